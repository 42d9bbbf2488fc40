//! The panes of the window.

use egui::{Ui, WidgetText};
use egui_tiles::{Behavior, SimplificationOptions, TileId, Tiles, UiResponse};
use serde::{Deserialize, Serialize};

use crate::app::command::Command;
use crate::app::contents::ContentsEntry;
use crate::app::looks::{self, Icon};
use crate::app::panels;
use crate::app::project::Project;
use crate::app::state::{Session, View};
use crate::app::variants::AnsweredVariant;
use crate::app::widgets::BetweenCursors;

/// Number of pane titles that the tab of a container shows before it ends in “…”.
const MAX_TITLES: usize = 2;

/// A pane of the window. Each one is drawn by a function in `panels`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pane {
    /// What the case consists of, and what is missing.
    Case,
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
    /// What was found after a collision, as the reconstruction takes it.
    Evidence,
    /// The evidence from above, with the paths that go with it.
    ReconstructedScene,
    /// What the evidence says of the speeds before the impact.
    Speeds,
    /// The variants of the case side by side.
    Variants,
    /// Models in use, work under way, and what has been finished.
    Models,
    /// The training of either network.
    Training,
    /// The evaluation of the force network on a data set.
    Evaluation,
    /// The comparison of response models.
    ModelComparison,
    /// Settings and sections of the report.
    Report,
    /// The report as it will be written.
    ReportPages,
}

impl Pane {
    /// Every pane, in the order of the menu.
    pub const ALL: [Self; 21] = [
        Self::Case,
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
        Self::Evidence,
        Self::ReconstructedScene,
        Self::Speeds,
        Self::Variants,
        Self::Models,
        Self::Training,
        Self::Evaluation,
        Self::ModelComparison,
        Self::Report,
        Self::ReportPages,
    ];

    /// Whether the pane shows nothing but the simulation of the subject.
    fn is_answer(self) -> bool {
        matches!(self, Self::Scene | Self::Motion | Self::Force | Self::Comparison)
    }

    /// Returns the title of the pane.
    pub fn title(self) -> &'static str {
        match self {
            Self::Case => "Contents",
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
            Self::Evidence => "Evidence",
            Self::ReconstructedScene => "Reconstructed scene",
            Self::Speeds => "Speeds",
            Self::Variants => "Variants",
            Self::Models => "Models",
            Self::Training => "Training",
            Self::Evaluation => "Force evaluation",
            Self::ModelComparison => "Compare models",
            Self::Report => "Report",
            Self::ReportPages => "Report text",
        }
    }

    /// The icon beside the title.
    pub fn icon(self) -> Icon {
        match self {
            Self::Case => Icon::ListTree,
            Self::Data => Icon::Database,
            Self::Cases => Icon::Table2,
            Self::Vehicle => Icon::Car,
            Self::Scenario => Icon::Zap,
            Self::Scene => Icon::Map,
            Self::Motion => Icon::ChartLine,
            Self::Force => Icon::Activity,
            Self::Comparison => Icon::GitCompare,
            Self::ForcePrediction => Icon::ChartSpline,
            Self::MotionForecast => Icon::Route,
            Self::Evidence => Icon::ClipboardList,
            Self::ReconstructedScene => Icon::MapPin,
            Self::Speeds => Icon::Sigma,
            Self::Variants => Icon::Layers,
            Self::Models => Icon::BrainCircuit,
            Self::Training => Icon::GraduationCap,
            Self::Evaluation => Icon::Gauge,
            Self::ModelComparison => Icon::ChartBar,
            Self::Report => Icon::FileText,
            Self::ReportPages => Icon::BookOpen,
        }
    }
}

/// The context in which the panes are drawn: the parts of the state, and the list of commands.
pub struct PaneContext<'a> {
    /// What the user works on. Panes edit their own settings in it.
    pub project: &'a mut Project,
    /// How the project is shown. The layout of the workspace that is shown is empty while the panes are drawn.
    pub view: &'a mut View,
    /// Loaded data, answers and running work.
    pub session: &'a mut Session,
    /// The two cursors of the figures over time.
    pub between: BetweenCursors,
    /// The variants of the case with their answers.
    pub variants: Vec<AnsweredVariant>,
    /// What the case consists of.
    pub contents: Vec<ContentsEntry>,
    /// The commands that the panes add.
    pub commands: &'a mut Vec<Command>,
}

impl Behavior<Pane> for PaneContext<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let frame = egui::Frame::new().inner_margin(looks::MARGIN);
        let is_late = pane.is_answer() && self.session.is_simulation_late();
        frame.show(ui, |ui| {
            panels::faded(ui, is_late, |ui| match pane {
                Pane::Case => panels::contents_ui(ui, self),
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
                Pane::Evidence => panels::evidence_ui(ui, self),
                Pane::ReconstructedScene => panels::reconstructed_scene_ui(ui, self),
                Pane::Speeds => panels::speeds_ui(ui, self),
                Pane::Variants => panels::variants_ui(ui, self),
                Pane::Models => panels::models_ui(ui, self),
                Pane::Training => panels::training_ui(ui, self),
                Pane::Evaluation => panels::evaluation_ui(ui, self),
                Pane::ModelComparison => panels::model_comparison_ui(ui, self),
                Pane::Report => panels::report_ui(ui, self),
                Pane::ReportPages => panels::report_pages_ui(ui, self),
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
