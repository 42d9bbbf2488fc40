//! The time intervals in which the vehicles touch, from the contact force. The vehicles separate
//! where the contact force vanishes; a gap shorter than 25 ms does not divide a contact pulse.
//!
//! A force counts as zero up to 1 % of the peak. Where the noise of a sensor is larger, the force is
//! averaged over some 4 ms, and counts as zero up to four standard deviations of what is left of the
//! noise: else the first and the last sample of the record would be the contact. The noise is taken
//! from the ends of the record, the quieter of which counts: a record may end during the contact.

use std::ops::Range;

use crate::data::{ForceHistory, Sampling};
use crate::numerics::{SIGMA_PER_MAD, median};

/// Shortest time without contact that separates two pulses, s.
pub const MIN_GAP_S: f64 = 0.025;

/// Share of the peak force up to which the force counts as zero. Computed contact forces are
/// exactly zero outside the contact, measured forces are not.
pub const CONTACT_SHARE_OF_PEAK: f64 = 0.01;

/// Standard deviations of the noise up to which a force counts as zero. The magnitude of two components
/// exceeds four once in 3000 independent samples.
const NOISE_FACTOR: f64 = 4.0;
/// Share of the peak that noise does not reach: what lies outside the samples above it is not the core of
/// the contact.
const CORE_SHARE_OF_PEAK: f64 = 0.3;
/// Share of the samples at each end of a record from which noise is estimated, and their smallest
/// number.
const END_SHARE: f64 = 0.1;
const MIN_END_SAMPLES: usize = 22;
/// Smallest number of second differences from which noise is estimated.
const MIN_DIFFERENCES: usize = 20;
/// Time over which a noisy force is averaged, s, and the smallest number of samples.
const NOISE_WINDOW_S: f64 = 0.004;
const MIN_WINDOW: usize = 5;
/// A pulse of a noisy force is one if it rises to this many times what counts as zero.
const LEAST_PULSE: f64 = 2.0;

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
    let Some(signal) = ContactSignal::from_force(force) else {
        return Vec::new();
    };
    // Start, end and largest force.
    let mut pulses: Vec<(f64, f64, f64)> = Vec::new();
    for (i, force_n) in signal.magnitude_n.iter().enumerate() {
        if *force_n <= signal.zero_n {
            continue;
        }
        let (start, end) = sample_interval_s(force, i);
        match pulses.last_mut() {
            Some(pulse) if start - pulse.1 < MIN_GAP_S => {
                (pulse.1, pulse.2) = (end, pulse.2.max(*force_n));
            }
            _ => pulses.push((start, end, *force_n)),
        }
    }
    let is_pulse = |pulse: &(f64, f64, f64)| pulse.2 >= signal.least_pulse_n;
    pulses.into_iter().filter(is_pulse).map(|(start, end, _)| (start, end)).collect()
}

/// The magnitude of a force, with what counts as zero.
struct ContactSignal {
    magnitude_n: Vec<f64>,
    zero_n: f64,
    /// The largest force that a pulse reaches at least.
    least_pulse_n: f64,
}

impl ContactSignal {
    /// `None` if the force is zero throughout.
    fn from_force(force: &ForceHistory) -> Option<Self> {
        let (peak_n, _) = force.peak().filter(|(peak_n, _)| *peak_n > 0.0)?;
        let zero_n = CONTACT_SHARE_OF_PEAK * peak_n;
        let magnitudes = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect();
        let magnitude_n: Vec<f64> = magnitudes(&force.fx_n, &force.fy_n);
        let axes = [&force.fx_n, &force.fy_n];
        let at_end = |end| axes.map(|axis| noise_n(axis, &end)).into_iter().fold(0.0, f64::max);
        let [first_n, last_n] = ends(&magnitude_n, peak_n).map(at_end);
        let noise_n = f64::min(first_n, last_n);
        if NOISE_FACTOR * noise_n <= zero_n {
            return Some(Self { magnitude_n, zero_n, least_pulse_n: 0.0 });
        }
        let window = window(&force.time_s);
        let [x, y] = axes.map(|axis| moving_mean(axis, window));
        let left_n = NOISE_FACTOR * noise_n / (window as f64).sqrt();
        let zero_n = zero_n.max(left_n);
        Some(Self { magnitude_n: magnitudes(&x, &y), zero_n, least_pulse_n: LEAST_PULSE * zero_n })
    }
}

/// The first and the last samples, outside of those that reach [`CORE_SHARE_OF_PEAK`]: ranges of their
/// indices.
fn ends(magnitude_n: &[f64], peak_n: f64) -> [Range<usize>; 2] {
    let is_core = |force_n: &f64| *force_n > CORE_SHARE_OF_PEAK * peak_n;
    let first = magnitude_n.iter().position(is_core).unwrap_or(0);
    let last = magnitude_n.iter().rposition(is_core).unwrap_or(0);
    let n = magnitude_n.len();
    let n_end = ((END_SHARE * n as f64) as usize).max(MIN_END_SAMPLES);
    [0..first.min(n_end), (last + 1).max(n.saturating_sub(n_end))..n]
}

/// Standard deviation of the noise in a component, from second differences at an end of the record,
/// which a slow course of the force leaves small: for white noise they have six times its variance. 0
/// if there are too few samples.
fn noise_n(axis: &[f64], end: &Range<usize>) -> f64 {
    let part = axis.get(end.clone()).unwrap_or_default();
    let sizes: Vec<f64> =
        part.windows(3).map(|window| (window[0] - 2.0 * window[1] + window[2]).abs()).collect();
    if sizes.len() < MIN_DIFFERENCES {
        return 0.0;
    }
    SIGMA_PER_MAD * median(sizes).unwrap_or(0.0) / 6.0_f64.sqrt()
}

/// Number of samples, an odd one, over which a noisy force is averaged.
fn window(time_s: &[f64]) -> usize {
    let step_s = match time_s {
        [first, .., last] => (last - first) / (time_s.len() - 1) as f64,
        _ => return 1,
    };
    ((NOISE_WINDOW_S / step_s).round() as usize).max(MIN_WINDOW) | 1
}

/// Mean over a window of samples around each; at the ends over those that there are.
fn moving_mean(values: &[f64], window: usize) -> Vec<f64> {
    let half = window / 2;
    let mean = |i: usize| {
        let part = &values[i.saturating_sub(half)..(i + half + 1).min(values.len())];
        part.iter().sum::<f64>() / part.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Time of the first touch and of the last separation, s; `None` if the force is zero throughout.
pub fn contact_interval(force: &ForceHistory) -> Option<(f64, f64)> {
    let pulses = contact_pulses(force);
    Some((pulses.first()?.0, pulses.last()?.1))
}

/// Time of the last sample of a record that ends during the contact, s; `None` if the force has come
/// to zero, or is zero throughout.
pub fn cut_at_s(force: &ForceHistory) -> Option<f64> {
    let signal = ContactSignal::from_force(force)?;
    let is_cut = signal.magnitude_n.last().is_some_and(|force_n| *force_n > signal.zero_n);
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

    /// The shipped runs are computed, without noise: nothing is averaged.
    fn shipped() -> ForceHistory {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/fea/forces/c001.csv");
        let loaded = crate::data::read_force_file(std::path::Path::new(path), None).unwrap();
        ForceHistory::from_series(&loaded.series, loaded.force_sampling()).unwrap()
    }

    /// A shipped force with 0.1 s of rest before and after it and noise of a sensor.
    ///
    /// - `share`: standard deviation of the noise in each component as a share of the peak.
    fn noisy(force: &ForceHistory, share: f64, seed: u64) -> ForceHistory {
        let (peak_n, _) = force.peak().unwrap();
        let step_s = force.time_s[1] - force.time_s[0];
        let n_rest = (0.1 / step_s).round() as usize;
        let n = force.time_s.len() + 2 * n_rest;
        let mut state = seed;
        let mut uniform = || {
            // Knuth's linear congruential generator.
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        // A sum of twelve uniform numbers is nearly normal, with a standard deviation of 1.
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let mut with_noise = |axis: &[f64]| -> Vec<f64> {
            let at = |i: usize| i.checked_sub(n_rest).and_then(|i| axis.get(i)).copied();
            (0..n).map(|i| at(i).unwrap_or(0.0) + share * peak_n * normal()).collect()
        };
        let (fx_n, fy_n) = (with_noise(&force.fx_n), with_noise(&force.fy_n));
        let start_s = force.time_s[0] - n_rest as f64 * step_s;
        let time_s = (0..n).map(|i| start_s + i as f64 * step_s).collect();
        ForceHistory { time_s, fx_n, fy_n, mz_n_m: None, ..force.clone() }
    }

    /// The contact was the whole record.
    #[test]
    fn noise_of_a_sensor_does_not_stretch_the_contact() {
        let clean = shipped();
        let (start_s, end_s) = contact_interval(&clean).unwrap();
        let [x, y] = clean.impulse_n_s();
        for share in [0.005, 0.01, 0.02, 0.03, 0.05] {
            for seed in 0..5 {
                let noisy = noisy(&clean, share, seed);
                let (from, to) = contact_interval(&noisy).unwrap();
                let record = format!("noise {share}, seed {seed}: {from} to {to} s");
                assert!((from - start_s).abs() < 0.015, "{record}, without noise from {start_s} s");
                assert!((to - end_s).abs() < 0.005, "{record}, without noise to {end_s} s");
                let ([fx, fy], _) = noisy.cumulative().mean_over(from, to);
                let impulse = [fx, fy].map(|mean_n| mean_n * (to - from));
                let off = (impulse[0] - x).hypot(impulse[1] - y) / x.hypot(y);
                let limit = if share < 0.04 { 0.01 } else { 0.02 };
                assert!(off < limit, "{record}: the impulse is off by {:.2} %", 100.0 * off);
                assert_eq!(cut_at_s(&noisy), None, "{record}");
            }
        }
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
