//! How the networks learn.

use egui::{ScrollArea, Ui};

use crate::app::network::Network;
use crate::app::panels::training_force::force_training_ui;
use crate::app::panels::training_response::response_training_ui;
use crate::app::panes::PaneContext;

/// Draws the training of one of the networks.
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
