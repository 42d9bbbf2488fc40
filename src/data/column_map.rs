//! A mapping of columns to channels that the user states, in the syntax of the option `--map`:
//! `fx=Kraft X:kN,time=1:ms`.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::data::error::quoted;
use crate::data::{Channel, spelling};
use crate::units::Unit;

/// A reference to a column of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ColumnRef {
    /// The number of the column, counted from 1.
    Number(usize),
    /// The header of the column, with or without the unit that it contains.
    Name(String),
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
/// use impactlab::data::{Channel, ColumnMap};
///
/// let map: ColumnMap = "time=1:ms, fx=Kraft X:kN, fy=Kraft Y:kN".parse()?;
/// assert_eq!(map.get(Channel::Fx).and_then(|fx| fx.unit).map(|unit| unit.symbol), Some("kN"));
/// assert_eq!(map.to_string(), "time=1:ms,fx=Kraft X:kN,fy=Kraft Y:kN");
/// # Ok::<(), impactlab::data::MapError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ColumnMap {
    sources: BTreeMap<Channel, ColumnSource>,
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
        Self { sources }
    }
}

impl FromStr for ColumnMap {
    type Err = MapError;

    /// Parses `channel=column[:unit]`, several of them separated by commas. A column is a number
    /// from 1 or a header. The text after the last colon is the unit if it names a unit of the
    /// channel, and otherwise part of the header.
    fn from_str(text: &str) -> Result<Self, MapError> {
        let mut map = Self::default();
        for part in text.split(',').filter(|part| !part.trim().is_empty()) {
            let (channel, source) = choice(part.trim())?;
            if map.sources.insert(channel, source).is_some() {
                return Err(MapError::Twice { channel });
            }
        }
        Ok(map)
    }
}

fn choice(part: &str) -> Result<(Channel, ColumnSource), MapError> {
    let syntax = || MapError::Syntax { part: part.to_owned() };
    let (name, column) = part.split_once('=').ok_or_else(syntax)?;
    let (name, column) = (name.trim(), column.trim());
    if name.is_empty() || column.is_empty() {
        return Err(syntax());
    }
    let channel =
        spelling::channel(name).ok_or_else(|| MapError::Channel { name: name.to_owned() })?;
    let with_unit = column.rsplit_once(':').and_then(|(column, text)| {
        let unit = spelling::unit(channel.quantity(), text.trim())?;
        Some((column.trim(), Some(unit)))
    });
    let (column, unit) = with_unit.unwrap_or((column, None));
    let column = match column.parse() {
        Ok(0) => return Err(MapError::ColumnZero { channel }),
        Ok(number) => ColumnRef::Number(number),
        Err(_) => ColumnRef::Name(column.to_owned()),
    };
    Ok((channel, ColumnSource { column, unit }))
}

impl fmt::Display for ColumnRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for ColumnMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (channel, source)) in self.iter().enumerate() {
            let comma = if i > 0 { "," } else { "" };
            write!(f, "{comma}{}={}", channel.short_name(), source.column)?;
            if let Some(unit) = source.unit {
                write!(f, ":{}", unit.symbol)?;
            }
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
    names.join(", ")
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
    fn a_long_mistake_is_quoted_in_part() {
        for text in ["x".repeat(100_000), format!("{}=1", "x".repeat(100_000))] {
            let error = text.parse::<ColumnMap>().unwrap_err().to_string();
            assert!(error.starts_with("\"xxxx") && error.len() < 600, "{} bytes", error.len());
        }
    }
}
