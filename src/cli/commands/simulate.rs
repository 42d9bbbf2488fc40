//! `impactlab simulate`: the motion after an impact or a steer manoeuvre, of one vehicle or of
//! every case of a data set.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{
    EQUATIONS, EndingArgs, INTEGRATORS, OverwriteArg, SAMPLINGS, UNITS, VehicleArg, contact_point,
    count, number, one_value_of,
};
use crate::cli::text::{PrintedAnswer, print_answer};
use impactlab_core::data::write::check_ending;
use impactlab_core::data::{
    ColumnMap, DatasetKind, Existing, Sampling, write_restricted_series_csv,
};
use impactlab_core::ranges::{
    REST_LIMIT, ROAD_FRICTION, ROAD_FRICTION_SIGMA, SIMULATED_DURATION, SPEED, VEHICLE_DRAWS,
    YAW_RATE,
};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{ContactPoint, Equations, Integrator};
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    DEFAULT_DURATION_S, Drive, MotionSource, Question, ScenarioChoice, SeriesFile,
    SimulateDatasetRequest, SimulateRequest,
};

/// Simulate the motion after an impact, or compare a whole data set with the simulation
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
#[command(group(ArgGroup::new("source").required(true).multiple(true)
    .args(["dataset", "scenario", "trajectory", "force", "steer", "fishhook", "wheels", "speed"])))]
#[command(group(ArgGroup::new("start").multiple(true)
    .args(["speed", "vy", "yaw_rate", "steer", "steer_map", "fishhook", "wheels", "wheels_map", "force"])))]
#[command(group(ArgGroup::new("steering")
    .args(["steer", "fishhook", "steer_angle", "steering_wheel"])))]
#[command(group(ArgGroup::new("mapped").args(["force", "trajectory"])))]
pub(in crate::cli) struct SimulateArgs {
    /// Simulate every case of this trajectory data set from its recorded start and force, and
    /// compare; of recorded pairs both vehicles from their recorded starts, through all contacts; of a force
    /// data set the one of --case
    #[arg(long, value_name = "DIR", conflicts_with_all = SINGLE_ONLY)]
    dataset: Option<PathBuf>,
    /// With --dataset: only this case
    #[arg(long, value_name = "NAME", requires = "dataset", conflicts_with_all = NOT_OF_A_DATASET)]
    case: Option<String>,
    /// Simulate both vehicles of this scenario, with the impulse spread over a classic pulse
    #[arg(long, value_name = "NAME|FILE", conflicts_with_all = NOT_WITH_SCENARIO)]
    scenario: Option<PathBuf>,
    /// Simulate a recorded motion from its first sample and its own force, and compare
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = NOT_WITH_TRAJECTORY)]
    trajectory: Option<PathBuf>,
    /// The struck vehicle: a file, or a name from `impactlab vehicles`; a data set has its own, else
    /// reference-2000. A scenario takes over its mass, yaw inertia and outline
    #[arg(long, value_name = "V.toml|PRESET")]
    vehicle: Option<VehicleArg>,
    /// The striking vehicle, where it is simulated; with a data set, mass and inertia are those of the case
    #[arg(id = "bullet", long = "bullet", value_name = "V.toml|PRESET")]
    striking: Option<VehicleArg>,
    /// How the equations of motion are integrated
    #[arg(long, value_parser = one_value_of(INTEGRATORS), default_value = "rk4")]
    integrator: Integrator,
    /// Which equations of motion
    #[arg(long, value_parser = one_value_of(EQUATIONS))]
    equations: Option<Equations>,
    /// Write the trajectory as CSV, 100 Hz (with --dataset: every trajectory, into this folder)
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
    /// Simulate until the vehicle has come to rest, for two minutes or the --duration at most
    #[arg(long, conflicts_with = "trajectory")]
    until_rest: bool,
    /// With --scenario: do not follow both vehicles through all contacts; after the first one each moves
    /// as if it were alone
    #[arg(long, requires = "scenario", conflicts_with_all = NOT_OF_A_SCENARIO)]
    one_contact: bool,
    /// The ground: a site file, whose zones have their own friction
    #[arg(long, value_name = "SITE.toml")]
    site: Option<PathBuf>,
    #[command(flatten)]
    ending: EndingArgs,
    #[command(flatten)]
    single: SingleArgs,
}

/// What a scenario says itself.
const NOT_WITH_SCENARIO: [&str; 6] =
    ["dataset", "trajectory", "start", "map", "sampling", "contact"];

/// What a recorded motion says itself.
const NOT_WITH_TRAJECTORY: [&str; 5] = ["dataset", "scenario", "start", "sampling", "duration"];

/// Sources of another kind than a data set. An option that requires one is not missed by clap where something
/// else is given that excludes the data set, so that what belongs to it has to exclude that as well.
const NOT_OF_A_DATASET: [&str; 3] = ["scenario", "trajectory", "start"];

/// Sources of another kind than a scenario, likewise.
const NOT_OF_A_SCENARIO: [&str; 3] = ["dataset", "trajectory", "start"];

/// What a data set says itself.
const SINGLE_ONLY: [&str; 7] =
    ["start", "map", "sampling", "contact", "friction", "friction_sigma", "duration"];

const EXAMPLES: &str = "\
Examples:
  impactlab simulate --vehicle reference-2000 --speed 72km/h --force datasets/fea/forces/c001.csv \\
      --out motion.csv
  impactlab simulate --vehicle my-car.toml --speed 20 --steer steer.csv
  impactlab simulate --vehicle ford-explorer-2004 --fishhook --speed 45mph --duration 7
  impactlab simulate --scenario pit-right-rear --brake 0.8 --brake-start 0.7s --until-rest
  impactlab simulate --dataset datasets/trajectories-fea --json
  impactlab simulate --dataset datasets/pairs --case d001

A force sample stands for: the mean around its instant in finite-element files (with target_vx
columns, as in forces/ of the data sets); the mean over the coming interval in trajectories (with
fx_body); else the value at its instant. --sampling overrules it.

JSON: impactlab schema simulate --answer says every key with its unit, of a data set impactlab
  schema simulate-dataset --answer; and out, what was written

Exit code 1 if any case failed.";

/// What one vehicle does.
#[derive(Debug, Args)]
struct SingleArgs {
    /// Forward speed at the start, m/s, or with a unit: 72km/h, 45mph; if not given, that
    /// with which a finite-element run begins, or else 20 m/s
    #[arg(long, value_parser = number(SPEED), allow_hyphen_values = true)]
    speed: Option<f64>,
    /// Leftward speed at the start, as --speed; if neither is given, that with which a
    /// finite-element run begins, or else 0
    #[arg(long, value_parser = number(SPEED), allow_hyphen_values = true)]
    vy: Option<f64>,
    /// Yaw rate at the start, rad/s to the left, or with a unit: 30deg/s
    #[arg(long, value_parser = number(YAW_RATE), allow_hyphen_values = true, default_value = "0")]
    yaw_rate: f64,
    /// Steering over time: CSV with time and steer, the angle of the road wheels, or with time and
    /// steering_wheel and --steering-ratio; positive to the left
    #[arg(long, value_name = "FILE")]
    steer: Option<PathBuf>,
    /// Which column of the steer file is what: time=1:s,steer=2:deg
    #[arg(long, value_name = "MAP", requires = "steer",
        conflicts_with_all = ["fishhook", "steer_angle", "steering_wheel"])]
    steer_map: Option<ColumnMap>,
    /// Steer the fishhook of the NHTSA's rollover test, to the left first
    #[arg(long)]
    fishhook: bool,
    /// Torques at the wheels over time: CSV with time and brake_fl … brake_rr, against the rotation,
    /// drive_fl … drive_rr, forwards; N m or with a unit
    #[arg(long, value_name = "FILE")]
    wheels: Option<PathBuf>,
    /// Which column of the file of torques is what: time=1:s,brake_fl=2:N m
    #[arg(long, value_name = "MAP", requires = "wheels")]
    wheels_map: Option<ColumnMap>,
    /// Contact force ON the vehicle over time: CSV with time and fx, fy (world axes) or fx_body,
    /// fy_body (heading axes)
    #[arg(long, value_name = "F.csv")]
    force: Option<PathBuf>,
    /// Which column of the force file or the recorded motion is what: time=1:ms,fx=Kraft X:kN
    #[arg(long, requires = "mapped")]
    map: Option<ColumnMap>,
    /// What a force sample stands for; without it, as the columns suggest
    #[arg(long, value_parser = one_value_of(SAMPLINGS), requires = "force")]
    sampling: Option<Sampling>,
    /// Where the force acts: x, y from the CG in body axes (x forward, y left), z above the
    /// ground, m. The yaw moment follows from it; without it, the file's own mz at CG height, or, if
    /// there is none, the right rear quarter
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true)]
    contact: Option<ContactPoint>,
    /// Peak friction of the road instead of the vehicle file's
    #[arg(long, value_parser = number(ROAD_FRICTION))]
    friction: Option<f64>,
    /// Standard deviation of the friction; 7.5 % of it if not given, 0 if it is known exactly
    #[arg(long, value_name = "SIGMA", value_parser = number(ROAD_FRICTION_SIGMA))]
    friction_sigma: Option<f64>,
    /// Duration, s; 4 if not given
    #[arg(long, value_parser = number(SIMULATED_DURATION))]
    duration: Option<f64>,
    /// Vehicles to draw from what the data sheet of the struck vehicle leaves open; 0 takes the
    /// medians alone; 100 if not given
    #[arg(long, value_name = "N", value_parser = count::<usize>(VEHICLE_DRAWS))]
    vehicle_draws: Option<usize>,
    /// Seed of these draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

/// A report, and where the motions were written.
#[derive(Debug, Serialize)]
struct PrintedSimulation<'a, R: Serialize> {
    #[serde(flatten)]
    report: &'a R,
    out: Option<&'a Path>,
}

/// Simulates one vehicle or a data set.
pub(in crate::cli) fn run(
    args: &SimulateArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match (&args.dataset, &args.case) {
        (Some(root), Some(case)) if DatasetKind::from_folder(root) == Some(DatasetKind::Force) => {
            let source = MotionSource::Case { dataset: root.clone(), case: case.clone() };
            simulate_one(args, source, console)
        }
        (Some(_), _) if args.until_rest || args.ending.ending()?.is_some() => {
            Err(CliError::EndingOfDataset)
        }
        (Some(_), _) if args.site.is_some() => Err(CliError::SiteOfDataset),
        (Some(_), _) if args.single.vehicle_draws.is_some() => Err(CliError::DrawsOfDataset),
        (Some(root), _) => simulate_dataset(args, root, console),
        (None, _) => simulate_one(args, source(args), console),
    }
}

fn simulate_one(
    args: &SimulateArgs,
    source: MotionSource,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let mut request = SimulateRequest {
        source,
        vehicle: VehicleArg::choice(&args.vehicle),
        striking: VehicleArg::choice(&args.striking),
        equations: args.equations,
        integrator: args.integrator,
        friction: args.single.friction,
        friction_sigma: args.single.friction_sigma,
        site: args.site.clone(),
        duration_s: args.single.duration.unwrap_or(match args.until_rest {
            true => REST_LIMIT.high,
            false => DEFAULT_DURATION_S,
        }),
        ending: args.ending.ending()?,
        until_rest: args.until_rest,
        one_contact: args.one_contact,
        vehicle_draws: args.single.vehicle_draws,
        seed: args.single.seed,
        alone: false,
    };
    let existing = args.overwrite.into();
    console.check_target(args.out.as_deref(), existing)?;
    console.take_vehicles(&mut request)?;
    if let Some(path) = args.out.as_deref().filter(|_| !console.print_request) {
        check_ending(path, "csv")?;
    }
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    let motion = answer.analysis.written_motion()?;
    let report = &answer.report;
    let out = args.out.as_deref().filter(|_| motion.is_some());
    if let (Some(path), Some(motion)) = (out, &motion) {
        let restrictions = report.caveats.text();
        write_restricted_series_csv(path, existing, motion, restrictions.as_deref())?;
    }
    let printed = PrintedSimulation { report, out };
    console.print(&printed, |text| {
        print_answer(text, PrintedAnswer::from(report).written(out), args.units)
    })?;
    match &args.out {
        Some(path) if out.is_none() => Err(CliError::NotSimulated { path: path.clone() }),
        _ => Ok(Verdict::Clean),
    }
}

fn simulate_dataset(
    args: &SimulateArgs,
    root: &Path,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = SimulateDatasetRequest {
        dataset: root.to_owned(),
        case: args.case.clone(),
        vehicle: VehicleArg::choice(&args.vehicle),
        equations: args.equations,
        integrator: args.integrator,
    };
    let out = args.out.as_deref();
    let into = out.map(|folder| (folder, args.overwrite.into(), &[][..]));
    let answer = console.ask_into(&request, into, |output, answer| {
        for (case, file, motion) in answer.motions() {
            let path = output.staging().join(format!("{file}.csv"));
            let restrictions = answer.report.caveats_of(case).text();
            write_restricted_series_csv(
                &path,
                Existing::Refuse,
                &motion.series,
                restrictions.as_deref(),
            )?;
        }
        Ok(answer.report.provenance.clone())
    })?;
    let Some(answer) = answer else { return Ok(Verdict::Clean) };
    let report = &answer.report;
    let printed = PrintedSimulation { report, out };
    console.print(&printed, |text| {
        print_answer(text, PrintedAnswer::from(report).written(out), args.units)
    })?;
    Ok(Verdict::from_problems(SimulateDatasetRequest::has_problems(report)))
}

/// What drives the motion of a single vehicle.
fn source(args: &SimulateArgs) -> MotionSource {
    let single = &args.single;
    if let Some(path) = args.scenario.clone() {
        let scenario = ScenarioChoice::File(path);
        return MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
    }
    let file = |path: PathBuf, map: &Option<ColumnMap>| SeriesFile { path, map: map.clone() };
    if let Some(path) = args.trajectory.clone() {
        let contact = single.contact;
        return MotionSource::Trajectory { file: file(path, &single.map), contact };
    }
    MotionSource::Drive(Drive {
        speed_m_s: single.speed,
        vy_m_s: single.vy,
        yaw_rate_rad_s: single.yaw_rate,
        force: single.force.clone().map(|path| file(path, &single.map)),
        sampling: single.sampling,
        contact: single.contact,
        steer: single.steer.clone().map(|path| file(path, &single.steer_map)),
        steering_ratio: match single.steer.is_some() || single.fishhook {
            true => args.ending.steering_ratio,
            false => None,
        },
        fishhook: single.fishhook,
        wheels: single.wheels.clone().map(|path| file(path, &single.wheels_map)),
    })
}
