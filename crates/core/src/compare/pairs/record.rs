//! A data set of recorded pairs:
//!
//! ```text
//! cases.csv           a row for each case: the cars, the friction of the road, initial states, contacts
//! cases/<case>.csv    motions of both cars, what their drivers did, the contact force
//! vehicles/<car>.toml data sheets
//! ```
//!
//! The struck car is called `target` there, the striking one `bullet`. Columns have SI units and are
//! found by their names; others than those that are needed may stand beside them.

use std::path::{Path, PathBuf};

use crate::compare::initial_state;
use crate::data::{
    AttributeColumn, Attributes, CASES_FILE, Channel, DataError, SeriesError, Table, TimeSeries,
    TomlError, TomlFile, named_cases, names_a_file,
};
use crate::ranges::{
    BRAKE_SHARE, CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, CONTROL_TIME, ROAD_FRICTION,
};
use crate::vehicle::{
    AntiLock, Braking, ClosedLoop, Controls, DEFAULT_BRAKE_RISE_S, DrivenAxle, Manoeuvre,
    MultibodyRecord, OUTPUT_INTERVAL_S, StabilityControl, SteerHistory, VehicleParameters,
    WheelEffort, WheelHistory,
};

const NO_PAIR: &str = "the pair cannot be simulated";
const FRICTION: AttributeColumn = AttributeColumn::needed("mu", ROAD_FRICTION);
const HEIGHT: AttributeColumn = AttributeColumn::optional("contact_height_m", CONTACT_HEIGHT);
const FIRST_CONTACT: AttributeColumn = AttributeColumn::optional("first_contact_s", CONTROL_TIME);
const PLACE_X: AttributeColumn = AttributeColumn::optional("contact_x_m", CONTACT_X);
const PLACE_Y: AttributeColumn = AttributeColumn::optional("contact_y_m", CONTACT_Y);
const BRAKE_REACTION: AttributeColumn =
    AttributeColumn::optional("target_reaction_s", CONTROL_TIME);
const BRAKE_DECELERATION: AttributeColumn =
    AttributeColumn::optional("target_brake_g", BRAKE_SHARE);

/// Force from which on the recorded vehicles are in contact, N.
const CONTACT_FORCE_N: f64 = 100.0;

/// Share of the front axle in the brake torque of a car of which only the sum is recorded: a usual
/// layout of the brakes of a car.
const FRONT_BRAKE_SHARE: f64 = 0.62;

/// Words for the cars in the names of columns, struck and striking.
const CARS: [&str; 2] = ["target", "bullet"];

/// A folder of recorded pairs.
#[derive(Debug, Clone)]
pub struct PairRecords {
    root: PathBuf,
    rows: Vec<(String, Attributes)>,
}

/// What the table of cases says of a pair, beside numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairAttributes {
    /// Kind of the collision, such as `pit`; empty if it is not said.
    pub kind: String,
    /// Names of the struck and of the striking car.
    pub cars: [String; 2],
    /// Whether the struck car has electronic stability control.
    pub has_stability_control: bool,
    /// The case with the same conditions without stability control.
    pub twin_without_stability_control: Option<String>,
}

/// The contact of a recorded pair.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedContact {
    /// When it begins, s; `None` if it is not said.
    pub first_s: Option<f64>,
    /// Where the struck car is touched first, body axes from its CG, m; `None` if it is not said.
    pub place_m: Option<[f64; 2]>,
    /// Contact force on the struck car over time, world axes, N: means over the interval that
    /// follows.
    pub force_world_n: [Vec<f64>; 2],
}

/// A recorded pair.
#[derive(Debug, Clone)]
pub struct PairCase {
    /// Its name.
    pub name: String,
    /// What the table says of it.
    pub attributes: PairAttributes,
    /// The struck and the striking car on the road of the case.
    pub vehicles: [VehicleParameters; 2],
    /// Their initial states and what their drivers did, over the time of the record.
    pub manoeuvres: [Manoeuvre; 2],
    /// Mean height of their bumpers above the ground, m; `None` if neither file nor table has it.
    pub contact_height_m: Option<f64>,
    /// The motions that were recorded: pose, velocities in body axes, yaw rate.
    pub motions: [TimeSeries; 2],
    /// How the driver of the struck car presses the brake pedal, over the time of the record; `None` if he
    /// does not, or nothing says so. The recorded brake torques are what systems of the car left of it.
    pub brake_pedal: Option<Braking>,
    /// Their contact.
    pub contact: RecordedContact,
}

/// Reason why a recorded pair cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PairCaseError {
    /// A file or a cell of the table.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A data sheet.
    #[error(transparent)]
    Vehicle(#[from] TomlError),
    /// The samples of a file.
    #[error("{}", path.display())]
    Series {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        #[source]
        source: SeriesError,
    },
}

impl PairRecords {
    /// Whether a folder is a data set of pairs: it has `cases.csv`, `cases/` and `vehicles/`.
    pub fn is_at(root: &Path) -> bool {
        root.join(CASES_FILE).is_file()
            && ["cases", "vehicles"].iter().all(|folder| root.join(folder).is_dir())
    }

    /// The files from which a data set of pairs is loaded, in the order of their names: the table of cases,
    /// and the files of the cases and cars that it names. Others in the folder are not of the data set; a
    /// folder that is none has none.
    pub fn files(root: &Path) -> Vec<PathBuf> {
        if !Self::is_at(root) {
            return Vec::new();
        }
        let mut files = vec![root.join(CASES_FILE)];
        for (name, row) in Self::open(root).map(|records| records.rows).unwrap_or_default() {
            files.push(case_file(root, &name));
            let cars = PairAttributes::read(&row).cars.into_iter();
            files.extend(cars.filter(|car| names_a_file(car)).map(|car| car_file(root, &car)));
        }
        files.retain(|file| file.is_file());
        files.sort();
        files.dedup();
        files
    }

    /// Reads the table of cases. No file of a case is read.
    ///
    /// # Errors
    /// [`DataError`] if `cases.csv` cannot be read or a case has no name that can be that of a file.
    pub fn open(root: &Path) -> Result<Self, DataError> {
        let table = Table::read_cases(&root.join(CASES_FILE))?;
        Ok(Self { root: root.to_owned(), rows: named_cases(&table)? })
    }

    /// Names of the cases in the order of the table.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().map(|(name, _)| name.as_str())
    }

    /// What the table says of a case; `None` if it has none of this name.
    pub fn attributes(&self, name: &str) -> Option<PairAttributes> {
        self.row(name).map(PairAttributes::read)
    }

    fn row(&self, name: &str) -> Option<&Attributes> {
        self.rows.iter().find(|(row, _)| row == name).map(|(_, attributes)| attributes)
    }

    /// Loads a case; `None` if the table has none of this name.
    ///
    /// # Errors
    /// [`PairCaseError`] with file, line and column.
    pub fn load(&self, name: &str) -> Option<Result<PairCase, PairCaseError>> {
        self.row(name).map(|row| self.load_row(name, row))
    }

    fn load_row(&self, name: &str, row: &Attributes) -> Result<PairCase, PairCaseError> {
        let attributes = PairAttributes::read(row);
        let friction = row.require(&FRICTION, NO_PAIR)?;
        let path = case_file(&self.root, name);
        let columns = Columns { table: Table::read(&path)? };
        let [struck, striking] = [0, 1].map(|i| self.car(row, CARS[i], &attributes.cars[i]));
        let cars = [struck?, striking?];
        let in_file = |source| PairCaseError::Series { path: path.clone(), source };
        let [struck, striking] = CARS.map(|car| columns.motion(car));
        let motions = [struck?.map_err(in_file)?, striking?.map_err(in_file)?];
        let time_s = motions[0].time_s();
        let duration_s = time_s.last().copied().unwrap_or(0.0).max(OUTPUT_INTERVAL_S);
        let manoeuvre = |i: usize| -> Result<Manoeuvre, PairCaseError> {
            let controls = columns.controls(CARS[i], time_s, &cars[i])?;
            let initial = initial_state(&motions[i]).map_err(in_file)?;
            Ok(Manoeuvre { initial, controls, duration_s, ..Manoeuvre::default() })
        };
        let manoeuvres = [manoeuvre(0)?, manoeuvre(1)?];
        let heights_m = [0, 1].map(|i| cars[i].bumper_height_m);
        let contact_height_m = match heights_m {
            [Some(struck), Some(striking)] => Some((struck + striking) / 2.0),
            _ => row.optional(&HEIGHT)?,
        };
        let first_s = row.optional(&FIRST_CONTACT)?;
        let contact = RecordedContact {
            first_s,
            place_m: row.optional(&PLACE_X)?.zip(row.optional(&PLACE_Y)?).map(<[f64; 2]>::from),
            force_world_n: [
                columns.numbers("contact_fx_n")?.unwrap_or_default(),
                columns.numbers("contact_fy_n")?.unwrap_or_default(),
            ],
        };
        Ok(PairCase {
            name: name.to_owned(),
            attributes,
            vehicles: cars.map(|car| car.vehicle.with_friction(friction)),
            manoeuvres,
            contact_height_m,
            motions,
            brake_pedal: brake_pedal(row, first_s, friction)?,
            contact,
        })
    }

    /// The data sheet of a car.
    ///
    /// - `column`: in which its name stands.
    fn car(&self, row: &Attributes, column: &str, name: &str) -> Result<PairCar, PairCaseError> {
        if !names_a_file(name) {
            let expected = "the name of a file of the folder vehicles, without .toml";
            return Err(row.refused(column, format!("{name:?}"), expected.to_owned()).into());
        }
        let path = car_file(&self.root, name);
        let text = TomlFile::read(&path)?;
        let vehicle = VehicleParameters::parse(&text, &path)?;
        let record: Option<MultibodyRecord> = TomlFile { path: &path, text: &text }.to().ok();
        Ok(PairCar {
            vehicle,
            bumper_height_m: record.as_ref().and_then(MultibodyRecord::bumper_height_m),
            driven: record.as_ref().and_then(MultibodyRecord::driven_axle).unwrap_or_default(),
        })
    }
}

/// The file of a case in a data set of pairs.
fn case_file(root: &Path, case: &str) -> PathBuf {
    root.join("cases").join(format!("{case}.csv"))
}

/// The data sheet of a car in a data set of pairs.
fn car_file(root: &Path, car: &str) -> PathBuf {
    root.join("vehicles").join(format!("{car}.toml"))
}

impl PairCase {
    /// Time for which the recorded vehicles are in contact, s; `None` without a recorded force.
    pub fn contact_s(&self) -> Option<f64> {
        let [fx, fy] = self.recorded_force()?;
        let sizes_n = fx.iter().zip(fy).map(|(x, y)| x.hypot(*y));
        let in_contact =
            sizes_n.zip(self.intervals_s()).filter(|(size_n, _)| *size_n > CONTACT_FORCE_N);
        Some(in_contact.map(|(_, interval_s)| interval_s).sum())
    }

    /// Size of the recorded impulse on the struck vehicle over all contacts, N s; `None` without a recorded
    /// force.
    pub fn impulse_n_s(&self) -> Option<f64> {
        let impulse = |force: &[f64]| -> f64 {
            let steps = force.iter().zip(self.intervals_s());
            steps.map(|(force_n, interval_s)| force_n * interval_s).sum()
        };
        let [fx, fy] = self.recorded_force()?;
        Some(impulse(fx).hypot(impulse(fy)))
    }

    fn recorded_force(&self) -> Option<[&[f64]; 2]> {
        let [fx, fy] = &self.contact.force_world_n;
        (!fx.is_empty() && fx.len() == fy.len()).then_some([fx, fy])
    }

    /// A force is the mean over the interval that follows its instant.
    fn intervals_s(&self) -> impl Iterator<Item = f64> {
        self.motions[0].time_s().windows(2).map(|pair| pair[1] - pair[0])
    }

    /// The initial state of the struck car, steer angle and drive torques as recorded, and our systems in the
    /// place of the recorded brake torques: the pedal acts through an anti-lock system where the car has
    /// one.
    ///
    /// - `has_stability_control`: whether the car has one, of which nothing else is stated.
    pub fn struck_with_own_systems(&self, has_stability_control: bool) -> Manoeuvre {
        let mut manoeuvre = self.manoeuvres[0].clone();
        let esc = has_stability_control.then(StabilityControl::default);
        let own = self.brake_pedal.and_then(|brake| brake.abs);
        let abs = own.or_else(|| esc.map(|_| AntiLock::default()));
        let closed_loop = ClosedLoop { esc, abs, brake: self.brake_pedal, ..ClosedLoop::default() };
        manoeuvre.controls.closed_loop = closed_loop.acts_on_wheels().then_some(closed_loop);
        if let Some(history) = &mut manoeuvre.controls.wheels {
            history.wheels.iter_mut().flatten().for_each(|wheel| wheel.braking_n = 0.0);
        }
        manoeuvre
    }
}

/// A car of a pair.
struct PairCar {
    vehicle: VehicleParameters,
    bumper_height_m: Option<f64>,
    driven: DrivenAxle,
}

impl PairAttributes {
    fn read(row: &Attributes) -> Self {
        let text = |name: &str| row.text(name).map(str::trim).unwrap_or_default().to_owned();
        Self {
            kind: text("kind"),
            cars: CARS.map(text),
            has_stability_control: row.flag("esc").unwrap_or(false),
            twin_without_stability_control: Some(text("esc_twin_of"))
                .filter(|name| !name.is_empty()),
        }
    }
}

/// The brake pedal of a driver of whom the table says that he brakes.
///
/// - `first_s`: first contact, from which his reaction counts; `friction`: of the road.
fn brake_pedal(
    row: &Attributes,
    first_s: Option<f64>,
    friction: f64,
) -> Result<Option<Braking>, DataError> {
    if row.text("target_driver").map(str::trim) != Some("brake") {
        return Ok(None);
    }
    let (Some(first_s), Some(reaction_s), Some(deceleration_g)) =
        (first_s, row.optional(&BRAKE_REACTION)?, row.optional(&BRAKE_DECELERATION)?)
    else {
        return Ok(None);
    };
    let abs = row.flag("target_abs").unwrap_or(false).then(AntiLock::default);
    let share = deceleration_g / friction;
    let braking = Braking::new(first_s + reaction_s, share, DEFAULT_BRAKE_RISE_S);
    Ok(Some(Braking { front_share: Some(FRONT_BRAKE_SHARE), abs, ..braking }))
}

/// The columns of the file of a case by their names.
struct Columns {
    table: Table,
}

impl Columns {
    fn idx(&self, name: &str) -> Option<usize> {
        self.table.header().iter().position(|column| column == name)
    }

    /// The numbers of a column that may be missing.
    fn numbers(&self, name: &str) -> Result<Option<Vec<f64>>, DataError> {
        self.idx(name).map(|idx| self.table.numbers(idx, "")).transpose()
    }

    fn required(&self, name: &str) -> Result<Vec<f64>, DataError> {
        self.numbers(name)?.ok_or_else(|| DataError::MissingAttribute {
            path: self.table.path().to_owned(),
            line: self.table.header_line(),
            name: name.to_owned(),
            consequence: NO_PAIR,
        })
    }

    /// The motion of a car; the inner error is about the instants.
    fn motion(&self, car: &str) -> Result<Result<TimeSeries, SeriesError>, DataError> {
        use Channel as C;
        let mut channels = Vec::new();
        for (channel, name) in [
            (C::X, "x_m"),
            (C::Y, "y_m"),
            (C::Yaw, "yaw_rad"),
            (C::Vx, "vx_m_s"),
            (C::Vy, "vy_m_s"),
            (C::YawRate, "yaw_rate_rad_s"),
        ] {
            channels.push((channel, self.required(&format!("{car}_{name}"))?));
        }
        for (channel, name) in [(C::Roll, "roll_rad"), (C::RollRate, "roll_rate_rad_s")] {
            let values = self.numbers(&format!("{car}_{name}"))?;
            channels.extend(values.map(|values| (channel, values)));
        }
        let time_s = self.required("time_s")?;
        Ok((|| {
            let mut series = TimeSeries::new(time_s)?;
            channels
                .into_iter()
                .try_for_each(|(channel, values)| series.insert(channel, values))?;
            series.check_starts_at_zero(OUTPUT_INTERVAL_S / 2.0)?;
            Ok(series)
        })())
    }

    /// What the driver of a car did: steer angle of the front wheels, brake and drive torques.
    fn controls(&self, word: &str, time_s: &[f64], car: &PairCar) -> Result<Controls, DataError> {
        let named = |name: &str| self.numbers(&format!("{word}_{name}"));
        let steer_rad = match (named("steer_rad")?, named("steer_fl_rad")?, named("steer_fr_rad")?)
        {
            (Some(steer), ..) => Some(steer),
            (None, Some(left), Some(right)) => {
                Some(left.iter().zip(&right).map(|(left, right)| (left + right) / 2.0).collect())
            }
            _ => None,
        };
        let n = time_s.len();
        let zeros = || vec![0.0; n];
        let of_wheels = ["fl", "fr", "rl", "rr"].map(|it| named(&format!("brake_{it}_n_m")));
        let [fl, fr, rl, rr] = of_wheels;
        let brakes_n_m = match (fl?, fr?, rl?, rr?) {
            (Some(fl), Some(fr), Some(rl), Some(rr)) => [fl, fr, rl, rr],
            _ => {
                let sum = named("brake_n_m")?.unwrap_or_else(zeros);
                let share = |share: f64| sum.iter().map(|torque| share * torque / 2.0).collect();
                let (front, rear): (Vec<f64>, Vec<f64>) =
                    (share(FRONT_BRAKE_SHARE), share(1.0 - FRONT_BRAKE_SHARE));
                [front.clone(), front, rear.clone(), rear]
            }
        };
        let drive_n_m = named("drive_n_m")?.unwrap_or_else(zeros);
        let driven = match car.driven {
            DrivenAxle::Front => [0.5, 0.5, 0.0, 0.0],
            DrivenAxle::Rear => [0.0, 0.0, 0.5, 0.5],
            DrivenAxle::All => [0.25; 4],
        };
        let radius_m = car.vehicle.tires.rolling_radius_m;
        let wheels = |sample: usize| {
            std::array::from_fn(|wheel| WheelEffort {
                braking_n: brakes_n_m[wheel][sample].max(0.0) / radius_m,
                drive_n: driven[wheel] * drive_n_m[sample] / radius_m,
                locked: 0.0,
            })
        };
        Ok(Controls {
            steer: steer_rad.map(|steer_rad| SteerHistory { time_s: time_s.to_vec(), steer_rad }),
            wheels: Some(WheelHistory {
                time_s: time_s.to_vec(),
                wheels: (0..n).map(wheels).collect(),
            }),
            ..Controls::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is recorded of the brakes of the struck car gives way to our systems.
    #[test]
    fn own_systems_stand_in_the_place_of_recorded_brake_torques() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/pairs");
        let records = PairRecords::open(&root).unwrap();
        let case = |name: &str| records.load(name).unwrap().unwrap();
        let brakes = |manoeuvre: &Manoeuvre| {
            let wheels = &manoeuvre.controls.wheels.as_ref().unwrap().wheels;
            wheels.iter().flatten().map(|wheel| wheel.braking_n).fold(0.0, f64::max)
        };
        // A driver who brakes.
        let braked = case("d009e");
        let pedal = braked.brake_pedal.unwrap();
        assert!((pedal.start_s - (0.457 + 1.408)).abs() < 1e-9, "{pedal:?}");
        assert!((pedal.share_of_friction - 0.984 / 0.822).abs() < 1e-9, "{pedal:?}");
        assert!(brakes(&braked.manoeuvres[0]) > 1000.0);
        for has_stability_control in [false, true] {
            let own = braked.struck_with_own_systems(has_stability_control);
            assert_eq!(brakes(&own), 0.0);
            let closed_loop = own.controls.closed_loop.as_ref().unwrap();
            assert_eq!(closed_loop.esc.is_some(), has_stability_control);
            assert!(closed_loop.abs.is_some() && closed_loop.brake == Some(pedal));
            assert_eq!(own.controls.steer, braked.manoeuvres[0].controls.steer);
            assert_eq!(own.initial, braked.manoeuvres[0].initial);
        }
        // A driver who does not: without stability control nothing brakes the car.
        let steered = case("d006e");
        assert_eq!(steered.brake_pedal, None);
        assert!(steered.struck_with_own_systems(false).controls.closed_loop.is_none());
        let own = steered.struck_with_own_systems(true).controls.closed_loop.unwrap();
        assert!(own.esc.is_some() && own.abs.is_some() && own.brake.is_none());
        // The table has the same contact.
        let [contact_s, impulse_n_s] = [braked.contact_s().unwrap(), braked.impulse_n_s().unwrap()];
        let row = records.row("d009e").unwrap();
        let [x, y] = ["impulse_x_n_s", "impulse_y_n_s"].map(|name| row.number(name).unwrap());
        assert!((impulse_n_s / x.hypot(y) - 1.0).abs() < 0.01, "{impulse_n_s}");
        let table_s = row.number("contact_total_s").unwrap();
        assert!((contact_s - table_s).abs() < 0.1, "{contact_s} {table_s}");
    }
}
