//! Compares the speed that a motion records with the speed at which its path goes on, to find a unit or a
//! clock that is wrong.
//!
//! ```text
//! s = ∫ v dt  against  the distance of the places at both ends, over windows of half a second
//! ```
//!
//! Half a second smooths the noise of positions and hardly cuts a bend. What a noisy path leaves goes to
//! both sides from window to window; a wrong unit or clock goes to one side over a whole part of the path.
//! A record of few rows is compared as a whole alone; of one that cannot be compared it is said.

use std::collections::BTreeMap;
use std::fmt;

use crate::data::correction::Change;
use crate::data::velocity_fit::{FITTING, SHORTEST_PATH_M, UNITS, is_other_length};
use crate::data::{
    Channel, ColumnUse, Contradiction, Correction, Note, Table, TimeSeries, contradictions,
};
use crate::units::{Unit, significant};

/// Duration of a window, s, and the number of windows of a motion that has fewer of that duration.
const WINDOW_S: f64 = 0.5;
const LEAST_WINDOWS: usize = 12;
/// Least number of windows of a motion that is compared, and of one of which a part is.
const LEAST_FOR_WHOLE: usize = 2;
const LEAST_FOR_PART: usize = 6;
/// Share of the path over which the speed has to be off to one side.
const SHARE_OF_PATH: f64 = 0.25;

/// A recorded speed that is not that of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSpeed {
    /// The way that the speed gives over the way along the path, where they differ.
    pub ratio: f64,
    /// Whether the whole path is meant and not a part of it.
    pub is_whole: bool,
    /// Index of the row where they differ most.
    pub sample_idx: usize,
    /// Time of this row, s.
    pub time_s: f64,
    /// What is recorded there, m/s.
    pub recorded_m_s: f64,
    /// At what speed the path goes on there, m/s.
    pub path_m_s: f64,
}

/// A part of a motion.
#[derive(Clone, Copy)]
struct Window {
    from: usize,
    duration_s: f64,
    recorded_m: f64,
    path_m: f64,
}

impl Window {
    /// By how much the recorded speed is off, m/s.
    fn off_m_s(&self) -> f64 {
        (self.recorded_m - self.path_m).abs() / self.duration_s
    }
}

/// Compares the speed of a motion with its path: the column of the speed, the size of v_x and v_y where
/// the motion has no such column and its yaw angle, by which
/// [`velocity_fit`](crate::data::velocity_fit()) would compare them, is missing, or v_x alone with the way along the
/// yaw angle.
///
/// - returns `None` if they agree, if there is nothing to compare or if the path is too short.
pub fn path_speed(series: &TimeSeries) -> Option<PathSpeed> {
    let Some(recorded_m_s) = recorded_m_s(series) else { return forward_speed(series) };
    let windows = windows(series, &recorded_m_s)?;
    let all_m = way_m(&windows);
    if all_m < SHORTEST_PATH_M || windows.len() < LEAST_FOR_WHOLE {
        return None;
    }
    let is_whole = is_other_length(ratio(&windows));
    let off = match is_whole {
        true => windows.as_slice(),
        false if windows.len() < LEAST_FOR_PART => return None,
        false => longest_off(&windows),
    };
    if way_m(off) < SHARE_OF_PATH * all_m || has_held_positions(series) {
        return None;
    }
    let worst = off.iter().max_by(|a, b| a.off_m_s().total_cmp(&b.off_m_s()))?;
    Some(PathSpeed {
        ratio: ratio(off),
        is_whole,
        sample_idx: worst.from,
        time_s: series.time_s().get(worst.from).copied()?,
        recorded_m_s: worst.recorded_m / worst.duration_s,
        path_m_s: worst.path_m / worst.duration_s,
    })
}

/// Why the speed of a motion could not be compared with its path, in words; `None` if it was, if there is
/// nothing to compare or if neither goes anywhere.
fn why_not_compared(series: &TimeSeries) -> Option<String> {
    let windows = windows(series, &recorded_m_s(series)?)?;
    let recorded_m: f64 = windows.iter().map(|window| window.recorded_m).sum();
    let (path_m, n_rows) = (way_m(&windows), series.n_samples());
    if recorded_m.max(path_m) < SHORTEST_PATH_M {
        return None;
    }
    if windows.len() < LEAST_FOR_WHOLE {
        return Some(format!("there are only {n_rows} rows"));
    }
    let [path, recorded] = [path_m, recorded_m].map(significant);
    (path_m < SHORTEST_PATH_M).then(|| {
        format!("the path is {path} m long, too short for that; by the speed it is {recorded} m")
    })
}

/// The size of the recorded speed.
fn recorded_m_s(series: &TimeSeries) -> Option<Vec<f64>> {
    if let Some(speed) = series.get(Channel::Speed) {
        return Some(speed.iter().map(|v| v.abs()).collect());
    }
    let is_compared = series.get(Channel::Yaw).is_some();
    let (vx, vy) = (series.get(Channel::Vx)?, series.get(Channel::Vy)?);
    (!is_compared).then(|| vx.iter().zip(vy).map(|(x, y)| x.hypot(*y)).collect())
}

/// Compares v_x without a v_y with the way along the heading, as a whole: neither a car that slides nor a place beside
/// its CG makes it so much longer or shorter. Nothing is found where heading and path contradict each other. Without a
/// heading it is compared with the path, which no component of the velocity is faster than.
fn forward_speed(series: &TimeSeries) -> Option<PathSpeed> {
    let get = |channel| series.get(channel);
    if get(Channel::Vy).is_some() {
        return None;
    }
    let ([x, y], vx) = ([get(Channel::X)?, get(Channel::Y)?], get(Channel::Vx)?);
    let (yaw_rad, time_s) = (get(Channel::Yaw), series.time_s());
    let step = |to: usize| {
        let [dx_m, dy_m] = [x[to] - x[to - 1], y[to] - y[to - 1]];
        let way_m = yaw_rad.map_or(dx_m.hypot(dy_m), |yaw_rad| {
            let (sin, cos) = ((yaw_rad[to - 1] + yaw_rad[to]) / 2.0).sin_cos();
            cos * dx_m + sin * dy_m
        });
        let speed_m_s = (vx[to - 1] + vx[to]) / 2.0;
        (to, time_s[to] - time_s[to - 1], way_m, speed_m_s)
    };
    let steps: Vec<(usize, f64, f64, f64)> = (1..time_s.len()).map(step).collect();
    let path_m: f64 = steps.iter().map(|(_, _, way_m, _)| way_m).sum::<f64>().abs();
    let recorded_m = steps.iter().map(|(_, step_s, _, speed)| step_s * speed).sum::<f64>().abs();
    let (to, step_s, way_m, speed_m_s) =
        steps.iter().copied().max_by(|a, b| a.3.abs().total_cmp(&b.3.abs()))?;
    let is_compared = path_m > SHORTEST_PATH_M && steps.len() >= LEAST_WINDOWS;
    let may_be_short = yaw_rad.is_none() && recorded_m < path_m;
    let is_off = is_compared && is_other_length(recorded_m / path_m) && !may_be_short;
    (is_off && contradictions(series).is_empty()).then(|| PathSpeed {
        ratio: recorded_m / path_m,
        is_whole: true,
        sample_idx: to - 1,
        time_s: time_s[to - 1],
        recorded_m_s: speed_m_s.abs(),
        path_m_s: way_m.abs() / step_s,
    })
}

/// Positions that are held between fixes go on by steps, which is another fault.
fn has_held_positions(series: &TimeSeries) -> bool {
    contradictions(series).iter().any(|found| matches!(found, Contradiction::Held { .. }))
}

fn windows(series: &TimeSeries, speed_m_s: &[f64]) -> Option<Vec<Window>> {
    let time_s = series.time_s();
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let duration_s = time_s.last()? - time_s.first()?;
    let window_s = WINDOW_S.min(duration_s / LEAST_WINDOWS as f64);
    let mut windows = Vec::new();
    let (mut from, mut recorded_m) = (0, 0.0);
    for to in 1..time_s.len() {
        recorded_m += (time_s[to] - time_s[to - 1]) * (speed_m_s[to - 1] + speed_m_s[to]) / 2.0;
        let duration_s = time_s[to] - time_s[from];
        if duration_s >= window_s * (1.0 - 1e-9) {
            let path_m = (x[to] - x[from]).hypot(y[to] - y[from]);
            windows.push(Window { from, duration_s, recorded_m, path_m });
            (from, recorded_m) = (to, 0.0);
        }
    }
    Some(windows)
}

fn way_m(windows: &[Window]) -> f64 {
    windows.iter().map(|window| window.path_m).sum()
}

fn ratio(windows: &[Window]) -> f64 {
    let recorded_m: f64 = windows.iter().map(|window| window.recorded_m).sum();
    recorded_m / way_m(windows)
}

/// The longest way over which the speed is off to the same side in every window.
fn longest_off(windows: &[Window]) -> &[Window] {
    let side = |window: &Window| {
        let ratio = window.recorded_m / window.path_m;
        is_other_length(ratio).then_some(ratio > 1.0)
    };
    let runs = windows.chunk_by(|a, b| side(a) == side(b));
    let off = runs.filter(|run| run.first().is_some_and(|window| side(window).is_some()));
    off.max_by(|a, b| way_m(a).total_cmp(&way_m(b))).unwrap_or_default()
}

/// The remark on a speed that is not that of the path, or that could not be compared with it.
pub(super) fn note(
    table: &Table,
    columns: &BTreeMap<Channel, ColumnUse>,
    series: &TimeSeries,
) -> Option<Note> {
    let Some(found) = path_speed(series) else {
        return why_not_compared(series).map(|why| Note::SpeedUnchecked { why });
    };
    let column = columns.get(&Channel::Speed).or_else(|| columns.get(&Channel::Vx))?;
    Some(Note::Speed {
        path: table.path().to_owned(),
        line: table.line(found.sample_idx),
        column: column.number,
        name: column.name.clone(),
        found,
        corrections: corrections(&found, columns),
    })
}

/// Units of the speed, of the path or of the time with which they agree.
fn corrections(found: &PathSpeed, columns: &BTreeMap<Channel, ColumnUse>) -> Vec<Correction> {
    use Channel::{Speed, Time, Vx, Vy, X, Y};
    if !found.is_whole {
        return Vec::new();
    }
    let (speed, name) = match (columns.contains_key(&Speed), columns.contains_key(&Vy)) {
        (true, _) => (&[Speed][..], "The speed is"),
        (false, true) => (&[Vx, Vy][..], "v_x and v_y are"),
        (false, false) => (&[Vx][..], "v_x is"),
    };
    let tries = [
        (speed, name, 1.0 / found.ratio),
        (&[X, Y][..], "x and y are", found.ratio),
        (&[Time][..], "The time is", 1.0 / found.ratio),
    ];
    let in_unit = |(channels, name, wanted)| in_other_unit(columns, channels, name, wanted);
    tries.into_iter().filter_map(in_unit).collect()
}

/// Other units of columns, whose size is near to a multiple of those in which they were read.
fn in_other_unit(
    columns: &BTreeMap<Channel, ColumnUse>,
    channels: &[Channel],
    name: &str,
    wanted: f64,
) -> Option<Correction> {
    let quantity = channels.first()?.quantity();
    let used: Vec<&ColumnUse> =
        channels.iter().map(|channel| columns.get(channel)).collect::<Option<_>>()?;
    let is_plain = |column: &&ColumnUse| column.formula.is_none() && column.terms.len() == 1;
    let before = used.first()?.unit.si_per_unit;
    let off = |unit: &Unit| (unit.si_per_unit / before / wanted - 1.0).abs();
    let near =
        quantity.units().iter().filter(|unit| unit.is_guessed() && off(unit) < FITTING / 2.0);
    let unit = near.min_by(|a, b| off(a).total_cmp(&off(b)))?;
    if !used.iter().all(is_plain) {
        return None;
    }
    let change = |column: &&ColumnUse| {
        let mut column = (*column).clone();
        (column.unit, column.unit_is_stated) = (*unit, true);
        column.terms.iter_mut().for_each(|term| term.unit = *unit);
        Change::Column(column.channel, column.source())
    };
    let changes = used.iter().map(change).collect();
    Some(Correction::new(format!("{name} in {}", unit.symbol), changes))
}

impl fmt::Display for PathSpeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let &Self { ratio, is_whole, time_s, recorded_m_s, path_m_s, .. } = self;
        let [recorded, path, factor] = [recorded_m_s, path_m_s, ratio].map(significant);
        let part = if is_whole { "the whole" } else { "a part of the" };
        write!(
            f,
            "says {recorded} m/s at {time_s} s, where the path goes on at {path} m/s: {factor} times as fast \
             over {part} path"
        )?;
        match UNITS.iter().find(|(factor, _)| (ratio / factor - 1.0).abs() < FITTING / 2.0) {
            Some((_, unit)) if is_whole => write!(f, ", as if {unit} were read as m/s"),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bend of 50 m radius at 15 m/s with noise of a few centimetres, and a speed that was changed.
    fn bend(speed: impl Fn(f64) -> f64) -> TimeSeries {
        let time_s: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.02).collect();
        let noise_m = |i: usize, k: f64| 0.03 * (k * i as f64 * i as f64).sin();
        let column = |f: &dyn Fn(usize, f64) -> f64| {
            time_s.iter().enumerate().map(|(i, t)| f(i, *t)).collect::<Vec<f64>>()
        };
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        for (channel, values) in [
            (Channel::X, column(&|i, t| 50.0 * (0.3 * t).sin() + noise_m(i, 1.3))),
            (Channel::Y, column(&|i, t| 50.0 * (1.0 - (0.3 * t).cos()) + noise_m(i, 0.7))),
            (Channel::Speed, column(&|_, t| speed(t))),
        ] {
            series.insert(channel, values).unwrap();
        }
        series
    }

    #[test]
    fn a_speed_with_noise_is_that_of_its_path() {
        assert_eq!(path_speed(&bend(|t| 15.0 + (40.0 * t).sin())), None);
        assert_eq!(path_speed(&bend(|_| -15.0)), None);
    }

    #[test]
    fn another_unit_and_a_part_that_is_off_are_found_with_their_place() {
        let found = path_speed(&bend(|_| 54.0)).unwrap();
        assert!((found.ratio - 3.6).abs() < 0.02 && found.is_whole, "{found:?}");
        assert!(found.to_string().ends_with("over the whole path, as if km/h were read as m/s"));
        // A wheel that locks for 2.4 s: its speed is not that of the car.
        let found =
            path_speed(&bend(|t| if (3.0..5.4).contains(&t) { 9.0 } else { 15.0 })).unwrap();
        assert!(!found.is_whole && (3.0..5.4).contains(&found.time_s), "{found:?}");
        assert!((found.recorded_m_s - 9.0).abs() < 0.1, "{found:?}");
    }

    /// Rows at a distance of a second, at 15 m/s to the east.
    fn sparse(n_rows: u32, speed_m_s: f64) -> TimeSeries {
        let time_s: Vec<f64> = (0..n_rows).map(f64::from).collect();
        let east_m = time_s.iter().map(|t| 15.0 * t).collect();
        let (north_m, speed) = (vec![0.0; time_s.len()], vec![speed_m_s; time_s.len()]);
        let mut series = TimeSeries::new(time_s).unwrap();
        for (channel, values) in
            [(Channel::X, east_m), (Channel::Y, north_m), (Channel::Speed, speed)]
        {
            series.insert(channel, values).unwrap();
        }
        series
    }

    #[test]
    fn a_short_log_is_compared_as_a_whole_and_a_shorter_one_is_said_to_be_unchecked() {
        for n_rows in [3, 4, 5, 6] {
            assert_eq!(path_speed(&sparse(n_rows, 15.0)), None, "{n_rows} rows");
            assert_eq!(why_not_compared(&sparse(n_rows, 15.0)), None, "{n_rows} rows");
            let found = path_speed(&sparse(n_rows, 54.0)).expect("another unit");
            assert!(found.is_whole && (found.ratio - 3.6).abs() < 1e-9, "{found:?}");
        }
        assert_eq!(path_speed(&sparse(2, 54.0)), None);
        let why = why_not_compared(&sparse(2, 54.0));
        assert_eq!(why.as_deref(), Some("there are only 2 rows"));
        // A car that stands by its speed and its path, and one that stands by its path alone.
        let mut standing = sparse(9, 0.0);
        standing.insert(Channel::X, vec![3.0; 9]).unwrap();
        assert_eq!(why_not_compared(&standing), None);
        standing.insert(Channel::Speed, vec![10.0; 9]).unwrap();
        let why = why_not_compared(&standing).expect("it goes 80 m by its speed");
        assert!(why.contains("by the speed it is 80"), "{why}");
    }

    #[test]
    fn components_are_compared_where_no_heading_is_known() {
        let mut series = bend(|_| 15.0);
        let n = series.n_samples();
        series.insert(Channel::Speed, vec![15.0; n]).unwrap();
        assert_eq!(path_speed(&series), None);
        let mut components = TimeSeries::new(series.time_s().to_vec()).unwrap();
        for channel in [Channel::X, Channel::Y] {
            components.insert(channel, series.get(channel).unwrap().to_vec()).unwrap();
        }
        // One component alone is no faster than the path.
        let along = |vx_m_s: f64| {
            let mut of = components.clone();
            of.insert(Channel::Vx, vec![vx_m_s; n]).unwrap();
            path_speed(&of)
        };
        assert_eq!([along(9.0), along(15.0)], [None, None]);
        assert!(along(54.0).is_some_and(|found| found.is_whole && found.ratio > 3.0));
        components.insert(Channel::Vx, vec![9.0 * 3.6; n]).unwrap();
        components.insert(Channel::Vy, vec![12.0 * 3.6; n]).unwrap();
        assert!(path_speed(&components).unwrap().is_whole);
    }

    /// A log of a receiver has the course for the heading and the speed along it.
    #[test]
    fn a_speed_along_the_heading_alone_is_compared_as_a_whole() {
        let motion = |speed_m_s: f64, yaw: &dyn Fn(f64) -> f64| {
            let series = bend(|_| 15.0);
            let mut of = TimeSeries::new(series.time_s().to_vec()).unwrap();
            let n = series.n_samples();
            for channel in [Channel::X, Channel::Y] {
                of.insert(channel, series.get(channel).unwrap().to_vec()).unwrap();
            }
            let angles = series.time_s().iter().map(|t| yaw(*t)).collect();
            of.insert(Channel::Yaw, angles).unwrap();
            of.insert(Channel::Vx, vec![speed_m_s; n]).unwrap();
            path_speed(&of)
        };
        assert_eq!(motion(15.0, &|t| 0.3 * t), None);
        let found = motion(54.0, &|t| 0.3 * t).expect("another unit");
        assert!(found.is_whole && (found.ratio - 3.6).abs() < 0.05, "{found:?}");
        assert!(found.to_string().ends_with("as if km/h were read as m/s"), "{found}");
        // A compass heading is another fault, by which nothing can be said of the speed.
        assert_eq!(motion(54.0, &|t| std::f64::consts::FRAC_PI_2 - 0.3 * t), None);
    }
}
