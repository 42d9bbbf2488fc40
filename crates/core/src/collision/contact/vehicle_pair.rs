//! Two vehicles that may touch each other, and what their motions come to.

use crate::collision::contact::{
    ContactBody, ContactConditions, ContactOutline, ContactPhase, FaceLawError, FaceLaws, HandOver,
    PairError,
};
use crate::vehicle::{Manoeuvre, Motion, VehicleParameters};

/// One of two vehicles that may touch each other.
#[derive(Debug, Clone, Copy)]
pub struct PairVehicle<'a> {
    /// The vehicle.
    pub vehicle: &'a VehicleParameters,
    /// Its initial state, controls, ground and end. The collision force of the struck vehicle, if it has
    /// one, is that of the first contact and drives both; the striking vehicle has none of its own.
    pub manoeuvre: &'a Manoeuvre,
    /// Outline and face laws.
    pub body: ContactBody<'a>,
}

/// Two vehicles that may touch each other.
#[derive(Debug, Clone, Copy)]
pub struct VehiclePair<'a> {
    /// The struck and the striking vehicle.
    pub vehicles: [PairVehicle<'a>; 2],
    /// Friction, damping and height of their contact.
    pub conditions: ContactConditions,
    /// How they are followed.
    pub settings: CoupledSettings,
}

/// How two vehicles that may touch each other are followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoupledSettings {
    /// Into how many parts the steps are divided: 1, or more to see what they change.
    pub step_divisor: usize,
    /// Whether steps in contact may be longer where the contact is slow enough: for thousands of motions of
    /// which none is told by itself.
    pub has_long_steps: bool,
    /// Whether a motion that ends at rest goes on until both are at rest, although the striking vehicle
    /// moves away from the struck one.
    pub until_both_rest: bool,
    /// Whether the collision force of the struck vehicle is the whole of the first contact, with what the
    /// faces give back, as an impulse with a coefficient of restitution is. The faces then carry no load at
    /// its end, and push only where they are pressed in again.
    pub first_force_is_whole: bool,
}

impl Default for CoupledSettings {
    fn default() -> Self {
        Self {
            step_divisor: 1,
            has_long_steps: false,
            until_both_rest: false,
            first_force_is_whole: false,
        }
    }
}

/// Energy that the contact has taken from the vehicles, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactEnergy {
    /// Work of the planar motion of both vehicles against force and yaw moment,
    /// `−Σ∫(F·dx + M dψ)`. It contains no roll.
    pub absorbed_j: f64,
    /// Heat of friction between the outlines, `∫|T v_t| dt`.
    pub friction_heat_j: f64,
    /// Heat of crush and unloading: the work against the normal loads, `∫N v_n dt`, less what is stored.
    pub crush_heat_j: f64,
    /// Elastic energy that the faces still hold.
    pub stored_j: f64,
    /// Work of the face laws, see [`PairContact::law_work_j`](crate::collision::contact::PairContact::law_work_j).
    pub law_work_j: f64,
    /// Part of the absorbed energy that a known force of the first contact has taken.
    pub first_force_j: f64,
}

impl ContactEnergy {
    /// Absorbed energy that appears neither as heat nor as stored energy, J: what velocities change
    /// within the steps.
    pub fn residual_j(&self) -> f64 {
        let by_law_j = self.absorbed_j - self.first_force_j;
        by_law_j - self.friction_heat_j - self.crush_heat_j - self.stored_j
    }
}

/// The motions of two vehicles with all contacts between them.
#[derive(Debug, Clone, PartialEq)]
pub struct PairMotion {
    /// Of the struck and of the striking vehicle, over the same time.
    pub motions: [Motion; 2],
    /// Phases of contact in the order of time.
    pub phases: Vec<ContactPhase>,
    /// Energy of all contacts together.
    pub energy: ContactEnergy,
    /// How the contact law took over from a known force of the first contact; `None` without one, or if
    /// the motion ends before it.
    pub hand_over: Option<HandOver>,
    /// Depth of the dents that stay, of the elements of each outline, m.
    pub dents_m: [Vec<f64>; 2],
}

impl VehiclePair<'_> {
    pub(super) fn check(&self) -> Result<(), PairError> {
        let is_some = |value: f64| value.is_finite() && value >= 0.0;
        for (name, value) in [
            ("friction", self.conditions.friction),
            ("damping_s_m", self.conditions.damping_s_m),
            ("height_m", self.conditions.height_m),
        ] {
            if !is_some(value) {
                return Err(PairError::Range { name, value, expected: "0 or more" });
            }
        }
        if self.settings.step_divisor == 0 {
            let (name, expected) = ("step_divisor", "1 or more");
            return Err(PairError::Range { name, value: 0.0, expected });
        }
        if self.vehicles[1].manoeuvre.contact_load.is_some() {
            return Err(PairError::CollisionForce);
        }
        let [struck_s, striking_s] = self.vehicles.map(|it| it.manoeuvre.duration_s);
        match struck_s == striking_s {
            true => Ok(()),
            false => Err(PairError::Durations { struck_s, striking_s }),
        }
    }
}

impl<'a> PairVehicle<'a> {
    /// A vehicle with an outline and with the face laws of its class and mass.
    ///
    /// # Errors
    /// [`FaceLawError`] if the mass is not more than 0.
    pub fn by_class(
        vehicle: &'a VehicleParameters,
        manoeuvre: &'a Manoeuvre,
        outline: &'a ContactOutline,
    ) -> Result<Self, FaceLawError> {
        let faces = FaceLaws::by_class(vehicle)?;
        Ok(Self { vehicle, manoeuvre, body: ContactBody { outline, faces } })
    }
}
