//! What the commands that train a response network share.

use std::io::{IsTerminal, Write, stderr};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::fine_tune_log::LogFacts;
use crate::cli::output::{print_facts, print_json};
use crate::cli::progress::{complete, with_progress};
use crate::cli::run::{Console, Verdict};
use crate::cli::vehicle_choice::vehicle;
use crate::learning::{TrainingProgress, TrainingReport};
use crate::response::{ResponseCase, ResponseConfig, ResponseLossTerms, ResponseModel};

/// Epochs between two lines where nobody looks at a bar.
const EPOCHS_PER_LINE: usize = 10;

/// Settings of a file, or the defaults.
pub(super) fn config(path: Option<&Path>) -> Result<ResponseConfig, CliError> {
    Ok(match path {
        Some(path) => ResponseConfig::load(path)?,
        None => ResponseConfig::default(),
    })
}

/// Prints settings as TOML.
pub(super) fn print_config(
    config: &ResponseConfig,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    write!(console.out, "{}", toml::to_string_pretty(config).unwrap_or_default())?;
    Ok(Verdict::Clean)
}

/// The trajectories of a data set under a progress bar.
///
/// - `name`: of the vehicle, instead of the data set's own.
pub(super) fn load_cases(root: &Path, name: Option<&str>) -> Result<Vec<ResponseCase>, CliError> {
    let vehicle = name.map(vehicle).transpose()?;
    complete(with_progress(|report| ResponseCase::load_all(root, vehicle.as_ref(), report))?)
}

/// What a data set is called.
pub(super) fn data_name(root: &Path) -> String {
    root.file_name().unwrap_or(root.as_os_str()).to_string_lossy().into_owned()
}

/// Where a training is kept: beside its model.
pub(super) fn checkpoint_of(model: &Path) -> PathBuf {
    let mut path = model.to_owned().into_os_string();
    path.push(".training");
    path.into()
}

/// Trains under a progress bar; without a terminal, prints a line every ten epochs.
pub(super) fn under_bar<T, E: Into<CliError>>(
    train: impl FnOnce(&mut TrainingProgress<'_>) -> Result<T, E>,
) -> Result<T, CliError> {
    let is_seen = stderr().is_terminal();
    let bar = if is_seen { ProgressBar::new(0) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}") {
        bar.set_style(style);
    }
    let model = train(&mut |told: &TrainingReport| {
        let (done, total, line) = match told {
            TrainingReport::Fit { what, done, n_fits } => (*done, *n_fits, what.clone()),
            TrainingReport::Epoch(epoch) => {
                let (done, total) = epoch.progress();
                (done, total, epoch.to_string())
            }
        };
        bar.set_length(total as u64);
        bar.set_position(done as u64);
        if let TrainingReport::Epoch(told) = told
            && !is_seen
        {
            let epoch = told.summary.epoch;
            if epoch.is_multiple_of(EPOCHS_PER_LINE) || epoch == 1 {
                let (n, seconds) = (told.n_epochs, told.summary.seconds);
                let _ = writeln!(stderr(), "epoch {epoch} of {n}: {line} ({seconds:.2} s)");
            }
        }
        bar.set_message(line);
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    model.map_err(Into::into)
}

#[derive(Debug, Serialize)]
struct Answer<'a> {
    model: &'a Path,
    data: &'a str,
    data_digest: &'a str,
    seed: u64,
    n_simulated: usize,
    train: Vec<&'a str>,
    n_test: usize,
    n_parameters: usize,
    seconds: f64,
    epochs: usize,
    loss: Option<ResponseLossTerms>,
    balance: Option<f64>,
    latents: &'a crate::response::LatentScales,
    keeps_latents: bool,
    #[serde(skip_serializing_if = "<[LogFacts]>::is_empty")]
    logs: &'a [LogFacts],
}

/// Prints what was trained.
pub(super) fn print_model(
    (path, model, seconds): (&Path, &ResponseModel, f64),
    logs: &[LogFacts],
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let record = model.record();
    let last = record.history.last();
    let answer = Answer {
        model: path,
        data: &record.data,
        data_digest: &record.data_digest,
        seed: record.seed,
        n_simulated: record.detail.n_simulated,
        train: record.train.iter().map(|case| case.name.as_str()).collect(),
        n_test: record.test.len(),
        n_parameters: model.n_parameters(),
        seconds,
        epochs: record.history.len(),
        loss: last.map(|epoch| epoch.detail.loss),
        balance: last.map(|epoch| epoch.detail.balance),
        latents: model.latents(),
        keeps_latents: record.detail.keeps_latents,
        logs,
    };
    if console.json {
        print_json(console.out, &answer)?;
        return Ok(Verdict::Clean);
    }
    let loss = last.map_or(String::new(), |epoch| {
        let shown = |(name, value): (&str, f64)| format!("{name} {value:.4}");
        epoch.detail.loss.named().map(shown).join(", ")
    });
    let scales = crate::response::LATENT_NAMES
        .iter()
        .zip(answer.latents.scales)
        .map(|(name, scale)| format!("{name} {:.1} %", 100.0 * scale))
        .collect::<Vec<_>>()
        .join(", ");
    let calibrated = match answer.latents.n_calibrated {
        0 if record.detail.keeps_latents => {
            "a guess: the model before, at least the usual".to_owned()
        }
        0 => "usual values".to_owned(),
        n => format!("from {n} trajectories, each unseen"),
    };
    let facts = [
        ("model", path.display().to_string()),
        ("data", answer.data.to_owned()),
        (
            "trajectories",
            format!("{} to learn from, {} kept for the test", answer.train.len(), answer.n_test),
        ),
        ("simulated motions", answer.n_simulated.to_string()),
        ("weights", answer.n_parameters.to_string()),
        ("time", format!("{seconds:.0} s")),
        ("epochs", answer.epochs.to_string()),
        ("uncertainty", format!("{scales} ({calibrated})")),
        ("loss", loss),
    ];
    print_facts(console.out, &facts)?;
    for log in logs {
        writeln!(console.out, "{}", log.shown())?;
    }
    Ok(Verdict::Clean)
}
