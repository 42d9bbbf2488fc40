//! Options that choose one of a few, and the vehicle.

use std::convert::Infallible;
use std::str::FromStr;

use clap::{Args, ValueEnum};

use impactlab_core::data::Sampling;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{Equations, Integrator};
use impactlab_study::{BadCases, EvaluatedCases, VehicleChoice};

/// The units of the text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum UnitsArg {
    /// km/h, deg, kN, kJ, m
    #[default]
    Si,
    /// mph, deg, lbf, ft lbf, ft
    Us,
}

impl From<UnitsArg> for UnitSystem {
    fn from(units: UnitsArg) -> Self {
        match units {
            UnitsArg::Si => Self::Si,
            UnitsArg::Us => Self::Us,
        }
    }
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

/// What happens to cases that cannot be used.
#[derive(Debug, Clone, Copy, Args)]
pub(in crate::cli) struct BadCasesArg {
    /// What happens to cases that cannot be used
    #[arg(long, value_enum, default_value_t, value_name = "WHAT")]
    bad_cases: BadCasesWord,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum BadCasesWord {
    /// The first one is an error
    #[default]
    Refuse,
    /// They are left out and listed
    LeaveOut,
}

impl From<BadCasesArg> for BadCases {
    fn from(arg: BadCasesArg) -> Self {
        match arg.bad_cases {
            BadCasesWord::Refuse => Self::Refuse,
            BadCasesWord::LeaveOut => Self::LeaveOut,
        }
    }
}

/// Which cases of the data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum SplitArg {
    /// Those that the model was not trained on, recognised by their content
    Test,
    /// All, also those that it was trained on
    All,
}

impl From<SplitArg> for EvaluatedCases {
    fn from(split: SplitArg) -> Self {
        match split {
            SplitArg::Test => Self::Test,
            SplitArg::All => Self::All,
        }
    }
}

/// How the equations of motion are integrated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum IntegratorArg {
    /// Classical Runge–Kutta, 1 ms: the reference
    #[default]
    Rk4,
    /// Explicit Euler, 10 ms: the paper's baseline
    Euler,
}

impl From<IntegratorArg> for Integrator {
    fn from(integrator: IntegratorArg) -> Self {
        match integrator {
            IntegratorArg::Rk4 => Self::Rk4,
            IntegratorArg::Euler => Self::Euler,
        }
    }
}

/// Which equations of motion; without the option, the vehicle file says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum EquationsArg {
    /// The paper's, mended
    Corrected,
    /// The paper's, as printed: an ablation that diverges
    Paper,
}

impl From<EquationsArg> for Equations {
    fn from(equations: EquationsArg) -> Self {
        match equations {
            EquationsArg::Corrected => Self::Corrected,
            EquationsArg::Paper => Self::Paper,
        }
    }
}

/// What a force sample stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum SamplingArg {
    /// The value at its instant
    Instant,
    /// The mean over an interval centred at its instant
    CentredMean,
    /// The mean from its instant to the next one
    ComingMean,
}

impl From<SamplingArg> for Sampling {
    fn from(sampling: SamplingArg) -> Self {
        match sampling {
            SamplingArg::Instant => Self::Instant,
            SamplingArg::CentredMean => Self::CentredMean,
            SamplingArg::ComingMean => Self::ComingMean,
        }
    }
}
