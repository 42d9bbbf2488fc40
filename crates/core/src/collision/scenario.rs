//! A collision scenario: two vehicles that are about to collide, as plain numbers. A user writes it
//! as a `SCENARIO.toml` file, the app saves it, and [`Scenario::solve`] computes the impact.
//!
//! What holds where restitution and friction limit are not given is said at
//! [`default_restitution`](crate::collision::default_restitution).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::collision::{
    ContactSurface, DEFAULT_FRICTION_LIMIT, Footprint, FootprintError, FrictionModel, Impact,
    ImpactBody, ImpactError, ImpactSolution, MovingFootprint, OffOutline, Pose, RestitutionForm,
    ScenarioSkid, Side, StruckSurface, default_restitution, find_contact, place_touching,
};

use crate::collision::fixed_place::place_wall;
use crate::vehicle::{Ending, FIXED_MASS_KG, FIXED_YAW_INERTIA_KG_M2, FixedObject, RoadSlope};

use crate::ranges::{
    BODY_CG, BODY_LENGTH, BODY_MASS, BODY_WIDTH, BODY_YAW_INERTIA, CONTACT_COORDINATE,
    CONTACT_OFFSET, FRICTION_LIMIT, FRICTION_OF_CRITICAL, HEADING, POSITION, RESTITUTION, Range,
    SPEED, YAW_RATE,
};

/// Vehicle data and motion before the impact of one of the two vehicles. The ranges are checked
/// when a scenario is read from a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenarioVehicle {
    /// Mass, kg, 1 to 1e8. A fixed barrier is represented by a very heavy vehicle.
    pub mass_kg: f64,
    /// Yaw moment of inertia about the CG, kg m², 0.1 to 1e10.
    pub yaw_inertia_kg_m2: f64,
    /// Outer length, m, 0.1 to 100.
    pub length_m: f64,
    /// Outer width, m, 0.1 to 20.
    pub width_m: f64,
    /// Distance from the front of the outline back to the CG, m, 0 to `length_m`.
    pub cg_from_front_m: f64,
    /// Heading (yaw angle ψ) in world axes, rad, −4π to 4π.
    pub heading_rad: f64,
    /// Velocity of the CG along the X axis of the world, m/s, −150 to 150.
    #[serde(rename = "vx_m_s")]
    pub vx_world_m_s: f64,
    /// Velocity of the CG along the Y axis of the world, m/s, −150 to 150.
    #[serde(rename = "vy_m_s")]
    pub vy_world_m_s: f64,
    /// Yaw rate before the impact, rad/s, −50 to 50, counter-clockwise positive.
    pub yaw_rate_rad_s: f64,
    /// What it is, if it is an object that does not move. Mass, inertia and velocities are then those of
    /// such an object, whatever is said, and the heading of a pole, which is round, is that of the struck vehicle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed: Option<FixedObject>,
    /// A skid that ends at the first contact; the velocities are those after it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skid: Option<ScenarioSkid>,
}

/// The way in which a scenario specifies contact point, contact normal and position of the striking
/// vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "from", rename_all = "snake_case")]
pub enum ContactLocation {
    /// The position of the striking vehicle is given. Contact point and normal follow from the
    /// outlines of both vehicles ([`find_contact`]).
    Footprints {
        /// X coordinate of the CG of the striking vehicle in world axes, m.
        #[serde(rename = "bullet_x_m")]
        striking_x_world_m: f64,
        /// Y coordinate of the CG of the striking vehicle in world axes, m.
        #[serde(rename = "bullet_y_m")]
        striking_y_world_m: f64,
    },
    /// The touching point on a side of the struck vehicle is given. The striking vehicle is placed
    /// so that it just touches there ([`place_touching`]); contact point and normal follow from the
    /// outlines.
    Side {
        /// Side on which the struck vehicle is hit.
        side: Side,
        /// Position of the touching point relative to the midpoint of that side, m, positive along
        /// the x axis of the struck vehicle (left and right side) or along its y axis (front and
        /// rear).
        offset_m: f64,
    },
    /// Contact point, normal and position of the striking vehicle are all given by the user. The
    /// outlines are not used.
    Point {
        /// Coordinate x of the contact point in body axes of the struck vehicle, from its CG, m.
        #[serde(rename = "x_m")]
        x_body_m: f64,
        /// Coordinate y of the contact point in body axes of the struck vehicle, from its CG, m.
        #[serde(rename = "y_m")]
        y_body_m: f64,
        /// Angle of the contact normal in body axes of the struck vehicle, rad. The normal points
        /// into the struck vehicle.
        #[serde(rename = "normal_rad")]
        normal_body_rad: f64,
        /// X coordinate of the CG of the striking vehicle in world axes, m.
        #[serde(rename = "bullet_x_m")]
        striking_x_world_m: f64,
        /// Y coordinate of the CG of the striking vehicle in world axes, m.
        #[serde(rename = "bullet_y_m")]
        striking_y_world_m: f64,
    },
}

/// The contact of a scenario: its location, restitution and friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScenarioContact {
    /// Specification of contact point, contact normal and position of the striking vehicle.
    #[serde(flatten)]
    pub location: ContactLocation,
    /// Coefficient of restitution e, 0 to 1; without it,
    /// [`default_restitution`](crate::collision::default_restitution) at the closing speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Meaning of the coefficient of restitution.
    #[serde(default)]
    pub restitution_form: RestitutionForm,
    /// Friction limit μ_c, the largest ratio of tangential to normal impulse, 0 to 10; without it,
    /// [`DEFAULT_FRICTION_LIMIT`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_limit: Option<f64>,
    /// Friction limit as a share of the critical impulse ratio, 0 to 1, which overrules
    /// `friction_limit`; see [`Impact::critical_impulse_ratio`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_of_critical: Option<f64>,
    /// Friction model of the contact.
    pub friction_model: FrictionModel,
}

/// Two vehicles that are about to collide. [`Scenario::load`] and [`Scenario::from_toml`] read a
/// scenario and check every range; [`Scenario::to_toml`] writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the scenario in lists and reports; may be empty.
    pub name: String,
    /// Origin of the data, as free text for the user; may be empty.
    pub notes: String,
    /// X coordinate of the CG of the struck vehicle in world axes, m.
    #[serde(rename = "target_x_m")]
    pub struck_x_world_m: f64,
    /// Y coordinate of the CG of the struck vehicle in world axes, m.
    #[serde(rename = "target_y_m")]
    pub struck_y_world_m: f64,
    /// The vehicle that is struck.
    #[serde(rename = "target")]
    pub struck: ScenarioVehicle,
    /// The vehicle that strikes.
    #[serde(rename = "bullet")]
    pub striking: ScenarioVehicle,
    /// The contact between the two vehicles.
    pub contact: ScenarioContact,
    /// What happens to the wheels of the struck vehicle after the first contact; `None` if the
    /// scenario does not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ending: Option<Ending>,
    /// The same of the striking vehicle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[serde(rename = "bullet_ending")]
    pub striking_ending: Option<Ending>,
    /// The struck vehicle by its name among those that come with the program, if the scenario says it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[serde(rename = "target_vehicle")]
    pub struck_vehicle: Option<String>,
    /// The striking vehicle, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[serde(rename = "bullet_vehicle")]
    pub striking_vehicle: Option<String>,
    /// Slope of the road in world axes; `None` if the scenario does not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub road: Option<RoadSlope>,
}

/// Poses and contact of the two vehicles of a scenario, in world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScenarioGeometry {
    /// Pose of the struck vehicle.
    pub struck: Pose,
    /// Pose of the striking vehicle.
    pub striking: Pose,
    /// Contact point, m.
    pub contact_point_world_m: [f64; 2],
    /// Angle Γ of the contact normal, rad. The normal points into the struck vehicle.
    pub normal_angle_world_rad: f64,
    /// Overlap of the outlines along the normal, m; negative for a gap within the tolerance. `None`
    /// if the user gave the contact ([`ContactLocation::Point`]), since the outlines are not used
    /// then.
    pub overlap_m: Option<f64>,
    /// The side to which the normal is perpendicular, where the contact comes from the outlines.
    pub surface: Option<StruckSurface>,
}

/// Reason why a scenario, or a row of a table of impacts, cannot be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The outlines make no contact, or an outline or a pose is out of range.
    #[error("the vehicles' outlines give no contact")]
    Footprint(#[from] FootprintError),
    /// The impact has an input out of range, or no solution.
    #[error("the impact cannot be solved")]
    Impact(#[from] ImpactError),
    /// The contact normal given by the user points away from the CG of the struck vehicle; most
    /// likely it was given in the opposite direction.
    #[error(
        "the contact normal at {normal_deg:.1} deg points out of the struck vehicle; \
         it is the way the striking vehicle pushes, {:.1} deg would point inwards",
        normal_deg + 180.0
    )]
    NormalPointsOut {
        /// Angle of the given normal in body axes of the struck vehicle, deg.
        normal_deg: f64,
    },
    /// The contact point that the user gave does not lie at one of the vehicles.
    #[error("the vehicles do not touch there: {which}")]
    ContactOffOutline {
        /// The vehicle: struck or striking.
        which: &'static str,
        /// How far the point lies off.
        source: OffOutline,
    },
    /// The friction is given as a share of the critical impulse ratio, and there is none.
    #[error(
        "friction_of_critical has no meaning here: the vehicles slide along each other whatever \
         the friction; give friction_limit instead"
    )]
    NoCriticalRatio,
    /// The contact point of an [`ImpactCase`](crate::collision::ImpactCase) lies on neither side of
    /// the struck vehicle, so that the direction of the normal is undefined.
    #[error("contact_y_m is {contact_y_m}, expected a side of the struck vehicle")]
    NoSide {
        /// Coordinate y of the contact point in body axes of the struck vehicle, m.
        contact_y_m: f64,
    },
}

impl ScenarioVehicle {
    /// Outline of the vehicle.
    pub fn footprint(&self) -> Footprint {
        Footprint {
            length_m: self.length_m,
            width_m: self.width_m,
            cg_from_front_m: self.cg_from_front_m,
        }
    }

    /// Every number with its name and its range.
    fn ranges(&self) -> [(&'static str, f64, Range); 9] {
        [
            ("mass_kg", self.mass_kg, BODY_MASS),
            ("yaw_inertia_kg_m2", self.yaw_inertia_kg_m2, BODY_YAW_INERTIA),
            ("length_m", self.length_m, BODY_LENGTH),
            ("width_m", self.width_m, BODY_WIDTH),
            ("cg_from_front_m", self.cg_from_front_m, BODY_CG.at_most(self.length_m)),
            ("heading_rad", self.heading_rad, HEADING),
            ("vx_m_s", self.vx_world_m_s, SPEED),
            ("vy_m_s", self.vy_world_m_s, SPEED),
            ("yaw_rate_rad_s", self.yaw_rate_rad_s, YAW_RATE),
        ]
    }

    fn body(&self, pose: &Pose, contact_point_m: [f64; 2]) -> ImpactBody {
        if self.fixed.is_some() {
            return ImpactBody {
                mass_kg: FIXED_MASS_KG,
                yaw_inertia_kg_m2: FIXED_YAW_INERTIA_KG_M2,
                heading_rad: pose.yaw_rad,
                velocity_world_m_s: [0.0; 2],
                yaw_rate_rad_s: 0.0,
                contact_arm_world_m: [contact_point_m[0] - pose.x_m, contact_point_m[1] - pose.y_m],
            };
        }
        ImpactBody {
            mass_kg: self.mass_kg,
            yaw_inertia_kg_m2: self.yaw_inertia_kg_m2,
            heading_rad: pose.yaw_rad,
            velocity_world_m_s: [self.vx_world_m_s, self.vy_world_m_s],
            yaw_rate_rad_s: self.yaw_rate_rad_s,
            contact_arm_world_m: [contact_point_m[0] - pose.x_m, contact_point_m[1] - pose.y_m],
        }
    }
}

impl ScenarioContact {
    /// Every number with its name and its range.
    fn ranges(&self) -> Vec<(&'static str, f64, Range)> {
        let mut numbers: Vec<(&'static str, f64, Range)> = [
            ("restitution", self.restitution, RESTITUTION),
            ("friction_limit", self.friction_limit, FRICTION_LIMIT),
            ("friction_of_critical", self.friction_of_critical, FRICTION_OF_CRITICAL),
        ]
        .into_iter()
        .filter_map(|(name, value, range)| Some((name, value?, range)))
        .collect();
        let mut striking = |x_m, y_m| {
            numbers.extend([("bullet_x_m", x_m, POSITION), ("bullet_y_m", y_m, POSITION)]);
        };
        match self.location {
            ContactLocation::Footprints { striking_x_world_m, striking_y_world_m } => {
                striking(striking_x_world_m, striking_y_world_m);
            }
            ContactLocation::Side { offset_m, .. } => {
                numbers.push(("offset_m", offset_m, CONTACT_OFFSET));
            }
            ContactLocation::Point {
                x_body_m,
                y_body_m,
                normal_body_rad,
                striking_x_world_m,
                striking_y_world_m,
            } => {
                striking(striking_x_world_m, striking_y_world_m);
                numbers.extend([
                    ("x_m", x_body_m, CONTACT_COORDINATE),
                    ("y_m", y_body_m, CONTACT_COORDINATE),
                    ("normal_rad", normal_body_rad, HEADING),
                ]);
            }
        }
        numbers
    }
}

impl Scenario {
    /// Every number of the scenario with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut numbers = vec![
            ("target_x_m".to_owned(), self.struck_x_world_m, POSITION),
            ("target_y_m".to_owned(), self.struck_y_world_m, POSITION),
        ];
        for (name, vehicle) in [("target", &self.struck), ("bullet", &self.striking)] {
            let skid = vehicle.skid.iter().flat_map(ScenarioSkid::ranges);
            let own = vehicle.ranges().into_iter().chain(skid);
            numbers.extend(own.map(|(key, value, range)| (format!("{name}.{key}"), value, range)));
        }
        let own = self.contact.ranges().into_iter();
        numbers.extend(own.map(|(key, value, range)| (format!("contact.{key}"), value, range)));
        for (name, ending) in [("ending", &self.ending), ("bullet_ending", &self.striking_ending)] {
            let own = ending.iter().flat_map(Ending::ranges);
            numbers.extend(own.map(|(key, value, range)| (format!("{name}.{key}"), value, range)));
        }
        let own = self.road.iter().flat_map(RoadSlope::ranges);
        numbers.extend(own.map(|(key, value, range)| (format!("road.{key}"), value, range)));
        numbers
    }

    /// Computes the poses of both vehicles, the contact point and the contact normal.
    ///
    /// # Errors
    /// [`ScenarioError::Footprint`] if the outlines make no contact or are out of range,
    /// [`ScenarioError::NormalPointsOut`] if a normal that the user gave points away from the CG of
    /// the struck vehicle.
    pub fn geometry(&self) -> Result<ScenarioGeometry, ScenarioError> {
        let struck = Pose {
            x_m: self.struck_x_world_m,
            y_m: self.struck_y_world_m,
            yaw_rad: self.struck.heading_rad,
        };
        let heading_rad = match self.striking.fixed {
            // Its outline is that of a square: no heading of its own may turn that.
            Some(FixedObject::Pole) => self.struck.heading_rad,
            Some(FixedObject::Wall) | None => self.striking.heading_rad,
        };
        let striking_at = |x_m, y_m| Pose { x_m, y_m, yaw_rad: heading_rad };
        let outlines = [self.struck.footprint(), self.striking.footprint()];
        let striking = match self.contact.location {
            ContactLocation::Footprints { striking_x_world_m, striking_y_world_m } => {
                striking_at(striking_x_world_m, striking_y_world_m)
            }
            ContactLocation::Side { side, offset_m }
                if self.striking.fixed == Some(FixedObject::Wall) =>
            {
                place_wall((&outlines[0], &struck), (side, offset_m), &outlines[1], heading_rad)
            }
            ContactLocation::Side { side, offset_m } => {
                place_touching(&outlines[0], &struck, side, offset_m, &outlines[1], heading_rad)?
            }
            ContactLocation::Point {
                x_body_m,
                y_body_m,
                normal_body_rad,
                striking_x_world_m,
                striking_y_world_m,
            } => {
                let (sin, cos) = normal_body_rad.sin_cos();
                if x_body_m * cos + y_body_m * sin > 0.0 {
                    let normal_deg = normal_body_rad.to_degrees();
                    return Err(ScenarioError::NormalPointsOut { normal_deg });
                }
                let contact_point_world_m = struck.world_from_body([x_body_m, y_body_m]);
                let striking = striking_at(striking_x_world_m, striking_y_world_m);
                for (which, outline, pose) in [
                    ("struck vehicle", outlines[0], &struck),
                    ("striking vehicle", outlines[1], &striking),
                ] {
                    outline
                        .check_contact(pose.body_from_world(contact_point_world_m))
                        .map_err(|source| ScenarioError::ContactOffOutline { which, source })?;
                }
                return Ok(ScenarioGeometry {
                    struck,
                    striking,
                    contact_point_world_m,
                    normal_angle_world_rad: struck.yaw_rad + normal_body_rad,
                    overlap_m: None,
                    surface: None,
                });
            }
        };
        let moving = |vehicle: &ScenarioVehicle, pose| MovingFootprint {
            footprint: vehicle.footprint(),
            pose,
            velocity_world_m_s: [vehicle.vx_world_m_s, vehicle.vy_world_m_s],
            yaw_rate_rad_s: vehicle.yaw_rate_rad_s,
        };
        let contact =
            find_contact(&moving(&self.struck, struck), &moving(&self.striking, striking))?;
        Ok(ScenarioGeometry {
            struck,
            striking,
            contact_point_world_m: contact.point_world_m,
            normal_angle_world_rad: contact.normal_angle_world_rad,
            overlap_m: Some(contact.depth_m),
            surface: Some(contact.surface),
        })
    }

    /// The planar impact of the two vehicles, ready to be solved, with a value for the restitution and
    /// the friction limit that the scenario leaves open. A friction that is given as a share of the
    /// critical impulse ratio is a friction limit here.
    ///
    /// # Errors
    /// The errors of [`Scenario::geometry`]; [`ScenarioError::NoCriticalRatio`].
    pub fn impact(&self) -> Result<Impact, ScenarioError> {
        let geometry = self.geometry()?;
        let point = geometry.contact_point_world_m;
        let mut impact = Impact {
            struck: self.struck.body(&geometry.struck, point),
            striking: self.striking.body(&geometry.striking, point),
            surface: ContactSurface {
                normal_angle_world_rad: geometry.normal_angle_world_rad,
                restitution: self.contact.restitution.unwrap_or_default(),
                restitution_form: self.contact.restitution_form,
                friction_limit: self.contact.friction_limit.unwrap_or(DEFAULT_FRICTION_LIMIT),
                friction_model: self.contact.friction_model,
            },
        };
        if self.contact.restitution.is_none() {
            impact.surface.restitution = default_restitution(impact.closing_speed_m_s());
        }
        if let Some(share) = self.contact.friction_of_critical
            && impact.closing_velocity_m_s()[0] > 0.0
        {
            let critical = impact.critical_impulse_ratio().ok_or(ScenarioError::NoCriticalRatio)?;
            impact.surface.friction_limit = share * critical;
        }
        Ok(impact)
    }

    /// Solves the impact for its impulse, the motion of both vehicles after it and the dissipated
    /// energy; see [`Impact::solve`].
    ///
    /// # Errors
    /// The errors of [`Scenario::impact`], and those of [`Impact::solve`] as
    /// [`ScenarioError::Impact`].
    pub fn solve(&self) -> Result<ImpactSolution, ScenarioError> {
        Ok(self.impact()?.solve()?)
    }
}
