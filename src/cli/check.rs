//! `impactlab check`: what is in files and data sets, and what is wrong with them.

use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use crate::cli::CliError;
use crate::cli::check_report::{
    CaseFlag, DatasetReport, FileReport, ModelReport, ProblemReport, Proposal, Report,
};
use crate::cli::check_text::print_text;
use crate::cli::output::{print_json, word};
use crate::cli::progress::{complete, with_progress};
use crate::cli::run::{Console, Verdict};
use crate::collision::Scenario;
use crate::data::{
    Case, ColumnMap, DataError, Dataset, Loaded, Opened, check_case, check_series, open,
    propose_columns, read_any_series,
};
use crate::error_chain;
use crate::vehicle::VehicleParameters;

/// Say what is in files and data sets, in which units, and what is wrong with them
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct CheckArgs {
    /// Data sets, folders of data sets; force, trajectory and steer files; scenarios and vehicles
    #[arg(value_name = "PATH", required = true)]
    paths: Vec<PathBuf>,
    /// List the cases without a flag, too
    #[arg(long)]
    all: bool,
    /// For single files, which column is what: time=1:ms,fx=Kraft X:kN,fy=3
    #[arg(long)]
    map: Option<ColumnMap>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab check datasets
  impactlab check measured.csv --map \"time=1:ms,fx=Kraft X:kN,fy=Kraft Y:kN\"

JSON: ok; datasets [{path, kind, n_cases, vehicle_file, columns [{name, channel, unit}],
  flags [{case, kind, severity, message, value, limit, time_s}], n_clean, clean_cases (--all),
  problems}]; files [{path, kind, n_samples, start_s, end_s, encoding, separator, decimal_comma,
  force_sampling, columns [{column, name, channel, unit, unit_is_stated}], notes, flags}];
  models [{path, kind, name}]; problems [{path, message, columns, map}]

Exit code 1 if anything cannot be read or has an error flag.";

/// Checks every path and prints what was found.
pub(super) fn run(args: &CheckArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let mut report = Report::default();
    for path in &args.paths {
        check_path(path, args, &mut report)?;
    }
    report.ok = !report.has_problems();
    if console.json {
        print_json(console.out, &report)?;
    } else {
        print_text(console.out, &report)?;
    }
    Ok(Verdict::of(!report.ok))
}

fn check_path(path: &Path, args: &CheckArgs, report: &mut Report) -> Result<(), CliError> {
    if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml")) {
        match model(path) {
            Ok(model) => report.models.push(model),
            Err(error) => report.problems.push(ProblemReport {
                path: path.to_owned(),
                message: error_chain(&error),
                columns: None,
                map: None,
            }),
        }
        return Ok(());
    }
    let opened = match &args.map {
        Some(_) if path.is_dir() => {
            let path = path.to_owned();
            return Err(CliError::MapOfFolder { path });
        }
        Some(map) => read_any_series(path, Some(map)).map(Opened::File),
        None => match with_progress(|progress| open(path, progress)) {
            Ok(outcome) => Ok(complete(outcome)?),
            Err(error) => Err(error),
        },
    };
    match opened {
        Ok(Opened::Dataset(dataset)) => report.datasets.push(dataset_report(&dataset, args.all)),
        Ok(Opened::Collection { datasets, problems }) => {
            let reports = datasets.iter().map(|set| dataset_report(set, args.all));
            report.datasets.extend(reports);
            let problems = problems.iter().map(|error| problem(path, error));
            report.problems.extend(problems);
        }
        Ok(Opened::File(loaded)) => report.files.push(file_report(path, &loaded)),
        Err(error) => report.problems.push(problem(path, &error)),
    }
    Ok(())
}

/// Reads a scenario, known by its striking vehicle, or a vehicle.
fn model(path: &Path) -> Result<ModelReport, CliError> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let is_scenario = text.lines().any(|line| line.trim_start().starts_with("[bullet]"));
    let (kind, name) = if is_scenario {
        ("scenario", Scenario::load(path)?.name)
    } else {
        ("vehicle", VehicleParameters::load(path)?.name)
    };
    Ok(ModelReport { path: path.to_owned(), kind, name })
}

fn dataset_report(dataset: &Dataset, all: bool) -> DatasetReport {
    let flags: Vec<_> = dataset.cases.par_iter().map(check_case).collect();
    let cases = || dataset.cases.iter().zip(&flags);
    let mut found: Vec<CaseFlag> = cases()
        .flat_map(|(case, flags)| {
            let name = |case: &Case| Some(case.name.clone());
            flags.iter().map(move |flag| CaseFlag::new(name(case), flag))
        })
        .collect();
    // Stable, so that cases stay in the order of the table.
    found.sort_by_key(|flag| std::cmp::Reverse(flag.severity_rank));
    let clean = cases().filter(|(_, flags)| flags.is_empty());
    let clean: Vec<String> = clean.map(|(case, _)| case.name.clone()).collect();
    let channels = dataset.cases.first();
    let channels = channels.map(|case| case.series.channels().collect());
    let problems = dataset.problems.iter();
    DatasetReport {
        path: dataset.root.clone(),
        kind: word(&dataset.kind),
        n_cases: dataset.cases.len(),
        vehicle_file: dataset.vehicle_file.clone(),
        columns: channels.unwrap_or_default(),
        flags: found,
        n_clean: clean.len(),
        clean_cases: all.then_some(clean),
        problems: problems.map(|problem| error_chain(problem)).collect(),
    }
}

fn file_report(path: &Path, loaded: &Loaded) -> FileReport {
    let flags = check_series(&loaded.series, loaded.force_sampling());
    let mut flags: Vec<_> = flags.iter().map(|flag| CaseFlag::new(None, flag)).collect();
    flags.sort_by_key(|flag| std::cmp::Reverse(flag.severity_rank));
    FileReport::new(path, loaded, flags)
}

/// A path that cannot be read; if its columns are the reason, with what they look like.
fn problem(path: &Path, error: &DataError) -> ProblemReport {
    let is_about_columns = error.needs_mapping() || matches!(error, DataError::NoSuchColumn { .. });
    let columns = is_about_columns.then(|| propose_columns(path).ok()).flatten();
    ProblemReport {
        path: path.to_owned(),
        message: error_chain(error),
        map: columns.as_deref().and_then(Proposal::map),
        columns: columns.map(|columns| columns.iter().map(Proposal::of).collect()),
    }
}
