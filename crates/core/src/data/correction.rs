//! Changes of a map that correct how a file is read. One value is the text of the map in a message, the
//! button of the import dialog, and what this button does.

use std::fmt;

use crate::data::{Channel, ColumnMap, ColumnSource, Thousands, VelocityAxes};

/// A change of a map that corrects how a file is read, with what it does in words.
///
/// ```
/// use impactlab_core::data::{ColumnMap, Correction};
///
/// let correction = Correction::shift(5.0);
/// assert_eq!(correction.label(), "Shift the time by 5 s");
/// let mut map: ColumnMap = "time=1:s,steer=2:deg".parse()?;
/// correction.apply(&mut map);
/// assert_eq!(map.to_string(), "shift=5:s,time=1:s,steer=2:deg");
/// assert_eq!(correction.to_string(), "shift=5:s");
/// # Ok::<(), impactlab_core::data::MapError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    label: String,
    changes: Vec<Change>,
}

/// A part of a map that is set.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Change {
    /// The column of a channel, with sign and unit.
    Column(Channel, ColumnSource),
    /// Whether yaw angles are compass headings.
    CompassHeadings(bool),
    /// What is added to every yaw angle, rad.
    YawOffset(f64),
    /// The axes of the velocities.
    Velocities(VelocityAxes),
    /// What is added to every instant, s.
    TimeShift(f64),
    /// Whether the decimal sign is a comma.
    DecimalComma(bool),
    /// What stands between thousands.
    Thousands(Thousands),
}

impl Correction {
    pub(super) fn new(label: String, changes: Vec<Change>) -> Self {
        Self { label, changes }
    }

    /// A shift of all instants.
    ///
    /// - `shift_s`: what is added to each of them, s.
    pub fn shift(shift_s: f64) -> Self {
        let sign = if shift_s < 0.0 { "−" } else { "" };
        let label = format!("Shift the time by {sign}{} s", shift_s.abs());
        Self::new(label, vec![Change::TimeShift(shift_s)])
    }

    /// What a map says that answers a question, in addition to the map that was given.
    ///
    /// - returns `None` if it says nothing else.
    pub(super) fn from_answer(given: Option<&ColumnMap>, answer: &ColumnMap) -> Option<Self> {
        if let Some(signs) = Self::from_signs(given, answer) {
            return Some(signs);
        }
        let is_new = |(channel, source): &(Channel, &ColumnSource)| {
            given.and_then(|map| map.get(*channel)) != Some(*source)
        };
        let columns: Vec<Change> = answer
            .iter()
            .filter(is_new)
            .map(|(channel, source)| Change::Column(channel, source.clone()))
            .collect();
        let given_s = given.and_then(|map| map.settings.time_shift_s);
        let shift = answer.settings.time_shift_s.filter(|shift_s| given_s != Some(*shift_s));
        let shift = shift.map(Self::shift);
        let columns = Self { label: String::new(), changes: columns };
        Some(match (columns.changes.is_empty(), shift) {
            (true, shift) => return shift,
            (false, None) => Self { label: format!("Read {columns}"), ..columns },
            (false, Some(shift)) => {
                let Self { label, changes } = shift;
                let label = format!("{label} and read {columns}");
                Self { label, changes: [changes, columns.changes].concat() }
            }
        })
    }

    /// What a map says of decimal sign and thousands, in addition to the map that was given.
    fn from_signs(given: Option<&ColumnMap>, answer: &ColumnMap) -> Option<Self> {
        let (given, answer) = (given.map(|map| &map.settings), &answer.settings);
        let is_comma = answer
            .decimal_comma
            .filter(|is_comma| given.and_then(|given| given.decimal_comma) != Some(*is_comma));
        if let Some(is_comma) = is_comma {
            let label = if is_comma { "Decimal commas" } else { "Decimal points" };
            return Some(Self::new(label.to_owned(), vec![Change::DecimalComma(is_comma)]));
        }
        let thousands = answer.thousands;
        let mark = thousands.filter(|_| given.and_then(|given| given.thousands) != thousands)?;
        let label = format!("{} between thousands", mark.label());
        Some(Self::new(label, vec![Change::Thousands(mark)]))
    }

    /// What it does, in words: the text of a button.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Changes a map.
    pub fn apply(&self, map: &mut ColumnMap) {
        for change in &self.changes {
            match change {
                Change::Column(channel, source) => map.insert(*channel, source.clone()),
                Change::CompassHeadings(is_compass) => map.settings.compass_headings = *is_compass,
                Change::YawOffset(offset_rad) => map.settings.yaw_offset_rad = Some(*offset_rad),
                Change::Velocities(axes) => map.settings.velocities = Some(*axes),
                Change::TimeShift(shift_s) => map.settings.time_shift_s = Some(*shift_s),
                Change::DecimalComma(is_comma) => map.settings.decimal_comma = Some(*is_comma),
                Change::Thousands(mark) => map.settings.thousands = Some(*mark),
            }
        }
    }

    /// Takes its change back.
    ///
    /// - `before`: the map as it was before the change. What is changed by other means since then stays.
    pub fn undo(&self, map: &mut ColumnMap, before: &ColumnMap) {
        let (settings, earlier) = (&mut map.settings, &before.settings);
        for change in &self.changes {
            match change {
                Change::Column(..) => {}
                Change::CompassHeadings(_) => settings.compass_headings = earlier.compass_headings,
                Change::YawOffset(_) => settings.yaw_offset_rad = earlier.yaw_offset_rad,
                Change::Velocities(_) => settings.velocities = earlier.velocities,
                Change::TimeShift(_) => settings.time_shift_s = earlier.time_shift_s,
                Change::DecimalComma(_) => settings.decimal_comma = earlier.decimal_comma,
                Change::Thousands(_) => settings.thousands = earlier.thousands,
            }
        }
        for change in &self.changes {
            if let Change::Column(channel, _) = change {
                match before.get(*channel) {
                    Some(source) => map.insert(*channel, source.clone()),
                    None => map.remove(*channel),
                }
            }
        }
    }

    /// Whether both change the same part of a map.
    pub fn overlaps(&self, other: &Self) -> bool {
        let is_same = |a: &Change, b: &Change| match (a, b) {
            (Change::Column(a, _), Change::Column(b, _)) => a == b,
            _ => std::mem::discriminant(a) == std::mem::discriminant(b),
        };
        self.changes.iter().any(|a| other.changes.iter().any(|b| is_same(a, b)))
    }
}

impl fmt::Display for Correction {
    /// Writes its parts as the text of a map.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, change) in self.changes.iter().enumerate() {
            f.write_str(if i > 0 { "," } else { "" })?;
            match change {
                Change::Column(channel, source) => write!(f, "{}={source}", channel.short_name()),
                Change::CompassHeadings(true) => f.write_str("headings=compass"),
                Change::CompassHeadings(false) => f.write_str("headings=yaw"),
                Change::YawOffset(offset_rad) => {
                    write!(f, "yaw_offset={}:deg", offset_rad.to_degrees())
                }
                Change::Velocities(VelocityAxes::Body) => f.write_str("velocities=body"),
                Change::Velocities(VelocityAxes::World) => f.write_str("velocities=world"),
                Change::TimeShift(shift_s) => write!(f, "shift={shift_s}:s"),
                Change::DecimalComma(true) => f.write_str("decimal=comma"),
                Change::DecimalComma(false) => f.write_str("decimal=point"),
                Change::Thousands(mark) => write!(f, "thousands={}", mark.name()),
            }?;
        }
        Ok(())
    }
}

/// The texts of maps of which one is to be chosen, such as `y=-3:m or yaw=-4:rad`.
pub(super) fn one_of(corrections: &[Correction]) -> String {
    let texts: Vec<String> = corrections.iter().map(Correction::to_string).collect();
    texts.join(" or ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_adds_what_it_says_and_can_be_taken_back() {
        let given: ColumnMap = "header=2,time=1,fx=2".parse().unwrap();
        for (answer, label, text) in [
            ("header=2,time=1,fx=2:N s", "Read fx=2:N s", "fx=2:N s"),
            ("shift=-0.5:s,header=2,time=1,fx=2", "Shift the time by −0.5 s", "shift=-0.5:s"),
            (
                "shift=-4:s,header=2,time=1:ns,fx=2",
                "Shift the time by −4 s and read time=1:ns",
                "shift=-4:s,time=1:ns",
            ),
        ] {
            let answer: ColumnMap = answer.parse().unwrap();
            let correction = Correction::from_answer(Some(&given), &answer).unwrap();
            assert_eq!((correction.label(), correction.to_string().as_str()), (label, text));
            let mut map = given.clone();
            correction.apply(&mut map);
            assert_eq!(map, answer);
            map.insert(
                Channel::Fy,
                "fy=3".parse::<ColumnMap>().unwrap().get(Channel::Fy).unwrap().clone(),
            );
            correction.undo(&mut map, &given);
            assert_eq!(map.to_string(), "header=2,time=1,fx=2,fy=3");
        }
        assert_eq!(Correction::from_answer(Some(&given), &given), None);
        for (answer, label) in
            [("decimal=point", "Decimal points"), ("thousands=point", "Points between thousands")]
        {
            let answer: ColumnMap = answer.parse().unwrap();
            let correction = Correction::from_answer(None, &answer).unwrap();
            assert_eq!((correction.label(), correction.to_string()), (label, answer.to_string()));
            let mut map = ColumnMap::default();
            correction.apply(&mut map);
            assert_eq!(map, answer);
            correction.undo(&mut map, &ColumnMap::default());
            assert_eq!(map, ColumnMap::default());
        }
    }
}
