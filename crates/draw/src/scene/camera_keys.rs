//! Keys between which a camera moves.
//!
//! A share s of the way from one key to the next is done at time t. It starts and ends at rest and goes
//! neither back nor too far:
//!
//! ```text
//! u = (t − t₀) / (t₁ − t₀)             s = u² (3 − 2 u)
//! angle = angle₀ + s (angle₁ − angle₀), the short way round
//! distance = distance₀ (distance₁ / distance₀)ˢ
//! target = (1 − s) target₀(t) + s target₁(t)
//! ```
//!
//! The target of a key that follows a car is where that car is at time t. Before the first key the camera
//! is that of the first one, after the last key that of the last one.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::scene::{Camera, Follow, ViewKind};
use impactlab_core::ranges::{
    CAMERA_AZIMUTH, CAMERA_DISTANCE, CAMERA_ELEVATION, INSTANT, OutOfRange, POSITION,
};
use impactlab_document::scene::{FilmTiming, Scene};

/// A camera at a time of a scene. The kind of view is that of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CameraKey {
    /// Time of the scene, s.
    pub time_s: f64,
    /// Point on the ground that is in the middle of the picture, `[X, Y]`, m; where a car is followed, the
    /// place of that car takes its place.
    pub target_m: [f64; 2],
    /// Distance of the camera from that point, m.
    pub distance_m: f64,
    /// Direction from that point to the camera, as in [`Camera`], rad.
    pub azimuth_rad: f64,
    /// Height of the camera above the horizon of that point, rad.
    pub elevation_rad: f64,
    /// The car that stays in the middle.
    pub follow: Follow,
}

/// The reason why a film cannot be made with camera keys.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CameraKeyError {
    /// A number of a key is outside its range.
    #[error("the camera key at {time_s} s")]
    Range {
        /// Time of the key, s.
        time_s: f64,
        /// The number.
        source: OutOfRange,
    },
    /// A key does not come after the one before it.
    #[error(
        "the camera key at {after_s} s comes after that at {before_s} s; expected keys in the order of \
         time, each at a time of its own"
    )]
    Order {
        /// Time of the one that stands first, s.
        before_s: f64,
        /// Time of the one behind it, s.
        after_s: f64,
    },
    /// A key lies before or after the film.
    #[error(
        "the camera key at {time_s} s lies outside the film, expected times between {from_s:.3} s and \
         {to_s:.3} s"
    )]
    Outside {
        /// Time of the key, s.
        time_s: f64,
        /// First instant of the film, s.
        from_s: f64,
        /// Last instant of the film, s.
        to_s: f64,
    },
}

impl CameraKey {
    /// A camera as it is at a time.
    pub fn new(time_s: f64, camera: &Camera, follow: Follow) -> Self {
        let Camera { target_m, azimuth_rad, elevation_rad, distance_m, .. } = camera.limited();
        // The window lets a camera stand a little more upright.
        let elevation_rad = elevation_rad.clamp(CAMERA_ELEVATION.low, CAMERA_ELEVATION.high);
        Self { time_s, target_m, distance_m, azimuth_rad, elevation_rad, follow }
    }

    /// The camera of the key, for a kind of view.
    pub fn camera(&self, kind: ViewKind) -> Camera {
        let Self { target_m, distance_m, azimuth_rad, elevation_rad, .. } = *self;
        Camera { kind, target_m, azimuth_rad, elevation_rad, distance_m }.limited()
    }

    /// The key with a share of the way to another one done; it follows a car if both follow that car.
    fn towards(self, other: &Self, share: f64) -> Self {
        if share <= 0.0 {
            return self;
        }
        let between = |from: f64, to: f64| from + share * (to - from);
        let turn_rad = (other.azimuth_rad - self.azimuth_rad + PI).rem_euclid(TAU) - PI;
        let ([x, y], [other_x, other_y]) = (self.target_m, other.target_m);
        let is_same = self.follow == other.follow;
        Self {
            target_m: [between(x, other_x), between(y, other_y)],
            distance_m: self.distance_m * (other.distance_m / self.distance_m).powf(share),
            azimuth_rad: self.azimuth_rad + share * turn_rad,
            elevation_rad: between(self.elevation_rad, other.elevation_rad),
            follow: if is_same { self.follow } else { Follow::Nothing },
            ..self
        }
    }

    fn check_numbers(&self) -> Result<(), OutOfRange> {
        let [x_m, y_m] = self.target_m;
        for (value, range) in [
            (self.time_s, INSTANT),
            (x_m, POSITION),
            (y_m, POSITION),
            (self.distance_m, CAMERA_DISTANCE),
            (self.azimuth_rad, CAMERA_AZIMUTH),
            (self.elevation_rad, CAMERA_ELEVATION),
        ] {
            range.check(value)?;
        }
        Ok(())
    }
}

/// The camera that keys give at a time of a scene; `None` without any.
///
/// - `keys`: in the order of time.
pub fn camera_in_scene(keys: &[CameraKey], scene: &Scene, time_s: f64) -> Option<CameraKey> {
    camera_at(keys, time_s, |follow| follow.target_m(scene, time_s))
}

/// The same where the places of the cars are given.
///
/// - `place`: where the car that is followed is at that time, m.
fn camera_at(
    keys: &[CameraKey],
    time_s: f64,
    place: impl Fn(Follow) -> Option<[f64; 2]>,
) -> Option<CameraKey> {
    let n_before = keys.partition_point(|key| key.time_s <= time_s);
    let before = n_before.checked_sub(1).and_then(|idx| keys.get(idx));
    let placed = |key: &CameraKey| CameraKey {
        time_s,
        target_m: place(key.follow).unwrap_or(key.target_m),
        ..*key
    };
    match (before, keys.get(n_before)) {
        (Some(before), Some(after)) => {
            let share = (time_s - before.time_s) / (after.time_s - before.time_s);
            let eased = share * share * (3.0 - 2.0 * share);
            Some(placed(before).towards(&placed(after), eased))
        }
        (Some(only), None) | (None, Some(only)) => Some(placed(only)),
        (None, None) => None,
    }
}

/// Puts a key among others in the order of time. One at the same time is replaced.
pub fn set_key(keys: &mut Vec<CameraKey>, key: CameraKey) {
    keys.retain(|other| other.time_s != key.time_s);
    keys.push(key);
    keys.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
}

/// Moves a key to another time and keeps the order of time. At a time at which another key stands it is not
/// moved.
///
/// - returns the key as it is moved.
pub fn move_key(keys: &mut [CameraKey], idx: usize, time_s: f64) -> Option<CameraKey> {
    if keys.iter().any(|other| other.time_s == time_s) {
        return None;
    }
    let key = keys.get_mut(idx)?;
    key.time_s = time_s;
    let moved = *key;
    keys.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    Some(moved)
}

/// Checks the keys of a film.
///
/// # Errors
/// [`CameraKeyError`]: a number outside its range, keys out of order, or one outside the film.
pub fn check_keys(keys: &[CameraKey], timing: &FilmTiming) -> Result<(), CameraKeyError> {
    let mut before_s = f64::NEG_INFINITY;
    for key in keys {
        let time_s = key.time_s;
        key.check_numbers().map_err(|source| CameraKeyError::Range { time_s, source })?;
        if time_s <= before_s {
            return Err(CameraKeyError::Order { before_s, after_s: time_s });
        }
        if !timing.shows(time_s) {
            let FilmTiming { from_s, to_s, .. } = *timing;
            return Err(CameraKeyError::Outside { time_s, from_s, to_s });
        }
        before_s = time_s;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time_s: f64, target_m: [f64; 2], distance_m: f64, angles_deg: [f64; 2]) -> CameraKey {
        let [azimuth_rad, elevation_rad] = angles_deg.map(f64::to_radians);
        let follow = Follow::Nothing;
        CameraKey { time_s, target_m, distance_m, azimuth_rad, elevation_rad, follow }
    }

    fn keys() -> [CameraKey; 3] {
        [
            key(0.5, [1.0, 2.0], 60.0, [350.0, 30.0]),
            key(1.25, [-8.0, 5.0], 12.0, [20.0, 80.0]),
            key(3.0, [-8.0, 40.0], 300.0, [-60.0, 10.0]),
        ]
    }

    fn seen(keys: &[CameraKey], time_s: f64) -> CameraKey {
        camera_at(keys, time_s, |_| None).unwrap()
    }

    #[test]
    fn at_its_time_the_camera_is_exactly_the_key() {
        for key in keys() {
            assert_eq!(seen(&keys(), key.time_s), key);
        }
        assert_eq!(camera_at(&[], 1.0, |_| None), None);
    }

    #[test]
    fn the_camera_stands_before_the_first_key_and_after_the_last() {
        let [first, _, last] = keys();
        for time_s in [-1e9, 0.0, 0.499] {
            assert_eq!(seen(&keys(), time_s), CameraKey { time_s, ..first });
        }
        for time_s in [3.0, 3.001, 1e9] {
            assert_eq!(seen(&keys(), time_s), CameraKey { time_s, ..last });
        }
        assert_eq!(seen(&[first], 7.0), CameraKey { time_s: 7.0, ..first });
    }

    /// What a camera consists of.
    fn numbers(key: &CameraKey) -> [f64; 5] {
        let [x, y] = key.target_m;
        [x, y, key.distance_m, key.elevation_rad, key.azimuth_rad]
    }

    #[test]
    fn between_keys_nothing_goes_back_or_too_far() {
        const STEPS: usize = 1000;
        for pair in keys().windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let at = |step: usize| {
                let share = step as f64 / STEPS as f64;
                numbers(&seen(pair, from.time_s + share * (to.time_s - from.time_s)))
            };
            let mut ends = [numbers(&from), numbers(&to)];
            // 350° to 20° and 20° to −60° are turns of +30° and −80°.
            let turn_deg: f64 = if from.azimuth_rad > 6.0 { 30.0 } else { -80.0 };
            ends[1][4] = ends[0][4] + turn_deg.to_radians();
            for (idx, (first, last)) in ends[0].into_iter().zip(ends[1]).enumerate() {
                let sign = (last - first).signum();
                let slack = 1e-12 * last.abs().max(1.0);
                for step in 1..STEPS {
                    let (before, now) = (at(step - 1)[idx], at(step)[idx]);
                    assert!(sign * (now - before) >= -slack, "{idx} at {step}: {before}, {now}");
                    assert!(sign * (last - now) >= -slack, "{idx} at {step}: {now}");
                }
                let close = 1e-3 * last.abs().max(1.0);
                assert!((at(STEPS - 1)[idx] - last).abs() < close);
            }
        }
    }

    #[test]
    fn the_camera_starts_and_ends_at_rest() {
        let [from, to, _] = keys();
        let travelled = |from_s: f64, to_s: f64| {
            (seen(&keys(), to_s).elevation_rad - seen(&keys(), from_s).elevation_rad).abs()
        };
        let step_s = 1e-3;
        let middle_s = (from.time_s + to.time_s) / 2.0;
        let fastest = travelled(middle_s, middle_s + step_s);
        for at_s in [from.time_s, to.time_s - step_s, to.time_s] {
            let slow = travelled(at_s, at_s + step_s);
            assert!(slow < 0.02 * fastest, "{at_s} s: {slow} of {fastest}");
        }
    }

    #[test]
    fn a_key_that_follows_a_car_looks_at_it() {
        let [first, second, third] = keys();
        let keys = [
            CameraKey { follow: Follow::Struck, ..first },
            CameraKey { follow: Follow::Struck, ..second },
            third,
        ];
        let at = |time_s: f64| {
            let place =
                |follow: Follow| (follow == Follow::Struck).then_some([10.0 * time_s, -time_s]);
            camera_at(&keys, time_s, place).unwrap()
        };
        for time_s in [0.0, 0.5, 0.8, 1.25] {
            let seen = at(time_s);
            assert_eq!(seen.follow, Follow::Struck, "{time_s} s");
            let off = [seen.target_m[0] - 10.0 * time_s, seen.target_m[1] + time_s];
            assert!(off[0].hypot(off[1]) < 1e-12, "{time_s} s: {off:?}");
        }
        // It leaves the car without a jump and comes to where the last key looks.
        let left = at(1.25 + 1e-6);
        assert_eq!(left.follow, Follow::Nothing);
        assert!((left.target_m[0] - 12.5).abs() < 1e-4, "{left:?}");
        let reached = at(3.0 - 1e-6);
        assert!((reached.target_m[1] - 40.0).abs() < 1e-4, "{reached:?}");
    }

    #[test]
    fn a_camera_becomes_a_key_and_back() {
        let camera = Camera { distance_m: 33.0, elevation_rad: 9.0, ..Camera::default() };
        let key = CameraKey::new(0.25, &camera, Follow::Striking);
        assert!(key.check_numbers().is_ok(), "{key:?}");
        let again = CameraKey::new(0.25, &key.camera(ViewKind::Perspective), Follow::Striking);
        assert_eq!(again, key);
    }

    #[test]
    fn a_new_key_stands_at_its_time_and_replaces_one_there() {
        let [first, second, third] = keys();
        let mut set = Vec::new();
        for key in [second, third, first, CameraKey { distance_m: 5.0, ..second }] {
            set_key(&mut set, key);
        }
        assert_eq!(set, [first, CameraKey { distance_m: 5.0, ..second }, third]);
    }

    #[test]
    fn a_key_is_moved_to_its_place_in_the_order_and_never_over_another() {
        let [first, second, third] = keys();
        let mut moved = keys();
        let late = CameraKey { time_s: 2.0, ..first };
        assert_eq!(move_key(&mut moved, 0, 2.0), Some(late));
        assert_eq!(moved, [second, late, third]);
        assert_eq!(move_key(&mut moved, 1, third.time_s), None, "one stands there");
        assert_eq!(move_key(&mut moved, 7, 9.0), None, "there is no such key");
        assert_eq!(moved, [second, late, third]);
    }

    #[test]
    fn keys_that_no_film_has_are_refused() {
        let scene = Scene { end_s: 3.0, ..Scene::default() };
        let timing = FilmTiming { from_s: 0.4, ..FilmTiming::from_scene(&scene) };
        let [first, second, third] = keys();
        assert_eq!(check_keys(&keys(), &timing), Ok(()));
        let late = CameraKey { time_s: 3.04, ..third };
        assert_eq!(check_keys(&[late], &timing), Ok(()), "it misses the end by little");
        for (keys, part) in [
            (vec![second, first], "the camera key at 0.5 s comes after that at 1.25 s"),
            (vec![first, first], "each at a time of its own"),
            (
                vec![CameraKey { time_s: 3.1, ..first }],
                "expected times between 0.400 s and 3.000 s",
            ),
            (vec![CameraKey { time_s: 0.0, ..first }], "0 s lies outside the film"),
            (vec![CameraKey { time_s: f64::NAN, ..first }], "the camera key at NaN s"),
            (vec![CameraKey { distance_m: 1.0, ..first }], "the camera key at 0.5 s"),
            (vec![CameraKey { elevation_rad: 2.0, ..first }], "the camera key at 0.5 s"),
            (vec![CameraKey { target_m: [0.0, 1e9], ..first }], "the camera key at 0.5 s"),
        ] {
            let error = check_keys(&keys, &timing).unwrap_err().to_string();
            assert!(error.contains(part), "{keys:?}: {error}");
        }
    }
}
