//! The time intervals in which the vehicles touch, from the contact force. The vehicles separate
//! where the contact force vanishes; a gap shorter than 25 ms does not divide a contact pulse.

use crate::data::{ForceHistory, Sampling};

/// Shortest time without contact that separates two pulses, s.
pub const MIN_GAP_S: f64 = 0.025;

/// Share of the peak force up to which the force counts as zero. Computed contact forces are
/// exactly zero outside the contact, measured forces are not.
pub const CONTACT_SHARE_OF_PEAK: f64 = 0.01;

/// Times are written with few digits: a contact that leaves the time of a motion by less is not cut.
pub const TIME_TOLERANCE_S: f64 = 1e-3;

/// A contact that lies partly or wholly outside the time of a motion, so that a part of its impulse
/// would be lost.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "contact from {start_s} s to {end_s} s, expected between 0 s and the end at {duration_s} s; \
     shift the time column or change the duration"
)]
pub struct ContactOutside {
    /// First touch, s.
    pub start_s: f64,
    /// Last separation, s.
    pub end_s: f64,
    /// Duration of the motion, s.
    pub duration_s: f64,
}

/// Checks that the contact lies within a motion from t = 0 to `duration_s`. Samples of a measured
/// force that count as zero ([`CONTACT_SHARE_OF_PEAK`]) may lie outside.
///
/// # Errors
/// [`ContactOutside`].
pub fn check_contact_within(force: &ForceHistory, duration_s: f64) -> Result<(), ContactOutside> {
    match contact_interval(force) {
        Some((start_s, end_s))
            if start_s < -TIME_TOLERANCE_S || end_s > duration_s + TIME_TOLERANCE_S =>
        {
            Err(ContactOutside { start_s, end_s, duration_s })
        }
        _ => Ok(()),
    }
}

/// Start and end of each contact pulse, s, in order of time; empty if the force is zero throughout.
pub fn contact_pulses(force: &ForceHistory) -> Vec<(f64, f64)> {
    let Some((peak_n, _)) = force.peak().filter(|(peak_n, _)| *peak_n > 0.0) else {
        return Vec::new();
    };
    let mut pulses: Vec<(f64, f64)> = Vec::new();
    for (i, (x, y)) in force.fx_n.iter().zip(&force.fy_n).enumerate() {
        if x.hypot(*y) <= CONTACT_SHARE_OF_PEAK * peak_n {
            continue;
        }
        let (start, end) = sample_interval_s(force, i);
        match pulses.last_mut() {
            Some(pulse) if start - pulse.1 < MIN_GAP_S => pulse.1 = end,
            _ => pulses.push((start, end)),
        }
    }
    pulses
}

/// Time of the first touch and of the last separation, s; `None` if the force is zero throughout.
pub fn contact_interval(force: &ForceHistory) -> Option<(f64, f64)> {
    let pulses = contact_pulses(force);
    Some((pulses.first()?.0, pulses.last()?.1))
}

/// Time of the last sample of a record that ends during the contact, s; `None` if the force has come
/// to zero, or is zero throughout.
pub fn cut_at_s(force: &ForceHistory) -> Option<f64> {
    let (peak_n, _) = force.peak().filter(|(peak_n, _)| *peak_n > 0.0)?;
    let (x, y) = force.fx_n.last().zip(force.fy_n.last())?;
    let is_cut = x.hypot(*y) > CONTACT_SHARE_OF_PEAK * peak_n;
    force.time_s.last().copied().filter(|_| is_cut)
}

/// The time interval `(start, end)` that a sample with force stands for, s. With
/// [`Sampling::Instant`] it extends to both neighbouring samples, because the force reaches zero
/// there.
fn sample_interval_s(force: &ForceHistory, i: usize) -> (f64, f64) {
    let time = |i: Option<usize>| i.and_then(|i| force.time_s.get(i)).copied();
    let now = time(Some(i)).unwrap_or_default();
    let (before, after) = (time(i.checked_sub(1)), time(Some(i + 1)));
    let step_after = after.map(|after| after - now);
    let step_before = before.map(|before| now - before);
    let (back, forth) = match force.sampling {
        Sampling::Instant => (step_before, step_after),
        Sampling::CentredMean => {
            let half = |step: Option<f64>, other: Option<f64>| step.or(other).map(|s| s / 2.0);
            (half(step_before, step_after), half(step_after, step_before))
        }
        Sampling::ComingMean => (None, step_after.or(step_before)),
    };
    (now - back.unwrap_or(0.0), now + forth.unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::ForceAxes;

    fn history(sampling: Sampling, fy_n: &[f64]) -> ForceHistory {
        ForceHistory {
            axes: ForceAxes::World,
            sampling,
            time_s: (0..fy_n.len()).map(|i| i as f64 * 0.01).collect(),
            fx_n: vec![0.0; fy_n.len()],
            fy_n: fy_n.to_vec(),
            mz_n_m: None,
        }
    }

    #[test]
    fn the_ends_are_where_the_samples_say_the_force_vanishes() {
        for (sampling, start, end) in [
            (Sampling::Instant, 0.01, 0.05),
            (Sampling::CentredMean, 0.015, 0.045),
            (Sampling::ComingMean, 0.02, 0.05),
        ] {
            let force = history(sampling, &[0.0, 0.0, 5.0, -9.0, 4.0, 0.0]);
            let (from, to) = contact_interval(&force).unwrap();
            assert!((from - start).abs() < 1e-12, "{sampling:?} starts at {from}");
            assert!((to - end).abs() < 1e-12, "{sampling:?} ends at {to}");
        }
        assert_eq!(contact_interval(&history(Sampling::Instant, &[0.0; 4])), None);
        assert_eq!(contact_interval(&history(Sampling::Instant, &[])), None);
    }

    #[test]
    fn a_contact_that_is_cut_at_either_end_is_refused() {
        let force = history(Sampling::Instant, &[0.0, 5.0, 9.0, 5.0, 0.0]);
        let shifted = |by_s: f64| {
            let time_s = force.time_s.iter().map(|t| t + by_s).collect();
            check_contact_within(&ForceHistory { time_s, ..force.clone() }, 1.0)
        };
        assert_eq!(shifted(0.0), Ok(()));
        assert_eq!(shifted(0.96), Ok(()));
        for by_s in [-0.5, -0.02, 0.98, 3.0] {
            let outside = shifted(by_s).unwrap_err();
            assert!((outside.start_s - by_s).abs() < 1e-12, "{by_s}: {outside}");
        }
        // Noise before the contact is no contact.
        let mut early = history(Sampling::Instant, &[0.01, 0.01, 0.0, 5.0, 9.0, 5.0, 0.0]);
        early.time_s.iter_mut().for_each(|t| *t -= 0.015);
        assert_eq!(check_contact_within(&early, 1.0), Ok(()));
    }

    #[test]
    fn short_gaps_do_not_part_a_pulse() {
        let short = [0.0, 5.0, 0.0, 0.0, 5.0, 0.0];
        let long = [0.0, 5.0, 0.0, 0.0, 0.0, 5.0, 0.0];
        let n_pulses = |fy_n| contact_pulses(&history(Sampling::CentredMean, fy_n)).len();
        assert_eq!((n_pulses(&short), n_pulses(&long)), (1, 2));
    }
}
