use std::ops::ControlFlow;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use super::*;
use crate::evidence::examples::read;
use crate::sampler::{Particles, SamplerSettings, sample, standard_normals};
use crate::{
    CollisionMotion, Discrepancy, ForwardModel, HandCheck, HandSpeed, HingeInput, Posterior, Prior,
    ReconstructedQuantity, ReconstructionTarget,
};
use impactlab_core::numerics::{quantile_of_sorted, random_stream};
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{PathEnd, TireMark, Wheel};

/// A car that skids straight to a stop with locked wheels, on a road whose drag factor is known.
const SKID: &str = r#"
case = "skid"
kind = "single_car"
[road]
drag_factor = 0.7
drag_factor_sigma = 0.01
[car]
mass_kg = 1500
[start]
x_m = 0
y_m = 0
position_sigma_m = 0.05
heading_deg = 0
[rest]
x_m = 40
y_m = 0
position_sigma_m = 0.05
heading_deg = 0
[wheels]
blocked_wheels = ["FL", "FR", "RL", "RR"]
"#;

/// The form of cars that come to rest from a known place, with their marks.
const CASES: &str = r#"
case = "simulated"
kind = "single_car"
[road]
friction = 0.7
friction_sigma = 0.05
[car]
mass_kg = 1500
[start]
x_m = 0
y_m = 0
position_sigma_m = 0.2
heading_deg = 0
heading_sigma_deg = 2
speed_m_s = [8, 35]
[rest]
x_m = 80
y_m = 0
heading_deg = 0
"#;

fn target(evidence: &Evidence) -> ReconstructionTarget {
    let cars = Cars::new(evidence, None, None);
    let model = ForwardModel::new(evidence, cars);
    ReconstructionTarget::new(evidence.clone(), model, Discrepancy::default())
}

fn sampled(target: &ReconstructionTarget, n_particles: usize, seed: u64) -> Particles {
    let max_evaluations = 100 * n_particles;
    let least_ess = n_particles as f64;
    let settings = SamplerSettings { n_particles, seed, least_ess, max_evaluations };
    sample(target, &settings, None, &mut |_| ControlFlow::Continue(())).unwrap()
}

#[test]
fn a_straight_skid_with_locked_wheels_has_the_speed_of_its_energy() {
    let evidence = read(SKID);
    let target = target(&evidence);
    let expected_m_s = (2.0 * 0.7 * STANDARD_GRAVITY_M_S2 * 40.0_f64).sqrt();
    for seed in [0, 1] {
        let particles = sampled(&target, 200, seed);
        let posterior = Posterior::new(&target, &particles);
        let quantities = posterior.quantities();
        let names: Vec<&str> = quantities.iter().map(|of| of.name).collect();
        assert_eq!(names, ["speed_m_s", "sideslip_rad", "yaw_rate_rad_s", "road_friction"]);
        let median_m_s = quantities[0].estimate.median;
        let off = median_m_s / expected_m_s - 1.0;
        assert!(off.abs() < 0.02, "seed {seed}: {median_m_s} m/s, expected {expected_m_s} m/s");
        let [low, high] = quantities[0].estimate.ninety();
        assert!(low < expected_m_s && expected_m_s < high && high - low < 3.0, "{low} {high}");
        let hinges = posterior.hinges();
        assert!(hinges.iter().all(|hinge| hinge.striking_speed.is_none()), "{hinges:?}");
        // dv = v dμ / (2 μ): the drag factor moves the speed, whatever road and tires make of it.
        let drag = hinges.iter().find(|hinge| hinge.input == HingeInput::LockedDrag).unwrap();
        let expected_change_m_s = 0.1 * expected_m_s / (2.0 * 0.7);
        let change = drag.struck_speed.change_m_s / expected_change_m_s;
        assert!((0.7..1.3).contains(&change), "seed {seed}: {change} of {expected_change_m_s}");
        let measured: Vec<&str> = posterior.budget(0).iter().map(|item| item.known).collect();
        let expected = ["road_friction", "tire_friction_factor", "speed_m_s"];
        assert_eq!(measured, expected, "what is fixed is not measured");
    }
    let by_hand = HandCheck::all(&evidence, target.model().cars(), &[]);
    let [check] = &by_hand[..] else { panic!("{by_hand:?}") };
    assert_eq!(check.speed, HandSpeed::AtStart);
    assert!((check.value_m_s - expected_m_s).abs() < 1e-9, "{check:?}");
}

/// Wheels that slide hold the car back by less than wheels near the peak, so that a car that stopped over the
/// same distance was slower. Of what nobody says, each is drawn with one half.
#[test]
fn a_car_with_anti_lock_brakes_was_faster_than_one_whose_wheels_slid() {
    let skid = |anti_lock: &str| {
        let wheels = format!("driver_braked = \"yes\"\n{anti_lock}");
        let start = "heading_deg = 0\nbrake_start_s = [0, 0.05]\nbrake_share = [1.5, 2]\n";
        let evidence = SKID
            .replace("drag_factor", "friction")
            .replace("blocked_wheels = [\"FL\", \"FR\", \"RL\", \"RR\"]", &wheels)
            .replacen("heading_deg = 0\n", start, 1);
        read(&evidence)
    };
    let speed_m_s = |anti_lock: &str| {
        let target = target(&skid(anti_lock));
        let posterior = Posterior::new(&target, &sampled(&target, 120, 0));
        posterior.quantities()[0].estimate.clone()
    };
    let [unknown, slid, held] = ["", "anti_lock = \"no\"", "anti_lock = \"yes\""].map(speed_m_s);
    // 0.95 of the peak against some 0.8 of it: √(0.95/0.8) is 1.09.
    let ratio = held.median / slid.median;
    assert!((1.03..1.2).contains(&ratio), "{} with it, {} without", held.median, slid.median);
    let [low, high] = unknown.ninety();
    assert!(low < slid.median && held.median < high, "{low} to {high} m/s holds both");
    let said = skid("anti_lock = \"yes\"");
    assert_eq!(read(&said.to_toml()), said);
}

/// Braking that left no marks took speed away before them: g times its share of the friction, with the grade,
/// times its duration.
#[test]
fn braking_before_the_start_tells_the_speed_at_which_it_began() {
    let skid = |start: &str, grade: &str| {
        let friction = format!("friction_sigma = 0.01\n{grade}");
        let text = SKID
            .replace("drag_factor", "friction")
            .replace("friction_sigma = 0.01\n", &friction)
            .replacen("heading_deg = 0\n", &format!("heading_deg = 0\n{start}"), 1);
        read(&text)
    };
    let gained_m_s = |grade: &str| {
        let before = "braked_before_s = [0.6, 0.62]\nbraked_before_share = [0.5, 0.51]\n";
        let target = target(&skid(before, grade));
        let posterior = Posterior::new(&target, &sampled(&target, 120, 0));
        let quantities = posterior.quantities();
        let names: Vec<&str> = quantities.iter().map(|of| of.name).collect();
        assert_eq!(names[4..], ["speed_before_braking_m_s"]);
        let medians = [0, 4].map(|at| quantities[at].estimate.median);
        medians[1] - medians[0]
    };
    // Tires of cars and of a friction test differ, and so do those along and across.
    let level_m_s = STANDARD_GRAVITY_M_S2 * 0.505 * 0.7 * 0.61;
    let gained_level_m_s = gained_m_s("");
    assert!((gained_level_m_s / level_m_s - 1.0).abs() < 0.3, "{gained_level_m_s} m/s");
    let uphill_m_s = gained_m_s("grade = 0.1\n") - gained_level_m_s;
    let expected_m_s = STANDARD_GRAVITY_M_S2 * 0.1 * 0.61;
    assert!((uphill_m_s / expected_m_s - 1.0).abs() < 0.3, "{uphill_m_s}, {expected_m_s} m/s");
    let evidence = skid("braked_before_s = [0.2, 0.4]\n", "");
    assert_eq!(read(&evidence.to_toml()), evidence);
    // A driver who braked before the start brakes there.
    let with = read(&format!("{CASES}[wheels]\n").replacen(
        "heading_deg = 0\n",
        "heading_deg = 0\nbraked_before_s = [0.2, 0.4]\n",
        1,
    ));
    let model = ForwardModel::new(&with, Cars::new(&with, None, None));
    let mut rng = random_stream(7, "braking before", 0);
    for _ in 0..200 {
        let z = standard_normals(model.prior().components().len(), &mut rng);
        let values = model.prior().values(&z);
        assert!(values.brakes() && values.get(Latent::BrakeStart) <= 0.0);
    }
}

/// Half of the draws have an anti-lock system where nobody says it, and only where the driver may brake.
#[test]
fn anti_lock_brakes_are_drawn_where_nobody_says_them() {
    let share = |wheels: &str| {
        let evidence = read(&format!("{CASES}[wheels]\n{wheels}\n"));
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let mut rng = random_stream(3, "anti-lock", 0);
        let n = 2000;
        let has = |rng: &mut ChaCha8Rng| {
            let z = standard_normals(model.prior().components().len(), rng);
            model.prior().values(&z).has_anti_lock()
        };
        (0..n).filter(|_| has(&mut rng)).count() as f64 / f64::from(n)
    };
    assert!((share("") - 0.5).abs() < 0.05);
    assert_eq!(share("anti_lock = \"yes\""), 1.0);
    assert_eq!(share("anti_lock = \"no\""), 0.0);
    assert_eq!(share("driver_braked = \"no\""), 0.0);
}

/// Twelve cars drawn from what is taken to be likely beforehand, braked and not, straight and turning.
#[test]
fn simulated_cars_lie_in_their_intervals() {
    // Side by side: the steps between the motions of a case take one core.
    let cases = (0..12_u64).into_par_iter().map(|case| {
        let (evidence, true_m_s) = simulated(case);
        let target = target(&evidence);
        let posterior = Posterior::new(&target, &sampled(&target, 60, case));
        let mut speeds = posterior.values(ReconstructedQuantity::CarSpeed);
        speeds.sort_by(f64::total_cmp);
        let [low, high] = [0.05, 0.95].map(|share| quantile_of_sorted(&speeds, share).unwrap());
        ((low..=high).contains(&true_m_s), high - low)
    });
    let cases: Vec<(bool, f64)> = cases.collect();
    let n_inside = cases.iter().filter(|(is_inside, _)| *is_inside).count();
    let width_m_s = cases.iter().map(|(_, width_m_s)| width_m_s).sum::<f64>() / 12.0;
    assert!(n_inside >= 9, "{n_inside} of 12");
    assert!(width_m_s < 14.0, "intervals of {width_m_s} m/s say nothing");
}

/// The evidence of a car that slides and comes to rest, and its speed at the start, m/s.
fn simulated(case: u64) -> (Evidence, f64) {
    let form = target(&read(CASES));
    let mut rng = random_stream(11, "single car", case);
    for _ in 0..1000 {
        let z = standard_normals(form.model().prior().components().len(), &mut rng);
        let motion = form.model().motions(&[z], |motion| motion).pop().unwrap();
        let marks = motion.tire_marks();
        let is_marked = marks.iter().any(|mark| mark.length_m() > 5.0);
        if motion.path.end != PathEnd::Rest || !is_marked {
            continue;
        }
        let Some(mut evidence) = form.drawn(&motion, &mut rng) else { continue };
        let long = marks.iter().filter(|mark| mark.length_m() > 2.0);
        evidence.marks = long.map(|mark| found(mark, &mut rng)).collect();
        return (evidence, speed_of(&motion));
    }
    panic!("no car of 1000 leaves marks");
}

fn speed_of(motion: &CollisionMotion) -> f64 {
    motion.values.get(Latent::CarSpeed)
}

/// About eight points along a mark, as they are measured.
fn found(mark: &TireMark, rng: &mut ChaCha8Rng) -> Mark {
    const SIGMA_M: f64 = 0.05;
    let step = mark.points.len().div_ceil(8).max(1);
    let [_, last] = mark.ends().unwrap();
    let places = mark.points.iter().step_by(step).map(|point| point.place_m);
    let mut points_m: Vec<[f64; 2]> = places.chain([last.place_m]).collect();
    points_m.dedup();
    for value in points_m.iter_mut().flatten() {
        let error: f64 = rng.sample(StandardNormal);
        *value += SIGMA_M * error;
    }
    Mark { wheel: mark.wheel, kind: None, points_m, sigma_m: Some(SIGMA_M) }
}

/// Front and rear wheels that lock together begin their marks with the car at one place.
#[test]
fn the_start_is_where_the_earliest_mark_begins() {
    let mark = |wheel: &str, from: [f64; 2], to: [f64; 2]| {
        format!("[[mark]]\nwheel = \"{wheel}\"\npoints_m = [{from:?}, {to:?}]\n")
    };
    let case = |marks: &[String]| {
        let head = "kind = \"single_car\"\n[car]\ncg_to_front_axle_m = 1.2\n\
                    cg_to_rear_axle_m = 1.5\ntrack_m = 1.5\n";
        let evidence = read(&format!("{head}{}", marks.concat()));
        let cars = Cars::new(&evidence, None, None);
        StartPlace::of(&evidence, &cars).unwrap().cg_m()
    };
    // Along Y, which is ahead of the car.
    let front = mark("FL", [-0.75, 11.2], [-0.75, 40.0]);
    let rear = mark("RR", [0.75, 8.5], [0.75, 38.0]);
    let later = mark("FR", [0.75, 15.0], [0.75, 40.0]);
    for marks in [
        vec![front.clone(), rear.clone()],
        vec![rear.clone(), front.clone()],
        vec![later.clone(), front.clone()],
        vec![front.clone(), later],
    ] {
        let [x_m, y_m] = case(&marks);
        assert!(x_m.abs() < 1e-9 && (y_m - 10.0).abs() < 1e-9, "{marks:?}: {x_m} {y_m}");
    }
}

#[test]
fn the_state_at_the_start_is_that_of_the_place_and_the_course() {
    let evidence = read(
        "kind = \"single_car\"\n[car]\n[[mark]]\nwheel = \"FL\"\npoints_m = [[5, 5], [5, 20]]",
    );
    let cars = Cars::new(&evidence, None, None);
    let start = StartPlace::of(&evidence, &cars).unwrap();
    let model = ForwardModel::new(&evidence, cars.clone());
    let mut values = model.prior().values(&vec![0.0; model.prior().components().len()]);
    values.set(Latent::CarSpeed, 20.0);
    values.set(Latent::CarSideslip, 0.1);
    let state = start.state(&values);
    let speed_m_s = state.vx_body_m_s.hypot(state.vy_body_m_s);
    assert!((speed_m_s - 20.0).abs() < 1e-9, "{state:?}");
    let course_rad = state.yaw_rad + state.vy_body_m_s.atan2(state.vx_body_m_s);
    assert!((course_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{state:?}");
    let [along_m, across_m] = cars.struck.parameters.geometry.wheel_place_m(Wheel::FrontLeft);
    let (sin, cos) = state.yaw_rad.sin_cos();
    let wheel_x_m = state.x_m + along_m * cos - across_m * sin;
    let wheel_y_m = state.y_m + along_m * sin + across_m * cos;
    assert!((wheel_x_m - 5.0).abs() < 1e-9 && (wheel_y_m - 5.0).abs() < 1e-9, "{state:?}");
}

#[test]
fn a_recorded_speed_is_compared_with_that_of_its_time() {
    let evidence = read(&format!(
        "{SKID}[[recorded_speed]]\nspeed_m_s = 23\n[[recorded_speed]]\ntime_s = 1\nspeed_m_s = 16\n"
    ));
    let target = target(&evidence);
    let model = target.model();
    let z = vec![0.0; model.prior().components().len()];
    let motion = model.motions(&[z], |motion| motion).pop().unwrap();
    let terms = target.terms(&motion);
    let expected = |name: &str| terms.iter().find(|term| term.name == name).unwrap().expected;
    let [first, later] = ["recorded speed at 0 s", "recorded speed at 1 s"].map(expected);
    assert!((first - speed_of(&motion)).abs() < 1e-6, "{first}");
    let decelerated_m_s = motion.values.locked_drag() * STANDARD_GRAVITY_M_S2;
    assert!((first - later - decelerated_m_s).abs() < 0.2, "{first} {later} {decelerated_m_s}");
    let words = ["struck", "striking", "delta-v", "damage", "mass"];
    assert!(terms.iter().all(|term| words.iter().all(|word| !term.name.contains(word))));
}

/// Ten speeds of one recorder, which may be wrong by 4 % together, were ten witnesses.
#[test]
fn speeds_of_one_device_count_as_one() {
    let log_likelihood = |n: usize| {
        let speeds = "[[recorded_speed]]\nspeed_m_s = 21\n".repeat(n);
        let target = target(&read(&format!("{SKID}{speeds}")));
        let z = vec![0.0; target.model().prior().components().len()];
        target.model().motions(&[z], |motion| target.log_likelihood(&motion)).pop().unwrap()
    };
    let [none, one, ten] = [0, 1, 10].map(log_likelihood);
    assert!((one - none).abs() > 0.1, "{none} {one}");
    assert!((ten - one).abs() < 1e-9, "{one} {ten}");
}

/// A place at the start says nothing of when the driver braked; the start of a mark does.
#[test]
fn braking_may_begin_long_after_a_stated_place() {
    let latest_s = |start: &str| {
        let mark = "[[mark]]\nwheel = \"FL\"\npoints_m = [[0, 0], [9, 0]]\n";
        let evidence = read(&format!("kind = \"single_car\"\n[car]\n{start}{mark}"));
        let prior = Prior::new(&evidence, &Cars::new(&evidence, None, None));
        let brakes = prior.components().iter().find(|of| of.latent == Latent::BrakeStart).unwrap();
        brakes.distribution.ninety()[1]
    };
    assert!(latest_s("") < 1.1 && latest_s("[start]\nx_m = 0\ny_m = 0\n") > 3.0);
}

/// A friction that was measured was cut off at 1.6.
#[test]
fn a_friction_that_was_measured_is_possible() {
    let road = "[road]\nfriction = 1.9\nfriction_sigma = 0.05\n";
    let start = "[start]\nx_m = 0\ny_m = 0\n";
    let evidence = read(&format!("kind = \"single_car\"\n{road}[car]\n{start}"));
    let prior = Prior::new(&evidence, &Cars::new(&evidence, None, None));
    let road = prior.components().iter().find(|of| of.latent == Latent::RoadFriction).unwrap();
    assert!((road.distribution.at(0.0) - 1.9).abs() < 0.01, "{road:?}");
}
