//! A mapping of columns to channels that the user states, in the syntax of the option `--map`:
//! `fx=Kraft X:kN,time=1:ms`.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::error::quoted;
use crate::data::{Channel, Formula, ReadSettings, spelling};
use crate::units::Unit;

/// What stands for a column if a channel is zero throughout.
const NO_COLUMN: &str = "none";

/// A reference to a column of a file.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnRef {
    /// The number of the column, counted from 1.
    Number(usize),
    /// The header of the column, with or without the unit that it contains.
    Name(String),
    /// Columns that are added up, `2+5`, or whose sign is changed, `-3`: the forces of several
    /// contacts between two vehicles, the force on the other vehicle, a time in seconds and
    /// nanoseconds.
    Sum(Vec<SignedColumn>),
    /// Columns from which the channel is computed, `quaternion(4 5 6 7)`.
    Computed(Formula, Vec<usize>),
    /// No column, `none`: the channel is zero throughout.
    Zero,
}

/// A term of a sum of columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignedColumn {
    /// The number of the column, counted from 1.
    pub number: usize,
    /// Whether the sign of its numbers is changed.
    pub is_negated: bool,
    /// The unit of its numbers where the terms have units of their own, `1:s+2:µs`; otherwise that of
    /// the sum applies.
    pub unit: Option<Unit>,
}

/// The column from which a channel is read, and its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnSource {
    /// The column.
    pub column: ColumnRef,
    /// The unit of the numbers. If it is `None`, the unit that the file states applies, or the SI
    /// unit if the file states none.
    pub unit: Option<Unit>,
}

/// The columns that the user has chosen for channels. They take precedence over what the headers
/// suggest.
///
/// ```
/// use impactlab_core::data::{Channel, ColumnMap};
///
/// let map: ColumnMap = "time=1:ms, fx=Kraft X:kN, fy=Kraft Y:kN".parse()?;
/// assert_eq!(map.get(Channel::Fx).and_then(|fx| fx.unit).map(|unit| unit.symbol), Some("kN"));
/// assert_eq!(map.to_string(), "time=1:ms,fx=Kraft X:kN,fy=Kraft Y:kN");
/// # Ok::<(), impactlab_core::data::MapError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
pub struct ColumnMap {
    sources: BTreeMap<Channel, ColumnSource>,
    /// How the file is read, apart from its columns.
    pub settings: Box<ReadSettings>,
}

/// The reason why the text of a mapping is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// A part has no `=`, or nothing on one side of it.
    #[error(
        "{} is no mapping, expected channel=column or channel=column:unit, e.g. fx=Kraft X:kN",
        quoted(part)
    )]
    Syntax {
        /// The part of the text between two commas.
        part: String,
    },
    /// The text to the left of `=` names no channel.
    #[error("{} is no channel, expected one of {}", quoted(name), short_names())]
    Channel {
        /// The text to the left of `=`.
        name: String,
    },
    /// The column has the number 0, but columns are counted from 1.
    #[error("{} is taken from column 0, but columns are counted from 1", channel.short_name())]
    ColumnZero {
        /// The channel that is mapped.
        channel: Channel,
    },
    /// The value of a setting is not one that it can have.
    #[error("{name}={} is not understood, expected {expected}", quoted(text))]
    Setting {
        /// The name of the setting.
        name: String,
        /// The text to the right of `=`.
        text: String,
        /// What it can be, in words.
        expected: &'static str,
    },
    /// A setting is given more than once.
    #[error("{name} is given twice")]
    SettingTwice {
        /// The name of the setting.
        name: String,
    },
    /// A channel is mapped more than once.
    #[error("{} is mapped twice", channel.short_name())]
    Twice {
        /// The channel that is mapped.
        channel: Channel,
    },
}

impl ColumnMap {
    /// Sets the column from which `channel` is read; it replaces an earlier choice.
    pub fn insert(&mut self, channel: Channel, source: ColumnSource) {
        self.sources.insert(channel, source);
    }

    /// Takes back the choice for a channel.
    pub fn remove(&mut self, channel: Channel) {
        self.sources.remove(&channel);
    }

    /// The column that was chosen for a channel; `None` if none was chosen.
    pub fn get(&self, channel: Channel) -> Option<&ColumnSource> {
        self.sources.get(&channel)
    }

    /// Returns all chosen columns, in the order of the channels.
    pub fn iter(&self) -> impl Iterator<Item = (Channel, &ColumnSource)> {
        self.sources.iter().map(|(channel, source)| (*channel, source))
    }
}

impl FromIterator<(Channel, ColumnSource)> for ColumnMap {
    fn from_iter<I: IntoIterator<Item = (Channel, ColumnSource)>>(choices: I) -> Self {
        let sources = choices.into_iter().collect();
        Self { sources, settings: Box::default() }
    }
}

impl FromStr for ColumnMap {
    type Err = MapError;

    /// Parses `channel=column[:unit]`, several of them separated by commas. A column is a number
    /// from 1, several of them with signs, `none` or a header. The text after the last colon is the
    /// unit if it names a unit of the channel, and otherwise part of the header. Settings
    /// ([`ReadSettings`]) stand among them.
    fn from_str(text: &str) -> Result<Self, MapError> {
        let mut map = Self::default();
        for part in parts(text) {
            let (name, value) = divided(part.trim())?;
            if map.settings.take(name, value)? {
                continue;
            }
            let (channel, source) = choice(name, value)?;
            if map.sources.insert(channel, source).is_some() {
                return Err(MapError::Twice { channel });
            }
        }
        Ok(map)
    }
}

/// The parts of a map between its commas. The comma of a place, `antenna=0.4,-0.3`, divides no parts.
fn parts(text: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for part in text.split(',').filter(|part| !part.trim().is_empty()) {
        let is_place = |last: &&mut String| {
            last.split('=').next().is_some_and(|name| name.trim() == "antenna")
        };
        match parts.last_mut().filter(is_place).filter(|_| !part.contains('=')) {
            Some(last) => {
                last.push(' ');
                last.push_str(part);
            }
            None => parts.push(part.to_owned()),
        }
    }
    parts
}

fn divided(part: &str) -> Result<(&str, &str), MapError> {
    let syntax = || MapError::Syntax { part: part.to_owned() };
    let (name, value) = part.split_once('=').ok_or_else(syntax)?;
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() || value.is_empty() {
        return Err(syntax());
    }
    Ok((name, value))
}

fn choice(name: &str, column: &str) -> Result<(Channel, ColumnSource), MapError> {
    let channel =
        spelling::channel(name).ok_or_else(|| MapError::Channel { name: name.to_owned() })?;
    if let Some(columns) = signed_columns(channel, column) {
        return sum(channel, columns);
    }
    let with_unit = column.rsplit_once(':').and_then(|(column, text)| {
        let unit = spelling::unit(channel.quantity(), text.trim())?;
        Some((column.trim(), Some(unit)))
    });
    let (column, unit) = with_unit.unwrap_or((column, None));
    // The unit itself may have a sign in it, `4:N-m`.
    if let Some(columns) = signed_columns(channel, column) {
        let (channel, source) = sum(channel, columns)?;
        return Ok((channel, ColumnSource { unit, ..source }));
    }
    let column = match computed(column) {
        Some((formula, numbers)) => ColumnRef::Computed(formula, numbers),
        None if column == NO_COLUMN => ColumnRef::Zero,
        None => ColumnRef::Name(column.to_owned()),
    };
    Ok((channel, ColumnSource { column, unit }))
}

/// The choice of one column by its number, or of several that are added up. The unit of the last term
/// is that of all if no other term has one.
fn sum(
    channel: Channel,
    mut columns: Vec<SignedColumn>,
) -> Result<(Channel, ColumnSource), MapError> {
    if columns.iter().any(|column| column.number == 0) {
        return Err(MapError::ColumnZero { channel });
    }
    let n_units = columns.iter().filter(|column| column.unit.is_some()).count();
    let mut unit = None;
    if n_units == 1
        && let Some(last) = columns.last_mut()
    {
        unit = last.unit.take();
    }
    let column = match columns[..] {
        [SignedColumn { number, is_negated: false, .. }] => ColumnRef::Number(number),
        _ => ColumnRef::Sum(columns),
    };
    Ok((channel, ColumnSource { column, unit }))
}

/// The formula and its columns in `quaternion(4 5 6 7)`; `None` if the text is none.
fn computed(text: &str) -> Option<(Formula, Vec<usize>)> {
    let (name, rest) = text.split_once('(')?;
    let formula = Formula::ALL.into_iter().find(|formula| formula.name() == name.trim())?;
    let numbers = rest.strip_suffix(')')?.split_whitespace().map(|number| number.parse().ok());
    let numbers: Vec<usize> = numbers.collect::<Option<_>>()?;
    (numbers.len() == formula.n_columns()).then_some((formula, numbers))
}

/// The terms of `2`, `2+5-7`, `-3` or `1:s+2:µs`; `None` if the text is no such sum.
fn signed_columns(channel: Channel, text: &str) -> Option<Vec<SignedColumn>> {
    let is_sign = |c: char| matches!(c, '+' | '-');
    let signed = match text.starts_with(is_sign) {
        true => text.to_owned(),
        false => format!("+{text}"),
    };
    let starts: Vec<usize> = signed.match_indices(is_sign).map(|(at, _)| at).collect();
    let ends = starts.iter().skip(1).copied().chain([signed.len()]);
    let term = |(start, end): (&usize, usize)| {
        let term = signed.get(*start..end)?;
        let (digits, unit) = match term.get(1..)?.split_once(':') {
            Some((digits, unit)) => {
                (digits, Some(spelling::unit(channel.quantity(), unit.trim())?))
            }
            None => (term.get(1..)?, None),
        };
        let digits = digits.trim();
        let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = digits.parse().ok().filter(|_| is_number)?;
        Some(SignedColumn { number, is_negated: term.starts_with('-'), unit })
    };
    starts.iter().zip(ends).map(term).collect()
}

impl fmt::Display for ColumnRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => f.write_str(name),
            Self::Sum(columns) => columns.iter().enumerate().try_for_each(|(i, column)| {
                let sign = match (column.is_negated, i) {
                    (true, _) => "-",
                    (false, 0) => "",
                    (false, _) => "+",
                };
                write!(f, "{sign}{}", column.number)?;
                column.unit.map_or(Ok(()), |unit| write!(f, ":{}", unit.symbol))
            }),
            Self::Computed(formula, numbers) => {
                let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
                write!(f, "{}({})", formula.name(), numbers.join(" "))
            }
            Self::Zero => f.write_str(NO_COLUMN),
        }
    }
}

impl fmt::Display for ColumnSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.column)?;
        self.unit.map_or(Ok(()), |unit| write!(f, ":{}", unit.symbol))
    }
}

impl fmt::Display for ColumnMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let settings = self.settings.to_string();
        f.write_str(&settings)?;
        for (i, (channel, source)) in self.iter().enumerate() {
            let comma = if i > 0 || !settings.is_empty() { "," } else { "" };
            write!(f, "{comma}{}={source}", channel.short_name())?;
        }
        Ok(())
    }
}

impl TryFrom<String> for ColumnMap {
    type Error = MapError;

    fn try_from(text: String) -> Result<Self, MapError> {
        text.parse()
    }
}

impl From<ColumnMap> for String {
    fn from(map: ColumnMap) -> Self {
        map.to_string()
    }
}

fn short_names() -> String {
    let names: Vec<_> = Channel::ALL.iter().map(|channel| channel.short_name()).collect();
    format!("{}; or {}", names.join(", "), ReadSettings::NAMES.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mappings_are_read_and_mistakes_are_named() {
        let map: ColumnMap = "yaw_rate_rad_s=Gier: Rate:deg/s".parse().unwrap();
        let source = map.get(Channel::YawRate).unwrap();
        assert_eq!(source.column, ColumnRef::Name("Gier: Rate".to_owned()));
        assert_eq!(source.unit.unwrap().symbol, "deg/s");
        for (text, message) in [
            (
                "fx",
                r#""fx" is no mapping, expected channel=column or channel=column:unit, e.g. fx=Kraft X:kN"#,
            ),
            ("fx=0", "fx is taken from column 0, but columns are counted from 1"),
            ("fx=1,fx=2", "fx is mapped twice"),
        ] {
            let error = text.parse::<ColumnMap>().unwrap_err();
            assert_eq!(error.to_string(), message);
        }
        let error = "force=1".parse::<ColumnMap>().unwrap_err().to_string();
        assert!(error.starts_with(r#""force" is no channel, expected one of time, x, y, yaw"#));
    }

    #[test]
    fn sums_signs_and_settings_are_written_as_they_are_read() {
        for text in [
            "sheet=2,header=5,units=6,shift=-0.012:s,y_axis=right,velocities=world,time=1,fx=2+5-7:kN",
            "header=none,fx=-3:kN,fy=none",
            "headings=compass,yaw_offset=-90:deg,yaw=4:deg",
            "sheet=Messung 2,fx=Kraft-X",
            "time=5:s+6:µs,x=east(2 3),y=north(2 3),yaw=quaternion(7 8 9 10)",
            "fx=2:N s,fy=-3:kN s",
            "separator=space,decimal=comma,thousands=point,header=2,fx=2",
            "separator=tab,decimal=point,thousands=apostrophe,sheet=2",
        ] {
            assert_eq!(text.parse::<ColumnMap>().unwrap().to_string(), text);
        }
        let with_sign: ColumnMap = "mz=4:N-m".parse().unwrap();
        assert_eq!(with_sign.to_string(), "mz=4:N m");
        let map: ColumnMap = "fx=2+5-7,shift=-12:ms".parse().unwrap();
        let terms = [(2, false), (5, false), (7, true)].map(|(number, is_negated)| SignedColumn {
            number,
            is_negated,
            unit: None,
        });
        assert_eq!(map.get(Channel::Fx).unwrap().column, ColumnRef::Sum(terms.to_vec()));
        assert_eq!(map.settings.time_shift_s, Some(-0.012));
        for (text, message) in [
            (
                "header=x",
                r#"header="x" is not understood, expected the number of a line or none, e.g. header=5"#,
            ),
            ("shift=1:kN", r#"shift="1:kN" is not understood, expected a time, e.g. shift=-12:ms"#),
            (
                "thousands=dot",
                r#"thousands="dot" is not understood, expected point, comma, apostrophe or space"#,
            ),
            ("units=6,units=7", "units is given twice"),
            (
                "yaw_offset=90",
                r#"yaw_offset="90" is not understood, expected an angle, e.g. yaw_offset=-90:deg"#,
            ),
            ("fx=2+0", "fx is taken from column 0, but columns are counted from 1"),
        ] {
            assert_eq!(text.parse::<ColumnMap>().unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn a_long_mistake_is_quoted_in_part() {
        for text in ["x".repeat(100_000), format!("{}=1", "x".repeat(100_000))] {
            let error = text.parse::<ColumnMap>().unwrap_err().to_string();
            assert!(error.starts_with("\"xxxx") && error.len() < 600, "{} bytes", error.len());
        }
    }
}
