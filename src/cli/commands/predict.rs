//! `impactlab predict`: what trained networks say of a collision.

use clap::{ArgGroup, Args, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::predict_force::{self, PredictForceArgs};
use crate::cli::commands::predict_motion::{self, PredictMotionArgs};
use crate::cli::console::{Console, Verdict};
use crate::cli::options::EndingArgs;

/// Predict with trained networks: the motion after an impact, or its force alone
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(group(ArgGroup::new("steering").args(["steer_angle", "steering_wheel"])))]
pub(in crate::cli) struct PredictArgs {
    #[command(subcommand)]
    what: Option<PredictedQuantity>,
    #[command(flatten)]
    motion: Option<PredictMotionArgs>,
    // Not a part of the motion's arguments: clap does not see whether options are given that hold others.
    #[command(flatten)]
    ending: EndingArgs,
}

#[derive(Debug, Subcommand)]
enum PredictedQuantity {
    /// The impact force history of a scenario, with bands
    Force(PredictForceArgs),
}

/// Predicts what was asked for.
pub(in crate::cli) fn run(
    args: &PredictArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let ending = &args.ending;
    match (&args.what, &args.motion) {
        (Some(PredictedQuantity::Force(args)), _) => predict_force::run(args, console),
        (None, Some(args)) => predict_motion::run(args, ending, console),
        (None, None) => Err(CliError::NothingToPredict),
    }
}
