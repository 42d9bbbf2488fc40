//! What of the state is stored between runs.

use std::path::PathBuf;
use std::time::Duration;

use crate::app::force::collision_of;
use crate::app::state::*;
use crate::app::{
    Command, Content, Dialog, Measure, Measurement, Measuring, Output, Pane, Source, TaskKey,
    VariantCommand, Workspace, Workspaces,
};
use impactlab_core::collision::{ChannelClass, Role};
use impactlab_core::data::{Existing, Severity};
use impactlab_core::units::UnitSystem;
use impactlab_study::case_file::{CaseFile, Variant};
use impactlab_study::{
    Drive, EvidenceChoice, ModelChoice, MotionSource, ReconstructRequest, SeriesFile,
    SimulateRequest, VehicleChoice,
};

#[test]
fn project_and_view_survive_a_restart() {
    let mut state = State::default();
    state.select(Subject::Case { dataset: PathBuf::from("d"), case: "c001".to_owned() });
    state.project.simulate.duration_s = 2.5;
    state.project.beside.channel_class = Some(ChannelClass::Cfc60);
    state.view.units = UnitSystem::Us;
    state.view.filter = "spin=1".to_owned();
    let mut collision = collision_of(&state.project.predict_force, &[]).unwrap();
    collision.numbers.mass_kg[1] = 1234.0;
    collision.put_into(&mut state.project.predict_force);
    state.project.predict_force.model = ModelChoice::file("mine.safetensors");
    state.view.force.bands[0] = false;
    state.session.sources.push(Source::failed(PathBuf::from("a.csv"), "gone".to_owned()));
    // As before every frame: a stored project comes back with its questions in step.
    state.project.keep_in_step();
    let (restored, sources) = State::restore(&state.save().unwrap()).unwrap();
    assert_eq!(restored.project, state.project);
    assert_eq!(restored.view, state.view);
    assert_eq!(sources, [PathBuf::from("a.csv")]);
}

/// After a kill the shipped network answered in the place of one that had just been trained, without a word.
#[test]
fn a_network_that_was_lost_with_the_last_run_is_told() {
    let mut state = State::default();
    state.project.predict_force.model = ModelChoice::held("trained on 60 cases");
    state.project.keep_in_step();
    let (restored, _) = State::restore(&state.save().unwrap()).unwrap();
    assert_eq!(restored.project.predict_force.model, ModelChoice::default());
    let [said] = &restored.session.messages[..] else { panic!("one message") };
    assert!(said.text.contains("\"trained on 60 cases\" of the last run is in no file"));
    let (restored, _) = State::restore(&restored.save().unwrap()).unwrap();
    assert!(restored.session.messages.is_empty());
}

/// A friction that is said of the scenario went on to a recorded log that was selected after it.
#[test]
fn the_road_of_the_scenario_is_not_that_of_a_recording() {
    let mut state = State::default();
    state.select(Subject::Scenario);
    let [friction, sigma] = state.project.road_mut();
    (*friction, *sigma) = (Some(0.3), Some(0.02));
    let of = |state: &State| {
        let simulate = &state.project.simulate;
        [simulate.friction, simulate.friction_sigma]
    };
    for subject in [
        Subject::File(PathBuf::from("log.csv")),
        Subject::Case { dataset: PathBuf::from("d"), case: "c001".to_owned() },
    ] {
        state.select(subject);
        assert_eq!(of(&state), [None; 2]);
        assert_eq!(state.project.road_mut().map(|number| *number), [Some(0.3), Some(0.02)]);
        state.select(Subject::Scenario);
        assert_eq!(of(&state), [Some(0.3), Some(0.02)]);
    }
}

/// Trainings and comparisons had settings of their own, which no question has.
#[test]
fn a_state_with_the_settings_of_earlier_trainings_is_read() {
    let mut state = State::default();
    state.project.simulate.duration_s = 2.5;
    state.project.keep_in_step();
    let mut saved: serde_json::Value = serde_json::from_str(&state.save().unwrap()).unwrap();
    let project = saved["project"].as_object_mut().unwrap();
    assert!(project.remove("networks").is_some());
    let training = serde_json::json!({ "dataset": null, "seed": 7, "config": "" });
    project.insert("force_training".to_owned(), training);
    project.insert("comparison".to_owned(), serde_json::json!({ "trajectories": "5, x" }));
    let (restored, _) = State::restore(&saved.to_string()).unwrap();
    assert_eq!(restored.project, state.project);
}

#[test]
fn a_layout_without_the_newer_panes_is_put_back() {
    let mut state = State::default();
    let tiles = &mut state.view.workspaces.layout_mut(Workspace::Models).tiles;
    let pane =
        |tile: &egui_tiles::Tile<Pane>| matches!(tile, egui_tiles::Tile::Pane(Pane::Training));
    let training = tiles.iter().find(|(_, tile)| pane(tile)).map(|(id, _)| *id).unwrap();
    tiles.remove(training);
    let (restored, _) = State::restore(&state.save().unwrap()).unwrap();
    assert_eq!(restored.view.workspaces, Workspaces::default());
}

#[test]
fn a_damaged_or_foreign_save_is_not_read() {
    let text = State::default().save().unwrap();
    let error = |text: &str| State::restore(text).err().unwrap();
    assert!(matches!(error(&text[..text.len() / 2]), RestoreError::Damaged(_)));
    let later = error(&text.replace("\"version\":2", "\"version\":99"));
    assert!(later.is_of_later_version(), "{later}");
    let earlier = error(&text.replace("\"version\":2", "\"version\":0"));
    assert!(!earlier.is_of_later_version(), "{earlier}");
}

/// A vehicle with a slip was reported as a bad scenario.
#[test]
fn a_file_that_cannot_be_opened_is_told_as_what_it_was_taken_for() {
    let folder = tempfile::tempdir().unwrap();
    let vehicle = include_str!("../../assets/vehicles/target-2000.toml");
    let evidence = include_str!("../../assets/examples/reconstruction.toml");
    for (text, place, kind) in [
        (vehicle.replace("friction = 0.8", "friction = -0.8"), "friction", "a vehicle"),
        (evidence.replace("mass_kg = 1530", "mass_kg = -1"), "mass", "evidence"),
        ("colour = 1\n".to_owned(), "is neither evidence", "a vehicle"),
    ] {
        let path = folder.path().join("file.toml");
        std::fs::write(&path, text).unwrap();
        let (mut state, context) = (State::default(), egui::Context::default());
        state.apply(Command::Open(vec![path]), &context);
        let message = state.session.messages.last().unwrap();
        assert_eq!(message.severity, Severity::Error);
        assert!(message.text.contains(place) && message.text.contains(kind), "{}", message.text);
    }
}

#[test]
fn the_text_of_a_state_follows_every_change_of_it() {
    let (mut state, mut text) = (State::default(), StateText::default());
    let first = text.update(&state).unwrap().to_owned();
    assert_eq!(text.update(&state).unwrap(), first, "nothing has changed");
    state.view.playback_speed = 0.25;
    state.project.simulate.duration_s = 2.5;
    state.project.keep_in_step();
    state.case.file.notes = "seen".to_owned();
    state.session.sources.push(Source::failed(PathBuf::from("a.csv"), "gone".to_owned()));
    let (restored, sources) = State::restore(text.update(&state).unwrap()).unwrap();
    assert_eq!((&restored.view, &restored.project), (&state.view, &state.project));
    assert_eq!((restored.case.file.notes.as_str(), sources), ("seen", vec!["a.csv".into()]));
}

#[test]
fn what_is_known_of_the_case_follows_every_change_of_it() {
    let mut state = State::default();
    state.select(Subject::Scenario);
    let mut is_changed = |change: fn(&mut State)| {
        change(&mut state);
        state.update_known_case();
        let known = state.session.known_case.is_changed;
        assert_eq!(known, state.is_case_changed());
        known
    };
    is_changed(|_| {});
    assert!(is_changed(|state| state.project.simulate.duration_s = 2.5));
    is_changed(|state| {
        state.project.simulate.duration_s = State::default().project.simulate.duration_s;
    });
    assert!(is_changed(|state| state.case.file.notes = "seen".to_owned()));
}

/// A line that was measured in one case was drawn in the film of the next, and the report of that bore the date
/// that was typed for the first.
#[test]
fn what_was_entered_or_made_for_one_case_is_not_in_the_next() {
    let mut state = State::default();
    state.view.report.date = "2026-03-01".to_owned();
    let session = &mut state.session;
    let points_m = vec![[0.0, 0.0], [3.0, 4.0]];
    session.scene.measuring.done.push(Measurement { measure: Measure::Length, points_m });
    session.between.span_s = Some([0.1, 0.2]);
    session.report.problem = Some("no question has an answer".to_owned());
    session.other_variants.entry("copy".to_owned()).or_default();
    let n_cases = session.n_cases;
    state.new_case();
    let session = &state.session;
    assert_eq!(state.view.report.date, "");
    assert_eq!(session.scene.measuring, Measuring::default());
    assert_eq!((session.between.span_s, session.report.problem.as_deref()), (None, None));
    assert!(session.other_variants.is_empty());
    assert_eq!(session.n_cases, n_cases + 1, "fields keep what was typed into them");
}

/// A case that was opened again after its files had been changed showed, and answered, what they had held
/// before.
#[test]
fn a_case_that_is_opened_again_reads_its_files_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (evidence, force, case) = (at("evidence.toml"), at("force.csv"), at("spin.impactlab"));
    let text = include_str!("../../assets/examples/reconstruction.toml");
    std::fs::write(&evidence, text).unwrap();
    let drive = Drive { force: Some(SeriesFile::new(&force)), ..Drive::default() };
    let simulate = SimulateRequest::new(MotionSource::Drive(drive));
    let reconstruct = ReconstructRequest::new(EvidenceChoice::File(evidence.clone()));
    let questions = vec![simulate.into(), reconstruct.into()];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    CaseFile::new("spin", variant).save(&case, Existing::Refuse).unwrap();
    let (mut state, context) = (State::default(), egui::Context::default());
    let opened = |state: &mut State| {
        state.open_case(&case);
        state.update_reconstruction(&context);
        state.evidence().map(|evidence| evidence.case.clone())
    };
    assert_eq!(opened(&mut state).as_deref(), Some("example"));
    // The force was not there, and is now.
    state.session.sources = vec![Source::failed(force.clone(), "not there".to_owned())];
    std::fs::copy("datasets/fea/forces/c001.csv", &force).unwrap();
    std::fs::write(&evidence, text.replace("\"example\"", "\"corrected\"")).unwrap();
    assert_eq!(opened(&mut state).as_deref(), Some("corrected"));
    let [source] = &state.session.sources[..] else { panic!("one source") };
    assert!(source.path == force && matches!(source.content, Content::Loading));
}

/// The Vehicle pane had the mass that the file had when it was opened for the first time, and the speeds of a
/// reconstruction with this car stayed.
#[test]
fn a_vehicle_that_is_opened_again_is_shown_as_its_file_is_now() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("car.toml");
    let text = include_str!("../../assets/vehicles/target-2000.toml");
    let (mut state, context) = (State::default(), egui::Context::default());
    for mass_kg in [2000.0, 2100.0] {
        let edited = text.replace("\nmass_kg = 2000.0", &format!("\nmass_kg = {mass_kg:.1}"));
        std::fs::write(&path, edited).unwrap();
        let striking = VehicleChoice::File(path.clone());
        let evidence = EvidenceChoice::File(folder.path().join("evidence.toml"));
        let reconstruct = ReconstructRequest { striking, ..ReconstructRequest::new(evidence) };
        state.project.reconstruct = Some(reconstruct);
        state.session.reconstruction.n_answers = 1;
        state.apply(Command::Open(vec![path.clone()]), &context);
        assert_eq!(state.session.reconstruction.n_answers, 0);
        state.session.chosen_vehicles.update(&state.project);
        let shown = state.session.chosen_vehicles.get(Role::Struck).unwrap();
        assert_eq!(shown.mass.mass_kg, mass_kg);
    }
}

/// A report of 1530 kg was saved after the evidence had been corrected to 1600 kg and opened again.
#[test]
fn a_report_is_not_of_the_case_once_a_file_of_it_is_opened_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("evidence.toml");
    let text = include_str!("../../assets/examples/reconstruction.toml");
    std::fs::write(&path, text).unwrap();
    let (mut state, context) = (State::default(), egui::Context::default());
    state.view.report.date = "2026-03-01".to_owned();
    state.apply(Command::Open(vec![path.clone()]), &context);
    let made_of = state.report_origin().unwrap();
    state.apply(Command::Open(vec![folder.path().join("beside.csv")]), &context);
    assert_eq!(state.report_origin().unwrap(), made_of);
    std::fs::write(&path, text.replace("mass_kg = 1530", "mass_kg = 1600")).unwrap();
    state.apply(Command::Open(vec![path]), &context);
    assert_eq!(state.report_origin().unwrap().fingerprint, made_of.fingerprint);
    assert_ne!(state.report_origin().unwrap(), made_of);
}

/// A training that ended after another case was opened put its network into the questions of that.
#[test]
fn a_case_that_is_opened_during_a_training_keeps_its_networks() {
    let mut state = State::default();
    let subject = Subject::Case { dataset: PathBuf::from("d"), case: "c001".to_owned() };
    state.select(subject.clone());
    let n_cases = state.session.n_cases;
    assert!(state.takes_trained(n_cases));
    state.new_case();
    state.select(subject);
    assert!(!state.takes_trained(n_cases) && state.takes_trained(state.session.n_cases));
    state.say_of_training("trained on 60 cases", true, None, n_cases);
    let said = &state.session.messages.last().unwrap().text;
    assert!(said.contains("no answer of this case, opened meanwhile"), "{said}");
    state.select(Subject::Scenario);
    assert!(!state.takes_trained(state.session.n_cases));
}

/// The forms had what was open before, under the name of a case whose variant cannot be read.
#[test]
fn a_variant_that_cannot_be_shown_leaves_nothing_of_another_in_the_forms() {
    let mut state = State::default();
    state.select(Subject::Scenario);
    let bad = Variant { name: "bad".to_owned(), view: 3.into(), ..Variant::default() };
    state.case.file.variants.push(bad.clone());
    state.change_variant(VariantCommand::Show("bad".to_owned()));
    assert_eq!(state.project.subject(), None);
    assert!(state.session.messages.iter().any(|of| of.text.contains("cannot be shown")));
    assert_eq!(state.case.with_shown(&state.project).variant("bad"), Some(&bad));
}

/// A case that was dropped onto the window while it asked whether to replace a file was saved over that.
#[test]
fn a_file_of_one_case_is_not_replaced_by_the_next() {
    let mut state = State::default();
    let path = PathBuf::from("first.impactlab");
    state.session.dialogs.open(Dialog::Replace(Output::Case, path));
    state.new_case();
    assert!(!state.session.dialogs.is_any_open());
}

/// The case that was opened while another was being written got the file of that, and was saved over it.
#[test]
fn a_case_that_is_written_while_another_is_opened_keeps_its_file_to_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("first.impactlab");
    let mut state = State::default();
    state.save_case(path.clone(), Existing::Replace);
    state.new_case();
    let context = egui::Context::default();
    for _ in 0..2000 {
        for command in state.session.tasks.poll() {
            state.apply(command, &context);
        }
        if !state.session.tasks.is_running(&TaskKey::SaveCase) {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(path.exists());
    assert_eq!(state.case.path, None);
    assert_eq!(state.view.recent, [path]);
}
