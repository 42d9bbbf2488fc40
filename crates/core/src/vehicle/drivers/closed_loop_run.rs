//! Drivers and systems along a motion.

use crate::vehicle::drivers::antilock::ActingAntiLock;
use crate::vehicle::drivers::stability_control::{ActingStabilityControl, StabilityState};
use crate::vehicle::drivers::striking_driver::{ActingPitDriver, PitState};
use crate::vehicle::drivers::struck_driver::ActingCountersteer;
use crate::vehicle::drivers::{AntiLock, ClosedLoop, Countersteer, PitDriver, StabilityControl};
use crate::vehicle::tire::{WheelEffort, WheelHold};
use crate::vehicle::{
    Braking, VehicleConstants, VehicleInput, VehicleParameters, VehicleState, Wheel,
};

/// Drivers and systems along a motion, with what they ask for until the next sample.
#[derive(Debug, Clone)]
pub(in crate::vehicle) struct ClosedLoopRun<'a> {
    closed_loop: &'a ClosedLoop,
    vehicle: &'a VehicleParameters,
    esc: Option<(ActingStabilityControl, StabilityState)>,
    abs: Option<ActingAntiLock>,
    countersteer: Option<ActingCountersteer>,
    pit: Option<(ActingPitDriver, PitState)>,
    /// How far a car that was struck by this one has turned since the first contact, rad.
    pub struck_turn_rad: Option<f64>,
    steer_rad: Option<f64>,
    braking_n: [f64; 4],
    drive_n: [f64; 4],
}

impl<'a> ClosedLoopRun<'a> {
    pub fn new(closed_loop: &'a ClosedLoop, vehicle: &'a VehicleParameters) -> Self {
        let esc = closed_loop.esc.as_ref().map(StabilityControl::acting);
        let pit = closed_loop.pit.as_ref().map(PitDriver::acting);
        Self {
            closed_loop,
            vehicle,
            esc: esc.map(|esc| (esc, StabilityState::default())),
            abs: closed_loop.abs.as_ref().map(AntiLock::acting),
            countersteer: closed_loop.countersteer.as_ref().map(Countersteer::acting),
            pit: pit.map(|driver| (driver, PitState::default())),
            struck_turn_rad: None,
            steer_rad: None,
            braking_n: [0.0; 4],
            drive_n: [0.0; 4],
        }
    }

    /// Whether it brakes or drives wheels. Then wheels have efforts at all times, so that the motion takes
    /// one way through the equations, by itself and beside others.
    pub fn acts_on_wheels(&self) -> bool {
        self.closed_loop.acts_on_wheels()
    }

    /// The inputs of the histories with what was asked for at the last sample.
    pub fn applied_to(&self, mut histories: VehicleInput<f64>) -> VehicleInput<f64> {
        histories.steer_rad = self.steer_rad.unwrap_or(histories.steer_rad);
        if self.acts_on_wheels() {
            let wheels = histories.wheels.get_or_insert([WheelEffort::FREE; 4]);
            for (idx, wheel) in wheels.iter_mut().enumerate() {
                wheel.braking_n += self.braking_n[idx];
                wheel.drive_n += self.drive_n[idx];
            }
        }
        histories
    }

    /// Takes a sample of the motion.
    ///
    /// - `histories`: inputs by the histories alone, without a collision force: the systems know the
    ///   loads of the wheels as they follow from the forces of the road.
    pub fn sample(
        &mut self,
        time_s: f64,
        x: &VehicleState<f64>,
        histories: &VehicleInput<f64>,
        constants: &VehicleConstants<f64>,
    ) {
        let before = self.applied_to(*histories);
        let mut pedals: [Option<Braking>; 2] = [self.closed_loop.brake, None];
        self.steer_rad = None;
        if let Some((driver, pit)) = &mut self.pit {
            let (vehicle, turn_rad) = (self.vehicle, self.struck_turn_rad);
            let demand = pit.sample(driver, vehicle, time_s, x, before.steer_rad, turn_rad);
            (self.steer_rad, self.drive_n, pedals[1]) =
                (demand.steer_rad, demand.drive_n, demand.brake);
        }
        if let Some(driver) = &self.countersteer {
            let steer_rad = || driver.steer_rad(time_s, x, before.steer_rad);
            self.steer_rad = self.steer_rad.or_else(steer_rad);
        }
        if !self.acts_on_wheels() {
            return;
        }
        let steer_rad = self.steer_rad.unwrap_or(histories.steer_rad);
        let holds = constants.wheel_holds(x, &VehicleInput { steer_rad, ..before });
        let speed_m_s = x.vx_body_m_s.hypot(x.vy_body_m_s);
        let asked_n = self
            .esc
            .as_mut()
            .map(|(esc, state)| (*esc, state.sample(esc, self.vehicle, time_s, x, steer_rad)));
        let by_esc = asked_n.map(|(esc, asked_n)| self.held_at_slip_n(&esc, &asked_n, &holds));
        let efforts = histories.wheels.unwrap_or([WheelEffort::FREE; 4]);
        for wheel in Wheel::ALL {
            let idx = wheel.index();
            let of_pedal = |pedal: &Braking| pedal.force_n(self.vehicle, wheel, time_s);
            let pedal_n: f64 = pedals.iter().flatten().map(of_pedal).fold(0.0, f64::max);
            let (other_n, largest_n) = (efforts[idx].braking_n, holds[idx].largest_braking_n);
            let allowed_n =
                |abs: ActingAntiLock| abs.allowed_n(pedal_n, other_n, largest_n, speed_m_s);
            let by_pedal_n = self.abs.map_or(pedal_n, allowed_n);
            self.braking_n[idx] = by_esc.map_or(by_pedal_n, |by_esc| by_pedal_n.max(by_esc[idx]));
        }
        if let Some(followed) = &self.closed_loop.followed_speed {
            let free = VehicleInput { steer_rad, ..*histories };
            let free_m_s2 = constants.evaluate(x, &free).derivative.vx_body_m_s;
            let speed_m_s = x.vx_body_m_s;
            let demand = followed.demand(self.vehicle, time_s, speed_m_s, free_m_s2, &holds);
            self.drive_n = demand.drive_n;
            for (own_n, asked_n) in self.braking_n.iter_mut().zip(demand.braking_n) {
                *own_n = own_n.max(asked_n);
            }
        }
    }

    /// The forces that a stability control asks for, limited by the slip at which it holds the wheels, N.
    fn held_at_slip_n(
        &self,
        esc: &ActingStabilityControl,
        asked_n: &[f64; 4],
        holds: &[WheelHold; 4],
    ) -> [f64; 4] {
        let tires = &self.vehicle.tires;
        let abs = self.abs.unwrap_or_else(|| AntiLock::default().acting());
        Wheel::ALL.map(|wheel| {
            let WheelHold { friction_n, largest_braking_n, slip_angle_rad } = holds[wheel.index()];
            let coefficient = match wheel.is_front() {
                true => tires.cornering_coefficient_front_per_rad,
                false => tires.cornering_coefficient_rear_per_rad,
            };
            let held_n = friction_n * tires.longitudinal_friction_ratio;
            let by_slip_n = esc.slip_held_n(held_n, coefficient / tires.friction, slip_angle_rad);
            asked_n[wheel.index()].min(by_slip_n).min(abs.share_of_peak * largest_braking_n)
        })
    }
}
