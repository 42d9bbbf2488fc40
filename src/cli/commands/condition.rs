//! `impactlab condition response`: what a few trajectories of a car say of it, in seconds.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::fine_tune::LogArgs;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{BadCasesArg, OverwriteArg, VehicleArg, count, number};
use crate::cli::text::{Trained, print_response_training};
use crate::data::check_target;
use crate::learning::{ModelFile, TEST_SHARE};
use crate::ranges::{TEST_SHARE as SHARE_OF_TEST, TRAJECTORIES};
use crate::shipped::ModelSource;
use crate::study::{FineTuneRequest, Learning, ModelChoice, TrainingOptions};

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
    /// A trajectory data set of the car, of which a quarter of the cases is kept apart for the test;
    /// several if given again
    #[arg(long, value_name = "DIR", required_unless_present = "log")]
    data: Vec<PathBuf>,
    #[command(flatten)]
    logs: LogArgs,
    /// How many trajectories of each data set to learn from; all that are not kept for the test if not
    /// given
    #[arg(long, value_name = "N", value_parser = count::<usize>(TRAJECTORIES))]
    trajectories: Option<usize>,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// Share of the cases that is kept for the test
    #[arg(long, default_value_t = TEST_SHARE, value_name = "SHARE", value_parser = number(SHARE_OF_TEST))]
    test_share: f64,
    /// Seed of the split
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Seed of the choice of the trajectories; the split's if not given
    #[arg(long)]
    choice: Option<u64>,
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

JSON: as of fine-tune response";

/// Conditions what was asked for.
pub(in crate::cli) fn run(
    args: &ConditionArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let ConditionedNetwork::Response(args) = &args.what;
    let request = FineTuneRequest {
        learning: Learning::Strengths,
        model: Some(ModelChoice::from(args.model.clone())),
        data: args.data.clone(),
        logs: args.logs.logs(),
        trajectories: args.trajectories,
        vehicle: VehicleArg::choice(&args.vehicle),
        test_share: args.test_share,
        choice: args.choice,
        training: TrainingOptions {
            seed: args.seed,
            bad_cases: args.bad_cases.into(),
            ..TrainingOptions::default()
        },
    };
    if !console.print_request {
        check_target(&args.out, args.overwrite.into())?;
    }
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    answer.model.save(&args.out, args.overwrite.into())?;
    let trained = Trained { model: &args.out, report: &answer.report };
    console.print(&trained, |out| print_response_training(out, &trained))?;
    Ok(Verdict::Clean)
}
