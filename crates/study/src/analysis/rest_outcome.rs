//! Where, when and after what distance a vehicle comes to rest, over draws of its motion.

use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::uncertainty::PlanarMixture;
use impactlab_core::units::Estimate;

/// Share of the draws at rest with which the vehicle is said to be at rest: the upper end of an interval
/// of 90 %.
const SHARE_AT_REST: f64 = 0.95;

/// Where one draw of a motion ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionEnd {
    /// Whether the vehicle is at rest; else what follows is at the limit of time.
    pub is_at_rest: bool,
    /// The instant since which it is at rest, s.
    pub time_s: f64,
    /// Length of the path of the CG, m.
    pub distance_m: f64,
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Heading, which goes on beyond a turn, rad.
    pub yaw_rad: f64,
    /// Speed of the CG, m/s.
    pub speed_m_s: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

/// Where, when and after what distance a vehicle comes to rest, SI units.
///
/// Draws that still move at the limit of time count with where they are then: times and distances are
/// longer than what is said of them. With less than 95 % at rest the upper ends of the 90 % intervals
/// are such lower bounds.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RestOutcome {
    /// Draws of the motion.
    pub n_draws: usize,
    /// Share of them in which the vehicle comes to rest.
    pub share_at_rest: f64,
    /// Time after which those that still move are followed no further, s.
    pub limit_s: f64,
    /// Time from the first contact to rest, s.
    pub time_s: Estimate,
    /// Length of the path of the CG to rest, m.
    pub distance_m: Estimate,
    /// X of the CG, m.
    pub x_m: Estimate,
    /// Y of the CG, m.
    pub y_m: Estimate,
    /// Heading, rad; a full turn counts as 2π.
    pub yaw_rad: Estimate,
    /// Area of the smallest region that holds the position with a probability of 50 %, m²; none
    /// after a second contact, which is not computed.
    pub region_50_m2: Option<f64>,
    /// Area of the smallest region that holds the position with a probability of 90 %, m²;
    /// likewise.
    pub region_90_m2: Option<f64>,
    /// Median speed of those that still move at the limit of time, m/s; none if all are at rest.
    pub moving_speed_m_s: Option<f64>,
}

impl RestOutcome {
    /// The same without what no longer holds after a second contact, which is not computed: intervals and
    /// regions.
    pub(crate) fn after_contact(&self) -> Self {
        let [x_m, y_m, yaw_rad, time_s, distance_m] =
            [&self.x_m, &self.y_m, &self.yaw_rad, &self.time_s, &self.distance_m]
                .map(Estimate::without_intervals);
        let (region_50_m2, region_90_m2) = (None, None);
        Self { x_m, y_m, yaw_rad, time_s, distance_m, region_50_m2, region_90_m2, ..*self }
    }

    /// Whether 95 % of the draws come to rest: the ends of 90 % intervals are then those of motions at rest.
    pub fn is_nearly_all_at_rest(&self) -> bool {
        self.share_at_rest >= SHARE_AT_REST
    }

    /// Time after which 95 % of the draws are at rest, s; `None` where fewer come to rest.
    pub fn nearly_all_at_rest_s(&self) -> Option<f64> {
        let [_, late_s] = self.time_s.interval(0.9)?;
        self.is_nearly_all_at_rest().then_some(late_s)
    }

    /// The outcome over draws; `None` without any.
    pub fn from_ends(ends: &[MotionEnd], limit_s: f64) -> Option<Self> {
        if ends.is_empty() {
            return None;
        }
        let spread =
            |value: fn(&MotionEnd) -> f64| Estimate::from_draws(ends.iter().map(value).collect());
        let moving: Vec<f64> =
            ends.iter().filter(|end| !end.is_at_rest).map(|end| end.speed_m_s).collect();
        let position = PlanarMixture::from_poses(&poses(ends));
        Some(Self {
            n_draws: ends.len(),
            share_at_rest: 1.0 - moving.len() as f64 / ends.len() as f64,
            limit_s,
            time_s: spread(|end| end.time_s),
            distance_m: spread(|end| end.distance_m),
            x_m: spread(|end| end.x_m),
            y_m: spread(|end| end.y_m),
            yaw_rad: spread(|end| end.yaw_rad),
            region_50_m2: Some(position.region_m2(0.5)),
            region_90_m2: Some(position.region_m2(0.9)),
            moving_speed_m_s: (!moving.is_empty()).then(|| Estimate::from_draws(moving).median),
        })
    }
}

/// Where draws end: X, Y, m, and heading, rad.
fn poses(ends: &[MotionEnd]) -> Vec<[f64; 3]> {
    ends.iter().map(|end| [end.x_m, end.y_m, end.yaw_rad]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::{Term, Value};

    fn end(x_m: f64, yaw_rad: f64, is_at_rest: bool) -> MotionEnd {
        MotionEnd {
            is_at_rest,
            time_s: x_m / 2.0,
            distance_m: x_m,
            x_m,
            y_m: 0.1 * x_m,
            yaw_rad,
            speed_m_s: 1.0,
            yaw_rate_rad_s: 0.0,
        }
    }

    #[test]
    fn draws_that_still_move_are_said_and_count_as_lower_bounds() {
        let ends: Vec<MotionEnd> = (1..=100).map(|i| end(f64::from(i), 0.0, i <= 60)).collect();
        let rest = RestOutcome::from_ends(&ends, 50.0).unwrap();
        assert!((rest.share_at_rest - 0.6).abs() < 1e-12, "{rest:?}");
        assert_eq!(rest.moving_speed_m_s, Some(1.0));
        assert!((rest.distance_m.median - 50.5).abs() < 1e-9, "{rest:?}");
        assert!(rest.distance_m.ninety()[1] > 94.0, "{rest:?}");
        assert_eq!(rest.nearly_all_at_rest_s(), None);
        let settled = RestOutcome::from_ends(&ends[..60], 50.0).unwrap();
        assert!(settled.moving_speed_m_s.is_none());
        let says = |rest: &RestOutcome, term: Term| {
            rest.facts(true).into_iter().any(|fact| fact.name == Value::Term(term))
        };
        assert!(says(&settled, Term::TimeToRest) && !says(&rest, Term::TimeToRest));
        assert!(says(&rest, Term::TimeToRestOrLimit));
        let late_s = settled.nearly_all_at_rest_s().unwrap();
        assert!((28.0..29.0).contains(&late_s), "{late_s}");
        assert_eq!(RestOutcome::from_ends(&[], 50.0), None);
    }
}
