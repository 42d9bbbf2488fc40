//! What a training reports while it runs: the same for every kind of network, so that one progress
//! bar and one plot serve them all.

use std::fmt;
use std::ops::ControlFlow;

use impactlab_core::jobs::Progress;
use serde::Serialize;

/// The callback of a training. Breaking ends the training, and the weights so far are kept.
pub type TrainingProgress<'a> = dyn FnMut(&TrainingReport) -> ControlFlow<()> + 'a;

/// How far a training has come.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TrainingReport {
    /// Something is fitted before the first epoch or after the last one.
    Fit(FitReport),
    /// An epoch is over.
    Epoch(EpochReport),
}

impl TrainingReport {
    /// The same as of any computation: steps of the fits, or epochs.
    pub fn progress(&self) -> Progress {
        let ((done, total), message) = match self {
            Self::Fit(fit) => ((fit.done, fit.n_steps), fit.to_string()),
            Self::Epoch(epoch) => (epoch.progress(), epoch.to_string()),
        };
        Progress::new(done as u64, total as u64, message)
    }
}

/// How far the fits before the first epoch or after the last one have come.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct FitReport {
    /// Whether the epochs are over.
    pub is_after_epochs: bool,
    /// What is being fitted, for a person: the same for all steps of one fit.
    pub what: String,
    /// Cost of the fit after the latest step, where it is known.
    pub cost: Option<f64>,
    /// Steps of all fits that are over; a fit that ends early counts as all of its steps.
    pub done: usize,
    /// Steps of all fits.
    pub n_steps: usize,
}

/// The steps of all fits before the first epoch or after the last one, as they are reported.
pub(crate) struct FitSteps<'a, 'b> {
    report: &'a mut TrainingProgress<'b>,
    latest: FitReport,
}

impl<'a, 'b> FitSteps<'a, 'b> {
    /// - `n_steps`: steps of all fits.
    pub fn new(
        report: &'a mut TrainingProgress<'b>,
        is_after_epochs: bool,
        n_steps: usize,
    ) -> Self {
        let latest = FitReport { is_after_epochs, n_steps, ..FitReport::default() };
        Self { report, latest }
    }

    /// Says what is fitted from the next report on.
    pub fn name(&mut self, what: impl Into<String>) {
        self.latest.what = what.into();
    }

    /// Says how many steps of all fits are over.
    pub fn at(&mut self, done: usize, cost: Option<f64>) -> ControlFlow<()> {
        (self.latest.done, self.latest.cost) = (done.min(self.latest.n_steps), cost);
        (self.report)(&TrainingReport::Fit(self.latest.clone()))
    }

    /// Says that more steps are over.
    pub fn advance(&mut self, n: usize) -> ControlFlow<()> {
        self.at(self.latest.done + n, None)
    }
}

/// An epoch that is over, and where in its training it stands.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EpochReport {
    /// What happened in the epoch.
    pub summary: EpochSummary,
    /// Epochs of an earlier training from which this one started; they count as epochs too.
    pub n_before: usize,
    /// Epochs at most, with those before.
    pub n_epochs: usize,
    /// The epoch with the best weights so far, where the best are kept and not the last.
    pub best_epoch: Option<usize>,
    /// Which of several trainings it is: 0 for the model itself, then those for the calibration.
    pub training_idx: usize,
    /// Number of trainings.
    pub n_trainings: usize,
    /// Epochs of the other trainings that are over.
    pub n_done_elsewhere: usize,
    /// Epochs still to come one after the other where trainings run side by side, which share the time;
    /// `None` where all do.
    pub rounds_left: Option<usize>,
}

/// What a progress bar or a plot shows of an epoch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EpochSummary {
    /// Number of the epoch over all stages, counted from 1.
    pub epoch: usize,
    /// The part of the training to which the epoch belongs, if there are several.
    pub stage: Option<String>,
    /// Every loss term; the first is the one that is minimised.
    pub losses: Vec<NamedLoss>,
    /// How data and physics balance in the loss, where physics has a weight that changes.
    pub physics: Option<PhysicsBalance>,
    /// Learning rate η of the optimiser at the end of the epoch.
    pub learning_rate: f64,
    /// Norm of the longest gradient before clipping.
    pub gradient_norm: f64,
    /// Duration of the epoch, s; `None` where only the model is left of the training.
    pub seconds: Option<f64>,
}

/// A term of the loss.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NamedLoss {
    /// Its name.
    pub name: &'static str,
    /// Mean over the cases learned from, while the weights changed.
    pub train: f64,
    /// Mean over the validation cases at the end of the epoch, where there are any.
    pub validation: Option<f64>,
}

/// How data and physics balance in the loss.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PhysicsBalance {
    /// Weight λ of the physics.
    pub weight: f64,
    /// Share of the data: `L_data/(L_data + λ L_physics)`.
    pub data_share: f64,
}

impl EpochReport {
    /// Number of the epoch in this training, counted from 1.
    pub fn epoch_in_training(&self) -> usize {
        self.summary.epoch.saturating_sub(self.n_before)
    }

    /// Epochs of this training at most.
    pub fn n_in_training(&self) -> usize {
        self.n_epochs.saturating_sub(self.n_before)
    }

    /// Epochs that are over and epochs at most, over all trainings.
    pub fn progress(&self) -> (usize, usize) {
        let n = self.n_in_training();
        (self.n_done_elsewhere + self.epoch_in_training(), self.n_trainings * n)
    }

    /// Epochs still to come one after the other.
    pub fn n_in_a_row(&self) -> usize {
        let (done, total) = self.progress();
        self.rounds_left.unwrap_or(total.saturating_sub(done))
    }

    /// Share that is done of all trainings, 0 to 1.
    pub fn share_done(&self) -> f64 {
        let (done, total) = self.progress();
        done as f64 / total.max(1) as f64
    }

    /// Where it stands: the calibration's training or the stage, if there are several.
    pub fn part(&self) -> Option<String> {
        match self.training_idx {
            0 => self.summary.stage.clone(),
            idx => Some(format!("calibration {idx} of {}", self.n_trainings - 1)),
        }
    }
}

impl EpochSummary {
    /// The loss that is minimised, over the cases learned from and over the validation cases.
    pub fn total(&self) -> (f64, Option<f64>) {
        self.losses.first().map_or((f64::NAN, None), |loss| (loss.train, loss.validation))
    }
}

/// One line: when, what, and the cost.
impl fmt::Display for FitReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let when = if self.is_after_epochs { "after" } else { "before" };
        write!(f, "{when} the epochs: {}", self.what)?;
        self.cost.map_or(Ok(()), |cost| write!(f, ", cost {cost:.3}"))
    }
}

/// One line: losses, balance, and whether the weights are the best so far.
impl fmt::Display for EpochReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(part) = self.part() {
            write!(f, "{part}, ")?;
        }
        let (train, validation) = self.summary.total();
        write!(f, "loss {train:.4}")?;
        if let Some(validation) = validation {
            write!(f, ", validation {validation:.4}")?;
        }
        if let Some(physics) = self.summary.physics {
            write!(f, ", balance {:.2}", physics.data_share)?;
        }
        match self.best_epoch == Some(self.summary.epoch) {
            true => write!(f, " best"),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> EpochReport {
        let summary = EpochSummary {
            epoch: 7,
            stage: Some("single steps".to_owned()),
            losses: vec![NamedLoss { name: "total", train: 0.25, validation: Some(0.5) }],
            physics: Some(PhysicsBalance { weight: 2.0, data_share: 0.75 }),
            learning_rate: 1e-3,
            gradient_norm: 1.0,
            seconds: Some(0.1),
        };
        EpochReport {
            summary,
            n_before: 5,
            n_epochs: 15,
            best_epoch: Some(7),
            training_idx: 0,
            n_trainings: 3,
            n_done_elsewhere: 0,
            rounds_left: None,
        }
    }

    #[test]
    fn epochs_before_the_training_do_not_count_as_progress() {
        assert_eq!(report().progress(), (2, 30));
        let calibration = EpochReport { training_idx: 2, n_done_elsewhere: 20, ..report() };
        assert_eq!((calibration.progress(), calibration.n_in_a_row()), ((22, 30), 8));
        assert!((calibration.share_done() - 22.0 / 30.0).abs() < 1e-12);
    }

    #[test]
    fn the_steps_of_fits_are_counted_over_all_of_them() {
        let mut told = Vec::new();
        let mut report = |report: &TrainingReport| {
            if let TrainingReport::Fit(fit) = report {
                told.push((fit.to_string(), fit.done, fit.n_steps));
            }
            ControlFlow::Continue(())
        };
        let mut steps = FitSteps::new(&mut report, true, 8);
        steps.name("first");
        let _ = steps.at(3, Some(0.5));
        steps.name("second");
        let _ = steps.advance(0);
        let _ = steps.advance(9);
        let line = |line: &str, done| (format!("after the epochs: {line}"), done, 8);
        let expected = [line("first, cost 0.500", 3), line("second", 3), line("second", 8)];
        assert_eq!(told, expected);
    }

    #[test]
    fn a_line_says_where_the_training_is() {
        let line = "single steps, loss 0.2500, validation 0.5000, balance 0.75 best";
        assert_eq!(report().to_string(), line);
        let calibration = EpochReport { training_idx: 2, best_epoch: None, ..report() };
        assert!(calibration.to_string().starts_with("calibration 2 of 2, loss 0.2500"));
        assert!(calibration.to_string().ends_with("balance 0.75"));
    }
}
