//! `impactlab evaluate pairs`: how well both vehicles of recorded pairs are forecast.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{UNITS, Values, count, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::ranges::DRAWS;
use impactlab_core::units::UnitSystem;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{EvaluatePairsRequest, PairSplit, Question};

/// Which cases of the folder.
const CASES: Values<PairSplit> = &[
    (PairSplit::All, "All of them"),
    (
        PairSplit::Fitted,
        "The first half in the order of the SHA-256 of their names, which the contact law was fitted to",
    ),
    (PairSplit::Reported, "The other half"),
];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct EvaluatePairsArgs {
    /// A folder of recorded pairs: cases.csv, cases/CASE.csv and vehicles/CAR.toml
    #[arg(value_name = "DIR")]
    data: PathBuf,
    /// Which of the cases
    #[arg(long, value_parser = one_value_of(CASES), default_value = "all")]
    cases: PairSplit,
    /// Only those of them that have these names
    #[arg(long, num_args = 1.., value_name = "NAME")]
    only: Vec<String>,
    /// Number of draws of each case
    #[arg(long, value_name = "N", default_value_t = EvaluatePairsRequest::new("").draws,
        value_parser = count::<usize>(DRAWS))]
    draws: usize,
    /// Seed of all draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The response network that corrects both cars while they are apart: `shipped` or a file
    #[arg(long, value_name = "MODEL", default_value = "shipped")]
    model: ModelSource,
    /// The equations of motion alone, without the response network
    #[arg(long, conflicts_with = "model")]
    physics_only: bool,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Examples:
  impactlab evaluate pairs datasets/pairs --only d001 d002
  impactlab evaluate pairs datasets/pairs --cases reported --json

A forecast is given the initial states, the data sheets, the friction of the road and what the drivers
did: steer angles, brake and drive torques. It is not given the contact, nor how stiff and how rough the
cars are. Errors are over 4 s from the first contact, of the motion with everything at its median; the turn is
right where the likelier side was the recorded one.

JSON: impactlab schema evaluate-pairs --answer says every key with its unit";

/// Evaluates.
pub(in crate::cli) fn run(
    args: &EvaluatePairsArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = EvaluatePairsRequest {
        data: args.data.clone(),
        split: args.cases,
        only: args.only.clone(),
        draws: args.draws,
        seed: args.seed,
        model: args.model.clone().into(),
        physics_only: args.physics_only,
    };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    let units = args.units;
    console.print(&answer.report, |out| print_answer(out, &answer.report, units))?;
    Ok(Verdict::from_problems(EvaluatePairsRequest::has_problems(&answer.report)))
}
