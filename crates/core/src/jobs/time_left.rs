//! The time that work still takes, estimated from its reports so that the number does not jump.

use std::time::Duration;

use crate::jobs::Progress;

/// Shortest time over which what is shown approaches a new estimate, s, and its share of the estimate, or
/// of the time since the start if that is less, where that is longer.
const SMOOTHING_S: f64 = 5.0;
const SMOOTHING_SHARE: f64 = 0.1;
/// What is left at least of work that goes on, s.
const LEAST_S: f64 = 1.0;

/// The estimated time left of some work.
///
/// The estimate is the work left times the mean pace, in which what was done later counts more:
///
/// ```text
/// pace = T/U      T ← w T + Δt,  U ← w U + Δdone,  w = t/(t + Δt)
/// ```
///
/// What is shown counts down as time passes and approaches the estimate meanwhile. It rises no faster than
/// time passes, unless the amount of work has changed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TimeLeft {
    /// When the work began, s.
    start_s: f64,
    /// The latest report after which more was done than before.
    latest: Option<Report>,
    /// T and U.
    took_s: f64,
    units: f64,
    /// What is shown at the latest report, s.
    left_s: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Report {
    at_s: f64,
    done: u64,
    total: u64,
}

impl TimeLeft {
    /// Takes in a report. Less done than before means that other work has begun.
    ///
    /// - `at`: time of the report since the start.
    pub fn take(&mut self, at: Duration, progress: &Progress) {
        let &Progress { done, done_before, total, .. } = progress;
        let now = Report { at_s: at.as_secs_f64(), done, total };
        let before = match self.latest {
            Some(latest) if latest.total > 0 && total > 0 && latest.done <= done => latest,
            None if total > 0 && done > done_before => {
                Report { at_s: 0.0, done: done_before, total }
            }
            _ => return *self = Self { start_s: now.at_s, latest: Some(now), ..Self::default() },
        };
        if done > before.done {
            self.advance(before, now);
        }
    }

    fn advance(&mut self, before: Report, now: Report) {
        let passed_s = (now.at_s - before.at_s).max(0.0);
        let age_s = (now.at_s - self.start_s).max(f64::MIN_POSITIVE);
        let weight = ((before.at_s - self.start_s) / age_s).clamp(0.0, 1.0);
        self.took_s = weight * self.took_s + passed_s;
        self.units = weight * self.units + (now.done - before.done) as f64;
        let estimate_s = self.took_s / self.units * now.total.saturating_sub(now.done) as f64;
        let shown = self.left_s.filter(|_| before.total == now.total);
        let left_s = shown.map_or(estimate_s, |left_s| {
            let counted_s = (left_s - passed_s).max(0.0);
            let smoothing_s = SMOOTHING_S.max(SMOOTHING_SHARE * estimate_s.min(age_s));
            let share = 1.0 - (-passed_s / smoothing_s).exp();
            (counted_s + share * (estimate_s - counted_s)).min(left_s + passed_s)
        });
        (self.left_s, self.latest) = (Some(left_s), Some(now));
    }

    /// The time left; `None` before anything was done, while the amount of work is unknown, and once all that
    /// was counted is done: how long work takes that goes on after that is not known.
    ///
    /// - `at`: time since the start.
    pub fn at(&self, at: Duration) -> Option<Duration> {
        let latest = self.latest.filter(|latest| latest.done < latest.total)?;
        let passed_s = at.as_secs_f64() - latest.at_s;
        Duration::try_from_secs_f64((self.left_s? - passed_s).max(LEAST_S)).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times left, s, at each report but the last of work whose units take times in s.
    fn shown(seconds: &[f64]) -> Vec<(f64, f64)> {
        let (mut left, mut at_s) = (TimeLeft::default(), 0.0);
        let report = |(i, unit_s): (usize, &f64)| {
            at_s += unit_s;
            let at = Duration::from_secs_f64(at_s);
            left.take(at, &Progress::new(i as u64 + 1, seconds.len() as u64, ""));
            (at_s, left.at(at).expect("something was done").as_secs_f64())
        };
        seconds.iter().enumerate().take(seconds.len() - 1).map(report).collect()
    }

    #[test]
    fn even_work_counts_down() {
        for (at_s, left_s) in shown(&[2.0; 50]) {
            assert!((left_s - (100.0 - at_s).max(LEAST_S)).abs() < 1e-6, "{left_s} at {at_s}");
        }
    }

    #[test]
    fn uneven_work_does_not_make_the_time_left_jump() {
        let seconds: Vec<f64> = (0..200).map(|i| if i % 7 == 0 { 6.0 } else { 0.5 }).collect();
        let all_s: f64 = seconds.iter().sum();
        let shown = shown(&seconds);
        for pair in shown.windows(2) {
            let ([from_s, to_s], passed_s) = ([pair[0].1, pair[1].1], pair[1].0 - pair[0].0);
            assert!(to_s <= from_s + passed_s + 1e-9, "{pair:?}");
        }
        for (at_s, left_s) in shown.iter().skip(100) {
            assert!((left_s - (all_s - at_s)).abs() < 15.0, "{left_s} at {at_s} of {all_s}");
        }
    }

    #[test]
    fn work_counts_down_between_reports_and_other_work_begins_anew() {
        let mut left = TimeLeft::default();
        let seconds = Duration::from_secs;
        left.take(seconds(1), &Progress::new(0, 5, "a"));
        assert_eq!(left.at(seconds(2)), None);
        left.take(seconds(11), &Progress::new(1, 5, "a"));
        left.take(seconds(15), &Progress::new(1, 5, "a"));
        assert_eq!(left.at(seconds(16)), Some(seconds(35)));
        assert_eq!(left.at(seconds(90)), Some(seconds(1)));
        left.take(seconds(60), &Progress::new(0, 3, "b"));
        assert_eq!(left.at(seconds(60)), None);
        left.take(seconds(62), &Progress::new(1, 3, "b"));
        assert_eq!(left.at(seconds(62)), Some(seconds(4)));
        // “100 %, 1 s left” stood there for a minute, in which the data that were counted were checked.
        left.take(seconds(63), &Progress::new(3, 3, "b"));
        assert_eq!(left.at(seconds(63)), None);
        left.take(seconds(64), &Progress::new(2, 0, "unknown"));
        assert_eq!(left.at(seconds(64)), None);
    }
}
