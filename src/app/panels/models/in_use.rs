//! Which model of each network answers, what it is, and what it is used for.

use egui::Ui;

use crate::app::archive::{ArchiveStatus, how_it_was_made};
use crate::app::command::Command;
use crate::app::model::{CurrentModel, ModelStatus};
use crate::app::network::TrainedModel;
use crate::app::panels::model_row::{model_row_ui, no_model_ui};
use crate::app::panes::PaneContext;
use crate::app::widgets::facts_ui;
use impactlab_core::units::UnitSystem;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::facts::{Fact, Term};
use impactlab_study::{ForceSource, ModelChoice};

/// Draws both networks beside each other.
pub fn in_use_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let units = view.units;
    let is_chained = matches!(project.predict_motion.force, ForceSource::Predicted(_));
    let (force, response, archive) =
        (&session.force.model, &session.response.model, &session.archive);
    ui.columns(2, |columns| {
        let [left, right] = columns else { return };
        let use_of_it = match is_chained {
            true => "Answers the force prediction, and gives the motion forecast its force.",
            false => "Answers the force prediction. The motion forecast takes the given force.",
        };
        network_ui(left, force, use_of_it, archive, units, commands);
        let use_of_it = "Answers the motion forecast and the outcome.";
        network_ui(right, response, use_of_it, archive, units, commands);
    });
}

fn network_ui<M: TrainedModel>(
    ui: &mut Ui,
    model: &ModelStatus<M>,
    use_of_it: &str,
    archive: &ArchiveStatus,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    ui.strong(M::NETWORK.label());
    let Some(current) = &model.current else {
        no_model_ui(ui, model, use_of_it, commands);
        return;
    };
    model_row_ui(ui, model, "The model that answers", commands);
    ui.label(use_of_it);
    let mut facts = current.model.facts();
    facts.facts.insert(0, Fact::text(Term::Origin, origin(current, archive)));
    // Both networks may be called alike.
    let name = format!("{}: {}", M::NETWORK.label(), current.name);
    facts_ui(ui, &name, &[facts], units);
    match current.model.settings() {
        None => drop(ui.weak("The usual settings")),
        Some(settings) => {
            let title = format!("Settings that are not the usual ones: {}", settings.facts.len());
            ui.collapsing(title, |ui| {
                facts_ui(ui, &format!("{name}, settings"), &[settings], units);
            });
        }
    }
    if let Some(set_aside) = &model.set_aside {
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("Not in use, of the last training: {}", set_aside.name));
            if ui.button("Use it").clicked() {
                commands.push(Command::UseTrained(M::NETWORK));
            }
        });
    }
}

/// Says where a model comes from.
fn origin<M: TrainedModel>(current: &CurrentModel<M>, archive: &ArchiveStatus) -> String {
    match &current.choice {
        ModelChoice::Source(ModelSource::File(path)) => match archive.entry_of(path) {
            Some(entry) => {
                let cancelled = if entry.is_cancelled { ", cancelled" } else { "" };
                let how = how_it_was_made(&entry.question);
                format!("{how}{cancelled}")
            }
            None => path.display().to_string(),
        },
        ModelChoice::Source(_) => "comes with the program".to_owned(),
        ModelChoice::Held { .. } => "trained in this window, in no file".to_owned(),
    }
}
