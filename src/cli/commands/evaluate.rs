//! `impactlab evaluate`: how well a trained network does.

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::evaluate_force::{self, EvaluateForceArgs};
use crate::cli::commands::evaluate_response::{self, EvaluateResponseArgs};
use crate::cli::console::{Console, Verdict};

/// Measure a trained network against data
#[derive(Debug, Args)]
pub(in crate::cli) struct EvaluateArgs {
    #[command(subcommand)]
    what: EvaluatedNetwork,
}

#[derive(Debug, Subcommand)]
enum EvaluatedNetwork {
    /// The force network beside classic pulse, nearest case and Gaussian processes
    Force(EvaluateForceArgs),
    /// A response network on trajectories
    Response(EvaluateResponseArgs),
}

/// Evaluates what was asked for.
pub(in crate::cli) fn run(
    args: &EvaluateArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.what {
        EvaluatedNetwork::Force(args) => evaluate_force::run(args, console),
        EvaluatedNetwork::Response(args) => evaluate_response::run(args, console),
    }
}
