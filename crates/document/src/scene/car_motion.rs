//! The motion of a car as it is drawn: pose, steered front wheels, and how far each wheel has turned.
//!
//! A wheel that is not locked rolls: it turns by the way that its centre moves along its own plane over
//! its radius. Longitudinal slip of a wheel that is braked or driven without being locked is left out of
//! the picture.

use crate::scene::{CarBody, N_WHEELS};
use impactlab_core::collision::Pose;
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_core::vehicle::{ControlledVehicle, VehicleParameters, Wheel};

/// Speed below which the direction of a wheel's motion is not known, m/s.
const LEAST_SPEED_M_S: f64 = 1e-3;

/// Where a car is and how its wheels stand, at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CarState {
    /// Position of the CG and heading.
    pub pose: Pose,
    /// Roll angle, rad, positive if the body leans to the right.
    pub roll_rad: f64,
    /// Steer angle of the front wheels `[left, right]`, rad, positive to the left.
    pub steer_rad: [f64; 2],
    /// Angle by which each wheel has turned since the start, rad, positive forwards.
    pub turned_rad: [f64; N_WHEELS],
    /// Whether each wheel is locked.
    pub locked: [bool; N_WHEELS],
}

/// The motion of a car over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CarMotion {
    time_s: Vec<f64>,
    states: Vec<CarState>,
}

impl CarMotion {
    /// The motion of a time series: X and Y are required, and what else is missing is zero.
    ///
    /// - `controls`: what locks the wheels; without it they roll.
    /// - returns `None` without X or Y, or without samples.
    pub fn from_series(
        series: &TimeSeries,
        body: &CarBody,
        controls: Option<ControlledVehicle<'_>>,
    ) -> Option<Self> {
        let (x, y) = (series.get(Channel::X)?, series.get(Channel::Y)?);
        let value = |channel, idx: usize| -> Option<f64> {
            series.get(channel).and_then(|values| values.get(idx)).copied()
        };
        let n = series.n_samples().min(x.len()).min(y.len());
        let state = |idx: usize| {
            let both = value(Channel::Steer, idx).unwrap_or(0.0);
            CarState {
                pose: Pose {
                    x_m: x.get(idx).copied().unwrap_or(0.0),
                    y_m: y.get(idx).copied().unwrap_or(0.0),
                    yaw_rad: value(Channel::Yaw, idx).unwrap_or(0.0),
                },
                roll_rad: value(Channel::Roll, idx).unwrap_or(0.0),
                steer_rad: [Channel::SteerFl, Channel::SteerFr]
                    .map(|channel| value(channel, idx).unwrap_or(both)),
                ..CarState::default()
            }
        };
        let mut motion =
            Self { time_s: series.time_s().to_vec(), states: (0..n).map(state).collect() };
        motion.time_s.truncate(n);
        let load = |idx: usize, wheel: Wheel| {
            let channels = [Channel::FzFl, Channel::FzFr, Channel::FzRl, Channel::FzRr];
            channels.get(wheel.index()).and_then(|channel| value(*channel, idx))
        };
        motion.turn_wheels(body, |(idx, pose), time_s, wheel, velocity| {
            let vehicle = controls?;
            let load_n = load(idx, wheel).unwrap_or_else(|| static_load_n(vehicle.vehicle, wheel));
            let place_m = pose.world_from_body(vehicle.vehicle.geometry.wheel_place_m(wheel));
            vehicle.is_locked(time_s, wheel, place_m, velocity, load_n).then_some(())
        });
        (n > 0).then_some(motion)
    }

    /// The motion along poses at the same distance in time, s; `None` without poses.
    pub fn from_poses(poses: &[Pose], step_s: f64, body: &CarBody) -> Option<Self> {
        let states = poses.iter().map(|pose| CarState { pose: *pose, ..CarState::default() });
        let time_s = (0..poses.len()).map(|idx| idx as f64 * step_s).collect();
        let mut motion = Self { time_s, states: states.collect() };
        motion.turn_wheels(body, |_, _, _, _| None);
        (!poses.is_empty()).then_some(motion)
    }

    /// The same motion at a later time, s.
    #[must_use]
    pub fn later_by(mut self, offset_s: f64) -> Self {
        self.time_s.iter_mut().for_each(|time_s| *time_s += offset_s);
        self
    }

    /// A car that does not move.
    pub fn standing(pose: Pose) -> Self {
        Self { time_s: vec![0.0], states: vec![CarState { pose, ..CarState::default() }] }
    }

    /// Instants of the motion, s.
    pub fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// States at these instants.
    pub fn states(&self) -> &[CarState] {
        &self.states
    }

    /// The last instant, s.
    pub fn end_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or(0.0)
    }

    /// The state at a time, linear between the instants; before the first and after the last of them the
    /// car stands.
    pub fn at(&self, time_s: f64) -> CarState {
        let after = self.time_s.partition_point(|time| *time <= time_s);
        let first = self.states.first().copied().unwrap_or_default();
        let Some(before) = after.checked_sub(1) else { return first };
        let from = self.states.get(before).copied().unwrap_or(first);
        let (Some(to), Some(start_s), Some(end_s)) =
            (self.states.get(after), self.time_s.get(before), self.time_s.get(after))
        else {
            return from;
        };
        let share = if end_s > start_s { (time_s - start_s) / (end_s - start_s) } else { 0.0 };
        let mix = |from: f64, to: f64| from + (to - from) * share;
        CarState {
            pose: Pose {
                x_m: mix(from.pose.x_m, to.pose.x_m),
                y_m: mix(from.pose.y_m, to.pose.y_m),
                yaw_rad: mix(from.pose.yaw_rad, to.pose.yaw_rad),
            },
            roll_rad: mix(from.roll_rad, to.roll_rad),
            steer_rad: std::array::from_fn(|i| mix(from.steer_rad[i], to.steer_rad[i])),
            turned_rad: std::array::from_fn(|i| mix(from.turned_rad[i], to.turned_rad[i])),
            locked: from.locked,
        }
    }

    /// Turns the wheels by the way that they roll.
    ///
    /// - `is_locked`: of sample and pose there, time, wheel, and velocity of its centre `[along, across]` its own plane,
    ///   m/s; `Some` where it is locked.
    fn turn_wheels(
        &mut self,
        body: &CarBody,
        is_locked: impl Fn((usize, Pose), f64, Wheel, [f64; 2]) -> Option<()>,
    ) {
        for idx in 0..self.states.len() {
            let velocities = self.wheel_velocities(idx, body);
            let time_s = self.time_s.get(idx).copied().unwrap_or(0.0);
            let at = (idx, self.states.get(idx).map_or_else(Pose::default, |state| state.pose));
            let locked = Wheel::ALL
                .map(|wheel| is_locked(at, time_s, wheel, velocities[wheel.index()]).is_some());
            let step_s = self.time_s.get(idx + 1).map_or(0.0, |next| next - time_s);
            let Some(state) = self.states.get_mut(idx) else { return };
            state.locked = locked;
            let mut turned = state.turned_rad;
            for i in 0..N_WHEELS {
                if !locked[i] && body.wheel_radius_m > 0.0 {
                    turned[i] += velocities[i][0] * step_s / body.wheel_radius_m;
                }
            }
            if let Some(next) = self.states.get_mut(idx + 1) {
                next.turned_rad = turned;
            }
        }
    }

    /// Velocity of each wheel's centre along and across its own plane over the interval that begins, m/s;
    /// at the end, over the last one.
    fn wheel_velocities(&self, idx: usize, body: &CarBody) -> [[f64; 2]; N_WHEELS] {
        let from = if idx + 1 < self.states.len() { idx } else { idx.saturating_sub(1) };
        let (Some(a), Some(b)) = (self.states.get(from), self.states.get(from + 1)) else {
            return [[0.0; 2]; N_WHEELS];
        };
        let step_s = match (self.time_s.get(from), self.time_s.get(from + 1)) {
            (Some(start_s), Some(end_s)) if end_s > start_s => end_s - start_s,
            _ => return [[0.0; 2]; N_WHEELS],
        };
        let rate = (b.pose.yaw_rad - a.pose.yaw_rad) / step_s;
        let yaw_rad = (a.pose.yaw_rad + b.pose.yaw_rad) / 2.0;
        let world = [b.pose.x_m - a.pose.x_m, b.pose.y_m - a.pose.y_m].map(|way| way / step_s);
        let [vx, vy] = body_from_world(yaw_rad, world);
        Wheel::ALL.map(|wheel| {
            let [x, y, _] = body.wheel_m(wheel);
            let of_hub = [vx - rate * y, vy + rate * x];
            let steer_rad = match wheel {
                Wheel::FrontLeft => a.steer_rad[0],
                Wheel::FrontRight => a.steer_rad[1],
                Wheel::RearLeft | Wheel::RearRight => 0.0,
            };
            let own = body_from_world(steer_rad, of_hub);
            if own[0].hypot(own[1]) < LEAST_SPEED_M_S { [0.0; 2] } else { own }
        })
    }
}

/// Load of a wheel at rest, N.
fn static_load_n(vehicle: &VehicleParameters, wheel: Wheel) -> f64 {
    let geometry = &vehicle.geometry;
    let other_m = match wheel.is_front() {
        true => geometry.cg_to_rear_axle_m,
        false => geometry.cg_to_front_axle_m,
    };
    let weight_n = vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2;
    weight_n * other_m / geometry.wheelbase_m() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::Footprint;
    use impactlab_core::vehicle::{
        Braking, DamagedWheel, Ending, FrictionZone, Integrator, Manoeuvre, Preset, VehicleState,
    };

    fn driven(ending: &Ending, speed_m_s: f64) -> (CarMotion, CarBody) {
        driven_on(&[], ending, speed_m_s)
    }

    fn driven_on(zones: &[FrictionZone], ending: &Ending, speed_m_s: f64) -> (CarMotion, CarBody) {
        let vehicle = Preset::Reference.parameters();
        let controls = ending.controls(&vehicle);
        let manoeuvre = Manoeuvre {
            initial: VehicleState::driving_straight(speed_m_s),
            controls: controls.clone(),
            duration_s: 2.0,
            friction_zones: zones.to_vec(),
            ..Manoeuvre::default()
        };
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
        let body = CarBody::new(&vehicle, &Footprint::from(&vehicle.geometry));
        let motion = CarMotion::from_series(
            &motion.series,
            &body,
            Some(ControlledVehicle {
                controls: &controls,
                vehicle: &vehicle,
                friction_zones: zones,
            }),
        );
        (motion.unwrap(), body)
    }

    #[test]
    fn a_free_wheel_turns_by_the_way_over_its_radius() {
        let (motion, body) = driven(&Ending::default(), 15.0);
        let end = motion.at(2.0);
        for turned_rad in end.turned_rad {
            let way_m = turned_rad * body.wheel_radius_m;
            assert!((way_m - end.pose.x_m).abs() < 1e-6, "{way_m} against {}", end.pose.x_m);
        }
        assert_eq!(end.locked, [false; 4]);
    }

    #[test]
    fn a_locked_wheel_does_not_turn() {
        let brake = Braking {
            start_s: 0.5,
            share_of_friction: 1.5,
            rise_s: 0.1,
            front_share: None,
            abs: None,
            lock_delay_s: 0.0,
        };
        let (motion, _) = driven(&Ending { brake: Some(brake), ..Ending::default() }, 25.0);
        let (early, late, later) = (motion.at(0.4), motion.at(1.0), motion.at(1.5));
        assert_eq!((early.locked, late.locked), ([false; 4], [true; 4]));
        assert_eq!(late.turned_rad, later.turned_rad);
        assert!(later.pose.x_m > late.pose.x_m + 3.0, "it slides on");
        assert!(early.turned_rad[0] > 20.0);
    }

    #[test]
    fn a_brake_that_the_road_holds_locks_the_wheels_on_ice() {
        let ending = Ending { brake: Some(Braking::new(0.0, 0.5, 0.1)), ..Ending::default() };
        let ice = FrictionZone {
            name: "ice".to_owned(),
            border_m: vec![[20.0, -9.0], [99.0, -9.0], [99.0, 0.0], [20.0, 0.0]],
            friction: 0.1,
        };
        let (motion, _) = driven_on(&[ice], &ending, 25.0);
        assert_eq!(motion.at(0.3).locked, [false; 4]);
        assert_eq!(motion.at(1.5).locked, [false, true, false, true], "ice lies on the right");
    }

    #[test]
    fn a_damaged_wheel_alone_is_locked() {
        let damage = vec![DamagedWheel {
            wheel: Wheel::RearRight,
            drag_share_of_friction: None,
            start_s: 0.2,
        }];
        let (motion, _) = driven(&Ending { damage, ..Ending::default() }, 25.0);
        assert_eq!(motion.at(1.0).locked, [false, false, false, true]);
    }

    #[test]
    fn a_car_stands_before_and_after_its_motion() {
        let pose = |x_m| Pose { x_m, y_m: 1.0, yaw_rad: 0.0 };
        let body = driven(&Ending::default(), 1.0).1;
        let motion = CarMotion::from_poses(&[pose(0.0), pose(2.0), pose(4.0)], 0.5, &body).unwrap();
        for (time_s, x_m) in [(-1.0, 0.0), (0.0, 0.0), (0.25, 1.0), (1.0, 4.0), (9.0, 4.0)] {
            assert_eq!(motion.at(time_s).pose.x_m, x_m, "at {time_s} s");
        }
        assert_eq!(CarMotion::from_poses(&[], 0.5, &body), None);
    }
}
