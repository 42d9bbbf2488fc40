//! The panes of the window and their layout.

use egui::{Id, Ui, WidgetText};
use egui_tiles::{
    Behavior, Container, Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse,
};
use serde::{Deserialize, Serialize};

use crate::app::command::Command;
use crate::app::panels;
use crate::app::state::{Project, Session, View};

/// Number of pane titles that the tab of a container shows before it ends in “…”.
const MAX_TITLES: usize = 2;

/// The arrangement of the panes in the window, which the user can change.
pub type Layout = Tree<Pane>;

/// A pane of the window. Each one is drawn by a function in `panels`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pane {
    /// The data sets and files that are open, with the problems found in them.
    Data,
    /// The cases of the listed data set.
    Cases,
    /// The vehicles, the equations of motion and their integration.
    Vehicle,
    /// The scenario of two vehicles and its impulse solution.
    Scenario,
    /// The scene of the impact and the motion, seen from above.
    Scene,
    /// The motion over time.
    Motion,
    /// The contact force over time.
    Force,
    /// The simulation compared with the recorded motion.
    Comparison,
    /// The force history that the force network predicts.
    ForcePrediction,
    /// The predicted motion of the struck vehicle, with its uncertainty.
    MotionForecast,
    /// The training of either network.
    Training,
    /// The evaluation of the force network on a data set.
    Evaluation,
    /// The comparison of response models.
    ModelComparison,
}

impl Pane {
    /// Every pane, in the order of the menu.
    pub const ALL: [Self; 13] = [
        Self::Data,
        Self::Cases,
        Self::Vehicle,
        Self::Scenario,
        Self::Scene,
        Self::Motion,
        Self::Force,
        Self::Comparison,
        Self::ForcePrediction,
        Self::MotionForecast,
        Self::Training,
        Self::Evaluation,
        Self::ModelComparison,
    ];

    /// Whether the pane shows nothing but the simulation of the subject.
    fn is_answer(self) -> bool {
        matches!(self, Self::Scene | Self::Motion | Self::Force | Self::Comparison)
    }

    /// Returns the title of the pane.
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
            Self::ForcePrediction => "Force prediction",
            Self::MotionForecast => "Motion forecast",
            Self::Training => "Training",
            Self::Evaluation => "Force evaluation",
            Self::ModelComparison => "Compare models",
        }
    }
}

/// Returns the default layout.
///
/// The data stand at the upper left, with the cases, the scenario and the vehicle in tabs below.
/// The rest of the window holds tabs: one with scene, motion, force and comparison of a single
/// case, and one for each pane of the two networks.
pub fn default_layout() -> Layout {
    let mut tiles = Tiles::default();
    let mut tabs = |panes: &[Pane]| {
        let tiles_of_tabs = panes.iter().map(|&pane| tiles.insert_pane(pane)).collect();
        tiles.insert_tab_tile(tiles_of_tabs)
    };
    let (data, cases) = (tabs(&[Pane::Data]), tabs(&[Pane::Cases, Pane::Scenario, Pane::Vehicle]));
    let (scene, motion) = (tabs(&[Pane::Scene]), tabs(&[Pane::Motion]));
    let (force, comparison) = (tabs(&[Pane::Force]), tabs(&[Pane::Comparison]));
    let mut linear = |direction, parts: [(TileId, f32); 2]| {
        let mut linear = Linear::new(direction, parts.map(|(tile, _)| tile).to_vec());
        for (tile, share) in parts {
            linear.shares.set_share(tile, share);
        }
        tiles.insert_new(egui_tiles::Tile::Container(Container::Linear(linear)))
    };
    let left = linear(LinearDir::Vertical, [(data, 0.28), (cases, 0.72)]);
    let middle = linear(LinearDir::Vertical, [(scene, 0.45), (motion, 0.55)]);
    let right = linear(LinearDir::Vertical, [(force, 0.5), (comparison, 0.5)]);
    let case = linear(LinearDir::Horizontal, [(middle, 0.59), (right, 0.41)]);
    let networks = [
        Pane::ForcePrediction,
        Pane::MotionForecast,
        Pane::Training,
        Pane::Evaluation,
        Pane::ModelComparison,
    ];
    let networks = networks.map(|pane| tiles.insert_pane(pane));
    let work = tiles.insert_tab_tile(std::iter::once(case).chain(networks).collect());
    let mut row = Linear::new(LinearDir::Horizontal, vec![left, work]);
    row.shares.set_share(left, 0.27);
    row.shares.set_share(work, 0.73);
    let root = tiles.insert_new(egui_tiles::Tile::Container(Container::Linear(row)));
    Tree::new(Id::unique("panes"), root, tiles)
}

/// Whether a layout contains every pane. A layout that was saved by an earlier version may lack
/// some.
pub fn is_complete(layout: &Layout) -> bool {
    let has = |pane: &Pane| {
        let mut tiles = layout.tiles.tiles();
        tiles.any(|tile| matches!(tile, egui_tiles::Tile::Pane(other) if other == pane))
    };
    Pane::ALL.iter().all(has)
}

/// Brings a pane to the front.
pub fn show_pane(layout: &mut Layout, pane: Pane) {
    layout.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(other) if *other == pane));
}

/// The context in which the panes are drawn: the parts of the state, and the list of commands.
pub struct PaneContext<'a> {
    /// What the user works on. Panes edit their own settings in it.
    pub project: &'a mut Project,
    /// How the project is shown. Its layout is empty while the panes are drawn.
    pub view: &'a mut View,
    /// Loaded data, answers and running work.
    pub session: &'a mut Session,
    /// The commands that the panes add.
    pub commands: &'a mut Vec<Command>,
}

impl Behavior<Pane> for PaneContext<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let frame = egui::Frame::new().inner_margin(6.0);
        let is_late = pane.is_answer() && self.session.is_simulation_late();
        frame.show(ui, |ui| {
            panels::faded(ui, is_late, |ui| match pane {
                Pane::Data => panels::data_ui(ui, self),
                Pane::Cases => panels::cases_ui(ui, self),
                Pane::Vehicle => panels::vehicle_ui(ui, self),
                Pane::Scenario => panels::scenario_ui(ui, self),
                Pane::Scene => panels::scene_ui(ui, self),
                Pane::Motion => panels::motion_ui(ui, self),
                Pane::Force => panels::force_ui(ui, self),
                Pane::Comparison => panels::comparison_ui(ui, self),
                Pane::ForcePrediction => panels::prediction_ui(ui, self),
                Pane::MotionForecast => panels::motion_forecast_ui(ui, self),
                Pane::Training => panels::training_ui(ui, self),
                Pane::Evaluation => panels::evaluation_ui(ui, self),
                Pane::ModelComparison => panels::model_comparison_ui(ui, self),
            })
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.title().into()
    }

    /// Returns the title of a tab: that of its pane or, for a container, the titles of the first
    /// panes in it.
    fn tab_title_for_tile(&mut self, tiles: &Tiles<Pane>, tile_id: TileId) -> WidgetText {
        let mut names = Vec::new();
        collect_titles(tiles, tile_id, &mut names);
        let more = if names.len() > MAX_TITLES { ", …" } else { "" };
        names.truncate(MAX_TITLES);
        format!("{}{more}", names.join(", ")).into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }
}

/// Collects the titles of the panes in a tile, in their order.
fn collect_titles(tiles: &Tiles<Pane>, tile_id: TileId, titles: &mut Vec<&'static str>) {
    match tiles.get(tile_id) {
        Some(egui_tiles::Tile::Pane(pane)) => titles.push(pane.title()),
        Some(egui_tiles::Tile::Container(container)) => {
            for child in container.children() {
                collect_titles(tiles, *child, titles);
            }
        }
        None => {}
    }
}
