//! The attributes of a case that the physics needs, taken from the columns of `cases.csv` by name.
//! The names end in the SI unit.

use serde::{Deserialize, Serialize};

use crate::data::{Attributes, DataError, DatasetKind};

const NO_COLLISION: &str = "the collision cannot be computed";
const NO_MOTION: &str = "the motion cannot be simulated";

/// The side of the target that is struck, as seen by its driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StruckSide {
    /// The left side of the target, +y in its body axes.
    Left,
    /// The right side of the target, −y in its body axes.
    Right,
}

/// The attributes of a case of a force data set: two vehicles at the instant of first contact. The
/// X axis of the world points along the heading of the target, Y to its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceAttributes {
    /// Masses of the target and of the bullet, kg.
    pub mass_kg: [f64; 2],
    /// Yaw moments of inertia of the target and of the bullet, kg m²; `None` where the table does
    /// not give one.
    pub yaw_inertia_kg_m2: [Option<f64>; 2],
    /// Velocity `[x, y]` of the centre of gravity of the target, world axes, m/s.
    pub target_velocity_m_s: [f64; 2],
    /// Velocity `[x, y]` of the centre of gravity of the bullet, world axes, m/s.
    pub bullet_velocity_m_s: [f64; 2],
    /// Heading of the bullet relative to that of the target, rad, counter-clockwise positive.
    pub theta_b_rad: f64,
    /// Point of first contact `[x, y]` in the body axes of the target, from its centre of gravity,
    /// m.
    pub contact_m: [f64; 2],
    /// Height of the point of first contact above the road, m.
    pub contact_height_m: Option<f64>,
    /// The struck side of the target.
    pub side: Option<StruckSide>,
    /// Whether a corner of the bullet stays hooked to the target.
    pub hooked: Option<bool>,
    /// Whether the vehicles are separated at the end of the record.
    pub separated: Option<bool>,
}

/// The attributes of a case of a trajectory data set: one vehicle that is struck while it is
/// driving.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryAttributes {
    /// Speed before the impact, m/s.
    pub speed_m_s: f64,
    /// Peak coefficient of lateral friction of the tires.
    pub mu: f64,
    /// Point of application of the force, `[x, y]` in body axes from the centre of gravity, m.
    pub contact_m: [f64; 2],
    /// Height of the point of application above the road, m.
    pub contact_height_m: f64,
    /// The struck side of the vehicle.
    pub side: Option<StruckSide>,
    /// Whether the vehicle turns by more than 90°.
    pub spin: Option<bool>,
    /// Whether the vehicles were separated when the record of the force ended.
    pub separated: Option<bool>,
}

impl ForceAttributes {
    /// The columns without which [`ForceAttributes::read`] fails.
    pub const NEEDED: &'static [&'static str] = &[
        "m_t_kg",
        "m_b_kg",
        "v_tx_m_s",
        "v_ty_m_s",
        "v_bx_m_s",
        "v_by_m_s",
        "theta_b_rad",
        "contact_x_m",
        "contact_y_m",
    ];

    /// Reads the attributes of a force case from its row.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] if a needed column is missing or blank, and
    /// [`DataError::Cell`] if it holds text.
    pub fn read(attributes: &Attributes) -> Result<Self, DataError> {
        let need = |name| attributes.require(name, NO_COLLISION);
        Ok(Self {
            mass_kg: [need("m_t_kg")?, need("m_b_kg")?],
            yaw_inertia_kg_m2: ["izz_t_kg_m2", "izz_b_kg_m2"].map(|name| attributes.number(name)),
            target_velocity_m_s: [need("v_tx_m_s")?, need("v_ty_m_s")?],
            bullet_velocity_m_s: [need("v_bx_m_s")?, need("v_by_m_s")?],
            theta_b_rad: need("theta_b_rad")?,
            contact_m: [need("contact_x_m")?, need("contact_y_m")?],
            contact_height_m: attributes.number("contact_z_m"),
            side: side(attributes),
            hooked: attributes.flag("hooked"),
            separated: attributes.flag("separated"),
        })
    }
}

impl TrajectoryAttributes {
    /// The columns without which [`TrajectoryAttributes::read`] fails.
    pub const NEEDED: &'static [&'static str] =
        &["speed_m_s", "mu", "contact_x_m", "contact_y_m", "contact_height_m"];

    /// Reads the attributes of a trajectory case from its row.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] if a needed column is missing or blank, and
    /// [`DataError::Cell`] if it holds text.
    pub fn read(attributes: &Attributes) -> Result<Self, DataError> {
        let need = |name| attributes.require(name, NO_MOTION);
        Ok(Self {
            speed_m_s: need("speed_m_s")?,
            mu: need("mu")?,
            contact_m: [need("contact_x_m")?, need("contact_y_m")?],
            contact_height_m: need("contact_height_m")?,
            side: side(attributes),
            spin: attributes.flag("spin"),
            separated: attributes.flag("fe_separated"),
        })
    }
}

impl DatasetKind {
    /// The columns of `cases.csv` without which the physics of such a case cannot be computed.
    pub fn needed_attributes(self) -> &'static [&'static str] {
        match self {
            Self::Force => ForceAttributes::NEEDED,
            Self::Trajectory => TrajectoryAttributes::NEEDED,
        }
    }

    /// What cannot be computed if a needed column is missing, for an error message.
    pub(crate) fn consequence(self) -> &'static str {
        match self {
            Self::Force => NO_COLLISION,
            Self::Trajectory => NO_MOTION,
        }
    }
}

fn side(attributes: &Attributes) -> Option<StruckSide> {
    match attributes.text("side")?.to_ascii_lowercase().as_str() {
        "left" => Some(StruckSide::Left),
        "right" => Some(StruckSide::Right),
        _ => None,
    }
}
