//! The “Training” pane: settings, progress and losses of the training of either network.

use egui::{ScrollArea, Ui};

use crate::app::cost::CostPlace;
use crate::app::network::Network;
use crate::app::panels::training_force::force_form_ui;
use crate::app::panels::training_losses::LossView;
use crate::app::panels::training_parts::network_training_ui;
use crate::app::panels::training_response::response_form_ui;
use crate::app::panes::PaneContext;
use crate::app::widgets::{cost_ui, no_dataset_ui};
use impactlab_core::data::DatasetKind;

/// Draws the choice between the two networks and the training of the chosen one.
pub fn training_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.horizontal(|ui| {
            for network in Network::ALL {
                ui.selectable_value(&mut pane.view.trained, network, network.label());
            }
        });
        ui.separator();
        match pane.view.trained {
            Network::Force => force_training_ui(ui, pane),
            Network::Response => response_training_ui(ui, pane),
        }
    });
}

fn force_training_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let has_data =
        force_form_ui(ui, &mut project.networks, &session.sources, view.listed.as_deref());
    if !has_data {
        no_dataset_ui(ui, DatasetKind::Force, commands);
    }
    let (reset, units, view) = (session.fit_plots, view.units, &mut view.force);
    let view = LossView { terms: &mut view.loss_terms, log: &mut view.log_losses, reset, units };
    let (force, costs) = (&mut session.force, &mut session.costs);
    let cost = |ui: &mut Ui| cost_ui(ui, costs, CostPlace::ForceTraining, "Training");
    network_training_ui(ui, has_data, &force.training, &mut force.model, cost, view, commands);
}

fn response_training_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let has_data =
        response_form_ui(ui, &mut project.networks, &session.sources, view.listed.as_deref());
    if !has_data {
        no_dataset_ui(ui, DatasetKind::Trajectory, commands);
    }
    let (reset, units, view) = (session.fit_plots, view.units, &mut view.response);
    let view = LossView { terms: &mut view.loss_terms, log: &mut view.log_losses, reset, units };
    let (response, costs) = (&mut session.response, &mut session.costs);
    let (training, model) = (&response.training, &mut response.model);
    let cost = |ui: &mut Ui| cost_ui(ui, costs, CostPlace::ResponseTraining, "Training");
    network_training_ui(ui, has_data, training, model, cost, view, commands);
}
