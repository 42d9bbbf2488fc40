//! `impactlab simulate`: the motion after an impact or a steer manoeuvre, of one vehicle or of
//! every case of a data set. Here are the arguments of both.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::cli::CliError;
use crate::cli::quantity::{UnitsArg, contact_point, friction, speed_m_s, time_s, yaw_rate_rad_s};
use crate::cli::run::{Console, Verdict};
use crate::cli::{simulate_dataset, simulate_single};
use crate::data::{ColumnMap, Sampling};
use crate::vehicle::{ContactPoint, Equations, Integrator};

/// Simulate the motion after an impact, or compare a whole data set with the simulation
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct SimulateArgs {
    /// Simulate every case of this trajectory data set from its recorded start and force, and
    /// compare
    #[arg(long, value_name = "DIR", conflicts_with_all = SINGLE_ONLY)]
    pub(super) dataset: Option<PathBuf>,
    /// With --dataset: only this case
    #[arg(long, value_name = "NAME", requires = "dataset")]
    pub(super) case: Option<String>,
    /// A vehicle file, or a name from `impactlab vehicles`; a data set has its own
    #[arg(long, value_name = "V.toml|PRESET", required_unless_present = "dataset")]
    pub(super) vehicle: Option<String>,
    /// How the equations of motion are integrated
    #[arg(long, value_enum, default_value_t)]
    pub(super) integrator: IntegratorArg,
    /// Which equations of motion
    #[arg(long, value_enum)]
    pub(super) equations: Option<EquationsArg>,
    /// Write the trajectory as CSV, 100 Hz (with --dataset: every trajectory, into this folder)
    #[arg(long, value_name = "PATH")]
    pub(super) out: Option<PathBuf>,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_enum, default_value_t)]
    pub(super) units: UnitsArg,
    #[command(flatten)]
    pub(super) single: SingleArgs,
}

const SINGLE_ONLY: [&str; 11] = [
    "speed",
    "vy",
    "yaw_rate",
    "steer",
    "steer_map",
    "force",
    "map",
    "sampling",
    "contact",
    "friction",
    "duration",
];

const EXAMPLES: &str = "\
Examples:
  impactlab simulate --vehicle reference-2000 --speed 72km/h --force datasets/fea/forces/c001.csv \\
      --out motion.csv
  impactlab simulate --vehicle my-car.toml --speed 20 --steer steer.csv
  impactlab simulate --dataset datasets/trajectories-fea --json

A force sample stands for: the mean around its instant in finite-element files (with target_vx
columns, as in forces/ of the data sets); the mean over the coming interval in trajectories (with
fx_body); else the value at its instant. --sampling overrules it.

JSON, one vehicle: vehicle, equations, integrator, friction, duration_s, force {path, sampling, axes,
  impulse_n_s [x, y], contact_start_s, contact_end_s, yaw_moment}, delta_v_m_s [x, y] and
  delta_v_magnitude_m_s over the contact (null without), end {x_m, y_m, yaw_rad, roll_rad,
  vx_m_s, vy_m_s, yaw_rate_rad_s, speed_m_s}, distance_m, largest_yaw_change_rad,
  flags [{kind, time_s, wheel, roll_rad, message}], out

JSON, data set: dataset, vehicle, equations, integrator, cases [{case, spin, average_error_m, final_error_m,
  final_heading_error_rad, horizon_error_m (at 0.5, 1, 2, 4 s), rmse_*, flags}], overall, spinning
  and not_spinning {average_error_m, final_error_m, final_heading_error_rad,
  rmse_yaw_rate_rad_s: each {n, mean, std, median, p90, min, max}}, failures [text], out

Exit code 1 if any case failed.";

/// What one vehicle does.
#[derive(Debug, Args)]
pub(super) struct SingleArgs {
    /// Forward speed at the start, m/s, or with a unit: 72km/h, 45mph
    #[arg(long, value_parser = speed_m_s, allow_hyphen_values = true,
        required_unless_present = "dataset")]
    pub(super) speed: Option<f64>,
    /// Leftward speed at the start, as --speed
    #[arg(long, value_parser = speed_m_s, allow_hyphen_values = true, default_value = "0")]
    pub(super) vy: f64,
    /// Yaw rate at the start, rad/s to the left, or with a unit: 30deg/s
    #[arg(long, value_parser = yaw_rate_rad_s, allow_hyphen_values = true, default_value = "0")]
    pub(super) yaw_rate: f64,
    /// Road-wheel angle over time: CSV with time and steer, positive to the left
    #[arg(long, value_name = "FILE")]
    pub(super) steer: Option<PathBuf>,
    /// Which column of the steer file is what: time=1:s,steer=2:deg
    #[arg(long, value_name = "MAP", requires = "steer")]
    pub(super) steer_map: Option<ColumnMap>,
    /// Contact force ON the vehicle over time: CSV with time and fx, fy (world axes) or fx_body,
    /// fy_body (heading axes)
    #[arg(long, value_name = "F.csv")]
    pub(super) force: Option<PathBuf>,
    /// Which column of the force file is what: time=1:ms,fx=Kraft X:kN
    #[arg(long, requires = "force")]
    pub(super) map: Option<ColumnMap>,
    /// What a force sample stands for; without it, as the columns suggest
    #[arg(long, value_enum, requires = "force")]
    pub(super) sampling: Option<SamplingArg>,
    /// Where the force acts: x, y from the CG in body axes (x forward, y left), z above the
    /// ground, m. The yaw moment follows from it; without it, the file's own mz at CG height
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true,
        requires = "force")]
    pub(super) contact: Option<ContactPoint>,
    /// Peak friction of the road instead of the vehicle file's
    #[arg(long, value_parser = friction)]
    pub(super) friction: Option<f64>,
    /// Duration, s
    #[arg(long, value_parser = time_s, default_value = "4")]
    pub(super) duration: f64,
}

/// How the equations of motion are integrated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum IntegratorArg {
    /// Classical Runge–Kutta, 1 ms: the reference
    #[default]
    Rk4,
    /// Explicit Euler, 10 ms: the paper's baseline
    Euler,
}

impl From<IntegratorArg> for Integrator {
    fn from(integrator: IntegratorArg) -> Self {
        match integrator {
            IntegratorArg::Rk4 => Self::Rk4,
            IntegratorArg::Euler => Self::Euler,
        }
    }
}

/// Which equations of motion; without the option, the vehicle file says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum EquationsArg {
    /// The paper's, mended
    Corrected,
    /// The paper's, as printed: an ablation that diverges
    Paper,
}

impl From<EquationsArg> for Equations {
    fn from(equations: EquationsArg) -> Self {
        match equations {
            EquationsArg::Corrected => Self::Corrected,
            EquationsArg::Paper => Self::Paper,
        }
    }
}

/// What a force sample stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum SamplingArg {
    /// The value at its instant
    Instant,
    /// The mean over an interval centred at its instant
    CentredMean,
    /// The mean from its instant to the next one
    ComingMean,
}

impl From<SamplingArg> for Sampling {
    fn from(sampling: SamplingArg) -> Self {
        match sampling {
            SamplingArg::Instant => Self::Instant,
            SamplingArg::CentredMean => Self::CentredMean,
            SamplingArg::ComingMean => Self::ComingMean,
        }
    }
}

/// Simulates one vehicle or a data set.
pub(super) fn run(args: &SimulateArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match &args.dataset {
        Some(root) => simulate_dataset::run(args, root, console),
        None => simulate_single::run(args, console),
    }
}
