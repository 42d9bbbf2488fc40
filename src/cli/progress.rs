//! A progress bar on stderr, if somebody looks at it.

use std::io::{IsTerminal, stderr};
use std::ops::ControlFlow;

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::CliError;
use crate::data::Outcome;
use crate::jobs::{Progress, Report};

const TEMPLATE: &str = "{msg} {wide_bar} {pos}/{len} {eta}";

/// Does the work under a progress bar, which is gone afterwards.
pub(super) fn with_progress<T>(work: impl FnOnce(&mut Report<'_>) -> T) -> T {
    let bar = if stderr().is_terminal() { ProgressBar::new(0) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
        bar.set_style(style);
    }
    let result = work(&mut |progress: Progress| {
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        bar.set_message(progress.message);
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    result
}

/// The result of work that nobody cancels: Ctrl-C ends the whole program.
pub(super) fn complete<T>(outcome: Outcome<T>) -> Result<T, CliError> {
    outcome.complete().ok_or(CliError::Cancelled)
}
