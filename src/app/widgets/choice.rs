//! A row of a form with the choice of one of a few values.

use std::fmt::Debug;
use std::hash::Hash;

use egui::{ComboBox, Response, Ui};

/// Draws a row of a two-column grid: a label, which no other list of the form has, and a drop-down list.
///
/// - `text`: what a value is called.
/// - returns the response of the list, which a hint can be added to.
pub fn choice_row<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    value: &mut T,
    options: &[T],
    text: impl Fn(T) -> &'static str,
) -> Response {
    salted_choice_row(ui, label, label, value, options, text)
}

/// The same with a label that other lists have, too.
///
/// - `id_salt`: tells the list from the others.
pub fn salted_choice_row<T: Copy + PartialEq>(
    ui: &mut Ui,
    id_salt: impl Hash + Debug,
    label: &str,
    value: &mut T,
    options: &[T],
    text: impl Fn(T) -> &'static str,
) -> Response {
    let name = ui.label(label);
    let list = ComboBox::from_id_salt(id_salt).selected_text(text(*value)).show_ui(ui, |ui| {
        for &option in options {
            ui.selectable_value(value, option, text(option));
        }
    });
    let response = list.response.labelled_by(name.id);
    ui.end_row();
    response
}

#[cfg(test)]
mod tests {
    use egui::Grid;
    use egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    #[test]
    fn a_value_is_chosen_in_the_list_of_its_label() {
        let text = |is_left: bool| if is_left { "left" } else { "right" };
        let mut harness = Harness::builder().with_size([400.0, 300.0]).build_ui_state(
            |ui, is_left: &mut bool| {
                Grid::new("choice").num_columns(2).show(ui, |ui| {
                    choice_row(ui, "It is positive to the", is_left, &[false, true], text);
                });
            },
            false,
        );
        harness.get_by_role_and_label(Role::ComboBox, "It is positive to the").click_accesskit();
        harness.run_steps(4);
        harness.get_by_role_and_label(Role::Button, "left").click_accesskit();
        harness.run_steps(4);
        assert!(*harness.state(), "the other value is chosen");
    }
}
