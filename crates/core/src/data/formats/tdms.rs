//! TDMS files as tables: a part for each group and each time in it.
//!
//! The time of a channel is that of its group's stamps, counted from the first of them, or follows from its
//! properties `wf_start_offset` and `wf_increment` (in `wf_xunit_string`, seconds without it); where it has
//! neither, a channel of the group has to be the time. Units are those of `unit_string`. A linear scale of
//! NI is applied. Texts, complex numbers and channels with other scales are left out and named. The bytes are
//! read by [`tdms_file`](super::tdms_file), which describes their layout.

use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::bytes::{plain, some};
use crate::data::formats::tdms_file::{Cell, TdmsFile};
use crate::data::formats::tdms_objects::{Kind, Object, Stamp};
use crate::data::formats::{Converted, Said, chosen_part, number_text};
use crate::data::spelling::{Meaning, meaning};
use crate::data::{Channel, DataError, ReadSettings, Sheet, read_bytes};

/// Seconds from 1904 to 1970, and to 2100, up to which a date is shown.
const UNIX_S: i64 = 2_082_844_800;
const LATEST_S: i64 = UNIX_S + 4_102_444_800;

/// The time of a channel.
#[derive(Debug, Clone, PartialEq)]
enum Clock {
    /// By stamps of the group, or by one of its channels.
    OfGroup,
    /// First instant, step and unit, and when it began.
    Waveform { first: f64, step: f64, unit: String, start: Option<Stamp> },
}

/// Cells of a part; more would not fit into the text of a table.
const MAX_CELLS: u64 = 32 << 20;

/// Channels over one time.
struct Part {
    name: String,
    clock: Clock,
    n_values: u64,
    /// The channels by their indices, with their scales: intercept and slope.
    channels: Vec<(usize, [f64; 2])>,
    left_out: Vec<String>,
}

/// Reads a TDMS file as the text of a table.
///
/// # Errors
/// [`DataError::DamagedAt`] if it does not follow its format, [`DataError::NoSheet`] without such a group,
/// [`DataError::OtherFormat`] without any channel of numbers.
pub(super) fn as_table(path: &Path, settings: &ReadSettings) -> Result<Converted, DataError> {
    let bytes = read_bytes(path, MAX_TABLE_BYTES)?;
    let file = TdmsFile::parse(&bytes).map_err(|fault| fault.in_file(path))?;
    let parts = parts(&file.objects);
    if parts.is_empty() {
        let remedy = "it has no channel of numbers; export the channels over time as CSV";
        return Err(DataError::OtherFormat {
            path: path.to_owned(),
            format: "a TDMS file",
            remedy,
        });
    }
    let all: Vec<String> = parts.iter().map(|part| part.name.clone()).collect();
    let has_time = |part: &&Part| part.n_values > 1 && part.has_time(&file.objects);
    let first = parts.iter().find(has_time).or_else(|| parts.iter().find(|of| of.n_values > 1));
    let first = first.and_then(|first| all.iter().position(|name| *name == first.name));
    let first = first.unwrap_or(0);
    let at = chosen_part(path, &all, first, settings)?;
    let Some(part) = parts.get(at) else {
        return Err(DataError::Empty { path: path.to_owned() });
    };
    let wanted: Vec<usize> = part.channels.iter().map(|(object, _)| *object).collect();
    let too_large = || {
        let (bytes, limit) = (MAX_TABLE_BYTES + 1, MAX_TABLE_BYTES);
        DataError::TooLarge { path: path.to_owned(), bytes, limit }
    };
    if part.n_values.saturating_mul(wanted.len() as u64) > MAX_CELLS {
        return Err(too_large());
    }
    let values = file.values(&wanted).map_err(|fault| fault.in_file(path))?;
    let text = part.text(&file.objects, &values).ok_or_else(too_large)?;
    let mut doubts = part.doubts();
    if file.is_cut || file.n_bytes_cut > 0 {
        doubts.push(format!(
            "the file was not closed or is cut off: {} bytes that are no whole samples are left out",
            file.n_bytes_cut
        ));
    }
    let said = Said {
        description: part.description(&values),
        doubts,
        part: Some(Sheet { name: part.name.clone(), all }),
        ..Said::default()
    };
    Ok(Converted { text, said })
}

/// The groups of a file, each divided by the times of its channels.
fn parts(objects: &[Object]) -> Vec<Part> {
    let mut parts: Vec<(&str, Part)> = Vec::new();
    let channels = || {
        objects.iter().enumerate().filter_map(|(idx, object)| match object.path.as_slice() {
            [group, name] => Some((idx, group.as_str(), name, object)),
            _ => None,
        })
    };
    for (idx, group, _, object) in channels() {
        let Ok(scale) = object.scale() else { continue };
        let (clock, n_values) = (object.clock(), object.n_values);
        let own = parts
            .iter_mut()
            .find(|(of, part)| *of == group && part.clock == clock && part.n_values == n_values);
        if let Some((_, part)) = own {
            part.channels.push((idx, scale));
            continue;
        }
        let (name, left_out, channels) = (String::new(), Vec::new(), vec![(idx, scale)]);
        parts.push((group, Part { name, clock, n_values, channels, left_out }));
    }
    for (_, group, name, object) in channels() {
        let Err(Some(why)) = object.scale() else { continue };
        if let Some((_, part)) = parts.iter_mut().find(|(of, _)| *of == group) {
            part.left_out.push(format!("{} ({why})", plain(name)));
        }
    }
    let groups: Vec<&str> = parts.iter().map(|(group, _)| *group).collect();
    for (at, (group, part)) in parts.iter_mut().enumerate() {
        let group = *group;
        let same = |end: usize| groups.iter().take(end).filter(|of| **of == group).count();
        part.name = match same(groups.len()) {
            1 => plain(group),
            _ => format!("{} time {}", plain(group), same(at) + 1),
        };
    }
    parts.into_iter().map(|(_, part)| part).collect()
}

impl Object {
    fn clock(&self) -> Clock {
        let step = self.number("wf_increment").filter(|step| step.is_finite() && *step > 0.0);
        let Some(step) = step else { return Clock::OfGroup };
        Clock::Waveform {
            first: self.number("wf_start_offset").unwrap_or(0.0),
            step,
            unit: plain(
                self.text("wf_xunit_string").filter(|unit| !unit.is_empty()).unwrap_or("s"),
            ),
            start: self.stamp("wf_start_time"),
        }
    }

    /// Intercept and slope by which its numbers are scaled.
    ///
    /// # Errors
    /// Why its values are not read; nothing where it has none.
    fn scale(&self) -> Result<[f64; 2], Option<&'static str>> {
        match self.kind {
            _ if self.n_values == 0 && self.kind != Some(Kind::Text) => Err(None),
            Some(Kind::Number(..) | Kind::Stamp) => match self.number("NI_Number_Of_Scales") {
                None | Some(0.0) => Ok([0.0, 1.0]),
                Some(_) if self.text("NI_Scaling_Status") == Some("scaled") => Ok([0.0, 1.0]),
                Some(1.0) => self.linear_scale().ok_or(Some("its scale is not linear")),
                Some(_) => Err(Some("several scales")),
            },
            Some(Kind::Text) => Err(Some("texts")),
            Some(Kind::Other(_)) => Err(Some("complex numbers")),
            None => Err(Some("its type changes")),
        }
    }

    fn linear_scale(&self) -> Option<[f64; 2]> {
        let is_linear = self.text("NI_Scale[0]_Scale_Type") == Some("Linear");
        let source = self.number("NI_Scale[0]_Linear_Input_Source");
        let is_raw = source.is_none_or(|source| source == f64::from(u32::MAX));
        let scale = [
            self.number("NI_Scale[0]_Linear_Y_Intercept")?,
            self.number("NI_Scale[0]_Linear_Slope")?,
        ];
        (is_linear && is_raw).then_some(scale)
    }

    fn header(&self) -> String {
        let name = plain(self.path.last().map_or("", String::as_str));
        let name = if name.is_empty() { "channel".to_owned() } else { name };
        match self.text("unit_string").map(plain).filter(|unit| !unit.is_empty()) {
            Some(unit) => format!("{name} [{unit}]"),
            None => name,
        }
    }
}

impl Part {
    /// Whether a time of its own is known, by its channels or by the name of one.
    fn has_time(&self, objects: &[Object]) -> bool {
        let is_time = |(idx, _): &(usize, [f64; 2])| {
            objects.get(*idx).is_some_and(|object| {
                let is_named =
                    matches!(meaning(&object.header()), Meaning::Channel(Channel::Time, _));
                object.kind == Some(Kind::Stamp) || is_named
            })
        };
        self.clock != Clock::OfGroup || self.channels.iter().any(is_time)
    }

    /// The text of the table; `None` beyond the size of one.
    fn text(&self, objects: &[Object], values: &[Vec<Cell>]) -> Option<String> {
        let mut header: Vec<String> = Vec::new();
        if let Clock::Waveform { unit, .. } = &self.clock {
            header.push(format!("time [{unit}]"));
        }
        let mut has_time = !header.is_empty();
        let mut firsts: Vec<Option<Stamp>> = Vec::new();
        for ((object, _), values) in self.channels.iter().zip(values) {
            let first = values.first().and_then(Cell::stamp);
            let object = objects.get(*object)?;
            header.push(match first {
                Some(_) if !has_time => "time [s]".to_owned(),
                Some(_) => format!("stamp of {} [s]", object.header()),
                None => object.header(),
            });
            has_time |= first.is_some();
            firsts.push(first);
        }
        let mut text = header.join("\t") + "\n";
        let n_rows = values.iter().map(Vec::len).max().unwrap_or(0);
        for row in 0..n_rows {
            let mut cells: Vec<String> = Vec::with_capacity(header.len());
            if let Clock::Waveform { first, step, .. } = &self.clock {
                cells.push(number_text(first + row as f64 * step));
            }
            for ((values, (_, [intercept, slope])), first) in
                values.iter().zip(&self.channels).zip(&firsts)
            {
                cells.push(match (values.get(row), first) {
                    (Some(Cell::Number(number)), _) => number_text(intercept + slope * number),
                    (Some(Cell::Stamp(stamp)), Some(first)) => number_text(stamp.after_s(*first)),
                    _ => String::new(),
                });
            }
            text.push_str(&cells.join("\t"));
            text.push('\n');
            if text.len() as u64 > MAX_TABLE_BYTES {
                return None;
            }
        }
        Some(text)
    }

    fn description(&self, values: &[Vec<Cell>]) -> String {
        let mut text = format!(
            "a TDMS file; read is the group {} with {} channels of {} samples",
            self.name,
            self.channels.len(),
            self.n_values
        );
        let first = values.iter().find_map(|values| values.first().and_then(Cell::stamp));
        let start = match &self.clock {
            Clock::Waveform { start, .. } => *start,
            Clock::OfGroup => first,
        };
        if let Some(date) = start.and_then(date) {
            text += &format!("; time 0 is {date}");
        }
        let n_scaled = self.channels.iter().filter(|(_, scale)| *scale != [0.0, 1.0]).count();
        if n_scaled > 0 {
            text += &format!("; {n_scaled} channels by their linear scale");
        }
        text
    }

    fn doubts(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        if !self.left_out.is_empty() {
            doubts.push(format!("channels are left out: {}", some(&self.left_out)));
        }
        doubts
    }
}

impl Cell {
    fn stamp(&self) -> Option<Stamp> {
        match self {
            Self::Stamp(stamp) => Some(*stamp),
            Self::Number(_) => None,
        }
    }
}

/// A stamp as a date, if it is one of our time.
fn date(stamp: Stamp) -> Option<String> {
    let is_shown = (UNIX_S..LATEST_S).contains(&stamp.seconds);
    let seconds = u64::try_from(stamp.seconds.checked_sub(UNIX_S)?).ok().filter(|_| is_shown)?;
    let parts_s = stamp.parts as f64 / 2.0_f64.powi(64);
    let since = Duration::from_secs(seconds) + Duration::from_secs_f64(parts_s.clamp(0.0, 1.0));
    Some(humantime::format_rfc3339_millis(UNIX_EPOCH + since).to_string())
}
