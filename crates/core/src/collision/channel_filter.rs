//! The low-pass filters of crash tests for the channel frequency classes (CFC), without phase
//! shift.
//!
//! Source: [`SaeJ211`](crate::bibliography::SaeJ211), appendix C: a two-pole Butterworth filter
//! that is run forward and backward over the signal. The standard does not say how the ends of a
//! signal are treated; [`ChannelFilter::apply`] describes what is done here.

use std::f64::consts::{SQRT_2, TAU};

use serde::{Deserialize, Serialize};

use crate::data::ForceHistory;

/// Ratio of the design frequency of the two-pole filter to the number of the class (SAE J211,
/// appendix C). With this ratio, the two runs together give −3 dB at 1.65 times the number of the
/// class.
const DESIGN_RATIO: f64 = 2.0775;

/// Smallest ratio of the sampling rate to the number of the class (SAE J211).
const MIN_RATE_RATIO: f64 = 10.0;

/// Length of the padding at each end, in periods of the class frequency. Over this length the
/// response of the filter decays by a factor of `exp(−2π · 2.0775 / √2 · 4) = 1e-16`.
const PAD_PERIODS: f64 = 4.0;

/// Largest deviation of a time step from the mean step, as a share of the mean step. Times are
/// often written with few digits, so steps that are meant to be equal differ a little.
const STEP_TOLERANCE: f64 = 0.01;

/// A channel frequency class (CFC) of SAE J211.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ChannelClass {
    /// CFC 60, −3 dB at 100 Hz, for vehicle accelerations that are compared and for barrier forces.
    Cfc60,
    /// CFC 180, −3 dB at 300 Hz, for vehicle accelerations that are integrated.
    Cfc180,
    /// CFC 600, −3 dB at 1000 Hz, for component tests.
    Cfc600,
    /// CFC 1000, −3 dB at 1650 Hz, for head accelerations.
    Cfc1000,
}

/// The digital filter of a channel frequency class for a given sampling rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelFilter {
    a: [f64; 3],
    b: [f64; 2],
    n_pad: usize,
}

/// Reason why a signal cannot be filtered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// The sampling rate is too low for the class, or the sample interval is not a positive number.
    #[error(
        "{rate_hz:.0} samples a second are too few for CFC {class_hz:.0}, expected {expected_hz:.0}"
    )]
    RateTooLow {
        /// Sampling rate of the signal, Hz.
        rate_hz: f64,
        /// Number of the class, Hz.
        class_hz: f64,
        /// Smallest permitted sampling rate, Hz.
        expected_hz: f64,
    },
    /// The sampling rate is higher than that of any recorder; the time is probably in another unit.
    #[error("{rate_hz:e} samples a second are too many, expected {limit_hz:e} or fewer")]
    RateTooHigh {
        /// Sampling rate of the signal, Hz.
        rate_hz: f64,
        /// Largest permitted sampling rate, Hz.
        limit_hz: f64,
    },
    /// There are fewer than two samples, or the last time does not lie after the first, so that
    /// there is no sampling rate.
    #[error("{n_samples} samples over {duration_s} s have no sampling rate")]
    NoRate {
        /// Number of samples.
        n_samples: usize,
        /// Difference between the last and the first time, s.
        duration_s: f64,
    },
    /// The time steps are not equal. The signal has to be resampled before it is filtered.
    #[error(
        "the step before sample {sample_idx} is {step_s} s, expected {expected_s} s throughout"
    )]
    Uneven {
        /// Index of the sample at the end of the step.
        sample_idx: usize,
        /// Length of the step, s.
        step_s: f64,
        /// Mean step, s.
        expected_s: f64,
    },
    /// A sample is NaN or infinite, which the filter would spread over the whole signal.
    #[error("sample {sample_idx} is {value}, expected a finite number")]
    NotFinite {
        /// Index of the sample.
        sample_idx: usize,
        /// Value of the sample.
        value: f64,
    },
    /// The number of samples differs from the number of times.
    #[error("{got} samples over {expected} times")]
    Length {
        /// Number of times.
        expected: usize,
        /// Number of samples.
        got: usize,
    },
}

impl ChannelClass {
    /// All four classes, in the order of rising cut-off frequency.
    pub const ALL: [Self; 4] = [Self::Cfc60, Self::Cfc180, Self::Cfc600, Self::Cfc1000];

    /// Number of the class, which is a frequency in Hz.
    pub fn class_hz(self) -> f64 {
        match self {
            Self::Cfc60 => 60.0,
            Self::Cfc180 => 180.0,
            Self::Cfc600 => 600.0,
            Self::Cfc1000 => 1000.0,
        }
    }

    /// Name of the class in plots and tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Cfc60 => "CFC 60",
            Self::Cfc180 => "CFC 180",
            Self::Cfc600 => "CFC 600",
            Self::Cfc1000 => "CFC 1000",
        }
    }
}

/// Largest sampling rate, Hz. Recorders of crash tests take 10 000 to 100 000 samples a second.
const MAX_RATE_HZ: f64 = 1e7;

impl ChannelFilter {
    /// Designs the filter of a class for a sample interval T, s.
    ///
    /// ```text
    /// ω_d = 2π · CFC · 2.0775     ω_a = tan(ω_d T/2)     D = 1 + √2 ω_a + ω_a²
    /// a0 = a2 = ω_a²/D    a1 = 2 a0    b1 = −2(ω_a² − 1)/D    b2 = (−1 + √2 ω_a − ω_a²)/D
    /// y_k = a0 x_k + a1 x_{k−1} + a2 x_{k−2} + b1 y_{k−1} + b2 y_{k−2}
    /// ```
    ///
    /// # Errors
    /// [`FilterError::RateTooLow`] if the sampling rate is less than ten times the number of the
    /// class (SAE J211), or if the interval is not a positive number. The limit also keeps the
    /// design frequency well below half the sampling rate. [`FilterError::RateTooHigh`] beyond
    /// 10 MHz, whose padding would be longer than any record.
    pub fn new(class: ChannelClass, sample_interval_s: f64) -> Result<Self, FilterError> {
        let class_hz = class.class_hz();
        let rate_hz = 1.0 / sample_interval_s;
        let expected_hz = MIN_RATE_RATIO * class_hz;
        // The tolerance accepts a rate that falls below the limit only because of rounding or of
        // the few digits of a time axis.
        let enough = rate_hz >= expected_hz * (1.0 - 1e-6);
        if !(sample_interval_s > 0.0 && enough && rate_hz.is_finite()) {
            return Err(FilterError::RateTooLow { rate_hz, class_hz, expected_hz });
        }
        if rate_hz > MAX_RATE_HZ {
            return Err(FilterError::RateTooHigh { rate_hz, limit_hz: MAX_RATE_HZ });
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

    /// Filters a signal forward and backward, which gives no phase shift and a gain of 1 at zero
    /// frequency.
    ///
    /// The signal is continued at each end by its point reflection (`2 x₀ − x_k`), repeatedly if
    /// the signal is shorter than the padding, and the filter starts in the steady state of the
    /// outermost value. A constant signal is therefore returned exactly, a linear ramp keeps its
    /// ends, and the end values of other signals change little: a signal that is cut off at a large
    /// value is not drawn towards zero.
    ///
    /// - `samples`: values at the sample interval for which the filter was designed, in any unit.
    /// - returns as many filtered values.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] for the first sample that is not finite.
    pub fn apply(&self, samples: &[f64]) -> Result<Vec<f64>, FilterError> {
        if let Some((sample_idx, &value)) = samples.iter().enumerate().find(|(_, x)| !x.is_finite())
        {
            return Err(FilterError::NotFinite { sample_idx, value });
        }
        let (Some(&first), n) = (samples.first(), samples.len()) else {
            return Ok(Vec::new());
        };
        let pad = self.n_pad as i64;
        // The first value is subtracted so that rounding errors scale with the variation of the
        // signal instead of its level.
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

/// Filters a signal that is given over a time axis of equal steps.
///
/// - `time_s`: times of the samples, s, rising in steps that are equal to within 1 %.
/// - `samples`: one value per time, in any unit.
///
/// # Errors
/// Any variant of [`FilterError`].
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

/// Filters every component of a force history.
///
/// The impulse is preserved except for the part that the filter spreads beyond the ends of the
/// history. The history should therefore contain some time without force before and after the
/// pulse.
///
/// # Errors
/// Any variant of [`FilterError`].
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

/// Mean step of a time axis, s, after a check that all steps are equal.
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

/// Value at index `i` of a signal that is continued by point reflection at both ends, repeated as
/// often as needed. The signal must not be empty.
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

    /// Gain at a frequency, computed from the response to a unit impulse in the middle of a long
    /// signal of zeros.
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
            // The attenuation is at most 1 dB at the class frequency and 3 dB at 1.65 times it. It
            // is smaller near half the sampling rate: 2.78 dB for CFC 1000 at 20 kHz. Above, two
            // runs of two poles fall by 24 dB per octave.
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
