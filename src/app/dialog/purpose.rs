//! What the user is asked for a path for.

use crate::app::output::Output;

/// The purpose for which the user is asked for a path.
#[derive(Debug, Clone)]
pub enum Purpose {
    /// A data set or a folder of data sets to open.
    Folder,
    /// Single files to open.
    Files,
    /// A site file or an orthophoto to open.
    Ground,
    /// A model file to open.
    OpenModel,
    /// A `comparison.json` file to open.
    OpenComparison,
    /// An atlas to open.
    OpenAtlas,
    /// The plan of a sweep to open.
    OpenPlan,
    /// The folder of a sweep.
    SweepFolder,
    /// A file or a folder that is written.
    Save(Output),
}

impl Purpose {
    /// What is asked for.
    pub(in crate::app) fn title(&self) -> &'static str {
        match self {
            Self::Folder => "Open a data set",
            Self::Files => "Open files",
            Self::Ground => "Open a site",
            Self::OpenModel => "Open a model",
            Self::OpenComparison => "Open a comparison",
            Self::OpenAtlas => "Open an atlas",
            Self::OpenPlan => "Open the plan of a sweep",
            Self::SweepFolder => "A folder for the sweep",
            Self::Save(output) => output.texts()[0],
        }
    }

    /// What is written at the path, if anything is.
    pub(in crate::app) fn output(&self) -> Option<&Output> {
        match self {
            Self::Save(output) => Some(output),
            _ => None,
        }
    }
}
