//! The files of `impactlab predict`: tables, density map, pictures with their numbers.

use std::path::{Path, PathBuf};

use crate::cli::CliError;
use impactlab_core::data::{Existing, write_atomically, write_restricted_table};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    FORECAST_CHANNELS, Figure, MotionForecastFigure, forecast_channel_figure,
    forecast_scene_figure, write_figure_csv,
};
use impactlab_study::PredictMotionAnswer;
use impactlab_study::analysis::{
    DensityMap, DensityTask, MotionBands, MotionForecast, motion_columns,
};

/// Where the files go, and what they show.
pub(in crate::cli) struct MotionFiles<'a> {
    /// The folder, which exists.
    pub(in crate::cli) folder: &'a Path,
    /// Window of time of the density map, s; the end without.
    pub(in crate::cli) window_s: Option<[f64; 2]>,
    /// Units of the pictures.
    pub(in crate::cli) units: UnitSystem,
}

/// Writes tables, density map and pictures, and gives their names. There is no density map of a window
/// that ends after a second contact, which is not computed.
pub(in crate::cli) fn write_motion_prediction(
    wanted: &MotionFiles<'_>,
    answer: &PredictMotionAnswer,
) -> Result<Vec<String>, CliError> {
    let forecast = &answer.forecast;
    let path = |name: &str| wanted.folder.join(name);
    let (trajectory, map) = ("trajectory.csv".to_owned(), "density.csv".to_owned());
    let bands = MotionBands::new(&forecast.distribution, 1);
    let caveats = answer.report.caveats.clone();
    let restrictions = caveats.text();
    let restrictions = restrictions.as_deref();
    let known_s = answer.report.known_until_s();
    write_trajectory(&path(&trajectory), forecast, &bands, known_s, restrictions)?;
    let window_s = wanted.window_s.unwrap_or([forecast.outcome.time_s; 2]);
    let density = DensityTask::new(&forecast.distribution, window_s).on_cpu();
    let mut files = vec![trajectory];
    if window_s[1] <= known_s {
        write_density(&path(&map), &density, restrictions)?;
        files.push(map);
    }
    let input = MotionForecastFigure {
        title: &answer.report.scenario,
        density: Some(&density),
        draws: true,
        reference: answer.analysis.reference.as_ref(),
        ..MotionForecastFigure::new(answer, &bands, &caveats, forecast.outcome.time_s, wanted.units)
    };
    let mut figures = vec![("scene".to_owned(), forecast_scene_figure(&input))];
    for channel in FORECAST_CHANNELS {
        let name = channel.channel.header().to_owned();
        figures.push((name, forecast_channel_figure(&input, channel)));
    }
    let mut pictures: Vec<(PathBuf, &Figure)> = Vec::new();
    for (name, figure) in &figures {
        let csv = format!("{name}.csv");
        write_atomically(&path(&csv), Existing::Refuse, |file| {
            write_figure_csv(figure, file).map_err(std::io::Error::other)
        })?;
        files.push(csv);
        let png = format!("{name}.png");
        pictures.push((path(&png), figure));
        files.push(png);
    }
    impactlab_draw::save_figures(&pictures, Existing::Refuse)?;
    Ok(files)
}

/// Writes the motion over time. After a second contact, which is not computed, cells of standard deviations
/// and intervals stay empty.
///
/// - `known_s`: until when positions have a probability, s.
fn write_trajectory(
    path: &Path,
    forecast: &MotionForecast,
    bands: &MotionBands,
    known_s: f64,
    restrictions: Option<&str>,
) -> Result<(), CliError> {
    let columns = motion_columns(&forecast.distribution, &forecast.central, bands, known_s);
    let header: Vec<String> = columns.iter().map(|(name, _)| name.clone()).collect();
    let cell = |(idx, value): (usize, f64)| match idx {
        _ if value.is_nan() => String::new(),
        0 => format!("{value:.2}"),
        _ => format!("{value:.6}"),
    };
    let rows = (0..forecast.central.len()).map(|at| {
        let values = columns.iter().filter_map(|(_, values)| values.get(at).copied());
        values.enumerate().map(cell).collect()
    });
    Ok(write_restricted_table(path, Existing::Refuse, &header, rows, restrictions)?)
}

fn write_density(
    path: &Path,
    map: &DensityMap,
    restrictions: Option<&str>,
) -> Result<(), CliError> {
    let [width, _] = map.grid.size;
    let header = ["x_m", "y_m", "density_1_m2"].map(str::to_owned);
    let rows = map.values.iter().enumerate().map(|(i, value)| {
        let x = map.grid.low_m[0] + (i % width) as f64 * map.grid.step_m[0];
        let y = map.grid.low_m[1] + (i / width) as f64 * map.grid.step_m[1];
        vec![format!("{x:.4}"), format!("{y:.4}"), format!("{value:.6e}")]
    });
    Ok(write_restricted_table(path, Existing::Refuse, &header, rows, restrictions)?)
}
