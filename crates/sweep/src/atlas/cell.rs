//! What the rows of a cell amount to, and how sure that is.

use serde::Serialize;

use crate::Outcome;
use crate::atlas::HistogramKind;

/// Fewest rows of which a mean or a quantile is told.
pub const MIN_ROWS: u64 = 20;

/// Fewest shares of rows in which both networks apply, of rows with an answer, and of rows that come to rest
/// where the measure is that of a motion to rest, for a cell to be shown without hatching.
const LEAST_INSIDE: f64 = 0.5;
const LEAST_ANSWERED: f64 = 0.9;
const LEAST_AT_REST: f64 = 0.9;

/// Probability that a draw stays within the corridor, for its length and for its width.
const CORRIDOR: f64 = 0.9;

/// What a map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// The mean of an outcome; of one that happens or not its probability.
    Mean(Outcome),
    /// The length that 90 % of the rows stay within, m.
    CorridorLength,
    /// The distance to one side that 90 % of the rows stay within, m.
    CorridorWidth,
}

impl From<Outcome> for Measure {
    fn from(outcome: Outcome) -> Self {
        Self::Mean(outcome)
    }
}

impl Measure {
    /// Every measure: the outcomes in their order, then the corridor.
    pub fn all() -> impl Iterator<Item = Self> {
        let outcomes = Outcome::ALL.iter().copied().map(Self::Mean);
        outcomes.chain([Self::CorridorLength, Self::CorridorWidth])
    }

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean(outcome) => outcome.name(),
            Self::CorridorLength => "corridor_length_m",
            Self::CorridorWidth => "corridor_width_m",
        }
    }

    /// Its name for a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Mean(outcome) => outcome.label(),
            Self::CorridorLength => "length of the 90 % corridor",
            Self::CorridorWidth => "width of the 90 % corridor to one side",
        }
    }

    /// Its SI unit; `1` if it has none.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Mean(outcome) => outcome.unit(),
            Self::CorridorLength | Self::CorridorWidth => "m",
        }
    }

    /// Whether it is a probability.
    pub fn is_probability(self) -> bool {
        matches!(self, Self::Mean(outcome) if outcome.is_probability())
    }

    /// Whether it is one of a motion to rest: the rows that the time limit of the plan cuts off have too little
    /// of it, or are left out.
    fn needs_rest(self) -> bool {
        use Outcome as O;
        match self {
            Self::Mean(outcome) => matches!(
                outcome,
                O::TravelM | O::ReachM | O::OffsetM | O::RestTimeS | O::RestDistanceM
            ),
            Self::CorridorLength | Self::CorridorWidth => true,
        }
    }
}

/// Number, mean and sum of squared deviations of some values. Two are put together without the values.
///
/// Source: Chan, Golub and `LeVeque` (1983), The American Statistician 37, 242–247.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Moments {
    pub n: u64,
    pub mean: f64,
    pub m2: f64,
}

impl Moments {
    pub fn add(&mut self, value: f64) {
        self.merge(&Self { n: 1, mean: value, m2: 0.0 });
    }

    pub fn merge(&mut self, other: &Self) {
        if other.n == 0 {
            return;
        }
        let [n, n_other] = [self.n, other.n].map(|n| n as f64);
        let (total, apart) = (n + n_other, other.mean - self.mean);
        self.mean += apart * n_other / total;
        self.m2 += other.m2 + apart * apart * n * n_other / total;
        self.n += other.n;
    }

    /// Standard error of the mean: s/√n.
    fn error_of_mean(&self) -> f64 {
        let n = self.n as f64;
        if self.n < 2 { f64::INFINITY } else { (self.m2.max(0.0) / (n - 1.0) / n).sqrt() }
    }

    /// Standard error of a probability whose share is the mean, which is not zero where the share is 0 or 1:
    /// the standard deviation of the beta distribution with k + 1 and n − k + 1.
    fn error_of_share(&self) -> f64 {
        let n = self.n as f64;
        let p = (self.mean * n + 1.0) / (n + 2.0);
        (p * (1.0 - p) / (n + 3.0)).sqrt()
    }
}

/// The rows of one cell, or of many put together.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    pub(super) n_rows: u64,
    pub(super) n_failed: u64,
    pub(super) n_inside: u64,
    /// In the order of [`Outcome::ALL`].
    pub(super) moments: Vec<Moments>,
    /// In the order of [`HistogramKind::ALL`].
    pub(super) histograms: Vec<Vec<u32>>,
}

/// A measure of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SliceCell {
    /// Rows with an answer.
    pub n_rows: u64,
    /// Rows without one, which are in nothing else here.
    pub n_failed: u64,
    /// Rows to which the outcome applies.
    pub n_applies: u64,
    /// The measure, in its SI unit; `None` where fewer than [`MIN_ROWS`] rows have it, or a quantile
    /// lies beyond the histogram.
    pub mean: Option<f64>,
    /// What a quantile beyond the histogram is greater than, in the SI unit of the measure.
    pub more_than: Option<f64>,
    /// Its Monte Carlo standard error, of a probability with the most by which rows without an answer could
    /// move it; infinite (null in JSON) where there is no mean.
    pub error: f64,
    /// Share of the rows in which both networks apply by at least a half.
    pub inside: f64,
    /// Share of the rows that come to rest within the time limit of the plan, where the measure is one of a
    /// motion to rest; 1 for any other.
    pub at_rest: f64,
}

/// A quantile with its Monte Carlo standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quantile {
    /// The quantile.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// What 90 % of the rows stay within, each side by itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Corridor {
    /// Distance forward along the lane, m.
    pub length_m: Option<Quantile>,
    /// What the distance forward is greater than where it lies beyond the histogram, m.
    pub length_more_than_m: Option<f64>,
    /// Distance to one side, m.
    pub width_m: Option<Quantile>,
    /// What the distance to one side is greater than where it lies beyond the histogram, m.
    pub width_more_than_m: Option<f64>,
}

impl SliceCell {
    /// Whether there is a number: the measure, or what it is more than.
    pub fn is_told(&self) -> bool {
        self.mean.or(self.more_than).is_some()
    }

    /// Whether the measure, or what it is more than, may be relied upon: there are enough rows, nearly all
    /// have an answer and, where it matters, come to rest, and in most of them both networks apply.
    pub fn is_sound(&self) -> bool {
        let all = (self.n_rows + self.n_failed) as f64;
        self.is_told()
            && self.inside >= LEAST_INSIDE
            && self.at_rest >= LEAST_AT_REST
            && self.n_rows as f64 >= LEAST_ANSWERED * all
    }
}

impl Default for Cell {
    fn default() -> Self {
        Self {
            n_rows: 0,
            n_failed: 0,
            n_inside: 0,
            moments: vec![Moments::default(); Outcome::ALL.len()],
            histograms: HistogramKind::ALL.iter().map(|kind| vec![0; kind.n_bins()]).collect(),
        }
    }
}

impl Cell {
    /// Rows with an answer.
    pub fn n_rows(&self) -> u64 {
        self.n_rows
    }

    /// Rows without one.
    pub fn n_failed(&self) -> u64 {
        self.n_failed
    }

    /// Share of the rows in which both networks apply by at least a half.
    pub fn inside(&self) -> f64 {
        self.share(self.n_inside)
    }

    /// A number of its rows as a share of them.
    fn share(&self, n: u64) -> f64 {
        if self.n_rows == 0 { 0.0 } else { n as f64 / self.n_rows as f64 }
    }

    /// The most by which the rows without an answer could move a probability.
    fn failed_share(&self, probability: f64) -> f64 {
        let all = (self.n_rows + self.n_failed).max(1) as f64;
        self.n_failed as f64 / all * probability.max(1.0 - probability)
    }

    /// Puts the rows of another cell to those of this one.
    pub(super) fn merge(&mut self, other: &Self) {
        self.merge_counts(other);
        for (moments, other) in self.moments.iter_mut().zip(&other.moments) {
            moments.merge(other);
        }
        let histograms = self.histograms.iter_mut().zip(&other.histograms);
        for (count, other) in histograms.flat_map(|(of, other)| of.iter_mut().zip(other)) {
            *count = count.saturating_add(*other);
        }
    }

    /// The same of what a measure needs alone.
    pub(super) fn merge_for(&mut self, other: &Self, measure: Measure) {
        self.merge_counts(other);
        let (outcome, histogram) = parts_of(measure);
        let rest = Outcome::RestTimeS as usize;
        let with_rest = (measure.needs_rest() && outcome != rest).then_some(rest);
        for outcome in [Some(outcome), with_rest].into_iter().flatten() {
            let moments = self.moments.get_mut(outcome).zip(other.moments.get(outcome));
            if let Some((moments, other)) = moments {
                moments.merge(other);
            }
        }
        let Some(kind) = histogram else { return };
        let counts =
            self.histograms.get_mut(kind as usize).zip(other.histograms.get(kind as usize));
        for (count, other) in counts.into_iter().flat_map(|(of, other)| of.iter_mut().zip(other)) {
            *count = count.saturating_add(*other);
        }
    }

    fn merge_counts(&mut self, other: &Self) {
        self.n_rows += other.n_rows;
        self.n_failed += other.n_failed;
        self.n_inside += other.n_inside;
    }

    /// A measure of the cell.
    pub fn measure(&self, measure: impl Into<Measure>) -> SliceCell {
        let measure = measure.into();
        let (outcome, histogram) = parts_of(measure);
        let moments = self.moments.get(outcome).copied().unwrap_or_default();
        let estimate = match histogram {
            Some(kind) => self.quantile(kind, CORRIDOR),
            None if moments.n < MIN_ROWS => None,
            None => Some(Quantile {
                value: moments.mean,
                error: match measure.is_probability() {
                    true => moments.error_of_share().hypot(self.failed_share(moments.mean)),
                    false => moments.error_of_mean(),
                },
            }),
        };
        let n_at_rest = self.moments.get(Outcome::RestTimeS as usize).map_or(0, |rest| rest.n);
        SliceCell {
            n_rows: self.n_rows,
            n_failed: self.n_failed,
            n_applies: moments.n,
            mean: estimate.map(|estimate| estimate.value),
            more_than: histogram.and_then(|kind| self.beyond(kind, CORRIDOR)),
            error: estimate.map_or(f64::INFINITY, |estimate| estimate.error),
            inside: self.inside(),
            at_rest: if measure.needs_rest() { self.share(n_at_rest) } else { 1.0 },
        }
    }

    /// A quantile of the size of an outcome; `None` with fewer than [`MIN_ROWS`] rows that have it, or beyond
    /// the histogram.
    ///
    /// - `p`: its probability, 0 to 1.
    pub fn quantile(&self, kind: HistogramKind, p: f64) -> Option<Quantile> {
        kind.quantile(self.enough_counts(kind)?, p)
    }

    /// The end of the histogram, where a quantile lies beyond it.
    fn beyond(&self, kind: HistogramKind, p: f64) -> Option<f64> {
        let counts = self.enough_counts(kind)?;
        kind.quantile(counts, p).is_none().then(|| kind.end())
    }

    /// The counts of an outcome; `None` with fewer than [`MIN_ROWS`] rows that have it.
    fn enough_counts(&self, kind: HistogramKind) -> Option<&[u32]> {
        let counts = self.histograms.get(kind as usize)?;
        let n: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        (n >= MIN_ROWS).then_some(counts.as_slice())
    }

    /// What 90 % of the rows stay within.
    pub fn corridor(&self) -> Corridor {
        Corridor {
            length_m: self.quantile(HistogramKind::Reach, CORRIDOR),
            length_more_than_m: self.beyond(HistogramKind::Reach, CORRIDOR),
            width_m: self.quantile(HistogramKind::Offset, CORRIDOR),
            width_more_than_m: self.beyond(HistogramKind::Offset, CORRIDOR),
        }
    }
}

/// Number of the outcome of a measure, and the histogram that it is read from.
fn parts_of(measure: Measure) -> (usize, Option<HistogramKind>) {
    let histogram = match measure {
        Measure::Mean(outcome) => return (outcome as usize, None),
        Measure::CorridorLength => HistogramKind::Reach,
        Measure::CorridorWidth => HistogramKind::Offset,
    };
    (histogram.outcome() as usize, Some(histogram))
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use impactlab_core::numerics::random_stream;

    fn moments(values: impl Iterator<Item = f64>) -> Moments {
        let mut moments = Moments::default();
        values.for_each(|value| moments.add(value));
        moments
    }

    #[test]
    fn moments_put_together_are_those_of_all_values() {
        let values: Vec<f64> = (0..1000).map(|i| 1e4 + f64::from(i).sin()).collect();
        let all = moments(values.iter().copied());
        let mut parts = Moments::default();
        for chunk in values.chunks(17) {
            parts.merge(&moments(chunk.iter().copied()));
        }
        assert_eq!(parts.n, all.n);
        assert!((parts.mean - all.mean).abs() < 1e-9, "{parts:?} {all:?}");
        assert!((parts.m2 / all.m2 - 1.0).abs() < 1e-9, "{parts:?} {all:?}");
        let mean = values.iter().sum::<f64>() / 1000.0;
        let m2: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        assert!((all.m2 / m2 - 1.0).abs() < 1e-9, "{} {m2}", all.m2);
    }

    /// The error that is told of one cell is the scatter of many cells.
    #[test]
    fn the_errors_of_shares_and_means_are_the_scatter_of_cells() {
        let (n_cells, n_rows) = (4000, 200);
        for p in [0.05, 0.3, 0.9] {
            let mut rng = random_stream(7, "shares", (p * 100.0) as u64);
            let cells: Vec<Moments> = (0..n_cells)
                .map(|_| moments((0..n_rows).map(|_| f64::from(u8::from(rng.random::<f64>() < p)))))
                .collect();
            let of = moments(cells.iter().map(|cell| cell.mean));
            let scatter = (of.m2 / (of.n - 1) as f64).sqrt();
            let told = moments(cells.iter().map(Moments::error_of_share)).mean;
            assert!((told / scatter - 1.0).abs() < 0.07, "{p}: {told} {scatter}");
            let told = moments(cells.iter().map(Moments::error_of_mean)).mean;
            assert!((told / scatter - 1.0).abs() < 0.07, "{p}: {told} {scatter}");
        }
    }

    #[test]
    fn a_share_of_nothing_or_all_is_not_certain() {
        for value in [0.0, 1.0] {
            let all = moments((0..100).map(|_| value));
            assert!((0.005..0.02).contains(&all.error_of_share()), "{}", all.error_of_share());
        }
    }

    #[test]
    fn few_rows_have_no_mean() {
        let mut cell = Cell::default();
        let contact = Outcome::ContactS as usize;
        for i in 0..MIN_ROWS {
            assert_eq!(cell.measure(Outcome::ContactS).mean, None, "{i} rows");
            cell.n_rows += 1;
            cell.n_inside += 1;
            cell.moments[contact].add(0.5);
        }
        let told = cell.measure(Outcome::ContactS);
        assert_eq!((told.mean, told.error, told.inside), (Some(0.5), 0.0, 1.0));
        assert!(told.is_sound());
        cell.n_failed = MIN_ROWS;
        assert!(!cell.measure(Outcome::ContactS).is_sound());
        assert_eq!(cell.measure(Outcome::ReachM).mean, None);
    }

    /// A corridor wider than the histogram was told as “too few rows”, of 361 rows.
    #[test]
    fn a_corridor_beyond_the_histogram_is_more_than_its_end() {
        let kind = HistogramKind::Offset;
        let mut cell = Cell { n_rows: 100, n_inside: 100, ..Cell::default() };
        for i in 0..100 {
            let offset = if i < 80 { 5.0 } else { 90.0 };
            cell.moments[Outcome::OffsetM as usize].add(offset);
            cell.moments[Outcome::RestTimeS as usize].add(9.0);
            cell.histograms[kind as usize][kind.bin(offset)] += 1;
        }
        let told = cell.measure(Measure::CorridorWidth);
        assert_eq!((told.mean, told.more_than), (None, Some(kind.end())));
        assert!(told.is_told() && told.is_sound(), "{told:?}");
        assert_eq!(cell.corridor().width_more_than_m, Some(60.0));
        // Of the other corridor there are no rows.
        let other = cell.measure(Measure::CorridorLength);
        assert_eq!((other.mean, other.more_than, other.is_told()), (None, None, false));
    }

    /// A cell of 100 rows, of which some come to rest.
    fn cell_with_rests(n_at_rest: usize) -> Cell {
        let mut cell = Cell { n_rows: 100, n_inside: 100, ..Cell::default() };
        for i in 0..100 {
            cell.moments[Outcome::TravelM as usize].add(30.0 + f64::from(i));
            cell.moments[Outcome::Turns90 as usize].add(f64::from(u8::from(i < 20)));
        }
        (0..n_at_rest).for_each(|_| cell.moments[Outcome::RestTimeS as usize].add(9.0));
        cell
    }

    #[test]
    fn what_the_time_limit_cuts_off_is_not_sound() {
        for (n_at_rest, is_sound) in [(95, true), (60, false)] {
            let mut merged = Cell::default();
            merged.merge_for(&cell_with_rests(n_at_rest), Outcome::TravelM.into());
            for outcome in [Outcome::TravelM, Outcome::RestTimeS] {
                let told = merged.measure(outcome);
                assert_eq!(told.is_sound(), is_sound, "{outcome:?} {told:?}");
                assert_eq!(told.at_rest, n_at_rest as f64 / 100.0);
            }
        }
        let turns = cell_with_rests(60).measure(Outcome::Turns90);
        assert!(turns.is_sound() && turns.at_rest == 1.0, "{turns:?}");
    }

    #[test]
    fn rows_without_an_answer_widen_the_error_of_a_probability() {
        let mut cell = cell_with_rests(100);
        let all = cell.measure(Outcome::Turns90).error;
        cell.n_failed = 10;
        let told = cell.measure(Outcome::Turns90);
        // All of the ten could turn: 30 of 110 and not 20 of 100.
        assert!((told.error - all.hypot(0.8 * 10.0 / 110.0)).abs() < 1e-12, "{told:?} {all}");
        assert!(told.error > 30.0 / 110.0 - 0.2);
    }
}
