//! How the learning rate changes with the steps of training.

use serde::{Deserialize, Serialize};

/// The learning rate as a share of the configured one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Schedule {
    /// Always the configured one.
    Constant,
    /// Rises linearly over the warm-up, then falls along half a cosine.
    ///
    /// ```text
    /// s < w:  (s + 1)/w      else:  e + (1 − e)·½(1 + cos(π·(s − w)/(n − w)))
    /// ```
    WarmupCosine {
        /// w: steps of the warm-up, 0 for none.
        warmup_steps: u64,
        /// n: steps in all; afterwards the share stays at its end.
        total_steps: u64,
        /// e: share of the learning rate at the end, 0 to 1.
        final_share: f64,
    },
}

impl Schedule {
    /// The share at a step.
    ///
    /// - `step`: steps taken before this one.
    /// - returns 0 to 1.
    pub fn share(self, step: u64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::WarmupCosine { warmup_steps, .. } if step < warmup_steps => {
                (step + 1) as f64 / warmup_steps as f64
            }
            Self::WarmupCosine { warmup_steps, total_steps, final_share } => {
                let length = total_steps.saturating_sub(warmup_steps).max(1);
                let done = ((step - warmup_steps) as f64 / length as f64).min(1.0);
                let cosine = 0.5 * (1.0 + (std::f64::consts::PI * done).cos());
                final_share + (1.0 - final_share) * cosine
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_rises_then_falls_to_its_end() {
        let schedule =
            Schedule::WarmupCosine { warmup_steps: 4, total_steps: 14, final_share: 0.1 };
        let expected = [(0, 0.25), (3, 1.0), (4, 1.0), (9, 0.55), (14, 0.1), (1000, 0.1)];
        for (step, expected) in expected {
            let share = schedule.share(step);
            assert!((share - expected).abs() < 1e-12, "step {step}: {share}, not {expected}");
        }
        assert_eq!(Schedule::Constant.share(5), 1.0);
    }

    #[test]
    fn no_schedule_divides_by_zero() {
        let schedule = Schedule::WarmupCosine { warmup_steps: 0, total_steps: 0, final_share: 0.5 };
        assert!((0..3).all(|step| schedule.share(step).is_finite()));
    }
}
