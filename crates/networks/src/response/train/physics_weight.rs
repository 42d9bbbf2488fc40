//! How strongly physics holds the network: λ_physics over the epochs, the quality of the data about
//! an instant, and the balance between data and physics.
//!
//! ```text
//! λ(epoch) = λ_min + (λ_max − λ_min) σ(±(epoch − t₀)/τ)
//! DataQuality = exp(−d/h)      d: distance to the nearest instant of the data
//! balance = L_data/(L_data + λ L_physics)      where it is below ½: λ ← λ max(0.1, balance)
//! ```
//!
//! Source: `eq:adaptive_weights` and what follows in [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper).
//!
//! Departures from the paper:
//! - Its words say that the weight falls with the epochs, its formula that it grows, and its
//!   DataQuality gives physics the least weight where data are far: all three are there.
//! - The balance works on the scheduled λ of each epoch; as printed it shrinks for ever.

use kdtree::KdTree;
use kdtree::distance::squared_euclidean;
use rayon::prelude::*;

use crate::response::{N_FEATURES, PhysicsSchedule, PhysicsTrend};

/// Below this balance physics dominates.
const EVEN: f64 = 0.5;
/// The most by which balance lowers λ.
const LEAST_SHARE: f64 = 0.1;

impl PhysicsSchedule {
    /// λ of an epoch.
    ///
    /// - `epoch`: from 1;
    /// - `balance`: of the epoch before, 1 for the first.
    pub fn weight(&self, epoch: usize, balance: f64) -> f64 {
        let argument = (epoch as f64 - self.midpoint_epoch) / self.epoch_scale;
        let argument = match self.trend {
            PhysicsTrend::Paper => argument,
            PhysicsTrend::Decay | PhysicsTrend::InverseQuality => -argument,
        };
        let scheduled = self.min + (self.max - self.min) / (1.0 + (-argument).exp());
        if balance < EVEN { scheduled * balance.max(LEAST_SHARE) } else { scheduled }
    }

    /// Factor on λ at an instant.
    pub fn quality_factor(&self, quality: f64) -> f64 {
        match self.trend {
            PhysicsTrend::Paper | PhysicsTrend::Decay => quality,
            PhysicsTrend::InverseQuality => 1.0 - quality,
        }
    }

    /// DataQuality of instants, 0 to 1.
    ///
    /// - `data`: features of the instants of the data;
    /// - `at`: those asked for.
    pub(crate) fn qualities(
        &self,
        data: &[[f64; N_FEATURES]],
        at: &[[f64; N_FEATURES]],
    ) -> Vec<f64> {
        let scale = standard_deviations(data);
        let standardised = |row: &[f64; N_FEATURES]| -> [f64; N_FEATURES] {
            std::array::from_fn(|i| row[i] / scale[i])
        };
        let mut tree = KdTree::new(N_FEATURES);
        for row in data.iter().map(standardised) {
            // Only points with numbers that are not finite are refused; they are near to nothing.
            let _ = tree.add(row, ());
        }
        let quality = |row: &[f64; N_FEATURES]| {
            let nearest = tree.nearest(&standardised(row), 1, &squared_euclidean);
            let squared =
                nearest.ok().and_then(|found| found.first().map(|(squared, ())| *squared));
            let distance = (squared.unwrap_or(f64::INFINITY) / N_FEATURES as f64).sqrt();
            (-distance / self.quality_distance).exp()
        };
        at.par_iter().map(quality).collect()
    }
}

/// Standard deviation of each feature, 1 where it does not change.
fn standard_deviations(rows: &[[f64; N_FEATURES]]) -> [f64; N_FEATURES] {
    let n = rows.len().max(1) as f64;
    std::array::from_fn(|i| {
        let mean = rows.iter().map(|row| row[i]).sum::<f64>() / n;
        let variance = rows.iter().map(|row| (row[i] - mean).powi(2)).sum::<f64>() / n;
        if variance > 0.0 { variance.sqrt() } else { 1.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weight_grows_on_paper_and_falls_else() {
        let schedule = |trend| PhysicsSchedule { trend, ..PhysicsSchedule::default() };
        let (paper, decay) = (schedule(PhysicsTrend::Paper), schedule(PhysicsTrend::Decay));
        assert!(paper.weight(1, 1.0) < 1.0 && paper.weight(200, 1.0) > 9.9);
        assert!(decay.weight(1, 1.0) > 9.0 && decay.weight(200, 1.0) < 0.2);
        let middle = paper.midpoint_epoch as usize;
        assert!((paper.weight(middle, 1.0) - 5.05).abs() < 1e-9);
    }

    #[test]
    fn balance_lowers_the_weight_where_physics_dominates_but_not_for_ever() {
        let schedule = PhysicsSchedule::default();
        let plain = schedule.weight(10, 1.0);
        assert_eq!(schedule.weight(10, 0.6), plain);
        assert!((schedule.weight(10, 0.3) / plain - 0.3).abs() < 1e-12);
        assert!((schedule.weight(10, 1e-6) / plain - 0.1).abs() < 1e-12);
    }

    #[test]
    fn quality_falls_with_the_distance_to_the_nearest_instant() {
        let schedule = PhysicsSchedule::default();
        let mut data = [[0.0; N_FEATURES]; 3];
        for (i, row) in data.iter_mut().enumerate() {
            row[0] = i as f64;
        }
        let mut near = data[1];
        near[0] += 0.01;
        let mut far = data[1];
        far[3] = 5.0;
        let found = schedule.qualities(&data, &[data[2], near, far]);
        assert!((found[0] - 1.0).abs() < 1e-12 && found[1] < 1.0 && found[1] > 0.9, "{found:?}");
        // 5 in one of the standardised features: root of the mean square 5/√20.
        let expected = (-5.0 / (N_FEATURES as f64).sqrt() / 0.1).exp();
        assert!((found[2] / expected - 1.0).abs() < 1e-9, "{found:?}");
    }
}
