//! A text field for a value that is written as text.

use std::path::PathBuf;

use egui::{Response, TextEdit, Ui};

use crate::app::widgets::refusal::refusal_ui;
use crate::app::widgets::severity_color;
use impactlab_core::data::Severity;
use impactlab_study::ConfigChoice;

/// What was typed, and the value in its place as it is written.
#[derive(Debug, Clone)]
struct Typed {
    text: String,
    value: String,
}

/// Draws a text field for a value. What is typed stays in the field until the value changes elsewhere. A
/// text that cannot be read is not taken, and the field says why, over what stands below it.
///
/// - `write`, `read`: the value as a text, and the value of a text or what is wrong with it;
/// - `look`: completes the field;
/// - returns the response of the field and whether its text is the value.
pub fn written_field<T>(
    ui: &mut Ui,
    value: &mut T,
    write: impl Fn(&T) -> String,
    read: impl Fn(&str) -> Result<T, String>,
    look: impl FnOnce(TextEdit<'_>) -> TextEdit<'_>,
) -> (Response, bool) {
    let id = ui.next_auto_id().with("typed");
    let written = write(value);
    let typed = ui.data(|data| data.get_temp::<Typed>(id)).filter(|typed| typed.value == written);
    let mut text = typed.map_or(written, |typed| typed.text);
    let color = read(&text).is_err().then(|| severity_color(ui, Severity::Error));
    let response = ui.add(look(TextEdit::singleline(&mut text).text_color_opt(color)));
    let taken = read(&text);
    let problem = taken.as_ref().err().cloned();
    if response.changed() {
        if let Ok(taken) = taken {
            *value = taken;
        }
        let value = write(value);
        ui.data_mut(|data| data.insert_temp(id, Typed { text, value }));
    }
    let is_taken = problem.is_none();
    let response = match problem {
        Some(problem) => {
            let is_open = response.has_focus();
            refusal_ui(ui, response, &problem, is_open)
        }
        None => response,
    };
    (response, is_taken)
}

/// Draws a text field for the path of a settings file, which may be left empty.
pub fn config_field(
    ui: &mut Ui,
    config: &mut ConfigChoice,
    look: impl FnOnce(TextEdit<'_>) -> TextEdit<'_>,
) -> Response {
    let write = |config: &ConfigChoice| {
        config.file().map(|path| path.display().to_string()).unwrap_or_default()
    };
    let read = |text: &str| {
        let path = text.trim();
        Ok((!path.is_empty()).then(|| PathBuf::from(path)).into())
    };
    written_field(ui, config, write, read, look).0
}
