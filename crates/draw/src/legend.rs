//! The legend of a figure: in rows above the plot, where it hides nothing.

use std::collections::BTreeSet;

use egui::{Color32, Label, Rangef, RichText, Sense, Stroke, TextStyle, Ui, Vec2, vec2};

use crate::cell_map::scale_ui;
use crate::theme;
use impactlab_document::figure::{Figure, FigureElement, LineStyle, Path};

/// Width of the number of the names that a legend has no room for, points.
const NUMBER_WIDTH: f32 = 30.0;

/// Draws the names of a figure with their colours in rows. A click on a name hides what it names, or shows
/// it again.
///
/// - `hidden`: the names that are hidden.
/// - `n_rows`: so many rows at most; names for which there is no room are counted.
pub fn legend_ui(ui: &mut Ui, figure: &Figure, hidden: &mut BTreeSet<String>, n_rows: usize) {
    let (dark, named) = (ui.visuals().dark_mode, named(figure));
    if named.is_empty() {
        return;
    }
    let (shown, others) = named.split_at(n_that_fit(ui, &named, n_rows));
    ui.horizontal_wrapped(|ui| {
        for element in shown {
            let name = element.name();
            let color = theme::color(element.role(), dark);
            let color = match element {
                FigureElement::Band(band) => color.gamma_multiply(band.opacity),
                _ => color,
            };
            let is_hidden = hidden.contains(name);
            let text = RichText::new(name).small();
            let text = if is_hidden { text.weak().strikethrough() } else { text };
            keep_together(ui, name);
            match element {
                FigureElement::CellMap(map) => scale_ui(ui, map),
                _ => marker_ui(ui, element, if is_hidden { Color32::TRANSPARENT } else { color }),
            }
            let label = ui.add(Label::new(text).extend().sense(Sense::click()));
            if label.on_hover_text("Click to hide or show it").clicked() && !hidden.remove(name) {
                hidden.insert(name.to_owned());
            }
        }
        if !others.is_empty() {
            ui.add(Label::new(RichText::new(format!("+{}", others.len())).small()).extend());
        }
    });
}

/// How many names have room in so many rows, with the number of the others behind them.
fn n_that_fit(ui: &Ui, named: &[&FigureElement], n_rows: usize) -> usize {
    if n_rows >= named.len() {
        return named.len();
    }
    let font = TextStyle::Small.resolve(ui.style());
    let between = ui.spacing().item_spacing.x;
    let (whole, mut row, mut used) = (ui.available_width(), 1, 0.0);
    for (idx, element) in named.iter().enumerate() {
        let name = element.name().to_owned();
        let text = ui.painter().layout_no_wrap(name, font.clone(), Color32::PLACEHOLDER);
        let needed = font.size + 2.0 * between + text.size().x;
        let has_others = row == n_rows && idx + 1 < named.len();
        let room = if has_others { whole - NUMBER_WIDTH } else { whole };
        if used > 0.0 && used + needed > room {
            (row, used) = (row + 1, 0.0);
        }
        if row > n_rows {
            return idx;
        }
        used += needed;
    }
    named.len()
}

/// The first element of each name of a figure, in their order.
fn named(figure: &Figure) -> Vec<&FigureElement> {
    let mut named: Vec<&FigureElement> = Vec::new();
    for element in figure.elements.iter().filter(|element| !element.name().is_empty()) {
        if named.iter().all(|other| other.name() != element.name()) {
            named.push(element);
        }
    }
    named
}

/// Begins a new row where a dot and its name do not fit into this one.
fn keep_together(ui: &mut Ui, name: &str) {
    let font = TextStyle::Small.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(name.to_owned(), font.clone(), Color32::PLACEHOLDER);
    let needed = font.size + ui.spacing().item_spacing.x + text.size().x;
    let is_first = ui.cursor().left() <= ui.max_rect().left();
    if !is_first && ui.available_size_before_wrap().x < needed {
        ui.end_row();
    }
}

/// A dot in the colour of an element; for a dashed or dotted line a few dashes or three small dots.
fn marker_ui(ui: &mut Ui, element: &FigureElement, color: Color32) {
    let size = TextStyle::Small.resolve(ui.style()).size;
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(size), Sense::hover());
    let (centre, painter) = (rect.center(), ui.painter());
    let style = match element {
        FigureElement::Line(series) | FigureElement::Path(Path { series, .. }) => series.style,
        _ => LineStyle::Solid,
    };
    match style {
        LineStyle::Solid => {
            painter.circle_filled(centre, size / 3.0, color);
        }
        LineStyle::Dashed => {
            let stroke = Stroke::new(theme::line_width(element.role()), color);
            for ends in element.role().dashes().sample {
                let x = ends.map(|share| centre.x + share * size);
                painter.hline(Rangef::new(x[0], x[1]), centre.y, stroke);
            }
        }
        LineStyle::Dotted => {
            for share in [-0.4, 0.0, 0.4] {
                painter.circle_filled(centre + vec2(share * size, 0.0), size / 9.0, color);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Canvas;
    use crate::offscreen::shapes_offscreen;
    use impactlab_core::units::{Quantity, UnitSystem};
    use impactlab_document::figure::{Axis, Role};

    const CANVAS: Canvas = Canvas { size_px: [1200, 300], scale: 1.0, dark: false };

    #[test]
    fn a_legend_has_a_name_once_and_none_for_what_has_no_name() {
        let axis = Axis::shown("x", Quantity::Ratio, UnitSystem::Si);
        let line = |name, role| FigureElement::line(name, role, vec![[0.0, 1.0], [1.0, 0.0]]);
        let elements = vec![
            line("line", Role::Simulation),
            line("line", Role::Simulation),
            line("", Role::Muted),
            line("other", Role::Target),
        ];
        let figure = Figure::new("", [axis.clone(), axis], elements);
        let names: Vec<&str> = named(&figure).iter().map(|element| element.name()).collect();
        assert_eq!(names, ["line", "other"]);
    }

    /// Seven rows of names left no room for the plot below them.
    #[test]
    fn names_that_have_no_room_are_counted() {
        let axis = Axis::shown("x", Quantity::Ratio, UnitSystem::Si);
        let names = (0..20).map(|idx| format!("tire mark of the struck car {idx}"));
        let line = |name| FigureElement::line(name, Role::Simulation, vec![[0.0, 1.0], [1.0, 0.0]]);
        let elements = names.map(line).collect();
        let figure = Figure::new("", [axis.clone(), axis], elements);
        let named = named(&figure);
        shapes_offscreen(CANVAS, |ui| {
            ui.set_max_width(340.0);
            let [one, two] = [1, 2].map(|n_rows| n_that_fit(ui, &named, n_rows));
            assert!(0 < one && one < two && two < 20, "{one}, {two}");
            assert_eq!(n_that_fit(ui, &named, usize::MAX), 20);
        })
        .unwrap();
    }
}
