//! Friction of the road. It is measured by itself, so that it is a part of the prior.

use impactlab_core::ranges::{FRICTION_SIGMA, ROAD_FRICTION};
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

/// Friction of the road.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Road {
    /// Peak friction, as stated.
    pub friction: Stated,
}

impl Item for Road {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { friction } = self;
        let mut stated = Some(*friction).filter(|stated| *stated != Stated::default());
        visitor.measured(&FRICTION, &SIGMA, &mut stated);
        *friction = stated.unwrap_or_default();
    }
}

impl Road {
    /// Peak friction.
    pub fn friction(&self) -> Option<Measured> {
        SIGMA.resolve(Some(self.friction))
    }

    pub(super) fn compare(&self, comparison: &mut Comparison<'_>) {
        let expected = comparison.value(Latent::RoadFriction);
        comparison.tell_measured("road friction", "", self.friction(), expected);
    }
}
