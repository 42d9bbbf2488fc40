//! Friction and slope of the road. A peak friction is measured by itself, so that it is a part of the prior; the drag
//! factor of a car with locked wheels is what follows from it and from tires, and is compared.
//!
//! ```text
//! f = μ · f_tire · κ · d        d: sliding over peak friction, κ: friction along a wheel over across it
//! ```

use impactlab_core::ranges::{FRICTION_SIGMA, ROAD_CROSS_SLOPE, ROAD_FRICTION, ROAD_GRADE};
use impactlab_core::vehicle::RoadSlope;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Latent;
use crate::evidence::{Field, Fields, Group, Item, Measured, Section, Sigma, Stated};
use crate::likelihood::Comparison;

/// Peak friction of a road of which nothing was measured: dry and wet asphalt together. The dry
/// half is that of the data sheets of this program.
pub const DEFAULT_FRICTION: f64 = 0.72;
/// Its standard deviation.
pub const DEFAULT_FRICTION_SIGMA: f64 = 0.13;

/// The road in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "road",
    title: "friction of the road",
    group: Group::Scene,
    is_required: false,
    missing: "",
};

const FRICTION: Field = Field::new("friction", "peak friction", ROAD_FRICTION);
const SIGMA: Sigma = Sigma::fixed(
    "friction_sigma",
    "±",
    FRICTION_SIGMA,
    DEFAULT_FRICTION_SIGMA,
    "dry and wet asphalt together",
);

const DRAG_FACTOR: Field = Field::new("drag_factor", "drag factor, locked wheels", ROAD_FRICTION);
/// That of a drag factor, here and of a skid.
pub(super) const DRAG_FACTOR_SIGMA: Sigma = Sigma::fixed(
    "drag_factor_sigma",
    "±",
    FRICTION_SIGMA,
    // Skid tests of one car on one road differ by 5 to 7 %. `Brach2011`, drag factors.
    0.05,
    "skid tests with another car on the same road",
);

const GRADE: Field = Field::new("grade", "grade along X, uphill", ROAD_GRADE);
const CROSS_SLOPE: Field =
    Field::new("cross_slope", "cross slope, rising to the left", ROAD_CROSS_SLOPE).turned();

/// Friction and slope of the road.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Road {
    /// Peak friction; `None` until it is entered.
    pub value: Option<f64>,
    /// Its standard deviation; `None` for that of the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// Drag factor of a car whose wheels are locked, deceleration over that of gravity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drag_factor: Option<Stated>,
    /// Rise over run along X, positive uphill; level where nobody states it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grade: Option<f64>,
    /// Rise over run along Y, positive where the road rises to the left; likewise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cross_slope: Option<f64>,
}

impl Item for Road {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { value, sigma, drag_factor, grade, cross_slope } = self;
        let parts = Stated { value: *value, sigma: *sigma };
        let mut stated = Some(parts).filter(|stated| *stated != Stated::default());
        visitor.measured(&FRICTION, &SIGMA, &mut stated);
        let stated = stated.unwrap_or_default();
        (*value, *sigma) = (stated.value, stated.sigma);
        visitor.measured(&DRAG_FACTOR, &DRAG_FACTOR_SIGMA, drag_factor);
        visitor.number(&GRADE, grade);
        visitor.number(&CROSS_SLOPE, cross_slope);
    }
}

impl Road {
    /// Peak friction.
    pub fn friction(&self) -> Option<Measured> {
        SIGMA.resolve(Some(Stated { value: self.value, sigma: self.sigma }))
    }

    /// Drag factor of locked wheels.
    pub fn drag_factor(&self) -> Option<Measured> {
        DRAG_FACTOR_SIGMA.resolve(self.drag_factor)
    }

    /// Its slope; level where nobody states it.
    pub fn slope(&self) -> RoadSlope {
        let Self { grade, cross_slope, .. } = self;
        RoadSlope { grade: grade.unwrap_or(0.0), cross_slope: cross_slope.unwrap_or(0.0) }
    }

    pub(super) fn compare_drag(&self, comparison: &mut Comparison<'_>) {
        let Some(Measured { value, sigma }) = self.drag_factor() else { return };
        let expected = comparison.motion.values.locked_drag();
        let distance = ((value - expected) / sigma).powi(2);
        comparison.log_likelihood -= distance / 2.0;
        comparison.tell("drag factor of locked wheels", "", [expected, value], distance);
    }

    pub(super) fn compare(&self, comparison: &mut Comparison<'_>) {
        let expected = comparison.value(Latent::RoadFriction);
        comparison.tell_measured("road friction", "", self.friction(), expected);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_road_of_an_earlier_case_is_read_and_a_key_that_nobody_knows_is_refused() {
        let read = |json: &str| serde_json::from_str::<Road>(json);
        let road = read(r#"{"value": 0.7, "sigma": 0.05}"#).unwrap();
        assert_eq!(road.friction(), Some(Measured { value: 0.7, sigma: 0.05 }));
        assert_eq!(road.drag_factor(), None);
        let error = read(r#"{"value": 0.7, "sgima": 0.05}"#).unwrap_err().to_string();
        assert!(error.contains("sgima"), "{error}");
    }
}
