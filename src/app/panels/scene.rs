//! The “Scene” pane: a plan view of the motion at a chosen time, and the clock with which the time
//! is chosen.

use egui::{Slider, Ui};

use crate::app::command::Command;
use crate::app::looks::{Icon, icon_button};
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::recording::overlaid;
use crate::app::variants::{are_others_awaited, other_simulations};
use crate::app::widgets::{badges_ui, figure_frame};
use crate::figure::{analysis_scene_figure, recording_path};
use crate::render::FigureOptions;
use crate::study::{SimulateAnswer, Trust};
use crate::units::Quantity;

/// Seconds of the motion that can be played in a second.
const SPEEDS: [f64; 5] = [0.05, 0.1, 0.25, 0.5, 1.0];

/// Draws the time slider and the plan view.
pub fn scene_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, variants, commands, .. } = pane;
    let Some(SimulateAnswer { analysis, report }) = analysis_or_hint(ui, session) else {
        return;
    };
    let series = analysis.simulation.as_ref().map(|motion| &motion.series);
    let Some(series) = series.or(analysis.reference.as_ref()) else {
        ui.label("There is no motion to show.");
        return;
    };
    let end_s = series.time_s().last().copied().unwrap_or(0.0);
    clock_ui(ui, (session.time_s, end_s), (session.playing, view.playback_speed), commands);
    badges_ui(ui, &report.badges);
    if let Some(rest) = &report.rest {
        let distance = Quantity::Length.shown(rest.distance_m, view.units);
        let position = Quantity::Length.shown_vector([rest.x_m, rest.y_m], view.units);
        ui.label(format!("At rest after {:.2} s and {distance}, at {position}", rest.time_s));
    }
    let trust = session.simulation_trust(report).outdated_if(are_others_awaited(variants));
    let mut figure = analysis_scene_figure((analysis, &trust), session.time_s, view.units);
    for (i, (name, other)) in other_simulations(variants).enumerate() {
        let of_other = Trust::new(&other.report.badges, &other.report.assumptions);
        let shown = (&other.analysis, &of_other);
        figure.overlay((name, i), &analysis_scene_figure(shown, session.time_s, view.units));
    }
    if let Some((name, series, _)) = overlaid(project.recording.as_ref(), &session.sources) {
        figure.elements.extend(recording_path((&name, series), view.units));
    }
    let options = FigureOptions {
        id: "scene".to_owned(),
        reset: session.fit_plots,
        ..FigureOptions::default()
    };
    figure_frame(ui, (&figure.title, &figure), &options, commands);
}

/// Draws the button that plays or pauses the motion, and the slider of the time.
///
/// - `time_s`: the present time, s.
/// - `end_s`: the end of the motion and of the slider, s; the slider starts at 0.
/// - `speed`: seconds of the motion that are played in a second.
pub fn clock_ui(
    ui: &mut Ui,
    (time_s, end_s): (f64, f64),
    (is_playing, speed): (bool, f64),
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        let (of, label) = match is_playing {
            true => (Icon::Pause, "Pause"),
            false => (Icon::Play, "Play"),
        };
        if ui.add(icon_button(of, label)).on_hover_text("Space").clicked() {
            commands.push(Command::TogglePlay);
        }
        let text = |speed: f64| format!("× {speed}");
        let list = egui::ComboBox::from_id_salt("playback speed").width(58.0);
        let list = list.selected_text(text(speed)).show_ui(ui, |ui| {
            for other in SPEEDS {
                if ui.selectable_label(other == speed, text(other)).clicked() {
                    commands.push(Command::SetSpeed(other));
                }
            }
        });
        list.response.on_hover_text("Speed of the playback");
        let name = ui.label("Time");
        let mut time_s = time_s;
        ui.spacing_mut().slider_width = (ui.available_width() - 90.0).max(80.0);
        let slider = Slider::new(&mut time_s, 0.0..=end_s).suffix(" s").fixed_decimals(3);
        if ui.add(slider).labelled_by(name.id).changed() {
            commands.push(Command::SetTime(time_s));
        }
    });
}
