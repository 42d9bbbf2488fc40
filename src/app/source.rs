//! The data that are open: loaded in the background, checked, and kept with the problems found in
//! them.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::import::{ColumnMaps, fingerprint};
use crate::app::model::file_name;
use crate::app::question_job::Answered;
use impactlab_core::data::{ColumnMap, DatasetKind, Note, Outcome};
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_study::{
    CheckAnswer, CheckRequest, CheckedContent, CheckedDataset, CheckedFile, CheckedItem, Event,
    Library, Observer, PathProblem, Question, SeriesFile,
};

/// A data set or a file that the user has opened.
pub struct Source {
    /// The path that the user opened. Opening one folder may give several sources.
    pub opened: PathBuf,
    /// The path of the data set or file itself.
    pub path: PathBuf,
    /// The columns that the user assigned, for a file whose header does not identify them.
    pub map: Option<ColumnMap>,
    /// The check of the opened path with its report; `None` until it is finished. Sources from one
    /// folder share it.
    pub check: Option<Arc<Answered<CheckRequest>>>,
    /// The data, or the reason why there are none.
    pub content: Content,
}

/// The content of a source.
#[derive(Clone)]
pub enum Content {
    /// The data are being loaded.
    Loading,
    /// A data set.
    Dataset(Arc<CheckedDataset>),
    /// A single file.
    File(Arc<CheckedFile>),
    /// The data could not be read, for the given reason.
    Failed(String),
}

/// A data set that is open, and its path.
#[derive(Clone, Copy)]
pub struct OpenDataset<'a> {
    /// The folder of the data set.
    pub path: &'a Path,
    /// The data set and its checks.
    pub checked: &'a Arc<CheckedDataset>,
}

/// Returns the open data sets of the given kinds, ordered by kind as in `kinds`, and within a kind
/// by the order of opening.
pub fn open_datasets<'a>(sources: &'a [Source], kinds: &[DatasetKind]) -> Vec<OpenDataset<'a>> {
    let of_kind = |kind: &DatasetKind| {
        let kind = *kind;
        let datasets = sources.iter().filter_map(|source| {
            Some(OpenDataset { path: &source.path, checked: source.dataset()? })
        });
        datasets.filter(move |of| of.checked.dataset.kind == kind)
    };
    kinds.iter().flat_map(of_kind).collect()
}

/// Returns the data set at the wanted path; if that one is not among them, the one in use, or else the
/// first.
///
/// - `in_use`: path of the data set whose cases are listed.
pub fn chosen_dataset<'a>(
    datasets: &[OpenDataset<'a>],
    wanted: &Path,
    in_use: Option<&Path>,
) -> Option<OpenDataset<'a>> {
    let at = |path: &Path| datasets.iter().find(|of| of.path == path);
    at(wanted).or_else(|| at(in_use?)).or(datasets.first()).copied()
}

/// The result of opening a path.
pub struct OpenedPath {
    /// The check of the path.
    check: Arc<Answered<CheckRequest>>,
    /// The data sets and files at the path, each with its own path, among them those that cannot be
    /// read.
    contents: Vec<(PathBuf, Content)>,
    /// The first problem, if nothing at the path can be read.
    pub failure: Option<PathProblem>,
    /// The map with which a file was read.
    pub map: Option<OpenedMap>,
    /// Whether a file was read, but units that it does not state were assumed or the velocities
    /// contradict the path, so that the user has to be asked.
    pub is_doubtful: bool,
}

/// The map with which a file was read.
pub struct OpenedMap {
    /// The map.
    pub map: ColumnMap,
    /// The digest of the header of the file.
    pub fingerprint: Option<String>,
    /// Whether it was chosen for an earlier file, or in an earlier run.
    pub is_remembered: bool,
}

impl Source {
    /// A source of a path that is being read.
    pub fn loading(path: PathBuf, map: Option<ColumnMap>) -> Self {
        Self { opened: path.clone(), path, map, check: None, content: Content::Loading }
    }

    /// Returns a source for a path that could not be opened.
    ///
    /// - `why`: reason, shown to the user.
    pub fn failed(path: PathBuf, why: String) -> Self {
        let content = Content::Failed(why);
        Self { opened: path.clone(), path, map: None, check: None, content }
    }

    /// Returns the sources found at the path once it has been read, and puts their data into the
    /// library. A file with columns that the user assigned is not put there, because the library
    /// identifies files by their path alone.
    pub fn opened(&self, found: &OpenedPath, library: &Library) -> Vec<Self> {
        let map = found.map.as_ref().map(|map| map.map.clone());
        let source = |(path, content): &(PathBuf, Content)| {
            match content {
                Content::Dataset(checked) => library.hold_dataset(Arc::clone(&checked.dataset)),
                Content::File(file) if map.is_none() => {
                    library.hold_series(path.clone(), Arc::clone(&file.loaded));
                }
                Content::File(_) | Content::Loading | Content::Failed(_) => {}
            }
            let (opened, path, map) = (self.opened.clone(), path.clone(), map.clone());
            Self {
                opened,
                path,
                map,
                check: Some(Arc::clone(&found.check)),
                content: content.clone(),
            }
        };
        found.contents.iter().map(source).collect()
    }

    /// Returns the last component of the path, as text.
    pub fn name(&self) -> String {
        file_name(&self.path)
    }

    /// The file with the columns that the user assigned, as questions name it.
    pub fn series_file(&self) -> SeriesFile {
        SeriesFile { path: self.path.clone(), map: self.map.clone() }
    }

    /// Whether loading has ended, with data or with an error.
    pub fn is_settled(&self) -> bool {
        !matches!(self.content, Content::Loading)
    }

    /// Returns the data set, if the source holds one.
    pub fn dataset(&self) -> Option<&Arc<CheckedDataset>> {
        match &self.content {
            Content::Dataset(dataset) => Some(dataset),
            _ => None,
        }
    }
}

impl OpenDataset<'_> {
    /// Returns the last component of the path, as text.
    pub fn name(&self) -> String {
        file_name(self.path)
    }
}

impl OpenedPath {
    fn new(question: CheckRequest, answer: CheckAnswer) -> Self {
        let problems = &answer.report.problems;
        let failed = |problem: &PathProblem| {
            (problem.path.clone(), Content::Failed(problem.message.clone()))
        };
        let contents = answer.items.iter().map(content).chain(problems.iter().map(failed));
        let contents = contents.collect();
        let failure = problems.first().filter(|_| answer.items.is_empty()).cloned();
        let is_doubtful = |item: &CheckedItem| match &item.content {
            CheckedContent::File(file) => file.loaded.notes.iter().any(Note::is_doubt),
            CheckedContent::Dataset(_) => false,
        };
        let is_doubtful = question.map.is_none() && answer.items.iter().any(is_doubtful);
        let check = Arc::new(Answered { question, answer: Ok(Arc::new(answer)) });
        Self { check, contents, failure, map: None, is_doubtful }
    }

    /// The paths of the data sets and files that were found.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.contents.iter().map(|(path, _)| path)
    }

    /// Whether the user, or a map that he chose before, has to say how the file is read.
    fn needs_map(&self) -> bool {
        self.is_doubtful || self.failure.as_ref().is_some_and(Self::is_about_columns)
    }

    /// Whether a map may solve a problem: it is about columns, or a map is known that answers it.
    pub fn is_about_columns(failure: &PathProblem) -> bool {
        failure.columns.is_some() || failure.map.is_some()
    }
}

/// Reads and checks a path. Without a map, a file is read with the one that it had before; if its
/// columns are doubtful, with the one of another file with the same header.
///
/// - `chosen`: the columns that the user assigned;
/// - `maps`: those of earlier files.
///
/// # Errors
/// A message for the user.
pub fn read_source(
    path: &Path,
    chosen: Option<ColumnMap>,
    maps: &ColumnMaps,
    library: &Library,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<OpenedPath>, String> {
    let observer: &mut Observer<'_> = &mut |event: Event<'_>| match event {
        Event::Progress(progress) => report(progress),
        Event::Training(_) | Event::Sampling(_) => ControlFlow::Continue(()),
    };
    let mut ask = |map: Option<&ColumnMap>| -> Result<Outcome<OpenedPath>, String> {
        let map = map.cloned();
        let question = CheckRequest { paths: vec![path.to_owned()], all: false, map };
        let answer = question.answer(library, observer).map_err(|error| error_chain(&error))?;
        Ok(answer.map(|answer| OpenedPath::new(question, answer)))
    };
    let with_map = |opened: OpenedPath, map: ColumnMap, is_remembered| {
        let fingerprint = fingerprint(path, &map);
        OpenedPath { map: Some(OpenedMap { map, fingerprint, is_remembered }), ..opened }
    };
    let remembered = if chosen.is_none() { maps.find_by_path(path) } else { None };
    let is_remembered = remembered.is_some();
    if let Some(map) = chosen.or(remembered) {
        return Ok(ask(Some(&map))?.map(|opened| with_map(opened, map, is_remembered)));
    }
    let opened = match ask(None)? {
        Outcome::Complete(opened) if opened.needs_map() => opened,
        settled => return Ok(settled),
    };
    match maps.find_by_header(path) {
        None => Ok(Outcome::Complete(opened)),
        Some(map) => Ok(ask(Some(&map))?.map(|opened| with_map(opened, map, true))),
    }
}

/// Returns the path and the content of a checked item.
fn content(item: &CheckedItem) -> (PathBuf, Content) {
    let content = match &item.content {
        CheckedContent::Dataset(dataset) => Content::Dataset(Arc::clone(dataset)),
        CheckedContent::File(file) => Content::File(Arc::clone(file)),
    };
    (item.path.clone(), content)
}
