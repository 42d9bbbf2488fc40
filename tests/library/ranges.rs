//! Every place that takes numbers from outside accepts what the table of ranges holds and refuses
//! everything else; what is shipped lies inside.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use toml::Value;

use impactlab_core::collision::{ContactLocation, Scenario};
use impactlab_core::data::{Dataset, DatasetKind, read_any_series};
use impactlab_core::ranges::{
    CG_HEIGHT, CHOICES, CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, CORNERING_COEFFICIENT, DRAWS, EPOCHS,
    FOLDS, FORCE_SAMPLE, FORCE_SETTINGS, FORECAST_DURATION, FRICTION_LIMIT, INSTANT, LOG_DURATION,
    PULSE_DURATION, RESPONSE_SETTINGS, RESTITUTION, ROAD_FRICTION, ROLL_DAMPING, Range, RangeGroup,
    SAMPLES, SIMULATED_DURATION, SLIDING_FRICTION_RATIO, SPEED, STEER_ANGLE, TEST_SHARE, TIME_STEP,
    TRACK_WIDTH, TRAJECTORIES, YAW_RATE,
};
use impactlab_core::vehicle::{ContactPoint, Preset, VehicleParameters};
use impactlab_networks::force::{ForceConfig, ForceScenario};
use impactlab_networks::learning::check_settings;
use impactlab_networks::response::ResponseConfig;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    CompareRequest, Drive, EvaluateForceRequest, FineTuneRequest, ForceQuestion, ForceSource,
    ModelChoice, MotionLogs, MotionSource, PredictForceRequest, PredictMotionRequest, Question,
    ScenarioChoice, SimulateRequest, TrainForceRequest, TrainingOptions,
};

/// Behind the name of a setting: how many numbers it has.
const NUMBER_OF: &str = " (number)";

/// The settings with one of their numbers replaced, wherever it stands in lists.
fn with(settings: &Value, name: &str, number: &Value) -> Value {
    let mut changed = settings.clone();
    let mut at = &mut changed;
    for key in name.split('.') {
        at = at.get_mut(key).unwrap_or_else(|| panic!("there is no {name}"));
    }
    while at.is_array() {
        at = at.get_mut(0).unwrap();
    }
    *at = number.clone();
    changed
}

fn names(name: &str, value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| {
            let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
            names(&name, value, found);
        }),
        Value::Array(list) => list.iter().for_each(|value| names(name, value, found)),
        Value::Integer(_) | Value::Float(_) => drop(found.insert(name.to_owned())),
        _ => {}
    }
}

fn settings() -> [(Value, RangeGroup); 2] {
    [
        (Value::try_from(ForceConfig::default()).unwrap(), FORCE_SETTINGS),
        (Value::try_from(ResponseConfig::default()).unwrap(), RESPONSE_SETTINGS),
    ]
}

#[test]
fn every_number_has_a_range_and_every_range_a_number() {
    for (settings, ranges) in settings() {
        let mut found = BTreeSet::new();
        names("", &settings, &mut found);
        let of_numbers = ranges.ranges.iter().map(|range| range.name);
        let listed: BTreeSet<String> =
            of_numbers.filter(|name| !name.ends_with(NUMBER_OF)).map(str::to_owned).collect();
        assert_eq!(found, listed, "{}", ranges.title);
        check_settings(&settings, &ranges).unwrap();
    }
}

#[test]
fn each_setting_is_accepted_at_its_limits_and_refused_beyond() {
    for (settings, ranges) in settings() {
        for range in ranges.ranges.iter().filter(|range| !range.name.ends_with(NUMBER_OF)) {
            let number = |value: f64| match range.is_whole {
                true => Value::Integer(value as i64),
                false => Value::Float(value),
            };
            let checked =
                |value: Value| check_settings(&with(&settings, range.name, &value), &ranges);
            for inside in [range.low, range.high] {
                checked(number(inside)).unwrap();
            }
            let step = if range.is_whole { 1.0 } else { 1e-6 * (range.high - range.low) };
            let beyond = [range.low - step, range.high + step].map(number);
            let not_finite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(Value::Float);
            for outside in beyond.into_iter().chain(not_finite) {
                let error = checked(outside.clone()).unwrap_err().to_string();
                assert!(error.starts_with(range.name), "{outside}: {error}");
            }
        }
    }
}

/// Values just inside a range, and values that it must not hold.
fn probes(range: &Range) -> ([f64; 2], [f64; 5]) {
    let step = if range.is_whole { 1.0 } else { 1e-6 * (range.high - range.low) };
    let beyond = [range.low - step, range.high + step];
    let not_finite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let [below, above] = beyond;
    let [nan, up, down] = not_finite;
    ([range.low, range.high], [below, above, nan, up, down])
}

/// Checks that a place accepts the limits of a range and refuses what lies outside of it.
fn probe(place: &str, range: &Range, accepts: impl Fn(f64) -> Result<(), String>) {
    let (inside, outside) = probes(range);
    for value in inside {
        accepts(value).unwrap_or_else(|error| panic!("{place}: {value} is refused: {error}"));
    }
    for value in outside {
        assert!(accepts(value).is_err(), "{place}: {value} is accepted");
    }
}

/// A TOML file with the value of one key replaced, in whichever table it stands first.
fn replaced(text: &str, key: &str, value: f64) -> String {
    let mut is_replaced = false;
    let line = |line: &str| {
        let is_key = line.split('=').next().is_some_and(|name| name.trim() == key);
        if is_key && !is_replaced {
            is_replaced = true;
            return format!("{key} = {}\n", toml::Value::Float(value));
        }
        format!("{line}\n")
    };
    let text: String = text.lines().map(line).collect();
    assert!(is_replaced, "{key} is not there");
    text
}

#[test]
fn vehicle_files_are_checked() {
    let text = Preset::Reference.text();
    for (key, range) in [
        ("friction", ROAD_FRICTION),
        ("cg_height_m", CG_HEIGHT),
        ("track_width_m", TRACK_WIDTH),
        ("roll_damping_n_m_s_rad", ROLL_DAMPING),
        ("sliding_friction_ratio", SLIDING_FRICTION_RATIO),
        ("cornering_coefficient_front_per_rad", CORNERING_COEFFICIENT),
    ] {
        probe(key, &range, |value| {
            let file = replaced(text, key, value);
            let vehicle = VehicleParameters::parse(&file, Path::new("car.toml"));
            vehicle.map(|_| ()).map_err(|error| error.to_string())
        });
    }
}

#[test]
fn scenario_files_are_checked() {
    let text = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let text = text.replacen("speed_km_h = 54", "speed_m_s = 15\nyaw_rate_rad_s = 0", 1);
    for (key, range) in [
        ("mass_kg", impactlab_core::ranges::BODY_MASS),
        ("yaw_inertia_kg_m2", impactlab_core::ranges::BODY_YAW_INERTIA),
        ("width_m", impactlab_core::ranges::BODY_WIDTH),
        ("speed_m_s", SPEED),
        ("yaw_rate_rad_s", YAW_RATE),
        ("restitution", RESTITUTION),
    ] {
        probe(key, &range, |value| {
            let file = replaced(&text, key, value);
            let scenario = Scenario::from_toml(&file, Path::new("scenario.toml"));
            scenario.map(|_| ()).map_err(|error| error.to_string())
        });
    }
}

#[test]
fn columns_of_cases_are_checked() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    for kind in [DatasetKind::Force, DatasetKind::Trajectory] {
        let files = root.join(kind.folder());
        fs::create_dir_all(&files).unwrap();
        let series = match kind {
            DatasetKind::Force => "time_s,fx_n,fy_n\n0,0,0\n0.1,1,1\n",
            DatasetKind::Trajectory => "time_s,x_m,y_m\n0,0,0\n0.1,1,1\n",
        };
        fs::write(files.join("a.csv"), series).unwrap();
        for changed in kind.columns() {
            probe(changed.name, &changed.range, |value| {
                let columns = kind.columns().iter();
                let names: Vec<&str> = columns.clone().map(|column| column.name).collect();
                let number = |name: &str| if name == changed.name { value } else { 1.0 };
                let values: Vec<String> =
                    columns.map(|column| number(column.name).to_string()).collect();
                let table = format!("case,{}\na,{}\n", names.join(","), values.join(","));
                fs::write(root.join("cases.csv"), table).unwrap();
                let loaded = Dataset::load(root, &mut |_| ControlFlow::Continue(())).unwrap();
                let problems = loaded.complete().unwrap().problems;
                problems.first().map_or(Ok(()), |problem| {
                    let column = kind.columns().iter().position(|column| column == changed);
                    let place = format!("cases.csv:2:{}: ", column.unwrap() + 2);
                    let message = problem.to_string();
                    assert!(message.contains(&place), "{message}");
                    Err(message)
                })
            });
        }
        fs::remove_dir_all(files).unwrap();
    }
}

#[test]
fn time_series_are_checked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("series.csv");
    let read = |text: String| {
        fs::write(&path, text).unwrap();
        read_any_series(&path, None).map(|_| ()).map_err(|error| error.to_string())
    };
    probe("steer", &STEER_ANGLE, |value| read(format!("time_s,steer_rad\n0,0\n1,{value}\n")));
    probe("force", &FORCE_SAMPLE, |value| read(format!("time_s,fx_n,fy_n\n0,0,0\n1,{value},0\n")));
    for (value, is_read) in [(INSTANT.high, true), (2e10, false)] {
        let file = format!("time_s,fx_n,fy_n\n{},0,0\n{value},1,0\n", value - 1.0);
        assert_eq!(read(file).is_ok(), is_read, "{value}");
    }
    let error = read("time_s,fx_n,fy_n\n0,0,0\n1e999,1,0\n".to_owned()).unwrap_err();
    assert!(error.contains("\"1e999\", expected a finite number in s"), "{error}");
    probe("time step", &TIME_STEP, |step| {
        // A later time that is not finite is no number of a file.
        read(format!("time_s,fx_n,fy_n\n0,0,0\n{step},1,0\n"))
    });
    let error = read("time_s,steer_rad\n0,0\n1,5\n".to_owned()).unwrap_err();
    assert!(error.contains("an angle of the steering wheel as such"), "{error}");
}

fn pit() -> Scenario {
    Scenario::load(Path::new("assets/scenarios/pit_right_rear.toml")).unwrap()
}

fn checked(question: &impl Question) -> Result<(), String> {
    question.check().map_err(|error| error.to_string())
}

fn drive(drive: Drive) -> SimulateRequest {
    SimulateRequest::new(MotionSource::Drive(drive))
}

#[test]
fn simulations_are_checked() {
    let start = Drive { speed_m_s: Some(20.0), ..Drive::default() };
    probe("friction", &ROAD_FRICTION, |value| {
        checked(&SimulateRequest { friction: Some(value), ..drive(start.clone()) })
    });
    probe("duration", &SIMULATED_DURATION, |value| {
        checked(&SimulateRequest { duration_s: value, ..drive(start.clone()) })
    });
    probe("speed", &SPEED, |value| {
        checked(&drive(Drive { speed_m_s: Some(value), ..start.clone() }))
    });
    probe("yaw rate", &YAW_RATE, |value| {
        checked(&drive(Drive { yaw_rate_rad_s: value, ..start.clone() }))
    });
    let at = ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: 0.5 };
    let contact = |contact| checked(&drive(Drive { contact: Some(contact), ..start.clone() }));
    probe("contact x", &CONTACT_X, |x_body_m| contact(ContactPoint { x_body_m, ..at }));
    probe("contact y", &CONTACT_Y, |y_body_m| contact(ContactPoint { y_body_m, ..at }));
    probe("contact height", &CONTACT_HEIGHT, |height_m| contact(ContactPoint { height_m, ..at }));
    probe("pulse", &PULSE_DURATION, |duration_s| {
        let pulse = PulseSetup { duration_s, ..PulseSetup::default() };
        let scenario = ScenarioChoice::Inline(Box::new(pit()));
        checked(&SimulateRequest::new(MotionSource::Scenario { scenario, pulse }))
    });
}

#[test]
fn scenarios_in_questions_are_checked() {
    for (number, (name, _, range)) in pit().ranges().into_iter().enumerate() {
        probe(&name, &range, |value| {
            let mut scenario = pit();
            set(&mut scenario, number, value);
            assert_eq!(scenario.ranges()[number].1.to_bits(), value.to_bits(), "{name}");
            // What depends on the length is checked with the length.
            scenario.struck.cg_from_front_m = scenario.struck.cg_from_front_m.min(0.1);
            scenario.striking.cg_from_front_m = scenario.striking.cg_from_front_m.min(0.1);
            if name.ends_with("cg_from_front_m") {
                set(&mut scenario, number, value);
            }
            let scenario = ScenarioChoice::Inline(Box::new(scenario));
            let collision = ForceQuestion::Scenario(scenario);
            checked(&PredictForceRequest::new(collision))
        });
    }
}

/// Sets one of the numbers of a scenario, in the order of [`Scenario::ranges`].
fn set(scenario: &mut Scenario, number: usize, value: f64) {
    let Scenario { struck_x_world_m, struck_y_world_m, struck, striking, contact, .. } = scenario;
    let mut numbers = vec![struck_x_world_m, struck_y_world_m];
    for vehicle in [struck, striking] {
        numbers.extend([
            &mut vehicle.mass_kg,
            &mut vehicle.yaw_inertia_kg_m2,
            &mut vehicle.length_m,
            &mut vehicle.width_m,
            &mut vehicle.cg_from_front_m,
            &mut vehicle.heading_rad,
            &mut vehicle.vx_world_m_s,
            &mut vehicle.vy_world_m_s,
            &mut vehicle.yaw_rate_rad_s,
        ]);
    }
    let stated = [&mut contact.restitution, &mut contact.friction_limit];
    numbers.extend(stated.map(|stated| stated.as_mut().expect("the shipped scenario states it")));
    match &mut contact.location {
        ContactLocation::Side { offset_m, .. } => numbers.push(offset_m),
        other => panic!("the shipped scenario is placed by a side, not {other:?}"),
    }
    *numbers[number] = value;
}

#[test]
fn collisions_in_numbers_are_checked() {
    let numbers = ForceScenario::from_scenario(&pit()).unwrap();
    let ask = |numbers: ForceScenario| {
        let numbers = ForceQuestion::Numbers { name: String::new(), numbers: Box::new(numbers) };
        checked(&PredictForceRequest::new(numbers))
    };
    probe("mass", &impactlab_core::ranges::BODY_MASS, |mass| {
        ask(ForceScenario { mass_kg: [mass, 2000.0], ..numbers.clone() })
    });
    probe("speed", &SPEED, |speed| {
        ask(ForceScenario { striking_velocity_m_s: [speed, 0.0], ..numbers.clone() })
    });
    probe("contact", &CONTACT_X, |x| {
        ask(ForceScenario { contact_m: Some([x, -0.9]), ..numbers.clone() })
    });
}

#[test]
fn numbers_of_things_in_questions_are_checked() {
    // A number that no count can be is refused before the question is made.
    let count = |value: f64| match value {
        value if value.fract() == 0.0 && (0.0..1e15).contains(&value) => Ok(value as usize),
        value => Err(format!("{value} is no number of things")),
    };
    let scenario = || ScenarioChoice::Inline(Box::new(pit()));
    let source = || MotionSource::Scenario { scenario: scenario(), pulse: PulseSetup::default() };
    let motion = || PredictMotionRequest::new(source(), ForceSource::Given);
    probe("draws", &DRAWS, |n| checked(&PredictMotionRequest { draws: count(n)?, ..motion() }));
    probe("duration of a forecast", &FORECAST_DURATION, |duration_s| {
        let mut request = motion();
        request.motion.duration_s = duration_s;
        checked(&request)
    });
    probe("samples", &SAMPLES, |n| {
        let usual = PredictForceRequest::new(ForceQuestion::Scenario(scenario()));
        checked(&PredictForceRequest { samples: count(n)?, ..usual })
    });
    let evaluation = EvaluateForceRequest::new(ModelChoice::default(), "datasets/fea");
    probe("folds", &FOLDS, |n| {
        checked(&EvaluateForceRequest { cross_validate: Some(count(n)?), ..evaluation.clone() })
    });
    let compare = CompareRequest::new("datasets/trajectories-fea");
    probe("choices", &CHOICES, |n| {
        checked(&CompareRequest { choices: count(n)? as u64, ..compare.clone() })
    });
    probe("trajectories", &TRAJECTORIES, |n| {
        checked(&CompareRequest { trajectories: vec![5, count(n)?], ..compare.clone() })
    });
    assert!(checked(&CompareRequest { trajectories: Vec::new(), ..compare }).is_err());
    probe("test share", &TEST_SHARE, |test_share| {
        checked(&FineTuneRequest { test_share, ..FineTuneRequest::default() })
    });
    probe("epochs", &EPOCHS, |n| {
        checked(&TrainForceRequest {
            data: "datasets/fea".into(),
            extra: Vec::new(),
            paper: false,
            epochs: Some(count(n)?),
            training: TrainingOptions::default(),
        })
    });
    let log = |impact_s, steering_ratio, duration_s| {
        let logs = MotionLogs {
            logs: Vec::new(),
            forces: Vec::new(),
            map: None,
            force_map: None,
            contact: None,
            impact_s,
            without_impact: false,
            steering_ratio,
            duration_s,
        };
        checked(&FineTuneRequest { logs: Some(logs), ..FineTuneRequest::default() })
    };
    probe("first contact of a log", &INSTANT, |impact_s| log(Some(impact_s), None, 4.0));
    probe("duration of a log", &LOG_DURATION, |duration_s| log(None, None, duration_s));
    assert!(log(None, Some(15.0), 4.0).is_ok() && log(None, Some(0.5), 4.0).is_err());
}

/// By its file a test drive could have a first contact, which the command line refuses.
#[test]
fn a_drive_in_which_nothing_was_struck_has_no_first_contact() {
    let is_taken = |without_impact: bool| {
        let text = format!(
            r#"{{"logs": ["drive.csv"], "impact_s": 1.0, "without_impact": {without_impact}}}"#
        );
        let logs: MotionLogs = serde_json::from_str(&text).unwrap();
        checked(&FineTuneRequest { logs: Some(logs), ..FineTuneRequest::default() }).is_ok()
    };
    assert!(is_taken(false) && !is_taken(true));
}

#[test]
fn what_is_shipped_lies_inside() {
    for preset in Preset::ALL {
        VehicleParameters::parse(preset.text(), Path::new(preset.id())).unwrap();
    }
    for name in ["pit-right-rear", "carpenter-welcher-barrier"] {
        let scenario = Scenario::preset_or_file(Path::new(name)).unwrap();
        for (number, value, range) in scenario.ranges() {
            range.check(value).unwrap_or_else(|error| panic!("{name}, {number}: {error}"));
        }
        scenario.geometry().unwrap();
    }
    ForceConfig::paper().check().unwrap();
    ResponseConfig::default().plain().check().unwrap();
    ResponseConfig::load(Path::new("assets/models/response.toml")).unwrap();
    // A model checks the settings that it carries.
    ModelSource::Shipped.force_model().unwrap();
    ModelSource::Shipped.response_model().unwrap();
    ModelSource::ShippedPretrained.response_model().unwrap();
    for name in ["fea", "fea-wide", "trajectories-fea", "trajectories-pulse"] {
        let root = Path::new("datasets").join(name);
        let loaded = Dataset::load(&root, &mut |_| ControlFlow::Continue(())).unwrap();
        let dataset = loaded.complete().unwrap();
        assert_eq!((dataset.cases.len(), dataset.problems.len()), (100, 0), "{name}");
    }
    assert!(FRICTION_LIMIT.contains(0.82) && RESTITUTION.contains(0.0));
}
