//! Figures of the accuracy and calibration of predictions: predicted over observed values,
//! histogram of the probability integral transform (PIT), and coverage of prediction intervals.

use crate::figure::{Axis, Figure, FigureElement, Role};
use impactlab_core::units::{Quantity, Unit, UnitSystem};

/// An observed and a predicted value of a case, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct ParityPoint {
    /// Observed value.
    pub observed: f64,
    /// Predicted value.
    pub predicted: f64,
    /// Ends of the predicted interval, if there is one.
    pub interval: Option<[f64; 2]>,
    /// Whether the vehicles separate for good: they neither hook nor are in contact at the end of
    /// the run.
    pub is_clean: bool,
}

/// Coverage of the intervals of one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoveragePoint {
    /// Nominal level: the share of observed values that the intervals should contain, 0 to 1.
    pub level: f64,
    /// Share of observed values that the intervals contain, 0 to 1.
    pub share: f64,
    /// Standard error of `share`.
    pub standard_error: f64,
}

/// Predicted over observed values, with the line of equality.
///
/// - `title`, `label`: title of the figure and name of the quantity.
/// - `interval`: legend entry of the intervals, for example “90 % interval”.
pub fn parity_figure(
    title: &str,
    label: &str,
    interval: &str,
    points: &[ParityPoint],
    quantity: Quantity,
    units: UnitSystem,
) -> Figure {
    let x = Axis::shown(format!("{label}, observed"), quantity, units);
    let y = Axis::shown(format!("{label}, predicted"), quantity, units);
    let unit = x.unit;
    let values = points.iter().flat_map(|point| {
        let ends = point.interval.into_iter().flatten();
        [point.observed, point.predicted].into_iter().chain(ends)
    });
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let mut elements = Vec::new();
    if low <= high {
        let diagonal = [low, high].map(|value| [unit.from_si(value); 2]).to_vec();
        elements.push(FigureElement::dashed("equal", Role::Muted, diagonal));
    }
    for point in points {
        if let Some(ends) = point.interval {
            let bar = ends.map(|end| [unit.from_si(point.observed), unit.from_si(end)]).to_vec();
            elements.push(FigureElement::line(interval, Role::Muted, bar));
        }
    }
    for (name, role, clean) in
        [("separated", Role::Model, true), ("hooked or cut", Role::Validation, false)]
    {
        let of_kind = points.iter().filter(|point| point.is_clean == clean);
        let shown =
            |point: &ParityPoint| [point.observed, point.predicted].map(|v| unit.from_si(v));
        let of_kind: Vec<[f64; 2]> = of_kind.map(shown).collect();
        if !of_kind.is_empty() {
            elements.push(FigureElement::points(name, role, of_kind));
        }
    }
    Figure::new(title, [x, y], elements)
}

/// Histogram of the probability integral transform as a density. It is flat for a calibrated
/// distribution, high in the middle if the predicted spread is too wide, and high at the ends if it
/// is too narrow.
///
/// - `counts`: number of observed values in each of several bins of equal width from 0 to 1.
pub fn pit_figure(title: &str, counts: &[u32]) -> Figure {
    let x = Axis::shown("Predicted probability of less", Quantity::Ratio, UnitSystem::Si);
    let y = Axis::shown("Density", Quantity::Ratio, UnitSystem::Si);
    let (n_bins, total) = (counts.len().max(1) as f64, counts.iter().sum::<u32>().max(1));
    let bar = |(i, count): (usize, &u32)| {
        let [left, right] = [i, i + 1].map(|edge| edge as f64 / n_bins);
        let height = f64::from(*count) / f64::from(total) * n_bins;
        let outline = vec![[left, 0.0], [left, height], [right, height], [right, 0.0]];
        FigureElement::polygon("observed", Role::Model, outline)
    };
    let mut elements: Vec<FigureElement> = counts.iter().enumerate().map(bar).collect();
    elements.push(FigureElement::dashed("honest", Role::Reference, vec![[0.0, 1.0], [1.0, 1.0]]));
    Figure::new(title, [x, y], elements)
}

/// Share of observed values inside the predicted intervals over the nominal level of the intervals,
/// with bars of one standard error.
///
/// - `rows`: name, role and points of each prediction that is compared.
pub fn coverage_figure(title: &str, rows: &[(&str, Role, Vec<CoveragePoint>)]) -> Figure {
    let percent = percent();
    let axis = |label: &str| Axis::new(label, percent);
    let shown = |point: [f64; 2]| point.map(|value| percent.from_si(value));
    let diagonal = [[0.4, 0.4], [1.0, 1.0]].map(shown).to_vec();
    let mut elements = vec![FigureElement::dashed("honest", Role::Muted, diagonal)];
    for (name, role, points) in rows {
        for point in points {
            let end = |sign: f64| {
                let share = point.share + sign * point.standard_error;
                shown([point.level, share.clamp(0.0, 1.0)])
            };
            elements.push(FigureElement::line(*name, *role, vec![end(-1.0), end(1.0)]));
        }
        let curve: Vec<[f64; 2]> = points.iter().map(|p| shown([p.level, p.share])).collect();
        elements.push(FigureElement::line(*name, *role, curve.clone()));
        elements.push(FigureElement::points(*name, *role, curve));
    }
    let [x, y] = [axis("Interval should hold"), axis("Interval holds")];
    Figure::new(title, [x, y], elements)
}

/// The unit per cent.
fn percent() -> Unit {
    let units = Quantity::Ratio.units();
    *units.iter().find(|unit| unit.symbol == "%").unwrap_or(&units[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_of_the_histogram_have_area_one() {
        let figure = pit_figure("t", &[1, 3, 0, 4]);
        let area: f64 = figure
            .elements
            .iter()
            .filter_map(|element| match element {
                FigureElement::Polygon(bar) => {
                    Some((bar.points[2][0] - bar.points[1][0]) * bar.points[1][1])
                }
                _ => None,
            })
            .sum();
        assert!((area - 1.0).abs() < 1e-12, "{area}");
        assert_eq!(pit_figure("t", &[]).elements.len(), 1);
    }

    #[test]
    fn the_diagonal_of_equals_spans_all_points() {
        let point = |observed, predicted| ParityPoint {
            observed,
            predicted,
            interval: Some([predicted - 500.0, predicted + 500.0]),
            is_clean: observed > 2000.0,
        };
        let points = [point(1000.0, 2000.0), point(3000.0, 2500.0)];
        let parity = |interval, points: &[ParityPoint]| {
            parity_figure("t", "|P|", interval, points, Quantity::Impulse, UnitSystem::Si)
        };
        let figure = parity("90 % interval", &points);
        let FigureElement::Line(diagonal) = &figure.elements[0] else { unreachable!() };
        assert_eq!(diagonal.points, [[1.0, 1.0], [3.0, 3.0]]);
        assert_eq!(figure.elements.len(), 5);
        assert!(parity("", &[]).elements.is_empty());
    }
}
