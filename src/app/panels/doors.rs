//! The three ways to begin: what happens if, what has happened, and one's own data.

use std::path::PathBuf;

use egui::{Align, Button, Frame, Layout, RichText, Ui, vec2};

use crate::app::case::{CaseCommand, Leaving};
use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{self, Icon};
use crate::app::workspaces::Workspace;

/// Width and height of a door, points.
const SIZE: [f32; 2] = [280.0, 190.0];
/// Space between two doors, points.
const GAP: f32 = 4.0 * looks::GRID;
/// Space between the edge of a door and its text, points.
const INSIDE: f32 = 4.0 * looks::GRID;

/// What to do first.
const FIRST_STEP: &str = "New here? Set up a collision: it has an answer within seconds, and every number of \
                          it can be changed.";

/// A way to begin.
struct Door {
    icon: Icon,
    title: &'static str,
    text: &'static str,
    button: &'static str,
    commands: fn() -> Vec<Command>,
}

/// The ways to begin, from left to right.
const DOORS: [Door; 3] = [
    Door {
        icon: Icon::CarFront,
        title: "What happens if …",
        text: "Two cars in a PIT, ready to play. Change speeds, angle, cars and brakes, and see where \
               the struck car goes and how sure that is.",
        button: "Set up a collision",
        commands: || vec![Command::Case(CaseCommand::Leave(Leaving::Pit))],
    },
    Door {
        icon: Icon::History,
        title: "What happened?",
        text: "From what was found after a collision (places of rest, tire marks, damage, recorders) \
               back to the speeds before it: type it in, open a file, or look at an example.",
        button: "Reconstruct a collision",
        commands: || vec![Command::Case(CaseCommand::Leave(Leaving::Reconstruction))],
    },
    Door {
        icon: Icon::FolderOpen,
        title: "Open my data",
        text: "Force curves, trajectories, driving logs: CSV, text or Excel. What a file leaves \
               open, such as a unit, is asked before it is read. You can also drop files here.",
        button: "Choose files…",
        commands: || vec![Command::ShowWorkspace(Workspace::Data), Command::Ask(Purpose::Files)],
    },
];

/// Draws the ways to begin and the cases that were opened last.
pub fn doors_ui(ui: &mut Ui, recent: &[PathBuf], commands: &mut Vec<Command>) {
    ui.add_space((ui.available_height() * 0.18).max(GAP));
    ui.vertical_centered(|ui| {
        ui.heading("What do you want to know?");
        ui.weak(
            "The shipped cars, forces and networks are there already. Nothing leaves this machine.",
        );
        ui.label(FIRST_STEP);
    });
    ui.add_space(2.0 * GAP);
    let width = DOORS.len() as f32 * (SIZE[0] + GAP) - GAP;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        ui.add_space(((ui.available_width() - width) / 2.0 - GAP).max(0.0));
        for door in &DOORS {
            door_ui(ui, door, commands);
        }
    });
    ui.add_space(2.0 * GAP);
    ui.vertical_centered(|ui| {
        if !recent.is_empty() {
            ui.strong("Recent cases");
        }
        for path in recent {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            if ui.link(name).on_hover_text(path.display().to_string()).clicked() {
                commands.push(Command::Open(vec![path.clone()]));
            }
        }
        ui.add_space(GAP);
        let example = ui.link("Look at the example case");
        let hint =
            "Finished, with three variants: the car coasts, its driver brakes, a lighter car";
        if example.on_hover_text(hint).clicked() {
            commands.push(Command::Case(CaseCommand::Leave(Leaving::Example)));
        }
        if ui.link("Look through the shipped data").clicked() {
            commands.push(Command::ShowWorkspace(Workspace::Data));
        }
    });
}

fn door_ui(ui: &mut Ui, door: &Door, commands: &mut Vec<Command>) {
    let frame = Frame::group(ui.style()).fill(ui.visuals().extreme_bg_color).inner_margin(INSIDE);
    frame.show(ui, |ui| {
        let margin = 2.0 * INSIDE;
        let size = vec2(SIZE[0] - margin, SIZE[1] - margin);
        ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
            ui.set_min_size(size);
            ui.horizontal(|ui| {
                looks::icon_ui(ui, door.icon, ui.visuals().hyperlink_color);
                ui.label(RichText::new(door.title).heading());
            });
            ui.add_space(looks::PART);
            ui.add(egui::Label::new(door.text).wrap());
            ui.with_layout(Layout::bottom_up(Align::Min), |ui| {
                let button = Button::new(RichText::new(door.button).strong());
                if ui.add(button.min_size(vec2(size.x, 30.0))).clicked() {
                    commands.extend((door.commands)());
                }
            });
        });
    });
}
