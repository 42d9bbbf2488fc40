//! The “Reconstructed scene” pane: what was found from above, the paths that go with it, and the car on
//! one of them.

use egui::{ComboBox, Ui};

use crate::app::command::Command;
use crate::app::looks::{Icon, icon_button};
use crate::app::panels::reconstruction::scene_edit::SceneEdit;
use crate::app::panels::reconstruction::{OUTDATED, notice_ui};
use crate::app::panels::scene::clock_ui;
use crate::app::panes::PaneContext;
use crate::app::reconstruction::{
    FollowedParticle, LiveParticles, PreparedReconstruction, ReconstructionCommand,
};
use crate::app::widgets::{MIN_PLOT_HEIGHT, TITLE_HEIGHT, badges_ui, figure_frame};
use crate::data::Severity;
use crate::figure::{FollowedPath, ReconstructionScene, reconstruction_scene_figure};
use crate::render::FigureOptions;
use crate::study::{EvidenceChoice, ReconstructReport, Trust};
use crate::units::{Quantity, UnitSystem, percent};

/// Draws the choice of what is followed, the time slider and the plan view.
pub fn reconstructed_scene_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let of = &session.reconstruction;
    let Some(preview) = &of.preview else {
        ui.weak("What was found and the paths that go with it, from above.");
        return;
    };
    let is_outdated = of.is_outdated(&project.reconstruction);
    // Paths that go with other evidence are not drawn over this.
    let (live, answer) = (of.live.as_ref(), of.answer().filter(|_| !is_outdated));
    let followed = of.followed_path().filter(|_| live.is_none() && !is_outdated);
    if let Some(live) = live {
        live_ui(ui, live, view.units);
    } else if let Some(answer) = answer {
        play_ui(ui, (answer, of.mode, of.followed), commands);
        let clock = (session.time_s, of.end_time_s());
        clock_ui(ui, clock, (session.playing, view.playback_speed), commands);
        badges_ui(ui, &answer.answer.report.badges);
    } else if is_outdated {
        notice_ui(ui, Severity::Warning, OUTDATED);
    }
    let trust = match answer.filter(|_| live.is_none()) {
        Some(answer) => trust_of(&answer.answer.report),
        None => Trust::default().outdated_if(live.is_some()),
    };
    let followed =
        followed.as_ref().map(|(name, path)| FollowedPath { name, path, time_s: session.time_s });
    let drawn = match (live, answer) {
        (Some(live), _) => live.paths.drawn.as_slice(),
        (None, Some(answer)) => answer.paths_of(of.mode).drawn.as_slice(),
        (None, None) => &[],
    };
    let scene =
        ReconstructionScene { evidence: &preview.evidence, cars: &preview.cars, drawn, followed };
    let mut figure = reconstruction_scene_figure(&scene, &trust, view.units);
    let mut evidence = preview.evidence.clone();
    let mut edit = SceneEdit::begin(ui, (&preview.cars, of.adds_to));
    figure.elements.extend(edit.handles(&evidence, figure.x.unit));
    let height = ui.available_height() - TITLE_HEIGHT - edit.hint_height();
    let height = height.max(MIN_PLOT_HEIGHT);
    let options = FigureOptions {
        id: "reconstructed scene".to_owned(),
        reset: session.fit_plots,
        view: edit.view(),
        pans: edit.pans(),
        height: Some(height),
        ..FigureOptions::default()
    };
    let shown = figure_frame(ui, (&figure.title, &figure), &options, commands);
    edit.apply(ui, (&shown, figure.x.unit), &mut evidence);
    ui.weak(edit.hint());
    if evidence != preview.evidence {
        project.reconstruction.evidence = Some(EvidenceChoice::Inline(Box::new(evidence)));
    }
}

/// What restricts a reconstruction.
pub(super) fn trust_of(report: &ReconstructReport) -> Trust {
    Trust::new(&report.badges, &report.assumptions)
}

/// Says that the particles are not the answer yet, and how far they are.
fn live_ui(ui: &mut Ui, live: &LiveParticles, units: UnitSystem) {
    let reached = match live.temperature {
        ..=0.0 => "before the evidence".to_owned(),
        1.0.. => "all of the evidence counts, still sampling".to_owned(),
        share => format!("the evidence counts {} so far", percent(share)),
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
    (answer, mode, followed): (&PreparedReconstruction, Option<usize>, FollowedParticle),
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
