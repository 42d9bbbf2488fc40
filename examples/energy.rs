//! Looks for a vehicle whose simulation gains energy although nothing pushes it.
//!
//! Vehicles, states and impacts are drawn at random, each motion is simulated with the 4DOF model, and
//! the energy after the end of the force is followed: kinetic energy and potential of roll. A gain is
//! the largest rise above an earlier value, as a share of the energy at the end of the force.
//!
//! Half of the vehicles are drawn over all the ranges that a vehicle file may hold, each value by
//! itself, so that most of them are no vehicle; the other half are vehicles that come with the program
//! with each value changed by a factor of up to three.
//!
//! The arguments are the number of runs, the seed, and the duration of each motion, s:
//!
//! `cargo run --release --example energy -- 100000 0 4`

#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use impactlab_core::data::{Channel, ForceAxes, ForceHistory, Sampling, TimeSeries};
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Integrator, Manoeuvre, Preset, VehicleParameters, VehicleState,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Gains that are counted, as shares of the energy at the end of the force.
const COUNTED_SHARES: [f64; 3] = [1e-3, 0.01, 0.05];
/// Duration of a drawn force, s.
const FORCE_S: f64 = 0.1;
/// Number of runs with the largest gains that are listed.
const N_LISTED: usize = 8;

/// What became of a run.
enum Outcome {
    /// The vehicle file is refused.
    VehicleRefused(String),
    /// The simulation is refused.
    SimulationRefused(String),
    /// The largest gain of energy, as a share, and the vehicle with its start.
    Simulated(f64, Box<(VehicleParameters, VehicleState<f64>)>),
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [n_runs, seed, duration_s] = &arguments[..] else {
        return Err("expected: RUNS SEED DURATION".into());
    };
    let (n_runs, seed, duration_s): (u64, u64, f64) =
        (n_runs.parse()?, seed.parse()?, duration_s.parse()?);
    for (title, draw) in [
        ("every value over its whole range", draw_anything as fn(&mut ChaCha8Rng) -> String),
        ("around the vehicles of the program", draw_around_presets),
    ] {
        let run = |i: u64| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(i);
            outcome(&mut rng, draw, duration_s)
        };
        let outcomes: Vec<Outcome> = (0..n_runs / 2).into_par_iter().map(run).collect();
        report(title, &outcomes);
    }
    Ok(())
}

fn report(title: &str, outcomes: &[Outcome]) {
    let mut refused: BTreeMap<String, usize> = BTreeMap::new();
    let mut gains = Vec::new();
    for outcome in outcomes {
        match outcome {
            Outcome::VehicleRefused(why) => {
                *refused.entry(format!("vehicle: {why}")).or_default() += 1;
            }
            Outcome::SimulationRefused(why) => {
                *refused.entry(format!("simulation: {why}")).or_default() += 1;
            }
            Outcome::Simulated(gain, run) => gains.push((*gain, run)),
        }
    }
    println!("{title}: {} runs, {} simulated", outcomes.len(), gains.len());
    for (why, n) in refused {
        println!("  refused {n}: {why}");
    }
    for share in COUNTED_SHARES {
        let n = gains.iter().filter(|(gain, _)| gain.is_nan() || *gain > share).count();
        println!("  energy gained by more than {} %: {n}", share * 100.0);
    }
    gains.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    for (gain, run) in gains.iter().take(N_LISTED) {
        println!("  {:.2e} {}", gain, shape(run));
    }
}

/// The numbers of a vehicle that stability depends on, and its start.
fn shape((vehicle, start): &(VehicleParameters, VehicleState<f64>)) -> String {
    let (mass, geometry, suspension) = (&vehicle.mass, &vehicle.geometry, &vehicle.suspension);
    let arms = geometry.cg_to_front_axle_m * geometry.cg_to_rear_axle_m;
    format!(
        "m {:.0} I/(m l_f l_r) {:.2e} l_f {:.2} l_r {:.2} w {:.2} c {:.0} {:.0} mu {:.2} f {:.2e} roll rate {:.1e} damping rate {:.1e} lean {:.2} h {:.2} coupling {:.2} v {:.1} {:.1} r {:.2}",
        mass.mass_kg,
        mass.yaw_inertia_kg_m2 / (mass.mass_kg * arms),
        geometry.cg_to_front_axle_m,
        geometry.cg_to_rear_axle_m,
        geometry.track_width_m,
        vehicle.tires.cornering_coefficient_front_per_rad,
        vehicle.tires.cornering_coefficient_rear_per_rad,
        vehicle.tires.friction,
        vehicle.tires.rolling_resistance,
        (suspension.roll_stiffness_n_m_rad / mass.roll_inertia_kg_m2).sqrt(),
        suspension.roll_damping_n_m_s_rad / mass.roll_inertia_kg_m2,
        mass.sprung_mass_kg * 9.81 * suspension.roll_arm_m / suspension.roll_stiffness_n_m_rad,
        suspension.roll_arm_m,
        mass.roll_yaw_product_kg_m2 / (mass.yaw_inertia_kg_m2 * mass.roll_inertia_kg_m2).sqrt(),
        start.vx_body_m_s,
        start.vy_body_m_s,
        start.yaw_rate_rad_s,
    )
}

fn outcome(rng: &mut ChaCha8Rng, draw: fn(&mut ChaCha8Rng) -> String, duration_s: f64) -> Outcome {
    let text = draw(rng);
    let vehicle = match VehicleParameters::parse(&text, Path::new("drawn.toml")) {
        Ok(vehicle) => vehicle,
        Err(error) => return Outcome::VehicleRefused(without_numbers(&error.to_string())),
    };
    let (manoeuvre, released_s) = draw_manoeuvre(rng, &vehicle, duration_s);
    match vehicle.simulate(&manoeuvre, Integrator::Rk4) {
        Ok(motion) => {
            let gain = gain(&vehicle, &motion.series, released_s);
            Outcome::Simulated(gain, Box::new((vehicle, manoeuvre.initial)))
        }
        Err(error) => Outcome::SimulationRefused(without_numbers(&error.to_string())),
    }
}

/// A message without its numbers, so that equal reasons are counted together.
fn without_numbers(message: &str) -> String {
    let is_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let words = message.split_whitespace().filter(|word| !word.chars().any(is_number));
    words.collect::<Vec<_>>().join(" ")
}

/// Largest rise of the energy after the force, as a share of the energy at its end.
fn gain(vehicle: &VehicleParameters, motion: &TimeSeries, released_s: f64) -> f64 {
    let column = |channel| motion.get(channel).unwrap_or_default();
    let [vx, vy, yaw_rate, roll, roll_rate] =
        [Channel::Vx, Channel::Vy, Channel::YawRate, Channel::Roll, Channel::RollRate].map(column);
    let energies = motion.time_s().iter().enumerate().filter(|(_, time)| **time >= released_s);
    let mut energies = energies.map(|(i, _)| {
        vehicle.energy_j(&VehicleState {
            vx_body_m_s: vx[i],
            vy_body_m_s: vy[i],
            yaw_rate_rad_s: yaw_rate[i],
            roll_rad: roll[i],
            roll_rate_rad_s: roll_rate[i],
            ..VehicleState::default()
        })
    });
    let Some(first) = energies.next() else { return 0.0 };
    let (mut lowest, mut gain) = (first, 0.0_f64);
    for energy in energies {
        gain = gain.max((energy - lowest) / first);
        lowest = lowest.min(energy);
    }
    gain
}

/// A start and, in half of the runs, a force; and when the force has ended, s.
fn draw_manoeuvre(
    rng: &mut ChaCha8Rng,
    vehicle: &VehicleParameters,
    duration_s: f64,
) -> (Manoeuvre, f64) {
    let speed_m_s = log_uniform(rng, [0.1, 60.0]);
    let (sin, cos) = rng.random_range(-3.2..3.2_f64).sin_cos();
    let initial = VehicleState {
        vx_body_m_s: speed_m_s * cos,
        vy_body_m_s: speed_m_s * sin,
        yaw_rate_rad_s: rng.random_range(-6.0..6.0),
        ..VehicleState::default()
    };
    let is_struck = rng.random_bool(0.5);
    let contact_load = is_struck.then(|| draw_load(rng, vehicle));
    let released_s = if is_struck { FORCE_S } else { 0.0 };
    (Manoeuvre { initial, contact_load, duration_s, ..Manoeuvre::default() }, released_s)
}

fn draw_load(rng: &mut ChaCha8Rng, vehicle: &VehicleParameters) -> ContactLoad {
    let delta_v_m_s = log_uniform(rng, [0.1, 20.0]);
    let (sin, cos) = rng.random_range(-3.2..3.2_f64).sin_cos();
    let peak_n = vehicle.mass.mass_kg * delta_v_m_s * 2.0 / FORCE_S;
    let geometry = &vehicle.geometry;
    let (half_length, half_width) = (geometry.outer_length_m / 2.0, geometry.outer_width_m / 2.0);
    ContactLoad {
        force: ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::Instant,
            time_s: vec![0.0, FORCE_S / 2.0, FORCE_S],
            fx_n: vec![0.0, peak_n * cos, 0.0],
            fy_n: vec![0.0, peak_n * sin, 0.0],
            mz_n_m: None,
        },
        contact: ContactPoint {
            x_body_m: rng.random_range(-half_length..half_length),
            y_body_m: rng.random_range(-half_width..half_width),
            height_m: rng.random_range(0.1..1.0) * geometry.cg_height_m * 2.0,
        },
        recorded_moment: false,
    }
}

fn log_uniform(rng: &mut ChaCha8Rng, [low, high]: [f64; 2]) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}

/// A vehicle file whose values are drawn over their whole ranges.
fn draw_anything(rng: &mut ChaCha8Rng) -> String {
    let mut log = |low, high| log_uniform(rng, [low, high]);
    let mass_kg = log(1.0, 50_000.0);
    let (yaw_inertia, roll_inertia) = (log(1e-3, 1e6), log(1e-3, 1e5));
    let (stiffness, damping) = (log(1.0, 1e7), log(1e-3, 1e6));
    let (front, rear, track) = (log(0.05, 10.0), log(0.05, 10.0), log(0.05, 4.0));
    let (length, width) = (log(0.1, 25.0), log(0.05, 4.0));
    let (c_front, c_rear) = (log(1.0, 60.0), log(1.0, 60.0));
    let (friction, resistance) = (log(0.01, 2.0), log(1e-4, 0.5));
    let (resistance_1, resistance_2) = (log(1e-6, 0.01), log(1e-7, 0.001));
    let mut share = || rng.random_range(0.0..1.0_f64);
    let sprung_kg = 0.5 + share() * (mass_kg - 0.5);
    let coupling = (yaw_inertia * roll_inertia).sqrt() * 0.95 * (2.0 * share() - 1.0);
    format!(
        "name = \"drawn\"\nsource = \"drawn\"\n\
         [mass]\nmass_kg = {mass_kg:?}\nsprung_mass_kg = {sprung_kg:?}\n\
         yaw_inertia_kg_m2 = {yaw_inertia:?}\nroll_inertia_kg_m2 = {roll_inertia:?}\n\
         roll_yaw_product_kg_m2 = {coupling:?}\n\
         [geometry]\ncg_to_front_axle_m = {front:?}\ncg_to_rear_axle_m = {rear:?}\n\
         track_width_m = {track:?}\ncg_height_m = {:?}\nouter_length_m = {length:?}\n\
         outer_width_m = {width:?}\ncg_to_front_end_m = {:?}\n\
         [suspension]\nroll_axis_height_m = {:?}\nroll_arm_m = {:?}\n\
         roll_stiffness_n_m_rad = {stiffness:?}\nroll_damping_n_m_s_rad = {damping:?}\n\
         front_roll_stiffness_share = {:?}\n\
         [tires]\ncornering_coefficient_front_per_rad = {c_front:?}\n\
         cornering_coefficient_rear_per_rad = {c_rear:?}\nfriction = {friction:?}\n\
         sliding_friction_ratio = {:?}\nrolling_resistance = {resistance:?}\n\
         rolling_resistance_s_m = {resistance_1:?}\n\
         rolling_resistance_s2_m2 = {resistance_2:?}\n",
        0.01 + 2.99 * share(),
        length * share(),
        -1.0 + 3.0 * share(),
        3.0 * share(),
        share(),
        0.1 + 0.9 * share(),
    )
}

/// A vehicle of the program with every number changed by a factor of up to three; what is a part of
/// another value goes with it.
fn draw_around_presets(rng: &mut ChaCha8Rng) -> String {
    let preset = Preset::ALL[rng.random_range(0..Preset::ALL.len())];
    let mut factors: BTreeMap<String, f64> = BTreeMap::new();
    let mut text = String::new();
    for line in preset.text().lines() {
        match line.split_once(" = ").and_then(|(key, value)| Some((key, value.parse().ok()?))) {
            Some((key, value)) => {
                let value: f64 = value;
                let (whole, largest) = match key {
                    "sprung_mass_kg" => ("mass_kg", f64::INFINITY),
                    "cg_to_front_end_m" => ("outer_length_m", f64::INFINITY),
                    "front_roll_stiffness_share" | "sliding_friction_ratio" => (key, 1.0),
                    "friction" => (key, 2.0),
                    _ => (key, f64::INFINITY),
                };
                let drawn = log_uniform(rng, [1.0 / 3.0, 3.0]);
                let factor = factors.get(whole).copied().unwrap_or(drawn);
                factors.insert(key.to_owned(), factor);
                text.push_str(&format!("{key} = {:?}\n", (value * factor).min(largest)));
            }
            None => text.push_str(&format!("{line}\n")),
        }
    }
    text
}
