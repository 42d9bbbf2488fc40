//! A motion forecast as columns of numbers over time, for tables and arrays.

use crate::analysis::{MOTION_BAND_LEVELS, MotionBands};
use impactlab_core::data::Channel;
use impactlab_core::vehicle::VehicleState;
use impactlab_networks::response::{MotionDistribution, STEP_S};

/// The quantities of [`VehicleState::planar`], in its order.
const PLANAR: [Channel; 6] =
    [Channel::X, Channel::Y, Channel::Yaw, Channel::Vx, Channel::Vy, Channel::YawRate];

/// Columns by name: the time from first contact, then of X, Y, yaw, v_x, v_y and yaw rate the central path,
/// mean and standard deviation of the draws, and the edges of the intervals of [`MOTION_BAND_LEVELS`]. Each
/// name ends in the unit and which of these it is: `x_m_low_90`.
///
/// - `central`: the path with nothing uncertain, at every instant of the distribution;
/// - `bands`: those of the distribution at every instant;
/// - `known_s`: until when positions have a probability, s. After that standard deviations and edges are
///   NaN.
pub fn motion_columns(
    distribution: &MotionDistribution,
    central: &[VehicleState<f64>],
    bands: &MotionBands,
    known_s: f64,
) -> Vec<(String, Vec<f64>)> {
    let instants = 0..central.len();
    let time_s: Vec<f64> = instants.clone().map(|at| at as f64 * STEP_S).collect();
    let spread = |at: usize, value: f64| match time_s.get(at) {
        Some(time_s) if *time_s <= known_s => value,
        _ => f64::NAN,
    };
    let means: Vec<[f64; 6]> = instants.clone().map(|at| distribution.mean(at).planar()).collect();
    let deviations: Vec<[f64; 6]> = instants
        .clone()
        .map(|at| {
            let covariance = distribution.covariance(at);
            std::array::from_fn(|axis| spread(at, covariance[(axis, axis)].max(0.0).sqrt()))
        })
        .collect();
    let mut columns = Vec::new();
    for (axis, channel) in PLANAR.into_iter().enumerate() {
        let name = channel.header();
        let central = central.iter().map(|state| state.planar()[axis]).collect();
        columns.push((format!("{name}_central"), central));
        columns.push((format!("{name}_mean"), means.iter().map(|of| of[axis]).collect()));
        columns.push((format!("{name}_std"), deviations.iter().map(|of| of[axis]).collect()));
        for (idx, level) in MOTION_BAND_LEVELS.into_iter().enumerate() {
            let percent = (100.0 * level) as u32;
            for (end, side) in ["low", "high"].into_iter().enumerate() {
                let edge =
                    |at: usize| bands.intervals.get(at).map_or(f64::NAN, |of| of[axis][idx][end]);
                let edges = instants.clone().map(|at| spread(at, edge(at))).collect();
                columns.push((format!("{name}_{side}_{percent}"), edges));
            }
        }
    }
    columns.insert(0, (Channel::Time.header().to_owned(), time_s));
    columns
}
