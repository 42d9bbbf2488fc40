//! The mesh of an object that does not move: a wall or a pole.

use std::f64::consts::TAU;

use crate::scene::mesh::Mesh;
use crate::scene::{BodyClass, CarBody, Surface};
use impactlab_core::collision::Footprint;
use impactlab_core::vehicle::FixedObject;

/// Straight pieces of the circumference of a pole.
const N_PIECES: usize = 24;

/// Radius of the wheels that it does not have, m: such that nobody sees them.
const NO_WHEEL_M: f64 = 1e-3;

impl CarBody {
    /// Dimensions of an object that does not move, in place of those of a car.
    pub fn of_fixed(object: FixedObject, outline: &Footprint) -> Self {
        let height_m = match object {
            FixedObject::Wall => 1.0,
            FixedObject::Pole => 4.0,
        };
        Self {
            class: BodyClass::Van,
            length_m: outline.length_m,
            width_m: outline.width_m,
            height_m,
            front_m: outline.cg_from_front_m,
            axles_m: [0.0; 2],
            track_m: 0.0,
            wheel_radius_m: NO_WHEEL_M,
        }
    }
}

/// The mesh of an object that does not move.
pub(super) fn fixed_mesh(object: FixedObject, body: &CarBody) -> Mesh {
    let (middle_m, half_m) = (body.front_m - body.length_m / 2.0, body.width_m / 2.0);
    let outline_m: Vec<[f64; 2]> = match object {
        FixedObject::Wall => {
            let (front, rear) = (body.front_m, body.rear_m());
            vec![[front, half_m], [rear, half_m], [rear, -half_m], [front, -half_m]]
        }
        FixedObject::Pole => (0..N_PIECES)
            .map(|piece| (TAU * piece as f64 / N_PIECES as f64).sin_cos())
            .map(|(sin, cos)| [middle_m + half_m * cos, half_m * sin])
            .collect(),
    };
    let top_m = body.height_m;
    let inside = [middle_m, 0.0, top_m / 2.0];
    let mut mesh = Mesh::default();
    let next = outline_m.iter().cycle().skip(1);
    for ([x0, y0], [x1, y1]) in outline_m.iter().zip(next) {
        let face = [[*x0, *y0, 0.0], [*x1, *y1, 0.0], [*x1, *y1, top_m], [*x0, *y0, top_m]];
        mesh.add(Surface::Body, &face, inside);
    }
    let top: Vec<[f64; 3]> = outline_m.iter().map(|[x, y]| [*x, *y, top_m]).collect();
    mesh.add(Surface::Trim, &top, inside);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::CarShape;

    #[test]
    fn an_object_fills_its_outline_and_stands_on_the_ground() {
        let outline = Footprint { length_m: 0.4, width_m: 0.4, cg_from_front_m: 0.2 };
        for object in FixedObject::ALL {
            let shape = CarShape::of_fixed(*object, CarBody::of_fixed(*object, &outline));
            for (axis, expected) in
                [[-0.2, 0.2], [-0.2, 0.2], [0.0, shape.body.height_m]].iter().enumerate()
            {
                let values = shape.mesh.vertices_m.iter().map(|vertex| vertex[axis]);
                let [low, high] = values
                    .fold([9.0_f64, -9.0], |[low, high], value| [low.min(value), high.max(value)]);
                assert!((low - expected[0]).abs() < 1e-9 && (high - expected[1]).abs() < 1e-9);
            }
        }
    }
}
