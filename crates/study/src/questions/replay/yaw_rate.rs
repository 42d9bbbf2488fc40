//! The recorded yaw rate against the computed one.

use schemars::JsonSchema;
use serde::Serialize;

use crate::ReplaySample;
use crate::questions::replay::report::DrawnMotion;
use impactlab_core::ranges::STEERING_RATIO;
use impactlab_core::units::Estimate;

/// Standard deviation of a recorded yaw rate, rad/s: 2 deg/s for rounding, and for channels that are not
/// sampled at the same moment.
const YAW_RATE_SIGMA_RAD_S: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Standard deviations by which they may differ in the root of the mean square, and at one sample.
const LARGEST_DEVIATIONS: [f64; 2] = [1.5, 4.0];

/// Computed yaw rate from which on both are compared as a factor, rad/s, in the root of the mean square.
const LEAST_YAW_RATE_RAD_S: f64 = 3.0 * std::f64::consts::PI / 180.0;

/// Share of the friction up to which the yaw rate is about proportional to the steer angle.
const PROPORTIONAL_FRICTION_USE: f64 = 0.7;

/// Share of the draws that have to turn so that both are compared as a factor.
const TURNING_SHARE: f64 = 0.9;

/// Standard deviations over the width of an interval of 90 %.
const SIGMAS_OF_NINETY: f64 = 3.29;

/// How the recorded yaw rate goes with the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct YawRateCheck {
    /// Root of the mean square of their difference, rad/s.
    pub difference_rad_s: f64,
    /// The same in standard deviations of both, which are 2 deg/s of the recorder and the scatter of the draws.
    pub deviations: f64,
    /// The largest difference at a sample, in standard deviations.
    pub largest_deviations: f64,
    /// The recorded yaw rate over the computed one by least squares, over the samples before 70 % of the
    /// friction is used; none where the vehicle hardly turns there.
    pub factor: Option<Estimate>,
    /// Steering ratio with which both would be the same over these samples, if nothing else is wrong; none
    /// without a factor, or where 90 % of it are not those of vehicles.
    pub implied_steering_ratio: Option<Estimate>,
    /// Whether they disagree.
    pub disagrees: bool,
}

impl YawRateCheck {
    /// Compares both; none if no yaw rate was recorded.
    pub(super) fn new(samples: &[ReplaySample], draws: &[DrawnMotion]) -> Option<Self> {
        let pairs: Vec<[f64; 3]> = samples.iter().filter_map(compared).collect();
        if pairs.is_empty() {
            return None;
        }
        let mean =
            |of: &dyn Fn(&[f64; 3]) -> f64| pairs.iter().map(of).sum::<f64>() / pairs.len() as f64;
        let in_sigmas = |[recorded, computed, sigma]: &[f64; 3]| (recorded - computed) / sigma;
        let difference_rad_s = mean(&|pair| (pair[0] - pair[1]).powi(2)).sqrt();
        let deviations = mean(&|pair| in_sigmas(pair).powi(2)).sqrt();
        let largest = pairs.iter().map(|pair| in_sigmas(pair).abs()).fold(0.0, f64::max);
        let with_ratio = |draw: &DrawnMotion| {
            let factor = factor(draw, samples)?;
            Some([factor, draw.steering_ratio / factor])
        };
        let factors: Vec<[f64; 2]> = draws.iter().filter_map(with_ratio).collect();
        let turns = factors.len() as f64 >= TURNING_SHARE * draws.len() as f64;
        let of = |idx: usize| {
            turns.then(|| Estimate::from_draws(factors.iter().map(|of| of[idx]).collect()))
        };
        let is_of_vehicle =
            |ratio: &Estimate| ratio.ninety().iter().all(|end| STEERING_RATIO.contains(*end));
        let [of_all, of_one] = LARGEST_DEVIATIONS;
        Some(Self {
            difference_rad_s,
            deviations,
            largest_deviations: largest,
            factor: of(0),
            implied_steering_ratio: of(1).filter(is_of_vehicle),
            disagrees: deviations > of_all || largest > of_one,
        })
    }

    /// Whether the recorded yaw rate is to the other side.
    pub fn is_opposite(&self) -> bool {
        self.factor.as_ref().is_some_and(|factor| factor.ninety()[1] < 0.0)
    }
}

/// Recorded and computed yaw rate of a sample, and the standard deviation of their difference, rad/s.
fn compared(sample: &ReplaySample) -> Option<[f64; 3]> {
    let recorded = sample.recorded_yaw_rate_rad_s?;
    let [low, high] = sample.yaw_rate_rad_s.ninety();
    let scatter = (high - low) / SIGMAS_OF_NINETY;
    Some([recorded, sample.yaw_rate_rad_s.median, scatter.hypot(YAW_RATE_SIGMA_RAD_S)])
}

/// The recorded yaw rate over that of a draw:
///
/// ```text
/// Σ r̂ r/Σ r² + z σ/√(Σ r²)
/// ```
///
/// None where the vehicle hardly turns before the tires come near their limit.
fn factor(draw: &DrawnMotion, samples: &[ReplaySample]) -> Option<f64> {
    let [mut n, mut product, mut square] = [0.0; 3];
    for (at, sample) in draw.at_samples.iter().zip(samples) {
        if at.friction_use > PROPORTIONAL_FRICTION_USE {
            break;
        }
        n += 1.0;
        product += sample.recorded_yaw_rate_rad_s? * at.yaw_rate_rad_s;
        square += at.yaw_rate_rad_s * at.yaw_rate_rad_s;
    }
    let turns = square > LEAST_YAW_RATE_RAD_S * LEAST_YAW_RATE_RAD_S * n;
    let error = draw.yaw_rate_error * YAW_RATE_SIGMA_RAD_S;
    turns.then(|| product / square + error / square.sqrt())
}
