//! `impactlab predict`: from a scenario to the distribution of the motion after the impact.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::analysis::{
    MotionForecastSettings, Outcome, Spread, StruckVehicle, forecast_collision, forecast_forces,
};
use crate::cli::CliError;
use crate::cli::output::{print_facts, print_json, shown};
use crate::cli::predict_motion_files::write_files;
use crate::cli::quantity::{UnitsArg, window_s};
use crate::cli::run::{Console, Verdict};
use crate::cli::vehicle_choice::vehicle;
use crate::collision::Scenario;
use crate::data::{read_force_file, write_atomically};
use crate::force::{ForceScenario, OutsideTraining};
use crate::shipped::ModelSource;
use crate::units::{Quantity, UnitSystem};

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct PredictMotionArgs {
    /// The scenario, both vehicles and where they meet: a file, or `pit-right-rear`
    #[arg(long, value_name = "NAME|FILE")]
    scenario: PathBuf,
    /// The struck vehicle: a preset or a file
    #[arg(long, default_value = "reference-2000", value_name = "NAME|FILE")]
    vehicle: String,
    /// A force history instead of the predicted one
    #[arg(long, value_name = "FORCE.csv")]
    force: Option<PathBuf>,
    /// The force network: `shipped` or a file
    #[arg(long, default_value_t, value_name = "MODEL")]
    force_model: ModelSource,
    /// The response network: `shipped`, `shipped-pretrained` or a file
    #[arg(long, default_value_t, value_name = "MODEL")]
    response_model: ModelSource,
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
    /// Window of time of the density map, s, instead of the end
    #[arg(long, value_parser = window_s, value_name = "FROM,TO")]
    pub(super) window: Option<[f64; 2]>,
    /// Folder for trajectory.csv, density.csv, outcome.json, pictures and their numbers
    #[arg(long, value_name = "DIR")]
    pub(super) out: PathBuf,
    /// Units of text and pictures (JSON and tables are always SI)
    #[arg(long, value_enum, default_value_t)]
    pub(super) units: UnitsArg,
}

const EXAMPLES: &str = "\
Example:
  impactlab predict --scenario pit-right-rear --out prediction

trajectory.csv: time, central path (nothing uncertain), mean, standard deviation and edges of the 50
  and 90 % bands of X, Y, yaw, v_x, v_y and yaw rate. density.csv: probability density of the position of the CG at the end, or its
  mean over the window, on a grid.
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
    force_model: Option<&'a ModelSource>,
    response_model: &'a ModelSource,
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
    let scenario = Scenario::preset_or_file(&args.scenario)?;
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
    let response = args.response_model.response_model()?;
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
            let force = args.force_model.force_model()?;
            let collision = ForceScenario::from_scenario(&scenario).map_err(unsolved)?;
            forecast_collision(&collision, (&force, &response), &struck, &settings)
        }
    };
    let failed =
        |source| CliError::Forecast { path: args.scenario.clone(), source: Box::new(source) };
    let forecast = forecast.map_err(failed)?;
    let files = write_files(args, &scenario, &forecast)?;
    let outside = forecast.force.as_ref().map_or(&[][..], |force| &force.outside);
    let answer = Answer {
        scenario: &scenario.name,
        vehicle: &struck.vehicle.name,
        force: args.force.as_deref(),
        force_model: args.force.is_none().then_some(&args.force_model),
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
