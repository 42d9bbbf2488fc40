//! What is known of a car. Its mass is measured by itself, so that it is a part of the prior; its dimensions
//! go into the vehicle.

use impactlab_core::ranges::{
    CG_HEIGHT, CG_TO_AXLE, MASS_SIGMA, OUTER_LENGTH, OUTER_WIDTH, TRACK_WIDTH, VEHICLE_MASS,
    VEHICLE_YAW_INERTIA,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Latent;
use crate::evidence::{Field, Fields, Group, Item, Measured, Section, Sigma, Stated};
use crate::likelihood::Comparison;

/// Mass as a share of it: kerb mass of the type with an estimate of the load. Assumed.
pub const DEFAULT_MASS_SHARE: f64 = 0.03;

/// The struck car in a file, a form and a report.
pub const STRUCK: Section = Section {
    key: "struck_car",
    title: "struck car",
    group: Group::Cars,
    is_required: true,
    missing: "",
};
/// The striking car, likewise.
pub const STRIKING: Section = Section { key: "striking_car", title: "striking car", ..STRUCK };
/// A single car, likewise.
pub const SINGLE: Section = Section { key: "car", title: "car", ..STRUCK };

const MASS: Field = Field::new("mass", "mass", VEHICLE_MASS);
const SIGMA: Sigma = Sigma::share(
    "mass_sigma",
    "±",
    MASS_SIGMA,
    [DEFAULT_MASS_SHARE, 0.0],
    "kerb mass of the type with an estimate of the load",
);
const CG_TO_FRONT_AXLE: Field = Field::new("cg_to_front_axle", "CG to front axle", CG_TO_AXLE);
const CG_TO_REAR_AXLE: Field = Field::new("cg_to_rear_axle", "CG to rear axle", CG_TO_AXLE);
const TRACK: Field = Field::new("track", "track width", TRACK_WIDTH);
const HEIGHT: Field = Field::new("cg_height", "height of the CG", CG_HEIGHT);
const LENGTH: Field = Field::new("length", "outer length", OUTER_LENGTH);
const WIDTH: Field = Field::new("width", "outer width", OUTER_WIDTH);
const YAW_INERTIA: Field = Field::new("yaw_inertia", "yaw inertia", VEHICLE_YAW_INERTIA);

/// What is known of a car.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CarEvidence {
    /// Mass, kg.
    pub mass_kg: Option<Stated>,
    /// Distance from the CG to the front axle, m; known together with that to the rear axle.
    pub cg_to_front_axle_m: Option<f64>,
    /// Distance from the CG to the rear axle, m.
    pub cg_to_rear_axle_m: Option<f64>,
    /// Track width, m.
    pub track_m: Option<f64>,
    /// Height of the CG, m.
    pub cg_height_m: Option<f64>,
    /// Outer length, m.
    pub length_m: Option<f64>,
    /// Outer width, m.
    pub width_m: Option<f64>,
    /// Yaw moment of inertia, kg m².
    pub yaw_inertia_kg_m2: Option<f64>,
}

impl Item for CarEvidence {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self {
            mass_kg,
            cg_to_front_axle_m: front_m,
            cg_to_rear_axle_m: rear_m,
            track_m,
            cg_height_m,
            length_m,
            width_m,
            yaw_inertia_kg_m2,
        } = self;
        visitor.measured(&MASS, &SIGMA, mass_kg);
        let front = CG_TO_FRONT_AXLE.required_if(rear_m.is_some());
        let rear = CG_TO_REAR_AXLE.required_if(front_m.is_some());
        visitor.number(&front, front_m);
        visitor.number(&rear, rear_m);
        visitor.number(&TRACK, track_m);
        visitor.number(&HEIGHT, cg_height_m);
        visitor.number(&LENGTH, length_m);
        visitor.number(&WIDTH, width_m);
        visitor.number(&YAW_INERTIA, yaw_inertia_kg_m2);
    }
}

impl CarEvidence {
    /// Mass, kg.
    pub fn mass(&self) -> Option<Measured> {
        SIGMA.resolve(self.mass_kg)
    }

    pub(super) fn compare_struck(&self, comparison: &mut Comparison<'_>) {
        let expected = comparison.value(Latent::StruckMass);
        comparison.tell_measured("mass of the struck car", "kg", self.mass(), expected);
    }

    pub(super) fn compare_striking(&self, comparison: &mut Comparison<'_>) {
        let expected = comparison.value(Latent::StrikingMass);
        comparison.tell_measured("mass of the striking car", "kg", self.mass(), expected);
    }
}
