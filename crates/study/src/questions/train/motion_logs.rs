//! Logs of single impacts as data to fine-tune on.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::StudyError;
use crate::ask::checks::{check, check_contact, check_given};
use crate::ask::inputs::data_files::{files_of_sets, logs_in};
use crate::caveats::restrictions::{doubtful_data_caveats, doubtful_note_caveats};
use crate::questions::simulate::drive::steer_history;
use crate::questions::simulate::motion_source::acting_force;
use impactlab_core::data::{
    Channel, ColumnMap, ForceHistory, Loaded, read_any_series, read_motion_log,
};
use impactlab_core::ranges::{INSTANT, LOG_DURATION, STEERING_RATIO};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject, Caveats};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::{ContactLoad, ContactPoint, VehicleParameters};
use impactlab_networks::response::{
    ForceOrigin, LogNoise, LogSettings, LoggedImpact, MotionLog, N_RESIDUAL, ResponseCase,
    average_error_m, rollout,
};

/// How much of a log from the first contact on is learned from where nobody says it, s.
pub const DEFAULT_LOG_DURATION_S: f64 = 4.0;

/// Largest mean distance between a recorded and a simulated path, as a share of the way and at least, m: beyond
/// it something else moved the car than what its log says.
const LARGEST_DISTANCE: (f64, f64) = (0.05, 0.5);

/// Channels that say how the front wheels are turned.
const STEERING: [Channel; 4] =
    [Channel::Steer, Channel::SteerFl, Channel::SteerFr, Channel::SteeringWheel];

/// Logs of single impacts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionLogs {
    /// Log files, and folders of such files.
    pub logs: Vec<PathBuf>,
    /// The contact force of each log, in their order and on their clock; without it, the force is
    /// estimated from the change of momentum.
    #[serde(default)]
    pub forces: Vec<PathBuf>,
    /// Which column of the logs is what.
    #[serde(default)]
    pub map: Option<ColumnMap>,
    /// Which column of the files of the forces is what.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_map: Option<ColumnMap>,
    /// Where the forces act; without it, the yaw moment of the force file.
    #[serde(default)]
    pub contact: Option<ContactPoint>,
    /// First contact on the clock of the logs, s; from the force, or from the motion, if not given.
    #[serde(default)]
    pub impact_s: Option<f64>,
    /// Whether nothing was struck, as in a test drive: then no force is looked for in the motion.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub without_impact: bool,
    /// Angle of the steering wheel over that of the road wheels, for logs that have the former.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steering_ratio: Option<f64>,
    /// How much of a log from the first contact on is learned from, s.
    #[serde(default = "default_duration_s")]
    pub duration_s: f64,
}

fn default_duration_s() -> f64 {
    DEFAULT_LOG_DURATION_S
}

/// What was made of a log.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LogReport {
    /// The file.
    pub log: PathBuf,
    /// Where the motion that is learned from begins on the clock of the log, s.
    pub start_s: f64,
    /// First touch and last separation, s.
    pub contact_s: Option<[f64; 2]>,
    /// Where the force comes from.
    pub force: ForceOrigin,
    /// Impulse [x, y], N s.
    pub impulse_n_s: [f64; 2],
    /// States that are learned from.
    pub n_samples: usize,
    /// Noise that was found in the log.
    pub noise: LogNoise,
}

impl MotionLogs {
    /// Checks every number, and that nothing says of a drive where it was struck.
    pub(crate) fn check(&self) -> Result<(), StudyError> {
        if self.without_impact && (!self.forces.is_empty() || self.impact_s.is_some()) {
            return Err(StudyError::ImpactOfDrive);
        }
        check_contact(self.contact.as_ref())?;
        check_given("impact_s", &INSTANT, self.impact_s)?;
        check_given("steering_ratio", &STEERING_RATIO, self.steering_ratio)?;
        check("duration_s", &LOG_DURATION, self.duration_s)
    }

    /// The logs as trajectories.
    pub(crate) fn read(
        &self,
        vehicle: VehicleParameters,
        caveats: &mut Caveats,
    ) -> Result<(Vec<ResponseCase>, Vec<LogReport>), StudyError> {
        let paths = self.paths()?;
        if !self.forces.is_empty() && self.forces.len() != paths.len() {
            let (n_forces, n_logs) = (self.forces.len(), paths.len());
            return Err(StudyError::ForcesOfLogs { n_forces, n_logs });
        }
        let settings = LogSettings {
            vehicle,
            has_impact: !self.without_impact,
            impact_s: self.impact_s,
            duration_s: self.duration_s,
        };
        let (mut cases, mut reports) = (Vec::new(), Vec::new());
        for (i, path) in paths.iter().enumerate() {
            let log = self.log(path, caveats)?;
            let load = match self.forces.get(i) {
                Some(force) => Some(self.load(force, &settings.vehicle, caveats)?),
                None => None,
            };
            let found = LoggedImpact::from_log(&log, load, &settings)?;
            if found.force == ForceOrigin::Estimated {
                caveats.push(estimated_force(path, &found));
            }
            caveats.extend(unexplained_motion(path, &found.case));
            reports.push(LogReport {
                log: path.clone(),
                start_s: found.start_s,
                contact_s: found.contact_s,
                force: found.force,
                impulse_n_s: found.impulse_n_s,
                n_samples: found.case.states.len(),
                noise: found.noise,
            });
            cases.push(found.case);
        }
        Ok((cases, reports))
    }

    /// A log with its steering as an angle of the road wheels. What is in doubt about it is said.
    fn log(&self, path: &Path, caveats: &mut Caveats) -> Result<MotionLog, StudyError> {
        let loaded = read_motion_log(path, self.map.as_ref())?;
        caveats.extend(doubts(path, &loaded));
        let mut series = loaded.series;
        let in_file = |source| StudyError::Series { path: path.to_owned(), source };
        if STEERING.iter().any(|channel| series.get(*channel).is_some()) {
            let steer = steer_history(path, &series, self.steering_ratio)?;
            series.insert(Channel::Steer, steer.steer_rad).map_err(in_file)?;
        } else {
            caveats.push(straight_ahead(&name_of(path)));
        }
        Ok(MotionLog { path: path.to_owned(), series })
    }

    /// The files, those of a folder by name.
    fn paths(&self) -> Result<Vec<PathBuf>, StudyError> {
        let mut paths = Vec::new();
        for path in &self.logs {
            if !path.is_dir() {
                paths.push(path.clone());
                continue;
            }
            // What a case rests on is known by the folder alone, and data sets come first there.
            let has_sets = !files_of_sets(path).is_empty();
            let logs = if has_sets { Vec::new() } else { logs_in(path)? };
            if logs.is_empty() {
                return Err(StudyError::NoLogs { path: path.clone() });
            }
            paths.extend(logs);
        }
        Ok(paths)
    }

    /// A force with the point where it acts. A force that does not say where it acts is refused: an
    /// answer can say what it assumes, but a network that has learned from it cannot. What is in doubt about the
    /// file is said.
    fn load(
        &self,
        path: &Path,
        vehicle: &VehicleParameters,
        caveats: &mut Caveats,
    ) -> Result<ContactLoad, StudyError> {
        let loaded = read_any_series(path, self.force_map.as_ref())
            .map_err(|error| error.of_option("--force-map"))?;
        caveats.extend(doubts(path, &loaded));
        let in_file = |source| StudyError::Series { path: path.to_owned(), source };
        let force =
            ForceHistory::from_series(&loaded.series, loaded.force_sampling()).map_err(in_file)?;
        if self.contact.is_none() && force.mz_n_m.is_none() {
            return Err(StudyError::NoYawMoment { path: path.to_owned() });
        }
        let (force, contact) =
            acting_force(force, self.contact, vehicle, 0.0, &mut Caveats::default());
        Ok(ContactLoad { recorded_moment: force.mz_n_m.is_some(), force, contact })
    }
}

/// What is in doubt about a file.
fn doubts(path: &Path, loaded: &Loaded) -> impl Iterator<Item = Caveat> {
    let name = name_of(path);
    let of_data = doubtful_data_caveats(&name, loaded);
    of_data.into_iter().chain(doubtful_note_caveats(&name, loaded))
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A log without steering is that of a vehicle whose front wheels stand straight ahead.
///
/// - `name`: of the log.
fn straight_ahead(name: &str) -> Caveat {
    let value = Phrase::new("0 deg throughout", "durchweg 0°");
    let reason = Phrase::new(
        "{0} has no steering: columns steer, or steering_wheel with --steering-ratio",
        "{0} hat keine Lenkung: Spalten steer, oder steering_wheel mit --steering-ratio",
    );
    let reason = reason.with(PhraseValue::Name(name.to_owned()));
    Caveat::assumed(CaveatSubject::Steer, value, reason)
}

/// A force that is in no file.
fn estimated_force(path: &Path, found: &LoggedImpact) -> Caveat {
    let [x, y] = found.impulse_n_s;
    let value = Phrase::new("{0} from {1} on", "{0} ab {1}")
        .with(PhraseValue::three_digits(Quantity::Impulse, x.hypot(y)))
        .with(PhraseValue::fixed(Quantity::Time, found.start_s, 2));
    let reason = Phrase::new(
        "{0} has no force, and this explains its motion; where nothing was struck: --no-impact",
        "{0} hat keine Kraft, und diese erklärt die Bewegung; ohne Anstoß: --no-impact",
    );
    Caveat::assumed(CaveatSubject::Pulse, value, reason.with(PhraseValue::Name(name_of(path))))
}

/// That a motion is not the one that its steering and its force give. A network would learn the difference as
/// that of the car.
fn unexplained_motion(path: &Path, case: &ResponseCase) -> Option<Caveat> {
    let initial = *case.states.first()?;
    let simulated = rollout(&case.vehicle, initial, &case.inputs, [0.0; N_RESIDUAL]);
    let distance_m = average_error_m(&simulated, &case.states);
    let steps = case.states.iter().zip(case.states.iter().skip(1));
    let way_m: f64 = steps.map(|(a, b)| (b.x_m - a.x_m).hypot(b.y_m - a.y_m)).sum();
    let (share, least_m) = LARGEST_DISTANCE;
    if distance_m <= (share * way_m).max(least_m) {
        return None;
    }
    let text = Phrase::new(
        "the path in {0} is on average {1} from the one that its steering and its force give this vehicle over \
         {2}; check unit, side and ratio of the steering, the vehicle, and whether it was struck or braked",
        "Der Weg in {0} liegt im Mittel {1} neben dem, den Lenkung und Kraft diesem Fahrzeug auf {2} geben; zu \
         prüfen sind Einheit, Seite und Übersetzung der Lenkung, das Fahrzeug und ob es angestoßen oder gebremst \
         wurde",
    )
    .with(PhraseValue::Name(name_of(path)))
    .with(PhraseValue::three_digits(Quantity::Length, distance_m))
    .with(PhraseValue::three_digits(Quantity::Length, way_m));
    Some(Caveat::new(CaveatKind::DoubtfulData, text))
}
