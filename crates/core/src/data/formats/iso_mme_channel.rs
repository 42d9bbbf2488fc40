//! A channel of a test in ISO-MME: its keys, its samples and what is in doubt of them. Its lines are described in
//! [`iso_mme`](super::iso_mme).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::data::DataError;
use crate::units::significant;

/// Lines of keys above the values of a channel.
const MAX_KEYS: usize = 400;

/// By how much a stated extreme may be off for its rounding, as a share of the range of the values.
const ROUNDING: f64 = 0.01;

/// Words of a data status by which the samples of a channel are no measurement, in small letters.
const FAILED: [&str; 5] = ["failed", "meaningless", "no data", "invalid", "not valid"];

/// A channel.
pub(super) struct MmeChannel {
    path: PathBuf,
    /// Its keys in small letters, with their values.
    keys: BTreeMap<String, String>,
    /// Its values; `None` for one that is not there.
    pub values: Vec<Option<f64>>,
}

/// The key in small letters and the value of a line.
pub(super) fn pair(line: &str) -> Option<(String, &str)> {
    let (key, value) = line.split_once(':')?;
    let key = key.trim().to_lowercase();
    let starts = key.chars().next().is_some_and(char::is_alphabetic);
    starts.then(|| (key, value.trim()))
}

/// Whether a text is that of a channel: it has a code.
pub(super) fn has_code(text: &str) -> bool {
    text.lines().take(MAX_KEYS).filter_map(pair).any(|(key, _)| key == "channel code")
}

impl MmeChannel {
    /// # Errors
    /// [`DataError::Cell`] at the first line that is neither a key nor a value.
    pub(super) fn parse(path: PathBuf, text: &str) -> Result<Self, DataError> {
        let (mut keys, mut values) = (BTreeMap::new(), Vec::new());
        for (line, content) in (1..).zip(text.lines()) {
            let content = content.trim();
            let is_head = values.is_empty() && keys.len() < MAX_KEYS;
            match pair(content) {
                _ if content.is_empty() => {}
                Some((key, value)) if is_head => {
                    keys.entry(key).or_insert_with(|| value.to_owned());
                }
                _ => values.push(sample(&path, line, content)?),
            }
        }
        Ok(Self { path, keys, values })
    }

    pub(super) fn value(&self, key: &str) -> Option<&str> {
        let value = self.keys.get(key).map(String::as_str)?;
        (!value.is_empty() && !value.eq_ignore_ascii_case("novalue")).then_some(value)
    }

    fn number(&self, key: &str) -> Option<f64> {
        let number: f64 = self.value(key)?.replace(',', ".").parse().ok()?;
        number.is_finite().then_some(number)
    }

    pub(super) fn code(&self) -> String {
        let ending = self.path.extension().unwrap_or_default().to_string_lossy();
        plain(self.value("channel code").unwrap_or(&ending))
    }

    /// What is in doubt of its samples and their times, in words.
    pub(super) fn remark(&self) -> Option<String> {
        let (code, n) = (self.code(), self.values.len());
        let cut = self.number("number of samples").filter(|stated| *stated != n as f64);
        let cut = cut.map(|stated| format!("{code} has {n} samples and says {stated}; is it cut?"));
        let has_start = self.is_explicit() || self.number("time of first sample").is_some();
        cut.or_else(|| self.other_extreme()).or_else(|| {
            (!has_start).then(|| {
                format!("{code} does not say the time of its first sample; it is taken as 0 s")
            })
        })
    }

    /// That its largest or smallest value is another than it says.
    fn other_extreme(&self) -> Option<String> {
        let values = || self.values.iter().copied().flatten();
        let (largest, smallest) = (values().reduce(f64::max)?, values().reduce(f64::min)?);
        let extremes = [("maximum", largest), ("minimum", smallest)];
        let other = |(word, found): (&str, f64)| {
            let stated = self.number(&format!("first global {word} value"))?;
            let is_other =
                (stated - found).abs() > ROUNDING * (largest - smallest).max(stated.abs());
            is_other.then(|| {
                format!(
                    "{} has the {word} {} and says {}; is it cut, filtered or in another unit?",
                    self.code(),
                    significant(found),
                    significant(stated)
                )
            })
        };
        extremes.into_iter().find_map(other)
    }

    /// Whether its times are those of another channel.
    pub(super) fn is_explicit(&self) -> bool {
        let of = self.value("reference channel");
        of.is_some_and(|of| of.eq_ignore_ascii_case("explicit"))
    }

    /// Whether it is measured along or about an axis that points elsewhere than here: the fifteenth sign of a code.
    pub(super) fn has_other_axis(&self) -> bool {
        self.code()
            .chars()
            .nth(14)
            .is_some_and(|axis| matches!(axis.to_ascii_uppercase(), 'Y' | 'Z'))
    }

    /// Its instants by its own keys, s.
    pub(super) fn implicit_s(&self) -> Option<Vec<f64>> {
        let interval_s = self.number("sampling interval").filter(|interval| *interval > 0.0)?;
        let first_s = self.number("time of first sample").unwrap_or(0.0);
        Some((0..self.values.len()).map(|i| first_s + i as f64 * interval_s).collect())
    }

    /// Its status, if that says that its samples are no measurement.
    pub(super) fn failure(&self) -> Option<String> {
        let status = self.value("data status")?;
        let lower = status.to_lowercase();
        FAILED.iter().any(|word| lower.contains(word)).then(|| plain(status))
    }

    /// What its status says of samples that are read and not simply good.
    pub(super) fn status(&self) -> Option<String> {
        let status = self.value("data status")?;
        let is_good = matches!(status.to_lowercase().as_str(), "ok" | "good" | "valid");
        (!is_good).then(|| format!("{}: data status {}", self.code(), plain(status)))
    }
}

/// A value, or nothing where none was recorded.
fn sample(path: &Path, line: u64, text: &str) -> Result<Option<f64>, DataError> {
    if text.eq_ignore_ascii_case("novalue") {
        return Ok(None);
    }
    let number: Option<f64> = text.replace(',', ".").parse().ok();
    let number = number.filter(|number| number.is_finite());
    number.map(Some).ok_or_else(|| DataError::Cell {
        path: path.to_owned(),
        line,
        column: 1,
        name: "value".to_owned(),
        text: text.to_owned(),
        expected: "a number or NOVALUE".into(),
    })
}

/// A text without what would end a cell or a line, cut to a length that a header may have.
pub(super) fn plain(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() || c == '"' { ' ' } else { c });
    plain.take(60).collect()
}
