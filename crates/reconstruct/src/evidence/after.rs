//! What driver and damage did to the wheels after the impact: it decides what the forward model leaves open.

use impactlab_core::vehicle::Wheel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{Choice, Fields, Group, Item, Section, Word};

/// What happened after the impact in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "after",
    title: "after the impact",
    group: Group::Cars,
    is_required: false,
    missing: "",
};

const DRIVER_BRAKED: Choice =
    Choice { key: "driver_braked", label: "driver braked", is_required: false, none: "" };
const BLOCKED_WHEELS: Choice = Choice {
    key: "blocked_wheels",
    label: "blocked wheels",
    is_required: false,
    none: "nobody looked",
};

/// Whether the driver braked after the impact.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum DriverBraked {
    /// He did.
    Yes,
    /// He did not.
    No,
    /// Nobody knows.
    #[default]
    Unknown,
}

impl Word for DriverBraked {
    const ALL: &'static [Self] = &[Self::Yes, Self::No, Self::Unknown];

    fn word(self) -> &'static str {
        self.into()
    }

    fn label(self) -> &'static str {
        match self {
            Self::Unknown => "not known",
            other => other.word(),
        }
    }
}

/// What driver and damage did to the wheels after the impact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct After {
    /// Wheels that were found blocked; `None` if nobody looked, so that each wheel near the damage may
    /// be.
    pub blocked_wheels: Option<Vec<Wheel>>,
    /// Whether the driver braked.
    pub driver_braked: DriverBraked,
}

impl Item for After {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { blocked_wheels, driver_braked } = self;
        visitor.choice(&DRIVER_BRAKED, driver_braked);
        visitor.choices(&BLOCKED_WHEELS, blocked_wheels);
    }
}
