//! The “Motion” pane: the simulated motion of the struck vehicle over time, beside the recorded
//! one.

use std::sync::Arc;

use egui::{Id, Ui};

use crate::app::command::Command;
use crate::app::motion_plots::{ControlPlot, MotionPlots, MotionSource, recorded};
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::playback::PlaybackCommand;
use crate::app::recording::recording_menu_ui;
use crate::app::scene::SceneSource;
use crate::app::variants::are_others_awaited;
use crate::app::widgets::{MIN_PLOT_HEIGHT, TITLE_HEIGHT, caveats_ui, time_figure};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    Figure, FigureElement, MOTION_CHANNELS, analysis_readout, figure_readout,
};
use impactlab_draw::FigureOptions;
use impactlab_study::SimulateAnswer;
use impactlab_study::analysis::Analysis;

/// Width from which on two plots stand side by side, points.
const TWO_COLUMNS_WIDTH: f32 = 480.0;

/// What is said where nothing acts on the wheels.
const NOBODY_ACTS: &str = "Nobody steers, brakes or accelerates: there are no inputs to be shown.";

/// What is shown of drivers and systems.
const ABOUT_CONTROLS: &str = "As the simulation gave it to the wheels, drivers, anti-lock system and \
    stability control (ESC) included. Torques are those of brakes, engine and bent bodywork; the road may \
    hold less of them, and a locked wheel has none of its own. Grey: the vehicles are in contact.";

/// Draws v_x, v_y, yaw rate and roll over time, and below them what drivers and systems did to the wheels,
/// with a cursor at the time of the scene. A click or a drag in a plot sets this time.
pub fn motion_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let mut plots = std::mem::take(&mut pane.session.motion_plots);
    plots_ui(ui, pane, &mut plots);
    pane.session.motion_plots = plots;
}

fn plots_ui(ui: &mut Ui, pane: &mut PaneContext<'_>, plots: &mut MotionPlots) {
    let PaneContext { project, view, session, between, variants, commands, .. } = pane;
    if analysis_or_hint(ui, session, project, commands).is_none() {
        return;
    }
    let Some(answer) = session.analysis.ok() else { return };
    let SimulateAnswer { report, analysis } = &**answer;
    caveats_ui(ui, &report.caveats, view.units, commands);
    let to_controls = ui.horizontal_wrapped(|ui| {
        curves_menu_ui(ui, analysis, &mut view.motion_channels);
        recording_menu_ui(ui, &mut project.beside.recording, &session.sources);
        let button = ui.button("Inputs").on_hover_text("What drivers and systems do, below");
        ui.weak("Shift + drag in a plot: numbers between two cursors");
        button.clicked()
    });
    let (time_s, units) = (session.playback.time_s, view.units);
    let source = MotionSource {
        answer: Arc::clone(answer),
        caveats: session.simulation_caveats(report).outdated_if(are_others_awaited(variants)),
        others: SceneSource::others(variants),
        recording: recorded(project.beside.recording.as_ref(), &session.sources),
        channels: view.motion_channels.clone(),
        units,
    };
    plots.update(source, &session.sources);
    let [channels, controls] = plots.drawn(analysis, &view.motion_channels, time_s, units);
    let n_columns = if ui.available_width() > TWO_COLUMNS_WIDTH { 2 } else { 1 };
    let n_rows = MOTION_CHANNELS.len() / n_columns + usize::from(!controls.is_empty());
    let height = (ui.available_height() / n_rows as f32 - TITLE_HEIGHT).max(MIN_PLOT_HEIGHT);
    let mut plot_ui = |ui: &mut Ui, plot: &Plot<'_>| {
        let options = FigureOptions {
            id: plot.figure.y.label.clone(),
            link: Some(Id::unique("motion")),
            cursor_x: Some(time_s),
            height: Some(height),
            reset: session.fit_plots,
            legend: plot.legend,
            ..FigureOptions::default()
        };
        let response = time_figure(ui, &plot.heading, plot.figure, options, between, commands);
        if let Some(picked_s) = response.picked_x {
            let last_s = figure_end(plot.figure);
            commands.push(Command::Playback(PlaybackCommand::SetTime(picked_s.clamp(0.0, last_s))));
        }
    };
    let mut rows_ui = |ui: &mut Ui, plots: &[Plot<'_>]| {
        for row in plots.chunks(n_columns) {
            ui.columns(n_columns, |columns| {
                columns.iter_mut().zip(row).for_each(|(column, plot)| plot_ui(column, plot));
            });
        }
    };
    egui::ScrollArea::vertical().show(ui, |ui| {
        if channels.is_empty() {
            ui.weak("None of these curves was recorded or simulated: choose others under Curves.");
        }
        rows_ui(ui, &channels);
        let heading = match (controls.is_empty(), analysis.simulation.is_some()) {
            (false, _) => ui.strong("What drivers and systems do").on_hover_text(ABOUT_CONTROLS),
            (true, true) => ui.weak(NOBODY_ACTS),
            (true, false) => ui.weak("Without a simulation nothing is known of the inputs."),
        };
        if to_controls.inner {
            heading.scroll_to_me(Some(egui::Align::TOP));
        }
        rows_ui(ui, &controls);
    });
}

/// A plot of the panel.
struct Plot<'a> {
    heading: String,
    figure: &'a Figure,
    legend: bool,
}

impl MotionPlots {
    /// The plots of the channels, of those that were recorded or simulated, and of the inputs.
    fn drawn(
        &self,
        analysis: &Analysis,
        channels: &[Channel],
        time_s: f64,
        units: UnitSystem,
    ) -> [Vec<Plot<'_>>; 2] {
        let of_channels = channels.iter().zip(&self.channels);
        let of_channels = of_channels.filter(|(_, figure)| !figure.elements.is_empty());
        let of_channels = of_channels.enumerate().map(|(idx, (channel, figure))| Plot {
            heading: analysis_readout(analysis, *channel, time_s, units),
            figure,
            legend: idx == 0,
        });
        let of_controls = self.controls.iter().map(|ControlPlot { own, figure }| Plot {
            heading: figure_readout(own, time_s),
            figure,
            legend: true,
        });
        [of_channels.collect(), of_controls.collect()]
    }
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
fn figure_end(figure: &Figure) -> f64 {
    let ends = figure.elements.iter().filter_map(|element| match element {
        FigureElement::Line(series) => series.points.last().map(|point| point[0]),
        _ => None,
    });
    ends.fold(0.0, f64::max)
}
