//! The cabin: pillars and roof in the colour of the body, windows in front of them.

use crate::scene::Surface;
use crate::scene::body_mesh::Shape;
use crate::scene::mesh::{Mesh, between, triangle_normal};

/// How far windows stand out of the body, m, so that they hide it.
const GLASS_LIFT_M: f64 = 0.006;
/// Heights over that of the roof: edge of the roof, and its middle at the windscreen and at its end.
const ROOF_EDGE: f64 = 0.972;
const ROOF_ENDS: [f64; 2] = [0.985, 0.98];
/// Shares of the length of the roof from its front end: where it is highest.
const ROOF_MIDDLE: f64 = 0.45;
/// Shares of the side from the windscreen to the rear window: the windows.
const SIDE_WINDOWS: [[f64; 2]; 2] = [[0.07, 0.47], [0.52, 0.93]];
/// Shares of the height of the side: lower and upper edge of its windows.
const SIDE_HEIGHTS: [f64; 2] = [0.08, 0.88];
/// Shares of the half width and of the height of windscreen and rear window.
const SCREEN_WIDTH: f64 = 0.92;
const SCREEN_HEIGHTS: [f64; 2] = [0.04, 0.95];

/// Adds the cabin.
pub(super) fn add_cabin(mesh: &mut Mesh, shape: &Shape<'_>) {
    let [foot, top, end, rear] = shape.proportions.cabin;
    let roof_m = shape.body.height_m;
    let roof = |place: f64| {
        let half_m = shape.proportions.roof_width * shape.half_width_m(place);
        [shape.x_m(place), half_m, ROOF_EDGE * roof_m]
    };
    let pillars = [shape.edge_m(foot), roof(top), roof(end), shape.edge_m(rear)];
    let [front_foot, front_top, rear_top, rear_foot] = pillars;
    let middle = between(front_top, rear_top, ROOF_MIDDLE);
    let inside = [middle[0], 0.0, 0.8 * roof_m];
    let crown = |[x, ..]: [f64; 3], height: f64| [x, 0.0, height * roof_m];
    let [front_crown, rear_crown] = [crown(front_top, ROOF_ENDS[0]), crown(rear_top, ROOF_ENDS[1])];
    let highest = crown(middle, 1.0);
    for half in [[front_crown, front_top, middle, highest], [highest, middle, rear_top, rear_crown]]
    {
        mesh.add_mirrored(Surface::Body, &half, inside);
    }
    for (surface, [low, high], crown) in [
        (Surface::Windscreen, [front_foot, front_top], front_crown),
        (Surface::Glass, [rear_foot, rear_top], rear_crown),
    ] {
        let screen = [[low[0], 0.0, low[2]], low, high, crown];
        mesh.add_mirrored(Surface::Body, &screen, inside);
        mesh.add_mirrored(surface, &lifted(pane(screen), inside), inside);
    }
    let side = |share: f64, height: f64| {
        between(between(front_foot, rear_foot, share), between(front_top, rear_top, share), height)
    };
    let face = |[from, to]: [f64; 2], [low, high]: [f64; 2]| {
        [side(from, low), side(from, high), side(to, high), side(to, low)]
    };
    for part in [[0.0, 0.5], [0.5, 1.0]] {
        mesh.add_mirrored(Surface::Body, &face(part, [0.0, 1.0]), inside);
    }
    for window in SIDE_WINDOWS {
        let glass = lifted(face(window, SIDE_HEIGHTS), inside);
        mesh.add_mirrored(Surface::Glass, &glass, inside);
    }
}

/// The left half of the glass of a windscreen or rear window.
fn pane([low_middle, low, high, high_middle]: [[f64; 3]; 4]) -> [[f64; 3]; 4] {
    let [from, to] = SCREEN_HEIGHTS;
    let at = |height: f64, width: f64| {
        let middle = between(low_middle, high_middle, height);
        between(middle, between(low, high, height), width)
    };
    [at(from, 0.0), at(from, SCREEN_WIDTH), at(to, SCREEN_WIDTH), at(to, 0.0)]
}

/// A surface moved outward.
fn lifted(corners: [[f64; 3]; 4], inside: [f64; 3]) -> [[f64; 3]; 4] {
    let [a, b, c, _] = corners;
    let out = triangle_normal([a, b, c]);
    let outward: f64 = (0..3).map(|i| out[i] * (a[i] - inside[i])).sum();
    let lift_m = GLASS_LIFT_M * outward.signum();
    corners.map(|point| std::array::from_fn(|i| point[i] + lift_m * out[i]))
}
