//! What of the state is saved beside the project: the subject, and how everything is shown.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::app::atlas::AtlasView;
use crate::app::case::TrustedCase;
use crate::app::force::ForceView;
use crate::app::import::ColumnMaps;
use crate::app::network::Network;
use crate::app::reconstruction::ReconstructionView;
use crate::app::report::ReportView;
use crate::app::response::ResponseView;
use crate::app::scene::SceneSettings;
use crate::app::source::Source;
use crate::app::sweep::SweepView;
use crate::app::workspaces::Workspaces;
use impactlab_core::data::{Channel, DatasetKind};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::MOTION_CHANNELS;

/// The case, file or scenario that is shown and simulated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Subject {
    /// A case of a data set.
    Case {
        /// Folder of the data set.
        dataset: PathBuf,
        /// Name of the case.
        case: String,
    },
    /// A single file, by its path.
    File(PathBuf),
    /// A start without any file, which only the command line makes.
    Manoeuvre,
    /// The scenario in the scenario pane.
    Scenario,
}

impl Subject {
    /// Whether it leaves open what happens to the wheels after the impact.
    pub(in crate::app) fn takes_ending(&self, sources: &[Source]) -> bool {
        match self {
            Self::Case { dataset, .. } => {
                let source = sources.iter().find(|source| source.path == *dataset);
                let kind = source.and_then(Source::dataset).map(|checked| checked.dataset.kind);
                kind == Some(DatasetKind::Force)
            }
            Self::File(_) | Self::Manoeuvre => true,
            Self::Scenario => false,
        }
    }
}

/// How the project is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct View {
    /// The system of units in which all quantities are shown.
    pub units: UnitSystem,
    /// Whether the theme is dark.
    pub dark: bool,
    /// Filter of the case table, as the user typed it.
    pub filter: String,
    /// Key of the column by which the cases are sorted; `None` keeps the order of the data set.
    pub sort_column: Option<String>,
    /// Whether the sorting is reversed, so that the largest number comes first.
    pub sort_descending: bool,
    /// Folder of the data set whose cases are listed.
    pub listed: Option<PathBuf>,
    /// How the force network is shown.
    pub force: ForceView,
    /// How the response network is shown.
    pub response: ResponseView,
    /// How the reconstruction is shown.
    pub reconstruction: ReconstructionView,
    /// How reports are written.
    pub report: ReportView,
    /// Which map of an atlas is shown.
    pub atlas: AtlasView,
    /// Which sweep is worked on.
    pub sweep: SweepView,
    /// The network that the training pane shows.
    pub trained: Network,
    /// The cases that were opened or saved last, the latest first.
    pub recent: Vec<PathBuf>,
    /// The cases that may do more than read files in their own folder.
    pub trusted: Vec<TrustedCase>,
    /// The column maps of earlier files, by their headers.
    pub column_maps: ColumnMaps,
    /// Seconds of the motion that are played in a second.
    pub playback_speed: f64,
    /// The curves of the motion pane.
    pub motion_channels: Vec<Channel>,
    /// Whether the answers of all variants are shown, not only those of the one in the forms.
    pub shows_all_variants: bool,
    /// From where the scene is seen.
    pub scene: SceneSettings,
    /// The arrangement of the panes in each workspace.
    pub workspaces: Workspaces,
}

impl Default for View {
    fn default() -> Self {
        Self {
            units: UnitSystem::default(),
            dark: false,
            filter: String::new(),
            sort_column: None,
            sort_descending: false,
            listed: None,
            force: ForceView::default(),
            response: ResponseView::default(),
            reconstruction: ReconstructionView::default(),
            report: ReportView::default(),
            atlas: AtlasView::default(),
            sweep: SweepView::default(),
            trained: Network::default(),
            recent: Vec::new(),
            trusted: Vec::new(),
            column_maps: ColumnMaps::default(),
            playback_speed: 1.0,
            motion_channels: MOTION_CHANNELS.to_vec(),
            shows_all_variants: true,
            scene: SceneSettings::default(),
            workspaces: Workspaces::default(),
        }
    }
}
