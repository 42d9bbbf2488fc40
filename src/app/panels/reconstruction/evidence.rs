//! The “Evidence” pane: what was found, what is taken to be likely beforehand, and the run.

use egui::{ScrollArea, TextEdit, TextStyle, Ui, vec2};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::ground::{GroundCommand, REMOVE_SITE};
use crate::app::looks::{self, Icon, icon_button};
use crate::app::output::Output;
use crate::app::panels::reconstruction::OUTDATED;
use crate::app::panels::reconstruction::cards::{SheetChoices, cards_ui};
use crate::app::panels::reconstruction::priors::{prior_ranges_ui, priors_ui};
use crate::app::panes::{Pane, PaneContext};
use crate::app::reconstruction::{EvidencePreview, ReconstructionCommand, ReconstructionSession};
use crate::app::widgets::{count_field, empty_ui, notice_ui, run_progress_ui, seed_field};
use impactlab_core::data::Severity;
use impactlab_core::ranges::RECONSTRUCTION_PARTICLES;
use impactlab_reconstruct::evidence::Evidence;
use impactlab_study::{EvidenceChoice, ReconstructRequest, VehicleChoice};

/// Lines of text for which there is room below the button that starts a run.
const STATUS_LINES: f32 = 3.0;

/// Draws the run, the cards of the evidence, and the ranges before and after it.
pub fn evidence_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let is_own =
        |of: &&VehicleChoice| matches!(of, VehicleChoice::File(_) | VehicleChoice::Sheet(_));
    let simulate = &project.simulate;
    let own: Vec<VehicleChoice> =
        [&simulate.vehicle, &simulate.striking].into_iter().filter(is_own).cloned().collect();
    let (request, session) = (&mut project.reconstruct, &session.reconstruction);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let (Some(preview), Some(request)) = (&session.preview, &mut *request) else {
            return start_ui(ui, request.as_ref(), session, commands);
        };
        let mut evidence = preview.evidence.clone();
        case_ui(ui, &mut evidence, request, commands);
        run_ui(ui, request, session, preview, commands);
        ui.separator();
        let chosen = [&mut request.vehicle, &mut request.striking];
        let sheets = SheetChoices { chosen, own: &own };
        let command = cards_ui(ui, &mut evidence, sheets, session.adds_to, view.units);
        commands.extend(command.map(Command::Reconstruct));
        ui.add_space(looks::PART);
        if !evidence.is_single_car() {
            prior_ranges_ui(ui, &mut evidence.prior, view.units);
        }
        priors_ui(ui, preview, request, session, view.units);
        if evidence != preview.evidence {
            request.evidence = EvidenceChoice::Inline(Box::new(evidence));
        }
    });
}

/// Says what can be done without evidence, or what is wrong with its file.
fn start_ui(
    ui: &mut Ui,
    request: Option<&ReconstructRequest>,
    session: &ReconstructionSession,
    commands: &mut Vec<Command>,
) {
    let evidence = request.map(|request| &request.evidence);
    if let (Some(EvidenceChoice::File(path)), Some(file)) = (evidence, &session.file)
        && let Err(problem) = &file.evidence
    {
        let text = format!("{} cannot be read: {problem}", path.display());
        notice_ui(ui, Severity::Error, text);
    }
    empty_ui(
        ui,
        "How fast were the cars?",
        "From what was found after a collision (rest position, tire marks, damage, recorder, friction, \
         masses) back to the speeds before it, or from the marks and the rest of a single car to its speed at \
         their start, as a distribution.",
    );
    ui.add_space(looks::PART);
    for (icon, label, hint, command) in [
        (
            Icon::FolderOpen,
            "Open an evidence file…",
            "A TOML file, as impactlab reconstruct takes it; it can also be dropped here",
            Command::Ask(Purpose::Files),
        ),
        (
            Icon::History,
            "Look at the example",
            "A car that was hit behind its left rear wheel and slid to rest, with four tire marks",
            Command::Reconstruct(ReconstructionCommand::Example),
        ),
        (
            Icon::Plus,
            "New evidence",
            "An empty form, with the car at rest to be dragged in the scene",
            Command::Reconstruct(ReconstructionCommand::New),
        ),
        (
            Icon::Car,
            "New evidence of a single car",
            "An empty form of a car that struck nothing: it left marks and came to rest",
            Command::Reconstruct(ReconstructionCommand::NewSingleCar),
        ),
    ] {
        if ui.add(icon_button(icon, label)).on_hover_text(hint).clicked() {
            commands.push(command);
        }
    }
}

/// Draws the name of the case, where its evidence comes from, and the way to other evidence.
fn case_ui(
    ui: &mut Ui,
    evidence: &mut Evidence,
    request: &ReconstructRequest,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        let name = ui.strong("Case");
        ui.add(TextEdit::singleline(&mut evidence.case).desired_width(120.0)).labelled_by(name.id);
        if ui.button("Open…").on_hover_text("Open an evidence file").clicked() {
            commands.push(Command::Ask(Purpose::Files));
        }
        if ui.button("New").on_hover_text("Begin with an empty form").clicked() {
            commands.push(Command::Reconstruct(ReconstructionCommand::New));
        }
        let hint = "A file for impactlab reconstruct, and for this window";
        let save = ui.add_enabled(evidence.missing().is_none(), egui::Button::new("Save as…"));
        if save.on_hover_text(hint).clicked() {
            commands
                .push(Command::Ask(Purpose::Save(Output::Evidence(Box::new(evidence.clone())))));
        }
    });
    // The line is always there, so that the cards do not move when the first of them is edited.
    match &request.evidence {
        EvidenceChoice::File(path) => {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            ui.weak(format!("as in {name}")).on_hover_text(path.display().to_string());
        }
        EvidenceChoice::Inline(_) => {
            let hint = "Save as… writes a file of it";
            ui.weak("entered here, kept in the case").on_hover_text(hint);
        }
    }
    if let Some(site) = &request.site {
        let name = site.file_name().unwrap_or_default().to_string_lossy();
        let text = format!(
            "The wheels stand on the friction zones of {name}, the site of this case, in the axes of the \
             evidence. Evidence of another place belongs into a new case, or to no site."
        );
        notice_ui(ui, Severity::Info, text);
        ui.horizontal_wrapped(|ui| {
            let hint = "Where it is looked at, measured, saved and taken away";
            if ui.small_button("Show the site").on_hover_text(hint).clicked() {
                commands.push(Command::Show(Pane::Scene));
            }
            let hint = "The wheels then stand on the friction of the evidence. Undo takes it back";
            if ui.small_button(REMOVE_SITE).on_hover_text(hint).clicked() {
                commands.push(Command::Ground(GroundCommand::Remove));
            }
        });
    }
}

/// Draws the settings of the run, the button that starts it, and its progress.
fn run_ui(
    ui: &mut Ui,
    request: &mut ReconstructRequest,
    session: &ReconstructionSession,
    preview: &EvidencePreview,
    commands: &mut Vec<Command>,
) {
    let mut command = |command| commands.push(Command::Reconstruct(command));
    let lacks = preview.problem.clone().or_else(|| preview.evidence.missing());
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Particles");
        count_field(ui, &mut request.particles, &RECONSTRUCTION_PARTICLES, 10.0)
            .labelled_by(name.id)
            .on_hover_text("More particles are more sure of the intervals and take longer");
        let name = ui.label("Seed");
        seed_field(ui, &mut request.seed).labelled_by(name.id);
        if preview.evidence.follows_striking_car() {
            ui.checkbox(&mut request.one_contact, "One contact only").on_hover_text(
                "Otherwise both cars are followed through all contacts where they meet again, which takes \
                 minutes",
            );
        }
        let button = icon_button(Icon::Play, "Run");
        let can_run = lacks.is_none() && !session.run.is_running();
        let run = ui.add_enabled(can_run, button).on_hover_text("From the evidence to the speeds");
        if run.clicked() {
            command(ReconstructionCommand::Run);
        }
    });
    // The room is always there, so that the cards do not move while they are filled in and while it runs.
    let line = ui.text_style_height(&TextStyle::Body) + ui.spacing().item_spacing.y;
    ui.allocate_ui(vec2(ui.available_width(), STATUS_LINES * line), |ui| {
        ui.set_min_height(STATUS_LINES * line);
        let is_outdated = session.is_outdated(Some(&*request));
        let (severity, state) = match (lacks.as_deref(), session.run.problem(), session.answer()) {
            (Some(lacks), ..) => (Severity::Warning, lacks.to_owned()),
            // Why other evidence gave no speeds says nothing of this.
            (None, Some(problem), _) if !is_outdated => {
                (Severity::Error, format!("Not reconstructed: {problem}"))
            }
            (None, _, Some(_)) if is_outdated => (Severity::Warning, OUTDATED.to_owned()),
            (None, _, Some(_)) => {
                (Severity::Info, "The speeds are those of this evidence.".to_owned())
            }
            (None, _, None) => {
                (Severity::Info, "Nothing is missing: Run gives the speeds.".to_owned())
            }
        };
        match session.run.job() {
            Some(_) => progress_ui(ui, session, &mut command),
            None => drop(notice_ui(ui, severity, state)),
        }
    });
}

/// Draws the progress of a run.
fn progress_ui(
    ui: &mut Ui,
    session: &ReconstructionSession,
    command: &mut impl FnMut(ReconstructionCommand),
) {
    let Some(job) = session.run.job() else { return };
    ui.horizontal(|ui| {
        let is_cancelled = job.is_cancelled();
        let hint = "It gives no speeds before all of the evidence is used; Run goes on from what was \
                    sampled";
        let button = ui.add_enabled(!is_cancelled, egui::Button::new("Cancel"));
        if button.on_hover_text(hint).clicked() {
            command(ReconstructionCommand::Cancel);
        }
        let progress = job.progress();
        let (what, left) = match is_cancelled {
            true => ("ending", None),
            false => (progress.message.as_str(), session.time_left()),
        };
        run_progress_ui(ui, what, progress.fraction(), left);
    });
}
