//! The “Reconstructed scene” pane: what was found from above, the paths that go with it, and the car on
//! one of them.

use std::sync::Arc;

use egui::{ComboBox, Ui};
use impactlab_core::uncertainty::Caveats;

use crate::app::command::Command;
use crate::app::looks::{Icon, icon_button};
use crate::app::panels::reconstruction::scene_edit::SceneEdit;
use crate::app::panels::reconstruction::{OUTDATED, notice_ui};
use crate::app::panels::scene::{clock_ui, scene_heading_ui};
use crate::app::panes::PaneContext;
use crate::app::reconstruction::{
    CarsSource, EvidencePreview, FollowedParticle, LiveParticles, MarkKey, PreparedReconstruction,
    ReconstructedCars, ReconstructionCommand, ShownPaths,
};
use crate::app::scene::SceneSettings;
use crate::app::widgets::{MIN_PLOT_HEIGHT, TITLE_HEIGHT, figure_frame, restrictions_ui};
use impactlab_core::data::Severity;
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_document::figure::{
    Figure, FollowedPath, ReconstructionScene, reconstruction_scene_figure,
};
use impactlab_document::scene::{ReconstructionParts, Scene};
use impactlab_draw::FigureOptions;
use impactlab_draw::scene::{ScenePicture, SceneView, scene_view_ui};
use impactlab_reconstruct::evidence::Evidence;
use impactlab_study::EvidenceChoice;

/// Draws the choice of what is followed, the time slider, and the plan or the cars.
pub fn reconstructed_scene_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let mut cars = std::mem::take(&mut pane.session.reconstruction.cars);
    scene_ui(ui, pane, &mut cars);
    pane.session.reconstruction.cars = cars;
}

fn scene_ui(ui: &mut Ui, pane: &mut PaneContext<'_>, cars: &mut ReconstructedCars) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let of = &session.reconstruction;
    let Some(preview) = &of.preview else {
        ui.weak("What was found and the paths that go with it, from above.");
        return;
    };
    kind_ui(ui, &mut view.reconstruction.shows_cars);
    let is_outdated = of.is_outdated(project.reconstruct.as_ref());
    // Paths that go with other evidence are not drawn over this.
    let (live, answer) = (of.live.as_ref(), of.answer().filter(|_| !is_outdated));
    if let Some(live) = live {
        live_ui(ui, live, view.units);
    } else if let Some(answer) = answer {
        play_ui(ui, answer, of.mode, of.followed, commands);
        clock_ui(ui, &session.playback, (of.end_time_s(), &[]), &mut view.playback_speed, commands);
        restrictions_ui(ui, &answer.answer.report.caveats);
    } else if is_outdated {
        notice_ui(ui, Severity::Warning, OUTDATED);
    }
    let caveats = match answer.filter(|_| live.is_none()) {
        Some(answer) => answer.answer.report.caveats.clone(),
        None => Caveats::default().outdated_if(live.is_some()),
    };
    let followed = of.followed_path().filter(|_| live.is_none() && !is_outdated);
    let drawn = match (live, answer) {
        (Some(live), _) => live.paths.drawn.as_slice(),
        (None, Some(answer)) => answer.paths_of(of.mode).drawn.as_slice(),
        (None, None) => &[],
    };
    let others = if followed.is_some() { of.other_paths() } else { &[] };
    let marks = of.followed_marks().filter(|_| followed.is_some()).unwrap_or_default();
    let figure = {
        let followed = followed.as_ref();
        let followed = followed.map(|(name, path)| FollowedPath {
            name,
            path,
            time_s: session.playback.time_s,
        });
        let (evidence, cars) = (&preview.evidence, &preview.cars);
        let scene = ReconstructionScene { evidence, cars, drawn, followed, others, marks };
        reconstruction_scene_figure(&scene, &caveats, view.units)
    };
    if !view.reconstruction.shows_cars {
        let moved = plan_ui(ui, preview, of.adds_to, session.fit_plots, figure, commands);
        if let (Some(evidence), Some(request)) = (moved, &mut project.reconstruct) {
            request.evidence = EvidenceChoice::Inline(Box::new(evidence));
        }
        return;
    }
    let source = CarsSource {
        evidence: preview.evidence.clone(),
        paths: match (live, answer) {
            (Some(live), _) => ShownPaths::Live(live.temperature, live.speeds_m_s),
            (None, Some(_)) => ShownPaths::Answer(of.n_answers, of.mode),
            (None, None) => ShownPaths::None,
        },
        followed: followed.is_some().then_some(of.followed),
        units: view.units,
        caveats: caveats.clone(),
    };
    let parts = ReconstructionParts {
        evidence: &preview.evidence,
        cars: &preview.cars,
        drawn,
        followed: followed.as_ref().map(|(name, path)| (name.as_str(), *path)),
        others,
        marks,
        units: view.units,
        caveats: &caveats,
    };
    let ground = session.ground.shown().map(|loaded| &loaded.ground);
    let scene = cars.scene(source, &parts, ground);
    if session.fit_plots {
        cars.view.fit();
    }
    let settings = &mut view.reconstruction.scene;
    cars_ui(ui, &scene, session.playback.time_s, figure, &mut cars.view, settings, commands);
}

/// Draws the choice between the plan and the cars.
fn kind_ui(ui: &mut Ui, shows_cars: &mut bool) {
    ui.horizontal(|ui| {
        for (kind, name, hint) in [
            (false, "Plan", "Evidence is placed here: drag a place of rest, click along a mark"),
            (true, "Cars", "The cars as bodies, from above or in perspective"),
        ] {
            ui.selectable_value(shows_cars, kind, name).on_hover_text(hint);
        }
    });
}

/// Draws the plan; returns the evidence if it was changed in it.
fn plan_ui(
    ui: &mut Ui,
    preview: &EvidencePreview,
    adds_to: Option<MarkKey>,
    resets: bool,
    mut figure: Figure,
    commands: &mut Vec<Command>,
) -> Option<Evidence> {
    let mut evidence = preview.evidence.clone();
    let mut edit = SceneEdit::begin(ui, &preview.cars, adds_to);
    figure.elements.extend(edit.handles(&evidence, figure.x.unit));
    let height = ui.available_height() - TITLE_HEIGHT - edit.hint_height();
    let height = height.max(MIN_PLOT_HEIGHT);
    let options = FigureOptions {
        id: "reconstructed scene".to_owned(),
        reset: resets,
        view: edit.view(),
        pans: edit.pans(),
        height: Some(height),
        ..FigureOptions::default()
    };
    let shown = figure_frame(ui, &figure.title, &figure, &options, commands);
    edit.apply(ui, &shown, figure.x.unit, &mut evidence);
    ui.weak(edit.hint());
    (evidence != preview.evidence).then_some(evidence)
}

/// Draws the cars at a time.
fn cars_ui(
    ui: &mut Ui,
    scene: &Arc<Scene>,
    time_s: f64,
    figure: Figure,
    shown: &mut SceneView,
    settings: &mut SceneSettings,
    commands: &mut Vec<Command>,
) {
    // The motion ends where the car is at rest.
    let time_s = time_s.min(scene.end_s);
    let placed = shown.camera();
    let exported = |settings: &SceneSettings| {
        let picture = ScenePicture {
            scene: Arc::clone(scene),
            courses: Vec::new(),
            time_s,
            camera: placed.unwrap_or(settings.camera),
            is_placed: placed.is_some(),
            distance_m: None,
            follow: settings.follow,
        };
        (picture, figure.clone())
    };
    scene_heading_ui(ui, scene, time_s, settings, None, exported, commands);
    let SceneSettings { camera, follow, .. } = settings;
    let height = ui.available_height();
    scene_view_ui(ui, scene, time_s, shown, camera, *follow, height);
}

/// Says that the particles are not the answer yet, and how far they are.
fn live_ui(ui: &mut Ui, live: &LiveParticles, units: UnitSystem) {
    let reached = match live.temperature {
        ..=0.0 => "before the evidence".to_owned(),
        1.0.. => "still sampling".to_owned(),
        share => format!("still sampling, evidence at {} of its weight", percent(share)),
    };
    let speeds = live.speeds_m_s.map(|ends| {
        let unit = Quantity::Speed.display_unit(units);
        let [low, high] = ends.map(|end| unit.from_si(end));
        format!("; struck car {low:.0} to {high:.0} {}", unit.symbol)
    });
    let text = format!("Not the answer yet: {reached}{}", speeds.unwrap_or_default());
    notice_ui(ui, Severity::Info, &text);
}

/// Draws the choice of the course of events, and what is played.
fn play_ui(
    ui: &mut Ui,
    answer: &PreparedReconstruction,
    mode: Option<usize>,
    followed: FollowedParticle,
    commands: &mut Vec<Command>,
) {
    let mut command = |command| commands.push(Command::Reconstruct(command));
    ui.horizontal_wrapped(|ui| {
        let modes = &answer.answer.report.modes;
        if modes.len() > 1 {
            let all = "all courses of events".to_owned();
            let text = |idx: usize| {
                modes.get(idx).map(|of| format!("{} {}", percent(of.probability), of.name))
            };
            let shown = mode.and_then(text).unwrap_or_else(|| all.clone());
            let list = ComboBox::from_id_salt("course of events").selected_text(shown).truncate();
            let list = list.width(ui.available_width().min(260.0));
            list.show_ui(ui, |ui| {
                let choices = std::iter::once(None).chain((0..modes.len()).map(Some));
                for choice in choices {
                    let label = choice.and_then(text).unwrap_or_else(|| all.clone());
                    if ui.selectable_label(choice == mode, label).clicked() {
                        command(ReconstructionCommand::ShowMode(choice));
                    }
                }
            });
        }
        let median = ui.add(icon_button(Icon::Play, "Play the median"));
        if median.on_hover_text("A particle whose speed is the median").clicked() {
            command(ReconstructionCommand::Play(FollowedParticle::Median));
        }
        let n_drawn = answer.paths_of(mode).drawn.len();
        let next = match followed {
            FollowedParticle::Median => 0,
            FollowedParticle::Draw(idx) => (idx + 1) % n_drawn.max(1),
        };
        let button = icon_button(Icon::Shuffle, "Play a draw");
        let draw = ui.add_enabled(n_drawn > 0, button);
        if draw.on_hover_text("Another of the paths that go with the evidence").clicked() {
            command(ReconstructionCommand::Play(FollowedParticle::Draw(next)));
        }
        if let FollowedParticle::Draw(idx) = followed {
            ui.weak(format!("draw {} of {n_drawn}", idx + 1));
        }
    });
}
