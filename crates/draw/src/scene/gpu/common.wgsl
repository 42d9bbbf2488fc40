// What all stages share. Places on the ground are off the point that the camera looks at, m; colours are
// shares of 255, blended as they are, as on the CPU.

struct Scene {
    // Width and height of the picture, pixels; clip coordinates per metre at a distance of one (in
    // perspective) or everywhere (from above).
    size: vec4<f32>,
    // The ground under pixel (px, py): (a + b px + c py) of x and of y over that of d.
    ground_x: vec4<f32>,
    ground_y: vec4<f32>,
    ground_d: vec4<f32>,
    // Phases along x and y, m; distances of fine and of coarse lines, m.
    grid: vec4<f32>,
    // Place of the camera; distances at which the ground begins to fade and has faded, m.
    eye: vec4<f32>,
    // Lowest and highest place of the density.
    density_reach: vec4<f32>,
    // Steps of the density along x and y, m; its largest value; its opacity there, 0 without a density.
    density: vec4<f32>,
    // Pixels of the picture of the ground along x and along y, per metre.
    picture_map: vec4<f32>,
    // Its pixel under the point that is looked at; its width and height, pixels.
    picture: vec4<f32>,
    // Distance and phase of the hatching, m; opacity between its lines and on them.
    hatch: vec4<f32>,
    // Whether the view is parallel; opacity of the grid; share of the colour of the ground over its
    // picture; number of the smallest copy of the picture.
    options: vec4<f32>,
    // Opacity of shadows; width of their soft edge, m.
    shadow: vec4<f32>,
    // Distance of the lines of a grid, pixels, below which they fade and at which they are gone; least
    // share of the largest density that is drawn.
    fading: vec4<f32>,
    // Shares of the light that comes from everywhere, from the sun, and that what is turned away lacks.
    light: vec4<f32>,
    ground_color: vec4<f32>,
    sky_color: vec4<f32>,
    fine_color: vec4<f32>,
    coarse_color: vec4<f32>,
    density_color: vec4<f32>,
    locked_color: vec4<f32>,
}

@group(0) @binding(0) var<uniform> scene: Scene;

// Clip coordinates of a pixel.
fn in_clip(pixel: vec2<f32>) -> vec4<f32> {
    let share = 2.0 * pixel / scene.size.xy - 1.0;
    return vec4<f32>(share.x, -share.y, 0.0, 1.0);
}

// The corner of a square from -1 to 1, for a strip of two triangles.
fn corner_of(index: u32) -> vec2<f32> {
    return vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
}

// Clip coordinates of a corner of a rectangle by its lowest and highest pixel.
fn corner_of_bounds(index: u32, bounds: vec4<f32>) -> vec4<f32> {
    let middle = (bounds.xy + bounds.zw) / 2.0;
    return in_clip(middle + corner_of(index) * (bounds.zw - middle));
}

// A triangle that covers the whole picture.
@vertex
fn whole(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The place under a pixel, and one over its distance; that is 0 above the horizon.
struct Spot {
    place: vec2<f32>,
    per: f32,
}

fn spot_at(pixel: vec2<f32>) -> Spot {
    let at = vec3<f32>(1.0, pixel);
    let d = dot(scene.ground_d.xyz, at);
    if d <= 1e-9 {
        return Spot(vec2<f32>(0.0), 0.0);
    }
    let per = 1.0 / d;
    return Spot(vec2<f32>(dot(scene.ground_x.xyz, at), dot(scene.ground_y.xyz, at)) * per, per);
}

// By how much the place changes from a pixel to the one at its right.
fn change_right(spot: Spot) -> vec2<f32> {
    return (vec2<f32>(scene.ground_x.y, scene.ground_y.y) - spot.place * scene.ground_d.y) * spot.per;
}

// The same to the pixel below.
fn change_down(spot: Spot) -> vec2<f32> {
    return (vec2<f32>(scene.ground_x.z, scene.ground_y.z) - spot.place * scene.ground_d.z) * spot.per;
}

// By how much each coordinate changes over a pixel.
fn change_over(spot: Spot) -> vec2<f32> {
    let right = change_right(spot);
    let down = change_down(spot);
    return max(sqrt(right * right + down * down), vec2<f32>(1e-9));
}

// How far a line of a grid covers a pixel, 0 to 1. Lines that are too close fade.
fn line_cover(at: f32, change: f32, step: f32) -> f32 {
    let cell = at / step;
    let per = step / change;
    let away = abs(cell - round(cell)) * per;
    return max(1.0 - away, 0.0) * clamp((per - scene.fading.y) / (scene.fading.x - scene.fading.y), 0.0, 1.0);
}

// A share as the CPU rounds it.
fn share_of(value: f32) -> f32 {
    return floor(value * 256.0) / 256.0;
}
