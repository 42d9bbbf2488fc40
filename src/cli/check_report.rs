//! What `impactlab check` prints.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use crate::cli::output::{print_facts, print_table, word};
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
    path: PathBuf,
    kind: String,
    n_samples: usize,
    start_s: f64,
    end_s: f64,
    encoding: &'static str,
    separator: String,
    decimal_comma: bool,
    force_sampling: Option<String>,
    columns: Vec<ColumnReport>,
    notes: Vec<String>,
    flags: Vec<CaseFlag>,
}

#[derive(Debug, Serialize)]
struct ColumnReport {
    column: usize,
    name: String,
    channel: &'static str,
    unit: &'static str,
    unit_is_stated: bool,
}

/// A flag of a case or a file.
#[derive(Debug, Serialize)]
pub(super) struct CaseFlag {
    #[serde(skip_serializing_if = "Option::is_none")]
    case: Option<String>,
    kind: String,
    severity: String,
    message: String,
    value: f64,
    limit: f64,
    time_s: Option<f64>,
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
    column: usize,
    name: String,
    samples: Vec<String>,
    channel: Option<&'static str>,
    unit: Option<&'static str>,
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

/// Prints the report for a person.
pub(super) fn print_text(out: &mut dyn Write, report: &Report) -> io::Result<()> {
    for set in &report.datasets {
        print_dataset(out, set)?;
        writeln!(out)?;
    }
    for file in &report.files {
        print_file(out, file)?;
        writeln!(out)?;
    }
    for problem in &report.problems {
        writeln!(out, "problem: {}", problem.message)?;
        print_proposals(out, problem)?;
        writeln!(out)?;
    }
    for model in &report.models {
        writeln!(
            out,
            "{}: {}, {:?}\n",
            model.path.display(),
            model.kind,
            model.name
        )?;
    }
    let sets = || report.datasets.iter();
    let n_problems = report.problems.len() + sets().map(|set| set.problems.len()).sum::<usize>();
    let n_files = report.files.len() + report.models.len();
    writeln!(
        out,
        "{} with {}, {}; {}",
        counted(report.datasets.len(), "data set"),
        counted(sets().map(|set| set.n_cases).sum(), "case"),
        counted(n_files, "file"),
        counted(n_problems, "problem"),
    )
}

/// `1 case`, `2 cases`.
fn counted(n: usize, what: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {what}{plural}")
}

fn print_dataset(out: &mut dyn Write, set: &DatasetReport) -> io::Result<()> {
    let column = |channel: &Channel| {
        let unit = channel.quantity().si_unit().symbol;
        format!("{} [{unit}]", channel.short_name())
    };
    let columns: Vec<String> = set.columns.iter().map(column).collect();
    let flagged = set.n_cases - set.n_clean;
    let vehicle = set.vehicle_file.as_ref();
    writeln!(out, "{}: {} data set", set.path.display(), set.kind)?;
    let facts = [
        ("  cases", format!("{} ({flagged} with flags)", set.n_cases)),
        (
            "  vehicle",
            vehicle.map_or("not given".to_owned(), |path| path.display().to_string()),
        ),
        ("  columns", columns.join(", ")),
    ];
    print_facts(out, &facts)?;
    print_flags(
        out,
        &set.flags,
        set.clean_cases.as_deref().unwrap_or_default(),
    )?;
    for problem in &set.problems {
        writeln!(out, "  problem: {problem}")?;
    }
    Ok(())
}

fn print_file(out: &mut dyn Write, file: &FileReport) -> io::Result<()> {
    writeln!(out, "{}: {} file", file.path.display(), file.kind)?;
    let decimal = if file.decimal_comma { "comma" } else { "point" };
    let mut facts = vec![
        (
            "  samples",
            format!(
                "{} from {} s to {} s",
                file.n_samples, file.start_s, file.end_s
            ),
        ),
        (
            "  format",
            format!(
                "{}, separated by {}, decimal {decimal}",
                file.encoding, file.separator
            ),
        ),
    ];
    if let Some(sampling) = &file.force_sampling {
        facts.push(("  force is", sampling.replace('_', " ")));
    }
    print_facts(out, &facts)?;
    let row = |column: &ColumnReport| {
        let stated = if column.unit_is_stated { "" } else { "assumed" };
        vec![
            String::new(),
            column.column.to_string(),
            column.name.clone(),
            column.channel.to_owned(),
            column.unit.to_owned(),
            stated.to_owned(),
        ]
    };
    let rows: Vec<_> = file.columns.iter().map(row).collect();
    print_table(out, &["", "column", "name", "channel", "unit", ""], &rows)?;
    for note in &file.notes {
        writeln!(out, "  note: {note}")?;
    }
    print_flags(out, &file.flags, &[])
}

/// Prints flags and the cases without one, the flags first.
fn print_flags(out: &mut dyn Write, flags: &[CaseFlag], clean_cases: &[String]) -> io::Result<()> {
    if flags.is_empty() && clean_cases.is_empty() {
        return Ok(());
    }
    let row = |flag: &CaseFlag| {
        vec![
            String::new(),
            flag.severity.clone(),
            flag.case.clone().unwrap_or_default(),
            flag.kind.replace('_', " "),
            flag.message.clone(),
        ]
    };
    let clean = |case: &String| ["", "clean", case, "", ""].map(str::to_owned).to_vec();
    let flagged = flags.iter().map(row);
    let rows: Vec<_> = flagged.chain(clean_cases.iter().map(clean)).collect();
    print_table(out, &["", "severity", "case", "flag", ""], &rows)
}

fn print_proposals(out: &mut dyn Write, problem: &ProblemReport) -> io::Result<()> {
    let Some(columns) = &problem.columns else {
        return Ok(());
    };
    let row = |column: &Proposal| {
        let unit = column.unit.unwrap_or_default();
        vec![
            String::new(),
            column.column.to_string(),
            column.name.clone(),
            column.channel.unwrap_or("?").to_owned(),
            unit.to_owned(),
            column.samples.join(" "),
        ]
    };
    let rows: Vec<_> = columns.iter().map(row).collect();
    print_table(
        out,
        &["", "column", "name", "channel", "unit", "first values"],
        &rows,
    )?;
    let is_known = |channel: &&str| columns.iter().any(|c| c.channel == Some(*channel));
    let missing = ["time", "fx", "fy"]
        .into_iter()
        .filter(|name| !is_known(name))
        .map(|name| format!("{name}=COLUMN:UNIT"));
    let parts: Vec<String> = problem.map.iter().cloned().chain(missing).collect();
    let map = parts.join(",");
    writeln!(out, "  for a force file, complete: --map \"{map}\"")
}
