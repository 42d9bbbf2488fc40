//! The import dialog: units, the curve as it will be read, what is remembered, what is cancelled.

use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use impactlab::app::{App, Command, State};

use crate::harness::{apply, is_idle, open, open_with, state, step_until};
use crate::pictures::save;

/// A pulse of 60 kN over 0.1 s, as a German measuring program exports it: one component, metadata
/// above, decimal commas.
pub fn german_export(header: &str) -> String {
    let mut text = format!("Prüfstand 3;;\nDatum;17.03.2026;\n{header}\n");
    for i in 0..=120 {
        let share = f64::from(i - 10) / 100.0;
        let force_kn = 60.0 * (std::f64::consts::PI * share.clamp(0.0, 1.0)).sin();
        let (time_ms, force_kn) = (f64::from(i), format!("{force_kn:.3}").replace('.', ","));
        text.push_str(&format!("{time_ms:.1};{force_kn};ok\n").replacen('.', ",", 1));
    }
    text
}

/// Waits until the dialog shows what its choices give.
pub fn settle(harness: &mut Harness<'_, App>) {
    step_until(harness, "the dialog", |state| {
        state.session.dialogs.import().is_some_and(|dialog| dialog.is_settled())
    });
}

pub fn map(harness: &Harness<'_, App>) -> String {
    state(harness).session.dialogs.import().map_or(String::new(), |dialog| dialog.map().to_string())
}

/// Chooses an entry of the list at a label; of several lists with this label, the one with `index`.
pub fn choose(harness: &mut Harness<'_, App>, (label, index): (&str, usize), entry: &str) {
    // A list that is used without a pointer stays open, and its next click closes it.
    for _ in 0..2 {
        let lists = harness.get_all_by_role_and_label(Role::ComboBox, label);
        lists.into_iter().nth(index).expect("a list").click_accesskit();
        harness.run_steps(4);
        if entries(harness, entry).next().is_some() {
            break;
        }
    }
    entries(harness, entry).last().expect("an entry").click_accesskit();
    harness.run_steps(4);
}

/// The buttons with this label.
fn entries<'a>(
    harness: &'a Harness<'_, App>,
    label: &'a str,
) -> impl Iterator<Item = egui_kittest::Node<'a>> {
    harness
        .query_all_by_role(Role::Button)
        .filter(move |node| node.accesskit_node().label().is_some_and(|text| text == label))
}

pub fn write(folder: &Path, name: &str, text: &str) -> (PathBuf, String) {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    let text = path.to_str().expect("a plain name").to_owned();
    (path, text)
}

#[test]
fn a_unit_of_the_header_stays_when_another_channel_is_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, path) = write(folder.path(), "f.csv", &german_export("Zeit [ms];Kraft [kN];Status"));
    let mut harness = open(&[&path]);
    settle(&mut harness);
    // The column of unknown direction is proposed as F_x, with the unit of its header.
    assert_eq!(map(&harness), "time=1:ms,fx=2:kN");
    choose(&mut harness, ("2: Kraft [kN]", 0), "F_y, force to the left of the road");
    assert_eq!(map(&harness), "time=1:ms,fy=2:kN");
    choose(&mut harness, ("2: Kraft [kN]", 0), "X, position along the road");
    choose(&mut harness, ("2: Kraft [kN]", 0), "F_x, force along the road");
    assert_eq!(map(&harness), "time=1:ms,fx=2:kN");
    harness.get_by_label("choose a column for F_y, or say that F_y is zero");
    harness.get_by_label("F_y is zero throughout").click();
    harness.run_steps(2);
    settle(&mut harness);
    save(&mut harness, "import-force.png");
    harness.get_by_label("60.00 kN at 60.00 ms");
    harness.get_by_label("Open with these columns").click();
    step_until(&mut harness, "the force", |state| state.analysis().is_some() && is_idle(state));
    let force = state(&harness).analysis().expect("it is read").report.force.clone();
    assert!((force.expect("a force").peak_n - 60_000.0).abs() < 1e-6);
}

#[test]
fn a_unit_that_nobody_states_is_asked_for_before_the_file_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    // The channels are known, the units are not: 60 may be N or kN.
    let text = german_export("Zeit [ms];Fx;Status").replace("Status", "Fy").replace("ok", "0,0");
    let (_, path) = write(folder.path(), "f.csv", &text);
    let mut harness = open(&[&path]);
    settle(&mut harness);
    assert!(state(&harness).session.sources.is_empty(), "it is not opened as 60 N meanwhile");
    assert_eq!(harness.get_all_by_value("not stated: choose").count(), 2);
    harness.get_by_label("choose the unit of column 2, \"Fx\"");
    harness.get_by_label("Open with these columns").click();
    harness.run_steps(4);
    assert!(state(&harness).session.dialogs.import().is_some(), "the button does nothing yet");
    // 60 N are said in words, 60 kN are not.
    choose(&mut harness, ("2: Fx", 1), "N");
    choose(&mut harness, ("3: Fy", 1), "N");
    settle(&mut harness);
    save(&mut harness, "import-small-force.png");
    harness.get_by_label_contains("peak force 60.00 N, less than cars have that touch");
    choose(&mut harness, ("2: Fx", 1), "kN");
    choose(&mut harness, ("3: Fy", 1), "kN");
    settle(&mut harness);
    assert!(harness.query_by_label_contains("less than cars have that touch").is_none());
    assert_eq!(map(&harness), "time=1:ms,fx=2:kN,fy=3:kN");
}

#[test]
fn a_map_is_kept_for_the_header_and_over_a_restart() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("state.json");
    let text = german_export("Zeit [ms];Kraft [kN];Status");
    let (first, name) = write(folder.path(), "first.csv", &text);
    let (_, cancelled) = write(folder.path(), "cancelled.csv", "Zeit;Temperatur\n0;20\n1;21\n");
    let mut harness = open_with(&[&name, &cancelled], Some(state_file.clone()));
    settle(&mut harness);
    // Both files ask, one after the other; the second one is cancelled.
    let map = "time=1:ms,fx=2:kN,fy=none".parse().expect("a map");
    let path =
        |state: &State| state.session.dialogs.import().map(|dialog| dialog.path().to_owned());
    assert!(
        path(state(&harness)).is_some() && state(&harness).session.dialogs.to_import.len() == 1
    );
    if path(state(&harness)) != Some(first.clone()) {
        apply(&mut harness, Command::CloseDialog);
        apply(&mut harness, Command::OpenMapped(first.clone(), map));
    } else {
        apply(&mut harness, Command::OpenMapped(first.clone(), map));
        apply(&mut harness, Command::CloseDialog);
    }
    step_until(&mut harness, "the force", |state| state.analysis().is_some() && is_idle(state));
    let opened: Vec<&PathBuf> = state(&harness).session.sources.iter().map(|of| &of.path).collect();
    assert_eq!(opened, [&first], "the cancelled file is closed");
    harness.run_steps(90);
    step_until(&mut harness, "the stored state", |_| state_file.exists());
    drop(harness);

    let mut harness = open_with(&[], Some(state_file));
    step_until(&mut harness, "the force again", |state| {
        state.analysis().is_some() && is_idle(state)
    });
    let state_now = state(&harness);
    assert!(state_now.session.dialogs.import().is_none() && state_now.session.sources.len() == 1);
    let peak = |harness: &Harness<'_, App>| {
        let force = state(harness).analysis().and_then(|answer| answer.report.force.clone());
        force.expect("a force").peak_n
    };
    assert!((peak(&harness) - 60_000.0).abs() < 1e-6);
    // Another file with this header is read alike, and a message says so.
    let (_, second) = write(folder.path(), "second.csv", &text.replace("17.03.", "18.03."));
    apply(&mut harness, Command::Open(vec![second.into()]));
    step_until(&mut harness, "the second force", |state| {
        state.session.sources.len() == 2 && is_idle(state)
    });
    assert!(state(&harness).session.dialogs.import().is_none());
    let last = &state(&harness).session.messages.last().expect("a message").text;
    assert!(
        last.contains("second.csv: read as files with this header before, time=1:ms"),
        "{last}"
    );
}

#[test]
fn world_velocities_are_told_from_body_velocities_by_the_path() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = "t [s],x [m],y [m],yaw [deg],vx [m/s],vy [m/s]\n".to_owned();
    for i in 0..200 {
        let t = f64::from(i) * 0.02;
        let (sin, cos) = (0.5 * t + 0.6).sin_cos();
        let (x, y, yaw) = (20.0 * sin, -20.0 * cos, (0.5 * t + 0.6).to_degrees());
        text.push_str(&format!("{t},{x},{y},{yaw},{},{}\n", 10.0 * cos, 10.0 * sin));
    }
    let (path, name) = write(folder.path(), "path.csv", &text);
    let mut harness = open(&[&name]);
    // Each column is recognised, but the velocities contradict the path, so that the window asks.
    settle(&mut harness);
    save(&mut harness, "import-path.png");
    harness.get_by_label("the path says: world axes");
    assert!(map(&harness).starts_with("velocities=world,"), "{}", map(&harness));
    harness.get_by_label("Open with these columns").click();
    step_until(&mut harness, "the path", |state| {
        state.session.sources.iter().any(|source| source.path == path) && is_idle(state)
    });
    let content = &state(&harness).session.sources[0].content;
    let impactlab::app::Content::File(file) = content else { panic!("a file") };
    let vy = file.loaded.series.get(impactlab_core::data::Channel::Vy).expect("velocities");
    assert!(vy.iter().all(|vy| vy.abs() < 1e-6), "body axes: no lateral velocity");
}

#[test]
fn keys_stay_in_the_dialog() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, path) = write(folder.path(), "f.csv", &german_export("Zeit [ms];Kraft [kN];Status"));
    let mut harness = open(&["datasets/trajectories-fea", &path]);
    settle(&mut harness);
    step_until(&mut harness, "the first case", is_idle);
    let selected = state(&harness).project.subject();
    for key in [egui::Key::Space, egui::Key::ArrowDown, egui::Key::ArrowRight] {
        harness.key_press(key);
        harness.run_steps(3);
    }
    let state = state(&harness);
    assert!(!state.session.playback.is_playing && state.session.playback.time_s == 0.0);
    assert_eq!(state.project.subject(), selected);
}

#[test]
fn a_list_opens_above_the_dialog_and_takes_the_pointer() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, path) = write(folder.path(), "f.csv", &german_export("Zeit [ms];Kraft [kN];Status"));
    let mut harness = open(&[&path]);
    settle(&mut harness);
    harness.run_steps(10);
    let list = harness.get_all_by_role_and_label(Role::ComboBox, "2: Kraft [kN]").next();
    list.expect("a list").click();
    harness.run_steps(10);
    save(&mut harness, "import-list.png");
    entries(&harness, "F_y, force to the left of the road").last().expect("an entry").click();
    harness.run_steps(10);
    assert_eq!(map(&harness), "time=1:ms,fy=2:kN");
}

/// What a force does not say was asked, but for the vehicle.
#[test]
fn the_vehicle_of_a_file_is_asked_for_beside_its_curve() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, path) = write(folder.path(), "f.csv", &german_export("Zeit [ms];Kraft [kN];Status"));
    let mut harness = open(&[&path]);
    settle(&mut harness);
    harness.get_by_label("F_y is zero throughout").click();
    harness.run_steps(2);
    settle(&mut harness);
    let vehicle = |harness: &Harness<'_, App>| state(harness).project.simulate.vehicle.clone();
    let before = vehicle(&harness);
    choose(&mut harness, ("Struck vehicle", 0), "FEA target (2000 kg)");
    assert_eq!(vehicle(&harness), before, "the variant gets it with the file");
    harness.get_by_label("Open with these columns").click();
    step_until(&mut harness, "the force", |state| state.analysis().is_some() && is_idle(state));
    let chosen = impactlab_study::VehicleChoice::Preset("target-2000".to_owned());
    assert_eq!(vehicle(&harness), chosen);
    let report = &state(&harness).analysis().expect("it is simulated").report;
    assert!(report.vehicle.starts_with("FEA target"), "{}", report.vehicle);
}

/// A pulse with 60 kN along x and 2 kN along y opened without a word if y was in N.
#[test]
fn components_in_different_units_are_asked_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "Time [s],Fx [kN],Fy [N]\n0,0,0\n0.05,60,2000\n0.1,0,0\n";
    let (_, path) = write(folder.path(), "f.csv", text);
    let mut harness = open(&[&path]);
    settle(&mut harness);
    harness.get_by_label_contains("two components of one vector are rarely recorded in different");
}

/// The dialog wrote vehicle and speed into a variant that asked about something else.
#[test]
fn what_is_said_of_a_vehicle_waits_for_the_button_that_takes_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, path) = write(folder.path(), "f.csv", &german_export("Zeit [ms];Kraft [kN];Status"));
    let mut harness = open(&["datasets/trajectories-fea", &path]);
    settle(&mut harness);
    step_until(&mut harness, "the first case", is_idle);
    harness.get_by_label("F_y is zero throughout").click();
    harness.run_steps(2);
    settle(&mut harness);
    let before = state(&harness).project.simulate.clone();
    choose(&mut harness, ("Struck vehicle", 0), "FEA target (2000 kg)");
    harness.get_by_label("Open with these columns").click();
    step_until(&mut harness, "the file", |state| state.session.offered.is_some() && is_idle(state));
    assert_eq!(state(&harness).project.simulate, before, "opening changes no question");
    harness
        .get_by_label_contains("With it come the struck vehicle and its start as said: FEA target");
    harness.get_by_label("Use in this variant").click();
    harness.run_steps(4);
    let now = &state(&harness).project.simulate;
    assert_eq!(now.vehicle, impactlab_study::VehicleChoice::Preset("target-2000".to_owned()));
    assert_ne!(now.source, before.source);
}
