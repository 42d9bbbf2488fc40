//! The choice of what happens to the cases of a data set that cannot be used.

use egui::Ui;

use impactlab_study::BadCases;

/// Draws a checkbox: if it is set, cases that cannot be used are left out, otherwise the first of
/// them ends the work with an error.
pub fn bad_cases_ui(ui: &mut Ui, bad_cases: &mut BadCases) {
    let mut leave_out = *bad_cases == BadCases::LeaveOut;
    let checkbox = ui.checkbox(&mut leave_out, "leave out cases that cannot be used");
    if checkbox.on_hover_text("Otherwise the first of them is an error").changed() {
        *bad_cases = if leave_out { BadCases::LeaveOut } else { BadCases::Refuse };
    }
}
