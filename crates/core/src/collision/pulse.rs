//! Classic pulses: force histories of a simple shape that carry a given impulse over a given
//! duration. They are the baselines of the force network, and they serve a user who knows only the
//! impulse.
//!
//! Source: textbook shapes, e.g. [`Brach2011`](crate::bibliography::Brach2011). Both components of
//! the force have the same shape and duration, so the force keeps its direction in world axes.
//! Impulse and duration are inputs; the duration is not estimated here.

use std::f64::consts::{PI, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{ForceAxes, ForceHistory, Sampling};

/// Shape of a pulse as a function of the relative time `u = (t − start) / duration`, scaled to an
/// area of 1.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "kebab-case")]
pub enum PulseShape {
    /// Half a period of a sine: `π/2 sin πu`.
    HalfSine,
    /// A full period of a raised cosine, without kinks at the ends: `1 − cos 2πu`.
    Haversine,
    /// A symmetric triangle: `4u` for `u ≤ 1/2`, `4(1 − u)` after it.
    Triangle,
    /// A constant force: `1`.
    Square,
}

/// A force of fixed direction in world axes that acts over a limited time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    shape: PulseShape,
    impulse_world_n_s: [f64; 2],
    start_s: f64,
    duration_s: f64,
}

/// A parameter of a pulse, or of its sampling, is out of range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} is {value}, expected {expected}")]
pub struct PulseError {
    /// Name of the parameter.
    pub name: &'static str,
    /// Value of the parameter, in the unit that ends its name.
    pub value: f64,
    /// Description of the permitted range.
    pub expected: &'static str,
}

impl PulseShape {
    /// All four shapes, in the order in which they are listed to the user.
    pub const ALL: [Self; 4] = [Self::HalfSine, Self::Haversine, Self::Triangle, Self::Square];

    /// Name of the shape in plots and tables.
    pub fn label(self) -> &'static str {
        self.into()
    }

    /// Ratio of the force at the relative time `u` to the mean force of the pulse. Its integral
    /// over `u` from 0 to 1 is 1; it is zero outside of this interval.
    pub fn density(self, u: f64) -> f64 {
        if !(0.0..=1.0).contains(&u) {
            return 0.0;
        }
        match self {
            Self::HalfSine => PI / 2.0 * (PI * u).sin(),
            Self::Haversine => 1.0 - (TAU * u).cos(),
            Self::Triangle => 4.0 * u.min(1.0 - u),
            Self::Square => 1.0,
        }
    }

    /// Share of the impulse that has been transferred up to the relative time `u`: 0 before the
    /// pulse, 1 after it. It is the closed-form integral of [`PulseShape::density`].
    pub fn cumulative(self, u: f64) -> f64 {
        if u <= 0.0 {
            return 0.0;
        }
        if u >= 1.0 {
            return 1.0;
        }
        match self {
            Self::HalfSine => (1.0 - (PI * u).cos()) / 2.0,
            Self::Haversine => u - (TAU * u).sin() / TAU,
            Self::Triangle if u < 0.5 => 2.0 * u * u,
            Self::Triangle => 1.0 - 2.0 * (1.0 - u) * (1.0 - u),
            Self::Square => u,
        }
    }
}

impl Pulse {
    /// Creates a pulse that carries a given impulse.
    ///
    /// - `impulse_n_s`: impulse on the struck vehicle in world axes, N s, any finite numbers;
    /// - `start_s`: time of first contact, s, 0 or more;
    /// - `duration_s`: duration of the contact, s, more than 0.
    ///
    /// # Errors
    /// [`PulseError`] names the first parameter that is out of range or not finite.
    pub fn new(
        shape: PulseShape,
        impulse_world_n_s: [f64; 2],
        start_s: f64,
        duration_s: f64,
    ) -> Result<Self, PulseError> {
        let finite = "a finite number";
        for (ok, name, value, expected) in [
            (true, "impulse_n_s[0]", impulse_world_n_s[0], finite),
            (true, "impulse_n_s[1]", impulse_world_n_s[1], finite),
            (start_s >= 0.0, "start_s", start_s, "0 or more"),
            (duration_s > 0.0, "duration_s", duration_s, "more than 0"),
        ] {
            if !(ok && value.is_finite()) {
                return Err(PulseError { name, value, expected });
            }
        }
        Ok(Self { shape, impulse_world_n_s, start_s, duration_s })
    }

    /// Force on the struck vehicle at a time, in world axes, N.
    ///
    /// ```text
    /// F(t) = P / Δt · density((t − start) / Δt)
    /// ```
    pub fn force_n(&self, time_s: f64) -> [f64; 2] {
        let height = self.shape.density((time_s - self.start_s) / self.duration_s);
        self.impulse_world_n_s.map(|p| p / self.duration_s * height)
    }

    /// Impulse on the struck vehicle from the start of the pulse up to a time, in closed form, in
    /// world axes, N s.
    pub fn impulse_until_n_s(&self, time_s: f64) -> [f64; 2] {
        let area = self.shape.cumulative((time_s - self.start_s) / self.duration_s);
        self.impulse_world_n_s.map(|p| p * area)
    }

    /// Largest magnitude of the force, N: π/2, 2, 2 and 1 times the mean force for the half-sine,
    /// the haversine, the triangle and the square.
    pub fn peak_n(&self) -> f64 {
        let [px, py] = self.impulse_world_n_s;
        px.hypot(py) / self.duration_s * self.shape.density(0.5)
    }

    /// Time at which the pulse ends, s.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// Samples the pulse as a force history. Each sample is the exact mean of the force over one of
    /// the equal intervals from time 0 to the end of the pulse, and its time is the middle of the
    /// interval. The impulse of the history therefore equals that of the pulse for any interval.
    ///
    /// - `sample_interval_s`: length of an interval, s.
    ///
    /// # Errors
    /// [`PulseError`] if the interval is not positive or gives more than a million samples.
    pub fn to_history(&self, sample_interval_s: f64) -> Result<ForceHistory, PulseError> {
        let n_samples = (self.end_s() / sample_interval_s * (1.0 - 1e-12)).ceil();
        if !(sample_interval_s > 0.0 && (1.0..=1e6).contains(&n_samples)) {
            return Err(PulseError {
                name: "sample_interval_s",
                value: sample_interval_s,
                expected: "more than 0 and more than a millionth of the pulse's end",
            });
        }
        let edges: Vec<f64> =
            (0..=n_samples as usize).map(|i| i as f64 * sample_interval_s).collect();
        // The last edge may lie before the end of the pulse by a rounding error, so the whole
        // impulse is used there.
        let until = |i: usize, axis: usize| match edges.get(i) {
            Some(&edge) if i + 1 < edges.len() => self.impulse_until_n_s(edge)[axis],
            _ => self.impulse_world_n_s[axis],
        };
        let means = |axis: usize| {
            (0..n_samples as usize)
                .map(|i| (until(i + 1, axis) - until(i, axis)) / sample_interval_s)
                .collect()
        };
        Ok(ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::CentredMean,
            time_s: (0..n_samples as usize).map(|i| (i as f64 + 0.5) * sample_interval_s).collect(),
            fx_n: means(0),
            fy_n: means(1),
            mz_n_m: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulse(shape: PulseShape) -> Pulse {
        Pulse::new(shape, [600.0, -3200.0], 0.0123, 0.1).unwrap()
    }

    #[test]
    fn the_closed_form_is_the_integral_of_the_force() {
        for shape in PulseShape::ALL {
            let n = 20_000;
            let mut area = 0.0;
            for i in 0..n {
                let u = (f64::from(i) + 0.5) / f64::from(n);
                let end = f64::from(i + 1) / f64::from(n);
                area += shape.density(u) / f64::from(n);
                assert!((shape.cumulative(end) - area).abs() < 1e-8, "{shape:?} {end}");
            }
            assert_eq!(shape.cumulative(-0.1), 0.0, "{shape:?}");
            assert_eq!(shape.cumulative(1.1), 1.0, "{shape:?}");
        }
    }

    #[test]
    fn a_history_carries_the_impulse_exactly() {
        for shape in PulseShape::ALL {
            for sample_interval_s in [1e-4, 1e-3, 7e-3, 0.01, 0.1123, 0.5] {
                let history = pulse(shape).to_history(sample_interval_s).unwrap();
                if history.time_s.len() < 2 {
                    continue; // one sample has no interval to be weighted with
                }
                let [px, py] = history.impulse_n_s();
                let case = format!("{shape:?} {sample_interval_s}: {px} {py}");
                assert!((px - 600.0).abs() < 1e-9, "{case}");
                assert!((py + 3200.0).abs() < 1e-9, "{case}");
            }
        }
    }

    #[test]
    fn peaks_are_the_known_multiples_of_the_mean() {
        let mean = 600.0_f64.hypot(3200.0) / 0.1;
        for (shape, ratio) in PulseShape::ALL.into_iter().zip([PI / 2.0, 2.0, 2.0, 1.0]) {
            let pulse = pulse(shape);
            assert!((pulse.peak_n() / mean - ratio).abs() < 1e-12, "{shape:?}");
            let [fx, fy] = pulse.force_n(0.0123 + 0.05);
            assert!((fx.hypot(fy) - pulse.peak_n()).abs() < 1e-9, "{shape:?}");
            assert_eq!(pulse.force_n(0.0122), [0.0, -0.0], "{shape:?}");
            assert_eq!(pulse.force_n(0.1124), [0.0, -0.0], "{shape:?}");
        }
    }

    #[test]
    fn senseless_numbers_are_refused() {
        let new = |impulse, start_s, duration_s| {
            Pulse::new(PulseShape::Square, impulse, start_s, duration_s)
        };
        assert!(new([1.0, 1.0], 0.0, 0.0).is_err());
        assert!(new([1.0, 1.0], -0.1, 0.1).is_err());
        assert!(new([f64::NAN, 1.0], 0.0, 0.1).is_err());
        assert!(new([1.0, 1.0], 0.0, f64::INFINITY).is_err());
        for interval in [0.0, -1.0, f64::NAN, 1e-12] {
            assert!(pulse(PulseShape::Square).to_history(interval).is_err());
        }
    }
}
