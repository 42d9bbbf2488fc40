//! A number that a method by hand takes: key, label, range, default and standard deviation in one place.

use impactlab_core::data::key_with_unit;
use impactlab_core::ranges::Range;
use impactlab_core::units::Quantity;

/// Key of the points of a mark.
pub(super) const POINTS: &str = "points_m";

/// A number that a method takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandField {
    /// Its key, without a unit.
    pub key: &'static str,
    /// What a person calls it.
    pub label: &'static str,
    /// What is possible, with the quantity.
    pub range: Range,
    /// What holds where nothing is entered.
    pub default: HandDefault,
    /// Key of the input beside which alone it has a meaning.
    pub(super) needs: Option<&'static str>,
    /// The rule that stands for its standard deviation where none is stated, if it stands for several inputs,
    /// which are then off together.
    pub(super) rule: Option<&'static str>,
    /// Standard deviation where none is stated.
    sigma: DefaultSigma,
}

/// What holds for a number that nobody enters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HandDefault {
    /// The method needs it.
    Required,
    /// The method does without it.
    Open,
    /// This value, SI.
    Value(f64),
}

/// Standard deviation of a number where none is stated: a rule of ours.
#[derive(Debug, Clone, Copy, PartialEq)]
enum DefaultSigma {
    /// The same for every value, SI.
    Fixed(f64),
    /// A share of the value.
    Share(f64),
    /// A share of what the value, itself a share, lacks to 1.
    OfRest(f64),
}

impl HandField {
    /// A number that the method needs, with the same standard deviation for every value.
    ///
    /// - `sigma`: SI.
    pub(super) const fn new(
        key: &'static str,
        label: &'static str,
        range: Range,
        sigma: f64,
    ) -> Self {
        let sigma = DefaultSigma::Fixed(sigma);
        Self { key, label, range, default: HandDefault::Required, needs: None, rule: None, sigma }
    }

    /// The same with a standard deviation that is a share of the value.
    pub(super) const fn relative(
        key: &'static str,
        label: &'static str,
        range: Range,
        share: f64,
    ) -> Self {
        let sigma = DefaultSigma::Share(share);
        Self { key, label, range, default: HandDefault::Required, needs: None, rule: None, sigma }
    }

    /// A share of a whole that the method needs, with a standard deviation that is a share of what it lacks to 1: the
    /// whole is exact.
    pub(super) const fn part(
        key: &'static str,
        label: &'static str,
        range: Range,
        share: f64,
    ) -> Self {
        let sigma = DefaultSigma::OfRest(share);
        Self { key, label, range, default: HandDefault::Required, needs: None, rule: None, sigma }
    }

    /// The same, which may be left out.
    pub(super) const fn open(self) -> Self {
        Self { default: HandDefault::Open, ..self }
    }

    /// The same with a value where none is entered, SI.
    pub(super) const fn or(self, value: f64) -> Self {
        Self { default: HandDefault::Value(value), ..self }
    }

    /// The same, which is off together with others of a rule.
    pub(super) const fn by_rule(self, rule: &'static str) -> Self {
        Self { rule: Some(rule), ..self }
    }

    /// The same, which has a meaning beside another input alone.
    ///
    /// - `key`: of the other one, or [`POINTS`].
    pub(super) const fn only_with(self, key: &'static str) -> Self {
        Self { needs: Some(key), ..self }
    }

    /// Its key in a question, with its SI unit.
    pub fn si_key(&self) -> String {
        match self.range.quantity {
            Quantity::ForcePerLength => format!("{}_n_per_m", self.key),
            Quantity::ForcePerArea => format!("{}_n_per_m2", self.key),
            quantity => key_with_unit(self.key, &quantity.si_unit()),
        }
    }

    /// Its word on the command line.
    pub fn word(&self) -> String {
        self.key.replace('_', "-")
    }

    /// Whether the method needs it.
    pub fn is_required(&self) -> bool {
        self.default == HandDefault::Required
    }

    /// Standard deviation of a value where none is stated, SI.
    pub fn usual_sigma(&self, value: f64) -> f64 {
        match self.sigma {
            DefaultSigma::Fixed(sigma) => sigma,
            DefaultSigma::Share(share) => share * value.abs(),
            DefaultSigma::OfRest(share) => share * (1.0 - value).abs(),
        }
    }

    /// The standard deviations that it may have.
    pub fn sigma_range(&self) -> Range {
        let limits = [0.0, self.range.high - self.range.low];
        Range::real("standard deviation", self.range.quantity, limits, self.range.name)
    }
}
