//! Where, when and after what distance a vehicle comes to rest, over draws of its motion.

use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::uncertainty::{PlanarMixture, PlanarPart};
use impactlab_core::units::Estimate;

/// Largest number of groups into which draws are divided by where they end.
const MAX_GROUPS: usize = 24;
/// Smallest number of draws in a group, so that their covariance means something.
const LEAST_GROUP: usize = 8;
/// Length with which a heading is compared with positions, m/rad: half of a car.
const HEADING_ARM_M: f64 = 2.3;

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

    /// The outcome over draws; `None` without any.
    pub fn from_ends(ends: &[MotionEnd], limit_s: f64) -> Option<Self> {
        if ends.is_empty() {
            return None;
        }
        let spread =
            |value: fn(&MotionEnd) -> f64| Estimate::from_draws(ends.iter().map(value).collect());
        let moving: Vec<f64> =
            ends.iter().filter(|end| !end.is_at_rest).map(|end| end.speed_m_s).collect();
        let position = position_of(ends);
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

/// The distribution of the position in which draws end: a normal distribution for each group.
fn position_of(ends: &[MotionEnd]) -> PlanarMixture {
    let part = |group: Vec<usize>| {
        let points: Vec<[f64; 2]> =
            group.iter().filter_map(|&idx| ends.get(idx)).map(|end| [end.x_m, end.y_m]).collect();
        let n = points.len().max(1) as f64;
        let mean = [0, 1].map(|axis| points.iter().map(|p| p[axis]).sum::<f64>() / n);
        let product = |a: usize, b: usize| {
            let sum: f64 = points.iter().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum();
            sum / (n - 1.0).max(1.0)
        };
        PlanarPart { weight: n, mean, covariance: [product(0, 0), product(0, 1), product(1, 1)] }
    };
    PlanarMixture::new(groups(ends).into_iter().map(part).collect())
}

/// Divides draws into groups that end near each other: the largest group is halved at the median of
/// the quantity in which it is widest, position or heading, as long as there are enough draws.
pub(super) fn groups(ends: &[MotionEnd]) -> Vec<Vec<usize>> {
    let numbers = |idx: usize| {
        let end = ends.get(idx);
        end.map_or([0.0; 3], |end| [end.x_m, end.y_m, end.yaw_rad * HEADING_ARM_M])
    };
    let mut groups: Vec<Vec<usize>> = vec![(0..ends.len()).collect()];
    while groups.len() < MAX_GROUPS {
        let largest = (0..groups.len()).max_by_key(|&i| groups[i].len()).unwrap_or(0);
        if groups[largest].len() < 2 * LEAST_GROUP {
            break;
        }
        let mut group = groups.swap_remove(largest);
        let width = |axis: usize| {
            let values = || group.iter().map(|&idx| numbers(idx)[axis]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let axis = (0..3).max_by(|&a, &b| width(a).total_cmp(&width(b))).unwrap_or(0);
        group.sort_by(|&a, &b| numbers(a)[axis].total_cmp(&numbers(b)[axis]));
        let upper = group.split_off(group.len() / 2);
        groups.extend([group, upper]);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn groups_hold_every_draw_once_and_those_that_end_alike() {
        let ends: Vec<MotionEnd> = (0..200)
            .map(|i| end(f64::from(i % 100) * 0.01, if i < 100 { 0.0 } else { 3.0 }, true))
            .collect();
        let groups = groups(&ends);
        let mut all: Vec<usize> = groups.iter().flatten().copied().collect();
        all.sort_unstable();
        assert_eq!(all, (0..200).collect::<Vec<usize>>());
        assert!(groups.iter().all(|group| group.len() >= LEAST_GROUP), "{groups:?}");
        // Those that have turned and those that have not are never together.
        assert!(
            groups
                .iter()
                .all(|group| group.iter().all(|idx| *idx < 100)
                    || group.iter().all(|idx| *idx >= 100))
        );
    }

    #[test]
    fn draws_that_still_move_are_said_and_count_as_lower_bounds() {
        let ends: Vec<MotionEnd> = (1..=100).map(|i| end(f64::from(i), 0.0, i <= 60)).collect();
        let rest = RestOutcome::from_ends(&ends, 50.0).unwrap();
        assert!((rest.share_at_rest - 0.6).abs() < 1e-12, "{rest:?}");
        assert_eq!(rest.moving_speed_m_s, Some(1.0));
        assert!((rest.distance_m.median - 50.5).abs() < 1e-9, "{rest:?}");
        assert!(rest.distance_m.ninety()[1] > 94.0, "{rest:?}");
        assert!(RestOutcome::from_ends(&ends[..60], 50.0).unwrap().moving_speed_m_s.is_none());
        assert_eq!(RestOutcome::from_ends(&[], 50.0), None);
    }
}
