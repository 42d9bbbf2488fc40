//! Which vehicles a question is about.

use std::path::{Path, PathBuf};

use impactlab_core::uncertainty::{Caveat, CaveatSubject, Caveats};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::caveats::bodies::unusual;
use crate::{InputKind, StudyError};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_core::vehicle::{
    BuiltInVehicle, DataSheet, Preset, VehicleParameters, built_in_vehicle,
};

/// The struck vehicle where neither the question nor the data set says which it is: the car that
/// the shipped response network knows best.
pub const DEFAULT_VEHICLE: Preset = Preset::Reference;

/// The striking vehicle where the question does not say which it is.
pub const DEFAULT_STRIKING: Preset = Preset::Bullet2000;

/// Which vehicle it is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum VehicleChoice {
    /// The data set's own, else [`DEFAULT_VEHICLE`] or [`DEFAULT_STRIKING`], which is then listed as
    /// an assumption.
    #[default]
    #[serde(alias = "automatic")]
    Automatic,
    /// A vehicle that comes with the program, a preset or one of the library, by its id.
    #[serde(alias = "preset")]
    Preset(String),
    /// A vehicle file.
    #[serde(alias = "file")]
    File(PathBuf),
    /// A data sheet that was filled in.
    #[serde(alias = "sheet")]
    Sheet(Box<DataSheet>),
}

impl VehicleChoice {
    /// What a person typed: the id of a vehicle that comes with the program, else a file.
    pub fn named(name: &str) -> Self {
        match BuiltInVehicle::from_id(name) {
            Some(_) => Self::Preset(name.to_owned()),
            None => Self::File(PathBuf::from(name)),
        }
    }

    /// The vehicle that was chosen; `None` if it was left open.
    ///
    /// # Errors
    /// [`StudyError`] if there is no such vehicle, or its file or sheet is wrong.
    pub fn chosen(&self) -> Result<Option<VehicleParameters>, StudyError> {
        match self {
            Self::Automatic => Ok(None),
            Self::Preset(id) => match built_in_vehicle(id) {
                Some(vehicle) => Ok(Some(vehicle)),
                None => Err(StudyError::unknown_vehicle(id)),
            },
            Self::File(path) if path.exists() => {
                InputKind::Vehicle.explain(path, VehicleParameters::load(path)).map(Some)
            }
            Self::Sheet(sheet) => Ok(Some(sheet.checked_vehicle()?)),
            Self::File(path) => Err(StudyError::unknown_vehicle(&path.display().to_string())),
        }
    }
}

/// What stands in for a vehicle that was left open.
pub(crate) enum OpenVehicle<'a> {
    /// The vehicle file of the data set that the question is about, if it has one.
    OfDataset(Option<&'a Path>),
    /// The vehicle that the scenario names, if it names one.
    OfScenario(Option<&'a str>),
    /// Nothing: the question is not about a data set.
    Unknown,
    /// Nothing, of a vehicle that drives and has struck nothing.
    Driven,
}

impl OpenVehicle<'_> {
    fn subject(&self) -> CaveatSubject {
        match self {
            Self::OfDataset(_) | Self::OfScenario(_) | Self::Unknown => CaveatSubject::Vehicle,
            Self::Driven => CaveatSubject::Driven,
        }
    }
}

/// The struck vehicle; one that nobody named is added to the caveats, and what no car has.
pub(crate) fn struck_vehicle(
    choice: &VehicleChoice,
    open: &OpenVehicle<'_>,
    caveats: &mut Caveats,
) -> Result<VehicleParameters, StudyError> {
    let vehicle = named_or_learned(choice, open, caveats)?;
    caveats.extend(unusual(&vehicle, open.subject()));
    Ok(vehicle)
}

fn named_or_learned(
    choice: &VehicleChoice,
    open: &OpenVehicle<'_>,
    caveats: &mut Caveats,
) -> Result<VehicleParameters, StudyError> {
    if let Some(vehicle) = choice.chosen()? {
        return Ok(vehicle);
    }
    if let OpenVehicle::OfDataset(Some(file)) = open {
        return Ok(VehicleParameters::load(file)?);
    }
    if let OpenVehicle::OfScenario(Some(name)) = open {
        return built_in_vehicle(name).ok_or_else(|| StudyError::unknown_vehicle(name));
    }
    let reason = match open {
        OpenVehicle::OfDataset(_) => {
            Phrase::new("the data set has no vehicle.toml", "der Datensatz hat keine vehicle.toml")
        }
        OpenVehicle::OfScenario(_) | OpenVehicle::Unknown | OpenVehicle::Driven => {
            Phrase::new("no vehicle was named", "kein Fahrzeug ist benannt")
        }
    };
    let reason = Phrase::new(
        "{0}; this one stands in, the car that the shipped response network knows best; another one: --vehicle",
        "{0}; ersatzweise dieses, das Fahrzeug, das das mitgelieferte Bewegungsnetz am besten kennt; ein anderes: \
         --vehicle",
    )
    .with(PhraseValue::phrase(reason));
    caveats.push(Caveat::assumed(open.subject(), name_of(DEFAULT_VEHICLE.id()), reason));
    Ok(DEFAULT_VEHICLE.parameters())
}

/// The name of a vehicle, the same in every language.
fn name_of(name: &str) -> Phrase {
    Phrase::of(PhraseValue::Name(name.to_owned()))
}

/// The striking vehicle; one that nobody named is added to the caveats, and what no car has.
///
/// - `named`: the vehicle that the scenario names, if it names one.
pub(crate) fn striking_vehicle(
    choice: &VehicleChoice,
    named: Option<&str>,
    caveats: &mut Caveats,
) -> Result<VehicleParameters, StudyError> {
    if let Some(vehicle) = choice.chosen()? {
        caveats.extend(unusual(&vehicle, CaveatSubject::Striking));
        return Ok(vehicle);
    }
    if let Some(name) = named {
        return built_in_vehicle(name).ok_or_else(|| StudyError::unknown_vehicle(name));
    }
    let reason = Phrase::new(
        "no striking vehicle was named; its mass, inertia and outline are those of the \
         case; another one: --bullet",
        "kein stoßendes Fahrzeug ist benannt; Masse, Trägheit und Umriss sind die des Falls; ein anderes: \
         --bullet",
    );
    caveats.push(Caveat::assumed(CaveatSubject::Striking, name_of(DEFAULT_STRIKING.id()), reason));
    Ok(DEFAULT_STRIKING.parameters())
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::Integrator;

    /// Options, reports and all other choices spell their words so; questions knew `Rk4` and `File` alone.
    #[test]
    fn vehicles_and_integrators_are_read_in_small_letters_too() {
        assert_eq!(serde_json::from_str::<Integrator>("\"rk4\"").unwrap(), Integrator::Rk4);
        assert_eq!(serde_json::from_str::<Integrator>("\"euler\"").unwrap(), Integrator::Euler);
        for (written, expected) in [
            ("\"automatic\"", VehicleChoice::Automatic),
            ("{\"preset\": \"target-2000\"}", VehicleChoice::Preset("target-2000".to_owned())),
            ("{\"file\": \"car.toml\"}", VehicleChoice::File(PathBuf::from("car.toml"))),
        ] {
            let read: VehicleChoice = serde_json::from_str(written).unwrap();
            assert_eq!(read, expected, "{written}");
        }
    }
}
