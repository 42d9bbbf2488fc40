//! `impactlab impact`: the impulse solution of a scenario.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{UNITS, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::units::UnitSystem;
use impactlab_study::{ImpactRequest, ScenarioChoice};

/// Solve an impact: impulse, velocities after it, delta-v, energy, direction of force
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ImpactArgs {
    /// The scenario: a file, or `pit-right-rear`
    #[arg(value_name = "NAME|FILE")]
    scenario: PathBuf,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
    /// Friction as in the paper: always sliding
    #[arg(long)]
    paper: bool,
}

const EXAMPLES: &str = "\
Example:
  impactlab impact pit-right-rear --units us

The impulse acts ON the struck vehicle. World axes: X along the road, Y to the left; yaw to the
left is positive. PDOF: clockwise from straight ahead, where the force comes from.

JSON: impactlab schema impact --answer says every key with its unit";

/// Solves the scenario and prints the solution.
pub(in crate::cli) fn run(
    args: &ImpactArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let scenario = ScenarioChoice::File(args.scenario.clone());
    let request = ImpactRequest { paper: args.paper, ..ImpactRequest::new(scenario) };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    console.print(&answer.report, |out| print_answer(out, &answer.report, args.units))?;
    Ok(Verdict::Clean)
}
