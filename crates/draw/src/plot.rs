//! Draws a figure with egui_plot.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Id, Pos2, Rect, Stroke, TextStyle, TextureId, Ui, Vec2, Vec2b, pos2};
use egui_plot::{
    AxisHints, Line, LineStyle as PlotLineStyle, Plot, PlotBounds, PlotImage, PlotMemory,
    PlotPoint, PlotPoints, PlotUi, VLine,
};

use crate::axis_label::{GAP, label_in_part, label_that_fits, seen_part, shortened};
use crate::elements::draw_element;
use crate::legend::legend_ui;
use crate::theme;
use crate::ticks::{
    X_TICK_CELLS, Y_TICK_CELLS, grid, log_grid, log_tick_label, name_grid, name_label, tick_label,
};
use impactlab_core::units::{NumberFormat, significant};
use impactlab_document::figure::{Figure, FigureElement, Role};

/// Smallest width of the labels of the vertical axis, and width of a character of a name, points.
const LEAST_Y_AXIS_WIDTH: f32 = 44.0;
const CHARACTER_WIDTH: f32 = 6.5;

/// Height of the labels of the horizontal axis, points, and the smallest height of a plot with them.
const X_AXIS_HEIGHT: f32 = 36.0;
const LEAST_HEIGHT: f32 = 2.0 * X_AXIS_HEIGHT;

/// By how much a height may be rounded, points.
const ROUNDING: f32 = 0.5;

/// Logarithm of the zoom for each point that the wheel scrolls.
const ZOOM_PER_POINT: f32 = 0.004;

/// A picture below a figure on screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backdrop {
    /// The picture.
    pub texture: TextureId,
    /// The part of it that is drawn: its left upper and right lower corner as shares of width and height.
    pub part: [[f64; 2]; 2],
    /// The middle of this part, in the units of the axes.
    pub centre: [f64; 2],
    /// Width and height of this part, in the units of the axes.
    pub size: [f64; 2],
    /// By what it is turned about its middle, counter-clockwise, rad.
    pub turn_rad: f64,
}

/// Options for the placement of a figure.
#[derive(Debug, Clone)]
pub struct FigureOptions {
    /// Identifier that distinguishes the plots in a window; the title is used if it is empty.
    pub id: String,
    /// Group of plots that share the cursor and the horizontal axis.
    pub link: Option<Id>,
    /// Whether the plots of the group share the vertical axis, too.
    pub links_y: bool,
    /// Position of the cursor along x, in the unit of the axis; not drawn beyond the curves, whose axis it
    /// would stretch.
    pub cursor_x: Option<f64>,
    /// Two cursors along x, in the unit of the axis; likewise.
    pub span: Option<[f64; 2]>,
    /// Height of the plot, points; `None` for all the space that is available.
    pub height: Option<f32>,
    /// Whether the view is fitted to the data again.
    pub reset: bool,
    /// View `[lowest, highest]` of [x, y] in the units of the axes; `None` leaves the view to the
    /// user.
    pub view: Option<[[f64; 2]; 2]>,
    /// Whether a legend names the elements.
    pub legend: bool,
    /// Rows that the legend has at most.
    pub legend_rows: usize,
    /// Whether the primary pointer button moves the view of a figure seen from above.
    pub pans: bool,
    /// What lies below the elements of the figure.
    pub backdrop: Option<Backdrop>,
    /// Lines between both that are not of the figure, in the units of the axes.
    pub lines_below: Arc<Vec<Vec<[f64; 2]>>>,
}

impl Default for FigureOptions {
    fn default() -> Self {
        let (id, link, cursor_x, span, height) = (String::new(), None, None, None, None);
        Self {
            id,
            link,
            links_y: false,
            cursor_x,
            span,
            height,
            reset: false,
            view: None,
            legend: true,
            legend_rows: usize::MAX,
            pans: true,
            backdrop: None,
            lines_below: Arc::default(),
        }
    }
}

impl FigureOptions {
    /// What distinguishes the plot of a figure from the others in a window.
    fn plot_name<'a>(&'a self, figure: &'a Figure) -> &'a str {
        if self.id.is_empty() { &figure.title } else { &self.id }
    }
}

/// Interaction of the user with a figure.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FigureResponse {
    /// Position along x at which the user presses a pointer button, in the unit of the axis, to set
    /// the cursor.
    pub picked_x: Option<f64>,
    /// Where the user has pressed the primary pointer button in the figure, and where the pointer is
    /// now, while the button is down: [x, y] in the units of the axes.
    pub drag: Option<[[f64; 2]; 2]>,
    /// Where the pointer is in the figure: [x, y] in the units of the axes.
    pub pointer: Option<[f64; 2]>,
    /// Where the user has clicked in this frame with the primary button.
    pub clicked: Option<[f64; 2]>,
    /// View `[lowest, highest]` of [x, y] in the units of the axes.
    pub view: [[f64; 2]; 2],
    /// Distance along x that a point of the screen is wide, in the unit of the axis.
    pub x_per_point: f64,
}

/// Draws a figure into the space that is available. Hovering shows values in the units of the axes.
pub fn figure_ui(ui: &mut Ui, figure: &Figure, options: &FigureOptions) -> FigureResponse {
    let all = options.height.unwrap_or_else(|| ui.available_height());
    let top = ui.cursor().top();
    let hidden = if options.legend { hidden_ui(ui, figure, options) } else { BTreeSet::new() };
    let height = (all - (ui.cursor().top() - top)).max(LEAST_HEIGHT);
    let x_label = shortened(ui, &figure.x, ui.available_width() - y_axis_width(figure));
    let (left, seen) = (ui.cursor().left(), seen_part(ui, height - X_AXIS_HEIGHT));
    let y_label = match seen {
        // Takes the room of the text, which is drawn within the part that is seen.
        Some(_) => " ".to_owned(),
        None => label_that_fits(ui, &figure.y, height - X_AXIS_HEIGHT),
    };
    let id = ui.make_persistent_id(options.plot_name(figure));
    let is_first_time = PlotMemory::load(ui.ctx(), id).is_none();
    let x_height = x_axis_height(ui, &x_label);
    let mut plot = plot_with_axes(figure, options, [x_label, y_label], x_height).id(id);
    if figure.equal_aspect {
        plot = plot.data_aspect(1.0);
    }
    if options.height.is_some() {
        plot = plot.height(height);
    }
    if let Some(group) = options.link {
        let axes = Vec2b::new(true, options.links_y);
        plot = plot.link_axis(group, axes).link_cursor(group, axes);
    }
    let resets = options.reset && ui.ctx().current_pass_index() == 0;
    if resets {
        plot = plot.reset();
    }
    plot = including_places(plot, figure);
    let dark = ui.visuals().dark_mode;
    let response = plot.show(ui, |plot_ui| {
        if let Some([low, high]) = options.view {
            plot_ui.set_plot_bounds(PlotBounds::from_min_max(low, high));
        }
        if let Some(backdrop) = options.backdrop {
            draw_backdrop(plot_ui, backdrop);
        }
        draw_lines_below(plot_ui, options, dark);
        for element in figure.elements.iter().filter(|of| !hidden.contains(of.name())) {
            draw_element(plot_ui, dark, element, figure.log_y);
        }
        draw_cursors(plot_ui, figure, options, dark);
        if figure.equal_aspect && options.pans {
            zoom_by_wheel(plot_ui);
        }
        let picking = plot_ui.response().is_pointer_button_down_on();
        plot_ui.pointer_coordinate().filter(|_| picking).map(|point| point.x)
    });
    if is_first_time || resets {
        // The axes take the room that they took the last time: none in this pass.
        ui.ctx().request_discard("axes without room");
    }
    let has_axes = response.response.rect.left() > left;
    if let Some(seen) = seen.filter(|_| has_axes) {
        label_in_part(ui, &figure.y, left, seen);
    }
    let transform = response.transform;
    let at = |point: Pos2| {
        let value = transform.value_from_position(point);
        [value.x, value.y]
    };
    let pressed = ui.input(|input| {
        let pointer = &input.pointer;
        let is_down = pointer.primary_down() && response.response.is_pointer_button_down_on();
        pointer.press_origin().zip(pointer.latest_pos()).filter(|_| is_down)
    });
    let is_clicked = response.response.clicked();
    FigureResponse {
        picked_x: response.inner,
        drag: pressed.map(|(from, to)| [at(from), at(to)]),
        pointer: response.response.hover_pos().map(at),
        clicked: response.response.interact_pointer_pos().filter(|_| is_clicked).map(at),
        view: [transform.bounds().min(), transform.bounds().max()],
        x_per_point: transform.dvalue_dpos()[0].abs(),
    }
}

/// Has the view reach what egui_plot does not find in the elements: the tips of arrows, of which it includes
/// only the origins, and the places of figures with which this one is compared.
fn including_places<'a>(mut plot: Plot<'a>, figure: &Figure) -> Plot<'a> {
    let arrows = figure.elements.iter().filter_map(|element| match element {
        FigureElement::Arrow(series) => Some(&series.points),
        _ => None,
    });
    for [x, y] in arrows.flatten().chain(&figure.included) {
        plot = plot.include_x(*x).include_y(*y);
    }
    plot
}

/// Thin lines below the elements.
fn draw_lines_below(plot_ui: &mut PlotUi<'_>, options: &FigureOptions, dark: bool) {
    for points in options.lines_below.iter() {
        let stroke = Stroke::new(theme::THIN_LINE_WIDTH, theme::color(Role::Muted, dark));
        let line = Line::new("", PlotPoints::from(points.clone())).stroke(stroke);
        plot_ui.line(line.allow_hover(false));
    }
}

/// The upright lines of the cursor and of both ends of the span, where a curve is.
fn draw_cursors(plot_ui: &mut PlotUi<'_>, figure: &Figure, options: &FigureOptions, dark: bool) {
    let color = theme::cursor_color(dark);
    if let Some(x) = options.cursor_x.filter(|x| reaches(figure, *x)) {
        let line = VLine::new("", x).stroke(Stroke::new(theme::LINE_WIDTH, color));
        plot_ui.vline(line.allow_hover(false));
    }
    for x in options.span.into_iter().flatten().filter(|x| reaches(figure, *x)) {
        let stroke = Stroke::new(theme::THIN_LINE_WIDTH, color);
        let line = VLine::new("", x).stroke(stroke).style(PlotLineStyle::dashed_loose());
        plot_ui.vline(line.allow_hover(false));
    }
}

fn draw_backdrop(plot_ui: &mut PlotUi<'_>, backdrop: Backdrop) {
    let Backdrop { texture, part, centre: [x, y], size, turn_rad } = backdrop;
    let (at, size) = (PlotPoint::new(x, y), size.map(|side| side as f32));
    let [from, to] = part.map(|[u, v]| pos2(u as f32, v as f32));
    let picture = PlotImage::new("", texture, at, size).rotate(turn_rad);
    plot_ui.image(picture.uv(Rect::from_min_max(from, to)).allow_hover(false));
}

/// Draws the legend and returns the names that it hides.
fn hidden_ui(ui: &mut Ui, figure: &Figure, options: &FigureOptions) -> BTreeSet<String> {
    let id = Id::unique(("hidden in", options.plot_name(figure)));
    let mut hidden: BTreeSet<String> = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    legend_ui(ui, figure, &mut hidden, options.legend_rows);
    ui.data_mut(|data| data.insert_temp(id, hidden.clone()));
    hidden
}

/// Zooms about the pointer as the wheel is turned, which then scrolls nothing else.
fn zoom_by_wheel(plot: &mut PlotUi<'_>) {
    if !plot.response().contains_pointer() {
        return;
    }
    let turned = plot.ctx().input_mut(|input| {
        let is_zoom_already = input.modifiers.command;
        let turned = if is_zoom_already { 0.0 } else { input.smooth_scroll_delta().y };
        if turned != 0.0 {
            input.smooth_scroll_delta = Vec2::ZERO;
        }
        turned
    });
    if turned != 0.0 {
        plot.zoom_bounds_around_hovered(Vec2::splat((turned * ZOOM_PER_POINT).exp()));
    }
}

/// Smallest width of the labels of the vertical axis, points.
fn y_axis_width(figure: &Figure) -> f32 {
    let longest = figure.y.names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    f32::max(LEAST_Y_AXIS_WIDTH, longest as f32 * CHARACTER_WIDTH)
}

/// Height of the horizontal axis: that of its ticks, and of its label with the gap that egui_plot leaves, points.
/// An axis that comes into view has no other one in its first frame, and its label stood in its ticks.
fn x_axis_height(ui: &Ui, label: &str) -> f32 {
    let row = ui.text_style_height(&TextStyle::Body);
    let of_label = if label.is_empty() { 0.0 } else { row * (1.0 + GAP) };
    // Rather a little less than what it takes, which is its height from the second frame on.
    row + of_label - ROUNDING
}

/// A plot with the labels and ticks of the axes and the text shown on hovering.
///
/// - `labels`: of the horizontal and the vertical axis;
/// - `x_height`: of the horizontal axis at least, points.
fn plot_with_axes<'a>(
    figure: &Figure,
    options: &FigureOptions,
    labels: [String; 2],
    x_height: f32,
) -> Plot<'a> {
    let (x, y, log_y) = (figure.x.clone(), figure.y.clone(), figure.log_y);
    let [x_label, y_label] = labels;
    let format = NumberFormat { language: figure.language, ..NumberFormat::default() };
    let readout = move |name: &str, at: PlotPoint| {
        let head = if name.is_empty() { String::new() } else { format!("{name}\n") };
        let value = if log_y { 10.0_f64.powf(at.y) } else { at.y };
        let of_y = match y.names.is_empty() {
            true => format!("\n{} {}", significant(value), y.unit.symbol),
            // The name at the tick replaces the number.
            false => String::new(),
        };
        let of_x = match x.names.is_empty() {
            true => format!("{} {}", significant(at.x), x.unit.symbol),
            false => String::new(),
        };
        format!("{head}{of_x}{of_y}")
    };
    let (names, x_names) = (figure.y.names.clone(), figure.x.names.clone());
    let n_x_names = x_names.len();
    let n_names = names.len();
    let x_axis = AxisHints::new_x().label(x_label).min_thickness(x_height);
    let x_axis = x_axis.formatter(move |mark, _| match x_names.is_empty() {
        true => format.local(&tick_label(mark)),
        false => name_label(mark, &x_names),
    });
    Plot::new(options.plot_name(figure))
        .custom_x_axes(vec![x_axis])
        .y_axis_label(y_label)
        .y_axis_min_width(y_axis_width(figure))
        .label_formatter(move |position| {
            let (name, at) = match position {
                egui_plot::HoverPosition::NearDataPoint { plot_name, position, .. } => {
                    (*plot_name, *position)
                }
                egui_plot::HoverPosition::Elsewhere { position } => ("", *position),
            };
            Some(readout(name, at))
        })
        .x_grid_spacer(move |input| match n_x_names {
            0 => grid(input, X_TICK_CELLS),
            n => name_grid(n),
        })
        .y_grid_spacer(move |input| match (log_y, n_names) {
            (true, _) => log_grid(input),
            (false, 0) => grid(input, Y_TICK_CELLS),
            (false, n) => name_grid(n),
        })
        .grid_fade(0.9)
        .y_axis_formatter(move |mark, _| match names.is_empty() {
            true if log_y => format.local(&log_tick_label(mark)),
            true => format.local(&tick_label(mark)),
            false => name_label(mark, &names),
        })
        .allow_scroll(false)
        .allow_drag(Vec2b::from(figure.equal_aspect && options.pans))
}

/// Whether a place along x lies over a curve; anywhere does in a figure without curves.
fn reaches(figure: &Figure, x: f64) -> bool {
    let ends = figure.elements.iter().filter_map(|element| {
        // Curves over time ascend.
        let [first, last] = match element {
            FigureElement::Line(series) => {
                [series.points.first()?, series.points.last()?].map(|point| point[0])
            }
            FigureElement::Band(band) => [*band.x.first()?, *band.x.last()?],
            _ => return None,
        };
        Some([first, last])
    });
    let mut curves = ends.peekable();
    curves.peek().is_none() || curves.any(|[first, last]| first <= x && x <= last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Quantity, UnitSystem};
    use impactlab_document::figure::Axis;

    #[test]
    fn a_cursor_reaches_as_far_as_the_curves() {
        let axis = |quantity| Axis::shown("axis", quantity, UnitSystem::Si);
        let axes = [axis(Quantity::Time), axis(Quantity::Force)];
        let curve = |points| FigureElement::line("F", Role::Resultant, points);
        let mut figure = Figure::new("force", axes, vec![curve(vec![[0.0, 1.0], [0.1, 2.0]])]);
        assert!(reaches(&figure, 0.0) && reaches(&figure, 0.1) && !reaches(&figure, 2.0));
        figure.elements.push(curve(vec![[0.0, 0.0], [3.0, 0.0]]));
        assert!(reaches(&figure, 2.0));
        figure.elements.clear();
        assert!(reaches(&figure, 2.0));
    }

    #[test]
    fn figures_that_include_the_same_places_have_the_same_axes() {
        let context = egui::Context::default();
        let view = |end: f64| {
            let axis = || Axis::shown("axis", Quantity::Time, UnitSystem::Si);
            let curve = FigureElement::line("F", Role::Resultant, vec![[0.0, 0.0], [end, end]]);
            let figure = Figure::new(format!("to {end}"), [axis(), axis()], vec![curve]);
            let figure = Figure { included: vec![[0.0, -1.0], [3.0, 3.0]], ..figure };
            let screen = Rect::from_min_size(Pos2::ZERO, Vec2::new(500.0, 300.0));
            let mut view = [[0.0; 2]; 2];
            for _ in 0..3 {
                let input = egui::RawInput { screen_rect: Some(screen), ..Default::default() };
                let _ = context.run_ui(input, |ui| {
                    view = figure_ui(ui, &figure, &FigureOptions::default()).view;
                });
            }
            view
        };
        assert_eq!(view(1.0), view(3.0));
        assert!(view(1.0)[1][0] >= 3.0 && view(1.0)[0][1] <= -1.0, "{:?}", view(1.0));
    }

    /// Ends of the ticks and beginning of the label of the horizontal axis in the frame that is drawn.
    fn ticks_and_label(context: &egui::Context, figure: &Figure) -> [f32; 2] {
        let options = FigureOptions { reset: true, ..FigureOptions::default() };
        let places = texts(context, figure, &options, f32::INFINITY);
        let place = |wanted: &str| {
            let is_wanted = |(text, _): &&(String, Rect)| text.contains(wanted);
            places.iter().rfind(is_wanted).unwrap_or_else(|| panic!("no {wanted}: {places:?}")).1
        };
        [place("100").bottom(), place("along").top()]
    }

    /// The texts of a frame with their places.
    ///
    /// - `seen_height`: of the figure from above, points.
    fn texts(
        context: &egui::Context,
        figure: &Figure,
        options: &FigureOptions,
        seen_height: f32,
    ) -> Vec<(String, Rect)> {
        let size = Vec2::new(500.0, 300.0);
        let input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            ..egui::RawInput::default()
        };
        let output = context.run_ui(input, |ui| {
            ui.shrink_clip_rect(Rect::everything_above(seen_height));
            figure_ui(ui, figure, options);
        });
        output
            .shapes
            .iter()
            .filter_map(|clipped| match &clipped.shape {
                egui::Shape::Text(text) => {
                    Some((text.galley.text().to_owned(), text.visual_bounding_rect()))
                }
                _ => None,
            })
            .collect()
    }

    #[test]
    fn the_label_of_an_axis_stands_below_its_ticks_from_the_first_frame_on() {
        let axis = |title| Axis::shown(title, Quantity::Time, UnitSystem::Si);
        let points = (0..5).map(|i| [50.0 * f64::from(i), f64::from(i)]).collect();
        let curve = FigureElement::line("F", Role::Resultant, points);
        let figure = Figure::new("figure", [axis("along"), axis("across")], vec![curve]);
        let context = egui::Context::default();
        for _ in 0..3 {
            let [ticks_end, label_begins] = ticks_and_label(&context, &figure);
            assert!(ticks_end <= label_begins, "{ticks_end} {label_begins}");
        }
    }

    /// A plot whose axis was scrolled into view had “Time [s]” in its ticks until the next frame, for which nobody
    /// asked.
    #[test]
    fn the_label_of_an_axis_that_comes_into_view_stands_below_its_ticks() {
        let axis = |title| Axis::shown(title, Quantity::Time, UnitSystem::Si);
        let points = (0..5).map(|i| [50.0 * f64::from(i), f64::from(i)]).collect();
        let curve = FigureElement::line("F", Role::Resultant, points);
        let figure = Figure::new("figure", [axis("along"), axis("across")], vec![curve]);
        let (context, options) = (egui::Context::default(), FigureOptions::default());
        for _ in 0..3 {
            let unseen = texts(&context, &figure, &options, 150.0);
            assert!(!unseen.iter().any(|(text, _)| text.contains("along")), "{unseen:?}");
        }
        let seen = texts(&context, &figure, &options, f32::INFINITY);
        let place = |wanted: &str| {
            let found = seen.iter().rfind(|(text, _)| text.contains(wanted));
            found.unwrap_or_else(|| panic!("no {wanted}: {seen:?}")).1
        };
        let (ticks_end, label_begins) = (place("100").bottom(), place("along").top());
        assert!(ticks_end <= label_begins + ROUNDING, "{ticks_end} {label_begins}");
    }
}
