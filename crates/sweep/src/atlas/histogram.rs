//! Histograms that every cell keeps of a few outcomes, so that quantiles can be read after cells are
//! put together.

use crate::Outcome;
use crate::atlas::Quantile;

/// An outcome of which every cell keeps a histogram of its size, without the sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum HistogramKind {
    /// Greatest distance forward along the lane, m.
    Reach,
    /// Greatest lateral distance, m.
    Offset,
    /// Greatest change of heading, rad.
    Turn,
}

impl HistogramKind {
    /// All of them.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// What is counted.
    pub fn outcome(self) -> Outcome {
        match self {
            Self::Reach => Outcome::ReachM,
            Self::Offset => Outcome::OffsetM,
            Self::Turn => Outcome::TurnRad,
        }
    }

    /// Numbers of bins and their width, from zero upwards, in the unit of the outcome. What lies beyond the
    /// last one is counted in one more.
    fn steps(self) -> &'static [(usize, f64)] {
        const TURN: &[(usize, f64)] = &[(36, 10_f64.to_radians()), (12, 30_f64.to_radians())];
        match self {
            Self::Reach => &[(20, 5.0), (10, 10.0), (10, 20.0)],
            Self::Offset => &[(20, 0.5), (20, 1.0), (10, 3.0)],
            Self::Turn => TURN,
        }
    }

    /// Ends of the bins, from zero upwards; the bin beyond the last one is open.
    pub fn edges(self) -> Vec<f64> {
        let mut edges = vec![0.0];
        let mut last = 0.0;
        for (n, width) in self.steps() {
            edges.extend((1..=*n).map(|i| last + i as f64 * width));
            last += *n as f64 * width;
        }
        edges
    }

    /// The end of the last bin that is not open.
    pub(super) fn end(self) -> f64 {
        self.steps().iter().map(|(n, width)| *n as f64 * width).sum()
    }

    /// Number of bins, with the open one.
    pub fn n_bins(self) -> usize {
        self.steps().iter().map(|(n, _)| n).sum::<usize>() + 1
    }

    /// The bin of a value.
    pub(super) fn bin(self, value: f64) -> usize {
        let (mut from, mut first) = (0.0, 0);
        let size = value.abs();
        for (n, width) in self.steps() {
            let end = from + *n as f64 * width;
            if size < end {
                return first + (((size - from) / width) as usize).min(n - 1);
            }
            (from, first) = (end, first + n);
        }
        first
    }

    /// Reads a quantile from counts, by linear interpolation within its bin.
    ///
    /// The standard error is half the distance of the quantiles whose probabilities lie one binomial
    /// standard deviation below and above, with what the bin hides: the less even the counts around it, the
    /// less is known of where in it the quantile lies, however many rows there are.
    ///
    /// - `p`: its probability, 0 to 1;
    /// - returns `None` without counts, and where the quantile lies in the open bin.
    pub(super) fn quantile(self, counts: &[u32], p: f64) -> Option<Quantile> {
        let n: f64 = counts.iter().map(|count| f64::from(*count)).sum();
        if n <= 0.0 {
            return None;
        }
        let edges = self.edges();
        let at = |p: f64| read_quantile(&edges, counts, p * n);
        let spread = (p * (1.0 - p) / n).sqrt();
        let (value, bin) = at(p)?;
        let (low, _) = at((p - spread).max(0.0))?;
        // Above the last edge nothing is known; the distance below stands for the one above.
        let high = at((p + spread).min(1.0)).map_or(2.0 * value - low, |(high, _)| high);
        let error = (0.5 * (high - low)).hypot(error_within(&edges, counts, bin));
        Some(Quantile { value, error })
    }
}

/// What linear interpolation within a bin may be off: a quarter of its width times the relative change of the
/// density to the next bins, and at most the standard deviation of a place in the bin.
fn error_within(edges: &[f64], counts: &[u32], bin: usize) -> f64 {
    let width = |bin: usize| Some(edges.get(bin + 1)? - edges.get(bin)?);
    let density = |bin: usize| Some(f64::from(*counts.get(bin)?) / width(bin)?);
    let (Some(width), Some(own)) = (width(bin), density(bin)) else { return 0.0 };
    // Below zero there is nothing; what lies beyond the last bin is not known.
    let before = bin.checked_sub(1).and_then(density).unwrap_or(own);
    let after = density(bin + 1).unwrap_or(0.0);
    let change = (before - own).abs().max((after - own).abs()) / own;
    (0.25 * change * width).min(width / 12_f64.sqrt())
}

/// Where a number of counts is reached, and the number of its bin.
fn read_quantile(edges: &[f64], counts: &[u32], wanted: f64) -> Option<(f64, usize)> {
    let mut below = 0.0;
    for (number, (bin, count)) in edges.windows(2).zip(counts).enumerate() {
        let [low, high] = bin else { continue };
        let count = f64::from(*count);
        if count > 0.0 && below + count >= wanted {
            let share = ((wanted - below) / count).clamp(0.0, 1.0);
            return Some((low + share * (high - low), number));
        }
        below += count;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_lies_within_the_edges_of_its_bin() {
        for kind in HistogramKind::ALL {
            let edges = kind.edges();
            assert_eq!(edges.len(), kind.n_bins(), "{kind:?}");
            assert!((edges[edges.len() - 1] - kind.end()).abs() < 1e-9, "{kind:?}");
            assert!(edges.windows(2).all(|pair| pair[0] < pair[1]), "{kind:?}");
            for i in 0..4000 {
                let value = 0.123 * f64::from(i);
                let bin = kind.bin(-value);
                let low = edges[bin];
                let high = edges.get(bin + 1).copied().unwrap_or(f64::INFINITY);
                let slack = 1e-9 * value.max(1.0);
                assert!(low <= value + slack && value <= high + slack, "{kind:?} {value} {bin}");
            }
        }
    }

    #[test]
    fn quantiles_of_an_even_spread_are_shares_of_it() {
        let kind = HistogramKind::Reach;
        let mut counts = vec![0; kind.n_bins()];
        for i in 0..1000 {
            counts[kind.bin(0.1 * f64::from(i) + 0.05)] += 1;
        }
        for p in [0.1, 0.5, 0.9] {
            let Quantile { value, error } = kind.quantile(&counts, p).unwrap();
            assert!((value - 100.0 * p).abs() < 0.2, "{p}: {value}");
            let expected = 100.0 * (p * (1.0 - p) / 1000.0).sqrt();
            assert!((error / expected - 1.0).abs() < 0.1, "{p}: {error} {expected}");
        }
    }

    #[test]
    fn many_rows_in_one_bin_do_not_say_where_in_it_they_are() {
        let kind = HistogramKind::Reach;
        let mut counts = vec![0; kind.n_bins()];
        counts[kind.bin(101.0)] = 1_000_000;
        let Quantile { value, error } = kind.quantile(&counts, 0.9).unwrap();
        assert!((value - 101.0).abs() > 7.0 && error > 2.4, "{value} {error}");
    }

    #[test]
    fn what_lies_beyond_the_last_edge_has_no_quantile() {
        let kind = HistogramKind::Offset;
        let mut counts = vec![0; kind.n_bins()];
        assert_eq!(kind.quantile(&counts, 0.5), None);
        counts[kind.bin(1e6)] = 10;
        counts[kind.bin(1.0)] = 90;
        assert!(kind.quantile(&counts, 0.5).is_some());
        assert_eq!(kind.quantile(&counts, 0.95), None);
    }
}
