//! `impactlab train force`: trains the force network.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_settings};
use crate::cli::options::{TrainingArgs, count};
use crate::cli::text::print_trained;
use impactlab_core::ranges::EPOCHS;
use impactlab_networks::learning::ModelFile;
use impactlab_study::TrainForceRequest;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct TrainForceArgs {
    /// A force data set; a quarter of its cases is kept apart for the test
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Another force data set, all of it to learn from; may be repeated
    #[arg(long, value_name = "DIR")]
    extra: Vec<PathBuf>,
    /// The network in the sizes of the paper instead of the default, which predicts as well
    #[arg(long, conflicts_with = "config")]
    paper: bool,
    /// Epochs at most, instead of the configured number
    #[arg(long, value_parser = count::<usize>(EPOCHS))]
    epochs: Option<usize>,
    #[command(flatten)]
    training: TrainingArgs,
}

const EXAMPLES: &str = "\
Examples:
  impactlab train force --data datasets/fea --out force.safetensors
  impactlab train force --data datasets/fea --out force.safetensors --resume --epochs 800
  impactlab train force --data datasets/fea --out x --print-config > config.toml

A training that was killed goes on with --resume to the same weights as if it had not been. The same
seed gives the same weights on the same machine.

JSON: impactlab schema train-force --answer says every key with its unit;
  and model, the file";

/// Trains and saves the model.
pub(in crate::cli) fn run(
    args: &TrainForceArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = TrainForceRequest {
        data: args.data.clone(),
        extra: args.extra.clone(),
        paper: args.paper,
        epochs: args.epochs,
        training: args.training.options(),
    };
    if args.training.print_config {
        return print_settings(&request.settings()?, console);
    }
    let existing = args.training.existing(console)?;
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    answer.model.save(&args.training.out, existing)?;
    print_trained(console, &args.training.out, &answer.report)
}
