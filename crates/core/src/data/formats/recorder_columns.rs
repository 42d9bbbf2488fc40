//! The columns of one table of an event data recorder, found by words in their names.

use crate::data::error::quoted;
use crate::data::formats::cdr::number;
use crate::data::formats::recorder::RecordedSide;
use crate::data::formats::recorder_table::falls;
use crate::data::spelling::{is_delta_v, letters_and_digits, quantity_name, trailing_unit};
use crate::data::stated_side::stated_side;
use crate::units::Quantity;

/// Words of columns of a change of velocity that are no record of it over time: its largest value, and the parts
/// of which it is the sum.
pub(super) const NO_RECORD: [&str; 3] = ["maximum", "persample", "changeper"];

/// German words in the letters of a header, with the English ones by which columns are known; those that hold others
/// come first. A `Lenkwinkel` without more is that of the road wheels.
const GERMAN: [(&str, &str); 48] = [
    ("geschwindigkeitsänderung", "deltav"),
    ("geschwindigkeitsaenderung", "deltav"),
    ("gierwinkelgeschwindigkeit", "yawrate"),
    ("giergeschwindigkeit", "yawrate"),
    ("gierrate", "yawrate"),
    ("winkelgeschwindigkeit", "anglerate"),
    ("radgeschwindigkeit", "wheelspeed"),
    ("raddrehzahl", "wheelspeed"),
    ("sollgeschwindigkeit", "targetspeed"),
    ("wunschgeschwindigkeit", "targetspeed"),
    ("zielgeschwindigkeit", "targetspeed"),
    ("relativgeschwindigkeit", "relativespeed"),
    ("quergeschwindigkeit", "lateralspeed"),
    ("geschwindigkeitsbegrenz", "speedlimit"),
    ("geschwindigkeit", "speed"),
    ("vorausfahrend", "lead"),
    ("vorderfahrzeug", "lead"),
    ("tempomat", "cruise"),
    ("längs", "longitudinal"),
    ("laengs", "longitudinal"),
    ("quer", "lateral"),
    ("seitlich", "lateral"),
    ("lenkradwinkel", "steeringwheelangle"),
    ("lenkrad", "steeringwheel"),
    ("lenkwinkel", "roadwheelsteerangle"),
    ("feststellbrems", "parkbrake"),
    ("notbrems", "emergencybrake"),
    ("bremsassist", "brakeassist"),
    ("bremsdruck", "brakepressure"),
    ("bremskraft", "brakeforce"),
    ("bremsmoment", "braketorque"),
    ("bremspedalstellung", "brakepedalposition"),
    ("bremspedalweg", "brakepedalposition"),
    ("bremswarn", "brakewarning"),
    ("brems", "brake"),
    ("antiblockier", "antilock"),
    ("maximal", "maximum"),
    ("proabtast", "persample"),
    ("jeabtast", "persample"),
    ("zeitvor", "timebefore"),
    ("sekundenvor", "secondsbefore"),
    ("zeitbiszum", "timeto"),
    ("zeitbis", "timeto"),
    ("aufprall", "impact"),
    ("kollision", "crash"),
    ("unfall", "crash"),
    ("zeit", "time"),
    ("sekunden", "seconds"),
];

/// The columns of a table: names with units, numbers and texts.
pub(super) struct Table563<'a> {
    pub header: Vec<String>,
    pub numbers: &'a dyn Fn(usize) -> Vec<Option<f64>>,
    pub texts: &'a dyn Fn(usize) -> Vec<String>,
}

pub(super) fn has(key: &str, words: &[&str]) -> bool {
    words.iter().any(|word| key.contains(word))
}

/// Whether a column has an angle of the road wheels.
pub(super) fn is_of_road_wheels(key: &str) -> bool {
    key.contains("steer") && key.contains("roadwheel")
}

impl Table563<'_> {
    pub(super) fn keys(&self) -> Vec<String> {
        let bare = |name: &String| {
            let name = name.rsplit_once('[').map_or(name.as_str(), |(bare, _)| bare);
            let key = letters_and_digits(name);
            GERMAN.iter().fold(key, |key, (german, english)| key.replace(*german, english))
        };
        self.header.iter().map(bare).collect()
    }

    /// That the columns of a speed are not of that of the car; `None` if there are none.
    pub(super) fn other_speeds(&self) -> Option<String> {
        let columns = self.keys().into_iter().zip(&self.header);
        let of_others = columns.filter(|(key, name)| {
            let has_unit = matches!(trailing_unit(name, Quantity::Speed), Ok(Some(_)));
            has_unit && key.contains("speed") && !is_delta_v(key)
        });
        let names: Vec<String> = of_others.map(|(_, name)| quoted(name)).collect();
        let said =
            "may not have the speed of the car and is not read; call its column Speed if it has";
        (!names.is_empty()).then(|| format!("{} {said}", names.join(", ")))
    }

    /// Columns of a change of velocity that are not read, with the reason.
    pub(super) fn unread_delta_v(&self) -> Vec<String> {
        let columns = self.keys().into_iter().zip(&self.header);
        let of_delta_v = columns.filter(|(key, name)| {
            let has_unit = matches!(trailing_unit(name, Quantity::Speed), Ok(Some(_)));
            is_delta_v(key) && has_unit && !key.contains("maximum")
        });
        let unread = |(key, name): (String, &String)| {
            let why = match () {
                () if has(&key, &NO_RECORD) => "has the change from sample to sample",
                () if has(&key, &["longitudinal", "lateral"]) => return None,
                () => "says neither longitudinal nor lateral in its name",
            };
            Some(format!("{} {why}; it is not read", quoted(name)))
        };
        of_delta_v.filter_map(unread).collect()
    }

    /// That a steer angle is that of the road wheels; `None` if there is none.
    pub(super) fn unread_steering(&self) -> Option<String> {
        let mut columns = self.keys().into_iter().zip(&self.header);
        let (_, name) = columns.find(|(key, _)| is_of_road_wheels(key))?;
        Some(format!("{} is an angle of the road wheels and is not read", quoted(name)))
    }

    /// What the first column says whose name fits and that is on or off in all rows; one that is not is said.
    pub(super) fn switch(
        &self,
        rows: &[usize],
        fits: impl Fn(&str) -> bool,
        name: &str,
        doubts: &mut Vec<String>,
    ) -> Option<Vec<bool>> {
        let keys = self.keys();
        let columns: Vec<usize> = (0..keys.len()).filter(|idx| fits(&keys[*idx])).collect();
        let read = |idx: &usize| {
            let texts = (self.texts)(*idx);
            rows.iter().map(|row| is_on(texts.get(*row)?)).collect::<Option<Vec<bool>>>()
        };
        let found = columns.iter().find_map(read);
        if found.is_none() && !columns.is_empty() {
            doubts.push(format!(
                "the {name} is not recorded as on or off throughout; it is left out"
            ));
        }
        found
    }

    /// Cells of a column that are neither blank nor numbers, such as dates that a spreadsheet has made of numbers.
    fn unreadable(&self, idx: usize, values: &[Option<f64>]) -> Option<String> {
        let texts = (self.texts)(idx);
        let is_text =
            |(text, value): &(&String, &Option<f64>)| value.is_none() && !text.trim().is_empty();
        let mut unreadable = texts.iter().zip(values).filter(is_text);
        let (first, _) = unreadable.next()?;
        Some(format!(
            "cells of {} that are no numbers: {}, the first of them {}; they are taken as blank",
            quoted(self.header.get(idx)?),
            1 + unreadable.count(),
            quoted(first)
        ))
    }

    /// As [`column`](Self::column), with the side to which the column says that it is positive. Where that is not the
    /// usual one, its numbers are turned and that is said.
    pub(super) fn sided(
        &self,
        quantity: Quantity,
        usual: Option<RecordedSide>,
        doubts: &mut Vec<String>,
        fits: impl Fn(&str) -> bool,
    ) -> Option<(Vec<Option<f64>>, Option<RecordedSide>)> {
        let (idx, mut values) = self.found(quantity, doubts, fits)?;
        let name = self.header.get(idx)?;
        let side = stated_side(name).filter(|_| usual.is_some());
        if let Some(side) = side.filter(|side| Some(*side) != usual) {
            values.iter_mut().flatten().for_each(|value| *value = 0.0 - *value);
            let (name, side) = (quoted(name), side.word());
            doubts.push(format!("{name} says that it is positive to the {side}; it is turned"));
        }
        Some((values, side))
    }

    /// The numbers of the first column whose name fits and that has a unit, in SI units. Others that fit are said.
    pub(super) fn column(
        &self,
        quantity: Quantity,
        doubts: &mut Vec<String>,
        fits: impl Fn(&str) -> bool,
    ) -> Option<Vec<Option<f64>>> {
        self.found(quantity, doubts, fits).map(|(_, values)| values)
    }

    /// The instants of the rows, s. Those that count the time before the crash by the name of their column are negative,
    /// and that is said.
    pub(super) fn instants_s(&self, doubts: &mut Vec<String>) -> Option<Vec<Option<f64>>> {
        let is_time = |key: &str| {
            let begins = ["time", "seconds", "precrashtime", "precrashseconds"];
            begins.iter().any(|begin| key.starts_with(begin)) && !key.contains("maximum")
        };
        let (idx, mut time_s) = self.found(Quantity::Time, doubts, is_time)?;
        let key = self.keys().into_iter().nth(idx)?;
        let written_s: Vec<f64> = time_s.iter().copied().flatten().collect();
        // Of the other names the order says whether the record goes up to the crash or counts down to it.
        let counts_back = has(&key, &["before", "prior"])
            || has(&key, &["timetocrash", "timetoimpact", "timetoae"])
            || key.contains("precrash") && falls(&written_s);
        let is_positive = written_s.iter().all(|at_s| *at_s >= 0.0);
        if counts_back && is_positive && written_s.iter().any(|at_s| *at_s > 0.0) {
            time_s.iter_mut().flatten().for_each(|at_s| *at_s = 0.0 - *at_s);
            let name = quoted(self.header.get(idx)?);
            doubts.push(format!(
                "{name} counts the time before the crash; its numbers are read as negative"
            ));
        }
        Some(time_s)
    }

    /// The same with the index of the column.
    fn found(
        &self,
        quantity: Quantity,
        doubts: &mut Vec<String>,
        fits: impl Fn(&str) -> bool,
    ) -> Option<(usize, Vec<Option<f64>>)> {
        for (idx, (name, key)) in self.header.iter().zip(self.keys()).enumerate() {
            if !fits(&key) {
                continue;
            }
            let stated = match trailing_unit(name, quantity) {
                Ok(None) if quantity == Quantity::Time && key.starts_with("seconds") => {
                    Ok(Some(quantity.si_unit()))
                }
                stated => stated,
            };
            match stated {
                Ok(Some(unit)) => {
                    let later = self.keys().into_iter().enumerate().skip(idx + 1);
                    let later: Vec<String> = later
                        .filter(|(_, key)| fits(key))
                        .filter_map(|(at, _)| self.header.get(at))
                        .filter(|name| matches!(trailing_unit(name, quantity), Ok(Some(_))))
                        .map(|name| quoted(name))
                        .collect();
                    if !later.is_empty() {
                        let later = later.join(", ");
                        doubts.push(format!("{} is read, and not {later}", quoted(name)));
                    }
                    let values = (self.numbers)(idx);
                    doubts.extend(self.unreadable(idx, &values));
                    let in_si = |value: Option<f64>| value.map(|value| unit.to_si(value));
                    return Some((idx, values.into_iter().map(in_si).collect()));
                }
                Ok(None) if quantity != Quantity::Angle || key.contains("wheel") => {
                    doubts.push(format!(
                        "column {} {} names no unit of {}; it is left out",
                        idx + 1,
                        quoted(name),
                        quantity_name(quantity)
                    ));
                }
                Ok(None) => {}
                Err(unit) => doubts.push(format!(
                    "column {} {} is in {}, which is no unit of {}; it is left out",
                    idx + 1,
                    quoted(name),
                    quoted(&unit),
                    quantity_name(quantity)
                )),
            }
        }
        None
    }
}

/// Whether a switch is on; `None` if the cell does not say.
fn is_on(cell: &str) -> Option<bool> {
    match letters_and_digits(cell).as_str() {
        // As spreadsheets in German write them, too.
        "on" | "yes" | "applied" | "pressed" | "active" | "engaged" | "true" | "ein" | "ja"
        | "wahr" => Some(true),
        "off" | "no" | "notapplied" | "released" | "notpressed" | "inactive" | "false"
        | "nonengaged" | "notengaged" | "aus" | "nein" | "falsch" => Some(false),
        _ => number(cell).filter(|number| [0.0, 1.0].contains(number)).map(|number| number != 0.0),
    }
}
