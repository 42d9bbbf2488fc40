//! What `impactlab check` finds, as JSON says it.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use crate::cli::output::word;
use crate::data::{Channel, ColumnProposal, ColumnUse, Flag, Loaded, Severity, map_from_proposals};

/// All that was found.
#[derive(Debug, Default, Serialize)]
pub(super) struct Report {
    pub(super) ok: bool,
    pub(super) datasets: Vec<DatasetReport>,
    pub(super) files: Vec<FileReport>,
    pub(super) models: Vec<ModelReport>,
    pub(super) problems: Vec<ProblemReport>,
}

/// A scenario or vehicle file.
#[derive(Debug, Serialize)]
pub(super) struct ModelReport {
    pub(super) path: PathBuf,
    pub(super) kind: &'static str,
    pub(super) name: String,
}

/// A data set.
#[derive(Debug, Serialize)]
pub(super) struct DatasetReport {
    pub(super) path: PathBuf,
    pub(super) kind: String,
    pub(super) n_cases: usize,
    pub(super) vehicle_file: Option<PathBuf>,
    #[serde(serialize_with = "channels")]
    pub(super) columns: Vec<Channel>,
    pub(super) flags: Vec<CaseFlag>,
    pub(super) n_clean: usize,
    pub(super) clean_cases: Option<Vec<String>>,
    pub(super) problems: Vec<String>,
}

/// A single file.
#[derive(Debug, Serialize)]
pub(super) struct FileReport {
    pub(super) path: PathBuf,
    pub(super) kind: String,
    pub(super) n_samples: usize,
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) encoding: &'static str,
    pub(super) separator: String,
    pub(super) decimal_comma: bool,
    pub(super) force_sampling: Option<String>,
    pub(super) columns: Vec<ColumnReport>,
    pub(super) notes: Vec<String>,
    pub(super) flags: Vec<CaseFlag>,
}

#[derive(Debug, Serialize)]
pub(super) struct ColumnReport {
    pub(super) column: usize,
    pub(super) name: String,
    pub(super) channel: &'static str,
    pub(super) unit: &'static str,
    pub(super) unit_is_stated: bool,
}

/// A flag of a case or a file.
#[derive(Debug, Serialize)]
pub(super) struct CaseFlag {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) case: Option<String>,
    pub(super) kind: String,
    pub(super) severity: String,
    pub(super) message: String,
    pub(super) value: f64,
    pub(super) limit: f64,
    pub(super) time_s: Option<f64>,
    #[serde(skip)]
    pub(super) severity_rank: Severity,
}

/// A path that cannot be read.
#[derive(Debug, Serialize)]
pub(super) struct ProblemReport {
    pub(super) path: PathBuf,
    pub(super) message: String,
    pub(super) columns: Option<Vec<Proposal>>,
    pub(super) map: Option<String>,
}

/// A column of a file that is not understood.
#[derive(Debug, Serialize)]
pub(super) struct Proposal {
    pub(super) column: usize,
    pub(super) name: String,
    pub(super) samples: Vec<String>,
    pub(super) channel: Option<&'static str>,
    pub(super) unit: Option<&'static str>,
}

impl Report {
    /// Whether anything cannot be read or must not be used.
    pub(super) fn has_problems(&self) -> bool {
        let sets = self.datasets.iter();
        let flags = sets.clone().flat_map(|set| &set.flags);
        let mut flags = flags.chain(self.files.iter().flat_map(|file| &file.flags));
        !self.problems.is_empty()
            || sets.clone().any(|set| !set.problems.is_empty())
            || flags.any(|flag| flag.severity_rank == Severity::Error)
    }
}

impl FileReport {
    pub(super) fn new(path: &Path, loaded: &Loaded, flags: Vec<CaseFlag>) -> Self {
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
            notes: loaded.notes.iter().map(ToString::to_string).collect(),
            flags,
        }
    }
}

impl CaseFlag {
    pub(super) fn new(case: Option<String>, flag: &Flag) -> Self {
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

impl Proposal {
    pub(super) fn of(column: &ColumnProposal) -> Self {
        Self {
            column: column.number,
            name: column.name.clone(),
            samples: column.samples.clone(),
            channel: column.guess.map(|(channel, _)| channel.short_name()),
            unit: column.guess.and_then(|(_, unit)| Some(unit?.symbol)),
        }
    }

    /// The mapping that takes what is recognised, if anything is.
    pub(super) fn map(columns: &[ColumnProposal]) -> Option<String> {
        let map = map_from_proposals(columns).to_string();
        (!map.is_empty()).then_some(map)
    }
}

fn channels<S: Serializer>(channels: &[Channel], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Column {
        name: &'static str,
        channel: &'static str,
        unit: &'static str,
    }
    serializer.collect_seq(channels.iter().map(|channel| Column {
        name: channel.header(),
        channel: channel.short_name(),
        unit: channel.quantity().si_unit().symbol,
    }))
}
