//! Placement of the legend: in the corner of a plot where it hides least, or above a plot that is too low
//! for it.

use egui::{Color32, Label, RichText, Sense, Ui, Vec2};
use egui_plot::Corner;

use crate::theme;
use impactlab_document::figure::{Figure, FigureElement, Path, Series};

/// Share of the width and of the height of the plot that a legend is assumed to take.
const LEGEND_SHARE: [f64; 2] = [0.4, 0.45];
/// Approximate number of segments of a line that are taken into account; a longer line is sampled
/// evenly.
const MAX_SEGMENTS: usize = 400;
/// Number of points into which a segment is divided, so that it counts in proportion to its length.
const SEGMENT_POINTS: usize = 16;
/// Corners in order of preference.
const CORNERS: [Corner; 4] =
    [Corner::RightTop, Corner::LeftTop, Corner::RightBottom, Corner::LeftBottom];

/// Height of a name in a legend, and the share of the height of a plot that the legend may take, points.
const NAME_HEIGHT: f32 = 20.0;
const MAX_HEIGHT_SHARE: f32 = 0.55;

/// The first element of each name of a figure, in their order.
pub fn named(figure: &Figure) -> Vec<&FigureElement> {
    let mut named: Vec<&FigureElement> = Vec::new();
    for element in figure.elements.iter().filter(|element| !element.name().is_empty()) {
        if named.iter().all(|other| other.name() != element.name()) {
            named.push(element);
        }
    }
    named
}

/// Whether the legend of a figure has no place in a plot of this height, points: it would cover most of
/// it, or it would cover bars, which fill a plot from edge to edge.
pub fn has_no_place(figure: &Figure, height: f32) -> bool {
    let has_bars = !figure.y.names.is_empty();
    has_bars || named(figure).len() as f32 * NAME_HEIGHT > MAX_HEIGHT_SHARE * height
}

/// Draws the names of a figure with their colours in rows.
pub fn legend_row_ui(ui: &mut Ui, figure: &Figure) {
    let dark = ui.visuals().dark_mode;
    ui.horizontal_wrapped(|ui| {
        for element in named(figure) {
            let color = theme::color(element.role(), dark);
            let color = match element {
                FigureElement::Band(band) => color.gamma_multiply(band.opacity),
                _ => color,
            };
            dot_ui(ui, color);
            ui.add(Label::new(RichText::new(element.name()).small()).extend());
        }
    });
}

fn dot_ui(ui: &mut Ui, color: Color32) {
    let size = egui::TextStyle::Small.resolve(ui.style()).size;
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(size), Sense::hover());
    ui.painter().circle_filled(rect.center(), size / 3.0, color);
}

/// The corner of a figure where a legend hides the fewest points; among equal corners the first in
/// the order right top, left top, right bottom, left bottom.
pub fn emptiest_corner(figure: &Figure) -> Corner {
    let points: Vec<[f64; 2]> = figure.elements.iter().flat_map(points).collect();
    let range = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let ranges = [range(0), range(1)];
    let share = |point: &[f64; 2], axis: usize| {
        let (low, high) = ranges[axis];
        (point[axis] - low) / (high - low)
    };
    let hidden = |corner: &Corner| {
        let is_right = matches!(corner, Corner::RightTop | Corner::RightBottom);
        let is_top = matches!(corner, Corner::RightTop | Corner::LeftTop);
        let is_behind = |point: &&[f64; 2]| {
            let [x, y] = [share(point, 0), share(point, 1)];
            let from_side = if is_right { 1.0 - x } else { x };
            let from_edge = if is_top { 1.0 - y } else { y };
            from_side < LEGEND_SHARE[0] && from_edge < LEGEND_SHARE[1]
        };
        points.iter().filter(is_behind).count()
    };
    CORNERS.into_iter().min_by_key(hidden).unwrap_or(Corner::RightTop)
}

/// Points by which an element counts in the choice of the corner.
fn points(element: &FigureElement) -> Vec<[f64; 2]> {
    match element {
        FigureElement::Points(series) => series.points.clone(),
        FigureElement::Line(series)
        | FigureElement::Polygon(series)
        | FigureElement::Arrow(series)
        | FigureElement::Path(Path { series, .. }) => along(series),
        FigureElement::HeatMap(_) => Vec::new(),
        FigureElement::Band(band) => {
            let edge = |edge: &[f64]| band.x.iter().copied().zip(edge.iter().copied()).collect();
            let (low, high): (Vec<_>, Vec<_>) = (edge(&band.low), edge(&band.high));
            low.into_iter().chain(high).map(|(x, y)| [x, y]).collect()
        }
        FigureElement::VerticalLine { .. } => Vec::new(),
    }
}

/// Points at even steps along the segments of a line.
fn along(series: &Series) -> Vec<[f64; 2]> {
    let cut = |pair: &[[f64; 2]]| {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        (0..SEGMENT_POINTS).map(move |index| {
            let share = index as f64 / SEGMENT_POINTS as f64;
            [x0 + (x1 - x0) * share, y0 + (y1 - y0) * share]
        })
    };
    let stride = (series.points.len() / MAX_SEGMENTS).max(1);
    let points: Vec<[f64; 2]> = series.points.iter().copied().step_by(stride).collect();
    points.windows(2).flat_map(cut).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Quantity, UnitSystem};
    use impactlab_document::figure::{Axis, Role};

    fn figure(points: Vec<[f64; 2]>) -> Figure {
        let axis = Axis::shown("x", Quantity::Ratio, UnitSystem::Si);
        let line = FigureElement::line("line", Role::Simulation, points);
        Figure::new("", [axis.clone(), axis], vec![line])
    }

    #[test]
    fn a_legend_has_a_name_once_and_leaves_a_low_plot() {
        let mut figure = figure(vec![[0.0, 1.0], [1.0, 0.0]]);
        let of_line = figure.elements[0].clone();
        figure.elements.push(of_line);
        figure.elements.push(FigureElement::line("", Role::Muted, vec![[0.0, 0.0]]));
        figure.elements.push(FigureElement::line("other", Role::Target, vec![[0.0, 0.0]]));
        let names: Vec<&str> = named(&figure).iter().map(|element| element.name()).collect();
        assert_eq!(names, ["line", "other"]);
        assert!(has_no_place(&figure, 60.0));
        assert!(!has_no_place(&figure, 200.0));
        figure.y.names = vec!["a bar".to_owned()];
        assert!(has_no_place(&figure, 200.0));
    }

    #[test]
    fn the_legend_goes_where_the_line_is_not() {
        let falling = figure(vec![[0.0, 1.0], [1.0, 0.0]]);
        assert_eq!(emptiest_corner(&falling), Corner::RightTop);
        let rising = figure(vec![[0.0, 0.0], [1.0, 1.0]]);
        assert_eq!(emptiest_corner(&rising), Corner::LeftTop);
        let hook = figure(vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
        assert_eq!(emptiest_corner(&hook), Corner::RightBottom);
        assert_eq!(emptiest_corner(&figure(Vec::new())), Corner::RightTop);
    }
}
