//! The slope of the road on which a vehicle moves.
//!
//! ```text
//! z = a X + b Y                         a: grade along X, b: cross slope along Y
//! g_X = −g a / n    g_Y = −g b / n      n = √(1 + a² + b²)
//! Σ F_z = m g / n
//! ```
//!
//! X and Y are measured in the plane of the road. The weight acts at the CG, so that it transfers no
//! load by itself: the tire forces that hold against it do.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{TomlError, TomlTable};
use crate::ranges::{ROAD_CROSS_SLOPE, ROAD_GRADE, Range};
use crate::units::STANDARD_GRAVITY_M_S2;

/// Grade or cross slope in size beyond which nothing that the program was compared with has been.
pub const USUAL_SLOPE: f64 = 0.1;

/// Slope of the road in world axes; level by default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RoadSlope {
    /// Rise over run along X, −0.3 to 0.3; positive where the road climbs along X.
    pub grade: f64,
    /// Rise over run along Y, −0.3 to 0.3; positive where the road rises to the left of X.
    pub cross_slope: f64,
}

impl RoadSlope {
    /// Whether the road is level.
    pub fn is_level(&self) -> bool {
        self.grade == 0.0 && self.cross_slope == 0.0
    }

    /// Whether it is as steep as the roads on which the program was never compared with anything.
    pub fn is_unusual(&self) -> bool {
        self.grade.abs().max(self.cross_slope.abs()) > USUAL_SLOPE
    }

    /// Acceleration `[g_X, g_Y]` by the weight along the road, m/s².
    pub fn gravity_m_s2(&self) -> [f64; 2] {
        let down = -STANDARD_GRAVITY_M_S2 * self.normal_share();
        [down * self.grade, down * self.cross_slope]
    }

    /// Share of the weight that presses on the road.
    pub fn normal_share(&self) -> f64 {
        let Self { grade, cross_slope } = self;
        1.0 / (1.0 + grade * grade + cross_slope * cross_slope).sqrt()
    }

    /// Grade in a direction of travel.
    ///
    /// - `direction_rad`: from X, counter-clockwise, rad.
    pub fn along(&self, direction_rad: f64) -> f64 {
        let (sin, cos) = direction_rad.sin_cos();
        self.grade * cos + self.cross_slope * sin
    }

    /// Reads a section `[road]` with `grade` and `cross_slope`, or `grade_percent` and
    /// `cross_slope_percent`.
    ///
    /// # Errors
    /// [`TomlError`] if a key is unknown or out of range, or if there is none.
    pub fn read(mut section: TomlTable<'_>) -> Result<Self, TomlError> {
        let grade = section.number("grade", &ROAD_GRADE)?;
        let cross_slope = section.number("cross_slope", &ROAD_CROSS_SLOPE)?;
        if grade.or(cross_slope).is_none() {
            return Err(section.missing("grade (or cross_slope)"));
        }
        section.finish()?;
        Ok(Self { grade: grade.unwrap_or(0.0), cross_slope: cross_slope.unwrap_or(0.0) })
    }

    /// The keys and values of a section from which [`RoadSlope::read`] reads the same.
    pub fn entries(&self) -> [(&'static str, f64); 2] {
        [("grade", self.grade), ("cross_slope", self.cross_slope)]
    }

    /// Both numbers with their names and ranges.
    pub fn ranges(&self) -> [(&'static str, f64, Range); 2] {
        [("grade", self.grade, ROAD_GRADE), ("cross_slope", self.cross_slope, ROAD_CROSS_SLOPE)]
    }
}

#[cfg(test)]
#[path = "road_slope_tests.rs"]
mod tests;
