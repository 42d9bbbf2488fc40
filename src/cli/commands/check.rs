//! `impactlab check`: what is in files and data sets, and what is wrong with them.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::text::print_answer;
use impactlab_core::data::ColumnMap;
use impactlab_core::units::UnitSystem;
use impactlab_study::{CheckRequest, Question};

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
    /// For single files, which column is what: time=1:ms,fx=Kraft X:kN,fy=3:kN
    #[arg(long)]
    map: Option<ColumnMap>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab check datasets
  impactlab check measured.csv --map \"time=1:ms,fx=Kraft X:kN,fy=Kraft Y:kN\"

JSON: impactlab schema check --answer says every key with its unit

Exit code 1 if anything cannot be read or has an error flag.";

/// Checks every path and prints what was found.
pub(in crate::cli) fn run(
    args: &CheckArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let CheckArgs { paths, all, map } = args;
    let request = CheckRequest { paths: paths.clone(), all: *all, map: map.clone() };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    let units = UnitSystem::default();
    console.print(&answer.report, |out| print_answer(out, &answer.report, units))?;
    Ok(Verdict::from_problems(CheckRequest::has_problems(&answer.report)))
}
