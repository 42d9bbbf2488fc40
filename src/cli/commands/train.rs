//! `impactlab train`: trains a network.

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::train_force::{self, TrainForceArgs};
use crate::cli::commands::train_response::{self, TrainResponseArgs};
use crate::cli::console::{Console, Verdict};

/// Train a network
#[derive(Debug, Args)]
pub(in crate::cli) struct TrainArgs {
    #[command(subcommand)]
    what: TrainedNetwork,
}

#[derive(Debug, Subcommand)]
enum TrainedNetwork {
    /// The force network: scenario to impact force history
    Force(TrainForceArgs),
    /// The response network, on simulations: force history and vehicle to motion after the impact
    Response(TrainResponseArgs),
}

/// Trains what was asked for.
pub(in crate::cli) fn run(
    args: &TrainArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.what {
        TrainedNetwork::Force(args) => train_force::run(args, console),
        TrainedNetwork::Response(args) => train_response::run(args, console),
    }
}
