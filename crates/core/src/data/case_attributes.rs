//! The attributes of a case that the physics needs, taken from the columns of `cases.csv` by name.
//! The names end in the SI unit.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{Attributes, CaseBraking, CaseSteering, DataError, DatasetKind};
use crate::ranges::{
    BODY_MASS, BODY_YAW_INERTIA, CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, HEADING, ROAD_FRICTION,
    Range, SPEED, STRIKING_OFFSET, YAW_RATE,
};

const NO_COLLISION: &str = "the collision cannot be computed";
const NO_MOTION: &str = "the motion cannot be simulated";

/// A column of `cases.csv` from which the physics takes a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttributeColumn {
    /// Header of the column.
    pub name: &'static str,
    /// Values that the numbers in it may have.
    pub range: Range,
    /// Whether the physics of a case cannot be computed without the number. In a column that is
    /// not needed, a cell may be blank.
    pub is_needed: bool,
}

impl AttributeColumn {
    /// A column without which the physics of a case cannot be computed.
    pub const fn needed(name: &'static str, range: Range) -> Self {
        Self { name, range, is_needed: true }
    }

    /// A column that may be missing or have blank cells.
    pub const fn optional(name: &'static str, range: Range) -> Self {
        Self { name, range, is_needed: false }
    }
}

const M_T: AttributeColumn = AttributeColumn::needed("m_t_kg", BODY_MASS);
const M_B: AttributeColumn = AttributeColumn::needed("m_b_kg", BODY_MASS);
const V_TX: AttributeColumn = AttributeColumn::needed("v_tx_m_s", SPEED);
const V_TY: AttributeColumn = AttributeColumn::needed("v_ty_m_s", SPEED);
const V_BX: AttributeColumn = AttributeColumn::needed("v_bx_m_s", SPEED);
const V_BY: AttributeColumn = AttributeColumn::needed("v_by_m_s", SPEED);
const THETA_B: AttributeColumn = AttributeColumn::needed("theta_b_rad", HEADING);
const AT_X: AttributeColumn = AttributeColumn::needed("contact_x_m", CONTACT_X);
const AT_Y: AttributeColumn = AttributeColumn::needed("contact_y_m", CONTACT_Y);
const AT_Z: AttributeColumn = AttributeColumn::optional("contact_z_m", CONTACT_HEIGHT);
const IZZ_T: AttributeColumn = AttributeColumn::optional("izz_t_kg_m2", BODY_YAW_INERTIA);
const IZZ_B: AttributeColumn = AttributeColumn::optional("izz_b_kg_m2", BODY_YAW_INERTIA);
const NORMAL: AttributeColumn = AttributeColumn::optional("contact_normal_rad", HEADING);
const R_T: AttributeColumn = AttributeColumn::optional("target_yaw_rate_rad_s", YAW_RATE);
const R_B: AttributeColumn = AttributeColumn::optional("bullet_yaw_rate_rad_s", YAW_RATE);
const STRIKING_X: AttributeColumn = AttributeColumn::optional("bullet_x0_m", STRIKING_OFFSET);
const STRIKING_Y: AttributeColumn = AttributeColumn::optional("bullet_y0_m", STRIKING_OFFSET);
const SPEED_BEFORE: AttributeColumn = AttributeColumn::needed("speed_m_s", SPEED);
const MU: AttributeColumn = AttributeColumn::needed("mu", ROAD_FRICTION);
const HEIGHT: AttributeColumn = AttributeColumn::needed("contact_height_m", CONTACT_HEIGHT);

const FORCE_COLUMNS: &[AttributeColumn] = &[
    M_T, M_B, V_TX, V_TY, V_BX, V_BY, THETA_B, AT_X, AT_Y, AT_Z, NORMAL, IZZ_T, IZZ_B, R_T, R_B,
    STRIKING_X, STRIKING_Y,
];

const TRAJECTORY_COLUMNS: &[AttributeColumn] = &[SPEED_BEFORE, MU, AT_X, AT_Y, HEIGHT];

/// The side on which the struck vehicle is hit, as seen by its driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum StruckSide {
    /// The left side of the struck vehicle, +y in its body axes.
    Left,
    /// The right side of the struck vehicle, −y in its body axes.
    Right,
}

/// The attributes of a case of a force data set: two vehicles at the instant of first contact. The
/// X axis of the world points along the heading of the struck vehicle, Y to its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceAttributes {
    /// Masses of the struck vehicle and of the striking vehicle, kg.
    pub mass_kg: [f64; 2],
    /// Yaw moments of inertia of the struck vehicle and of the striking vehicle, kg m²; `None`
    /// where the table does not give one.
    pub yaw_inertia_kg_m2: [Option<f64>; 2],
    /// Velocity `[x, y]` of the centre of gravity of the struck vehicle, world axes, m/s.
    pub struck_velocity_m_s: [f64; 2],
    /// Velocity `[x, y]` of the centre of gravity of the striking vehicle, world axes, m/s.
    pub striking_velocity_m_s: [f64; 2],
    /// Yaw rates of the struck and of the striking vehicle, rad/s, counter-clockwise positive; 0 where
    /// the table does not give one.
    pub yaw_rate_rad_s: [f64; 2],
    /// Heading of the striking vehicle relative to that of the struck vehicle, rad,
    /// counter-clockwise positive.
    pub theta_b_rad: f64,
    /// Point of first contact `[x, y]` in the body axes of the struck vehicle, from its centre of
    /// gravity, m.
    pub contact_m: [f64; 2],
    /// Height of the point of first contact above the road, m.
    pub contact_height_m: Option<f64>,
    /// Direction of the contact normal, which points into the struck vehicle, from its heading, rad,
    /// counter-clockwise positive: 0 for a blow from behind.
    pub contact_normal_rad: Option<f64>,
    /// The side on which the struck vehicle is hit.
    pub side: Option<StruckSide>,
    /// Whether a corner of the striking vehicle stays hooked to the struck vehicle.
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
    /// What brakes the wheels; `None` for a vehicle that coasts.
    pub braking: Option<CaseBraking>,
    /// How the front wheels turn; `None` if they stay straight ahead.
    pub steering: Option<CaseSteering>,
}

impl ForceAttributes {
    /// Reads the attributes of a force case from its row.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] if a needed column is missing, and [`DataError::Attribute`]
    /// if a cell is blank though it is needed, or holds text or a number out of range.
    pub fn read(attributes: &Attributes) -> Result<Self, DataError> {
        let need = |column| attributes.require(column, NO_COLLISION);
        let known = |column| attributes.optional(column);
        Ok(Self {
            mass_kg: [need(&M_T)?, need(&M_B)?],
            yaw_inertia_kg_m2: [known(&IZZ_T)?, known(&IZZ_B)?],
            struck_velocity_m_s: [need(&V_TX)?, need(&V_TY)?],
            striking_velocity_m_s: [need(&V_BX)?, need(&V_BY)?],
            yaw_rate_rad_s: [known(&R_T)?.unwrap_or(0.0), known(&R_B)?.unwrap_or(0.0)],
            theta_b_rad: need(&THETA_B)?,
            contact_m: [need(&AT_X)?, need(&AT_Y)?],
            contact_height_m: known(&AT_Z)?,
            contact_normal_rad: known(&NORMAL)?,
            side: side(attributes),
            hooked: attributes.flag("hooked"),
            separated: attributes.flag("separated"),
        })
    }
}

impl TrajectoryAttributes {
    /// Reads the attributes of a trajectory case from its row.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] if a needed column is missing, and [`DataError::Attribute`]
    /// if a cell is blank though it is needed, or holds text or a number out of range.
    pub fn read(attributes: &Attributes) -> Result<Self, DataError> {
        let need = |column| attributes.require(column, NO_MOTION);
        Ok(Self {
            speed_m_s: need(&SPEED_BEFORE)?,
            mu: need(&MU)?,
            contact_m: [need(&AT_X)?, need(&AT_Y)?],
            contact_height_m: need(&HEIGHT)?,
            side: side(attributes),
            spin: attributes.flag("spin"),
            separated: attributes.flag("fe_separated"),
            braking: CaseBraking::read(attributes)?,
            steering: CaseSteering::read(attributes)?,
        })
    }
}

impl DatasetKind {
    /// The columns of `cases.csv` from which the physics of such a case takes numbers.
    pub fn columns(self) -> &'static [AttributeColumn] {
        match self {
            Self::Force => FORCE_COLUMNS,
            Self::Trajectory => TRAJECTORY_COLUMNS,
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
