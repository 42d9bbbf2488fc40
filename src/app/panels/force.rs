//! The contact force over time.

use egui::{ComboBox, Grid, Id, Ui};

use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::widgets::{figure_frame, value_row};
use crate::collision::{ChannelClass, PrincipalDirectionOfForce, Pulse, PulseShape};
use crate::data::{ForceHistory, contact_interval};
use crate::figure::analysis_force_figure;
use crate::render::FigureOptions;
use crate::units::{Quantity, UnitSystem};

/// Interval at which pulses are drawn, s.
const PULSE_INTERVAL_S: f64 = 5e-4;

/// Draws the force plot with its readouts.
pub fn force_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands } = pane;
    let Some(analysis) = analysis_or_hint(ui, session) else {
        return;
    };
    let Some(force) = &analysis.force else {
        ui.label("This file holds no contact force.");
        return;
    };
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Filter");
        let label = |class: Option<ChannelClass>| class.map_or("none", ChannelClass::label);
        let combo =
            ComboBox::from_id_salt("channel class").selected_text(label(project.channel_class));
        combo
            .show_ui(ui, |ui| {
                for class in std::iter::once(None).chain(ChannelClass::ALL.map(Some)) {
                    ui.selectable_value(&mut project.channel_class, class, label(class));
                }
            })
            .response
            .labelled_by(name.id)
            .on_hover_text("SAE J211 channel frequency class");
        ui.checkbox(&mut project.show_pulses, "Classic pulses").on_hover_text(
            "Half-sine, haversine, triangle and square of the same impulse and duration",
        );
    });
    readouts_ui(ui, force, view.units);
    let pulses = if project.show_pulses { pulses(force) } else { Vec::new() };
    let figure = analysis_force_figure(analysis, project.channel_class, &pulses, view.units);
    match figure {
        Ok(Some(figure)) => {
            let options = FigureOptions {
                id: "force".to_owned(),
                link: Some(Id::unique("force")),
                reset: session.fit_plots,
                ..FigureOptions::default()
            };
            figure_frame(ui, (&figure.title, &figure), &options, commands);
        }
        Ok(None) => {}
        Err(error) => {
            ui.label(format!("{error}. Choose another filter, or none."));
        }
    }
}

fn readouts_ui(ui: &mut Ui, force: &ForceHistory, units: UnitSystem) {
    let [px, py] = force.impulse_n_s();
    Grid::new("force readouts").num_columns(4).striped(true).show(ui, |ui| {
        let half_rows = [
            ("Impulse", Quantity::Impulse.shown_vector([px, py], units)),
            ("|Impulse|", Quantity::Impulse.shown(px.hypot(py), units)),
            ("Peak |F|", peak_text(force, units)),
            ("Contact", contact_text(force)),
            ("PDOF", pdof_text([px, py])),
        ];
        for (label, text) in half_rows {
            value_row(ui, label, &text);
        }
    });
}

fn peak_text(force: &ForceHistory, units: UnitSystem) -> String {
    force.peak().map_or("none".to_owned(), |(peak, at)| {
        format!("{} at {:.1} ms", Quantity::Force.shown(peak, units), at * 1e3)
    })
}

fn contact_text(force: &ForceHistory) -> String {
    contact_interval(force).map_or("none".to_owned(), |(start, end)| {
        format!("{:.1} ms, from {:.1} to {:.1} ms", (end - start) * 1e3, start * 1e3, end * 1e3)
    })
}

/// Against the heading before the impact, along X.
fn pdof_text(impulse_n_s: [f64; 2]) -> String {
    PrincipalDirectionOfForce::from_impulse(impulse_n_s, 0.0).map_or("none".to_owned(), |pdof| {
        format!("{:.0} deg, {} o'clock", pdof.angle_deg(), pdof.clock())
    })
}

/// The classic pulses of the same impulse over the same contact.
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
