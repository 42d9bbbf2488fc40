//! What steers, drives, brakes and locks the wheels of a vehicle over time.

use crate::data::Channel;
use crate::numerics::interpolate;
use crate::vehicle::drivers::ClosedLoop;
use crate::vehicle::tire::{LOCKING_SHARE, TireParameters, WheelEffort};
use crate::vehicle::{VehicleInput, Wheel};

/// Share to which a wheel is locked from which it is said to be.
const LOCKED_FROM: f64 = 0.5;

/// Channels of the brake torques, in the order of [`Wheel::ALL`](crate::vehicle::Wheel::ALL).
pub const BRAKE_TORQUES: [Channel; 4] =
    [Channel::BrakeFl, Channel::BrakeFr, Channel::BrakeRl, Channel::BrakeRr];

/// Channels of the drive torques, in the same order.
pub const DRIVE_TORQUES: [Channel; 4] =
    [Channel::DriveFl, Channel::DriveFr, Channel::DriveRl, Channel::DriveRr];

/// Steer angle of the front road wheels over time. It is linear between samples; outside, the first
/// or the last value holds.
#[derive(Debug, Clone, PartialEq)]
pub struct SteerHistory {
    /// Times of the samples, s, strictly rising.
    pub time_s: Vec<f64>,
    /// Steer angle δ of the front road wheels at these times, rad, positive to the left.
    pub steer_rad: Vec<f64>,
}

/// What drives, brakes and locks each wheel over time. It is linear between samples; outside, the
/// first or the last values hold.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelHistory {
    /// Times of the samples, s, strictly rising.
    pub time_s: Vec<f64>,
    /// The wheels at these times, in the order of [`Wheel::ALL`](crate::vehicle::Wheel::ALL).
    pub wheels: Vec<[WheelEffort<f64>; 4]>,
}

/// Everything that acts on the wheels over time. By default the vehicle coasts: steering wheel,
/// throttle and brake are released, and every wheel rolls freely.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Controls {
    /// Steer angle; with `None` it is zero.
    pub steer: Option<SteerHistory>,
    /// The wheels; with `None` they roll freely.
    pub wheels: Option<WheelHistory>,
    /// What acts by the motion of the vehicle, beside the histories; nothing with `None`.
    pub closed_loop: Option<ClosedLoop>,
}

impl Controls {
    /// Whether the vehicle coasts with its front wheels straight ahead.
    pub fn is_coasting(&self) -> bool {
        self.wheels.is_none() && self.closed_loop.is_none() && !self.is_steered()
    }

    /// Whether wheels may be driven, braked or locked.
    pub fn acts_on_wheels(&self) -> bool {
        self.wheels.is_some() || self.closed_loop.as_ref().is_some_and(ClosedLoop::acts_on_wheels)
    }

    /// Whether the front wheels are turned, or a driver may turn them.
    pub fn is_steered(&self) -> bool {
        let is_turned = |steer: &SteerHistory| steer.steer_rad.iter().any(|rad| *rad != 0.0);
        self.steer.as_ref().is_some_and(is_turned)
            || self.closed_loop.as_ref().is_some_and(ClosedLoop::steers)
    }

    /// Whether a stability control acts by the motion.
    pub fn has_stability_control(&self) -> bool {
        self.closed_loop.as_ref().is_some_and(|closed_loop| closed_loop.esc.is_some())
    }

    /// Whether a wheel is driven.
    pub fn is_driven(&self) -> bool {
        let efforts = self.wheels.iter().flat_map(|history| history.wheels.iter().flatten());
        efforts.into_iter().any(|wheel| wheel.drive_n != 0.0)
            || self.closed_loop.as_ref().is_some_and(ClosedLoop::drives)
    }

    /// The torques of the wheels at given times, N m, by their channels: those of brakes, engine and bent
    /// bodywork against the rotation, and those that drive. A locked wheel has no torque of its own. Only
    /// the histories count. Empty where no wheel is braked or driven.
    ///
    /// - `time_s`: the times, s;
    /// - `rolling_radius_m`: of the tires, more than 0.
    pub fn torques_n_m(&self, time_s: &[f64], rolling_radius_m: f64) -> Vec<(Channel, Vec<f64>)> {
        let Some(history) = &self.wheels else { return Vec::new() };
        let efforts: Vec<[WheelEffort<f64>; 4]> =
            time_s.iter().map(|&t| history.at(t).unwrap_or([WheelEffort::FREE; 4])).collect();
        let is_acting = |wheel: &WheelEffort<f64>| wheel.braking_n != 0.0 || wheel.drive_n != 0.0;
        if !efforts.iter().flatten().any(is_acting) {
            return Vec::new();
        }
        let columns = |channels: [Channel; 4], force_n: fn(&WheelEffort<f64>) -> f64| {
            let torque = |idx: usize| {
                let of_wheel = efforts.iter().map(|wheels| force_n(&wheels[idx]));
                of_wheel.map(|force_n| force_n * rolling_radius_m).collect()
            };
            (0..4).map(|idx| (channels[idx], torque(idx))).collect::<Vec<_>>()
        };
        let brakes = columns(BRAKE_TORQUES, |wheel| wheel.braking_n);
        let drive = columns(DRIVE_TORQUES, |wheel| wheel.drive_n);
        brakes.into_iter().chain(drive).collect()
    }

    /// Whether a wheel is locked at a time, by damage or by a brake that asks for more than the road can
    /// hold along the plane of the wheel; as in the tire model, with the peak of the friction. Only the
    /// histories count; those of a motion with drivers or systems are [`Motion::applied_controls`].
    ///
    /// - `velocity_m_s`: velocity of its centre along and across its own plane, m/s;
    /// - `load_n`: its vertical load, N.
    ///
    /// [`Motion::applied_controls`]: crate::vehicle::Motion::applied_controls
    pub fn is_locked(
        &self,
        time_s: f64,
        wheel: Wheel,
        velocity_m_s: [f64; 2],
        load_n: f64,
        tires: &TireParameters,
    ) -> bool {
        let Some(wheels) = self.wheels.as_ref().and_then(|wheels| wheels.at(time_s)) else {
            return false;
        };
        let effort = wheels[wheel.index()];
        let [u, w] = velocity_m_s;
        let along = u.abs() / (u * u + w * w + 1e-6).sqrt();
        let largest_n = tires.friction * tires.longitudinal_friction_ratio * load_n * along;
        let beyond = (effort.braking_n - largest_n) / (largest_n * LOCKING_SHARE + 1e-3);
        let by_brake = beyond.clamp(0.0, 1.0);
        by_brake + (1.0 - by_brake) * effort.locked >= LOCKED_FROM
    }
}

/// Steer angle and wheels of a motion at its output instants.
#[derive(Debug, Default)]
pub(super) struct AppliedControls {
    time_s: Vec<f64>,
    steer_rad: Vec<f64>,
    wheels: Vec<[WheelEffort<f64>; 4]>,
}

impl AppliedControls {
    /// - `coming`: input over the interval that begins.
    pub fn record(&mut self, time_s: f64, coming: &VehicleInput<f64>) {
        self.time_s.push(time_s);
        self.steer_rad.push(coming.steer_rad);
        self.wheels.push(coming.wheels.unwrap_or([WheelEffort::FREE; 4]));
    }

    /// The controls as histories. Where nothing acts they are as without histories.
    pub fn finish(self) -> Controls {
        let Self { time_s, steer_rad, wheels } = self;
        let is_steered = steer_rad.iter().any(|rad| *rad != 0.0);
        let acts = wheels.iter().flatten().any(|wheel| *wheel != WheelEffort::FREE);
        Controls {
            steer: is_steered.then(|| SteerHistory { time_s: time_s.clone(), steer_rad }),
            wheels: acts.then_some(WheelHistory { time_s, wheels }),
            closed_loop: None,
        }
    }
}

impl SteerHistory {
    /// Steer angle at a time, rad; 0 without samples.
    pub(super) fn at(&self, time_s: f64) -> f64 {
        interpolate(&self.time_s, &self.steer_rad, time_s).unwrap_or(0.0)
    }
}

impl WheelHistory {
    /// The wheels at a time; `None` while all of them roll freely, so that the rules for a vehicle
    /// that coasts apply.
    pub fn at(&self, time_s: f64) -> Option<[WheelEffort<f64>; 4]> {
        let after = self.time_s.partition_point(|&t| t <= time_s);
        let last = self.wheels.len().checked_sub(1)?;
        let (before, after) = (after.saturating_sub(1), after.min(last));
        let (from, to) = (self.wheels.get(before)?, self.wheels.get(after)?);
        let span_s = self.time_s.get(after)? - self.time_s.get(before)?;
        let share = match span_s > 0.0 {
            true => ((time_s - self.time_s.get(before)?) / span_s).clamp(0.0, 1.0),
            false => 0.0,
        };
        let between = |i: usize| {
            let mix = |value: fn(&WheelEffort<f64>) -> f64| {
                value(&from[i]) + (value(&to[i]) - value(&from[i])) * share
            };
            WheelEffort {
                drive_n: mix(|wheel| wheel.drive_n),
                braking_n: mix(|wheel| wheel.braking_n),
                locked: mix(|wheel| wheel.locked),
            }
        };
        let wheels: [WheelEffort<f64>; 4] = std::array::from_fn(between);
        wheels.iter().any(|wheel| *wheel != WheelEffort::none()).then_some(wheels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheels_are_linear_between_samples_and_free_where_nothing_acts() {
        let braked = |braking_n| [WheelEffort { braking_n, ..WheelEffort::none() }; 4];
        let history = WheelHistory {
            time_s: vec![1.0, 2.0, 3.0],
            wheels: vec![braked(0.0), braked(100.0), braked(50.0)],
        };
        for (time_s, expected) in [
            (0.0, None),
            (1.0, None),
            (1.5, Some(braked(50.0))),
            (2.0, Some(braked(100.0))),
            (2.5, Some(braked(75.0))),
            (3.0, Some(braked(50.0))),
            (9.0, Some(braked(50.0))),
        ] {
            assert_eq!(history.at(time_s), expected, "at {time_s} s");
        }
        assert_eq!(WheelHistory { time_s: Vec::new(), wheels: Vec::new() }.at(1.0), None);
    }

    #[test]
    fn torques_are_forces_at_the_rolling_radius_and_none_where_nothing_acts() {
        let mut wheels = [WheelEffort::FREE; 4];
        wheels[1] = WheelEffort { braking_n: 1000.0, ..WheelEffort::FREE };
        wheels[2] = WheelEffort { drive_n: 200.0, ..WheelEffort::FREE };
        let history =
            WheelHistory { time_s: vec![0.0, 1.0], wheels: vec![[WheelEffort::FREE; 4], wheels] };
        let controls = Controls { wheels: Some(history), ..Controls::default() };
        let torques = controls.torques_n_m(&[0.0, 0.5, 2.0], 0.3);
        let of = |channel| torques.iter().find(|(of, _)| *of == channel).map(|(_, n_m)| n_m);
        assert_eq!(torques.len(), 8);
        assert_eq!(of(Channel::BrakeFr), Some(&vec![0.0, 150.0, 300.0]));
        assert_eq!(of(Channel::DriveRl), Some(&vec![0.0, 30.0, 60.0]));
        assert_eq!(of(Channel::BrakeFl), Some(&vec![0.0; 3]));
        assert!(controls.torques_n_m(&[0.0], 0.3).is_empty());
        assert!(Controls::default().torques_n_m(&[0.0], 0.3).is_empty());
    }
}
