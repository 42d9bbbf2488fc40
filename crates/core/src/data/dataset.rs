//! A data set: a folder with the table `cases.csv`, which has one row per case, and one file per
//! case, `forces/<case>.csv` or `trajectories/<case>.csv`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::data::table::CASE_COLUMN;
use crate::data::{
    Attributes, DataError, FileKind, ForceHistory, MAX_CASE_CELLS, MAX_CASES, MAX_DATASET_BYTES,
    Sampling, SeriesError, Table, TimeSeries, list_folder, read_series,
};
use crate::jobs::{Progress, ProgressCallback};

/// Name of the table of cases in the folder of a data set.
pub const CASES_FILE: &str = "cases.csv";

/// Name of the file that describes the vehicle of a trajectory data set.
const VEHICLE_FILE: &str = "vehicle.toml";

/// Number of cases that are loaded in parallel between two reports of progress.
const BLOCK_CASES: usize = 64;

/// The kind of the cases in a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DatasetKind {
    /// Contact forces of collisions, in world axes. A sample is the mean over an interval centred
    /// at its instant.
    Force,
    /// Motions after an impact, with the contact force in heading axes. A sample of the force is
    /// the mean over the interval that follows its instant.
    Trajectory,
}

/// A data set that was loaded.
#[derive(Debug)]
pub struct Dataset {
    /// Folder of the data set.
    pub root: PathBuf,
    /// Kind of the cases.
    pub kind: DatasetKind,
    /// Path of `vehicle.toml`; `None` if the folder has no such file.
    pub vehicle_file: Option<PathBuf>,
    /// The cases that could be read, in the order of the table.
    pub cases: Vec<Case>,
    /// The reasons why cases, files or columns could not be read or are missing.
    pub problems: Vec<DataError>,
}

/// One case of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name of the case in the column `case`.
    pub name: String,
    /// Kind of the case.
    pub kind: DatasetKind,
    /// The row of the case in the table of cases.
    pub attributes: Attributes,
    /// The time series from the file of the case, SI units.
    pub series: TimeSeries,
}

/// The end of a long computation that can be cancelled.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<T> {
    /// The computation ended with a result.
    Complete(T),
    /// The computation was cancelled by its callback and has no result.
    Cancelled,
}

impl<T> Outcome<T> {
    /// The result; `None` if the computation was cancelled.
    pub fn complete(self) -> Option<T> {
        match self {
            Self::Complete(result) => Some(result),
            Self::Cancelled => None,
        }
    }

    /// Converts the result by `go_on`; a cancelled computation stays cancelled.
    pub fn map<U>(self, go_on: impl FnOnce(T) -> U) -> Outcome<U> {
        match self {
            Self::Complete(result) => Outcome::Complete(go_on(result)),
            Self::Cancelled => Outcome::Cancelled,
        }
    }
}

impl DatasetKind {
    pub(crate) const ALL: [Self; 2] = [Self::Force, Self::Trajectory];

    /// Name of the folder that holds the files of the cases.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Force => "forces",
            Self::Trajectory => "trajectories",
        }
    }

    /// What a sample of the contact force in the files of the cases stands for.
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

    /// The kind of the data set in a folder, by the name of the subfolder that it has; `None` if
    /// the folder is no data set. A folder with both subfolders is a force data set.
    pub fn from_folder(root: &Path) -> Option<Self> {
        let is_there = |kind: &Self| root.join(kind.folder()).is_dir();
        Self::ALL.into_iter().find(is_there)
    }
}

impl Case {
    /// The contact force on the struck vehicle.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] if the file has no complete pair of force columns, which a
    /// trajectory may lack.
    pub fn force_history(&self) -> Result<ForceHistory, SeriesError> {
        ForceHistory::from_series(&self.series, self.kind.sampling())
    }
}

impl Dataset {
    /// Loads a data set. Cases that cannot be read are listed in [`Dataset::problems`]; the others
    /// are loaded all the same. The cases are read in parallel and keep the order of the table.
    ///
    /// - `report`: called with the number of rows done after each block of cases; if it breaks, the
    ///   result is [`Outcome::Cancelled`].
    ///
    /// # Errors
    /// [`DataError::NotFound`] if there is no such folder, [`DataError::NotRecognised`] if it has neither `forces/`
    /// nor `trajectories/`, [`DataError::TooLarge`] if the files of the cases have more than [`MAX_DATASET_BYTES`]
    /// together, and any other [`DataError`] if `cases.csv` cannot be read, has no column `case` or
    /// too many cases, or if the folder of the files cannot be listed.
    pub fn load(
        root: &Path,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<Self>, DataError> {
        let mut budget = MAX_DATASET_BYTES;
        Self::load_within(root, &mut budget, report)
    }

    /// Loads a data set whose files have at most `budget` bytes together, by which the budget is
    /// reduced.
    ///
    /// # Errors
    /// The same as for [`Dataset::load`].
    pub(super) fn load_within(
        root: &Path,
        budget: &mut u64,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<Self>, DataError> {
        let kind = DatasetKind::from_folder(root).ok_or_else(|| match root.metadata() {
            Ok(_) => DataError::NotRecognised { path: root.to_owned() },
            Err(error) => DataError::io(root, error),
        })?;
        let table = Table::read_cases(&root.join(CASES_FILE))?;
        check_size(&table)?;
        let mut problems = missing_attributes(&table, kind);
        let rows = named_rows(&table, &mut problems)?;
        let files = CaseFiles::list(root, kind)?;
        files.take_from(budget, &rows)?;
        problems.extend(files.without_row(&rows, table.path()));
        let vehicle_file =
            Some(root.join(VEHICLE_FILE)).filter(|path| path.is_symlink() || path.exists());
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

    /// The files from which a data set is loaded, in the order of their names: the table of cases, the
    /// vehicle, and the files of the cases that the table names. Others in the folder are not of the data
    /// set; a folder that is no data set has none.
    pub fn files(root: &Path) -> Vec<PathBuf> {
        let Some(kind) = DatasetKind::from_folder(root) else { return Vec::new() };
        let mut files = vec![root.join(CASES_FILE), root.join(VEHICLE_FILE)];
        files.extend(Self::case_files(root, kind).unwrap_or_default());
        files.retain(|file| file.is_file());
        files.sort();
        files
    }

    /// The files of the cases that the table names.
    fn case_files(root: &Path, kind: DatasetKind) -> Result<Vec<PathBuf>, DataError> {
        let table = Table::read_cases(&root.join(CASES_FILE))?;
        check_size(&table)?;
        let rows = named_rows(&table, &mut Vec::new())?;
        let mut files = CaseFiles::list(root, kind)?.files;
        Ok(rows.iter().filter_map(|row| files.remove(&row.name)).collect())
    }

    /// The case of this name; `None` if the data set has no such case or the case could not be
    /// read.
    pub fn case(&self, name: &str) -> Option<&Case> {
        self.cases.iter().find(|case| case.name == name)
    }
}

/// A row of the table of cases whose name is unique and can be the name of a file.
struct NamedRow {
    idx: usize,
    name: String,
    attributes: Attributes,
}

/// Refuses a table with more cases or cells than are held in memory.
///
/// # Errors
/// [`DataError::TooManyCases`].
fn check_size(table: &Table) -> Result<(), DataError> {
    let n_rows = table.n_rows();
    let n_cells = n_rows.saturating_mul(table.header().len());
    let sizes = [("cases", n_rows, MAX_CASES), ("cells", n_cells, MAX_CASE_CELLS)];
    match sizes.into_iter().find(|(_, got, limit)| got > limit) {
        None => Ok(()),
        Some((what, got, limit)) => {
            Err(DataError::TooManyCases { path: table.path().to_owned(), what, got, limit })
        }
    }
}

/// The errors for needed columns that the table does not have.
fn missing_attributes(table: &Table, kind: DatasetKind) -> Vec<DataError> {
    let is_missing = |name: &&str| !table.header().iter().any(|column| column == *name);
    let needed = kind.columns().iter().filter(|column| column.is_needed);
    let missing = needed.map(|column| column.name).filter(is_missing);
    let problem = |name: &str| DataError::MissingAttribute {
        path: table.path().to_owned(),
        line: table.header_line(),
        name: name.to_owned(),
        consequence: kind.consequence(),
    };
    missing.map(problem).collect()
}

/// The names of all cases of a table with their rows.
///
/// # Errors
/// [`DataError`] for the first row whose name is not valid or not unique, or for a table that is too
/// large or has no column `case`.
pub(crate) fn named_cases(table: &Table) -> Result<Vec<(String, Attributes)>, DataError> {
    check_size(table)?;
    let mut problems = Vec::new();
    let rows = named_rows(table, &mut problems)?;
    match problems.into_iter().next() {
        Some(problem) => Err(problem),
        None => Ok(rows.into_iter().map(|row| (row.name, row.attributes)).collect()),
    }
}

/// The rows whose names are valid and unique. The errors for the other rows are added to
/// `problems`.
///
/// # Errors
/// [`DataError::MissingAttribute`] if the table has no column `case`.
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
    for (row_idx, attributes) in Attributes::from_table(table).into_iter().enumerate() {
        let (path, line) = (|| table.path().to_owned(), attributes.line());
        let case = table.cell(row_idx, case_idx).into_owned();
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

/// The error for the first cell that is blank though the physics needs it, or holds text or a
/// number out of range. A column that the table lacks is reported once, for all cases.
fn bad_attribute(attributes: &Attributes, kind: DatasetKind) -> Option<DataError> {
    let known = kind.columns().iter().filter(|column| attributes.column(column.name) > 0);
    let checked = known.map(|column| match column.is_needed {
        true => attributes.require(column, kind.consequence()).err(),
        false => attributes.optional(column).err(),
    });
    checked.flatten().next()
}

/// Whether a case name can be the name of a file inside the folder: it consists of letters, digits
/// and ` -_.+()` and does not begin with a point.
pub(crate) fn names_a_file(case: &str) -> bool {
    let is_plain = |c: char| c.is_alphanumeric() || " -_.+()".contains(c);
    !case.is_empty() && !case.starts_with('.') && case.chars().all(is_plain)
}

/// The files of the cases in the folder of a data set.
struct CaseFiles {
    folder: PathBuf,
    kind: DatasetKind,
    /// The files by their names without extension; `.CSV` is an extension as `.csv` is.
    files: BTreeMap<String, PathBuf>,
}

impl CaseFiles {
    fn list(root: &Path, kind: DatasetKind) -> Result<Self, DataError> {
        let folder = root.join(kind.folder());
        let mut files = BTreeMap::new();
        for path in list_folder(&folder)? {
            let is_csv = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
            if let (true, Some(stem)) = (is_csv, path.file_stem()) {
                let name = stem.to_string_lossy().into_owned();
                if let Some(other) = files.insert(name, path.clone()) {
                    let (path, other) = (path.clone().min(other.clone()), path.max(other));
                    return Err(DataError::TwoFilesOfCase { path, other });
                }
            }
        }
        Ok(Self { folder, kind, files })
    }

    /// The file of a case; the path that it should have if there is none.
    fn path(&self, case: &str) -> PathBuf {
        let found = self.files.get(case).cloned();
        found.unwrap_or_else(|| self.folder.join(format!("{case}.csv")))
    }

    /// Reduces `budget` by the sizes of the files of all rows, before any of them is read.
    ///
    /// # Errors
    /// [`DataError::TooLarge`] if they are larger than the budget.
    fn take_from(&self, budget: &mut u64, rows: &[NamedRow]) -> Result<(), DataError> {
        // A file that cannot be looked at is a problem of its case, which is found when it is read.
        let size = |path: &PathBuf| std::fs::metadata(path).map_or(0, |metadata| metadata.len());
        let sizes = rows.iter().filter_map(|row| self.files.get(&row.name)).map(size);
        let (bytes, limit) = (sizes.fold(0, u64::saturating_add), *budget);
        let too_large = || DataError::TooLarge { path: self.folder.clone(), bytes, limit };
        *budget = limit.checked_sub(bytes).ok_or_else(too_large)?;
        Ok(())
    }

    fn without_row<'a>(
        &'a self,
        rows: &'a [NamedRow],
        table: &'a Path,
    ) -> impl Iterator<Item = DataError> + 'a {
        let known: BTreeSet<&str> = rows.iter().map(|row| row.name.as_str()).collect();
        let stray = self.files.iter().filter(move |(name, _)| !known.contains(name.as_str()));
        stray.map(|(_, path)| DataError::FileWithoutCase {
            path: path.clone(),
            table: table.to_owned(),
        })
    }

    fn load(&self, row: &NamedRow) -> Result<Case, DataError> {
        if let Some(problem) = bad_attribute(&row.attributes, self.kind) {
            return Err(problem);
        }
        let file = self.path(&row.name);
        if !self.files.contains_key(&row.name) {
            return Err(DataError::CaseWithoutFile {
                path: row.attributes.path(),
                line: row.attributes.line(),
                column: row.attributes.column(CASE_COLUMN),
                case: row.name.clone(),
                file,
            });
        }
        let loaded = read_series(&file, None, self.kind.file_kind())?;
        loaded.check_consistent(&file)?;
        Ok(Case {
            name: row.name.clone(),
            kind: self.kind,
            attributes: row.attributes.clone(),
            series: loaded.series,
        })
    }
}
