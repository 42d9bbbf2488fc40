//! A scene with its animation in glTF 2.0, in one binary file (`.glb`) that 3D programs such as Blender
//! and viewers in browsers open.
//!
//! glTF has Y up: the node `scene` turns the axes of the scene into those of glTF, so that X of the scene
//! is X, Y (to the left) is −Z, and Z (up) is Y; the nodes below it are in the axes of the scene, in
//! metres. Times and places are counted from a [`GltfFrame`], which stands in the `extras` of the asset.
//!
//! Keys are close enough for a wheel to turn by less than a third of a turn between two of them, since a
//! rotation goes the shorter way. Densities and points are left out.

use std::borrow::Cow;
use std::io::Write;

use gltf::binary::{Glb, Header};
use gltf::json::scene::UnitQuaternion;
use gltf::json::{Animation, Asset, Node, Scene as GltfScene};

use crate::exchange::ExchangeError;
use crate::exchange::gltf_buffer::GltfBuilder;
use crate::exchange::gltf_cars::{Keys, add_car, unique_names};
use crate::exchange::gltf_frame::GltfFrame;
use crate::exchange::gltf_lines::add_lines;
use crate::scene::{Scene, SceneCar};

/// Distance of keys in time, at most, s.
const LARGEST_STEP_S: f64 = 0.02;
/// Angle by which a wheel turns between two keys, at most, rad.
const LARGEST_TURN_RAD: f64 = 2.0;
/// Keys of an animation, at most; a wheel that turns faster looks slower.
const MAX_KEYS: f64 = 200_000.0;

/// Writes a scene as binary glTF.
///
/// # Errors
/// [`ExchangeError`]: a scene beyond 4 GiB, and the errors of the library and the operating system.
pub fn glb(scene: &Scene, out: &mut dyn Write) -> Result<(), ExchangeError> {
    let mut builder = GltfBuilder::default();
    let cars: Vec<&SceneCar> = scene.cars.iter().filter(|car| !car.is_draw()).collect();
    let frame = GltfFrame::new(scene);
    let mut time_s = key_times_s(scene.end_s, frame.start_s, &cars);
    // Keys that single precision does not tell apart are one.
    time_s.dedup_by_key(|time| frame.time(*time));
    let single: Vec<[f32; 1]> = time_s.iter().map(|time| [frame.time(*time)]).collect();
    let times = builder.list(&single, None);
    let mut animation = Animation {
        extensions: None,
        extras: Default::default(),
        channels: Vec::new(),
        name: Some("motion".to_owned()),
        samplers: Vec::new(),
    };
    let mut children = add_lines(&mut builder, scene, &frame);
    let keys = Keys { time_s: &time_s, times, frame };
    for (car, name) in cars.iter().zip(unique_names(&cars)) {
        children.push(add_car(&mut builder, &mut animation, car, &name, &keys));
    }
    if !animation.channels.is_empty() {
        builder.root.push(animation);
    }
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turned = builder.root.push(Node {
        children: Some(children),
        name: Some("scene".to_owned()),
        rotation: Some(UnitQuaternion([-half, 0.0, 0.0, half])),
        ..Node::default()
    });
    let shown = builder.root.push(GltfScene {
        extensions: None,
        extras: Default::default(),
        name: Some(scene.title.clone()),
        nodes: vec![turned],
    });
    builder.root.scene = Some(shown);
    // What restricts the answer travels with it: 3D programs show the copyright line of a file.
    builder.root.asset = Asset {
        generator: Some(concat!("impactlab ", env!("CARGO_PKG_VERSION")).to_owned()),
        copyright: scene.caveats.in_units(scene.units).text(),
        ..Asset::default()
    };
    builder.describe_buffer();
    write(builder, &frame, out)
}

fn write(
    builder: GltfBuilder,
    frame: &GltfFrame,
    out: &mut dyn Write,
) -> Result<(), ExchangeError> {
    let mut root = serde_json::to_value(&builder.root)?;
    // The types of the library have no extras as it is built here.
    root["asset"]["extras"] = frame.extras();
    let json = serde_json::to_vec(&root)?;
    let bytes = builder.bytes.len().saturating_add(json.len());
    // Two chunks with a head of 8 bytes each, padded to 4 bytes, behind a head of 12.
    if u32::try_from(bytes.saturating_add(64)).is_err() {
        return Err(ExchangeError::TooLarge { bytes });
    }
    let header = Header { magic: *b"glTF", version: 2, length: 0 };
    let file = Glb { header, json: Cow::Owned(json), bin: Some(Cow::Owned(builder.bytes)) };
    Ok(file.to_writer(out)?)
}

/// Times of the keys, s: from the first instant to the last at the same distance.
fn key_times_s(end_s: f64, first_s: f64, cars: &[&SceneCar]) -> Vec<f64> {
    let duration_s = end_s - first_s;
    let fastest = cars.iter().map(|car| fastest_turn_rad_s(car)).fold(0.0, f64::max);
    let step_s = LARGEST_STEP_S.min(LARGEST_TURN_RAD / fastest.max(1.0));
    let n = (duration_s / step_s).ceil().clamp(1.0, MAX_KEYS);
    (0..=n as usize).map(|idx| first_s + duration_s * (idx as f64 / n)).collect()
}

/// The fastest turning of a wheel, rad/s.
fn fastest_turn_rad_s(car: &SceneCar) -> f64 {
    let (times, states) = (car.motion.time_s(), car.motion.states());
    let steps = times.windows(2).zip(states.windows(2));
    let rates = steps.flat_map(|(time, state)| {
        let step_s = time[1] - time[0];
        let turned = state[1].turned_rad.iter().zip(state[0].turned_rad);
        turned.map(move |(to, from)| ((to - from) / step_s).abs()).collect::<Vec<f64>>()
    });
    rates.filter(|rate| rate.is_finite()).fold(0.0, f64::max)
}
