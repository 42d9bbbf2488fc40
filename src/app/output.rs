//! What the user can have written to a file or a folder.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::export::SceneExport;
use crate::app::network::Network;
use impactlab_core::vehicle::DataSheet;
use impactlab_document::figure::Figure;
use impactlab_document::report::ReportDocument;
use impactlab_draw::film::Film;
use impactlab_draw::scene::ScenePicture;
use impactlab_reconstruct::evidence::Evidence;
use impactlab_study::MODEL_ENDING;
use impactlab_study::case_file::{CASE_ENDING, file_stem};

/// What is written to a file or a folder.
#[derive(Debug, Clone)]
pub enum Output {
    /// A figure, as PNG; as CSV if the path ends in `.csv`.
    Picture(Box<Figure>),
    /// The numbers of a figure, as CSV.
    Numbers(Box<Figure>),
    /// A scene as it is seen, as PNG.
    ScenePicture(Box<ScenePicture>),
    /// A scene for another program.
    Exchange(Box<SceneExport>),
    /// A film of a scene, as MP4, which is made in the background.
    Film(Box<Film>),
    /// The scenario of the scenario pane, as TOML.
    Scenario,
    /// A vehicle, as TOML.
    Vehicle(Box<DataSheet>),
    /// The evidence of a reconstruction, as TOML.
    Evidence(Box<Evidence>),
    /// The ground as a site file, which becomes that of the project.
    Site,
    /// The current model of a network.
    Model(Network),
    /// A copy of a kept model.
    Archived(Network, PathBuf),
    /// A folder with the comparison that is shown.
    Comparison,
    /// The case, whose own file it becomes.
    Case,
    /// One zip of the case and all its files.
    PackedCase,
    /// A report, in the format of the ending.
    Report(Arc<ReportDocument>),
    /// The plan of the shipped atlas, as a start for one's own.
    ExamplePlan,
    /// The chunks of the sweep in one table.
    SweepRows,
}

impl Output {
    /// What the user is asked for, and what such files are called.
    pub(in crate::app) fn texts(&self) -> [&'static str; 2] {
        match self {
            Self::Picture(_) | Self::ScenePicture(_) => ["Save the picture", "picture"],
            Self::Numbers(_) => ["Save the numbers", "table"],
            Self::Exchange(_) => ["Save the scene", "scene"],
            Self::Film(_) => ["Save the film", "film"],
            Self::Scenario => ["Save the scenario", "scenario"],
            Self::Vehicle(_) => ["Save the vehicle", "vehicle"],
            Self::Evidence(_) => ["Save the evidence", "evidence"],
            Self::Site => ["Save the site", "site file"],
            Self::Model(_) | Self::Archived(..) => ["Save the model", "model"],
            Self::Comparison => ["A folder for the comparison", "folder"],
            Self::Case => ["Save the case", "case"],
            Self::PackedCase => ["Pack the case and its files", "package"],
            Self::Report(_) => ["Save the report (.pdf, .md or .json)", "report"],
            Self::ExamplePlan => ["Save the example plan", "plan"],
            Self::SweepRows => ["Merge the chunks of the sweep", "table"],
        }
    }

    /// The endings that the file may have, the usual one first; none for a folder.
    pub(in crate::app) fn endings(&self) -> Vec<&'static str> {
        match self {
            Self::Picture(_) | Self::ScenePicture(_) => vec!["png"],
            Self::Numbers(_) => vec!["csv"],
            Self::Exchange(of) => vec![of.format.ending()],
            Self::Film(_) => vec!["mp4"],
            Self::Scenario
            | Self::Vehicle(_)
            | Self::Evidence(_)
            | Self::Site
            | Self::ExamplePlan => vec!["toml"],
            Self::Model(_) | Self::Archived(..) => vec![MODEL_ENDING],
            Self::Comparison => Vec::new(),
            Self::Case => vec![CASE_ENDING],
            Self::PackedCase => vec!["zip"],
            Self::Report(_) => vec!["pdf", "md", "json"],
            Self::SweepRows => vec!["parquet"],
        }
    }

    /// The name that is proposed.
    pub(in crate::app) fn usual_name(&self) -> String {
        let stem = match self {
            Self::Picture(figure) | Self::Numbers(figure) => file_stem(&figure.title),
            Self::ScenePicture(picture) => file_stem(&picture.title()),
            Self::Exchange(of) => file_stem(&of.scene.title),
            Self::Film(film) => file_stem(&film.picture.scene.title),
            Self::Scenario => "scenario".to_owned(),
            Self::Vehicle(sheet) => file_stem(&sheet.name),
            Self::Evidence(evidence) => file_stem(&evidence.case),
            Self::Site => "site".to_owned(),
            Self::Model(network) | Self::Archived(network, _) => network.stem().to_owned(),
            Self::Comparison => "comparison".to_owned(),
            Self::Case | Self::PackedCase => "case".to_owned(),
            Self::Report(document) => file_stem(&document.title),
            Self::ExamplePlan => "plan".to_owned(),
            Self::SweepRows => "rows".to_owned(),
        };
        let ending = self.endings().first().map(|ending| format!(".{ending}"));
        stem + &ending.unwrap_or_default()
    }

    /// Whether it is a figure or a scene that is not of what is asked any more.
    pub(in crate::app) fn is_outdated(&self) -> bool {
        match self {
            Self::Picture(figure) | Self::Numbers(figure) => figure.caveats.is_outdated(),
            Self::ScenePicture(picture) => picture.scene.caveats.is_outdated(),
            Self::Exchange(export) => export.scene.caveats.is_outdated(),
            _ => false,
        }
    }
}
