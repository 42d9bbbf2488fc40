//! The panes of the window and where they stand.

use egui::{Id, Ui, WidgetText};
use egui_tiles::{
    Behavior, Container, Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse,
};
use serde::{Deserialize, Serialize};

use crate::app::command::Command;
use crate::app::panels;
use crate::app::state::{Project, Session, View};

/// Where the panes stand.
pub type Layout = Tree<Pane>;

/// A part of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pane {
    /// What is open.
    Data,
    /// The cases of a dataset.
    Cases,
    /// Vehicle and integration.
    Vehicle,
    /// The impact solver.
    Scenario,
    /// The scene from above.
    Scene,
    /// Motion over time.
    Motion,
    /// Force over time.
    Force,
    /// Simulation against reference.
    Comparison,
}

impl Pane {
    /// Every pane.
    pub const ALL: [Self; 8] = [
        Self::Data,
        Self::Cases,
        Self::Vehicle,
        Self::Scenario,
        Self::Scene,
        Self::Motion,
        Self::Force,
        Self::Comparison,
    ];

    /// Its title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Data => "Data",
            Self::Cases => "Cases",
            Self::Vehicle => "Vehicle",
            Self::Scenario => "Scenario",
            Self::Scene => "Scene",
            Self::Motion => "Motion",
            Self::Force => "Force",
            Self::Comparison => "Comparison",
        }
    }
}

/// Three columns: data and cases, with scenario and vehicle behind; scene and motion; force and
/// figures.
pub fn default_layout() -> Layout {
    let mut tiles = Tiles::default();
    let mut tabs = |panes: &[Pane]| {
        let tiles_of_tabs = panes.iter().map(|&pane| tiles.insert_pane(pane)).collect();
        tiles.insert_tab_tile(tiles_of_tabs)
    };
    let (data, cases) = (tabs(&[Pane::Data]), tabs(&[Pane::Cases, Pane::Scenario, Pane::Vehicle]));
    let (scene, motion) = (tabs(&[Pane::Scene]), tabs(&[Pane::Motion]));
    let (force, comparison) = (tabs(&[Pane::Force]), tabs(&[Pane::Comparison]));
    let mut column = |top, bottom, share: f32| {
        let mut linear = Linear::new(LinearDir::Vertical, vec![top, bottom]);
        linear.shares.set_share(top, share);
        linear.shares.set_share(bottom, 1.0 - share);
        tiles.insert_new(egui_tiles::Tile::Container(Container::Linear(linear)))
    };
    let columns = [
        (column(data, cases, 0.28), 0.27),
        (column(scene, motion, 0.45), 0.43),
        (column(force, comparison, 0.5), 0.30),
    ];
    let mut row = Linear::new(LinearDir::Horizontal, columns.map(|(tile, _)| tile).to_vec());
    for (tile, share) in columns {
        row.shares.set_share(tile, share);
    }
    let root = tiles.insert_new(egui_tiles::Tile::Container(Container::Linear(row)));
    Tree::new(Id::unique("panes"), root, tiles)
}

/// Brings a pane to the front.
pub fn show_pane(layout: &mut Layout, pane: Pane) {
    layout.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(other) if *other == pane));
}

/// Draws the panes over the parts of the state.
pub struct PaneContext<'a> {
    /// What the user works on.
    pub project: &'a mut Project,
    /// How it is shown, without the layout, which is being drawn.
    pub view: &'a mut View,
    /// What is loaded and computed.
    pub session: &'a mut Session,
    /// What the user asks for.
    pub commands: &'a mut Vec<Command>,
}

impl Behavior<Pane> for PaneContext<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let frame = egui::Frame::new().inner_margin(6.0);
        frame.show(ui, |ui| match pane {
            Pane::Data => panels::data_ui(ui, self),
            Pane::Cases => panels::cases_ui(ui, self),
            Pane::Vehicle => panels::vehicle_ui(ui, self),
            Pane::Scenario => panels::scenario_ui(ui, self),
            Pane::Scene => panels::scene_ui(ui, self),
            Pane::Motion => panels::motion_ui(ui, self),
            Pane::Force => panels::force_ui(ui, self),
            Pane::Comparison => panels::comparison_ui(ui, self),
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.title().into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }
}
