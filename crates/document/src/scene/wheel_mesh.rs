//! A wheel: a cylinder with a disc whose sectors show how far it has turned.

use std::f64::consts::TAU;

use crate::scene::Surface;
use crate::scene::mesh::Mesh;

/// Straight pieces of the circumference; two of them are a sector of the disc.
const N_PIECES: usize = 20;
/// Radius of the disc over that of the wheel.
const DISC_RATIO: f64 = 0.66;
/// How far the disc stands out of the tire, m.
const DISC_LIFT_M: f64 = 0.004;

/// A wheel around the y axis with its centre at the origin; its disc shows on both sides.
///
/// - `radius_m`, `width_m`: of the tire.
pub(super) fn wheel_mesh(radius_m: f64, width_m: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let half_m = width_m / 2.0;
    let point = |piece: usize, radius_m: f64, y: f64| {
        let (sin, cos) = (TAU * piece as f64 / N_PIECES as f64).sin_cos();
        [radius_m * cos, y, radius_m * sin]
    };
    for piece in 0..N_PIECES {
        let next = piece + 1;
        let tread = [
            point(piece, radius_m, half_m),
            point(next, radius_m, half_m),
            point(next, radius_m, -half_m),
            point(piece, radius_m, -half_m),
        ];
        mesh.add(Surface::Tire, &tread, [0.0; 3]);
        let side =
            [[0.0, half_m, 0.0], point(piece, radius_m, half_m), point(next, radius_m, half_m)];
        mesh.add_mirrored(Surface::Tire, &side, [0.0; 3]);
        let disc_m = half_m + DISC_LIFT_M;
        let surface = if piece / 2 % 2 == 0 { Surface::Hub } else { Surface::HubGap };
        let radius_m = DISC_RATIO * radius_m;
        let disc =
            [[0.0, disc_m, 0.0], point(piece, radius_m, disc_m), point(next, radius_m, disc_m)];
        mesh.add_mirrored(surface, &disc, [0.0; 3]);
    }
    mesh
}
