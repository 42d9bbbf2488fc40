//! The other method beside a forecast: do they agree?

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::{Analysis, MotionForecast};
use impactlab_core::data::Channel;
use impactlab_networks::response::STEP_S;

/// How far the 4DOF model by data sheet ends from the record, as a share of the way, in three of four
/// motions of the fleet.
const PHYSICS_ERROR: f64 = 0.125;

/// Under which force the other method moves the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RivalForce {
    /// That of the forecast.
    Same,
    /// The impulse of the momentum solution as a pulse, where the forecast has another force.
    Momentum,
}

/// Where the 4DOF model by data sheet, without a network, ends beside a forecast; SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Rival {
    /// Under which force it moves.
    pub force: RivalForce,
    /// The instant at which both are compared, s.
    pub time_s: f64,
    /// X of the CG by the other method, m.
    pub x_m: f64,
    /// Y of the CG by the other method, m.
    pub y_m: f64,
    /// Change of heading by the other method, rad; a full turn counts as 2π.
    pub heading_change_rad: f64,
    /// Mean of the forecast at that instant [x, y], m.
    pub forecast_m: [f64; 2],
    /// Distance from the mean of the forecast, m.
    pub apart_m: f64,
    /// Probability of the smallest region of the forecast that holds the end by the other method, 0 to
    /// 1.
    pub region_level: f64,
    /// How far the other method is known to err over this way: by less in three of four motions, m.
    pub known_error_m: f64,
}

impl Rival {
    /// The 4DOF simulation of the same source; `None` if there is none.
    pub(crate) fn from_simulation(
        forecast: &MotionForecast,
        simulated: &Analysis,
        force: RivalForce,
    ) -> Option<Self> {
        let motion = &simulated.simulation.as_ref()?.series;
        let n_steps = forecast.distribution.n_instants().checked_sub(1)?;
        let end_s = motion.time_s().last()?.min(n_steps as f64 * STEP_S);
        let at = motion.time_s().partition_point(|time_s| *time_s < end_s - 1e-9);
        let value = |channel, at| motion.get(channel)?.get(at).copied();
        let [x_m, y_m] = [value(Channel::X, at)?, value(Channel::Y, at)?];
        let instant = ((end_s / STEP_S).round() as usize).min(n_steps);
        let mean = forecast.distribution.mean(instant);
        let apart_m = (x_m - mean.x_m).hypot(y_m - mean.y_m);
        let [xs, ys] = [motion.get(Channel::X)?, motion.get(Channel::Y)?];
        let steps = xs.iter().zip(ys).zip(xs.iter().zip(ys).skip(1)).take(at);
        let way_m: f64 = steps.map(|((x0, y0), (x1, y1))| (x1 - x0).hypot(y1 - y0)).sum();
        apart_m.is_finite().then_some(Self {
            force,
            time_s: end_s,
            x_m,
            y_m,
            heading_change_rad: value(Channel::Yaw, at)? - value(Channel::Yaw, 0)?,
            forecast_m: [mean.x_m, mean.y_m],
            apart_m,
            region_level: forecast.distribution.position(instant).level_of([x_m, y_m]),
            known_error_m: PHYSICS_ERROR * way_m,
        })
    }

    /// Whether the end by the other method lies in the 90 % region of the forecast.
    pub fn is_in_region(&self) -> bool {
        self.region_level <= 0.9
    }

    /// Whether the mean of the forecast is as near to the other method as that is known to err.
    pub fn is_within_known_error(&self) -> bool {
        self.apart_m <= self.known_error_m
    }
}
