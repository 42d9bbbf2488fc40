//! The steering of a trajectory case: the columns `steering`, `steering_start_s`, `steering_rad` and
//! `steering_rate_rad_s` of `cases.csv`.
//!
//! ```text
//! steering              none or blank: the front wheels are straight ahead; held: they turn to an angle
//! steering_start_s      when they begin to turn
//! steering_rad          the angle that is held, positive to the left
//! steering_rate_rad_s   how fast they turn
//! ```

use crate::data::{AttributeColumn, Attributes, DataError};
use crate::ranges::{CONTROL_TIME, ROAD_WHEEL_RATE, STEER_ANGLE};

const NO_STEERING: &str = "the steering of the case cannot be followed";

const KIND: &str = "steering";
const START: AttributeColumn = AttributeColumn::needed("steering_start_s", CONTROL_TIME);
const ANGLE: AttributeColumn = AttributeColumn::needed("steering_rad", STEER_ANGLE);
const RATE: AttributeColumn = AttributeColumn::needed("steering_rate_rad_s", ROAD_WHEEL_RATE);

/// The front wheels of a case turn to an angle that is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseSteering {
    /// When they begin to turn, s.
    pub start_s: f64,
    /// The angle that is held, rad, positive to the left.
    pub angle_rad: f64,
    /// How fast they turn, rad/s.
    pub rate_rad_s: f64,
}

impl CaseSteering {
    /// Reads what a row says; `None` for wheels that stay straight ahead.
    ///
    /// # Errors
    /// [`DataError::MissingAttribute`] and [`DataError::Attribute`] if a column is missing or a cell holds
    /// something else than the module documentation says.
    pub fn read(attributes: &Attributes) -> Result<Option<Self>, DataError> {
        match attributes.text(KIND).map(str::trim) {
            None | Some("none" | "no") => return Ok(None),
            Some("held") => {}
            Some(other) => {
                let expected = "none or held".to_owned();
                return Err(attributes.refused(KIND, format!("{other:?}"), expected));
            }
        }
        let need = |column| attributes.require(column, NO_STEERING);
        let [start_s, angle_rad, rate_rad_s] = [need(&START)?, need(&ANGLE)?, need(&RATE)?];
        Ok((angle_rad != 0.0).then_some(Self { start_s, angle_rad, rate_rad_s }))
    }

    /// When the angle is reached, s.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.angle_rad.abs() / self.rate_rad_s
    }
}
