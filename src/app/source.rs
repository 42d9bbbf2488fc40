//! What is open: loaded in the background, checked, and kept with its problems.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::data::{
    ColumnMap, DataError, Dataset, DatasetKind, FileKind, Flag, Loaded, Opened, Outcome,
    check_case, check_series, open, read_series,
};
use crate::error_chain;
use crate::jobs::Job;
use crate::vehicle::VehicleParameters;

/// Something that was opened.
pub struct Source {
    /// The path that the user opened; several sources may come from one folder.
    pub opened: PathBuf,
    /// The path of the dataset or file itself.
    pub path: PathBuf,
    /// What it holds.
    pub content: Content,
}

/// What a source holds.
pub enum Content {
    /// Not known yet.
    Loading(Job<Result<Vec<(PathBuf, Content)>, OpenError>>),
    /// A dataset.
    Dataset(Arc<CheckedDataset>),
    /// A single file.
    File(Arc<CheckedFile>),
    /// Nothing: why.
    Failed(String),
}

/// A dataset with its checks and its vehicle.
pub struct CheckedDataset {
    /// The data.
    pub dataset: Dataset,
    /// Flags of each case.
    pub flags: Vec<Vec<Flag>>,
    /// What its `vehicle.toml` says; `None` without one.
    pub vehicle: Option<Result<VehicleParameters, String>>,
}

/// A dataset that is open.
#[derive(Clone, Copy)]
pub struct OpenDataset<'a> {
    /// Its folder.
    pub path: &'a Path,
    /// What was read of it.
    pub checked: &'a Arc<CheckedDataset>,
}

/// The datasets of a kind that are open, in the order of the sources.
pub fn open_datasets(sources: &[Source], kind: DatasetKind) -> Vec<OpenDataset<'_>> {
    let datasets = sources
        .iter()
        .filter_map(|source| Some(OpenDataset { path: &source.path, checked: source.dataset()? }));
    datasets.filter(|of| of.checked.dataset.kind == kind).collect()
}

/// The wanted one of the datasets, or else the first.
pub fn chosen_dataset<'a>(
    datasets: &[OpenDataset<'a>],
    wanted: Option<&Path>,
) -> Option<OpenDataset<'a>> {
    let chosen = datasets.iter().find(|of| Some(of.path) == wanted);
    chosen.or(datasets.first()).copied()
}

/// A single file with its checks.
pub struct CheckedFile {
    /// The data.
    pub loaded: Loaded,
    /// Its flags.
    pub flags: Vec<Flag>,
}

/// Why something could not be opened.
pub struct OpenError {
    /// For the user.
    pub text: String,
    /// Whether saying which column is which would help.
    pub needs_mapping: bool,
}

impl Source {
    /// Starts loading a path.
    pub fn load(path: PathBuf, wake: impl Fn() + Send + 'static) -> Self {
        let target = path.clone();
        let job = Job::spawn("load", wake, move |report| {
            let opened = open(&target, report).map_err(OpenError::from)?;
            Ok(match opened {
                Outcome::Cancelled => Vec::new(),
                Outcome::Complete(opened) => contents(&target, opened),
            })
        });
        match job {
            Ok(job) => Self { opened: path.clone(), path, content: Content::Loading(job) },
            Err(error) => Self::failed(path, error.to_string()),
        }
    }

    /// Starts loading a file with the user's own columns.
    pub fn load_mapped(
        path: PathBuf,
        kind: FileKind,
        map: ColumnMap,
        wake: impl Fn() + Send + 'static,
    ) -> Self {
        let target = path.clone();
        let job = Job::spawn("load", wake, move |_| {
            let loaded = read_series(&target, Some(&map), kind).map_err(OpenError::from)?;
            Ok(vec![(target.clone(), checked_file(loaded))])
        });
        match job {
            Ok(job) => Self { opened: path.clone(), path, content: Content::Loading(job) },
            Err(error) => Self::failed(path, error.to_string()),
        }
    }

    /// A source that could not be opened.
    pub fn failed(path: PathBuf, why: String) -> Self {
        Self { opened: path.clone(), path, content: Content::Failed(why) }
    }

    /// The last part of its path.
    pub fn name(&self) -> String {
        last_part(&self.path)
    }

    /// The dataset, if it is one.
    pub fn dataset(&self) -> Option<&Arc<CheckedDataset>> {
        match &self.content {
            Content::Dataset(dataset) => Some(dataset),
            _ => None,
        }
    }
}

impl OpenDataset<'_> {
    /// The last part of its path.
    pub fn name(&self) -> String {
        last_part(self.path)
    }
}

fn last_part(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn contents(path: &Path, opened: Opened) -> Vec<(PathBuf, Content)> {
    match opened {
        Opened::Dataset(dataset) => vec![checked_dataset(dataset)],
        Opened::File(loaded) => vec![(path.to_owned(), checked_file(loaded))],
        Opened::Collection { datasets, problems } => {
            let failed =
                |problem: DataError| (path.to_owned(), Content::Failed(error_chain(&problem)));
            let datasets = datasets.into_iter().map(checked_dataset);
            datasets.chain(problems.into_iter().map(failed)).collect()
        }
    }
}

fn checked_dataset(dataset: Dataset) -> (PathBuf, Content) {
    let flags = dataset.cases.iter().map(check_case).collect();
    let load = |path: &PathBuf| VehicleParameters::load(path).map_err(|error| error_chain(&error));
    let vehicle = dataset.vehicle_file.as_ref().map(load);
    let path = dataset.root.clone();
    (path, Content::Dataset(Arc::new(CheckedDataset { dataset, flags, vehicle })))
}

fn checked_file(loaded: Loaded) -> Content {
    let flags = check_series(&loaded.series, loaded.force_sampling());
    Content::File(Arc::new(CheckedFile { loaded, flags }))
}

impl From<DataError> for OpenError {
    fn from(error: DataError) -> Self {
        Self { needs_mapping: error.needs_mapping(), text: error_chain(&error) }
    }
}
