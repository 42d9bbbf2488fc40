//! A folder of cases: `cases.csv` with a row a case, and `forces/<case>.csv` or
//! `trajectories/<case>.csv` beside it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::data::table::CASE_COLUMN;
use crate::data::{
    Attributes, DataError, FileKind, ForceHistory, Sampling, SeriesError, Table, TimeSeries, Value,
    read_series,
};
use crate::jobs::{Progress, ProgressCallback};

/// The table of cases in a data set's folder.
pub(crate) const CASES_FILE: &str = "cases.csv";

/// Describes the vehicle of a trajectory data set.
const VEHICLE_FILE: &str = "vehicle.toml";

/// Cases that are loaded in parallel between two reports of progress.
const BLOCK_CASES: usize = 64;

/// What the cases of a data set are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DatasetKind {
    /// Contact forces of collisions, world axes, means over intervals centred at the samples.
    Force,
    /// Motions after an impact, with the force in heading axes as means over the coming interval.
    Trajectory,
}

/// A data set.
#[derive(Debug)]
pub struct Dataset {
    /// Its folder.
    pub root: PathBuf,
    /// What its cases are.
    pub kind: DatasetKind,
    /// `vehicle.toml`, if there is one.
    pub vehicle_file: Option<PathBuf>,
    /// The cases that could be read, in the order of the table.
    pub cases: Vec<Case>,
    /// What could not be read, and what is missing.
    pub problems: Vec<DataError>,
}

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its name in the column `case`.
    pub name: String,
    /// What it is.
    pub kind: DatasetKind,
    /// Its row of the table.
    pub attributes: Attributes,
    /// Its file.
    pub series: TimeSeries,
}

/// How a long piece of work ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<T> {
    /// With its result.
    Complete(T),
    /// Without, as the callback asked.
    Cancelled,
}

impl<T> Outcome<T> {
    /// The result, unless cancelled.
    pub fn complete(self) -> Option<T> {
        match self {
            Self::Complete(result) => Some(result),
            Self::Cancelled => None,
        }
    }

    /// Goes on with the result, unless cancelled.
    pub fn map<U>(self, go_on: impl FnOnce(T) -> U) -> Outcome<U> {
        match self {
            Self::Complete(result) => Outcome::Complete(go_on(result)),
            Self::Cancelled => Outcome::Cancelled,
        }
    }
}

impl DatasetKind {
    pub(crate) const ALL: [Self; 2] = [Self::Force, Self::Trajectory];

    /// The folder of its files.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Force => "forces",
            Self::Trajectory => "trajectories",
        }
    }

    /// What a force sample in its files stands for.
    pub fn sampling(self) -> Sampling {
        match self {
            Self::Force => Sampling::CentredMean,
            Self::Trajectory => Sampling::ComingMean,
        }
    }

    fn file_kind(self) -> FileKind {
        match self {
            Self::Force => FileKind::Force,
            Self::Trajectory => FileKind::Trajectory,
        }
    }

    /// The kind of data set in a folder, by the folder of its files.
    pub fn of_folder(root: &Path) -> Option<Self> {
        let is_there = |kind: &Self| root.join(kind.folder()).is_dir();
        Self::ALL.into_iter().find(is_there)
    }
}

impl Case {
    /// The contact force on the target.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] if the file has no force, as a trajectory may not.
    pub fn force_history(&self) -> Result<ForceHistory, SeriesError> {
        ForceHistory::from_series(&self.series, self.kind.sampling())
    }
}

impl Dataset {
    /// Loads a data set. Bad cases become [`Dataset::problems`] and do not stop the good ones.
    ///
    /// # Errors
    /// [`DataError::NotRecognised`] if the folder has neither `forces/` nor `trajectories/`;
    /// [`DataError`] if `cases.csv` cannot be read or has no column `case`.
    pub fn load(
        root: &Path,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<Self>, DataError> {
        let kind = DatasetKind::of_folder(root)
            .ok_or_else(|| DataError::NotRecognised { path: root.to_owned() })?;
        let table = Table::read(&root.join(CASES_FILE))?;
        let mut problems = missing_attributes(&table, kind);
        let rows = named_rows(&table, &mut problems)?;
        let files = CaseFiles::list(root, kind)?;
        problems.extend(files.without_row(&rows, table.path()));
        let vehicle_file = Some(root.join(VEHICLE_FILE)).filter(|path| path.is_file());
        let mut cases = Vec::with_capacity(rows.len());
        let message = format!("loading {}", root.display());
        let total = rows.len() as u64;
        for block in rows.chunks(BLOCK_CASES) {
            let loaded: Vec<_> = block.par_iter().map(|row| files.load(row)).collect();
            for case in loaded {
                match case {
                    Ok(case) => cases.push(case),
                    Err(problem) => problems.push(problem),
                }
            }
            let done = block.last().map_or(0, |row| row.idx as u64 + 1);
            if report(Progress::new(done, total, message.as_str())).is_break() {
                return Ok(Outcome::Cancelled);
            }
        }
        Ok(Outcome::Complete(Self { root: root.to_owned(), kind, vehicle_file, cases, problems }))
    }

    /// The case of this name.
    pub fn case(&self, name: &str) -> Option<&Case> {
        self.cases.iter().find(|case| case.name == name)
    }
}

/// A row with a name of its own that can name a file.
struct NamedRow {
    idx: usize,
    name: String,
    attributes: Attributes,
}

/// The needed columns that the table does not have.
fn missing_attributes(table: &Table, kind: DatasetKind) -> Vec<DataError> {
    let is_missing = |name: &&&str| !table.header().iter().any(|column| column == **name);
    let missing = kind.needed_attributes().iter().filter(is_missing);
    let problem = |name: &&str| DataError::MissingAttribute {
        path: table.path().to_owned(),
        line: table.header_line(),
        name: (*name).to_owned(),
        consequence: kind.consequence(),
    };
    missing.map(problem).collect()
}

/// The rows whose name is good.
fn named_rows(table: &Table, problems: &mut Vec<DataError>) -> Result<Vec<NamedRow>, DataError> {
    let is_case = |name: &String| name.eq_ignore_ascii_case(CASE_COLUMN);
    let case_idx =
        table.header().iter().position(is_case).ok_or_else(|| DataError::MissingAttribute {
            path: table.path().to_owned(),
            line: table.header_line(),
            name: CASE_COLUMN.to_owned(),
            consequence: "no row can be matched to its file",
        })?;
    let column = case_idx + 1;
    let mut first_lines: BTreeMap<String, u64> = BTreeMap::new();
    let mut rows = Vec::new();
    for (row_idx, attributes) in Attributes::of(table).into_iter().enumerate() {
        let (path, line) = (|| table.path().to_owned(), attributes.line());
        let case = table.cell(row_idx, case_idx).to_owned();
        if !names_a_file(&case) {
            problems.push(DataError::CaseName { path: path(), line, column, case });
        } else if let Some(&first_line) = first_lines.get(&case) {
            problems.push(DataError::DuplicateCase {
                path: path(),
                line,
                column,
                case,
                first_line,
            });
        } else {
            first_lines.insert(case.clone(), line);
            rows.push(NamedRow { idx: rows.len(), name: case, attributes });
        }
    }
    Ok(rows)
}

/// A needed cell that is neither a number nor blank.
fn bad_attribute(attributes: &Attributes, kind: DatasetKind) -> Option<DataError> {
    kind.needed_attributes().iter().find_map(|name| match attributes.get(name)? {
        Value::Number(_) => None,
        Value::Text(text) => Some(attributes.not_a_number(name, text)),
    })
}

/// Whether a case name stays inside the folder on every system.
fn names_a_file(case: &str) -> bool {
    let is_plain = |c: char| c.is_alphanumeric() || " -_.+()".contains(c);
    !case.is_empty() && !case.starts_with('.') && case.chars().all(is_plain)
}

/// The files of the cases.
struct CaseFiles {
    folder: PathBuf,
    kind: DatasetKind,
    /// Names without extension.
    names: BTreeSet<String>,
}

impl CaseFiles {
    fn list(root: &Path, kind: DatasetKind) -> Result<Self, DataError> {
        let folder = root.join(kind.folder());
        let to_error = |source| DataError::io(&folder, source);
        let mut names = BTreeSet::new();
        for entry in std::fs::read_dir(&folder).map_err(to_error)? {
            let path = entry.map_err(to_error)?.path();
            let is_csv = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
            if let (true, Some(stem)) = (is_csv, path.file_stem()) {
                names.insert(stem.to_string_lossy().into_owned());
            }
        }
        Ok(Self { folder, kind, names })
    }

    fn path(&self, case: &str) -> PathBuf {
        self.folder.join(format!("{case}.csv"))
    }

    fn without_row<'a>(
        &'a self,
        rows: &'a [NamedRow],
        table: &'a Path,
    ) -> impl Iterator<Item = DataError> + 'a {
        let known: BTreeSet<&str> = rows.iter().map(|row| row.name.as_str()).collect();
        let stray = self.names.iter().filter(move |name| !known.contains(name.as_str()));
        stray.map(|name| DataError::FileWithoutCase {
            path: self.path(name),
            table: table.to_owned(),
        })
    }

    fn load(&self, row: &NamedRow) -> Result<Case, DataError> {
        if let Some(problem) = bad_attribute(&row.attributes, self.kind) {
            return Err(problem);
        }
        let file = self.path(&row.name);
        if !self.names.contains(&row.name) {
            return Err(DataError::CaseWithoutFile {
                path: row.attributes.path(),
                line: row.attributes.line(),
                column: row.attributes.column(CASE_COLUMN),
                case: row.name.clone(),
                file,
            });
        }
        let loaded = read_series(&file, None, self.kind.file_kind())?;
        Ok(Case {
            name: row.name.clone(),
            kind: self.kind,
            attributes: row.attributes.clone(),
            series: loaded.series,
        })
    }
}
