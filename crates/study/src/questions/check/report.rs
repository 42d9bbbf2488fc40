//! What `check` finds, as JSON says it.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use crate::{InputKind, word};
use impactlab_core::data::{
    Case, Channel, ColumnProposal, ColumnUse, Dataset, Flag, ForceHistory, Loaded, ReadSettings,
    Severity, contact_interval, map_from_proposals,
};
use impactlab_core::error_chain;

/// All that was found.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct CheckReport {
    /// Whether nothing is wrong.
    pub ok: bool,
    /// The data sets.
    pub datasets: Vec<DatasetReport>,
    /// The files of time series.
    pub files: Vec<FileReport>,
    /// All other files: cases, evidence, scenarios, vehicles, sites, networks, comparisons.
    pub models: Vec<InputFileReport>,
    /// What cannot be read.
    pub problems: Vec<PathProblem>,
}

/// A file that holds no data of its own: a case, evidence, a scenario, a vehicle, a site and others.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct InputFileReport {
    /// Its path.
    pub path: PathBuf,
    /// What it is.
    pub kind: InputKind,
    /// Its name.
    pub name: String,
    /// What it consists of, where that is told.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contents: Vec<String>,
    /// What of it no answer uses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unused: Vec<String>,
}

impl InputFileReport {
    /// A command that takes the file; `None` if it is not used by itself.
    pub fn command(&self) -> Option<&'static str> {
        match self.contents.first().map(String::as_str).filter(|_| self.kind == InputKind::Network)
        {
            Some("force network") => Some("impactlab evaluate force --model FILE"),
            Some("response network") => Some("impactlab evaluate response --model FILE"),
            Some("training of a force network") => Some("impactlab train force --resume"),
            Some("training of a response network") => Some("impactlab train response --resume"),
            _ => self.kind.command(),
        }
    }
}

/// A data set.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DatasetReport {
    /// Its path.
    pub path: PathBuf,
    /// What it is.
    pub kind: String,
    /// Number of cases that can be read.
    pub n_cases: usize,
    /// Its `vehicle.toml`, if there is one.
    pub vehicle_file: Option<PathBuf>,
    /// Its columns.
    #[serde(serialize_with = "channels")]
    #[schemars(with = "Vec<JsonColumn>")]
    pub columns: Vec<Channel>,
    /// What is suspicious or wrong, the worst first.
    pub flags: Vec<CaseFlag>,
    /// Number of cases without a flag.
    pub n_clean: usize,
    /// The cases without a flag, if they are asked for.
    pub clean_cases: Option<Vec<String>>,
    /// What cannot be read.
    pub problems: Vec<String>,
}

/// A single file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FileReport {
    /// Its path.
    pub path: PathBuf,
    /// What it is.
    pub kind: String,
    /// Number of samples.
    pub n_samples: usize,
    /// First instant, s.
    pub start_s: f64,
    /// Last instant, s.
    pub end_s: f64,
    /// Character encoding.
    pub encoding: &'static str,
    /// What stands between two cells.
    pub separator: String,
    /// Whether decimals are set off by a comma.
    pub decimal_comma: bool,
    /// What a force sample stands for, if there is a force.
    pub force_sampling: Option<String>,
    /// Its columns.
    pub columns: Vec<ColumnReport>,
    /// Its force, if it has one.
    pub force: Option<RecordedForceReport>,
    /// What a person should know about how it was read.
    pub notes: Vec<String>,
    /// What is suspicious or wrong, the worst first.
    pub flags: Vec<CaseFlag>,
}

/// The force of a file, so that a wrong unit is seen at once.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RecordedForceReport {
    /// Axes of the components: `world` or `heading`.
    pub axes: String,
    /// Impulse [x, y] in these axes, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest size of the force, N.
    pub peak_n: f64,
    /// When it is reached, s.
    pub peak_time_s: f64,
    /// First touch and last separation, s; `None` where the force vanishes.
    pub contact_s: Option<[f64; 2]>,
}

/// A column of a file and what it is taken for.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ColumnReport {
    /// Its number, from 1.
    pub column: usize,
    /// Its name.
    pub name: String,
    /// What it is taken for.
    pub channel: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Whether the file states the unit.
    pub unit_is_stated: bool,
}

/// A flag of a case or a file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CaseFlag {
    /// Name of the case; none for a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub case: Option<String>,
    /// What it is.
    pub kind: String,
    /// How bad it is.
    pub severity: String,
    /// For a person.
    pub message: String,
    /// The value that was found.
    pub value: f64,
    /// The limit that it passes.
    pub limit: f64,
    /// When, s.
    pub time_s: Option<f64>,
    /// How bad it is, for sorting.
    #[serde(skip)]
    pub severity_rank: Severity,
}

/// A path that cannot be read.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PathProblem {
    /// Its path.
    pub path: PathBuf,
    /// What it was taken for.
    pub kind: InputKind,
    /// For a person.
    pub message: String,
    /// Its columns.
    pub columns: Option<Vec<ProposedColumn>>,
    /// A column map that takes what is recognised.
    pub map: Option<String>,
}

/// A column of a file that is not understood.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ProposedColumn {
    /// Its number, from 1.
    pub column: usize,
    /// Its name.
    pub name: String,
    /// Its first cells.
    pub samples: Vec<String>,
    /// What it is taken for.
    pub channel: Option<&'static str>,
    /// Its unit.
    pub unit: Option<&'static str>,
}

impl CheckReport {
    /// Whether anything cannot be read or must not be used.
    #[must_use]
    pub fn has_problems(&self) -> bool {
        let sets = self.datasets.iter();
        let flags = sets.clone().flat_map(|set| &set.flags);
        let mut flags = flags.chain(self.files.iter().flat_map(|file| &file.flags));
        !self.problems.is_empty()
            || sets.clone().any(|set| !set.problems.is_empty())
            || flags.any(|flag| flag.severity_rank == Severity::Error)
    }
}

impl DatasetReport {
    /// What is told of a data set.
    ///
    /// - `flags`: of each of its cases;
    /// - `all`: whether cases without a flag are listed.
    pub fn new(dataset: &Dataset, flags: &[Vec<Flag>], all: bool) -> Self {
        let cases = || dataset.cases.iter().zip(flags);
        let mut found: Vec<CaseFlag> = cases()
            .flat_map(|(case, flags)| {
                let name = |case: &Case| Some(case.name.clone());
                flags.iter().map(move |flag| CaseFlag::new(name(case), flag))
            })
            .collect();
        // The sort is stable, so that cases stay in the order of the table.
        found.sort_by_key(|flag| std::cmp::Reverse(flag.severity_rank));
        let clean = cases().filter(|(_, flags)| flags.is_empty());
        let clean: Vec<String> = clean.map(|(case, _)| case.name.clone()).collect();
        let channels = dataset.cases.first().map(|case| case.series.channels().collect());
        Self {
            path: dataset.root.clone(),
            kind: word(&dataset.kind),
            n_cases: dataset.cases.len(),
            vehicle_file: dataset.vehicle_file.clone(),
            columns: channels.unwrap_or_default(),
            flags: found,
            n_clean: clean.len(),
            clean_cases: all.then_some(clean),
            problems: dataset.problems.iter().map(|problem| error_chain(problem)).collect(),
        }
    }
}

impl RecordedForceReport {
    /// Impulse, peak and contact of a file's force; `None` if it has none.
    fn from_loaded(loaded: &Loaded) -> Option<Self> {
        let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling()).ok()?;
        let sizes = force.time_s.iter().zip(force.fx_n.iter().zip(&force.fy_n));
        let sizes = sizes.map(|(time_s, (fx, fy))| (*time_s, fx.hypot(*fy)));
        let (peak_time_s, peak_n) = sizes.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self {
            axes: word(&force.axes),
            impulse_n_s: force.impulse_n_s(),
            peak_n,
            peak_time_s,
            contact_s: contact_interval(&force).map(|(start, end)| [start, end]),
        })
    }
}

impl FileReport {
    /// What is told of a file of time series.
    pub fn new(path: &Path, loaded: &Loaded, flags: &[Flag]) -> Self {
        let mut flags: Vec<CaseFlag> = flags.iter().map(|flag| CaseFlag::new(None, flag)).collect();
        flags.sort_by_key(|flag| std::cmp::Reverse(flag.severity_rank));
        let series = &loaded.series;
        let time = |time: Option<&f64>| time.copied().unwrap_or_default();
        let has = |channel| series.get(channel).is_some();
        let has_force = has(Channel::Fx) || has(Channel::FxBody);
        let column = |column: &ColumnUse| ColumnReport {
            column: column.number,
            name: column.name.clone(),
            channel: column.channel.short_name(),
            unit: column.unit.symbol,
            unit_is_stated: column.unit_is_stated,
        };
        Self {
            path: path.to_owned(),
            kind: word(&loaded.kind),
            n_samples: series.n_samples(),
            start_s: time(series.time_s().first()),
            end_s: time(series.time_s().last()),
            encoding: loaded.encoding,
            separator: word(&loaded.dialect.separator),
            decimal_comma: loaded.dialect.decimal_comma,
            force_sampling: has_force.then(|| word(&loaded.force_sampling())),
            columns: loaded.columns.iter().map(column).collect(),
            force: RecordedForceReport::from_loaded(loaded),
            notes: loaded.notes.iter().map(ToString::to_string).collect(),
            flags,
        }
    }
}

impl CaseFlag {
    /// What is told of a flag; `case` is `None` for a file.
    pub fn new(case: Option<String>, flag: &Flag) -> Self {
        Self {
            case,
            kind: word(&flag.kind),
            severity: word(&flag.severity),
            message: flag.to_string(),
            value: flag.value,
            limit: flag.limit,
            time_s: flag.time_s,
            severity_rank: flag.severity,
        }
    }
}

impl ProposedColumn {
    /// What is told of a column.
    pub fn from_proposal(column: &ColumnProposal) -> Self {
        Self {
            column: column.number,
            name: column.name.clone(),
            samples: column.samples.clone(),
            channel: column.guess.map(|(channel, _)| channel.short_name()),
            unit: column.guess.and_then(|(_, unit)| Some(unit?.symbol)),
        }
    }

    /// The mapping that takes what is recognised, if anything is, from where the settings say.
    pub fn map(columns: &[ColumnProposal], settings: &ReadSettings) -> Option<String> {
        let mut map = map_from_proposals(columns);
        *map.settings = settings.clone();
        let map = map.to_string();
        (!map.is_empty()).then_some(map)
    }
}

/// A column of a data set, as it is told.
#[derive(Serialize, JsonSchema)]
struct JsonColumn {
    /// What its header says.
    name: &'static str,
    /// What it holds.
    channel: &'static str,
    /// Its unit.
    unit: &'static str,
}

fn channels<S: Serializer>(channels: &[Channel], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(channels.iter().map(|channel| JsonColumn {
        name: channel.header(),
        channel: channel.short_name(),
        unit: channel.quantity().si_unit().symbol,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The checkpoint of a training is no network that can be evaluated.
    #[test]
    fn a_network_names_the_command_that_takes_it() {
        let command = |kind, contents: &[&str]| {
            let contents = contents.iter().map(|part| (*part).to_owned()).collect();
            let (path, name) = (PathBuf::from("f"), "f".to_owned());
            InputFileReport { path, kind, name, contents, unused: Vec::new() }.command()
        };
        for (contents, expected) in [
            ("force network", "impactlab evaluate force --model FILE"),
            ("response network", "impactlab evaluate response --model FILE"),
            ("training of a force network", "impactlab train force --resume"),
            ("training of a response network", "impactlab train response --resume"),
        ] {
            assert_eq!(command(InputKind::Network, &[contents]), Some(expected));
        }
        assert_eq!(command(InputKind::Case, &["force network"]), Some("impactlab report FILE"));
    }
}
