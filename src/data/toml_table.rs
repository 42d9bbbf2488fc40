//! One table of a TOML file, read key by key with the place of each: units in the key names, ranges,
//! nothing unknown.

use std::collections::BTreeSet;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::collision::ScenarioFileError;
use crate::units::{Quantity, Unit};

/// Lowest and highest value, SI.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range(pub f64, pub f64);

/// A file's name and text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub text: &'a str,
}

impl<'a> Source<'a> {
    pub fn parse(self) -> Result<Spanned<DeTable<'a>>, ScenarioFileError> {
        DeTable::parse(self.text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            let (line, column) = self.line_column(at);
            ScenarioFileError::Syntax {
                path: self.path.to_owned(),
                line,
                column,
                message: error.message().to_owned(),
            }
        })
    }

    /// Line and column of a byte, both from 1, columns in characters.
    fn line_column(self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before[line_start..].chars().count() + 1;
        (before.matches('\n').count() + 1, column)
    }
}

/// A table, and which of its keys were read.
#[derive(Debug)]
pub(super) struct Section<'a> {
    source: Source<'a>,
    name: String,
    at: usize,
    table: &'a DeTable<'a>,
    used: BTreeSet<String>,
    last_key: String,
}

impl<'a> Section<'a> {
    pub fn root(source: Source<'a>, root: &'a Spanned<DeTable<'a>>) -> Self {
        Self::new(source, String::new(), 0, root.get_ref())
    }

    fn new(source: Source<'a>, name: String, at: usize, table: &'a DeTable<'a>) -> Self {
        Self { source, name, at, table, used: BTreeSet::new(), last_key: String::new() }
    }

    /// A table inside this one; it must be there.
    pub fn table(&mut self, key: &str) -> Result<Self, ScenarioFileError> {
        let Some((at, value)) = self.take(key) else {
            return Err(self.missing(&format!("[{key}]")));
        };
        let Some(table) = value.get_ref().as_table() else {
            return Err(self.bad_value(key, value, "a table".to_owned()));
        };
        Ok(Self::new(self.source, key.to_owned(), at, table))
    }

    pub fn string(&mut self, key: &str) -> Result<Option<String>, ScenarioFileError> {
        let Some((_, value)) = self.take(key) else {
            return Ok(None);
        };
        match value.get_ref().as_str() {
            Some(text) => Ok(Some(text.to_owned())),
            None => Err(self.bad_value(key, value, "a text in quotes".to_owned())),
        }
    }

    /// Index of the word that the key gives.
    pub fn choice(
        &mut self,
        key: &str,
        words: &[&str],
    ) -> Result<Option<usize>, ScenarioFileError> {
        let Some((_, value)) = self.take(key) else {
            return Ok(None);
        };
        let text = value.get_ref().as_str();
        match words.iter().position(|&word| text == Some(word)) {
            Some(idx) => Ok(Some(idx)),
            None => {
                let quoted: Vec<_> = words.iter().map(|word| format!("{word:?}")).collect();
                Err(self.bad_value(key, value, quoted.join(" or ")))
            }
        }
    }

    /// A number in SI units from the one key `base_unit` that is there.
    pub fn number(
        &mut self,
        base: &str,
        quantity: Quantity,
        range: Range,
    ) -> Result<Option<f64>, ScenarioFileError> {
        let mut found: Option<(String, f64)> = None;
        for unit in quantity.units() {
            let key = key_of(base, unit);
            let Some((_, value)) = self.take(&key) else {
                continue;
            };
            let si = self.in_range(&key, value, unit, range)?;
            if let Some((other, _)) = found {
                return Err(self.conflict(&other));
            }
            found = Some((key, si));
        }
        Ok(found.map(|(_, si)| si))
    }

    /// As [`Section::number`], for a quantity that must be there.
    pub fn require(
        &mut self,
        base: &str,
        quantity: Quantity,
        range: Range,
    ) -> Result<f64, ScenarioFileError> {
        let key = key_of(base, &quantity.si_unit());
        self.number(base, quantity, range)?.ok_or_else(|| self.missing(&key))
    }

    /// Refuses what was not read.
    pub fn finish(self) -> Result<(), ScenarioFileError> {
        for key in self.table.keys() {
            let name: &str = key.get_ref();
            if !self.used.contains(name) {
                let (line, column) = self.source.line_column(key.span().start);
                return Err(ScenarioFileError::UnknownKey {
                    path: self.source.path.to_owned(),
                    line,
                    column,
                    key: self.full(name),
                });
            }
        }
        Ok(())
    }

    /// The last key that was there.
    pub fn last_key(&self) -> String {
        self.last_key.clone()
    }

    pub fn missing(&self, key: &str) -> ScenarioFileError {
        let (line, column) = self.source.line_column(self.at);
        ScenarioFileError::MissingKey {
            path: self.source.path.to_owned(),
            line,
            column,
            key: self.full(key),
        }
    }

    /// The last key that was there says again what `other` says.
    pub fn conflict(&self, other: &str) -> ScenarioFileError {
        let here = self.table.keys().find(|key| *key.get_ref() == self.last_key);
        let at = here.map_or(self.at, |key| key.span().start);
        let (line, column) = self.source.line_column(at);
        ScenarioFileError::Conflict {
            path: self.source.path.to_owned(),
            line,
            column,
            key: self.full(&self.last_key),
            other: other.to_owned(),
        }
    }

    fn take(&mut self, key: &str) -> Option<(usize, &'a Spanned<DeValue<'a>>)> {
        let table = self.table;
        let (found, value) = table.iter().find(|(k, _)| *k.get_ref() == key)?;
        self.used.insert(key.to_owned());
        key.clone_into(&mut self.last_key);
        Some((found.span().start, value))
    }

    fn in_range(
        &self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        unit: &Unit,
        Range(low, high): Range,
    ) -> Result<f64, ScenarioFileError> {
        // Rounding in the unit's factor must not refuse the limit itself.
        let slack = 1e-12 * low.abs().max(high.abs());
        let si = parse_number(value.get_ref()).map(|number| unit.to_si(number));
        match si {
            Some(si) if si >= low - slack && si <= high + slack => Ok(si),
            _ => {
                let [low, high] = [low, high].map(|si| {
                    let shown = unit.from_si(si);
                    (shown * 1e6).round() / 1e6
                });
                let expected = format!("{low} to {high} {}", unit.symbol);
                Err(self.bad_value(key, value, expected.trim_end().to_owned()))
            }
        }
    }

    fn bad_value(
        &self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        expected: String,
    ) -> ScenarioFileError {
        let span = value.span();
        let (line, column) = self.source.line_column(span.start);
        let text = self.source.text.get(span).unwrap_or_default();
        ScenarioFileError::Value {
            path: self.source.path.to_owned(),
            line,
            column,
            key: self.full(key),
            value: text.lines().next().unwrap_or_default().to_owned(),
            expected,
        }
    }

    fn full(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }
}

/// `speed` in km/h is `speed_km_h`, `yaw_inertia` in kg m² is `yaw_inertia_kg_m2`, a ratio `e` is
/// `e` and in per cent `e_percent`.
fn key_of(base: &str, unit: &Unit) -> String {
    match unit.symbol {
        "" => base.to_owned(),
        "%" => format!("{base}_percent"),
        symbol => {
            let suffix = symbol.replace(['/', ' '], "_").replace('²', "2").replace('µ', "u");
            format!("{base}_{suffix}")
        }
    }
}

fn parse_number(value: &DeValue<'_>) -> Option<f64> {
    if let Some(float) = value.as_float() {
        return float.as_str().parse().ok();
    }
    let integer = value.as_integer()?;
    let number = i64::from_str_radix(integer.as_str(), integer.radix()).ok()?;
    Some(number as f64)
}
