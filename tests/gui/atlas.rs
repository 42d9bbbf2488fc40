//! The Atlas workspace: a map of synthetic rows, the case at hand in it, and a variant of a cell.

use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, AtlasCommand, Command, Pane, ShownMap, State, Subject, VariantCommand, Workspace,
};
use impactlab_core::data::Existing;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::FigureElement;
use impactlab_sweep::atlas::{Atlas, Axis, MIN_ROWS};
use impactlab_sweep::{Column, Outcome, Rows, RowsMeta};

use crate::harness::{apply, is_idle, open, state, step_until};
use crate::pictures::save;

const SCENARIO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");

/// Rows in each cell.
const ROWS: u64 = 2 * MIN_ROWS;

/// Speeds of 10 to 40 m/s, closing at 1 to 9 m/s, two roads, without and with stability control.
fn axes() -> Vec<Axis> {
    let axis = |name: &str, label: &str, unit: &str, edges: &[f64], labels: &[&str]| Axis {
        name: name.to_owned(),
        word: label.to_owned(),
        label: label.to_owned(),
        unit: unit.to_owned(),
        edges: edges.to_vec(),
        labels: labels.iter().map(|&label| label.to_owned()).collect(),
    };
    vec![
        axis("target_speed_m_s", "Speed", "m/s", &[10.0, 20.0, 30.0, 40.0], &[]),
        axis("closing_m_s", "Closing", "m/s", &[1.0, 5.0, 9.0], &[]),
        axis("friction", "Friction", "1", &[0.4, 0.7, 1.0], &[]),
        axis("esc", "Control", "1", &[], &["without ESC", "with ESC"]),
    ]
}

/// How often a cell turns by 90°, of its rows: more with the speed, and less with stability control.
fn n_turns(speed: usize, esc: usize) -> u64 {
    [[10, 20, 40], [0, 5, 10]][esc][speed]
}

/// The atlas of rows that fill every cell.
fn atlas() -> Atlas {
    let axes = axes();
    let (mut inputs, mut turns) = (vec![Vec::new(); 4], Vec::new());
    for speed in 0..3 {
        for closing in 0..2 {
            for friction in 0..2 {
                for esc in 0..2 {
                    for row in 0..ROWS {
                        for (values, (axis, bin)) in
                            inputs.iter_mut().zip(axes.iter().zip([speed, closing, friction, esc]))
                        {
                            let [low, high] = axis.ends(bin).expect("a bin");
                            values.push((low + high) / 2.0);
                        }
                        turns.push(f64::from(u8::from(row < n_turns(speed, esc))));
                    }
                }
            }
        }
    }
    let n = turns.len();
    let column = |name: &str, unit: &str, values: Vec<f64>| Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    };
    let outcome = |outcome: &Outcome| {
        let values = match outcome {
            Outcome::Turns90 => turns.clone(),
            Outcome::ForceApplies | Outcome::ResponseApplies => vec![1.0; n],
            _ => (0..n).map(|row| (row % 2) as f64).collect(),
        };
        column(outcome.name(), outcome.unit(), values)
    };
    let columns = axes.iter().zip(inputs);
    let rows = Rows {
        inputs: columns.map(|(axis, values)| column(&axis.name, &axis.unit, values)).collect(),
        outcomes: Outcome::ALL.iter().map(outcome).collect(),
        index: (0..n as u64).collect(),
        caveats: None,
        reasons: vec![String::new(); n],
        meta: RowsMeta {
            plan_sha256: "ab".repeat(32),
            program: "impactlab of a test".to_owned(),
            ..RowsMeta::default()
        },
    };
    Atlas::from_rows(&rows, axes).expect("an atlas")
}

fn atlas_in(folder: &Path) -> PathBuf {
    let path = folder.join("synthetic.atlas");
    atlas().write(&path, Existing::Refuse).expect("written");
    path
}

/// The window with the PIT and the synthetic atlas, its maps made.
fn opened(folder: &Path) -> Harness<'static, App> {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the PIT", is_idle);
    apply(&mut harness, Command::Open(vec![atlas_in(folder)]));
    step_until(&mut harness, "the maps", |state| !state.session.atlas.maps().is_empty());
    harness
}

fn cells(map: &ShownMap) -> Vec<Option<f64>> {
    map.slice.cells.iter().map(|cell| cell.mean).collect()
}

#[test]
fn a_file_that_is_no_atlas_leaves_the_ways_to_get_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("broken.atlas");
    std::fs::write(&path, "no atlas at all").expect("written");
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the PIT", is_idle);
    apply(&mut harness, Command::Open(vec![path]));
    step_until(&mut harness, "why not", |state| state.session.atlas.problem().is_some());
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Atlas);
    harness.get_by_label("No atlas is open");
    let why = state(&harness).session.atlas.problem().expect("a reason").to_owned();
    assert!(why.contains("broken.atlas") && why.contains("is no atlas"), "{why}");
    save(&mut harness, "atlas-none.png");
    harness.get_by_label("Show the sweep").click();
    harness.run_steps(3);
    harness.get_by_label("One question, many times");
}

#[test]
fn an_atlas_is_shown_as_two_maps_with_one_scale_and_the_case_in_one_of_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(folder.path());
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Atlas);
    let maps = state(&harness).session.atlas.maps();
    let [without, with] = maps else { panic!("{} maps", maps.len()) };
    let share = |speed, esc| Some(n_turns(speed, esc) as f64 / ROWS as f64);
    for (esc, map) in [without, with].into_iter().enumerate() {
        let row: Vec<_> = (0..3).map(|speed| share(speed, esc)).collect();
        assert_eq!(cells(map), [row.clone(), row].concat(), "{}", map.name);
        let scales = map.figure.elements.iter().filter_map(|element| match element {
            FigureElement::CellMap(map) => Some(map.scale),
            _ => None,
        });
        assert_eq!(scales.collect::<Vec<_>>(), [[0.0, 100.0]]);
    }
    let has_case = |map: &ShownMap| {
        map.figure.elements.iter().any(|of| matches!(of, FigureElement::Points(_)))
    };
    assert!(has_case(without) && !has_case(with), "the example has no stability control");
    // 54 km/h are in the first bin.
    let text = without.text([0, 1], UnitSystem::Si);
    assert!(text.contains("25.0 % ± ") && text.contains("in 80 runs"), "{text}");
    // The pane said it, and the picture that is saved did not.
    let told = without.figure.caveats.text().expect("what restricts it");
    assert!(told.contains("other networks") && told.contains("(force, response)"), "{told}");
    assert!(harness.query_all_by_label_contains("The case at hand: ").next().is_some());
    assert!(harness.query_all_by_label_contains("not validated").next().is_some());
    save(&mut harness, "atlas.png");
    harness.state_mut().state_mut().view.dark = true;
    harness.run_steps(4);
    save(&mut harness, "atlas-dark.png");

    // Held at one road, with both kinds of cars together.
    harness.get_by_label("Without and with stability control side by side").click();
    harness.state_mut().state_mut().view.atlas.hold("friction", Some(1));
    harness.run_steps(4);
    let [map] = state(&harness).session.atlas.maps() else { panic!("one map") };
    let both = |speed| Some((n_turns(speed, 0) + n_turns(speed, 1)) as f64 / (2 * ROWS) as f64);
    let row: Vec<_> = (0..3).map(both).collect();
    assert_eq!(cells(map), [row.clone(), row].concat());
    assert!(map.slice.cells.iter().all(|cell| cell.n_rows == 2 * ROWS));
    let view = state(&harness).view.atlas.clone();
    let (restored, _) = State::restore(&state(&harness).save().expect("saved")).expect("restored");
    assert_eq!(restored.view.atlas, view);
}

#[test]
fn a_point_of_a_map_is_in_a_cell_in_every_system_of_units() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(folder.path());
    for (units, speed) in [(UnitSystem::Si, 90.0), (UnitSystem::Us, 56.0)] {
        harness.state_mut().state_mut().view.units = units;
        harness.run_steps(3);
        let map = &state(&harness).session.atlas.maps()[1];
        let closing = map.figure.y.unit.from_si(6.0);
        assert_eq!(map.bins_at([speed, closing]), Some([1, 1]), "25 m/s");
        assert_eq!(map.bins_at([500.0, closing]), None);
        assert_eq!(map.bins([1, 1]), [Some(1), Some(1), None, Some(1)]);
    }
}

#[test]
fn a_cell_becomes_a_variant_that_is_played_and_can_be_undone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(folder.path());
    harness.run_steps(90);
    let before = state(&harness).project.clone();
    let cell = state(&harness).session.atlas.maps()[1].bins([1, 0]);
    apply(&mut harness, Command::Atlas(AtlasCommand::Play(cell)));
    step_until(&mut harness, "the motion", |state| state.session.playback.is_playing);
    let now = state(&harness);
    assert_eq!(now.project.subject(), Some(Subject::Scenario));
    assert_eq!(now.view.workspaces.shown, Workspace::Case);
    assert_eq!((now.case.file.variants.len(), now.case.file.shown.as_str()), (2, "atlas"));
    let scenario = now.project.scenario().expect("a scenario");
    assert!((scenario.struck.vx_world_m_s - 25.0).abs() < 1e-9, "{scenario:?}");
    assert!((scenario.striking.vy_world_m_s - 3.0).abs() < 1e-9, "{scenario:?}");
    // It kept the heading of the case before and slid, which no row of the atlas does.
    let way_rad = scenario.striking.vy_world_m_s.atan2(scenario.striking.vx_world_m_s);
    assert!((scenario.striking.heading_rad - way_rad).abs() < 1e-9, "{scenario:?}");
    let ending = scenario.ending.as_ref().expect("an ending");
    assert!(ending.esc.is_some());
    // What is integrated out stays.
    assert_eq!(now.project.simulate.friction, before.simulate.friction);
    let notes = &now.case.file.variant("atlas").expect("the variant").notes;
    assert!(notes.contains("with ESC"), "{notes}");

    apply(&mut harness, Command::Undo);
    harness.run_steps(2);
    assert_eq!(state(&harness).project.impact.scenario, before.impact.scenario);
    apply(&mut harness, Command::Variant(VariantCommand::Show("base".to_owned())));
    harness.run_steps(2);
    assert_eq!(state(&harness).project.impact.scenario, before.impact.scenario);
}

#[test]
fn what_moves_an_outcome_is_told_or_why_it_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(folder.path());
    apply(&mut harness, Command::Show(Pane::Sensitivity));
    harness.run_steps(3);
    assert!(harness.query_all_by_label_contains("has no Sobol indices").next().is_some());
}

/// That the case lay outside was said, and neither by how much nor what to do.
#[test]
fn a_case_outside_says_by_how_much_and_what_can_be_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = opened(folder.path());
    harness.run_steps(4);
    let says = |harness: &Harness<'_, App>, text: &str| {
        harness.query_all_by_label_contains(text).next().is_some()
    };
    let click = |harness: &mut Harness<'_, App>, label: &str| {
        harness.get_by_label(label).scroll_to_me();
        harness.run_steps(4);
        harness.get_by_label(label).click();
        harness.run_steps(4);
    };
    assert!(!says(&harness, " above the atlas"));
    click(&mut harness, "Hold the map at the case");
    let held = &state(&harness).view.atlas.held;
    assert_eq!(held.get("esc"), Some(&0), "{held:?}");

    let change = |harness: &mut Harness<'_, App>, vx_m_s: [f64; 2], turns_away: bool| {
        let project = &mut harness.state_mut().state_mut().project;
        let scenario = project.scenario_mut().expect("a scenario");
        [scenario.struck.vx_world_m_s, scenario.striking.vx_world_m_s] = vx_m_s;
        if turns_away {
            scenario.striking.vy_world_m_s *= -1.0;
        }
        harness.run_steps(4);
    };
    // The synthetic atlas ends at 40 m/s.
    change(&mut harness, [50.0, 51.0], false);
    assert!(says(&harness, "180.0 km/h, 36.00 km/h above the atlas"));
    assert!(says(&harness, "(36.00 km/h above)"), "below the map");
    assert!(says(&harness, "compute an atlas whose plan reaches it"));
    // The map without the case ended at 40 m/s, the one beside it at the case.
    let reach = |map: &ShownMap| {
        map.figure.included.iter().map(|[speed, _]| *speed).fold(f64::MIN, f64::max)
    };
    let reaches: Vec<f64> = state(&harness).session.atlas.maps().iter().map(reach).collect();
    let [without, with] = reaches[..] else { panic!("{reaches:?}") };
    assert!((without - 180.0).abs() < 1e-9 && without == with, "{reaches:?}");
    save(&mut harness, "atlas-outside.png");
    change(&mut harness, [15.0, 16.0], true);
    assert!(!says(&harness, " above the atlas"));
    assert!(says(&harness, "does not close in on the side"));
    click(&mut harness, "Show the scenario");
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Case);
}
