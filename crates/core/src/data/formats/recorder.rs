//! What an event data recorder has kept of a crash: the change of velocity, the speed before it, and what the
//! driver did in the seconds before. Read from the report of a Bosch CDR tool or from a table with
//! the elements of 49 CFR 563 (or UN R160), which any program may have written:
//!
//! ```text
//! Time [s],Speed [mph],Brake,Steering Wheel Angle [deg],Delta-V, Longitudinal [km/h],Delta-V, Lateral [km/h]
//! ```
//!
//! A column whose header names no unit is left out, and said so. Headers may be in German. Lateral values and the yaw
//! rate are positive to the right, as SAE J1698 has them; a steering wheel is positive to the left. A column that
//! names another side is turned.

use std::borrow::Cow;
use std::path::Path;

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::error::quoted;
use crate::data::formats::cdr::{
    MAX_BYTES, Report, Row, Section, column_name, is_before_crash, is_over_time, is_report,
    is_unread, joined,
};
use crate::data::formats::number_text;
use crate::data::formats::recorder_columns::Table563;
use crate::data::formats::upright::upright;
use crate::data::spelling::{is_delta_v, letters_and_digits, trailing_unit};
use crate::data::text::read_text;
use crate::data::{DataError, ReadSettings, Table};
use crate::ranges::SPEED;
use crate::units::{KILOMETRE_PER_HOUR_M_S, MILE_PER_HOUR_M_S, Quantity};

/// Time at the end of a record of the change of velocity over which it no longer changes if the record is
/// complete, s.
pub(super) const SETTLED_S: f64 = 0.02;

/// Lines within which the header of a table stands.
const HEADER_LINES: usize = 5;

/// Longest time over which a change of velocity is recorded, s.
pub(super) const LONGEST_S: f64 = 2.0;

/// By how much the largest change of velocity of a report may be beyond the end of its record.
const LARGER_SHARE: f64 = 1.2;
const LARGER_M_S: f64 = 0.5;

/// Change of velocity up to which 49 CFR 563 and UN R160 ask a recorder to count, 100 km/h, less half of 1 mph, m/s.
const RANGE_END_M_S: f64 = 100.0 * KILOMETRE_PER_HOUR_M_S - 0.5 * MILE_PER_HOUR_M_S;

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
    /// To which sides its values are positive in the file, where their columns say so. What is positive to another
    /// side than usual was turned.
    pub sides: RecordedSides,
}

/// A side to which recorded values are positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordedSide {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

impl RecordedSide {
    /// Its word in a sentence.
    pub fn word(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// To which sides values are positive in a file; `None` where it does not say.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RecordedSides {
    /// Of the lateral change of velocity.
    pub lateral: Option<RecordedSide>,
    /// Of the yaw rate.
    pub yaw_rate: Option<RecordedSide>,
    /// Of the angle of the steering wheel.
    pub steering: Option<RecordedSide>,
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

impl RecordedControls {
    /// Whether the driver braked, or the anti-lock system was at work, at an instant that was recorded.
    ///
    /// - `time_s`: the instant, s.
    pub fn is_braked_at(&self, time_s: f64) -> bool {
        let at = self.time_s.iter().position(|of_s| (of_s - time_s).abs() < 1e-6);
        let is_on = |of: &[bool]| at.and_then(|at| of.get(at)).is_some_and(|on| *on);
        is_on(&self.is_braked) || is_on(&self.is_anti_lock_active)
    }
}

impl RecorderRecord {
    /// Reads the record of an event.
    ///
    /// - `event`: its number among those of the file, counted from 1; `None` is the first. A table has one.
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
        let mut record = match is_cdr {
            Some(report) => Self::from_report(path, &report, event)?,
            None => match event {
                None | Some(1) => {
                    Self::from_table(&Table::read_as(path, &ReadSettings::default())?)
                }
                Some(number) => return Err(no_event(path, number, vec!["event 1".to_owned()])),
            },
        };
        if record.is_empty() {
            return Err(DataError::NoRecord { path: path.to_owned(), doubts: record.doubts });
        }
        let changes = [(record.delta_v_ahead, "ahead"), (record.delta_v_right, "to the right")];
        record.doubts.extend(changes.into_iter().filter_map(beyond_range));
        Ok(record)
    }

    /// Whether a file is the report of a recorder's tool.
    pub fn is_report(path: &Path) -> bool {
        read_text(path, MAX_TABLE_BYTES).is_ok_and(|text| is_report(&text.text))
    }

    /// Turns lateral changes of velocity that a report has as positive to the left, unless it says their side itself.
    pub fn turn_lateral(&mut self) {
        if !self.is_open(self.sides.lateral, RecordedSide::Left, "lateral Δv") {
            return;
        }
        if let Some(delta_v) = &mut self.delta_v_right {
            delta_v.delta_v_m_s = 0.0 - delta_v.delta_v_m_s;
        }
    }

    /// Turns yaw rates that a report has as positive to the left, likewise.
    pub fn turn_yaw_rate(&mut self) {
        if self.is_open(self.sides.yaw_rate, RecordedSide::Left, "the yaw rate") {
            self.before.yaw_rate_right_rad_s.iter_mut().for_each(|rate| *rate = 0.0 - *rate);
        }
    }

    /// Turns angles of the steering wheel that a report has as positive to the right, likewise.
    pub fn turn_steering(&mut self) {
        if self.is_open(self.sides.steering, RecordedSide::Right, "the angle of the steering wheel")
        {
            self.before.steering_wheel_rad.iter_mut().for_each(|angle| *angle = 0.0 - *angle);
        }
    }

    /// Whether the file leaves open to which side values are positive. One that says another side than somebody does is
    /// believed, and that is said.
    fn is_open(&mut self, stated: Option<RecordedSide>, said: RecordedSide, name: &str) -> bool {
        if let Some(stated) = stated.filter(|stated| *stated != said) {
            self.doubts.push(format!(
                "{name} is positive to the {} by its column, not to the {}; the column counts",
                stated.word(),
                said.word()
            ));
        }
        stated.is_none()
    }

    /// Whether a file is such a report, or a table with a change of velocity in its first lines.
    pub fn is_record(path: &Path) -> bool {
        let Ok(text) = read_text(path, MAX_BYTES as u64) else { return false };
        let mut first = text.text.lines().take(HEADER_LINES).map(letters_and_digits);
        is_report(&text.text) || first.any(|line| is_delta_v(&line))
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
                None => return Err(no_event(path, number, events)),
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
            let is_record = is_over_time(section) && section.is_table();
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
        for section in sections.iter().filter(|section| is_unread(section)) {
            record.doubts.push(format!(
                "the table {:?} has no header above its rows and no row of times that leaves nothing open, and is \
                 not read: write its times and its values below each other",
                section.title
            ));
        }
        for table in joined(&sections) {
            record.add_section(&table);
        }
        // A record over time says more than its largest value.
        sections.iter().for_each(|section| record.add_keys(section));
        record.keep_one_end();
        Ok(record)
    }

    /// Adds a table of a report.
    fn add_section(&mut self, section: &Section) {
        let numbers = |idx: usize| section.column(idx);
        let texts = |idx: usize| section.texts(idx);
        let table = Table563 { header: section.header(), numbers: &numbers, texts: &texts };
        if section.is_turned {
            self.description += "; times stand in a row";
            if !section.title.is_empty() {
                self.description += &format!(" in {:?}", section.title);
            }
        }
        // Modules with their times in a row have them among the status of the system, too.
        let has_controls = is_before_crash(section) || section.is_turned && !is_over_time(section);
        let before = (self.delta_v_ahead, self.delta_v_right, self.doubts.len());
        self.add_table(&table, has_controls);
        let after = (self.delta_v_ahead, self.delta_v_right, self.doubts.len());
        if !has_controls && is_over_time(section) && after == before {
            self.doubts.push(format!(
                "nothing is read of the table {:?}: it has no change of velocity over time in columns that say so with their \
                 unit",
                section.title
            ));
        }
    }

    /// The table if its times stand in a row, as a section of a report.
    fn turned(table: &Table) -> Option<Section> {
        if table.has_header() {
            return None;
        }
        let cell = |cell: Cow<'_, str>| match table.dialect().number(&cell) {
            Some(number) => number_text(number),
            None => cell.into_owned(),
        };
        let row = |(line, cells): (u64, Vec<Cow<'_, str>>)| -> Row {
            (line, cells.into_iter().map(cell).collect())
        };
        let rows: Vec<Row> = table.rows().map(row).collect();
        let (at, rows) = upright(&rows)?;
        (at == 0).then_some(Section { title: String::new(), rows, is_turned: true })
    }

    fn from_table(table: &Table) -> Self {
        let mut record =
            Self { description: "a table of an event data recorder".to_owned(), ..Self::default() };
        if let Some(section) = Self::turned(table) {
            record.add_section(&section);
            record.keep_one_end();
            return record;
        }
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
        record.add_table(&Table563 { header, numbers: &numbers, texts: &texts }, true);
        let columns: Vec<usize> = (0..table.header().len()).collect();
        let open = table.ambiguous_number(&columns).map(|(row, column)| table.cell(row, column));
        record.doubts.extend(open.map(|text| {
            format!(
                "{} may have a decimal sign or thousands, and nothing in the file says which; a decimal sign is taken",
                quoted(&text)
            )
        }));
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
            match *slot {
                None if SPEED.contains(delta_v_m_s) => {
                    *slot = Some(RecordedDeltaV { delta_v_m_s, ends_s, is_cut: false });
                }
                Some(of)
                    if delta_v_m_s.abs() > LARGER_SHARE * of.delta_v_m_s.abs() + LARGER_M_S =>
                {
                    self.doubts.push(format!(
                        "the largest change of velocity is {delta_v_m_s:.2} m/s by the report ({}) and {:.2} m/s \
                         at the end of its record: the record is cut off, or one of them is of another event",
                        section.title, of.delta_v_m_s
                    ));
                }
                None | Some(_) => {}
            }
        }
    }
}

/// That a change of velocity is where recorders stop counting, or have a number that stands for none.
fn beyond_range((delta_v, name): (Option<RecordedDeltaV>, &str)) -> Option<String> {
    let size_m_s = delta_v?.delta_v_m_s.abs();
    (size_m_s >= RANGE_END_M_S).then(|| {
        format!(
            "the change of velocity {name} is {:.0} km/h ({:.0} mph): recorders need not count beyond 100 km/h, so that it \
             may have been larger, and 126 and 127 stand for no value in some",
            size_m_s / KILOMETRE_PER_HOUR_M_S,
            size_m_s / MILE_PER_HOUR_M_S
        )
    })
}

fn no_event(path: &Path, number: usize, found: Vec<String>) -> DataError {
    DataError::NoSheet { path: path.to_owned(), wanted: format!("event {number}"), found }
}

/// The event in parentheses in the name of a section. How often it was sampled, the number of a table and, of a numbered
/// event, its kind may stand beside it and are no part of its name.
fn event_of(title: &str) -> Option<String> {
    let groups = title.split('(').skip(1).filter_map(|rest| rest.split(')').next());
    let mut names = groups.filter(|name| {
        let lower = name.to_lowercase();
        ["event", "record", "deployment"].iter().any(|word| lower.contains(word))
    });
    let name = names.next()?.trim();
    let sampled = name.strip_prefix('[').and_then(|rest| rest.split_once(']'));
    let name = sampled.map_or(name, |(_, name)| name);
    let lower = name.to_ascii_lowercase();
    let end = lower.find(" table ").unwrap_or(name.len());
    let is_numbered = lower.get(..end)?.contains(|c: char| c.is_ascii_digit());
    let kinds = [" - deployment", " - non-deployment"];
    let kind = kinds.iter().find_map(|kind| lower.find(kind)).filter(|_| is_numbered);
    let name = name.get(..kind.unwrap_or(end).min(end))?;
    Some(name.trim().trim_end_matches([' ', '-']).to_owned())
}

#[cfg(test)]
#[path = "recorder_tests.rs"]
mod tests;
