//! Logs of satellite receivers: GPX (tracks) and NMEA 0183 (sentences `RMC`, else `GGA`; both are parts where
//! `GGA` comes more often).
//!
//! ```text
//! <trkpt lat="51.985" lon="-0.975"><ele>100</ele><time>2026-11-25T10:00:00.5Z</time></trkpt>
//! $GPRMC,100000.50,A,5159.1000,N,00058.5000,W,29.2,090.0,251126,,*1A
//! $GPGGA,100000.50,5159.1000,N,00058.5000,W,4,12,0.7,100.0,M,,M,,*55
//! ```
//!
//! Latitude and longitude become degrees, to the north and to the east positive, and metres in the plane at the
//! first point by the formulas `east` and `north` of a map. A place of NMEA is degrees and minutes of arc, a
//! speed knots, a course clockwise from north. A sentence whose checksum is wrong or that says that there was no
//! fix is left out and counted; what a logger writes in front of one, such as its own stamp, is not read. Positions
//! are those of the antenna.

use std::collections::BTreeSet;
use std::path::Path;

use crate::data::formats::{Converted, Said, chosen_part, number_text};
use crate::data::{DataError, Place, ReadSettings, Sheet};
use crate::units::KNOT_M_S;

/// Lines at the beginning by which a log is known.
const EXAMINED_LINES: usize = 40;

/// Bytes in front of a sentence, such as the stamp of a logger. With more than one separator among them the line is a
/// row of a table, whose other cells would be lost.
const MAX_PREFIX_BYTES: usize = 64;
const SEPARATORS: [char; 4] = [',', ';', '\t', '|'];

/// Tracks of a file.
const MAX_TRACKS: usize = 1000;

/// What is said of a yaw angle that is a course over ground.
pub(in crate::data) const OF_COURSE: &str = "the yaw angle is the course over ground: of a car that slides or spins it is not the \
     heading";

/// Columns of sentences `RMC`.
const RMC_HEADER: &str = "time [s]\tlatitude [deg]\tlongitude [deg]\tspeed [m/s]\tyaw [deg]";

/// How many times more positions than sentences `RMC` those of `GGA` give if they are a part of their own.
const DENSER: usize = 2;

/// A part of a log.
struct Track {
    name: String,
    /// Names of the columns.
    header: &'static str,
    rows: String,
    /// What is said of it, in words.
    doubts: Vec<String>,
}

/// A log as the text of a table.
///
/// # Errors
/// [`DataError::NoSheet`] without such a track, [`DataError::OtherFormat`] without any.
pub(super) fn as_table(
    path: &Path,
    text: &str,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    let (format, tracks) = match () {
        () if is_gpx(text) => ("a GPX file", Ok(gpx_tracks(text))),
        () if is_nmea(text) => ("a log of NMEA sentences", nmea_tracks(text)),
        () => return Ok(None),
    };
    let tracks = match tracks {
        Err(doubts) if !doubts.is_empty() => {
            let why = format!(
                "is {format} of which fewer than two are read: {}; take the log from the receiver once more, or give a \
                 CSV file with time, latitude and longitude",
                doubts.join("; ")
            );
            return Err(DataError::DamagedAt { path: path.to_owned(), place: Place::Whole, why });
        }
        tracks => tracks.unwrap_or_default(),
    };
    if tracks.is_empty() {
        let remedy = "it has no track with positions; record one, or give a CSV file with time, latitude and \
                      longitude";
        return Err(DataError::OtherFormat { path: path.to_owned(), format, remedy });
    }
    let all: Vec<String> = tracks.iter().map(|track| track.name.clone()).collect();
    let Some(track) = tracks.get(chosen_part(path, &all, 0, settings)?) else {
        return Err(DataError::Empty { path: path.to_owned() });
    };
    if track.rows.lines().all(|row| row.starts_with('\t')) {
        let remedy =
            "its points have no times, so that they are no motion; record a track with times";
        return Err(DataError::OtherFormat { path: path.to_owned(), format, remedy });
    }
    let mut doubts = track.doubts.clone();
    if track.header == RMC_HEADER {
        doubts.push(OF_COURSE.to_owned());
    }
    let said = Said {
        description: format!(
            "{format}: places from latitude and longitude; read is {}",
            track.name
        ),
        doubts,
        part: Some(Sheet { name: track.name.clone(), all }),
        device: String::new(),
        keeps_lines: false,
        ..Said::default()
    };
    Ok(Some(Converted { text: format!("{}\n{}", track.header, track.rows), said }))
}

fn is_gpx(text: &str) -> bool {
    let start: String = text.chars().take(4096).collect();
    text.trim_start().starts_with('<') && start.contains("<gpx")
}

/// The tracks of a GPX file, each segment by itself.
fn gpx_tracks(text: &str) -> Vec<Track> {
    let mut tracks = Vec::new();
    for segment in parts(text, "<trkseg", "</trkseg>").take(MAX_TRACKS) {
        let mut rows = String::new();
        for point in parts(segment, "<trkpt", "</trkpt>") {
            let head = point.split('>').next().unwrap_or_default();
            let cells = [
                within(point, "<time>", "</time>"),
                attribute(head, "lat"),
                attribute(head, "lon"),
                within(point, "<ele>", "</ele>"),
            ];
            let cells = cells.map(|cell| plain(cell.unwrap_or_default()));
            rows.push_str(&cells.join("\t"));
            rows.push('\n');
        }
        if !rows.is_empty() {
            let name = format!("track {}", tracks.len() + 1);
            let header = "time [s]\tlatitude [deg]\tlongitude [deg]\televation [m]";
            tracks.push(Track { name, header, rows, doubts: Vec::new() });
        }
    }
    tracks
}

/// The parts of a text from one mark to the next end of them, or of the next one.
fn parts<'a>(text: &'a str, start: &'a str, end: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(start).skip(1).map(move |part| part.split(end).next().unwrap_or_default())
}

fn within<'a>(text: &'a str, start: &str, end: &str) -> Option<&'a str> {
    text.split_once(start)?.1.split_once(end).map(|(inside, _)| inside)
}

/// The value of an attribute within the head of an element.
fn attribute<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = head;
    while let Some(at) = rest.find(name) {
        let (before, after) = rest.split_at(at);
        let after = after.get(name.len()..)?;
        let value = after.trim_start().strip_prefix('=').map(str::trim_start);
        let is_word = before.ends_with(char::is_whitespace);
        if let Some(value) = value.filter(|_| is_word) {
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            return value.get(1..)?.split(quote).next();
        }
        rest = after;
    }
    None
}

fn is_nmea(text: &str) -> bool {
    let lines = text.lines().filter(|line| !line.trim().is_empty()).take(EXAMINED_LINES);
    let n_sentences = lines.filter(|line| matches!(kind(line), Some("RMC" | "GGA"))).count();
    n_sentences >= 2
}

/// A sentence, from its sign on, without what a logger wrote in front of it.
fn sentence(line: &str) -> Option<&str> {
    let line = line.trim();
    let (prefix, sentence) = line.split_at_checked(line.find('$')?)?;
    let is_prefix = prefix.len() <= MAX_PREFIX_BYTES && prefix.matches(SEPARATORS).count() <= 1;
    is_prefix.then_some(sentence)
}

/// The kind of a sentence.
fn kind(line: &str) -> Option<&str> {
    let name = sentence(line)?.strip_prefix('$')?.split(',').next()?;
    name.get(2..5).filter(|_| name.len() == 5)
}

/// A row of a log with who sent it and when.
struct Fix {
    talker: String,
    /// Year, month and day as one number, `20261125`. Sentences `GGA` have none.
    date: Option<u32>,
    /// Of the day.
    time_s: f64,
    row: String,
}

/// The track of sentences `RMC`, which have speeds, else that of `GGA`; both if those of `GGA` are denser.
///
/// # Errors
/// What is left out, if fewer than two sentences are read.
fn nmea_tracks(text: &str) -> Result<Vec<Track>, Vec<String>> {
    if !text.lines().any(|line| kind(line) == Some("RMC")) {
        return nmea_track(text, "GGA").map(|gga| vec![gga]);
    }
    let mut rmc = match nmea_track(text, "RMC") {
        Ok(rmc) => rmc,
        Err(of_rmc) => return instead_of_rmc(text, of_rmc),
    };
    let n_fixes = |track: &Track| track.rows.lines().count();
    let n_rmc = n_fixes(&rmc);
    let is_denser = |gga: &Track| n_fixes(gga) >= DENSER * n_rmc;
    let Some(gga) = nmea_track(text, "GGA").ok().filter(is_denser) else { return Ok(vec![rmc]) };
    rmc.doubts.push(format!(
        "RMC, which is read, gives {n_rmc} positions, GGA {}: for a motion that is short against the steps of RMC, read \
         GGA (sheet=2), which has no speeds and no courses",
        n_fixes(&gga)
    ));
    Ok(vec![rmc, gga])
}

/// The track by the sentences GGA, where those RMC give none.
///
/// - `of_rmc`: what is left out of them.
///
/// # Errors
/// What is left out of both.
fn instead_of_rmc(text: &str, mut of_rmc: Vec<String>) -> Result<Vec<Track>, Vec<String>> {
    match nmea_track(text, "GGA") {
        Ok(mut gga) => {
            of_rmc.push(
                "RMC gives no track: GGA is read instead, which has no speeds and no courses"
                    .to_owned(),
            );
            gga.doubts.splice(0..0, of_rmc);
            Ok(vec![gga])
        }
        Err(of_gga) => {
            of_rmc.extend(of_gga);
            Err(of_rmc)
        }
    }
}

/// The track of one kind of sentences.
///
/// # Errors
/// What is left out, if fewer than two are read.
fn nmea_track(text: &str, wanted: &str) -> Result<Track, Vec<String>> {
    let lines = || text.lines().filter_map(sentence);
    let (mut fixes, mut n_wrong, mut n_without, mut n_estimated) = (Vec::new(), 0, 0, 0);
    for line in lines().filter(|line| kind(line) == Some(wanted)) {
        let Some(sentence) = checked(line) else {
            n_wrong += 1;
            continue;
        };
        let fields: Vec<&str> = sentence.split(',').collect();
        let row = match wanted {
            "RMC" => rmc(&fields),
            _ => gga(&fields),
        };
        let time_s = fields.get(1).and_then(|text| seconds(text));
        match row.zip(time_s) {
            Some((row, time_s)) => {
                n_estimated += usize::from(is_estimated(wanted, &fields));
                let talker = line.chars().skip(1).take(2).collect();
                let date = fields.get(9).filter(|_| wanted == "RMC").and_then(|text| date(text));
                fixes.push(Fix { talker, date, time_s, row });
            }
            None => n_without += 1,
        }
    }
    let is_behind = |line: &&str| kind(line) == Some(wanted) && !line.trim().starts_with('$');
    let n_behind = text.lines().filter(is_behind).count();
    let mut doubts = Vec::new();
    if n_behind > 0 {
        doubts.push(format!(
            "what stands in front of {n_behind} sentences, such as the stamp of a logger, is not read: times are those of \
             the receiver"
        ));
    }
    if n_wrong > 0 {
        doubts.push(format!("{n_wrong} sentences with a wrong checksum are left out"));
    }
    if n_without > 0 {
        doubts.push(format!("{n_without} sentences without a position are left out"));
    }
    if n_estimated > 0 {
        doubts.push(format!(
            "{n_estimated} sentences have positions that the receiver says it did not measure, but went on with by dead \
             reckoning, was told or simulated: they are read, and may be far off"
        ));
    }
    let is_dated = fixes.iter().all(|fix| fix.date.is_some());
    fixes.iter_mut().filter(|_| !is_dated).for_each(|fix| fix.date = None);
    let (mut fixes, of_talkers) = of_one_clock(fixes, wanted);
    doubts.extend(of_talkers);
    let n_held = if wanted == "RMC" { hold_course(&mut fixes) } else { 0 };
    if n_held > 0 {
        doubts.push(format!(
            "{n_held} sentences have no course, as those of a receiver that stands: the one before is held"
        ));
    }
    let header = match wanted {
        "RMC" => RMC_HEADER,
        _ => "time [s]\tlatitude [deg]\tlongitude [deg]",
    };
    // A single place is no track.
    if fixes.len() < 2 {
        return Err(doubts);
    }
    let rows: String = fixes.into_iter().map(|fix| day_text(fix.date) + &fix.row).collect();
    Ok(Track { name: wanted.to_owned(), header, rows, doubts })
}

/// Gives fixes without a course that of the one before, the first ones that of the first one that has it; their number.
fn hold_course(fixes: &mut [Fix]) -> usize {
    let course = |fix: &Fix| {
        let course = fix.row.trim_end().rsplit_once('\t').map(|(_, course)| course.to_owned());
        course.filter(|_| !fix.row.ends_with("\t\n"))
    };
    let mut last = fixes.iter().find_map(course);
    let mut n_held = 0;
    for fix in fixes {
        if let Some(own) = course(fix) {
            last = Some(own);
            continue;
        }
        let Some(held) = &last else { continue };
        fix.row.insert_str(fix.row.len() - 1, held);
        n_held += 1;
    }
    n_held
}

/// The fixes of the talker that comes first, with those of others at instants that it leaves out; without these
/// where the time would go back, as that of two receivers does.
fn of_one_clock(fixes: Vec<Fix>, kind: &str) -> (Vec<Fix>, Option<String>) {
    let first = fixes.first().map(|fix| fix.talker.clone()).unwrap_or_default();
    let others: BTreeSet<String> = fixes
        .iter()
        .filter(|fix| fix.talker != first)
        .map(|fix| format!("{}{kind}", fix.talker))
        .collect();
    if others.is_empty() {
        return (fixes, None);
    }
    let others: Vec<String> = others.into_iter().collect();
    let others = others.join(", ");
    // Instants of a day, to a millisecond.
    let instant = |fix: &Fix| (fix.date, (fix.time_s * 1e3).round() as u64);
    let mut taken: BTreeSet<(Option<u32>, u64)> =
        fixes.iter().filter(|fix| fix.talker == first).map(instant).collect();
    let n_own = taken.len();
    let is_kept: Vec<bool> =
        fixes.iter().map(|fix| fix.talker == first || taken.insert(instant(fix))).collect();
    let kept = || fixes.iter().zip(&is_kept).filter(|(_, is_kept)| **is_kept).map(|(fix, _)| fix);
    let n_back =
        |times: Vec<(Option<u32>, u64)>| times.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let own = || fixes.iter().filter(|fix| fix.talker == first);
    let goes_back = n_back(kept().map(instant).collect()) > n_back(own().map(instant).collect());
    let n_added = taken.len() - n_own;
    let n_others = fixes.len() - own().count();
    let said = match (n_added, goes_back) {
        (0, _) => format!(
            "{first}{kind} is read; {n_others} sentences {others} give the same instants and are left out"
        ),
        (_, true) => format!(
            "{first}{kind} is read; {n_others} sentences {others} are left out, as their times do not follow on: are \
             they of another receiver?"
        ),
        (_, false) => format!(
            "{first}{kind} is read, and {others} at {n_added} instants that it leaves out; if they are of another \
             receiver, keep one of them"
        ),
    };
    let fixes = fixes.into_iter().zip(is_kept);
    let fixes = fixes.filter(|(fix, is_kept)| *is_kept && (!goes_back || fix.talker == first));
    (fixes.map(|(fix, _)| fix).collect(), Some(said))
}

/// What stands between the sign and the checksum, if it is right or not given.
fn checked(line: &str) -> Option<&str> {
    let body = line.strip_prefix('$')?;
    let Some((sentence, sum)) = body.split_once('*') else { return Some(body) };
    let sum = u8::from_str_radix(sum.get(..2)?, 16).ok()?;
    (sentence.bytes().fold(0, |sum, byte| sum ^ byte) == sum).then_some(sentence)
}

/// Time, place, speed and direction of `…RMC,time,status,lat,N,lon,E,knots,course,…`.
fn rmc(fields: &[&str]) -> Option<String> {
    let [_, time, status, lat, ns, lon, ew, knots, course, ..] = fields else { return None };
    let [time, lat, lon] = [clock(time)?, degrees(lat, ns, 2)?, degrees(lon, ew, 3)?];
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
    let speed = number(knots).map(|knots| knots * KNOT_M_S);
    // The direction of the way over ground; a receiver that stands has none.
    let yaw = number(course).map(|course| 90.0 - course);
    let [speed, yaw] = [speed, yaw].map(|number| number.map_or_else(String::new, number_text));
    (*status == "A").then(|| format!("{time}\t{lat}\t{lon}\t{speed}\t{yaw}\n"))
}

/// Time and place of `…GGA,time,lat,N,lon,E,quality,…`.
fn gga(fields: &[&str]) -> Option<String> {
    let [_, time, lat, ns, lon, ew, quality, ..] = fields else { return None };
    let [time, lat, lon] = [clock(time)?, degrees(lat, ns, 2)?, degrees(lon, ew, 3)?];
    (*quality != "0" && !quality.is_empty()).then(|| format!("{time}\t{lat}\t{lon}\n"))
}

/// Whether a receiver says of a position that it is estimated, typed or simulated: by the mode of `RMC`, which older
/// ones do not have, or the quality of `GGA`.
fn is_estimated(kind: &str, fields: &[&str]) -> bool {
    let (idx, marks) = if kind == "RMC" { (12, ["E", "M", "S"]) } else { (6, ["6", "7", "8"]) };
    fields.get(idx).is_some_and(|mark| marks.contains(mark))
}

/// The year, month and day of `ddmmyy` as one number; the years are those from 1980 on, when the system began.
fn date(text: &str) -> Option<u32> {
    let is_date = text.len() == 6 && text.bytes().all(|byte| byte.is_ascii_digit());
    let number: u32 = text.parse().ok().filter(|_| is_date)?;
    let [day, month, year] = [number / 10_000, number / 100 % 100, number % 100];
    let year = if year < 80 { 2000 + year } else { 1900 + year };
    let is_date = (1..=31).contains(&day) && (1..=12).contains(&month);
    is_date.then_some(10_000 * year + 100 * month + day)
}

/// `2026-11-25T` of such a number; nothing without one.
fn day_text(date: Option<u32>) -> String {
    date.map_or_else(String::new, |date| {
        format!("{}-{:02}-{:02}T", date / 10_000, date / 100 % 100, date % 100)
    })
}

/// Seconds of the day of `hhmmss.ss`.
fn seconds(text: &str) -> Option<f64> {
    let parts = [text.get(..2)?, text.get(2..4)?, text.get(4..)?];
    let [hours, minutes, seconds] = parts.map(|part| part.parse::<f64>().ok());
    Some(3600.0 * hours? + 60.0 * minutes? + seconds?)
}

/// `hh:mm:ss.ss` of `hhmmss.ss`.
fn clock(text: &str) -> Option<String> {
    let [hours, minutes, seconds] = [text.get(..2)?, text.get(2..4)?, text.get(4..)?];
    let is_clock = text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    is_clock.then(|| format!("{hours}:{minutes}:{seconds}"))
}

/// Degrees of degrees and minutes, such as `5159.1000`.
///
/// - `n_digits`: of the degrees.
fn degrees(text: &str, side: &str, n_digits: usize) -> Option<String> {
    let whole: f64 = text.get(..n_digits)?.parse().ok()?;
    let minutes: f64 = text.get(n_digits..)?.parse().ok()?;
    let sign = match side {
        "N" | "E" => 1.0,
        "S" | "W" => -1.0,
        _ => return None,
    };
    (0.0..60.0).contains(&minutes).then(|| number_text(sign * (whole + minutes / 60.0)))
}

/// A cell without what would end it.
fn plain(text: &str) -> String {
    text.chars().take(80).map(|c| if c.is_control() || c == '"' { ' ' } else { c }).collect()
}

#[cfg(test)]
#[path = "positions_tests.rs"]
mod tests;
