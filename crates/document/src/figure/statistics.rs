//! What the curves of a figure do between two abscissae.

use crate::figure::{Figure, FigureElement, Series};
use impactlab_core::numerics::interpolate;

/// Numbers of one curve between two abscissae, in the units of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveStatistics {
    /// Name of the curve.
    pub name: String,
    /// Integral over x divided by the length of the interval.
    pub mean: f64,
    /// Smallest and largest ordinate.
    pub range: [f64; 2],
    /// Ordinate at the end less that at the start.
    pub change: f64,
    /// Integral over x by the trapezoidal rule.
    pub integral: f64,
}

/// The numbers of every curve of a figure between two abscissae, in the order of drawing. A curve that
/// does not reach over the whole interval is left out.
pub fn curve_statistics(figure: &Figure, span: [f64; 2]) -> Vec<CurveStatistics> {
    let curves = figure.elements.iter().filter_map(|element| match element {
        FigureElement::Line(series) => line_statistics(series, span),
        _ => None,
    });
    curves.collect()
}

fn line_statistics(series: &Series, [from, to]: [f64; 2]) -> Option<CurveStatistics> {
    let [x, y] =
        [0, 1].map(|axis| series.points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
    let is_covered =
        x.first().is_some_and(|first| *first <= from) && x.last().is_some_and(|last| *last >= to);
    if !is_covered || to <= from || x.windows(2).any(|pair| pair[1] < pair[0]) {
        return None;
    }
    let ends = [interpolate(&x, &y, from)?, interpolate(&x, &y, to)?];
    let inside = series.points.iter().copied().filter(|[x, _]| (from..to).contains(x) && *x > from);
    let points: Vec<[f64; 2]> =
        std::iter::once([from, ends[0]]).chain(inside).chain([[to, ends[1]]]).collect();
    let ordinates = || points.iter().map(|point| point[1]);
    let integral = points
        .windows(2)
        .map(|pair| (pair[1][0] - pair[0][0]) * (pair[0][1] + pair[1][1]) / 2.0)
        .sum::<f64>();
    Some(CurveStatistics {
        name: series.name.clone(),
        mean: integral / (to - from),
        range: [
            ordinates().fold(f64::INFINITY, f64::min),
            ordinates().fold(f64::NEG_INFINITY, f64::max),
        ],
        change: ends[1] - ends[0],
        integral,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{Axis, Role};
    use impactlab_core::units::{Quantity, UnitSystem};

    #[test]
    fn a_straight_line_between_two_of_its_samples() {
        let axis = |quantity| Axis::shown("", quantity, UnitSystem::Si);
        let line = |points| FigureElement::line("line", Role::Simulation, points);
        let elements = vec![
            line(vec![[0.0, 0.0], [1.0, 2.0], [2.0, 4.0], [3.0, 6.0]]),
            line(vec![[0.0, 0.0], [1.0, 2.0]]),
        ];
        let figure = Figure::new("", [axis(Quantity::Time), axis(Quantity::Force)], elements);
        let [found] = curve_statistics(&figure, [0.5, 2.5]).try_into().unwrap();
        assert_eq!(
            found,
            CurveStatistics {
                name: "line".to_owned(),
                mean: 3.0,
                range: [1.0, 5.0],
                change: 4.0,
                integral: 6.0,
            }
        );
        assert!(curve_statistics(&figure, [2.5, 0.5]).is_empty());
    }
}
