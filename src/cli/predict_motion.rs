//! `impactlab predict`: from a scenario to the distribution of the motion after the impact.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::analysis::{
    MotionForecast, MotionForecastError, MotionForecastSettings, Outcome, Spread, StruckVehicle,
    forecast_forces, forecast_scenario,
};
use crate::cli::CliError;
use crate::cli::output::{print_facts, print_json, shown};
use crate::cli::quantity::UnitsArg;
use crate::cli::run::{Console, Verdict};
use crate::cli::vehicle_choice::vehicle;
use crate::collision::Scenario;
use crate::data::{read_force_file, write_atomically};
use crate::figure::{
    FORECAST_CHANNELS, Figure, MotionForecastFigure, forecast_channel_figure,
    forecast_scene_figure, write_figure_csv,
};
use crate::force::{ForceModel, OutsideTraining};
use crate::response::{ResponseModel, STEP_S};
use crate::uncertainty::PlanarGrid;
use crate::units::{Quantity, UnitSystem};

/// Points of the density map along each side.
const MAP_POINTS: usize = 256;
/// How many standard deviations of all parts the density map reaches.
const MAP_REACH: f64 = 4.0;
/// Levels of the bands in the table.
const LEVELS: [f64; 2] = [0.5, 0.9];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct PredictMotionArgs {
    /// The scenario file: both vehicles, and where they meet
    #[arg(long, value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// The struck vehicle: a preset or a file
    #[arg(long, default_value = "reference-2000", value_name = "NAME|FILE")]
    vehicle: String,
    /// A force history instead of the predicted one
    #[arg(long, value_name = "FORCE.csv")]
    force: Option<PathBuf>,
    /// The force network
    #[arg(long, default_value = "assets/models/force.safetensors", value_name = "MODEL")]
    force_model: PathBuf,
    /// The response network
    #[arg(long, default_value = "assets/models/response.safetensors", value_name = "MODEL")]
    response_model: PathBuf,
    /// Friction of the road, instead of the vehicle's
    #[arg(long, value_name = "MU")]
    friction: Option<f64>,
    /// Force histories to draw
    #[arg(long, default_value_t = 30, value_name = "N")]
    draws: usize,
    /// How long, s
    #[arg(long, default_value_t = 4.0, value_name = "S")]
    duration: f64,
    /// Seed of the draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Folder for trajectory.csv, density.csv, outcome.json, pictures and their numbers
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Units of text and pictures (JSON and tables are always SI)
    #[arg(long, value_enum, default_value_t)]
    units: UnitsArg,
}

const EXAMPLES: &str = "\
Example:
  impactlab predict --scenario assets/scenarios/pit_right_rear.toml --out prediction

trajectory.csv: time, central path (nothing uncertain), mean, standard deviation and edges of the 50
  and 90 % bands of X, Y, yaw, v_x, v_y and yaw rate. density.csv: probability density of the position of the CG at the end on a grid.
scene.png and one picture per quantity, each with its numbers as CSV beside it (pictures need the
  build with the window).

JSON: scenario, vehicle, force_model, response_model, n_forces, outcome {time_s, is_at_rest, x_m, y_m,
  heading_change_rad (median, half, ninety), speed_m_s, region_90_m2, p_quarter_turn, p_half_turn},
  hooking_probability, outside_training, files";

#[derive(Debug, Serialize)]
struct Answer<'a> {
    scenario: &'a str,
    vehicle: &'a str,
    force: Option<&'a Path>,
    force_model: Option<&'a Path>,
    response_model: &'a Path,
    n_forces: usize,
    outcome: &'a Outcome,
    hooking_probability: Option<f64>,
    outside_training: &'a [OutsideTraining],
    files: Vec<PathBuf>,
}

/// Predicts.
pub(super) fn run(
    args: &PredictMotionArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let scenario = Scenario::load(&args.scenario)?;
    let mut kind = vehicle(&args.vehicle)?;
    if let Some(friction) = args.friction {
        kind = kind.with_friction(friction);
    }
    let settings = MotionForecastSettings {
        n_curves: args.draws,
        duration_s: args.duration,
        seed: args.seed,
        ..MotionForecastSettings::default()
    };
    let unsolved = |source| CliError::Scenario { path: args.scenario.clone(), source };
    let struck = StruckVehicle::of_scenario(&scenario, &kind, settings.contact_height_m)
        .map_err(unsolved)?;
    let response = ResponseModel::load(&args.response_model)?;
    let forecast = match &args.force {
        Some(path) => {
            let loaded = read_force_file(path, None)?;
            let in_file = |source| CliError::Series { path: path.clone(), source };
            let force =
                crate::data::ForceHistory::from_series(&loaded.series, loaded.force_sampling())
                    .map_err(in_file)?;
            forecast_forces(&[force], &response, &struck, &settings)
        }
        None => {
            let force = ForceModel::load(&args.force_model)?;
            forecast_scenario(&scenario, (&force, &response), &struck, &settings)
        }
    };
    let forecast = forecast.map_err(|source| match source {
        MotionForecastError::Scenario(source) => unsolved(source),
        source => CliError::Forecast { path: args.scenario.clone(), source: Box::new(source) },
    })?;
    let files = write_files(args, &scenario, &forecast)?;
    let outside = forecast.force.as_ref().map_or(&[][..], |force| &force.outside);
    let answer = Answer {
        scenario: &scenario.name,
        vehicle: &struck.vehicle.name,
        force: args.force.as_deref(),
        force_model: args.force.is_none().then_some(&*args.force_model),
        response_model: &args.response_model,
        n_forces: forecast.forces.len(),
        outcome: &forecast.outcome,
        hooking_probability: forecast.force.as_ref().and_then(|force| force.hooking_probability),
        outside_training: outside,
        files,
    };
    let json = serde_json::to_vec_pretty(&answer).map_err(std::io::Error::from)?;
    write_atomically(&args.out.join("outcome.json"), |out| out.write_all(&json))?;
    if console.json {
        print_json(console.out, &answer)?;
    } else {
        print_text(&answer, args.units.into(), console)?;
    }
    Ok(Verdict::Clean)
}

fn write_files(
    args: &PredictMotionArgs,
    scenario: &Scenario,
    forecast: &MotionForecast,
) -> Result<Vec<PathBuf>, CliError> {
    let to_error = |source| CliError::Folder { path: args.out.clone(), source };
    fs::create_dir_all(&args.out).map_err(to_error)?;
    let (trajectory, map) = (args.out.join("trajectory.csv"), args.out.join("density.csv"));
    write_trajectory(&trajectory, forecast)?;
    write_density(&map, forecast)?;
    let mut files = vec![trajectory, map];
    let input = MotionForecastFigure {
        title: &scenario.name,
        distribution: &forecast.distribution,
        central: &forecast.central,
        reference: None,
        simulation: None,
        footprint: scenario.target.footprint(),
        time_s: forecast.outcome.time_s,
        units: args.units.into(),
    };
    let mut figures = vec![("scene".to_owned(), forecast_scene_figure(&input))];
    for channel in FORECAST_CHANNELS {
        let name = channel.channel.header().to_owned();
        figures.push((name, forecast_channel_figure(&input, channel)));
    }
    for (name, figure) in &figures {
        let csv = args.out.join(format!("{name}.csv"));
        write_atomically(&csv, |file| {
            write_figure_csv(figure, file).map_err(std::io::Error::other)
        })?;
        files.push(csv);
        let png = args.out.join(format!("{name}.png"));
        if write_png(figure, &png)? {
            files.push(png);
        }
    }
    Ok(files)
}

/// Whether this build draws.
#[cfg(feature = "gui")]
fn write_png(figure: &Figure, path: &Path) -> Result<bool, CliError> {
    let image = crate::render::figure_image(figure, crate::render::Canvas::default())?;
    crate::render::save_png(&image, path)?;
    Ok(true)
}

#[cfg(not(feature = "gui"))]
#[allow(clippy::unnecessary_wraps, reason = "the build with a window can fail here")]
fn write_png(_figure: &Figure, _path: &Path) -> Result<bool, CliError> {
    Ok(false)
}

fn write_trajectory(path: &Path, forecast: &MotionForecast) -> Result<(), CliError> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut header = vec!["time_s".to_owned()];
    for channel in FORECAST_CHANNELS {
        let name = channel.channel.header();
        header.extend(["central", "mean", "std"].map(|kind| format!("{name}_{kind}")));
        for level in LEVELS {
            let percent = (100.0 * level) as u32;
            header.extend([format!("{name}_low_{percent}"), format!("{name}_high_{percent}")]);
        }
    }
    let failed = |error: csv::Error| CliError::Output(std::io::Error::other(error));
    csv.write_record(&header).map_err(failed)?;
    let distribution = &forecast.distribution;
    for (at, central) in forecast.central.iter().enumerate() {
        let covariance = distribution.covariance(at);
        let (central, mean) = (central.planar(), distribution.mean(at).planar());
        let mut row = vec![format!("{:.2}", at as f64 * STEP_S)];
        for (axis, (central, mean)) in central.into_iter().zip(mean).enumerate() {
            let std = covariance[(axis, axis)].max(0.0).sqrt();
            row.extend([central, mean, std].map(|value| format!("{value:.6}")));
            let marginal = distribution.marginal(at, axis);
            for level in LEVELS {
                let edges = marginal.as_ref().map_or([mean; 2], |of| of.interval(level));
                row.extend(edges.map(|edge| format!("{edge:.6}")));
            }
        }
        csv.write_record(&row).map_err(failed)?;
    }
    let bytes = csv.into_inner().map_err(|error| std::io::Error::other(error.to_string()))?;
    write_atomically(path, |out| out.write_all(&bytes))?;
    Ok(())
}

fn write_density(path: &Path, forecast: &MotionForecast) -> Result<(), CliError> {
    let at = (forecast.outcome.time_s / STEP_S).round() as usize;
    let position = forecast.distribution.position(at);
    let bounds = position.bounds(MAP_REACH).unwrap_or([[0.0; 2], [1.0; 2]]);
    let grid = PlanarGrid::over(bounds, [MAP_POINTS; 2]);
    let density = position.density_on(&grid);
    write_atomically(path, |out| {
        writeln!(out, "x_m,y_m,density_1_m2")?;
        for (i, value) in density.iter().enumerate() {
            let x = grid.low_m[0] + (i % MAP_POINTS) as f64 * grid.step_m[0];
            let y = grid.low_m[1] + (i / MAP_POINTS) as f64 * grid.step_m[1];
            writeln!(out, "{x:.4},{y:.4},{value:.6e}")?;
        }
        Ok(())
    })?;
    Ok(())
}

fn print_text(
    answer: &Answer<'_>,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<(), CliError> {
    let outcome = answer.outcome;
    let spread = |quantity: Quantity, of: &Spread| {
        let [low, high] = of.ninety;
        format!(
            "{} (90 %: {} to {})",
            shown(quantity, of.median, units),
            shown(quantity, low, units),
            shown(quantity, high, units)
        )
    };
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let when = match outcome.is_at_rest {
        true => format!("at rest after {:.2} s", outcome.time_s),
        false => format!("after {:.2} s", outcome.time_s),
    };
    let mut facts = vec![
        ("scenario", answer.scenario.to_owned()),
        ("vehicle", answer.vehicle.to_owned()),
        ("forces", format!("{}, each as likely", answer.n_forces)),
        ("end", when),
        ("speed", shown(Quantity::Speed, outcome.speed_m_s, units)),
        ("X", spread(Quantity::Length, &outcome.x_m)),
        ("Y", spread(Quantity::Length, &outcome.y_m)),
        ("heading change", spread(Quantity::Angle, &outcome.heading_change_rad)),
        ("90 % region", format!("{:.1} m²", outcome.region_90_m2)),
        ("P(quarter turn or more)", percent(outcome.p_quarter_turn)),
        ("P(half turn or more)", percent(outcome.p_half_turn)),
    ];
    if let Some(probability) = answer.hooking_probability {
        facts.push(("P(hooking)", percent(probability)));
    }
    for outside in answer.outside_training {
        let [low, high] = outside.range;
        let value = format!(
            "{} is {:.3}, trained on {low:.3} to {high:.3}",
            outside.feature, outside.value
        );
        facts.push(("outside training", value));
    }
    print_facts(console.out, &facts)?;
    Ok(())
}
