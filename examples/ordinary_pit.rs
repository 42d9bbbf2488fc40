//! Measures in which share of ordinary PIT manoeuvres the force network applies.
//!
//! ```text
//! cargo run --release --example ordinary_pit [-- MODEL]
//! ```
//!
//! Both cars run at 35 to 70 mph and 1400 to 2600 kg; the striking car closes across at 2 to 15 mph, is up to
//! 10 mph faster or 5 mph slower along the road, and turned by 5° to 30°. It touches between 0.6 m behind and
//! 0.6 m ahead of the rear axle. All of it is uniform and independent; yaw rates are those of a driver who
//! steers in (0 to 0.5 rad/s towards the struck car). Nothing is fitted to what is drawn here.

#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use impactlab_core::data::StruckSide;
use impactlab_core::numerics::random_stream;
use impactlab_networks::force::{ForceModel, ForceScenario};
use impactlab_networks::learning::ModelFile;
use rand::RngExt;

/// Number of manoeuvres.
const N: usize = 2000;
const M_S_PER_MPH: f64 = 0.44704;
/// Rear axle and flank of the struck car, and the front corner of the striking one, from their CGs, m.
const REAR_AXLE_X_M: f64 = -1.5;
const FLANK_Y_M: f64 = -0.92;
const CORNER_M: [f64; 2] = [2.2, 0.9];

fn manoeuvre(rng: &mut impl rand::Rng) -> ForceScenario {
    let mut between = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
    let along = M_S_PER_MPH * between(35.0, 70.0);
    let across = M_S_PER_MPH * between(2.0, 15.0);
    let faster = M_S_PER_MPH * between(-5.0, 10.0);
    let theta = between(5.0, 30.0).to_radians();
    let contact = [REAR_AXLE_X_M + between(-0.6, 0.6), FLANK_Y_M];
    let mass_kg = [between(1400.0, 2600.0), between(1400.0, 2600.0)];
    let (sin, cos) = theta.sin_cos();
    let arm = [CORNER_M[0] * cos - CORNER_M[1] * sin, CORNER_M[0] * sin + CORNER_M[1] * cos];
    ForceScenario {
        mass_kg,
        struck_velocity_m_s: [along, 0.0],
        striking_velocity_m_s: [along + faster, across],
        yaw_rate_rad_s: [0.0, between(0.0, 0.5)],
        theta_b_rad: theta,
        side: StruckSide::Right,
        contact_m: Some(contact),
        normal_rad: None,
        striking_position_m: Some([contact[0] - arm[0], contact[1] - arm[1]]),
        striking_body: None,
        struck_body: None,
        yaw_inertia_kg_m2: mass_kg.map(|mass| Some(1.8 * mass)),
        contact_law: None,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path =
        std::env::args().nth(1).unwrap_or_else(|| "assets/models/force.safetensors".to_owned());
    let model = ForceModel::load(Path::new(&path))?;
    let mut rng = random_stream(0, "ordinary PIT", 0);
    let (mut whole, mut half, mut outside) = (0, 0, BTreeMap::new());
    for _ in 0..N {
        let prediction = model.predict(&manoeuvre(&mut rng))?;
        whole += usize::from(prediction.applicability >= 1.0);
        half += usize::from(prediction.applicability >= 0.5);
        for feature in &prediction.outside {
            *outside.entry(feature.feature).or_insert(0) += 1;
        }
    }
    let percent = |n: usize| 100.0 * n as f64 / N as f64;
    println!("of {N} manoeuvres the force network applies");
    println!("  fully         {:5.1} %", percent(whole));
    println!("  by half       {:5.1} %", percent(half));
    for (feature, n) in outside {
        println!("  outside: {feature:<60} {:5.1} %", percent(n));
    }
    Ok(())
}
