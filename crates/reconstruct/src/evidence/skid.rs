//! A skid of a car that ended at the first contact. Its length is measured by itself, so that it is a part of
//! the prior; the speed before the skid follows (`skid.rs` of the forward model).

use impactlab_core::ranges::{POSITION_SIGMA, ROAD_FRICTION, ROAD_GRADE, SKID_LENGTH};
use impactlab_core::vehicle::Wheel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::road::DRAG_FACTOR_SIGMA;
use crate::evidence::{Choice, Field, Fields, Group, Item, Measured, Section, Sigma, Stated};

/// The skid of the struck car in a file, a form and a report.
pub const STRUCK: Section = Section {
    key: "skid_before",
    title: "skid before the impact",
    group: Group::Scene,
    is_required: false,
    missing: "",
};
/// That of the striking car, likewise.
pub const STRIKING: Section = Section {
    key: "striking_skid_before",
    title: "skid of the striking car before the impact",
    ..STRUCK
};

const LENGTH: Field =
    Field::new("length", "length of the skid to first contact", SKID_LENGTH).required();
const LENGTH_SIGMA: Sigma = Sigma::share(
    "length_sigma",
    "±",
    POSITION_SIGMA,
    [0.03, 0.3],
    "the start of a skid mark is faint; assumed",
);
const LOCKED_WHEELS: Choice = Choice {
    key: "locked_wheels",
    label: "wheels that were locked",
    is_required: false,
    none: "all four",
};
const DRAG_FACTOR: Field = Field::new("drag_factor", "drag factor of the skid", ROAD_FRICTION)
    .with_default("by the friction of the road and the locked wheels");
const GRADE: Field = Field::new("grade", "grade along the skid, uphill", ROAD_GRADE)
    .with_default("that of the road");

/// A skid of a car that ended at the first contact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SkidBefore {
    /// Distance over which the car skidded, m; `None` until it is entered.
    pub length_m: Option<Stated>,
    /// Wheels that were locked, while the others rolled; all four where none is named.
    pub locked_wheels: Option<Vec<Wheel>>,
    /// Deceleration on a level road over that of gravity, where it is known of this skid; otherwise it
    /// follows from the friction of the road and the locked wheels.
    pub drag_factor: Option<Stated>,
    /// Grade in the direction of the skid, positive uphill; `None` for that of the road.
    pub grade: Option<f64>,
}

impl Item for SkidBefore {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { length_m, locked_wheels, drag_factor, grade } = self;
        visitor.measured(&LENGTH, &LENGTH_SIGMA, length_m);
        visitor.choices(&LOCKED_WHEELS, locked_wheels);
        visitor.measured(&DRAG_FACTOR, &DRAG_FACTOR_SIGMA, drag_factor);
        visitor.number(&GRADE, grade);
    }
}

impl SkidBefore {
    /// Distance over which the car skidded, m; `None` until it is entered.
    pub fn length(&self) -> Option<Measured> {
        LENGTH_SIGMA.resolve(self.length_m)
    }

    /// Drag factor of this skid, where it is known.
    pub fn drag_factor(&self) -> Option<Measured> {
        DRAG_FACTOR_SIGMA.resolve(self.drag_factor)
    }

    /// Share of the wheels of the front and of the rear axle that were locked.
    pub fn locked_shares(&self) -> [f64; 2] {
        let named = self.locked_wheels.as_deref().filter(|locked| !locked.is_empty());
        let Some(locked) = named else { return [1.0; 2] };
        [true, false].map(|is_front| {
            let of_axle = |wheel: &&Wheel| wheel.is_front() == is_front && locked.contains(wheel);
            Wheel::ALL.iter().filter(of_axle).count() as f64 / 2.0
        })
    }
}
