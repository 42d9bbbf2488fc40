//! The motion that follows from speed and steering before a crash, as an event data recorder keeps them.
//!
//! The vehicle keeps the first speed and the first steer angle for two seconds before the record begins, so
//! that it turns steadily there as it would with them. The clock is that of the crash: 0 at the first contact.

use crate::data::{Channel, SeriesError};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::frames::Heading;
use crate::vehicle::{
    ClosedLoop, Controls, DrivenAxle, FollowedSpeed, Manoeuvre, Motion, OUTPUT_INTERVAL_S,
    PathPoint, SteerHistory, VehicleParameters, VehicleState,
};

/// How long the vehicle drives with the first speed and steer angle before the record begins, s.
const SETTLING_S: f64 = 2.0;

/// Speed and steer angle up to the first contact. They are linear between samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedDrive {
    /// Times of the samples, s, strictly rising, the last one 0.
    pub time_s: Vec<f64>,
    /// Velocity v_x along the vehicle, m/s, not backwards.
    pub speed_m_s: Vec<f64>,
    /// Steer angle of the front road wheels, rad, positive to the left.
    pub steer_rad: Vec<f64>,
}

/// The motion up to the first contact.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMotion {
    /// States every 10 ms, the last one at the first contact, time 0.
    pub points: Vec<PathPoint>,
    /// Largest horizontal acceleration from the beginning of the record up to each of them over what the
    /// friction of the road allows.
    friction_use: Vec<f64>,
}

impl RecordedDrive {
    /// The manoeuvre in which a vehicle drives so; its last instant is the first contact.
    ///
    /// - `axle`: the axle that is driven.
    pub fn manoeuvre(&self, axle: DrivenAxle) -> Manoeuvre {
        let contact_s = self.contact_s();
        let time_s: Vec<f64> = self.time_s.iter().map(|time_s| time_s + contact_s).collect();
        let steer = SteerHistory { time_s: time_s.clone(), steer_rad: self.steer_rad.clone() };
        let followed = FollowedSpeed { time_s, speed_m_s: self.speed_m_s.clone(), axle };
        let closed_loop = ClosedLoop { followed_speed: Some(followed), ..ClosedLoop::default() };
        let first_m_s = self.speed_m_s.first().copied().unwrap_or(0.0);
        Manoeuvre {
            initial: VehicleState::driving_straight(first_m_s),
            controls: Controls { steer: Some(steer), wheels: None, closed_loop: Some(closed_loop) },
            duration_s: contact_s,
            ..Manoeuvre::default()
        }
    }

    /// The motion of the manoeuvre on the clock of the crash.
    ///
    /// # Errors
    /// [`SeriesError`] if the motion lacks a channel.
    pub fn motion(
        &self,
        vehicle: &VehicleParameters,
        motion: &Motion,
    ) -> Result<RecordedMotion, SeriesError> {
        let mut points = PathPoint::of_series(&motion.series)?;
        let contact_s = self.contact_s();
        points.iter_mut().for_each(|point| point.time_s -= contact_s);
        if let Some(last) = points.last_mut() {
            last.time_s = 0.0;
        }
        let [ax, ay] = [motion.series.require(Channel::Ax)?, motion.series.require(Channel::Ay)?];
        let limit_m_s2 = vehicle.tires.friction * STANDARD_GRAVITY_M_S2;
        let mut largest = 0.0_f64;
        let up_to = |(point, (ax, ay)): (&PathPoint, (&f64, &f64))| {
            if point.time_s >= self.start_s() {
                largest = largest.max(ax.hypot(*ay) / limit_m_s2);
            }
            largest
        };
        let friction_use = points.iter().zip(ax.iter().zip(ay)).map(up_to).collect();
        Ok(RecordedMotion { points, friction_use })
    }

    /// When the record begins, s.
    pub fn start_s(&self) -> f64 {
        self.time_s.first().copied().unwrap_or(0.0)
    }

    /// The first contact on the clock of the manoeuvre, s: an instant of its output.
    fn contact_s(&self) -> f64 {
        let outputs = ((SETTLING_S - self.start_s()) / OUTPUT_INTERVAL_S).ceil();
        outputs * OUTPUT_INTERVAL_S
    }
}

impl RecordedMotion {
    /// The same motion, moved and turned so that it ends at a place.
    ///
    /// - `[x_m, y_m, yaw_rad]`: the CG and the heading at the first contact.
    #[must_use]
    pub fn ending_at(mut self, [x_m, y_m, yaw_rad]: [f64; 3]) -> Self {
        let Some(end) = self.points.last().copied() else { return self };
        let turn_rad = yaw_rad - end.yaw_rad;
        let heading = Heading::new(turn_rad);
        for point in &mut self.points {
            let [dx, dy] = heading.world_from_body([point.x_m - end.x_m, point.y_m - end.y_m]);
            (point.x_m, point.y_m) = (x_m + dx, y_m + dy);
            point.yaw_rad += turn_rad;
        }
        self
    }

    /// The state at a time, linear between those that are known; before the first one that one, and none of a
    /// motion without any.
    pub fn at(&self, time_s: f64) -> Option<PathPoint> {
        let after = self.points.partition_point(|point| point.time_s <= time_s);
        let from = self.points.get(after.saturating_sub(1))?;
        let to = self.points.get(after).unwrap_or(from);
        Some(from.towards(to, time_s))
    }

    /// Largest horizontal acceleration from the beginning of the record up to a time over what the friction of
    /// the road allows.
    pub fn friction_use_until(&self, time_s: f64) -> f64 {
        let after = self.points.partition_point(|point| point.time_s <= time_s);
        let last = after.checked_sub(1).and_then(|idx| self.friction_use.get(idx));
        last.copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::{Integrator, Preset};

    fn driven(time_s: Vec<f64>, speed_m_s: Vec<f64>, steer_rad: Vec<f64>) -> RecordedMotion {
        let vehicle = Preset::Reference.parameters();
        let drive = RecordedDrive { time_s, speed_m_s, steer_rad };
        let manoeuvre = drive.manoeuvre(DrivenAxle::Front);
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
        drive.motion(&vehicle, &motion).unwrap()
    }

    /// Speeds up, steady, down to standstill, none of them beyond the friction.
    #[test]
    fn the_recorded_speed_is_kept_and_the_path_is_its_integral() {
        let time_s = vec![-8.0, -6.0, -4.0, -1.0, 0.0];
        let motion = driven(time_s, vec![15.0, 19.0, 19.0, 4.0, 0.0], vec![0.0; 5]);
        for (time_s, speed_m_s) in
            [(-8.0, 15.0), (-7.0, 17.0), (-5.0, 19.0), (-2.5, 11.5), (0.0, 0.0)]
        {
            let point = motion.at(time_s).unwrap();
            assert!((point.vx_body_m_s - speed_m_s).abs() < 0.03, "{point:?}");
        }
        let length_m = motion.at(0.0).unwrap().x_m - motion.at(-8.0).unwrap().x_m;
        let integral_m = 34.0 + 38.0 + 34.5 + 2.0;
        assert!((length_m - integral_m).abs() < 0.05, "{length_m}");
        let [at_first, whole] = [-8.0, 0.0].map(|time_s| motion.friction_use_until(time_s));
        assert!(at_first < whole && whole < 0.7, "{at_first} {whole}");
    }

    /// With a constant angle it turns steadily from the beginning, as the linear bicycle model does.
    #[test]
    fn a_steady_turn_is_steady_from_the_first_sample() {
        let vehicle = Preset::Reference.parameters();
        let (speed_m_s, steer_rad) = (15.0, 0.02);
        let motion = driven(vec![-3.0, 0.0], vec![speed_m_s; 2], vec![steer_rad; 2]);
        let tires = &vehicle.tires;
        let gradient = (1.0 / tires.cornering_coefficient_front_per_rad
            - 1.0 / tires.cornering_coefficient_rear_per_rad)
            / STANDARD_GRAVITY_M_S2;
        let expected = speed_m_s * steer_rad
            / (vehicle.geometry.wheelbase_m() + gradient * speed_m_s * speed_m_s);
        for time_s in [-3.0, -1.5, 0.0] {
            let rate = motion.at(time_s).unwrap().yaw_rate_rad_s;
            assert!((rate / expected - 1.0).abs() < 0.05, "{time_s}: {rate}, {expected}");
        }
    }

    #[test]
    fn a_speed_that_falls_faster_than_the_road_allows_is_not_followed() {
        let motion = driven(vec![-2.0, -1.0, 0.0], vec![20.0, 20.0, 0.0], vec![0.0; 3]);
        let end = motion.at(0.0).unwrap();
        assert!(end.vx_body_m_s > 8.0, "{end:?}");
        let friction_use = motion.friction_use_until(0.0);
        assert!(friction_use > 0.85 && friction_use < 1.05, "{friction_use}");
    }

    #[test]
    fn a_motion_ends_where_it_is_put() {
        let motion = driven(vec![-3.0, 0.0], vec![15.0; 2], vec![0.0, 0.03]);
        let length = |motion: &RecordedMotion| {
            let [from, to] = [-3.0, 0.0].map(|time_s| motion.at(time_s).unwrap());
            (to.x_m - from.x_m).hypot(to.y_m - from.y_m)
        };
        let placed = motion.clone().ending_at([100.0, -20.0, 2.0]);
        let end = placed.at(0.0).unwrap();
        assert!((end.x_m - 100.0).abs() < 1e-9 && (end.y_m + 20.0).abs() < 1e-9, "{end:?}");
        assert!((end.yaw_rad - 2.0).abs() < 1e-9);
        assert!((length(&motion) - length(&placed)).abs() < 1e-9);
    }
}
