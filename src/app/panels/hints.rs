//! What panes show in the place of an answer, or over one that is late.

use egui::Ui;

use crate::app::command::Command;
use crate::app::model::file_name;
use crate::app::project::Project;
use crate::app::source::{Content, Source};
use crate::app::state::{Session, Subject};
use crate::app::widgets::{empty_ui, notice_ui, working_ui};
use impactlab_core::data::Severity;
use impactlab_study::SimulateAnswer;

/// Share of its colour that an answer keeps which is not of what is asked any more.
const FADED: f32 = 0.35;

/// Draws an answer, greyed if it is not of what is asked any more; the bar of its tab says that it is being
/// computed.
pub(super) fn faded_if<R>(ui: &mut Ui, is_late: bool, draw: impl FnOnce(&mut Ui) -> R) -> R {
    let drawn = ui.scope(|ui| {
        if is_late {
            ui.multiply_opacity(FADED);
        }
        draw(ui)
    });
    drawn.inner
}

/// Returns the simulation of the selected subject. If there is none, it draws the reason (an error,
/// a simulation that is still running, data that are not there, or no selection) with what can be done, and
/// returns `None`.
pub(super) fn analysis_or_hint<'a>(
    ui: &mut Ui,
    session: &'a Session,
    project: &Project,
    commands: &mut Vec<Command>,
) -> Option<&'a SimulateAnswer> {
    match &session.analysis.answer {
        Some(Ok(answer)) => return Some(answer),
        Some(Err(error)) => {
            notice_ui(ui, Severity::Error, format!("Not computed: {error}"));
        }
        None if session.analysis.is_waiting()
            || session.sources.iter().any(|s| !s.is_settled()) =>
        {
            working_ui(ui, "Working…");
        }
        None => nothing_asked_ui(ui, &session.sources, project.subject().as_ref(), commands),
    }
    None
}

/// Draws why nothing is simulated: nothing is selected, or the data of what is selected are not there.
fn nothing_asked_ui(
    ui: &mut Ui,
    sources: &[Source],
    subject: Option<&Subject>,
    commands: &mut Vec<Command>,
) {
    let path = match subject {
        None => {
            let text = "Choose a case in the Data workspace, open a file (File, or drop it here), or set up a scenario.";
            return empty_ui(ui, "No case chosen", text);
        }
        Some(Subject::Scenario | Subject::Manoeuvre) => return working_ui(ui, "Working…"),
        Some(Subject::Case { dataset: path, .. } | Subject::File(path)) => path,
    };
    let name = file_name(path);
    let source = sources.iter().find(|source| source.path == *path);
    match (source.map(|source| &source.content), subject) {
        (None, _) => {
            let text = "What is chosen comes from there. Open it again, or choose something else in the Data workspace.";
            empty_ui(ui, format!("{name} is not open"), text);
            let button = ui.button(format!("Open {name}"));
            if button.on_hover_text(path.display().to_string()).clicked() {
                commands.push(Command::Open(vec![path.clone()]));
            }
        }
        (Some(Content::Failed(why)), _) => {
            notice_ui(ui, Severity::Error, format!("{name} is not read: {why}"));
            ui.label("The Data workspace says more, and has what else can be chosen.");
        }
        (Some(Content::Dataset(checked)), Some(Subject::Case { case, .. }))
            if checked.dataset.case(case).is_none() =>
        {
            let title = format!("{name} has no case {case}");
            empty_ui(ui, title, "Choose another one in the Data workspace.");
        }
        (Some(_), _) => working_ui(ui, "Working…"),
    }
}
