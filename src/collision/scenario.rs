//! Two vehicles about to collide, as plain numbers: what a user writes in `SCENARIO.toml`, the app
//! saves and [`Scenario::solve`] turns into an impact.
//!
//! Source of the defaults of restitution and friction: see
//! [`ContactDistribution`](crate::collision::ContactDistribution).

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

use crate::collision::{
    ContactSurface, Footprint, FootprintError, FrictionModel, Impact, ImpactBody, ImpactError,
    ImpactSolution, Pose, Side, find_contact, place_touching,
};

/// Restitution used where none is given, the middle of the default
/// [`ContactDistribution`](crate::collision::ContactDistribution).
pub const DEFAULT_RESTITUTION: f64 = 0.15;

/// Friction limit used where none is given, the middle of the default
/// [`ContactDistribution`](crate::collision::ContactDistribution).
pub const DEFAULT_FRICTION_LIMIT: f64 = 0.4;

/// One of the two vehicles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioVehicle {
    /// Mass, kg, 1 to 1e8 (a barrier is a heavy vehicle).
    pub mass_kg: f64,
    /// Yaw inertia about the CG, kg m², 0.1 to 1e10.
    pub yaw_inertia_kg_m2: f64,
    /// Outer length, m, 0.1 to 100.
    pub length_m: f64,
    /// Outer width, m, 0.1 to 20.
    pub width_m: f64,
    /// From the foremost point back to the CG, m, 0 to `length_m`.
    pub cg_from_front_m: f64,
    /// Heading (yaw ψ) in the world, rad, −4π to 4π.
    pub heading_rad: f64,
    /// Velocity along the world's X axis, m/s, −150 to 150.
    pub vx_m_s: f64,
    /// Velocity along the world's Y axis, m/s, −150 to 150.
    pub vy_m_s: f64,
    /// Yaw rate, rad/s, −50 to 50.
    pub yaw_rate_rad_s: f64,
}

/// What says where and how the vehicles touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "from", rename_all = "snake_case")]
pub enum ContactLocation {
    /// The outlines of both vehicles, with the bullet's CG here.
    Footprints {
        /// The bullet's CG along the world's X axis, m.
        bullet_x_m: f64,
        /// The bullet's CG along the world's Y axis, m.
        bullet_y_m: f64,
    },
    /// The outlines of both vehicles, with the bullet placed so that it just touches.
    Side {
        /// Struck side of the target.
        side: Side,
        /// From the middle of that side along the target's x axis (left, right) or y axis (front,
        /// rear), m.
        offset_m: f64,
    },
    /// The user.
    Point {
        /// Contact point, target's body axes from its CG, m.
        x_m: f64,
        /// Contact point, target's body axes from its CG, m.
        y_m: f64,
        /// Angle of the contact normal in the target's body axes, rad, pointing into the target.
        normal_rad: f64,
        /// The bullet's CG along the world's X axis, m.
        bullet_x_m: f64,
        /// The bullet's CG along the world's Y axis, m.
        bullet_y_m: f64,
    },
}

/// The contact: where, and how it rebounds and rubs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScenarioContact {
    /// Where the vehicles touch.
    #[serde(flatten)]
    pub location: ContactLocation,
    /// Coefficient of restitution e, 0 to 1.
    pub restitution: f64,
    /// Friction limit μ_c, 0 to 10.
    pub friction_limit: f64,
    /// How friction is resolved.
    pub friction_model: FrictionModel,
}

/// Two vehicles about to collide. Read from a file by [`Scenario::load`]
/// and [`Scenario::from_toml`], which check every range; written by [`Scenario::to_toml`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What a list of scenarios calls it.
    pub name: String,
    /// Where it comes from, for a person.
    pub notes: String,
    /// The target's CG along the world's X axis, m.
    pub target_x_m: f64,
    /// The target's CG along the world's Y axis, m.
    pub target_y_m: f64,
    /// The vehicle that is struck.
    pub target: ScenarioVehicle,
    /// The vehicle that strikes.
    pub bullet: ScenarioVehicle,
    /// Where and how they touch.
    pub contact: ScenarioContact,
}

/// Where a scenario's vehicles stand and touch, world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScenarioGeometry {
    /// The target.
    pub target: Pose,
    /// The bullet.
    pub bullet: Pose,
    /// Contact point, m.
    pub contact_point_m: [f64; 2],
    /// Angle Γ of the contact normal, rad, pointing into the target.
    pub normal_angle_rad: f64,
    /// How deep the outlines overlap, m (negative: a gap within the tolerance); `None` where the
    /// user gave the contact and the outlines were not asked.
    pub overlap_m: Option<f64>,
}

/// A scenario that cannot be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The outlines make no contact.
    #[error("the vehicles' outlines make no contact")]
    Footprint(#[from] FootprintError),
    /// The impact has no solution.
    #[error("the impact cannot be solved")]
    Impact(#[from] ImpactError),
    /// The user's normal points away from the target's CG: most likely turned round.
    #[error(
        "the contact normal at {normal_deg:.1} deg points out of the target; \
         it is the way the bullet pushes, {:.1} deg would point inwards", normal_deg + 180.0
    )]
    NormalPointsOut {
        /// The normal in the target's body axes, deg.
        normal_deg: f64,
    },
    /// A contact on neither side of the target, so that "across the target" has no direction.
    #[error("contact_y_m is {contact_y_m}, expected a side of the target")]
    NoSide {
        /// The contact's y in the target's body axes, m.
        contact_y_m: f64,
    },
}

impl ScenarioVehicle {
    /// Its outline.
    pub fn footprint(&self) -> Footprint {
        Footprint {
            length_m: self.length_m,
            width_m: self.width_m,
            cg_from_front_m: self.cg_from_front_m,
        }
    }

    fn body(&self, pose: &Pose, contact_point_m: [f64; 2]) -> ImpactBody {
        ImpactBody {
            mass_kg: self.mass_kg,
            yaw_inertia_kg_m2: self.yaw_inertia_kg_m2,
            heading_rad: self.heading_rad,
            velocity_m_s: [self.vx_m_s, self.vy_m_s],
            yaw_rate_rad_s: self.yaw_rate_rad_s,
            contact_arm_m: [contact_point_m[0] - pose.x_m, contact_point_m[1] - pose.y_m],
        }
    }
}

impl Scenario {
    /// Where the vehicles stand and touch.
    ///
    /// # Errors
    /// [`ScenarioError::Footprint`] if the outlines make no contact,
    /// [`ScenarioError::NormalPointsOut`] for a user's normal that does not point into the target.
    pub fn geometry(&self) -> Result<ScenarioGeometry, ScenarioError> {
        let target =
            Pose { x_m: self.target_x_m, y_m: self.target_y_m, yaw_rad: self.target.heading_rad };
        let heading_rad = self.bullet.heading_rad;
        let bullet_at = |x_m, y_m| Pose { x_m, y_m, yaw_rad: heading_rad };
        let outlines = [self.target.footprint(), self.bullet.footprint()];
        let bullet = match self.contact.location {
            ContactLocation::Footprints { bullet_x_m, bullet_y_m } => {
                bullet_at(bullet_x_m, bullet_y_m)
            }
            ContactLocation::Side { side, offset_m } => {
                let place = (side, offset_m);
                place_touching((&outlines[0], &target), place, (&outlines[1], heading_rad))?
            }
            ContactLocation::Point { x_m, y_m, normal_rad, bullet_x_m, bullet_y_m } => {
                let (sin, cos) = normal_rad.sin_cos();
                if x_m * cos + y_m * sin > 0.0 {
                    let normal_deg = normal_rad.to_degrees();
                    return Err(ScenarioError::NormalPointsOut { normal_deg });
                }
                return Ok(ScenarioGeometry {
                    target,
                    bullet: bullet_at(bullet_x_m, bullet_y_m),
                    contact_point_m: target.world_from_body([x_m, y_m]),
                    normal_angle_rad: target.yaw_rad + normal_rad,
                    overlap_m: None,
                });
            }
        };
        let contact = find_contact((&outlines[0], &target), (&outlines[1], &bullet))?;
        Ok(ScenarioGeometry {
            target,
            bullet,
            contact_point_m: contact.point_m,
            normal_angle_rad: contact.normal_angle_rad,
            overlap_m: Some(contact.depth_m),
        })
    }

    /// The impact of the two vehicles.
    ///
    /// # Errors
    /// Those of [`Scenario::geometry`].
    pub fn impact(&self) -> Result<Impact, ScenarioError> {
        let geometry = self.geometry()?;
        let point = geometry.contact_point_m;
        Ok(Impact {
            target: self.target.body(&geometry.target, point),
            bullet: self.bullet.body(&geometry.bullet, point),
            surface: ContactSurface {
                normal_angle_rad: geometry.normal_angle_rad,
                restitution: self.contact.restitution,
                friction_limit: self.contact.friction_limit,
                friction_model: self.contact.friction_model,
            },
        })
    }

    /// Impulse, post-impact motion and energy.
    ///
    /// # Errors
    /// Those of [`Scenario::impact`] and [`Impact::solve`].
    pub fn solve(&self) -> Result<ImpactSolution, ScenarioError> {
        Ok(self.impact()?.solve()?)
    }
}

/// One row of a table of impacts, as in the shipped finite-element cases: the target's body axes at
/// first contact are the world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactCase {
    /// Mass of the target, kg.
    pub m_t_kg: f64,
    /// Mass of the bullet, kg.
    pub m_b_kg: f64,
    /// Velocity of the target, m/s.
    pub v_t_m_s: [f64; 2],
    /// Velocity of the bullet, m/s.
    pub v_b_m_s: [f64; 2],
    /// Heading of the bullet against the target's, rad.
    pub theta_b_rad: f64,
    /// Yaw inertia of the target, kg m².
    pub izz_t_kg_m2: f64,
    /// Yaw inertia of the bullet, kg m².
    pub izz_b_kg_m2: f64,
    /// Contact point from the target's CG, m.
    pub contact_m: [f64; 2],
    /// The bullet's CG from the target's CG, m.
    pub bullet_m: [f64; 2],
}

impl ImpactCase {
    /// The impact with the contact point of the table and the normal across the target: ±y, into it
    /// from the side of the contact. Neither vehicle turns before it.
    ///
    /// - `restitution`: e, 0 to 1;
    /// - `friction_limit`: μ_c, 0 or more.
    ///
    /// # Errors
    /// [`ScenarioError::NoSide`] for a contact at `y = 0`.
    pub fn to_impact(
        &self,
        restitution: f64,
        friction_limit: f64,
    ) -> Result<Impact, ScenarioError> {
        let [x, y] = self.contact_m;
        Ok(Impact {
            target: ImpactBody {
                mass_kg: self.m_t_kg,
                yaw_inertia_kg_m2: self.izz_t_kg_m2,
                heading_rad: 0.0,
                velocity_m_s: self.v_t_m_s,
                yaw_rate_rad_s: 0.0,
                contact_arm_m: [x, y],
            },
            bullet: ImpactBody {
                mass_kg: self.m_b_kg,
                yaw_inertia_kg_m2: self.izz_b_kg_m2,
                heading_rad: self.theta_b_rad,
                velocity_m_s: self.v_b_m_s,
                yaw_rate_rad_s: 0.0,
                contact_arm_m: [x - self.bullet_m[0], y - self.bullet_m[1]],
            },
            surface: ContactSurface {
                normal_angle_rad: self.normal_rad()?,
                restitution,
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

    /// The scenario with the same impact as [`ImpactCase::to_impact`], for showing and saving; the
    /// outlines only serve drawing.
    ///
    /// # Errors
    /// [`ScenarioError::NoSide`] for a contact at `y = 0`.
    pub fn to_scenario(
        &self,
        [target, bullet]: [Footprint; 2],
        (restitution, friction_limit): (f64, f64),
    ) -> Result<Scenario, ScenarioError> {
        let [x_m, y_m] = self.contact_m;
        let normal_rad = self.normal_rad()?;
        let vehicle = |mass_kg, yaw_inertia_kg_m2, [vx_m_s, vy_m_s]: [f64; 2], f: Footprint| {
            ScenarioVehicle {
                mass_kg,
                yaw_inertia_kg_m2,
                length_m: f.length_m,
                width_m: f.width_m,
                cg_from_front_m: f.cg_from_front_m,
                heading_rad: 0.0,
                vx_m_s,
                vy_m_s,
                yaw_rate_rad_s: 0.0,
            }
        };
        Ok(Scenario {
            name: String::new(),
            notes: String::new(),
            target_x_m: 0.0,
            target_y_m: 0.0,
            target: vehicle(self.m_t_kg, self.izz_t_kg_m2, self.v_t_m_s, target),
            bullet: ScenarioVehicle {
                heading_rad: self.theta_b_rad,
                ..vehicle(self.m_b_kg, self.izz_b_kg_m2, self.v_b_m_s, bullet)
            },
            contact: ScenarioContact {
                location: ContactLocation::Point {
                    x_m,
                    y_m,
                    normal_rad,
                    bullet_x_m: self.bullet_m[0],
                    bullet_y_m: self.bullet_m[1],
                },
                restitution,
                friction_limit,
                friction_model: FrictionModel::Limit,
            },
        })
    }
}
