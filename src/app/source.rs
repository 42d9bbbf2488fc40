//! What is open: loaded in the background, checked, and kept with its problems.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::model::file_name;
use crate::app::question_job::Answered;
use crate::data::{ColumnMap, Dataset, DatasetKind, Flag, Loaded, Outcome};
use crate::error_chain;
use crate::jobs::Job;
use crate::study::{
    CheckAnswer, CheckRequest, CheckedContent, CheckedItem, Event, Library, PathProblem, Question,
};
use crate::vehicle::VehicleParameters;

/// Something that was opened.
pub struct Source {
    /// The path that the user opened; several sources may come from one folder.
    pub opened: PathBuf,
    /// The path of the dataset or file itself.
    pub path: PathBuf,
    /// The user's columns of a file whose header does not say which column is which.
    pub map: Option<ColumnMap>,
    /// The check of the opened path with its report; sources from one folder share it.
    pub check: Option<Arc<Answered<CheckRequest>>>,
    /// The data, or why there are none.
    pub content: Content,
}

/// What a source holds.
pub enum Content {
    /// It is being loaded.
    Loading(Job<Result<Outcome<OpenedPath>, String>>),
    /// A dataset.
    Dataset(Arc<CheckedDataset>),
    /// A single file.
    File(Arc<CheckedFile>),
    /// It could not be read, for this reason.
    Failed(String),
}

/// A dataset with its checks and its vehicle.
pub struct CheckedDataset {
    /// The data.
    pub dataset: Arc<Dataset>,
    /// Flags of each case.
    pub flags: Vec<Vec<Flag>>,
    /// Name of the vehicle in its `vehicle.toml`; `None` without one.
    pub vehicle: Option<Result<String, String>>,
}

/// A dataset that is open.
#[derive(Clone, Copy)]
pub struct OpenDataset<'a> {
    /// Its folder.
    pub path: &'a Path,
    /// Its data and their checks.
    pub checked: &'a Arc<CheckedDataset>,
}

/// The datasets of these kinds that are open, kind by kind in the order of the sources.
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
    pub loaded: Arc<Loaded>,
    /// Its flags.
    pub flags: Vec<Flag>,
}

/// What became of a path that was opened.
pub struct OpenedPath {
    check: Answered<CheckRequest>,
    contents: Vec<(PathBuf, Content)>,
    /// What is wrong with the path as a whole, if nothing of it can be read.
    pub failure: Option<PathProblem>,
}

impl Source {
    /// Starts to read and check a path.
    ///
    /// - `map`: the user's columns of a single file, where its header does not say.
    pub fn load(
        path: PathBuf,
        map: Option<ColumnMap>,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> Self {
        let question = CheckRequest { paths: vec![path.clone()], all: false, map: map.clone() };
        let library = Arc::clone(library);
        let job = Job::spawn("load", wake, move |report| {
            let mut observer = |event: Event<'_>| match event {
                Event::Progress(progress) => report(progress),
                Event::Training(_) => ControlFlow::Continue(()),
            };
            let answer = question.answer(&library, &mut observer);
            let answer = answer.map_err(|error| error_chain(&error))?;
            Ok(answer.map(|answer| OpenedPath::new(question, answer)))
        });
        match job {
            Ok(job) => {
                let content = Content::Loading(job);
                Self { opened: path.clone(), path, map, check: None, content }
            }
            Err(error) => Self::failed(path, error.to_string()),
        }
    }

    /// A source that could not be opened.
    pub fn failed(path: PathBuf, why: String) -> Self {
        let content = Content::Failed(why);
        Self { opened: path.clone(), path, map: None, check: None, content }
    }

    /// The sources that a path turned out to hold; the library holds their data from now on.
    pub fn opened(self, opened: OpenedPath, library: &Library) -> Vec<Self> {
        let check = Some(Arc::new(opened.check));
        let source = |(path, content): (PathBuf, Content)| {
            match &content {
                Content::Dataset(checked) => library.hold_dataset(Arc::clone(&checked.dataset)),
                Content::File(file) if self.map.is_none() => {
                    library.hold_series(path.clone(), Arc::clone(&file.loaded));
                }
                Content::File(_) | Content::Loading(_) | Content::Failed(_) => {}
            }
            let (opened, map) = (self.opened.clone(), self.map.clone());
            Self { opened, path, map, check: check.clone(), content }
        };
        opened.contents.into_iter().map(source).collect()
    }

    /// The last part of its path.
    pub fn name(&self) -> String {
        file_name(&self.path)
    }

    /// Whether it has been loaded, with whatever result.
    pub fn is_settled(&self) -> bool {
        !matches!(self.content, Content::Loading(_))
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
        let check = Answered { question, answer: Ok(Arc::new(answer)) };
        Self { check, contents, failure }
    }
}

/// Data with their checks, and of a dataset the name of its vehicle.
fn content(item: &CheckedItem) -> (PathBuf, Content) {
    let content = match &item.content {
        CheckedContent::Dataset(dataset, flags) => {
            let name = |path: &PathBuf| match VehicleParameters::load(path) {
                Ok(vehicle) => Ok(vehicle.name),
                Err(error) => Err(error_chain(&error)),
            };
            Content::Dataset(Arc::new(CheckedDataset {
                dataset: Arc::clone(dataset),
                flags: flags.clone(),
                vehicle: dataset.vehicle_file.as_ref().map(name),
            }))
        }
        CheckedContent::File(loaded, flags) => Content::File(Arc::new(CheckedFile {
            loaded: Arc::clone(loaded),
            flags: flags.clone(),
        })),
    };
    (item.path.clone(), content)
}
