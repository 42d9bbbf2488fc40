//! The two vehicles of a scenario as the contact law sees them, and their motion through all contacts.

use crate::analysis::{AnalysisError, Settings, StruckVehicle};
use impactlab_core::collision::contact::{
    ContactBody, ContactConditions, ContactOutline, CoupledSettings, FaceLaws, PairError,
    PairMotion, PairVehicle, USUAL_ELEMENT_M, VehiclePair, way_to_touch_m,
};
use impactlab_core::collision::{Footprint, FootprintError, Pose};
use impactlab_core::data::ForceHistory;
use impactlab_core::vehicle::{ContactLoad, FixedObject, Manoeuvre};

/// Longest way of the striking vehicle that closes the gap between rounded outlines, m.
const LONGEST_WAY_M: f64 = 1.0;

/// Radius of the edges of a wall over its thickness.
const WALL_CORNER_SHARE: f64 = 0.1;

/// The same of a pole, whose outline is all corners.
const POLE_CORNER_SHARE: f64 = 0.499;

/// Elements along a wall at the most.
const MOST_WALL_ELEMENTS: f64 = 400.0;

/// Outlines, faces and contact of two vehicles; arrays are struck, striking.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPair {
    /// Their outlines, with rounded corners.
    pub outlines: [ContactOutline; 2],
    /// Laws of their faces at their medians.
    pub faces: [FaceLaws; 2],
    /// Friction, damping and height of their contact at their medians.
    pub conditions: ContactConditions,
}

impl ContactPair {
    /// Two vehicles with the face laws of their class and mass, touching each other at the height of
    /// their contact.
    ///
    /// # Errors
    /// [`AnalysisError::Outline`] or [`AnalysisError::Faces`] for dimensions or a mass out of range.
    pub fn new([struck, striking]: [&StruckVehicle; 2]) -> Result<Self, AnalysisError> {
        let outline = |it: &StruckVehicle| match it.vehicle.fixed {
            Some(object) => outline_of(object, Footprint::from(&it.vehicle.geometry)),
            None => ContactOutline::from_vehicle(&it.vehicle),
        };
        let faces = |it: &StruckVehicle| FaceLaws::by_class(&it.vehicle);
        let height_m = struck.contact.height_m;
        Ok(Self {
            outlines: [outline(struck)?, outline(striking)?],
            faces: [faces(struck)?, faces(striking)?],
            conditions: ContactConditions { height_m, ..ContactConditions::default() },
        })
    }

    /// Moves the striking vehicle until the rounded outlines touch: a scenario places rectangles, which
    /// touch earlier. Where the rounded outlines pass each other, it stays.
    ///
    /// - `normal_world_rad`: angle of the contact normal, which points into the struck vehicle.
    pub fn close_gap(
        &self,
        struck: &StruckVehicle,
        striking: &mut StruckVehicle,
        normal_world_rad: f64,
    ) {
        let pose = |it: &StruckVehicle| Pose::from_state(&it.initial);
        let (poses, outlines) =
            ([&pose(struck), &pose(striking)], [0, 1].map(|i| &self.outlines[i]));
        let way_m = way_to_touch_m(outlines, poses, normal_world_rad, LONGEST_WAY_M);
        let (sin, cos) = normal_world_rad.sin_cos();
        let way_m = way_m.unwrap_or(0.0);
        striking.initial.x_m += way_m * cos;
        striking.initial.y_m += way_m * sin;
    }

    /// Follows both vehicles.
    ///
    /// - `first_force`: force on the struck vehicle of the first contact; the contact law from the start
    ///   on without it.
    ///
    /// # Errors
    /// [`PairError`] if a motion cannot be computed.
    pub fn simulate(
        &self,
        starts: [&StruckVehicle; 2],
        first_force: Option<&ForceHistory>,
        settings: &Settings,
    ) -> Result<PairMotion, PairError> {
        let (duration_s, ends_at_rest) = (settings.duration_s, settings.ends_at_rest);
        let manoeuvres = manoeuvres(starts, first_force, duration_s, ends_at_rest);
        let vehicle = |i: usize| PairVehicle {
            vehicle: &starts[i].vehicle,
            manoeuvre: &manoeuvres[i],
            body: ContactBody { outline: &self.outlines[i], faces: self.faces[i] },
        };
        let vehicles = [vehicle(0), vehicle(1)];
        VehiclePair { vehicles, conditions: self.conditions, settings: CoupledSettings::default() }
            .simulate()
    }
}

/// Outline of an object that does not move.
///
/// # Errors
/// [`FootprintError::Range`] if its dimensions are out of range.
fn outline_of(object: FixedObject, footprint: Footprint) -> Result<ContactOutline, FootprintError> {
    let shorter_m = footprint.length_m.min(footprint.width_m);
    let (corner_share, element_m) = match object {
        FixedObject::Wall => {
            (WALL_CORNER_SHARE, USUAL_ELEMENT_M.max(footprint.length_m / MOST_WALL_ELEMENTS))
        }
        FixedObject::Pole => (POLE_CORNER_SHARE, USUAL_ELEMENT_M / 2.0),
    };
    ContactOutline::new(footprint, corner_share * shorter_m, element_m)
}

/// What both vehicles do, with the force of the first contact on the struck one.
pub(super) fn manoeuvres(
    [struck, striking]: [&StruckVehicle; 2],
    first_force: Option<&ForceHistory>,
    duration_s: f64,
    ends_at_rest: bool,
) -> [Manoeuvre; 2] {
    let manoeuvre = |start: &StruckVehicle, contact_load| Manoeuvre {
        initial: start.initial,
        contact_load,
        controls: start.controls.clone(),
        duration_s,
        ends_at_rest,
        friction_zones: start.friction_zones.clone(),
    };
    let load = first_force.map(|force| struck.load(force));
    [manoeuvre(struck, load), manoeuvre(striking, None)]
}

impl StruckVehicle {
    /// A force where it acts on the vehicle.
    pub(super) fn load(&self, force: &ForceHistory) -> ContactLoad {
        ContactLoad {
            force: force.clone(),
            contact: self.contact,
            recorded_moment: force.mz_n_m.is_some(),
        }
    }
}
