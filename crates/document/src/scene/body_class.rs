//! The kind of body of a car, which decides how its picture is built.

use serde::{Deserialize, Serialize};

use impactlab_core::vehicle::{VehicleClass, VehicleParameters};

/// Length from which a passenger car is taken for a saloon and not for a hatchback, m: the gap between
/// the compact and the middle class.
const SALOON_LENGTH_M: f64 = 4.45;
/// Height of the CG from which a vehicle of unknown class is taken for a sport utility vehicle, and for
/// a van, m. The rules of estimation give 0.56 m for cars and 0.68 m for sport utility vehicles.
const SUV_CG_HEIGHT_M: f64 = 0.63;
const VAN_CG_HEIGHT_M: f64 = 0.78;
/// Length from which a tall vehicle of unknown class is taken for a pickup truck, m.
const PICKUP_LENGTH_M: f64 = 5.3;
/// Height of the CG over that of the roof, about the same for cars and for light trucks.
const CG_OVER_ROOF: f64 = 0.385;

/// The kind of body of a car in a picture. No simulation depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum BodyClass {
    /// Two boxes, with a steep tail.
    #[strum(to_string = "hatchback")]
    Hatch,
    /// Three boxes, with a boot.
    Saloon,
    /// A long roof down to the tail.
    Estate,
    /// Sport utility vehicle: tall, with a long roof.
    #[strum(to_string = "sport utility vehicle")]
    Suv,
    /// One box with a short bonnet.
    Van,
    /// A cab and an open bed.
    Pickup,
}

impl BodyClass {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::Hatch, Self::Saloon, Self::Estate, Self::Suv, Self::Van, Self::Pickup];

    /// What the kind is called.
    pub fn label(self) -> &'static str {
        self.into()
    }

    /// The kind by the class of the data sheet. A passenger car is an estate or a hatchback if its name
    /// says so, and else a saloon from 4.45 m of length on. Where nobody said the class, height of the CG
    /// and length decide.
    pub fn from_vehicle(vehicle: &VehicleParameters) -> Self {
        let class = vehicle.sheet.as_ref().map_or(VehicleClass::Any, |sheet| sheet.class);
        let (length_m, cg_height_m) =
            (vehicle.geometry.outer_length_m, vehicle.geometry.cg_height_m);
        let name = vehicle.name.to_lowercase();
        let says = |words: &[&str]| words.iter().any(|word| name.contains(word));
        match class {
            VehicleClass::Suv => Self::Suv,
            VehicleClass::Pickup => Self::Pickup,
            VehicleClass::Van => Self::Van,
            VehicleClass::Any if cg_height_m >= SUV_CG_HEIGHT_M && length_m >= PICKUP_LENGTH_M => {
                Self::Pickup
            }
            VehicleClass::Any if cg_height_m >= VAN_CG_HEIGHT_M => Self::Van,
            VehicleClass::Any if cg_height_m >= SUV_CG_HEIGHT_M => Self::Suv,
            VehicleClass::Any | VehicleClass::Car => {
                if says(&["estate", "wagon"]) {
                    Self::Estate
                } else if says(&["hatch"]) || length_m < SALOON_LENGTH_M {
                    Self::Hatch
                } else {
                    Self::Saloon
                }
            }
        }
    }

    /// Height of the roof, which no data sheet states: from the height of the CG, within what bodies of
    /// the kind have, m.
    pub fn roof_height_m(self, cg_height_m: f64) -> f64 {
        let [low, high] = match self {
            Self::Hatch => [1.40, 1.58],
            Self::Saloon => [1.38, 1.52],
            Self::Estate => [1.40, 1.56],
            Self::Suv => [1.58, 1.85],
            Self::Van => [1.70, 2.10],
            Self::Pickup => [1.70, 1.95],
        };
        let height_m = cg_height_m / CG_OVER_ROOF;
        if height_m.is_finite() { height_m.clamp(low, high) } else { low }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use impactlab_core::vehicle::{DataSheet, Preset, SheetQuantity};

    #[test]
    fn the_class_of_the_sheet_decides_and_else_the_size() {
        let body_class = |class, name: &str, length_m, cg_height_m| {
            let sheet = DataSheet::new(name, class)
                .with(SheetQuantity::Length, length_m)
                .with(SheetQuantity::CgHeight, cg_height_m);
            BodyClass::from_vehicle(&sheet.vehicle())
        };
        for (class, name, length_m, cg_height_m, expected) in [
            (VehicleClass::Suv, "a", 4.2, 0.5, BodyClass::Suv),
            (VehicleClass::Pickup, "a", 5.0, 0.5, BodyClass::Pickup),
            (VehicleClass::Van, "a", 4.0, 0.5, BodyClass::Van),
            (VehicleClass::Car, "a", 4.2, 0.7, BodyClass::Hatch),
            (VehicleClass::Car, "a", 4.7, 0.7, BodyClass::Saloon),
            (VehicleClass::Car, "Station Wagon", 4.7, 0.55, BodyClass::Estate),
            (VehicleClass::Any, "a", 4.7, 0.55, BodyClass::Saloon),
            (VehicleClass::Any, "a", 4.7, 0.68, BodyClass::Suv),
            (VehicleClass::Any, "a", 5.6, 0.70, BodyClass::Pickup),
            (VehicleClass::Any, "a", 4.9, 0.85, BodyClass::Van),
        ] {
            assert_eq!(
                body_class(class, name, length_m, cg_height_m),
                expected,
                "{class:?} {name}"
            );
        }
        let mut vehicle = Preset::Reference.parameters();
        vehicle.sheet = Some(Arc::new(DataSheet::new("x", VehicleClass::Van)));
        assert_eq!(BodyClass::from_vehicle(&vehicle), BodyClass::Van);
    }

    #[test]
    fn the_roof_is_as_high_as_bodies_of_the_kind_have_it() {
        for class in BodyClass::ALL {
            for cg_height_m in [f64::NAN, 0.0, 0.55, 0.7, 9.0] {
                let roof_m = class.roof_height_m(cg_height_m);
                assert!((1.3..2.2).contains(&roof_m), "{class:?} {cg_height_m}: {roof_m}");
            }
        }
        assert!(BodyClass::Saloon.roof_height_m(0.55) < BodyClass::Saloon.roof_height_m(0.57));
    }
}
