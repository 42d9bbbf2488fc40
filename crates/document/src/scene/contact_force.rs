//! The contact force of two vehicles over time, as an arrow along its line of action.

use crate::scene::{SceneForce, SceneRole};
use impactlab_core::collision::{Footprint, Pose};
use impactlab_core::data::Channel;
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};
use impactlab_study::analysis::Analysis;

/// Length of the arrow of the largest force, m; those of others are in proportion to their square roots,
/// so that a push can be seen beside a blow.
const LONGEST_M: f64 = 4.0;
/// Share of the largest force below which none is shown.
const LEAST_SHARE: f64 = 0.002;
/// How far from the outline a line of action may pass, as a factor on the half diagonal.
const REACH: f64 = 1.2;

/// The force on the struck vehicle of a motion through all contacts; `None` where it was not followed
/// through them, or nothing acts.
pub(super) fn contact_force(analysis: &Analysis, units: UnitSystem) -> Option<SceneForce> {
    analysis.pair.as_ref()?;
    let series = &analysis.simulation.as_ref()?.series;
    let [fx, fy, mz] =
        [Channel::FxBody, Channel::FyBody, Channel::Mz].map(|channel| series.get(channel));
    let [x, y, yaw] = [Channel::X, Channel::Y, Channel::Yaw].map(|channel| series.get(channel));
    let (fx, fy, mz, x, y, yaw) = (fx?, fy?, mz?, x?, y?, yaw?);
    let largest_n = fx.iter().zip(fy).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
    if !(largest_n > 0.0 && largest_n.is_finite()) {
        return None;
    }
    let arrow = |i: usize| -> Option<[[f64; 2]; 2]> {
        let force_n = [fx[i], fy[i]];
        let size_n = force_n[0].hypot(force_n[1]);
        if size_n < LEAST_SHARE * largest_n {
            return None;
        }
        let along = force_n.map(|part| part / size_n);
        let tip = entry_m(&analysis.footprint, along, mz[i] / size_n)?;
        let length_m = LONGEST_M * (size_n / largest_n).sqrt();
        let tail = [tip[0] - length_m * along[0], tip[1] - length_m * along[1]];
        let pose = Pose { x_m: x[i], y_m: y[i], yaw_rad: yaw[i] };
        Some([tail, tip].map(|end| pose.world_from_body(end)))
    };
    let size = NumberFormat::english(units).rough(Quantity::Force, largest_n);
    Some(SceneForce {
        name: format!("contact force, mean over 10 ms, up to {size}"),
        role: SceneRole::Evidence,
        time_s: series.time_s().to_vec(),
        arrows_m: (0..series.n_samples()).map(arrow).collect(),
    })
}

/// Where the line of action of a force enters a vehicle, in its body axes, m: the place of the outline
/// that the force reaches first, or, where it passes by, the place nearest to the CG.
///
/// - `along`: direction of the force;
/// - `arm_m`: moment about the CG over the force.
fn entry_m(footprint: &Footprint, [ux, uy]: [f64; 2], arm_m: f64) -> Option<[f64; 2]> {
    let nearest = [arm_m * uy, -arm_m * ux];
    let (front, half) = (footprint.cg_from_front_m, footprint.width_m / 2.0);
    let rear = front - footprint.length_m;
    let reach_m = REACH * (footprint.length_m.hypot(footprint.width_m)) / 2.0;
    if arm_m.is_nan() || arm_m.abs() >= 2.0 * reach_m {
        return None;
    }
    // Interval of the line inside of the rectangle.
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for (at, along, low, high) in [(nearest[0], ux, rear, front), (nearest[1], uy, -half, half)] {
        if along.abs() < 1e-9 {
            if !(low..=high).contains(&at) {
                return Some(nearest);
            }
            continue;
        }
        let ends = [(low - at) / along, (high - at) / along];
        from = from.max(ends[0].min(ends[1]));
        to = to.min(ends[0].max(ends[1]));
    }
    let way_m = if from < to { from } else { 0.0 };
    Some([nearest[0] + way_m * ux, nearest[1] + way_m * uy])
}

impl SceneForce {
    /// The arrow at a time, `[X, Y]`, m; `None` where no force acts.
    pub fn at(&self, time_s: f64) -> Option<[[f64; 2]; 2]> {
        // A sample is the mean over the interval that follows.
        let idx = self.time_s.partition_point(|time| *time <= time_s + 1e-9).checked_sub(1)?;
        *self.arrows_m.get(idx)?
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_action_enters_where_the_force_comes_from() {
        let footprint = Footprint { length_m: 4.0, width_m: 2.0, cg_from_front_m: 1.8 };
        // To the left, 1.5 m behind the CG: turns the car to the right.
        let entry = entry_m(&footprint, [0.0, 1.0], -1.5).unwrap();
        assert!((entry[0] + 1.5).abs() < 1e-12 && (entry[1] + 1.0).abs() < 1e-12, "{entry:?}");
        // From behind, 0.4 m to the right of the CG: turns the car to the left.
        let entry = entry_m(&footprint, [1.0, 0.0], 0.4).unwrap();
        assert!((entry[0] + 2.2).abs() < 1e-12 && (entry[1] + 0.4).abs() < 1e-12, "{entry:?}");
        // A line that passes by.
        assert_eq!(entry_m(&footprint, [0.0, 1.0], -3.0), Some([-3.0, 0.0]));
        assert_eq!(entry_m(&footprint, [0.0, 1.0], f64::NAN), None);
    }
}
