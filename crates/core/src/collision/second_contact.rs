//! Whether two vehicles meet again after they were in contact.
//!
//! Both are followed as rigid outlines on their own motions, in which no force acts between them:
//! from the instant at which their outlines overlap again, the motions are those of vehicles that
//! pass through each other.
//!
//! Assumption: where the outlines overlap when the force has ended, the vehicles have crushed each
//! other by this much. While they have not come apart they are in contact again only where the
//! overlap exceeds it by more than [`RENEWED_OVERLAP_M`].

use crate::collision::{
    Footprint, MovingFootprint, Pose, TOUCH_TOLERANCE_M, overlap_centre_m, overlap_m,
};
use crate::data::TimeSeries;

/// Overlap beyond that at the end of the force from which on vehicles that have not come apart are
/// in contact again, m. Outlines of vehicles that have crushed each other are not known more closely.
const RENEWED_OVERLAP_M: f64 = 0.1;

/// A second contact of two vehicles, which the motions do not know of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondContact {
    /// Time at which it begins, s.
    pub time_s: f64,
    /// Where the outlines overlap, world axes, m.
    pub point_m: [f64; 2],
    /// Speed at which the overlap grows, m/s.
    pub closing_speed_m_s: f64,
    /// Whether the vehicles were apart before.
    pub was_apart: bool,
}

impl SecondContact {
    /// Follows two vehicles from the end of their first contact; `None` if they do not meet again,
    /// or if a motion has no X or Y.
    ///
    /// - `struck`, `striking`: outlines and motions, of which X, Y and yaw are used;
    /// - `contact_end_s`: end of the force of the first contact, s.
    pub fn find(
        struck: (Footprint, &TimeSeries),
        striking: (Footprint, &TimeSeries),
        contact_end_s: f64,
    ) -> Option<Self> {
        let at = |time_s: f64| -> Option<[MovingFootprint; 2]> {
            let still = |(footprint, motion): (Footprint, &TimeSeries)| {
                Some(MovingFootprint::at_rest(footprint, Pose::from_motion(motion, time_s)?))
            };
            Some([still(struck)?, still(striking)?])
        };
        let overlap_at = |time_s: f64| at(time_s).map(|[t, b]| overlap_m(&t, &b));
        // Where a motion has ended, nothing is known of it.
        let last_s = |motion: &TimeSeries| motion.time_s().last().copied();
        let end_s = last_s(struck.1)?.min(last_s(striking.1)?);
        let followed = contact_end_s..=end_s;
        let mut before = (contact_end_s, overlap_at(contact_end_s)?);
        let (crushed_m, mut was_apart) = (before.1.max(0.0), false);
        for &time_s in struck
            .1
            .time_s()
            .iter()
            .filter(|time_s| followed.contains(time_s))
            .skip_while(|&&time_s| time_s <= contact_end_s)
        {
            let Some(depth_m) = overlap_at(time_s) else { break };
            was_apart |= depth_m < -TOUCH_TOLERANCE_M;
            let limit_m = if was_apart { 0.0 } else { crushed_m + RENEWED_OVERLAP_M };
            if depth_m > limit_m {
                let rate = (depth_m - before.1) / (time_s - before.0);
                let begin_s = time_s - (depth_m - limit_m) / rate;
                let [t, b] = at(time_s)?;
                let point_m = overlap_centre_m(&t, &b)?;
                return Some(Self { time_s: begin_s, point_m, closing_speed_m_s: rate, was_apart });
            }
            before = (time_s, depth_m);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::footprint::examples::CAR;
    use crate::data::Channel;

    /// A straight motion at the Y of the time, sampled every 10 ms over 4 s.
    fn motion(x_m: impl Fn(f64) -> f64, y_m: impl Fn(f64) -> f64) -> TimeSeries {
        let time_s: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.01).collect();
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        let sampled = |f: &dyn Fn(f64) -> f64| time_s.iter().map(|&t| f(t)).collect();
        series.insert(Channel::X, sampled(&x_m)).unwrap();
        series.insert(Channel::Y, sampled(&y_m)).unwrap();
        series.insert(Channel::Yaw, vec![0.0; time_s.len()]).unwrap();
        series
    }

    fn meet(struck: &TimeSeries, striking: &TimeSeries) -> Option<SecondContact> {
        SecondContact::find((CAR, struck), (CAR, striking), 0.1)
    }

    #[test]
    fn a_struck_that_slows_down_is_struck_again() {
        // Apart at 2 m/s after the impact, then the struck vehicle stops in front of the striking
        // vehicle.
        let struck = motion(|t| if t < 1.0 { 12.0 * t } else { 12.0 }, |_| 0.0);
        let striking = motion(|t| -4.8 + 10.0 * t, |_| 0.5);
        let second = meet(&struck, &striking).unwrap();
        assert!((second.time_s - 1.2).abs() < 1e-9, "{second:?}");
        assert!((second.closing_speed_m_s - 10.0).abs() < 1e-9, "{second:?}");
        assert!(second.was_apart);
        // The struck vehicle's rear at 12 m − 2.6 m, the middle of the shared width.
        assert!((second.point_m[0] - 9.4).abs() < 0.11, "{second:?}");
        assert!((second.point_m[1] - 0.25).abs() < 1e-9, "{second:?}");
    }

    #[test]
    fn vehicles_that_part_or_stay_as_they_are_do_not_meet_again() {
        let struck = motion(|t| 12.0 * t, |_| 0.0);
        for (gap_m, speed_m_s) in [(0.0, 10.0), (-0.3, 12.0), (-0.3, 12.02), (0.5, 12.0)] {
            let striking = motion(|t| -4.8 - gap_m + speed_m_s * t, |_| 0.5);
            assert_eq!(meet(&struck, &striking), None, "{gap_m} {speed_m_s}");
        }
    }

    #[test]
    fn crushed_vehicles_that_go_deeper_are_in_contact_again() {
        let struck = motion(|t| 12.0 * t, |_| 0.0);
        let striking = motion(|t| -4.5 + 13.0 * t, |_| 0.5);
        let second = meet(&struck, &striking).unwrap();
        assert!(!second.was_apart, "{second:?}");
        assert!((second.time_s - 0.2).abs() < 1e-9, "{second:?}");
    }
}
