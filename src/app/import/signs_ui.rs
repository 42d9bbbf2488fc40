//! Draws what divides the fields of a file and what stands within its numbers.

use egui::{ComboBox, Ui};

use crate::app::import::dialog::ImportDialog;
use impactlab_core::data::{Dialect, Separator, Thousands};

impl ImportDialog {
    /// Draws the separator, the decimal sign and the mark between thousands: what was found, or what the
    /// user says instead.
    pub(super) fn signs_ui(&mut self, ui: &mut Ui, found: Option<Dialect>, is_sheet: bool) {
        let settings = &mut self.settings;
        ui.horizontal(|ui| {
            if !is_sheet {
                let all = Separator::ALL.map(|of| (of, of.name()));
                let found = found.map(|found| found.separator.name());
                choice_ui(ui, "Separator", &mut settings.separator, &all, found);
            }
            let all = [(false, "point"), (true, "comma")];
            let name = |is_comma| if is_comma { "comma" } else { "point" };
            let decimal = found.map(|found| name(found.decimal_comma));
            choice_ui(ui, "Decimal sign", &mut settings.decimal_comma, &all, decimal);
            let all = Thousands::ALL.map(|of| (of, of.name()));
            let thousands = found.map(|found| found.thousands.map_or("none", Thousands::name));
            choice_ui(ui, "Thousands", &mut settings.thousands, &all, thousands);
        });
    }
}

/// Draws a list of values and of what is found in the file.
fn choice_ui<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    chosen: &mut Option<T>,
    all: &[(T, &str)],
    found: Option<&str>,
) {
    let name = ui.label(label);
    let found = format!("as found: {}", found.unwrap_or("?"));
    let said = all.iter().find(|(value, _)| *chosen == Some(*value)).map(|(_, text)| *text);
    let combo = ComboBox::from_id_salt(label).selected_text(said.unwrap_or(&found)).width(96.0);
    let list = combo.show_ui(ui, |ui| {
        // What is found beside a choice would be what was chosen.
        let text = if said.is_some() { "as found" } else { found.as_str() };
        ui.selectable_value(chosen, None, text);
        for (value, text) in all {
            ui.selectable_value(chosen, Some(*value), *text);
        }
    });
    list.response.labelled_by(name.id);
}
