//! Draws a map of cells: a colour for each value, hatching over what is not to be relied upon, and the
//! scale of the colours.
//!
//! The scale runs from the ground to one blue, so that it differs in lightness alone: it can be read with
//! any colour vision and in a grey print, and lines over it keep their contrast.

use egui::{Color32, Rect, RichText, Sense, Stroke, TextStyle, Ui, Vec2, pos2};
use egui_plot::{Line, PlotPoints, PlotUi, Polygon};

use crate::theme;
use impactlab_core::units::{significant, trimmed};
use impactlab_document::figure::{CellMap, Role};

/// Colours of the lowest and the highest value, for a light and a dark ground.
const SCALES: [[[u8; 3]; 2]; 2] = [[[247, 250, 252], [0, 114, 178]], [[34, 38, 42], [0, 114, 178]]];

/// Lines of the hatching across a cell, in each direction of its sides.
const N_HATCHES: usize = 4;

/// Width of the scale in the legend, in heights of its letters, and its steps.
const SCALE_WIDTH: f32 = 9.0;
const N_STEPS: usize = 32;

/// The colour at a share of the scale, 0 to 1.
fn color_at(share: f64, dark: bool) -> Color32 {
    let [low, high] = SCALES[usize::from(dark)];
    let mixed = |channel: usize| {
        let [low, high] = [low, high].map(|color| f64::from(color[channel]));
        (low + share.clamp(0.0, 1.0) * (high - low)).round() as u8
    };
    Color32::from_rgb(mixed(0), mixed(1), mixed(2))
}

/// Draws the cells.
pub(crate) fn draw<'a>(plot: &mut PlotUi<'a>, map: &'a CellMap, dark: bool) {
    let hatch = Stroke::new(theme::THIN_LINE_WIDTH, theme::color(Role::Muted, dark));
    for ([low, high], value, is_hatched) in map.cells() {
        if let Some(value) = value {
            let corners =
                vec![[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
            let color = color_at(map.share(value), dark);
            let number = trimmed(significant(value));
            let name = format!("{}: {number} {}", map.name, map.unit.symbol);
            let area = Polygon::new(name, PlotPoints::from(corners)).fill_color(color);
            plot.polygon(area.stroke(Stroke::NONE));
        }
        if is_hatched {
            for ends in hatches([low, high]) {
                let line = Line::new("", PlotPoints::from(ends.to_vec())).stroke(hatch);
                plot.line(line.allow_hover(false));
            }
        }
    }
}

/// Oblique lines across a cell, from its left or upper side down to its lower or right one.
fn hatches([low, high]: [[f64; 2]; 2]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let at = move |shares: [f64; 2]| {
        [0, 1].map(|axis| low[axis] + shares[axis] * (high[axis] - low[axis]))
    };
    (1..2 * N_HATCHES).map(move |number| {
        let sum = number as f64 / N_HATCHES as f64;
        let over = (sum - 1.0).max(0.0);
        [at([over, sum.min(1.0)]), at([sum.min(1.0), over])]
    })
}

/// Draws the scale of the colours into a row of the legend: lowest value, colours, highest value.
pub(crate) fn scale_ui(ui: &mut Ui, map: &CellMap) {
    let dark = ui.visuals().dark_mode;
    let height = TextStyle::Small.resolve(ui.style()).size;
    let number = |value: f64| RichText::new(trimmed(significant(value))).small();
    let [low, high] = map.scale;
    ui.label(number(low));
    let (rect, _) = ui.allocate_exact_size(Vec2::new(SCALE_WIDTH * height, height), Sense::hover());
    let step = rect.width() / N_STEPS as f32;
    for i in 0..N_STEPS {
        let left = rect.left() + i as f32 * step;
        let part = Rect::from_min_max(pos2(left, rect.top()), pos2(left + step, rect.bottom()));
        let share = (i as f64 + 0.5) / N_STEPS as f64;
        ui.painter().rect_filled(part, 0.0, color_at(share, dark));
    }
    let high = format!("{} {}", trimmed(significant(high)), map.unit.symbol);
    ui.label(RichText::new(high.trim()).small());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The scale differs in lightness from end to end, in a grey print too.
    #[test]
    fn the_scale_is_as_long_in_grey_and_never_turns() {
        for dark in [false, true] {
            let grey = |share: f64| {
                let [r, g, b, _] = color_at(share, dark).to_array().map(f64::from);
                0.299 * r + 0.587 * g + 0.114 * b
            };
            let greys: Vec<f64> = (0..=20).map(|i| grey(f64::from(i) / 20.0)).collect();
            let rises = greys.windows(2).all(|pair| pair[0] < pair[1]);
            let falls = greys.windows(2).all(|pair| pair[0] > pair[1]);
            assert!(rises || falls, "{greys:?}");
            let length = (greys[0] - greys[20]).abs();
            assert!(length > if dark { 45.0 } else { 140.0 }, "{length}");
        }
    }

    #[test]
    fn hatches_stay_within_their_cell() {
        let (low, high) = ([2.0, -1.0], [4.0, 5.0]);
        let all: Vec<_> = hatches([low, high]).collect();
        assert_eq!(all.len(), 2 * N_HATCHES - 1);
        for end in all.iter().flatten() {
            let is_in = |axis: usize| (low[axis]..=high[axis]).contains(&end[axis]);
            assert!(is_in(0) && is_in(1), "{end:?}");
        }
    }
}
