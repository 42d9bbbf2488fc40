//! Channel frequency classes of crash tests: a phaseless low-pass filter.
//!
//! Source: [`SaeJ211`](crate::bibliography::SaeJ211), appendix C: two-pole Butterworth, run forward
//! and backward. The standard leaves the ends open; here see [`ChannelFilter::apply`].

use std::f64::consts::{SQRT_2, TAU};

use serde::{Deserialize, Serialize};

use crate::data::ForceHistory;

/// Design frequency of the two-pole filter over the class's number, SAE J211 appendix C: two runs
/// then give −3 dB at 1.65 times the class.
const DESIGN_RATIO: f64 = 2.0775;

/// SAE J211: sampling rate at least ten times the class.
const MIN_RATE_RATIO: f64 = 10.0;

/// Padding at each end, in periods of the class: the slowest pole has decayed by
/// `exp(−2π · 2.0775 / √2 · 4) = 1e-16` there.
const PAD_PERIODS: f64 = 4.0;

/// Steps may differ by this share of their mean (times are often written with few digits).
const STEP_TOLERANCE: f64 = 0.01;

/// A channel frequency class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ChannelClass {
    /// CFC 60, −3 dB at 100 Hz: vehicle accelerations for comparison, barrier forces.
    Cfc60,
    /// CFC 180, −3 dB at 300 Hz: vehicle accelerations for integration.
    Cfc180,
    /// CFC 600, −3 dB at 1000 Hz: component tests.
    Cfc600,
    /// CFC 1000, −3 dB at 1650 Hz: head accelerations.
    Cfc1000,
}

/// The filter of a class at a sampling rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelFilter {
    a: [f64; 3],
    b: [f64; 2],
    n_pad: usize,
}

/// A signal that cannot be filtered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// Too few samples a second.
    #[error(
        "{rate_hz:.0} samples a second are too few for CFC {class_hz:.0}, expected {expected_hz:.0}"
    )]
    RateTooLow {
        /// Samples a second.
        rate_hz: f64,
        /// The class's number.
        class_hz: f64,
        /// The least that is needed.
        expected_hz: f64,
    },
    /// Fewer than two samples, or a time that does not rise: no sampling rate.
    #[error("{n_samples} samples over {duration_s} s have no sampling rate")]
    NoRate {
        /// Number of samples.
        n_samples: usize,
        /// Last time less the first, s.
        duration_s: f64,
    },
    /// Steps of different length: resample first.
    #[error(
        "the step before sample {sample_idx} is {step_s} s, expected {expected_s} s throughout"
    )]
    Uneven {
        /// The sample after the step.
        sample_idx: usize,
        /// The step, s.
        step_s: f64,
        /// The mean step, s.
        expected_s: f64,
    },
    /// Not a number or infinite: it would spread over the whole signal.
    #[error("sample {sample_idx} is {value}, expected a finite number")]
    NotFinite {
        /// Which sample.
        sample_idx: usize,
        /// Its value.
        value: f64,
    },
    /// A column that does not fit the time axis.
    #[error("{got} samples over {expected} times")]
    Length {
        /// Times.
        expected: usize,
        /// Samples.
        got: usize,
    },
}

impl ChannelClass {
    /// All four, from the lowest.
    pub const ALL: [Self; 4] = [Self::Cfc60, Self::Cfc180, Self::Cfc600, Self::Cfc1000];

    /// The class's number.
    pub fn class_hz(self) -> f64 {
        match self {
            Self::Cfc60 => 60.0,
            Self::Cfc180 => 180.0,
            Self::Cfc600 => 600.0,
            Self::Cfc1000 => 1000.0,
        }
    }

    /// What a plot or a table calls it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Cfc60 => "CFC 60",
            Self::Cfc180 => "CFC 180",
            Self::Cfc600 => "CFC 600",
            Self::Cfc1000 => "CFC 1000",
        }
    }
}

impl ChannelFilter {
    /// The filter of a class for this sample interval T.
    ///
    /// ```text
    /// ω_d = 2π · CFC · 2.0775     ω_a = tan(ω_d T/2)     D = 1 + √2 ω_a + ω_a²
    /// a0 = a2 = ω_a²/D    a1 = 2 a0    b1 = −2(ω_a² − 1)/D    b2 = (−1 + √2 ω_a − ω_a²)/D
    /// y_k = a0 x_k + a1 x_{k−1} + a2 x_{k−2} + b1 y_{k−1} + b2 y_{k−2}
    /// ```
    ///
    /// # Errors
    /// [`FilterError::RateTooLow`] below ten samples a period of the class (SAE J211), which also
    /// keeps the design frequency well below half the sampling rate.
    pub fn new(class: ChannelClass, sample_interval_s: f64) -> Result<Self, FilterError> {
        let class_hz = class.class_hz();
        let rate_hz = 1.0 / sample_interval_s;
        let expected_hz = MIN_RATE_RATIO * class_hz;
        // A rate that is exact but for rounding, or for the digits of the time axis, will do.
        let enough = rate_hz >= expected_hz * (1.0 - 1e-6);
        if !(sample_interval_s > 0.0 && enough && rate_hz.is_finite()) {
            return Err(FilterError::RateTooLow { rate_hz, class_hz, expected_hz });
        }
        let w_d = TAU * class_hz * DESIGN_RATIO;
        let w_a = (w_d * sample_interval_s / 2.0).tan();
        let d = 1.0 + SQRT_2 * w_a + w_a * w_a;
        let a0 = w_a * w_a / d;
        Ok(Self {
            a: [a0, 2.0 * a0, a0],
            b: [-2.0 * (w_a * w_a - 1.0) / d, (-1.0 + SQRT_2 * w_a - w_a * w_a) / d],
            n_pad: (PAD_PERIODS * rate_hz / class_hz).ceil() as usize,
        })
    }

    /// Runs the filter forward and backward: no phase shift, gain 1 at rest.
    ///
    /// Each end is continued by its point reflection (`2 x₀ − x_k`), again and again if the signal
    /// is shorter than the padding, and the filter starts settled at the outermost value. So a
    /// constant comes back exactly, a ramp keeps its ends, and the end values are kept roughly: a
    /// signal that is cut off in full swing is not pulled to zero.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`].
    pub fn apply(&self, samples: &[f64]) -> Result<Vec<f64>, FilterError> {
        if let Some((sample_idx, &value)) = samples.iter().enumerate().find(|(_, x)| !x.is_finite())
        {
            return Err(FilterError::NotFinite { sample_idx, value });
        }
        let (Some(&first), n) = (samples.first(), samples.len()) else {
            return Ok(Vec::new());
        };
        let pad = self.n_pad as i64;
        // Less its first value, so that rounding scales with the signal's swing, not its level.
        let mut padded: Vec<f64> =
            (-pad..n as i64 + pad).map(|i| reflected(samples, i) - first).collect();
        self.run(&mut padded);
        padded.reverse();
        self.run(&mut padded);
        padded.reverse();
        let inner = padded.into_iter().skip(self.n_pad).take(n);
        Ok(inner.map(|y| y + first).collect())
    }

    fn run(&self, signal: &mut [f64]) {
        let Some(&first) = signal.first() else { return };
        let ([a0, a1, a2], [b1, b2]) = (self.a, self.b);
        let (mut x1, mut x2, mut y1, mut y2) = (first, first, first, first);
        for sample in signal {
            let x = *sample;
            let y = a0 * x + a1 * x1 + a2 * x2 + b1 * y1 + b2 * y2;
            (x2, x1, y2, y1) = (x1, x, y1, y);
            *sample = y;
        }
    }
}

/// Filters a column over a time axis of even steps.
///
/// # Errors
/// All of [`FilterError`].
pub fn filter_channel(
    class: ChannelClass,
    time_s: &[f64],
    samples: &[f64],
) -> Result<Vec<f64>, FilterError> {
    let (expected, got) = (time_s.len(), samples.len());
    if got != expected {
        return Err(FilterError::Length { expected, got });
    }
    ChannelFilter::new(class, even_step_s(time_s)?)?.apply(samples)
}

/// Filters every component of a force history. Its impulse stays, but for what the filter smears
/// over the ends: leave a quiet stretch before and after the pulse.
///
/// # Errors
/// All of [`FilterError`].
pub fn filter_history(
    class: ChannelClass,
    history: &ForceHistory,
) -> Result<ForceHistory, FilterError> {
    let filter = |samples: &[f64]| filter_channel(class, &history.time_s, samples);
    Ok(ForceHistory {
        axes: history.axes,
        sampling: history.sampling,
        time_s: history.time_s.clone(),
        fx_n: filter(&history.fx_n)?,
        fy_n: filter(&history.fy_n)?,
        mz_n_m: history.mz_n_m.as_deref().map(filter).transpose()?,
    })
}

/// The step of an even time axis, s.
fn even_step_s(time_s: &[f64]) -> Result<f64, FilterError> {
    let n_samples = time_s.len();
    let duration_s = match time_s {
        [first, .., last] => last - first,
        _ => 0.0,
    };
    if !(duration_s.is_finite() && duration_s > 0.0) {
        return Err(FilterError::NoRate { n_samples, duration_s });
    }
    let expected_s = duration_s / (n_samples - 1) as f64;
    for (i, pair) in time_s.windows(2).enumerate() {
        let step_s = pair[1] - pair[0];
        let off = (step_s - expected_s).abs();
        if off.is_nan() || off > STEP_TOLERANCE * expected_s {
            return Err(FilterError::Uneven { sample_idx: i + 1, step_s, expected_s });
        }
    }
    Ok(expected_s)
}

/// Sample `i` of a signal that is point-reflected at both ends without end. Not empty.
fn reflected(samples: &[f64], i: i64) -> f64 {
    let last = samples.len() as i64 - 1;
    if last == 0 {
        return samples[0];
    }
    let (turn, rest) = (i.div_euclid(2 * last), i.rem_euclid(2 * last));
    let [x0, xn] = [samples[0], samples[last as usize]];
    let within = if rest <= last {
        samples[rest as usize]
    } else {
        2.0 * xn - samples[(2 * last - rest) as usize]
    };
    within + 2.0 * turn as f64 * (xn - x0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f64 = 20_000.0;

    fn filter(class: ChannelClass) -> ChannelFilter {
        ChannelFilter::new(class, 1.0 / RATE_HZ).unwrap()
    }

    /// Gain at a frequency, from the response to a unit impulse in the middle of a long rest.
    fn gain(class: ChannelClass, frequency_hz: f64) -> f64 {
        let mut impulse = vec![0.0; 8001];
        impulse[4000] = 1.0;
        let response = filter(class).apply(&impulse).unwrap();
        let sum = response.iter().enumerate().map(|(i, y)| {
            let phase = TAU * frequency_hz / RATE_HZ * (i as f64 - 4000.0);
            y * phase.cos()
        });
        sum.sum()
    }

    #[test]
    fn gains_are_those_of_the_class() {
        for class in ChannelClass::ALL {
            let db = |ratio: f64| 20.0 * gain(class, ratio * class.class_hz()).log10();
            assert!((gain(class, 0.0) - 1.0).abs() < 1e-12, "{class:?}");
            // Up to the class's own frequency at most −1 dB; −3 dB at 1.65 times it (less the nearer
            // half the sampling rate comes, −2.78 dB for CFC 1000 at 20 kHz); two poles
            // twice then fall by 24 dB an octave.
            assert!((-1.0..0.0).contains(&db(1.0)), "{class:?}: {} dB", db(1.0));
            assert!((db(1.65) + 3.0).abs() < 0.25, "{class:?}: {} dB", db(1.65));
            assert!(db(5.0) < -30.0, "{class:?}: {} dB", db(5.0));
            let closed = |ratio: f64| {
                let warped = |hz: f64| (std::f64::consts::PI * hz / RATE_HZ).tan();
                let class_hz = class.class_hz();
                let over = warped(ratio * class_hz) / warped(DESIGN_RATIO * class_hz);
                -20.0 * (1.0 + over.powi(4)).log10()
            };
            for ratio in [0.3, 1.0, 1.65, 2.0775, 4.0] {
                let error = db(ratio) - closed(ratio);
                assert!(error.abs() < 1e-6, "{class:?} {ratio}: {error}");
            }
        }
    }

    #[test]
    fn constants_and_ramps_keep_their_ends() {
        for class in ChannelClass::ALL {
            for n in [1, 2, 5, 100, 5000] {
                let constant = vec![123_456.789; n];
                assert_eq!(filter(class).apply(&constant).unwrap(), constant, "{class:?}");
                let ramp: Vec<f64> = (0..n).map(|i| 3.0 + 0.5 * i as f64).collect();
                let filtered = filter(class).apply(&ramp).unwrap();
                for (i, (y, x)) in filtered.iter().zip(&ramp).enumerate() {
                    let off = (y - x).abs();
                    assert!(off < 1e-8, "{class:?}, sample {i} of {n}: {y} {x}");
                }
            }
        }
    }

    #[test]
    fn there_is_no_phase_shift() {
        let bump = |i: i64| (-((i - 600) as f64 / 40.0).powi(2)).exp();
        let signal: Vec<f64> = (0..=1200).map(bump).collect();
        let filtered = filter(ChannelClass::Cfc180).apply(&signal).unwrap();
        for i in 0..600 {
            let off = (filtered[i] - filtered[1200 - i]).abs();
            assert!(off < 1e-12, "sample {i}: {off:e}");
        }
        let area = |x: &[f64]| x.iter().sum::<f64>();
        assert!((area(&filtered) - area(&signal)).abs() < 1e-9);
    }

    #[test]
    fn what_cannot_be_filtered_is_refused() {
        let time: Vec<f64> = (0..100).map(|i| f64::from(i) * 5e-4).collect();
        let zeros = vec![0.0; 100];
        assert!(filter_channel(ChannelClass::Cfc180, &time, &zeros).is_ok());
        let error = filter_channel(ChannelClass::Cfc600, &time, &zeros).unwrap_err();
        assert_eq!(
            error.to_string(),
            "2000 samples a second are too few for CFC 600, expected 6000"
        );
        let mut uneven = time.clone();
        uneven[50] += 1e-4;
        let error = filter_channel(ChannelClass::Cfc60, &uneven, &zeros).unwrap_err();
        assert!(matches!(error, FilterError::Uneven { sample_idx: 50, .. }), "{error}");
        let mut broken = zeros.clone();
        broken[7] = f64::NAN;
        let error = filter_channel(ChannelClass::Cfc60, &time, &broken).unwrap_err();
        assert!(matches!(error, FilterError::NotFinite { sample_idx: 7, .. }), "{error}");
        assert!(filter_channel(ChannelClass::Cfc60, &time, &zeros[1..]).is_err());
        assert!(filter_channel(ChannelClass::Cfc60, &[0.0], &[0.0]).is_err());
        assert!(filter_channel(ChannelClass::Cfc60, &[], &[]).is_err());
        for interval in [0.0, -1.0, f64::NAN] {
            assert!(ChannelFilter::new(ChannelClass::Cfc60, interval).is_err());
        }
    }
}
