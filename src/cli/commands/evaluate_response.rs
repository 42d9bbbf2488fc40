//! `impactlab evaluate response`: how well a response network does on a data set.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::commands::compare::print_comparison;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{BadCasesArg, OverwriteArg, SPLITS, VehicleArg, one_value_of};
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{EvaluateResponseRequest, EvaluatedCases};

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct EvaluateResponseArgs {
    /// A fine-tuned response network: `shipped` or a file
    #[arg(long, value_name = "MODEL")]
    model: ModelSource,
    /// A trajectory data set
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Which of its cases
    #[arg(long, value_parser = one_value_of(SPLITS), default_value = "test")]
    split: EvaluatedCases,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// Seed of the clusters
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    bad_cases: BadCasesArg,
    /// Folder for comparison.json, comparison.md and the tables as CSV
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

const EXAMPLES: &str = "\
Example:
  impactlab evaluate response --model shipped --data datasets/trajectories-fea --json

--split test: the trajectories that the model was not trained on, recognised by their content; if the
model knows which were kept for its test, those of them that are there.

JSON: impactlab schema evaluate-response --answer says every key with its unit";

/// Evaluates.
pub(in crate::cli) fn run(
    args: &EvaluateResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = EvaluateResponseRequest {
        model: args.model.clone().into(),
        data: args.data.clone(),
        split: args.split,
        vehicle: VehicleArg::choice(&args.vehicle),
        seed: args.seed,
        bad_cases: args.bad_cases.into(),
    };
    print_comparison(&request, args.out.as_deref(), args.overwrite.into(), console)
}
