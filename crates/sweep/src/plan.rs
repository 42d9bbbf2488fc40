//! What a sweep is: a question, what varies in it, and how many rows there are.
//!
//! A plan is written by a person as TOML ([`Plan::read`]) and resolved once: scenario and request stand in
//! it, with the digests of program, networks and files. Row i follows from (plan, seed, i) alone.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rand::Rng as _;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::pit::PitInput;
use crate::points::point;
use crate::vary::{Distribution, InputValue, Vary, listed, unit_fault};
use crate::{Outcome, SweepError};
use impactlab_core::collision::Scenario;
use impactlab_core::data::write::WriteError;
use impactlab_core::data::{DataError, Existing, MAX_SETTINGS_BYTES, read_utf8, write_atomically};
use impactlab_core::numerics::{random_stream, sha256_hex};
use impactlab_core::program;
use impactlab_study::case_file::UsedFile;
use impactlab_study::{Library, ModelChoice, Request};

/// Name of a resolved plan in its folder.
pub const PLAN_FILE: &str = "plan.json";

/// Most rows of a sweep.
pub const MOST_ROWS: u64 = 100_000_000_000;

/// Most rows of a chunk.
pub const MOST_CHUNK_ROWS: u64 = 1_000_000;

/// Most chunks of a sweep.
pub const MOST_CHUNKS: u64 = 10_000_000;

/// Name of the input that stands for all that a draw leaves open.
pub const UNKNOWNS: &str = "unknowns";

/// Version of the format of a resolved plan that reads no files.
pub(crate) const FORMAT: u32 = 1;

/// That of one that reads files: its file says them relative to its folder, so that both can be moved together.
/// In plans of the first format they stand as they were given.
pub(crate) const FORMAT_OF_FILES: u32 = 2;

/// A resolved plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Version of the format.
    pub format: u32,
    /// What the sweep is called.
    pub name: String,
    /// What is asked in each row.
    pub question: SweptQuestion,
    /// How the rows are laid out.
    pub design: Design,
    /// Number of rows; of base points in a Saltelli design, and of rows a cell in a grid.
    pub n: u64,
    /// Rows of a chunk.
    pub chunk: u64,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// What varies, in the order of the columns.
    pub vary: Vec<Vary>,
    /// Version of the program that answers.
    pub program: String,
    /// Digests of the networks that answer.
    pub networks: BTreeMap<String, String>,
    /// Files that the question reads, by their content.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<UsedFile>,
}

/// What is asked in each row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SweptQuestion {
    /// One draw of both vehicles of a PIT.
    Pit(Box<PitQuestion>),
    /// Any request, and numbers of its answer.
    Request(Box<RequestQuestion>),
}

/// A PIT of which rows are drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PitQuestion {
    /// What does not vary.
    pub scenario: Scenario,
    /// Pairs of vehicles that come with the program; those of the scenario if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<VehiclePairIds>,
    /// Standard deviation of the friction of the road.
    pub road_sigma: f64,
    /// Time after which a motion is followed no further, s.
    pub limit_s: f64,
}

/// A pair of vehicles that come with the program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehiclePairIds {
    /// The struck vehicle.
    pub struck: String,
    /// The striking vehicle.
    pub striking: String,
}

/// A request into which values are written, and numbers that are picked from its answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RequestQuestion {
    /// The request.
    pub request: Value,
    /// Where the seed of a row goes, as JSON pointers; empty if all rows have the seed of the request.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seed_at: Vec<String>,
    /// The numbers that are picked.
    pub outcomes: Vec<PickedOutcome>,
}

/// A number of an answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PickedOutcome {
    /// Name of its column.
    pub name: String,
    /// Where it is in the answer: a JSON pointer.
    pub at: String,
    /// Its SI unit; "1" for a pure number.
    pub unit: String,
}

/// How the rows of a sweep are laid out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// A Sobol sequence, scrambled as Owen has it.
    #[default]
    Sobol,
    /// The rows of Saltelli, from which Sobol indices follow.
    Saltelli,
    /// Every combination of the values of lists.
    Grid,
}

/// The inputs of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowInputs {
    /// Values, in the order of [`Plan::vary`].
    pub values: Vec<InputValue>,
    /// Seed of all that the row leaves open.
    pub seed: u64,
}

impl Plan {
    /// Number of rows.
    pub fn n_rows(&self) -> u64 {
        match self.design {
            Design::Sobol => self.n,
            Design::Saltelli => self.n.saturating_mul(self.n_exchanged() as u64 + 2),
            Design::Grid => {
                let lists = self.vary.iter().filter_map(|vary| vary.distribution.list());
                lists.fold(self.n, |n, values| n.saturating_mul(values.len() as u64))
            }
        }
    }

    /// Number of chunks.
    pub fn n_chunks(&self) -> u64 {
        self.n_rows().div_ceil(self.chunk.max(1))
    }

    /// The rows of a chunk.
    pub fn rows_of(&self, chunk: u64) -> std::ops::Range<u64> {
        let start = chunk.saturating_mul(self.chunk).min(self.n_rows());
        start..start.saturating_add(self.chunk).min(self.n_rows())
    }

    /// SHA-256 of the plan, hexadecimal. Files count by their content, wherever they are.
    pub fn sha256(&self) -> String {
        let bytes = match self.format {
            FORMAT_OF_FILES => serde_json::to_vec(&self.by_content()),
            _ => serde_json::to_vec(self),
        };
        // A plan is made of numbers, texts and maps with texts as keys, which JSON can write.
        sha256_hex([bytes.unwrap_or_default().as_slice()])
    }

    /// Whether a row leaves something open, which is drawn from its own stream.
    pub fn has_unknowns(&self) -> bool {
        match &self.question {
            SweptQuestion::Pit(_) => true,
            SweptQuestion::Request(request) => !request.seed_at.is_empty(),
        }
    }

    /// Inputs that a Saltelli design exchanges: all that vary, and the unknowns.
    pub fn n_exchanged(&self) -> usize {
        self.vary.len() + usize::from(self.has_unknowns())
    }

    /// Names and units of the outcomes.
    pub fn outcomes(&self) -> Vec<(String, String)> {
        match &self.question {
            SweptQuestion::Pit(_) => {
                let all = Outcome::ALL.iter();
                all.map(|it| (it.name().to_owned(), it.unit().to_owned())).collect()
            }
            SweptQuestion::Request(request) => {
                request.outcomes.iter().map(|it| (it.name.clone(), it.unit.clone())).collect()
            }
        }
    }

    /// The inputs of a row, which follow from (plan, seed, row) alone.
    pub fn inputs(&self, row: u64) -> RowInputs {
        let n = self.vary.len();
        match self.design {
            Design::Sobol => {
                let shares = point(self.seed, row, n);
                RowInputs { values: self.values(&shares), seed: self.stream(2 * row) }
            }
            Design::Saltelli => {
                let size = self.n_exchanged() as u64 + 2;
                let (base, matrix) = (row / size, row % size);
                let both = point(self.seed, base, 2 * n);
                let (a, b) = both.split_at(n);
                // Which of the inputs are those of matrix B.
                let is_of_b = |idx: usize| matrix == 1 || matrix == 2 + idx as u64;
                let shares: Vec<f64> =
                    (0..n).map(|idx| if is_of_b(idx) { b[idx] } else { a[idx] }).collect();
                let seed = self.stream(2 * base + u64::from(is_of_b(n)));
                RowInputs { values: self.values(&shares), seed }
            }
            Design::Grid => {
                let mut cell = row / self.n.max(1);
                let mut values: Vec<InputValue> = Vec::with_capacity(n);
                for vary in self.vary.iter().rev() {
                    let list = vary.distribution.list().unwrap_or_default();
                    let len = list.len().max(1) as u64;
                    values.push(listed(list, (cell % len) as usize));
                    cell /= len;
                }
                values.reverse();
                RowInputs { values, seed: self.stream(2 * row) }
            }
        }
    }

    fn values(&self, shares: &[f64]) -> Vec<InputValue> {
        self.vary.iter().zip(shares).map(|(vary, share)| vary.distribution.at(*share)).collect()
    }

    /// Seed of a row by the number of its stream.
    fn stream(&self, number: u64) -> u64 {
        random_stream(self.seed, UNKNOWNS, number).next_u64()
    }

    /// Reads the plan in the folder of a sweep, and checks that it is one of this program, these networks
    /// and these files.
    ///
    /// # Errors
    /// [`SweepError`] says what is wrong or differs.
    pub fn open(folder: &Path, library: &Library) -> Result<Self, SweepError> {
        let plan = Self::stored(folder)?;
        plan.check_program(folder, library)?;
        Ok(plan)
    }

    /// Reads the plan in the folder of a sweep, whichever program made it.
    ///
    /// # Errors
    /// [`SweepError::NoPlan`] or [`SweepError::BadPlan`].
    pub fn stored(folder: &Path) -> Result<Self, SweepError> {
        let path = folder.join(PLAN_FILE);
        let text = read_utf8(&path, MAX_SETTINGS_BYTES)?;
        let plan: Self = serde_json::from_str(&text)
            .map_err(|source| SweepError::NoPlan { path: path.clone(), source })?;
        let plan = plan.with_paths_begun_at(folder)?;
        match plan.fault() {
            None => Ok(plan),
            Some((key, expected)) => {
                Err(SweepError::BadPlan { path, what: format!("{key}: expected {expected}") })
            }
        }
    }

    /// Writes the plan into a folder, which is made if it is not there.
    ///
    /// # Errors
    /// [`SweepError::PlanThere`] where there is another plan already, [`SweepError::Data`].
    pub fn write(&self, folder: &Path) -> Result<(), SweepError> {
        std::fs::create_dir_all(folder).map_err(|source| SweepError::no_folder(folder, source))?;
        let path = folder.join(PLAN_FILE);
        if Self::stored(folder).is_ok_and(|there| there == *self) {
            return Ok(());
        }
        let text = serde_json::to_string_pretty(&self.with_paths_ended_at(folder)?)
            .map_err(|source| SweepError::NoPlan { path: path.clone(), source })?;
        let written = write_atomically(&path, Existing::Refuse, |out| writeln!(out, "{text}"));
        written.map_err(|error| match error {
            DataError::Write(WriteError::Exists { path }) => SweepError::PlanThere { path },
            error => error.into(),
        })
    }

    /// Checks that program, networks and files are those of the plan.
    ///
    /// - `folder`: of the sweep, whose plan the error names.
    ///
    /// # Errors
    /// [`SweepError::OtherProgram`] with the first that is not.
    pub fn check_program(&self, folder: &Path, library: &Library) -> Result<(), SweepError> {
        if self.program != program::version() {
            return Err(other(folder, "impactlab", &self.program, program::version()));
        }
        let present = networks(library)?;
        if self.networks != present {
            let list = |of: &BTreeMap<String, String>| {
                of.iter().map(|(name, sha256)| format!("{name} {sha256}")).collect::<Vec<_>>()
            };
            let [planned, present] = [&self.networks, &present].map(|of| list(of).join(", "));
            return Err(other(folder, "networks", &planned, &present));
        }
        self.check_files(folder)
    }

    /// Checks that the files that rows read still are those of the plan.
    ///
    /// # Errors
    /// [`SweepError::OtherProgram`] with the first that is not, [`SweepError::Input`].
    pub(crate) fn check_files(&self, folder: &Path) -> Result<(), SweepError> {
        for planned in &self.files {
            let present = used(&planned.path)?;
            if present != *planned {
                let what = format!("the content of {},", planned.path.display());
                return Err(other(folder, &what, &planned.sha256, &present.sha256));
            }
        }
        Ok(())
    }

    /// What is wrong with the plan, as the key of its file and what is expected; `None` if nothing is.
    pub(crate) fn fault(&self) -> Option<(String, String)> {
        let is_count = |n: u64, most: u64| (1..=most).contains(&n);
        let counted = |key: &str, most: u64| Some((key.to_owned(), format!("1 to {most}")));
        if !(FORMAT..=FORMAT_OF_FILES).contains(&self.format) {
            return Some(("format".to_owned(), format!("{FORMAT} to {FORMAT_OF_FILES}")));
        }
        if !is_count(self.n, MOST_ROWS) || !is_count(self.n_rows(), MOST_ROWS) {
            return Some(("n".to_owned(), format!("1 to {MOST_ROWS} rows in all")));
        }
        if !is_count(self.chunk, MOST_CHUNK_ROWS) {
            return counted("chunk", MOST_CHUNK_ROWS);
        }
        if !is_count(self.n_chunks(), MOST_CHUNKS) {
            return Some(("chunk".to_owned(), format!("at most {MOST_CHUNKS} chunks in all")));
        }
        if self.vary.is_empty() {
            return Some(("vary".to_owned(), "at least one input that varies".to_owned()));
        }
        let of_inputs = || self.vary.iter().find_map(|vary| self.fault_of(vary));
        let of_pit = match &self.question {
            SweptQuestion::Pit(pit) => pit.fault(self.varies(PitInput::Pair)),
            SweptQuestion::Request(_) => None,
        };
        of_pit.or_else(of_inputs).or_else(|| self.fault_of_names())
    }

    fn varies(&self, input: PitInput) -> bool {
        self.vary.iter().any(|vary| vary.name == input.name())
    }

    fn fault_of(&self, vary: &Vary) -> Option<(String, String)> {
        let key = format!("vary.{}", vary.name);
        if let Some(expected) = vary.distribution.fault() {
            return Some((key, expected));
        }
        let (list, weights) = match &vary.distribution {
            Distribution::List { values, weights } => (Some(values), weights.as_slice()),
            _ => (None, &[][..]),
        };
        if self.design == Design::Grid && (list.is_none() || !weights.is_empty()) {
            return Some((key, "list or steps, without weights: this is a grid".to_owned()));
        }
        if let Some(expected) = unit_fault(&vary.unit, vary.at.iter().map(String::as_str)) {
            return Some((format!("{key}.unit"), expected));
        }
        match &self.question {
            SweptQuestion::Pit(pit) => pit.fault_of(vary).map(|expected| (key, expected)),
            SweptQuestion::Request(_) if vary.at.is_empty() => {
                Some((key, "at, the place in the request as a JSON pointer".to_owned()))
            }
            SweptQuestion::Request(request) => {
                let is_there = |at: &String| request.request.pointer(at).is_some();
                let missing = vary.at.iter().find(|at| !is_there(at))?;
                let expected = format!("a JSON pointer to a value of the request, not {missing:?}");
                Some((format!("{key}.at"), expected))
            }
        }
    }

    /// Names of columns that are empty or stand there twice.
    fn fault_of_names(&self) -> Option<(String, String)> {
        let outcomes = self.outcomes();
        if outcomes.is_empty() {
            return Some(("outcome".to_owned(), "at least one outcome".to_owned()));
        }
        let of_inputs =
            self.vary.iter().map(|vary| (vary.name.as_str(), format!("vary.{}", vary.name)));
        let of_outcomes =
            outcomes.iter().map(|(name, _)| (name.as_str(), "request.outcomes".to_owned()));
        let mut seen = std::collections::BTreeSet::from(["row", "reason", UNKNOWNS]);
        for (name, key) in of_inputs.chain(of_outcomes) {
            if name.is_empty() || !seen.insert(name) {
                return Some((key, format!("a name that no other column has, not {name:?}")));
            }
        }
        if let SweptQuestion::Request(request) = &self.question {
            if let Some(outcome) = request.outcomes.iter().find(|it| !it.at.starts_with('/')) {
                let expected = format!("places that begin with \"/\", not {:?}", outcome.at);
                return Some(("request.outcomes".to_owned(), expected));
            }
            let fault_of = |it: &PickedOutcome| unit_fault(&it.unit, [it.at.as_str()]);
            if let Some(expected) = request.outcomes.iter().find_map(fault_of) {
                return Some(("request.outcomes".to_owned(), expected));
            }
            let is_missing = |at: &&String| request.request.pointer(at).is_none();
            if let Some(at) = request.seed_at.iter().find(is_missing) {
                let expected = format!("a JSON pointer to a value of the request, not {at:?}");
                return Some(("request.seed_at".to_owned(), expected));
            }
            return self.fault_of_places(request);
        }
        (self.varies(PitInput::Angle) && self.varies(PitInput::Slip)).then(|| {
            let slip = format!("vary.{}", PitInput::Slip.name());
            (slip, format!("not beside {}, which follows from it", PitInput::Angle.name()))
        })
    }

    /// A place in the request into which two values go, of which one would be lost.
    fn fault_of_places(&self, request: &RequestQuestion) -> Option<(String, String)> {
        let of_vary = |vary: &Vary| -> Vec<(String, String)> {
            vary.at.iter().map(|at| (format!("vary.{}.at", vary.name), at.clone())).collect()
        };
        let of_seed = request.seed_at.iter().map(|at| ("request.seed_at".to_owned(), at.clone()));
        let places: Vec<(String, String)> =
            self.vary.iter().flat_map(of_vary).chain(of_seed).collect();
        let is_within = |at: &str, outer: &str| {
            at.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        places.iter().enumerate().find_map(|(idx, (key, at))| {
            let mut earlier = places.iter().take(idx).map(|(_, at)| at.as_str());
            let other = earlier.find(|other| is_within(at, other) || is_within(other, at))?;
            Some((key.clone(), format!("another place than {other:?}, which has a value already")))
        })
    }
}

/// What of a plan is not as it is here.
fn other(folder: &Path, what: &str, planned: &str, present: &str) -> SweepError {
    let [what, planned, present] = [what, planned, present].map(str::to_owned);
    SweepError::OtherProgram { path: folder.join(PLAN_FILE), what, planned, present }
}

/// Digests of the networks that come with the program.
pub(crate) fn networks(library: &Library) -> Result<BTreeMap<String, String>, SweepError> {
    let choice = ModelChoice::default();
    let both = [library.force_model_digest(&choice)?, library.response_model_digest(&choice)?];
    Ok(both.into_iter().map(|it| (it.network.to_string(), it.sha256)).collect())
}

/// The files that requests read, by their content.
pub(crate) fn files_of(requests: &[Request]) -> Result<Vec<UsedFile>, SweepError> {
    let mut paths: Vec<PathBuf> = requests.iter().flat_map(Request::files_read).collect();
    paths.sort();
    paths.dedup();
    paths.iter().map(|path| used(path)).collect()
}

fn used(path: &Path) -> Result<UsedFile, SweepError> {
    UsedFile::read(path).map_err(|source| SweepError::Input { path: path.to_owned(), source })
}
