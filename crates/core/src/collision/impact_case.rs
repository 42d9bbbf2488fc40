//! Rows of a table of impacts, as the shipped finite-element runs have them.

use std::f64::consts::FRAC_PI_2;

use crate::collision::{
    ContactLocation, ContactSurface, Footprint, FrictionModel, Impact, ImpactBody, RestitutionForm,
    Scenario, ScenarioContact, ScenarioError, ScenarioVehicle,
};

/// One row of a table of impacts, as in the shipped finite-element cases. The world axes are the
/// body axes of the struck vehicle at first contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactCase {
    /// Mass of the struck vehicle, kg.
    pub m_t_kg: f64,
    /// Mass of the striking vehicle, kg.
    pub m_b_kg: f64,
    /// Velocity `[x, y]` of the CG of the struck vehicle before the impact, m/s.
    pub v_t_m_s: [f64; 2],
    /// Velocity `[x, y]` of the CG of the striking vehicle before the impact, m/s.
    pub v_b_m_s: [f64; 2],
    /// Heading of the striking vehicle relative to that of the struck vehicle, rad,
    /// counter-clockwise positive.
    pub theta_b_rad: f64,
    /// Yaw moment of inertia of the struck vehicle about its CG, kg m².
    pub izz_t_kg_m2: f64,
    /// Yaw moment of inertia of the striking vehicle about its CG, kg m².
    pub izz_b_kg_m2: f64,
    /// Position `[x, y]` of the contact point relative to the CG of the struck vehicle, m.
    pub contact_m: [f64; 2],
    /// Position `[x, y]` of the CG of the striking vehicle relative to the CG of the struck
    /// vehicle, m.
    pub striking_m: [f64; 2],
}

impl ImpactCase {
    /// The planar impact of the case. The contact normal is perpendicular to the longitudinal axis
    /// of the struck vehicle and points into it from the side of the contact point. The yaw rates
    /// before the impact are zero.
    ///
    /// - `restitution`: coefficient of restitution e, 0 to 1;
    /// - `friction_limit`: friction limit μ_c, 0 or more.
    ///
    /// # Errors
    /// [`ScenarioError::NoSide`] if the y coordinate of the contact point is zero or not finite.
    pub fn to_impact(
        &self,
        restitution: f64,
        friction_limit: f64,
    ) -> Result<Impact, ScenarioError> {
        let [x, y] = self.contact_m;
        Ok(Impact {
            struck: ImpactBody {
                mass_kg: self.m_t_kg,
                yaw_inertia_kg_m2: self.izz_t_kg_m2,
                heading_rad: 0.0,
                velocity_world_m_s: self.v_t_m_s,
                yaw_rate_rad_s: 0.0,
                contact_arm_world_m: [x, y],
            },
            striking: ImpactBody {
                mass_kg: self.m_b_kg,
                yaw_inertia_kg_m2: self.izz_b_kg_m2,
                heading_rad: self.theta_b_rad,
                velocity_world_m_s: self.v_b_m_s,
                yaw_rate_rad_s: 0.0,
                contact_arm_world_m: [x - self.striking_m[0], y - self.striking_m[1]],
            },
            surface: ContactSurface {
                normal_angle_world_rad: self.normal_rad()?,
                restitution,
                restitution_form: RestitutionForm::Normal,
                friction_limit,
                friction_model: FrictionModel::Limit,
            },
        })
    }

    fn normal_rad(&self) -> Result<f64, ScenarioError> {
        let contact_y_m = self.contact_m[1];
        if contact_y_m == 0.0 || !contact_y_m.is_finite() {
            return Err(ScenarioError::NoSide { contact_y_m });
        }
        Ok(-contact_y_m.signum() * FRAC_PI_2)
    }

    /// The scenario that gives the same impact as [`ImpactCase::to_impact`], to be shown or saved.
    ///
    /// - `struck`, `striking`: outlines of the vehicles; they are used for drawing only.
    /// - `restitution`, `friction_limit`: as for [`ImpactCase::to_impact`].
    ///
    /// # Errors
    /// [`ScenarioError::NoSide`] if the y coordinate of the contact point is zero or not finite.
    pub fn to_scenario(
        &self,
        [struck, striking]: [Footprint; 2],
        restitution: f64,
        friction_limit: f64,
    ) -> Result<Scenario, ScenarioError> {
        let [x_body_m, y_body_m] = self.contact_m;
        let normal_body_rad = self.normal_rad()?;
        let vehicle =
            |mass_kg, yaw_inertia_kg_m2, [vx_world_m_s, vy_world_m_s]: [f64; 2], f: Footprint| {
                ScenarioVehicle {
                    mass_kg,
                    yaw_inertia_kg_m2,
                    length_m: f.length_m,
                    width_m: f.width_m,
                    cg_from_front_m: f.cg_from_front_m,
                    heading_rad: 0.0,
                    vx_world_m_s,
                    vy_world_m_s,
                    yaw_rate_rad_s: 0.0,
                    fixed: None,
                    skid: None,
                }
            };
        Ok(Scenario {
            name: String::new(),
            notes: String::new(),
            struck_x_world_m: 0.0,
            struck_y_world_m: 0.0,
            struck: vehicle(self.m_t_kg, self.izz_t_kg_m2, self.v_t_m_s, struck),
            striking: ScenarioVehicle {
                heading_rad: self.theta_b_rad,
                ..vehicle(self.m_b_kg, self.izz_b_kg_m2, self.v_b_m_s, striking)
            },
            contact: ScenarioContact {
                location: ContactLocation::Point {
                    x_body_m,
                    y_body_m,
                    normal_body_rad,
                    striking_x_world_m: self.striking_m[0],
                    striking_y_world_m: self.striking_m[1],
                },
                restitution: Some(restitution),
                restitution_form: RestitutionForm::Normal,
                friction_limit: Some(friction_limit),
                friction_of_critical: None,
                friction_model: FrictionModel::Limit,
            },
            ending: None,
            striking_ending: None,
            struck_vehicle: None,
            striking_vehicle: None,
            road: None,
        })
    }
}
