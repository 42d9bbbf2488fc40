//! The “By hand” pane: a method, its inputs with their standard deviations, and what it gives, beside the
//! reconstruction.

use egui::{Button, ComboBox, Grid, Label, ScrollArea, Ui};

use crate::app::looks;
use crate::app::panes::PaneContext;
use crate::app::widgets::{
    EmptyField, PointRows, caveats_ui, facts_ui, notice_ui, optional_quantity,
};
use impactlab_core::data::Severity;
use impactlab_core::ranges::HAND_COORDINATE;
use impactlab_core::units::UnitSystem;
use impactlab_reconstruct::evidence::{Evidence, Mark, Stated};
use impactlab_reconstruct::hand::{HandDefault, HandField, HandInputs, HandMethod};
use impactlab_study::HandRequest;

/// Width of the texts, points.
const TEXT_WIDTH: f32 = 620.0;

/// Points of a mark through which there is one circle.
const LEAST_POINTS: usize = 3;

/// Draws the choice of the method, its inputs and its answer.
pub fn hand_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.set_max_width(TEXT_WIDTH.min(ui.available_width()));
        choice_ui(ui, &mut project.hand);
        let Some(request) = &mut project.hand else {
            let labels: Vec<&str> = HandMethod::ALL.iter().map(|method| method.label()).collect();
            ui.weak(format!(
                "One quantity by one equation, with its standard deviation, beside the reconstruction and \
                 without it. Choose a method: {}.",
                labels.join("; ")
            ));
            return;
        };
        ui.add(Label::new(request.method.equation()).wrap());
        inputs_ui(ui, request, view.units);
        if request.method.takes_points() {
            let preview = session.reconstruction.preview.as_ref();
            points_ui(ui, request, preview.map(|preview| &preview.evidence));
            Grid::new("hand points").num_columns(4).show(ui, |ui| {
                let (id, units) = (ui.scope_id().with("next point by hand"), view.units);
                let rows = PointRows { id, range: &HAND_COORDINATE, units, is_narrow: false };
                rows.draw(ui, &mut request.points_m);
            });
        }
        ui.add_space(looks::PART);
        match &session.hand.answer {
            None => drop(ui.spinner()),
            Some(Err(problem)) => drop(notice_ui(ui, Severity::Warning, problem)),
            Some(Ok(answer)) => {
                let report = &answer.report;
                super::faded_if(ui, session.hand.is_late(), |ui| {
                    caveats_ui(ui, &report.caveats, view.units, commands);
                    facts_ui(ui, report.name, &report.facts(), view.units);
                });
            }
        }
    });
}

/// Draws the choice of the method. Another method has other inputs.
fn choice_ui(ui: &mut Ui, request: &mut Option<HandRequest>) {
    let chosen = request.as_ref().map(|request| request.method);
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Method");
        let shown = chosen.map_or("none", HandMethod::label);
        let list = ComboBox::from_id_salt("hand method").selected_text(shown);
        let list = list.show_ui(ui, |ui| {
            for &method in HandMethod::ALL {
                let is_chosen = chosen == Some(method);
                if ui.selectable_label(is_chosen, method.label()).clicked() && !is_chosen {
                    *request = Some(HandRequest::new(method));
                }
            }
        });
        list.response.labelled_by(name.id);
        let remove = ui.add_enabled(chosen.is_some(), Button::new("Remove").small());
        if remove.on_hover_text("The case asks for no calculation by hand any more").clicked() {
            *request = None;
        }
    });
}

/// Draws value and standard deviation of each input.
fn inputs_ui(ui: &mut Ui, request: &mut HandRequest, units: UnitSystem) {
    let method = request.method;
    Grid::new(("hand inputs", method)).num_columns(4).show(ui, |ui| {
        for field in method.fields() {
            input_ui(ui, field, &mut request.inputs, units);
            ui.end_row();
        }
    });
}

/// Draws which points of a mark are taken beside those that are typed: those of a mark of the evidence.
fn points_ui(ui: &mut Ui, request: &mut HandRequest, evidence: Option<&Evidence>) {
    ui.horizontal_wrapped(|ui| {
        match request.points_m.len() {
            0 => drop(
                ui.weak("Or points along the mark: typed, or those of a mark of the evidence."),
            ),
            n => {
                ui.weak(format!("{n} points along the mark."));
                if ui.add(Button::new("Remove points").small()).clicked() {
                    request.points_m.clear();
                }
            }
        }
        let marks = evidence.into_iter().flat_map(|of| {
            numbered("Take mark", &of.marks)
                .chain(numbered("Take mark of the striking car", &of.striking_marks))
        });
        for (text, mark) in marks.filter(|(_, mark)| mark.points_m.len() >= LEAST_POINTS) {
            let take = ui.add(Button::new(text).small());
            if take.on_hover_text("Its points instead of chord and middle ordinate").clicked() {
                request.points_m.clone_from(&mark.points_m);
                for key in ["chord_m", "middle_ordinate_m", "radius_m"] {
                    request.inputs.remove(key);
                }
            }
        }
    });
}

/// Marks of a car with their numbers after a text.
fn numbered<'a>(text: &'static str, marks: &'a [Mark]) -> impl Iterator<Item = (String, &'a Mark)> {
    (1..).zip(marks).map(move |(number, mark)| (format!("{text} {number}"), mark))
}

fn input_ui(ui: &mut Ui, field: &HandField, inputs: &mut HandInputs, units: UnitSystem) {
    let name = ui.label(field.label);
    let mut stated = inputs.get(&field.si_key()).copied().unwrap_or_default();
    let before = stated;
    let usual = match field.default {
        HandDefault::Value(value) => value,
        HandDefault::Required | HandDefault::Open => 0.0,
    };
    let text = match field.default {
        HandDefault::Value(_) => field.range.quantity.shown(usual, units),
        HandDefault::Required => "needed".to_owned(),
        HandDefault::Open => "open".to_owned(),
    };
    let empty = EmptyField { text: &text, start_si: usual };
    optional_quantity(ui, &mut stated.value, empty, &field.range, units).labelled_by(name.id);
    ui.label("±");
    let sigma = field.usual_sigma(stated.value.unwrap_or(usual));
    let text = field.range.quantity.shown(sigma, units);
    let empty = EmptyField { text: &text, start_si: sigma };
    let hint = "One standard deviation; empty for that of the program, 0 for an exact number";
    let response = optional_quantity(ui, &mut stated.sigma, empty, &field.sigma_range(), units);
    response.on_hover_text(hint);
    if stated == before {
        return;
    }
    if stated == Stated::default() {
        inputs.remove(&field.si_key());
    } else {
        inputs.insert(field.si_key(), stated);
    }
}
