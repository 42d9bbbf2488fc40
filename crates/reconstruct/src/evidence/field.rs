//! What a field of the evidence is: its key in a file, its name for a person, its range, and what stands in
//! where nobody states it.

use impactlab_core::collision::Side;
use impactlab_core::data::key_with_unit;
use impactlab_core::ranges::Range;
use impactlab_core::vehicle::Wheel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number with its standard deviation, both in the same unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// One standard deviation.
    pub sigma: f64,
}

/// A number as somebody states it. [`Sigma::resolve`] makes a [`Measured`] number of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Stated {
    /// The value; `None` until it is entered.
    pub value: Option<f64>,
    /// One standard deviation; `None` for that of the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
}

impl From<Measured> for Stated {
    fn from(Measured { value, sigma }: Measured) -> Self {
        Self { value: Some(value), sigma: Some(sigma) }
    }
}

/// Lower and upper end of a range; `None` for an end that is not entered yet.
pub type Bounds = [Option<f64>; 2];

/// Both ends of a range, once they are entered.
pub fn ends(bounds: Option<Bounds>) -> Option<[f64; 2]> {
    let [low, high] = bounds?;
    Some([low?, high?])
}

/// A number of an item.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// Key in a file, without its unit.
    pub key: &'static str,
    /// What a person calls it, in the window and in reports.
    pub label: &'static str,
    /// What is possible, with the quantity.
    pub range: Range,
    /// Whether the item says nothing without it.
    pub is_required: bool,
    /// What is taken where nobody states it; empty if nothing is, or if it is told elsewhere.
    pub default: &'static str,
    /// Whether a mirror on the X axis turns its sign.
    pub is_turned: bool,
    /// What is possible in words, where the range says too little; empty otherwise.
    pub expected: &'static str,
}

impl Field {
    /// A number that may be left out and that a mirror does not change.
    pub const fn new(key: &'static str, label: &'static str, range: Range) -> Self {
        let (is_required, is_turned) = (false, false);
        Self { key, label, range, is_required, default: "", is_turned, expected: "" }
    }

    /// The same, without which the item says nothing.
    #[must_use]
    pub const fn required(self) -> Self {
        self.required_if(true)
    }

    /// The same, required in some cases.
    #[must_use]
    pub const fn required_if(self, is_required: bool) -> Self {
        Self { is_required, ..self }
    }

    /// The same, whose sign a mirror on the X axis turns.
    #[must_use]
    pub const fn turned(self) -> Self {
        self.turned_if(true)
    }

    /// The same, whose sign a mirror turns in some cases.
    #[must_use]
    pub const fn turned_if(self, is_turned: bool) -> Self {
        Self { is_turned, ..self }
    }

    /// The same with what is taken where nobody states it.
    #[must_use]
    pub const fn with_default(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    /// The same with what is possible in words.
    #[must_use]
    pub const fn with_expected(self, expected: &'static str) -> Self {
        Self { expected, ..self }
    }

    /// Its key in a file with the SI unit.
    pub fn si_key(&self) -> String {
        self.si_key_with("")
    }

    /// The same of a number that belongs to it, such as its lower bound.
    pub fn si_key_with(&self, ending: &str) -> String {
        key_with_unit(&format!("{}{ending}", self.key), &self.range.quantity.si_unit())
    }
}

/// A standard deviation, which may be left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sigma {
    /// The number.
    pub field: Field,
    /// That of the program, as a share of the value.
    share: f64,
    /// The least that this is.
    least: f64,
    /// Where that of the program comes from.
    pub source: &'static str,
}

impl Sigma {
    /// A standard deviation that is the same for every value where nobody states it.
    pub const fn fixed(
        key: &'static str,
        label: &'static str,
        range: Range,
        default: f64,
        source: &'static str,
    ) -> Self {
        Self { field: Field::new(key, label, range), share: 0.0, least: default, source }
    }

    /// The share of the value that it is where nobody states it; `None` for a fixed one.
    pub fn relative(&self) -> Option<f64> {
        (self.share > 0.0).then_some(self.share)
    }

    /// A standard deviation that is a share of the value where nobody states it, and not below `least`.
    pub const fn share(
        key: &'static str,
        label: &'static str,
        range: Range,
        [share, least]: [f64; 2],
        source: &'static str,
    ) -> Self {
        Self { field: Field::new(key, label, range), share, least, source }
    }

    /// The standard deviation of the program.
    pub const fn default_at(&self, value: f64) -> f64 {
        (self.share * value).max(self.least)
    }

    /// A number with its standard deviation, that of the program where none is stated; `None` until the
    /// value is entered.
    pub fn resolve(&self, stated: Option<Stated>) -> Option<Measured> {
        let Stated { value, sigma } = stated?;
        let value = value?;
        Some(Measured { value, sigma: sigma.unwrap_or(self.default_at(value)) })
    }
}

/// A choice between words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// Key in a file.
    pub key: &'static str,
    /// What a person calls it.
    pub label: &'static str,
    /// Whether a file has to say it.
    pub is_required: bool,
    /// What it means for a person if nothing is chosen; empty where something always is.
    pub none: &'static str,
}

/// What can be chosen.
pub trait Word: Copy + PartialEq + 'static {
    /// All of them.
    const ALL: &'static [Self];
    /// Its word in a file.
    fn word(self) -> &'static str;
    /// What a person calls it.
    fn label(self) -> &'static str;
    /// What a mirror on the X axis shows.
    #[must_use]
    fn mirrored(self) -> Self {
        self
    }
}

impl Word for Wheel {
    const ALL: &'static [Self] = &Self::ALL;

    fn word(self) -> &'static str {
        ["FL", "FR", "RL", "RR"][self.index()]
    }

    fn label(self) -> &'static str {
        Self::label(self)
    }

    fn mirrored(self) -> Self {
        match self {
            Self::FrontLeft => Self::FrontRight,
            Self::FrontRight => Self::FrontLeft,
            Self::RearLeft => Self::RearRight,
            Self::RearRight => Self::RearLeft,
        }
    }
}

impl Word for Side {
    const ALL: &'static [Self] = &[Self::Left, Self::Right, Self::Front, Self::Rear];

    fn label(self) -> &'static str {
        self.word()
    }

    fn word(self) -> &'static str {
        self.name()
    }

    fn mirrored(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::ranges::{MASS_SIGMA, POSITION_SIGMA};

    #[test]
    fn a_standard_deviation_that_is_stated_stands_and_another_is_that_of_the_program() {
        let fixed = Sigma::fixed("sigma", "±", POSITION_SIGMA, 0.1, "");
        let share = Sigma::share("sigma", "±", MASS_SIGMA, [0.03, 10.0], "");
        let stated = |value, sigma| Some(Stated { value, sigma });
        let sigma = |rule: Sigma, stated| rule.resolve(stated).map(|resolved| resolved.sigma);
        assert_eq!(sigma(fixed, stated(Some(5.0), None)), Some(0.1));
        assert_eq!(sigma(fixed, stated(Some(5.0), Some(0.2))), Some(0.2));
        assert_eq!(sigma(share, stated(Some(1000.0), None)), Some(30.0));
        assert_eq!(sigma(share, stated(Some(100.0), None)), Some(10.0));
        assert_eq!(sigma(share, stated(None, Some(1.0))), None);
        assert_eq!(sigma(share, None), None);
    }
}
