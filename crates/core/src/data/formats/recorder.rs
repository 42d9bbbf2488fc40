//! What an event data recorder has kept of a crash: the change of velocity, the speed before it, and what the
//! driver did in the seconds before. Read from the report of a Bosch CDR tool or from a table with
//! the elements of 49 CFR 563 (or UN R160), which any program may have written:
//!
//! ```text
//! Time [s],Speed [mph],Brake,Steering Wheel Angle [deg],Delta-V, Longitudinal [km/h],Delta-V, Lateral [km/h]
//! ```
//!
//! A column whose header names no unit is left out, and said so. Lateral values and the yaw rate are positive to
//! the right, as SAE J1698 has them; a steering wheel is positive to the left.

use std::path::Path;

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::cdr::{
    MAX_BYTES, Report, Section, column_name, is_before_crash, is_report, number,
};
use crate::data::spelling::{letters_and_digits, quantity_name, trailing_unit};
use crate::data::text::read_text;
use crate::data::{DataError, ReadSettings, Table};
use crate::ranges::{ANGULAR_VELOCITY_SAMPLE, INSTANT, Range, SPEED, STEERING_WHEEL_ANGLE};
use crate::units::Quantity;

/// Time at the end of a record of the change of velocity over which it no longer changes if the record is
/// complete, s.
const SETTLED_S: f64 = 0.02;

/// Change over this time from which the record is cut off, m/s.
const CUT_M_S: f64 = 0.3;

/// Lines within which the header of a table stands.
const HEADER_LINES: usize = 5;

/// Longest time over which a change of velocity is recorded, s.
const LONGEST_S: f64 = 2.0;

/// What a recorder has kept of one event.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecorderRecord {
    /// What the file is, with the device and whether it is complete.
    pub description: String,
    /// The event of several; empty if the file says none.
    pub event: String,
    /// The names of all events.
    pub events: Vec<String>,
    /// What a person should look at before the record is used, in words.
    pub doubts: Vec<String>,
    /// Change of velocity ahead.
    pub delta_v_ahead: Option<RecordedDeltaV>,
    /// Change of velocity to the right.
    pub delta_v_right: Option<RecordedDeltaV>,
    /// The last speed before the crash.
    pub speed_before: Option<RecordedSpeed>,
    /// Speed and controls in the seconds before.
    pub before: RecordedControls,
}

/// A change of velocity as it was recorded last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedDeltaV {
    /// The change up to then, m/s.
    pub delta_v_m_s: f64,
    /// When, s after the recorder woke up; `None` if nothing says it.
    pub ends_s: Option<f64>,
    /// Whether the velocity still changed there.
    pub is_cut: bool,
}

/// A speed before the crash.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedSpeed {
    /// The speed, m/s.
    pub speed_m_s: f64,
    /// When it was recorded, s; 0 when the recorder woke up.
    pub at_s: f64,
}

/// Speed and controls before a crash; a column that was not recorded throughout has no values.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordedControls {
    /// Instants, s; 0 when the recorder woke up.
    pub time_s: Vec<f64>,
    /// Speed, m/s.
    pub speed_m_s: Vec<f64>,
    /// Angle of the steering wheel, positive to the left, rad.
    pub steering_wheel_rad: Vec<f64>,
    /// Yaw rate, positive to the right as it was recorded, rad/s.
    pub yaw_rate_right_rad_s: Vec<f64>,
    /// Whether the service brake was on.
    pub is_braked: Vec<bool>,
    /// Whether the anti-lock system was at work.
    pub is_anti_lock_active: Vec<bool>,
}

/// The columns of a table: names with units, numbers and texts.
struct Table563<'a> {
    header: Vec<String>,
    numbers: &'a dyn Fn(usize) -> Vec<Option<f64>>,
    texts: &'a dyn Fn(usize) -> Vec<String>,
}

impl RecorderRecord {
    /// Reads the record of an event.
    ///
    /// - `event`: its number among those of the file, counted from 1; `None` is the first.
    ///
    /// # Errors
    /// [`DataError`] if the file cannot be read, has no such event, or nothing of a crash in it.
    pub fn read(path: &Path, event: Option<usize>) -> Result<Self, DataError> {
        let is_cdr = match read_text(path, MAX_TABLE_BYTES) {
            Ok(text) if is_report(&text.text) => Some(Report::parse(path, &text.text)?),
            // A workbook is no text; what else is none is refused below.
            Ok(_) | Err(DataError::NotText { .. } | DataError::OtherFormat { .. }) => None,
            Err(error) => return Err(error),
        };
        let record = match is_cdr {
            Some(report) => Self::from_report(path, &report, event)?,
            None => Self::from_table(&Table::read_as(path, &ReadSettings::default())?),
        };
        if record.is_empty() {
            let format =
                "no record of an event data recorder in which a column with its unit is recognised";
            let remedy = "name the columns as Time [s], Speed [km/h], Steering Wheel Angle [deg], \
                          Delta-V, Longitudinal [km/h]";
            return Err(DataError::OtherFormat { path: path.to_owned(), format, remedy });
        }
        Ok(record)
    }

    /// Whether a file is the report of a recorder's tool.
    pub fn is_report(path: &Path) -> bool {
        read_text(path, MAX_TABLE_BYTES).is_ok_and(|text| is_report(&text.text))
    }

    /// Turns lateral changes of velocity that a report has as positive to the left.
    pub fn turn_lateral(&mut self) {
        if let Some(delta_v) = &mut self.delta_v_right {
            delta_v.delta_v_m_s = 0.0 - delta_v.delta_v_m_s;
        }
    }

    /// Turns yaw rates that a report has as positive to the left.
    pub fn turn_yaw_rate(&mut self) {
        for rate in &mut self.before.yaw_rate_right_rad_s {
            *rate = 0.0 - *rate;
        }
    }

    /// Whether a file is such a report, or a table with a change of velocity in its first lines.
    pub fn is_record(path: &Path) -> bool {
        let Ok(text) = read_text(path, MAX_BYTES as u64) else { return false };
        let mut first = text.text.lines().take(HEADER_LINES).map(letters_and_digits);
        is_report(&text.text) || first.any(|line| line.contains("deltav"))
    }

    fn is_empty(&self) -> bool {
        self.delta_v_ahead.is_none()
            && self.delta_v_right.is_none()
            && self.speed_before.is_none()
            && self.before.time_s.is_empty()
    }

    fn from_report(path: &Path, report: &Report, event: Option<usize>) -> Result<Self, DataError> {
        let mut events: Vec<String> = Vec::new();
        for section in &report.sections {
            let name = event_of(&section.title);
            if let Some(name) = name.filter(|name| !events.contains(name)) {
                events.push(name);
            }
        }
        let chosen = match event {
            None => events.first().cloned(),
            Some(number) => match number.checked_sub(1).and_then(|idx| events.get(idx)) {
                Some(name) => Some(name.clone()),
                None => {
                    let (path, wanted) = (path.to_owned(), number.to_string());
                    return Err(DataError::NoSheet { path, wanted, found: events });
                }
            },
        };
        let mut record = Self {
            description: report.description(),
            doubts: report.doubts(),
            event: chosen.clone().unwrap_or_default(),
            ..Self::default()
        };
        if events.len() > 1 && event.is_none() {
            record.doubts.push(format!(
                "{} events are recorded; read is the first, {}",
                events.len(),
                record.event
            ));
        }
        let has_several = events.len() > 1;
        record.events = events;
        let is_of_none = |section: &&Section| {
            let title = letters_and_digits(&section.title);
            let words = ["precrash", "longitudinal", "lateral", "deltav"];
            let is_record = words.iter().any(|word| title.starts_with(word)) && section.is_table();
            has_several && is_record && event_of(&section.title).is_none()
        };
        let n_of_none = report.sections.iter().filter(is_of_none).count();
        if n_of_none > 0 {
            record.doubts.push(format!(
                "tables that do not say of which event they are: {n_of_none}; they are left out"
            ));
        }
        let is_of_event = |section: &&Section| match event_of(&section.title) {
            Some(of) => chosen.as_ref() == Some(&of),
            None => !has_several,
        };
        let sections: Vec<&Section> = report.sections.iter().filter(is_of_event).collect();
        for section in sections.iter().filter(|section| section.is_table()) {
            let numbers = |idx: usize| section.column(idx);
            let texts = |idx: usize| section.texts(idx);
            let table = Table563 { header: section.header(), numbers: &numbers, texts: &texts };
            record.add_table(&table, is_before_crash(section));
        }
        // A record over time says more than its largest value.
        sections.iter().for_each(|section| record.add_keys(section));
        record.keep_one_end();
        Ok(record)
    }

    fn from_table(table: &Table) -> Self {
        let numbers = |idx: usize| -> Vec<Option<f64>> {
            (0..table.n_rows()).map(|row| table.number(row, idx)).collect()
        };
        let texts = |idx: usize| -> Vec<String> {
            (0..table.n_rows()).map(|row| table.cell(row, idx).into_owned()).collect()
        };
        let with_unit = |(idx, name): (usize, &String)| match table.unit_text(idx) {
            Some(unit) => format!("{name} [{unit}]"),
            None => name.clone(),
        };
        let header = table.header().iter().enumerate().map(with_unit).collect();
        let mut record =
            Self { description: "a table of an event data recorder".to_owned(), ..Self::default() };
        record.add_table(&Table563 { header, numbers: &numbers, texts: &texts }, true);
        record.keep_one_end();
        record
    }

    /// Leaves out the smaller one of both changes of velocity if no common end holds for both. A record that no
    /// longer changed at its end holds at any later one.
    fn keep_one_end(&mut self) {
        let (Some(ahead), Some(right)) = (self.delta_v_ahead, self.delta_v_right) else { return };
        let end_s = |of: RecordedDeltaV| of.ends_s.unwrap_or(f64::INFINITY);
        let last_s = end_s(ahead).max(end_s(right));
        let is_lost = |of: &RecordedDeltaV| of.is_cut && last_s - end_s(*of) > SETTLED_S;
        if ![ahead, right].iter().any(is_lost) {
            return;
        }
        let is_ahead_smaller = ahead.delta_v_m_s.abs() < right.delta_v_m_s.abs();
        let (slot, name) = match is_ahead_smaller {
            true => (&mut self.delta_v_ahead, "ahead"),
            false => (&mut self.delta_v_right, "to the right"),
        };
        *slot = None;
        self.doubts.push(format!(
            "the changes of velocity ahead and to the right end at different times, one of them before it was over; \
             the one {name}, which is the smaller, is left out"
        ));
    }

    /// Adds the largest changes of velocity that stand beside their names.
    fn add_keys(&mut self, section: &Section) {
        for (key, slot) in [
            ("deltavlongitudinal", &mut self.delta_v_ahead),
            ("deltavlateral", &mut self.delta_v_right),
        ] {
            let Some((name, value)) = section.number(&format!("maximum{key}")) else { continue };
            let Ok(Some(unit)) = trailing_unit(&column_name(name), Quantity::Speed) else {
                continue;
            };
            let delta_v_m_s = unit.to_si(value);
            let time = section.number(&format!("timemaximum{key}"));
            let ends_s = time.and_then(|(name, value)| {
                let unit = trailing_unit(&column_name(name), Quantity::Time).ok().flatten()?;
                Some(unit.to_si(value)).filter(|at_s| (0.0..LONGEST_S).contains(at_s))
            });
            if slot.is_none() && SPEED.contains(delta_v_m_s) {
                *slot = Some(RecordedDeltaV { delta_v_m_s, ends_s, is_cut: false });
            }
        }
    }

    /// Adds what the columns of a table hold.
    fn add_table(&mut self, table: &Table563<'_>, has_controls: bool) {
        let mut doubts = Vec::new();
        let time = table.column(Quantity::Time, &mut doubts, |key| {
            key.starts_with("time") && !key.contains("maximum")
        });
        let Some(time_s) = time else {
            self.doubts.extend(doubts);
            return;
        };
        for (words, slot, name) in [
            ("longitudinal", &mut self.delta_v_ahead, "ahead"),
            ("lateral", &mut self.delta_v_right, "to the right"),
        ] {
            let is_delta_v = |key: &str| {
                let has = |word: &str| key.contains(word);
                (has("deltav") || has("velocitychange")) && has(words) && !has("maximum")
            };
            let Some(values) = table.column(Quantity::Speed, &mut doubts, is_delta_v) else {
                continue;
            };
            let Some(recorded) = recorded_delta_v(&time_s, &values) else { continue };
            if slot.is_some() {
                doubts.push(format!(
                    "the change of velocity {name} is recorded twice for the event; the first one is read"
                ));
                continue;
            }
            if recorded.is_cut {
                doubts.push(format!(
                    "the change of velocity {name} still changes at the end of its record: the pulse is cut \
                     off there"
                ));
            }
            *slot = Some(recorded);
        }
        match has_controls {
            true if self.before.time_s.is_empty() => {
                self.add_controls(table, &time_s, &mut doubts);
            }
            true => doubts.push(
                "another table of the seconds before the crash is not read; open it as a table"
                    .to_owned(),
            ),
            false => {}
        }
        self.doubts.extend(doubts);
    }

    fn add_controls(
        &mut self,
        table: &Table563<'_>,
        time_s: &[Option<f64>],
        doubts: &mut Vec<String>,
    ) {
        let is_speed = |key: &str| {
            let others =
                ["deltav", "change", "engine", "wheelspeed", "cruise", "setspeed", "limit"];
            key.contains("speed") && !others.iter().any(|other| key.contains(other))
        };
        let speed = table.column(Quantity::Speed, doubts, is_speed).unwrap_or_default();
        let steering = table.column(Quantity::Angle, doubts, |key| key.contains("steering"));
        let yaw_rate =
            table.column(Quantity::AngularVelocity, doubts, |key| key.starts_with("yawrate"));
        let is_brake = |key: &String| {
            key.contains("brake") && !["abs", "pressure"].iter().any(|other| key.contains(other))
        };
        let is_anti_lock = |key: &String| {
            let is_lamp = ["lamp", "warning", "indicator"].iter().any(|word| key.contains(word));
            (key.starts_with("abs") || key.contains("antilock")) && !is_lamp
        };
        let rows: Vec<usize> = time_s
            .iter()
            .enumerate()
            .filter(|(row, at_s)| {
                at_s.is_some_and(|at_s| at_s <= 0.0 && INSTANT.contains(at_s))
                    && speed.get(*row).is_some_and(Option::is_some)
            })
            .map(|(row, _)| row)
            .collect();
        let all = |values: &[Option<f64>], range: Range| {
            let of = |row: &usize| {
                values.get(*row).copied().flatten().filter(|value| range.contains(*value))
            };
            rows.iter().map(of).collect::<Option<Vec<f64>>>()
        };
        let Some(speed_m_s) = all(&speed, SPEED) else {
            doubts
                .push("a speed before the crash is beyond that of a car; none is taken".to_owned());
            return;
        };
        let in_time = |row: &usize| time_s.get(*row).copied().flatten();
        let time_s: Vec<f64> = rows.iter().filter_map(in_time).collect();
        if time_s.windows(2).any(|pair| pair.first() >= pair.last()) {
            doubts.push("the times before the crash do not increase; none is taken".to_owned());
            return;
        }
        if let Some((at_s, speed_m_s)) = time_s.last().copied().zip(speed_m_s.last().copied()) {
            self.speed_before = Some(RecordedSpeed { speed_m_s, at_s });
        }
        let of = |values: Option<Vec<Option<f64>>>, range, name: &str, doubts: &mut Vec<String>| {
            let values = values?;
            let found = all(&values, range);
            if found.is_none() {
                doubts.push(format!("the {name} is not recorded throughout; it is left out"));
            }
            found
        };
        let steering = of(steering, STEERING_WHEEL_ANGLE, "angle of the steering wheel", doubts);
        let yaw_rate = of(yaw_rate, ANGULAR_VELOCITY_SAMPLE, "yaw rate", doubts);
        let keys = table.keys();
        let switch = |column: Option<usize>| {
            let texts = (table.texts)(column?);
            let on = |row: &usize| is_on(texts.get(*row)?);
            rows.iter().map(on).collect::<Option<Vec<bool>>>()
        };
        let braked = switch(keys.iter().position(is_brake));
        let anti_lock = switch(keys.iter().position(is_anti_lock));
        self.before = RecordedControls {
            time_s,
            speed_m_s,
            steering_wheel_rad: steering.unwrap_or_default(),
            yaw_rate_right_rad_s: yaw_rate.unwrap_or_default(),
            is_braked: braked.unwrap_or_default(),
            is_anti_lock_active: anti_lock.unwrap_or_default(),
        };
    }
}

impl Table563<'_> {
    fn keys(&self) -> Vec<String> {
        let bare = |name: &String| {
            letters_and_digits(name.rsplit_once('[').map_or(name.as_str(), |(bare, _)| bare))
        };
        self.header.iter().map(bare).collect()
    }

    /// The numbers of the first column whose name fits and that has a unit, in SI units.
    fn column(
        &self,
        quantity: Quantity,
        doubts: &mut Vec<String>,
        fits: impl Fn(&str) -> bool,
    ) -> Option<Vec<Option<f64>>> {
        for (idx, (name, key)) in self.header.iter().zip(self.keys()).enumerate() {
            if !fits(&key) {
                continue;
            }
            match trailing_unit(name, quantity) {
                Ok(Some(unit)) => {
                    let values = (self.numbers)(idx).into_iter();
                    return Some(
                        values.map(|value| value.map(|value| unit.to_si(value))).collect(),
                    );
                }
                Ok(None) if quantity != Quantity::Angle || key.contains("wheel") => {
                    doubts.push(format!(
                        "column {} {name:?} names no unit of {}; it is left out",
                        idx + 1,
                        quantity_name(quantity)
                    ));
                }
                Ok(None) | Err(_) => {}
            }
        }
        None
    }
}

/// The event in parentheses in the name of a section, without the number of one of its tables.
fn event_of(title: &str) -> Option<String> {
    let groups = title.split('(').skip(1).filter_map(|rest| rest.split(')').next());
    let mut names = groups.filter(|name| {
        let lower = name.to_lowercase();
        ["event", "record", "deployment"].iter().any(|word| lower.contains(word))
    });
    let name = names.next()?;
    Some(name.split(" TABLE ").next()?.trim().to_owned())
}

/// The last change of velocity of a record after the recorder has woken up.
fn recorded_delta_v(time_s: &[Option<f64>], values: &[Option<f64>]) -> Option<RecordedDeltaV> {
    let pairs: Vec<(f64, f64)> = time_s
        .iter()
        .zip(values)
        .filter_map(|(at_s, value)| at_s.zip(*value))
        .filter(|(at_s, value)| (0.0..LONGEST_S).contains(at_s) && SPEED.contains(*value))
        .collect();
    let (ends_s, delta_v_m_s) = *pairs.last()?;
    let earlier = pairs.iter().rev().find(|(at_s, _)| ends_s - at_s >= SETTLED_S - 1e-9);
    let is_cut = earlier.is_some_and(|(_, value)| (delta_v_m_s - value).abs() > CUT_M_S);
    Some(RecordedDeltaV { delta_v_m_s, ends_s: Some(ends_s), is_cut })
}

/// Whether a switch is on; `None` if the cell does not say.
fn is_on(cell: &str) -> Option<bool> {
    match letters_and_digits(cell).as_str() {
        "on" | "yes" | "applied" | "active" | "engaged" | "true" => Some(true),
        "off" | "no" | "notapplied" | "inactive" | "false" | "nonengaged" | "notengaged" => {
            Some(false)
        }
        _ => number(cell).map(|number| number != 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, event: Option<usize>) -> Result<RecorderRecord, DataError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("edr.csv");
        std::fs::write(&path, text).unwrap();
        RecorderRecord::read(&path, event)
    }

    const REPORT: &str = "CDR FILE INFORMATION\nEDR Device Type,Module 7\n\
        Complete File Recorded,Yes\nPRE-CRASH DATA [2 SAMPLES/SEC] (EVENT RECORD 1)\n\
        Times (sec),\"Speed, Vehicle Indicated (MPH [km/h])\",Steering Input (deg),Service Brake\n\
        -1.0,40 [64],0,Off\n-0.5,36 [58],10,On\n0,30 [48],20,On\n\
        \"DELTA-V, LONGITUDINAL (EVENT RECORD 1)\"\n\
        Time (msec),\"Delta-V, Longitudinal (MPH [km/h])\"\n\
        0,0\n50,-10\n80,-19\n100,-20\n120,-20\n\
        SYSTEM STATUS AT EVENT (EVENT RECORD 2)\n\
        \"Maximum Delta-V, Lateral (MPH [km/h])\",5.0 [8]\n\
        \"Time, Maximum Delta-V, Lateral (msec)\",150\n";

    #[test]
    fn a_report_gives_evidence_and_controls() {
        let record = read(REPORT, None).unwrap();
        assert_eq!(record.event, "EVENT RECORD 1");
        let mph = 0.447_04;
        let delta_v = record.delta_v_ahead.unwrap();
        assert!((delta_v.delta_v_m_s + 20.0 * mph).abs() < 1e-9, "{delta_v:?}");
        assert_eq!((delta_v.ends_s, delta_v.is_cut), (Some(0.12), false));
        let speed = record.speed_before.unwrap();
        assert!((speed.speed_m_s - 30.0 * mph).abs() < 1e-9 && speed.at_s == 0.0, "{speed:?}");
        assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0]);
        assert!((record.before.steering_wheel_rad[2] - 20_f64.to_radians()).abs() < 1e-12);
        assert_eq!(record.before.is_braked, [false, true, true]);
        assert!(record.doubts.iter().any(|doubt| doubt.starts_with("2 events")), "{record:?}");
        let second = read(REPORT, Some(2)).unwrap();
        let lateral = second.delta_v_right.unwrap();
        assert!((lateral.delta_v_m_s - 5.0 * mph).abs() < 1e-9, "{lateral:?}");
        assert_eq!((lateral.ends_s, second.delta_v_ahead), (Some(0.15), None));
        assert!(read(REPORT, Some(3)).is_err());
    }

    #[test]
    fn events_are_told_apart_and_their_tables_belong_together() {
        for (title, event) in [
            ("PRE-CRASH DATA (EVENT RECORD 1)", Some("EVENT RECORD 1")),
            ("PRE-CRASH DATA (EVENT RECORD 1 TABLE 2 OF 2)", Some("EVENT RECORD 1")),
            ("PRE-CRASH DATA (MOST RECENT EVENT) (TABLE 1 OF 2)", Some("MOST RECENT EVENT")),
            ("DELTA-V LONGITUDINAL (NON-DEPLOYMENT)", Some("NON-DEPLOYMENT")),
            ("PRE-CRASH DATA -5 TO 0 SEC (2 SAMPLES/SEC)", None),
        ] {
            assert_eq!(event_of(title).as_deref(), event, "{title}");
        }
        // Δv of a table without an event is that of none of two events.
        let other = REPORT
            .replace("\"DELTA-V, LONGITUDINAL (EVENT RECORD 1)\"", "\"DELTA-V, LONGITUDINAL\"");
        let record = read(&other, None).unwrap();
        assert_eq!(record.delta_v_ahead, None);
        let said = |word: &str| record.doubts.iter().any(|doubt| doubt.contains(word));
        assert!(said("of which event"), "{record:?}");
    }

    /// Δv ahead is cut off at 0.1 s, that to the right goes on to 0.25 s.
    #[test]
    fn changes_of_velocity_without_a_common_end_are_not_both_taken() {
        let text = |end: &str| {
            format!(
                "Time [ms],Delta-V Longitudinal [km/h],Delta-V Lateral [km/h]\n\
                 0,0,0\n50,-10,1\n80,-18,2\n100,{end},3\n200,,4\n250,,4\n"
            )
        };
        let record = read(&text("-25"), None).unwrap();
        assert!(record.delta_v_ahead.is_some() && record.delta_v_right.is_none(), "{record:?}");
        assert!(record.doubts.iter().any(|doubt| doubt.contains("different times")), "{record:?}");
        let settled = read(&text("-18"), None).unwrap();
        assert!(settled.delta_v_ahead.is_some() && settled.delta_v_right.is_some(), "{settled:?}");
    }

    #[test]
    fn a_pulse_that_is_cut_off_is_said_so() {
        let cut = REPORT.replace("100,-20\n120,-20\n", "100,-24\n");
        let record = read(&cut, None).unwrap();
        assert!(record.delta_v_ahead.unwrap().is_cut);
        assert!(record.doubts.iter().any(|doubt| doubt.contains("cut off")), "{record:?}");
    }

    #[test]
    fn an_anti_lock_system_that_was_at_work_is_read() {
        let text = "Time [s],Speed [mph],Service Brake,ABS Activity\n\
            -1,31,Off,Non-Engaged\n-0.5,27,On,Engaged\n0,20,On,Engaged\n";
        let before = read(text, None).unwrap().before;
        assert_eq!(before.is_anti_lock_active, [false, true, true]);
        assert_eq!(before.is_braked, [false, true, true]);
    }

    #[test]
    fn a_table_needs_units() {
        let text = "Time [s],Speed [mph],Yaw Rate [deg/s],Steering Wheel Angle [deg]\n\
            -1,31,0,0\n-0.5,27,-2,-10\n0,26,0,0\n";
        let record = read(text, None).unwrap();
        assert!((record.speed_before.unwrap().speed_m_s - 26.0 * 0.447_04).abs() < 1e-9);
        assert_eq!(record.before.yaw_rate_right_rad_s.len(), 3);
        let without = "Time [s],Speed,Steering Wheel Angle [deg]\n-1,31,0\n0,26,1\n";
        let error = read(without, None).unwrap_err().to_string();
        assert!(error.contains("no record of an event data recorder"), "{error}");
    }
}
