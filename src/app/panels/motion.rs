//! The “Motion” pane: the simulated motion of the struck vehicle over time, beside the recorded
//! one.

use egui::{Id, Ui};

use crate::app::command::Command;
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::playback::PlaybackCommand;
use crate::app::recording::{overlaid, recording_menu_ui};
use crate::app::variants::{are_others_awaited, other_simulations};
use crate::app::widgets::{MIN_PLOT_HEIGHT, TITLE_HEIGHT, caveats_ui, time_figure};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_document::figure::{analysis_motion_figure, analysis_readout, recording_line};
use impactlab_draw::FigureOptions;
use impactlab_study::SimulateAnswer;
use impactlab_study::analysis::Analysis;

/// Draws v_x, v_y, yaw rate and roll over time, with a cursor at the time of the scene. A click or
/// a drag in a plot sets this time.
pub fn motion_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, between, variants, commands, .. } = pane;
    let Some(SimulateAnswer { report, analysis }) = analysis_or_hint(ui, session) else {
        return;
    };
    caveats_ui(ui, &report.caveats, commands);
    ui.horizontal_wrapped(|ui| {
        curves_menu_ui(ui, analysis, &mut view.motion_channels);
        recording_menu_ui(ui, &mut project.beside.recording, &session.sources);
        ui.weak("Shift + drag in a plot: numbers between two cursors");
    });
    let recording = overlaid(project.beside.recording.as_ref(), &session.sources);
    let two_columns = ui.available_width() > 560.0;
    let rows = if two_columns { 2.0 } else { 4.0 };
    let height = (ui.available_height() / rows - TITLE_HEIGHT).max(MIN_PLOT_HEIGHT);
    let caveats = session.simulation_caveats(report).outdated_if(are_others_awaited(variants));
    let mut plot = |ui: &mut Ui, channel| {
        let mut figure = analysis_motion_figure(analysis, &caveats, channel, view.units);
        for (i, (name, other)) in other_simulations(variants).enumerate() {
            let other =
                analysis_motion_figure(&other.analysis, &other.report.caveats, channel, view.units);
            figure.overlay(name, i, &other);
        }
        if let Some((name, series, offset_s)) = &recording {
            let line = recording_line(name, series, *offset_s, channel, view.units);
            figure.elements.extend(line);
        }
        let options = FigureOptions {
            id: channel.label().to_owned(),
            link: Some(Id::unique("motion")),
            cursor_x: Some(session.playback.time_s),
            height: Some(height),
            reset: session.fit_plots,
            legend: Some(&channel) == view.motion_channels.first(),
            ..FigureOptions::default()
        };
        let heading = analysis_readout(analysis, channel, session.playback.time_s, view.units);
        let response = time_figure(ui, &heading, &figure, options, between, commands);
        if let Some(time_s) = response.picked_x {
            let last = figure_end(&figure);
            commands.push(Command::Playback(PlaybackCommand::SetTime(time_s.clamp(0.0, last))));
        }
    };
    egui::ScrollArea::vertical().show(ui, |ui| {
        let n_columns = if two_columns { 2 } else { 1 };
        for row in view.motion_channels.chunks(n_columns) {
            ui.columns(n_columns, |columns| {
                for (column, &channel) in columns.iter_mut().zip(row) {
                    plot(column, channel);
                }
            });
        }
    });
}

/// Draws the menu in which the curves are chosen, of those that there are.
fn curves_menu_ui(ui: &mut Ui, analysis: &Analysis, chosen: &mut Vec<Channel>) {
    let simulation = analysis.simulation.as_ref().map(|motion| &motion.series);
    let motions: Vec<&TimeSeries> = simulation.into_iter().chain(&analysis.reference).collect();
    let has = |channel: Channel| motions.iter().any(|motion| motion.get(channel).is_some());
    ui.menu_button("Curves", |ui| {
        for &channel in Channel::ALL.iter().filter(|channel| has(**channel)) {
            let mut is_chosen = chosen.contains(&channel);
            if ui.checkbox(&mut is_chosen, channel.label()).changed() {
                chosen.retain(|other| *other != channel);
                chosen.extend(is_chosen.then_some(channel));
            }
        }
    });
}

/// Largest time at which a line of the figure ends, s; 0 if the figure has no line.
fn figure_end(figure: &impactlab_document::figure::Figure) -> f64 {
    let ends = figure.elements.iter().filter_map(|element| match element {
        impactlab_document::figure::FigureElement::Line(series) => {
            series.points.last().map(|point| point[0])
        }
        _ => None,
    });
    ends.fold(0.0, f64::max)
}
