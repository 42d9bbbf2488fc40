//! The files of `impactlab predict force`.

use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use crate::data::{Existing, write_atomically, write_series_csv};
use crate::study::{PredictForceAnswer, StudyError};
use crate::uncertainty::{CurveBands, ForceCurve};

/// Writes bands, mean and samples as CSV, and the report as JSON, into a folder that exists.
pub(in crate::cli) fn write_force_prediction(
    path: &Path,
    answer: &PredictForceAnswer,
    report: &impl Serialize,
) -> Result<(), CliError> {
    let forecast = &answer.forecast;
    write_bands(&path.join("bands.csv"), &forecast.mean, &forecast.bands)?;
    let write_curve = |name: String, curve: &ForceCurve| -> Result<(), CliError> {
        let path = path.join(name);
        let unwritable = |source| StudyError::Series { path: path.clone(), source };
        let series = curve.to_history().to_series().map_err(unwritable)?;
        Ok(write_series_csv(&path, Existing::Refuse, &series)?)
    };
    write_curve("mean.csv".to_owned(), &forecast.mean)?;
    for (i, sample) in forecast.curves.iter().enumerate() {
        write_curve(format!("sample_{:03}.csv", i + 1), sample)?;
    }
    write_atomically(&path.join("prediction.json"), Existing::Refuse, |out| {
        serde_json::to_writer_pretty(&mut *out, report)?;
        writeln!(out)
    })?;
    Ok(())
}

/// One row per instant: time, then mean and edges of each force.
fn write_bands(path: &Path, mean: &ForceCurve, bands: &CurveBands) -> Result<(), CliError> {
    let magnitude = mean.magnitude_n();
    let forces = [
        ("fx", &mean.fx_n, &bands.fx),
        ("fy", &mean.fy_n, &bands.fy),
        ("f", &magnitude, &bands.magnitude),
    ];
    write_atomically(path, Existing::Refuse, |out| {
        write!(out, "time_s")?;
        for (name, _, bands) in &forces {
            write!(out, ",{name}_mean_n")?;
            for band in *bands {
                let percent = (band.level * 100.0).round();
                write!(out, ",{name}_low_{percent}_n,{name}_high_{percent}_n")?;
            }
        }
        writeln!(out)?;
        for (i, time) in mean.time_s().iter().enumerate() {
            write!(out, "{time}")?;
            for (_, mean, bands) in &forces {
                write!(out, ",{}", mean[i])?;
                for band in *bands {
                    write!(out, ",{},{}", band.lower_n[i], band.upper_n[i])?;
                }
            }
            writeln!(out)?;
        }
        Ok(())
    })?;
    Ok(())
}
