//! A log of a test drive tells the network of a car that it does not know, and the bands narrow.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Network, Pane, Subject, TrainingMode};
use impactlab_core::data::{Channel, ForceAxes, ForceHistory, Sampling};
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Integrator, Manoeuvre, VehicleState, built_in_vehicle,
};
use impactlab_study::VehicleChoice;

use crate::harness::{apply, is_forecast, open_with, step_until};
use crate::pictures::save;

/// A car of the library, of which the network knows no motion.
const CAR: &str = "toyota-camry-2018";
const CONTACT: ContactPoint = ContactPoint { x_body_m: -1.6, y_body_m: -0.92, height_m: 0.52 };

/// Writes the motion of the car after a push to the left, with the force or in a file apart.
///
/// - `noise`: standard deviations of position, m, and yaw, rad.
/// - returns position X of the last sample, m.
fn write_drive(
    (motion, force_file): (&Path, Option<&Path>),
    (speed_m_s, peak_n): (f64, f64),
    noise: [f64; 2],
) -> f64 {
    // Tires and road are not those that the rules for data sheets assume.
    let mut car = built_in_vehicle(CAR).expect("a car of the library");
    car.tires.cornering_coefficient_front_per_rad *= 1.15;
    car.tires.cornering_coefficient_rear_per_rad *= 1.3;
    car.tires.friction = 0.86;
    let time_s: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.01).collect();
    let push = |t: &f64| peak_n * (std::f64::consts::PI * t / 0.08).sin().max(0.0);
    let fy_n: Vec<f64> = time_s.iter().map(|t| if *t < 0.08 { push(t) } else { 0.0 }).collect();
    let force = ForceHistory {
        axes: ForceAxes::Body,
        sampling: Sampling::Instant,
        time_s: time_s.clone(),
        fx_n: fy_n.iter().map(|f| 0.2 * f).collect(),
        fy_n,
        mz_n_m: None,
    };
    let load = ContactLoad { force: force.clone(), contact: CONTACT, recorded_moment: false };
    let manoeuvre = Manoeuvre {
        initial: VehicleState::driving_straight(speed_m_s),
        contact_load: Some(load),
        duration_s: 4.0,
        ..Manoeuvre::default()
    };
    let series = car.simulate(&manoeuvre, Integrator::Rk4).expect("a motion").series;
    let of = |channel| series.require(channel).expect("a channel").to_vec();
    let [x, y, yaw] = [Channel::X, Channel::Y, Channel::Yaw].map(of);
    let [vx, vy, rate] = [Channel::Vx, Channel::Vy, Channel::YawRate].map(of);
    let mut text = match force_file {
        Some(_) => "time_s,x_m,y_m,yaw_rad,yaw_rate_rad_s\n".to_owned(),
        None => {
            "time_s,x_m,y_m,yaw_rad,vx_m_s,vy_m_s,yaw_rate_rad_s,fx_body_n,fy_body_n\n".to_owned()
        }
    };
    let mut forces = "time_s,fx_body_n,fy_body_n\n".to_owned();
    for (i, t) in time_s.iter().enumerate() {
        // Noise without a generator: angles that do not repeat.
        let jitter = |k: f64| std::f64::consts::SQRT_2 * (k * (i * i + 7 * i) as f64).sin();
        let [dx, dy] = [1.7, 2.3].map(|k| noise[0] * jitter(k));
        let turn = noise[1] * jitter(3.1);
        let (fx, fy) = (force.fx_n[i], force.fy_n[i]);
        let row = [x[i] + dx, y[i] + dy, yaw[i] + turn];
        write!(text, "{t},{},{},{}", row[0], row[1], row[2]).expect("text");
        match force_file {
            Some(_) => writeln!(text, ",{}", rate[i] + 2.0 * turn),
            None => writeln!(text, ",{},{},{},{fx},{fy}", vx[i], vy[i], rate[i]),
        }
        .expect("text");
        writeln!(forces, "{t},{fx},{fy}").expect("text");
    }
    std::fs::write(motion, text).expect("a file");
    if let Some(path) = force_file {
        std::fs::write(path, forces).expect("a file");
    }
    *x.last().expect("a sample")
}

/// Ends of the 90 % interval of X at the end of the forecast, m.
fn interval_m(harness: &Harness<'_, App>) -> [f64; 2] {
    let forecast = harness.state().state().motion_forecast().expect("a forecast");
    forecast.answer.report.outcome.x_m.ninety()
}

#[test]
fn a_log_narrows_the_bands_of_a_car_that_the_network_does_not_know() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    let (log, log_force, other) = (path("drive.csv"), path("drive_force.csv"), path("other.csv"));
    write_drive((&log, Some(&log_force)), (15.0, 60e3), [0.02, 0.003]);
    let x_m = write_drive((&other, None), (18.0, 65e3), [0.0; 2]);

    let open: Vec<&str> = [&other, &log, &log_force].map(|path| path.to_str().unwrap()).into();
    let mut harness = open_with(&open, Some(path("state.json")));
    step_until(&mut harness, "the files", |state| {
        state.session.sources.iter().all(impactlab::app::Source::is_settled)
    });
    let project = &mut harness.state_mut().state_mut().project;
    project.simulate.vehicle = VehicleChoice::Preset(CAR.to_owned());
    project.start_mut().contact = Some(CONTACT);
    apply(&mut harness, Command::Select(Subject::File(other)));
    step_until(&mut harness, "the forecast", is_forecast);
    let before = interval_m(&harness);

    apply(&mut harness, Command::ShowTraining(Network::Response));
    let form = &mut harness.state_mut().state_mut().project.networks;
    form.mode = TrainingMode::Condition;
    harness.run_steps(3);
    harness.get_by_label("Log").click();
    harness.run_steps(3);
    harness.get_by_label("drive.csv").click();
    harness.run_steps(3);
    let form = &mut harness.state_mut().state_mut().project.networks;
    assert_eq!(form.log.as_deref(), Some(log.as_path()));
    form.log_force = Some(log_force);
    harness.run_steps(3);
    save(&mut harness, "conditioning.png");
    harness.get_by_label("Train").click();
    harness.run_steps(2);
    step_until(&mut harness, "the network that knows the car", |state| {
        !state.session.response.training.run.is_running()
            && state.session.response.model.current.as_ref().is_some_and(|of| !of.is_saved)
    });
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    step_until(&mut harness, "the forecast of the network that knows the car", is_forecast);
    let after = interval_m(&harness);
    save(&mut harness, "conditioned.png");
    let width = |ends: [f64; 2]| ends[1] - ends[0];
    assert!(width(after) < 0.85 * width(before), "{before:?} {after:?}");
    for ends in [before, after] {
        assert!((ends[0]..=ends[1]).contains(&x_m), "{x_m} in {ends:?}");
    }
}
