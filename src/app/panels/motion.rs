//! The “Motion” pane: the simulated motion of the struck vehicle over time, beside the recorded
//! one.

use egui::{Id, Ui};

use crate::app::command::Command;
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::playback::PlaybackCommand;
use crate::app::recording::{Overlaid, overlaid, recording_menu_ui};
use crate::app::variants::{are_others_awaited, other_simulations};
use crate::app::widgets::{MIN_PLOT_HEIGHT, TITLE_HEIGHT, caveats_ui, time_figure};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    Figure, FigureElement, MOTION_CHANNELS, analysis_motion_figure, analysis_readout,
    control_figures, figure_readout, recording_line,
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
    let PaneContext { project, view, session, between, variants, commands, .. } = pane;
    let Some(answer) = analysis_or_hint(ui, session) else {
        return;
    };
    let SimulateAnswer { report, analysis } = answer;
    caveats_ui(ui, &report.caveats, view.units, commands);
    let to_controls = ui.horizontal_wrapped(|ui| {
        curves_menu_ui(ui, analysis, &mut view.motion_channels);
        recording_menu_ui(ui, &mut project.beside.recording, &session.sources);
        let button = ui.button("Inputs").on_hover_text("What drivers and systems do, below");
        ui.weak("Shift + drag in a plot: numbers between two cursors");
        button.clicked()
    });
    let time_s = session.playback.time_s;
    let shown = Shown {
        analysis,
        caveats: session.simulation_caveats(report).outdated_if(are_others_awaited(variants)),
        others: other_simulations(variants).collect(),
        recording: overlaid(project.beside.recording.as_ref(), &session.sources),
        time_s,
        units: view.units,
    };
    let first = view.motion_channels.first();
    let channels = view.motion_channels.iter();
    let channels: Vec<Plot> =
        channels.map(|channel| shown.channel_plot(*channel, first == Some(channel))).collect();
    let controls = shown.control_plots();
    let n_columns = if ui.available_width() > TWO_COLUMNS_WIDTH { 2 } else { 1 };
    let n_rows = MOTION_CHANNELS.len() / n_columns + usize::from(!controls.is_empty());
    let height = (ui.available_height() / n_rows as f32 - TITLE_HEIGHT).max(MIN_PLOT_HEIGHT);
    let mut plot_ui = |ui: &mut Ui, plot: &Plot| {
        let options = FigureOptions {
            id: plot.figure.y.label.clone(),
            link: Some(Id::unique("motion")),
            cursor_x: Some(time_s),
            height: Some(height),
            reset: session.fit_plots,
            legend: plot.legend,
            ..FigureOptions::default()
        };
        let response = time_figure(ui, &plot.heading, &plot.figure, options, between, commands);
        if let Some(picked_s) = response.picked_x {
            let last_s = figure_end(&plot.figure);
            commands.push(Command::Playback(PlaybackCommand::SetTime(picked_s.clamp(0.0, last_s))));
        }
    };
    let mut rows_ui = |ui: &mut Ui, plots: &[Plot]| {
        for row in plots.chunks(n_columns) {
            ui.columns(n_columns, |columns| {
                columns.iter_mut().zip(row).for_each(|(column, plot)| plot_ui(column, plot));
            });
        }
    };
    egui::ScrollArea::vertical().show(ui, |ui| {
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

/// What the plots of the panel show.
struct Shown<'a> {
    analysis: &'a Analysis,
    caveats: Caveats,
    /// The other variants by their names.
    others: Vec<(&'a str, &'a SimulateAnswer)>,
    recording: Option<Overlaid<'a>>,
    time_s: f64,
    units: UnitSystem,
}

/// A plot of the panel.
struct Plot {
    heading: String,
    figure: Figure,
    legend: bool,
}

impl Shown<'_> {
    fn channel_plot(&self, channel: Channel, legend: bool) -> Plot {
        let figure_of = |analysis: &Analysis, caveats: &Caveats| {
            analysis_motion_figure(analysis, caveats, channel, self.units)
        };
        let mut figure = figure_of(self.analysis, &self.caveats);
        for (i, (name, other)) in self.others.iter().enumerate() {
            figure.overlay(name, i, &figure_of(&other.analysis, &other.report.caveats));
        }
        if let Some((name, series, offset_s)) = &self.recording {
            let line = recording_line(name, series, *offset_s, channel, self.units);
            figure.elements.extend(line);
        }
        let heading = analysis_readout(self.analysis, channel, self.time_s, self.units);
        Plot { heading, figure, legend }
    }

    /// The plots of what was done to the wheels; those of other variants over those of the same kind.
    fn control_plots(&self) -> Vec<Plot> {
        let mut figures = control_figures(self.analysis, &self.caveats, self.units);
        let headings: Vec<String> =
            figures.iter().map(|figure| figure_readout(figure, self.time_s)).collect();
        for (i, (name, other)) in self.others.iter().enumerate() {
            let others = control_figures(&other.analysis, &other.report.caveats, self.units);
            for figure in &mut figures {
                let same = others.iter().find(|other| other.y.label == figure.y.label);
                same.into_iter().for_each(|other| figure.overlay(name, i, other));
            }
        }
        let plots = headings.into_iter().zip(figures);
        plots.map(|(heading, figure)| Plot { heading, figure, legend: true }).collect()
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
