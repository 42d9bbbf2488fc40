//! The methods by hand, each with all that is said of it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hand::values::HandValues;
use crate::hand::{HandField, airborne, crush, momentum, slide, time_distance, yaw_mark};
use impactlab_core::units::{Phrase, Quantity};

/// A method by hand.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::VariantArray,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum HandMethod {
    /// Momentum of two vehicles that meet in one line.
    MomentumInLine,
    /// Momentum of two vehicles that meet at an angle: both speeds before the impact.
    #[default]
    Momentum,
    /// Crush energy from stiffness and depths of crush, with the change of velocity.
    CrushEnergy,
    /// Speed at the start of a spin-out to rest.
    SpinOut,
    /// Critical speed from a yaw mark.
    YawMark,
    /// Speed at the start of a skid over one or several surfaces.
    Skid,
    /// Speed at take-off of a vehicle that flew.
    Airborne,
    /// Whether braking would have avoided the collision.
    TimeDistance,
}

/// A number that a method gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HandOutput {
    /// Its key with its SI unit.
    pub key: &'static str,
    /// What a person calls it.
    pub label: &'static str,
    /// What it measures.
    pub quantity: Quantity,
}

/// All that is said of a method.
#[derive(Debug)]
pub(super) struct Formula {
    /// What a person calls it.
    pub label: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Under which conditions it holds, in English and in German.
    pub holds: [&'static str; 2],
    /// Its sources.
    pub sources: &'static [&'static str],
    /// Its inputs.
    pub fields: &'static [HandField],
    /// Its outputs, the one that it is asked for first.
    pub outputs: &'static [HandOutput],
    /// Computes the outputs in their order; NaN for one that does not follow.
    pub solve: fn(&HandValues<'_>) -> Vec<f64>,
    /// Why the inputs do not go together.
    pub refuse: fn(&HandValues<'_>) -> Option<&'static str>,
    /// Which of its conditions inputs and outputs violate.
    pub warn: fn(&HandValues<'_>, &[f64]) -> Vec<Phrase>,
}

/// Share of the draws from which on it is told that they violate a condition: as many lie beyond an end of an
/// interval of 90 %.
const TOLD_SHARE: f64 = 0.05;

impl Formula {
    /// Which share of the draws violates a condition, with what is said of the first one that does; none where
    /// it is small.
    ///
    /// - `at`: the inputs at their values;
    /// - `drawn`: the outputs of each draw.
    pub fn violated_in_draws(
        &self,
        at: &HandValues<'_>,
        drawn: &[Vec<f64>],
    ) -> Option<(f64, Phrase)> {
        let said = drawn.iter().filter_map(|outputs| (self.warn)(at, outputs).into_iter().next());
        let said: Vec<Phrase> = said.collect();
        let share = said.len() as f64 / drawn.len().max(1) as f64;
        let first = said.into_iter().next().filter(|_| share >= TOLD_SHARE)?;
        Some((share, first))
    }
}

impl HandMethod {
    /// Every method.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    pub(super) fn formula(self) -> &'static Formula {
        match self {
            Self::MomentumInLine => &momentum::IN_LINE,
            Self::Momentum => &momentum::AT_ANGLES,
            Self::CrushEnergy => &crush::CRUSH_ENERGY,
            Self::SpinOut => &slide::SPIN_OUT,
            Self::YawMark => &yaw_mark::YAW_MARK,
            Self::Skid => &slide::SKID,
            Self::Airborne => &airborne::AIRBORNE,
            Self::TimeDistance => &time_distance::TIME_DISTANCE,
        }
    }

    /// Its word on the command line.
    pub fn word(self) -> String {
        let name: &'static str = self.into();
        name.replace('_', "-")
    }

    /// What a person calls it.
    pub fn label(self) -> &'static str {
        self.formula().label
    }

    /// Its equation.
    pub fn equation(self) -> &'static str {
        self.formula().equation
    }

    /// Under which conditions it holds.
    pub fn holds(self) -> Phrase {
        let [en, de] = self.formula().holds;
        Phrase::new(en, de)
    }

    /// Its sources.
    pub fn sources(self) -> &'static [&'static str] {
        self.formula().sources
    }

    /// Its inputs.
    pub fn fields(self) -> &'static [HandField] {
        self.formula().fields
    }

    /// Its outputs, the one that it is asked for first.
    pub fn outputs(self) -> &'static [HandOutput] {
        self.formula().outputs
    }

    /// Whether it takes points of a mark.
    pub fn takes_points(self) -> bool {
        self == Self::YawMark
    }
}

/// Nothing refuses the inputs of a method.
pub(super) fn accept(_: &HandValues<'_>) -> Option<&'static str> {
    None
}

/// Phrases of the conditions that are violated.
pub(super) fn violated<const N: usize>(conditions: [(bool, Phrase); N]) -> Vec<Phrase> {
    let violated = conditions.into_iter().filter(|(is_violated, _)| *is_violated);
    violated.map(|(_, phrase)| phrase).collect()
}
