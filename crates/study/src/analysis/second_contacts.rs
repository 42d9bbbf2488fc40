//! Whether the two vehicles of a forecast meet again, over its draws.
//!
//! The struck vehicle moves on the central path of each draw, the striking one as a 4DOF vehicle of
//! its own under the opposite of the same force. Both are followed to where they would pass through
//! each other ([`SecondContact`]).
//!
//! What is left out: the scatter of the struck vehicle's motion under one force, and what is not
//! known of the striking vehicle.

use rayon::prelude::*;

use crate::analysis::pair_forecast::opposite;
use crate::analysis::{MotionForecast, StruckVehicle, VehicleTrack};
use impactlab_core::collision::{Footprint, Pose, SecondContact};
use impactlab_core::data::{Channel, ForceAxes, ForceHistory, TimeSeries, contact_interval};
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::{
    ContactLoad, Integrator, Manoeuvre, Motion, SimulationError, SimulationRun, simulate_batch,
};
use impactlab_networks::response::STEP_S;

/// Time over which the vehicles are followed first, s: most that meet again do so by then.
const FIRST_LOOK_S: f64 = 1.0;
/// Draws that are followed side by side.
const N_TOGETHER: usize = 32;

/// How often and where two vehicles meet again.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondContacts {
    /// Draws that were followed.
    pub n_draws: usize,
    /// Share of them in which the vehicles meet again.
    pub probability: f64,
    /// When they do, s after the first contact.
    pub time_s: Estimate,
    /// Where they do: X, m.
    pub x_m: Estimate,
    /// Where they do: Y, m.
    pub y_m: Estimate,
    /// How fast their overlap grows then, m/s.
    pub closing_speed_m_s: Estimate,
    /// Share of these second contacts before which the vehicles were apart.
    pub apart_share: f64,
}

impl SecondContacts {
    /// Follows both vehicles through every draw of a forecast; `None` if they meet in none, or if
    /// nothing can be followed.
    ///
    /// - `struck`: outline of the struck vehicle;
    /// - `striking`: the striking vehicle;
    /// - `is_own`: whether the motion of the striking vehicle is that under the force of the
    ///   forecast. If not, it is simulated.
    pub fn find(
        forecast: &MotionForecast,
        struck: Footprint,
        striking: &VehicleTrack,
        is_own: bool,
    ) -> Option<Self> {
        let draw = |(part, path): (usize, &Vec<Pose>)| {
            let force = forecast.forces.get(part % forecast.forces.len().max(1))?;
            Draw::new(struck, path, force)
        };
        let draws: Vec<Draw<'_>> = forecast.paths.par_iter().enumerate().filter_map(draw).collect();
        let follow = |draws: &[Draw<'_>]| -> Vec<Option<SecondContact>> {
            match is_own {
                true => draws.iter().map(|draw| draw.meet(striking, &striking.motion)).collect(),
                false => follow(draws, striking),
            }
        };
        let followed: Vec<Option<SecondContact>> =
            draws.par_chunks(N_TOGETHER).flat_map_iter(follow).collect();
        let met: Vec<SecondContact> = followed.iter().flatten().copied().collect();
        if met.is_empty() {
            return None;
        }
        let spread = |value: fn(&SecondContact) -> f64| {
            Estimate::from_draws(met.iter().map(value).collect())
        };
        Some(Self {
            n_draws: followed.len(),
            probability: met.len() as f64 / followed.len() as f64,
            time_s: spread(|met| met.time_s),
            x_m: spread(|met| met.point_m[0]),
            y_m: spread(|met| met.point_m[1]),
            closing_speed_m_s: spread(|met| met.closing_speed_m_s),
            apart_share: met.iter().filter(|met| met.was_apart).count() as f64 / met.len() as f64,
        })
    }
}

/// The struck vehicle in a draw.
struct Draw<'a> {
    footprint: Footprint,
    motion: TimeSeries,
    force: &'a ForceHistory,
    contact_end_s: f64,
    duration_s: f64,
}

impl<'a> Draw<'a> {
    /// `None` if the draw cannot be followed.
    fn new(footprint: Footprint, path: &[Pose], force: &'a ForceHistory) -> Option<Self> {
        let (_, contact_end_s) = contact_interval(force)?;
        let duration_s = path.len().saturating_sub(1) as f64 * STEP_S;
        Some(Self { footprint, motion: series(path)?, force, contact_end_s, duration_s })
    }

    fn meet(&self, striking: &VehicleTrack, motion: &TimeSeries) -> Option<SecondContact> {
        let struck = (self.footprint, &self.motion);
        SecondContact::find(struck, (striking.footprint, motion), self.contact_end_s)
    }
}

/// Follows draws, in each of which the striking vehicle is simulated. Those for which it cannot be are
/// left out.
fn follow(draws: &[Draw<'_>], striking: &VehicleTrack) -> Vec<Option<SecondContact>> {
    let mut waiting: Vec<(usize, &Draw<'_>)> = draws.iter().enumerate().collect();
    let mut met: Vec<(usize, Option<SecondContact>)> = Vec::new();
    for is_last in [false, true] {
        let manoeuvre = |&(idx, draw): &(usize, &Draw<'_>)| {
            let first_s = draw.contact_end_s + FIRST_LOOK_S;
            let duration_s = if is_last { draw.duration_s } else { draw.duration_s.min(first_s) };
            Some((idx, pushed(&striking.start, reaction(draw.force)?, duration_s)))
        };
        let manoeuvres: Vec<(usize, Manoeuvre)> = waiting.iter().filter_map(manoeuvre).collect();
        waiting.clear();
        for ((idx, _), motion) in manoeuvres.iter().zip(simulated(&striking.start, &manoeuvres)) {
            let (Some(draw), Ok(motion)) = (draws.get(*idx), motion) else { continue };
            match draw.meet(striking, &motion.series) {
                None if !is_last => waiting.push((*idx, draw)),
                second => met.push((*idx, second)),
            }
        }
    }
    met.sort_by_key(|(idx, _)| *idx);
    met.into_iter().map(|(_, second)| second).collect()
}

/// The motions of a vehicle. Side by side they may depend on each other by rounding where its wheels are
/// braked or driven; there they are simulated one by one.
fn simulated(
    start: &StruckVehicle,
    manoeuvres: &[(usize, Manoeuvre)],
) -> Vec<Result<Motion, SimulationError>> {
    let runs: Vec<SimulationRun<'_>> = manoeuvres
        .iter()
        .map(|(_, manoeuvre)| SimulationRun { vehicle: &start.vehicle, manoeuvre })
        .collect();
    if start.controls.is_coasting() {
        return simulate_batch(&runs);
    }
    runs.iter().map(|run| run.vehicle.simulate(run.manoeuvre, Integrator::Rk4)).collect()
}

/// The force on the striking vehicle; `None` if its axes turn with the struck one.
fn reaction(force: &ForceHistory) -> Option<ForceHistory> {
    (force.axes == ForceAxes::World).then(|| opposite(force))
}

/// What the striking vehicle does under a force that acts where the vehicles touch.
fn pushed(start: &StruckVehicle, force: ForceHistory, duration_s: f64) -> Manoeuvre {
    Manoeuvre {
        initial: start.initial,
        contact_load: Some(ContactLoad { force, contact: start.contact, recorded_moment: false }),
        controls: start.controls.clone(),
        duration_s,
        ends_at_rest: false,
        friction_zones: start.friction_zones.clone(),
    }
}

fn series(path: &[Pose]) -> Option<TimeSeries> {
    let mut series = TimeSeries::new((0..path.len()).map(|i| i as f64 * STEP_S).collect()).ok()?;
    let column = |value: fn(&Pose) -> f64| path.iter().map(value).collect();
    series.insert(Channel::X, column(|pose| pose.x_m)).ok()?;
    series.insert(Channel::Y, column(|pose| pose.y_m)).ok()?;
    series.insert(Channel::Yaw, column(|pose| pose.yaw_rad)).ok()?;
    Some(series)
}
