//! A part of the ground on which the tyres grip differently: ice, a wet patch, gravel, a verge.

use serde::{Deserialize, Serialize};

/// A part of the ground with its own friction. Where zones overlap, the last of a list holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionZone {
    /// What it is, such as “verge”.
    pub name: String,
    /// Corners `[X, Y]` of its border in either sense, m; the last is joined to the first.
    pub border_m: Vec<[f64; 2]>,
    /// Peak friction coefficient μ between tyre and ground in it, in the range
    /// [`ROAD_FRICTION`](crate::ranges::ROAD_FRICTION).
    pub friction: f64,
}
