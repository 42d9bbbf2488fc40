//! What happens to cases that cannot be used.

use egui::Ui;

use crate::study::BadCases;

/// Chooses whether cases that cannot be used are left out.
pub fn bad_cases_ui(ui: &mut Ui, bad_cases: &mut BadCases) {
    let mut leave_out = *bad_cases == BadCases::LeaveOut;
    let checkbox = ui.checkbox(&mut leave_out, "leave out cases that cannot be used");
    if checkbox.on_hover_text("Otherwise the first of them is an error").changed() {
        *bad_cases = if leave_out { BadCases::LeaveOut } else { BadCases::Refuse };
    }
}
