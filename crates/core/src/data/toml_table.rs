//! Reads one table of a TOML file key by key. The unit is part of the name of a key, each number
//! has a range, and a key that is never read is an error.

use std::collections::BTreeSet;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::data::{TomlError, TomlFile};
use crate::ranges::Range;
use crate::units::{Quantity, Unit};

/// A table of a TOML file, with the keys that have been read so far.
#[derive(Debug)]
pub struct TomlTable<'a> {
    file: TomlFile<'a>,
    name: String,
    at: usize,
    table: &'a DeTable<'a>,
    used: BTreeSet<String>,
    last_key: String,
}

impl<'a> TomlTable<'a> {
    /// The table at the top level of a file.
    ///
    /// - `root`: the result of [`TomlFile::parse`] for this file.
    pub fn root(file: TomlFile<'a>, root: &'a Spanned<DeTable<'a>>) -> Self {
        Self::new(file, String::new(), 0, root.get_ref())
    }

    fn new(file: TomlFile<'a>, name: String, at: usize, table: &'a DeTable<'a>) -> Self {
        Self { file, name, at, table, used: BTreeSet::new(), last_key: String::new() }
    }

    /// Reads a table inside this one, which is required.
    ///
    /// # Errors
    /// [`TomlError::MissingKey`] if there is no such key, and [`TomlError::Value`] if it is not a
    /// table.
    pub fn table(&mut self, key: &str) -> Result<Self, TomlError> {
        let Some((at, value)) = self.take(key) else {
            return Err(self.missing(&format!("[{key}]")));
        };
        let Some(table) = value.get_ref().as_table() else {
            return Err(self.bad_value(key, value, "a table".to_owned()));
        };
        Ok(Self::new(self.file, key.to_owned(), at, table))
    }

    /// Reads a table inside this one; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if it is not a table.
    pub fn optional_table(&mut self, key: &str) -> Result<Option<Self>, TomlError> {
        match self.table.contains_key(key) {
            true => self.table(key).map(Some),
            false => Ok(None),
        }
    }

    /// Reads the tables of an array of tables, `[[key]]`; none if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if it is not an array of tables.
    pub fn tables(&mut self, key: &str) -> Result<Vec<Self>, TomlError> {
        let Some((_, value)) = self.take(key) else { return Ok(Vec::new()) };
        let wrong = || self.bad_value(key, value, format!("tables, each after [[{key}]]"));
        let entries = value.get_ref().as_array().ok_or_else(wrong)?;
        let table = |(idx, entry): (usize, &'a Spanned<DeValue<'a>>)| {
            let table = entry.get_ref().as_table().ok_or_else(wrong)?;
            Ok(Self::new(self.file, format!("{key}[{idx}]"), entry.span().start, table))
        };
        entries.iter().enumerate().map(table).collect()
    }

    /// Reads `true` or `false`; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if the value is neither.
    pub fn flag(&mut self, key: &str) -> Result<Option<bool>, TomlError> {
        let Some((_, value)) = self.take(key) else { return Ok(None) };
        match value.get_ref().as_bool() {
            Some(flag) => Ok(Some(flag)),
            None => Err(self.bad_value(key, value, "true or false".to_owned())),
        }
    }

    /// Reads a list of words, each at most once, as their indices in `words`; `None` if there is no
    /// such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] at the first entry that is none of them, or stands there twice.
    pub fn choices(&mut self, key: &str, words: &[&str]) -> Result<Option<Vec<usize>>, TomlError> {
        let Some((_, value)) = self.take(key) else { return Ok(None) };
        let quoted: Vec<_> = words.iter().map(|word| format!("{word:?}")).collect();
        let expected = format!("a list of {}, each once", quoted.join(", "));
        let Some(entries) = value.get_ref().as_array() else {
            return Err(self.bad_value(key, value, expected));
        };
        let mut found = Vec::new();
        for entry in entries.iter() {
            let text = entry.get_ref().as_str();
            match words.iter().position(|&word| text == Some(word)) {
                Some(idx) if !found.contains(&idx) => found.push(idx),
                _ => return Err(self.bad_value(key, entry, expected)),
            }
        }
        Ok(Some(found))
    }

    /// Reads the lower and the upper end of a range as [`TomlTable::number`] reads a number:
    /// `speed_km_h = [40, 90]`; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if these are not two numbers in the range, the first one the smaller, and
    /// [`TomlError::Conflict`] if it is given in two units.
    pub fn interval(&mut self, base: &str, range: &Range) -> Result<Option<[f64; 2]>, TomlError> {
        let mut found: Option<(String, [f64; 2])> = None;
        for unit in range.quantity.units() {
            let key = key_with_unit(base, unit);
            let Some((_, value)) = self.take(&key) else { continue };
            let ends = value
                .get_ref()
                .as_array()
                .map(|ends| ends.iter().map(|end| self.in_range(base, end, unit, range)).collect());
            let ends: Option<Vec<f64>> = ends.transpose()?;
            let Some(&[low, high]) =
                ends.as_deref().filter(|ends| ends.len() == 2 && ends[0] < ends[1])
            else {
                let expected = "the lower and the upper end of a range, [low, high]".to_owned();
                return Err(self.bad_value(&key, value, expected));
            };
            if let Some((other, _)) = found {
                return Err(self.conflict(&other));
            }
            found = Some((key, [low, high]));
        }
        Ok(found.map(|(_, ends)| ends))
    }

    /// Reads a list of points `[[x, y], …]` under a key that has its unit in it; `None` if there is no
    /// such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] at the first entry that is not a pair of numbers in the range.
    pub fn points(&mut self, key: &str, range: &Range) -> Result<Option<Vec<[f64; 2]>>, TomlError> {
        let Some((_, value)) = self.take(key) else { return Ok(None) };
        let expected = format!("points [x, y], each {}", range.expected_si());
        let Some(entries) = value.get_ref().as_array() else {
            return Err(self.bad_value(key, value, expected));
        };
        entries
            .iter()
            .map(|entry| {
                self.pair(entry, range).ok_or_else(|| self.bad_value(key, entry, expected.clone()))
            })
            .collect::<Result<_, _>>()
            .map(Some)
    }

    /// Reads one point `[x, y]` under a key that has its unit in it; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if it is not a pair of numbers in the range.
    pub fn point(&mut self, key: &str, range: &Range) -> Result<Option<[f64; 2]>, TomlError> {
        let Some((_, value)) = self.take(key) else { return Ok(None) };
        match self.pair(value, range) {
            Some(pair) => Ok(Some(pair)),
            None => {
                let expected = format!("a point [x, y], each {}", range.expected_si());
                Err(self.bad_value(key, value, expected))
            }
        }
    }

    /// A pair of numbers in a range, SI units.
    fn pair(&self, value: &Spanned<DeValue<'_>>, range: &Range) -> Option<[f64; 2]> {
        let entries = value.get_ref().as_array()?;
        let mut numbers = entries
            .iter()
            .map(|entry| parse_number(entry.get_ref()).filter(|number| range.contains(*number)));
        match (numbers.next(), numbers.next(), numbers.next()) {
            (Some(x), Some(y), None) => Some([x?, y?]),
            _ => None,
        }
    }

    /// Reads a text; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if the value is not a text.
    pub fn string(&mut self, key: &str) -> Result<Option<String>, TomlError> {
        let Some((_, value)) = self.take(key) else {
            return Ok(None);
        };
        match value.get_ref().as_str() {
            Some(text) => Ok(Some(text.to_owned())),
            None => Err(self.bad_value(key, value, "a text in quotes".to_owned())),
        }
    }

    /// Reads a list of texts; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if it is not a list, or at the first entry that is not a text.
    pub fn strings(&mut self, key: &str) -> Result<Option<Vec<String>>, TomlError> {
        let Some((_, value)) = self.take(key) else { return Ok(None) };
        let expected = || "texts in quotes, [\"a\", \"b\"]".to_owned();
        let Some(entries) = value.get_ref().as_array() else {
            return Err(self.bad_value(key, value, expected()));
        };
        let text = |entry: &Spanned<DeValue<'_>>| match entry.get_ref().as_str() {
            Some(text) => Ok(text.to_owned()),
            None => Err(self.bad_value(key, entry, expected())),
        };
        entries.iter().map(text).collect::<Result<_, _>>().map(Some)
    }

    /// Reads one of several words and returns its index in `words`; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if the value is not one of the words.
    pub fn choice(&mut self, key: &str, words: &[&str]) -> Result<Option<usize>, TomlError> {
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

    /// Reads a number and converts it to SI units; `None` if there is no such key. The name of the
    /// key is `base`, an underscore and one of the units of the range's quantity, such as
    /// `speed_km_h`.
    ///
    /// # Errors
    /// [`TomlError::Value`] if the value is not a number or outside the range, and
    /// [`TomlError::Conflict`] if the number is given in two units.
    pub fn number(&mut self, base: &str, range: &Range) -> Result<Option<f64>, TomlError> {
        self.number_in(base, range, range.quantity.units())
    }

    /// Reads a number as [`TomlTable::number`] does, in one of the given units.
    ///
    /// # Errors
    /// The same as for [`TomlTable::number`].
    pub fn number_in(
        &mut self,
        base: &str,
        range: &Range,
        units: &[Unit],
    ) -> Result<Option<f64>, TomlError> {
        let mut found: Option<(String, f64)> = None;
        for unit in units {
            let key = key_with_unit(base, unit);
            let Some((_, value)) = self.take(&key) else {
                continue;
            };
            let si = self.in_range(base, value, unit, range)?;
            if let Some((other, _)) = found {
                return Err(self.conflict(&other));
            }
            found = Some((key, si));
        }
        Ok(found.map(|(_, si)| si))
    }

    /// Reads a number whose key has its unit in it, and no other; `None` if there is no such key.
    ///
    /// # Errors
    /// [`TomlError::Value`] if the value is not a number or outside the range.
    pub fn plain(&mut self, key: &str, range: &Range) -> Result<Option<f64>, TomlError> {
        let Some((_, value)) = self.take(key) else {
            return Ok(None);
        };
        match parse_number(value.get_ref()).filter(|number| range.contains(*number)) {
            Some(number) => Ok(Some(number)),
            None => Err(self.bad_value(key, value, range.expected_si())),
        }
    }

    /// Reads a number as [`TomlTable::number`] does, where the number is required.
    ///
    /// # Errors
    /// The same as for [`TomlTable::number`], and [`TomlError::MissingKey`] if the number is
    /// missing.
    pub fn require(&mut self, base: &str, range: &Range) -> Result<f64, TomlError> {
        let key = key_with_unit(base, &range.quantity.si_unit());
        self.number(base, range)?.ok_or_else(|| self.missing(&key))
    }

    /// Checks that every key of the table has been read.
    ///
    /// # Errors
    /// [`TomlError::UnknownKey`] with the first key that has not been read.
    pub fn finish(self) -> Result<(), TomlError> {
        for key in self.table.keys() {
            let name: &str = key.get_ref();
            if !self.used.contains(name) {
                let (line, column) = self.file.line_column(key.span().start);
                return Err(TomlError::UnknownKey {
                    path: self.file.path.to_owned(),
                    line,
                    column,
                    key: self.full(name),
                });
            }
        }
        Ok(())
    }

    /// The key that was read last among those that the table has.
    pub fn last_key(&self) -> String {
        self.last_key.clone()
    }

    /// Builds the error for a required key that is missing, at the place of the table. One in a unit that is not known
    /// is named with it.
    pub fn missing(&self, key: &str) -> TomlError {
        let (line, column) = self.file.line_column(self.at);
        let instead = self.in_other_unit(key).map(|other| format!("{key}, instead of {other},"));
        let key = self.full(instead.as_deref().unwrap_or(key));
        TomlError::MissingKey { path: self.file.path.to_owned(), line, column, key }
    }

    /// A key that nobody has read and that is a required one but for its unit, which is none that is known.
    ///
    /// - `key`: in SI units; what stands behind it in words does not count.
    fn in_other_unit(&self, key: &str) -> Option<&str> {
        let key = key.split(' ').next()?;
        let in_si = |quantity: &Quantity| {
            let suffix = key_with_unit("", &quantity.si_unit());
            let base = key.strip_suffix(&suffix).filter(|_| !suffix.is_empty())?;
            Some((suffix.len(), base, *quantity))
        };
        let (_, base, quantity) = Quantity::ALL.iter().filter_map(in_si).max_by_key(|of| of.0)?;
        let has_unit = |name: &str| {
            quantity.units().iter().any(|unit| name.ends_with(&key_with_unit("", unit)))
        };
        for key in self.table.keys() {
            let name: &str = key.get_ref();
            let is_same = name.strip_prefix(base).is_some_and(|rest| rest.starts_with('_'));
            if is_same && !has_unit(name) && !self.used.contains(name) {
                return Some(name);
            }
        }
        None
    }

    /// Builds the error for the last key that was read, which gives the same quantity as the key
    /// `other`.
    pub fn conflict(&self, other: &str) -> TomlError {
        let here = self.table.keys().find(|key| *key.get_ref() == self.last_key);
        let at = here.map_or(self.at, |key| key.span().start);
        let (line, column) = self.file.line_column(at);
        TomlError::Conflict {
            path: self.file.path.to_owned(),
            line,
            column,
            key: self.full(&self.last_key),
            other: other.into(),
        }
    }

    /// Builds the error for the value that was read last, which is not permitted.
    ///
    /// - `expected`: the permitted values, in words.
    pub fn refuse_last(&self, expected: &str) -> TomlError {
        let entry = self.table.iter().find(|(key, _)| *key.get_ref() == self.last_key);
        match entry {
            Some((_, value)) => self.bad_value(&self.last_key, value, expected.to_owned()),
            None => self.missing(&self.last_key),
        }
    }

    fn take(&mut self, key: &str) -> Option<(usize, &'a Spanned<DeValue<'a>>)> {
        let table = self.table;
        let (found, value) = table.iter().find(|(k, _)| *k.get_ref() == key)?;
        self.used.insert(key.to_owned());
        key.clone_into(&mut self.last_key);
        Some((found.span().start, value))
    }

    /// - `base`: the key without its unit.
    fn in_range(
        &self,
        base: &str,
        value: &Spanned<DeValue<'_>>,
        unit: &Unit,
        range: &Range,
    ) -> Result<f64, TomlError> {
        let number = parse_number(value.get_ref());
        let si = number.and_then(|number| range.rounded_into(unit.to_si(number)));
        si.ok_or_else(|| {
            let others = number.map(|number| other_keys(base, number, unit, range));
            let asked = others.filter(|keys| !keys.is_empty()).map(|keys| keys.join(" or "));
            let asked = asked.map_or_else(String::new, |keys| format!("; is it {keys}?"));
            let expected = format!("{}{asked}", range.expected(unit));
            self.bad_value(&key_with_unit(base, unit), value, expected)
        })
    }

    fn bad_value(&self, key: &str, value: &Spanned<DeValue<'_>>, expected: String) -> TomlError {
        let span = value.span();
        let (line, column) = self.file.line_column(span.start);
        let text = self.file.text.get(span).unwrap_or_default();
        TomlError::Value {
            path: self.file.path.to_owned(),
            line,
            column,
            key: self.full(key),
            value: text.lines().next().unwrap_or_default().into(),
            expected: expected.into(),
        }
    }

    fn full(&self, key: &str) -> Box<str> {
        if self.name.is_empty() { key.into() } else { format!("{}.{key}", self.name).into() }
    }
}

/// Number of keys that a message offers.
const OFFERED: usize = 3;

/// The keys with which a number would lie in its range, which it does not in its unit.
fn other_keys(base: &str, number: f64, unit: &Unit, range: &Range) -> Vec<String> {
    let fits =
        |other: &&Unit| *other != unit && other.is_guessed() && range.contains(other.to_si(number));
    let units = range.quantity.units().iter().filter(fits).take(OFFERED);
    // What counts something, or is in a unit of no quantity, has no other.
    let has_units = range.unit() == range.quantity.si_unit().symbol && !range.is_whole;
    units.filter(|_| has_units).map(|other| key_with_unit(base, other)).collect()
}

/// The name of a key: `speed` in km/h is `speed_km_h`, `yaw_inertia` in kg m² is
/// `yaw_inertia_kg_m2`, `torque` in N m is `torque_n_m`, a ratio `e` is `e`, or `e_percent` in per cent.
pub fn key_with_unit(base: &str, unit: &Unit) -> String {
    match unit.symbol {
        "" => base.to_owned(),
        "%" => format!("{base}_percent"),
        symbol => {
            let suffix = symbol.replace(['/', ' '], "_").replace('²', "2").replace('µ', "u");
            format!("{base}_{}", suffix.to_lowercase())
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
