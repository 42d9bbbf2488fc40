//! The “Scene” pane: the cars at a chosen time, from above or in perspective, and the clock with which
//! the time is chosen.

use std::sync::Arc;

use egui::{Align, Layout, RichText, Slider, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::export::{SceneExport, SceneFormat};
use crate::app::film::FilmCommand;
use crate::app::ground::GroundSession;
use crate::app::looks::{Icon, icon, icon_button};
use crate::app::measure::Measuring;
use crate::app::motion_plots::recorded;
use crate::app::output::Output;
use crate::app::panels::analysis_or_hint;
use crate::app::panels::scene_camera::camera_menu_ui;
use crate::app::panels::scene_ground::{
    ground_menu_ui, measure_bar_ui, measure_menu_ui, measured_ui,
};
use crate::app::panes::PaneContext;
use crate::app::playback::{Playback, PlaybackCommand};
use crate::app::recording::overlaid;
use crate::app::scene::{SceneSession, SceneSettings, SceneSource};
use crate::app::state::{Session, State};
use crate::app::variants::{AnsweredVariant, are_others_awaited, other_simulations};
use crate::app::widgets::{OUTDATED, restrictions_ui, severity_color};
use impactlab_core::data::Severity;
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};
use impactlab_document::figure::{Figure, analysis_scene_figure, recording_path};
use impactlab_document::scene::{FilmTiming, ForecastScene, Scene};
use impactlab_draw::scene::{CameraKey, Follow, ScenePicture, ViewKind, scene_view_ui};
use impactlab_study::RestState;

/// Seconds of the motion that can be played in a second.
const SPEEDS: [f64; 5] = [0.05, 0.1, 0.25, 0.5, 1.0];

/// Height below the tools from which badges stand above the picture, points.
const ROOMY: f32 = 240.0;

/// What can be done with the mouse in each view.
const HINTS: [&str; 2] = [
    "Drag moves the scene, the wheel zooms, a double click shows all of it",
    "Drag turns the scene, drag with the right button or Shift moves it, the wheel zooms, a double click \
     shows all of it",
];

/// Draws the time slider and the scene.
pub fn scene_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    if analysis_or_hint(ui, pane.session, pane.project, pane.commands).is_none() {
        return bare_ground_ui(ui, pane);
    }
    let Some(answer) = pane.session.analysis.ok().cloned() else { return };
    let (analysis, report) = (&answer.analysis, &answer.report);
    let PaneContext { project, view, session, variants, commands, .. } = pane;
    let series = analysis.simulation.as_ref().map(|motion| &motion.series);
    let Some(series) = series.or(analysis.reference.as_ref()) else {
        ui.label("There is no motion to show: nothing was recorded, and nothing is simulated. Choose another case, or set up a scenario.");
        return;
    };
    let end_s = series.time_s().last().copied().unwrap_or(0.0);
    let span = (end_s, &*analysis.contacts_s(end_s));
    clock_ui(ui, &session.playback, span, &mut view.playback_speed, commands);
    let caveats = session.simulation_caveats(report).outdated_if(are_others_awaited(variants));
    let source = SceneSource {
        forecast: State::shown_forecast(view, session),
        answer: Arc::clone(&answer),
        others: SceneSource::others(variants),
        recording: recorded(project.beside.recording.as_ref(), &session.sources),
        ground: session.ground.shown().map(|loaded| Arc::clone(&loaded.ground)),
        caveats: caveats.clone(),
        units: view.units,
    };
    let keys = &mut project.beside.camera_keys;
    choices_ui(ui, keys, (&mut view.scene, view.units), session, commands);
    let scene = session.scene.scene(source, &session.sources);
    let time_s = session.playback.time_s;
    let numbers = || {
        let figure = analysis_scene_figure(analysis, &caveats, time_s, view.units);
        let mut figure = with_others(figure, variants, time_s, view.units);
        if let Some((name, series, _)) =
            overlaid(project.beside.recording.as_ref(), &session.sources)
        {
            figure.elements.extend(recording_path(&name, series, view.units));
        }
        figure
    };
    let (placed, measured) = (session.scene.view.camera(), session.scene.measuring.clone());
    let seen_aspect = session.scene.view.aspect();
    scene_heading_ui(
        ui,
        &scene,
        time_s,
        (&mut view.scene, &project.beside.camera_keys),
        Some((&session.ground, &mut session.scene.measuring)),
        |settings| {
            let picture = ScenePicture {
                scene: measured.added_to(&scene),
                courses: Vec::new(),
                time_s,
                camera: placed.unwrap_or(settings.camera),
                is_placed: placed.is_some(),
                seen_aspect,
                distance_m: None,
                follow: settings.follow,
            };
            (picture, numbers())
        },
        commands,
    );
    // Below the tools, which therefore stay where they are when badges come and go.
    // In a low pane the picture has the room; it has a line of what restricts it itself.
    if ui.available_height() >= ROOMY {
        restrictions_ui(ui, &report.caveats, view.units);
        rest_ui(ui, report.rest.as_ref(), view.units);
    }
    if session.fit_plots {
        session.scene.view.fit();
    }
    session.scene.place_by_keys(&project.beside.camera_keys, &mut view.scene, (&scene, time_s));
    picture_ui(ui, (&scene, time_s), &mut session.scene, &mut view.scene, commands);
}

/// Draws the ground by itself before anything is chosen that moves on it.
fn bare_ground_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let loaded = session.ground.shown().filter(|_| project.subject().is_none()).cloned();
    let Some(loaded) = loaded else { return };
    let scene = session.scene.of_ground(&loaded, view.units);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ground_menu_ui(ui, &session.ground, &scene, commands);
            measure_menu_ui(ui, &mut session.scene.measuring, loaded.ground.has_picture());
            view_ui(ui, &scene, &mut view.scene);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(egui::Label::new(RichText::new(&scene.title).strong()).truncate());
            });
        });
    });
    picture_ui(ui, (&scene, 0.0), &mut session.scene, &mut view.scene, commands);
}

/// Draws the picture at a time, with what is measured in it.
fn picture_ui(
    ui: &mut Ui,
    (scene, time_s): (&Arc<Scene>, f64),
    session: &mut SceneSession,
    settings: &mut SceneSettings,
    commands: &mut Vec<Command>,
) {
    measure_bar_ui(ui, &mut session.measuring, scene.units, commands);
    session.view.takes_clicks = session.measuring.measure.is_some();
    let SceneSettings { camera, follow, .. } = settings;
    let height = ui.available_height();
    let response = scene_view_ui(ui, scene, time_s, &mut session.view, camera, *follow, height);
    let SceneSession { view: drawn, measuring, .. } = session;
    measured_ui(ui, &response, drawn, measuring, scene.units);
}

/// Draws when and where the vehicle comes to rest, if it does.
fn rest_ui(ui: &mut Ui, rest: Option<&RestState>, units: UnitSystem) {
    let Some(rest) = rest else { return };
    let format = NumberFormat::english(units);
    let time = format.rough(Quantity::Time, rest.time_s);
    let [distance, x, y] =
        [rest.distance_m, rest.x_m, rest.y_m].map(|m| format.rough(Quantity::Length, m));
    ui.label(format!("At rest after {time} and {distance}, at X {x}, Y {y}"));
}

/// Draws the choice whether the forecast is shown, and the menu of the keys of the camera.
fn choices_ui(
    ui: &mut Ui,
    keys: &mut Vec<CameraKey>,
    (settings, units): (&mut SceneSettings, UnitSystem),
    session: &mut Session,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        forecast_choice_ui(ui, &mut settings.shows_forecast, session);
        let seen = (session.scene.view.camera(), session.playback.time_s);
        if let Some(camera) = camera_menu_ui(ui, keys, settings, seen, units, commands) {
            session.scene.view.place_at(camera);
        }
    });
}

/// Draws the choice whether the forecast is shown.
fn forecast_choice_ui(ui: &mut Ui, shows_forecast: &mut bool, session: &Session) {
    let forecast = &session.response.forecast;
    let is_there = forecast.ok().is_some() || forecast.is_waiting();
    ui.add_enabled_ui(is_there || *shows_forecast, |ui| {
        let choice = ui.checkbox(shows_forecast, "Forecast");
        choice
            .on_hover_text(format!(
                "{} draws of the motion forecast as ghosts, its central path, and where the CG is at its \
                 end: density, regions of 50 and 90 %",
                ForecastScene::N_GHOSTS
            ))
            .on_disabled_hover_text("There is no forecast of this motion");
    });
}

/// Draws what the scene shows, the choice of the view and of the car that is followed, and the menu that
/// exports it.
///
/// - `keys`: between which the camera moves in a film;
/// - `on_ground`: the ground and what is measured on it, where both can be changed;
/// - `exported`: picture and numbers, which are made only when they are wanted.
pub fn scene_heading_ui(
    ui: &mut Ui,
    scene: &Scene,
    time_s: f64,
    (settings, keys): (&mut SceneSettings, &[CameraKey]),
    on_ground: Option<(&GroundSession, &mut Measuring)>,
    exported: impl Fn(&SceneSettings) -> (ScenePicture, Figure),
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_enabled_ui(!scene.caveats.is_outdated(), |ui| {
                ui.menu_button((icon(Icon::Download), "Export"), |ui| {
                    export_menu_ui(ui, || exported(settings), keys, commands);
                })
                .response
                .on_hover_text("Save or copy this scene")
                .on_disabled_hover_text(OUTDATED);
            });
            if let Some((ground, measuring)) = on_ground {
                ground_menu_ui(ui, ground, scene, commands);
                let has_photo = scene.ground.as_ref().is_some_and(|ground| ground.has_picture());
                measure_menu_ui(ui, measuring, has_photo);
            }
            view_ui(ui, scene, settings);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let title = scene.heading(settings.camera.kind.phrase(), time_s);
                ui.add(egui::Label::new(RichText::new(title).strong()).truncate());
            });
        });
    });
}

/// Draws the choice of the view and of the car that stays in the middle, from right to left.
fn view_ui(ui: &mut Ui, scene: &Scene, settings: &mut SceneSettings) {
    let cars = [
        (Follow::Nothing, "no car", true),
        (Follow::Struck, "struck car", scene.struck().is_some()),
        (Follow::Striking, "striking car", scene.striking().is_some()),
    ];
    let chosen = cars.iter().find(|(follow, ..)| *follow == settings.follow);
    let list = egui::ComboBox::from_id_salt("followed car").width(96.0);
    let text = chosen.map_or("", |(_, name, _)| *name);
    let list = list.selected_text(format!("follow {text}")).show_ui(ui, |ui| {
        for (follow, name, is_there) in cars {
            ui.add_enabled_ui(is_there, |ui| {
                ui.selectable_value(&mut settings.follow, follow, name);
            });
        }
    });
    list.response.on_hover_text("The car that stays in the middle");
    let kind = &mut settings.camera.kind;
    let views = [(ViewKind::Perspective, "Perspective"), (ViewKind::Above, "From above")];
    for ((view, name), hint) in views.into_iter().zip(HINTS.into_iter().rev()) {
        ui.selectable_value(kind, view, name).on_hover_text(hint);
    }
}

fn export_menu_ui(
    ui: &mut Ui,
    exported: impl Fn() -> (ScenePicture, Figure),
    keys: &[CameraKey],
    commands: &mut Vec<Command>,
) {
    if ui.add(icon_button(Icon::Image, "Save picture (PNG)…")).clicked() {
        commands.push(Command::Ask(Purpose::Save(Output::ScenePicture(Box::new(exported().0)))));
    }
    if ui.add(icon_button(Icon::Film, "Save film (MP4)…")).clicked() {
        let picture = Box::new(exported().0);
        commands.push(Command::Film(FilmCommand::Ask(picture, keys.to_vec())));
    }
    for (format, icon, label) in [
        (SceneFormat::Dxf, Icon::PencilRuler, "Save drawing (DXF)…"),
        (SceneFormat::Glb, Icon::Box, "Save 3D scene (glTF)…"),
    ] {
        if ui.add(icon_button(icon, label)).clicked() {
            let ScenePicture { scene, time_s, .. } = exported().0;
            let outlines_s = vec![FilmTiming::from_scene(&scene).from_s, time_s, scene.end_s];
            let export = SceneExport { scene, format, outlines_s };
            commands.push(Command::Ask(Purpose::Save(Output::Exchange(Box::new(export)))));
        }
    }
    if ui.add(icon_button(Icon::Table2, "Save numbers (CSV)…")).clicked() {
        commands.push(Command::Ask(Purpose::Save(Output::Numbers(Box::new(exported().1)))));
    }
    if ui.add(icon_button(Icon::Copy, "Copy numbers")).clicked() {
        commands.push(Command::CopyNumbers(Box::new(exported().1)));
    }
}

/// Draws the button that plays or pauses the motion, and the slider of the time.
///
/// - `end_s`: the end of the motion and of the slider, s; the slider starts at 0;
/// - `contacts_s`: when the vehicles are in contact, marked below the slider.
/// - `speed`: seconds of the motion that are played in a second, which the user can change.
pub fn clock_ui(
    ui: &mut Ui,
    &Playback { time_s, is_playing }: &Playback,
    (end_s, contacts_s): (f64, &[[f64; 2]]),
    speed: &mut f64,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        let (of, label) = match is_playing {
            true => (Icon::Pause, "Pause"),
            false => (Icon::Play, "Play"),
        };
        if ui.add(icon_button(of, label)).on_hover_text("Space").clicked() {
            commands.push(Command::Playback(PlaybackCommand::Toggle));
        }
        let text = |speed: f64| format!("× {speed}");
        let list = egui::ComboBox::from_id_salt("playback speed").width(58.0);
        let list = list.selected_text(text(*speed)).show_ui(ui, |ui| {
            for other in SPEEDS {
                ui.selectable_value(speed, other, text(other));
            }
        });
        list.response.on_hover_text("Speed of the playback");
        let name = ui.label("Time");
        let mut time_s = time_s;
        ui.spacing_mut().slider_width = (ui.available_width() - 90.0).max(80.0);
        let slider = Slider::new(&mut time_s, 0.0..=end_s).suffix(" s").fixed_decimals(3);
        let slider_width = ui.spacing().slider_width;
        let shown = ui.add(slider).labelled_by(name.id);
        mark_contacts(ui, &shown, slider_width, end_s, contacts_s);
        if shown.changed() {
            commands.push(Command::Playback(PlaybackCommand::SetTime(time_s)));
        }
    });
}

/// A figure with the simulations of other variants over it.
fn with_others(
    mut figure: Figure,
    variants: &[AnsweredVariant],
    time_s: f64,
    units: UnitSystem,
) -> Figure {
    for (i, (name, other)) in other_simulations(variants).enumerate() {
        let (analysis, caveats) = (&other.analysis, &other.report.caveats);
        let other = analysis_scene_figure(analysis, caveats, time_s, units);
        figure.overlay(name, i, &other);
    }
    figure
}

/// Marks below the rail of a slider when the vehicles are in contact.
fn mark_contacts(
    ui: &Ui,
    slider: &egui::Response,
    width: f32,
    end_s: f64,
    contacts_s: &[[f64; 2]],
) {
    if contacts_s.is_empty() || end_s <= 0.0 {
        return;
    }
    // The handle keeps within the rail.
    let inset = slider.rect.height() / 2.5;
    let x = |time_s: f64| {
        let share = (time_s / end_s).clamp(0.0, 1.0) as f32;
        slider.rect.left() + inset + share * (width - 2.0 * inset).max(0.0)
    };
    let color = severity_color(ui, Severity::Warning);
    let y = slider.rect.bottom() - 1.0;
    for [from_s, to_s] in contacts_s {
        let (from, to) = (x(*from_s), x(*to_s));
        let ends = [egui::pos2(from, y), egui::pos2(to.max(from + 2.0), y)];
        ui.painter().line_segment(ends, egui::Stroke::new(3.0, color));
    }
    slider.clone().on_hover_text("Marked: the vehicles are in contact");
}
