//! `impactlab fine-tune response`: fine-tunes the response network on trajectories.

use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::fine_tune_log::{LogArgs, LogFacts};
use crate::cli::response_training::{
    checkpoint_of, config, data_name, load_cases, print_config, print_model, under_bar,
};
use crate::cli::run::{Console, Verdict};
use crate::learning::{ModelFile, TEST_SHARE};
use crate::response::{ResponseCase, ResponseTrainSettings, ResponseTrainingSet, fine_tune};
use crate::shipped::ModelSource;

/// Fine-tune a network on data of your own
#[derive(Debug, Args)]
pub(super) struct FineTuneArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
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
    /// A trajectory data set, of which a quarter of the cases is kept apart for the test; several if
    /// given again
    #[arg(long, value_name = "DIR", required_unless_present = "log")]
    data: Vec<PathBuf>,
    #[command(flatten)]
    logs: LogArgs,
    /// How many trajectories of each data set to learn from; all that are not kept for the test if not
    /// given
    #[arg(long, value_name = "N")]
    trajectories: Option<usize>,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Where the model goes; the training is kept beside it in MODEL.training
    #[arg(long, value_name = "MODEL")]
    out: PathBuf,
    /// Settings (TOML) instead of the model's own; layers must be the same
    #[arg(long, value_name = "CONFIG.toml")]
    config: Option<PathBuf>,
    /// Share of the cases that is kept for the test
    #[arg(long, default_value_t = TEST_SHARE, value_name = "SHARE")]
    test_share: f64,
    /// Seed of the split
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Seed of the choice of the trajectories and of all other draws; the split's if not given
    #[arg(long)]
    choice: Option<u64>,
    /// Go on from MODEL.training, if it is there
    #[arg(long)]
    resume: bool,
    /// Print the settings as TOML and stop
    #[arg(long)]
    print_config: bool,
}

const EXAMPLES: &str = "\
Examples:
  impactlab fine-tune response --model shipped-pretrained \\
      --data datasets/trajectories-fea --trajectories 20 --out response.safetensors
  impactlab fine-tune response --data datasets/trajectories-fea --data datasets/trajectories-pulse \\
      --out r.safetensors
  impactlab fine-tune response --model shipped-pretrained \\
      --log impact.csv --vehicle scaled-target-100 --out scaled.safetensors

A log is smoothed (position, yaw and what else it has of yaw rate and velocity) and taken from the
first contact on. Without a force file the impulse is the one that explains the change of momentum.
With a single log there is nothing to calibrate on: the uncertainty is a guess. Without --config
effects.ridge and effects.common are those for few samples, see --print-config.

A training that was killed goes on with --resume to the same weights as if it had not been.

JSON: model, data, data_digest, seed, n_simulated, train, n_test, n_parameters, seconds, epochs, loss,
  balance, latents, keeps_latents; with --log: logs [{log, start_s, contact_s [s, s] or null, force
  (recorded, estimated, none), impulse_n_s [x, y], n_samples, noise {position_m, velocity_m_s,
  yaw_rad, yaw_rate_rad_s}}]";

/// Fine-tunes what was asked for.
pub(super) fn run(args: &FineTuneArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match &args.what {
        What::Response(args) => fine_tune_response(args, console),
    }
}

fn fine_tune_response(
    args: &FineTuneResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let start = args.model.as_ref().map(ModelSource::response_model).transpose()?;
    let mut config = match (&args.config, &start) {
        (None, Some(start)) => start.config().clone(),
        (path, _) => config(path.as_deref())?,
    };
    if args.config.is_none() && !args.logs.log.is_empty() {
        config.effects = config.effects.few_samples();
    }
    if args.print_config {
        return print_config(&config, console);
    }
    let choice = args.choice.unwrap_or(args.seed);
    let (set, logs) = training_set(args, choice)?;
    let settings = ResponseTrainSettings {
        config,
        seed: choice,
        checkpoint: Some(checkpoint_of(&args.out)),
        resume: args.resume,
    };
    let started = Instant::now();
    let model = under_bar(|report| fine_tune(start.as_ref(), &set, &settings, report))?;
    model.save(&args.out)?;
    print_model((&args.out, &model, started.elapsed().as_secs_f64()), &logs, console)
}

/// Trajectories of the data set, or of the logs and what they are.
fn training_set(
    args: &FineTuneResponseArgs,
    choice: u64,
) -> Result<(ResponseTrainingSet, Vec<LogFacts>), CliError> {
    let name = args.vehicle.as_deref();
    if !args.data.is_empty() {
        let chosen = |data: &PathBuf| -> Result<ResponseTrainingSet, CliError> {
            let cases = load_cases(data, name)?;
            let (name, share) = (data_name(data), args.test_share);
            let set = ResponseTrainingSet::of_split(name, &cases, args.seed, share);
            Ok(set.choose(args.trajectories, choice)?)
        };
        let sets = args.data.iter().map(chosen).collect::<Result<Vec<_>, _>>()?;
        return Ok((ResponseTrainingSet::joined(sets), Vec::new()));
    }
    let (facts, found): (Vec<_>, Vec<_>) =
        args.logs.read(name.unwrap_or_default())?.into_iter().unzip();
    let train: Vec<ResponseCase> = found.into_iter().map(|found| found.case).collect();
    let names: Vec<&str> = train.iter().map(|case| case.name.as_str()).collect();
    Ok((ResponseTrainingSet { name: names.join(", "), train, test: Vec::new() }, facts))
}
