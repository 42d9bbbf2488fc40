//! The “Force” pane: the contact force of the selected subject over time, its impulse, peak,
//! duration and principal direction, and classic pulses of the same impulse.

use egui::{ComboBox, Grid, Id, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::playback::PlaybackCommand;
use crate::app::project::Project;
use crate::app::variants::{are_others_awaited, other_simulations};
use crate::app::widgets::{MIN_PLOT_HEIGHT, TITLE_HEIGHT, time_figure, value_row};
use impactlab_core::collision::{ChannelClass, PrincipalDirectionOfForce, Pulse, PulseShape};
use impactlab_core::data::{ForceHistory, contact_interval};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_document::figure::analysis_force_figure;
use impactlab_draw::FigureOptions;
use impactlab_study::{ForceReport, SimulateAnswer};

/// Sample interval at which the classic pulses are drawn, s.
const PULSE_INTERVAL_S: f64 = 5e-4;

/// Draws the choice of the SAE J211 filter and of the classic pulses, the characteristic numbers of
/// the force, and the plot.
pub fn force_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, between, variants, commands, .. } = pane;
    let Some(SimulateAnswer { report, analysis }) =
        analysis_or_hint(ui, session, project, commands)
    else {
        return;
    };
    let (Some(force), Some(numbers)) = (&analysis.force, &report.force) else {
        ui.label("What is chosen has no contact force. Choose a case of a force data set, open a force file, or set up a scenario.");
        return;
    };
    let drawn = ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        settings_ui(ui, project);
        readouts_ui(ui, numbers, view.units);
        let pulses = if project.beside.show_pulses { pulses(force) } else { Vec::new() };
        let caveats = session.simulation_caveats(report).outdated_if(are_others_awaited(variants));
        let class = project.beside.channel_class;
        let figure = analysis_force_figure(analysis, &caveats, class, &pulses, view.units);
        let height = (ui.available_height() - TITLE_HEIGHT).max(MIN_PLOT_HEIGHT);
        let mut figure = match figure {
            Ok(Some(figure)) => figure,
            Ok(None) => return None,
            Err(error) => {
                ui.label(format!("{error}. Choose another filter, or none."));
                return None;
            }
        };
        for (i, (name, other)) in other_simulations(variants).enumerate() {
            if let Ok(Some(other)) = analysis_force_figure(
                &other.analysis,
                &other.report.caveats,
                class,
                &[],
                view.units,
            ) {
                figure.overlay(name, i, &other);
            }
        }
        let options = FigureOptions {
            id: "force".to_owned(),
            link: Some(Id::unique("force")),
            cursor_x: Some(figure.x.unit.from_si(session.playback.time_s)),
            height: Some(height),
            reset: session.fit_plots,
            ..FigureOptions::default()
        };
        let response = time_figure(ui, &figure.title, &figure, options, between, commands);
        response.picked_x.map(|x| figure.x.unit.to_si(x).max(0.0))
    });
    if let Some(picked_s) = drawn.inner {
        commands.push(Command::Playback(PlaybackCommand::SetTime(picked_s)));
    }
}

/// Draws the choice of the SAE J211 filter and of the classic pulses.
fn settings_ui(ui: &mut Ui, project: &mut Project) {
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Filter");
        let label = |class: Option<ChannelClass>| class.map_or("none", ChannelClass::label);
        let combo = ComboBox::from_id_salt("channel class")
            .selected_text(label(project.beside.channel_class));
        combo
            .show_ui(ui, |ui| {
                for class in std::iter::once(None).chain(ChannelClass::ALL.map(Some)) {
                    ui.selectable_value(&mut project.beside.channel_class, class, label(class));
                }
            })
            .response
            .labelled_by(name.id)
            .on_hover_text("SAE J211 channel frequency class");
        ui.checkbox(&mut project.beside.show_pulses, "Classic pulses").on_hover_text(
            "Half-sine, haversine, triangle and square of the same impulse and duration",
        );
    });
}

/// Draws impulse, peak, contact interval and principal direction of force (PDOF).
fn readouts_ui(ui: &mut Ui, force: &ForceReport, units: UnitSystem) {
    let [px, py] = force.impulse_n_s;
    let peak = Quantity::Force.shown(force.peak_n, units);
    Grid::new("force readouts").num_columns(4).striped(true).show(ui, |ui| {
        let half_rows = [
            ("Impulse", Quantity::Impulse.shown_vector([px, py], units)),
            ("|Impulse|", Quantity::Impulse.shown(px.hypot(py), units)),
            ("Peak |F|", format!("{peak} at {:.1} ms", force.peak_time_s * 1e3)),
            ("Contact", contact_text(force)),
            ("PDOF", pdof_text(force)),
        ];
        for (label, text) in half_rows {
            value_row(ui, label, &text);
        }
    });
}

/// Duration, start and end of the contact, or “none” if the force shows no contact.
fn contact_text(force: &ForceReport) -> String {
    let (Some(start), Some(end)) = (force.contact_start_s, force.contact_end_s) else {
        return "none".to_owned();
    };
    format!("{:.1} ms, from {:.1} to {:.1} ms", (end - start) * 1e3, start * 1e3, end * 1e3)
}

/// Principal direction of force: its angle, clockwise from the struck vehicle's heading before the
/// impact, and its clock direction; “none” without an impulse.
fn pdof_text(force: &ForceReport) -> String {
    match (force.pdof_deg, force.pdof_clock) {
        (Some(angle_deg), Some(clock)) => {
            let pdof = PrincipalDirectionOfForce::from_angle(angle_deg.to_radians());
            format!("{:.0} deg, {clock} o'clock", pdof.written_rad(0).to_degrees())
        }
        _ => "none".to_owned(),
    }
}

/// The classic pulses with the impulse and the contact interval of `force`, each with its name. A
/// pulse that cannot be constructed is left out; without a contact the list is empty.
fn pulses(force: &ForceHistory) -> Vec<(String, ForceHistory)> {
    let Some((start, end)) = contact_interval(force) else {
        return Vec::new();
    };
    let pulse = |shape: PulseShape| {
        let pulse = Pulse::new(shape, force.impulse_n_s(), start, end - start).ok()?;
        Some((shape.label().to_owned(), pulse.to_history(PULSE_INTERVAL_S).ok()?))
    };
    PulseShape::ALL.into_iter().filter_map(pulse).collect()
}
