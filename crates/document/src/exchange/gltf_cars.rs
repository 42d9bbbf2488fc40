//! The cars of a scene in glTF: bodies that lean, wheels that steer and roll.
//!
//! ```text
//! car: place and heading ──┬── body: roll
//!                          └── four wheels: steer angle, then how far it has turned
//! ```

use std::collections::HashMap;

use gltf::json::animation::{Channel, Interpolation, Property, Sampler, Target};
use gltf::json::mesh::Mode;
use gltf::json::scene::UnitQuaternion;
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Animation, Index, Mesh, Node};

use crate::exchange::gltf_buffer::GltfBuilder;
use crate::exchange::gltf_frame::GltfFrame;
use crate::exchange::gltf_lines::{material, mesh, primitive};
use crate::exchange::looks::{role_name, role_rgb};
use crate::scene::{
    CarLook, CarState, GHOST_OPACITY, Mesh as CarMesh, SceneCar, Surface, triangle_normal,
};
use impactlab_core::vehicle::Wheel;

/// Every material of a car.
const SURFACES: [Surface; 10] = [
    Surface::Body,
    Surface::Trim,
    Surface::Windscreen,
    Surface::Glass,
    Surface::HeadLamp,
    Surface::TailLamp,
    Surface::Underbody,
    Surface::Tire,
    Surface::Hub,
    Surface::HubGap,
];

/// A rotation as a unit quaternion `[x, y, z, w]`.
pub type Quaternion = [f32; 4];

/// The instants of an animation.
pub struct Keys<'a> {
    /// Their times in the scene, s.
    pub time_s: &'a [f64],
    /// The same in the file.
    pub times: Index<Accessor>,
    /// From where times and places are counted.
    pub frame: GltfFrame,
}

/// Adds a car with its animation; returns its node, in the axes of the scene.
pub fn add_car(
    builder: &mut GltfBuilder,
    animation: &mut Animation,
    car: &SceneCar,
    name: &str,
    keys: &Keys<'_>,
) -> Index<Node> {
    let states: Vec<CarState> = keys.time_s.iter().map(|time_s| car.at(*time_s)).collect();
    let shape = &car.shape;
    let is_ghost = car.look == CarLook::Ghost;
    let of_body = if is_ghost { &shape.coarse } else { &shape.mesh };
    let body = car_mesh(builder, car, &format!("{name} body"), of_body);
    let wheel_mesh = car_mesh(builder, car, &format!("{name} wheel"), &shape.wheel);
    let first = states.first().copied().unwrap_or_default();
    let body = builder.root.push(Node {
        mesh: Some(body),
        name: Some(format!("{name} body")),
        rotation: Some(UnitQuaternion(about_x(first.roll_rad))),
        ..Node::default()
    });
    let mut children = vec![body];
    let mut tracks = vec![(body, rotations(&states, |state| about_x(state.roll_rad)))];
    for wheel in Wheel::ALL {
        let turned = |state: &CarState| wheel_rotation(state, wheel);
        let node = builder.root.push(Node {
            mesh: Some(wheel_mesh),
            name: Some(format!("{name} wheel {wheel:?}")),
            translation: Some(shape.body.wheel_m(wheel).map(|value| value as f32)),
            rotation: Some(UnitQuaternion(turned(&first))),
            ..Node::default()
        });
        children.push(node);
        tracks.push((node, rotations(&states, turned)));
    }
    let node = builder.root.push(Node {
        children: Some(children),
        name: Some(name.to_owned()),
        translation: Some(place(&keys.frame, &first)),
        rotation: Some(UnitQuaternion(about_z(first.pose.yaw_rad))),
        ..Node::default()
    });
    tracks.push((node, rotations(&states, |state| about_z(state.pose.yaw_rad))));
    for (target, values) in tracks {
        let output = builder.list(&values, None);
        add_channel(animation, target, Property::Rotation, keys.times, output);
    }
    let places: Vec<[f32; 3]> = states.iter().map(|state| place(&keys.frame, state)).collect();
    let output = builder.list(&places, None);
    add_channel(animation, node, Property::Translation, keys.times, output);
    node
}

fn add_channel(
    animation: &mut Animation,
    node: Index<Node>,
    path: Property,
    input: Index<Accessor>,
    output: Index<Accessor>,
) {
    let sampler = Index::push(
        &mut animation.samplers,
        Sampler {
            extensions: None,
            extras: Default::default(),
            input,
            interpolation: Checked::Valid(Interpolation::Linear),
            output,
        },
    );
    animation.channels.push(Channel {
        sampler,
        target: Target {
            extensions: None,
            extras: Default::default(),
            node,
            path: Checked::Valid(path),
        },
        extensions: None,
        extras: Default::default(),
    });
}

/// A mesh with one part for each of its materials, flat faces.
fn car_mesh(builder: &mut GltfBuilder, car: &SceneCar, name: &str, shape: &CarMesh) -> Index<Mesh> {
    let mut parts = Vec::new();
    let opacity = if car.look == CarLook::Ghost { GHOST_OPACITY } else { 1.0 };
    for surface in SURFACES {
        let of_surface = shape.triangles.iter().filter(|triangle| triangle.surface == surface);
        let corners: Vec<[[f64; 3]; 3]> =
            of_surface.filter_map(|triangle| shape.corners_m(triangle)).collect();
        if corners.is_empty() {
            continue;
        }
        let single = |point: [f64; 3]| point.map(|value| value as f32);
        let positions: Vec<[f32; 3]> = corners.iter().flatten().map(|at| single(*at)).collect();
        let normals: Vec<[f32; 3]> =
            corners.iter().flat_map(|triangle| [single(triangle_normal(*triangle)); 3]).collect();
        let rgb = surface.rgb(role_rgb(car.role));
        let title = format!("{} {surface:?}", role_name(car.role));
        let of_material = material(builder, title, rgb, opacity);
        parts.push(primitive(builder, &positions, &normals, of_material, Mode::Triangles));
    }
    mesh(builder, name.to_owned(), parts)
}

/// Names of cars, each once: a second one of a name is numbered.
pub fn unique_names(cars: &[&SceneCar]) -> Vec<String> {
    let mut seen: HashMap<&str, usize> = HashMap::new();
    let mut names = Vec::with_capacity(cars.len());
    for car in cars {
        let n = seen.entry(car.name.as_str()).or_default();
        *n += 1;
        names.push(if *n == 1 { car.name.clone() } else { format!("{} {n}", car.name) });
    }
    names
}

/// The rotation of a wheel in its car: steered about z, turned about y, forwards from z towards x.
fn wheel_rotation(state: &CarState, wheel: Wheel) -> Quaternion {
    let steer_rad = match wheel {
        Wheel::FrontLeft => state.steer_rad[0],
        Wheel::FrontRight => state.steer_rad[1],
        Wheel::RearLeft | Wheel::RearRight => 0.0,
    };
    let ([_, _, z, w], (sin, cos)) =
        (about_z(steer_rad), (state.turned_rad[wheel.index()] / 2.0).sin_cos());
    let (sin, cos) = (sin as f32, cos as f32);
    // The product of a rotation about z and one about y.
    [-z * sin, w * sin, z * cos, w * cos]
}

/// Rotations of states, each on the same side as the one before, so that the shorter way lies between.
fn rotations(states: &[CarState], rotation: impl Fn(&CarState) -> Quaternion) -> Vec<Quaternion> {
    let mut before: Option<Quaternion> = None;
    let continued = |state: &CarState| {
        let next = rotation(state);
        let along = before.map_or(1.0, |from| (0..4).map(|i| from[i] * next[i]).sum());
        let next = if along < 0.0 { next.map(|value: f32| -value) } else { next };
        before = Some(next);
        next
    };
    states.iter().map(continued).collect()
}

fn place(frame: &GltfFrame, state: &CarState) -> [f32; 3] {
    let [x, y] = frame.place([state.pose.x_m, state.pose.y_m]);
    [x, y, 0.0]
}

fn about_x(angle_rad: f64) -> Quaternion {
    let (sin, cos) = (angle_rad / 2.0).sin_cos();
    [sin as f32, 0.0, 0.0, cos as f32]
}

fn about_z(angle_rad: f64) -> Quaternion {
    let (sin, cos) = (angle_rad / 2.0).sin_cos();
    [0.0, 0.0, sin as f32, cos as f32]
}
