//! The recorded yaw rate against the computed one.

use schemars::JsonSchema;
use serde::Serialize;

use crate::ReplaySample;

/// Standard deviation of a recorded yaw rate, rad/s: 2 deg/s for rounding, and for channels that are not
/// sampled at the same moment.
const YAW_RATE_SIGMA_RAD_S: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Standard deviations by which they may differ in the root of the mean square, and at one sample.
const LARGEST_DEVIATIONS: [f64; 2] = [1.5, 4.0];

/// Computed yaw rate from which on both are compared as a factor, rad/s, in the root of the mean square.
const LEAST_YAW_RATE_RAD_S: f64 = 3.0 * std::f64::consts::PI / 180.0;

/// Standard deviations over the width of an interval of 90 %.
const SIGMAS_OF_NINETY: f64 = 3.29;

/// How the recorded yaw rate goes with the computed one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct YawRateCheck {
    /// Root of the mean square of their difference, rad/s.
    pub difference_rad_s: f64,
    /// The same in standard deviations of both, which are 2 deg/s of the recorder and the scatter of the draws.
    pub deviations: f64,
    /// The largest difference at a sample, in standard deviations.
    pub largest_deviations: f64,
    /// The recorded yaw rate over the computed one by least squares; none where the vehicle hardly turns.
    pub factor: Option<f64>,
    /// Steering ratio with which both would be the same, if nothing else is wrong; none without a factor, or
    /// where it is that of no car.
    pub implied_steering_ratio: Option<f64>,
    /// Whether they disagree.
    pub disagrees: bool,
}

impl YawRateCheck {
    /// Compares both; none if no yaw rate was recorded.
    pub(super) fn new(samples: &[ReplaySample], steering_ratio: f64) -> Option<Self> {
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
        let square = mean(&|pair| pair[1] * pair[1]);
        let turns = square.sqrt() > LEAST_YAW_RATE_RAD_S;
        let factor = turns.then(|| mean(&|pair| pair[0] * pair[1]) / square);
        let of_car = |factor: &f64| (0.4..2.5).contains(factor);
        let [of_all, of_one] = LARGEST_DEVIATIONS;
        Some(Self {
            difference_rad_s,
            deviations,
            largest_deviations: largest,
            factor,
            implied_steering_ratio: factor.filter(of_car).map(|factor| steering_ratio / factor),
            disagrees: deviations > of_all || largest > of_one,
        })
    }

    /// Whether the recorded yaw rate is to the other side.
    pub fn is_opposite(&self) -> bool {
        self.factor.is_some_and(|factor| factor < -0.3)
    }
}

/// Recorded and computed yaw rate of a sample, and the standard deviation of their difference, rad/s.
fn compared(sample: &ReplaySample) -> Option<[f64; 3]> {
    let recorded = sample.recorded_yaw_rate_rad_s?;
    let [low, high] = sample.yaw_rate_rad_s.ninety();
    let scatter = (high - low) / SIGMAS_OF_NINETY;
    Some([recorded, sample.yaw_rate_rad_s.median, scatter.hypot(YAW_RATE_SIGMA_RAD_S)])
}
