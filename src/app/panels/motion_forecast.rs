//! The “Motion forecast” pane: the probability distribution of the motion of the struck vehicle as
//! the response network predicts it, in a plan view and over time.

use std::sync::Arc;

use egui::{DragValue, Id, Panel, ScrollArea, Ui};
use impactlab_core::uncertainty::Caveats;

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::ground::{ABOUT_SITES, OPEN_SITE};
use crate::app::looks;
use crate::app::model::file_name;
use crate::app::panels::analysis_or_hint;
use crate::app::panels::model_row::{model_row_ui, no_model_ui};
use crate::app::panels::scene::clock_ui;
use crate::app::panels::until_rest::until_rest_ui;
use crate::app::panels::vehicle::one_contact_ui;
use crate::app::panes::PaneContext;
use crate::app::playback::{Playback, PlaybackCommand};
use crate::app::project::Project;
use crate::app::response::{
    DensityAnswer, DensityChoice, MotionAnswer, ResponseSession, ResponseView,
};
use crate::app::state::{Session, View};
use crate::app::variants::{AnsweredVariant, are_others_awaited, other_forecasts};
use crate::app::widgets::{
    MIN_PLOT_HEIGHT, TITLE_HEIGHT, caveats_ui, count_field, facts_ui, figure_frame, notice_ui,
    seed_field, sentences_ui, working_ui,
};
use impactlab_core::data::{Severity, TimeSeries};
use impactlab_core::ranges::DRAWS;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    FORECAST_CHANNELS, MotionForecastFigure, forecast_channel_figure, forecast_readout,
    forecast_scene_figure, forecast_surroundings,
};
use impactlab_draw::FigureOptions;
use impactlab_study::analysis::Analysis;
use impactlab_study::{ForceSource, MotionSource, PredictMotionAnswer, PredictMotionReport};

/// What stands above the plots over time of a coarse forecast, and of a full one.
const COARSE: &str =
    "Of few draws, so that regions and bands are rough: the full forecast is being computed";
const ABOUT_BANDS: &str =
    "Bands hold 50 and 90 %. Numbers at the cursor: central path, and from where to where 90 %.";

/// Width of the form before the user resizes it, points.
const FORM_WIDTH: f32 = 330.0;
/// Share of the available height that the plan view takes.
const SCENE_SHARE: f32 = 0.52;
/// Largest difference between the time of a computed density and the time of the slider, s. A
/// density further away is not drawn.
const STALE_S: f64 = 0.15;
/// Number of plots over time in a row.
const MAX_COLUMNS: usize = 3;
/// Smallest width of such a plot with its heading, points.
const MIN_PLOT_WIDTH: f32 = 190.0;

/// Draws the form and the outcome on the left, and on the right the plan view and the predicted
/// quantities over time.
pub fn motion_forecast_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, variants, commands, .. } = pane;
    if session.response.model.current.is_none() {
        let use_of_it = "A response model says where a struck vehicle goes after the impact, and how sure that is.";
        no_model_ui(ui, &session.response.model, use_of_it, commands);
        return;
    }
    let left = Panel::left("motion form").default_size(FORM_WIDTH).size_range(260.0..=520.0);
    left.show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            model_ui(ui, &session.response, commands);
            ui.separator();
            force_ui(ui, project, session, commands);
            until_rest_ui(ui, project);
            one_contact_ui(ui, project);
            ui.separator();
            shown_ui(ui, &mut view.response, session, commands);
            if let Some(shown) = shown_forecast(session) {
                ui.separator();
                let answer = shown.answer;
                super::faded_if(ui, shown.is_late, |ui| {
                    let report = &answer.answer.report;
                    sentences_ui(ui, &report.answer_card(), view.units);
                    lanes_ui(ui, report, project, session, commands);
                    ui.separator();
                    caveats_ui(ui, &report.caveats, view.units, commands);
                    facts_ui(ui, &report.scenario, &report.detail_tables(), view.units);
                });
            }
        });
    });
    egui::CentralPanel::default_margins().frame(egui::Frame::new().inner_margin(looks::GRID)).show(
        ui,
        |ui| {
            if analysis_or_hint(ui, session, project, commands).is_none() {
                return;
            }
            if let Some(shown) = shown_forecast(session) {
                return super::faded_if(ui, shown.is_late, |ui| {
                    figures_ui(ui, &shown, session, variants, view, commands);
                });
            }
            match &session.response.forecast.answer {
                Some(Ok(_)) => {}
                Some(Err(problem)) => {
                    notice_ui(ui, Severity::Error, format!("No forecast: {problem}"));
                }
                None if session.response.forecast.is_waiting() => {
                    working_ui(ui, "Forecasting…");
                }
                None => {
                    ui.label("There is no force on a vehicle here. Pick a case with a force, open a force file, or set up a scenario.");
                }
            }
        },
    );
}

/// The forecast that is shown.
struct ShownForecast<'a> {
    answer: &'a Arc<MotionAnswer>,
    /// Whether it is not of what is asked any more.
    is_late: bool,
    /// Whether it is of few draws, and the full one is being computed.
    is_coarse: bool,
}

/// The newest forecast that there is; a coarse one until the full one comes.
fn shown_forecast(session: &Session) -> Option<ShownForecast<'_>> {
    let forecast = &session.response.forecast;
    let is_late = session.is_motion_late();
    if let Some((answer, is_of_latest)) = forecast.coarse() {
        let is_late = is_late && (!is_of_latest || session.analysis.is_unfinished());
        return Some(ShownForecast { answer, is_late, is_coarse: true });
    }
    Some(ShownForecast { answer: forecast.ok()?, is_late, is_coarse: false })
}

/// Draws what lacks for lanes to be counted in the forecast of a scenario, with the way there.
fn lanes_ui(
    ui: &mut Ui,
    report: &PredictMotionReport,
    project: &mut Project,
    session: &Session,
    commands: &mut Vec<Command>,
) {
    let is_scenario = matches!(project.simulate.source, MotionSource::Scenario { .. });
    if !report.places.is_empty() || !is_scenario {
        return;
    }
    let site = session.ground.shown().map(|loaded| &loaded.site);
    ui.horizontal_wrapped(|ui| {
        if report.contacts.is_none() && project.simulate.one_contact {
            ui.weak("For lanes: both vehicles.");
            let hint = "After the first contact, too: it takes One contact only back";
            if ui.small_button("Follow both vehicles").on_hover_text(hint).clicked() {
                project.simulate.one_contact = false;
            }
        }
        let lack = match site {
            None if session.ground.is_loading() => return,
            None => "For lanes: a site.".to_owned(),
            Some(site) if site.lanes.is_empty() => format!("{} has no lanes.", site.name),
            Some(_) => return,
        };
        ui.weak(lack);
        if ui.small_button(OPEN_SITE).on_hover_text(ABOUT_SITES).clicked() {
            commands.push(Command::Ask(Purpose::Ground));
        }
    });
}

/// Names the current response model, describes its training on hover, and warns of a model that was
/// trained on simulations only.
fn model_ui(ui: &mut Ui, response: &ResponseSession, commands: &mut Vec<Command>) {
    let Some(current) = &response.model.current else { return };
    let record = current.model.record();
    let calibrated = match current.model.latents().n_calibrated {
        0 => "Uncertainty: a guess".to_owned(),
        n => format!("Uncertainty calibrated on {n} trajectories, each unseen"),
    };
    let hint = format!(
        "Trained on {} trajectories of {}; {} kept for the test. Pre-trained on {} simulations. {} epochs, seed {}, {} weights, impactlab {}. {calibrated}.",
        record.train.len(),
        record.data,
        record.test.len(),
        record.detail.n_simulated,
        record.history.len(),
        record.seed,
        current.model.n_parameters(),
        record.version,
    );
    model_row_ui(ui, &response.model, &hint, commands);
    if record.train.is_empty() {
        let text = "Pre-trained on simulations alone: no better than the 4DOF model.";
        notice_ui(ui, Severity::Warning, text);
    }
}

/// Draws the choice of the force that drives the forecast: the given one or one predicted by the
/// force network. Warnings say why a force cannot be predicted, and which features of the collision
/// lie outside the training of the force model.
fn force_ui(ui: &mut Ui, project: &mut Project, session: &Session, commands: &mut Vec<Command>) {
    let request = &mut project.predict_motion;
    let predicted = ForceSource::Predicted(project.predict_force.model.clone());
    ui.horizontal_wrapped(|ui| {
        ui.strong("Force");
        if let ForceSource::File(path) = &request.force {
            let name = format!("of {}", file_name(path));
            ui.radio(true, name).on_hover_text(path.display().to_string());
        }
        ui.radio_value(&mut request.force, ForceSource::Given, "as given").on_hover_text(
            "That of the case or the file; of a scenario the classic pulse with the impulse of the momentum solution",
        );
        ui.radio_value(&mut request.force, predicted, "as predicted").on_hover_text(
            "By the force network, with all that is uncertain about it: needs a case of a force data set, or a scenario",
        );
    });
    if !matches!(request.force, ForceSource::Predicted(_)) {
        return;
    }
    ui.horizontal(|ui| {
        let name = ui.label("Force curves");
        count_field(ui, &mut request.draws, &DRAWS, 0.2)
            .labelled_by(name.id)
            .on_hover_text("Whole curves drawn from the predicted force, each as likely; each drives motions of its own");
        let name = ui.label("Seed");
        seed_field(ui, &mut request.seed).labelled_by(name.id);
    });
    let answer = session.response.forecast.ok();
    if answer.is_some_and(|answer| !answer.is_predicted()) {
        if session.force.model.current.is_none() {
            let text = "There is no force model: the given force is shown.";
            notice_ui(ui, Severity::Warning, text);
            if ui.button("Open a force model…").clicked() {
                commands.push(Command::Ask(Purpose::OpenModel));
            }
        } else {
            let text = "The collision is not known here, so that its force cannot be predicted: the given force is shown.";
            notice_ui(ui, Severity::Warning, text);
        }
    }
}

/// Draws the choice of the density map, of the time window, and of the motions that are drawn.
fn shown_ui(ui: &mut Ui, view: &mut ResponseView, session: &Session, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.strong("Density").on_hover_text("Where the CG is likely to be");
        for (choice, label, hint) in [
            (DensityChoice::Moment, "now", "At the moment of the slider"),
            (DensityChoice::Window, "over time", "Mean over a window of time"),
            (DensityChoice::Hidden, "none", ""),
        ] {
            let radio = ui.radio_value(&mut view.density, choice, label);
            if !hint.is_empty() {
                radio.on_hover_text(hint);
            }
        }
    });
    if view.density == DensityChoice::Window {
        let end_s = session.response.forecast.ok().map_or(4.0, |answer| answer.end_s());
        ui.horizontal(|ui| {
            let [from_s, to_s] = &mut view.window_s;
            // The window ends with the motion, and does not end before it starts.
            let limits = [0.0..=to_s.min(end_s), from_s.min(end_s)..=end_s];
            for ((label, value), limits) in [("from", from_s), ("to", to_s)].into_iter().zip(limits)
            {
                let name = ui.label(label);
                let field = DragValue::new(value).range(limits).speed(0.02).suffix(" s");
                ui.add(field.max_decimals(2)).labelled_by(name.id);
            }
        });
    }
    ui.horizontal_wrapped(|ui| {
        ui.strong("Show");
        ui.checkbox(&mut view.drawn_motions, "drawn motions")
            .on_hover_text("Paths of the forecast's draws, 15 at most");
        ui.checkbox(&mut view.simulation, "4DOF model");
        ui.checkbox(&mut view.reference, "recorded motion");
        let follow = ui.checkbox(&mut view.follow, "follow");
        let hint = "Keep the view on the vehicle at the slider's moment";
        if follow.on_hover_text(hint).changed() && !view.follow {
            commands.push(Command::FitPlots);
        }
    });
}

/// Draws what the bands mean, or that they are those of a first, rough forecast, in one line.
fn bands_line_ui(ui: &mut Ui, is_coarse: bool, input: &MotionForecastFigure<'_>) {
    if is_coarse {
        notice_ui(ui, Severity::Warning, COARSE);
    } else {
        let cut = input.cut().map(|cut| format!(" Curves over time run {cut}."));
        ui.weak(format!("{ABOUT_BANDS}{}", cut.unwrap_or_default()));
    }
}

/// Draws the clock, the plan view with the density, and the bands of each quantity over time.
fn figures_ui(
    ui: &mut Ui,
    &ShownForecast { answer, is_coarse, .. }: &ShownForecast<'_>,
    session: &Session,
    variants: &[AnsweredVariant],
    view: &mut View,
    commands: &mut Vec<Command>,
) {
    let choice = &view.response;
    let PredictMotionAnswer { report, analysis, .. } = &answer.answer;
    let caveats = report
        .caveats
        .clone()
        .outdated_if(session.is_motion_awaited(choice.density) || are_others_awaited(variants));
    let time_s = session.playback.time_s.min(answer.end_s());
    let is_shown = |density: &&Arc<DensityAnswer>| {
        // That of an earlier forecast is not drawn over the paths of this one.
        let is_of_this = Arc::ptr_eq(&density.motion, answer);
        is_of_this
            && match choice.density {
                DensityChoice::Hidden => false,
                DensityChoice::Moment => (density.map.window_s[0] - time_s).abs() < STALE_S,
                DensityChoice::Window => true,
            }
    };
    let density = session.response.density.ok().filter(is_shown);
    let input = MotionForecastFigure {
        density: density.map(|density| density.map.as_ref()),
        draws: choice.drawn_motions,
        reference: analysis.reference.as_ref().filter(|_| choice.reference),
        simulation: motion_of(analysis).filter(|_| choice.simulation),
        ..bare_figure(answer, &caveats, time_s, view.units)
    };
    let others: Vec<_> = other_forecasts(variants)
        .map(|(name, answer)| {
            (name, bare_figure(answer, &answer.answer.report.caveats, time_s, view.units))
        })
        .collect();
    let playback = Playback { time_s, ..session.playback };
    clock_ui(ui, &playback, (answer.end_s(), &[]), &mut view.playback_speed, commands);
    let all = ui.available_height();
    let mut scene = forecast_scene_figure(&input);
    for (i, (name, other)) in others.iter().enumerate() {
        scene.overlay(name, i, &forecast_scene_figure(other));
    }
    let options = FigureOptions {
        view: choice.follow.then(|| forecast_surroundings(&input)),
        id: "forecast scene".to_owned(),
        height: Some((all * SCENE_SHARE - TITLE_HEIGHT).max(2.0 * MIN_PLOT_HEIGHT)),
        reset: session.fit_plots,
        ..FigureOptions::default()
    };
    figure_frame(ui, &scene.title, &scene, &options, commands);
    bands_line_ui(ui, is_coarse, &input);
    let n_columns = ((ui.available_width() / MIN_PLOT_WIDTH) as usize).clamp(1, MAX_COLUMNS);
    let n_rows = FORECAST_CHANNELS.len().div_ceil(n_columns) as f32;
    let height = (ui.available_height() / n_rows - TITLE_HEIGHT).max(MIN_PLOT_HEIGHT);
    ScrollArea::vertical().show(ui, |ui| {
        for channels in FORECAST_CHANNELS.chunks(n_columns) {
            ui.columns(n_columns, |columns| {
                for (ui, &channel) in columns.iter_mut().zip(channels) {
                    let mut figure = forecast_channel_figure(&input, channel);
                    for (i, (name, other)) in others.iter().enumerate() {
                        figure.overlay(name, i, &forecast_channel_figure(other, channel));
                    }
                    let options = FigureOptions {
                        id: format!("forecast of {}", channel.channel.label()),
                        link: Some(Id::unique("motion forecast")),
                        cursor_x: Some(time_s),
                        height: Some(height),
                        reset: session.fit_plots,
                        // The plots are too small for a legend; that of the plan view applies.
                        legend: false,
                        ..FigureOptions::default()
                    };
                    let heading = forecast_readout(&input, channel);
                    let response = figure_frame(ui, &heading, &figure, &options, commands);
                    if let Some(picked_s) = response.picked_x {
                        commands.push(Command::Playback(PlaybackCommand::SetTime(
                            picked_s.clamp(0.0, answer.end_s()),
                        )));
                    }
                }
            });
        }
    });
}

/// The figure of a forecast by itself.
fn bare_figure<'a>(
    answer: &'a MotionAnswer,
    caveats: &'a Caveats,
    time_s: f64,
    units: UnitSystem,
) -> MotionForecastFigure<'a> {
    MotionForecastFigure::new(&answer.answer, &answer.bands, caveats, time_s, units)
}

/// The motion by the 4DOF model, if there is one.
fn motion_of(analysis: &Analysis) -> Option<&TimeSeries> {
    analysis.simulation.as_ref().map(|motion| &motion.series)
}
