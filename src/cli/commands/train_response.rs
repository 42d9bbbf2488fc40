//! `impactlab train response`: pre-trains the response network.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_settings};
use crate::cli::options::{TrainingArgs, VehicleArg};
use crate::cli::text::print_trained;
use impactlab_networks::learning::ModelFile;
use impactlab_study::TrainResponseRequest;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct TrainResponseArgs {
    /// A force or trajectory data set: its forces drive the simulations; a quarter of its cases is
    /// left out
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// The struck vehicle: a preset or a file; the data set's own, or the reference car
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// The plain network of the comparison instead: no 4DOF model, no guard, no physics
    #[arg(long)]
    plain: bool,
    #[command(flatten)]
    training: TrainingArgs,
}

const EXAMPLES: &str = "\
Examples:
  impactlab train response --data datasets/fea --out pretrained.safetensors
  impactlab fine-tune response --model pretrained.safetensors \\
      --data datasets/trajectories-fea --trajectories 20 --out response.safetensors

The network learns on simulations of the 4DOF model, under the forces of the data set, what another
vehicle, another road and another speed change. No recorded motion is looked at.

JSON: impactlab schema train-response --answer says every key with its unit;
  and model, the file";

/// Pre-trains and saves the model.
pub(in crate::cli) fn run(
    args: &TrainResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = TrainResponseRequest {
        data: args.data.clone(),
        vehicle: VehicleArg::choice(&args.vehicle),
        plain: args.plain,
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
