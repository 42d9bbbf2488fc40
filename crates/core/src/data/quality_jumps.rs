//! Checks of the columns of a motion for numbers that stand for none, such as −999, and for rows in which a sensor had
//! dropped out: steps from one row to the next that no vehicle, driver or crash makes, or that go back at once.
//!
//! The limits were set on the shipped data (1469 motions and records of controls), of which none exceeds them. Components
//! of a velocity in body axes change with every turn of a spin, so that their size is looked at.

use crate::data::yaw_rate::{MOVING_M_S, speed_m_s};
use crate::data::{Channel, Flag, FlagKind, Severity, TimeSeries};

/// Step of time from which rows are those of a log, s; a node of a finite-element model shakes from row to row.
const LEAST_STEP_S: f64 = 5e-4;
/// Time and number of rows within which a step goes back.
const BACK_S: f64 = 1.0;
const BACK_ROWS: usize = 50;
/// Share of a step that may be left when it has gone back.
const LEFT: f64 = 0.5;

/// The largest step of a quantity over a step of time: a size, and a rate.
struct Limits {
    /// Of one that stays.
    alone: [f64; 2],
    /// Of one that goes back.
    back: [f64; 2],
}

/// 50 g of a crash; what tires do and some.
const SPEED: Limits = Limits { alone: [5.0, 490.0], back: [5.0, 20.0] };
const FORWARD_SPEED: Limits = Limits { alone: [5.0, 490.0], back: [5.0, 490.0] };
const YAW_RATE: Limits = Limits { alone: [2.0, 500.0], back: [2.0, 30.0] };
const YAW: Limits = Limits { alone: [0.5, 50.0], back: [0.3, 15.0] };
/// A step of the steering that stays may be meant.
const ROAD_WHEEL: Limits = Limits { alone: [0.6, 4.0], back: [0.1, 4.0] };
const STEERING_WHEEL: Limits = Limits { alone: [8.0, 40.0], back: [0.5, 25.0] };

/// A quantity over time.
struct Curve<'a> {
    kind: FlagKind,
    values: Option<Vec<f64>>,
    limits: Limits,
    /// Whether the value of a row is one.
    is_known: &'a dyn Fn(usize) -> bool,
}

/// Finds the largest step of each quantity that is beyond its limits.
pub(super) fn check_jumps(series: &TimeSeries) -> Vec<Flag> {
    let of = |channel| series.get(channel).map(<[f64]>::to_vec);
    let velocity = of(Channel::Vx).zip(of(Channel::Vy));
    let size = |(vx, vy): (Vec<f64>, Vec<f64>)| -> Vec<f64> {
        vx.iter().zip(&vy).map(|(x, y)| x.hypot(*y)).collect()
    };
    let forward = of(Channel::Vx).filter(|_| velocity.is_none());
    let always = |_: usize| true;
    let moves = moving_rows(series);
    let is_moving = |row: usize| moves.get(row).copied().unwrap_or(true);
    let curve = |kind, values, limits| Curve { kind, values, limits, is_known: &always };
    let curves = [
        curve(FlagKind::SpeedJump, of(Channel::Speed), SPEED),
        curve(FlagKind::SpeedJump, velocity.map(size), SPEED),
        curve(FlagKind::SpeedJump, forward, FORWARD_SPEED),
        curve(FlagKind::YawRateJump, of(Channel::YawRate), YAW_RATE),
        // The course of a receiver at rest is noise.
        Curve { is_known: &is_moving, ..curve(FlagKind::YawJump, of(Channel::Yaw), YAW) },
        curve(FlagKind::SteerJump, of(Channel::Steer), ROAD_WHEEL),
        curve(FlagKind::SteerJump, of(Channel::SteerFl), ROAD_WHEEL),
        curve(FlagKind::SteerJump, of(Channel::SteerFr), ROAD_WHEEL),
        curve(FlagKind::SteerJump, of(Channel::SteeringWheel), STEERING_WHEEL),
    ];
    let flag = |Curve { kind, values, limits, is_known }: Curve<'_>| {
        let (value, time_s) = largest_jump(series.time_s(), &values?, &limits, is_known)?;
        let (severity, limit) = (Severity::Warning, limits.alone[0]);
        Some(Flag { kind, severity, value, limit, time_s: Some(time_s) })
    };
    curves.into_iter().filter_map(flag).collect()
}

/// Whether the vehicle moves in each row, by its speed or else by its path; empty where neither is recorded.
fn moving_rows(series: &TimeSeries) -> Vec<bool> {
    if let Some(speed_m_s) = speed_m_s(series) {
        return speed_m_s.iter().map(|speed| *speed >= MOVING_M_S).collect();
    }
    let time_s = series.time_s();
    let Some((x, y)) = series.get(Channel::X).zip(series.get(Channel::Y)) else {
        return Vec::new();
    };
    let last = time_s.len().saturating_sub(2);
    let moves = |row: usize| {
        let at = row.min(last);
        let moved_m = (x[at + 1] - x[at]).hypot(y[at + 1] - y[at]);
        moved_m >= MOVING_M_S * (time_s[at + 1] - time_s[at])
    };
    if time_s.len() < 2 { Vec::new() } else { (0..time_s.len()).map(moves).collect() }
}

/// Size and instant of the largest step beyond the limits.
///
/// - `is_known`: whether the value of a row is one.
fn largest_jump(
    time_s: &[f64],
    values: &[f64],
    limits: &Limits,
    is_known: &dyn Fn(usize) -> bool,
) -> Option<(f64, f64)> {
    let n_steps = values.len().min(time_s.len()).saturating_sub(1);
    let step = |at: usize| (time_s[at + 1] - time_s[at], values[at + 1] - values[at]);
    let is_beyond = |[base, rate]: [f64; 2], at: usize| {
        let (duration_s, size) = step(at);
        duration_s >= LEAST_STEP_S && size.abs() > base + rate * duration_s
    };
    let goes_back = |at: usize| {
        let (_, first) = step(at);
        let mut sum = first;
        for later in at + 1..(at + 1 + BACK_ROWS).min(n_steps) {
            let (_, size) = step(later);
            sum += size;
            if time_s[later] - time_s[at] > BACK_S {
                return false;
            }
            let is_back = size * first < 0.0 && sum.abs() < LEFT * first.abs();
            if is_back && is_beyond(limits.back, later) {
                return true;
            }
        }
        false
    };
    let jumps = (0..n_steps)
        .filter(|at| is_known(*at) && is_known(at + 1))
        .filter(|at| is_beyond(limits.alone, *at) || is_beyond(limits.back, *at) && goes_back(*at));
    let sizes = jumps.map(|at| (step(at).1.abs(), time_s[at]));
    sizes.max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four seconds at 50 rows a second: a bend at 15 m/s.
    fn drive(change: impl Fn(Channel, usize, f64) -> f64) -> Vec<FlagKind> {
        let time_s: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.02).collect();
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        let curves: [(Channel, &dyn Fn(f64) -> f64); 7] = [
            (Channel::X, &|t: f64| 50.0 * (0.3 * t).sin()),
            (Channel::Y, &|t: f64| 50.0 * (1.0 - (0.3 * t).cos())),
            (Channel::Yaw, &|t: f64| 0.3 * t),
            (Channel::Vx, &|_: f64| 15.0),
            (Channel::Vy, &|_: f64| 0.0),
            (Channel::YawRate, &|_: f64| 0.3),
            (Channel::SteeringWheel, &|t: f64| t.sin()),
        ];
        for (channel, value) in curves {
            let rows = time_s.iter().enumerate();
            let values = rows.map(|(row, t)| change(channel, row, value(*t))).collect();
            series.insert(channel, values).unwrap();
        }
        check_jumps(&series).into_iter().map(|flag| flag.kind).collect()
    }

    #[test]
    fn numbers_that_stand_for_none_are_flagged() {
        assert_eq!(drive(|_, _, value| value), []);
        for (channel, none, kind) in [
            (Channel::Vx, -99.0, FlagKind::SpeedJump),
            (Channel::Vx, 0.0, FlagKind::SpeedJump),
            (Channel::Yaw, -999_f64.to_radians(), FlagKind::YawJump),
            (Channel::YawRate, -999_f64.to_radians(), FlagKind::YawRateJump),
            (Channel::SteeringWheel, -999_f64.to_radians(), FlagKind::SteerJump),
            (Channel::SteeringWheel, -99_f64.to_radians(), FlagKind::SteerJump),
        ] {
            for lost in [50..51, 50..55] {
                let change = |of: Channel, row: usize, value: f64| match of == channel {
                    true if lost.contains(&row) => none,
                    _ => value,
                };
                assert_eq!(drive(change), [kind], "{channel:?} {none}");
            }
        }
    }

    #[test]
    fn a_crash_a_step_of_the_steering_and_a_spin_are_none() {
        // 20 g over 0.1 s, and 0.2 rad of the road wheels at once.
        let crash = drive(|channel, row, value| match channel {
            Channel::Vx => value - 0.2 * 9.81 * 2.0 * (row.clamp(50, 55) - 50) as f64,
            _ => value,
        });
        assert_eq!(crash, []);
        let step = drive(|channel, row, value| match channel {
            Channel::SteeringWheel if row >= 50 => value + 3.0,
            _ => value,
        });
        assert_eq!(step, []);
        // A light car that turns by 10 rad/s: its components change by 3 m/s from row to row.
        let spin = drive(|channel, row, value| {
            let angle = 10.0 * 0.02 * row as f64;
            match channel {
                Channel::Vx => 15.0 * angle.cos(),
                Channel::Vy => -15.0 * angle.sin(),
                Channel::YawRate => 10.0,
                Channel::Yaw => angle,
                _ => value,
            }
        });
        assert_eq!(spin, []);
    }
}
