//! A start with the files of what pushes, steers, brakes and drives the vehicle.

use std::path::Path;

use impactlab_core::uncertainty::{Caveat, CaveatSubject, Caveats};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{AnalysisError, DriveSetup, Settings};
use crate::ask::checks::{check, check_contact, check_given};
use crate::ask::inputs::OpenVehicle;
use crate::caveats::restrictions::{backwards_caveat, doubtful_data_caveats};
use crate::questions::simulate::motion_source::acting_force;
use crate::{Library, SeriesFile, StudyError};
use impactlab_core::data::{
    Channel, ForceHistory, Loaded, Sampling, SeriesError, TIME_TOLERANCE_S, TimeSeries,
    read_force_file, read_steer_file, read_wheels_file,
};
use impactlab_core::ranges::{SPEED, STEER_ANGLE, STEERING_RATIO, YAW_RATE};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::{
    BRAKE_TORQUES, ContactPoint, DRIVE_TORQUES, Ending, SteerHistory, USUAL_STEERING_RATIO,
    VehicleParameters, VehicleState, Wheel, WheelEffort, WheelHistory, angle_at_third_g_rad,
    fishhook, fishhook_amplitude_rad,
};

/// Speed of the struck vehicle before the impact where nothing says it, m/s: 72 km/h.
pub const ASSUMED_SPEED_M_S: f64 = 20.0;

/// Speed below which a car of a model stands, so that its heading does not follow from it, m/s.
const STANDING_M_S: f64 = 0.5;

/// How a vehicle starts and what pushes and steers it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Drive {
    /// Forward speed at the start, m/s.
    pub speed_m_s: Option<f64>,
    /// Leftward speed at the start, m/s; where nobody says it, that with which the file of the force begins, else
    /// 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vy_m_s: Option<f64>,
    /// Yaw rate at the start, rad/s.
    pub yaw_rate_rad_s: f64,
    /// The force on the vehicle.
    pub force: Option<SeriesFile>,
    /// What a force sample stands for; without it, as the columns suggest.
    pub sampling: Option<Sampling>,
    /// Where the force acts; without it, the file's own yaw moment.
    pub contact: Option<ContactPoint>,
    /// The angle of the road wheels or of the steering wheel.
    pub steer: Option<SeriesFile>,
    /// Angle of the steering wheel over that of the road wheels, where one is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steering_ratio: Option<f64>,
    /// Whether the driver steers a fishhook, instead of a file.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub fishhook: bool,
    /// The torques of brakes and drive at the wheels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wheels: Option<SeriesFile>,
}

impl Drive {
    /// What a vehicle is that was left open: one that no force acts on has struck nothing.
    pub(crate) fn open_vehicle(&self) -> OpenVehicle<'static> {
        match self.force {
            Some(_) => OpenVehicle::Unknown,
            None => OpenVehicle::Driven,
        }
    }

    pub(crate) fn name(&self) -> String {
        let file = self.force.as_ref().or(self.steer.as_ref()).or(self.wheels.as_ref());
        let manoeuvre = if self.fishhook { "fishhook" } else { "manoeuvre" };
        file.map_or_else(|| manoeuvre.to_owned(), SeriesFile::title)
    }

    /// Checks every number.
    pub(crate) fn check(&self) -> Result<(), StudyError> {
        check_given("speed_m_s", &SPEED, self.speed_m_s)?;
        check_given("vy_m_s", &SPEED, self.vy_m_s)?;
        check("yaw_rate_rad_s", &YAW_RATE, self.yaw_rate_rad_s)?;
        check_given("steering_ratio", &STEERING_RATIO, self.steering_ratio)?;
        check_contact(self.contact.as_ref())
    }

    pub(crate) fn setup(
        &self,
        settings: &Settings,
        library: &Library,
        caveats: &mut Caveats,
    ) -> Result<DriveSetup, StudyError> {
        self.check_one_control(&settings.ending)?;
        let loaded = self.force.as_ref().map(|file| library.series(file)).transpose()?;
        let [speed_m_s, vy_m_s] = self.velocity_m_s(loaded.as_deref(), caveats)?;
        let which = Phrase::new("the vehicle", "das Fahrzeug");
        caveats.extend(backwards_caveat(which, speed_m_s));
        let mut notes = Vec::new();
        let load = match self.force.as_ref().zip(loaded) {
            Some((file, loaded)) => {
                notes.extend(loaded.notes.iter().map(ToString::to_string));
                caveats.extend(doubtful_data_caveats(&file.title(), &loaded));
                let force = force_of(&loaded, self.sampling, file)?;
                Some(acting_force(force, self.contact, &settings.struck, 0.0, caveats))
            }
            None => None,
        };
        let initial = VehicleState {
            vy_body_m_s: vy_m_s,
            yaw_rate_rad_s: self.yaw_rate_rad_s,
            ..VehicleState::driving_straight(speed_m_s)
        };
        let duration_s = settings.duration_s;
        let steer = match &self.steer {
            Some(file) if !self.fishhook => {
                let loaded = read_steer_file(&file.path, file.map.as_ref())
                    .map_err(|error| error.of_option("--steer-map"))?;
                notes.extend(notes_on(file, &loaded));
                let steer = steer_history(&file.path, &loaded.series, self.steering_ratio)?;
                let acts = |sample: usize| steer.steer_rad.get(sample).is_some_and(|a| *a != 0.0);
                caveats.extend(covered(file, &loaded, duration_s, acts)?);
                Some(steer)
            }
            _ => self.fishhook(&settings.struck, &initial, caveats)?,
        };
        let held = steer.as_ref().and_then(|steer| held_steer(steer, duration_s));
        caveats.extend(held);
        let wheels = match &self.wheels {
            Some(file) => {
                let loaded = read_wheels_file(&file.path, file.map.as_ref())
                    .map_err(|error| error.of_option("--wheels-map"))?;
                notes.extend(notes_on(file, &loaded));
                let wheels = wheel_history(&loaded.series, &settings.struck);
                let free = [WheelEffort::none(); 4];
                let acts = |sample: usize| wheels.wheels.get(sample).is_some_and(|at| *at != free);
                caveats.extend(covered(file, &loaded, duration_s, acts)?);
                Some(wheels)
            }
            None => None,
        };
        Ok(DriveSetup { initial, load, steer, wheels, notes })
    }

    /// Velocity forwards and to the left at the start: as it is said, or as the file of the force begins.
    fn velocity_m_s(
        &self,
        loaded: Option<&Loaded>,
        caveats: &mut Caveats,
    ) -> Result<[f64; 2], StudyError> {
        if let Some(speed_m_s) = self.speed_m_s {
            return Ok([speed_m_s, self.vy_m_s.unwrap_or(0.0)]);
        }
        let start = loaded.and_then(|loaded| loaded.model_start.as_ref());
        let of_file = self.force.as_ref().zip(start.and_then(|start| start.of_force_m_s));
        if let Some((file, velocity_m_s)) = of_file {
            let [vx_m_s, vy_m_s] = velocity_along_x(&file.path, velocity_m_s)?;
            // A lateral speed that is said stands in place of that of the file, also one of 0.
            let of_file_m_s = if self.vy_m_s.is_none() { vy_m_s } else { 0.0 };
            let is_alike = start.is_some_and(|start| start.all_m_s.len() == 1);
            caveats.push(start_of_model(&file.title(), [vx_m_s, of_file_m_s], is_alike));
            return Ok([vx_m_s, self.vy_m_s.unwrap_or(of_file_m_s)]);
        }
        let reason = match start {
            Some(start) => unknown_parts(&start.all_m_s),
            None => Phrase::new(
                "the speed before the impact is not known; another one: --speed",
                "die Geschwindigkeit vor dem Anstoß ist nicht bekannt; eine andere: --speed",
            ),
        };
        let value = Phrase::of(PhraseValue::given(Quantity::Speed, ASSUMED_SPEED_M_S));
        caveats.push(Caveat::assumed(CaveatSubject::Speed, value, reason));
        Ok([ASSUMED_SPEED_M_S, self.vy_m_s.unwrap_or(0.0)])
    }

    /// Checks that not two things steer the vehicle, nor brake or drive it.
    fn check_one_control(&self, ending: &Ending) -> Result<(), StudyError> {
        let steers = [self.steer.is_some(), self.fishhook, ending.steers()];
        let wheels = [self.wheels.is_some(), ending.acts_on_wheels()];
        let is_many = |given: &[bool]| given.iter().filter(|is_given| **is_given).count() > 1;
        for (is_many, what) in [(is_many(&steers), "steer"), (is_many(&wheels), "brake or drive")] {
            if is_many {
                return Err(StudyError::TwoControls { name: self.name(), what });
            }
        }
        Ok(())
    }

    /// The road-wheel angle of a driver who steers a fishhook; `None` for another one.
    fn fishhook(
        &self,
        vehicle: &VehicleParameters,
        initial: &VehicleState<f64>,
        caveats: &mut Caveats,
    ) -> Result<Option<SteerHistory>, StudyError> {
        if !self.fishhook {
            return Ok(None);
        }
        let angle_rad = angle_at_third_g_rad(vehicle);
        let ratio = self.steering_ratio.unwrap_or_else(|| {
            let reason = Phrase::new(
                "the fishhook turns the steering wheel at 720 deg/s; another ratio: --steering-ratio",
                "das Fishhook-Manöver dreht das Lenkrad mit 720 °/s; eine andere Übersetzung: \
                 --steering-ratio",
            );
            let value = Phrase::new("ratio {0}", "Übersetzung {0}")
                .with(PhraseValue::given(Quantity::Ratio, USUAL_STEERING_RATIO));
            caveats.push(Caveat::assumed(CaveatSubject::Steer, value, reason));
            USUAL_STEERING_RATIO
        });
        let amplitude_rad = fishhook_amplitude_rad(angle_rad);
        if angle_rad <= 0.0 || !STEER_ANGLE.contains(amplitude_rad) {
            let vehicle = vehicle.name.clone();
            return Err(StudyError::NoFishhook { vehicle, angle_rad });
        }
        let failed = |source| StudyError::Analysis {
            name: self.name(),
            source: Box::new(AnalysisError::Simulation(source)),
        };
        fishhook(vehicle, initial, amplitude_rad, ratio).map(Some).map_err(failed)
    }
}

/// The velocity with which the parts of a model begin, if the car can head along x of the model with it.
///
/// # Errors
/// [`StudyError::ModelHeading`] if it drives in another direction; [`StudyError::OutOfRange`] if no car is as
/// fast.
fn velocity_along_x(path: &Path, velocity_m_s: [f64; 2]) -> Result<[f64; 2], StudyError> {
    let [vx_m_s, vy_m_s] = velocity_m_s;
    for component_m_s in velocity_m_s {
        check("speed_m_s", &SPEED, component_m_s)?;
    }
    let is_along = vx_m_s >= vy_m_s.abs() || vx_m_s.hypot(vy_m_s) < STANDING_M_S;
    let error = || StudyError::ModelHeading { path: path.to_owned(), vx_m_s, vy_m_s };
    is_along.then_some(velocity_m_s).ok_or_else(error)
}

/// That the speed is the one with which the file of the force begins.
///
/// - `is_alike`: whether all parts of the model begin with it.
fn start_of_model(file: &str, [vx_m_s, vy_m_s]: [f64; 2], is_alike: bool) -> Caveat {
    let speed = |value_m_s| PhraseValue::significant(Quantity::Speed, value_m_s);
    let value = match vy_m_s.abs() < STANDING_M_S {
        true => Phrase::of(speed(vx_m_s)),
        false => Phrase::new("{0}, to the left {1}", "{0}, nach links {1}")
            .with(speed(vx_m_s))
            .with(speed(vy_m_s)),
    };
    let reason = match is_alike {
        true => Phrase::new(
            "in {0} all parts begin with it, taken to head along x of the model; another one: --speed",
            "in {0} beginnen alle Teile mit ihr, Fahrzeugrichtung längs der x-Achse des Modells; eine andere: \
             --speed",
        ),
        false => Phrase::new(
            "in {0} the parts on which this force acts, by their momenta, begin with it, taken to head along x \
             of the model; another one: --speed",
            "in {0} beginnen die Teile, auf die diese Kraft nach ihren Impulsen wirkt, mit ihr, \
             Fahrzeugrichtung längs der x-Achse des Modells; eine andere: --speed",
        ),
    }
    .with(PhraseValue::Name(file.to_owned()));
    Caveat::assumed(CaveatSubject::Speed, value, reason)
}

/// Why a speed is assumed although a file says how fast its parts or nodes begin.
fn unknown_parts(velocities_m_s: &[[f64; 2]]) -> Phrase {
    let velocity = |[vx_m_s, vy_m_s]: &[f64; 2]| {
        let speed = |value_m_s| PhraseValue::significant(Quantity::Speed, value_m_s);
        Phrase::new("{0} along x, {1} along y", "{0} längs x, {1} längs y")
            .with(speed(*vx_m_s))
            .with(speed(*vy_m_s))
    };
    let all = Phrase::joined(velocities_m_s.iter().map(velocity), "; ");
    Phrase::new(
        "which parts of the model this force acts on does not follow from the file; they begin with: \
         {0}; another one: --speed",
        "auf welche Teile des Modells diese Kraft wirkt, geht aus der Datei nicht hervor; sie beginnen mit: \
         {0}; eine andere: --speed",
    )
    .with(PhraseValue::phrase(all))
}

/// The force of a file, under its own meaning of a sample or a given one.
fn force_of(
    loaded: &Loaded,
    sampling: Option<Sampling>,
    file: &SeriesFile,
) -> Result<ForceHistory, StudyError> {
    let sampling = sampling.unwrap_or_else(|| loaded.force_sampling());
    match ForceHistory::from_series(&loaded.series, sampling) {
        Ok(force) => Ok(force),
        Err(source) => {
            // Read as a force file it gives the error that says where and what to do.
            read_force_file(&file.path, file.map.as_ref())?;
            Err(StudyError::Series { path: file.path.clone(), source })
        }
    }
}

/// The remarks on a recording of controls, such as units that nobody states, with its name.
fn notes_on(file: &SeriesFile, loaded: &Loaded) -> Vec<String> {
    loaded.notes.iter().map(|note| format!("{}: {note}", file.title())).collect()
}

/// Checks that a recording of controls covers the motion that it acts in, and says what of it acts
/// before or after that and what a check of it finds.
///
/// - `acts`: whether something acts at the sample of an index.
///
/// # Errors
/// [`StudyError::ControlsOutside`] if the recording and the motion share no time, or if something acts
/// before the start alone, as where the clock of a recorder ends at the impact.
fn covered(
    file: &SeriesFile,
    loaded: &Loaded,
    duration_s: f64,
    acts: impl Fn(usize) -> bool,
) -> Result<Vec<Caveat>, StudyError> {
    let time_s = loaded.series.time_s();
    let (&start_s, &end_s) = match (time_s.first(), time_s.last()) {
        (Some(start_s), Some(end_s)) => (start_s, end_s),
        _ => return Ok(Vec::new()),
    };
    let acts_when = |is_when: &dyn Fn(f64) -> bool| {
        time_s.iter().enumerate().any(|(sample, &at_s)| is_when(at_s) && acts(sample))
    };
    let acts_before = acts_when(&|at_s| at_s < -TIME_TOLERANCE_S);
    let acts_within = acts_when(&|at_s| (-TIME_TOLERANCE_S..=duration_s).contains(&at_s));
    let acts_after = acts_when(&|at_s| at_s > duration_s);
    let shares_no_time = end_s <= TIME_TOLERANCE_S || start_s >= duration_s;
    if shares_no_time || (acts_before && !acts_within) {
        let (path, shift_s) = (file.path.clone(), -start_s);
        return Err(StudyError::ControlsOutside { path, start_s, end_s, duration_s, shift_s });
    }
    let mut caveats = doubtful_data_caveats(&file.title(), loaded);
    let end = || PhraseValue::given(Quantity::Time, duration_s);
    let reason = Phrase::new(
        "the motion begins at 0 s and ends after {0}",
        "die Bewegung beginnt bei 0 s und endet nach {0}",
    )
    .with(end());
    let before = Phrase::new("{0}, what acts before 0 s", "{0}, was vor 0 s wirkt");
    let after = Phrase::new("{0}, what acts after {1}", "{0}, was nach {1} wirkt");
    for (is_lost, what) in [(acts_before, before), (acts_after, after)] {
        let what = what.with(PhraseValue::Name(file.title())).with(end());
        caveats.extend(is_lost.then(|| Caveat::not_used(what, reason.clone())));
    }
    Ok(caveats)
}

/// What stands for the steer angle where its recording does not reach.
fn held_steer(steer: &SteerHistory, duration_s: f64) -> Option<Caveat> {
    let (&start_s, &end_s) = (steer.time_s.first()?, steer.time_s.last()?);
    let (&first_rad, &last_rad) = (steer.steer_rad.first()?, steer.steer_rad.last()?);
    let part = |angle_rad: f64, time_s: f64, [en, de]: [&str; 2]| {
        Phrase::new(format!("{{0}} {en} {{1}}"), format!("{{0}} {de} {{1}}"))
            .with(PhraseValue::given(Quantity::Angle, angle_rad))
            .with(PhraseValue::given(Quantity::Time, time_s))
    };
    let mut held = Vec::new();
    if start_s > TIME_TOLERANCE_S && first_rad != 0.0 {
        held.push(part(first_rad, start_s, ["before", "vor"]));
    }
    if end_s < duration_s - TIME_TOLERANCE_S && last_rad != 0.0 {
        held.push(part(last_rad, end_s, ["after", "nach"]));
    }
    let reason = Phrase::new(
        "the recording of the steer angle does not reach further; its ends are held",
        "die Aufzeichnung des Lenkwinkels reicht nicht weiter; ihre Enden werden gehalten",
    );
    let is_held = !held.is_empty();
    is_held.then(|| Caveat::assumed(CaveatSubject::Steer, Phrase::joined(held, ", "), reason))
}

/// The road-wheel angle of a file: that of the front axle, the mean of its wheels, or that of the
/// steering wheel over the steering ratio.
pub(crate) fn steer_history(
    path: &Path,
    series: &TimeSeries,
    steering_ratio: Option<f64>,
) -> Result<SteerHistory, StudyError> {
    let path = || path.to_owned();
    let history = |steer_rad| SteerHistory { time_s: series.time_s().to_vec(), steer_rad };
    let road_wheel = match (series.get(Channel::Steer), front_wheels(series)) {
        (Some(steer), _) => Some(steer.to_vec()),
        (None, wheels) => wheels.ok(),
    };
    match (road_wheel, series.get(Channel::SteeringWheel), steering_ratio) {
        (Some(steer_rad), _, None) => Ok(history(steer_rad)),
        (Some(_), None, Some(_)) => Err(StudyError::NoSteeringWheel { path: path() }),
        (_, Some(angles_rad), Some(ratio)) => {
            let steer_rad: Vec<f64> = angles_rad.iter().map(|angle| angle / ratio).collect();
            let refused = steer_rad.iter().find_map(|angle| STEER_ANGLE.check(*angle).err());
            match refused {
                None => Ok(history(steer_rad)),
                Some(source) => Err(StudyError::RoadWheel { path: path(), ratio, source }),
            }
        }
        (None, None, _) if has_front_wheel(series) => {
            let in_file = |source| StudyError::Series { path: path(), source };
            front_wheels(series).map(history).map_err(in_file)
        }
        (None, _, None) => Err(StudyError::NoSteeringRatio { path: path() }),
        (None, None, Some(_)) => Err(StudyError::NoSteeringWheel { path: path() }),
    }
}

/// Whether the angle of a front wheel is recorded.
fn has_front_wheel(series: &TimeSeries) -> bool {
    [Channel::SteerFl, Channel::SteerFr].iter().any(|channel| series.get(*channel).is_some())
}

/// Mean angle of the front wheels.
///
/// # Errors
/// [`SeriesError`] if one of them is not recorded.
fn front_wheels(series: &TimeSeries) -> Result<Vec<f64>, SeriesError> {
    let (left, right) = (series.require(Channel::SteerFl)?, series.require(Channel::SteerFr)?);
    Ok(left.iter().zip(right).map(|(left, right)| (left + right) / 2.0).collect())
}

/// The torques of a file over the rolling radius. What it does not record is zero.
fn wheel_history(series: &TimeSeries, vehicle: &VehicleParameters) -> WheelHistory {
    let radius_m = vehicle.tires.rolling_radius_m;
    let at = |sample: usize| {
        let force_n = |channel| {
            let torque_n_m = series.get(channel).and_then(|values| values.get(sample));
            torque_n_m.map_or(0.0, |torque_n_m| torque_n_m / radius_m)
        };
        Wheel::ALL.map(|wheel| WheelEffort {
            braking_n: force_n(BRAKE_TORQUES[wheel.index()]),
            drive_n: force_n(DRIVE_TORQUES[wheel.index()]),
            ..WheelEffort::none()
        })
    };
    let wheels = (0..series.n_samples()).map(at).collect();
    WheelHistory { time_s: series.time_s().to_vec(), wheels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::data::{Dialect, FileKind, ModelStart, Separator};

    /// A lateral speed of 0 that somebody says is not one that nobody says.
    #[test]
    fn a_lateral_speed_is_that_of_the_file_unless_one_is_said() {
        let begins_m_s = [12.0, -1.5];
        let loaded = Loaded {
            kind: FileKind::Force,
            series: TimeSeries::default(),
            columns: Vec::new(),
            notes: Vec::new(),
            dialect: Dialect { separator: Separator::Tab, decimal_comma: false, thousands: None },
            encoding: "binary",
            model_start: Some(ModelStart {
                of_force_m_s: Some(begins_m_s),
                all_m_s: vec![begins_m_s],
            }),
        };
        let velocity = |speed_m_s, vy_m_s| {
            let force = Some(SeriesFile::new("binout"));
            let drive = Drive { speed_m_s, vy_m_s, force, ..Drive::default() };
            let mut caveats = Caveats::default();
            drive.velocity_m_s(Some(&loaded), &mut caveats).unwrap()
        };
        assert_eq!(velocity(None, None), begins_m_s);
        assert_eq!(velocity(None, Some(0.0)), [12.0, 0.0]);
        assert_eq!(velocity(None, Some(2.0)), [12.0, 2.0]);
        assert_eq!(velocity(Some(20.0), None), [20.0, 0.0]);
        assert_eq!(velocity(Some(20.0), Some(2.0)), [20.0, 2.0]);
        let json = serde_json::to_value(Drive::default()).unwrap();
        assert!(json.get("vy_m_s").is_none(), "{json}");
    }
}
