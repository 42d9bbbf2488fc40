//! Measures what the response network learns from one log of 100 samples of a scaled vehicle about
//! the next impacts of the same vehicle. It prints a Markdown table.
//!
//! The vehicle is simulated. It is the 1:4 scaled target, whose friction, yaw inertia and cornering
//! coefficients differ from those of its data sheet. Its log has noise that is typical of a
//! satellite receiver and an inertial sensor. The logs and the forces are kept in the folder of
//! `--out`.
//!
//! `cargo run --release --example scaled_log -- --out scaled-logs --vehicles
//! 5`

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Parser;
use impactlab_core::collision::{Pulse, PulseShape};
use impactlab_core::data::{Channel, Existing, ForceAxes, TimeSeries, write_series_csv};
use impactlab_core::numerics::median;
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Integrator, Manoeuvre, Preset, VehicleParameters, VehicleState,
};
use impactlab_networks::learning::{ModelFile, TrainSettings, TrainingSet};
use impactlab_networks::response::{
    LogSettings, LoggedImpact, MotionLog, N_RESIDUAL, ResponseCase, ResponseConfig, ResponseModel,
    STEP_S, Tuning, average_error_m, fine_tune, rollout,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

type Answer<T> = Result<T, Box<dyn Error>>;

/// Time of the first contact on the clock of a log, s.
const CONTACT_S: f64 = 0.2;
/// Channels of a log and the standard deviation of their noise: x and y in m, yaw in rad, yaw rate
/// in rad/s, v_x and v_y in m/s.
const NOISE: [(&[Channel], f64); 4] = [
    (&[Channel::X, Channel::Y], 0.02),
    (&[Channel::Yaw], 0.008_727),
    (&[Channel::YawRate], 0.017_453),
    (&[Channel::Vx, Channel::Vy], 0.05),
];
/// The two kinds of logs, without and with velocities: the name in the table, and the number of
/// entries of [`NOISE`] that the log contains.
const N_CHANNELS: [(&str, usize); 2] = [("pose, yaw rate", 3), ("and velocity", 4)];
/// Number of samples of a log, the same as in the paper's fine-tuning.
const N_SAMPLES: usize = 100;
/// Number of impacts to predict with each vehicle, of 4 s each.
const N_NEXT: usize = 8;

#[derive(Parser)]
struct Arguments {
    /// Where logs and forces go
    #[arg(long, default_value = "scaled-logs")]
    out: PathBuf,
    /// How many vehicles, by the seeds 0, 1, …
    #[arg(long, default_value_t = 3)]
    vehicles: u64,
    /// The pre-trained network
    #[arg(long, default_value = "assets/models/response_pretrained.safetensors")]
    model: PathBuf,
    /// Settings (TOML) instead of the model's own
    #[arg(long)]
    config: Option<PathBuf>,
}

/// A row of the table: a model, and its average errors over the next impacts of all vehicles, m.
struct Row {
    name: String,
    errors_m: Vec<f64>,
}

impl Row {
    fn print(&self) {
        let mean = self.errors_m.iter().sum::<f64>() / self.errors_m.len().max(1) as f64;
        let median = median(self.errors_m.iter().copied()).unwrap_or(f64::NAN);
        let largest = self.errors_m.iter().copied().fold(f64::NAN, f64::max);
        println!("| {} | {mean:.3} | {median:.3} | {largest:.2} |", self.name);
    }
}

/// Draws the parameters of the simulated vehicle, which differ from its data sheet.
fn true_vehicle(rng: &mut ChaCha8Rng) -> VehicleParameters {
    let mut vehicle = Preset::ScaledStruck.parameters();
    vehicle.mass.yaw_inertia_kg_m2 *= rng.random_range(0.85..1.2);
    vehicle.tires.friction *= rng.random_range(0.7..1.0);
    vehicle.tires.cornering_coefficient_front_per_rad *= rng.random_range(0.8..1.2);
    vehicle.tires.cornering_coefficient_rear_per_rad *= rng.random_range(0.8..1.2);
    vehicle
}

/// Draws the speed before the impact, m/s, and the contact load of a push against a rear quarter: a
/// half-sine pulse with its yaw moment `x F_y − y F_x` about the CG.
fn impact(rng: &mut ChaCha8Rng) -> Answer<(f64, ContactLoad)> {
    let side: f64 = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let impulse = [rng.random_range(-10.0..30.0), side * rng.random_range(50.0..130.0)];
    let duration_s = rng.random_range(0.07..0.13);
    let pulse = Pulse::new(PulseShape::HalfSine, impulse, CONTACT_S, duration_s)?;
    let x_body_m = -rng.random_range(0.55..0.75);
    let contact = ContactPoint { x_body_m, y_body_m: -0.4 * side, height_m: 0.126 };
    let mut force = pulse.to_history(1e-3)?;
    // The vehicle hardly turns during the contact, so that the body axes are taken to be those of
    // the pulse.
    force.axes = ForceAxes::Body;
    let moment = |(fx, fy): (&f64, &f64)| contact.x_body_m * fy - contact.y_body_m * fx;
    force.mz_n_m = Some(force.fx_n.iter().zip(&force.fy_n).map(moment).collect());
    let load = ContactLoad { force, contact, recorded_moment: true };
    Ok((rng.random_range(4.0..8.0), load))
}

/// Simulates the vehicle from straight driving at a speed, struck by a load, for `duration_s`
/// seconds.
fn drive(
    vehicle: &VehicleParameters,
    (speed_m_s, load): &(f64, ContactLoad),
    duration_s: f64,
) -> Answer<TimeSeries> {
    let initial = VehicleState::driving_straight(*speed_m_s);
    let contact_load = Some(load.clone());
    let manoeuvre = Manoeuvre { initial, contact_load, duration_s, ..Manoeuvre::default() };
    Ok(vehicle.simulate(&manoeuvre, Integrator::Rk4)?.series)
}

/// Takes every `stride`-th sample of a motion, at most [`N_SAMPLES`], and adds noise.
///
/// - `n_kinds`: number of entries of [`NOISE`] that the log contains.
fn log(motion: &TimeSeries, stride: usize, n_kinds: usize, seed: u64) -> Answer<TimeSeries> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let time_s = motion.time_s().iter().copied().step_by(stride).take(N_SAMPLES).collect();
    let mut series = TimeSeries::new(time_s)?;
    for (channels, std) in NOISE.into_iter().take(n_kinds) {
        for channel in channels {
            let exact = motion.require(*channel)?.iter().step_by(stride).take(N_SAMPLES);
            let noisy = exact.map(|value| value + std * rng.sample::<f64, _>(StandardNormal));
            series.insert(*channel, noisy.collect())?;
        }
    }
    Ok(series)
}

/// Simulates another impact of the vehicle without noise, from the first contact on. The case has
/// the vehicle of the data sheet, since a prediction does not know the true one.
fn next_case(truth: &VehicleParameters, rng: &mut ChaCha8Rng) -> Answer<ResponseCase> {
    let (speed_m_s, mut load) = impact(rng)?;
    load.force.time_s.iter_mut().for_each(|time_s| *time_s -= CONTACT_S);
    let initial = VehicleState::driving_straight(speed_m_s);
    let manoeuvre =
        Manoeuvre { initial, contact_load: Some(load), duration_s: 4.0, ..Manoeuvre::default() };
    let inputs = manoeuvre.inputs(STEP_S, 400);
    let states = rollout(truth, initial, &inputs, [0.0; N_RESIDUAL]);
    let data_sheet = Preset::ScaledStruck.parameters();
    Ok(ResponseCase::from_motion("next".to_owned(), data_sheet, states, inputs))
}

/// Returns the average position error of a network on each case, m.
fn errors_of_model(model: &ResponseModel, cases: &[ResponseCase]) -> Answer<Vec<f64>> {
    let of = |case: &ResponseCase| {
        let path = model.predictor(&case.vehicle)?.central_path(&case.states[0], &case.inputs);
        Ok(average_error_m(&path, &case.states))
    };
    cases.iter().map(of).collect()
}

/// Returns the average position error of the tuned 4DOF model on each case, m.
fn errors_of_tuning(tuning: &Tuning, cases: &[ResponseCase]) -> Vec<f64> {
    let of = |case: &ResponseCase| {
        let vehicle = tuning.apply(&case.vehicle);
        let path = rollout(&vehicle, case.states[0], &case.inputs, [0.0; N_RESIDUAL]);
        average_error_m(&path, &case.states)
    };
    cases.iter().map(of).collect()
}

/// Appends errors to the row of this name, which is added if it is not there.
fn add(rows: &mut Vec<Row>, name: String, errors_m: Vec<f64>) {
    match rows.iter_mut().find(|row| row.name == name) {
        Some(row) => row.errors_m.extend(errors_m),
        None => rows.push(Row { name, errors_m }),
    }
}

/// Tunes the 4DOF model and fine-tunes the network on one log, and adds the errors of both on the
/// next impacts.
///
/// - `name`, `found`: name of the row, and the impact found in the log;
/// - `start`, `config`, `seed`: pre-trained network, settings and seed of the fine-tuning;
/// - `next`: impacts to predict.
fn add_log(
    rows: &mut Vec<Row>,
    (name, found): (&str, LoggedImpact),
    (start, config, seed): (&ResponseModel, &ResponseConfig, u64),
    next: &[ResponseCase],
) -> Answer<()> {
    let go_on = &mut |_, _| ControlFlow::Continue(());
    let tuning = Tuning::fit(&[&found.case], config.tuning, seed, go_on);
    add(rows, format!("4DOF tuned: {name}"), errors_of_tuning(&tuning, next));
    let train = vec![found.case];
    let set = TrainingSet { name: name.to_owned(), train, test: Vec::new() };
    let settings = TrainSettings::unsaved(config.clone(), seed);
    let model = fine_tune(Some(start), &set, &settings, &mut |_| ControlFlow::Continue(()))?;
    add(rows, format!("fine-tuned: {name}"), errors_of_model(&model, next)?);
    Ok(())
}

fn write(folder: &Path, name: &str, series: &TimeSeries) -> Answer<()> {
    std::fs::create_dir_all(folder)?;
    Ok(write_series_csv(&folder.join(name), Existing::Replace, series)?)
}

fn main() -> Answer<()> {
    let arguments = Arguments::parse();
    let start = ResponseModel::load(&arguments.model)?;
    let config = match &arguments.config {
        Some(path) => ResponseConfig::load(path)?,
        None => {
            let config = start.config().clone();
            ResponseConfig { effects: config.effects.few_samples(), ..config }
        }
    };
    let mut rows = Vec::new();
    for seed in 0..arguments.vehicles {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = true_vehicle(&mut rng);
        let struck = impact(&mut rng)?;
        let motion = drive(&truth, &struck, 4.0)?;
        let next: Vec<ResponseCase> =
            (0..N_NEXT).map(|_| next_case(&truth, &mut rng)).collect::<Result<_, _>>()?;
        add(&mut rows, "4DOF untuned".to_owned(), errors_of_tuning(&Tuning::default(), &next));
        add(&mut rows, "pre-trained".to_owned(), errors_of_model(&start, &next)?);
        write(&arguments.out, &format!("force_{seed}.csv"), &struck.1.force.to_series()?)?;
        for (hz, stride) in [(100, 1), (25, 4)] {
            for (channels, n_kinds) in N_CHANNELS {
                let series = log(&motion, stride, n_kinds, seed)?;
                let name = format!("log_{seed}_{hz}hz_{n_kinds}.csv");
                write(&arguments.out, &name, &series)?;
                let log = MotionLog { path: arguments.out.join(name), series };
                let vehicle = Preset::ScaledStruck.parameters();
                let settings =
                    LogSettings { vehicle, has_impact: true, impact_s: None, duration_s: 4.0 };
                for (of, load) in [("measured", Some(struck.1.clone())), ("estimated", None)] {
                    let name = format!("{hz} Hz, {channels}, force {of}");
                    let found = LoggedImpact::from_log(&log, load, &settings)?;
                    add_log(&mut rows, (&name, found), (&start, &config, seed), &next)?;
                }
            }
        }
        eprintln!("vehicle {seed}");
    }
    println!("| | mean [m] | median [m] | largest [m] |\n| --- | --- | --- | --- |");
    rows.iter().for_each(Row::print);
    Ok(())
}
