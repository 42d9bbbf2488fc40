//! A figure with its heading and a menu that exports it.

use egui::{Align, Layout, RichText, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{Icon, icon, icon_button};
use crate::app::output::Output;
use impactlab_document::figure::Figure;
use impactlab_draw::{FigureOptions, FigureResponse, figure_ui};

/// Height of the heading above a plot, and smallest height of a plot with its axes, points.
pub const TITLE_HEIGHT: f32 = 30.0;
pub const MIN_PLOT_HEIGHT: f32 = 120.0;

/// Why a figure is not exported that is not of what is asked any more.
pub const OUTDATED: &str = "This figure is not the answer to what is asked now: it can be saved as soon as that is computed";

/// Draws a figure under a heading, with a menu that saves the picture as PNG, saves the numbers as
/// CSV or copies the numbers, each with what restricts the figure. A figure that is not of what is
/// asked any more cannot be saved or copied.
///
/// - returns what the user did in the figure, such as the abscissa that was clicked.
pub fn figure_frame(
    ui: &mut Ui,
    heading: &str,
    figure: &Figure,
    options: &FigureOptions,
    commands: &mut Vec<Command>,
) -> FigureResponse {
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_enabled_ui(!figure.caveats.is_outdated(), |ui| {
                ui.menu_button((icon(Icon::Download), "Export"), |ui| {
                    export_menu_ui(ui, figure, commands)
                })
                .response
                .on_hover_text("Save or copy this figure")
                .on_disabled_hover_text(OUTDATED);
            });
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(egui::Label::new(RichText::new(heading).strong()).truncate());
            });
        });
    });
    figure_ui(ui, figure, options)
}

fn export_menu_ui(ui: &mut Ui, figure: &Figure, commands: &mut Vec<Command>) {
    if ui.add(icon_button(Icon::Image, "Save picture (PNG)…")).clicked() {
        commands.push(Command::Ask(Purpose::Save(Output::Picture(Box::new(figure.clone())))));
    }
    if ui.add(icon_button(Icon::Table2, "Save numbers (CSV)…")).clicked() {
        commands.push(Command::Ask(Purpose::Save(Output::Numbers(Box::new(figure.clone())))));
    }
    if ui.add(icon_button(Icon::Copy, "Copy numbers")).clicked() {
        commands.push(Command::CopyNumbers(Box::new(figure.clone())));
    }
}
