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
    let mut fitted = None;
    let result = work(&mut |event| {
        let (progress, line) = match event {
            Event::Progress(progress) => (progress, None),
            Event::Training(report) => training(report, &mut fitted),
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
/// - `fitted`: what was fitted before the first epoch or after the last one, as of the report before.
fn training(report: &TrainingReport, fitted: &mut Option<String>) -> (Progress, Option<String>) {
    let progress = report.progress();
    let message = &progress.message;
    let line = match report {
        TrainingReport::Fit(fit) => {
            let before = fitted.replace(fit.what.clone());
            (before.as_ref() != Some(&fit.what)).then(|| message.clone())
        }
        TrainingReport::Epoch(report) => {
            let (epoch, n, seconds) =
                (report.summary.epoch, report.n_epochs, report.summary.seconds);
            let is_due = epoch.is_multiple_of(EPOCHS_PER_LINE) || epoch == 1;
            let pace = seconds.map_or(String::new(), |seconds| format!(" ({seconds:.2} s)"));
            is_due.then(|| format!("epoch {epoch} of {n}: {message}{pace}"))
        }
    };
    (progress, line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_networks::learning::FitReport;

    #[test]
    fn each_fit_is_told_once_and_its_steps_move_the_bar() {
        let mut fitted = None;
        let mut step = |what: &str, done, cost| {
            let (what, n_steps) = (what.to_owned(), 24);
            let fit = FitReport { what, done, n_steps, cost, is_after_epochs: false };
            training(&TrainingReport::Fit(fit), &mut fitted)
        };
        let (progress, first) = step("fitting crush law 1 of 2", 0, Some(9.0));
        assert_eq!((progress.done, progress.total), (0, 24));
        let expected = "before the epochs: fitting crush law 1 of 2, cost 9.000";
        assert_eq!(first.as_deref(), Some(expected));
        let (progress, second) = step("fitting crush law 1 of 2", 1, Some(8.0));
        assert_eq!((progress.done, second), (1, None));
        assert!(progress.message.ends_with("cost 8.000"), "{}", progress.message);
        assert!(step("fitting crush law 2 of 2", 10, Some(9.0)).1.is_some());
        assert!(step("fitting regression 1 of 4", 20, None).1.is_some());
    }

    #[test]
    fn what_is_fitted_after_the_epochs_says_so() {
        let what = "how cars differ, motions of cars that were left out".to_owned();
        let fit = FitReport { is_after_epochs: true, what, n_steps: 5, ..FitReport::default() };
        let (progress, line) = training(&TrainingReport::Fit(fit), &mut None);
        assert_eq!((progress.done, progress.total), (0, 5));
        assert!(line.is_some_and(|line| line.starts_with("after the epochs: how cars differ")));
    }
}
