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
    /// Velocity v_x along the vehicle, m/s.
    pub speed_m_s: Vec<f64>,
    /// Steer angle of the front road wheels, rad, positive to the left.
    pub steer_rad: Vec<f64>,
}

/// The motion up to the first contact.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMotion {
    /// States every 10 ms, the last one at the first contact, time 0.
    pub points: Vec<PathPoint>,
    /// Largest horizontal acceleration along the record over what the friction of the road allows.
    pub friction_use: f64,
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
        let of = |channel| motion.series.require(channel);
        let [x, y, yaw] = [of(Channel::X)?, of(Channel::Y)?, of(Channel::Yaw)?];
        let [vx, vy, yaw_rate] = [of(Channel::Vx)?, of(Channel::Vy)?, of(Channel::YawRate)?];
        let [ax, ay] = [of(Channel::Ax)?, of(Channel::Ay)?];
        let [contact_s, start_s] = [self.contact_s(), self.start_s()];
        let n = motion.series.n_samples();
        let mut points = Vec::with_capacity(n);
        let mut largest_m_s2 = 0.0_f64;
        for (idx, time_s) in motion.series.time_s().iter().enumerate() {
            let at = |column: &[f64]| column.get(idx).copied().unwrap_or(f64::NAN);
            let time_s = if idx + 1 == n { 0.0 } else { time_s - contact_s };
            if time_s >= start_s {
                largest_m_s2 = largest_m_s2.max(at(ax).hypot(at(ay)));
            }
            points.push(PathPoint {
                time_s,
                x_m: at(x),
                y_m: at(y),
                yaw_rad: at(yaw),
                vx_body_m_s: at(vx),
                vy_body_m_s: at(vy),
                yaw_rate_rad_s: at(yaw_rate),
            });
        }
        let friction_use = largest_m_s2 / (vehicle.tires.friction * STANDARD_GRAVITY_M_S2);
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
        let last = self.points.len().checked_sub(1)?;
        let from = *self.points.get(after.saturating_sub(1))?;
        let to = *self.points.get(after.min(last))?;
        let span_s = to.time_s - from.time_s;
        let share = match span_s > 0.0 {
            true => ((time_s - from.time_s) / span_s).clamp(0.0, 1.0),
            false => 0.0,
        };
        let mix = |of: fn(&PathPoint) -> f64| of(&from) + (of(&to) - of(&from)) * share;
        Some(PathPoint {
            time_s,
            x_m: mix(|point| point.x_m),
            y_m: mix(|point| point.y_m),
            yaw_rad: mix(|point| point.yaw_rad),
            vx_body_m_s: mix(|point| point.vx_body_m_s),
            vy_body_m_s: mix(|point| point.vy_body_m_s),
            yaw_rate_rad_s: mix(|point| point.yaw_rate_rad_s),
        })
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
        assert!(motion.friction_use < 0.7, "{}", motion.friction_use);
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
        assert!(motion.friction_use > 0.85 && motion.friction_use < 1.05, "{motion:?}");
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
