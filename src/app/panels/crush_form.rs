//! The part of the form of a vehicle that says how stiff its faces are.

use egui::{Grid, Ui};

use crate::app::panels::vehicle_form::{estimate_ui, estimated_by};
use crate::app::widgets::quantity_value;
use impactlab_core::collision::contact::{
    STIFFNESS_LOG_SIGMA, STIFFNESS_RULE, STIFFNESS_SOURCE, TESTED_LOG_SIGMA, class_estimates,
};
use impactlab_core::ranges::{CRUSH_ONSET, CRUSH_STIFFNESS, Range};
use impactlab_core::units::{self, UnitSystem};
use impactlab_core::vehicle::{CrushFace, CrushStiffness, DataSheet};

/// What the section says when the pointer is over its title.
const EXPLANATION: &str = "How stiff each face is where vehicles push each other, as tests against a \
    flat rigid barrier give it: the load over the width of the face begins at A and grows by B with the \
    depth of the crush. The command `impactlab stiffness` computes both from a test.";

/// Largest width of a column, points.
const COLUMN_WIDTH: f32 = 105.0;

/// Heads of the columns and the ranges of their numbers.
const NUMBERS: [(&str, Range); 2] = [("A, onset", CRUSH_ONSET), ("B, growth", CRUSH_STIFFNESS)];

/// Draws a row for each face with A and B: what is known of it, else the values of its class.
///
/// - `title`: which vehicle it is.
pub(super) fn crush_form_ui(ui: &mut Ui, title: &str, sheet: &mut DataSheet, units: UnitSystem) {
    ui.add_space(ui.spacing().item_spacing.y);
    ui.strong("Crush stiffness").on_hover_text(EXPLANATION);
    let (class, mass_kg) = (sheet.class, sheet.vehicle().mass.mass_kg);
    let grid = Grid::new((title, "crush")).num_columns(3).striped(true);
    grid.max_col_width(COLUMN_WIDTH).show(ui, |ui| {
        ui.label("");
        let heads = NUMBERS.map(|(head, range)| ui.label(head).on_hover_text(range.meaning).id);
        ui.end_row();
        for face in CrushFace::ALL {
            let by_class = class_estimates(class, mass_kg, face);
            face_ui(ui, face, sheet.crush.face_mut(face), &by_class, heads, units);
        }
    });
}

/// Draws the row of a face.
///
/// - `by_class`: A and B by the rule for class and mass;
/// - `heads`: the labels above both columns.
fn face_ui(
    ui: &mut Ui,
    face: CrushFace,
    known: &mut Option<CrushStiffness>,
    by_class: &[units::Estimate; 2],
    heads: [egui::Id; 2],
    units: UnitSystem,
) {
    let mut is_known = known.is_some();
    let name = ui.checkbox(&mut is_known, face.word()).on_hover_text(scatter(face));
    if name.changed() {
        let [onset_n_per_m, stiffness_n_per_m2] = by_class.each_ref().map(|value| value.median);
        let of_class = CrushStiffness { onset_n_per_m, stiffness_n_per_m2 };
        *known = is_known.then_some(of_class);
    }
    match known {
        Some(CrushStiffness { onset_n_per_m, stiffness_n_per_m2 }) => {
            let values = [onset_n_per_m, stiffness_n_per_m2];
            for ((value, (_, range)), head) in values.into_iter().zip(NUMBERS).zip(heads) {
                let (field, _) = quantity_value(ui, value, &range, units);
                field.labelled_by(name.id).labelled_by(head);
            }
        }
        None => {
            for (value, (_, range)) in by_class.iter().zip(NUMBERS) {
                let shown = estimate_ui(ui, value, &range, units);
                shown.on_hover_text(estimated_by(STIFFNESS_RULE, STIFFNESS_SOURCE));
            }
        }
    }
    ui.end_row();
}

/// What a tick says of a face.
fn scatter(face: CrushFace) -> String {
    let [tested, by_class] =
        [TESTED_LOG_SIGMA, *STIFFNESS_LOG_SIGMA.at_face(face)].map(|sigma| 100.0 * sigma);
    format!(
        "Ticked: both numbers are known from a test; forecasts draw them with a scatter of \
         {tested:.0} %. Else: those of the class, with {by_class:.0} %. Untick it to go back to the class."
    )
}
