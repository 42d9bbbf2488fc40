//! The work of an analyst in the window. The controls are found by the text on the screen.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Output, Pane, ReplayStatus, Source, State, Subject};
use impactlab_core::collision::ContactLocation;
use impactlab_core::data::{DatasetKind, Severity};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;

use crate::harness::{apply, is_idle, open, open_with, open_with_few_draws, state, step_until};

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn shows(name: &'static str) -> impl Fn(&State) -> bool {
    move |state| state.analysis().is_some_and(|a| a.report.name == name) && is_idle(state)
}

#[test]
fn the_help_menu_shows_the_licences_of_crates_and_fonts() {
    let mut harness = open(&[]);
    harness.get_by_label("Help").click();
    harness.run_steps(10);
    harness.get_by_label("Licences…").click();
    harness.run_steps(10);
    assert!(state(&harness).session.dialogs.is_any_open());
    harness.get_by_label("Notices of third parties");
    harness.get_by_label("Close").click();
    harness.run_steps(10);
    assert!(!state(&harness).session.dialogs.is_any_open());
}

#[test]
fn open_pick_simulate_scrub() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea")]);
    step_until(&mut harness, "the first case", shows("FE_c001"));

    // A case is selected by its name in the table.
    harness.get_by_label("FE_c003").click();
    step_until(&mut harness, "the case that was clicked", shows("FE_c003"));
    let answer = state(&harness).analysis().unwrap();
    assert!(answer.analysis.simulation.is_some() && answer.analysis.reference.is_some());
    assert!(answer.report.error.as_ref().unwrap().average_error_m < 3.0);

    // The whole data set is simulated.
    harness.get_by_label("Simulate all 100 cases").click();
    step_until(&mut harness, "all cases", |state| {
        let mut reports = state.session.replays.values().filter_map(ReplayStatus::report);
        reports.any(|report| report.cases.len() == 100)
    });
    harness.get_by_label("All 100 cases, average position error");

    // The time is moved by keys, and playback is started and stopped.
    harness.key_press(Key::ArrowRight);
    harness.step();
    assert!((state(&harness).session.playback.time_s - 0.05).abs() < 1e-9);
    harness.key_press(Key::Space);
    harness.run_steps(8);
    assert!(state(&harness).session.playback.is_playing);
    assert!(
        state(&harness).session.playback.time_s > 0.1,
        "{}",
        state(&harness).session.playback.time_s
    );
    harness.get_by_label("Pause").click();
    harness.run_steps(2);
    assert!(!state(&harness).session.playback.is_playing);
    harness.key_press(Key::Home);
    harness.step();
    assert_eq!(state(&harness).session.playback.time_s, 0.0);
}

#[test]
fn the_next_case_comes_with_a_key_and_undo_brings_the_last_one_back() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", shows("c001"));
    harness.run_steps(90); // the past takes a second to settle
    harness.key_press(Key::ArrowDown);
    step_until(&mut harness, "the next case", shows("c002"));
    harness.run_steps(90);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    step_until(&mut harness, "the case before", shows("c001"));
}

#[test]
fn a_filter_narrows_the_table_and_units_change_everywhere() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", shows("c001"));
    harness.state_mut().state_mut().view.filter = "hooked=1 m_b_kg>2000".to_owned();
    harness.run_steps(2);
    assert!(harness.query_by_label("100 of 100 cases").is_none());
    harness.get_by_label("×").click();
    harness.run_steps(2);
    harness.get_by_label("100 of 100 cases");
    harness.get_by_label("US").click();
    harness.run_steps(2);
    assert_eq!(state(&harness).view.units, UnitSystem::Us);
    assert!(harness.query_all_by_label_contains("lbf").count() > 2);
}

#[test]
fn a_bad_file_says_where_and_offers_the_mapping() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("export.csv");
    std::fs::write(&path, "Zeit;Kraft A;Kraft B\n0;0;0\n1;2,5;40\n2;0;0\n").unwrap();
    let mut harness = open(&[path.to_str().unwrap()]);
    step_until(&mut harness, "the mapping dialog", |state| {
        state.session.dialogs.import().is_some()
    });
    harness.get_by_label("Which column is which?");
    let message = state(&harness).session.messages.last().unwrap();
    assert_eq!(message.severity, Severity::Error);
    assert!(message.text.contains("export.csv:1: no column for"), "{}", message.text);

    let map = "time=1:ms,fx=2:kN,fy=3:kN".parse().unwrap();
    apply(&mut harness, Command::OpenMapped(path, map));
    step_until(&mut harness, "the mapped file", shows("export"));
    let report = &state(&harness).analysis().unwrap().report;
    let force = report.force.as_ref().unwrap();
    assert!((force.peak_n - 2500.0_f64.hypot(40_000.0)).abs() < 1e-6);
    // A file states neither the speed of the vehicle nor the point at which the force acts.
    let assumed: Vec<&str> =
        report.caveats.assumptions().map(|of| of.subject.unwrap().label()).collect();
    assert_eq!(assumed, ["struck vehicle", "speed before the impact", "contact point"]);
    harness.run_steps(2);
    harness.query_all_by_label("assumed: contact point").next().expect("what was assumed");
    assert!(harness.query_all_by_label_contains("x -1.5 m").count() > 0, "and its value");
    assert!(harness.query_all_by_label("Change").count() > 0);
    // The user enters both in the vehicle pane instead.
    apply(&mut harness, Command::Show(Pane::Vehicle));
    harness.run_steps(2);
    assert_eq!(harness.query_all_by_label("Set").count(), 2);
    harness.state_mut().state_mut().project.start_mut().speed_m_s = Some(15.0);
    step_until(&mut harness, "the file at another speed", |state| {
        let answer = state.analysis().filter(|_| is_idle(state));
        answer.is_some_and(|answer| answer.report.caveats.assumptions().count() == 2)
    });
    harness.get_by_label("Speed not known");
}

#[test]
fn a_dropped_file_opens_and_a_figure_is_exported() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the data set", shows("c001"));
    let dropped = Dropped(PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/datasets/fea/forces/c002.csv"
    )));
    harness.input_mut().dropped_files.push(Arc::new(dropped));
    step_until(&mut harness, "the drop", |state| {
        state.session.sources.len() == 2 && state.session.offered.is_some() && is_idle(state)
    });
    harness.run_steps(2);
    harness.get_by_label_contains(
        "c002.csv is open beside this variant, which asks about c001 of fea",
    );
    harness.get_by_label("Use in this variant").click();
    step_until(&mut harness, "the file", shows("c002"));
    harness.get_by_label_contains("c002.csv · force");
    let analysis = state(&harness).analysis().unwrap().analysis.clone();
    let figure = impactlab_document::figure::analysis_scene_figure(
        &analysis,
        &Caveats::default(),
        1.0,
        UnitSystem::Si,
    );
    let folder = tempfile::tempdir().unwrap();
    for name in ["scene.png", "scene.csv"] {
        let path = folder.path().join(name);
        apply(
            &mut harness,
            Command::Write(Output::Picture(Box::new(figure.clone())), path.clone()),
        );
        step_until(&mut harness, "the export", |state| !state.session.tasks.is_writing());
        assert!(path.metadata().unwrap().len() > 1000, "{name}");
    }
    let png = image::open(folder.path().join("scene.png")).unwrap();
    assert_eq!((png.width(), png.height()), (1920, 1080));
    let bad = folder.path().join("no/folder/scene.png");
    apply(&mut harness, Command::Write(Output::Picture(Box::new(figure)), bad));
    step_until(&mut harness, "the failure", |state| {
        state.session.messages.last().is_some_and(|m| m.severity == Severity::Error)
    });
}

#[test]
fn a_scenario_is_solved_simulated_and_survives_a_kill() {
    let folder = tempfile::tempdir().unwrap();
    let state_file = folder.path().join("new/state.json");
    let mut harness = open_with(
        &[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")],
        Some(state_file.clone()),
    );
    step_until(&mut harness, "the first case", shows("c001"));
    apply(&mut harness, Command::Show(Pane::Scenario));
    step_until(&mut harness, "the solution", |state| state.session.impact.ok().is_some());
    harness.get_by_label_contains("Contact and impulse");
    harness.get_by_label("Simulate in the scene").click();
    step_until(&mut harness, "the scenario", shows("PIT, right rear quarter"));
    let analysis = &state(&harness).analysis().unwrap().analysis;
    assert!(analysis.striking.is_some() && analysis.simulation.is_some());

    // The state is on disk after about a second. The app is then dropped without being closed, as
    // if it had been killed.
    harness.run_steps(90);
    step_until(&mut harness, "the saved state", |_| state_file.exists());
    let before = state(&harness).project.clone();
    let layout = state(&harness).view.workspaces.clone();
    drop(harness);
    let mut harness = open_with(&[], Some(state_file));
    step_until(&mut harness, "the scenario again", shows("PIT, right rear quarter"));
    assert_eq!(state(&harness).project, before);
    assert_eq!(state(&harness).view.workspaces, layout);
    assert_eq!(state(&harness).session.sources.len(), 1);
}

#[test]
fn a_vehicle_file_becomes_the_struck_vehicle_and_a_scenario_file_the_scenario() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", shows("c001"));
    apply(&mut harness, Command::Open(vec!["assets/vehicles/target-2000.toml".into()]));
    step_until(&mut harness, "the case with the other vehicle", |state| {
        let answer = state.analysis().filter(|_| is_idle(state));
        answer.is_some_and(|answer| answer.report.vehicle.starts_with("FEA target"))
    });
    // The model car is too narrow to be struck where the full-sized one was.
    apply(&mut harness, Command::Open(vec!["assets/vehicles/scaled-target-100.toml".into()]));
    step_until(&mut harness, "the refusal of the vehicle", |state| {
        let answer = state.session.analysis.answer.as_ref().filter(|_| is_idle(state));
        let problem = answer.and_then(|answer| answer.as_ref().err());
        problem.is_some_and(|problem| problem.contains("the force does not act on Scaled target"))
    });
    apply(&mut harness, Command::Open(vec!["assets/vehicles/target-2000.toml".into()]));
    apply(&mut harness, Command::Open(vec!["assets/scenarios/pit_right_rear.toml".into()]));
    step_until(&mut harness, "the scenario", shows("PIT, right rear quarter"));
    apply(&mut harness, Command::Open(vec!["Cargo.toml".into()]));
    let message = state(&harness).session.messages.last().unwrap();
    assert!(message.severity == Severity::Error && message.text.contains("Cargo.toml:"));
}

#[test]
fn closing_everything_leaves_an_empty_window_that_says_what_to_do() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", shows("c001"));
    apply(
        &mut harness,
        Command::Close(concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea").into()),
    );
    harness.run_steps(4);
    assert!(state(&harness).analysis().is_none());
    harness.get_by_label("Open the shipped data").click();
    let shipped = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/datasets")).unwrap();
    let folders = shipped.map(|entry| entry.unwrap().path());
    let n_shipped = folders.filter(|path| DatasetKind::from_folder(path).is_some()).count();
    step_until(&mut harness, "the shipped data", |state| {
        state.session.sources.len() == n_shipped && is_idle(state)
    });
    assert!(
        state(&harness).session.messages.iter().all(|message| message.severity != Severity::Error)
    );
}

#[test]
fn data_that_are_opened_leave_the_answers_to_other_questions_as_they_are() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut harness = open(&["assets/scenarios/pit_right_rear.toml"]);
    let is_forecast = |state: &State| {
        is_idle(state)
            && state.session.response.forecast.ok().is_some()
            && !state.session.is_waiting()
    };
    step_until(&mut harness, "the forecast", is_forecast);
    let answer = |harness: &Harness<'_, App>| {
        Arc::clone(state(harness).session.analysis.ok().expect("an answer"))
    };
    let before = answer(&harness);
    apply(&mut harness, Command::Open(vec![root.join("datasets/fea")]));
    step_until(&mut harness, "the data", |state| {
        assert!(!state.session.is_waiting(), "the same question is not asked again");
        state.session.offered.is_some()
    });
    assert!(Arc::ptr_eq(&before, &answer(&harness)));

    // What was read from the data themselves is asked again when they are read again.
    harness.get_by_label("Use in this variant").click();
    step_until(&mut harness, "the first case", shows("c001"));
    let before = answer(&harness);
    apply(&mut harness, Command::Open(vec![root.join("datasets/fea")]));
    step_until(&mut harness, "the data again", |state| {
        let is_read = state.session.sources.iter().all(impactlab::app::Source::is_settled);
        is_read && is_idle(state) && state.session.analysis.ok().is_some()
    });
    assert!(!Arc::ptr_eq(&before, &answer(&harness)));
}

#[test]
fn a_simulation_that_fails_leaves_no_forecast_of_an_earlier_one() {
    let mut harness = open_with_few_draws("assets/scenarios/pit_right_rear.toml");
    step_until(&mut harness, "the forecasts", |state| {
        let session = &state.session;
        let is_told =
            session.response.forecast.ok().is_some() && session.force.forecast.ok().is_some();
        is_idle(state) && is_told && !session.is_waiting()
    });
    let outcome = |harness: &Harness<'_, App>| {
        let chain = state(harness).chain();
        let link = chain.into_iter().find(|link| link.title == "Outcome").expect("an outcome");
        link.figure
    };
    assert!(outcome(&harness).is_some());

    // The striking vehicle is moved to where it meets nothing.
    let project = &mut harness.state_mut().state_mut().project;
    let scenario = project.impact.scenario.inline_mut().expect("a scenario that is not a file");
    scenario.contact.location =
        ContactLocation::Footprints { striking_x_world_m: -40.0, striking_y_world_m: 0.0 };
    step_until(&mut harness, "the refusal", |state| {
        is_idle(state) && state.session.analysis.problem().is_some() && !state.session.is_waiting()
    });
    let session = &state(&harness).session;
    assert!(session.response.forecast.ok().is_none(), "a forecast of another collision is shown");
    assert!(session.force.forecast.ok().is_none(), "a force of another collision is shown");
    assert_eq!(outcome(&harness), None);
    apply(&mut harness, Command::Show(Pane::ForcePrediction));
    harness.run_steps(4);
    harness.get_by_label_contains("There is no collision to predict");
    assert!(harness.query_by_label("Predicting…").is_none());
}

#[test]
fn at_the_first_start_no_case_is_chosen_and_the_window_says_what_to_do() {
    let mut harness = open(&[]);
    step_until(&mut harness, "the shipped data", |state| {
        !state.session.sources.is_empty()
            && state.session.sources.iter().all(impactlab::app::Source::is_settled)
    });
    assert_eq!(state(&harness).project.subject(), None);
    harness.get_by_label("No case chosen");
    harness.get_by_label("Begin with one of the three ways below");
    harness.get_by_label_contains("New here? Set up a collision");
    harness.get_by_label("Look through the shipped data").click();
    harness.run_steps(4);
    assert_eq!(state(&harness).project.subject(), None, "data are looked at, not taken");
    harness.get_by_label_contains("click one to see it");
    harness.get_by_label("see the ways to begin").click();
    harness.run_steps(4);
    harness.get_by_label("Set up a collision").click();
    harness.run_steps(4);
    step_until(&mut harness, "the scenario", is_idle);
    let figure = state(&harness).chain().into_iter().next().and_then(|link| link.figure);
    assert_eq!(figure.as_deref(), Some("PIT, right rear quarter"));
}

/// Writes a log without a forward speed into a folder.
fn log_in(folder: &Path) -> PathBuf {
    let path = folder.join("log.csv");
    let row = |i: i32| {
        let time_s = 0.1 * f64::from(i);
        format!("{time_s:.1},{:.2},0.00,10.00,0.000", 10.0 * time_s)
    };
    let rows: Vec<String> = (0..60).map(row).collect();
    let header = "time_s,x_m,y_m,speed_m_s,yaw_rate_rad_s";
    std::fs::write(&path, format!("{header}\n{}\n", rows.join("\n"))).expect("a file");
    path
}

/// “Working…” stood there until all data that come with the program had been read.
#[test]
fn a_file_that_is_opened_is_shown_while_other_data_are_being_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = log_in(folder.path());
    let mut harness = open(&[]);
    let never = Source::loading(folder.path().join("large"), None);
    harness.state_mut().state_mut().session.sources.push(never);
    apply(&mut harness, Command::Open(vec![path.clone()]));
    step_until(&mut harness, "the log", |state| {
        state.project.subject() == Some(Subject::File(path.clone()))
    });
    assert!(!state(&harness).session.sources.iter().all(Source::is_settled));
}

/// A log without the forward speed was said to have no recorded motion, beside two empty plots.
#[test]
fn a_log_that_cannot_be_simulated_says_why_and_has_no_empty_plots() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = log_in(folder.path());
    let mut harness = open(&[path.to_str().expect("a plain name")]);
    step_until(&mut harness, "the log", shows("log"));
    apply(&mut harness, Command::Show(Pane::Comparison));
    harness.run_steps(4);
    for text in ["the file has no column vx_m_s (v_x)", "There is no simulation that could be"] {
        assert!(harness.query_by_label_contains(text).is_some(), "{text}");
    }
    apply(&mut harness, Command::Show(Pane::Motion));
    harness.run_steps(4);
    assert!(harness.query_by_label("v_x").is_none(), "an empty plot");
    assert!(harness.query_all_by_label_contains("Yaw rate").next().is_some());
}
