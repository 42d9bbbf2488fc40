//! A camera key as an argument: `t=0.5,distance=20,follow=struck`.

use crate::cli::options::number;
use crate::cli::options::quantity::QuantityError;
use impactlab_core::ranges::{
    CAMERA_AZIMUTH, CAMERA_DISTANCE, CAMERA_ELEVATION, INSTANT, POSITION, Range,
};
use impactlab_draw::scene::{CameraKey, Follow};

/// What is said of a camera key. What is left open is as in the key before it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::cli) struct CameraKeyArg {
    time_s: Option<f64>,
    x_m: Option<f64>,
    y_m: Option<f64>,
    distance_m: Option<f64>,
    azimuth_rad: Option<f64>,
    elevation_rad: Option<f64>,
    follow: Option<Follow>,
}

/// An argument that is no camera key.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(in crate::cli) enum CameraKeyArgError {
    /// A part without a name or a value.
    #[error("{part:?} is no name with a value, such as distance=20")]
    NoValue { part: String },
    /// A part with a name that no key has.
    #[error("{name:?} is unknown, expected t, x, y, distance, azimuth, elevation or follow")]
    Unknown { name: String },
    /// A name that stands twice.
    #[error("{name} stands twice")]
    Twice { name: String },
    /// No time.
    #[error("expected a time, such as t=0.5,distance=20,follow=struck")]
    NoTime,
    /// A car that there is not.
    #[error("follow is {car:?}, expected none, struck or striking")]
    NoCar { car: String },
    /// A value that is not the number it should be.
    #[error("{name}: {why}")]
    Number { name: String, why: QuantityError },
}

impl CameraKeyArg {
    /// The key behind another one, which says what is left open here.
    pub(in crate::cli) fn after(&self, before: &CameraKey) -> CameraKey {
        let [x_m, y_m] = before.target_m;
        CameraKey {
            time_s: self.time_s.unwrap_or(before.time_s),
            target_m: [self.x_m.unwrap_or(x_m), self.y_m.unwrap_or(y_m)],
            distance_m: self.distance_m.unwrap_or(before.distance_m),
            azimuth_rad: self.azimuth_rad.unwrap_or(before.azimuth_rad),
            elevation_rad: self.elevation_rad.unwrap_or(before.elevation_rad),
            follow: self.follow.unwrap_or(before.follow),
        }
    }

    /// The number of a name, and its range; `None` for a name that no key has.
    fn number_mut(&mut self, name: &str) -> Option<(&mut Option<f64>, Range)> {
        Some(match name {
            "t" => (&mut self.time_s, INSTANT),
            "x" => (&mut self.x_m, POSITION),
            "y" => (&mut self.y_m, POSITION),
            "distance" => (&mut self.distance_m, CAMERA_DISTANCE),
            "azimuth" => (&mut self.azimuth_rad, CAMERA_AZIMUTH),
            "elevation" => (&mut self.elevation_rad, CAMERA_ELEVATION),
            _ => return None,
        })
    }

    /// Takes the value of a name.
    fn set(&mut self, name: &str, value: &str) -> Result<(), CameraKeyArgError> {
        let owned = || name.to_owned();
        let is_twice = if name == "follow" {
            self.follow.replace(followed(value)?).is_some()
        } else {
            let Some((held, range)) = self.number_mut(name) else {
                return Err(CameraKeyArgError::Unknown { name: owned() });
            };
            let given = number(range)(value);
            let given = given.map_err(|why| CameraKeyArgError::Number { name: owned(), why })?;
            held.replace(given).is_some()
        };
        if is_twice { Err(CameraKeyArgError::Twice { name: owned() }) } else { Ok(()) }
    }
}

fn followed(car: &str) -> Result<Follow, CameraKeyArgError> {
    match car.trim() {
        "none" => Ok(Follow::Nothing),
        "struck" => Ok(Follow::Struck),
        "striking" => Ok(Follow::Striking),
        other => Err(CameraKeyArgError::NoCar { car: other.to_owned() }),
    }
}

/// A camera key, in SI units unless it says otherwise: `t=0.5,distance=20,azimuth=30deg,follow=struck`.
pub(in crate::cli) fn camera_key(text: &str) -> Result<CameraKeyArg, CameraKeyArgError> {
    let mut key = CameraKeyArg::default();
    for part in text.split(',') {
        let no_value = || CameraKeyArgError::NoValue { part: part.to_owned() };
        let (name, value) = part.split_once('=').ok_or_else(no_value)?;
        key.set(name.trim(), value)?;
    }
    if key.time_s.is_none() {
        return Err(CameraKeyArgError::NoTime);
    }
    Ok(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_key_leaves_open_is_as_before() {
        let before = CameraKey {
            time_s: 0.0,
            target_m: [1.0, 2.0],
            distance_m: 60.0,
            azimuth_rad: 0.5,
            elevation_rad: 0.6,
            follow: Follow::Nothing,
        };
        let of = |text: &str| camera_key(text).unwrap().after(&before);
        assert_eq!(of("t=250ms"), CameraKey { time_s: 0.25, ..before });
        let whole = "t=1, x=-3, y=4, distance=20, azimuth=-0.2, elevation=0.3, follow=striking";
        let expected = CameraKey {
            time_s: 1.0,
            target_m: [-3.0, 4.0],
            distance_m: 20.0,
            azimuth_rad: -0.2,
            elevation_rad: 0.3,
            follow: Follow::Striking,
        };
        assert_eq!(of(whole), expected);
        let turned = of("azimuth=-90deg,t=1");
        assert!((turned.azimuth_rad + std::f64::consts::FRAC_PI_2).abs() < 1e-12, "{turned:?}");
    }

    #[test]
    fn what_is_no_key_is_said() {
        for (text, part) in [
            ("", "is no name with a value"),
            ("distance=20", "expected a time"),
            ("t=1,20", "\"20\" is no name with a value"),
            ("t=1,zoom=2", "\"zoom\" is unknown, expected t, x, y, distance"),
            ("t=1,t=2", "t stands twice"),
            ("t=1,follow=none,follow=none", "follow stands twice"),
            ("t=1,follow=target", "expected none, struck or striking"),
            ("t=1,distance=0.5", "distance: camera distance is 0.5 m, expected 2 to 20000 m"),
            ("t=1,elevation=60", "elevation: camera elevation is 60 rad, expected"),
            ("t=soon", "t: "),
        ] {
            let error = camera_key(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
