//! The quantities of a data sheet, in the order in which one follows from those before it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ranges::{
    CG_HEIGHT, CORNERING_COEFFICIENT, DRAG_AREA, FRONT_LOAD_SHARE, FRONT_OVERHANG,
    FRONT_ROLL_SHARE, OUTER_LENGTH, OUTER_WIDTH, ROAD_FRICTION, ROLL_AXIS_HEIGHT,
    ROLL_DAMPING_RATIO, ROLL_GRADIENT, ROLL_INERTIA, ROLL_YAW_PRODUCT, ROLLING_RESISTANCE, Range,
    SLIDING_FRICTION_RATIO, SPRUNG_MASS, TRACK_WIDTH, VEHICLE_MASS, VEHICLE_YAW_INERTIA,
    WHEEL_INERTIA, WHEEL_RADIUS, WHEELBASE,
};

/// What kind of vehicle it is, as far as the rules of estimation tell kinds apart.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VehicleClass {
    /// Nobody said; the scatter of the rules then covers all of the others.
    #[default]
    Any,
    /// Passenger car: saloon, hatchback, estate, coupé.
    Car,
    /// Sport utility vehicle, off-road vehicle, crossover.
    Suv,
    /// Pickup truck.
    Pickup,
    /// Minivan or van.
    Van,
}

impl VehicleClass {
    /// Every class, from the smallest car to the commercial vehicles.
    pub const ALL: [Self; 5] = [Self::Any, Self::Car, Self::Suv, Self::Pickup, Self::Van];
    /// The words in a vehicle file, in the order of [`VehicleClass::ALL`].
    pub const WORDS: [&'static str; 5] = ["any", "car", "suv", "pickup", "van"];

    /// The value of this class among one for each of [`VehicleClass::ALL`].
    pub(super) const fn pick<T: Copy>(self, of_classes: [T; 5]) -> T {
        of_classes[self as usize]
    }

    /// The word of a vehicle file.
    pub const fn word(self) -> &'static str {
        self.pick(Self::WORDS)
    }
}

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $key:literal, $unit:literal, $label:literal, $range:expr, [$($parameter:literal),*];)+) => {
        /// A quantity of a data sheet. Each may be known; what is not known is estimated from
        /// quantities that stand before it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum SheetQuantity {
            $($(#[$doc])* $name,)+
        }

        impl SheetQuantity {
            /// Every quantity, in the order in which one follows from those before it.
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// Key in a vehicle file, without the unit that may be chosen.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$name => $key),+ }
            }

            /// Symbol of the SI unit; empty for a pure number.
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$name => $unit),+ }
            }

            /// For a person.
            pub const fn label(self) -> &'static str {
                match self { $(Self::$name => $label),+ }
            }

            /// The values that it may have.
            pub const fn range(self) -> Range {
                match self { $(Self::$name => $range),+ }
            }

            /// The parameters of the 4DOF vehicle that it decides, by their keys in a full file.
            pub(super) const fn parameters(self) -> &'static [&'static str] {
                match self { $(Self::$name => &[$($parameter),*]),+ }
            }
        }
    };
}

quantities! {
    /// Outer length of the body, m.
    Length: "length", "m", "outer length", OUTER_LENGTH, ["geometry.outer_length_m"];
    /// Outer width of the body without mirrors, m.
    Width: "width", "m", "outer width", OUTER_WIDTH, ["geometry.outer_width_m"];
    /// Mass with all on board, kg.
    Mass: "mass", "kg", "mass", VEHICLE_MASS, ["mass.mass_kg"];
    /// Distance between the axles, m.
    Wheelbase: "wheelbase", "m", "wheelbase", WHEELBASE, [];
    /// Mean distance between the wheels of an axle, m.
    Track: "track", "m", "track width", TRACK_WIDTH, ["geometry.track_width_m"];
    /// Distance from the front axle to the front end of the body, m.
    FrontOverhang: "front_overhang", "m", "front overhang", FRONT_OVERHANG,
        ["geometry.cg_to_front_end_m"];
    /// Share of the front axle in the weight.
    FrontShare: "front_share", "", "share of the front axle in the weight", FRONT_LOAD_SHARE,
        ["geometry.cg_to_front_axle_m", "geometry.cg_to_rear_axle_m"];
    /// Height of the CG of the whole vehicle above the ground, m.
    CgHeight: "cg_height", "m", "height of the CG", CG_HEIGHT, ["geometry.cg_height_m"];
    /// Yaw moment of inertia about the CG, kg m².
    YawInertia: "yaw_inertia", "kg m²", "yaw inertia", VEHICLE_YAW_INERTIA,
        ["mass.yaw_inertia_kg_m2"];
    /// Roll moment of inertia of the whole vehicle about its CG, kg m².
    RollInertia: "roll_inertia", "kg m²", "roll inertia about the CG", ROLL_INERTIA,
        ["mass.roll_inertia_kg_m2"];
    /// Roll–yaw product of inertia, `∫ x z dm` in axes x forward, z up, kg m².
    RollYawProduct: "roll_yaw_product", "kg m²", "roll–yaw product of inertia", ROLL_YAW_PRODUCT,
        ["mass.roll_yaw_product_kg_m2"];
    /// Sprung mass, kg.
    SprungMass: "sprung_mass", "kg", "sprung mass", SPRUNG_MASS, ["mass.sprung_mass_kg"];
    /// Rolling radius of the wheels, m: height of the CG of the unsprung mass.
    WheelRadius: "wheel_radius", "m", "wheel radius", WHEEL_RADIUS, [];
    /// Moment of inertia of a wheel with its tire about its axis, kg m².
    WheelInertia: "wheel_inertia_kg_m2", "kg m²", "inertia of a wheel", WHEEL_INERTIA,
        ["tires.wheel_inertia_kg_m2"];
    /// Height of the roll axis above the ground at the CG, m.
    RollAxisHeight: "roll_axis_height", "m", "height of the roll axis", ROLL_AXIS_HEIGHT,
        ["suspension.roll_axis_height_m", "suspension.roll_arm_m"];
    /// Steady roll angle over lateral acceleration, deg/g.
    RollGradient: "roll_gradient_deg_per_g", "deg/g", "roll gradient", ROLL_GRADIENT,
        ["suspension.roll_stiffness_n_m_rad"];
    /// Damping ratio of the roll motion.
    RollDampingRatio: "roll_damping_ratio", "", "damping ratio of the roll", ROLL_DAMPING_RATIO,
        ["suspension.roll_damping_n_m_s_rad"];
    /// Share of the front axle in the roll stiffness.
    FrontRollShare: "front_roll_stiffness_share", "", "share of the front axle in the roll stiffness",
        FRONT_ROLL_SHARE, ["suspension.front_roll_stiffness_share"];
    /// Cornering coefficient of the rear axle, 1/rad: side force over slip angle over load.
    RearCornering: "cornering_coefficient_rear_per_rad", "1/rad", "cornering coefficient, rear",
        CORNERING_COEFFICIENT, ["tires.cornering_coefficient_rear_per_rad"];
    /// Cornering coefficient of the front axle, 1/rad, steering compliance included.
    FrontCornering: "cornering_coefficient_front_per_rad", "1/rad", "cornering coefficient, front",
        CORNERING_COEFFICIENT, ["tires.cornering_coefficient_front_per_rad"];
    /// Peak friction of the road.
    Friction: "friction", "", "peak friction of the road", ROAD_FRICTION, ["tires.friction"];
    /// Sliding friction over peak friction.
    SlidingRatio: "sliding_friction_ratio", "", "sliding over peak friction",
        SLIDING_FRICTION_RATIO, ["tires.sliding_friction_ratio"];
    /// Rolling resistance over vertical load.
    RollingResistance: "rolling_resistance", "", "rolling resistance", ROLLING_RESISTANCE,
        ["tires.rolling_resistance"];
    /// Drag coefficient times frontal area, m².
    DragArea: "drag_area_m2", "m²", "drag area", DRAG_AREA, ["tires.rolling_resistance_s2_m2"];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::DrivenAxle;

    #[test]
    fn the_words_stand_in_the_order_of_the_classes() {
        for (class, word) in VehicleClass::ALL.into_iter().zip(VehicleClass::WORDS) {
            assert_eq!(class.word(), word);
            assert_eq!(serde_json::to_string(&class).unwrap(), format!("\"{word}\""));
        }
        for (axle, word) in DrivenAxle::ALL.iter().zip(DrivenAxle::WORDS) {
            assert_eq!(axle.word(), *word);
            assert_eq!(serde_json::to_string(axle).unwrap(), format!("\"{word}\""));
        }
    }
}
