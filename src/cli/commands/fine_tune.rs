//! `impactlab fine-tune response`: fine-tunes the response network on trajectories.

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_settings};
use crate::cli::options::{LearningDataArgs, TrainingArgs};
use crate::cli::text::print_trained;
use impactlab_networks::learning::ModelFile;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{FineTuneRequest, Learning, ModelChoice};

/// Fine-tune a network on data of your own
#[derive(Debug, Args)]
pub(in crate::cli) struct FineTuneArgs {
    #[command(subcommand)]
    what: FineTunedNetwork,
}

#[derive(Debug, Subcommand)]
enum FineTunedNetwork {
    /// The response network: force history and vehicle to motion after the impact
    Response(FineTuneResponseArgs),
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
struct FineTuneResponseArgs {
    /// A pre-trained response network: `shipped-pretrained` or a file; without one all layers are
    /// trained, from random weights
    #[arg(long, value_name = "MODEL")]
    model: Option<ModelSource>,
    #[command(flatten)]
    data: LearningDataArgs,
    /// Learn how cars differ too, from data sets of several cars, for cars of which there are no data
    #[arg(long, requires = "model", conflicts_with = "log")]
    fleet: bool,
    #[command(flatten)]
    training: TrainingArgs,
}

const EXAMPLES: &str = "\
Examples:
  impactlab fine-tune response --model shipped-pretrained \\
      --data datasets/trajectories-fea --trajectories 20 --out response.safetensors
  impactlab fine-tune response --data datasets/trajectories-fea --data datasets/trajectories-pulse \\
      --out r.safetensors
  impactlab fine-tune response --model shipped-pretrained --fleet \\
      --data datasets/trajectories-fleet --data datasets/trajectories-fea --out any-car.safetensors
  impactlab fine-tune response --model shipped-pretrained \\
      --log impact.csv --vehicle scaled-target-100 --out scaled.safetensors

A log is smoothed (position, yaw and what else it has of yaw rate and velocity) and taken from the
first contact on. Without a force file the impulse is the one that explains the change of momentum.
With a single log there is nothing to calibrate on: the uncertainty is a guess. Without --config
effects.ridge and effects.common are those for few samples, see --print-config.

A training that was killed goes on with --resume to the same weights as if it had not been.

JSON: impactlab schema fine-tune --answer says every key with its unit;
  and model, the file";

/// Fine-tunes what was asked for.
pub(in crate::cli) fn run(
    args: &FineTuneArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.what {
        FineTunedNetwork::Response(args) => fine_tune_response(args, console),
    }
}

fn fine_tune_response(
    args: &FineTuneResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let learning = if args.fleet { Learning::Fleet } else { Learning::Network };
    let request = FineTuneRequest {
        learning,
        model: args.model.clone().map(ModelChoice::from),
        training: args.training.options(),
        ..args.data.request()
    };
    if args.training.print_config {
        return print_settings(&request.settings(&console.library)?.0, console);
    }
    let existing = args.training.existing(console)?;
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    answer.model.save(&args.training.out, existing)?;
    print_trained(console, &args.training.out, &answer.report)
}
