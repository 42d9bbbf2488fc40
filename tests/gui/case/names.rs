//! Names of variants.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use super::{pit, state};

/// The popup closed on a click into its own field, and a space that was typed then let time run.
#[test]
fn a_variant_is_renamed_with_mouse_and_keyboard() {
    let mut harness = pit();
    harness.get_by_label("Name…").click();
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::TextInput, "Name of the variant").click();
    harness.run_steps(4);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    for (key, text) in [(None, "wet"), (Some(Key::Space), " "), (None, "road")] {
        if let Some(key) = key {
            harness.key_press(key);
        }
        harness.event(egui::Event::Text(text.to_owned()));
        harness.run_steps(2);
    }
    assert!(!state(&harness).session.playback.is_playing);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert_eq!(state(&harness).case.file.shown, "wet road");
    assert!(harness.query_by_label("Name of the variant").is_none(), "it is done");
}
