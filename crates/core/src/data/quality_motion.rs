//! Checks of the path of a single file: places that no vehicle reaches from one row to the next, and a path along
//! which none would take so long, or so short a time.

use std::f64::consts::PI;

use crate::data::yaw_rate::{MOVING_M_S, speed_m_s};
use crate::data::{Channel, Flag, FlagKind, Severity, TimeSeries};
use crate::ranges::SPEED;

/// Distance between two rows that noise and places held between fixes may have beyond that of the fastest
/// vehicle, m.
const JUMP_M: f64 = 10.0;
/// Speed that any vehicle has somewhere which was recorded because of a collision, m/s.
const SLOW_M_S: f64 = 0.5;
/// Length of the path from which its speed is looked at, m.
const SLOW_PATH_M: f64 = 5.0;
/// Turn from one row to the next from which it may as well be one to the other side, rad: 0.55 of half a turn.
const YAW_STEP_RAD: f64 = 0.55 * PI;
/// Parts of a path over which its speed is taken, so that noise of positions does not count.
const N_PARTS: usize = 24;

/// Checks the path of a motion; nothing is found in a file without one.
pub(super) fn check_path(series: &TimeSeries) -> Vec<Flag> {
    let Some((x, y)) = series.get(Channel::X).zip(series.get(Channel::Y)) else {
        return Vec::new();
    };
    let places: Vec<(f64, [f64; 2])> =
        series.time_s().iter().zip(x.iter().zip(y)).map(|(t, (x, y))| (*t, [*x, *y])).collect();
    jump(&places).or_else(|| of_parts(&places)).into_iter().collect()
}

/// Checks the yaw angle of a motion without a yaw rate; what is between two rows at rest is noise of a course.
pub(super) fn check_yaw(series: &TimeSeries) -> Option<Flag> {
    let yaw_rad = series.get(Channel::Yaw).filter(|_| series.get(Channel::YawRate).is_none())?;
    let speed_m_s = speed_m_s(series);
    let is_moving = |row: usize| {
        speed_m_s.as_ref().is_none_or(|of| of.get(row).is_some_and(|speed| *speed >= MOVING_M_S))
    };
    let rows = yaw_rad.iter().zip(yaw_rad.iter().skip(1)).zip(series.time_s()).enumerate();
    let steps = rows.filter(|(row, _)| is_moving(*row) && is_moving(row + 1));
    let steps = steps.map(|(_, ((from, to), time_s))| ((to - from).abs(), *time_s));
    // An angle that turns further has counted its turns.
    let (value, time_s) =
        steps.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(step, _)| *step <= PI)?;
    let (kind, severity) = (FlagKind::YawStep, Severity::Warning);
    let flag = Flag { kind, severity, value, limit: YAW_STEP_RAD, time_s: Some(time_s) };
    (value > YAW_STEP_RAD).then_some(flag)
}

/// Time and distance from one place to another.
fn step((t0, [x0, y0]): (f64, [f64; 2]), (t1, [x1, y1]): (f64, [f64; 2])) -> (f64, f64) {
    (t1 - t0, (x1 - x0).hypot(y1 - y0))
}

/// The largest distance between two rows that is beyond any vehicle.
fn jump(places: &[(f64, [f64; 2])]) -> Option<Flag> {
    let steps = places.iter().zip(places.iter().skip(1)).map(|(a, b)| (b.0, step(*a, *b)));
    let far = steps.filter(|(_, (duration_s, way_m))| *way_m > JUMP_M + SPEED.high * duration_s);
    let (time_s, (_, value)) = far.max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
    let (kind, severity) = (FlagKind::PathJump, Severity::Warning);
    Some(Flag { kind, severity, value, limit: JUMP_M, time_s: Some(time_s) })
}

/// The largest speed over a part of a path, if the path is nowhere faster than a car is pushed by hand, or faster than
/// any vehicle by a few metres a row.
fn of_parts(places: &[(f64, [f64; 2])]) -> Option<Flag> {
    let n_steps = places.len().checked_sub(1).filter(|n| *n > 0)?;
    let n_parts = N_PARTS.min(n_steps);
    let ends: Vec<(f64, [f64; 2])> =
        (0..=n_parts).filter_map(|i| places.get(i * n_steps / n_parts)).copied().collect();
    let parts = || ends.iter().zip(ends.iter().skip(1)).map(|(a, b)| step(*a, *b));
    let (duration_s, way_m) = parts().fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1));
    let fastest_m_s = parts().map(|(duration_s, way_m)| way_m / duration_s).fold(0.0, f64::max);
    let severity = Severity::Warning;
    let flag = |kind, value, limit| Some(Flag { kind, severity, value, limit, time_s: None });
    match () {
        () if way_m <= SLOW_PATH_M => None,
        () if fastest_m_s < SLOW_M_S => flag(FlagKind::SlowPath, fastest_m_s, SLOW_M_S),
        () if way_m > SPEED.high * duration_s => {
            flag(FlagKind::FastPath, way_m / duration_s, SPEED.high)
        }
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{counted_turns_rad, wrap_angle_rad};

    /// Three seconds at 20 m/s to the east.
    fn drive(time: impl Fn(f64) -> f64, place: impl Fn(usize, f64) -> f64) -> Vec<FlagKind> {
        let clock: Vec<f64> = (0..150).map(|i| f64::from(i) * 0.02).collect();
        let mut series = TimeSeries::new(clock.iter().map(|t| time(*t)).collect()).unwrap();
        let x = clock.iter().enumerate().map(|(i, t)| place(i, 20.0 * t)).collect();
        series.insert(Channel::X, x).unwrap();
        series.insert(Channel::Y, vec![0.0; clock.len()]).unwrap();
        check_path(&series).iter().map(|flag| flag.kind).collect()
    }

    #[test]
    fn a_place_that_stands_for_none_and_a_clock_in_milliseconds_are_flagged() {
        assert_eq!(drive(|t| t, |_, x| x), []);
        let no_fix = |i: usize, x: f64| if (50..53).contains(&i) { -9999.0 } else { x };
        assert_eq!(drive(|t| t, no_fix), [FlagKind::PathJump]);
        assert_eq!(drive(|t| t, |_, x| 1e3 * x), [FlagKind::PathJump]);
        assert_eq!(drive(|t| 1e3 * t, |_, x| x), [FlagKind::SlowPath]);
        // Seconds that are read as milliseconds, and the days of a spreadsheet as seconds.
        assert_eq!(drive(|t| 1e-3 * t, |_, x| x), [FlagKind::FastPath]);
        assert_eq!(drive(|t| 46_351.0 + t / 86_400.0, |_, x| x), [FlagKind::FastPath]);
    }

    /// A spin of 458 deg/s, recorded within one turn.
    #[test]
    fn a_spin_that_turns_on_by_half_between_rows_is_flagged() {
        let flag = |step_s: f64, speed_m_s: f64, has_rate: bool| {
            let time_s: Vec<f64> = (0..20).map(|i| f64::from(i) * step_s).collect();
            let yaw = time_s.iter().map(|t| wrap_angle_rad(8.0 * t)).collect();
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            series.insert(Channel::Yaw, counted_turns_rad(yaw)).unwrap();
            series.insert(Channel::Speed, vec![speed_m_s; time_s.len()]).unwrap();
            if has_rate {
                series.insert(Channel::YawRate, vec![8.0; time_s.len()]).unwrap();
            }
            check_yaw(&series).map(|flag| flag.kind)
        };
        assert_eq!(flag(0.1, 10.0, false), None);
        assert_eq!(flag(0.5, 10.0, false), Some(FlagKind::YawStep));
        // A course of a receiver at rest, and a yaw rate, with which the angle is compared.
        assert_eq!(flag(0.5, 0.1, false), None);
        assert_eq!(flag(0.5, 10.0, true), None);
    }

    #[test]
    fn noise_held_places_and_a_car_that_stands_are_not_flagged() {
        assert_eq!(drive(|t| t, |i, x| x + 3.0 * (1.3 * (i * i) as f64).sin()), []);
        assert_eq!(drive(|t| t, |i, _| 0.4 * (i / 10 * 10) as f64), []);
        assert_eq!(drive(|t| 1e3 * t, |_, _| 7.0), []);
        assert_eq!(drive(|t| 10.0 * t, |_, x| if x > 40.0 { x - 40.0 } else { 0.0 }), []);
    }
}
