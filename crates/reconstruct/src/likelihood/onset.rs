//! Where a wheel leaves a mark: where it slides by more than 8° or is locked, above 1 m/s, as in
//! [`tire_marks`](impactlab_core::vehicle::tire_marks).

use crate::likelihood::comparison::ComparedCar;
use crate::likelihood::track::WheelTrack;
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{
    LARGEST_MARK_GAP_M, VehicleParameters, Wheel, WheelEffort, friction_at, leaves_mark,
};

/// Stands for the distance to where a wheel slides that never does, m.
pub(crate) const NEVER_M: f64 = 30.0;

/// Where one wheel leaves a mark along its path.
#[derive(Debug, Clone)]
pub(crate) struct Onset {
    is_marking: Vec<bool>,
    is_locked: Vec<bool>,
}

impl Onset {
    pub fn new(car: ComparedCar<'_>, wheel: Wheel, path: &WheelTrack) -> Self {
        let held = car.manoeuvre.controls.wheels.as_ref();
        let zones = &car.manoeuvre.friction_zones;
        let states = car.track.points.iter().zip(&path.velocity_m_s).zip(&path.at_m);
        let (is_marking, is_locked) = states
            .map(|((at, &[u, w]), &place_m)| {
                let friction = friction_at(zones, place_m, car.vehicle.tires.friction);
                let efforts = held.and_then(|held| held.at(at.time_s));
                let efforts = efforts.unwrap_or([WheelEffort::FREE; 4]);
                let speed = u.hypot(w);
                let along = u.abs() / (speed + 1e-6);
                let is_locked = locks(car.vehicle, friction, wheel, &efforts, along);
                (leaves_mark([u, w], is_locked), is_locked)
            })
            .unzip();
        Self { is_marking, is_locked }
    }

    /// Distance along the path from a place on it to where the wheel leaves a mark, m.
    pub fn distance_m(&self, path: &WheelTrack, idx: usize) -> f64 {
        match self.nearest_marking(path, idx) {
            Some(marking) => (path.travelled_m[marking] - path.travelled_m[idx]).abs().min(NEVER_M),
            None => NEVER_M,
        }
    }

    fn nearest_marking(&self, path: &WheelTrack, idx: usize) -> Option<usize> {
        let before = (0..=idx).rev().find(|&i| self.is_marking[i]);
        let after = (idx..self.is_marking.len()).find(|&i| self.is_marking[i]);
        let distance = |i: usize| (path.travelled_m[i] - path.travelled_m[idx]).abs();
        match (before, after) {
            (Some(a), Some(b)) if distance(b) < distance(a) => Some(b),
            (Some(a), _) => Some(a),
            (None, b) => b,
        }
    }

    /// From a place on the path, the first or the last point of the mark there, m along the path.
    ///
    /// - `step`: −1 for its start, +1 for its end.
    pub fn end_m(&self, path: &WheelTrack, idx: usize, step: isize) -> Option<f64> {
        let mut end = self.nearest_marking(path, idx)?;
        let mut at = end;
        loop {
            let Some(next) = at.checked_add_signed(step).filter(|&i| i < self.is_marking.len())
            else {
                return Some(path.travelled_m[end]);
            };
            at = next;
            if self.is_marking[at] {
                end = at;
            } else if (path.travelled_m[at] - path.travelled_m[end]).abs() > LARGEST_MARK_GAP_M {
                return Some(path.travelled_m[end]);
            }
        }
    }

    /// Share of the way between two points of the path on which the wheel is locked.
    pub fn locked_share(&self, path: &WheelTrack, from: usize, to: usize) -> f64 {
        let (mut locked_m, mut all_m) = (0.0, 1e-9);
        for i in from..to {
            let piece_m = path.travelled_m[i + 1] - path.travelled_m[i];
            all_m += piece_m;
            locked_m += if self.is_locked[i] { piece_m } else { 0.0 };
        }
        locked_m / all_m
    }
}

/// Whether a wheel is locked: by damage, or by more braking than the road can turn it against, at the
/// load that braking shifts to the front axle.
///
/// - `friction`: peak friction of the ground under the wheel;
/// - `along`: share of the velocity of the wheel that is in its plane.
fn locks(
    vehicle: &VehicleParameters,
    friction: f64,
    wheel: Wheel,
    efforts: &[WheelEffort<f64>; 4],
    along: f64,
) -> bool {
    let effort = &efforts[wheel.index()];
    let friction = friction * vehicle.tires.longitudinal_friction_ratio;
    let weight_n = vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2;
    let braking_n = efforts.iter().map(|effort| effort.braking_n).sum::<f64>();
    let geometry = &vehicle.geometry;
    let shifted_n = braking_n.min(friction * weight_n) * along * geometry.cg_height_m
        / geometry.wheelbase_m()
        / 2.0;
    let static_n = vehicle.static_loads_n()[wheel.index()];
    let load_n = if wheel.is_front() { static_n + shifted_n } else { static_n - shifted_n };
    effort.locked > 0.5
        || effort.braking_n > friction * load_n * along
            && effort.braking_n > 0.05 * friction * load_n
}
