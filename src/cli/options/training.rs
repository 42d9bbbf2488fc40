//! What every command that trains takes as options.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::Console;
use crate::cli::options::{BadCasesArg, OverwriteArg};
use impactlab_core::data::Existing;
use impactlab_study::{TrainingOptions, checkpoint_beside};

/// Where a model goes and how it is trained.
#[derive(Debug, Args)]
pub(in crate::cli) struct TrainingArgs {
    /// Where the model goes; the training is kept beside it in MODEL.training
    #[arg(long, value_name = "MODEL")]
    pub(in crate::cli) out: PathBuf,
    /// Settings (TOML) instead of the model's own or the defaults; what the file leaves out keeps its
    /// default, see --print-config
    #[arg(long, value_name = "CONFIG.toml")]
    config: Option<PathBuf>,
    /// Seed of the split and, where no other is given, of all draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    bad_cases: BadCasesArg,
    /// Go on from MODEL.training, if it is there
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Print the settings as TOML and stop
    #[arg(long)]
    pub(in crate::cli) print_config: bool,
}

impl TrainingArgs {
    /// As a request has them.
    pub(in crate::cli) fn options(&self) -> TrainingOptions {
        TrainingOptions {
            config: self.config.clone().into(),
            seed: self.seed,
            bad_cases: self.bad_cases.into(),
            checkpoint: Some(checkpoint_beside(&self.out)),
            resume: self.resume,
            overwrite: self.overwrite.is_given(),
        }
    }

    /// Whether the model may replace a file: the one of the training that goes on, or any where
    /// that was said.
    ///
    /// # Errors
    /// What stands in the way of the model, so that it is told before the training begins. A
    /// training that exists and is not to go on is refused by the question itself.
    pub(in crate::cli) fn existing(&self, console: &mut Console<'_>) -> Result<Existing, CliError> {
        let existing = match checkpoint_beside(&self.out).exists() {
            true => Existing::Replace,
            false => self.overwrite.into(),
        };
        console.check_target(Some(&self.out), existing)?;
        console.keeps(Some(&checkpoint_beside(&self.out)));
        Ok(existing)
    }
}
