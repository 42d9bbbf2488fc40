//! Workspaces, the ways to begin, the contents of the case, variants side by side, and vehicles and
//! scenarios that are changed by hand.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Group, Output, Pane, Subject, VariantCommand, Workspace};
use impactlab_core::vehicle::{Braking, DataSheet, Ending, LibraryVehicle, SheetQuantity};
use impactlab_study::{Drive, MotionSource, VehicleChoice};

use crate::harness::{
    apply, ask_few_draws, is_forecast, is_idle, open, open_with, open_with_few_draws, state,
    step_until,
};
use crate::pictures::save;

const SCENARIO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");
const FEA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");

fn contents_of(harness: &Harness<'_, App>) -> Vec<impactlab::app::ContentsEntry> {
    let state = state(harness);
    state.contents(&state.chain())
}

#[test]
fn a_newcomer_gets_to_a_forecast_by_each_of_the_three_doors() {
    let mut harness = open(&[]);
    harness.run_steps(3);
    save(&mut harness, "doors.png");
    harness.get_by_label("Set up a collision").click();
    harness.run_steps(3);
    step_until(&mut harness, "the forecast of the PIT", is_forecast);
    assert_eq!(state(&harness).project.subject(), Some(Subject::Scenario));
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Case);
    save(&mut harness, "workspace-case.png");
    harness.get_by_label("Motion forecast").click();
    harness.run_steps(4);
    assert!(harness.query_all_by_label("drawn motions").next().is_some());
    save(&mut harness, "workspace-case-forecast.png");

    apply(&mut harness, Command::ShowDoors);
    harness.get_by_label("Look at the example case").click();
    harness.run_steps(3);
    step_until(&mut harness, "all variants of the example", |state| {
        let variants = state.answered_variants();
        variants.len() == 3 && variants.iter().all(|of| of.forecast.is_some() && !of.is_waiting)
    });
    assert!(!state(&harness).is_case_changed(), "the example is as it was opened");
    apply(&mut harness, Command::Show(Pane::Variants));
    harness.run_steps(3);
    // The answer stands before what it was made from.
    let left = |label: &str| harness.get_by_label(label).rect().left();
    assert!(left("Forecast: X (90 %)") < left("Δv with tires"));
    save(&mut harness, "variants.png");

    apply(&mut harness, Command::ShowDoors);
    harness.get_by_label("Look through the shipped data").click();
    harness.run_steps(3);
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Data);
    apply(&mut harness, Command::Open(vec![FEA.into()]));
    // Data lie beside the variant until they are taken into it.
    step_until(&mut harness, "the data", |state| {
        state.session.offered.is_some() && !state.session.sources.is_empty()
    });
    assert_eq!(state(&harness).project.subject(), Some(Subject::Scenario));
    harness.run_steps(3);
    save(&mut harness, "offer.png");
    let before = state(&harness).project.clone();
    harness.get_by_label("Leave it beside").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Use in this variant").is_none());
    assert_eq!(state(&harness).project, before);
    apply(&mut harness, Command::Open(vec![FEA.into()]));
    step_until(&mut harness, "the data again", |state| state.session.offered.is_some());
    harness.run_steps(3);
    harness.get_by_label("Use in this variant").click();
    step_until(&mut harness, "a case", |state| {
        matches!(state.project.subject(), Some(Subject::Case { .. })) && is_forecast(state)
    });
}

#[test]
fn the_ways_to_begin_are_shown_at_the_first_start_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.json");
    let mut harness = open_with(&[], Some(file.clone()));
    harness.run_steps(2);
    assert!(state(&harness).session.shows_doors);
    harness.get_by_label("Set up a collision").click();
    harness.run_steps(90);
    step_until(&mut harness, "the stored state", |_| file.exists());
    drop(harness);
    let mut harness = open_with(&[], Some(file));
    harness.run_steps(2);
    assert!(!state(&harness).session.shows_doors);
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Case);
}

#[test]
fn the_contents_name_what_is_missing_and_lead_to_it() {
    let mut harness = open_with_few_draws(SCENARIO);
    let contents = contents_of(&harness);
    for &group in Group::ALL {
        assert!(contents.iter().any(|entry| entry.group == group), "{group:?}");
    }
    let impact = contents.iter().find(|entry| entry.group == Group::Impact).unwrap();
    assert_eq!((impact.detail.as_str(), &impact.missing), ("PIT, right rear quarter", &None));
    harness.get_by_label_contains("Struck: left open").click();
    harness.run_steps(3);
    harness.get_by_label("Integration");
    // What a scenario says itself is not asked for a second time.
    assert!(harness.query_by_label("For single files").is_none());
    let of = |label: &str| contents.iter().find(|entry| entry.label == label).unwrap();
    assert!(of("After the impact").detail.starts_with("coasts, "), "{:?}", of("After the impact"));
    assert!(matches!(of("Road").command, Command::Show(Pane::Scenario)), "{:?}", of("Road"));
    harness.state_mut().state_mut().project.simulate.source = MotionSource::default();
    harness.run_steps(3);
    let contents = contents_of(&harness);
    let impact = contents.iter().find(|entry| entry.group == Group::Impact).unwrap();
    assert!(impact.missing.as_ref().unwrap().contains("choose a scenario"), "{impact:?}");
    // A car that only steers comes from no impact.
    let fishhook = Drive { fishhook: true, ..Drive::default() };
    harness.state_mut().state_mut().project.simulate.source = MotionSource::Drive(fishhook);
    let contents = contents_of(&harness);
    let scene: Vec<&str> = contents
        .iter()
        .filter(|entry| entry.group == Group::Scene)
        .map(|entry| &*entry.label)
        .collect();
    assert!(scene.contains(&"From the start"), "{scene:?}");
    assert!(!scene.contains(&"After the impact"), "{scene:?}");
}

/// A line that came with the answer pushed them away from the pointer.
#[test]
fn the_tools_of_the_scene_stay_where_they_are_when_an_answer_comes() {
    let mut harness = open_with_few_draws(SCENARIO);
    let top = |harness: &Harness<'_, App>| harness.get_by_label("Measure").rect().top();
    let before = top(&harness);
    let project = &mut harness.state_mut().state_mut().project;
    (project.simulate.until_rest, project.simulate.duration_s) = (true, 30.0);
    let brake = Some(Braking::new(0.5, 0.8, 0.2));
    project.scenario_mut().expect("a scenario").ending =
        Some(Ending { brake, ..Ending::default() });
    harness.run_steps(2);
    step_until(&mut harness, "the forecast to rest", is_forecast);
    assert!(harness.query_by_label_contains("At rest after").is_some());
    assert!((top(&harness) - before).abs() < 0.5, "{before} {}", top(&harness));
}

#[test]
fn variants_are_drawn_over_each_other_and_the_choice_is_kept() {
    let mut harness = open_with_few_draws(SCENARIO);
    apply(&mut harness, Command::Variant(VariantCommand::Duplicate));
    let edited = harness.state_mut().state_mut().project.scenario_mut().expect("a scenario");
    edited.striking.vy_world_m_s *= 1.3;
    harness.run_steps(2);
    step_until(&mut harness, "both variants", |state| {
        let variants = state.answered_variants();
        variants.iter().all(|of| of.simulation.is_some() && of.forecast.is_some())
            && is_forecast(state)
    });
    let ends: Vec<_> = state(&harness)
        .answered_variants()
        .iter()
        .map(|of| of.simulation.as_ref().unwrap().report.end.unwrap().x_m)
        .collect();
    assert!((ends[1] - ends[0]).abs() > 0.5, "the harder hit ends elsewhere: {ends:?}");
    harness.run_steps(3);
    save(&mut harness, "variants-overlaid.png");
    // What is shown beside is what the other variant answers by itself.
    let beside = ends[0];
    apply(&mut harness, Command::Variant(VariantCommand::Show("base".to_owned())));
    step_until(&mut harness, "the first variant", is_idle);
    assert_eq!(state(&harness).analysis().unwrap().report.end.unwrap().x_m, beside);
    harness.state_mut().state_mut().view.shows_all_variants = false;
    harness.run_steps(3);
    assert!(state(&harness).session.other_variants.is_empty());
}

#[test]
fn a_vehicle_is_edited_in_a_form_and_the_answer_is_that_of_its_saved_file() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    ask_few_draws(&mut harness);
    apply(&mut harness, Command::Show(Pane::Vehicle));
    let id = LibraryVehicle::ALL[0].id();
    harness.state_mut().state_mut().project.simulate.vehicle = VehicleChoice::Preset(id.to_owned());
    harness.run_steps(3);
    let buttons: Vec<_> = harness.query_all_by_label("Edit a copy").collect();
    buttons[0].click();
    drop(buttons);
    harness.run_steps(4);
    let VehicleChoice::Sheet(sheet) = &mut harness.state_mut().state_mut().project.simulate.vehicle
    else {
        panic!("a copy is in the form")
    };
    assert_eq!(
        Some(&**sheet),
        DataSheet::from_parameters(&LibraryVehicle::ALL[0].parameters()).as_ref()
    );
    sheet.set(SheetQuantity::CgHeight, 0.6);
    let sheet = sheet.clone();
    step_until(&mut harness, "the edited vehicle", is_forecast);
    save(&mut harness, "vehicle-form.png");
    let in_form = state(&harness).analysis().unwrap().report.clone();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("edited.toml");
    apply(&mut harness, Command::Write(Output::Vehicle(sheet), path.clone()));
    harness.state_mut().state_mut().project.simulate.vehicle = VehicleChoice::File(path);
    harness.run_steps(3);
    step_until(&mut harness, "the saved vehicle", is_idle);
    let of_file = state(&harness).analysis().unwrap().report.clone();
    assert_eq!(of_file.end, in_form.end);
    assert_eq!(of_file.vehicle, in_form.vehicle);
    assert_eq!(of_file.uncertainty, in_form.uncertainty);
}

#[test]
fn cars_are_dragged_in_the_plan() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    apply(&mut harness, Command::Show(Pane::Scenario));
    harness.run_steps(4);
    let before = state(&harness).project.impact.clone();
    // The struck vehicle's CG is in the middle between its ends; the plan is the only plot of the
    // pane.
    let plan = harness.get_by_label_contains("Drag a dot").rect();
    let centre = egui::pos2(plan.center().x, plan.min.y - 120.0);
    let mut n_changed = 0;
    for dx in [-90.0_f32, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0] {
        let from = centre + egui::vec2(dx, 0.0);
        drag(&mut harness, from, from + egui::vec2(14.0, 9.0));
        n_changed += usize::from(state(&harness).project.impact != before);
        harness.state_mut().state_mut().project.impact = before.clone();
        harness.run_steps(2);
    }
    assert!(n_changed > 0, "no handle was met");
    save(&mut harness, "scenario-plan.png");
}

fn drag(harness: &mut Harness<'_, App>, from: egui::Pos2, to: egui::Pos2) {
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    harness.event(egui::Event::PointerMoved(from));
    harness.run_steps(1);
    harness.event(button(from, true));
    harness.run_steps(2);
    harness.event(egui::Event::PointerMoved(to));
    harness.run_steps(2);
    harness.event(button(to, false));
    harness.run_steps(2);
}

#[test]
fn a_recording_is_drawn_over_the_motion_with_an_offset_and_kept_with_the_case() {
    const RECORD: &str =
        concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea/trajectories/FE_c001.csv");
    let mut harness = open(&[RECORD]);
    step_until(&mut harness, "the recording", is_idle);
    apply(&mut harness, Command::Open(vec![SCENARIO.into()]));
    step_until(&mut harness, "the scenario", is_forecast);
    apply(&mut harness, Command::Show(Pane::Motion));
    harness.run_steps(3);
    harness.get_by_label("Recording").click();
    harness.run_steps(3);
    harness.get_by_label("FE_c001.csv").click();
    harness.run_steps(3);
    let chosen = &mut harness.state_mut().state_mut().project.beside.recording;
    chosen.as_mut().expect("the recording is chosen").offset_s = 0.5;
    harness.run_steps(3);
    save(&mut harness, "recording-overlaid.png");
    let sources = state(&harness).project.sources();
    assert!(sources.iter().any(|file| file.path.ends_with("FE_c001.csv")), "{sources:?}");
}

#[test]
fn two_cursors_give_the_numbers_between_them() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    harness.run_steps(4);
    let hint = harness.get_by_label_contains("Shift + drag").rect();
    let from = egui::pos2(hint.min.x + 40.0, hint.max.y + 70.0);
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::SHIFT));
    drag(&mut harness, from, from + egui::vec2(90.0, 0.0));
    let span = state(&harness).session.between.span_s;
    let [start, end] = span.expect("two cursors");
    assert!(end > start && start >= 0.0, "{start} to {end}");
    assert!(harness.query_all_by_label("Integral").next().is_some());
    save(&mut harness, "two-cursors.png");
}

#[test]
fn an_object_that_a_car_strikes_stands_in_the_contents_by_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("wall.toml");
    let text = "name = \"wall\"\n[target]\nvehicle = \"toyota-camry-2018\"\nheading_deg = 0\n\
        speed_km_h = 40\n[bullet]\nfixed = \"wall\"\n[contact]\nfrom = \"side\"\nside = \"front\"\n\
        offset_m = 0\n";
    std::fs::write(&path, text).expect("a file");
    let mut harness = open(&[path.to_str().expect("a plain name")]);
    harness.run_steps(3);
    assert_eq!(state(&harness).project.subject(), Some(Subject::Scenario));
    let contents = contents_of(&harness);
    let striking = contents.iter().find(|entry| entry.label == "Striking").expect("a line");
    assert_eq!(striking.detail, "wall");
}
