//! k-means clusters of standardised rows. Their number is that with the largest mean silhouette.
//!
//! Source of the silhouette: [`Rousseeuw1987`](crate::bibliography::Rousseeuw1987).

use linfa::DatasetBase;
use linfa::metrics::SilhouetteScore;
use linfa::traits::{Fit, Predict};
use linfa_clustering::KMeans;
use ndarray::{Array2, ArrayView1};
use rand_xoshiro::Xoshiro256Plus;
use rand_xoshiro::rand_core::SeedableRng;

use crate::numerics::Summary;

/// Numbers of clusters that are tried.
const N_CLUSTERS: std::ops::RangeInclusive<usize> = 2..=6;

/// Number of random initialisations of k-means for each number of clusters.
const N_RUNS: usize = 20;

/// Largest number of iterations after each initialisation.
const MAX_ITERATIONS: u64 = 500;

/// Share of the rows up to which a cluster is merged into the nearest one.
const SMALL_SHARE: f64 = 0.05;

/// Clusters of rows, with the standardisation of their columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    /// Mean of each column, in the unit of the rows.
    mean: Vec<f64>,
    /// Reciprocal standard deviation of each column; 0 for a column that does not vary.
    inverse_std: Vec<f64>,
    /// Centres of the clusters, standardised.
    centroids: Vec<Vec<f64>>,
    /// Index of the cluster of each row that the clusters were fitted to.
    pub members: Vec<usize>,
    /// Mean silhouette of the rows before small clusters were merged, −1 to 1. A large value means
    /// that the clusters are well separated.
    pub silhouette: f64,
}

/// The reason why rows cannot be clustered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ClusterError {
    /// There are too few rows.
    #[error("{got} rows to cluster, expected {expected} or more")]
    TooFew {
        /// Smallest number of rows.
        expected: usize,
        /// Number of rows that were given.
        got: usize,
    },
    /// A row has another length than the first one or contains a number that is not finite.
    #[error("row {row_idx} is not {expected} finite numbers")]
    Row {
        /// Index of the row, counted from 0.
        row_idx: usize,
        /// Number of values in the first row, which every row must have.
        expected: usize,
    },
    /// The k-means algorithm or its silhouette failed.
    #[error("k-means with {n_clusters} clusters failed: {reason}")]
    Fit {
        /// Number of clusters that was tried.
        n_clusters: usize,
        /// The message of the algorithm.
        reason: String,
    },
}

impl Clusters {
    /// Clusters rows, each column standardised by its mean and standard deviation. Of 2 to 6
    /// clusters the number with the largest mean silhouette is chosen; then clusters with at most 5
    /// % of the rows are merged into the nearest one.
    ///
    /// - `rows`: all of one length, with finite values.
    /// - `seed`: seed of the random initialisations; the same rows and seed give the same clusters.
    ///
    /// # Errors
    /// [`ClusterError::TooFew`] for fewer than three rows, [`ClusterError::Row`] for a row of
    /// another length or with a value that is not finite, and [`ClusterError::Fit`] if k-means
    /// fails.
    pub fn fit(rows: &[Vec<f64>], seed: u64) -> Result<Self, ClusterError> {
        let standardised = Self::standardisation(rows)?;
        let values: Vec<Vec<f64>> = rows.iter().map(|row| standardised.standardise(row)).collect();
        let n_columns = standardised.mean.len();
        let records = Array2::from_shape_fn((rows.len(), n_columns), |(i, j)| values[i][j]);
        let mut best: Option<Self> = None;
        for n_clusters in N_CLUSTERS.filter(|k| *k < rows.len()) {
            let found = standardised.with_k(&records, n_clusters, seed)?;
            if best.as_ref().is_none_or(|best| found.silhouette > best.silhouette) {
                best = Some(found);
            }
        }
        let few = ClusterError::TooFew { expected: N_CLUSTERS.start() + 1, got: rows.len() };
        let mut clusters = best.ok_or(few)?;
        clusters.merge_small(&values);
        Ok(clusters)
    }

    /// Number of clusters.
    pub fn n_clusters(&self) -> usize {
        self.centroids.len()
    }

    /// Centre of a cluster in the unit of the rows; `None` if there is no cluster of this index.
    pub fn centre(&self, cluster: usize) -> Option<Vec<f64>> {
        let scale =
            self.inverse_std.iter().map(|inverse| if *inverse > 0.0 { 1.0 / inverse } else { 0.0 });
        let values = self.centroids.get(cluster)?.iter().zip(&self.mean).zip(scale);
        Some(values.map(|((value, mean), std)| mean + std * value).collect())
    }

    /// Index of the cluster whose centre is nearest to a row, by the distance in standardised
    /// columns.
    pub fn nearest(&self, row: &[f64]) -> usize {
        nearest(&self.centroids, &self.standardise(row), None)
    }

    /// Renumbers the clusters in increasing order of a key of their centres.
    ///
    /// - `key`: computed from the centre of a cluster in the unit of the rows.
    #[must_use]
    pub fn ordered_by(mut self, key: impl Fn(&[f64]) -> f64) -> Self {
        let keyed = (0..self.n_clusters()).filter_map(|c| Some((key(&self.centre(c)?), c)));
        let mut order: Vec<(f64, usize)> = keyed.collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut rank = vec![0; order.len()];
        for (new, (_, old)) in order.iter().enumerate() {
            rank[*old] = new;
        }
        self.centroids = order.iter().map(|(_, old)| self.centroids[*old].clone()).collect();
        for member in &mut self.members {
            *member = rank[*member];
        }
        self
    }

    fn standardisation(rows: &[Vec<f64>]) -> Result<Self, ClusterError> {
        let expected = rows.first().map_or(0, Vec::len);
        let is_bad = |row: &Vec<f64>| row.len() != expected || !row.iter().all(|v| v.is_finite());
        if let Some(row_idx) = rows.iter().position(is_bad) {
            return Err(ClusterError::Row { row_idx, expected });
        }
        let column = |j: usize| Summary::from_values(rows.iter().map(|row| row[j]));
        let columns: Vec<Summary> = (0..expected).filter_map(column).collect();
        let inverse = |summary: &Summary| if summary.std > 0.0 { summary.std.recip() } else { 0.0 };
        Ok(Self {
            mean: columns.iter().map(|summary| summary.mean).collect(),
            inverse_std: columns.iter().map(inverse).collect(),
            centroids: Vec::new(),
            members: Vec::new(),
            silhouette: f64::NEG_INFINITY,
        })
    }

    fn standardise(&self, row: &[f64]) -> Vec<f64> {
        let values = row.iter().zip(&self.mean).zip(&self.inverse_std);
        values.map(|((value, mean), inverse)| (value - mean) * inverse).collect()
    }

    fn with_k(&self, records: &Array2<f64>, k: usize, seed: u64) -> Result<Self, ClusterError> {
        let failed = |reason: String| ClusterError::Fit { n_clusters: k, reason };
        let rng = Xoshiro256Plus::seed_from_u64(seed);
        let parameters =
            KMeans::params_with_rng(k, rng).n_runs(N_RUNS).max_n_iterations(MAX_ITERATIONS);
        let data = DatasetBase::from(records.clone());
        let model = parameters.fit(&data).map_err(|error| failed(error.to_string()))?;
        let labelled = model.predict(data);
        let silhouette = labelled.silhouette_score().map_err(|error| failed(error.to_string()))?;
        let row = |row: ArrayView1<'_, f64>| row.iter().copied().collect();
        Ok(Self {
            centroids: model.centroids().rows().into_iter().map(row).collect(),
            members: labelled.targets.iter().copied().collect(),
            silhouette,
            ..self.clone()
        })
    }

    /// Merges the smallest cluster into the nearest one as long as it has too few rows and another
    /// cluster is left. The centres become the means of their rows.
    ///
    /// - `values`: the standardised rows.
    fn merge_small(&mut self, values: &[Vec<f64>]) {
        while self.n_clusters() > 1 {
            let count = |c: usize| self.members.iter().filter(|member| **member == c).count();
            let smallest = (0..self.n_clusters()).min_by_key(|c| count(*c)).unwrap_or_default();
            if count(smallest) as f64 > SMALL_SHARE * values.len() as f64 {
                return;
            }
            let into = nearest(&self.centroids, &self.centroids[smallest], Some(smallest));
            for member in &mut self.members {
                *member = if *member == smallest { into } else { *member };
                *member -= usize::from(*member > smallest);
            }
            self.centroids.remove(smallest);
            self.centre_on_members(values);
        }
    }

    fn centre_on_members(&mut self, values: &[Vec<f64>]) {
        for (c, centroid) in self.centroids.iter_mut().enumerate() {
            let own: Vec<&Vec<f64>> = values
                .iter()
                .zip(&self.members)
                .filter(|(_, m)| **m == c)
                .map(|(v, _)| v)
                .collect();
            for (j, value) in centroid.iter_mut().enumerate() {
                *value = own.iter().map(|row| row[j]).sum::<f64>() / own.len().max(1) as f64;
            }
        }
    }
}

/// Index of the centre nearest to a standardised row. The centre with the index `but` is not
/// considered.
fn nearest(centroids: &[Vec<f64>], row: &[f64], but: Option<usize>) -> usize {
    let square = |a: &[f64]| a.iter().zip(row).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    let others = centroids.iter().enumerate().filter(|(c, _)| Some(*c) != but);
    let distances = others.map(|(c, centroid)| (square(centroid), c));
    distances.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, c)| c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows that scatter about three centres, `n` about each of them. The third column is constant.
    fn three(n: [usize; 3]) -> Vec<Vec<f64>> {
        let centres = [[0.0, 0.0, 7.0], [10.0, 1.0, 7.0], [0.0, 3.0, 7.0]];
        let mut rows = Vec::new();
        for (centre, n) in centres.iter().zip(n) {
            for i in 0..n {
                let (a, b) = ((i as f64).sin(), (1.7 * i as f64).cos());
                rows.push(vec![centre[0] + 0.5 * a, centre[1] + 0.1 * b, centre[2]]);
            }
        }
        rows
    }

    #[test]
    fn three_groups_are_three_clusters_ordered_by_the_key() {
        let rows = three([20, 15, 25]);
        let clusters = Clusters::fit(&rows, 5).unwrap().ordered_by(|centre| -centre[0] - centre[1]);
        assert_eq!(clusters.n_clusters(), 3);
        assert!(clusters.silhouette > 0.7, "{}", clusters.silhouette);
        assert!(clusters.members[20..35].iter().all(|member| *member == 0), "{clusters:?}");
        assert!(clusters.members[35..].iter().all(|member| *member == 1));
        assert!(clusters.members[..20].iter().all(|member| *member == 2));
        let centre = clusters.centre(0).unwrap();
        assert!((centre[0] - 10.0).abs() < 0.3 && (centre[2] - 7.0).abs() < 1e-9, "{centre:?}");
        assert_eq!(clusters.nearest(&[9.0, 1.2, 0.0]), 0);
    }

    #[test]
    fn the_same_seed_gives_the_same_clusters() {
        let rows = three([20, 15, 25]);
        assert_eq!(Clusters::fit(&rows, 1), Clusters::fit(&rows, 1));
    }

    #[test]
    fn small_clusters_join_the_nearest() {
        let clusters = Clusters::fit(&three([40, 30, 2]), 0).unwrap();
        assert_eq!(clusters.n_clusters(), 2);
        // The second centre is the nearer one in standardised columns.
        assert_eq!(clusters.members[70], clusters.members[40]);
    }

    #[test]
    fn bad_rows_are_refused() {
        assert!(matches!(Clusters::fit(&three([1, 1, 0]), 0), Err(ClusterError::TooFew { .. })));
        let mut rows = three([5, 5, 5]);
        rows[3][1] = f64::NAN;
        assert_eq!(Clusters::fit(&rows, 0), Err(ClusterError::Row { row_idx: 3, expected: 3 }));
    }
}
