//! The “Atlas” pane: which atlas, which outcome over which axes, and where the other inputs stand.

use egui::{ComboBox, Grid, Label, RichText, ScrollArea, Slider, Ui};

use crate::app::atlas::{
    AtlasCommand, AtlasSession, AtlasView, CaseInput, MapChoice, OUTSIDE_REMEDY, can_be_beside,
};
use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{self, Icon, icon_button};
use crate::app::model::file_name;
use crate::app::panes::{Pane, PaneContext};
use crate::app::widgets::{notice_ui, severity_color, within_view, working_ui};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_sweep::atlas::{Atlas, Axis, Measure};

/// Largest width of a closed list, points.
const LIST_WIDTH: f32 = 220.0;

/// Least width of the names of the inputs, so that no word is broken, points.
const LABEL_WIDTH: f32 = 100.0;

/// Draws the choices; without an atlas, how to get one.
pub fn atlas_choices_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        source_ui(ui, &view.atlas, &session.atlas, commands);
        let Some(atlas) = session.atlas.atlas() else { return };
        let atlas: &Atlas = atlas;
        let Some(choice) = view.atlas.choice(atlas) else {
            ui.label("This atlas has fewer than two axes: there is no map of it.");
            return;
        };
        ui.add_space(looks::PART);
        map_form(ui, &mut view.atlas, atlas, &choice);
        ui.add_space(looks::PART);
        ui.strong("Everything else");
        ui.weak("Over all of its values together, or held at one of them.");
        let case = session.atlas.bins_of_case();
        held_form(ui, &mut view.atlas, (atlas, &choice, case), view.units);
        ui.add_space(looks::PART);
        case_ui(ui, &session.atlas, (&mut view.atlas, atlas), view.units, commands);
    });
}

/// Draws where the case at hand lies, input by input, and what can be done where that is outside.
fn case_ui(
    ui: &mut Ui,
    session: &AtlasSession,
    (view, atlas): (&mut AtlasView, &Atlas),
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let Some((name, why_none)) = session.case_at_hand() else { return };
    ui.strong("The case at hand");
    ui.add(Label::new(RichText::new(format!("{name}, in Scenario")).weak()).wrap());
    let warning = severity_color(ui, Severity::Warning);
    let wrapped = |ui: &mut Ui, text: RichText| drop(ui.add(Label::new(text).wrap()));
    let inputs = session.case_inputs(atlas, units);
    if let Some(why) = why_none {
        let text = format!("No PIT, so that it has no place in this atlas: {why}.");
        notice_ui(ui, Severity::Warning, text);
    }
    Grid::new("case in the atlas").num_columns(2).min_col_width(LABEL_WIDTH).show(ui, |ui| {
        for CaseInput { label, value, beyond } in &inputs {
            ui.add(Label::new(label).wrap());
            within_view(ui, |ui| {
                let value = value.as_deref().unwrap_or("not said");
                match beyond {
                    Some(beyond) => {
                        let text = format!("{value}, {beyond} the atlas");
                        wrapped(ui, RichText::new(text).color(warning));
                    }
                    None => wrapped(ui, RichText::new(value)),
                }
            });
            ui.end_row();
        }
    });
    let is_outside = inputs.iter().any(|input| input.beyond.is_some());
    if is_outside {
        ui.add(Label::new(OUTSIDE_REMEDY).wrap());
    }
    ui.horizontal_wrapped(|ui| {
        let hint = "Hold every input where the case has it";
        let hold = egui::Button::new("Hold the map at the case");
        let hold = ui.add_enabled(!is_outside && why_none.is_none(), hold).on_hover_text(hint);
        if hold.on_disabled_hover_text("The case lies in none of its cells").clicked() {
            for (axis, bin) in atlas.axes.iter().zip(session.bins_of_case()) {
                if bin.is_some() {
                    view.hold(&axis.name, *bin);
                }
            }
        }
        if ui.button("Show the scenario").on_hover_text("Where the case is changed").clicked() {
            commands.push(Command::Show(Pane::Scenario));
        }
    });
}

/// Draws which atlas is shown, and how another is opened.
fn source_ui(ui: &mut Ui, view: &AtlasView, session: &AtlasSession, commands: &mut Vec<Command>) {
    let name =
        view.file.as_deref().map_or_else(|| "The atlas of this version".to_owned(), file_name);
    ui.add(Label::new(RichText::new(name).strong()).truncate());
    match (session.atlas(), session.problem()) {
        (Some(atlas), _) => {
            let failed = match atlas.n_failed {
                0 => String::new(),
                n => format!(", {n} more without an answer"),
            };
            let text = format!("{} computed runs{failed}; {}", atlas.n_rows, atlas.program);
            let digest = format!("SHA-256 of the plan: {}", atlas.plan_sha256);
            ui.add(Label::new(RichText::new(text).weak()).wrap()).on_hover_text(digest);
        }
        (None, Some(why)) if view.file.is_some() => {
            notice_ui(ui, Severity::Error, why);
        }
        (None, Some(_)) => drop(ui.weak("There is none in this version.")),
        (None, None) => working_ui(ui, "Reading…"),
    }
    ui.horizontal_wrapped(|ui| {
        if ui.add(icon_button(Icon::FolderOpen, "Open an atlas…")).clicked() {
            commands.push(Command::Ask(Purpose::OpenAtlas));
        }
        let hint = "The atlas that comes with the program";
        if view.file.is_some() && ui.button("Shipped").on_hover_text(hint).clicked() {
            commands.push(Command::Atlas(AtlasCommand::Show(None)));
        }
        let hint = "Compute many runs on this machine";
        if ui.add(icon_button(Icon::Repeat, "Sweep…")).on_hover_text(hint).clicked() {
            commands.push(Command::Show(Pane::Sweep));
        }
    });
}

/// Draws the choice of outcome and axes.
fn map_form(ui: &mut Ui, view: &mut AtlasView, atlas: &Atlas, choice: &MapChoice) {
    Grid::new("atlas map").num_columns(2).show(ui, |ui| {
        let name = ui.label("Outcome");
        list_ui(ui, ("atlas outcome", &name), choice.measure.label(), |ui| {
            for measure in Measure::all() {
                let is_it = measure == choice.measure;
                if ui.selectable_label(is_it, measure.label()).clicked() {
                    view.outcome = measure.name().to_owned();
                }
            }
        });
        ui.end_row();
        for (at, label) in ["To the right", "Upwards"].into_iter().enumerate() {
            let name = ui.label(label);
            let shown = choice.axes.get(at).and_then(|idx| atlas.axes.get(*idx));
            let text = shown.map_or("", |axis| axis.label.as_str());
            list_ui(ui, (label, &name), text, |ui| {
                for (idx, axis) in atlas.axes.iter().enumerate() {
                    let is_it = choice.axes.get(at) == Some(&idx);
                    if ui.selectable_label(is_it, &axis.label).clicked() {
                        choose_axis(view, atlas, (choice, at), idx);
                    }
                }
            });
            ui.end_row();
        }
    });
    let is_beside_possible = atlas.axes.iter().enumerate().any(|(idx, axis)| {
        can_be_beside(&axis.name) && !choice.axes.contains(&idx) && axis.n_bins() > 1
    });
    if is_beside_possible {
        ui.checkbox(&mut view.is_beside, "Without and with stability control side by side");
    }
}

/// Shows another axis at a place. The one that stood there takes the other place if the new one had that.
fn choose_axis(view: &mut AtlasView, atlas: &Atlas, (choice, at): (&MapChoice, usize), idx: usize) {
    let mut axes = choice.axes;
    if axes[1 - at] == idx {
        axes[1 - at] = axes[at];
    }
    axes[at] = idx;
    view.axes = axes.map(|idx| atlas.axes.get(idx).map_or(String::new(), |axis| axis.name.clone()));
}

/// Draws a list that opens downwards.
///
/// - `name`: what tells it from others, and the label in front of it.
fn list_ui(
    ui: &mut Ui,
    (salt, name): (&str, &egui::Response),
    text: &str,
    options: impl FnOnce(&mut Ui),
) {
    within_view(ui, |ui| {
        ComboBox::from_id_salt(salt)
            .width(ui.available_width().min(LIST_WIDTH))
            .selected_text(text)
            .truncate()
            .show_ui(ui, options)
            .response
            .labelled_by(name.id)
    });
}

/// Draws where each input stands that is on neither axis.
///
/// - `case`: the bins of the case at hand.
fn held_form(
    ui: &mut Ui,
    view: &mut AtlasView,
    (atlas, choice, case): (&Atlas, &MapChoice, &[Option<usize>]),
    units: UnitSystem,
) {
    let beside = view.beside(atlas);
    let is_free = |idx: &usize| !choice.axes.contains(idx) && beside != Some(*idx);
    Grid::new("atlas inputs").num_columns(2).min_col_width(LABEL_WIDTH).show(ui, |ui| {
        for (idx, axis) in atlas.axes.iter().enumerate().filter(|(idx, _)| is_free(idx)) {
            let name = ui.add(Label::new(&axis.label).wrap());
            let mut held = choice.held.get(idx).copied().flatten();
            let before = held;
            let start = case.get(idx).copied().flatten().unwrap_or(axis.n_bins() / 2);
            match axis.is_choice() {
                true => labels_ui(ui, axis, &mut held, &name),
                false => slider_ui(ui, axis, &mut held, (start, &name), units),
            }
            ui.end_row();
            if held != before {
                view.hold(&axis.name, held);
            }
        }
    });
}

/// Draws a switch and a slider over the bins of an axis of numbers.
///
/// - `start`: the bin at which it is held first.
fn slider_ui(
    ui: &mut Ui,
    axis: &Axis,
    held: &mut Option<usize>,
    (start, name): (usize, &egui::Response),
    units: UnitSystem,
) {
    ui.vertical(|ui| {
        let mut is_held = held.is_some();
        let text = match *held {
            Some(bin) => axis.bin_text(bin, units),
            None => "all together".to_owned(),
        };
        let switch = ui.checkbox(&mut is_held, text).labelled_by(name.id);
        if switch.on_hover_text("Hold it at one bin of the atlas").changed() {
            *held = is_held.then_some(start);
        }
        let last = axis.n_bins().saturating_sub(1);
        if let Some(bin) = held.as_mut().filter(|_| last > 0) {
            ui.add(Slider::new(bin, 0..=last).show_value(false)).labelled_by(name.id);
        }
    });
}

/// Draws a list of the labels of an axis.
fn labels_ui(ui: &mut Ui, axis: &Axis, held: &mut Option<usize>, name: &egui::Response) {
    let text = held.and_then(|bin| axis.labels.get(bin)).map_or("all together", String::as_str);
    list_ui(ui, (axis.name.as_str(), name), text, |ui| {
        ui.selectable_value(held, None, "all together");
        for (bin, label) in axis.labels.iter().enumerate() {
            ui.selectable_value(held, Some(bin), label);
        }
    });
}
