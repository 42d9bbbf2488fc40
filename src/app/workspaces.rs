//! The workspaces: for each job of the analyst, an arrangement of panes that the user can change.

use egui::Id;
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

use crate::app::looks::Icon;
use crate::app::panes::Pane;

/// An arrangement of panes.
pub type Layout = Tree<Pane>;

/// A job of the analyst.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr,
)]
pub enum Workspace {
    /// Build a case and see where the struck vehicle goes.
    #[default]
    Case,
    /// Go from the evidence of a collision back to the speeds before it.
    Reconstruct,
    /// Look through data sets and recordings.
    Data,
    /// Train, evaluate and compare the networks.
    Models,
    /// Make the report of the case.
    Report,
    /// Look outcomes up on a map of many runs, and make many runs.
    Atlas,
}

impl Workspace {
    /// Every workspace, in the order in which they are offered.
    pub const ALL: [Self; 6] =
        [Self::Case, Self::Reconstruct, Self::Data, Self::Models, Self::Report, Self::Atlas];

    /// The name that is shown.
    pub fn title(self) -> &'static str {
        self.into()
    }

    /// The icon beside its name.
    pub fn icon(self) -> Icon {
        match self {
            Self::Case => Icon::CarFront,
            Self::Reconstruct => Icon::History,
            Self::Data => Icon::Database,
            Self::Models => Icon::BrainCircuit,
            Self::Report => Icon::FileText,
            Self::Atlas => Icon::Grid3x3,
        }
    }

    /// What it is for.
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Case => "Build a case and see where the struck vehicle goes",
            Self::Reconstruct => "Go from the evidence of a collision to the speeds before it",
            Self::Data => "Look through data sets and recordings, and compare them with the model",
            Self::Models => "Train, evaluate and compare the networks",
            Self::Report => "Make the report of the case, as PDF, Markdown or JSON",
            Self::Atlas => "See on a map how often a PIT spins a car, and compute many runs",
        }
    }

    /// The panes as they stand before the user has moved any.
    pub fn default_layout(self) -> Layout {
        match self {
            Self::Case => case_layout(),
            Self::Reconstruct => reconstruct_layout(),
            Self::Data => data_layout(),
            Self::Models => models_layout(),
            Self::Report => report_layout(),
            Self::Atlas => atlas_layout(),
        }
    }
}

/// The arrangement of all workspaces and which of them is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Workspaces {
    /// The workspace that is shown.
    pub shown: Workspace,
    case: Layout,
    reconstruct: Layout,
    data: Layout,
    models: Layout,
    report: Layout,
    atlas: Layout,
}

impl Default for Workspaces {
    fn default() -> Self {
        let [case, reconstruct, data, models, report, atlas] =
            Workspace::ALL.map(Workspace::default_layout);
        Self { shown: Workspace::default(), case, reconstruct, data, models, report, atlas }
    }
}

impl Workspaces {
    /// The arrangement of a workspace.
    pub fn layout(&self, workspace: Workspace) -> &Layout {
        match workspace {
            Workspace::Case => &self.case,
            Workspace::Reconstruct => &self.reconstruct,
            Workspace::Data => &self.data,
            Workspace::Models => &self.models,
            Workspace::Report => &self.report,
            Workspace::Atlas => &self.atlas,
        }
    }

    /// The same, to be changed.
    pub fn layout_mut(&mut self, workspace: Workspace) -> &mut Layout {
        match workspace {
            Workspace::Case => &mut self.case,
            Workspace::Reconstruct => &mut self.reconstruct,
            Workspace::Data => &mut self.data,
            Workspace::Models => &mut self.models,
            Workspace::Report => &mut self.report,
            Workspace::Atlas => &mut self.atlas,
        }
    }

    /// Brings a pane to the front: in the workspace that is shown if it has the pane, else in the first
    /// that has it, which is shown then.
    pub fn show_pane(&mut self, pane: Pane) {
        let mut order = vec![self.shown];
        order.extend(Workspace::ALL.into_iter().filter(|other| *other != self.shown));
        let Some(workspace) = order.into_iter().find(|of| has_pane(self.layout(*of), pane)) else {
            return;
        };
        self.shown = workspace;
        self.layout_mut(workspace)
            .make_active(|_, tile| matches!(tile, Tile::Pane(other) if *other == pane));
    }

    /// Puts the panes of the workspace that is shown back to where they stood at first.
    pub fn reset_shown(&mut self) {
        *self.layout_mut(self.shown) = self.shown.default_layout();
    }

    /// Puts back every arrangement that lacks a pane, because it was saved before the pane was added.
    pub fn complete(&mut self) {
        for workspace in Workspace::ALL {
            let default = workspace.default_layout();
            let layout = self.layout_mut(workspace);
            if Pane::ALL.iter().any(|&pane| has_pane(&default, pane) && !has_pane(layout, pane)) {
                *layout = default;
            }
        }
    }
}

/// Whether an arrangement has a pane.
fn has_pane(layout: &Layout, pane: Pane) -> bool {
    let mut tiles = layout.tiles.tiles();
    tiles.any(|tile| matches!(tile, Tile::Pane(other) if *other == pane))
}

/// Puts panes together from the parts to the whole.
struct Builder(Tiles<Pane>);

impl Builder {
    fn tabs(&mut self, panes: &[Pane]) -> TileId {
        let tiles = panes.iter().map(|&pane| self.0.insert_pane(pane)).collect();
        self.0.insert_tab_tile(tiles)
    }

    /// Parts in a row or one below the other, each with its share of the space.
    fn linear(&mut self, direction: LinearDir, parts: &[(TileId, f32)]) -> TileId {
        let mut linear = Linear::new(direction, parts.iter().map(|(tile, _)| *tile).collect());
        for (tile, share) in parts {
            linear.shares.set_share(*tile, *share);
        }
        self.0.insert_new(Tile::Container(Container::Linear(linear)))
    }

    /// A part in tabs with panes that need its whole space.
    fn beside(&mut self, part: TileId, panes: &[Pane]) -> TileId {
        let panes: Vec<_> = panes.iter().map(|&pane| self.0.insert_pane(pane)).collect();
        self.0.insert_tab_tile(std::iter::once(part).chain(panes).collect())
    }

    fn layout(self, id: &str, root: TileId) -> Layout {
        Tree::new(Id::unique(id), root, self.0)
    }
}

/// The case as a tree at the left, scene and plots in the middle, and at the right the forms of what is
/// selected in the tree.
fn case_layout() -> Layout {
    let mut build = Builder(Tiles::default());
    let tree = build.tabs(&[Pane::Case]);
    let scene = build.tabs(&[Pane::Scene]);
    let plots = build.tabs(&[Pane::Motion, Pane::Force, Pane::Comparison]);
    let forms = build.tabs(&[Pane::Scenario, Pane::Vehicle]);
    let shown = build.linear(LinearDir::Vertical, &[(scene, 0.55), (plots, 0.45)]);
    let others = [Pane::MotionForecast, Pane::ForcePrediction, Pane::Variants];
    let middle = build.beside(shown, &others);
    let parts = [(tree, 0.16), (middle, 0.59), (forms, 0.25)];
    let root = build.linear(LinearDir::Horizontal, &parts);
    build.layout("case panes", root)
}

/// The evidence at the left, the scene in the middle, the speeds at the right.
fn reconstruct_layout() -> Layout {
    let mut build = Builder(Tiles::default());
    let evidence = build.tabs(&[Pane::Evidence]);
    let scene = build.tabs(&[Pane::ReconstructedScene]);
    let speeds = build.tabs(&[Pane::Speeds, Pane::Hand, Pane::Replay]);
    let parts = [(evidence, 0.24), (scene, 0.34), (speeds, 0.42)];
    let root = build.linear(LinearDir::Horizontal, &parts);
    build.layout("reconstruction panes", root)
}

/// Data sets and their cases at the left, the plots of one case beside them.
fn data_layout() -> Layout {
    let mut build = Builder(Tiles::default());
    let data = build.tabs(&[Pane::Data]);
    let cases = build.tabs(&[Pane::Cases, Pane::Vehicle]);
    let scene = build.tabs(&[Pane::Scene]);
    let motion = build.tabs(&[Pane::Motion]);
    let force = build.tabs(&[Pane::Force]);
    let comparison = build.tabs(&[Pane::Comparison]);
    let left = build.linear(LinearDir::Vertical, &[(data, 0.32), (cases, 0.68)]);
    let middle = build.linear(LinearDir::Vertical, &[(scene, 0.45), (motion, 0.55)]);
    let right = build.linear(LinearDir::Vertical, &[(force, 0.5), (comparison, 0.5)]);
    let plots = build.linear(LinearDir::Horizontal, &[(middle, 0.62), (right, 0.38)]);
    let work = build.beside(plots, &[Pane::ForcePrediction, Pane::MotionForecast]);
    let root = build.linear(LinearDir::Horizontal, &[(left, 0.25), (work, 0.75)]);
    build.layout("data panes", root)
}

/// Training, evaluation and comparison of the networks, beside the data that they use.
fn models_layout() -> Layout {
    let mut build = Builder(Tiles::default());
    let data = build.tabs(&[Pane::Data]);
    let work = build.tabs(&[Pane::Models, Pane::Training, Pane::Evaluation, Pane::ModelComparison]);
    let root = build.linear(LinearDir::Horizontal, &[(data, 0.22), (work, 0.78)]);
    build.layout("model panes", root)
}

/// Settings and sections at the left, the report beside them.
fn report_layout() -> Layout {
    let mut build = Builder(Tiles::default());
    let settings = build.tabs(&[Pane::Report]);
    let pages = build.tabs(&[Pane::ReportPages]);
    let root = build.linear(LinearDir::Horizontal, &[(settings, 0.24), (pages, 0.76)]);
    build.layout("report panes", root)
}

/// What the map shows at the left, the map above what moves the outcome; sweeps in tabs with them.
fn atlas_layout() -> Layout {
    let mut build = Builder(Tiles::default());
    let choices = build.tabs(&[Pane::AtlasChoices]);
    let map = build.tabs(&[Pane::AtlasMap]);
    let sensitivity = build.tabs(&[Pane::Sensitivity]);
    let shown = build.linear(LinearDir::Vertical, &[(map, 0.72), (sensitivity, 0.28)]);
    let work = build.beside(shown, &[Pane::Sweep]);
    let root = build.linear(LinearDir::Horizontal, &[(choices, 0.24), (work, 0.76)]);
    build.layout("atlas panes", root)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pane_stands_in_a_workspace_and_is_found_there() {
        for &pane in Pane::ALL {
            let mut workspaces = Workspaces::default();
            workspaces.show_pane(pane);
            assert!(has_pane(workspaces.layout(workspaces.shown), pane), "{pane:?}");
        }
    }

    #[test]
    fn a_pane_of_the_workspace_that_is_shown_does_not_lead_away() {
        let mut workspaces = Workspaces { shown: Workspace::Data, ..Workspaces::default() };
        workspaces.show_pane(Pane::Scene);
        assert_eq!(workspaces.shown, Workspace::Data);
        workspaces.show_pane(Pane::Scenario);
        assert_eq!(workspaces.shown, Workspace::Case);
    }
}
