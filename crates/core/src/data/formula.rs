//! Channels that follow from several columns or from one that counts in another way: the yaw angle of a quaternion or of
//! a course, and places in metres from latitude and longitude.

use std::f64::consts::FRAC_PI_2;

use crate::data::GeographicPlace;

/// Courses that are read, degrees: those of a receiver lie between 0 and 360, and may be counted on over north.
const COURSES_DEG: std::ops::RangeInclusive<f64> = -36_000.0..=36_000.0;

/// What is computed from several columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formula {
    /// The yaw angle of a unit quaternion, `quaternion(w x y z)`.
    Quaternion,
    /// The yaw angle of a course over ground in degrees clockwise from north, over a path with x to the east:
    /// `course(column)`.
    Course,
    /// The way to the east of the first row, m, from degrees: `east(latitude longitude)`.
    East,
    /// The way to the north of the first row, m, from degrees: `north(latitude longitude)`.
    North,
}

/// What a column holds from which a channel is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormulaPart {
    /// The latitude, degrees to the north.
    Latitude,
    /// The longitude, degrees to the east.
    Longitude,
    /// The real part of a quaternion.
    QuaternionW,
    /// Its part along x.
    QuaternionX,
    /// Its part along y.
    QuaternionY,
    /// Its part along z.
    QuaternionZ,
    /// The course over ground, degrees clockwise from north.
    Course,
}

/// Deviation of the length of a quaternion from 1 from which it is none.
const UNIT_LENGTH: f64 = 0.05;

impl Formula {
    pub(super) const ALL: [Self; 4] = [Self::Quaternion, Self::Course, Self::East, Self::North];

    /// Its name in the text of a map.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quaternion => "quaternion",
            Self::Course => "course",
            Self::East => "east",
            Self::North => "north",
        }
    }

    /// What the columns hold from which it is computed, in their order.
    pub fn parts(self) -> &'static [FormulaPart] {
        use FormulaPart::{
            Course, Latitude, Longitude, QuaternionW, QuaternionX, QuaternionY, QuaternionZ,
        };
        match self {
            Self::Quaternion => &[QuaternionW, QuaternionX, QuaternionY, QuaternionZ],
            Self::Course => &[Course],
            Self::East | Self::North => &[Latitude, Longitude],
        }
    }

    /// Number of columns from which it is computed.
    pub fn n_columns(self) -> usize {
        self.parts().len()
    }

    /// What the columns have to hold, for a message.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::Quaternion => "the columns w, x, y and z of a quaternion of length 1",
            Self::Course => "a course in degrees clockwise from north",
            Self::East | Self::North => {
                "a latitude from −90° to 90° and a longitude from −180° to 180°, in degrees, neither × 10⁷ nor as \
                 ddmm.mmmm"
            }
        }
    }

    /// The values in all rows; the error is the index of the row in which the columns hold something
    /// else.
    ///
    /// - `columns`: the numbers of each of [`Formula::n_columns`] columns.
    pub(super) fn values(self, columns: &[Vec<f64>]) -> Result<Vec<f64>, usize> {
        match (self, columns) {
            (Self::Quaternion, [w, x, y, z]) => {
                let rows = w.iter().zip(x).zip(y).zip(z).enumerate();
                rows.map(|(row, (((w, x), y), z))| yaw_rad([*w, *x, *y, *z]).ok_or(row)).collect()
            }
            (Self::Course, [course]) => {
                let yaw = |(row, deg): (usize, &f64)| {
                    let is_course = COURSES_DEG.contains(deg);
                    is_course.then(|| FRAC_PI_2 - deg.to_radians()).ok_or(row)
                };
                course.iter().enumerate().map(yaw).collect()
            }
            (Self::East | Self::North, [latitude, longitude]) => {
                let places = latitude
                    .iter()
                    .zip(longitude)
                    .map(|(lat, lon)| GeographicPlace::from_degrees(*lat, *lon));
                let origin = latitude.first().zip(longitude.first());
                let Some((lat, lon)) = origin else { return Ok(Vec::new()) };
                let origin = GeographicPlace::from_degrees(*lat, *lon).ok_or(0_usize)?;
                let way = |place: GeographicPlace| match self {
                    Self::East => origin.to_east_m(place),
                    _ => origin.to_north_m(place),
                };
                places.enumerate().map(|(row, place)| place.map(way).ok_or(row)).collect()
            }
            _ => Err(0),
        }
    }
}

/// ψ = atan2(2 (w z + x y), 1 − 2 (y² + z²)) of a rotation from body to world axes.
fn yaw_rad([w, x, y, z]: [f64; 4]) -> Option<f64> {
    let length = (w * w + x * x + y * y + z * z).sqrt();
    let yaw_rad = (2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z);
    ((length - 1.0).abs() < UNIT_LENGTH).then_some(yaw_rad)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A minute of arc at 52° is 1854.5 m to the north and 1144.0 m to the east (WGS 84).
    #[test]
    fn minutes_of_arc_have_their_lengths() {
        let columns = [vec![52.0, 52.0 + 1.0 / 60.0, 52.0], vec![-1.0, -1.0, -1.0 + 1.0 / 60.0]];
        let north = Formula::North.values(&columns).unwrap();
        let east = Formula::East.values(&columns).unwrap();
        assert!((north[1] - 1854.5).abs() < 0.5 && east[1].abs() < 1e-6, "{north:?} {east:?}");
        assert!((east[2] - 1144.6).abs() < 1.0 && north[2].abs() < 0.2, "{north:?} {east:?}");
        let in_minutes = [vec![3120.0], vec![-60.0]];
        assert_eq!(Formula::North.values(&in_minutes), Err(0));
    }

    #[test]
    fn a_quaternion_has_its_yaw() {
        let half = 0.35_f64;
        let columns =
            [vec![half.cos(), 0.5], vec![0.0, 0.0], vec![0.0, 0.0], vec![half.sin(), 0.0]];
        assert_eq!(Formula::Quaternion.values(&columns), Err(1));
        let first: Vec<Vec<f64>> = columns.iter().map(|column| column[..1].to_vec()).collect();
        let yaw = Formula::Quaternion.values(&first).unwrap();
        assert!((yaw[0] - 0.7).abs() < 1e-12, "{yaw:?}");
    }
}
