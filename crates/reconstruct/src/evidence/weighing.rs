//! One scale that weighed both cars: an error that both masses share. It is a quantity of the prior.

use impactlab_core::ranges::SCALE_SIGMA;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{Field, Fields, Group, Item, Section};

/// The scale in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "weighing",
    title: "one scale for both cars",
    group: Group::Cars,
    is_required: false,
    missing: "",
};

const SHARED_SCALE_SIGMA: Field =
    Field::new("shared_scale_sigma", "error of the scale, as a share", SCALE_SIGMA).required();

/// A scale that weighed both cars. The standard deviation of each mass is that of its other errors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Weighing {
    /// Error of the scale, as a share of what it shows.
    pub shared_scale_sigma: Option<f64>,
}

impl Item for Weighing {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { shared_scale_sigma } = self;
        visitor.number(&SHARED_SCALE_SIGMA, shared_scale_sigma);
    }
}
