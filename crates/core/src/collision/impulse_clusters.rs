//! Groups (clusters) of collisions of similar impulse, found by [`Clusters`] on standardised
//! features of the force history. Results are reported per cluster in the comparison of models.

use serde::Serialize;

use crate::data::{ForceHistory, contact_interval};
use crate::numerics::{ClusterError, Clusters, Summary};

/// The features of a force history by which collisions are clustered. A collision and its mirror
/// image have the same features.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ImpulseFeatures {
    /// Impulse along the x axis of the history, N s.
    pub impulse_x_n_s: f64,
    /// Magnitude of the impulse along the y axis of the history, N s.
    pub impulse_y_n_s: f64,
    /// Magnitude of the impulse vector, N s.
    pub impulse_n_s: f64,
    /// Largest magnitude of the force, N.
    pub peak_n: f64,
    /// Mean of the magnitude of the force over the contact, N.
    pub mean_n: f64,
    /// Standard deviation of the magnitude of the force over the contact, N.
    pub std_n: f64,
}

/// Clusters of collisions, numbered from 0 in the order of rising impulse.
#[derive(Debug, Clone, PartialEq)]
pub struct ImpulseClusters {
    clusters: Clusters,
}

impl ImpulseFeatures {
    /// Computes the features of a force history. The contact lasts from the first to the last
    /// contact force ([`contact_interval`]). Returns `None` if all forces are zero.
    pub fn from_history(history: &ForceHistory) -> Option<Self> {
        let (from_s, to_s) = contact_interval(history)?;
        let [px, py] = history.impulse_n_s();
        let samples = history.time_s.iter().zip(history.fx_n.iter().zip(&history.fy_n));
        let in_contact = samples.filter(|(time_s, _)| (from_s..=to_s).contains(*time_s));
        let magnitude = Summary::from_values(in_contact.map(|(_, (x, y))| x.hypot(*y)))?;
        Some(Self {
            impulse_x_n_s: px,
            impulse_y_n_s: py.abs(),
            impulse_n_s: px.hypot(py),
            peak_n: magnitude.max,
            mean_n: magnitude.mean,
            std_n: magnitude.std,
        })
    }

    fn row(&self) -> Vec<f64> {
        let impulses = [self.impulse_x_n_s, self.impulse_y_n_s, self.impulse_n_s];
        impulses.into_iter().chain([self.peak_n, self.mean_n, self.std_n]).collect()
    }
}

impl ImpulseClusters {
    /// Clusters collisions by their features; see [`Clusters::fit`] for the method and the choice
    /// of the number of clusters.
    ///
    /// - `seed`: seed of the random initial centres; the same seed gives the same clusters.
    ///
    /// # Errors
    /// [`ClusterError`] if the features cannot be clustered.
    pub fn fit(features: &[ImpulseFeatures], seed: u64) -> Result<Self, ClusterError> {
        let rows: Vec<Vec<f64>> = features.iter().map(ImpulseFeatures::row).collect();
        let clusters = Clusters::fit(&rows, seed)?;
        let impulse_n_s = |centre: &[f64]| centre.get(2).copied().unwrap_or(0.0);
        Ok(Self { clusters: clusters.ordered_by(impulse_n_s) })
    }

    /// Number of clusters.
    pub fn n_clusters(&self) -> usize {
        self.clusters.n_clusters()
    }

    /// Index of the cluster whose centre is nearest to the features of a collision.
    pub fn nearest(&self, features: &ImpulseFeatures) -> usize {
        self.clusters.nearest(&features.row())
    }

    /// Name of a cluster in tables and figures: C0, C1, …
    pub fn label(cluster: usize) -> String {
        format!("C{cluster}")
    }

    /// Magnitude of the impulse at the centre of a cluster, N s; `None` if there is no such
    /// cluster.
    pub fn impulse_n_s(&self, cluster: usize) -> Option<f64> {
        self.clusters.centre(cluster)?.get(2).copied()
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use crate::data::Dataset;

    #[test]
    fn the_shipped_cases_cluster_by_rising_impulse() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("datasets/fea");
        let mut report = |_| ControlFlow::Continue(());
        let dataset = Dataset::load(&root, &mut report).unwrap().complete().unwrap();
        let histories: Vec<ForceHistory> =
            dataset.cases.iter().map(|case| case.force_history().unwrap()).collect();
        let features: Vec<ImpulseFeatures> = histories
            .iter()
            .map(|history| ImpulseFeatures::from_history(history).unwrap())
            .collect();
        let clusters = ImpulseClusters::fit(&features, 0).unwrap();
        assert!((2..=6).contains(&clusters.n_clusters()));
        let impulses: Vec<f64> =
            (0..clusters.n_clusters()).map(|c| clusters.impulse_n_s(c).unwrap()).collect();
        assert!(impulses.is_sorted(), "{impulses:?}");
        for ((case, history), features) in dataset.cases.iter().zip(&histories).zip(&features) {
            let fy_n = history.fy_n.iter().map(|force| -force).collect();
            let mirrored =
                ImpulseFeatures::from_history(&ForceHistory { fy_n, ..history.clone() }).unwrap();
            assert_eq!(clusters.nearest(&mirrored), clusters.nearest(features), "{}", case.name);
        }
        assert_eq!(clusters, ImpulseClusters::fit(&features, 0).unwrap());
    }
}
