//! What drives the motion of a struck vehicle: a case, a recorded motion, a start with files of force
//! and controls, or a scenario.

use crate::caveats::assumed;
use crate::caveats::restrictions::pulling_caveat;
use std::path::PathBuf;
use std::sync::Arc;

use impactlab_core::uncertainty::{Caveat, CaveatSubject, Caveats};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{Analysis, PulseSetup, USUAL_CONTACT_HEIGHT_M, scale_of_car};
use crate::ask::checks::{check, check_contact};
use crate::{Drive, Library, ScenarioChoice, SeriesFile, StudyError, word};
use impactlab_core::data::{Case, Channel, FileKind, ForceAttributes, ForceHistory, Loaded};
use impactlab_core::ranges::{CONTACT_HEIGHT, PULSE_DURATION};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::{ContactPoint, VehicleParameters};

/// Where a force acts where nothing says it: the right rear quarter of a car, where a PIT begins.
pub const ASSUMED_CONTACT: ContactPoint =
    ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: USUAL_CONTACT_HEIGHT_M };

/// What drives a motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum MotionSource {
    /// A case of a data set, with its recorded start and force.
    Case {
        /// The data set.
        dataset: PathBuf,
        /// Name of the case.
        case: String,
    },
    /// A recorded motion, simulated from its first sample if it records its force.
    Trajectory {
        /// The file.
        file: SeriesFile,
        /// Where the force acts; without it, the file's own yaw moment.
        #[serde(default)]
        contact: Option<ContactPoint>,
    },
    /// A start, a force and a steer angle.
    Drive(Drive),
    /// Two vehicles that meet; the impulse is spread over a classic pulse.
    Scenario {
        /// The scenario.
        scenario: ScenarioChoice,
        /// How the impulse is spread over time.
        #[serde(default)]
        pulse: PulseSetup,
    },
}

impl Default for MotionSource {
    /// A start on which nothing acts.
    fn default() -> Self {
        Self::Drive(Drive::default())
    }
}

impl MotionSource {
    /// The source of a file that was opened, by what the file is about.
    ///
    /// - `start`: speed and contact point that the user gave; the file is filled in here.
    pub fn from_file(file: SeriesFile, kind: FileKind, start: Drive) -> Self {
        match kind {
            FileKind::Trajectory => Self::Trajectory { file, contact: start.contact },
            FileKind::Force => Self::Drive(Drive { force: Some(file), ..start }),
            FileKind::Steer => Self::Drive(Drive { steer: Some(file), ..start }),
            FileKind::Wheels => Self::Drive(Drive { wheels: Some(file), ..start }),
        }
    }

    /// Whether the vehicle is driven and no force acts on it.
    pub fn is_alone(&self) -> bool {
        matches!(self, Self::Drive(drive) if drive.force.is_none())
    }

    /// Checks every number of the source.
    pub(crate) fn check(&self) -> Result<(), StudyError> {
        match self {
            Self::Case { .. } => Ok(()),
            Self::Trajectory { contact, .. } => check_contact(contact.as_ref()),
            Self::Drive(drive) => drive.check(),
            Self::Scenario { scenario, pulse } => {
                check("pulse.duration_s", &PULSE_DURATION, pulse.duration_s)?;
                check("pulse.contact_height_m", &CONTACT_HEIGHT, pulse.contact_height_m)?;
                scenario.check()
            }
        }
    }

    /// Whether its force was recorded; that of a scenario is a pulse.
    pub(crate) fn is_recorded(&self) -> bool {
        !matches!(self, Self::Scenario { .. })
    }

    /// What a title calls it.
    pub fn name(&self) -> String {
        match self {
            Self::Case { case, .. } => case.clone(),
            Self::Trajectory { file, .. } => file.path.display().to_string(),
            Self::Drive(drive) => drive.name(),
            Self::Scenario { scenario, .. } => scenario.name(),
        }
    }

    /// The file of the force, where the force is one.
    pub(crate) fn force_file(&self) -> Option<&PathBuf> {
        match self {
            Self::Drive(drive) => drive.force.as_ref().map(|file| &file.path),
            Self::Trajectory { file, .. } => Some(&file.path),
            Self::Case { .. } | Self::Scenario { .. } => None,
        }
    }
}

/// A recorded motion whose columns go together; another kind of file is refused, since its speed is not
/// known.
pub(crate) fn trajectory(library: &Library, file: &SeriesFile) -> Result<Arc<Loaded>, StudyError> {
    let loaded = library.series(file)?;
    if loaded.kind == FileKind::Trajectory {
        loaded.check_consistent(&file.path)?;
        return Ok(loaded);
    }
    Err(StudyError::WrongKind {
        path: file.path.clone(),
        got: format!("a {} file", word(&loaded.kind)),
        expected: "a trajectory; `impactlab simulate --out FILE.csv` makes one",
    })
}

/// The force of a recorded motion; `None` if it records none. One component alone is no force.
pub(crate) fn recorded_force(
    loaded: &Loaded,
    file: &SeriesFile,
) -> Result<Option<ForceHistory>, StudyError> {
    let components = [Channel::Fx, Channel::Fy, Channel::FxBody, Channel::FyBody];
    if components.iter().all(|component| loaded.series.get(*component).is_none()) {
        return Ok(None);
    }
    match ForceHistory::from_series(&loaded.series, loaded.force_sampling()) {
        Ok(force) => Ok(Some(force)),
        Err(source) => Err(StudyError::Series { path: file.path.clone(), source }),
    }
}

/// A force with the point where it acts.
///
/// A given contact point overrules a recorded yaw moment; a recorded yaw moment acts about the CG;
/// without either, the contact point is assumed.
///
/// - `yaw_rad`: heading of the vehicle at the start, rad.
pub(crate) fn acting_force(
    mut force: ForceHistory,
    contact: Option<ContactPoint>,
    vehicle: &VehicleParameters,
    yaw_rad: f64,
    caveats: &mut Caveats,
) -> (ForceHistory, ContactPoint) {
    let pulls = |force: &ForceHistory, contact| pulling_caveat(force, contact, vehicle, yaw_rad);
    if let Some(contact) = contact {
        force.mz_n_m = None;
        caveats.extend(pulls(&force, contact));
        return (force, contact);
    }
    if force.mz_n_m.is_some() {
        let height_m = vehicle.geometry.cg_height_m;
        return (force, ContactPoint { x_body_m: 0.0, y_body_m: 0.0, height_m });
    }
    let reason = Phrase::new(
        "the force has no yaw moment (mz) and nothing says where it acts; another point: --contact",
        "die Kraft hat kein Giermoment (mz), und ihr Angriffspunkt ist nicht angegeben; anderer Punkt: \
         --contact",
    );
    let contact = assumed_contact(vehicle);
    caveats.push(assumed::contact_point(contact, reason));
    caveats.extend(pulls(&force, contact));
    (force, contact)
}

/// Where a force acts that does not say it: the right rear quarter of a car, in the scale of a model of a
/// car.
fn assumed_contact(vehicle: &VehicleParameters) -> ContactPoint {
    let scale = scale_of_car(vehicle.geometry.outer_length_m);
    let ContactPoint { x_body_m, y_body_m, height_m } = ASSUMED_CONTACT;
    let [x_body_m, y_body_m, height_m] = [x_body_m, y_body_m, height_m].map(|m| scale * m);
    ContactPoint { x_body_m, y_body_m, height_m }
}

/// What stands for the rates and the roll with which a recorded motion starts, if it does not say
/// them.
pub(crate) fn start_of_record(loaded: &Loaded) -> Option<Caveat> {
    let is_missing = |channel: &Channel| loaded.series.get(*channel).is_none();
    let missing = [Channel::YawRate, Channel::Roll, Channel::RollRate].into_iter();
    let zero = |channel: Channel| {
        Phrase::new("{0} = 0", "{0} = 0").with(PhraseValue::Term(channel.label().to_owned()))
    };
    let zeros: Vec<Phrase> = missing.filter(is_missing).map(zero).collect();
    let is_assumed = !zeros.is_empty();
    is_assumed.then(|| {
        let reason =
            Phrase::new("the file does not record them", "die Datei zeichnet sie nicht auf");
        let zeros = Phrase::joined(zeros, ", ");
        Caveat::assumed(CaveatSubject::StartOfRecord, zeros, reason)
    })
}

/// What stands for the contact height of a force case that does not state it.
pub(crate) fn contact_height_assumption(case: &Case) -> Result<Option<Caveat>, StudyError> {
    let is_known = ForceAttributes::read(&case.attributes)?.contact_height_m.is_some();
    Ok((!is_known).then(|| {
        let reason = Phrase::new(
            "the case does not say how high the vehicles touch",
            "der Fall sagt nicht, in welcher Höhe sich die Fahrzeuge berühren",
        );
        let height = Phrase::new("that of the CG", "die des Schwerpunkts");
        Caveat::assumed(CaveatSubject::ContactHeight, height, reason)
    }))
}

/// What the pulse of a scenario adds to what the momentum solution says.
///
/// - `height_m`: of the contact, m.
pub(crate) fn pulse_assumptions(pulse: &PulseSetup, height_m: f64) -> Vec<Caveat> {
    let usual = PulseSetup::default();
    let shape = || {
        Caveat::assumed(
            CaveatSubject::Pulse,
            Phrase::new("{0} of {1}", "{0} von {1}")
                .with(PhraseValue::Term(pulse.shape.label().to_owned()))
                .with(PhraseValue::fixed(Quantity::Time, pulse.duration_s, 0).in_unit("ms")),
            Phrase::new(
                "the momentum solution gives the impulse, not the force over time",
                "die Impulslösung liefert den Stoßantrieb, nicht den Kraftverlauf",
            ),
        )
    };
    let height = || {
        let mut reason = Phrase::new(
            "a scenario does not say how high the vehicles touch",
            "ein Szenario sagt nicht, in welcher Höhe sich die Fahrzeuge berühren",
        );
        if height_m < pulse.contact_height_m {
            let scale = pulse.contact_height_m / height_m;
            let of_cars =
                Phrase::new("that of cars, {0}, at 1:{1}", "die von Pkw, {0}, im Maßstab 1:{1}")
                    .with(PhraseValue::given(Quantity::Length, pulse.contact_height_m))
                    .with(PhraseValue::fixed(Quantity::Ratio, scale, 1));
            reason = Phrase::joined([reason, of_cars], "; ");
        }
        let height = Phrase::new("{0} above the ground", "{0} über der Fahrbahn")
            .with(PhraseValue::three_digits(Quantity::Length, height_m));
        Caveat::assumed(CaveatSubject::ContactHeight, height, reason)
    };
    let is_usual = (pulse.shape, pulse.duration_s) == (usual.shape, usual.duration_s);
    let assumed = [is_usual.then(shape), pulse.is_height_open().then(height)];
    assumed.into_iter().flatten().collect()
}

/// Refuses a force that acts at a point far off the struck vehicle.
pub(super) fn refuse_contact_off_vehicle(analysis: &Analysis) -> Result<(), StudyError> {
    let Some(struck) = &analysis.struck else { return Ok(()) };
    let ContactPoint { x_body_m, y_body_m, .. } = struck.contact;
    analysis.footprint.check_contact([x_body_m, y_body_m]).map_err(|source| {
        StudyError::ContactOffVehicle {
            name: analysis.name.clone(),
            vehicle: struck.vehicle.name.clone(),
            source,
        }
    })
}
