// The ground: its picture, surfaces on it, and over them grid, density, haze and sky.

@group(1) @binding(0) var density_map: texture_2d<f32>;
@group(1) @binding(1) var ground_picture: texture_2d<f32>;
@group(1) @binding(2) var smooth_sampler: sampler;
// Corners of all surfaces, pixels.
@group(1) @binding(3) var<storage, read> corners: array<vec2<f32>>;

// Pixels of the picture for a way on the ground.
fn in_picture(way: vec2<f32>) -> vec2<f32> {
    return way.x * scene.picture_map.xy + way.y * scene.picture_map.zw;
}

// Colour and opacity at a point of a copy of the picture; nothing beyond its edge.
fn texel_at(at: vec2<f32>, level: f32) -> vec4<f32> {
    let scale = exp2(-level);
    let size = ceil(scene.picture.zw * scale);
    let pixel = at * scale;
    if any(pixel < vec2<f32>(0.0)) || any(pixel > size) {
        return vec4<f32>(0.0);
    }
    let inside = clamp(pixel, vec2<f32>(0.5), max(size - 0.5, vec2<f32>(0.5)));
    let whole_size = vec2<f32>(textureDimensions(ground_picture, i32(level)));
    return textureSampleLevel(ground_picture, smooth_sampler, inside / whole_size, level);
}

// The same between two copies.
fn picture_at(at: vec2<f32>, level: f32) -> vec4<f32> {
    let last = scene.options.w;
    let coarse = min(floor(max(level, 0.0)), last);
    let near = texel_at(at, coarse);
    let share = clamp(level - coarse, 0.0, 1.0);
    if share < 0.02 || coarse == last {
        return near;
    }
    return mix(near, texel_at(at, coarse + 1.0), share);
}

@fragment
fn picture_pixel(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let spot = spot_at(position.xy);
    let middle = in_picture(spot.place) + scene.picture.xy;
    if spot.per == 0.0 || any(middle < vec2<f32>(0.0)) || any(middle > scene.picture.zw) {
        return vec4<f32>(0.0);
    }
    let right = in_picture(change_right(spot));
    let down = in_picture(change_down(spot));
    let is_right = length(right) > length(down);
    let along = select(down, right, is_right);
    let width = select(length(right), length(down), is_right);
    let reach = length(along);
    let n = clamp(ceil(reach / max(width, 1.0)), 1.0, 8.0);
    let part = max(max(width, reach / n), 1.0);
    var sum = vec4<f32>(0.0);
    for (var i = 0.0; i < n; i += 1.0) {
        let share = (i + 0.5) / n - 0.5;
        sum += picture_at(middle + share * along, log2(part)) / n;
    }
    let wash = share_of(scene.options.z);
    return vec4<f32>(mix(sum.rgb, scene.ground_color.rgb, wash), sum.a);
}

struct AreaPixel {
    @builtin(position) position: vec4<f32>,
    // First corner and number of corners; whether the surface is hatched.
    @location(0) @interpolate(flat) range: vec3<u32>,
    @location(1) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn area_corner(
    @builtin(vertex_index) index: u32,
    @location(0) bounds: vec4<f32>,
    @location(1) range: vec4<u32>,
    @location(2) color: vec4<f32>,
) -> AreaPixel {
    return AreaPixel(corner_of_bounds(index, bounds), range.xyz, color);
}

@fragment
fn area_pixel(area: AreaPixel) -> @location(0) vec4<f32> {
    let column = floor(area.position.x);
    let y = area.position.y;
    // The part of the pixel to the right of each side that crosses the middle of the row, with its sign.
    var cover = 0.0;
    var start = corners[area.range.x + area.range.y - 1u];
    for (var i = 0u; i < area.range.y; i += 1u) {
        let end = corners[area.range.x + i];
        if (start.y > y) != (end.y > y) {
            let x = start.x + (end.x - start.x) * (y - start.y) / (end.y - start.y);
            let right = clamp(column + 1.0 - x, 0.0, 1.0);
            cover += select(-right, right, end.y > start.y);
        }
        start = end;
    }
    var opacity = 1.0;
    if area.range.z != 0u {
        let spot = spot_at(area.position.xy);
        var line = 0.0;
        if spot.per > 0.0 {
            let change = change_over(spot);
            let at = spot.place.x + spot.place.y + scene.hatch.y;
            line = line_cover(at, 1.4 * max(change.x, change.y), scene.hatch.x);
        }
        opacity = mix(scene.hatch.z, scene.hatch.w, line);
    }
    return vec4<f32>(area.color.rgb, share_of(min(abs(cover), 1.0) * opacity));
}

// The density over its largest value.
fn density_at(place: vec2<f32>) -> f32 {
    let cell = (place - scene.density_reach.xy) / scene.density.xy;
    let low = vec2<i32>(floor(cell));
    let part = cell - floor(cell);
    let a = textureLoad(density_map, low, 0).r;
    let b = textureLoad(density_map, low + vec2<i32>(1, 0), 0).r;
    let c = textureLoad(density_map, low + vec2<i32>(0, 1), 0).r;
    let d = textureLoad(density_map, low + vec2<i32>(1, 1), 0).r;
    return clamp(mix(mix(a, b, part.x), mix(c, d, part.x), part.y) / scene.density.z, 0.0, 1.0);
}

// A colour over what is there, which may be transparent.
fn put(under: vec4<f32>, color: vec4<f32>, share: f32) -> vec4<f32> {
    return mix(under, vec4<f32>(color.rgb, 1.0), share_of(share));
}

@fragment
fn cover_pixel(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let spot = spot_at(position.xy);
    if spot.per == 0.0 {
        return vec4<f32>(scene.sky_color.rgb, 1.0);
    }
    let change = change_over(spot);
    let at = spot.place + scene.grid.xy;
    var color = vec4<f32>(0.0);
    let fine = max(line_cover(at.x, change.x, scene.grid.z), line_cover(at.y, change.y, scene.grid.z));
    color = put(color, scene.fine_color, scene.options.y * fine);
    let coarse = max(line_cover(at.x, change.x, scene.grid.w), line_cover(at.y, change.y, scene.grid.w));
    color = put(color, scene.coarse_color, scene.options.y * coarse);
    let is_inside = all(spot.place >= scene.density_reach.xy) && all(spot.place < scene.density_reach.zw);
    if scene.density.w > 0.0 && is_inside {
        let share = density_at(spot.place);
        if share > scene.fading.z {
            color = put(color, scene.density_color, scene.density.w * share);
        }
    }
    if scene.options.x == 0.0 {
        let far = length(spot.place - scene.eye.xy);
        if far > scene.eye.z {
            let haze = (far - scene.eye.z) / (scene.eye.w - scene.eye.z);
            color = put(color, scene.sky_color, clamp(haze, 0.0, 1.0));
        }
    }
    return color;
}
