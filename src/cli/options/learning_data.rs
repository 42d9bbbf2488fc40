//! Which trajectories or logs a response network learns from.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::{VehicleArg, contact_point, count, number};
use impactlab_core::data::ColumnMap;
use impactlab_core::ranges::{
    INSTANT, LOG_DURATION, STEERING_RATIO, TEST_SHARE as SHARE_OF_TEST, TRAJECTORIES,
};
use impactlab_core::vehicle::ContactPoint;
use impactlab_networks::learning::TEST_SHARE;
use impactlab_study::{DEFAULT_LOG_DURATION_S, FineTuneRequest, MotionLogs};

/// Which trajectories or logs are learned from.
#[derive(Debug, Args)]
pub(in crate::cli) struct LearningDataArgs {
    /// A trajectory data set, or a folder of such sets, of which a quarter of the cases is kept apart
    /// for the test; several if given again
    #[arg(long, value_name = "DIR", required_unless_present = "log")]
    data: Vec<PathBuf>,
    #[command(flatten)]
    logs: LogArgs,
    /// How many trajectories of each data set to learn from; all that are not kept for the test if not
    /// given
    #[arg(long, value_name = "N", value_parser = count::<usize>(TRAJECTORIES))]
    trajectories: Option<usize>,
    /// The struck vehicle: a preset or a file, instead of the data set's own
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// Share of the cases that is kept for the test
    #[arg(long, default_value_t = TEST_SHARE, value_name = "SHARE", value_parser = number(SHARE_OF_TEST))]
    test_share: f64,
    /// Seed of the choice of the trajectories and of all other draws; the split's if not given
    #[arg(long)]
    choice: Option<u64>,
}

/// What excludes the force of a log. An option that requires it is not missed by clap where one of these is
/// given, so that what belongs to the force has to exclude them as well; likewise for logs and data sets.
const NOT_OF_A_FORCE: [&str; 2] = ["data", "no_impact"];

/// Where logs come from.
#[derive(Debug, Args)]
struct LogArgs {
    /// A log of one impact instead of a data set: a file with time, x, y, yaw, and perhaps yaw_rate, vx
    /// and vy, roll, steer; or a folder of CSV files. May be given several times
    #[arg(long, value_name = "LOG.csv|DIR", requires = "vehicle", conflicts_with_all = ["data", "trajectories", "test_share"])]
    log: Vec<PathBuf>,
    /// The contact force of each log, in their order and on their clock; without it, estimated from
    /// the change of momentum
    #[arg(long, value_name = "F.csv", requires = "log", conflicts_with = "data")]
    force: Vec<PathBuf>,
    /// Which column of the logs is what: time=1:s,x=2:m,y=3:m,yaw=4:deg
    #[arg(long, value_name = "MAP", requires = "log", conflicts_with = "data")]
    map: Option<ColumnMap>,
    /// Which column of the files of the forces is what: time=1:ms,fx=Kraft X:kN
    #[arg(long, value_name = "MAP", requires = "force", conflicts_with_all = NOT_OF_A_FORCE)]
    force_map: Option<ColumnMap>,
    /// With --force: where the force acts, x, y from the CG in body axes, z above the ground, m;
    /// without it, the force file's own yaw moment
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true,
        requires = "force", conflicts_with_all = NOT_OF_A_FORCE)]
    contact: Option<ContactPoint>,
    /// First contact on the logs' clock, s; from the force, or from the motion, if not given
    #[arg(long, value_name = "TIME", value_parser = number(INSTANT), allow_hyphen_values = true,
        requires = "log", conflicts_with = "data")]
    impact: Option<f64>,
    /// Nothing was struck, as in a test drive: no force is looked for in the motion
    #[arg(long, requires = "log", conflicts_with_all = ["force", "impact", "data"])]
    no_impact: bool,
    /// Angle of the steering wheel over that of the road wheels, for logs with steering_wheel
    #[arg(long, value_name = "RATIO", value_parser = number(STEERING_RATIO),
        allow_hyphen_values = true, requires = "log", conflicts_with = "data")]
    steering_ratio: Option<f64>,
    /// How much of a log from the first contact on is learned from, s
    #[arg(long, value_name = "TIME", value_parser = number(LOG_DURATION), default_value_t = DEFAULT_LOG_DURATION_S,
        requires = "log", conflicts_with = "data")]
    duration: f64,
}

impl LearningDataArgs {
    /// A request in which only the data are said.
    pub(in crate::cli) fn request(&self) -> FineTuneRequest {
        FineTuneRequest {
            data: self.data.clone(),
            logs: self.logs.logs(),
            trajectories: self.trajectories,
            vehicle: VehicleArg::choice(&self.vehicle),
            test_share: self.test_share,
            choice: self.choice,
            ..FineTuneRequest::default()
        }
    }
}

impl LogArgs {
    /// The logs, if there are any.
    fn logs(&self) -> Option<MotionLogs> {
        (!self.log.is_empty()).then(|| MotionLogs {
            logs: self.log.clone(),
            forces: self.force.clone(),
            map: self.map.clone(),
            force_map: self.force_map.clone(),
            contact: self.contact,
            impact_s: self.impact,
            without_impact: self.no_impact,
            steering_ratio: self.steering_ratio,
            duration_s: self.duration,
        })
    }
}
