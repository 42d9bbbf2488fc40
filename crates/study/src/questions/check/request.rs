//! What is in files and data sets, and what is wrong with them: `check`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::question::progress_of;
use crate::{
    Answer, CheckReport, DatasetReport, FileReport, InputError, InputFile, InputFileReport,
    InputKind, Library, Observer, PathProblem, ProposedColumn, Provenance, Question, StudyError,
};
use impactlab_core::data::{
    ColumnMap, DataError, Dataset, Flag, Loaded, Opened, Outcome, check_case, check_file,
    list_folder, open, propose_columns, read_any_series,
};
use impactlab_core::error_chain;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::vehicle::VehicleParameters;

/// Asks what is in files and data sets, in which units, and what is wrong with them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckRequest {
    /// Data sets, folders of data sets, files of time series, scenarios, vehicles.
    pub paths: Vec<PathBuf>,
    /// Whether cases without a flag are listed, too.
    #[serde(default)]
    pub all: bool,
    /// For single files, which column is what.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<ColumnMap>,
}

/// What was found, and the data themselves.
#[derive(Debug)]
pub struct CheckAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<CheckReport>,
    /// The data that could be read.
    pub items: Vec<CheckedItem>,
}

/// A data set or file that could be read.
#[derive(Debug)]
pub struct CheckedItem {
    /// Its path.
    pub path: PathBuf,
    /// Its content.
    pub content: CheckedContent,
}

/// Data with what was found in them.
#[derive(Debug, Clone)]
pub enum CheckedContent {
    /// A data set.
    Dataset(Arc<CheckedDataset>),
    /// A file of time series.
    File(Arc<CheckedFile>),
}

/// A data set with the results of its check.
#[derive(Debug)]
pub struct CheckedDataset {
    /// The data.
    pub dataset: Arc<Dataset>,
    /// Flags of each case, in the order of the cases.
    pub flags: Vec<Vec<Flag>>,
    /// Name of the vehicle in the `vehicle.toml` of the data set, or the reason why the file cannot
    /// be read; `None` if the data set has no such file.
    pub vehicle: Option<Result<String, String>>,
}

/// A single file with the results of its check.
#[derive(Debug)]
pub struct CheckedFile {
    /// The data.
    pub loaded: Arc<Loaded>,
    /// Flags that the check raised for the file.
    pub flags: Vec<Flag>,
}

impl Question for CheckRequest {
    type Answer = CheckAnswer;
    type Report = Answer<CheckReport>;
    const NAME: &'static str = "check";

    fn check(&self) -> Result<(), StudyError> {
        Ok(())
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn has_problems(report: &Self::Report) -> bool {
        !report.ok
    }

    fn solve(
        &self,
        _library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<CheckAnswer>, StudyError> {
        let (mut report, mut all) = (CheckReport::default(), Vec::new());
        for path in &self.paths {
            let kind = InputKind::from_path(path);
            if !kind.is_data() {
                report.add_input_file(path, kind);
                continue;
            }
            if self.map.is_some() && path.is_dir() {
                return Err(StudyError::MapOfFolder { path: path.clone() });
            }
            match check_path(path, self.map.as_ref(), observer) {
                Ok(Outcome::Cancelled) => return Ok(Outcome::Cancelled),
                Ok(Outcome::Complete((items, problems))) => {
                    report.add(&items, self.all);
                    let map = self.map.as_ref();
                    let problems = problems.iter().map(|error| problem(path, kind, error, map));
                    report.problems.extend(problems);
                    for pairs in pairs_within(path) {
                        report.add_input_file(&pairs, InputKind::Pairs);
                    }
                    all.extend(items);
                }
                Err(error) => {
                    report.problems.push(problem(path, kind, &error, self.map.as_ref()));
                }
            }
        }
        report.ok = !report.has_problems();
        let (caveats, provenance) = (Caveats::default(), Provenance::default());
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(CheckAnswer { report, items: all }))
    }
}

/// The data sets of recorded pairs directly in a folder, in the order of their names.
fn pairs_within(path: &Path) -> Vec<PathBuf> {
    let inside = if path.is_dir() { list_folder(path).unwrap_or_default() } else { Vec::new() };
    let mut found: Vec<PathBuf> =
        inside.into_iter().filter(|path| InputKind::from_path(path) == InputKind::Pairs).collect();
    found.sort();
    found
}

/// What a path holds, checked, and why parts of a folder of data sets cannot be read.
type Checked = (Vec<CheckedItem>, Vec<DataError>);

/// Reads and checks a data set, a folder of data sets or a file of time series.
///
/// # Errors
/// [`DataError`], with the place in the file and what to do.
pub fn check_path(
    path: &Path,
    map: Option<&ColumnMap>,
    observer: &mut Observer<'_>,
) -> Result<Outcome<Checked>, DataError> {
    let opened = match map {
        Some(_) => Outcome::Complete(Opened::File(read_any_series(path, map)?)),
        None => open(path, &mut progress_of(observer))?,
    };
    Ok(opened.map(|opened| match opened {
        Opened::Dataset(dataset) => (vec![checked_dataset(dataset)], Vec::new()),
        Opened::Collection { datasets, problems } => {
            (datasets.into_iter().map(checked_dataset).collect(), problems)
        }
        Opened::File(loaded) => (vec![checked_file(path, loaded)], Vec::new()),
    }))
}

fn checked_dataset(dataset: Dataset) -> CheckedItem {
    let flags = dataset.cases.par_iter().map(check_case).collect();
    let name = |path: &PathBuf| match VehicleParameters::load(path) {
        Ok(vehicle) => Ok(vehicle.name),
        Err(error) => Err(error_chain(&error)),
    };
    let vehicle = dataset.vehicle_file.as_ref().map(name);
    let path = dataset.root.clone();
    let checked = CheckedDataset { dataset: Arc::new(dataset), flags, vehicle };
    CheckedItem { path, content: CheckedContent::Dataset(Arc::new(checked)) }
}

fn checked_file(path: &Path, loaded: Loaded) -> CheckedItem {
    let checked = CheckedFile { flags: check_file(&loaded), loaded: Arc::new(loaded) };
    CheckedItem { path: path.to_owned(), content: CheckedContent::File(Arc::new(checked)) }
}

impl CheckReport {
    fn add(&mut self, items: &[CheckedItem], all: bool) {
        for item in items {
            match &item.content {
                CheckedContent::Dataset(checked) => {
                    self.datasets.push(DatasetReport::new(&checked.dataset, &checked.flags, all));
                }
                CheckedContent::File(checked) => {
                    self.files.push(FileReport::new(&item.path, &checked.loaded, &checked.flags));
                }
            }
        }
    }

    fn add_input_file(&mut self, path: &Path, kind: InputKind) {
        let summary = |file: InputFile| {
            Ok(InputFileReport {
                path: path.to_owned(),
                kind,
                name: file.name(path),
                contents: file.contents(kind)?,
                unused: file.unused(),
            })
        };
        match InputFile::load_as(path, kind).and_then(summary) {
            Ok(report) => self.models.push(report),
            Err(error) => self.problems.push(PathProblem {
                path: path.to_owned(),
                kind,
                message: error.to_string(),
                columns: None,
                map: None,
            }),
        }
    }
}

/// A path that cannot be read; if its columns are the reason, with what they look like. An open question
/// comes with its answer instead.
///
/// - `map`: what says where the columns stand, such as in which sheet.
fn problem(
    path: &Path,
    kind: InputKind,
    error: &DataError,
    map: Option<&ColumnMap>,
) -> PathProblem {
    let is_about_columns = error.needs_mapping() || matches!(error, DataError::NoSuchColumn { .. });
    let is_about_columns = is_about_columns && error.answer().is_none();
    let settings = map.map(|map| map.settings.as_ref().clone()).unwrap_or_default();
    let columns = is_about_columns.then(|| propose_columns(path, &settings).ok()).flatten();
    PathProblem {
        path: path.to_owned(),
        kind,
        message: match path.exists() {
            true => InputError::new(kind, error).to_string(),
            false => error_chain(error),
        },
        map: match error.answer() {
            Some(answer) => Some(answer.to_string()),
            None => columns.as_deref().and_then(|columns| ProposedColumn::map(columns, &settings)),
        },
        columns: columns.map(|columns| columns.iter().map(ProposedColumn::from_proposal).collect()),
    }
}
