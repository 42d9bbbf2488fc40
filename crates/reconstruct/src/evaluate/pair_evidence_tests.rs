use std::path::Path;

use super::*;
use crate::evaluate::TrueQuantities;
use crate::evidence::examples::read;
use impactlab_core::compare::{PairAttributes, PairRecords, RecordedContact};
use impactlab_core::data::TimeSeries;
use impactlab_core::vehicle::{Controls, Manoeuvre, Preset, Wheel, WheelEffort, WheelHistory};

/// Heading of both cars in the record before they meet, rad.
const HEADING_RAD: f64 = 0.5;

/// A motion by pose and velocities in body axes at each time.
fn motion(at: impl Fn(f64) -> [f64; 6]) -> TimeSeries {
    let time_s: Vec<f64> = (0..=400).map(|i| f64::from(i) / 100.0).collect();
    let rows: Vec<[f64; 6]> = time_s.iter().map(|time_s| at(*time_s)).collect();
    let mut series = TimeSeries::new(time_s).unwrap();
    use Channel as C;
    for (idx, channel) in [C::X, C::Y, C::Yaw, C::Vx, C::Vy, C::YawRate].into_iter().enumerate() {
        series.insert(channel, rows.iter().map(|row| row[idx]).collect()).unwrap();
    }
    series
}

/// The struck car drives 20 m/s, meets the striking car after 1 s, slides sideways with 5 m/s for 2 s and
/// stands. The striking car, 3 m to its right, goes straight on, with locked wheels from 2 s on until it
/// stands.
///
/// - `stands_s`: when the striking car stands.
fn pair(name: &str, stands_s: f64) -> PairCase {
    braked_pair(name, stands_s, false)
}

/// - `is_anti_lock`: whether the brakes of the striking car give way every 0.1 s.
fn braked_pair(name: &str, stands_s: f64, is_anti_lock: bool) -> PairCase {
    let start = Pose { x_m: 10.0, y_m: 5.0, yaw_rad: HEADING_RAD };
    let struck = motion(|time_s| {
        let along_m = 20.0 * time_s.min(1.0);
        let aside_m = 5.0 * (time_s - 1.0).clamp(0.0, 2.0);
        let [x_m, y_m] = start.world_from_body([along_m, aside_m]);
        let speeds = match time_s {
            t if t <= 1.0 => [20.0, 0.0],
            t if t < 3.0 => [0.0, 5.0],
            _ => [0.0, 0.0],
        };
        [x_m, y_m, HEADING_RAD, speeds[0], speeds[1], 0.0]
    });
    let striking = motion(|time_s| {
        let [x_m, y_m] = start.world_from_body([22.0 * time_s.min(stands_s), -3.0]);
        let vx = if time_s < stands_s { 22.0 } else { 0.0 };
        [x_m, y_m, HEADING_RAD, vx, 0.0, 0.0]
    });
    let braked = WheelEffort { braking_n: 2e4, ..WheelEffort::FREE };
    let brakes = |i: i32| i >= 200 && !(is_anti_lock && i % 20 >= 10);
    let effort = |i: i32| [if brakes(i) { braked } else { WheelEffort::FREE }; 4];
    let wheels = WheelHistory {
        time_s: (0..=400).map(|i| f64::from(i) / 100.0).collect(),
        wheels: (0..=400).map(effort).collect(),
    };
    let controls = Controls { wheels: Some(wheels), ..Controls::default() };
    PairCase {
        name: name.to_owned(),
        attributes: PairAttributes {
            kind: "pit".to_owned(),
            cars: ["a", "b"].map(str::to_owned),
            has_stability_control: false,
            twin_without_stability_control: None,
        },
        vehicles: [0.7, 0.7].map(|friction| Preset::Reference.parameters().with_friction(friction)),
        manoeuvres: [Manoeuvre::default(), Manoeuvre { controls, ..Manoeuvre::default() }],
        contact_height_m: None,
        motions: [struck, striking],
        brake_pedal: None,
        contact: RecordedContact {
            first_s: Some(1.0),
            place_m: Some([-1.5, -0.9]),
            force_world_n: [Vec::new(), Vec::new()],
        },
    }
}

fn found(name: &str, stands_s: f64) -> PairEvidence {
    PairEvidence::from_record(&pair(name, stands_s), 7).unwrap()
}

/// Whether a found place is that which it was, within four standard deviations.
fn is_near([x_m, y_m]: [f64; 2], expected_m: [f64; 2], sigma_m: f64) -> bool {
    (x_m - expected_m[0]).abs() < 4.0 * sigma_m && (y_m - expected_m[1]).abs() < 4.0 * sigma_m
}

#[test]
fn the_marks_of_a_known_motion_lie_where_its_wheels_slid() {
    let PairEvidence { evidence, .. } = found("a", 3.0);
    let geometry = Preset::Reference.parameters().geometry;
    let ends = |mark: &Mark| [mark.points_m[0], *mark.points_m.last().unwrap()];
    assert_eq!(evidence.marks.iter().map(|mark| mark.wheel).collect::<Vec<_>>(), Wheel::ALL);
    for mark in &evidence.marks {
        let [x_m, y_m] = geometry.wheel_place_m(mark.wheel);
        let [first, last] = ends(mark);
        assert!(is_near(first, [x_m, y_m], MARK_SIGMA_M), "{mark:?}");
        assert!(is_near(last, [x_m, y_m + 10.0], MARK_SIGMA_M), "{mark:?}");
        assert_eq!((mark.kind, mark.points_m.len()), (Some(MarkKind::SideSlip), 3), "{mark:?}");
    }
    // The striking car is 2 m ahead of the struck one at the contact, and brakes 22 m later.
    for mark in &evidence.striking_marks {
        let [x_m, y_m] = geometry.wheel_place_m(mark.wheel);
        let [first, last] = ends(mark);
        assert!(is_near(first, [x_m + 24.0, y_m - 3.0], MARK_SIGMA_M), "{mark:?}");
        assert!(is_near(last, [x_m + 46.0, y_m - 3.0], MARK_SIGMA_M + 0.05), "{mark:?}");
        assert_eq!((mark.kind, mark.points_m.len()), (Some(MarkKind::Locked), 7), "{mark:?}");
    }
    assert_eq!(evidence.striking_marks.len(), 4);
}

#[test]
fn the_rest_and_the_speeds_are_those_of_the_record_in_the_axes_of_the_struck_car() {
    let PairEvidence { evidence, truth } = found("a", 3.0);
    let rest = evidence.rest.unwrap();
    assert!(is_near(rest.place_m().unwrap(), [0.0, 10.0], REST_SIGMA_M), "{rest:?}");
    assert!(rest.heading().unwrap().value.abs() < 4.0 * HEADING_SIGMA_RAD, "{rest:?}");
    let rest = evidence.striking_rest.unwrap();
    assert!(is_near(rest.place_m().unwrap(), [46.0, -3.0], REST_SIGMA_M), "{rest:?}");
    let damage = evidence.damage;
    assert_eq!(damage.side, Some(Side::Right));
    assert!((damage.along().unwrap().value + 1.5).abs() < 4.0 * DAMAGE_SIGMA_M, "{damage:?}");
    let file = std::env::temp_dir().join(format!("impactlab-truth-{}.toml", std::process::id()));
    std::fs::write(&file, &truth).unwrap();
    let truth = TrueQuantities::load(&file);
    std::fs::remove_file(&file).unwrap();
    let truth = truth.unwrap();
    assert!((truth.struck_m_s - 20.0).abs() < 1e-9 && (truth.striking_m_s - 22.0).abs() < 1e-9);
    assert!((truth.closing_m_s - 2.0).abs() < 1e-9, "{truth:?}");
    assert!(truth.heading_difference_rad.unwrap().abs() < 1e-12, "{truth:?}");
}

/// The wheels of a car with an anti-lock system go on turning.
#[test]
fn brakes_that_give_way_again_and_again_leave_no_marks() {
    let PairEvidence { evidence, .. } =
        PairEvidence::from_record(&braked_pair("a", 3.0, true), 7).unwrap();
    assert_eq!(evidence.striking_marks, []);
    assert!(evidence.striking_rest.is_some());
}

/// A mark that goes on at the end of the record has no end that anybody could find.
#[test]
fn a_car_that_still_moves_has_no_rest_and_no_mark_that_is_cut_off() {
    let PairEvidence { evidence, .. } = found("a", 9.0);
    assert_eq!(evidence.striking_rest, None);
    assert_eq!(evidence.striking_marks, []);
    assert!(evidence.rest.is_some() && evidence.marks.len() == 4);
}

/// Over many cases the errors are as large as they are said to be, and recorders are in half of the cars.
#[test]
fn the_errors_are_those_that_are_stated() {
    let all: Vec<Evidence> =
        (0..200).map(|idx| found(&format!("case {idx}"), 3.0).evidence).collect();
    let n = all.len() as f64;
    let rms = |of: &dyn Fn(&Evidence) -> f64| {
        (all.iter().map(|it| of(it).powi(2)).sum::<f64>() / n).sqrt()
    };
    let vehicle = Preset::Reference.parameters();
    let mass_kg = vehicle.mass.mass_kg;
    for (what, sigma, found) in [
        ("rest", 0.15, rms(&|it| it.rest.unwrap().y_m.unwrap() - 10.0)),
        ("striking rest", 0.15, rms(&|it| it.striking_rest.unwrap().x_m.unwrap() - 46.0)),
        ("friction", 0.04, rms(&|it| it.road_friction().unwrap().value - 0.7)),
        ("mass", 0.02, rms(&|it| it.struck_car.mass().unwrap().value / mass_kg - 1.0)),
        ("damage", 0.08, rms(&|it| it.damage.along().unwrap().value + 1.5)),
        (
            "mark",
            0.10,
            rms(&|it| {
                it.marks[2].points_m[1][0] - vehicle.geometry.wheel_place_m(Wheel::RearLeft)[0]
            }),
        ),
    ] {
        // Of 200 numbers the root mean square is within 20 % with four standard errors.
        assert!((found / sigma - 1.0).abs() < 0.2, "{what}: {found} of {sigma}");
    }
    let records = |edr: fn(&Evidence) -> Option<Edr>| {
        let found: Vec<Edr> = all.iter().filter_map(edr).collect();
        let speeds: Vec<f64> =
            found.iter().filter_map(|it| Some(it.speed_before()?.value)).collect();
        assert!((75..=125).contains(&found.len()), "{} of 200", found.len());
        assert!((25..=75).contains(&speeds.len()), "{} of {}", speeds.len(), found.len());
        speeds
    };
    let striking_m_s = records(|it| it.striking_edr);
    let off = striking_m_s.iter().map(|speed| (speed / 22.0 - 1.0).powi(2)).sum::<f64>();
    let off = (off / striking_m_s.len() as f64).sqrt();
    assert!((off / 0.04 - 1.0).abs() < 0.45, "{off}");
    records(|it| it.edr);
}

#[test]
fn a_case_has_the_errors_of_its_name_and_the_seed() {
    assert_eq!(found("a", 3.0), found("a", 3.0));
    let other = PairEvidence::from_record(&pair("a", 3.0), 8).unwrap();
    assert_ne!(other.evidence.rest, found("a", 3.0).evidence.rest);
    assert_ne!(found("b", 3.0).evidence.rest, found("a", 3.0).evidence.rest);
}

#[test]
fn a_shipped_pair_leaves_evidence_that_is_read_again() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/pairs");
    let case = PairRecords::open(&root).unwrap().load("d062").unwrap().unwrap();
    let PairEvidence { evidence, .. } = PairEvidence::from_record(&case, 1).unwrap();
    assert_eq!(evidence.missing(), None);
    assert_eq!(read(&evidence.to_toml()), evidence);
    assert!(evidence.rest.is_some() && evidence.striking_rest.is_some());
    assert!(evidence.marks.len() > 3, "{evidence:?}");
    assert!(evidence.follows_striking_car());
}
