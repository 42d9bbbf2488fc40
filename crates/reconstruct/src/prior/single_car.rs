//! What is taken to be likely of a single car.
//!
//! | quantity | default | source |
//! | --- | --- | --- |
//! | speed at the start | uniform, 0 to 60 m/s | nothing is known |
//! | sideslip angle at the start | normal, 0° ± 9° | marks begin at a few degrees; assumed |
//! | yaw rate at the start | normal, 0 ± 0.4 rad/s | a curve at the limit of friction has 0.2 to 0.6; assumed |
//! | place at the start | where the earliest mark begins, ± 0.3 m and that of its points | a faint start |
//! | course at the start | along the first piece of that mark, ± 9°, else towards rest, ± 23° | assumed |
//! | front wheels held at | normal, 0 ± 5° | a bend or an evasion; assumed |
//! | driver brakes | 3 of 4 | assumed |
//! | … from | normal, −0.2 ± 0.7 s about a start by a mark | marks begin where somebody brakes; assumed |
//! | … | uniform, −1.5 to 4 s about a stated start | a place says nothing of the driver; assumed |
//! | … before the start, if said how long | uniform over it, 0.5 to 1 of the friction | no locked wheels; assumed |
//! | … with an anti-lock system | 1 of 2 | nothing is known; without it, wheels lock where the road does not hold them |
//! | wheels | those that somebody found locked or dragged are so from the start on | |
//!
//! Four locked wheels leave no part for brakes, engine and steering. The mass is that which is stated: friction,
//! inertia and cornering stiffness go with it, so that the motion hardly depends on it.

use crate::cars::Cars;
use crate::evidence::{After, Evidence, Measured, Start, YesNoUnknown, ends};
use crate::prior::wheels::ANY_DECISION;
use crate::prior::{HIGHEST_SPEED_M_S, Prior, PriorSource, normal};
use crate::single_car::StartPlace;
use crate::{Distribution, Latent, LatentValues};
use std::f64::consts::PI;

impl Prior {
    /// The prior of a single car.
    pub(super) fn of_single_car(evidence: &Evidence, cars: &Cars) -> Self {
        let mut prior = Self { components: Vec::new(), fixed: LatentValues::NONE, is_pit: false };
        prior.add_start(evidence, cars);
        prior.add_road(evidence);
        let weighed_kg = evidence.struck_car.mass().map(|mass| mass.value);
        let mass_kg = weighed_kg.unwrap_or(cars.struck.parameters.mass.mass_kg);
        prior.fixed.set(Latent::StruckMass, mass_kg);
        prior.add_struck_car(cars);
        prior.add_wheels(evidence);
        prior
    }

    fn add_start(&mut self, evidence: &Evidence, cars: &Cars) {
        let ranges = &evidence.start;
        let assumed = |distribution| (PriorSource::Assumed, distribution);
        let any = Distribution::Uniform { low: 0.0, high: HIGHEST_SPEED_M_S };
        self.open(Latent::CarSpeed, ranges.speed_m_s, assumed(any));
        let sideslip = normal(0.0, 0.15, -1.2, 1.2);
        self.open(Latent::CarSideslip, ranges.sideslip_rad, assumed(sideslip));
        let yaw_rate = normal(0.0, 0.4, -3.0, 3.0);
        self.open(Latent::CarYawRate, ranges.yaw_rate_rad_s, assumed(yaw_rate));
        let Some(start) = StartPlace::of(evidence, cars) else { return };
        for (latent, value) in [Latent::StartX, Latent::StartY].into_iter().zip(start.place_m) {
            let reach_m = 4.0 * start.sigma_m;
            let place = normal(value, start.sigma_m, value - reach_m, value + reach_m);
            self.add(latent, PriorSource::Measured, place);
        }
        match ranges.heading() {
            Some(Measured { value, sigma }) => {
                let heading = normal(value, sigma, value - PI, value + PI);
                self.add(Latent::StartHeading, PriorSource::Measured, heading);
            }
            None => {
                let (mean, sigma) = (start.course_rad, start.course_sigma_rad);
                self.assume(Latent::StartCourse, normal(mean, sigma, mean - PI, mean + PI));
            }
        }
    }

    /// The braking before the start, of which there are no marks.
    fn open_before_start(&mut self, ranges: &Start) {
        let Some([low, high]) = ends(ranges.braked_before_s) else { return };
        self.add(Latent::BrakedBefore, PriorSource::Given, Distribution::Uniform { low, high });
        let usual = (PriorSource::Assumed, Distribution::Uniform { low: 0.5, high: 1.0 });
        self.open(Latent::BrakedBeforeShare, ranges.braked_before_share, usual);
    }

    /// What driver and wheels do.
    fn add_wheels(&mut self, evidence: &Evidence) {
        let (after, ranges) = (&evidence.after, &evidence.start);
        let brakes_before = evidence.brakes_before_start();
        if brakes_before {
            self.open_before_start(ranges);
        }
        if after.is_all_locked() {
            // By the brakes, and not by a force that could turn a wheel.
            for (latent, value) in [
                (Latent::BrakeDecision, 0.0),
                (Latent::BrakeStart, -2.0),
                (Latent::BrakeRise, 1.0),
                (Latent::FrontBrakeShift, 0.0),
                (Latent::BrakeShare, 0.0),
                (Latent::EngineBraking, 0.0),
                (Latent::SteerAngle, 0.0),
            ] {
                self.fixed.set(latent, value);
            }
            return;
        }
        // Who braked before the start brakes there.
        let [latest_s, latest_by_mark_s] = if brakes_before { [0.0; 2] } else { [4.0, 6.0] };
        let start = match ranges.place_m() {
            Some(_) => Distribution::Uniform { low: -1.5, high: latest_s },
            None => normal(-0.2, 0.7, -1.5, latest_by_mark_s),
        };
        let driver_braked = if brakes_before { YesNoUnknown::Yes } else { after.driver_braked };
        let of_driver = After { driver_braked, ..after.clone() };
        self.add_brakes(&of_driver, [ranges.brake_start_s, ranges.brake_share], start);
        match after.anti_lock {
            _ if after.driver_braked == YesNoUnknown::No => {}
            YesNoUnknown::Unknown => self.assume(Latent::AntiLockDecision, ANY_DECISION),
            YesNoUnknown::Yes => self.fixed.set(Latent::AntiLockDecision, 0.0),
            YesNoUnknown::No => self.fixed.set(Latent::AntiLockDecision, 1.0),
        }
        self.assume(Latent::EngineBraking, Distribution::Uniform { low: 0.0, high: 0.8 });
        let steer = normal(0.0, 0.087, -0.6, 0.6);
        self.open(Latent::SteerAngle, ranges.road_wheel_rad, (PriorSource::Assumed, steer));
        if after.wheels_are_known() {
            self.add_held_wheels(after, [Latent::BlockedWheel, Latent::BlockedDrag]);
        }
    }
}
