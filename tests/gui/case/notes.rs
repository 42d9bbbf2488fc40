//! Notes of variants, and what their table says of them.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Pane, VariantCommand};
use impactlab_study::case_file::CaseFile;

use super::{is_answered, pit, pit_as_opened, save_as, scenario, state, variant};
use crate::harness::{apply, step_until};

/// Clicks the last field of a name and types into it.
fn type_into(harness: &mut Harness<'_, App>, name: &str) {
    let fields = harness.query_all_by_role_and_label(Role::MultilineTextInput, name);
    let field = fields.last().expect("a field");
    field.scroll_to_me();
    harness.run_steps(4);
    let fields = harness.query_all_by_role_and_label(Role::MultilineTextInput, name);
    fields.last().expect("a field").click();
    harness.run_steps(4);
    for (key, text) in [(None, "wet"), (Some(Key::Space), " "), (None, "road")] {
        if let Some(key) = key {
            harness.key_press(key);
        }
        harness.event(egui::Event::Text(text.to_owned()));
        harness.run_steps(2);
    }
    assert!(!state(harness).session.playback.is_playing);
}

#[test]
fn the_table_of_variants_has_notes_what_differs_and_how_likely_it_spins() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    let mut harness = pit_as_opened();
    variant(&mut harness, VariantCommand::Duplicate);
    scenario(&mut harness).striking.vy_world_m_s *= 1.3;
    harness.run_steps(2);
    step_until(&mut harness, "the forecast", is_answered);
    apply(&mut harness, Command::Show(Pane::Variants));
    harness.run_steps(4);
    type_into(&mut harness, "Notes");
    let notes = |file: &CaseFile| -> Vec<String> {
        file.variants.iter().map(|variant| variant.notes.clone()).collect()
    };
    assert_eq!(notes(&state(&harness).case.file), ["", "wet road"]);

    let variants = state(&harness).answered_variants();
    assert_eq!(variants[0].differs, None);
    let differs = variants[1].differs.clone().expect("differences from the first one");
    assert!(!differs.is_empty(), "the speed of the striking vehicle");
    assert!(differs.iter().all(|text| text.starts_with("striking vehicle")), "{differs:?}");
    assert!(harness.query_all_by_label_contains(&differs[0]).next().is_some());
    let forecast = state(&harness).session.response.forecast.ok().expect("a forecast");
    let turn = forecast.answer.report.outcome.p_quarter_turn.expect("a probability");
    let turn = format!("{:.1} %", 100.0 * turn);
    assert!(harness.query_all_by_label_contains(&turn).next().is_some(), "{turn}");

    save_as(&mut harness, &path);
    assert_eq!(notes(&CaseFile::load(&path).expect("a case")), ["", "wet road"]);
    assert!(!state(&harness).is_case_changed());
}

#[test]
fn notes_of_the_variant_stand_beside_its_name() {
    let mut harness = pit();
    harness.get_by_label("Name…").click();
    harness.run_steps(4);
    type_into(&mut harness, "Notes of the variant");
    assert_eq!(state(&harness).case.file.variants[0].notes, "wet road");
    assert!(state(&harness).is_case_changed());
}
