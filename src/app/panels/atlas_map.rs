//! The “Map” pane: an outcome over two axes of an atlas, with the case at hand in it.

use egui::{Id, Label, RichText, ScrollArea, Ui};

use crate::app::atlas::{AtlasCommand, AtlasSession, LEGEND, ShownMap};
use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{self, Icon, icon_button};
use crate::app::panes::{Pane, PaneContext};
use crate::app::widgets::{
    MIN_PLOT_HEIGHT, TITLE_HEIGHT, empty_ui, figure_frame, notice_ui, working_ui,
};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_draw::FigureOptions;
use impactlab_sweep::atlas::Atlas;

/// Height of the lines below the maps, points.
const READOUT_HEIGHT: f32 = 112.0;
/// Width of the text of the empty pane, points.
const TEXT_WIDTH: f32 = 560.0;

/// A cell that the pointer is over: its map, and its bins along both axes.
type Pointed<'a> = (&'a ShownMap, [usize; 2]);

/// Draws the maps side by side, and what the cell under the pointer says.
pub fn atlas_map_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, commands, .. } = pane;
    let Some(atlas) = session.atlas.atlas() else {
        return no_atlas_ui(ui, &session.atlas, commands);
    };
    ui.add(Label::new(RichText::new(LEGEND).weak()).wrap());
    if let Some(warning) = session.atlas.warning() {
        notice_ui(ui, Severity::Warning, warning);
    }
    let maps = session.atlas.maps();
    let height = (ui.available_height() - TITLE_HEIGHT - READOUT_HEIGHT).max(MIN_PLOT_HEIGHT);
    let mut pointed = None;
    ui.columns(maps.len().max(1), |columns| {
        for (idx, (ui, map)) in columns.iter_mut().zip(maps).enumerate() {
            let options = FigureOptions {
                id: format!("atlas map {idx}"),
                link: Some(Id::unique("atlas maps")),
                links_y: true,
                height: Some(height),
                reset: session.fit_plots,
                pans: false,
                ..FigureOptions::default()
            };
            let response = figure_frame(ui, &map.figure.title, &map.figure, &options, commands);
            if let Some(bins) = response.pointer.and_then(|at| map.bins_at(at)) {
                pointed = Some((map, bins));
            }
            if let Some(bins) = response.clicked.and_then(|at| map.bins_at(at)) {
                commands.push(Command::Atlas(AtlasCommand::Play(map.bins(bins))));
            }
        }
    });
    readout_ui(ui, &session.atlas, atlas, pointed, view.units);
}

/// Draws what the case at hand says, and below that what the cell under the pointer says: what is told of the
/// case stays while the pointer moves.
fn readout_ui(
    ui: &mut Ui,
    session: &AtlasSession,
    atlas: &Atlas,
    pointed: Option<Pointed<'_>>,
    units: UnitSystem,
) {
    for line in session.case_lines(atlas, units) {
        ui.add(Label::new(line).wrap());
    }
    match pointed {
        Some((map, bins)) => {
            for line in [map.place_text(bins, units), map.text(bins, units)] {
                ui.add(Label::new(line).wrap());
            }
        }
        None => {
            let hint =
                "A click on a cell makes a new variant of its values, computes and plays it.";
            ui.add(Label::new(RichText::new(hint).weak()).wrap());
        }
    }
}

/// Draws what an atlas is and how to get one.
fn no_atlas_ui(ui: &mut Ui, session: &AtlasSession, commands: &mut Vec<Command>) {
    if session.problem().is_none() {
        return working_ui(ui, "Reading the atlas…");
    }
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.set_max_width(TEXT_WIDTH.min(ui.available_width()));
        empty_ui(
            ui,
            "No atlas is open",
            "An atlas is a map of many computed collisions: how often a PIT spins a car, by speed, \
             angle, place of contact and road, and how much room it needs.",
        );
        ui.add_space(looks::PART);
        ui.label("Open a file NAME.atlas, or drop it on this window.");
        if ui.add(icon_button(Icon::FolderOpen, "Open an atlas…")).clicked() {
            commands.push(Command::Ask(Purpose::OpenAtlas));
        }
        ui.add_space(looks::PART);
        ui.label(
            "Or compute one: a sweep runs one question many times, and its merged rows make an atlas \
             (impactlab atlas make).",
        );
        if ui.add(icon_button(Icon::Repeat, "Show the sweep")).clicked() {
            commands.push(Command::Show(Pane::Sweep));
        }
        ui.add_space(looks::PART);
        ui.weak(LEGEND);
    });
}
