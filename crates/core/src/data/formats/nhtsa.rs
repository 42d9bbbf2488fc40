//! Crash tests of the NHTSA vehicle database: the description `vNNNNN.EV5` with the curves
//! `vNNNNN.001` … beside it.
//!
//! ```text
//! # Source: NHTSA Vehicle Database - Test Number: 10146
//! ----- EV5 -----
//! ----- TEST -----
//! V5|title|objective|date|laboratory|contract|reference|type|configuration|…|(14) closing speed km/h|
//!     (15) angle of the impact|…
//! ----- VEHICLE -----
//! number|make|model|year|…|(10) test mass kg|curb mass|(12) wheelbase mm|(13) length|(14) width|
//!     (15) CG behind front axle|…|(20–40) BX1–BX21|(41) speed km/h|…|(47–52) crush C1–C6 mm|(53) CDC|…
//! ----- BARRIER -----
//! R|LCB|angle|diameter|description                      rigid or deformable, shape
//! ----- OCCUPANT ----- … ----- RESTRAINT ----- …
//! ----- INSTRUMENTATION -----
//! vehicle|curve|sensor|occupant|place|axis|SEC|unit|prefilter Hz|maker|calibration|range|% of it|
//!     initial km/h|first sample|last sample|step µs|data status|channel status|comment
//! ----- END -----
//! ```
//!
//! Columns are counted from 0; vehicle 0 is the barrier, and `LC…` with the axis `XG` one of its load cells. A
//! curve has the time in seconds and a value in a line, with a tab between them. Read as recorded, without a
//! filter. A channel is not read if its status says that it failed, its comment that data are not valid, or its unit
//! that its values are over something else than seconds.

use std::path::{Path, PathBuf};

use crate::data::DataError;
use crate::data::formats::head_text;
use crate::data::text::read_text;

/// Bytes of a description or a curve.
pub(super) const MAX_CURVE_BYTES: u64 = 32 << 20;
/// Channels of a test; those with the largest barriers have some 700.
const MAX_CHANNELS: usize = 4096;

/// Words of remarks that data are not to be used.
const NOT_VALID: [&str; 6] =
    ["NO VALID DATA", "NOT VALID", "INVALID", "FAILED", "NO DATA", "QUESTIONABLE"];

/// A crash test of the database.
#[derive(Debug, Clone, PartialEq)]
pub struct CrashTest {
    /// What was tested.
    pub title: String,
    /// The vehicles; a barrier is none.
    pub vehicles: Vec<TestVehicle>,
    /// The barrier in the words of the file; `None` for one vehicle against another.
    pub barrier: Option<String>,
    /// Whether the test says that the impact was at an angle, or the barrier stood at one.
    pub is_oblique: bool,
    /// The channels that were instrumented.
    pub channels: Vec<TestChannel>,
    pub(super) path: PathBuf,
}

/// A vehicle of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct TestVehicle {
    /// Its number in the test.
    pub number: u32,
    /// Mass as tested, kg.
    pub mass_kg: Option<f64>,
    /// Wheelbase, m.
    pub wheelbase_m: Option<f64>,
    /// Length, m.
    pub length_m: Option<f64>,
    /// Width, m.
    pub width_m: Option<f64>,
    /// CG behind the front axle, m.
    pub cg_to_front_axle_m: Option<f64>,
    /// Speed of the impact, m/s.
    pub speed_m_s: Option<f64>,
    /// Crush C1 to C6 across the face, m; `None` if none was measured.
    pub crush_m: Option<[f64; 6]>,
    /// The damage by SAE J224, such as `12FDEW2`; empty if none is stated.
    pub damage_code: String,
}

/// A channel of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct TestChannel {
    /// The vehicle; 0 for the barrier.
    pub vehicle: u32,
    /// The number of the curve, the ending of its file.
    pub curve: u32,
    /// What kind of sensor, such as `AC` or `LC`.
    pub sensor: String,
    /// The occupant; `NA` for the vehicle.
    pub occupant: String,
    /// Place of the sensor, in the code of the database.
    pub place: String,
    /// Direction of its axis, such as `XG`.
    pub axis: String,
    /// Unit of what its values are over, `SEC` for a time.
    pub over: String,
    /// Unit of its values, as in the file.
    pub unit: String,
    /// Status of the data, `AM` as measured.
    pub status: String,
    /// A remark.
    pub comment: String,
}

impl TestChannel {
    /// Whether its values can be used, as far as the file says.
    pub fn is_valid(&self) -> bool {
        let is_good = matches!(self.status.as_str(), "AM" | "CM" | "");
        is_good && self.is_over_time() && !self.is_remarked()
    }

    /// Whether its remark says that data are not to be used, mostly from an instant on.
    pub(super) fn is_remarked(&self) -> bool {
        let comment = self.comment.to_uppercase();
        NOT_VALID.iter().any(|words| comment.contains(*words))
    }

    /// Whether its values are over a time in seconds, and not over a way or an angle.
    pub(super) fn is_over_time(&self) -> bool {
        matches!(self.over.as_str(), "SEC" | "")
    }

    /// Whether it is the force of a load cell of the barrier along its normal.
    pub(super) fn is_barrier_force(&self) -> bool {
        self.vehicle == 0 && self.sensor == "LC" && self.axis.starts_with('X') && self.unit == "NWT"
    }

    /// The part of the test in which it is shown.
    pub(super) fn part(&self) -> String {
        match (self.vehicle, self.occupant.as_str()) {
            (0, _) => "barrier channels".to_owned(),
            (vehicle, "NA" | "") => format!("vehicle {vehicle}"),
            (vehicle, occupant) => format!("vehicle {vehicle} occupant {occupant}"),
        }
    }

    pub(super) fn column(&self) -> String {
        let unit = match self.unit.as_str() {
            "G'S" => "g",
            "NWT" => "N",
            "NWM" => "N m",
            "DPS" => "deg/s",
            other => other,
        };
        let Self { curve, sensor, place, axis, comment, .. } = self;
        let comment: String = comment.chars().take(40).collect();
        plain(&format!("{curve} {sensor} {place} {axis} {comment} [{unit}]"))
    }
}

/// Whether a text is the description of a test.
pub(super) fn is_test(text: &str) -> bool {
    text.lines().take(20).any(|line| {
        let name = section(line);
        name.is_some_and(|name| name == "EV5")
    })
}

/// The name in a line such as `----- TEST -----`.
fn section(line: &str) -> Option<&str> {
    let name = line.trim().strip_prefix("-----")?.strip_suffix("-----")?;
    Some(name.trim())
}

impl CrashTest {
    /// Reads the description of a test.
    ///
    /// # Errors
    /// [`DataError`] if the file cannot be read or is none.
    pub fn read(path: &Path) -> Result<Self, DataError> {
        let text = read_text(path, MAX_CURVE_BYTES)?;
        if !is_test(&text.text) {
            let format = "no description of a test of the NHTSA database (.EV5)";
            let remedy = "give the .EV5 file beside its curves";
            return Err(DataError::OtherFormat { path: path.to_owned(), format, remedy });
        }
        Self::parse(path, &text.text)
    }

    /// Whether a file is the description of a test.
    pub fn is_test(path: &Path) -> bool {
        is_test(&head_text(path))
    }

    pub(super) fn parse(path: &Path, text: &str) -> Result<Self, DataError> {
        let mut test = Self {
            title: String::new(),
            vehicles: Vec::new(),
            barrier: None,
            is_oblique: false,
            channels: Vec::new(),
            path: path.to_owned(),
        };
        let mut name = "";
        for (number, line) in (1..).zip(text.lines()) {
            if let Some(of) = section(line) {
                name = of;
                continue;
            }
            if line.trim().is_empty() || line.starts_with('#') {
                continue;
            }
            let fields: Vec<&str> = line.split('|').map(str::trim).collect();
            match name {
                "TEST" if test.title.is_empty() => {
                    test.title = plain(fields.get(1).copied().unwrap_or_default());
                    test.is_oblique |= is_angle(fields.get(15));
                }
                "VEHICLE" => test.vehicles.push(vehicle(path, number, &fields)?),
                "BARRIER" => {
                    test.barrier = Some(plain(&fields.join(" ")));
                    test.is_oblique |= is_angle(fields.get(2));
                }
                "INSTRUMENTATION" => test.channels.push(channel(path, number, &fields)?),
                _ => {}
            }
            if test.channels.len() > MAX_CHANNELS || test.vehicles.len() > MAX_CHANNELS {
                let (path, got, limit) = (path.to_owned(), MAX_CHANNELS + 1, MAX_CHANNELS);
                return Err(DataError::TooManyColumns { path, line: number, got, limit });
            }
        }
        Ok(test)
    }
}

/// Whether a field holds an angle that is not 0.
fn is_angle(field: Option<&&str>) -> bool {
    let angle_deg: Option<f64> = field.and_then(|text| text.parse().ok());
    angle_deg.is_some_and(|angle_deg| angle_deg != 0.0)
}

fn vehicle(path: &Path, line: u64, fields: &[&str]) -> Result<TestVehicle, DataError> {
    // 0 is what the database writes for what is not known.
    let number = |column: usize, name: &str, factor: f64| -> Result<Option<f64>, DataError> {
        let text = fields.get(column).copied().unwrap_or_default();
        if text.is_empty() {
            return Ok(None);
        }
        let value = finite(path, line, column + 1, name, text, "a number")?;
        Ok(Some(value * factor).filter(|value| *value > 0.0))
    };
    let mut crush_m = [0.0; 6];
    for (idx, crush_m) in crush_m.iter_mut().enumerate() {
        let text = fields.get(47 + idx).copied().unwrap_or("0");
        let text = if text.is_empty() { "0" } else { text };
        *crush_m = 1e-3 * finite(path, line, 48 + idx, "crush", text, "a depth in millimetres")?;
    }
    Ok(TestVehicle {
        number: whole(path, line, 0, "vehicle", fields)?,
        mass_kg: number(10, "test mass", 1.0)?,
        wheelbase_m: number(12, "wheelbase", 1e-3)?,
        length_m: number(13, "length", 1e-3)?,
        width_m: number(14, "width", 1e-3)?,
        cg_to_front_axle_m: number(15, "CG behind the front axle", 1e-3)?,
        speed_m_s: number(41, "speed", 1.0 / 3.6)?,
        crush_m: Some(crush_m).filter(|crush_m| crush_m.iter().any(|depth| *depth != 0.0)),
        damage_code: plain(fields.get(53).copied().unwrap_or_default()),
    })
}

fn channel(path: &Path, line: u64, fields: &[&str]) -> Result<TestChannel, DataError> {
    let text = |idx: usize| fields.get(idx).map_or_else(String::new, |text| (*text).to_owned());
    Ok(TestChannel {
        vehicle: whole(path, line, 0, "vehicle", fields)?,
        curve: whole(path, line, 1, "curve", fields)?,
        sensor: text(2),
        occupant: text(3),
        place: text(4),
        axis: text(5),
        over: text(6),
        unit: text(7),
        status: text(17),
        comment: text(19),
    })
}

fn whole(
    path: &Path,
    line: u64,
    idx: usize,
    name: &str,
    fields: &[&str],
) -> Result<u32, DataError> {
    let text = fields.get(idx).copied().unwrap_or_default();
    let number = text.parse().ok();
    number.ok_or_else(|| cell(path, line, idx + 1, name, text, "a number from 0"))
}

pub(super) fn finite(
    path: &Path,
    line: u64,
    column: usize,
    name: &str,
    text: &str,
    expected: &str,
) -> Result<f64, DataError> {
    let number: Option<f64> = text.parse().ok();
    let number = number.filter(|number| number.is_finite());
    number.ok_or_else(|| cell(path, line, column, name, text, expected))
}

fn cell(
    path: &Path,
    line: u64,
    column: usize,
    name: &str,
    text: &str,
    expected: &str,
) -> DataError {
    let (path, name, text) = (path.to_owned(), name.to_owned(), text.to_owned());
    DataError::Cell { path, line, column, name, text, expected: expected.into() }
}

/// A text without what would end a cell or a line.
pub(super) fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || c == '"' { ' ' } else { c }).collect()
}
