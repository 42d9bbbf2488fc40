//! The piecewise linear functions of a crush law: where they have their knots, and their values.

use serde::{Deserialize, Serialize};

use super::outline::{OUTLINE_BEFORE_M, OUTLINE_M};

/// Limits of the ranges of crush depth in which the stiffness of the outer skins is constant, m.
/// The last range has no upper limit.
const DEPTH_KNOTS_M: [f64; 10] = [0.0, 0.03, 0.06, 0.09, 0.105, 0.13, 0.17, 0.24, 0.34, 0.46];
/// Positions along the side of the struck vehicle, measured from its rear axle and positive
/// forwards, m, at which the stiffness factor and the bulge of the skins are given.
const SKIN_KNOTS_M: [f64; 10] = [-0.66, -0.36, -0.16, 0.0, 0.16, 0.34, 0.64, 1.04, 1.6, 2.2];
/// Positions along the side of the struck vehicle, measured from its rear axle and positive
/// forwards, m, at which the depth of its stiff inner structure (wheel, edges of the wheel arch,
/// sill and pillars) is given.
const STRUCK_STRUCTURE_KNOTS_M: [f64; 15] =
    [-0.8, -0.6, -0.45, -0.32, -0.2, -0.1, 0.0, 0.1, 0.2, 0.32, 0.45, 0.6, 1.0, 1.5, 2.1];
/// Positions along the x axis of the striking vehicle, measured from the start of its front corner
/// and positive forwards, m, at which the depth of its stiff inner structure (wheel behind the
/// corner, beam in front of it) is given.
const STRIKING_STRUCTURE_KNOTS_M: [f64; 10] =
    [-0.7, -0.45, -0.25, -0.1, 0.05, 0.2, 0.3, 0.38, 0.46, 0.54];
/// The knots of laws that do not store them: of depth, of the skins, and of the inner structures of the
/// struck and the striking vehicle, m. They do not follow those of new laws.
const DEPTH_KNOTS_BEFORE_M: [f64; 8] = [0.0, 0.03, 0.06, 0.09, 0.105, 0.13, 0.17, 0.24];
const SKIN_KNOTS_BEFORE_M: [f64; 8] = [-0.66, -0.36, -0.16, 0.0, 0.16, 0.34, 0.64, 1.04];
const STRUCK_STRUCTURE_KNOTS_BEFORE_M: [f64; 12] =
    [-0.8, -0.6, -0.45, -0.32, -0.2, -0.1, 0.0, 0.1, 0.2, 0.32, 0.45, 0.6];
const STRIKING_STRUCTURE_KNOTS_BEFORE_M: [f64; 10] =
    [-0.7, -0.45, -0.25, -0.1, 0.05, 0.2, 0.3, 0.38, 0.46, 0.54];

/// Where the functions of a law that are piecewise linear have their knots. Values are linear in
/// between and constant beyond the ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrushKnots {
    /// Limits of the ranges of crush depth with a stiffness of their own, m; the first is 0.
    pub depth_m: Vec<f64>,
    /// Along the side of the struck vehicle from its rear axle, m: factor and bulge of the skins.
    pub skin_m: Vec<f64>,
    /// Along the side of the struck vehicle from its rear axle, m: depth of its inner structure.
    #[serde(rename = "target_structure_m")]
    pub struck_structure_m: Vec<f64>,
    /// Along the x axis of the striking vehicle from the start of its corner, m: depth of its inner
    /// structure.
    #[serde(rename = "bullet_structure_m")]
    pub striking_structure_m: Vec<f64>,
    /// How far the side behind the corner of the striking vehicle reaches, and its front beyond the corner,
    /// m.
    #[serde(rename = "outline_m")]
    pub side_and_front_m: [f64; 2],
}

impl Default for CrushKnots {
    fn default() -> Self {
        Self {
            depth_m: DEPTH_KNOTS_M.to_vec(),
            skin_m: SKIN_KNOTS_M.to_vec(),
            struck_structure_m: STRUCK_STRUCTURE_KNOTS_M.to_vec(),
            striking_structure_m: STRIKING_STRUCTURE_KNOTS_M.to_vec(),
            side_and_front_m: OUTLINE_M,
        }
    }
}

impl CrushKnots {
    /// Those of laws that were stored before laws named their knots.
    pub(super) fn before() -> Self {
        Self {
            depth_m: DEPTH_KNOTS_BEFORE_M.to_vec(),
            skin_m: SKIN_KNOTS_BEFORE_M.to_vec(),
            struck_structure_m: STRUCK_STRUCTURE_KNOTS_BEFORE_M.to_vec(),
            striking_structure_m: STRIKING_STRUCTURE_KNOTS_BEFORE_M.to_vec(),
            side_and_front_m: OUTLINE_BEFORE_M,
        }
    }
}

/// Values and corrections of them, one by one.
pub(super) fn sums(values: &[f64], more: &[f64]) -> Vec<f64> {
    values.iter().zip(more).map(|(value, more)| value + more).collect()
}

/// Piecewise linear interpolation of values at knots, constant beyond the ends.
///
/// - `values`: as many as knots, at least one.
pub(super) fn linear(knots: &[f64], values: &[f64], x: f64) -> f64 {
    match knots.iter().position(|knot| x < *knot) {
        None => values[values.len() - 1],
        Some(0) => values[0],
        Some(i) => {
            let share = (x - knots[i - 1]) / (knots[i] - knots[i - 1]);
            values[i - 1] * (1.0 - share) + values[i] * share
        }
    }
}

/// Derivative of [`linear`] with respect to `x`.
pub(super) fn slope(knots: &[f64], values: &[f64], x: f64) -> f64 {
    match knots.iter().position(|knot| x < *knot) {
        None | Some(0) => 0.0,
        Some(i) => (values[i] - values[i - 1]) / (knots[i] - knots[i - 1]),
    }
}
