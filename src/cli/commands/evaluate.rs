//! `impactlab evaluate`: how well a trained network or a reconstruction does.

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::evaluate_force::{self, EvaluateForceArgs};
use crate::cli::commands::evaluate_pairs::{self, EvaluatePairsArgs};
use crate::cli::commands::evaluate_reconstruction::{self, EvaluateReconstructionArgs};
use crate::cli::commands::evaluate_response::{self, EvaluateResponseArgs};
use crate::cli::console::{Console, Verdict};

/// Measure a trained network or reconstructions against data
#[derive(Debug, Args)]
pub(in crate::cli) struct EvaluateArgs {
    #[command(subcommand)]
    what: Evaluated,
}

#[derive(Debug, Subcommand)]
enum Evaluated {
    /// The force network beside classic pulse, nearest case and Gaussian processes
    Force(EvaluateForceArgs),
    /// A response network on trajectories
    Response(EvaluateResponseArgs),
    /// Forecasts of both cars of recorded pairs, through all contacts to the end
    Pairs(EvaluatePairsArgs),
    /// Reconstructed speeds of staged collisions, beside the hand calculation and a swarm's optimum
    Reconstruction(EvaluateReconstructionArgs),
}

/// Evaluates what was asked for.
pub(in crate::cli) fn run(
    args: &EvaluateArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.what {
        Evaluated::Force(args) => evaluate_force::run(args, console),
        Evaluated::Response(args) => evaluate_response::run(args, console),
        Evaluated::Pairs(args) => evaluate_pairs::run(args, console),
        Evaluated::Reconstruction(args) => evaluate_reconstruction::run(args, console),
    }
}
