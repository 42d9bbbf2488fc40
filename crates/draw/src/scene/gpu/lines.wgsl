// Lines with round ends, and shadows.

struct StrokePixel {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) ends: vec4<f32>,
    // Half the width, pixels, and opacity.
    @location(1) @interpolate(flat) pen: vec2<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn stroke_corner(
    @builtin(vertex_index) index: u32,
    @location(0) ends: vec4<f32>,
    @location(1) pen: vec2<f32>,
    @location(2) color: vec4<f32>,
) -> StrokePixel {
    let way = ends.zw - ends.xy;
    let size = length(way);
    let along = select(vec2<f32>(1.0, 0.0), way / size, size > 1e-4);
    let corner = corner_of(index) * (pen.x + 1.0);
    let end = select(ends.xy, ends.zw, corner.x > 0.0);
    let pixel = end + corner.x * along + corner.y * vec2<f32>(-along.y, along.x);
    return StrokePixel(in_clip(pixel), ends, pen, color);
}

@fragment
fn stroke_pixel(stroke: StrokePixel) -> @location(0) vec4<f32> {
    let way = stroke.ends.zw - stroke.ends.xy;
    let off = stroke.position.xy - stroke.ends.xy;
    let squared = dot(way, way);
    let along = select(0.0, clamp(dot(off, way) / squared, 0.0, 1.0), squared > 1e-9);
    let cover = clamp(stroke.pen.x + 0.5 - length(off - along * way), 0.0, 1.0);
    return vec4<f32>(stroke.color.rgb, share_of(cover * stroke.pen.y));
}

struct ShadowPixel {
    @builtin(position) position: vec4<f32>,
    // Middle; cosine and sine of the direction.
    @location(0) @interpolate(flat) pose: vec4<f32>,
    // Half the length and half the width, m.
    @location(1) @interpolate(flat) half_size: vec2<f32>,
}

@vertex
fn shadow_corner(
    @builtin(vertex_index) index: u32,
    @location(0) bounds: vec4<f32>,
    @location(1) pose: vec4<f32>,
    @location(2) half_size: vec2<f32>,
) -> ShadowPixel {
    return ShadowPixel(corner_of_bounds(index, bounds), pose, half_size);
}

@fragment
fn shadow_pixel(shadow: ShadowPixel) -> @location(0) vec4<f32> {
    let spot = spot_at(shadow.position.xy);
    if spot.per == 0.0 {
        return vec4<f32>(0.0);
    }
    let off = spot.place - shadow.pose.xy;
    let cos_sin = shadow.pose.zw;
    let own = vec2<f32>(dot(off, cos_sin), off.y * cos_sin.x - off.x * cos_sin.y);
    let edge = scene.shadow.y;
    let beyond = abs(own) - shadow.half_size + edge;
    let away = length(max(beyond, vec2<f32>(0.0))) + min(max(beyond.x, beyond.y), 0.0);
    let share = clamp(1.0 - away / (2.0 * edge), 0.0, 1.0);
    let smooth_share = share * share * (3.0 - 2.0 * share);
    return vec4<f32>(0.0, 0.0, 0.0, share_of(scene.shadow.x * smooth_share));
}
