//! The meshes of a car.

use crate::scene::body_mesh::{Detail, body_mesh};
use crate::scene::fixed_shape::fixed_mesh;
use crate::scene::wheel_mesh::wheel_mesh;
use crate::scene::{CarBody, Mesh};
use impactlab_core::vehicle::FixedObject;

/// A car as it is drawn, in body axes: x forward from the CG, y to the left, z up from the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct CarShape {
    /// The dimensions it was built from.
    pub body: CarBody,
    /// Body and cabin, with wheel arches.
    pub mesh: Mesh,
    /// The same in fewer triangles, without wheel arches: for ghosts, and for cars that are small in the
    /// picture.
    pub coarse: Mesh,
    /// A wheel around the y axis, with its centre at the origin.
    pub wheel: Mesh,
}

impl CarShape {
    /// Builds a car.
    pub fn new(body: CarBody) -> Self {
        Self {
            mesh: body_mesh(&body, Detail::Full),
            coarse: body_mesh(&body, Detail::Coarse),
            wheel: wheel_mesh(body.wheel_radius_m, body.wheel_width_m()),
            body,
        }
    }

    /// Builds an object that does not move, which stands in the place of a car.
    pub fn of_fixed(object: FixedObject, body: CarBody) -> Self {
        let mesh = fixed_mesh(object, &body);
        let wheel = wheel_mesh(body.wheel_radius_m, body.wheel_width_m());
        Self { coarse: mesh.clone(), mesh, wheel, body }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{BodyClass, Surface};
    use impactlab_core::collision::Footprint;
    use impactlab_core::vehicle::{Preset, Wheel};

    /// A car of each kind, of usual and of odd dimensions.
    fn bodies() -> Vec<CarBody> {
        let mut bodies = Vec::new();
        for vehicle in [Preset::Reference.parameters(), Preset::Bullet2000.parameters()] {
            let outline = Footprint::from(&vehicle.geometry);
            for class in BodyClass::ALL {
                let body = CarBody::new(&vehicle, &outline);
                let height_m = class.roof_height_m(vehicle.geometry.cg_height_m);
                bodies.push(CarBody { class, height_m, ..body });
                let odd = CarBody { length_m: 3.0, front_m: 1.2, axles_m: [1.3, 2.0], ..body };
                bodies.push(CarBody { class, wheel_radius_m: 0.6, track_m: 3.0, ..odd });
            }
        }
        bodies
    }

    #[test]
    fn a_car_lies_within_its_outer_dimensions_and_reaches_them() {
        for body in bodies() {
            let shape = CarShape::new(body);
            for mesh in [&shape.mesh, &shape.coarse] {
                let range = |axis: usize| {
                    let values = mesh.vertices_m.iter().map(|vertex| vertex[axis]);
                    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                        [low.min(value), high.max(value)]
                    })
                };
                let ([rear, front], [right, left], [low, high]) = (range(0), range(1), range(2));
                assert!((front - body.front_m).abs() < 1e-9, "{body:?}: front at {front}");
                assert!((rear - body.rear_m()).abs() < 1e-9, "{body:?}: rear at {rear}");
                assert!((left - body.width_m / 2.0).abs() < 1e-9, "{body:?}: left at {left}");
                assert!((left + right).abs() < 1e-12, "{body:?}: {left} and {right}");
                assert!((high - body.height_m).abs() < 0.01, "{body:?}: roof at {high}");
                assert!(low > 0.05, "{body:?}: {low} above the ground");
            }
        }
    }

    #[test]
    fn a_car_is_its_own_mirror_image() {
        for body in bodies() {
            let shape = CarShape::new(body);
            let key = |[x, y, z]: [f64; 3]| [x, y, z].map(|v| (v * 1e6).round() as i64);
            let mut vertices: Vec<_> = shape.mesh.vertices_m.iter().map(|v| key(*v)).collect();
            let mut mirrored: Vec<_> =
                shape.mesh.vertices_m.iter().map(|[x, y, z]| key([*x, -y, *z])).collect();
            vertices.sort_unstable();
            mirrored.sort_unstable();
            assert_eq!(vertices, mirrored, "{body:?}");
        }
    }

    #[test]
    fn the_front_faces_ahead_with_head_lamps_and_windscreen() {
        for body in bodies() {
            let shape = CarShape::new(body);
            let mean_x = |surface: Surface| {
                let triangles =
                    shape.mesh.triangles.iter().filter(|triangle| triangle.surface == surface);
                let corners: Vec<f64> = triangles
                    .filter_map(|triangle| shape.mesh.corners_m(triangle))
                    .flatten()
                    .map(|v| v[0])
                    .collect();
                corners.iter().sum::<f64>() / corners.len() as f64
            };
            let [lamp, screen, tail] =
                [Surface::HeadLamp, Surface::Windscreen, Surface::TailLamp].map(mean_x);
            assert!(lamp > screen && screen > tail, "{body:?}: {lamp}, {screen}, {tail}");
            assert!(lamp > body.front_m - 0.1 * body.length_m, "{body:?}: {lamp}");
        }
    }

    #[test]
    fn wheels_stand_on_the_ground_under_the_body() {
        for body in bodies() {
            let shape = CarShape::new(body);
            for wheel in Wheel::ALL {
                let [_, y, z] = body.wheel_m(wheel);
                let lowest = shape.wheel.vertices_m.iter().map(|v| v[2] + z).fold(9.0, f64::min);
                assert!(lowest.abs() < 0.02 * body.wheel_radius_m, "{body:?}: {lowest}");
                let outermost = y.abs() + body.wheel_width_m() / 2.0;
                assert!(outermost <= body.width_m / 2.0, "{body:?}: {outermost}");
            }
        }
    }

    #[test]
    fn surfaces_have_few_triangles() {
        for body in bodies() {
            let shape = CarShape::new(body);
            let [full, coarse, wheel] =
                [&shape.mesh, &shape.coarse, &shape.wheel].map(|mesh| mesh.triangles.len());
            assert!(full < 900 && coarse < 320 && wheel < 140, "{full}, {coarse}, {wheel}");
        }
    }
}
