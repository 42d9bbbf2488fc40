//! `impactlab condition response`: what a few trajectories of a car say of it, in seconds.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{BadCasesArg, LearningDataArgs, OverwriteArg};
use crate::cli::text::print_trained;
use impactlab_networks::learning::ModelFile;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{FineTuneRequest, Learning, ModelChoice, TrainingOptions};

/// Tell a network a few recorded motions of a car: its bands narrow, in seconds
#[derive(Debug, Args)]
pub(in crate::cli) struct ConditionArgs {
    #[command(subcommand)]
    what: ConditionedNetwork,
}

#[derive(Debug, Subcommand)]
enum ConditionedNetwork {
    /// The response network: force history and vehicle to motion after the impact
    Response(ConditionResponseArgs),
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
struct ConditionResponseArgs {
    /// A response network that was trained on a fleet: `shipped` or a file
    #[arg(long, value_name = "MODEL", default_value = "shipped")]
    model: ModelSource,
    #[command(flatten)]
    data: LearningDataArgs,
    /// Seed of the split
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    bad_cases: BadCasesArg,
    /// Where the model goes
    #[arg(long, value_name = "MODEL")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

const EXAMPLES: &str = "\
Examples:
  impactlab condition response --data my-car-trajectories --trajectories 5 --out my-car.safetensors
  impactlab condition response --log impact.csv --vehicle car.toml --out car.safetensors

The effects that the 4DOF model leaves out have strengths that differ from car to car. A network that
was trained on a fleet knows how they are distributed; every trajectory of a car is a Gaussian update
of its own. Other cars are predicted as before. With many trajectories, see fine-tune response.

JSON: as of impactlab fine-tune response";

/// Conditions what was asked for.
pub(in crate::cli) fn run(
    args: &ConditionArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let ConditionedNetwork::Response(args) = &args.what;
    let request = FineTuneRequest {
        learning: Learning::Strengths,
        model: Some(ModelChoice::from(args.model.clone())),
        training: TrainingOptions {
            seed: args.seed,
            bad_cases: args.bad_cases.into(),
            ..TrainingOptions::default()
        },
        ..args.data.request()
    };
    console.check_target(Some(&args.out), args.overwrite.into())?;
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    answer.model.save(&args.out, args.overwrite.into())?;
    print_trained(console, &args.out, &answer.report)
}
