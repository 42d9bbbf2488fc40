//! Whether the columns of a recorded motion go together: yaw rate and yaw angle, yaw angle and path, path
//! and time. A unit that is off, a mirrored axis, a compass heading or positions that are held between
//! fixes give a motion that no vehicle has, and each is found with what would mend it.
//!
//! ```text
//! yaw rate   ψ against ∫r dt, both about their means: the slope of a line through the origin
//! compass    course + ψ = π/2 wherever the vehicle drives and the course turns
//! mirror     course + ψ = 0 likewise
//! offset     ψ − course = ±π/2 wherever the vehicle drives
//! held       at speed most places stand in several rows
//! ```
//!
//! A path along an axis that does not turn leaves open whether ψ is that of a compass or has an offset; both are then
//! told. Across its heading a vehicle moves only while it slides, which makes it slower and does not turn with a bend: an
//! angle between both that stays is no contradiction where it slows down on a straight path, nor where velocities in body
//! axes say the same.
//!
//! A vehicle that spins moves in directions that have nothing to do with its heading; the path is compared
//! with the heading only where one of these relations holds all along while the course turns, which no spin
//! does.

use std::fmt;

use crate::data::course::{DRIVING_M_S, OfCourse, against_path, at_the_start, to_a_side};
use crate::data::yaw_rate::against_yaw_rate;
use crate::data::{Channel, TimeSeries, VelocityFit, velocity_fit};

/// Deviation of a slope from a known factor.
pub(super) const FACTOR_REACH: f64 = 0.15;
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
    /// The yaw angle is counted in the right sense, but from another axis than X.
    Offset {
        /// How far it is to the left of the direction of motion, rad.
        angle_rad: f64,
    },
    /// One of the two; the path does not turn, so that it does not tell which.
    CompassOrOffset {
        /// How far it is to the left of the direction of motion, rad.
        angle_rad: f64,
    },
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
    let by_path = || match against_path(series) {
        OfCourse::Contradiction(found) => Some(found),
        OfCourse::Along(_) => None,
        OfCourse::Open => at_the_start(series),
    };
    let by_path = if held.is_some() { None } else { by_path() };
    // Velocities in body axes that give the path have the heading from it.
    let is_confirmed = || velocity_fit(series) == Some(VelocityFit::Body);
    let by_path = by_path.filter(|found| !found.is_of_angle() || !is_confirmed());
    [held, against_yaw_rate(series), by_path].into_iter().flatten().collect()
}

/// Positions of which each stands in several rows at speed. Those of a coarse resolution do too, but go on by
/// one step of it; between fixes a vehicle goes much farther than that.
pub(super) fn held_positions(series: &TimeSeries) -> Option<Contradiction> {
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
    /// Whether it is that of an angle that stays between the yaw angle and the direction of motion.
    fn is_of_angle(self) -> bool {
        matches!(self, Self::Compass | Self::Offset { .. } | Self::CompassOrOffset { .. })
    }

    /// What can be done where no change of the map is known to help.
    pub(super) fn advice(self) -> &'static str {
        match self {
            Self::YawRate { .. } => "check both columns and their units",
            Self::YawRateUnrelated => "check which columns they are",
            Self::Compass => "turn the headings into yaw angles",
            Self::Offset { .. } => "count the yaw angle from the X axis",
            Self::CompassOrOffset { .. } => {
                "turn the headings into yaw angles, or count them from the X axis"
            }
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
            Self::Offset { angle_rad } => write!(
                f,
                "the yaw angle is {} of the direction of motion all along: it is counted from another axis",
                to_a_side(angle_rad)
            ),
            Self::CompassOrOffset { angle_rad } => write!(
                f,
                "the yaw angle is {} of the direction of motion: a compass heading, clockwise from north, or an angle \
                 that is counted from another axis, which a path that does not turn leaves open",
                to_a_side(angle_rad)
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
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::data::course::{backwards_note, offset_note};
    use crate::numerics::wrap_angle_rad;

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

    /// A yaw angle that is counted from another axis turns with the path, which that of a compass does not.
    #[test]
    fn an_offset_is_told_from_a_compass_by_the_turn_of_the_path() {
        for quarter in [FRAC_PI_2, -FRAC_PI_2] {
            let found = changed(Channel::Yaw, |yaw| yaw + quarter);
            let [Contradiction::Offset { angle_rad }] = found[..] else { panic!("{found:?}") };
            assert!((angle_rad - quarter).abs() < 0.01, "{angle_rad}");
            let side = if quarter > 0.0 { "90 deg to the left" } else { "90 deg to the right" };
            assert!(found[0].to_string().contains(side), "{}", found[0]);
        }
        // A car that drives backwards along the bend, which is faster than a car does so, and one that drifts along it.
        assert_eq!(changed(Channel::Yaw, |yaw| yaw + PI), []);
        let reversed = bend(|of, value| if of == Channel::Yaw { value + PI } else { value });
        let note = backwards_note(&reversed).expect("a remark").to_string();
        assert!(note.contains("at 15 m/s") && note.contains("yaw_offset=180:deg"), "{note}");
        assert_eq!(backwards_note(&bend(|_, value| value)), None);
        assert_eq!(changed(Channel::Yaw, |yaw| yaw + 0.7), []);
        let drift = bend(|of, value| if of == Channel::Yaw { value + 0.7 } else { value });
        let note = offset_note(&drift).expect("a remark").to_string();
        assert!(
            note.contains("40 deg to the left") && note.contains("yaw_offset=-40:deg"),
            "{note}"
        );
        assert_eq!(offset_note(&bend(|_, value| value)), None);
    }

    /// Along an axis a compass and an offset are the same; at an angle to the axes they are not.
    #[test]
    fn a_straight_drive_tells_an_offset_where_a_compass_would_be_another() {
        let time_s: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.02).collect();
        let drive = |course_rad: f64, yaw_rad: f64| {
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            let along = |per_second: f64| time_s.iter().map(|t| per_second * t).collect();
            let (sin, cos) = course_rad.sin_cos();
            series.insert(Channel::X, along(15.0 * cos)).unwrap();
            series.insert(Channel::Y, along(15.0 * sin)).unwrap();
            series.insert(Channel::Yaw, vec![yaw_rad; time_s.len()]).unwrap();
            contradictions(&series)
        };
        for (course_rad, yaw_rad) in [(0.0, FRAC_PI_2), (FRAC_PI_2, 0.0), (PI, -FRAC_PI_2)] {
            let found = drive(course_rad, yaw_rad);
            let is_open = matches!(found[..], [Contradiction::CompassOrOffset { .. }]);
            assert!(is_open, "{course_rad}: {found:?}");
        }
        let offset = drive(0.6, 0.6 + FRAC_PI_2);
        assert!(matches!(offset[..], [Contradiction::Offset { .. }]), "{offset:?}");
        assert_eq!(drive(0.2, FRAC_PI_2 - 0.2), [Contradiction::Compass]);
        assert_eq!(drive(0.6, 0.6), []);
    }

    /// A car that brakes in a bend does not slide through it at a right angle.
    #[test]
    fn an_offset_is_found_in_a_bend_in_which_the_car_brakes() {
        let time_s: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.02).collect();
        let column = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            time_s.iter().map(|t| f(0.3 * t - 0.02 * t * t)).collect()
        };
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        series.insert(Channel::X, column(&|angle| 40.0 * angle.sin())).unwrap();
        series.insert(Channel::Y, column(&|angle| 40.0 * (1.0 - angle.cos()))).unwrap();
        series.insert(Channel::Yaw, column(&|angle| angle + FRAC_PI_2)).unwrap();
        let found = contradictions(&series);
        assert!(matches!(found[..], [Contradiction::Offset { .. }]), "{found:?}");
    }

    /// A car that is struck from the side and one that has turned by a quarter slide broadside until they stand.
    #[test]
    fn a_slide_across_the_heading_contradicts_nothing() {
        let slide = |duration_s: f64, course_rad: f64, yaw_rad: f64| {
            let time_s: Vec<f64> = (0..200).map(|i| f64::from(i) * duration_s / 199.0).collect();
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            let way_m = |t: &f64| 10.0 * t.min(1.4) - 3.5 * t.min(1.4).powi(2);
            let along = |share: f64| time_s.iter().map(|t| share * way_m(t)).collect();
            series.insert(Channel::X, along(course_rad.cos())).unwrap();
            series.insert(Channel::Y, along(course_rad.sin())).unwrap();
            series.insert(Channel::Yaw, vec![yaw_rad; time_s.len()]).unwrap();
            series
        };
        // The longer it stands afterwards, the fewer are the windows in which it moves.
        for duration_s in [1.4, 4.0, 9.0] {
            for (course_rad, yaw_rad) in [(0.0, FRAC_PI_2), (0.6, 0.6 - FRAC_PI_2), (PI, -1.5)] {
                let series = slide(duration_s, course_rad, yaw_rad);
                assert_eq!(contradictions(&series), [], "{duration_s} {course_rad}");
                let note = offset_note(&series).expect("a remark").to_string();
                assert!(note.contains("slides or drifts"), "{note}");
            }
        }
    }

    /// What speeds ahead and to the left say is no offset of the yaw angle.
    #[test]
    fn body_velocities_that_give_the_path_confirm_the_yaw_angle() {
        let time_s: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.02).collect();
        let drive = |[vx, vy]: [f64; 2]| {
            let mut series = TimeSeries::new(time_s.clone()).unwrap();
            let n_samples = time_s.len();
            let x_m = time_s.iter().map(|t| 15.0 * t).collect();
            for (channel, values) in [
                (Channel::X, x_m),
                (Channel::Y, vec![0.0; n_samples]),
                (Channel::Yaw, vec![FRAC_PI_2; n_samples]),
                (Channel::Vx, vec![vx; n_samples]),
                (Channel::Vy, vec![vy; n_samples]),
            ] {
                series.insert(channel, values).unwrap();
            }
            contradictions(&series)
        };
        assert_eq!(drive([0.0, -15.0]), []);
        let ahead = drive([15.0, 0.0]);
        assert!(matches!(ahead[..], [Contradiction::CompassOrOffset { .. }]), "{ahead:?}");
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
        // Along an axis it may have an offset as well; the path turns too little to tell.
        let open = motion(&|t| FRAC_PI_2 - turned(t));
        assert!(matches!(open[..], [Contradiction::CompassOrOffset { .. }]), "{open:?}");
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
