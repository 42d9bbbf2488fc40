//! A cell of an atlas beside rows that were computed for it alone.

use std::error::Error;

use impactlab_core::numerics::normal_cdf;
use impactlab_sweep::atlas::{Atlas, AtlasBuilder, SliceCell};
use impactlab_sweep::{Outcome, Rows};

/// A |z| beyond which one in 22 lies by chance.
const FAR: f64 = 2.0;

/// A probability with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    pub p: f64,
    pub error: f64,
}

/// An outcome in a cell of the atlas and in its own rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutcomeComparison {
    pub outcome: Outcome,
    pub atlas: Share,
    pub direct: Share,
}

impl OutcomeComparison {
    /// The difference over its standard error.
    pub fn z(&self) -> f64 {
        (self.direct.p - self.atlas.p) / self.direct.error.hypot(self.atlas.error)
    }

    /// Whether all rows or none have it, in both.
    fn is_same(&self) -> bool {
        [0.0, 1.0].iter().any(|p| self.atlas.p == *p && self.direct.p == *p)
    }
}

/// A cell in the atlas and in its own rows.
#[derive(Debug, Clone, PartialEq)]
pub struct CellComparison {
    /// Rows of the cell in the atlas.
    pub n_atlas_rows: u64,
    /// Its own rows without an answer.
    pub n_failed: u64,
    /// The outcomes that happen or not.
    pub outcomes: Vec<OutcomeComparison>,
    /// Further ones, those of all rows or of none in both.
    pub n_same: usize,
    /// tr R² of the correlations R of the outcomes.
    squared_correlations: f64,
}

impl CellComparison {
    /// Compares a cell with rows that all lie in it.
    ///
    /// - `at`: the bin of every axis that is held.
    pub fn new(atlas: &Atlas, at: &[Option<usize>], rows: &[Rows]) -> Result<Self, Box<dyn Error>> {
        let mut builder = AtlasBuilder::new(atlas.axes.clone())?;
        rows.iter().try_for_each(|rows| builder.add(rows))?;
        let [cell, direct] = [atlas.cell(at), builder.finish()?.cell(at)];
        let n_rows: usize = rows.iter().map(Rows::len).sum();
        if direct.n_rows() + direct.n_failed() != n_rows as u64 {
            return Err("rows of the cell lie outside of it".into());
        }
        let share = |cell: SliceCell| {
            let p = cell.mean.ok_or("the cell has too few rows")?;
            Ok::<_, &str>(Share { p, error: cell.error })
        };
        let probabilities = Outcome::ALL.iter().filter(|outcome| outcome.is_probability());
        let outcomes = probabilities.map(|&outcome| {
            let (atlas, direct) = (share(cell.measure(outcome))?, share(direct.measure(outcome))?);
            Ok::<_, &str>(OutcomeComparison { outcome, atlas, direct })
        });
        let outcomes = outcomes.collect::<Result<Vec<_>, &str>>()?;
        let (same, outcomes): (Vec<_>, Vec<_>) =
            outcomes.into_iter().partition(OutcomeComparison::is_same);
        let values: Vec<Vec<f64>> = outcomes.iter().map(|of| values(rows, of)).collect();
        Ok(Self {
            n_atlas_rows: cell.n_rows(),
            n_failed: direct.n_failed(),
            n_same: same.len(),
            squared_correlations: squared_correlations(&values),
            outcomes,
        })
    }
}

/// Deviations of an outcome in the rows with an answer, over their root sum of squares; zeros where there is
/// none.
fn values(rows: &[Rows], of: &OutcomeComparison) -> Vec<f64> {
    let columns = rows.iter().filter_map(|rows| rows.column(of.outcome.name()));
    let all = columns.flat_map(|column| column.values.iter().copied());
    let mut values: Vec<f64> = all.filter(|value| value.is_finite()).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let size = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>().sqrt();
    let scale = if size > 0.0 { 1.0 / size } else { 0.0 };
    values.iter_mut().for_each(|value| *value = scale * (*value - mean));
    values
}

/// The sum of the squared correlations of all pairs, each outcome with itself among them.
fn squared_correlations(values: &[Vec<f64>]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let others = values
        .iter()
        .enumerate()
        .flat_map(|(idx, a)| values.iter().take(idx).map(move |b| product(a, b).powi(2)));
    values.len() as f64 + 2.0 * others.sum::<f64>()
}

/// How well all cells agree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Probabilities that were compared.
    pub n: usize,
    /// Those of them whose |z| is beyond 2.
    pub n_beyond: usize,
    pub chi_square: f64,
    /// Degrees of freedom of χ², fewer than there are probabilities because they go together.
    pub freedom: f64,
    /// Probability of as great a χ².
    pub p: f64,
}

impl Agreement {
    /// Of independent cells; `None` where nothing is compared.
    pub fn new(cells: &[CellComparison]) -> Option<Self> {
        let z: Vec<f64> =
            cells.iter().flat_map(|cell| &cell.outcomes).map(OutcomeComparison::z).collect();
        if z.is_empty() {
            return None;
        }
        let squared: f64 = cells.iter().map(|cell| cell.squared_correlations).sum();
        let scale = squared / z.len() as f64;
        let chi_square = z.iter().map(|z| z * z).sum::<f64>() / scale;
        let freedom = z.len() as f64 / scale;
        Some(Self {
            n: z.len(),
            n_beyond: z.iter().filter(|z| z.abs() > FAR).count(),
            chi_square,
            freedom,
            p: chi_square_above(chi_square, freedom),
        })
    }
}

/// Probability that χ² is greater.
///
/// Source: Wilson and Hilferty (1931), Proceedings of the National Academy of Sciences 17, 684–688.
fn chi_square_above(chi_square: f64, freedom: f64) -> f64 {
    let variance = 2.0 / (9.0 * freedom);
    normal_cdf((1.0 - variance - (chi_square / freedom).cbrt()) / variance.sqrt())
}
