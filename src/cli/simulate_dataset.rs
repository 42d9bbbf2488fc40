//! `impactlab simulate --dataset`: every case against its recorded motion.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::case_choice::{load_dataset, take_case};
use crate::cli::output::{print_json, print_table, word};
use crate::cli::progress::{complete, with_progress};
use crate::cli::run::{Console, Verdict};
use crate::cli::simulate::SimulateArgs;
use crate::cli::simulate_answer::FlagAnswer;
use crate::cli::vehicle_choice::{under, vehicle_or_own};
use crate::compare::{DatasetReplay, ErrorSummary, MotionError, Replay, replay_dataset};
use crate::data::{Dataset, DatasetKind, write_series_csv};
use crate::error_chain;
use crate::numerics::Summary;
use crate::units::{Quantity, UnitSystem};
use crate::vehicle::Integrator;

/// The answer for machines.
#[derive(Debug, Serialize)]
struct Answer<'a> {
    dataset: &'a Path,
    vehicle: String,
    equations: String,
    integrator: String,
    cases: Vec<CaseAnswer<'a>>,
    overall: Option<ErrorSummary>,
    spinning: Option<ErrorSummary>,
    not_spinning: Option<ErrorSummary>,
    failures: Vec<String>,
    out: Option<PathBuf>,
}

#[derive(Debug, Serialize)]
struct CaseAnswer<'a> {
    case: &'a str,
    spin: bool,
    #[serde(flatten)]
    error: &'a MotionError,
    violations: usize,
    flags: Vec<FlagAnswer>,
}

/// Simulates the cases of a data set, writes the trajectories if asked to, prints the errors.
pub(super) fn run(
    args: &SimulateArgs,
    root: &Path,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let mut dataset = trajectories(root)?;
    if let Some(name) = &args.case {
        let case = take_case(&mut dataset, name)?;
        dataset.cases = vec![case];
        dataset.problems.clear();
    }
    let own = dataset.vehicle_file.as_deref();
    let vehicle = vehicle_or_own(args.vehicle.as_deref(), own, root)?;
    let vehicle = under(vehicle, args.equations);
    let integrator: Integrator = args.integrator.into();
    let replay =
        complete(with_progress(|report| replay_dataset(&dataset, &vehicle, integrator, report)))?;
    if let Some(folder) = &args.out {
        write_trajectories(folder, &replay)?;
    }
    let problems = dataset.problems.iter().map(|problem| error_chain(problem));
    let failed = replay.failures.iter().map(|failure| error_chain(failure));
    let summary = |choose: fn(&Replay) -> bool| ErrorSummary::of(&replay.cases, choose);
    let answer = Answer {
        dataset: root,
        vehicle: vehicle.name.clone(),
        equations: word(&vehicle.equations),
        integrator: word(&integrator),
        cases: replay.cases.iter().map(CaseAnswer::of).collect(),
        overall: summary(|_| true),
        spinning: summary(|replay| replay.spin),
        not_spinning: summary(|replay| !replay.spin),
        failures: problems.chain(failed).collect(),
        out: args.out.clone(),
    };
    if console.json {
        print_json(console.out, &answer)?;
    } else {
        print_text(console.out, &answer, args.units.into())?;
    }
    Ok(Verdict::of(!answer.failures.is_empty()))
}

/// Loads a data set of motions.
fn trajectories(root: &Path) -> Result<Dataset, CliError> {
    let dataset = load_dataset(root)?;
    match dataset.kind {
        DatasetKind::Trajectory => Ok(dataset),
        DatasetKind::Force => Err(CliError::WrongKind {
            path: root.to_owned(),
            got: "a data set of forces".to_owned(),
            expected: "one of trajectories",
        }),
    }
}

fn write_trajectories(folder: &Path, replay: &DatasetReplay) -> Result<(), CliError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| CliError::Folder { path: folder.to_owned(), source })?;
    for case in &replay.cases {
        let path = folder.join(format!("{}.csv", case.case));
        write_series_csv(&path, &case.motion.series)?;
    }
    Ok(())
}

impl<'a> CaseAnswer<'a> {
    fn of(replay: &'a Replay) -> Self {
        Self {
            case: &replay.case,
            spin: replay.spin,
            error: &replay.error,
            violations: replay.violations,
            flags: replay.motion.flags.iter().map(FlagAnswer::from).collect(),
        }
    }
}

fn print_text(out: &mut dyn Write, answer: &Answer<'_>, units: UnitSystem) -> io::Result<()> {
    let length = Quantity::Length.display_unit(units);
    let degrees = Quantity::Angle.display_unit(units);
    writeln!(out, "{}: {}, {}\n", answer.dataset.display(), answer.vehicle, answer.integrator)?;
    let row = |case: &CaseAnswer<'_>| {
        let flags: Vec<&str> = case.flags.iter().map(|f| f.message.as_str()).collect();
        let error = case.error;
        vec![
            case.case.to_owned(),
            if case.spin { "spin" } else { "" }.to_owned(),
            format!("{:.3}", length.from_si(error.average_error_m)),
            format!("{:.3}", length.from_si(error.final_error_m)),
            format!("{:.1}", degrees.from_si(error.final_heading_error_rad)),
            flags.join("; "),
        ]
    };
    let rows: Vec<_> = answer.cases.iter().map(row).collect();
    let average = format!("average error [{}]", length.symbol);
    let last = format!("final error [{}]", length.symbol);
    let heading = format!("final heading error [{}]", degrees.symbol);
    let header = ["case", "motion", &average, &last, &heading, "flags"];
    print_table(out, &header, &rows)?;
    writeln!(out)?;
    let groups = [
        ("all", &answer.overall),
        ("spinning", &answer.spinning),
        ("not spinning", &answer.not_spinning),
    ];
    let summaries =
        groups.into_iter().filter_map(|(name, summary)| Some((name, summary.as_ref()?)));
    let rows: Vec<_> = summaries
        .flat_map(|(name, summary)| {
            [
                summary_row(name, &average, &summary.average_error_m, length.si_per_unit),
                summary_row(name, &last, &summary.final_error_m, length.si_per_unit),
                summary_row(name, &heading, &summary.final_heading_error_rad, degrees.si_per_unit),
            ]
        })
        .collect();
    let header = ["cases", "", "n", "mean", "std", "median", "p90", "max"];
    print_table(out, &header, &rows)?;
    for failure in &answer.failures {
        writeln!(out, "failed: {failure}")?;
    }
    if let Some(folder) = &answer.out {
        writeln!(out, "written: {}", folder.display())?;
    }
    Ok(())
}

fn summary_row(name: &str, what: &str, summary: &Summary, si_per_unit: f64) -> Vec<String> {
    let Summary { n, mean, std, median, p90, max, .. } = *summary;
    let figures = [mean, std, median, p90, max].map(|value| format!("{:.3}", value / si_per_unit));
    let words = [name.to_owned(), what.to_owned(), n.to_string()];
    words.into_iter().chain(figures).collect()
}
