//! The files of `impactlab predict force`.

use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::files::write_json;
use impactlab_core::data::{Existing, write_restricted_series_csv, write_restricted_table};
use impactlab_core::uncertainty::{CurveBands, ForceCurve};
use impactlab_study::{PredictForceAnswer, StudyError};

/// Writes bands, mean and samples as CSV, and the report as JSON, into a folder that exists.
pub(in crate::cli) fn write_force_prediction(
    path: &Path,
    answer: &PredictForceAnswer,
    report: &impl Serialize,
) -> Result<(), CliError> {
    let forecast = &answer.forecast;
    let restrictions = answer.report.caveats.text();
    let restrictions = restrictions.as_deref();
    write_bands(&path.join("bands.csv"), &forecast.mean, &forecast.bands, restrictions)?;
    let write_curve = |name: String, curve: &ForceCurve| -> Result<(), CliError> {
        let path = path.join(name);
        let unwritable = |source| StudyError::Series { path: path.clone(), source };
        let series = curve.to_history().to_series().map_err(unwritable)?;
        Ok(write_restricted_series_csv(&path, Existing::Refuse, &series, restrictions)?)
    };
    write_curve("mean.csv".to_owned(), &forecast.mean)?;
    for (i, sample) in forecast.curves.iter().enumerate() {
        write_curve(format!("sample_{:03}.csv", i + 1), sample)?;
    }
    write_json(&path.join("prediction.json"), report)
}

/// One row per instant: time, then mean and edges of each force.
fn write_bands(
    path: &Path,
    mean: &ForceCurve,
    bands: &CurveBands,
    restrictions: Option<&str>,
) -> Result<(), CliError> {
    let magnitude = mean.magnitude_n();
    let forces = [
        ("fx", &mean.fx_n, &bands.fx),
        ("fy", &mean.fy_n, &bands.fy),
        ("f", &magnitude, &bands.magnitude),
    ];
    let mut header = vec!["time_s".to_owned()];
    for (name, _, bands) in &forces {
        header.push(format!("{name}_mean_n"));
        for band in *bands {
            let percent = (band.level * 100.0).round();
            header.extend(["low", "high"].map(|edge| format!("{name}_{edge}_{percent}_n")));
        }
    }
    let rows = mean.time_s().into_iter().enumerate().map(|(i, time)| {
        let mut row = vec![time.to_string()];
        for (_, mean, bands) in &forces {
            row.push(mean[i].to_string());
            let edges = bands.iter().flat_map(|band| [band.lower_n[i], band.upper_n[i]]);
            row.extend(edges.map(|edge| edge.to_string()));
        }
        row
    });
    Ok(write_restricted_table(path, Existing::Refuse, &header, rows, restrictions)?)
}
