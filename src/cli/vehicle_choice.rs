//! Which vehicle: a preset by its name, a file, or the one of a data set.

use std::path::Path;

use crate::cli::CliError;
use crate::cli::simulate::EquationsArg;
use crate::vehicle::{Preset, VehicleParameters};

/// The vehicle that `--vehicle` names: a preset, else a file.
pub(super) fn vehicle(name: &str) -> Result<VehicleParameters, CliError> {
    if let Some(preset) = Preset::from_id(name) {
        return Ok(preset.parameters());
    }
    let path = Path::new(name);
    if path.exists() {
        return Ok(VehicleParameters::load(path)?);
    }
    Err(unknown(name))
}

/// The vehicle under the equations that `--equations` names, else those of its file.
pub(super) fn under(
    vehicle: VehicleParameters,
    equations: Option<EquationsArg>,
) -> VehicleParameters {
    match equations {
        Some(equations) => vehicle.with_equations(equations.into()),
        None => vehicle,
    }
}

/// The error for a name that is no vehicle.
pub(super) fn unknown(name: &str) -> CliError {
    CliError::UnknownVehicle {
        name: name.to_owned(),
        presets: Preset::ALL.iter().map(|preset| preset.id()).collect(),
    }
}

/// The vehicle that `--vehicle` names, else the data set's own; `path` is what lacks one.
pub(super) fn vehicle_or_own(
    name: Option<&str>,
    own: Option<&Path>,
    path: &Path,
) -> Result<VehicleParameters, CliError> {
    match (name, own) {
        (Some(name), _) => vehicle(name),
        (None, Some(own)) => Ok(VehicleParameters::load(own)?),
        (None, None) => Err(CliError::NoVehicle { path: path.to_owned() }),
    }
}
