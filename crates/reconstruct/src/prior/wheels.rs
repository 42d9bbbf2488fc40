//! What is taken to be likely of drivers and of wheels that damage holds.

use std::f64::consts::PI;

use crate::evidence::{After, Bounds, Evidence, YesNoUnknown, ends};
use crate::latent::{STRIKING_BRAKES, STRIKING_BRAKES_BEFORE};
use crate::prior::{
    Prior, PriorSource, TIRE_FRICTION_FACTOR, TIRE_FRICTION_SCATTER, log_normal, normal,
};
use crate::{Distribution, Latent};

/// A decision of which nothing is known: it is compared with a probability.
pub(super) const ANY_DECISION: Distribution = Distribution::Uniform { low: 0.0, high: 1.0 };

/// Turn of the steering wheel by which a car is pushed in a PIT manoeuvre, rad: 90° to 180°.
const PUSH_STEERING_WHEEL_RAD: [f64; 2] = [PI / 2.0, PI];

/// Turn of the steering wheel up to which nobody pushes, rad: 5°, the play of a hand on the wheel.
const LEAST_PUSH_STEERING_RAD: f64 = 0.0873;

impl Prior {
    /// What driver and damage did to the wheels of both cars.
    pub(super) fn add_ending(&mut self, evidence: &Evidence) {
        let ranges = &evidence.prior;
        let of_user = [ranges.brake_start_s, ranges.brake_share];
        self.add_brakes(&evidence.after, of_user, log_normal(0.9, 0.47, 0.1, 6.0));
        let has_anti_lock = evidence.after.anti_lock == YesNoUnknown::Yes;
        let decision = if has_anti_lock { 0.0 } else { 1.0 };
        self.fixed.set(Latent::AntiLockDecision, decision);
        self.assume(Latent::EngineBraking, Distribution::Uniform { low: 0.0, high: 0.8 });
        self.assume(Latent::SteerAngle, normal(0.0, 0.015, -0.2, 0.2));
        let of_struck = [Latent::BlockedWheel, Latent::BlockedDrag];
        self.add_held_wheels(&evidence.after, of_struck);
        if evidence.follows_striking_car() {
            self.add_striking_ending(evidence);
        }
    }

    /// Whether the driver of the struck or the single car brakes, when and how hard.
    ///
    /// - `ranges`: of the start and of the share, of the user;
    /// - `usual_start`: when he begins where nobody says it, s.
    pub(super) fn add_brakes(
        &mut self,
        after: &After,
        ranges: [Option<Bounds>; 2],
        usual_start: Distribution,
    ) {
        match after.driver_braked {
            YesNoUnknown::Unknown => self.assume(Latent::BrakeDecision, ANY_DECISION),
            YesNoUnknown::Yes => self.fixed.set(Latent::BrakeDecision, 0.0),
            YesNoUnknown::No => return self.fixed.set(Latent::BrakeDecision, 1.0),
        }
        let [start, share] = ranges;
        self.open(Latent::BrakeStart, start, (PriorSource::Assumed, usual_start));
        self.assume(Latent::BrakeRise, log_normal(0.4, 0.5, 0.1, 1.5));
        self.assume(Latent::FrontBrakeShift, normal(0.0, 0.05, -0.2, 0.2));
        let usual = (PriorSource::Assumed, log_normal(0.8, 0.79, 0.05, 3.0));
        self.open(Latent::BrakeShare, share, usual);
    }

    /// The driver of a striking car that hits a flank behind the CG: whether he steers in and pushes on.
    pub(super) fn add_push(&mut self, evidence: &Evidence) {
        self.assume(Latent::StrikingYawRate, normal(0.3, 0.2, -0.5, 1.2));
        let range = evidence.prior.striking_steering_wheel_rad;
        match ends(range) {
            None => self.assume(Latent::PushDecision, ANY_DECISION),
            Some([_, high]) if high > LEAST_PUSH_STEERING_RAD => {
                self.fixed.set(Latent::PushDecision, 0.0);
            }
            Some(_) => return self.fixed.set(Latent::PushDecision, 1.0),
        }
        let [low, high] = PUSH_STEERING_WHEEL_RAD;
        let usual = (PriorSource::Assumed, Distribution::Uniform { low, high });
        self.open(Latent::PushSteeringWheel, range, usual);
        self.assume(Latent::PushDuration, log_normal(0.5, 0.7, 0.05, 4.0));
    }

    /// Wheels that damage holds: one of two near it where nobody looked.
    pub(super) fn add_held_wheels(&mut self, after: &After, [which, drag]: [Latent; 2]) {
        if !after.wheels_are_known() {
            self.assume(which, ANY_DECISION);
            self.assume(drag, Distribution::Uniform { low: 0.2, high: 1.6 });
        } else if after.dragging_wheels.iter().flatten().next().is_some() {
            self.assume(drag, Distribution::Uniform { low: 0.1, high: 1.0 });
        }
    }

    /// How the tires of the striking car differ from those of a friction test, unless that is assumed
    /// already.
    pub(super) fn assume_striking_tires(&mut self) {
        let latent = Latent::StrikingTireFrictionFactor;
        if self.components.iter().all(|component| component.latent != latent) {
            let factor = log_normal(TIRE_FRICTION_FACTOR, TIRE_FRICTION_SCATTER, 0.7, 1.4);
            self.assume(latent, factor);
        }
    }

    /// What driver and damage did to the wheels of the striking car.
    pub(super) fn add_striking_ending(&mut self, evidence: &Evidence) {
        let (after, ranges) = (&evidence.striking_after, &evidence.prior);
        // Who says when he begins, says that he does not before.
        let first = match ranges.striking_brake_start_s {
            Some(_) => STRIKING_BRAKES_BEFORE,
            None => 0.0,
        };
        let last = match after.driver_braked {
            YesNoUnknown::Unknown => Some(1.0),
            YesNoUnknown::Yes => Some(STRIKING_BRAKES),
            YesNoUnknown::No => None,
        };
        match last {
            Some(last) => {
                let decision = Distribution::Uniform { low: first, high: last };
                self.assume(Latent::StrikingBrakeDecision, decision);
                let start = (PriorSource::Assumed, log_normal(0.9, 0.47, 0.1, 6.0));
                self.open(Latent::StrikingBrakeStart, ranges.striking_brake_start_s, start);
                let share = (PriorSource::Assumed, log_normal(0.8, 0.79, 0.05, 3.0));
                self.open(Latent::StrikingBrakeShare, ranges.striking_brake_share, share);
            }
            None => self.fixed.set(Latent::StrikingBrakeDecision, 1.0),
        }
        self.assume_striking_tires();
        let latents = [Latent::StrikingBlockedWheel, Latent::StrikingBlockedDrag];
        self.add_held_wheels(after, latents);
    }
}
