//! `impactlab predict force`: the distribution of an impact force history.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::output::{print_facts, print_json, shown};
use crate::cli::predict_motion::{self, PredictMotionArgs};
use crate::cli::quantity::UnitsArg;
use crate::cli::run::{Console, Verdict};
use crate::collision::{PrincipalDirectionOfForce, Scenario};
use crate::data::{write_atomically, write_series_csv};
use crate::force::{ForcePrediction, ForceScenario, OutsideTraining};
use crate::nn::random_stream;
use crate::shipped::ModelSource;
use crate::uncertainty::{CurveBands, CurveFigures, ForceCurve};
use crate::units::Quantity;

/// Levels of the bands.
const LEVELS: [f64; 4] = [0.5, 0.8, 0.9, 0.95];
/// Draws behind the intervals of peak and impulse.
const N_DRAWS: usize = 2000;

/// Predict with trained networks: the motion after an impact, or its force alone
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct PredictArgs {
    #[command(subcommand)]
    what: Option<What>,
    #[command(flatten)]
    motion: Option<PredictMotionArgs>,
}

#[derive(Debug, Subcommand)]
enum What {
    /// The impact force history of a scenario, with bands
    Force(PredictForceArgs),
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
struct PredictForceArgs {
    /// The force network: `shipped` or a file
    #[arg(long, default_value_t, value_name = "MODEL")]
    model: ModelSource,
    /// The scenario: a file, or `pit-right-rear`
    #[arg(long, value_name = "NAME|FILE")]
    scenario: PathBuf,
    /// Kind of bullet body, as the training data name it; left open if not given
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// Leave the contact point open: it is drawn from that of the training cases
    #[arg(long)]
    open_contact: bool,
    /// Whole curves to draw
    #[arg(long, default_value_t = 0, value_name = "N")]
    samples: usize,
    /// Seed of the draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Folder for bands.csv, mean.csv, prediction.json and the samples
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_enum, default_value_t)]
    units: UnitsArg,
}

const EXAMPLES: &str = "\
Example:
  impactlab predict force --scenario pit-right-rear --samples 5 --out prediction

bands.csv: time, mean and the edges of the 50, 80, 90 and 95 % bands of F_x, F_y and |F|, N.
mean.csv and sample_001.csv, …: force histories that every other command reads.

JSON: impulse_n_s {mean [x, y], magnitude {median, intervals}}, peak_n, duration_s (median and
  intervals at 50, 80, 90, 95 %), pdof_deg, pdof_clock, momentum_impulse_n_s, hooking_probability,
  outside_training [feature, value, range, deviations], is_contact_open, is_body_open";

/// Median and central intervals of a number.
#[derive(Debug, Serialize)]
struct Figure {
    median: f64,
    intervals: Vec<Interval>,
}

#[derive(Debug, Serialize)]
struct Interval {
    level: f64,
    low: f64,
    high: f64,
}

#[derive(Debug, Serialize)]
struct Impulse {
    mean: [f64; 2],
    magnitude: Figure,
}

#[derive(Debug, Serialize)]
struct Answer<'a> {
    scenario: &'a str,
    model: &'a ModelSource,
    impulse_n_s: Impulse,
    peak_n: Figure,
    duration_s: Figure,
    pdof_deg: Option<f64>,
    pdof_clock: Option<u8>,
    momentum_impulse_n_s: [f64; 2],
    hooking_probability: Option<f64>,
    outside_training: &'a [OutsideTraining],
    is_contact_open: bool,
    is_body_open: bool,
    out: Option<&'a Path>,
}

/// Predicts what was asked for.
pub(super) fn run(args: &PredictArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match (&args.what, &args.motion) {
        (Some(What::Force(args)), _) => predict_force(args, console),
        (None, Some(args)) => predict_motion::run(args, console),
        (None, None) => Err(CliError::NothingToPredict),
    }
}

fn predict_force(args: &PredictForceArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let model = args.model.force_model()?;
    let scenario = Scenario::preset_or_file(&args.scenario)?;
    let unsolved = |source| CliError::Scenario { path: args.scenario.clone(), source };
    let mut question = ForceScenario::from_scenario(&scenario).map_err(unsolved)?;
    question.bullet_body = args.body.clone();
    if args.open_contact {
        question.contact_m = None;
        question.bullet_position_m = None;
    }
    let prediction = model.predict(&question)?;
    let mut rng = random_stream(args.seed, "draws", 0);
    let figures = prediction.mixture.sample_figures(N_DRAWS, &mut rng);
    let answer = answer(args, &scenario.name, &prediction, &figures)?;
    if let Some(folder) = &args.out {
        let mut rng = random_stream(args.seed, "samples", 0);
        let samples = prediction.mixture.sample(args.samples, &mut rng);
        write_files(folder, &prediction, &samples, &answer)?;
    }
    if console.json {
        print_json(console.out, &answer)?;
    } else {
        print_text(&answer, args, console)?;
    }
    Ok(Verdict::Clean)
}

fn answer<'a>(
    args: &'a PredictForceArgs,
    name: &'a str,
    prediction: &'a ForcePrediction,
    figures: &CurveFigures,
) -> Result<Answer<'a>, CliError> {
    let mean = [0, 1].map(|axis| prediction.mixture.impulse(axis).mean());
    let pdof = PrincipalDirectionOfForce::from_impulse(mean, 0.0);
    Ok(Answer {
        scenario: name,
        model: &args.model,
        impulse_n_s: Impulse { mean, magnitude: figure(&figures.impulse_magnitude_n_s()) },
        peak_n: figure(&figures.peak_n),
        duration_s: figure(&figures.duration_s),
        pdof_deg: pdof.map(PrincipalDirectionOfForce::angle_deg),
        pdof_clock: pdof.map(PrincipalDirectionOfForce::clock),
        momentum_impulse_n_s: prediction.momentum_impulse_n_s,
        hooking_probability: prediction.hooking_probability,
        outside_training: &prediction.outside,
        is_contact_open: prediction.is_contact_open,
        is_body_open: prediction.is_body_open,
        out: args.out.as_deref(),
    })
}

fn figure(draws: &[f64]) -> Figure {
    let interval = |level| {
        let [low, high] = CurveFigures::interval(draws, level)?;
        Some(Interval { level, low, high })
    };
    Figure {
        median: CurveFigures::median(draws).unwrap_or(0.0),
        intervals: LEVELS.into_iter().filter_map(interval).collect(),
    }
}

fn write_files(
    folder: &Path,
    prediction: &ForcePrediction,
    samples: &[ForceCurve],
    answer: &Answer<'_>,
) -> Result<(), CliError> {
    let to_error = |source| CliError::Folder { path: folder.to_owned(), source };
    fs::create_dir_all(folder).map_err(to_error)?;
    let bands = prediction.mixture.bands(&LEVELS).map_err(crate::force::ForceError::from)?;
    let mean = prediction.mixture.mean();
    write_bands(&folder.join("bands.csv"), &mean, &bands)?;
    let write_curve = |name: String, curve: &ForceCurve| -> Result<(), CliError> {
        let path = folder.join(name);
        let unwritable = |source| CliError::Series { path: path.clone(), source };
        let series = curve.to_history().to_series().map_err(unwritable)?;
        Ok(write_series_csv(&path, &series)?)
    };
    write_curve("mean.csv".to_owned(), &mean)?;
    for (i, sample) in samples.iter().enumerate() {
        write_curve(format!("sample_{:03}.csv", i + 1), sample)?;
    }
    write_atomically(&folder.join("prediction.json"), |out| {
        serde_json::to_writer_pretty(&mut *out, answer)?;
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
    write_atomically(path, |out| {
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

fn print_text(
    answer: &Answer<'_>,
    args: &PredictForceArgs,
    console: &mut Console<'_>,
) -> Result<(), CliError> {
    let units = args.units.into();
    let number = |quantity, value| shown(quantity, value, units);
    let spread = |quantity, figure: &Figure| {
        let interval = figure.intervals.iter().find(|interval| interval.level == 0.9);
        let interval = interval.map_or(String::new(), |interval| {
            let [low, high] = [interval.low, interval.high].map(|x| number(quantity, x));
            format!(" (90 %: {low} to {high})")
        });
        format!("{}{interval}", number(quantity, figure.median))
    };
    writeln!(console.out, "{}\n", answer.scenario)?;
    let [px, py] = answer.impulse_n_s.mean.map(|p| number(Quantity::Impulse, p));
    let pdof = answer.pdof_deg.zip(answer.pdof_clock);
    let pdof =
        pdof.map_or("none".to_owned(), |(deg, clock)| format!("{deg:.1} deg, {clock} o'clock"));
    let hooking = answer.hooking_probability;
    let facts = [
        ("impulse", format!("x {px}, y {py}")),
        ("|impulse|", spread(Quantity::Impulse, &answer.impulse_n_s.magnitude)),
        ("peak", spread(Quantity::Force, &answer.peak_n)),
        ("duration", spread(Quantity::Time, &answer.duration_s)),
        ("PDOF", pdof),
        ("hooking", hooking.map_or("unknown".to_owned(), |p| format!("{:.0} %", 100.0 * p))),
    ];
    print_facts(console.out, &facts)?;
    for open in [("contact point", answer.is_contact_open), ("bullet body", answer.is_body_open)] {
        if open.1 {
            writeln!(console.out, "\nThe {} is open: drawn from the training cases.", open.0)?;
        }
    }
    for outside in answer.outside_training {
        let [low, high] = outside.range;
        writeln!(
            console.out,
            "\nwarning: {} is {:.4}, trained on {low:.4} to {high:.4}: {:.1} standard deviations \
             outside",
            outside.feature, outside.value, outside.deviations
        )?;
    }
    Ok(())
}
