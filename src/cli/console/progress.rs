//! A progress bar on standard error, if somebody looks at it.

use std::io::{IsTerminal, Write, stderr};
use std::ops::ControlFlow;

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::console::within_line;
use impactlab_core::jobs::Progress;
use impactlab_networks::learning::TrainingReport;
use impactlab_study::{Event, Observer};

const TEMPLATE: &str = "{msg} {wide_bar} {pos}/{len} {eta}";

/// Epochs between two lines where nobody looks at a bar.
const EPOCHS_PER_LINE: usize = 10;

/// Does the work under a progress bar, which is gone afterwards. Without a terminal, a training
/// prints a line at the start of each fit and every ten epochs, and other work prints nothing.
pub(in crate::cli) fn under_bar<T>(work: impl FnOnce(&mut Observer<'_>) -> T) -> T {
    let is_seen = stderr().is_terminal();
    let bar = if is_seen { ProgressBar::new(0) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
        bar.set_style(style);
    }
    let mut fits = None;
    let result = work(&mut |event| {
        let (progress, line) = match event {
            Event::Progress(progress) => (progress, None),
            Event::Training(report) => training(report, &mut fits),
            Event::Sampling(_) => return ControlFlow::Continue(()),
        };
        if let (false, Some(line)) = (is_seen, line) {
            // Nobody is left to tell if standard error is closed.
            let _ = writeln!(stderr(), "{}", within_line(&line));
        }
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        bar.set_message(within_line(&progress.message).into_owned());
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    result
}

/// How far a training is, and the line that is due, if any.
///
/// - `fits`: fits before the first epoch that are done, and all of them, as of the report before.
fn training(
    report: &TrainingReport,
    fits: &mut Option<(usize, usize)>,
) -> (Progress, Option<String>) {
    let (done, total, message) = match report {
        TrainingReport::Fit { what, done, n_fits } => (*done, *n_fits, what.clone()),
        TrainingReport::Epoch(epoch) => {
            let (done, total) = epoch.progress();
            (done, total, epoch.to_string())
        }
    };
    let line = match report {
        TrainingReport::Fit { what, done, n_fits } => {
            let is_due = fits.replace((*done, *n_fits)) != Some((*done, *n_fits));
            is_due.then(|| format!("before the epochs: {what}"))
        }
        TrainingReport::Epoch(report) => {
            let (epoch, n, seconds) =
                (report.summary.epoch, report.n_epochs, report.summary.seconds);
            let is_due = epoch.is_multiple_of(EPOCHS_PER_LINE) || epoch == 1;
            let pace = seconds.map_or(String::new(), |seconds| format!(" ({seconds:.2} s)"));
            is_due.then(|| format!("epoch {epoch} of {n}: {message}{pace}"))
        }
    };
    (Progress::new(done as u64, total as u64, message), line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fit_before_the_epochs_is_told_once() {
        let mut fits = None;
        let mut line = |what: &str, done, n_fits| {
            training(&TrainingReport::Fit { what: what.to_owned(), done, n_fits }, &mut fits)
        };
        let (progress, first) = line("fitting crush law 1 of 2, cost 9", 0, 2);
        assert_eq!((progress.done, progress.total), (0, 2));
        assert_eq!(first.as_deref(), Some("before the epochs: fitting crush law 1 of 2, cost 9"));
        assert_eq!(line("fitting crush law 1 of 2, cost 8", 0, 2).1, None);
        assert!(line("fitting crush law 2 of 2, cost 9", 1, 2).1.is_some());
        assert!(line("fitting regression 1 of 4", 0, 4).1.is_some());
    }
}
