//! Options that choose one of a few, and the vehicle.

use std::convert::Infallible;
use std::fmt::Debug;
use std::str::FromStr;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use impactlab_core::data::{RecordedSide, Sampling};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{DrivenAxle, Equations, Integrator};
use impactlab_study::{BadCases, EvaluatedCases, VehicleChoice, word};

/// The values of an option, each with its meaning for the help, which may be empty. Their words are those of
/// JSON with hyphens, by [`typed_word`].
pub(in crate::cli) type Values<T> = &'static [(T, &'static str)];

/// The words of an option whose values have no word in JSON, or another one there, each with its meaning for
/// the help, which may be empty, and its value.
pub(in crate::cli) type Words<T> = &'static [(&'static str, &'static str, T)];

/// The word of a value on the command line: that of JSON with hyphens, such as `without-edr`.
pub(in crate::cli) fn typed_word(value: &impl Debug) -> String {
    word(value).replace('_', "-")
}

/// A parser of one of some values.
pub(in crate::cli) fn one_value_of<T: Copy + Debug + Send + Sync + 'static>(
    values: Values<T>,
) -> impl TypedValueParser<Value = T> {
    let shown = |(value, meaning): &(T, &'static str)| {
        PossibleValue::new(typed_word(value)).help((!meaning.is_empty()).then_some(*meaning))
    };
    PossibleValuesParser::new(values.iter().map(shown)).try_map(move |chosen| {
        let found = values.iter().find(|(value, _)| typed_word(value) == chosen);
        found.map(|(value, _)| *value).ok_or("none of the words")
    })
}

/// A parser of one of some words.
pub(in crate::cli) fn one_of<T: Copy + Send + Sync + 'static>(
    words: Words<T>,
) -> impl TypedValueParser<Value = T> {
    let shown = |&(word, meaning, _): &(&'static str, &'static str, T)| {
        PossibleValue::new(word).help((!meaning.is_empty()).then_some(meaning))
    };
    PossibleValuesParser::new(words.iter().map(shown)).try_map(move |chosen| {
        let found = words.iter().find(|(word, ..)| *word == chosen);
        found.map(|(.., value)| *value).ok_or("none of the words")
    })
}

/// A vehicle by name or file.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::cli) struct VehicleArg(VehicleChoice);

impl FromStr for VehicleArg {
    type Err = Infallible;

    fn from_str(name: &str) -> Result<Self, Infallible> {
        Ok(Self(VehicleChoice::named(name)))
    }
}

impl VehicleArg {
    /// The vehicle that was named, else one that the data or the program choose.
    pub(in crate::cli) fn choice(arg: &Option<Self>) -> VehicleChoice {
        arg.as_ref().map_or(VehicleChoice::Automatic, |arg| arg.0.clone())
    }
}

/// The units in which numbers are told.
pub(in crate::cli) const UNITS: Values<UnitSystem> =
    &[(UnitSystem::Si, "km/h, deg, kN, kJ, m"), (UnitSystem::Us, "mph, deg, lbf, ft lbf, ft")];

/// What happens to cases that cannot be used.
#[derive(Debug, Clone, Copy, Args)]
pub(in crate::cli) struct BadCasesArg {
    /// What happens to cases that cannot be used
    #[arg(long, value_parser = one_value_of(BAD_CASES), default_value = "refuse", value_name = "WHAT")]
    bad_cases: BadCases,
}

impl From<BadCasesArg> for BadCases {
    fn from(arg: BadCasesArg) -> Self {
        arg.bad_cases
    }
}

const BAD_CASES: Values<BadCases> = &[
    (BadCases::Refuse, "The first one is an error"),
    (BadCases::LeaveOut, "They are left out and listed"),
];

/// Which cases of the data set.
pub(in crate::cli) const SPLITS: Values<EvaluatedCases> = &[
    (EvaluatedCases::Test, "Those that the model was not trained on, recognised by their content"),
    (EvaluatedCases::All, "All, also those that it was trained on"),
];

/// How the equations of motion are integrated.
pub(in crate::cli) const INTEGRATORS: Values<Integrator> = &[
    (Integrator::Rk4, "Classical Runge–Kutta, 1 ms: the reference"),
    (Integrator::Euler, "Explicit Euler, 10 ms: the paper's baseline"),
];

/// Which equations of motion; without the option, the vehicle file says.
pub(in crate::cli) const EQUATIONS: Values<Equations> = &[
    (Equations::Corrected, "The paper's, mended"),
    (Equations::Paper, "The paper's, as printed: an ablation that diverges"),
];

/// Which axle the engine turns.
pub(in crate::cli) const AXLES: Values<DrivenAxle> =
    &[(DrivenAxle::Front, ""), (DrivenAxle::Rear, ""), (DrivenAxle::All, "")];

/// To which side what a recorder says is positive.
pub(in crate::cli) const SIDES: Values<RecordedSide> =
    &[(RecordedSide::Left, ""), (RecordedSide::Right, "")];

/// What a force sample stands for.
pub(in crate::cli) const SAMPLINGS: Values<Sampling> = &[
    (Sampling::Instant, "The value at its instant"),
    (Sampling::CentredMean, "The mean over an interval centred at its instant"),
    (Sampling::ComingMean, "The mean from its instant to the next one"),
];
