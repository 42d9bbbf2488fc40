//! The “Reconstructed scene” pane: what was found from above, the paths that go with it, and the car on
//! one of them.

use std::sync::Arc;

use egui::{Checkbox, ComboBox, Ui, vec2};
use impactlab_core::uncertainty::Caveats;

use crate::app::command::Command;
use crate::app::looks::{Icon, icon_button};
use crate::app::panels::reconstruction::OUTDATED;
use crate::app::panels::reconstruction::backdrop::{backdrop, lines_below};
use crate::app::panels::reconstruction::scene_edit::SceneEdit;
use crate::app::panels::scene::{clock_ui, scene_heading_ui};
use crate::app::panels::scene_camera::camera_menu_ui;
use crate::app::panes::PaneContext;
use crate::app::reconstruction::{
    BuiltCars, CarsSource, EvidencePreview, FollowedParticle, LiveParticles, MarkKey,
    PreparedReconstruction, ReconstructedCars, ReconstructionCommand, ReconstructionSession,
    ReconstructionView, ShownPaths,
};
use crate::app::scene::SceneSettings;
use crate::app::widgets::{
    MIN_PLOT_HEIGHT, TITLE_HEIGHT, figure_frame, notice_ui, restrictions_ui,
};
use impactlab_core::data::Severity;
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_core::vehicle::{Path, TireMark};
use impactlab_document::figure::{
    Figure, FollowedPath, ReconstructionScene, reconstruction_scene_figure,
};
use impactlab_document::scene::{ReconstructionParts, SceneGround};
use impactlab_draw::FigureOptions;
use impactlab_draw::scene::{
    CameraKey, ScenePicture, courses_have_room, courses_view_ui, scene_view_ui,
};
use impactlab_reconstruct::evidence::Evidence;
use impactlab_study::{EvidenceChoice, NamedPath, ReconstructRequest, ReconstructedPaths};

/// Height of what stands above the scenes of courses of events, points.
const ABOVE_SCENES: f32 = 155.0;

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
        ui.weak("What was found is drawn here from above, and after a run the paths that go with it. Begin in the Evidence pane.");
        return;
    };
    let shown = Shown::new(of, project.reconstruct.as_ref());
    let Shown { live, answer, drawn, others, marks, ref caveats, .. } = shown;
    let room = ui.available_size() - vec2(0.0, ABOVE_SCENES);
    let n_courses = shown.courses.len();
    let has_room = (n_courses > 0).then(|| courses_have_room(room, n_courses));
    kind_ui(ui, &mut view.reconstruction, has_room);
    if let Some(live) = live {
        live_ui(ui, live, view.units);
    } else if let Some(answer) = answer {
        play_ui(ui, answer, of.mode, of.followed, commands);
        clock_ui(ui, &session.playback, (of.end_time_s(), &[]), &mut view.playback_speed, commands);
        restrictions_ui(ui, &answer.answer.report.caveats, view.units);
    } else if shown.is_outdated {
        notice_ui(ui, Severity::Warning, OUTDATED);
    }
    let followed = shown.followed.as_ref();
    let (units, time_s) = (view.units, session.playback.time_s);
    let figure = || {
        let followed = followed.map(|(name, path)| FollowedPath { name, path, time_s });
        let (evidence, cars) = (&preview.evidence, &preview.cars);
        let scene = ReconstructionScene { evidence, cars, drawn, followed, others, marks };
        reconstruction_scene_figure(&scene, caveats, units)
    };
    let ground = session.ground.shown().map(|loaded| &loaded.ground);
    if !view.reconstruction.shows_cars {
        let (adds_to, resets) = (of.adds_to, session.fit_plots);
        let moved = plan_ui(ui, preview, adds_to, resets, figure(), ground, commands);
        if let (Some(evidence), Some(request)) = (moved, &mut project.reconstruct) {
            request.evidence = EvidenceChoice::Inline(Box::new(evidence));
        }
        return;
    }
    let is_beside = has_room == Some(true) && view.reconstruction.courses_side_by_side;
    let courses = shown.course_parts(is_beside, view.units);
    let source = CarsSource {
        evidence: preview.evidence.clone(),
        paths: shown.paths(of),
        followed: followed.is_some().then_some(of.followed),
        has_courses: !courses.is_empty(),
        units: view.units,
        caveats: caveats.clone(),
    };
    let parts = ReconstructionParts {
        evidence: &preview.evidence,
        cars: &preview.cars,
        drawn,
        followed: followed.map(|(name, path)| (name.as_str(), *path)),
        others,
        marks,
        units: view.units,
        caveats,
    };
    let built = cars.scene(source, &parts, &courses, ground);
    if session.fit_plots {
        cars.fit();
    }
    let keys = &mut project.beside.reconstruction_camera_keys;
    let seen = (&mut view.reconstruction.scene, keys);
    cars_ui(ui, &built, time_s, figure, cars, seen, commands);
}

/// What is shown of a reconstruction. Paths that go with other evidence are not.
struct Shown<'a> {
    is_outdated: bool,
    live: Option<&'a LiveParticles>,
    answer: Option<&'a PreparedReconstruction>,
    /// Courses of events that can stand side by side.
    courses: Vec<(String, &'a ReconstructedPaths)>,
    followed: Option<(String, &'a Path)>,
    drawn: &'a [Path],
    others: &'a [NamedPath],
    marks: &'a [TireMark],
    caveats: Caveats,
}

impl<'a> Shown<'a> {
    fn new(of: &'a ReconstructionSession, request: Option<&ReconstructRequest>) -> Self {
        let is_outdated = of.is_outdated(request);
        let live = of.live.as_ref();
        let answer = of.answer().filter(|_| !is_outdated);
        let finished = answer.filter(|_| live.is_none());
        let followed = finished.and_then(|_| of.followed_path());
        let is_followed = followed.is_some();
        Self {
            is_outdated,
            live,
            answer,
            courses: finished.map_or_else(Vec::new, |_| of.courses()),
            drawn: match (live, answer) {
                (Some(live), _) => live.paths.drawn.as_slice(),
                (None, Some(answer)) => answer.paths_of(of.mode).drawn.as_slice(),
                (None, None) => &[],
            },
            others: if is_followed { of.other_paths() } else { &[] },
            marks: of.followed_marks().filter(|_| is_followed).unwrap_or_default(),
            caveats: match finished {
                Some(answer) => answer.answer.report.caveats.clone(),
                None => Caveats::default().outdated_if(live.is_some()),
            },
            followed,
        }
    }

    /// The paths that are drawn, told apart from others.
    fn paths(&self, of: &ReconstructionSession) -> ShownPaths {
        match (self.live, self.answer) {
            (Some(live), _) => ShownPaths::Live(live.temperature, live.speeds_m_s),
            (None, Some(_)) => ShownPaths::Answer(of.n_answers, of.mode),
            (None, None) => ShownPaths::None,
        }
    }

    /// What the scene of each course of events shows, with its title; none if they share one scene.
    fn course_parts(
        &self,
        is_beside: bool,
        units: UnitSystem,
    ) -> Vec<(String, ReconstructionParts<'_>)> {
        let Some(answer) = self.answer.filter(|_| is_beside) else { return Vec::new() };
        let parts = |(title, paths): &(String, &'a ReconstructedPaths)| {
            let parts = ReconstructionParts::new(&answer.answer, paths, units, &self.caveats);
            (title.clone(), parts)
        };
        self.courses.iter().map(parts).collect()
    }
}

/// Draws the choice between the plan and the cars, and whether courses of events stand side by side.
///
/// - `has_room`: whether there is room for that; `None` if there is one scene only.
fn kind_ui(ui: &mut Ui, shown: &mut ReconstructionView, has_room: Option<bool>) {
    ui.horizontal(|ui| {
        for (kind, name, hint) in [
            (false, "Plan", "Evidence is placed here: drag a place of rest, click along a mark"),
            (true, "Cars", "The cars as bodies, from above or in perspective"),
        ] {
            ui.selectable_value(&mut shown.shows_cars, kind, name).on_hover_text(hint);
        }
        if let Some(has_room) = has_room.filter(|_| shown.shows_cars) {
            let choice = Checkbox::new(&mut shown.courses_side_by_side, "Courses side by side");
            ui.add_enabled(has_room, choice)
                .on_hover_text(
                    "Each course of events in a scene of its own, with its probability and its \
                     standard error, under one camera and one clock",
                )
                .on_disabled_hover_text("The pane is too small for so many scenes");
        }
    });
}

/// Draws the plan over picture and lines of the ground; returns the evidence if it was changed in it.
fn plan_ui(
    ui: &mut Ui,
    preview: &EvidencePreview,
    adds_to: Option<MarkKey>,
    resets: bool,
    mut figure: Figure,
    ground: Option<&Arc<SceneGround>>,
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
        backdrop: ground.and_then(|ground| backdrop(ui, ground, &figure)),
        lines_below: ground.map(|ground| lines_below(ui, ground, &figure)).unwrap_or_default(),
        ..FigureOptions::default()
    };
    let shown = figure_frame(ui, &figure.title, &figure, &options, commands);
    edit.apply(ui, &shown, figure.x.unit, &mut evidence);
    ui.weak(edit.hint());
    (evidence != preview.evidence).then_some(evidence)
}

/// Draws the cars at a time: in one scene, or each course of events in its own.
///
/// - `figure`: the same as a plan, for its numbers;
/// - `keys`: between which the camera moves.
fn cars_ui(
    ui: &mut Ui,
    BuiltCars { scene, courses }: &BuiltCars,
    time_s: f64,
    figure: impl Fn() -> Figure,
    cars: &mut ReconstructedCars,
    (settings, keys): (&mut SceneSettings, &mut Vec<CameraKey>),
    commands: &mut Vec<Command>,
) {
    // The motion ends where the cars are at rest.
    let time_s = time_s.min(scene.end_s);
    let seen = match courses.as_slice() {
        [] => cars.view.camera(),
        _ => cars.courses_view.camera(),
    };
    let wanted = camera_menu_ui(ui, keys, settings, (seen, time_s), scene.units, commands);
    let keyed = cars.keyed.at(keys, settings, (scene, time_s));
    match (wanted.or(keyed), courses.as_slice()) {
        (Some(camera), []) => cars.view.place_at(camera),
        (Some(camera), _) => cars.courses_view.place_at(camera),
        (None, _) => {}
    }
    let (placed, seen_aspect) = match courses.as_slice() {
        [] => (cars.view.camera(), cars.view.aspect()),
        _ => (cars.courses_view.moved_camera(), None),
    };
    let pictured = |settings: &SceneSettings| ScenePicture {
        scene: Arc::clone(scene),
        courses: courses.clone(),
        time_s,
        camera: placed.unwrap_or(settings.camera),
        is_placed: placed.is_some(),
        seen_aspect,
        distance_m: None,
        follow: settings.follow,
    };
    let exported = |settings: &SceneSettings| (pictured(settings), figure());
    let filmed = (&mut *settings, keys.as_slice());
    scene_heading_ui(ui, scene, time_s, filmed, None, exported, commands);
    let picture = pictured(settings);
    let SceneSettings { camera, follow, .. } = settings;
    let height = ui.available_height();
    if courses.is_empty() {
        scene_view_ui(ui, scene, time_s, &mut cars.view, camera, *follow, height);
    } else {
        courses_view_ui(ui, &picture, &mut cars.courses_view, camera, height);
    }
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
        let car = if live.is_of_single_car { "car" } else { "struck car" };
        format!("; {car} {low:.0} to {high:.0} {}", unit.symbol)
    });
    let text = format!("Not the answer yet: {reached}{}", speeds.unwrap_or_default());
    notice_ui(ui, Severity::Info, text);
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
            let text = |idx: usize| modes.get(idx).map(ReconstructedPaths::course_title);
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
