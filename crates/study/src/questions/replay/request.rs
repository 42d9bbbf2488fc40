//! The replay of an event data recorder: `replay`.

use std::ops::ControlFlow;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::AnalysisError;
use crate::ask::checks::{check, check_count, check_given};
use crate::ask::inputs::{OpenVehicle, data_name, struck_vehicle};
use crate::caveats::assumed;
use crate::questions::replay::record::Record;
use crate::questions::replay::report::{
    ContactPose, ContactState, DrawnMotion, DrawnSample, ReplayAnswer, ReplayPoint, ReplayReport,
    ReplaySample, StartPose, Travelled, YawRateCheck, estimate, path_times_s,
};
use crate::questions::replay::restrictions::{self, CentralMotion};
use crate::questions::replay::unknowns::{Known, Unknowns};
use crate::{Answer, Event, Library, Observer, Provenance, Question, StudyError, VehicleChoice};
use impactlab_core::data::{Outcome, SeriesError, TimeSeries};
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::interpolate;
use impactlab_core::ranges::{
    HEADING, POSITION, RECORDED_SPEED_SIGMA, REPLAY_DRAWS, REPLAY_START, ROAD_FRICTION,
    ROAD_FRICTION_SIGMA, STEERING_RATIO, STEERING_RATIO_SIGMA,
};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::{
    DrivenAxle, Integrator, PathPoint, RecordedDrive, RoadDraws, SheetQuantity, SimulationError,
    SimulationRun, USUAL_STEERING_RATIO, VehicleDraws, VehicleParameters, simulate_batch,
    usual_road_sigma,
};
use impactlab_reconstruct::evidence::RECORDED_SPEED_SHARE;

/// Draws where nobody says how many.
pub const DEFAULT_REPLAY_DRAWS: usize = 400;

/// Standard deviation of a steering ratio that nobody states: cars have 12 to 20.
const ASSUMED_RATIO_SIGMA: f64 = 2.0;

/// Standard deviation of a steering ratio that is stated, as a share of it: ratios vary with the angle, and
/// steering columns yield.
const STATED_RATIO_SHARE: f64 = 0.03;

/// Draws that are computed together.
const DRAWS_TOGETHER: usize = 64;

/// Asks where a vehicle was up to the first contact, how it moved there, and where it came from, by speed and
/// steering of its event data recorder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReplayRequest {
    /// The recorder's file: a report of a Bosch CDR tool as CSV, or a table with time, speed and angle of the
    /// steering wheel, and units in its header.
    pub recorder: PathBuf,
    /// Which event of several, counted from 1; the first one if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub event: Option<usize>,
    /// Whether the recorded yaw rate is positive to the left; to the right if not, as in SAE J1698.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub yaw_rate_left: bool,
    /// Whether the recorded steering wheel is positive to the right; to the left if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub steering_right: bool,
    /// The vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// The axle that is driven.
    #[serde(default)]
    pub driven_axle: DrivenAxle,
    /// Angle of the steering wheel over that of the road wheels; 16 is assumed if not given.
    #[serde(default)]
    pub steering_ratio: Option<f64>,
    /// Its standard deviation; 3 % of a ratio that is given, 2 of one that is not.
    #[serde(default)]
    pub steering_ratio_sigma: Option<f64>,
    /// Standard deviation of the recorded speed as a share of it; 0.04 if not given.
    #[serde(default)]
    pub speed_sigma: Option<f64>,
    /// Peak friction of the road instead of the vehicle's.
    #[serde(default)]
    pub friction: Option<f64>,
    /// Its standard deviation; if not given that of the data sheet, or 7.5 % of it.
    #[serde(default)]
    pub friction_sigma: Option<f64>,
    /// From when on samples are followed, s on the clock of the recorder; all of the last 30 s if not given.
    #[serde(default)]
    pub from_s: Option<f64>,
    /// Place and heading at the first contact.
    #[serde(default)]
    pub contact: ContactPose,
    /// Number of draws.
    #[serde(default = "default_draws")]
    pub draws: usize,
    /// Seed of the draws.
    #[serde(default)]
    pub seed: u64,
}

fn default_draws() -> usize {
    DEFAULT_REPLAY_DRAWS
}

impl ReplayRequest {
    /// The replay of a file about which nothing else is said.
    pub fn new(recorder: PathBuf) -> Self {
        Self {
            recorder,
            event: None,
            yaw_rate_left: false,
            steering_right: false,
            vehicle: VehicleChoice::default(),
            driven_axle: DrivenAxle::default(),
            steering_ratio: None,
            steering_ratio_sigma: None,
            speed_sigma: None,
            friction: None,
            friction_sigma: None,
            from_s: None,
            contact: ContactPose::default(),
            draws: DEFAULT_REPLAY_DRAWS,
            seed: 0,
        }
    }

    /// The steering ratio, given or assumed.
    pub(super) fn ratio(&self) -> f64 {
        self.steering_ratio.unwrap_or(USUAL_STEERING_RATIO)
    }

    /// The standard deviation of the steering ratio where nobody states it.
    pub fn usual_steering_ratio_sigma(&self) -> f64 {
        match self.steering_ratio {
            Some(ratio) => STATED_RATIO_SHARE * ratio,
            None => ASSUMED_RATIO_SIGMA,
        }
    }

    pub(super) fn known(&self) -> Known {
        let usual_sigma = self.usual_steering_ratio_sigma();
        Known {
            steering_ratio: self.ratio(),
            steering_ratio_sigma: self.steering_ratio_sigma.unwrap_or(usual_sigma),
            speed_sigma: self.speed_sigma.unwrap_or(RECORDED_SPEED_SHARE),
        }
    }

    /// How the friction is drawn where the data sheet of the vehicle does not say it.
    fn road(&self, vehicle: &VehicleParameters) -> Option<RoadDraws> {
        let sheet = vehicle.sheet.as_ref();
        let is_estimated = sheet.is_some_and(|of| of.known(SheetQuantity::Friction).is_none());
        let usual = usual_road_sigma(vehicle.tires.friction);
        let sigma = match self.friction_sigma {
            Some(sigma) => sigma,
            None if is_estimated => return None,
            None => usual,
        };
        (sigma > 0.0).then_some(RoadDraws { sigma, seed: self.seed })
    }

    fn pose(&self) -> [f64; 3] {
        [self.contact.x_m, self.contact.y_m, self.contact.yaw_rad]
    }

    fn name(&self) -> String {
        data_name(&self.recorder)
    }

    fn not_simulated(&self, source: SimulationError) -> StudyError {
        let source = Box::new(AnalysisError::from(source));
        StudyError::Analysis { name: self.name(), source }
    }

    fn no_series(&self, source: SeriesError) -> StudyError {
        let source = Box::new(AnalysisError::Series(source));
        StudyError::Analysis { name: self.name(), source }
    }

    /// The motion of the recorded numbers as they are.
    fn central(
        &self,
        record: &Record,
        vehicle: &VehicleParameters,
    ) -> Result<CentralMotion, StudyError> {
        let unknowns = Unknowns::central(record.len());
        let drive = unknowns.drive(record, &self.known(), vehicle.tires.friction);
        let manoeuvre = drive.manoeuvre(self.driven_axle);
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4);
        let motion = motion.map_err(|source| self.not_simulated(source))?;
        let recorded = drive.motion(vehicle, &motion).map_err(|source| self.no_series(source))?;
        let begin_s = recorded.points.first().map_or(0.0, |point| point.time_s);
        let flags = motion.flags.iter().map(|flag| flag.later_by(begin_s)).collect();
        let (start_s, motion) = (drive.start_s(), recorded.ending_at(self.pose()));
        Ok(CentralMotion { start_s, motion, flags })
    }

    /// The motions of draws of what is not known; those that cannot be computed are left out.
    fn draw(
        &self,
        record: &Record,
        vehicles: &[VehicleParameters],
        path_s: &[f64],
        observer: &mut Observer<'_>,
    ) -> Outcome<Vec<DrawnMotion>> {
        let known = self.known();
        let all: Vec<(Unknowns, &VehicleParameters)> =
            Unknowns::drawn(self.draws, record.len(), self.seed)
                .into_iter()
                .zip(vehicles)
                .collect();
        let mut drawn = Vec::with_capacity(all.len());
        for (idx, part) in all.chunks(DRAWS_TOGETHER).enumerate() {
            let done = (idx * DRAWS_TOGETHER) as u64;
            let progress = Progress::new(done, all.len() as u64, "draws of the recorded drive");
            if let ControlFlow::Break(()) = observer(Event::Progress(progress)) {
                return Outcome::Cancelled;
            }
            let drives: Vec<RecordedDrive> = part
                .iter()
                .map(|(of, vehicle)| of.drive(record, &known, vehicle.tires.friction))
                .collect();
            let manoeuvres: Vec<_> =
                drives.iter().map(|drive| drive.manoeuvre(self.driven_axle)).collect();
            let runs: Vec<SimulationRun<'_>> = part
                .iter()
                .zip(&manoeuvres)
                .map(|((_, vehicle), manoeuvre)| SimulationRun { vehicle, manoeuvre })
                .collect();
            for (((unknowns, vehicle), drive), motion) in
                part.iter().zip(&drives).zip(simulate_batch(&runs))
            {
                let motion = motion.ok().and_then(|motion| drive.motion(vehicle, &motion).ok());
                let Some(motion) = motion else { continue };
                let motion = motion.ending_at(self.pose());
                let [_, last_s] = record.ends_s();
                let shift_s = last_s + unknowns.gap_s(record);
                let steer_rad = |time_s: f64| {
                    interpolate(&drive.time_s, &drive.steer_rad, time_s).unwrap_or(0.0)
                };
                let samples = record.samples.time_s.iter().map(|time_s| {
                    let time_s = time_s - shift_s;
                    [time_s, steer_rad(time_s)]
                });
                let of_draw = [unknowns.steering_ratio(&known), unknowns.yaw_rate_error];
                let motion = DrawnMotion::new(&motion, drive.start_s(), path_s, samples, of_draw);
                drawn.extend(motion);
            }
        }
        Outcome::Complete(drawn)
    }

    fn report_of(
        &self,
        record: &Record,
        central: &CentralMotion,
        path_s: &[f64],
        draws: &[DrawnMotion],
        (vehicle, friction): (&VehicleParameters, f64),
    ) -> ReplayReport {
        let Known { steering_ratio, steering_ratio_sigma, speed_sigma } = self.known();
        let samples = samples(record, draws);
        ReplayReport {
            name: self.name(),
            description: record.description.clone(),
            event: record.event.clone(),
            vehicle: vehicle.name.clone(),
            steering_ratio,
            steering_ratio_sigma,
            speed_sigma,
            friction,
            recorded_s: record.ends_s(),
            longest_gap_s: record.longest_gap_s(),
            at_contact: ContactState::of(draws),
            travelled: Travelled::of(draws),
            contact: self.contact,
            start: StartPose::of(draws),
            path: ReplayPoint::path(&central.motion, path_s, draws),
            yaw_rate: YawRateCheck::new(&samples, draws),
            samples,
            friction_use: estimate(draws, |draw| draw.friction_use),
            draws: self.draws,
            draws_left_out: self.draws - draws.len(),
        }
    }
}

/// The recorded samples beside the draws.
fn samples(record: &Record, draws: &[DrawnMotion]) -> Vec<ReplaySample> {
    let of = |values: &[f64], idx: usize| values.get(idx).copied();
    let sample = |(idx, time_s): (usize, &f64)| {
        let computed = |of: fn(&DrawnSample) -> f64| {
            let value = |draw: &DrawnMotion| draw.at_samples.get(idx).map(of);
            Estimate::from_draws(draws.iter().filter_map(value).collect())
        };
        let controls = &record.samples;
        Some(ReplaySample {
            recorder_time_s: *time_s,
            recorded_speed_m_s: of(&controls.speed_m_s, idx)?,
            steering_wheel_rad: of(&controls.steering_wheel_rad, idx)?,
            recorded_yaw_rate_rad_s: of(&record.yaw_rate_rad_s, idx),
            vx_body_m_s: computed(|at| at.vx_body_m_s),
            yaw_rate_rad_s: computed(|at| at.yaw_rate_rad_s),
            steer_rad: computed(|at| at.steer_rad),
        })
    };
    record.samples.time_s.iter().enumerate().filter_map(sample).collect()
}

/// The motion from the first sample on as a time series.
fn series(central: &CentralMotion) -> Result<TimeSeries, SeriesError> {
    let start = central.motion.at(central.start_s);
    let is_later = |point: &&PathPoint| point.time_s > central.start_s + 1e-6;
    let later = central.motion.points.iter().filter(is_later).copied();
    PathPoint::series(&start.into_iter().chain(later).collect::<Vec<_>>())
}

impl Question for ReplayRequest {
    type Answer = ReplayAnswer;
    type Report = Answer<ReplayReport>;
    const NAME: &'static str = "replay";

    fn check(&self) -> Result<(), StudyError> {
        check_given("steering_ratio", &STEERING_RATIO, self.steering_ratio)?;
        check_given("steering_ratio_sigma", &STEERING_RATIO_SIGMA, self.steering_ratio_sigma)?;
        check_given("speed_sigma", &RECORDED_SPEED_SIGMA, self.speed_sigma)?;
        check_given("friction", &ROAD_FRICTION, self.friction)?;
        check_given("friction_sigma", &ROAD_FRICTION_SIGMA, self.friction_sigma)?;
        check_given("from_s", &REPLAY_START, self.from_s)?;
        check("contact.x_m", &POSITION, self.contact.x_m)?;
        check("contact.y_m", &POSITION, self.contact.y_m)?;
        check("contact.yaw_rad", &HEADING, self.contact.yaw_rad)?;
        check_count("draws", &REPLAY_DRAWS, self.draws)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        _library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ReplayAnswer>, StudyError> {
        let mut caveats = Caveats::default();
        let record = self.record()?;
        let vehicle = struck_vehicle(&self.vehicle, &OpenVehicle::Driven, &mut caveats)?;
        let vehicle = match self.friction {
            Some(friction) => vehicle.with_friction(friction),
            None => vehicle,
        };
        let central = self.central(&record, &vehicle)?;
        let path_s = path_times_s(central.start_s);
        let road = self.road(&vehicle);
        let draws = VehicleDraws::new(&vehicle, true, road, self.draws, self.seed);
        let vehicles = draws.vehicles(&vehicle);
        let drawn = self.draw(&record, &vehicles, &path_s, observer);
        let Outcome::Complete(drawn) = drawn else { return Ok(Outcome::Cancelled) };
        if drawn.is_empty() {
            return Err(self.not_simulated(SimulationError::Diverged { time_s: 0.0 }));
        }
        let friction = Estimate::from_draws(
            vehicles.iter().map(|vehicle| vehicle.tires.friction).collect::<Vec<f64>>(),
        );
        let of = (&vehicle, friction.median);
        let report = self.report_of(&record, &central, &path_s, &drawn, of);
        caveats.extend(assumed::estimates(&vehicle));
        caveats.extend(self.assumed(road.as_ref(), &vehicle));
        caveats.extend(restrictions::all(&record, &central, &report, &vehicle));
        let path = series(&central).map_err(|source| self.no_series(source))?;
        let provenance = Provenance::from_seed(self.seed);
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(ReplayAnswer { report, path }))
    }
}
