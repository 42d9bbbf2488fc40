//! From the quantities of a data sheet to the parameters of the 4DOF vehicle.
//!
//! ```text
//! h_s = (m h_cog − m_u r_wheel)/m_s        height of the CG of the sprung mass
//! h   = h_s − h_roll axis                  roll arm
//! I   = I_xx + m_s h²                      roll inertia about the roll axis (parallel axes)
//! K_φ = m_s g h (1/roll gradient + 1)      meets the gradient
//! B   = 2 ζ √((K_φ − m_s g h) I)
//! f_2 = ρ C_d A/(2 m g)                    air drag as rolling resistance per speed²
//! ```
//!
//! The same rules derive the reference car from the data sheet of its multibody model
//! ([`MultibodyRecord`](crate::vehicle::MultibodyRecord)).

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::sheet::{DataSheet, SheetQuantity as Q};
use crate::vehicle::tire::{SAME_IN_ALL_DIRECTIONS, TireParameters};
use crate::vehicle::{
    GeometryParameters, MassParameters, RoadSlope, SuspensionParameters, VehicleParameters,
};

use super::data_sheet::SheetValues;

/// Air density at 15 °C and sea level, kg/m³ (ISO 2533 standard atmosphere).
pub(in crate::vehicle) const AIR_DENSITY_KG_M3: f64 = 1.225;

/// Largest |I_xz| over the root of both moments in a derived vehicle.
const MAX_COUPLING: f64 = 0.5;

/// Smallest roll arm of a vehicle whose roll axis is estimated, m.
const MIN_ROLL_ARM_M: f64 = 0.02;

impl DataSheet {
    /// The parameters at the latent factors of the sheet, whether or not they go together.
    pub(super) fn derive(&self) -> VehicleParameters {
        let values = self.resolve(|_, _| {});
        let get = |quantity| values.get(quantity);
        let mass_kg = get(Q::Mass);
        let [front_m, rear_m] = values.axle_distances_m();
        let (mass, suspension) = self.sprung(&values);
        let drag = 0.5 * AIR_DENSITY_KG_M3 * get(Q::DragArea) / (mass_kg * STANDARD_GRAVITY_M_S2);
        VehicleParameters {
            name: self.name.clone(),
            source: self.source.clone(),
            equations: self.equations,
            mass,
            geometry: GeometryParameters {
                cg_to_front_axle_m: front_m,
                cg_to_rear_axle_m: rear_m,
                track_width_m: get(Q::Track),
                cg_height_m: get(Q::CgHeight),
                outer_length_m: get(Q::Length),
                outer_width_m: get(Q::Width),
                cg_to_front_end_m: (front_m + get(Q::FrontOverhang)).min(get(Q::Length)),
            },
            suspension,
            tires: TireParameters {
                cornering_coefficient_front_per_rad: get(Q::FrontCornering),
                cornering_coefficient_rear_per_rad: get(Q::RearCornering),
                friction: get(Q::Friction),
                sliding_friction_ratio: get(Q::SlidingRatio),
                rolling_resistance: get(Q::RollingResistance),
                rolling_resistance_s_m: 0.0,
                rolling_resistance_s2_m2: drag,
                rolling_radius_m: get(Q::WheelRadius),
                wheel_inertia_kg_m2: get(Q::WheelInertia),
                longitudinal_friction_ratio: SAME_IN_ALL_DIRECTIONS,
            },
            crush: self.crush,
            estimates: self.rules(),
            stated: BTreeMap::new(),
            sheet: None,
            slope: RoadSlope::default(),
            fixed: None,
        }
    }

    /// Masses, and the motion of the sprung mass on its suspension.
    fn sprung(&self, values: &SheetValues<'_>) -> (MassParameters, SuspensionParameters) {
        let get = |quantity| values.get(quantity);
        let mass_kg = get(Q::Mass);
        let sprung_kg = get(Q::SprungMass);
        let unsprung_moment = (mass_kg - sprung_kg) * get(Q::WheelRadius);
        let sprung_height_m = (mass_kg * get(Q::CgHeight) - unsprung_moment) / sprung_kg;
        let axis_m = match self.known(Q::RollAxisHeight) {
            Some(height_m) => height_m,
            None => get(Q::RollAxisHeight).min(sprung_height_m - MIN_ROLL_ARM_M),
        };
        let arm_m = sprung_height_m - axis_m;
        let roll_inertia = get(Q::RollInertia) + sprung_kg * arm_m * arm_m;
        let coupling = MAX_COUPLING * (get(Q::YawInertia) * roll_inertia).sqrt();
        let product = match self.known(Q::RollYawProduct) {
            Some(product) => product,
            None => get(Q::RollYawProduct).clamp(-coupling, coupling),
        };
        let weight_arm = sprung_kg * STANDARD_GRAVITY_M_S2 * arm_m;
        let by_gradient = weight_arm * (1.0 / get(Q::RollGradient).to_radians() + 1.0);
        let stiffness = self.roll_stiffness_n_m_rad.unwrap_or(by_gradient);
        let critical = 2.0 * ((stiffness - weight_arm).max(0.0) * roll_inertia).sqrt();
        let damping = self.roll_damping_n_m_s_rad.unwrap_or(get(Q::RollDampingRatio) * critical);
        let mass = MassParameters {
            mass_kg,
            sprung_mass_kg: sprung_kg,
            yaw_inertia_kg_m2: get(Q::YawInertia),
            roll_inertia_kg_m2: roll_inertia,
            roll_yaw_product_kg_m2: product,
        };
        let suspension = SuspensionParameters {
            roll_axis_height_m: axis_m,
            roll_arm_m: arm_m,
            roll_stiffness_n_m_rad: stiffness,
            roll_damping_n_m_s_rad: damping,
            front_roll_stiffness_share: get(Q::FrontRollShare),
        };
        (mass, suspension)
    }

    /// The rule of each parameter that is estimated, by its key in a full vehicle file.
    fn rules(&self) -> BTreeMap<String, String> {
        let mut rules = BTreeMap::new();
        self.resolve(|quantity, rule| {
            for key in quantity.parameters() {
                rules.insert((*key).to_owned(), format!("{} ({})", rule.text, rule.source));
            }
        });
        let given = [
            (self.roll_stiffness_n_m_rad, "suspension.roll_stiffness_n_m_rad"),
            (self.roll_damping_n_m_s_rad, "suspension.roll_damping_n_m_s_rad"),
        ];
        for (_, key) in given.into_iter().filter(|(value, _)| value.is_some()) {
            rules.remove(key);
        }
        rules
    }
}

impl VehicleParameters {
    /// The same parameters, which know the sheet that they come from.
    pub(super) fn with_sheet(mut self, sheet: &DataSheet) -> Self {
        self.sheet = Some(Arc::new(sheet.clone()));
        self
    }
}
