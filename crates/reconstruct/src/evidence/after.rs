//! What driver and damage did to the wheels of a car after the impact: it decides what the forward model
//! leaves open.

use impactlab_core::vehicle::Wheel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{Choice, Fields, Group, Item, Section, Word};

/// What happened to the struck car after the impact in a file, a form and a report.
pub const STRUCK: Section = Section {
    key: "after",
    title: "after the impact",
    group: Group::Cars,
    is_required: false,
    missing: "",
};
/// What happened to the striking car, likewise.
pub const STRIKING: Section =
    Section { key: "striking_after", title: "striking car after the impact", ..STRUCK };
/// What driver and wheels of a single car did from the start to rest, likewise.
pub const SINGLE: Section = Section { key: "wheels", title: "driver and wheels", ..STRUCK };

const DRIVER_BRAKED: Choice =
    Choice { key: "driver_braked", label: "driver braked", is_required: false, none: "" };
const ANTI_LOCK: Choice =
    Choice { key: "anti_lock", label: "anti-lock brakes (ABS)", is_required: false, none: "" };
const BLOCKED_WHEELS: Choice = Choice {
    key: "blocked_wheels",
    label: "blocked wheels",
    is_required: false,
    none: "nobody looked",
};
const DRAGGING_WHEELS: Choice = Choice {
    key: "dragging_wheels",
    label: "wheels that drag",
    is_required: false,
    none: "none that is known",
};

/// Whether something was so.
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
pub enum YesNoUnknown {
    /// It was.
    Yes,
    /// It was not.
    No,
    /// Nobody knows.
    #[default]
    Unknown,
}

impl YesNoUnknown {
    /// Whether nobody knows.
    pub fn is_unknown(&self) -> bool {
        *self == Self::Unknown
    }
}

impl Word for YesNoUnknown {
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

/// What driver and damage did to the wheels of a car after the impact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct After {
    /// Wheels that were found blocked; `None` if nobody looked, so that each wheel near the damage may
    /// be.
    pub blocked_wheels: Option<Vec<Wheel>>,
    /// Wheels that turn, but are held back by the damage; `None` if none is known.
    pub dragging_wheels: Option<Vec<Wheel>>,
    /// Whether the driver braked.
    pub driver_braked: YesNoUnknown,
    /// Whether the brakes have an anti-lock system that works: the slip of braked wheels stays near the peak
    /// of the friction. Without it wheels that are braked beyond what the road holds lock and slide.
    #[serde(skip_serializing_if = "YesNoUnknown::is_unknown")]
    pub anti_lock: YesNoUnknown,
}

impl Item for After {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { blocked_wheels, dragging_wheels, driver_braked, anti_lock } = self;
        visitor.choice(&DRIVER_BRAKED, driver_braked);
        visitor.choice(&ANTI_LOCK, anti_lock);
        visitor.choices(&BLOCKED_WHEELS, blocked_wheels);
        visitor.choices(&DRAGGING_WHEELS, dragging_wheels);
    }
}

impl After {
    /// Whether somebody has looked which wheels are held.
    pub fn wheels_are_known(&self) -> bool {
        self.blocked_wheels.is_some() || self.dragging_wheels.is_some()
    }

    /// Whether all four wheels were found locked.
    pub fn is_all_locked(&self) -> bool {
        let blocked = self.blocked_wheels.as_deref().unwrap_or_default();
        Wheel::ALL.iter().all(|wheel| blocked.contains(wheel))
    }
}
