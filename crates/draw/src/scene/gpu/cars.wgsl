// Cars, in a picture of four samples a pixel, and how that becomes the picture.

// The picture without cars, or that of samples.
@group(1) @binding(0) var image: texture_2d<f32>;

struct CarPixel {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn car_corner(
    @location(0) place: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // The colour; the last number is 0 for what has it always, 1/255 for what is painted in the colour of
    // the car, 2/255 for the disc of a wheel, which shows whether it is locked.
    @location(2) surface: vec4<f32>,
    // The mesh in the axes of the camera: to the right, up, and ahead.
    @location(3) right: vec4<f32>,
    @location(4) up: vec4<f32>,
    @location(5) ahead: vec4<f32>,
    // Direction to the sun in the axes of the mesh, and opacity.
    @location(6) sun: vec4<f32>,
    // Colour of the car, and 1 for a locked wheel.
    @location(7) paint: vec4<f32>,
    // The depth of a nearness n is depth.x + depth.y n.
    @location(8) depth: vec2<f32>,
) -> CarPixel {
    let at = vec4<f32>(place, 1.0);
    let seen = vec2<f32>(dot(right, at), dot(up, at)) * scene.size.zw;
    let far = dot(ahead, at);
    let is_parallel = scene.options.x != 0.0;
    var position = vec4<f32>(seen, depth.x * far + depth.y, far);
    if is_parallel {
        position = vec4<f32>(seen, depth.x - depth.y * far, 1.0);
    }
    let kind = round(surface.a * 255.0);
    var color = surface.rgb;
    if kind == 1.0 {
        color = paint.rgb;
    }
    if kind == 2.0 && paint.a > 0.0 {
        color = scene.locked_color.rgb;
    }
    let toward = dot(normal, sun.xyz);
    let light = dot(scene.light.xyz, vec3<f32>(1.0, max(toward, 0.0), min(toward, 0.0)));
    return CarPixel(position, vec4<f32>(clamp(color * light, vec3<f32>(0.0), vec3<f32>(1.0)), sun.w));
}

@fragment
fn car_pixel(car: CarPixel) -> @location(0) vec4<f32> {
    return vec4<f32>(car.color.rgb, share_of(car.color.a));
}

// What lies behind a sample.
@fragment
fn behind_sample(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(image, vec2<i32>(position.xy) / 2, 0);
}

// The mean of the samples of a pixel.
@fragment
fn mean_of_samples(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let first = vec2<i32>(position.xy) * 2;
    let above = textureLoad(image, first, 0) + textureLoad(image, first + vec2<i32>(1, 0), 0);
    let below =
        textureLoad(image, first + vec2<i32>(0, 1), 0) + textureLoad(image, first + vec2<i32>(1, 1), 0);
    return vec4<f32>((above + below).rgb / 4.0, 1.0);
}
