//! The cars of a particle, and what happens to their wheels.

use crate::evidence::YesNoUnknown;
use crate::forward::{CONTACT_HEIGHT_M, ForwardModel, HELD_BEFORE_S, LONGEST_MOTION_S};
use crate::prior::towards;
use crate::{ImpactState, Latent, LatentValues};
use impactlab_core::collision::{Pulse, PulseShape};
use impactlab_core::data::{ForceAxes, ForceHistory, Sampling};
use impactlab_core::ranges::STRUCK_TURN;
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{
    AntiLock, Braking, ContactLoad, ContactPoint, DEFAULT_BRAKE_RISE_S, DrivenAxle, Ending,
    EngineBraking, FrictionZone, HeldSteer, Manoeuvre, PitDriver, PitEnd, VehicleParameters,
    VehicleState,
};

/// When the front wheels are turned, s after the first contact.
const STEERED_FROM_S: f64 = 0.1;

/// When the driver of the striking car who pushes begins to turn in, s after the first contact.
const PUSH_STEERED_FROM_S: f64 = -0.5;

/// Longest time that wheels need to stop turning, s.
const LONGEST_LOCK_DELAY_S: f64 = 1.0;

/// Samples of a pulse.
const PULSE_SAMPLES: f64 = 16.0;

impl ForwardModel {
    /// The struck car of a particle.
    pub(super) fn vehicle(&self, values: &LatentValues) -> VehicleParameters {
        let sheet = &self.cars.struck.parameters;
        let mass_kg = values.get(Latent::StruckMass);
        let yaw_inertia = sheet.mass.yaw_inertia_kg_m2 * mass_kg / sheet.mass.mass_kg
            * values.get(Latent::YawInertiaFactor);
        let mut vehicle = sheet.clone().scaled_to_mass(mass_kg, Some(yaw_inertia));
        let tires = &mut vehicle.tires;
        tires.friction = values.get(Latent::RoadFriction) * values.get(Latent::TireFrictionFactor);
        tires.sliding_friction_ratio = values.get(Latent::SlidingRatio);
        tires.longitudinal_friction_ratio = values.get(Latent::LongitudinalFrictionRatio);
        tires.rolling_resistance = values.get(Latent::RollingResistance);
        tires.cornering_coefficient_front_per_rad *= values.get(Latent::FrontCorneringFactor);
        tires.cornering_coefficient_rear_per_rad *= values.get(Latent::RearCorneringFactor);
        vehicle
    }

    /// What happens to the wheels of the struck car.
    pub(super) fn ending(&self, values: &LatentValues, vehicle: &VehicleParameters) -> Ending {
        let [struck, _] = &self.wheels;
        let damage = struck.damage(values);
        let brake = values.brakes().then(|| {
            let brake = Braking::new(
                values.get(Latent::BrakeStart),
                values.get(Latent::BrakeShare) * values.get(Latent::LongitudinalFrictionRatio),
                values.get(Latent::BrakeRise),
            );
            let shift = values.get(Latent::FrontBrakeShift);
            let abs = values.has_anti_lock().then(AntiLock::default);
            // Wheels that an anti-lock system keeps turning need no time to stop.
            let lock_delay_s = match abs {
                Some(_) => 0.0,
                None => lock_delay_s(vehicle, &brake, self.speed_m_s(values)),
            };
            Braking {
                front_share: Some(brake.ideal_front_share(vehicle) + shift),
                lock_delay_s,
                abs,
                ..brake
            }
        });
        let engine = brake.is_none().then(|| EngineBraking {
            deceleration_m_s2: values.get(Latent::EngineBraking),
            axle: DrivenAxle::All,
        });
        let steer = HeldSteer {
            start_s: if self.is_of_single_car() { -HELD_BEFORE_S } else { STEERED_FROM_S },
            rise_s: DEFAULT_BRAKE_RISE_S,
            road_wheel_rad: values.get(Latent::SteerAngle),
        };
        Ending { brake, engine, damage, steer: Some(steer), ..Ending::default() }
    }

    /// The zones of the ground with the friction that a car has in them, within the range of a zone:
    ///
    /// ```text
    /// μ = μ_site · f_zone · f_tire
    /// ```
    ///
    /// - `tire_factor`: f_tire, friction of the tires of the car over that which was measured.
    pub(super) fn zones_under(&self, values: &LatentValues, tire_factor: f64) -> Vec<FrictionZone> {
        let factor = values.get(Latent::ZoneFrictionFactor) * tire_factor;
        self.zones.iter().map(|zone| zone.scaled(factor)).collect()
    }

    /// The striking car and what happens to it.
    pub(super) fn striking(
        &self,
        values: &LatentValues,
        impact: &ImpactState,
    ) -> (VehicleParameters, Manoeuvre) {
        let mass_kg = values.get(Latent::StrikingMass);
        let mut vehicle = self.cars.striking.parameters.clone().scaled_to_mass(mass_kg, None);
        let tire_factor = values.get(Latent::StrikingTireFrictionFactor);
        let tires = &mut vehicle.tires;
        tires.friction = values.get(Latent::RoadFriction) * tire_factor;
        // How tires slide is a matter of the road more than of the car.
        tires.sliding_friction_ratio = values.get(Latent::SlidingRatio);
        tires.longitudinal_friction_ratio = values.get(Latent::LongitudinalFrictionRatio);
        let ending = self.striking_ending(values);
        let (sin, cos) = impact.heading_difference_rad.sin_cos();
        let in_body = |[x, y]: [f64; 2]| [x * cos + y * sin, y * cos - x * sin];
        let [vx_body_m_s, vy_body_m_s] = in_body(impact.striking_velocity_m_s);
        let arm_m = [0, 1].map(|i| impact.contact_m[i] - impact.striking_m[i]);
        let impulse = impact.solution.impulse_world_n_s.map(|p| -p);
        let manoeuvre = Manoeuvre {
            initial: VehicleState {
                vx_body_m_s,
                vy_body_m_s,
                yaw_rad: impact.heading_difference_rad,
                yaw_rate_rad_s: self.striking_yaw_rate_rad_s(values),
                x_m: impact.striking_m[0],
                y_m: impact.striking_m[1],
                ..VehicleState::default()
            },
            contact_load: Some(contact_load(impulse, values, in_body(arm_m))),
            controls: ending.controls(&vehicle),
            duration_s: LONGEST_MOTION_S,
            ends_at_rest: true,
            friction_zones: self.zones_under(values, tire_factor),
        };
        (vehicle, manoeuvre)
    }

    /// What happens to the wheels of the striking car. A driver who pushes brakes after it if he does.
    fn striking_ending(&self, values: &LatentValues) -> Ending {
        let [_, striking] = &self.wheels;
        let damage = striking.damage(values);
        let brakes_from_s = values.striking_brakes_from_s();
        let brake_share = brakes_from_s.map(|_| {
            values.get(Latent::StrikingBrakeShare) * values.get(Latent::LongitudinalFrictionRatio)
        });
        let has_anti_lock = striking.after.anti_lock == YesNoUnknown::Yes;
        let abs = has_anti_lock.then(AntiLock::default);
        if values.striking_pushes() {
            let end = brake_share.map_or(PitEnd::Straighten, |_| PitEnd::Brake);
            let inwards_rad = values.get(Latent::PushSteeringWheel);
            let pit = PitDriver {
                start_s: Some(PUSH_STEERED_FROM_S),
                steering_wheel_rad: Some(towards(self.side) * inwards_rad),
                end: Some(end),
                // He goes by the time: the struck car hardly turns once around before.
                struck_turn_rad: Some(STRUCK_TURN.high),
                longest_s: Some(values.get(Latent::PushDuration)),
                brake_share,
                ..PitDriver::default()
            };
            // The system belongs to the service brake, whose pedal he presses as the driver of the PIT.
            let released = Braking::new(0.0, 0.0, DEFAULT_BRAKE_RISE_S);
            let brake = abs.map(|abs| Braking { abs: Some(abs), ..released });
            return Ending { brake, damage, pit: Some(pit), ..Ending::default() };
        }
        let brake = brakes_from_s
            .zip(brake_share)
            .map(|(start_s, share)| Braking::new(start_s, share, DEFAULT_BRAKE_RISE_S))
            .map(|brake| Braking { abs, ..brake });
        Ending { brake, damage, ..Ending::default() }
    }
}

/// Time that wheels need to stop turning under a force that the road cannot hold, s:
///
/// ```text
/// t = 4 m_w v / (F_b − (1 − d/2) κ μ m g)        m_w = I_w/R²
/// ```
///
/// d: share of the friction that is lost while the wheel goes over from turning to sliding.
fn lock_delay_s(vehicle: &VehicleParameters, brake: &Braking, speed_m_s: f64) -> f64 {
    let tires = &vehicle.tires;
    let lost = 1.0 - tires.sliding_friction_ratio.min(1.0);
    let held = tires.longitudinal_friction_ratio * (1.0 - (lost / 2.0).max(0.05));
    let beyond = brake.share_of_friction - held;
    if beyond <= 0.0 {
        return 0.0;
    }
    let beyond_n = beyond * tires.friction * vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2;
    (4.0 * tires.wheel_mass_kg() * speed_m_s / beyond_n).min(LONGEST_LOCK_DELAY_S)
}

/// The impulse as a half-sine pulse at a point of a car.
///
/// - `at_m`: from the CG, in the axes of the car.
pub(super) fn contact_load(
    impulse_n_s: [f64; 2],
    values: &LatentValues,
    at_m: [f64; 2],
) -> ContactLoad {
    let duration_s = values.get(Latent::PulseDuration);
    let history = Pulse::new(PulseShape::HalfSine, impulse_n_s, 0.0, duration_s)
        .and_then(|pulse| pulse.to_history(duration_s / PULSE_SAMPLES));
    // Impulse and duration are finite; an empty history acts as none.
    let force = history.unwrap_or_else(|_| ForceHistory {
        axes: ForceAxes::World,
        sampling: Sampling::CentredMean,
        time_s: Vec::new(),
        fx_n: Vec::new(),
        fy_n: Vec::new(),
        mz_n_m: None,
    });
    let [x_body_m, y_body_m] = at_m;
    let contact = ContactPoint { x_body_m, y_body_m, height_m: CONTACT_HEIGHT_M };
    ContactLoad { force, contact, recorded_moment: false }
}
