//! How stiff the faces of both cars are, typed into their forms.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use impactlab::app::{App, Command, Output, Pane, State};
use impactlab_core::collision::Role as CarRole;
use impactlab_core::uncertainty::CaveatKind;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{CrushFace, CrushStiffness, DataSheet, built_in_vehicle};
use impactlab_study::VehicleChoice;
use impactlab_study::case_file::CaseFile;

use crate::harness::{apply, ask_few_draws, is_forecast, is_idle, open, state, step_until};
use crate::import::choose;
use crate::pictures::save;

const SCENARIO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");

/// The sheets of the struck and of the striking vehicle.
fn sheets(state: &State) -> [DataSheet; 2] {
    let simulate = &state.project.simulate;
    [&simulate.vehicle, &simulate.striking].map(|choice| match choice {
        VehicleChoice::Sheet(sheet) => DataSheet::clone(sheet),
        other => panic!("{other:?} is no sheet"),
    })
}

fn front(state: &State) -> [Option<CrushStiffness>; 2] {
    sheets(state).map(|sheet| sheet.crush.face(CrushFace::Front))
}

/// The scenario with both vehicles in their forms, and its forecast of few draws.
fn with_forms() -> Harness<'static, App> {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    ask_few_draws(&mut harness);
    apply(&mut harness, Command::Show(Pane::Vehicle));
    harness.run_steps(4);
    for _ in 0..2 {
        harness.query_all_by_label("Edit a copy").next().expect("a copy").click();
        harness.run_steps(4);
    }
    step_until(&mut harness, "the forecast of the sheets", is_forecast);
    harness
}

/// One vehicle has one mass: the scenario takes that of the car, and says where it says otherwise.
#[test]
fn a_car_that_is_chosen_is_the_car_of_the_scenario() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    apply(&mut harness, Command::Show(Pane::Vehicle));
    harness.run_steps(4);
    let before = state(&harness).project.clone();
    harness.get_by_role_and_label(Role::ComboBox, "Struck vehicle").click();
    harness.run_steps(4);
    for cell in ["Class", "Year", "2020", "suv"] {
        assert!(harness.query_all_by_label(cell).next().is_some(), "{cell}");
    }
    save(&mut harness, "vehicle-list.png");
    choose(&mut harness, ("Struck vehicle", 0), "Toyota Corolla 2020");
    step_until(&mut harness, "the simulation of the Corolla", is_idle);
    let corolla = built_in_vehicle("toyota-corolla-2020").unwrap();
    let struck =
        |harness: &Harness<'_, App>| state(harness).project.scenario().unwrap().struck.clone();
    assert_eq!(struck(&harness).mass_kg, corolla.mass.mass_kg);
    assert_eq!(struck(&harness).length_m, corolla.geometry.outer_length_m);
    let said = state(&harness).session.messages.last().expect("what was replaced");
    assert!(said.text.contains("instead of 2000"), "{}", said.text);
    save(&mut harness, "vehicle-chosen.png");

    apply(&mut harness, Command::Show(Pane::Scenario));
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("back to").is_none());
    harness.query_all_by_role_and_label(Role::SpinButton, "Mass").next().expect("a field").focus();
    typed(&mut harness, "1,9 t");
    assert_eq!(struck(&harness).mass_kg, 1900.0);
    assert!(
        struck(&harness).yaw_inertia_kg_m2 > 1.2 * corolla.mass.yaw_inertia_kg_m2,
        "it is estimated"
    );
    step_until(&mut harness, "the simulation of a loaded one", is_idle);
    let caveats = &state(&harness).analysis().expect("an answer").report.caveats;
    assert!(caveats.has(CaveatKind::OtherVehicle), "{caveats:?}");
    harness.get_by_label_contains("back to").scroll_to_me();
    harness.run_steps(4);
    save(&mut harness, "scenario-override.png");
    harness.get_by_label_contains("back to").click();
    harness.run_steps(4);
    assert_eq!(struck(&harness).mass_kg, corolla.mass.mass_kg);
    assert!(harness.query_by_label_contains("back to").is_none(), "the inertia goes with it");
    for _ in 0..3 {
        apply(&mut harness, Command::Undo);
    }
    harness.run_steps(4);
    let now = &state(&harness).project;
    assert_eq!(
        (&now.simulate.vehicle, now.scenario()),
        (&before.simulate.vehicle, before.scenario())
    );
}

#[test]
fn what_a_chosen_car_replaces_is_told_in_the_units_of_the_case() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the scenario", is_idle);
    harness.state_mut().state_mut().view.units = UnitSystem::Us;
    let car = Box::new(VehicleChoice::named("toyota-corolla-2020"));
    apply(&mut harness, Command::ChooseVehicle(CarRole::Struck, car));
    let said = state(&harness).session.messages.last().expect("what was replaced");
    assert!(said.text.contains(" lb instead of 4409"), "{}", said.text);
    assert!(!said.text.contains(" kg"), "{}", said.text);
}

/// The list took the focus back before it asked whether its search was entered.
#[test]
fn a_car_is_chosen_by_the_keyboard_alone() {
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Show(Pane::Vehicle));
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::ComboBox, "Struck vehicle").click();
    harness.run_steps(4);
    typed(&mut harness, "corolla");
    let vehicle = &state(&harness).project.simulate.vehicle;
    assert_eq!(*vehicle, VehicleChoice::Preset("toyota-corolla-2020".to_owned()));
}

#[test]
fn the_scenario_follows_a_vehicle_that_is_edited() {
    let mut harness = with_forms();
    let striking =
        |harness: &Harness<'_, App>| state(harness).project.scenario().unwrap().striking.clone();
    let before = striking(&harness);
    let [_, sheet] = sheets(state(&harness));
    assert_eq!(sheet.vehicle().mass.mass_kg, before.mass_kg);
    let fields: Vec<_> = harness.query_all_by_role_and_label(Role::SpinButton, "mass").collect();
    assert_eq!(fields.len(), 2, "a row in each form");
    fields[1].focus();
    drop(fields);
    // Any unit may be typed.
    typed(&mut harness, "4100 lb");
    let [_, sheet] = sheets(state(&harness));
    let mass_kg = 4100.0 * 0.453_592_37;
    assert!((sheet.vehicle().mass.mass_kg - mass_kg).abs() < 1e-6, "{sheet:?}");
    assert!((striking(&harness).mass_kg - mass_kg).abs() < 1e-6, "{:?}", striking(&harness));
    assert_eq!(striking(&harness).length_m, before.length_m, "what it says otherwise stays");
}

/// Brings the struck or the striking vehicle's row of the front into view and ticks it or unticks it.
fn tick_front(harness: &mut Harness<'_, App>, vehicle: usize) {
    let boxes: Vec<_> = harness.query_all_by_role_and_label(Role::CheckBox, "front").collect();
    assert_eq!(boxes.len(), 2, "both vehicles have a front");
    boxes[vehicle].scroll_to_me();
    drop(boxes);
    harness.run_steps(4);
    let boxes: Vec<_> = harness.query_all_by_role_and_label(Role::CheckBox, "front").collect();
    boxes[vehicle].click_accesskit();
    drop(boxes);
    harness.run_steps(4);
}

fn type_into(harness: &mut Harness<'_, App>, label: &str, typed_text: &str) {
    harness.query_all_by_label(label).next().expect(label).focus();
    typed(harness, typed_text);
}

/// Types into the field that has the focus.
fn typed(harness: &mut Harness<'_, App>, text: &str) {
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.key_press(egui::Key::Delete);
    harness.run_steps(2);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(4);
}

fn report(state: &State) -> serde_json::Value {
    let answer = state.session.response.forecast.ok().expect("a forecast");
    let mut report = serde_json::to_value(&answer.answer.report).expect("JSON");
    // The provenance holds the question, which differs in any case.
    report.as_object_mut().expect("an object").remove("provenance");
    report
}

#[test]
fn a_stiffness_that_is_typed_is_that_of_the_forecast_and_of_the_saved_case() {
    let mut harness = with_forms();
    let by_class = report(state(&harness));
    assert_eq!(front(state(&harness)), [None; 2]);
    tick_front(&mut harness, 1);
    let [struck, striking] = front(state(&harness));
    let of_class = striking.expect("the striking vehicle's front is known now");
    assert_eq!(struck, None);
    type_into(&mut harness, "front A, onset", "60.4");
    type_into(&mut harness, "front B, growth", "2500");
    let typed = CrushStiffness { onset_n_per_m: 60_400.0, stiffness_n_per_m2: 2.5e6 };
    assert_eq!(front(state(&harness)), [None, Some(typed)]);
    step_until(&mut harness, "the forecast with a stiff front", is_forecast);
    let stiff = report(state(&harness));
    assert_ne!(stiff, by_class, "the forecast follows from the stiffness");
    save(&mut harness, "vehicle-form-crush.png");

    // Beyond the range it is refused, with the range.
    type_into(&mut harness, "front A, onset", "-3");
    assert_eq!(front(state(&harness)), [None, Some(typed)]);
    let refusal = harness.get_by_label_contains("not possible, 60.40 stays");
    let text = refusal.accesskit_node().value().expect("a text");
    assert!(text.contains("0 to 1") && text.contains("kN/m"), "{text}");

    // The saved case has it, and opens with it.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("stiff.impactlab");
    apply(&mut harness, Command::Write(Output::Case, path.clone()));
    step_until(&mut harness, "the case on disk", |state| state.case.path.is_some());
    assert!(CaseFile::load(&path).is_ok());
    let mut again = open(&[path.to_str().expect("text")]);
    step_until(&mut again, "the forecast of the case", is_forecast);
    assert_eq!(front(state(&again)), [None, Some(typed)]);
    assert_eq!(report(state(&again)), stiff);

    // As does a vehicle file.
    let path = folder.path().join("stiff.toml");
    let [_, sheet] = sheets(state(&harness));
    apply(&mut harness, Command::Write(Output::Vehicle(Box::new(sheet)), path.clone()));
    let text = std::fs::read_to_string(&path).expect("a vehicle file");
    assert!(text.contains("[crush.front]\nonset_n_per_m = 60400.0\n"), "{text}");

    // Without the tick the face is that of its class again; undo brings back what was typed.
    harness.run_steps(90);
    tick_front(&mut harness, 1);
    assert_eq!(front(state(&harness)), [None; 2]);
    step_until(&mut harness, "the forecast by class", is_forecast);
    assert_eq!(report(state(&harness)), by_class);
    harness.run_steps(90);
    apply(&mut harness, Command::Undo);
    assert_eq!(front(state(&harness)), [None, Some(typed)]);
    assert_ne!(of_class, typed);
}

#[test]
fn a_stiffness_is_typed_in_pounds_and_inches() {
    let mut harness = with_forms();
    harness.state_mut().state_mut().view.units = UnitSystem::Us;
    harness.run_steps(4);
    tick_front(&mut harness, 0);
    type_into(&mut harness, "front A, onset", "345");
    type_into(&mut harness, "front B, growth", "113");
    let [typed, striking] = front(state(&harness));
    let CrushStiffness { onset_n_per_m, stiffness_n_per_m2 } = typed.expect("typed");
    // 1 lbf is 4.448 222 N, 1 in is 25.4 mm.
    assert!((onset_n_per_m / (345.0 * 4.448_222 / 0.0254) - 1.0).abs() < 1e-6);
    assert!((stiffness_n_per_m2 / (113.0 * 4.448_222 / 0.0254 / 0.0254) - 1.0).abs() < 1e-6);
    assert_eq!(striking, None);
    save(&mut harness, "vehicle-form-crush-us.png");
}

/// A trainer says where the bumper touches and how fast the cars close.
#[test]
fn an_approach_that_is_typed_places_the_contact_and_moves_the_striking_car() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    apply(&mut harness, Command::Show(Pane::Scenario));
    harness.run_steps(4);
    let scenario = |harness: &Harness<'_, App>| state(harness).project.scenario().unwrap().clone();
    let before = scenario(&harness);
    type_into(&mut harness, "Contact ahead of rear bumper", "0.9 m");
    type_into(&mut harness, "Striking vehicle faster by", "2 m/s");
    type_into(&mut harness, "Closing speed across", "3 m/s");
    let after = scenario(&harness);
    let approach = after.side_approach().unwrap();
    let typed = [approach.ahead_of_rear_m, approach.faster_m_s, approach.closing_m_s];
    for (typed, expected) in typed.into_iter().zip([0.9, 2.0, 3.0]) {
        assert!((typed - expected).abs() < 1e-9, "{approach:?}");
    }
    assert_eq!(after.struck, before.struck);
    assert_eq!(after.striking.heading_rad, before.striking.heading_rad);
    step_until(&mut harness, "the other collision", is_idle);
    save(&mut harness, "scenario-approach.png");
    apply(&mut harness, Command::Undo);
    assert_ne!(scenario(&harness), after, "an edit can be taken back");
}

/// Two numbers that were typed within a second were taken back together, and Ctrl+Z in a field with nothing
/// typed into it did what it does elsewhere only after that had lost the focus.
#[test]
fn each_number_that_is_typed_is_undone_by_itself() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    apply(&mut harness, Command::Show(Pane::Scenario));
    harness.run_steps(4);
    let numbers = |harness: &Harness<'_, App>| {
        let struck = &state(harness).project.scenario().expect("a scenario").struck;
        [struck.heading_rad, struck.yaw_rate_rad_s].map(|value| (value * 1e9).round() / 1e9)
    };
    let before = numbers(&harness);
    harness.query_all_by_label("Heading").next().expect("a field").focus();
    harness.run_steps(2);
    for text in ["0.05 rad", "0.1 rad/s"] {
        harness.event(egui::Event::Text(text.to_owned()));
        harness.run_steps(2);
        // To the next field, without a pause.
        harness.key_press(egui::Key::Tab);
        harness.run_steps(3);
    }
    assert_eq!(numbers(&harness), [0.05, 0.1]);
    let undo = |harness: &mut Harness<'_, App>| {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(3);
    };
    undo(&mut harness);
    assert_eq!(numbers(&harness), [0.05, before[1]]);
    // What is being typed is undone before anything else.
    harness.event(egui::Event::Text("7".to_owned()));
    harness.run_steps(2);
    undo(&mut harness);
    assert_eq!(numbers(&harness), [0.05, before[1]]);
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    undo(&mut harness);
    assert_eq!(numbers(&harness), before);
}
