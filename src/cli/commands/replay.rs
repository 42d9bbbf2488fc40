//! `impactlab replay`: what a vehicle did up to the first contact, from its event data recorder.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{
    AXLES, OverwriteArg, SIDES, UNITS, VehicleArg, count, number, one_value_of,
};
use crate::cli::text::{PrintedAnswer, print_answer};
use impactlab_core::data::write::check_ending;
use impactlab_core::data::{RecordedSide, write_restricted_series_csv};
use impactlab_core::ranges::{
    HEADING, POSITION, RECORDED_SPEED_SIGMA, REPLAY_DRAWS, REPLAY_START, ROAD_FRICTION,
    ROAD_FRICTION_SIGMA, STEERING_RATIO, STEERING_RATIO_SIGMA,
};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::DrivenAxle;
use impactlab_study::{Answer, ContactPose, DEFAULT_REPLAY_DRAWS, ReplayReport, ReplayRequest};

/// Follow speed and steering of an event data recorder up to the first contact
///
/// The vehicle model drives as the recorder says. The answer is how it meets the other car (speed, sideslip, yaw
/// rate), its way from the first sample on, and where it came from if the place of the contact is said; with
/// intervals, and the recorded yaw rate beside the computed one.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ReplayArgs {
    #[command(flatten)]
    record: RecordArgs,
    /// Write the path of the recorded numbers as CSV, 100 Hz, time 0 at the first contact
    #[arg(long, value_name = "PATH.csv")]
    write: Option<PathBuf>,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

/// The record, and how it is followed.
#[derive(Debug, Args)]
pub(in crate::cli) struct RecordArgs {
    /// The recorder's file: a Bosch CDR report as CSV, or a table with time, speed and steering wheel
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Which event of several, counted from 1
    #[arg(long, value_name = "N")]
    event: Option<usize>,
    /// The vehicle: a file, or a name from `impactlab vehicles`; reference-2000 if not given
    #[arg(long, value_name = "V.toml|PRESET")]
    vehicle: Option<VehicleArg>,
    /// The axle that is driven
    #[arg(long, value_parser = one_value_of(AXLES), default_value = "front")]
    driven: DrivenAxle,
    /// Angle of the steering wheel over that of the road wheels; 16 ± 2 if not given
    #[arg(long, value_name = "RATIO", value_parser = number(STEERING_RATIO),
        allow_hyphen_values = true)]
    steering_ratio: Option<f64>,
    /// Its standard deviation; if not given, 3 % of a ratio that is
    #[arg(long, value_name = "SIGMA", value_parser = number(STEERING_RATIO_SIGMA))]
    steering_ratio_sigma: Option<f64>,
    /// Standard deviation of the recorded speed as a share of it; 4 % if not given
    #[arg(long, value_name = "SHARE", value_parser = number(RECORDED_SPEED_SIGMA))]
    speed_sigma: Option<f64>,
    /// To which side the recorded steering wheel is positive
    #[arg(long, value_parser = one_value_of(SIDES), default_value = "left")]
    steering: RecordedSide,
    /// To which side the recorded yaw rate is positive; in controls.csv of `import` it is left
    #[arg(long, value_parser = one_value_of(SIDES), default_value = "right")]
    yaw_rate: RecordedSide,
    /// Peak friction of the road instead of the vehicle's
    #[arg(long, value_parser = number(ROAD_FRICTION))]
    friction: Option<f64>,
    /// Standard deviation of the friction; that of the data sheet or 7.5 % of it if not given
    #[arg(long, value_name = "SIGMA", value_parser = number(ROAD_FRICTION_SIGMA))]
    friction_sigma: Option<f64>,
    /// From when on samples are followed, s before the crash as the recorder counts: -5; all of the last
    /// 30 s if not given
    #[arg(long, value_name = "TIME", value_parser = number(REPLAY_START), allow_hyphen_values = true)]
    from: Option<f64>,
    /// X of the CG at the first contact, m
    #[arg(long, value_name = "X", value_parser = number(POSITION), allow_hyphen_values = true,
        default_value = "0")]
    x: f64,
    /// Y of the CG at the first contact, m
    #[arg(long, value_name = "Y", value_parser = number(POSITION), allow_hyphen_values = true,
        default_value = "0")]
    y: f64,
    /// Heading at the first contact, to the left of X: 90deg
    #[arg(long, value_name = "ANGLE", value_parser = number(HEADING), allow_hyphen_values = true,
        default_value = "0")]
    heading: f64,
    /// Draws of what is not known
    #[arg(long, value_name = "N", default_value_t = DEFAULT_REPLAY_DRAWS,
        value_parser = count::<usize>(REPLAY_DRAWS))]
    draws: usize,
    /// Seed of the draws
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
}

impl RecordArgs {
    /// The question.
    pub(in crate::cli) fn request(&self) -> ReplayRequest {
        ReplayRequest {
            event: self.event,
            yaw_rate_left: self.yaw_rate == RecordedSide::Left,
            steering_right: self.steering == RecordedSide::Right,
            vehicle: VehicleArg::choice(&self.vehicle),
            driven_axle: self.driven,
            steering_ratio: self.steering_ratio,
            steering_ratio_sigma: self.steering_ratio_sigma,
            speed_sigma: self.speed_sigma,
            friction: self.friction,
            friction_sigma: self.friction_sigma,
            from_s: self.from,
            contact: ContactPose { x_m: self.x, y_m: self.y, yaw_rad: self.heading },
            draws: self.draws,
            seed: self.seed,
            ..ReplayRequest::new(self.file.clone())
        }
    }
}

const EXAMPLES: &str = "\
Examples:
  impactlab replay report.csv --vehicle toyota-camry-2018 --steering-ratio 14.5
  impactlab replay edr.csv --steering-ratio 15.8 --from -3 --x 12.4 --y -3.1 --heading 20deg --write path.csv
  impactlab render replay report.csv --steering-ratio 14.5 --plot yaw-rate --out yaw-rate.png

A table needs a header with units, such as Time [s], Speed [km/h], Steering Wheel Angle [deg]; Yaw Rate [deg/s],
Service Brake and ABS Activity are used if they are there. Time 0 is the crash, before it is negative.

JSON: impactlab schema replay --answer says every key with its unit; and out, what was written";

/// The report, and where the path was written.
#[derive(Debug, Serialize)]
struct PrintedReplay<'a> {
    #[serde(flatten)]
    report: &'a Answer<ReplayReport>,
    out: Option<&'a Path>,
}

/// Follows the record, writes the path and prints the answer.
pub(in crate::cli) fn run(
    args: &ReplayArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let request = args.record.request();
    let (out, existing) = (args.write.as_deref(), args.overwrite.into());
    console.check_target(out, existing)?;
    if let Some(path) = out.filter(|_| !console.print_request) {
        check_ending(path, "csv")?;
    }
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    let report = &answer.report;
    if let Some(path) = out {
        let restrictions = report.caveats.text();
        write_restricted_series_csv(path, existing, &answer.path, restrictions.as_deref())?;
    }
    console.print(&PrintedReplay { report, out }, |text| {
        print_answer(text, PrintedAnswer::from(report).written(out), args.units)
    })?;
    Ok(Verdict::Clean)
}
