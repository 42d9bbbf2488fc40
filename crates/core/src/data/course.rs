//! What the course of a path says of the yaw angle beside it: whether it turns with the path or against it, and how far
//! it is off.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::data::consistency::held_positions;
use crate::data::yaw_rate::{MOVING_M_S, speed_m_s};
use crate::data::{Channel, Contradiction, Note, TimeSeries};
use crate::numerics::{continued_rad, wrap_angle_rad};

/// Windows into which a motion is divided.
const N_WINDOWS: usize = 24;
/// Speed from which the direction of motion is known from positions, m/s.
pub(super) const DRIVING_M_S: f64 = 3.0;
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
/// Slowing from which a vehicle may slide across its heading, m/s²: that of ice. One that does not slow down so
/// rolls along its heading.
const SLIDING_M_S2: f64 = 1.0;

/// Mean speed above which no car drives backwards, m/s: the reverse gear ends at about 45 km/h.
const FASTEST_BACKWARDS_M_S: f64 = 12.5;

/// What the course of a path says of the yaw angle.
pub(super) enum OfCourse {
    /// It contradicts it.
    Contradiction(Contradiction),
    /// The yaw angle keeps to it, and is so far to its left, rad.
    Along(f64),
    /// Nothing: the vehicle does not drive, does not turn, or spins.
    Open,
}

/// Indices of the ends of the windows.
fn windows(n_samples: usize) -> Option<impl Iterator<Item = (usize, usize)>> {
    let n_steps = n_samples.checked_sub(1).filter(|n| *n >= N_WINDOWS)?;
    Some((0..N_WINDOWS).map(move |i| (i * n_steps / N_WINDOWS, (i + 1) * n_steps / N_WINDOWS)))
}

/// What a path has while the vehicle drives.
struct Courses {
    /// Course and heading in the middle of each window.
    pairs: Vec<(f64, f64)>,
    /// By how much it becomes slower from the first of them to the last, m/s².
    slowing_m_s2: f64,
}

impl Courses {
    /// Whether the vehicle may slide across its heading: it slows down as tires that do not roll make it.
    fn may_slide(&self) -> bool {
        self.slowing_m_s2 >= SLIDING_M_S2
    }

    /// How far the heading is to the left of the course, rad, where the vehicle may slide across it in every window.
    fn slide_rad(&self) -> Option<f64> {
        let angle = |(course, yaw): &(f64, f64)| wrap_angle_rad(yaw - course);
        let first_rad = angle(self.pairs.first()?);
        let is_alike = |pair| wrap_angle_rad(angle(pair) - first_rad).abs() < RELATION_RAD;
        let is_one = is_quarter(first_rad) && self.pairs.iter().all(is_alike);
        (self.may_slide() && is_one).then_some(first_rad)
    }
}

fn courses(series: &TimeSeries) -> Option<Courses> {
    let time_s = series.time_s();
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let yaw_rad = continued_rad(series.get(Channel::Yaw)?);
    let speed = speed_m_s(series);
    let is_moving = |i: usize| speed.as_ref().is_none_or(|speed| speed[i] >= MOVING_M_S);
    let (mut pairs, mut speeds) = (Vec::new(), Vec::new());
    for (from, to) in windows(time_s.len())?.filter(|(from, to)| is_moving(*from) && is_moving(*to))
    {
        let moved_m = [x[to] - x[from], y[to] - y[from]];
        let duration_s = time_s[to] - time_s[from];
        let way_m = moved_m[0].hypot(moved_m[1]);
        if way_m < DRIVING_M_S * duration_s {
            continue;
        }
        pairs.push((moved_m[1].atan2(moved_m[0]), (yaw_rad[from] + yaw_rad[to]) / 2.0));
        speeds.push(((time_s[from] + time_s[to]) / 2.0, way_m / duration_s));
    }
    let slowing_m_s2 = match speeds[..] {
        [(first_s, fast_m_s), .., (last_s, slow_m_s)] => (fast_m_s - slow_m_s) / (last_s - first_s),
        _ => 0.0,
    };
    Some(Courses { pairs, slowing_m_s2 })
}

/// Whether an angle is a right one, to either side.
fn is_quarter(angle_rad: f64) -> bool {
    (wrap_angle_rad(angle_rad).abs() - FRAC_PI_2).abs() < 2.0 * RELATION_RAD
}

/// What a yaw angle is that stands at a right angle to the motion as that of a compass would.
///
/// - `angle_rad`: how far it is to the left of the direction of motion.
fn compass_or_offset(angle_rad: f64) -> Contradiction {
    match is_quarter(angle_rad) {
        true => Contradiction::CompassOrOffset { angle_rad },
        false => Contradiction::Compass,
    }
}

/// Compares the course with the yaw angle wherever the vehicle drives.
pub(super) fn against_path(series: &TimeSeries) -> OfCourse {
    let Some(courses) = courses(series) else { return OfCourse::Open };
    if courses.pairs.len() < N_WINDOWS / 4 {
        return courses.slide_rad().map_or(OfCourse::Open, OfCourse::Along);
    }
    let (pairs, may_slide) = (&courses.pairs, courses.may_slide());
    let course_rad = continued_rad(&pairs.iter().map(|(course, _)| *course).collect::<Vec<_>>());
    let turned = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
    };
    let found = |of: Option<Contradiction>| of.map_or(OfCourse::Open, OfCourse::Contradiction);
    let course_turn = turned(&course_rad);
    let in_degrees = yaw_unit(&course_rad, pairs, course_turn);
    // A relation `course − sign · ψ = constant`, with the constant and how far it is off at most.
    let relation = |sign: f64| {
        let off: Vec<f64> =
            course_rad.iter().zip(pairs).map(|(course, (_, yaw))| course - sign * yaw).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        (mean, off.iter().map(|off| (off - mean).abs()).fold(0.0, f64::max))
    };
    let [(behind, along), (sum, against)] = [relation(1.0), relation(-1.0)];
    let angle_rad = wrap_angle_rad(-behind);
    let is = |angle_rad: f64| wrap_angle_rad(sum - angle_rad).abs() < 2.0 * RELATION_RAD;
    let is_across = along < RELATION_RAD && is_quarter(angle_rad);
    if course_turn < LEAST_COURSE_TURN_RAD {
        return match in_degrees {
            None if is_across && may_slide => OfCourse::Along(angle_rad),
            None if is_across && is(FRAC_PI_2) => found(Some(compass_or_offset(angle_rad))),
            None if is_across => found(Some(Contradiction::Offset { angle_rad })),
            in_degrees => found(in_degrees),
        };
    }
    if along < RELATION_RAD {
        // No slide turns with a bend.
        return match is_across {
            true => OfCourse::Contradiction(Contradiction::Offset { angle_rad }),
            false => OfCourse::Along(angle_rad),
        };
    }
    if along < against / 2.0 {
        return OfCourse::Open;
    }
    if against < RELATION_RAD {
        return found(match () {
            () if is(FRAC_PI_2) => Some(Contradiction::Compass),
            () if is(0.0) => Some(Contradiction::Mirrored { axis: Channel::Y }),
            () if is(PI) => Some(Contradiction::Mirrored { axis: Channel::X }),
            () => None,
        });
    }
    found(in_degrees)
}

/// That a yaw angle keeps to the path at an angle to it all along, as that of a car that slides or drifts or one that is
/// counted from another axis. Where there is a lateral velocity, that is compared instead.
pub(super) fn offset_note(series: &TimeSeries) -> Option<Note> {
    if series.get(Channel::Vy).is_some() || held_positions(series).is_some() {
        return None;
    }
    let OfCourse::Along(angle_rad) = against_path(series) else { return None };
    let is_off = (LEAST_OFF_RAD..PI - LEAST_OFF_RAD).contains(&angle_rad.abs());
    is_off.then(|| Note::Doubt {
        text: format!(
            "the yaw angle is {} of the direction in which the vehicle moves, all along: the vehicle slides or drifts, \
             or the angle is counted from another axis (map yaw_offset={:.0}:deg)",
            to_a_side(angle_rad),
            -angle_rad.to_degrees()
        ),
    })
}

/// That a vehicle drives backwards all along and faster than cars do: its yaw angle may be that of its rear. A forward
/// velocity says itself which way it drives.
pub(super) fn backwards_note(series: &TimeSeries) -> Option<Note> {
    if series.get(Channel::Vx).is_some() || held_positions(series).is_some() {
        return None;
    }
    let pairs = courses(series)?.pairs;
    let is_backwards =
        |(course, yaw): &(f64, f64)| wrap_angle_rad(yaw - course).abs() > PI - LEAST_OFF_RAD;
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let steps = x.windows(2).zip(y.windows(2));
    let way_m: f64 = steps.map(|(x, y)| (x[1] - x[0]).hypot(y[1] - y[0])).sum();
    let speed_m_s = way_m / (series.time_s().last()? - series.time_s().first()?);
    let is_all = pairs.len() >= N_WINDOWS / 4 && pairs.iter().all(is_backwards);
    (is_all && speed_m_s > FASTEST_BACKWARDS_M_S).then(|| Note::Doubt {
        text: format!(
            "the vehicle drives backwards all along, at {speed_m_s:.0} m/s on average: if it drives forwards, map \
             yaw_offset=180:deg"
        ),
    })
}

/// That a yaw rate without a yaw angle beside it is to the other side than the path turns, or in another unit. What spins
/// keeps to none of these relations while its path turns.
pub(super) fn yaw_rate_note(series: &TimeSeries) -> Option<Note> {
    if series.get(Channel::Yaw).is_some() || held_positions(series).is_some() {
        return None;
    }
    let (time_s, rate) = (series.time_s(), series.get(Channel::YawRate)?);
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let mut by_rate_rad = vec![0.0];
    for (times, rates) in time_s.windows(2).zip(rate.windows(2)) {
        let turned = by_rate_rad.last().copied().unwrap_or_default();
        by_rate_rad.push(turned + (times[1] - times[0]) * (rates[0] + rates[1]) / 2.0);
    }
    let way = |(from, to): &(usize, usize)| (x[*to] - x[*from]).hypot(y[*to] - y[*from]);
    let is_driving = |of: &(usize, usize)| way(of) >= DRIVING_M_S * (time_s[of.1] - time_s[of.0]);
    let driven: Vec<(usize, usize)> = windows(time_s.len())?.filter(is_driving).collect();
    let course_rad = driven.iter().map(|&(from, to)| (y[to] - y[from]).atan2(x[to] - x[from]));
    let course_rad = continued_rad(&course_rad.collect::<Vec<_>>());
    let by_rate = driven.iter().map(|&(from, to)| (by_rate_rad[from] + by_rate_rad[to]) / 2.0);
    let by_rate: Vec<f64> = by_rate.collect();
    let low = course_rad.iter().copied().fold(f64::INFINITY, f64::min);
    let turn_rad = course_rad.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
    if driven.len() < N_WINDOWS / 4 || turn_rad < LEAST_COURSE_TURN_RAD {
        return None;
    }
    let reach = RELATION_RAD.min(UNIT_SHARE_OF_TURN * turn_rad);
    let is_factor = |factor: f64| {
        let off: Vec<f64> =
            course_rad.iter().zip(&by_rate).map(|(course, rate)| course - rate / factor).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        off.iter().all(|off| (off - mean).abs() < reach)
    };
    let (degrees, radians) = (1.0_f64.to_degrees(), 1.0_f64.to_radians());
    let (_, words) = [
        (-1.0, "to the other side than the path turns: it may be positive clockwise"),
        (degrees, "57 times what the path turns by, as if degrees were read as radians"),
        (
            -degrees,
            "-57 times what the path turns by, as of degrees clockwise that were read as radians",
        ),
        (radians, "1/57 of what the path turns by, as if radians were read as degrees"),
        (
            -radians,
            "-1/57 of what the path turns by, as of radians clockwise that were read as degrees",
        ),
    ]
    .into_iter()
    .find(|(factor, _)| is_factor(*factor))?;
    Some(Note::Doubt { text: format!("the yaw rate is {words}; map it with its sign and unit") })
}

/// The direction of the first metre, over which a vehicle that does not turn moves along its heading. One that
/// slides or drives backwards may not; that its heading is just that of a compass is no chance.
pub(super) fn at_the_start(series: &TimeSeries) -> Option<Contradiction> {
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
    let angle_rad = wrap_angle_rad(heading_rad - course_rad);
    let is_off = (LEAST_OFF_RAD..PI - LEAST_OFF_RAD).contains(&angle_rad.abs());
    (is_off && is_compass).then(|| compass_or_offset(angle_rad))
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

/// An angle to the left of something, in words: `90 deg to the left`.
pub(super) fn to_a_side(angle_rad: f64) -> String {
    let side = if angle_rad > 0.0 { "left" } else { "right" };
    format!("{:.0} deg to the {side}", angle_rad.to_degrees().abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without a yaw angle the yaw rate is compared with the turn of the path.
    #[test]
    fn a_yaw_rate_alone_is_compared_with_the_path() {
        let said = |change: &dyn Fn(f64) -> f64| {
            // A bend of 40 m radius at 15 m/s.
            let time_s: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.02).collect();
            let rate = 15.0 / 40.0;
            let column = |f: &dyn Fn(f64) -> f64| time_s.iter().map(|t| f(rate * t)).collect();
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            series.insert(Channel::X, column(&|angle| 40.0 * angle.sin())).unwrap();
            series.insert(Channel::Y, column(&|angle| 40.0 * (1.0 - angle.cos()))).unwrap();
            series.insert(Channel::YawRate, column(&|_| change(rate))).unwrap();
            yaw_rate_note(&series).map(|note| note.to_string())
        };
        assert_eq!(said(&|rate| rate), None);
        // A spin, and a slide that goes straight on.
        assert_eq!(said(&|rate| 6.0 * rate), None);
        assert_eq!(said(&|_| 0.0), None);
        for (change, words) in [
            (-1.0, "clockwise"),
            (57.295_78, "degrees were read as radians"),
            (-57.295_78, "degrees clockwise"),
            (1.0 / 57.295_78, "radians were read as degrees"),
        ] {
            let text = said(&|rate| change * rate).unwrap();
            assert!(text.contains(words), "{change}: {text}");
        }
    }
}
