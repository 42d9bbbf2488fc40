//! How a file is read, apart from which column is which: sheet, header and units, clock and axes.
//! In the text of a [`ColumnMap`](crate::data::ColumnMap) each of them is a part of its own, such as
//! `header=5` or `shift=-12:ms`.

use std::fmt;

use crate::data::{DeckUnits, MapError, Separator, Thousands, antenna, spelling};
use crate::ranges::{HEADING, INSTANT};
use crate::units::Quantity;

/// The sheet of a workbook from which a table is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SheetRef {
    /// The number of the sheet, counted from 1.
    Number(usize),
    /// The name of the sheet.
    Name(String),
}

/// Where the names of the columns stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeaderLine {
    /// In this line, counted from 1.
    Line(u64),
    /// Nowhere: the file begins with numbers.
    None,
}

/// The axes in which a file gives the velocities `vx` and `vy`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VelocityAxes {
    /// Heading axes of the vehicle: x forward, y left.
    Body,
    /// World axes, in which the positions are given.
    World,
}

/// How a file is read, apart from its columns. What is `None` is found in the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadSettings {
    /// What divides the fields of a line, `separator=semicolon`; a sheet has none.
    pub separator: Option<Separator>,
    /// Whether the decimal sign is a comma, `decimal=comma`, or a point, `decimal=point`.
    pub decimal_comma: Option<bool>,
    /// What stands between thousands, `thousands=point`.
    pub thousands: Option<Thousands>,
    /// The sheet of a workbook, `sheet=2` or `sheet=NAME`; `None` is the first one.
    pub sheet: Option<SheetRef>,
    /// The units of a finite-element model, `deck=t-mm-s`, in which its results are.
    pub deck: Option<DeckUnits>,
    /// The line of the header, `header=5` or `header=none`.
    pub header: Option<HeaderLine>,
    /// The line of the units, `units=6`.
    pub units_line: Option<u64>,
    /// What is added to every instant, s: `shift=-12:ms`.
    pub time_shift_s: Option<f64>,
    /// Whether y points to the right and yaw is positive clockwise (SAE J670), `y_axis=right`. The
    /// numbers are turned into the axes of this program, in which y points to the left.
    pub y_to_right: bool,
    /// Whether yaw angles are compass headings, clockwise from north, over a path with x to the east and y to
    /// the north: `headings=compass`. The numbers are turned into yaw angles.
    pub compass_headings: bool,
    /// What is added to every yaw angle, rad, where they are counted from another axis than X: `yaw_offset=-90:deg`.
    pub yaw_offset_rad: Option<f64>,
    /// Place of the antenna whose positions the file has, ahead and to the left of the CG, m:
    /// `antenna=0.4,-0.3`. The positions are moved to the CG by the yaw angle.
    pub antenna_m: Option<[f64; 2]>,
    /// The axes of `vx` and `vy`, `velocities=world`; `None` takes them as body axes and compares
    /// them with the path.
    pub velocities: Option<VelocityAxes>,
}

impl ReadSettings {
    /// The names of all settings, in the order in which they are written.
    pub(super) const NAMES: [&str; 13] = [
        "separator",
        "decimal",
        "thousands",
        "sheet",
        "deck",
        "header",
        "units",
        "shift",
        "y_axis",
        "headings",
        "yaw_offset",
        "antenna",
        "velocities",
    ];

    /// Takes a part of the text of a map if its name is that of a setting.
    ///
    /// - returns whether it is.
    ///
    /// # Errors
    /// [`MapError::Setting`] if the value is none of the setting, [`MapError::SettingTwice`] if the
    /// setting was given before.
    pub(super) fn take(&mut self, name: &str, value: &str) -> Result<bool, MapError> {
        let wrong = |expected: &'static str| wrong(name, value, expected);
        let line = || value.parse().ok().filter(|line| *line > 0);
        let is_first = match name {
            "separator" | "decimal" | "thousands" => self.take_sign(name, value)?,
            "sheet" => self.sheet.replace(sheet(value)).is_none(),
            "deck" => {
                let deck = DeckUnits::ALL.into_iter().find(|of| of.name() == value);
                let deck = deck.ok_or_else(|| wrong(DeckUnits::NAMES))?;
                self.deck.replace(deck).is_none()
            }
            "header" => {
                let expected = "the number of a line or none, e.g. header=5";
                let header = match value {
                    "none" => HeaderLine::None,
                    _ => HeaderLine::Line(line().ok_or_else(|| wrong(expected))?),
                };
                self.header.replace(header).is_none()
            }
            "units" => {
                let line = line().ok_or_else(|| wrong("the number of a line, e.g. units=6"))?;
                self.units_line.replace(line).is_none()
            }
            "shift" => {
                let shift_s = shift_s(value).ok_or_else(|| wrong("a time, e.g. shift=-12:ms"))?;
                self.time_shift_s.replace(shift_s).is_none()
            }
            "y_axis" => {
                let is_right = match value {
                    "left" => false,
                    "right" => true,
                    _ => return Err(wrong("left or right")),
                };
                !std::mem::replace(&mut self.y_to_right, is_right)
            }
            "headings" => {
                let is_compass = match value {
                    "yaw" => false,
                    "compass" => true,
                    _ => return Err(wrong("compass or yaw")),
                };
                !std::mem::replace(&mut self.compass_headings, is_compass)
            }
            "yaw_offset" => {
                let offset_rad = yaw_offset_rad(value);
                let offset_rad =
                    offset_rad.ok_or_else(|| wrong("an angle, e.g. yaw_offset=-90:deg"))?;
                self.yaw_offset_rad.replace(offset_rad).is_none()
            }
            "antenna" => {
                let expected = "x and y from the CG in metres, e.g. antenna=0.4,-0.3";
                let place_m = antenna::place_m(value).ok_or_else(|| wrong(expected))?;
                self.antenna_m.replace(place_m).is_none()
            }
            "velocities" => {
                let axes = match value {
                    "body" => VelocityAxes::Body,
                    "world" => VelocityAxes::World,
                    _ => return Err(wrong("body or world")),
                };
                self.velocities.replace(axes).is_none()
            }
            _ => return Ok(false),
        };
        match is_first {
            true => Ok(true),
            false => Err(MapError::SettingTwice { name: name.to_owned() }),
        }
    }

    /// Takes what divides fields and what stands within numbers.
    ///
    /// - returns whether it was not given before.
    fn take_sign(&mut self, name: &str, value: &str) -> Result<bool, MapError> {
        Ok(match name {
            "separator" => {
                let expected = "comma, semicolon, tab, bar or space";
                let separator = Separator::ALL.into_iter().find(|of| of.name() == value);
                let separator = separator.ok_or_else(|| wrong(name, value, expected))?;
                self.separator.replace(separator).is_none()
            }
            "decimal" => {
                let is_comma = match value {
                    "comma" => true,
                    "point" => false,
                    _ => return Err(wrong(name, value, "point or comma")),
                };
                self.decimal_comma.replace(is_comma).is_none()
            }
            _ => {
                let expected = "point, comma, apostrophe or space";
                let mark = Thousands::ALL.into_iter().find(|of| of.name() == value);
                let mark = mark.ok_or_else(|| wrong(name, value, expected))?;
                self.thousands.replace(mark).is_none()
            }
        })
    }
}

fn wrong(name: &str, value: &str, expected: &'static str) -> MapError {
    MapError::Setting { name: name.to_owned(), text: value.to_owned(), expected }
}

fn sheet(value: &str) -> SheetRef {
    match value.parse() {
        Ok(number) if number > 0 => SheetRef::Number(number),
        _ => SheetRef::Name(value.to_owned()),
    }
}

/// The time in `-12:ms`, or `-0.012` in seconds.
fn shift_s(value: &str) -> Option<f64> {
    let (number, unit) = value.rsplit_once(':').unwrap_or((value, "s"));
    let unit = spelling::unit(Quantity::Time, unit.trim())?;
    let shift_s = unit.to_si(number.trim().parse().ok()?);
    INSTANT.contains(shift_s).then_some(shift_s)
}

/// The angle in `-90:deg`, rad.
fn yaw_offset_rad(value: &str) -> Option<f64> {
    let (number, unit) = value.rsplit_once(':')?;
    let unit = spelling::unit(Quantity::Angle, unit.trim())?;
    let offset_rad = unit.to_si(number.trim().parse().ok()?);
    HEADING.contains(offset_rad).then_some(offset_rad)
}

impl fmt::Display for SheetRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for ReadSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let header = self.header.map(|header| match header {
            HeaderLine::Line(line) => line.to_string(),
            HeaderLine::None => "none".to_owned(),
        });
        let velocities = self.velocities.map(|axes| match axes {
            VelocityAxes::Body => "body".to_owned(),
            VelocityAxes::World => "world".to_owned(),
        });
        let decimal = |is_comma| match is_comma {
            true => "comma".to_owned(),
            false => "point".to_owned(),
        };
        // As NAMES has them.
        let values = [
            self.separator.map(|of| of.name().to_owned()),
            self.decimal_comma.map(decimal),
            self.thousands.map(|of| of.name().to_owned()),
            self.sheet.as_ref().map(SheetRef::to_string),
            self.deck.map(|of| of.name().to_owned()),
            header,
            self.units_line.map(|line| line.to_string()),
            self.time_shift_s.map(|shift_s| format!("{shift_s}:s")),
            self.y_to_right.then(|| "right".to_owned()),
            self.compass_headings.then(|| "compass".to_owned()),
            self.yaw_offset_rad.map(|of| format!("{}:deg", of.to_degrees())),
            self.antenna_m.map(|[x_m, y_m]| format!("{x_m} {y_m}")),
            velocities,
        ];
        let given = Self::NAMES.into_iter().zip(values);
        let text = given.filter_map(|(name, value)| Some(format!("{name}={}", value?)));
        let text: Vec<String> = text.collect();
        f.write_str(&text.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_taken_and_written_by_its_name() {
        for name in ReadSettings::NAMES {
            let taken = ReadSettings::default().take(name, "");
            assert!(!matches!(taken, Ok(false)), "{name}");
        }
        let values = [
            "tab",
            "comma",
            "point",
            "Messung",
            DeckUnits::ALL[0].name(),
            "5",
            "6",
            "-2:s",
            "right",
            "compass",
            "-90:deg",
            "0.4 -0.3",
            "world",
        ];
        let mut settings = ReadSettings::default();
        for (name, value) in ReadSettings::NAMES.into_iter().zip(values) {
            assert!(settings.take(name, value).unwrap(), "{name}={value}");
        }
        let given = ReadSettings::NAMES.into_iter().zip(values);
        let text: Vec<String> = given.map(|(name, value)| format!("{name}={value}")).collect();
        assert_eq!(settings.to_string(), text.join(","));
    }
}
