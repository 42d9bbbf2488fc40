//! Draws the elements of a figure into its plot.

use std::sync::Arc;

use egui::{Color32, ColorImage, Id, Stroke, TextureHandle, TextureOptions};
use egui_plot::{
    Arrows, FilledArea, Line, LineStyle as PlotLineStyle, PlotImage, PlotPoint, PlotPoints, PlotUi,
    Points, Polygon, VLine,
};

use crate::cell_map;
use crate::theme;
use crate::thin::thinned;
use impactlab_document::figure::{FigureElement, HeatMap, LineStyle, Path, Series};

/// Opacity of the largest value of a heat map.
const HEAT_OPACITY: f32 = 0.85;

/// The texture of a heat map, which is kept from frame to frame, and the data from which it was
/// made.
#[derive(Clone)]
struct Picture {
    values: Arc<Vec<f64>>,
    color: Color32,
    texture: TextureHandle,
}

/// Draws a heat map as a picture. The opacity of a cell is proportional to the square root of its
/// value.
fn heat_map(plot: &mut PlotUi<'_>, map: &HeatMap, color: Color32) {
    let [width, height] = map.size;
    let largest = map.values.iter().copied().fold(0.0, f64::max);
    if width == 0 || height == 0 || largest <= 0.0 {
        return;
    }
    let [r, g, b, _] = color.to_array();
    // The first row of a picture is at the top.
    let rows = map.values.chunks_exact(width).rev();
    let pixel = |value: &f64| {
        let opacity = (value / largest).max(0.0).sqrt() * f64::from(HEAT_OPACITY);
        Color32::from_rgba_unmultiplied(r, g, b, (opacity * 255.0).round() as u8)
    };
    // The texture lives as long as its handle, which is kept until another picture replaces it.
    let id = Id::unique(("heat map", plot.response().id));
    let known: Option<Picture> = plot.ctx().data(|data| data.get_temp(id));
    let known =
        known.filter(|known| Arc::ptr_eq(&known.values, &map.values) && known.color == color);
    let picture = known.unwrap_or_else(|| {
        let image = ColorImage::new([width, height], rows.flatten().map(pixel).collect());
        let texture = plot.ctx().load_texture(&map.name, image, TextureOptions::LINEAR);
        let picture = Picture { values: Arc::clone(&map.values), color, texture };
        plot.ctx().data_mut(|data| data.insert_temp(id, picture.clone()));
        picture
    });
    let side = |axis: usize| map.step[axis] * map.size[axis] as f64;
    let centre = |axis: usize| map.low[axis] + 0.5 * (side(axis) - map.step[axis]);
    let at = PlotPoint::new(centre(0), centre(1));
    let size = [side(0) as f32, side(1) as f32];
    plot.image(PlotImage::new("", picture.texture.id(), at, size).allow_hover(false));
}

/// Draws an element with the colours of the dark or the light theme; on a logarithmic axis y is
/// replaced by its logarithm.
pub(crate) fn draw_element<'a>(
    plot: &mut PlotUi<'a>,
    dark: bool,
    element: &'a FigureElement,
    log_y: bool,
) {
    let color = theme::color(element.role(), dark);
    let stroke = Stroke::new(theme::line_width(element.role()), color);
    let style = |series: &Series| match series.style {
        LineStyle::Solid => PlotLineStyle::Solid,
        LineStyle::Dashed => PlotLineStyle::Dashed { length: series.role.dashes().length },
        LineStyle::Dotted => PlotLineStyle::Dotted { spacing: series.role.dashes().length },
    };
    let height = |y: f64| if log_y { y.log10() } else { y };
    let points = |series: &Series| {
        let mut points = thinned(&series.points).into_owned();
        points.iter_mut().for_each(|[_, y]| *y = height(*y));
        PlotPoints::from(points)
    };
    match element {
        FigureElement::Line(series) | FigureElement::Path(Path { series, .. }) => {
            let line = Line::new(&series.name, points(series)).stroke(stroke).style(style(series));
            // Bands, which merge points in one column of pixels, thin out what is steep.
            plot.line(line.allow_band(false));
        }
        FigureElement::Points(series) => {
            plot.points(Points::new(&series.name, points(series)).color(color).radius(3.0));
        }
        FigureElement::Polygon(series) => {
            let fill = color.gamma_multiply(theme::FILL_OPACITY);
            let polygon = Polygon::new(&series.name, points(series)).fill_color(fill);
            plot.polygon(polygon.stroke(stroke).style(style(series)));
        }
        FigureElement::Arrow(series) => {
            if let [from, to] = series.points[..] {
                let (origin, tip) = (PlotPoints::from(vec![from]), PlotPoints::from(vec![to]));
                plot.arrows(Arrows::new(&series.name, origin, tip).color(color).tip_length(10.0));
            }
        }
        FigureElement::HeatMap(map) => heat_map(plot, map, color),
        FigureElement::CellMap(map) => cell_map::draw(plot, map, dark),
        FigureElement::Band(band) => {
            let edge = |edge: &[f64]| edge.iter().map(|y| height(*y)).collect::<Vec<_>>();
            let (low, high) = (edge(&band.low), edge(&band.high));
            let area = FilledArea::new(&band.name, &band.x, &low, &high);
            plot.add(area.fill_color(color.gamma_multiply(band.opacity)));
        }
        FigureElement::VerticalLine { name, x, .. } => {
            plot.vline(VLine::new(name, *x).stroke(stroke).style(PlotLineStyle::dashed_dense()));
        }
    }
}
