//! Whether the yaw rate of a recorded motion is that of its yaw angle.
//!
//! ```text
//! ψ against ∫r dt, both about their means: the slope of a line through the origin
//! ```

use crate::data::{Channel, Contradiction, TimeSeries};
use crate::numerics::continued_rad;

/// Difference of the yaw angle and the integral of the yaw rate up to which they go together, rad: noise and
/// drift of a gyroscope over some seconds.
const DRIFT_RAD: f64 = 0.1;
/// The same as a share of the turn: a gyroscope with a scale error, a yaw that is smoothed.
const FITTING: f64 = 0.2;
/// Share of the turn that may remain when a factor is taken out, so that there is one at all.
const EXPLAINED: f64 = 0.35;
/// Speed from which the course over ground of a receiver is a direction and not noise, m/s.
pub(super) const MOVING_M_S: f64 = 1.0;

/// Compares the yaw angle with the integral of the yaw rate. Where they have nothing to do with each other, the yaw
/// angle may be the course over ground of a receiver, which is noise at rest: then only where the vehicle moves.
pub(super) fn against_yaw_rate(series: &TimeSeries) -> Option<Contradiction> {
    match against_yaw_rate_where(series, |_| true)? {
        Contradiction::YawRateUnrelated => match speed_m_s(series) {
            Some(speed) => against_yaw_rate_where(series, |i| speed[i] >= MOVING_M_S),
            None => Some(Contradiction::YawRateUnrelated),
        },
        found => Some(found),
    }
}

/// The size of the recorded velocity.
pub(super) fn speed_m_s(series: &TimeSeries) -> Option<Vec<f64>> {
    if let Some(speed) = series.get(Channel::Speed) {
        return Some(speed.iter().map(|v| v.abs()).collect());
    }
    let vx = series.get(Channel::Vx)?;
    Some(match series.get(Channel::Vy) {
        Some(vy) => vx.iter().zip(vy).map(|(x, y)| x.hypot(*y)).collect(),
        None => vx.iter().map(|v| v.abs()).collect(),
    })
}

/// Compares both about their means, so that neither noise of single samples nor where the integral begins matters.
///
/// - `is_known`: whether the yaw angle of a sample is one. What it turns by in between counts for neither.
fn against_yaw_rate_where(
    series: &TimeSeries,
    is_known: impl Fn(usize) -> bool,
) -> Option<Contradiction> {
    let (time_s, rate) = (series.time_s(), series.get(Channel::YawRate)?);
    let angles_rad = continued_rad(series.get(Channel::Yaw)?);
    let (mut turned_rad, mut by_rate_rad) = (0.0, 0.0);
    let (mut yaw_rad, mut integral) = (Vec::new(), Vec::new());
    for i in (0..time_s.len()).filter(|i| is_known(*i)) {
        if i > 0 && is_known(i - 1) {
            turned_rad += angles_rad[i] - angles_rad[i - 1];
            by_rate_rad += (time_s[i] - time_s[i - 1]) * (rate[i - 1] + rate[i]) / 2.0;
        }
        yaw_rad.push(turned_rad);
        integral.push(by_rate_rad);
    }
    let [yaw, by_rate] = [centred(&yaw_rad), centred(&integral)];
    let off = |slope: f64| rms(yaw.iter().zip(&by_rate).map(|(yaw, rate)| yaw - slope * rate));
    let [yaw_size, rate_size] = [&yaw, &by_rate].map(|values| rms(values.iter().copied()));
    // What a gyroscope drifts by, and a scale error.
    if off(1.0) <= DRIFT_RAD.max(FITTING * yaw_size) {
        return None;
    }
    let slope = match rate_size > 0.0 {
        true => {
            let product: f64 = yaw.iter().zip(&by_rate).map(|(yaw, rate)| yaw * rate).sum();
            product / (rate_size * rate_size * yaw.len() as f64)
        }
        false => 0.0,
    };
    Some(match off(slope) <= EXPLAINED * yaw_size {
        true => Contradiction::YawRate { factor: slope },
        false => Contradiction::YawRateUnrelated,
    })
}

/// Whether a yaw angle turns so much that a yaw rate of the wrong sign contradicts it.
pub(super) fn tells_sides(yaw_rad: &[f64]) -> bool {
    2.0 * rms(centred(yaw_rad).into_iter()) > DRIFT_RAD
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len().max(1) as f64;
    (values.map(|value| value * value).sum::<f64>() / n).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::contradictions;

    /// The course of a receiver goes round at rest, and its bend is that of the yaw rate or of its mirror.
    #[test]
    fn a_course_is_compared_where_the_vehicle_moves() {
        let time_s: Vec<f64> = (0..800).map(|i| f64::from(i) * 0.01).collect();
        let column = |f: &dyn Fn(f64) -> f64| time_s.iter().map(|t| f(*t)).collect::<Vec<f64>>();
        let found = |sign: f64, drives_at_s: f64| {
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            let driven_s = |t: f64| (t - drives_at_s).max(0.0);
            let is_driving = |t: f64| t >= drives_at_s;
            for (channel, values) in [
                (Channel::Vx, column(&|t| if is_driving(t) { 15.0 } else { 0.2 })),
                (
                    Channel::Yaw,
                    column(&|t| if is_driving(t) { 0.3 * driven_s(t) } else { 250.0 * t }),
                ),
                (Channel::YawRate, column(&|t| if is_driving(t) { sign * 0.3 } else { 0.0 })),
            ] {
                series.insert(channel, values).unwrap();
            }
            contradictions(&series)
        };
        assert_eq!(found(1.0, 4.0), []);
        let mirrored = found(-1.0, 4.0);
        let [Contradiction::YawRate { factor }] = mirrored[..] else { panic!("{mirrored:?}") };
        assert!((factor + 1.0).abs() < 0.05, "{factor}");
        assert_eq!(found(0.0, 4.0), [Contradiction::YawRateUnrelated]);
        // It never moves, so that there is nothing to compare.
        assert_eq!(found(1.0, 9.0), []);
    }
}
