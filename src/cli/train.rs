//! `impactlab train force`: trains the force network.

use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, Subcommand};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::output::{print_facts, print_json};
use crate::cli::progress::{complete, with_progress};
use crate::cli::response_training::under_bar;
use crate::cli::run::{Console, Verdict};
use crate::cli::train_response::{self, TrainResponseArgs};
use crate::force::{
    ForceCase, ForceConfig, ForceModel, ForceRecord, ForceTrainSettings, ForceTrainingSet,
    VarianceFactors, train,
};
use crate::learning::ModelFile;

/// Train a network
#[derive(Debug, Args)]
pub(super) struct TrainArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// The force network: scenario to impact force history
    Force(TrainForceArgs),
    /// The response network, on simulations: force history and vehicle to motion after the impact
    Response(TrainResponseArgs),
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
struct TrainForceArgs {
    /// A force data set; a quarter of its cases is kept apart for the test
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// Another force data set, all of it to learn from; may be repeated
    #[arg(long, value_name = "DIR")]
    extra: Vec<PathBuf>,
    /// Where the model goes; the training is kept beside it in MODEL.training
    #[arg(long, value_name = "MODEL")]
    out: PathBuf,
    /// Settings (TOML); what it leaves out keeps its default, see --print-config
    #[arg(long, value_name = "CONFIG.toml")]
    config: Option<PathBuf>,
    /// Epochs at most, instead of the configured number
    #[arg(long)]
    epochs: Option<usize>,
    /// Seed of the split and of all draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Go on from MODEL.training, if it is there
    #[arg(long)]
    resume: bool,
    /// Print the settings as TOML and stop
    #[arg(long)]
    print_config: bool,
}

const EXAMPLES: &str = "\
Examples:
  impactlab train force --data datasets/fea --out force.safetensors
  impactlab train force --data datasets/fea --out force.safetensors --resume --epochs 800
  impactlab train force --data datasets/fea --out x --print-config > config.toml

A training that was killed goes on with --resume to the same weights as if it had not been. The same
seed gives the same weights on the same machine.

JSON: model, data, n_train, n_validation, n_test, n_parameters, seconds, best_epoch, epochs,
  variance_factors, train and validation (losses of the best epoch)";

#[derive(Debug, Serialize)]
struct Answer<'a> {
    model: &'a PathBuf,
    data: &'a str,
    data_digest: &'a str,
    n_train: usize,
    n_validation: usize,
    n_test: usize,
    n_parameters: usize,
    seconds: f64,
    best_epoch: usize,
    epochs: usize,
    variance_factors: VarianceFactors,
    train: Option<crate::force::LossTerms>,
    validation: Option<crate::force::LossTerms>,
}

/// Trains what was asked for.
pub(super) fn run(args: &TrainArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match &args.what {
        What::Force(args) => train_force(args, console),
        What::Response(args) => train_response::run(args, console),
    }
}

fn train_force(args: &TrainForceArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let mut config = match &args.config {
        Some(path) => ForceConfig::load(path)?,
        None => ForceConfig::default(),
    };
    config.training.epochs = args.epochs.unwrap_or(config.training.epochs);
    if args.print_config {
        let text = toml::to_string_pretty(&config).unwrap_or_default();
        write!(console.out, "{text}")?;
        return Ok(Verdict::Clean);
    }
    let load = |path: &PathBuf| -> Result<Vec<ForceCase>, CliError> {
        complete(with_progress(|report| ForceCase::load_all(path, report))?)
    };
    let cases = load(&args.data)?;
    let mut extra = Vec::new();
    for path in &args.extra {
        extra.extend(load(path)?);
    }
    let names: Vec<String> = std::iter::once(&args.data)
        .chain(&args.extra)
        .map(|path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned())
        .collect();
    let share = config.training.test_share;
    let set = ForceTrainingSet::of_split(names.join(" + "), &cases, args.seed, share);
    let set = set.with_extra(&extra);
    let mut checkpoint = args.out.clone().into_os_string();
    checkpoint.push(".training");
    let settings = ForceTrainSettings {
        config,
        seed: args.seed,
        checkpoint: Some(checkpoint.into()),
        resume: args.resume,
    };
    let started = Instant::now();
    let model = under_bar(|report| train(&set, &settings, report))?;
    model.save(&args.out)?;
    print(args, &model, started.elapsed().as_secs_f64(), console)
}

fn print(
    args: &TrainForceArgs,
    model: &ForceModel,
    seconds: f64,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let record: &ForceRecord = model.record();
    let best = record.detail.best_epoch.checked_sub(1).and_then(|idx| record.history.get(idx));
    let answer = Answer {
        model: &args.out,
        data: &record.data,
        data_digest: &record.data_digest,
        n_train: record.train.len(),
        n_validation: record.detail.validation.len(),
        n_test: record.test.len(),
        n_parameters: model.n_parameters(),
        seconds,
        best_epoch: record.detail.best_epoch,
        epochs: record.history.len(),
        variance_factors: record.detail.variance_factors,
        train: best.map(|record| record.detail.train),
        validation: best.map(|record| record.detail.validation),
    };
    if console.json {
        print_json(console.out, &answer)?;
        return Ok(Verdict::Clean);
    }
    let loss = |terms: Option<crate::force::LossTerms>| {
        let shown = |(name, value): (&str, f64)| format!("{name} {value:.4}");
        terms.map_or(String::new(), |terms| terms.named().map(shown).join(", "))
    };
    let facts = [
        ("model", args.out.display().to_string()),
        ("data", answer.data.to_owned()),
        (
            "cases",
            format!(
                "{} to learn, {} to validate, {} kept for the test",
                answer.n_train, answer.n_validation, answer.n_test
            ),
        ),
        ("weights", answer.n_parameters.to_string()),
        ("time", format!("{seconds:.0} s")),
        ("best epoch", format!("{} of {}", answer.best_epoch, answer.epochs)),
        (
            "variance factors",
            format!(
                "{:.2}, {:.2}, {:.2} (latent factors, single instants, duration)",
                answer.variance_factors.shared,
                answer.variance_factors.single,
                answer.variance_factors.duration
            ),
        ),
        ("training", loss(answer.train)),
        ("validation", loss(answer.validation)),
    ];
    print_facts(console.out, &facts)?;
    Ok(Verdict::Clean)
}
