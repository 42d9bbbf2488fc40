//! What the columns of one table of an event data recorder hold, known by their names.

use crate::data::error::quoted;
use crate::data::formats::cdr::number;
use crate::data::formats::recorder::{
    LONGEST_S, RecordedControls, RecordedDeltaV, RecordedSpeed, RecorderRecord, SETTLED_S,
};
use crate::data::spelling::{letters_and_digits, quantity_name, trailing_unit};
use crate::ranges::{ANGULAR_VELOCITY_SAMPLE, INSTANT, Range, SPEED, STEERING_WHEEL_ANGLE};
use crate::units::Quantity;

/// Change over this time from which the record is cut off, m/s.
const CUT_M_S: f64 = 0.3;

/// The columns of a table: names with units, numbers and texts.
pub(super) struct Table563<'a> {
    pub header: Vec<String>,
    pub numbers: &'a dyn Fn(usize) -> Vec<Option<f64>>,
    pub texts: &'a dyn Fn(usize) -> Vec<String>,
}

impl RecorderRecord {
    /// Adds what the columns of a table hold.
    pub(super) fn add_table(&mut self, table: &Table563<'_>, has_controls: bool) {
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
        let is_before =
            |at_s: &Option<f64>| at_s.is_some_and(|at_s| at_s <= 0.0 && INSTANT.contains(at_s));
        let has_speed = |row: &usize| speed.get(*row).is_some_and(Option::is_some);
        let before: Vec<usize> =
            (0..time_s.len()).filter(|row| time_s.get(*row).is_some_and(is_before)).collect();
        let rows: Vec<usize> = before.iter().copied().filter(has_speed).collect();
        if let (Some(first), Some(last)) = (rows.first(), rows.last()) {
            let between = before.iter().filter(|row| (first..=last).contains(row));
            let n_missing = between.count() - rows.len();
            if n_missing > 0 {
                doubts.push(format!(
                    "rows before the crash that have no speed, between others that have one: {n_missing}; they \
                     are left out"
                ));
            }
        }
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
                        "column {} {} names no unit of {}; it is left out",
                        idx + 1,
                        quoted(name),
                        quantity_name(quantity)
                    ));
                }
                Ok(None) | Err(_) => {}
            }
        }
        None
    }
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
