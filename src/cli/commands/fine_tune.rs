//! `impactlab fine-tune response`: fine-tunes the response network on trajectories.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_settings};
use crate::cli::options::{TrainingArgs, VehicleArg, contact_point, count, number};
use crate::cli::text::{Trained, print_response_training};
use crate::data::ColumnMap;
use crate::learning::{ModelFile, TEST_SHARE};
use crate::ranges::{INSTANT, LOG_DURATION, TEST_SHARE as SHARE_OF_TEST, TRAJECTORIES};
use crate::shipped::ModelSource;
use crate::study::{DEFAULT_LOG_DURATION_S, FineTuneRequest, Learning, ModelChoice, MotionLogs};
use crate::vehicle::ContactPoint;

/// Fine-tune a network on data of your own
#[derive(Debug, Args)]
pub(in crate::cli) struct FineTuneArgs {
    #[command(subcommand)]
    what: FineTunedNetwork,
}

#[derive(Debug, Subcommand)]
enum FineTunedNetwork {
    /// The response network: force history and vehicle to motion after the impact
    Response(FineTuneResponseArgs),
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
struct FineTuneResponseArgs {
    /// A pre-trained response network: `shipped-pretrained` or a file; without one all layers are
    /// trained, from random weights
    #[arg(long, value_name = "MODEL")]
    model: Option<ModelSource>,
    /// A trajectory data set, or a folder of such sets, of which a quarter of the cases is kept apart
    /// for the test; several if given again
    #[arg(long, value_name = "DIR", required_unless_present = "log")]
    data: Vec<PathBuf>,
    #[command(flatten)]
    logs: LogArgs,
    /// Learn how cars differ too, from data sets of several cars, for cars of which there are no data
    #[arg(long, requires = "model", conflicts_with = "log")]
    fleet: bool,
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
    #[command(flatten)]
    training: TrainingArgs,
}

const EXAMPLES: &str = "\
Examples:
  impactlab fine-tune response --model shipped-pretrained \\
      --data datasets/trajectories-fea --trajectories 20 --out response.safetensors
  impactlab fine-tune response --data datasets/trajectories-fea --data datasets/trajectories-pulse \\
      --out r.safetensors
  impactlab fine-tune response --model shipped-pretrained --fleet \\
      --data datasets/trajectories-fleet --data datasets/trajectories-fea --out any-car.safetensors
  impactlab fine-tune response --model shipped-pretrained \\
      --log impact.csv --vehicle scaled-target-100 --out scaled.safetensors

A log is smoothed (position, yaw and what else it has of yaw rate and velocity) and taken from the
first contact on. Without a force file the impulse is the one that explains the change of momentum.
With a single log there is nothing to calibrate on: the uncertainty is a guess. Without --config
effects.ridge and effects.common are those for few samples, see --print-config.

A training that was killed goes on with --resume to the same weights as if it had not been.

JSON: model, data, data_digest, seed, n_simulated, train, n_test, n_parameters, seconds, epochs, loss,
  balance, latents, keeps_latents, left_out, assumptions; with --log: logs [{log, start_s, contact_s [s, s] or null, force
  (recorded, estimated, none), impulse_n_s [x, y], n_samples, noise {position_m, velocity_m_s,
  yaw_rad, yaw_rate_rad_s}}]";

/// Where logs come from.
#[derive(Debug, Args)]
pub(in crate::cli) struct LogArgs {
    /// A log of one impact instead of a data set: CSV with time, x, y, yaw, and perhaps yaw_rate, vx
    /// and vy, roll, steer; or a folder of such files. May be given several times
    #[arg(long, value_name = "LOG.csv|DIR", requires = "vehicle", conflicts_with_all = ["data", "trajectories", "test_share"])]
    log: Vec<PathBuf>,
    /// The contact force of each log, in their order and on their clock; without it, estimated from
    /// the change of momentum
    #[arg(long, value_name = "F.csv", requires = "log")]
    force: Vec<PathBuf>,
    /// Which column of the logs is what: time=1:s,x=2:m,y=3:m,yaw=4:deg
    #[arg(long, value_name = "MAP", requires = "log")]
    map: Option<ColumnMap>,
    /// With --force: where the force acts, x, y from the CG in body axes, z above the ground, m;
    /// without it, the force file's own yaw moment
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true, requires = "force")]
    contact: Option<ContactPoint>,
    /// First contact on the logs' clock, s; from the force, or from the motion, if not given
    #[arg(long, value_name = "TIME", value_parser = number(INSTANT), allow_hyphen_values = true, requires = "log")]
    impact: Option<f64>,
    /// How much of a log from the first contact on is learned from, s
    #[arg(long, value_name = "TIME", value_parser = number(LOG_DURATION), default_value_t = DEFAULT_LOG_DURATION_S, requires = "log")]
    duration: f64,
}

/// Fine-tunes what was asked for.
pub(in crate::cli) fn run(
    args: &FineTuneArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.what {
        FineTunedNetwork::Response(args) => fine_tune_response(args, console),
    }
}

fn fine_tune_response(
    args: &FineTuneResponseArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = FineTuneRequest {
        learning: if args.fleet { Learning::Fleet } else { Learning::Network },
        model: args.model.clone().map(ModelChoice::from),
        data: args.data.clone(),
        logs: args.logs.logs(),
        trajectories: args.trajectories,
        vehicle: VehicleArg::choice(&args.vehicle),
        test_share: args.test_share,
        choice: args.choice,
        training: args.training.options(),
    };
    if args.training.print_config {
        return print_settings(&request.settings(&console.library)?.0, console);
    }
    let existing = args.training.existing(console)?;
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    answer.model.save(&args.training.out, existing)?;
    let trained = Trained { model: &args.training.out, report: &answer.report };
    console.print(&trained, |out| print_response_training(out, &trained))?;
    Ok(Verdict::Clean)
}

impl LogArgs {
    /// The logs, if there are any.
    pub(in crate::cli) fn logs(&self) -> Option<MotionLogs> {
        (!self.log.is_empty()).then(|| MotionLogs {
            logs: self.log.clone(),
            forces: self.force.clone(),
            map: self.map.clone(),
            contact: self.contact,
            impact_s: self.impact,
            duration_s: self.duration,
        })
    }
}
