//! Whether the columns of a recorded motion go together: yaw rate and yaw angle, yaw angle and path, path
//! and time. A unit that is off, a mirrored axis, a compass heading or positions that are held between
//! fixes give a motion that no vehicle has, and each is found with what would mend it.
//!
//! ```text
//! yaw rate   ψ against ∫r dt, both about their means: the slope of a line through the origin
//! compass    course + ψ = π/2 wherever the vehicle drives and the course turns
//! mirror     course + ψ = 0 likewise
//! held       at speed most places stand in several rows
//! ```
//!
//! A vehicle that spins moves in directions that have nothing to do with its heading; the path is compared
//! with the heading only where one of these relations holds all along while the course turns, which no spin
//! does.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

use crate::data::yaw_rate::{MOVING_M_S, against_yaw_rate, speed_m_s};
use crate::data::{Channel, TimeSeries};
use crate::numerics::{continued_rad, wrap_angle_rad};

/// Windows into which a motion is divided.
const N_WINDOWS: usize = 24;
/// Deviation of a slope from a known factor.
pub(super) const FACTOR_REACH: f64 = 0.15;
/// Speed from which the direction of motion is known from positions, m/s.
const DRIVING_M_S: f64 = 3.0;
/// Turn of the course from which it can tell a compass or a mirror, rad.
const LEAST_COURSE_TURN_RAD: f64 = 0.25;
/// The same from which it can tell degrees that were read as radians, and the share of it within which the yaw
/// angle then has to follow. Of 1426 computed motions, most of them spins, none comes nearer than 0.17.
const LEAST_UNIT_TURN_RAD: f64 = 0.05;
const UNIT_SHARE_OF_TURN: f64 = 0.1;
/// Deviation of a relation between course and heading up to which it holds all along, rad.
const RELATION_RAD: f64 = 0.12;
/// Way at the start over which the direction of motion is taken, m.
const FIRST_WAY_M: f64 = 1.0;
/// Yaw rate below which a vehicle does not turn there, rad/s.
const STEADY_RAD_S: f64 = 0.6;
/// Angle between course and heading there from which it is looked at, rad.
const LEAST_OFF_RAD: f64 = 0.5;
/// Share of places that stand in several rows from which they are held.
const HELD: f64 = 0.5;
/// Steps of the resolution by which a place has to differ from the next for it to be a fix.
const COARSE: f64 = 4.0;
/// Least number of places at speed.
const LEAST_PLACES: usize = 8;

/// What contradicts what in a recorded motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contradiction {
    /// The yaw angle changes by this many times what the yaw rate says.
    YawRate {
        /// The factor: 1/57.3 for degrees that were read as radians, −1 for a mirrored axis.
        factor: f64,
    },
    /// Yaw angle and yaw rate have nothing to do with each other.
    YawRateUnrelated,
    /// The yaw angle is a compass heading, clockwise from the Y axis.
    Compass,
    /// The vehicle turns to one side and its path to the other.
    Mirrored {
        /// The position that has the wrong sign if the yaw angle has the right one.
        axis: Channel,
    },
    /// The yaw angle changes by this many times what the path does, though the vehicle follows its heading.
    YawUnit {
        /// The factor.
        factor: f64,
    },
    /// Positions stay the same over several rows at speed.
    Held {
        /// Rows for each position.
        rows: f64,
    },
}

/// A factor by which numbers are off, with the word for it.
const FACTORS: [(f64, &str); 3] =
    [(57.295_78, "degrees and radians"), (1000.0, "milli-units"), (3.6, "km/h and m/s")];

/// What contradicts what in a recorded motion; nothing of one that may be true.
pub fn contradictions(series: &TimeSeries) -> Vec<Contradiction> {
    let held = held_positions(series);
    // The direction of a path of steps is not that of the motion.
    let by_path = || against_path(series).or_else(|| at_the_start(series));
    let by_path = if held.is_some() { None } else { by_path() };
    [held, against_yaw_rate(series), by_path].into_iter().flatten().collect()
}

/// Indices of the ends of the windows.
fn windows(n_samples: usize) -> Option<impl Iterator<Item = (usize, usize)>> {
    let n_steps = n_samples.checked_sub(1).filter(|n| *n >= N_WINDOWS)?;
    Some((0..N_WINDOWS).map(move |i| (i * n_steps / N_WINDOWS, (i + 1) * n_steps / N_WINDOWS)))
}

/// Course and heading in the middle of each window in which the vehicle drives.
fn courses(series: &TimeSeries) -> Option<Vec<(f64, f64)>> {
    let time_s = series.time_s();
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let yaw_rad = continued_rad(series.get(Channel::Yaw)?);
    let speed = speed_m_s(series);
    let is_moving = |i: usize| speed.as_ref().is_none_or(|speed| speed[i] >= MOVING_M_S);
    let mut pairs = Vec::new();
    for (from, to) in windows(time_s.len())?.filter(|(from, to)| is_moving(*from) && is_moving(*to))
    {
        let moved_m = [x[to] - x[from], y[to] - y[from]];
        let duration_s = time_s[to] - time_s[from];
        if moved_m[0].hypot(moved_m[1]) < DRIVING_M_S * duration_s {
            continue;
        }
        pairs.push((moved_m[1].atan2(moved_m[0]), (yaw_rad[from] + yaw_rad[to]) / 2.0));
    }
    Some(pairs)
}

fn against_path(series: &TimeSeries) -> Option<Contradiction> {
    let pairs = courses(series)?;
    if pairs.len() < N_WINDOWS / 4 {
        return None;
    }
    let course_rad = continued_rad(&pairs.iter().map(|(course, _)| *course).collect::<Vec<_>>());
    let turned = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
    };
    let course_turn = turned(&course_rad);
    let in_degrees = yaw_unit(&course_rad, &pairs, course_turn);
    if course_turn < LEAST_COURSE_TURN_RAD {
        return in_degrees;
    }
    // A relation `course − sign · ψ = constant`, with the constant and how far it is off at most.
    let relation = |sign: f64| {
        let off: Vec<f64> =
            course_rad.iter().zip(&pairs).map(|(course, (_, yaw))| course - sign * yaw).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        (mean, off.iter().map(|off| (off - mean).abs()).fold(0.0, f64::max))
    };
    let [(_, along), (sum, against)] = [relation(1.0), relation(-1.0)];
    if along < RELATION_RAD.max(against / 2.0) {
        return None;
    }
    let is = |angle_rad: f64| wrap_angle_rad(sum - angle_rad).abs() < 2.0 * RELATION_RAD;
    if against < RELATION_RAD {
        return match () {
            () if is(FRAC_PI_2) => Some(Contradiction::Compass),
            () if is(0.0) => Some(Contradiction::Mirrored { axis: Channel::Y }),
            () if is(PI) => Some(Contradiction::Mirrored { axis: Channel::X }),
            () => None,
        };
    }
    in_degrees
}

/// The direction of the first metre, over which a vehicle that does not turn moves along its heading. One that
/// slides or drives backwards may not; that its heading is just that of a compass is no chance.
fn at_the_start(series: &TimeSeries) -> Option<Contradiction> {
    let time_s = series.time_s();
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let yaw_rad = continued_rad(series.get(Channel::Yaw)?);
    let moved_m = |i: usize| [x[i] - x[0], y[i] - y[0]];
    let is_far = |i: &usize| moved_m(*i)[0].hypot(moved_m(*i)[1]) >= FIRST_WAY_M;
    let end = (1..time_s.len()).find(is_far)?;
    let duration_s = time_s[end] - time_s[0];
    let is_turning = (yaw_rad[end] - yaw_rad[0]).abs() > STEADY_RAD_S * duration_s;
    if is_turning || FIRST_WAY_M < DRIVING_M_S * duration_s {
        return None;
    }
    let course_rad = moved_m(end)[1].atan2(moved_m(end)[0]);
    let heading_rad = (yaw_rad[0] + yaw_rad[end]) / 2.0;
    let is_compass = wrap_angle_rad(course_rad + heading_rad - FRAC_PI_2).abs() < RELATION_RAD;
    let off_rad = wrap_angle_rad(course_rad - heading_rad).abs();
    let is_off = (LEAST_OFF_RAD..PI - LEAST_OFF_RAD).contains(&off_rad);
    (is_off && is_compass).then_some(Contradiction::Compass)
}

/// A yaw that turns with the path, but by 57.3 times as much or as little: degrees that were read as radians, or the
/// other way round. No vehicle spins so often while its path turns by so much, or keeps to its path in such a way.
fn yaw_unit(course_rad: &[f64], pairs: &[(f64, f64)], course_turn: f64) -> Option<Contradiction> {
    let reach = RELATION_RAD.min(UNIT_SHARE_OF_TURN * course_turn);
    let is_factor = |factor: &f64| {
        let off = |(course, (_, yaw)): (&f64, &(f64, f64))| course - yaw / factor;
        let off: Vec<f64> = course_rad.iter().zip(pairs).map(off).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let is_along =
            course_turn > LEAST_UNIT_TURN_RAD && off.iter().all(|off| (off - mean).abs() < reach);
        is_along && wrap_angle_rad(mean).abs() < 2.0 * RELATION_RAD
    };
    let factor = [1.0_f64.to_degrees(), 1.0_f64.to_radians()].into_iter().find(is_factor)?;
    Some(Contradiction::YawUnit { factor })
}

/// Positions of which each stands in several rows at speed. Those of a coarse resolution do too, but go on by
/// one step of it; between fixes a vehicle goes much farther than that.
fn held_positions(series: &TimeSeries) -> Option<Contradiction> {
    let time_s = series.time_s();
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let (mut last, mut rows, mut finest_m) = (0, Vec::new(), f64::INFINITY);
    for at in 1..time_s.len() {
        let steps_m = [x[at] - x[last], y[at] - y[last]].map(f64::abs);
        let moved_m = steps_m[0].hypot(steps_m[1]);
        if moved_m > 0.0 {
            let finest = steps_m.into_iter().filter(|step_m| *step_m > 0.0).fold(moved_m, f64::min);
            finest_m = finest_m.min(finest);
            if moved_m >= DRIVING_M_S * (time_s[at] - time_s[last]) {
                rows.push((at - last, moved_m));
            }
            last = at;
        }
    }
    let is_held = |(rows, moved_m): &&(usize, f64)| *rows > 1 && *moved_m > COARSE * finest_m;
    let n_held = rows.iter().filter(is_held).count() as f64;
    let mean = rows.iter().map(|(rows, _)| *rows as f64).sum::<f64>() / rows.len().max(1) as f64;
    (rows.len() >= LEAST_PLACES && n_held > HELD * rows.len() as f64)
        .then_some(Contradiction::Held { rows: mean })
}

/// The known factor that a slope is near to, or the inverse of one.
fn known_factor(slope: f64) -> Option<&'static str> {
    let is = |factor: f64| (slope.abs() / factor - 1.0).abs() < FACTOR_REACH;
    FACTORS.iter().find(|(factor, _)| is(*factor) || is(1.0 / factor)).map(|(_, words)| *words)
}

impl Contradiction {
    /// What can be done where no change of the map is known to help.
    pub(super) fn advice(self) -> &'static str {
        match self {
            Self::YawRate { .. } => "check both columns and their units",
            Self::YawRateUnrelated => "check which columns they are",
            Self::Compass => "turn the headings into yaw angles",
            Self::Mirrored { .. } => "change the sign of one of them",
            Self::YawUnit { .. } => "check its unit",
            Self::Held { .. } => "keep one row for each",
        }
    }
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::YawRate { factor } => {
                write!(f, "the yaw angle changes by {factor:.3} times what the yaw rate says")?;
                let is_mirrored = factor < 0.0;
                match known_factor(factor) {
                    Some(words) if factor.abs() < 0.05 && words.starts_with("degrees") => write!(
                        f,
                        ", as if degrees were read as radians{}",
                        if is_mirrored { " and clockwise as counterclockwise" } else { "" }
                    ),
                    Some(words) => write!(f, ", as between {words}"),
                    None if (factor + 1.0).abs() < FACTOR_REACH => {
                        write!(f, ": one of them is clockwise")
                    }
                    None => Ok(()),
                }
            }
            Self::YawRateUnrelated => {
                write!(f, "yaw angle and yaw rate have nothing to do with each other")
            }
            Self::Compass => write!(
                f,
                "the yaw angle is a compass heading, clockwise from north, over a path with x to the \
                 east"
            ),
            Self::Mirrored { .. } => {
                write!(f, "the path turns to one side where the yaw angle turns to the other")
            }
            Self::YawUnit { factor } if factor > 1.0 => write!(
                f,
                "the yaw angle turns by {factor:.1} times what the path does, as if degrees were read as \
                 radians"
            ),
            Self::YawUnit { factor } => write!(
                f,
                "the yaw angle turns by {factor:.4} times what the path does, as if radians were read as \
                 degrees"
            ),
            Self::Held { rows } => write!(
                f,
                "each position stands in about {rows:.0} rows, though the vehicle drives: positions were \
                 held between fixes"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bend of 40 m radius at 15 m/s, driven with the heading along the path.
    fn bend(change: impl Fn(Channel, f64) -> f64) -> TimeSeries {
        let time_s: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.02).collect();
        let rate = 15.0 / 40.0;
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        let mut add = |channel: Channel, value: &dyn Fn(f64) -> f64| {
            let values = time_s.iter().map(|t| change(channel, value(rate * t))).collect();
            series.insert(channel, values).unwrap();
        };
        add(Channel::X, &|angle| 40.0 * angle.sin());
        add(Channel::Y, &|angle| 40.0 * (1.0 - angle.cos()));
        add(Channel::Yaw, &|angle| angle);
        add(Channel::YawRate, &|_| rate);
        series
    }

    fn changed(channel: Channel, change: impl Fn(f64) -> f64) -> Vec<Contradiction> {
        contradictions(&bend(|of, value| if of == channel { change(value) } else { value }))
    }

    #[test]
    fn a_bend_contradicts_nothing() {
        assert_eq!(contradictions(&bend(|_, value| value)), []);
        // Angles between −180° and 180°, far along the circle.
        let wrapped = changed(Channel::Yaw, |yaw| wrap_angle_rad(yaw + 0.0));
        assert_eq!(wrapped, []);
    }

    #[test]
    fn a_yaw_rate_in_degrees_is_named_with_its_factor_and_its_side() {
        for (sign, words) in [(1.0, "read as radians"), (-1.0, "clockwise as counterclockwise")] {
            let found = changed(Channel::YawRate, |rate| sign * rate.to_degrees());
            let [Contradiction::YawRate { factor }] = found[..] else { panic!("{found:?}") };
            assert!((factor * 57.295_78 - sign).abs() < 1e-3, "{factor}");
            assert!(found[0].to_string().contains(words), "{}", found[0]);
        }
        let found = changed(Channel::YawRate, |rate| -rate);
        assert!(found[0].to_string().contains("one of them is clockwise"), "{found:?}");
    }

    #[test]
    fn a_compass_and_a_mirror_are_told_apart() {
        let compass = contradictions(&bend(|channel, value| match channel {
            Channel::Yaw => FRAC_PI_2 - value,
            Channel::YawRate => -value,
            _ => value,
        }));
        assert_eq!(compass, [Contradiction::Compass]);
        let mirrored = |axis| [Contradiction::Mirrored { axis }];
        assert_eq!(changed(Channel::Y, |y| -y), mirrored(Channel::Y));
        assert_eq!(changed(Channel::X, |x| -x), mirrored(Channel::X));
        let degrees = contradictions(&bend(|channel, value| match channel {
            Channel::Yaw | Channel::YawRate => value.to_degrees(),
            _ => value,
        }));
        assert!(matches!(degrees[..], [Contradiction::YawUnit { .. }]), "{degrees:?}");
        let radians = contradictions(&bend(|channel, value| match channel {
            Channel::Yaw | Channel::YawRate => value.to_radians(),
            _ => value,
        }));
        let [Contradiction::YawUnit { factor }] = radians[..] else { panic!("{radians:?}") };
        assert!((factor * 57.295_78 - 1.0).abs() < 1e-6, "{factor}");
        assert!(radians[0].to_string().contains("radians were read as degrees"), "{}", radians[0]);
    }

    /// 3.4° that are read as radians would be half a spin on a nearly straight path.
    #[test]
    fn degrees_of_a_gentle_bend_are_found() {
        let time_s: Vec<f64> = (0..150).map(|i| f64::from(i) * 0.02).collect();
        let motion = |heading: &dyn Fn(f64) -> f64| {
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            let column = |f: &dyn Fn(f64) -> f64| time_s.iter().map(|t| f(0.02 * t)).collect();
            series.insert(Channel::X, column(&|angle| 1000.0 * angle.sin())).unwrap();
            series.insert(Channel::Y, column(&|angle| 1000.0 * (1.0 - angle.cos()))).unwrap();
            series.insert(Channel::Yaw, column(heading)).unwrap();
            contradictions(&series)
        };
        let found = motion(&f64::to_degrees);
        assert!(matches!(found[..], [Contradiction::YawUnit { .. }]), "{found:?}");
        assert_eq!(motion(&|angle| angle), []);
        // A spin whose rate falls while the path bends on.
        assert_eq!(motion(&|angle| 57.3 * angle * (2.0 - 16.0 * angle)), []);
    }

    #[test]
    fn positions_that_are_held_are_found() {
        let mut series = bend(|_, value| value);
        for channel in [Channel::X, Channel::Y] {
            let values = series.get(channel).unwrap().to_vec();
            let held = (0..values.len()).map(|i| values[i / 10 * 10]).collect();
            series.insert(channel, held).unwrap();
        }
        let found = contradictions(&series);
        let [Contradiction::Held { rows }] = found[..] else { panic!("{found:?}") };
        assert!((rows - 10.0).abs() < 1e-9, "{rows}");
    }

    /// A log that begins to the east and spins right away has no bend that tells a compass.
    #[test]
    fn a_compass_is_found_before_a_spin() {
        let time_s: Vec<f64> = (0..300).map(|i| f64::from(i) * 0.01).collect();
        let motion = |heading: &dyn Fn(f64) -> f64| {
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            let column = |f: &dyn Fn(f64) -> f64| time_s.iter().map(|t| f(*t)).collect();
            series.insert(Channel::X, column(&|t| 15.0 * t)).unwrap();
            series.insert(Channel::Y, column(&|t| -0.5 * t * t)).unwrap();
            series.insert(Channel::Yaw, column(heading)).unwrap();
            contradictions(&series)
        };
        let turned = |t: f64| -1.2 * (t - 0.2).max(0.0);
        assert_eq!(motion(&turned), []);
        assert_eq!(motion(&|t| FRAC_PI_2 - turned(t)), [Contradiction::Compass]);
        // A car that reverses has its heading behind it.
        assert_eq!(motion(&|t| PI + turned(t)), []);
    }

    /// Noise of half a degree and a drift of half a degree a second are those of a usual log.
    #[test]
    fn a_straight_drive_with_noise_and_drift_contradicts_nothing() {
        let noise = |i: usize, k: f64| (k * i as f64 * i as f64).sin();
        let time_s: Vec<f64> = (0..800).map(|i| i as f64 * 0.01).collect();
        let column = |f: &dyn Fn(usize, f64) -> f64| {
            time_s.iter().enumerate().map(|(i, t)| f(i, *t)).collect::<Vec<f64>>()
        };
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        for (channel, values) in [
            (Channel::X, column(&|i, t| 15.0 * t + 0.02 * noise(i, 1.3))),
            (Channel::Y, column(&|i, _| 0.02 * noise(i, 0.7))),
            (Channel::Yaw, column(&|i, _| 0.012 * noise(i, 2.1))),
            (Channel::YawRate, column(&|i, _| 0.009 + 0.02 * noise(i, 0.9))),
        ] {
            series.insert(channel, values).unwrap();
        }
        assert_eq!(contradictions(&series), []);
        // Places to 0.1 m, at 100 Hz and 4 m/s: one of them stands in two or three rows.
        let coarse = column(&|_, t| (40.0 * t).round() / 10.0);
        series.insert(Channel::X, coarse).unwrap();
        series.insert(Channel::Y, vec![0.0; time_s.len()]).unwrap();
        assert_eq!(contradictions(&series), []);
    }

    #[test]
    fn a_yaw_rate_that_is_nothing_at_all_is_no_yaw_rate() {
        assert_eq!(changed(Channel::YawRate, |_| 0.0), [Contradiction::YawRateUnrelated]);
    }

    /// A car that spins goes on along its path while its heading turns: no contradiction.
    #[test]
    fn a_spin_contradicts_nothing() {
        let time_s: Vec<f64> = (0..300).map(|i| f64::from(i) * 0.01).collect();
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        let values = |f: &dyn Fn(f64) -> f64| time_s.iter().map(|t| f(*t)).collect::<Vec<f64>>();
        for (channel, column) in [
            (Channel::X, values(&|t| 20.0 * t - 2.5 * t * t)),
            (Channel::Y, values(&|t| 0.6 * t * t)),
            (Channel::Yaw, values(&|t| 2.0 * t - 0.2 * t * t)),
            (Channel::YawRate, values(&|t| 2.0 - 0.4 * t)),
        ] {
            series.insert(channel, column).unwrap();
        }
        assert_eq!(contradictions(&series), []);
    }
}
