//! Signals of one motion that do not go together in side, in time or in size: a steering that counts to the other side, a
//! yaw rate that follows the yaw angle late, one that is cut off at the limit of its sensor, a yaw angle that is held, and
//! an acceleration whose unit is another than its speed has.

use std::collections::BTreeMap;

use crate::data::course::DRIVING_M_S;
use crate::data::error::quoted;
use crate::data::quality::held_peak;
use crate::data::{Channel, ColumnUse, Note, TimeSeries};
use crate::numerics::{continued_rad, quantile_of_sorted, wrap_angle_rad};
use crate::units::{STANDARD_GRAVITY_M_S2, three_digits};

/// Duration of a window over which steering and turn are compared, s, and the least number of them.
const WINDOW_S: f64 = 0.5;
const LEAST_WINDOWS: usize = 10;
/// Angle between heading and path up to which a car does not slide, and its steering turns it, rad. Of 494 motions after
/// impacts, whose drivers countersteer, none is against its steering so; within 0.15 rad and six windows two are.
const ALONG_RAD: f64 = 0.1;
/// Turn in all from which a side is known, rad.
const LEAST_TURN_RAD: f64 = 0.3;
/// Correlation of steering and turn below which they are against each other.
const AGAINST: f64 = -0.8;

/// Delays that are looked for, s, and the most samples that they have.
const DELAYS_S: std::ops::Range<f64> = 0.04..1.5;
const MOST_DELAYED: usize = 2000;
/// Rows that are compared for each of them, about.
const COMPARED_ROWS: usize = 1000;
/// Difference of yaw angle and integral of the yaw rate from which a delay matters, rad, and the share of it that remains
/// where it is the reason.
const DELAYED_RAD: f64 = 0.02;
const REMAINING: f64 = 0.3;

/// Rows at the largest yaw rate from which it may be a limit, and how much farther the yaw angle then turns.
const ROWS_AT_LIMIT: usize = 5;
const FARTHER: f64 = 1.15;
const FARTHER_RAD: f64 = 0.05;

/// Yaw rate from which one that stays at its largest value without a yaw angle beside it is at a limit, rad/s: the sensors
/// of stability systems end at 75 to 100 deg/s and more, and a steady drive is slower.
const LEAST_LIMIT_RAD_S: f64 = 1.0;

/// Rows over which a yaw angle stays as it is, and by how much and how fast the car turns there by its yaw rate: more
/// than an angle in whole degrees leaves out and than a gyroscope drifts by.
const HELD_ROWS: usize = 5;
const HELD_TURN_RAD: f64 = 0.05;
const HELD_RATE_RAD_S: f64 = 0.1;

/// Factor by which an acceleration in g that is read in m/s² misses that of the speed, what is left of the speed with it,
/// and the changes of speed from which both are compared, m/s, each about their means.
const G_FACTORS: std::ops::Range<f64> = 0.75 * STANDARD_GRAVITY_M_S2..1.3 * STANDARD_GRAVITY_M_S2;
const LEFT_WITH_G: f64 = 0.3;
const LEAST_SPEED_M_S: f64 = 0.5;

/// What is in doubt about the signals of a motion.
pub(super) fn notes(
    by_channel: &BTreeMap<Channel, ColumnUse>,
    series: &TimeSeries,
) -> impl Iterator<Item = Note> {
    let texts = [
        steering_side(by_channel, series),
        late_yaw_rate(series),
        cut_yaw_rate(series),
        cut_yaw_rate_alone(series),
        held_yaw(series),
        acceleration_in_g(by_channel, series),
    ];
    texts.into_iter().flatten().map(|text| Note::Doubt { text })
}

/// That a car turns to the other side than it is steered wherever it drives without sliding.
fn steering_side(by_channel: &BTreeMap<Channel, ColumnUse>, series: &TimeSeries) -> Option<String> {
    let steering = [Channel::SteeringWheel, Channel::Steer];
    let (channel, steer) = steering.into_iter().find_map(|of| Some((of, series.get(of)?)))?;
    let column = by_channel.get(&channel)?;
    let [term] = column.terms[..] else { return None };
    let yaw = continued_rad(series.get(Channel::Yaw)?);
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let time_s = series.time_s();
    let (mut product, mut of_steer, mut of_turn) = (0.0, 0.0, 0.0);
    let (mut turn_rad, mut n_windows, mut from) = (0.0, 0, 0);
    for to in 1..time_s.len() {
        let duration_s = time_s[to] - time_s[from];
        if duration_s < WINDOW_S {
            continue;
        }
        let way_m = [x[to] - x[from], y[to] - y[from]];
        let course_rad = way_m[1].atan2(way_m[0]);
        let slip_rad = wrap_angle_rad(course_rad - (yaw[from] + yaw[to]) / 2.0);
        let is_driving = way_m[0].hypot(way_m[1]) >= DRIVING_M_S * duration_s;
        if is_driving && slip_rad.abs() < ALONG_RAD {
            let turned = yaw[to] - yaw[from];
            let steered = steer[from..to].iter().sum::<f64>() / (to - from) as f64;
            product += steered * turned;
            of_steer += steered * steered;
            of_turn += turned * turned;
            turn_rad += turned.abs();
            n_windows += 1;
        }
        from = to;
    }
    let is_against = product < AGAINST * (of_steer * of_turn).sqrt();
    (is_against && n_windows >= LEAST_WINDOWS && turn_rad >= LEAST_TURN_RAD).then(|| {
        format!(
            "the car turns to the other side than it is steered wherever it does not slide: if the steering counts to \
             the right, map {}={}{}:{}",
            channel.short_name(),
            if term.sign > 0.0 { "-" } else { "" },
            term.number,
            term.unit.symbol
        )
    })
}

/// That a yaw rate is that of the yaw angle at another instant, as after a filter or by another clock.
fn late_yaw_rate(series: &TimeSeries) -> Option<String> {
    let (time_s, rate) = (series.time_s(), series.get(Channel::YawRate)?);
    let yaw = continued_rad(series.get(Channel::Yaw)?);
    let mut steps_s: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps_s.sort_by(f64::total_cmp);
    let step_s = quantile_of_sorted(&steps_s, 0.5)?;
    let is_even = *steps_s.first()? > 0.5 * step_s && *steps_s.last()? < 1.5 * step_s;
    let n_rows = time_s.len();
    let most = ((DELAYS_S.end / step_s) as usize).min(n_rows / 4).min(MOST_DELAYED);
    let most = isize::try_from(most).ok().filter(|most| is_even && *most > 0)?;
    let mut by_rate = vec![0.0; n_rows];
    for i in 1..n_rows {
        by_rate[i] = by_rate[i - 1] + (time_s[i] - time_s[i - 1]) * (rate[i - 1] + rate[i]) / 2.0;
    }
    let rows = most.unsigned_abs()..n_rows - most.unsigned_abs();
    let off_rad = |delay: isize| {
        let rows = rows.clone().step_by(1 + n_rows / COMPARED_ROWS);
        let at = |i: usize| Some(yaw.get(i)? - by_rate.get(i.checked_add_signed(delay)?)?);
        let off: Vec<f64> = rows.filter_map(at).collect();
        let n = off.len().max(1) as f64;
        let mean = off.iter().sum::<f64>() / n;
        (off.iter().map(|off| (off - mean).powi(2)).sum::<f64>() / n).sqrt()
    };
    let now_rad = off_rad(0);
    if now_rad <= DELAYED_RAD {
        return None;
    }
    let all = (-most..=most).map(|delay| (delay, off_rad(delay)));
    let (delay, least_rad) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let delay_s = delay.unsigned_abs() as f64 * step_s;
    let is_delayed = least_rad < REMAINING * now_rad;
    (is_delayed && delay.abs() < most && DELAYS_S.contains(&delay_s)).then(|| {
        format!(
            "the yaw rate is {} s {} the yaw angle, as after a filter or by another clock: bring both to one time",
            three_digits(delay_s),
            if delay > 0 { "behind" } else { "ahead of" }
        )
    })
}

/// That a yaw rate stays at its largest value while the yaw angle turns faster.
fn cut_yaw_rate(series: &TimeSeries) -> Option<String> {
    let (time_s, rate) = (series.time_s(), series.get(Channel::YawRate)?);
    let yaw = continued_rad(series.get(Channel::Yaw)?);
    let limit = rate.iter().fold(0.0, |of: f64, rate| of.max(rate.abs()));
    let (mut by_rate, mut by_yaw, mut n_rows) = (0.0, 0.0, 0);
    for i in 1..time_s.len() {
        if rate[i - 1].abs() >= limit && rate[i].abs() >= limit {
            by_rate += limit * (time_s[i] - time_s[i - 1]);
            by_yaw += (yaw[i] - yaw[i - 1]) * rate[i].signum();
            n_rows += 1;
        }
    }
    let is_cut = by_yaw > FARTHER * by_rate && by_yaw - by_rate > FARTHER_RAD;
    (is_cut && n_rows >= ROWS_AT_LIMIT && limit > 0.0).then(|| {
        format!(
            "the yaw rate stays at its largest value, {} deg/s, in {n_rows} rows over which the yaw angle turns by {} deg \
             and not by {}: its sensor was at its limit there",
            three_digits(limit.to_degrees()),
            three_digits(by_yaw.to_degrees()),
            three_digits(by_rate.to_degrees())
        )
    })
}

/// The same of a yaw rate without a yaw angle: it stays at its largest value between flanks that are cut off.
fn cut_yaw_rate_alone(series: &TimeSeries) -> Option<String> {
    let rate = series.get(Channel::YawRate).filter(|_| series.get(Channel::Yaw).is_none())?;
    let largest = rate.iter().fold(0.0, |of: f64, rate| of.max(rate.abs()));
    let (row, limit) = held_peak(rate, largest).filter(|_| largest >= LEAST_LIMIT_RAD_S)?;
    Some(format!(
        "the yaw rate stays at its largest value, {} deg/s, over several rows from {} s on, between steep flanks: its sensor \
         was at its limit there, and the car turned faster",
        three_digits(limit.to_degrees()),
        three_digits(*series.time_s().get(row)?)
    ))
}

/// That a yaw angle stays as it is over rows in which the car turns by its yaw rate: the longest such turn.
fn held_yaw(series: &TimeSeries) -> Option<String> {
    let (time_s, rate) = (series.time_s(), series.get(Channel::YawRate)?);
    let yaw = series.get(Channel::Yaw)?;
    let mut longest: Option<(f64, [usize; 2])> = None;
    let mut from = 0;
    for to in 1..=time_s.len() {
        // A run of equal angles ends where the next one differs, and at the last row.
        if yaw.get(to).is_some_and(|angle| *angle == yaw[from]) {
            continue;
        }
        let last = to - 1;
        let steps = from + 1..to;
        let turned: f64 =
            steps.map(|i| (time_s[i] - time_s[i - 1]) * (rate[i - 1] + rate[i]) / 2.0).sum();
        let least = HELD_TURN_RAD.max(HELD_RATE_RAD_S * (time_s[last] - time_s[from]));
        let is_longest = longest.is_none_or(|(other, _)| turned.abs() > other.abs());
        if last - from >= HELD_ROWS && turned.abs() > least && is_longest {
            longest = Some((turned, [from, last]));
        }
        from = to;
    }
    let (turned, [from, last]) = longest?;
    Some(format!(
        "the yaw angle stays at {} deg from {} to {} s, over which the car turns by {} deg by its yaw rate: it was held \
         there; remove these rows, or read the yaw angle at its own instants",
        three_digits(yaw[from].to_degrees()),
        three_digits(time_s[from]),
        three_digits(time_s[last]),
        three_digits(turned.to_degrees())
    ))
}

/// That an acceleration ahead that names no unit is in g, by the speed beside it.
fn acceleration_in_g(
    by_channel: &BTreeMap<Channel, ColumnUse>,
    series: &TimeSeries,
) -> Option<String> {
    let column = by_channel.get(&Channel::Ax).filter(|column| !column.unit_is_stated)?;
    let [term] = column.terms[..] else { return None };
    let speed = series.get(Channel::Vx).or_else(|| series.get(Channel::Speed))?;
    let (time_s, ahead) = (series.time_s(), series.get(Channel::Ax)?);
    let mut by_ahead = vec![0.0; time_s.len()];
    for i in 1..time_s.len() {
        let mean = (ahead[i - 1] + ahead[i]) / 2.0;
        by_ahead[i] = by_ahead[i - 1] + (time_s[i] - time_s[i - 1]) * mean;
    }
    let centred = |values: &[f64]| -> Vec<f64> {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        values.iter().map(|value| value - mean).collect()
    };
    let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let (speed, by_ahead) = (centred(speed), centred(&by_ahead));
    let factor = product(&speed, &by_ahead) / product(&by_ahead, &by_ahead);
    let left: Vec<f64> = speed.iter().zip(&by_ahead).map(|(v, a)| v - factor * a).collect();
    let size = product(&speed, &speed).sqrt();
    let is_compared = size > LEAST_SPEED_M_S * (speed.len() as f64).sqrt();
    let is_in_g =
        G_FACTORS.contains(&factor.abs()) && product(&left, &left).sqrt() < LEFT_WITH_G * size;
    (is_compared && is_in_g).then(|| {
        let is_negated = (term.sign < 0.0) != (factor < 0.0);
        format!(
            "column {} {} names no unit and is read in m/s²: by the speed it is in g (map ax={}{}:g)",
            column.number,
            quoted(&column.name),
            if is_negated { "-" } else { "" },
            term.number
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::data::{Channel, TimeSeries, read_any_series};

    use super::{cut_yaw_rate_alone, held_yaw};

    /// A car that spins by up to 4 rad/s to the right and comes to rest, in 200 rows.
    fn spin(change: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> TimeSeries {
        let time_s: Vec<f64> = (0..200).map(|i| 0.02 * f64::from(i)).collect();
        let row = |(i, t): (usize, &f64)| {
            let angle = std::f64::consts::PI * t / 4.0;
            // The integral of the rate.
            change(i, [-16.0 / std::f64::consts::PI * (1.0 - angle.cos()), -4.0 * angle.sin()])
        };
        let rows: Vec<[f64; 2]> = time_s.iter().enumerate().map(row).collect();
        let mut series = TimeSeries::new(time_s).unwrap();
        series.insert(Channel::Yaw, rows.iter().map(|row| row[0]).collect()).unwrap();
        series.insert(Channel::YawRate, rows.iter().map(|row| row[1]).collect()).unwrap();
        series
    }

    #[test]
    fn a_yaw_angle_that_is_held_while_the_car_turns_is_said() {
        assert_eq!(held_yaw(&spin(|_, row| row)), None);
        let text = held_yaw(&spin(|i, [yaw, rate]| match (80..90).contains(&i) {
            true => [-3.0, rate],
            false => [yaw, rate],
        }));
        let text = text.unwrap();
        assert!(text.contains("from 1.6 to 1.78 s") && text.contains("-172 deg"), "{text}");
        // An angle in whole degrees, and a gyroscope that drifts at rest.
        let slow = |degrees: f64| degrees.round().to_radians();
        assert_eq!(held_yaw(&spin(|i, _| [slow(0.1 * i as f64), 0.087])), None);
        assert_eq!(held_yaw(&spin(|_, _| [1.0, 0.02])), None);
    }

    #[test]
    fn an_acceleration_in_g_without_a_unit_is_said() {
        let said = |header: &str, acceleration: &dyn Fn(f64) -> f64| {
            // Braked by 6 m/s² for two seconds of three.
            let row = |i: u32| {
                let t = 0.02 * f64::from(i);
                let braked_s = (t - 0.5).clamp(0.0, 2.0);
                let is_braked = (0.5..2.5).contains(&t);
                let ahead = acceleration(if is_braked { -6.0 } else { 0.0 });
                let x = 20.0 * t - 3.0 * braked_s * braked_s - 12.0 * (t - 2.5).max(0.0);
                format!("{t},{x},0,{},{ahead}\n", 20.0 - 6.0 * braked_s)
            };
            let rows: String = (0..150).map(row).collect();
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("log.csv");
            let text = format!("time [s],x [m],y [m],speed [m/s],{header}\n{rows}");
            std::fs::write(&path, text).unwrap();
            let loaded = read_any_series(&path, None).unwrap();
            let notes = loaded.notes.iter().map(ToString::to_string);
            notes.collect::<Vec<_>>().join("; ")
        };
        for (factor, map) in [(1.0, "map ax=5:g"), (-1.0, "map ax=-5:g")] {
            let text = said("ax", &|ahead| factor * ahead / 9.806_65);
            assert!(text.contains(map), "{text}");
        }
        assert!(!said("ax", &|ahead| ahead).contains("by the speed it is"), "m/s²");
        assert!(!said("ax [g]", &|ahead| ahead / 9.806_65).contains("by the speed it is"), "g");
    }

    #[test]
    fn a_yaw_rate_at_its_limit_is_said_without_a_yaw_angle_too() {
        let alone = |change: &dyn Fn(f64) -> f64| {
            let both = spin(|_, [yaw, rate]| [yaw, change(rate)]);
            let mut series = TimeSeries::new(both.time_s().to_vec()).unwrap();
            let rate = both.get(Channel::YawRate).unwrap().to_vec();
            series.insert(Channel::YawRate, rate).unwrap();
            cut_yaw_rate_alone(&series)
        };
        assert_eq!(alone(&|rate| rate), None);
        // A steady turn, and a peak in whole degrees.
        assert_eq!(alone(&|rate| (0.1 * rate).max(-0.2)), None);
        assert_eq!(alone(&|rate| rate.to_degrees().round().to_radians()), None);
        let text = alone(&|rate| rate.max(-2.0)).unwrap();
        assert!(text.contains("115 deg/s") && text.contains("at its limit"), "{text}");
    }

    /// What is said of a car that drives at 15 m/s through a bend to the left and one to the right.
    ///
    /// - `row`: yaw rate, deg/s, and angle of the steering wheel, deg, at an instant, s, of a car with yaw rate `rate(t)`.
    fn said(row: impl Fn(f64, &dyn Fn(f64) -> f64) -> [f64; 2]) -> String {
        let rate = |t: f64| 20.0 * (0.8 * t).sin();
        let (mut x, mut y, mut text) = (0.0, 0.0, String::new());
        for i in 0..800 {
            let t = 0.01 * f64::from(i);
            let yaw_deg = 25.0 * (1.0 - (0.8 * t).cos());
            let [rate_deg_s, steering_deg] = row(t, &rate);
            text += &format!("{t},{x},{y},{yaw_deg},{rate_deg_s},{steering_deg}\n");
            let middle = (25.0 * (1.0 - (0.8 * (t + 0.005)).cos())).to_radians();
            (x, y) = (x + 0.15 * middle.cos(), y + 0.15 * middle.sin());
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let head = "t [s],x [m],y [m],yaw [deg],yaw rate [deg/s],steering wheel [deg]";
        std::fs::write(&path, format!("{head}\n{text}")).unwrap();
        let loaded = read_any_series(&path, None).unwrap();
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        notes.join("\n")
    }

    #[test]
    fn signals_of_another_side_time_or_size_are_told() {
        assert_eq!(said(|t, rate| [rate(t), 2.0 * rate(t - 0.1)]), "");
        let other_side = said(|t, rate| [rate(t), -2.0 * rate(t)]);
        assert!(other_side.contains("map steering_wheel=-6:deg"), "{other_side}");
        let late = said(|t, rate| [rate(t - 0.3), 2.0 * rate(t)]);
        assert!(late.contains("the yaw rate is 0.3 s behind the yaw angle"), "{late}");
        let early = said(|t, rate| [rate(t + 0.3), 2.0 * rate(t)]);
        assert!(early.contains("the yaw rate is 0.3 s ahead of the yaw angle"), "{early}");
        let cut = said(|t, rate| [rate(t).clamp(-15.0, 15.0), 2.0 * rate(t)]);
        assert!(cut.contains("stays at its largest value, 15 deg/s"), "{cut}");
    }
}
