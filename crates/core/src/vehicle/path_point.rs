//! The planar motion of a vehicle at an instant, by itself and as a row of a time series.

use std::array;

use crate::data::{Channel, SeriesError, TimeSeries};

/// Columns of a motion in the order of [`PathPoint::values`].
const COLUMNS: [Channel; 6] =
    [Channel::X, Channel::Y, Channel::Yaw, Channel::Vx, Channel::Vy, Channel::YawRate];

/// State of a vehicle on its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Time, s; that after the start where nothing else is said.
    pub time_s: f64,
    /// X of the CG in world axes, m.
    pub x_m: f64,
    /// Y of the CG in world axes, m.
    pub y_m: f64,
    /// Heading, rad, counted over whole turns.
    pub yaw_rad: f64,
    /// Velocity along the x axis of the vehicle, m/s.
    pub vx_body_m_s: f64,
    /// Velocity along the y axis of the vehicle, m/s.
    pub vy_body_m_s: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

impl PathPoint {
    /// The states of a motion at its samples.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] without one of the columns of the planar motion.
    pub fn of_series(series: &TimeSeries) -> Result<Vec<Self>, SeriesError> {
        let mut columns: [&[f64]; 6] = [&[]; 6];
        for (column, channel) in columns.iter_mut().zip(COLUMNS) {
            *column = series.require(channel)?;
        }
        let point = |(idx, time_s): (usize, &f64)| {
            Self::from_values(*time_s, columns.map(|column| column[idx]))
        };
        Ok(series.time_s().iter().enumerate().map(point).collect())
    }

    /// The planar motion as a time series.
    ///
    /// # Errors
    /// [`SeriesError::TimeOrder`] if the time does not rise.
    pub fn series(points: &[Self]) -> Result<TimeSeries, SeriesError> {
        let mut series = TimeSeries::new(points.iter().map(|point| point.time_s).collect())?;
        for (idx, channel) in COLUMNS.into_iter().enumerate() {
            series.insert(channel, points.iter().map(|point| point.values()[idx]).collect())?;
        }
        Ok(series)
    }

    /// The state at a time on the line from this state to a later one, beyond them that of the nearer one.
    #[must_use]
    pub fn towards(&self, to: &Self, time_s: f64) -> Self {
        let span_s = to.time_s - self.time_s;
        let share = match span_s > 0.0 {
            true => ((time_s - self.time_s) / span_s).clamp(0.0, 1.0),
            false => 0.0,
        };
        let (from, to) = (self.values(), to.values());
        Self::from_values(time_s, array::from_fn(|i| from[i] + (to[i] - from[i]) * share))
    }

    fn from_values(time_s: f64, [x_m, y_m, yaw_rad, vx, vy, yaw_rate_rad_s]: [f64; 6]) -> Self {
        Self { time_s, x_m, y_m, yaw_rad, vx_body_m_s: vx, vy_body_m_s: vy, yaw_rate_rad_s }
    }

    fn values(&self) -> [f64; 6] {
        let Self { time_s: _, x_m, y_m, yaw_rad, vx_body_m_s, vy_body_m_s, yaw_rate_rad_s } = *self;
        [x_m, y_m, yaw_rad, vx_body_m_s, vy_body_m_s, yaw_rate_rad_s]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> [PathPoint; 2] {
        [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [2.0, 4.0, 6.0, 8.0, 10.0, 12.0]]
            .map(|values| PathPoint::from_values(values[0], values))
    }

    #[test]
    fn a_motion_is_the_same_as_a_series() {
        let series = PathPoint::series(&points()).unwrap();
        assert_eq!(series.get(Channel::YawRate), Some(&[6.0, 12.0][..]));
        assert_eq!(PathPoint::of_series(&series).unwrap(), points());
        let without = TimeSeries::new(vec![0.0]).unwrap();
        assert!(PathPoint::of_series(&without).is_err());
    }

    #[test]
    fn between_two_states_a_motion_is_linear_and_beyond_them_it_stays() {
        let [from, to] = points();
        let half = from.towards(&to, 1.5);
        assert_eq!((half.time_s, half.x_m, half.yaw_rate_rad_s), (1.5, 1.5, 9.0));
        for (time_s, x_m) in [(0.0, 1.0), (9.0, 2.0)] {
            assert_eq!(from.towards(&to, time_s).x_m, x_m);
        }
        assert_eq!(from.towards(&from, 1.0), from);
    }
}
