//! What single files do not say about the struck vehicle: its speed, where the force acts, what steers,
//! brakes and drives it.

use std::path::PathBuf;

use egui::{ComboBox, Grid, RichText, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::model::file_name;
use crate::app::panels::ending::ending_form;
use crate::app::panes::PaneContext;
use crate::app::project::Project;
use crate::app::source::{Content, Source};
use crate::app::widgets::{quantity_field, within_view};
use impactlab_core::data::FileKind;
use impactlab_core::ranges::{CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, SPEED, STEERING_RATIO};
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};
use impactlab_core::vehicle::{ContactPoint, USUAL_STEERING_RATIO};
use impactlab_study::{ASSUMED_CONTACT, ASSUMED_SPEED_M_S, Drive, MotionSource, SeriesFile};

/// Whose ending is edited, where a force acts.
const OF_STRUCK: &str = "After the impact: the struck vehicle";

/// Draws speed, contact point, files of steering and torques, and what happens after the impact.
pub(super) fn file_start_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ui.strong("For single files");
    Grid::new("file start").num_columns(2).show(ui, |ui| {
        let start = project.start_mut();
        let begins_m_s = start.force.as_ref().and_then(|force| begins_m_s(&session.sources, force));
        start_fields(ui, start, begins_m_s, view.units);
        let files = |kind| open_files(&session.sources, kind);
        file_ui(ui, "Steering", &mut start.steer, &files(FileKind::Steer), commands);
        ratio_ui(ui, start, view.units);
        let open = files(FileKind::Wheels);
        file_ui(ui, "Torques at the wheels", &mut start.wheels, &open, commands);
    });
    ui.strong("For single files and cases of a force");
    let takes_ending = project.subject().is_some_and(|of| of.takes_ending(&session.sources));
    let Project { simulate, beside, .. } = &mut **project;
    let whose = if takes_ending { whose_ending(&simulate.source) } else { OF_STRUCK };
    let ending = if takes_ending { &mut simulate.ending } else { &mut beside.ending };
    ending_form(ui, whose, ending, &mut beside.steering_ratio, view.units);
}

/// Whose ending is edited, and from when on: a vehicle on which no force acts was not struck.
fn whose_ending(source: &MotionSource) -> &'static str {
    if source.is_alone() { "From the start: the vehicle" } else { OF_STRUCK }
}

/// The velocity with which the car of an open force of a finite-element run begins, m/s.
fn begins_m_s(sources: &[Source], force: &SeriesFile) -> Option<[f64; 2]> {
    let source = sources.iter().find(|of| of.path == force.path && of.map == force.map)?;
    match &source.content {
        Content::File(file) => file.loaded.model_start.as_ref()?.of_force_m_s,
        _ => None,
    }
}

/// Draws rows of a two-column grid with the speed before the impact and the contact point.
///
/// - `begins_m_s`: velocity with which the car of a finite-element run begins, if the file says it.
pub(in crate::app) fn start_fields(
    ui: &mut Ui,
    start: &mut Drive,
    begins_m_s: Option<[f64; 2]>,
    units: UnitSystem,
) {
    speed_ui(ui, start, begins_m_s, units);
    contact_ui(ui, start, units);
}

/// The open files of a kind.
pub(super) fn open_files(sources: &[Source], kind: FileKind) -> Vec<PathBuf> {
    let is_of_kind = |source: &&Source| match &source.content {
        Content::File(file) => file.loaded.kind == kind,
        _ => false,
    };
    sources.iter().filter(is_of_kind).map(|source| source.path.clone()).collect()
}

/// Draws a row of a two-column grid with the choice of a file among those that are open.
fn file_ui(
    ui: &mut Ui,
    label: &str,
    chosen: &mut Option<SeriesFile>,
    open: &[PathBuf],
    commands: &mut Vec<Command>,
) {
    let hint = "A file that goes with the one that is shown. Drop it on the window, or open it";
    let before = chosen.as_ref().map(|file| file.path.clone());
    let mut path = before.clone();
    file_list_ui(ui, label, "none", hint, &mut path, open);
    if path != before {
        *chosen = path.map(SeriesFile::new);
    }
    ui.end_row();
    ui.label("");
    if ui.small_button("Open…").clicked() {
        commands.push(Command::Ask(Purpose::Files));
    }
    ui.end_row();
}

/// Draws two cells of a grid with the choice of one of the open files, or of none.
pub(super) fn file_list_ui(
    ui: &mut Ui,
    label: &str,
    none: &str,
    hint: &str,
    chosen: &mut Option<PathBuf>,
    open: &[PathBuf],
) {
    let name = ui.label(label).on_hover_text(hint);
    let text = chosen.as_deref().map_or(none.to_owned(), file_name);
    ComboBox::from_id_salt(label)
        .selected_text(text)
        .show_ui(ui, |ui| {
            ui.selectable_value(chosen, None, none);
            for path in open {
                ui.selectable_value(chosen, Some(path.clone()), file_name(path));
            }
        })
        .response
        .labelled_by(name.id)
        .on_hover_text(hint);
}

/// Draws the steering ratio for files that hold angles of the steering wheel.
fn ratio_ui(ui: &mut Ui, start: &mut Drive, units: UnitSystem) {
    let mut is_of_wheel = start.steering_ratio.is_some();
    ui.label("");
    let choice = ui.checkbox(&mut is_of_wheel, "Angles of the steering wheel");
    if choice.on_hover_text("As the steering file gives them; else of the road wheels").changed() {
        start.steering_ratio = is_of_wheel.then_some(USUAL_STEERING_RATIO);
    }
    ui.end_row();
    if let Some(ratio) = &mut start.steering_ratio {
        quantity_field(ui, "Steering ratio", ratio, &STEERING_RATIO, units);
    }
}

/// Draws the speed before the impact if the user has set it, otherwise the value that is taken.
fn speed_ui(ui: &mut Ui, start: &mut Drive, begins_m_s: Option<[f64; 2]>, units: UnitSystem) {
    let label = "Speed before impact";
    let Some(speed_m_s) = &mut start.speed_m_s else {
        let format = NumberFormat::english(units);
        let shown = |speed_m_s: f64| format.rounded(Quantity::Speed, speed_m_s);
        let (speed_m_s, vy_m_s, text) = match begins_m_s {
            Some([vx, vy]) => (vx, Some(vy), format!("{}, as the file begins", shown(vx))),
            None => (ASSUMED_SPEED_M_S, None, shown(ASSUMED_SPEED_M_S)),
        };
        if assumed_ui(ui, label, &text) {
            start.speed_m_s = Some(speed_m_s);
            start.vy_m_s = start.vy_m_s.or(vy_m_s);
        }
        return;
    };
    quantity_field(ui, label, speed_m_s, &SPEED, units);
    if leave_open_ui(ui, "Speed not known") {
        start.speed_m_s = None;
        // What was taken from this file with the speed says nothing of the next one.
        if begins_m_s.is_some_and(|[_, vy_m_s]| start.vy_m_s == Some(vy_m_s)) {
            start.vy_m_s = None;
        }
    }
}

/// Where a force acts, seen from the CG.
fn contact_in_words(contact: &ContactPoint, units: UnitSystem) -> String {
    let ContactPoint { x_body_m, y_body_m, height_m } = *contact;
    let format = NumberFormat::english(units);
    let length = |m: f64| format.rounded(Quantity::Length, m);
    let along = if x_body_m < 0.0 { "behind" } else { "ahead of" };
    let side = if y_body_m < 0.0 { "right" } else { "left" };
    format!(
        "{} {along} the CG, {} to the {side}, {} above the ground",
        length(x_body_m.abs()),
        length(y_body_m.abs()),
        length(height_m)
    )
}

/// Draws the contact point, at which the force acts, if the user has set it, otherwise the point
/// that is assumed.
fn contact_ui(ui: &mut Ui, start: &mut Drive, units: UnitSystem) {
    let Some(ContactPoint { x_body_m, y_body_m, height_m }) = &mut start.contact else {
        let place = contact_in_words(&ASSUMED_CONTACT, units);
        let assumed = format!("{place}; a yaw moment in the file takes precedence");
        if assumed_ui(ui, "Contact point", &assumed) {
            start.contact = Some(ASSUMED_CONTACT);
        }
        return;
    };
    for (label, value, range) in [
        ("Contact ahead of CG", x_body_m, CONTACT_X),
        ("Contact left of CG", y_body_m, CONTACT_Y),
        ("Contact above ground", height_m, CONTACT_HEIGHT),
    ] {
        quantity_field(ui, label, value, &range, units);
    }
    if leave_open_ui(ui, "Contact point not known") {
        start.contact = None;
    }
}

/// Draws a row of a two-column grid with the value that is assumed, and returns whether the user
/// clicked the button to set the value instead.
fn assumed_ui(ui: &mut Ui, label: &str, assumed: &str) -> bool {
    ui.label(label);
    let button = within_view(ui, |ui| {
        ui.vertical(|ui| {
            ui.add(egui::Label::new(RichText::new(format!("assumed: {assumed}")).weak()).wrap());
            ui.small_button("Set").on_hover_text("Say it instead of assuming it")
        })
        .inner
    });
    ui.end_row();
    button.clicked()
}

/// Draws a row of a two-column grid with a button, and returns whether the user clicked it to have
/// the value assumed.
fn leave_open_ui(ui: &mut Ui, label: &str) -> bool {
    ui.label("");
    let is_clicked = ui.small_button(label).on_hover_text("Assume a value").clicked();
    ui.end_row();
    is_clicked
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    /// “-1.500 m ahead, -0.9000 m left, 0.5200 m high” was told of a place behind and to the right.
    #[test]
    fn the_assumed_contact_is_told_as_one_says_where_something_is() {
        let told = contact_in_words(&ASSUMED_CONTACT, UnitSystem::Si);
        assert_eq!(told, "1.5 m behind the CG, 0.9 m to the right, 0.52 m above the ground");
    }

    /// A car that steers along a file was a struck vehicle after an impact.
    #[test]
    fn a_vehicle_on_which_no_force_acts_was_not_struck() {
        for (kind, whose) in [
            (FileKind::Force, OF_STRUCK),
            (FileKind::Steer, "From the start: the vehicle"),
            (FileKind::Wheels, "From the start: the vehicle"),
        ] {
            let file = SeriesFile::new("log.csv");
            let source = MotionSource::from_file(file, kind, Drive::default());
            assert_eq!(whose_ending(&source), whose, "{kind:?}");
        }
    }

    #[test]
    fn a_velocity_taken_from_a_file_goes_with_the_speed_but_not_one_that_was_stated() {
        let begins_m_s = [10.0, 1.5];
        for (stated_m_s, set_m_s, left_m_s) in [
            (None, Some(1.5), None),
            (Some(-2.0), Some(-2.0), Some(-2.0)),
            (Some(0.0), Some(0.0), Some(0.0)),
        ] {
            let mut harness = Harness::new_ui_state(
                |ui, start: &mut Drive| {
                    Grid::new("start").num_columns(2).show(ui, |ui| {
                        start_fields(ui, start, Some(begins_m_s), UnitSystem::Si);
                    });
                },
                Drive { vy_m_s: stated_m_s, ..Drive::default() },
            );
            harness.run();
            harness.get_all_by_label("Set").next().unwrap().click();
            harness.run();
            assert_eq!((harness.state().speed_m_s, harness.state().vy_m_s), (Some(10.0), set_m_s));
            harness.get_by_label("Speed not known").click();
            harness.run();
            assert_eq!((harness.state().speed_m_s, harness.state().vy_m_s), (None, left_m_s));
        }
    }
}
