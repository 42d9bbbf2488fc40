//! The data sheet of a multibody model (`vehicle.toml` of a trajectory data set) and the rules by
//! which the parameters of the 4DOF vehicle are derived from it.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::parameters::{
    GeometryParameters, MassParameters, SuspensionParameters, VehicleParameters,
};
use crate::vehicle::sheet::AIR_DENSITY_KG_M3;
use crate::vehicle::tire::{SAME_IN_ALL_DIRECTIONS, TireParameters};
use crate::vehicle::{CrushParameters, DrivenAxle, Equations, RoadSlope};

/// Vertical load at which the record states the cornering stiffnesses of the tires, N.
const TIRE_REFERENCE_LOAD_N: f64 = 4905.0;
/// Height of the roll axis above the ground at the CG, m: a usual value for strut and
/// double-wishbone axles.
const ROLL_AXIS_HEIGHT_M: f64 = 0.10;
/// Body of the BMW E90, whose subsystems the first multibody model uses; where the record has none.
const USUAL_BODY: BodyRecord =
    BodyRecord { length: 4.52, width: None, front_overhang: 0.78, bumper_height: None };

/// Values of a multibody model at rest in SI units, as the `vehicle.toml` of a trajectory data set
/// states them.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct MultibodyRecord {
    #[serde(default)]
    name: Option<String>,
    mass: MassRecord,
    geometry: GeometryRecord,
    wheel: WheelRecord,
    suspension: SuspensionRecord,
    #[serde(rename = "tyre")]
    tire: TireRecord,
    aero: AeroRecord,
    equivalent: EquivalentRecord,
    powertrain: Option<PowertrainRecord>,
    body: Option<BodyRecord>,
}

/// Plan view of the body, m.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
struct BodyRecord {
    length: f64,
    /// Where it is not said, twice the half width of the geometry.
    width: Option<f64>,
    /// From the front axle to the front end.
    front_overhang: f64,
    /// Middle of the bumper above the ground.
    bumper_height: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct PowertrainRecord {
    driven: Option<DrivenAxle>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "PascalCase")]
struct MassRecord {
    #[serde(rename = "total")]
    total_kg: f64,
    #[serde(rename = "unsprung_and_links")]
    unsprung_kg: f64,
    ixx: f64,
    izz: f64,
    ixz: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct GeometryRecord {
    lf: f64,
    lr: f64,
    track_front: f64,
    track_rear: f64,
    cg_height: f64,
    half_width: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct WheelRecord {
    effective_rolling_radius: f64,
    #[serde(rename = "wheel_and_tyre_spin_inertia")]
    wheel_and_tire_spin_inertia: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct SuspensionRecord {
    spring_front: f64,
    spring_rear: f64,
    anti_roll_bar_front: f64,
    anti_roll_bar_rear: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct TireRecord {
    cornering_stiffness_front: f64,
    cornering_stiffness_rear: f64,
    sliding_over_peak: f64,
    rolling_resistance: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct AeroRecord {
    #[serde(rename = "CdA")]
    drag_area_m2: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct EquivalentRecord {
    roll_gradient_deg_per_g: f64,
    roll_damping_fit: f64,
}

impl MultibodyRecord {
    /// Derives the parameters of the 4DOF vehicle that represents the multibody model. Only the
    /// data sheet is used, by the rules that [`VehicleParameters::estimates`] lists; no parameter
    /// is fitted to trajectories.
    ///
    /// - `folder`: the folder of the file, after which a car is named that its file does not name.
    pub fn parameters(&self, folder: Option<&str>) -> VehicleParameters {
        let Self { mass, geometry, wheel, tire, aero, .. } = self;
        let body = self.body.unwrap_or(USUAL_BODY);
        let sprung_kg = mass.total_kg - mass.unsprung_kg;
        let unsprung_moment = mass.unsprung_kg * wheel.effective_rolling_radius;
        let sprung_height = (mass.total_kg * geometry.cg_height - unsprung_moment) / sprung_kg;
        let roll_arm_m = sprung_height - ROLL_AXIS_HEIGHT_M;
        let drag_over_weight =
            0.5 * AIR_DENSITY_KG_M3 * aero.drag_area_m2 / (mass.total_kg * STANDARD_GRAVITY_M_S2);
        VehicleParameters {
            name: self.name.clone().unwrap_or_else(|| {
                let name = folder.unwrap_or("car");
                format!("{name} (multibody, {} kg)", mass.total_kg)
            }),
            source: "vehicle.toml of the trajectory dataset: values of the multibody model at rest"
                .to_owned(),
            equations: Equations::default(),
            mass: MassParameters {
                mass_kg: mass.total_kg,
                sprung_mass_kg: sprung_kg,
                yaw_inertia_kg_m2: mass.izz,
                roll_inertia_kg_m2: mass.ixx + sprung_kg * roll_arm_m * roll_arm_m,
                roll_yaw_product_kg_m2: mass.ixz,
            },
            geometry: GeometryParameters {
                cg_to_front_axle_m: geometry.lf,
                cg_to_rear_axle_m: geometry.lr,
                track_width_m: (geometry.track_front + geometry.track_rear) / 2.0,
                cg_height_m: geometry.cg_height,
                outer_length_m: body.length,
                outer_width_m: body.width.unwrap_or(2.0 * geometry.half_width),
                cg_to_front_end_m: geometry.lf + body.front_overhang,
            },
            suspension: self.suspension_parameters(sprung_kg, roll_arm_m),
            crush: CrushParameters::default(),
            tires: TireParameters {
                cornering_coefficient_front_per_rad: tire.cornering_stiffness_front
                    / TIRE_REFERENCE_LOAD_N,
                cornering_coefficient_rear_per_rad: tire.cornering_stiffness_rear
                    / TIRE_REFERENCE_LOAD_N,
                friction: 0.8,
                sliding_friction_ratio: tire.sliding_over_peak,
                rolling_resistance: tire.rolling_resistance,
                rolling_resistance_s_m: 0.0,
                rolling_resistance_s2_m2: drag_over_weight,
                rolling_radius_m: wheel.effective_rolling_radius,
                wheel_inertia_kg_m2: wheel.wheel_and_tire_spin_inertia,
                longitudinal_friction_ratio: SAME_IN_ALL_DIRECTIONS,
            },
            estimates: self.estimates(),
            stated: BTreeMap::new(),
            sheet: None,
            slope: RoadSlope::default(),
            fixed: None,
        }
    }

    /// Height of the middle of the bumper above the ground, m, where the record has it.
    pub fn bumper_height_m(&self) -> Option<f64> {
        self.body?.bumper_height
    }

    /// Which wheels the engine drives, where the record has it.
    pub fn driven_axle(&self) -> Option<DrivenAxle> {
        self.powertrain.as_ref()?.driven
    }

    /// The key of the record from which a parameter of the 4DOF vehicle follows, or the one of several
    /// that a wrong value most likely comes from; `None` for a constant.
    pub(super) fn origin(parameter: &str) -> Option<&'static str> {
        Some(match parameter {
            "mass.mass_kg" => "mass.total",
            "mass.sprung_mass_kg" => "mass.unsprung_and_links",
            "mass.yaw_inertia_kg_m2" => "mass.Izz",
            "mass.roll_inertia_kg_m2" => "mass.Ixx",
            "mass.roll_yaw_product_kg_m2" => "mass.Ixz",
            "geometry.cg_to_front_axle_m" | "geometry.cg_to_front_end_m" => "geometry.lf",
            "geometry.cg_to_rear_axle_m" => "geometry.lr",
            "geometry.track_width_m" => "geometry.track_front",
            "geometry.cg_height_m" | "suspension.roll_arm_m" => "geometry.cg_height",
            "geometry.outer_width_m" => "geometry.half_width",
            "suspension.roll_stiffness_n_m_rad" => "equivalent.roll_gradient_deg_per_g",
            "suspension.roll_damping_n_m_s_rad" => "equivalent.roll_damping_fit",
            "suspension.front_roll_stiffness_share" => "suspension.spring_front",
            "tires.cornering_coefficient_front_per_rad" => "tyre.cornering_stiffness_front",
            "tires.cornering_coefficient_rear_per_rad" => "tyre.cornering_stiffness_rear",
            "tires.sliding_friction_ratio" => "tyre.sliding_over_peak",
            "tires.rolling_resistance" => "tyre.rolling_resistance",
            "tires.rolling_resistance_s2_m2" => "aero.CdA",
            "tires.rolling_radius_m" => "wheel.effective_rolling_radius",
            "tires.wheel_inertia_kg_m2" => "wheel.wheel_and_tyre_spin_inertia",
            _ => return None,
        })
    }

    fn suspension_parameters(&self, sprung_kg: f64, roll_arm_m: f64) -> SuspensionParameters {
        let (springs, geometry) = (&self.suspension, &self.geometry);
        let axle_stiffness = |spring: f64, track: f64, bar: f64| spring * track * track / 2.0 + bar;
        let front =
            axle_stiffness(springs.spring_front, geometry.track_front, springs.anti_roll_bar_front);
        let rear =
            axle_stiffness(springs.spring_rear, geometry.track_rear, springs.anti_roll_bar_rear);
        let gradient_rad_per_g = self.equivalent.roll_gradient_deg_per_g.to_radians();
        let weight_arm = sprung_kg * STANDARD_GRAVITY_M_S2 * roll_arm_m;
        SuspensionParameters {
            roll_axis_height_m: ROLL_AXIS_HEIGHT_M,
            roll_arm_m,
            roll_stiffness_n_m_rad: weight_arm * (1.0 / gradient_rad_per_g + 1.0),
            roll_damping_n_m_s_rad: self.equivalent.roll_damping_fit,
            front_roll_stiffness_share: front / (front + rear),
        }
    }
    fn estimates(&self) -> BTreeMap<String, String> {
        let is_of_body =
            |key: &str| matches!(key, "geometry.outer_length_m" | "geometry.cg_to_front_end_m");
        let is_known = |key: &str| self.body.is_some() && is_of_body(key);
        let rules = ESTIMATES.into_iter().filter(|(key, _)| !is_known(key));
        rules.map(|(key, rule)| (key.to_owned(), rule.to_owned())).collect()
    }
}

/// Parameters that no key of the record states, and by which rule they follow.
const ESTIMATES: [(&str, &str); 10] = [
    ("geometry.outer_length_m", "body of the E90 saloon; the model has no outer skin"),
    ("geometry.cg_to_front_end_m", "l_f + 0.78 m front overhang of that body"),
    ("mass.sprung_mass_kg", "all of \"unsprung and links\" taken as unsprung"),
    ("mass.roll_inertia_kg_m2", "I_xx of the whole car + m_s h² (parallel axes)"),
    ("suspension.roll_axis_height_m", "usual for strut and double-wishbone axles"),
    ("suspension.roll_arm_m", "(m h_cog − m_u r_wheel)/m_s − roll axis height"),
    ("suspension.roll_stiffness_n_m_rad", "m_s g h (1/roll gradient + 1): meets the gradient"),
    ("suspension.front_roll_stiffness_share", "springs and bars at the wheels: c w²/2 + bar"),
    ("tires.friction", "the dataset's usual value; each case states its own"),
    ("tires.rolling_resistance_s2_m2", "stands for the air drag: ρ C_d A / (2 m g)"),
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::vehicle::Preset;

    #[test]
    fn the_reference_preset_is_what_the_dataset_says() {
        for dataset in ["trajectories-fea", "trajectories-pulse"] {
            let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets"))
                .join(dataset)
                .join("vehicle.toml");
            let derived = VehicleParameters::load(&path).unwrap();
            let shipped = Preset::Reference.parameters();
            assert_eq!(derived.name, shipped.name);
            for (derived, shipped) in [
                (derived.mass.yaw_inertia_kg_m2, shipped.mass.yaw_inertia_kg_m2),
                (
                    derived.suspension.roll_stiffness_n_m_rad,
                    shipped.suspension.roll_stiffness_n_m_rad,
                ),
                (
                    derived.tires.cornering_coefficient_front_per_rad,
                    shipped.tires.cornering_coefficient_front_per_rad,
                ),
            ] {
                assert!((derived / shipped - 1.0).abs() < 1e-4, "{dataset}: {derived} {shipped}");
            }
        }
    }
}
