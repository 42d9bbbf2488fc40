//! The form of a vehicle: what is known of it, and what is estimated by rule with its scatter.

use egui::{CollapsingHeader, Grid, Response, RichText, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::output::Output;
use crate::app::panels::crush_form::crush_form_ui;
use crate::app::widgets::{problem_line_ui, quantity_value, salted_choice_row};
use impactlab_core::ranges::Range;
use impactlab_core::units::{self, NumberFormat, UnitSystem};
use impactlab_core::vehicle::sheet::Estimate;
use impactlab_core::vehicle::{DataSheet, DrivenAxle, SheetQuantity, VehicleClass};

/// Largest width of a label and of a value, points.
const LABEL_WIDTH: f32 = 165.0;

/// Draws the form of a data sheet.
///
/// - `title`: which vehicle it is.
pub fn vehicle_form_ui(
    ui: &mut Ui,
    title: &str,
    sheet: &mut DataSheet,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let header = CollapsingHeader::new(format!("{title}: {}", sheet.name)).id_salt(title);
    header.default_open(true).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.weak(
                "Tick what you know. The rest is estimated by rule, and its scatter is in the bands. \
                 A scenario takes over mass, yaw inertia and outline, but for what it says otherwise.",
            );
            let hint = "As a vehicle file, for other cases and the command line";
            if ui.button("Save vehicle…").on_hover_text(hint).clicked() {
                commands.push(Command::Ask(Purpose::Save(Output::Vehicle(Box::new(sheet.clone())))));
            }
        });
        // The line is always there, so that the fields do not move while numbers are entered.
        let problem = sheet.checked_vehicle().err();
        let problem = problem.map(|error| format!("These values do not go together: {error}"));
        problem_line_ui(ui, problem.as_deref());
        Grid::new((title, "head")).num_columns(2).show(ui, |ui| head_ui(ui, title, sheet));
        let estimates = sheet.estimates();
        let grid = Grid::new((title, "quantities")).num_columns(2).striped(true);
        grid.max_col_width(LABEL_WIDTH).show(ui, |ui| {
            for &quantity in SheetQuantity::ALL {
                let estimate = estimates.iter().find(|estimate| estimate.quantity == quantity);
                quantity_ui(ui, sheet, quantity, estimate, units);
            }
        });
        crush_form_ui(ui, title, sheet, units);
    });
}

/// Draws name, source, class and drive.
fn head_ui(ui: &mut Ui, title: &str, sheet: &mut DataSheet) {
    for (label, text) in [("Name", &mut sheet.name), ("Source", &mut sheet.source)] {
        let name = ui.label(label);
        let field = egui::TextEdit::singleline(text).desired_width(260.0);
        ui.add(field).labelled_by(name.id);
        ui.end_row();
    }
    let (class, classes) = (&mut sheet.class, VehicleClass::ALL);
    let class =
        salted_choice_row(ui, (title, "class"), "Class", class, &classes, VehicleClass::word);
    class.on_hover_text("Says which rules estimate the rest");
    let axles = DrivenAxle::ALL.iter().copied().map(Some);
    let choices: Vec<_> = std::iter::once(None).chain(axles).collect();
    let word = |drive: Option<DrivenAxle>| drive.map_or("not known", DrivenAxle::word);
    let drive = &mut sheet.drive;
    salted_choice_row(ui, (title, "drive"), "Driven axle", drive, &choices, word);
}

/// Draws a row with one quantity: its value if it is known, else its estimate.
///
/// - `estimate`: by which rule it is estimated; `None` if it, or what stands for it, is known.
fn quantity_ui(
    ui: &mut Ui,
    sheet: &mut DataSheet,
    quantity: SheetQuantity,
    estimate: Option<&Estimate>,
    units: UnitSystem,
) {
    let range = quantity.range();
    let symbol = range.quantity.display_unit(units).symbol;
    let label = match (symbol, quantity.unit()) {
        ("", unit) if !unit.is_empty() => format!("{} [{unit}]", quantity.label()),
        _ => quantity.label().to_owned(),
    };
    let mut is_known = estimate.is_none();
    let known = ui.checkbox(&mut is_known, label).on_hover_text("Ticked: known. Else: estimated");
    if known.changed() {
        match estimate {
            Some(estimate) => sheet.set(quantity, estimate.value.median),
            None => sheet.forget(quantity),
        }
    }
    match (sheet.known(quantity), estimate) {
        (Some(mut value), _) => {
            let (field, is_changed) = quantity_value(ui, &mut value, &range, units);
            field.labelled_by(known.id);
            if is_changed {
                sheet.set(quantity, value);
            }
        }
        (None, Some(Estimate { value, rule, source, .. })) => {
            estimate_ui(ui, value, &range, units).on_hover_text(estimated_by(rule, source));
        }
        (None, None) => {
            ui.weak("follows from the stiffness or damping of its file");
        }
    }
    ui.end_row();
}

/// Draws an estimate with the range that holds it with a probability of 90 %.
pub(super) fn estimate_ui(
    ui: &mut Ui,
    value: &units::Estimate,
    range: &Range,
    units: UnitSystem,
) -> Response {
    let text = NumberFormat::english(units).estimate_in_words(range.quantity, value);
    ui.add(egui::Label::new(RichText::new(text).italics()).wrap())
}

/// Where an estimate comes from, for a person.
pub(super) fn estimated_by(rule: &str, source: &str) -> String {
    format!("Estimated: {rule}\nSource: {source}\nIn brackets: 90 %")
}
