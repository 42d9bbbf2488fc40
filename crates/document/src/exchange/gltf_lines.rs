//! The ground, paths and lines of a scene in glTF.

use gltf::json::material::{AlphaMode, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, Material, Mesh, Node, buffer};

use crate::exchange::gltf_buffer::GltfBuilder;
use crate::exchange::gltf_frame::GltfFrame;
use crate::exchange::looks::{role_name, role_rgb};
use crate::scene::{Scene, SceneRole};

/// Height of lines above the ground, m, so that they are not hidden in it.
const LINE_HEIGHT_M: f32 = 0.02;
/// Room around the scene that the ground fills, m.
const GROUND_ROOM_M: f64 = 15.0;
/// Colour of the ground.
const GROUND_RGB: [u8; 3] = [205, 208, 210];

/// Adds ground, paths and lines; returns their nodes, in the axes of the scene.
pub fn add_lines(builder: &mut GltfBuilder, scene: &Scene, frame: &GltfFrame) -> Vec<Index<Node>> {
    let mut nodes = vec![ground(builder, scene, frame)];
    for path in &scene.paths {
        let places = path.motion.states().iter().map(|state| [state.pose.x_m, state.pose.y_m]);
        nodes.extend(line(builder, frame, &path.name, path.role, places));
    }
    for scene_line in &scene.lines {
        let places = scene_line.points_m.iter().copied();
        nodes.extend(line(builder, frame, &scene_line.name, scene_line.role, places));
    }
    for mark in &scene.marks {
        for piece in mark.pieces() {
            let places = piece.iter().map(|point| point.place_m);
            nodes.extend(line(builder, frame, &mark.name, SceneRole::TireMark, places));
        }
    }
    for arrow in &scene.arrows {
        let ends = arrow.ends_m.into_iter();
        nodes.extend(line(builder, frame, &arrow.name, arrow.role, ends));
    }
    nodes
}

/// A material of one colour.
///
/// - `opacity`: 1 for one through which nothing shines.
pub fn material(
    builder: &mut GltfBuilder,
    name: String,
    rgb: [u8; 3],
    opacity: f32,
) -> Index<Material> {
    let [r, g, b] = rgb.map(linear);
    builder.root.push(Material {
        name: Some(name),
        alpha_mode: Checked::Valid(if opacity < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        }),
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([r, g, b, opacity]),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(0.6),
            ..PbrMetallicRoughness::default()
        },
        ..Material::default()
    })
}

/// A part of a mesh with one material.
pub fn primitive(
    builder: &mut GltfBuilder,
    positions: &[[f32; 3]],
    normals: &[[f32; 3]],
    material: Index<Material>,
    mode: Mode,
) -> Primitive {
    let target = Some(buffer::Target::ArrayBuffer);
    let mut attributes = std::collections::BTreeMap::new();
    let of_positions = builder.list(positions, target);
    attributes.insert(Checked::Valid(Semantic::Positions), of_positions);
    if !normals.is_empty() {
        let of_normals = builder.list(normals, target);
        attributes.insert(Checked::Valid(Semantic::Normals), of_normals);
    }
    Primitive {
        attributes,
        extensions: None,
        extras: Default::default(),
        indices: None,
        material: Some(material),
        mode: Checked::Valid(mode),
        targets: None,
    }
}

/// A mesh of parts.
pub fn mesh(builder: &mut GltfBuilder, name: String, primitives: Vec<Primitive>) -> Index<Mesh> {
    builder.root.push(Mesh {
        extensions: None,
        extras: Default::default(),
        name: Some(name),
        primitives,
        weights: None,
    })
}

fn line(
    builder: &mut GltfBuilder,
    frame: &GltfFrame,
    name: &str,
    role: SceneRole,
    places_m: impl Iterator<Item = [f64; 2]>,
) -> Option<Index<Node>> {
    let finite = places_m.filter(|place| place.iter().all(|value| value.is_finite()));
    let placed = |[x, y]: [f32; 2]| [x, y, LINE_HEIGHT_M];
    let places: Vec<[f32; 3]> = finite.map(|at| placed(frame.place(at))).collect();
    if places.len() < 2 {
        return None;
    }
    let name = if name.is_empty() { role_name(role) } else { name.to_owned() };
    let material = material(builder, format!("{} line", role_name(role)), role_rgb(role), 1.0);
    let part = primitive(builder, &places, &[], material, Mode::LineStrip);
    let mesh = mesh(builder, name.clone(), vec![part]);
    Some(builder.root.push(Node { mesh: Some(mesh), name: Some(name), ..Node::default() }))
}

fn ground(builder: &mut GltfBuilder, scene: &Scene, frame: &GltfFrame) -> Index<Node> {
    let [low, high] = scene.extent_m();
    let [x0, y0] = frame.place(low.map(|value| value - GROUND_ROOM_M));
    let [x1, y1] = frame.place(high.map(|value| value + GROUND_ROOM_M));
    let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y0], [x1, y1], [x0, y1]];
    let places = corners.map(|[x, y]| [x, y, 0.0]);
    let material = material(builder, "ground".to_owned(), GROUND_RGB, 1.0);
    let normals = [[0.0, 0.0, 1.0]; 6];
    let part = primitive(builder, &places, &normals, material, Mode::Triangles);
    let mesh = mesh(builder, "ground".to_owned(), vec![part]);
    let name = Some("ground".to_owned());
    builder.root.push(Node { mesh: Some(mesh), name, ..Node::default() })
}

/// A channel of sRGB as light, as glTF wants it.
fn linear(value: u8) -> f32 {
    let share = f32::from(value) / 255.0;
    if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
}
