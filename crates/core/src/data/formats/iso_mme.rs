//! Tests in the exchange format ISO-MME (ISO/TS 13499): `NAME.mme` with the test, `Channel/NAME.chn` with the
//! names of its channels, and `NAME.001` … with one channel each. Any of them opens the channels; a channel
//! opens itself alone.
//!
//! ```text
//! Channel code                :11HEADCG0000ACXP          keys in 28 columns, a colon, the value
//! Reference channel           :implicit                  or explicit, with the next line
//! Reference channel name      :11TIRS000000TIRP
//! Unit                        :g
//! Time of first sample        :-0.0005                   of an implicit time, s
//! Sampling interval           :0.0001
//! Number of samples           :20
//! Data status                 :ok
//! 0.000000E+00                                           then a value in a line, or NOVALUE
//! ```
//!
//! Keys are the same in capitals, and so are the names of files. A code has the object, the position, ten
//! characters of the place, the dimension (`AC`, `FO`, `VE` …), the axis and the filter class; places and axes
//! differ from laboratory to laboratory, so that columns are named by their codes and mapped. Values are read as
//! recorded; a channel of another time than the first one is a part of its own.
//!
//! The file is long because a test is read whole: its channels, their times and what is in doubt of each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::data::formats::nhtsa_curves::OTHER_AXES;
use crate::data::formats::{Converted, Said, number_text};
use crate::data::spelling::unit;
use crate::data::text::read_text;
use crate::data::{DataError, ReadSettings, Sheet, SheetRef, list_folder};
use crate::units::Quantity;

/// Bytes of one file, and of all channels of a test together.
const MAX_FILE_BYTES: u64 = 32 << 20;
const MAX_TEST_BYTES: u64 = 128 << 20;
/// Channels of a test; a code has three digits for them.
const MAX_CHANNELS: usize = 999;
/// Different times of the channels of a test.
const MAX_TIMES: usize = 64;
/// Lines of keys above the values of a channel.
const MAX_KEYS: usize = 400;
/// Remarks on channels that are shown.
const MAX_REMARKS: usize = 6;
/// Difference of two instants that are the same, s.
const SAME_S: f64 = 1e-9;

/// Keys of which such a file has at least one, in small letters.
const KEYS: [&str; 8] = [
    "data format edition number",
    "laboratory name",
    "test object number",
    "instrumentation standard",
    "number of channels",
    "name of the channel",
    "channel code",
    "name of channel 001",
];
/// Keys of which it has another, if not of those.
const OTHER_KEYS: [&str; 4] =
    ["data format", "reference channel", "channel frequency class", "sampling interval"];

/// A channel.
struct MmeChannel {
    path: PathBuf,
    /// Its keys in small letters, with their values.
    keys: BTreeMap<String, String>,
    /// Its values; `None` for one that is not there.
    values: Vec<Option<f64>>,
}

/// Channels over one time.
struct Group {
    name: String,
    time_s: Vec<f64>,
    /// Indices of the channels.
    channels: Vec<usize>,
}

/// The key in small letters and the value of a line.
fn pair(line: &str) -> Option<(String, &str)> {
    let (key, value) = line.split_once(':')?;
    let key = key.trim().to_lowercase();
    let starts = key.chars().next().is_some_and(char::is_alphabetic);
    starts.then(|| (key, value.trim()))
}

/// Whether a text is a file of a test.
pub(super) fn is_mme(text: &str) -> bool {
    let lines = text.lines().filter(|line| !line.trim().is_empty()).take(60);
    let (mut n_keys, mut n_others) = (0, 0);
    for (key, _) in lines.filter_map(pair) {
        n_keys += usize::from(KEYS.contains(&key.as_str()));
        n_others += usize::from(OTHER_KEYS.contains(&key.as_str()));
    }
    n_keys > 0 && n_keys + n_others >= 2
}

/// Channels of a test as the text of a table.
///
/// # Errors
/// [`DataError::NoSheet`] without such a part, [`DataError`] if a channel cannot be read.
pub(super) fn as_table(
    path: &Path,
    text: &str,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    if !is_mme(text) {
        return Ok(None);
    }
    let (channels, mut doubts) = match is_of_test(path, text) {
        true => read_test(path)?,
        false => (vec![MmeChannel::parse(path.to_owned(), text)?], Vec::new()),
    };
    let (groups, left_out) = grouped(&channels);
    doubts.extend(left_out);
    let all: Vec<String> = groups.iter().map(|group| group.name.clone()).collect();
    let chosen = match &settings.sheet {
        None => Some(0),
        Some(SheetRef::Number(number)) => number.checked_sub(1),
        Some(SheetRef::Name(name)) => all.iter().position(|part| part == name),
    };
    if groups.is_empty() {
        let format = "a test in ISO-MME without channels over time";
        let remedy = "put its channels (.001 and so on) into the folder Channel beside it, and look at their times";
        return Err(DataError::OtherFormat { path: path.to_owned(), format, remedy });
    }
    let Some(group) = chosen.and_then(|idx| groups.get(idx)) else {
        let wanted = settings.sheet.as_ref().map_or_else(String::new, SheetRef::to_string);
        return Err(DataError::NoSheet { path: path.to_owned(), wanted, found: all });
    };
    let (text, incomplete) = group.text(&channels);
    if !incomplete.is_empty() {
        doubts.push(format!(
            "channels with samples that are not there are left out: {}",
            some(&incomplete)
        ));
    }
    let of_group = || group.channels.iter().filter_map(|idx| channels.get(*idx));
    doubts.extend(of_group().filter_map(MmeChannel::remark).take(MAX_REMARKS));
    if of_group().any(MmeChannel::has_other_axis) {
        doubts.push(OTHER_AXES.to_owned());
    }
    let said = Said {
        description: format!(
            "a test in ISO-MME (ISO/TS 13499) with {} channels; read is {}, as recorded, without a filter",
            channels.len(),
            group.name
        ),
        doubts,
        part: Some(Sheet { name: group.name.clone(), all }),
        device: "ISO-MME".to_owned(),
        keeps_lines: false,
        ..Said::default()
    };
    Ok(Some(Converted { text, said }))
}

/// Whether a text is that of a channel: it has a code.
fn has_code(text: &str) -> bool {
    text.lines().take(MAX_KEYS).filter_map(pair).any(|(key, _)| key == "channel code")
}

/// Whether a file stands for a whole test, and not for one channel.
fn is_of_test(path: &Path, text: &str) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    matches!(ending.as_deref(), Some("mme" | "chn")) || !has_code(text)
}

/// The channels that are read with a file of a test; none for any other file.
///
/// - `text`: its beginning.
pub(super) fn channels_beside(path: &Path, text: &str) -> Vec<PathBuf> {
    match is_mme(text) && is_of_test(path, text) {
        true => files_of_test(path).unwrap_or_default().into_values().collect(),
        false => Vec::new(),
    }
}

/// The files of the channels of a test, in the folder of a file or in its folder `Channel`, by their numbers.
fn files_of_test(path: &Path) -> Result<BTreeMap<u32, PathBuf>, DataError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let entries = list_folder(folder)?;
    let is_channels = |path: &&PathBuf| {
        let name = path.file_name().unwrap_or_default();
        name.eq_ignore_ascii_case("channel") && path.is_dir()
    };
    let mut found = channel_files(&entries, &stem);
    if let Some(inner) = entries.iter().find(is_channels) {
        found.extend(channel_files(&list_folder(inner)?, &stem));
    }
    Ok(found)
}

/// The channels of a test, and what is in doubt.
fn read_test(path: &Path) -> Result<(Vec<MmeChannel>, Vec<String>), DataError> {
    let (mut channels, mut doubts, mut bytes) = (Vec::new(), Vec::new(), 0);
    for path in files_of_test(path)?.into_values() {
        let text = read_text(&path, MAX_FILE_BYTES)?.text;
        bytes += text.len() as u64;
        if bytes > MAX_TEST_BYTES {
            let limit = MAX_TEST_BYTES;
            return Err(DataError::TooLarge { path, bytes, limit });
        }
        match is_mme(&text) {
            true => channels.push(MmeChannel::parse(path, &text)?),
            false => doubts.push(format!(
                "{} is no channel and left out",
                path.file_name().unwrap_or_default().to_string_lossy()
            )),
        }
    }
    Ok((channels, doubts))
}

/// Files whose endings are three digits, by their numbers.
fn channel_files(entries: &[PathBuf], stem: &str) -> BTreeMap<u32, PathBuf> {
    let numbered = |path: &PathBuf| {
        let of = path.file_stem()?.to_string_lossy().to_lowercase();
        let ending = path.extension()?.to_string_lossy().into_owned();
        let is_number = ending.len() == 3 && ending.bytes().all(|byte| byte.is_ascii_digit());
        (is_number && of == stem).then(|| Some((ending.parse().ok()?, path.clone()))).flatten()
    };
    entries.iter().filter_map(numbered).take(MAX_CHANNELS).collect()
}

impl MmeChannel {
    /// # Errors
    /// [`DataError::Cell`] at the first line that is neither a key nor a value.
    fn parse(path: PathBuf, text: &str) -> Result<Self, DataError> {
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

    fn value(&self, key: &str) -> Option<&str> {
        let value = self.keys.get(key).map(String::as_str)?;
        (!value.is_empty() && !value.eq_ignore_ascii_case("novalue")).then_some(value)
    }

    fn number(&self, key: &str) -> Option<f64> {
        let number: f64 = self.value(key)?.replace(',', ".").parse().ok()?;
        number.is_finite().then_some(number)
    }

    fn code(&self) -> String {
        let ending = self.path.extension().unwrap_or_default().to_string_lossy();
        plain(self.value("channel code").unwrap_or(&ending))
    }

    /// What is in doubt of its samples and their times, in words.
    fn remark(&self) -> Option<String> {
        let (code, n) = (self.code(), self.values.len());
        match self.number("number of samples") {
            Some(stated) if stated != n as f64 => {
                Some(format!("{code} has {n} samples and says {stated}; is it cut?"))
            }
            _ if self.is_explicit() || self.number("time of first sample").is_some() => None,
            _ => Some(format!(
                "{code} does not say the time of its first sample; it is taken as 0 s"
            )),
        }
    }

    /// Whether its times are those of another channel.
    fn is_explicit(&self) -> bool {
        let of = self.value("reference channel");
        of.is_some_and(|of| of.eq_ignore_ascii_case("explicit"))
    }

    /// Whether it is measured along or about an axis that points elsewhere than here: the fifteenth sign of a code.
    fn has_other_axis(&self) -> bool {
        self.code()
            .chars()
            .nth(14)
            .is_some_and(|axis| matches!(axis.to_ascii_uppercase(), 'Y' | 'Z'))
    }

    /// Its instants by its own keys, s.
    fn implicit_s(&self) -> Option<Vec<f64>> {
        let interval_s = self.number("sampling interval").filter(|interval| *interval > 0.0)?;
        let first_s = self.number("time of first sample").unwrap_or(0.0);
        Some((0..self.values.len()).map(|i| first_s + i as f64 * interval_s).collect())
    }

    /// What keeps it from being read.
    fn status(&self) -> Option<String> {
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

/// The channels by their times, the largest group first, and what is said of those that are left out.
fn grouped(channels: &[MmeChannel]) -> (Vec<Group>, Vec<String>) {
    let (mut groups, mut doubts): (Vec<Group>, Vec<String>) = (Vec::new(), Vec::new());
    let is_time = |channel: &MmeChannel| channel.code().to_uppercase().contains("TIRS");
    for (idx, channel) in channels.iter().enumerate().filter(|(_, channel)| !is_time(channel)) {
        doubts.extend(channel.status());
        let time_s = match channel.is_explicit() {
            true => explicit_s(channels, channel),
            false => channel.implicit_s(),
        };
        let rises = |time_s: &Vec<f64>| time_s.windows(2).all(|pair| pair.first() < pair.last());
        let Some(time_s) = time_s.filter(|time_s| !time_s.is_empty()).filter(rises) else {
            doubts.push(format!("{} has no time and is left out", channel.code()));
            continue;
        };
        let is_same = |group: &Group| {
            group.time_s.len() == time_s.len()
                && group.time_s.iter().zip(&time_s).all(|(a, b)| (a - b).abs() < SAME_S)
        };
        let same = groups.iter().position(is_same);
        if let Some(group) = same.and_then(|at| groups.get_mut(at)) {
            group.channels.push(idx);
        } else if groups.len() < MAX_TIMES {
            let name = format!("channels over time {}", groups.len() + 1);
            groups.push(Group { name, time_s, channels: vec![idx] });
        } else {
            doubts.push(format!("{} is left out: too many times", channel.code()));
        }
    }
    let shown = doubts.len().min(MAX_REMARKS);
    let more = doubts.len() - shown;
    doubts.truncate(shown);
    if more > 0 {
        doubts.push(format!("{more} channels more with such remarks"));
    }
    (groups, doubts)
}

/// The instants of the channel that another one names, or of the only one of times.
fn explicit_s(channels: &[MmeChannel], of: &MmeChannel) -> Option<Vec<f64>> {
    let named = of.value("reference channel name");
    let is_it = |channel: &&MmeChannel| match named {
        Some(name) => channel.code().eq_ignore_ascii_case(name),
        None => channel.code().to_uppercase().contains("TIRS"),
    };
    let mut times = channels.iter().filter(is_it);
    let time = times.next()?;
    if times.next().is_some() {
        return None;
    }
    // Seconds are what a time has that does not say its unit.
    let factor = match time.value("unit") {
        None => 1.0,
        Some(symbol) => unit(Quantity::Time, symbol)?.si_per_unit,
    };
    let instants: Option<Vec<f64>> =
        time.values.iter().map(|value| value.map(|value| factor * value)).collect();
    instants.filter(|instants| instants.len() == of.values.len())
}

impl Group {
    /// The text of a table, and the codes of channels with samples that are not there.
    fn text(&self, channels: &[MmeChannel]) -> (String, Vec<String>) {
        let of: Vec<&MmeChannel> =
            self.channels.iter().filter_map(|idx| channels.get(*idx)).collect();
        let (full, partial): (Vec<&MmeChannel>, Vec<&MmeChannel>) =
            of.into_iter().partition(|channel| channel.values.iter().all(Option::is_some));
        let mut text = "time [s]".to_owned();
        for channel in &full {
            let unit = plain(channel.value("unit").unwrap_or("-"));
            let name: String = channel
                .value("name of the channel")
                .map_or_else(String::new, |name| plain(name).chars().take(40).collect());
            text.push_str(&format!("\t{} {name} [{unit}]", channel.code()));
        }
        text.push('\n');
        for (row, time_s) in self.time_s.iter().enumerate() {
            text.push_str(&number_text(*time_s));
            for channel in &full {
                let value = channel.values.get(row).copied().flatten();
                text.push('\t');
                text.push_str(&value.map_or_else(String::new, number_text));
            }
            text.push('\n');
        }
        (text, partial.iter().map(|channel| channel.code()).collect())
    }
}

fn some(names: &[String]) -> String {
    let shown: Vec<&str> = names.iter().take(6).map(String::as_str).collect();
    match names.len().saturating_sub(shown.len()) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// A text without what would end a cell or a line, cut to a length that a header may have.
fn plain(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() || c == '"' { ' ' } else { c });
    plain.take(60).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Channel, Table, read_any_series};

    fn channel(pairs: &[(&str, &str)], values: &[&str]) -> String {
        let head: String =
            pairs.iter().map(|(key, value)| format!("{key:<28}:{value}\n")).collect();
        head + &values.join("\n") + "\n"
    }

    /// A test with a time of its own, a force over it and an acceleration with an implicit time.
    fn write(folder: &Path, newline: &str) -> PathBuf {
        let inner = folder.join("CHANNEL");
        std::fs::create_dir(&inner).unwrap();
        let put = |path: PathBuf, text: String| {
            let bytes: Vec<u8> = text.replace('\n', newline).chars().map(|c| c as u8).collect();
            std::fs::write(path, bytes).unwrap();
        };
        let mme = channel(&[("Laboratory name", "Pr\u{fc}fer"), ("Data format", "ISO-MME")], &[]);
        put(folder.join("t.mme"), mme);
        let time =
            [("Channel code", "11TIRS000000TIRP"), ("Name of the channel", "time"), ("Unit", "ms")];
        put(inner.join("T.001"), channel(&time, &["0", "1", "2"]));
        let force = [
            ("CHANNEL CODE", "11BARR000000FOXP"),
            ("Name of the channel", "Kraft"),
            ("Reference channel", "explicit"),
            ("Reference channel name", "11TIRS000000TIRP"),
            ("Unit", "kN"),
            ("Data status", "ok"),
        ];
        put(inner.join("t.002"), channel(&force, &["-1", "-2", "-1"]));
        let other = [
            ("Channel code", "11SEAT000000ACXP"),
            ("Reference channel", "implicit"),
            ("Time of first sample", "-0.001"),
            ("Sampling interval", "0.0005"),
            ("Unit", "g"),
        ];
        put(inner.join("t.003"), channel(&other, &["0", "NOVALUE", "3", "4"]));
        folder.join("t.mme")
    }

    #[test]
    fn explicit_and_implicit_times_are_parts() {
        for newline in ["\n", "\r\n"] {
            let folder = tempfile::tempdir().unwrap();
            let path = write(folder.path(), newline);
            let table = Table::read(&path).unwrap();
            assert_eq!(table.header(), ["time [s]", "11BARR000000FOXP Kraft [kN]"]);
            assert_eq!(table.sheet().unwrap().all.len(), 2);
            let map = "fx_body=2:kN,fy_body=none".parse().unwrap();
            let loaded = read_any_series(&path, Some(&map)).unwrap();
            assert_eq!(loaded.series.time_s(), [0.0, 0.001, 0.002]);
            assert_eq!(loaded.series.require(Channel::FxBody).unwrap(), [-1e3, -2e3, -1e3]);
            let beside = crate::data::parts_beside(&path);
            assert_eq!(beside.len(), 4, "{beside:?}");
            assert!(beside[0] == path && beside[1].ends_with("CHANNEL/T.001"), "{beside:?}");
            // The other part has no channel with all of its samples.
            let alone = folder.path().join("CHANNEL/t.002");
            assert!(Table::read(&alone).is_err());
        }
    }

    #[test]
    fn a_cut_channel_and_another_axis_are_said() {
        let keys = [
            ("Channel code", "11SEAT000000ACYP"),
            ("Time of first sample", "-0.1"),
            ("Sampling interval", "0.1"),
            ("Number of samples", "3"),
        ];
        let doubts = |values: &[&str]| {
            let text = channel(&keys, values);
            let settings = ReadSettings::default();
            as_table(Path::new("a.001"), &text, &settings).unwrap().unwrap().said.doubts
        };
        assert!(doubts(&["1", "2"])[0].contains("has 2 samples and says 3"));
        let whole = doubts(&["1", "2", "3"]);
        assert!(whole.len() == 1 && whole[0].contains("to the right and down"), "{whole:?}");
    }

    /// A time in a unit that is none is no time in seconds, and one of two times is not guessed.
    #[test]
    fn a_time_that_is_not_known_is_none() {
        let of = |code: &str, more: &[(&str, &str)]| {
            let keys = [&[("Channel code", code)][..], more].concat();
            MmeChannel::parse("a.001".into(), &channel(&keys, &["0", "1"])).unwrap()
        };
        let force = of("11BARR000000FOXP", &[("Reference channel", "explicit")]);
        let [us, other] =
            ["us", "fortnights"].map(|unit| of("11TIRS000000TIRP", &[("Unit", unit)]));
        let again = of("12TIRS000000TIRP", &[]);
        let all = [force, us];
        assert_eq!(explicit_s(&all, &all[0]), Some(vec![0.0, 1e-6]));
        let [force, us] = all;
        let all = [force, other];
        assert_eq!(explicit_s(&all, &all[0]), None);
        let [force, _] = all;
        let all = [force, us, again];
        assert_eq!(explicit_s(&all, &all[0]), None);
    }

    #[test]
    fn a_line_that_is_no_value_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.001");
        let keys = [("Channel code", "X"), ("Sampling interval", "0.1"), ("Unit", "N")];
        std::fs::write(&path, channel(&keys, &["1", "2 3"])).unwrap();
        let error = Table::read(&path).unwrap_err().to_string();
        assert!(error.contains("a.001:5:1: "), "{error}");
        std::fs::write(&path, channel(&keys, &["1", "2"])).unwrap();
        assert_eq!(Table::read(&path).unwrap().n_rows(), 2);
    }
}
