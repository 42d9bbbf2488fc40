//! Objects that a vehicle strikes and that do not move: a wall, a pole.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::vehicle::{Preset, VehicleParameters};

/// Mass that stands for that of an object which does not move, kg.
pub const FIXED_MASS_KG: f64 = 1e8;

/// The same of its yaw inertia, kg m².
pub const FIXED_YAW_INERTIA_KG_M2: f64 = 1e10;

/// An object that does not move and is not crushed.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::IntoStaticStr,
    strum::VariantArray,
    strum::VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum FixedObject {
    /// A wall or a barrier: a rectangle whose length is along its heading.
    Wall,
    /// A pole or a tree: a circle.
    Pole,
}

impl FixedObject {
    /// All of them.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Their words in a file, in the order of [`FixedObject::ALL`].
    pub const WORDS: &'static [&'static str] = <Self as strum::VariantNames>::VARIANTS;

    /// Its word in a file, and what it is called.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Its parameters as those of a body that takes part in a collision. It has no size yet, stands on level
    /// ground, and is as much stiffer than a car as it is heavier.
    pub fn body(self) -> VehicleParameters {
        let mut body = Preset::Reference
            .parameters()
            .scaled_to_mass(FIXED_MASS_KG, Some(FIXED_YAW_INERTIA_KG_M2));
        body.name = self.word().to_owned();
        body.source = "fixed object: does not move and is not crushed".to_owned();
        body.estimates.clear();
        body.fixed = Some(self);
        body
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fixed_object_is_a_body_that_can_be_followed() {
        for object in FixedObject::ALL {
            let body = object.body();
            assert_eq!((body.fixed, body.mass.mass_kg), (Some(*object), FIXED_MASS_KG));
            assert_eq!(body.check_relations(), Ok(()), "{object:?}");
        }
        assert_eq!(FixedObject::WORDS, ["wall", "pole"]);
    }
}
