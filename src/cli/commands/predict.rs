//! `impactlab predict`: what trained networks say of a collision.

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::predict_force::{self, PredictForceArgs};
use crate::cli::commands::predict_motion::{self, PredictMotionArgs};
use crate::cli::console::{Console, Verdict};

/// Predict with trained networks: the motion after an impact, or its force alone
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(in crate::cli) struct PredictArgs {
    #[command(subcommand)]
    what: Option<PredictedQuantity>,
    #[command(flatten)]
    motion: Option<PredictMotionArgs>,
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
    match (&args.what, &args.motion) {
        (Some(PredictedQuantity::Force(args)), _) => predict_force::run(args, console),
        (None, Some(args)) => predict_motion::run(args, console),
        (None, None) => Err(CliError::NothingToPredict),
    }
}
