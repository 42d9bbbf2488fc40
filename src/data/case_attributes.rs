//! The attributes that the physics needs, with their units.

use serde::{Deserialize, Serialize};

use crate::data::{Attributes, DataError, DatasetKind};

const NO_COLLISION: &str = "the collision cannot be computed";
const NO_MOTION: &str = "the motion cannot be simulated";

/// The side of the target that is struck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StruckSide {
    /// Left.
    Left,
    /// Right.
    Right,
}

/// A case of a force data set: two vehicles at first contact. World axes: X along the target's
/// heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceAttributes {
    /// Masses of target and bullet, kg.
    pub mass_kg: [f64; 2],
    /// Yaw inertias of target and bullet, kg m², where they are given.
    pub yaw_inertia_kg_m2: [Option<f64>; 2],
    /// Velocity `[x, y]` of the target's CG, m/s.
    pub target_velocity_m_s: [f64; 2],
    /// Velocity `[x, y]` of the bullet's CG, m/s.
    pub bullet_velocity_m_s: [f64; 2],
    /// Heading of the bullet against the target's, rad.
    pub theta_b_rad: f64,
    /// First contact `[x, y]` in the target's body axes from its CG, m.
    pub contact_m: [f64; 2],
    /// Height of the first contact above the road, m.
    pub contact_height_m: Option<f64>,
    /// The struck side.
    pub side: Option<StruckSide>,
    /// Whether the bullet's corner stays caught.
    pub hooked: Option<bool>,
    /// Whether the vehicles have separated at the end.
    pub separated: Option<bool>,
}

/// A case of a trajectory data set: one vehicle, struck while it rolls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryAttributes {
    /// Speed before the impact, m/s.
    pub speed_m_s: f64,
    /// Peak lateral friction coefficient of the tires.
    pub mu: f64,
    /// Where the force acts, `[x, y]` in body axes from the CG, m.
    pub contact_m: [f64; 2],
    /// Height above the road at which it acts, m.
    pub contact_height_m: f64,
    /// The struck side.
    pub side: Option<StruckSide>,
    /// Whether the vehicle turns by more than 90°.
    pub spin: Option<bool>,
    /// Whether the vehicles had separated when the recorded force ended.
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

    /// Takes them out of a row.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] or [`DataError::Cell`] at a needed column.
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

    /// Takes them out of a row.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] or [`DataError::Cell`] at a needed column.
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
    /// The columns of `cases.csv` that the physics needs.
    pub fn needed_attributes(self) -> &'static [&'static str] {
        match self {
            Self::Force => ForceAttributes::NEEDED,
            Self::Trajectory => TrajectoryAttributes::NEEDED,
        }
    }

    /// What cannot be done without them.
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
