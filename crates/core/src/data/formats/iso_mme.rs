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
//! recorded; a channel whose status says that it failed is left out, and one of another time than the first one is
//! a part of its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::data::formats::iso_mme_channel::{MmeChannel, has_code, pair, plain};
use crate::data::formats::nhtsa_curves::OTHER_AXES;
use crate::data::formats::{Converted, Said, number_text};
use crate::data::spelling::unit;
use crate::data::text::read_text;
use crate::data::{DataError, Place, ReadSettings, Sheet, SheetRef, list_folder};
use crate::units::Quantity;

/// Bytes of one file, and of all channels of a test together.
const MAX_FILE_BYTES: u64 = 32 << 20;
const MAX_TEST_BYTES: u64 = 128 << 20;
/// Channels of a test; a code has three digits for them.
const MAX_CHANNELS: usize = 999;
/// Different times of the channels of a test.
const MAX_TIMES: usize = 64;
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

/// Channels over one time.
struct Group {
    name: String,
    time_s: Vec<f64>,
    /// Indices of the channels.
    channels: Vec<usize>,
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
    if groups.is_empty() && channels.iter().any(|channel| channel.failure().is_some()) {
        let why = format!(
            "is a test in ISO-MME of which no channel can be read: {}; open another channel, or correct the data status \
             in the file if the laboratory says that the samples are good",
            doubts.join("; ")
        );
        return Err(DataError::DamagedAt { path: path.to_owned(), place: Place::Whole, why });
    }
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

/// The channels by their times, the largest group first, and what is said of those that are left out.
fn grouped(channels: &[MmeChannel]) -> (Vec<Group>, Vec<String>) {
    let (mut groups, mut doubts): (Vec<Group>, Vec<String>) = (Vec::new(), Vec::new());
    let is_time = |channel: &MmeChannel| channel.code().to_uppercase().contains("TIRS");
    let failed = channels.iter().filter_map(|channel| {
        channel.failure().map(|status| format!("{} ({status})", channel.code()))
    });
    let failed: Vec<String> = failed.collect();
    if !failed.is_empty() {
        doubts.push(format!(
            "channels that failed, as their data status says, are left out: {}",
            some(&failed)
        ));
    }
    let is_read = |channel: &MmeChannel| !is_time(channel) && channel.failure().is_none();
    for (idx, channel) in channels.iter().enumerate().filter(|(_, channel)| is_read(channel)) {
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
    if times.next().is_some() || time.failure().is_some() {
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

#[cfg(test)]
#[path = "iso_mme_tests.rs"]
mod tests;
