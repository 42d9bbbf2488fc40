//! `impactlab check`: what is in files and data sets, and what is wrong with them.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::text::print_check;
use impactlab_core::data::ColumnMap;
use impactlab_study::CheckRequest;

/// Say what is in files and data sets, in which units, and what is wrong with them
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct CheckArgs {
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
  force_sampling, columns [{column, name, channel, unit, unit_is_stated}], force {axes, impulse_n_s
  [x, y], peak_n, peak_time_s, contact_s [s, s]}, notes, flags}];
  models [{path, kind, name, contents}]; problems [{path, kind, message, columns, map}]

Exit code 1 if anything cannot be read or has an error flag.";

/// Checks every path and prints what was found.
pub(in crate::cli) fn run(
    args: &CheckArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let CheckArgs { paths, all, map } = args;
    let request = CheckRequest { paths: paths.clone(), all: *all, map: map.clone() };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    console.print(&answer.report, |out| print_check(out, &answer.report))?;
    Ok(Verdict::from_problems(!answer.report.ok))
}
