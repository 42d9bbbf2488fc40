//! What was measured on the ground, over a scene.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2, vec2};

use impactlab_document::scene::MeasureTextAt;

/// Size of the values, points.
const TEXT_POINTS: f32 = 12.0;
/// Way from a place to the value beside it, points.
const TEXT_OFF: Vec2 = vec2(10.0, 8.0);

/// Draws a line with its places, joined to a border if it is closed.
pub fn draw_measure(painter: &Painter, places: &[Pos2], is_closed: bool, dark: bool) {
    let (line, edge) = colors(dark);
    let mut path = places.to_vec();
    if is_closed && places.len() > 2 {
        path.extend(places.first().copied());
    }
    for (width, color) in [(4.0, edge), (1.6, line)] {
        painter.line(path.clone(), Stroke::new(width, color));
    }
    for place in places {
        painter.circle_filled(*place, 3.5, edge);
        painter.circle_filled(*place, 2.2, line);
    }
}

/// Draws a value, moved so far that it is within the picture.
pub fn draw_measure_text(painter: &Painter, text: String, at: Pos2, dark: bool) {
    let (line, edge) = colors(dark);
    let galley = painter.layout_no_wrap(text, FontId::proportional(TEXT_POINTS), line);
    let place = Align2::LEFT_TOP.anchor_size(at, galley.size());
    let place = within(place, painter.clip_rect().shrink(4.0));
    painter.rect_filled(place.expand2(vec2(4.0, 2.0)), 2.0, edge);
    painter.galley(place.min, galley, line);
}

/// Where a value stands.
pub fn measure_text_place(places: &[Pos2], at: MeasureTextAt) -> Option<Pos2> {
    match at {
        MeasureTextAt::End => places.last().map(|place| *place + TEXT_OFF),
        MeasureTextAt::Vertex => places.get(1).map(|place| *place + TEXT_OFF),
        MeasureTextAt::Middle => {
            let sum = places.iter().fold(Vec2::ZERO, |sum, place| sum + place.to_vec2());
            (!places.is_empty()).then(|| (sum / places.len() as f32).to_pos2())
        }
    }
}

/// Colours of lines and of their edges.
fn colors(dark: bool) -> (Color32, Color32) {
    match dark {
        true => (Color32::WHITE, Color32::from_black_alpha(170)),
        false => (Color32::from_rgb(20, 22, 24), Color32::from_white_alpha(190)),
    }
}

/// A rectangle moved so that it lies within another, as far as it fits.
fn within(rect: Rect, outer: Rect) -> Rect {
    let over = (rect.max - outer.max).max(Vec2::ZERO);
    let rect = rect.translate(-over);
    rect.translate((outer.min - rect.min).max(Vec2::ZERO))
}
