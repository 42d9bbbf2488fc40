//! The curves of a crash test of the NHTSA database ([`nhtsa`](super::nhtsa)): one part of a test as a table,
//! and the force of the barrier with its momentum.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::data::formats::nhtsa::{
    CrashTest, MAX_CURVE_BYTES, TestChannel, finite, is_test, plain,
};
use crate::data::formats::{Converted, Said, number_text};
use crate::data::text::read_text;
use crate::data::{DataError, ReadSettings, Sheet, SheetRef};

/// Bytes of all curves of one part together.
const MAX_PART_BYTES: u64 = 128 << 20;

/// Difference of two instants that are the same, s.
const SAME_S: f64 = 2e-6;

/// Share of the momentum of the car that a barrier may say: up to the full stop, and with a rebound.
const MOMENTUM: std::ops::RangeInclusive<f64> = 0.9..=1.3;

/// What is said of channels along or about axes that point elsewhere than here.
pub(super) const OTHER_AXES: &str = "axes y and z of such a test point to the right and down (SAE J211): a channel \
     along or about one of them takes a minus in the map, such as vy=-5";

/// The part in which the force of the barrier is.
const BARRIER_FORCE: &str = "barrier force";

/// What the barrier of a test says of the momentum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarrierMomentum {
    /// Impulse of the force on the vehicle, N s.
    pub impulse_n_s: f64,
    /// Momentum of the vehicle before, N s.
    pub momentum_n_s: f64,
}

impl BarrierMomentum {
    /// The impulse over the momentum: 1 up to the stop, more with a rebound.
    pub fn ratio(self) -> f64 {
        self.impulse_n_s / self.momentum_n_s
    }
}

/// The force of the load cells of a barrier.
#[derive(Debug, Clone, PartialEq)]
pub struct BarrierForce {
    /// Instants, s.
    pub time_s: Vec<f64>,
    /// Force on the vehicle along its heading, N; negative, since the wall pushes it back.
    pub force_n: Vec<f64>,
    /// Load cells that are missing in the sum, each with the reason.
    pub left_out: Vec<String>,
}

/// Curves over one time.
#[derive(Default)]
struct Curves<'a> {
    time_s: Vec<f64>,
    values: Vec<(&'a TestChannel, Vec<f64>)>,
    left_out: Vec<String>,
}

impl CrashTest {
    /// The parts that can be read, in their order.
    fn parts(&self) -> Vec<String> {
        let mut parts: Vec<String> = Vec::new();
        if self.channels.iter().any(TestChannel::is_barrier_force) {
            parts.push(BARRIER_FORCE.to_owned());
        }
        // Those of the vehicle itself before those of its occupants.
        let mut channels: Vec<&TestChannel> = self.channels.iter().collect();
        channels.sort_by_key(|channel| {
            (!matches!(channel.occupant.as_str(), "NA" | ""), channel.vehicle)
        });
        for channel in channels {
            let part = channel.part();
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
        parts
    }

    /// The curves of channels over one time, with what was left out.
    fn curves(&self, is_in: impl Fn(&TestChannel) -> bool) -> Result<Curves<'_>, DataError> {
        let mut curves = Curves::default();
        let mut bytes = 0;
        for channel in self.channels.iter().filter(|channel| is_in(channel)) {
            if !channel.is_valid() {
                curves.left_out.push(format!("{} ({})", channel.curve, channel.why_not()));
                continue;
            }
            let path = self.curve_path(channel.curve);
            if !path.exists() {
                curves.left_out.push(format!("{} (no file)", channel.curve));
                continue;
            }
            let text = read_text(&path, MAX_CURVE_BYTES)?.text;
            bytes += text.len() as u64;
            if bytes > MAX_PART_BYTES {
                let (path, limit) = (self.path.clone(), MAX_PART_BYTES);
                return Err(DataError::TooLarge { path, bytes, limit });
            }
            let (at_s, values) = curve(&path, &text)?;
            if values.is_empty() {
                curves.left_out.push(format!("{} (no values)", channel.curve));
                continue;
            }
            let is_same = curves.time_s.len() == at_s.len()
                && curves.time_s.iter().zip(&at_s).all(|(a, b)| (a - b).abs() < SAME_S);
            match curves.values.is_empty() {
                true => curves.time_s = at_s,
                false if !is_same => {
                    curves.left_out.push(format!("{} (sampled otherwise)", channel.curve));
                    continue;
                }
                false => {}
            }
            curves.values.push((channel, values));
        }
        Ok(curves)
    }

    /// The files of its curves, as far as they are there.
    pub(super) fn curve_files(&self) -> Vec<PathBuf> {
        let numbers: BTreeSet<u32> = self.channels.iter().map(|channel| channel.curve).collect();
        let paths = numbers.into_iter().map(|number| self.curve_path(number));
        paths.filter(|path| path.is_file()).collect()
    }

    fn curve_path(&self, number: u32) -> PathBuf {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!("{stem}.{number:03}"))
    }

    /// The force of the barrier on the vehicle; `None` without load cells.
    ///
    /// # Errors
    /// [`DataError`] if a curve cannot be read.
    pub fn barrier_force(&self) -> Result<Option<BarrierForce>, DataError> {
        let Curves { time_s, values, left_out } = self.curves(TestChannel::is_barrier_force)?;
        if values.is_empty() {
            return Ok(None);
        }
        let mut force_n = vec![0.0; time_s.len()];
        for (_, values) in &values {
            force_n.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        // Laboratories differ in the polarity of load cells; a wall only pushes.
        if integral(&time_s, &force_n) > 0.0 {
            force_n.iter_mut().for_each(|force| *force = 0.0 - *force);
        }
        Ok(Some(BarrierForce { time_s, force_n, left_out }))
    }

    /// Compares the impulse of the barrier with the momentum of the only vehicle.
    pub fn momentum(&self, force: &BarrierForce) -> Option<BarrierMomentum> {
        let [vehicle] = self.vehicles.as_slice() else { return None };
        let momentum_n_s = vehicle.mass_kg? * vehicle.speed_m_s?;
        let impulse_n_s = 0.0 - integral(&force.time_s, &force.force_n);
        (momentum_n_s > 0.0).then_some(BarrierMomentum { impulse_n_s, momentum_n_s })
    }

    /// What is wrong with the record of the barrier, in words.
    pub fn barrier_doubts(&self, force: &BarrierForce) -> Vec<String> {
        let mut doubts = Vec::new();
        if !force.left_out.is_empty() {
            doubts.push(format!(
                "load cells are missing in the sum, {}: {}",
                force.left_out.len(),
                some(&force.left_out)
            ));
        }
        if self.is_oblique {
            doubts.push(
                "the impact was at an angle: the force is the one along the normal of the barrier, and not along \
                 the heading of the vehicle as its column says"
                    .to_owned(),
            );
        }
        match self.momentum(force) {
            None => doubts.push(
                "mass and speed of one vehicle are not stated: the momentum of the record is not checked"
                    .to_owned(),
            ),
            Some(momentum) if !MOMENTUM.contains(&momentum.ratio()) => doubts.push(format!(
                "the barrier took {:.0} N s, {:.2} times the momentum of the vehicle ({:.0} N s); expected {} to \
                 {}",
                momentum.impulse_n_s,
                momentum.ratio(),
                momentum.momentum_n_s,
                MOMENTUM.start(),
                MOMENTUM.end()
            )),
            Some(_) => {}
        }
        doubts
    }
}

/// A part of a test as the text of a table.
///
/// # Errors
/// [`DataError::NoSheet`] without such a part, [`DataError`] if a curve cannot be read or none is there.
pub(super) fn as_table(
    path: &Path,
    text: &str,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    if !is_test(text) {
        return Ok(None);
    }
    let test = CrashTest::parse(path, text)?;
    let all = test.parts();
    let chosen = match &settings.sheet {
        None => Some(0),
        Some(SheetRef::Number(number)) => number.checked_sub(1),
        Some(SheetRef::Name(name)) => all.iter().position(|part| part == name),
    };
    let Some(name) = chosen.and_then(|idx| all.get(idx)) else {
        let wanted = settings.sheet.as_ref().map_or_else(String::new, SheetRef::to_string);
        return Err(DataError::NoSheet { path: path.to_owned(), wanted, found: all });
    };
    let (text, doubts) = match name == BARRIER_FORCE {
        true => test.barrier_table()?,
        false => test.channel_table(name)?,
    };
    let description = format!(
        "a test of the NHTSA vehicle database, {}; read is the {name}, as recorded, without a filter",
        test.title
    );
    let part = Some(Sheet { name: name.clone(), all: all.clone() });
    let said = Said { description, doubts, part, device: "NHTSA".to_owned(), ..Said::default() };
    Ok(Some(Converted { text, said }))
}

impl CrashTest {
    fn barrier_table(&self) -> Result<(String, Vec<String>), DataError> {
        let Some(force) = self.barrier_force()? else {
            return Err(self.without_curves());
        };
        let mut text = "time [s]\tfx_body [N]\tfy_body [N]\n".to_owned();
        for (time_s, force_n) in force.time_s.iter().zip(&force.force_n) {
            text.push_str(&format!("{}\t{}\t0\n", number_text(*time_s), number_text(*force_n)));
        }
        Ok((text, self.barrier_doubts(&force)))
    }

    fn channel_table(&self, part: &str) -> Result<(String, Vec<String>), DataError> {
        let Curves { time_s, values, left_out } = self.curves(|channel| channel.part() == part)?;
        if values.is_empty() {
            return Err(self.without_curves());
        }
        let mut text = "time [s]".to_owned();
        for (channel, _) in &values {
            text.push('\t');
            text.push_str(&channel.column());
        }
        text.push('\n');
        for (row, time_s) in time_s.iter().enumerate() {
            text.push_str(&number_text(*time_s));
            for (_, of) in &values {
                text.push('\t');
                text.push_str(&of.get(row).map_or_else(String::new, |value| number_text(*value)));
            }
            text.push('\n');
        }
        let mut doubts = Vec::new();
        if !left_out.is_empty() {
            doubts.push(format!("channels are left out: {}", some(&left_out)));
        }
        if values.iter().any(|(channel, _)| channel.axis.starts_with(['Y', 'Z'])) {
            doubts.push(OTHER_AXES.to_owned());
        }
        Ok((text, doubts))
    }

    fn without_curves(&self) -> DataError {
        let format = "the description of a crash test without its curves";
        let remedy = "put the curves (.001 and so on) beside it, under the same name";
        DataError::OtherFormat { path: self.path.clone(), format, remedy }
    }
}

impl TestChannel {
    fn why_not(&self) -> String {
        match self.is_remarked() {
            true => plain(&self.comment.chars().take(60).collect::<String>()).to_lowercase(),
            false if !self.is_over_time() => format!("over {}, no time", plain(&self.over)),
            false => format!("status {}", plain(&self.status)),
        }
    }
}

/// The first of what was left out, and how many more.
fn some(left_out: &[String]) -> String {
    let shown: Vec<&str> = left_out.iter().take(6).map(String::as_str).collect();
    match left_out.len().saturating_sub(shown.len()) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// Reads a curve: instants, s, and values.
fn curve(path: &Path, text: &str) -> Result<(Vec<f64>, Vec<f64>), DataError> {
    let (mut time_s, mut values) = (Vec::new(), Vec::new());
    for (number, line) in (1..).zip(text.lines()) {
        let mut fields = line.split_whitespace();
        let Some(first) = fields.next() else { continue };
        let at_s = finite(path, number, 1, "time", first, "a time in seconds")?;
        let second = fields.next().unwrap_or_default();
        let value = finite(path, number, 2, "value", second, "a number")?;
        if time_s.last().is_some_and(|last| at_s <= *last) {
            let before_s = time_s.last().copied().unwrap_or_default();
            let path = path.to_owned();
            let (line, column, after_s) = (number, 1, at_s);
            return Err(DataError::TimeOrder { path, line, column, before_s, after_s });
        }
        time_s.push(at_s);
        values.push(value);
    }
    Ok((time_s, values))
}

/// ∫F dt, N s.
fn integral(time_s: &[f64], force_n: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (t, f) in time_s.windows(2).zip(force_n.windows(2)) {
        let ([t0, t1], [f0, f1]) = (t, f) else { continue };
        sum += (t1 - t0) * (f0 + f1) / 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Channel, read_any_series};

    /// A test of 1000 kg at 36 km/h whose two cells take 6000 and 5000 N s, with a third that failed.
    fn write(folder: &Path, scale: f64) -> PathBuf {
        let mut vehicle = vec!["0"; 60];
        vehicle[0] = "1";
        vehicle[10] = "1000";
        vehicle[12] = "2700";
        vehicle[13] = "4500";
        vehicle[14] = "1800";
        vehicle[41] = "36.0";
        for cell in &mut vehicle[47..53] {
            *cell = "400";
        }
        let row = |vehicle: u32, curve: u32, place: &str, status: &str, comment: &str| {
            let kind = if vehicle == 0 { "LC" } else { "AC" };
            let unit = if vehicle == 0 { "NWT" } else { "G'S" };
            format!(
                "{vehicle}|{curve}|{kind}|NA|{place}|XG|SEC|{unit}|2800|M|D|1|1|0.0|-1|100|1000|{status}|P|{comment}\n"
            )
        };
        let text = format!(
            "# Source: NHTSA\n----- EV5 -----\n----- TEST -----\nV5|A CAR|AIM\n----- VEHICLE -----\n{}\n\
             ----- BARRIER -----\nR|LCB|0|0|WALL\n----- INSTRUMENTATION -----\n{}{}{}{}----- END -----",
            vehicle.join("|"),
            row(0, 1, "LC0101", "AM", "B"),
            row(0, 2, "LC0102", "AM", "B"),
            row(0, 3, "LC0103", "AM", "B-03: No valid data after 20ms"),
            row(1, 4, "FLLR", "AM", "REAR"),
        );
        let path = folder.join("v1.EV5");
        std::fs::write(&path, text).unwrap();
        for (curve, impulse) in [(1, 6000.0), (2, 5000.0), (3, 9e9), (4, 10.0)] {
            let rows = (-1..=100).map(|i| {
                let inside = (0..100).contains(&i);
                let value = if inside { scale * impulse / 0.1 } else { 0.0 };
                format!("{:.5}\t{value}\n", f64::from(i) * 1e-3)
            });
            let text: String = rows.collect();
            std::fs::write(folder.join(format!("v1.{curve:03}")), text).unwrap();
        }
        path
    }

    #[test]
    fn load_cells_are_summed_and_their_momentum_checked() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), 1.0);
        let test = CrashTest::read(&path).unwrap();
        let beside = crate::data::parts_beside(&path);
        assert_eq!(beside.len(), 5, "{beside:?}");
        assert!(beside[0] == path && beside[4].ends_with("v1.004"), "{beside:?}");
        assert!(crate::data::parts_beside(&beside[1]).is_empty());
        let vehicle = &test.vehicles[0];
        assert_eq!((vehicle.mass_kg, vehicle.width_m), (Some(1000.0), Some(1.8)));
        assert_eq!(vehicle.crush_m, Some([0.4; 6]));
        let force = test.barrier_force().unwrap().unwrap();
        assert_eq!(force.left_out.len(), 1);
        // The polarity of the cells is turned: the wall pushes the car back.
        assert!(force.force_n.iter().all(|force| *force <= 0.0));
        let momentum = test.momentum(&force).unwrap();
        assert!((momentum.ratio() - 1.1).abs() < 0.01, "{momentum:?}");
        let loaded = read_any_series(&path, None).unwrap();
        let fx = loaded.series.require(Channel::FxBody).unwrap();
        assert!((fx[50] + 110_000.0).abs() < 1e-6, "{}", fx[50]);
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert!(
            notes.iter().any(|note| note.contains("load cells are missing in the sum, 1")),
            "{notes:?}"
        );
        assert!(!notes.iter().any(|note| note.contains("times the momentum")), "{notes:?}");
    }

    #[test]
    fn a_barrier_that_took_too_little_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), -0.5);
        let loaded = read_any_series(&path, None).unwrap();
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert!(notes.iter().any(|note| note.contains("0.55 times the momentum")), "{notes:?}");
        let bad = folder.path().join("v1.002");
        std::fs::write(&bad, "0.0\t1\n0.1\tx\n").unwrap();
        let error = read_any_series(&path, None).unwrap_err().to_string();
        assert!(error.contains("v1.002:2:2: "), "{error}");
    }

    /// Laboratories say it in their own words, and leave the status as measured.
    #[test]
    fn a_curve_whose_remark_says_that_it_failed_is_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), 1.0);
        let text = std::fs::read_to_string(&path).unwrap();
        for (remark, n_left_out) in [
            ("B-03: data not valid after 60 ms", 1),
            ("B-03: INVALID AFTER 60 MSEC", 1),
            ("B-03: channel failed at 40 ms", 1),
            ("B-03: no data", 1),
            ("B-03: questionable data after 40 ms", 1),
            ("B-03", 0),
        ] {
            std::fs::write(&path, text.replace("B-03: No valid data after 20ms", remark)).unwrap();
            let force = CrashTest::read(&path).unwrap().barrier_force().unwrap().unwrap();
            assert_eq!(force.left_out.len(), n_left_out, "{remark}: {:?}", force.left_out);
        }
    }

    /// A force over the way of a slow test is none over time.
    #[test]
    fn a_curve_over_a_way_is_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), 1.0);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("LC0102|XG|SEC", "LC0102|XG|MM")).unwrap();
        let force = CrashTest::read(&path).unwrap().barrier_force().unwrap().unwrap();
        assert_eq!(force.left_out.len(), 2, "{:?}", force.left_out);
        assert!(force.left_out.iter().any(|of| of == "2 (over MM, no time)"), "{force:?}");
    }

    #[test]
    fn channels_of_the_vehicle_are_a_part() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), 1.0);
        let settings = ReadSettings { sheet: Some(SheetRef::Number(3)), ..ReadSettings::default() };
        let table = crate::data::Table::read_as(&path, &settings).unwrap();
        assert_eq!(table.sheet().unwrap().name, "vehicle 1");
        assert_eq!(table.header(), ["time [s]", "4 AC FLLR XG REAR [g]"]);
    }
}
