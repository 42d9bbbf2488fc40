//! `impactlab predict`: the distribution of the motion after an impact.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::files::{MotionFiles, write_json, write_motion_prediction};
use crate::cli::options::{
    EndingArgs, OverwriteArg, UNITS, VehicleArg, contact_point, count, number, one_value_of,
    window_s,
};
use crate::cli::text::print_answer;
use impactlab_core::data::{ColumnMap, DatasetKind};
use impactlab_core::ranges::{
    DRAWS, REST_LIMIT, ROAD_FRICTION, ROAD_FRICTION_SIGMA, VEHICLE_DRAWS,
};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::ContactPoint;
use impactlab_networks::response::STEP_S;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    Answer, DEFAULT_DRAWS, DEFAULT_DURATION_S, ForceSource, MotionSource, PredictMotionReport,
    PredictMotionRequest, ScenarioChoice, SeriesFile, SimulateRequest,
};

/// Sources of another kind than a scenario. An option that requires one is not missed by clap where something
/// else is given that excludes the scenario, so that what belongs to it has to exclude that as well.
const NOT_OF_A_SCENARIO: [&str; 2] = ["dataset", "trajectory"];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct PredictMotionArgs {
    /// The scenario, both vehicles and where they meet: a file, or `pit-right-rear`
    #[arg(long, value_name = "NAME|FILE", requires = "out",
        required_unless_present_any = ["dataset", "trajectory", "force"])]
    scenario: Option<PathBuf>,
    /// Instead: a data set, of which --case says the impact
    #[arg(
        long,
        value_name = "DIR",
        requires = "case",
        requires = "out",
        conflicts_with = "scenario"
    )]
    dataset: Option<PathBuf>,
    /// The case of the data set
    #[arg(long, value_name = "NAME", requires = "dataset", conflicts_with_all = ["scenario", "trajectory"])]
    case: Option<String>,
    /// Instead: a recorded motion, whose own force is taken
    #[arg(long, value_name = "FILE.csv", requires = "out", conflicts_with_all = ["scenario", "dataset"])]
    trajectory: Option<PathBuf>,
    /// Which column of the recorded motion is what: time=1:ms,x=2:m,fx=Kraft X:kN
    #[arg(long, value_name = "MAP", requires = "trajectory", conflicts_with_all = ["scenario", "dataset"])]
    map: Option<ColumnMap>,
    /// The struck vehicle: a preset or a file; a data set has its own, else reference-2000. A scenario takes
    /// over its mass, yaw inertia and outline
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// The striking vehicle, likewise, where it is followed
    #[arg(id = "bullet", long = "bullet", value_name = "NAME|FILE", requires = "scenario",
        conflicts_with_all = NOT_OF_A_SCENARIO)]
    striking: Option<VehicleArg>,
    /// A force history instead of the predicted one
    #[arg(long, value_name = "FORCE.csv")]
    force: Option<PathBuf>,
    /// Which column of the force file is what: time=1:ms,fx=Kraft X:kN
    #[arg(long, value_name = "MAP", requires = "force", conflicts_with_all = ["given_force", "force_model"])]
    force_map: Option<ColumnMap>,
    /// Of a scenario, instead of the predicted force a classic pulse that carries the impulse of the
    /// momentum solution; that of a case is its own unless --force-model is given
    #[arg(long, conflicts_with_all = ["force", "force_model"])]
    given_force: bool,
    /// With --trajectory: where the force acts, as in `simulate`; needed where --force names a force
    /// without a yaw moment
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true,
        requires = "trajectory", conflicts_with_all = ["scenario", "dataset"])]
    contact: Option<ContactPoint>,
    /// The force network: `shipped`, which is asked of a scenario where nothing is said, or a file
    #[arg(long, value_name = "MODEL", conflicts_with = "force")]
    force_model: Option<ModelSource>,
    /// The response network: `shipped`, `shipped-pretrained` or a file
    #[arg(long, default_value_t, value_name = "MODEL")]
    response_model: ModelSource,
    /// The ground: a site file, whose zones have their own friction; how likely the vehicles come to its
    /// lanes and kerbs is said
    #[arg(long, value_name = "SITE.toml", requires = "scenario", conflicts_with_all = NOT_OF_A_SCENARIO)]
    site: Option<PathBuf>,
    /// Friction of the road, instead of the vehicle's
    #[arg(long, value_name = "MU", value_parser = number(ROAD_FRICTION))]
    friction: Option<f64>,
    /// Standard deviation of the friction; 7.5 % of it if not given, 0 if it is known exactly
    #[arg(long, value_name = "SIGMA", value_parser = number(ROAD_FRICTION_SIGMA))]
    friction_sigma: Option<f64>,
    /// Force histories to draw
    #[arg(long, default_value_t = DEFAULT_DRAWS, value_name = "N", value_parser = count::<usize>(DRAWS))]
    draws: usize,
    /// Vehicles to draw from what the data sheet of the struck vehicle and the road leave open, at least
    /// one for each force; 0 takes the medians alone; if not given, 200, or 32 for one vehicle by itself
    #[arg(long, value_name = "N", value_parser = count::<usize>(VEHICLE_DRAWS))]
    vehicle_draws: Option<usize>,
    /// How long, s; 4 if not given; a recorded motion has its own duration
    #[arg(long, value_name = "S", value_parser = number(REST_LIMIT))]
    duration: Option<f64>,
    /// Follow the vehicle until it has come to rest, for two minutes or the --duration at most
    #[arg(long)]
    until_rest: bool,
    /// With --scenario: do not follow both vehicles through all contacts; after the first one each moves
    /// as if it were alone
    #[arg(long, requires = "scenario", conflicts_with_all = NOT_OF_A_SCENARIO)]
    one_contact: bool,
    /// Seed of the draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Window of time of the density map, s, instead of the end
    #[arg(long, value_parser = window_s, value_name = "FROM,TO")]
    window: Option<[f64; 2]>,
    /// Folder for trajectory.csv, density.csv, outcome.json, pictures and their numbers
    // A force alone reaches `source`, which says what it lacks.
    #[arg(long, value_name = "DIR", required_unless_present = "force")]
    out: Option<PathBuf>,
    /// Replace files that exist already
    #[arg(long)]
    overwrite: bool,
    /// Units of text and pictures (JSON and tables are always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Examples:
  impactlab predict --scenario pit-right-rear --out prediction
  impactlab predict --scenario pit-right-rear --brake 0.8 --brake-start 0.7s --until-rest \\
      --out prediction

trajectory.csv: time, central path (nothing uncertain), mean, standard deviation and edges of the 50
  and 90 % bands of X, Y, yaw, v_x, v_y and yaw rate. density.csv: probability density of the position of the CG at the end, or its
  mean over the window, on a grid.
scene.png and one picture per quantity, each with its numbers as CSV beside it (pictures need the
  build with the window).

JSON: impactlab schema predict-motion --answer says every key with its unit;
  and files, what was written";

/// The report, and which files were written.
#[derive(Debug, Serialize)]
struct PrintedMotion<'a> {
    #[serde(flatten)]
    report: &'a Answer<PredictMotionReport>,
    files: &'a [PathBuf],
}

/// Files that are written whatever is predicted.
const KNOWN_FILES: [&str; 3] = ["trajectory.csv", "density.csv", "outcome.json"];

/// Predicts a motion.
pub(in crate::cli) fn run(
    args: &PredictMotionArgs,
    ending: &EndingArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let ending = ending.ending()?;
    let says_itself = args.trajectory.is_some()
        || args.dataset.as_deref().and_then(DatasetKind::from_folder)
            == Some(DatasetKind::Trajectory);
    if says_itself && ending.is_some() {
        return Err(CliError::EndingOfDataset);
    }
    let wanted_s = args.duration.unwrap_or(match args.until_rest {
        true => REST_LIMIT.high,
        false => DEFAULT_DURATION_S,
    });
    let source = source(args)?;
    let force = force_source(args, &source);
    let mut request = PredictMotionRequest {
        motion: SimulateRequest {
            vehicle: VehicleArg::choice(&args.vehicle),
            striking: VehicleArg::choice(&args.striking),
            friction: args.friction,
            friction_sigma: args.friction_sigma,
            site: args.site.clone(),
            duration_s: wanted_s,
            until_rest: args.until_rest,
            one_contact: args.one_contact,
            ending,
            vehicle_draws: args.vehicle_draws,
            ..SimulateRequest::new(source)
        },
        force,
        force_map: args.force_map.clone(),
        response_model: args.response_model.clone().into(),
        draws: args.draws,
        seed: args.seed,
    };
    console.take_vehicles(&mut request.motion)?;
    if args.scenario.is_some() {
        check_window_end(args.window, wanted_s)?;
    }
    let mut files = Vec::new();
    let existing = OverwriteArg::from_flag(args.overwrite).into();
    let folder = args.out.as_deref().ok_or(CliError::NothingToPredict)?;
    let out = (folder, existing, &KNOWN_FILES[..]);
    let answer = console.ask_into(&request, Some(out), |output, answer| {
        check_window_end(args.window, answer.forecast.end_s())?;
        let (staging, units) = (output.staging(), args.units);
        let wanted = MotionFiles { folder: staging, window_s: args.window, units };
        let names = write_motion_prediction(&wanted, answer)?;
        files = names.iter().map(|name| output.path_of(name)).collect();
        // What lies in the folder does not say where the folder is.
        let named: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
        let printed = PrintedMotion { report: &answer.report, files: &named };
        write_json(&staging.join("outcome.json"), &printed)?;
        Ok(answer.report.provenance.clone())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let printed = PrintedMotion { report: &answer.report, files: &files };
    let report = &answer.report;
    console.print(&printed, |out| print_answer(out, report, args.units))?;
    Ok(Verdict::Clean)
}

/// Refuses a window of time that ends after the motion.
///
/// - `end_s`: last instant of the motion, s.
pub(super) fn check_window_end(window_s: Option<[f64; 2]>, end_s: f64) -> Result<(), CliError> {
    match window_s {
        // The end of a recorded motion need not be a multiple of the step.
        Some([_, to_s]) if to_s > end_s + STEP_S => Err(CliError::WindowOutside { to_s, end_s }),
        _ => Ok(()),
    }
}

fn source(args: &PredictMotionArgs) -> Result<MotionSource, CliError> {
    if let Some(path) = args.scenario.clone() {
        let scenario = ScenarioChoice::File(path);
        return Ok(MotionSource::Scenario { scenario, pulse: PulseSetup::default() });
    }
    if let Some(path) = &args.trajectory {
        let file = SeriesFile { path: path.clone(), map: args.map.clone() };
        let contact = args.contact;
        return Ok(MotionSource::Trajectory { file, contact });
    }
    match (args.dataset.clone(), args.case.clone(), args.force.clone()) {
        (Some(dataset), Some(case), _) => Ok(MotionSource::Case { dataset, case }),
        (_, _, Some(path)) => Err(CliError::ForceAlone { path }),
        _ => Err(CliError::NothingToPredict),
    }
}

fn force_source(args: &PredictMotionArgs, source: &MotionSource) -> ForceSource {
    match (&args.force, &args.force_model) {
        (Some(path), _) => ForceSource::File(path.clone()),
        (None, _) if args.given_force || args.trajectory.is_some() => ForceSource::Given,
        (None, Some(model)) => ForceSource::Predicted(model.clone().into()),
        (None, None) => ForceSource::usual(source),
    }
}
