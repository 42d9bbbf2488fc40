//! What the user is asked for a path for.

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
use impactlab_study::case_file::file_stem;

/// The purpose for which the user is asked for a path.
#[derive(Debug, Clone)]
pub enum Purpose {
    /// A data set or a folder of data sets to open.
    Folder,
    /// Single files to open.
    Files,
    /// A PNG file for the picture of a figure.
    Picture(Box<Figure>),
    /// A PNG file for a scene as it is seen.
    ScenePicture(Box<ScenePicture>),
    /// A file of a scene for another program.
    Exchange(Box<SceneExport>),
    /// An MP4 file for a film of a scene.
    Film(Box<Film>),
    /// A CSV file for the numbers of a figure.
    Numbers(Box<Figure>),
    /// A TOML file for the scenario.
    Scenario,
    /// A TOML file for a vehicle.
    Vehicle(Box<DataSheet>),
    /// A TOML file for the evidence of a reconstruction.
    Evidence(Box<Evidence>),
    /// A site file or an orthophoto to open.
    Ground,
    /// A TOML file for the ground of the scene.
    Site,
    /// A model file to open.
    OpenModel,
    /// A file for the current model of a network.
    SaveModel(Network),
    /// A file for a copy of a kept model.
    SaveArchived(Network, PathBuf),
    /// A `comparison.json` file to open.
    OpenComparison,
    /// A folder for the comparison of response models.
    SaveComparison,
    /// A file for the case.
    SaveCase,
    /// A zip for the case and its files.
    PackCase,
    /// A file for a report, whose ending says the format.
    Report(Arc<ReportDocument>),
}

impl Purpose {
    /// What is asked for.
    pub(in crate::app) fn title(&self) -> &'static str {
        match self {
            Self::Folder => "Open a data set",
            Self::Files => "Open files",
            Self::Picture(_) | Self::ScenePicture(_) => "Save the picture",
            Self::Exchange(_) => "Save the scene",
            Self::Film(_) => "Save the film",
            Self::Numbers(_) => "Save the numbers",
            Self::Scenario => "Save the scenario",
            Self::Vehicle(_) => "Save the vehicle",
            Self::Evidence(_) => "Save the evidence",
            Self::Ground => "Open a ground",
            Self::Site => "Save the ground",
            Self::OpenModel => "Open a model",
            Self::SaveModel(_) | Self::SaveArchived(..) => "Save the model",
            Self::OpenComparison => "Open a comparison",
            Self::SaveComparison => "A folder for the comparison",
            Self::SaveCase => "Save the case",
            Self::PackCase => "Pack the case and its files",
            Self::Report(_) => "Save the report (.pdf, .md or .json)",
        }
    }

    /// The name that is proposed.
    pub(in crate::app) fn usual_name(&self) -> String {
        let fixed = match self {
            Self::Folder | Self::Files | Self::Ground | Self::OpenModel | Self::OpenComparison => {
                ""
            }
            Self::Site => "site.toml",
            Self::Picture(figure) => return file_stem(&figure.title) + ".png",
            Self::ScenePicture(picture) => return file_stem(&picture.title()) + ".png",
            Self::Exchange(of) => {
                return format!("{}.{}", file_stem(&of.scene.title), of.format.ending());
            }
            Self::Film(film) => return file_stem(&film.picture.scene.title) + ".mp4",
            Self::Numbers(figure) => return file_stem(&figure.title) + ".csv",
            Self::Scenario => "scenario.toml",
            Self::Vehicle(sheet) => return file_stem(&sheet.name) + ".toml",
            Self::Evidence(evidence) => return file_stem(&evidence.case) + ".toml",
            Self::SaveModel(network) | Self::SaveArchived(network, _) => network.file_name(),
            Self::SaveComparison => "comparison",
            Self::SaveCase => "case.impactlab",
            Self::PackCase => "case.zip",
            Self::Report(document) => return file_stem(&document.title) + ".pdf",
        };
        fixed.to_owned()
    }

    /// Whether something is written at the path.
    pub(in crate::app) fn writes(&self) -> bool {
        !matches!(
            self,
            Self::Folder | Self::Files | Self::Ground | Self::OpenModel | Self::OpenComparison
        )
    }
}
