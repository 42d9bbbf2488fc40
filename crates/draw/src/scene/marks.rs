//! Marks of tires on the ground, in the picture and in the order of time.

use egui::Color32;

use crate::scene::ground::Ground;
use crate::scene::lines::Stroke;
use crate::scene::shade::{ground_color, mark_color, mixed};
use impactlab_core::vehicle::TireMarkPoint;
use impactlab_document::scene::SceneMark;

/// Shortest piece that is drawn by itself, pixels.
const LEAST_PIECE: f32 = 1.2;
/// Least half width of a mark, points.
const LEAST_HALF_WIDTH: f32 = 0.75;
/// Share of the colour of rubber in the faintest and in the darkest mark.
const SHARES: [f32; 2] = [0.30, 0.92];

/// Colour of the faintest marks on the picture of a road, darker than its asphalt.
pub const ASPHALT: Color32 = Color32::from_rgb(92, 92, 92);

/// Pieces of marks with the times from which on they are there.
#[derive(Default)]
pub struct MarkStrokes {
    times_s: Vec<f64>,
    strokes: Vec<Stroke>,
}

impl MarkStrokes {
    /// The marks of a scene as its camera sees them. The colours are mixed with that of the ground, so
    /// that pieces that overlap at their ends are not darker there.
    pub fn new(ground: &Ground<'_>) -> Self {
        let mut timed: Vec<(f64, Stroke)> = Vec::new();
        for mark in &ground.scene.marks {
            add_mark(ground, mark, &mut timed);
        }
        timed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (times_s, strokes) = timed.into_iter().unzip();
        Self { times_s, strokes }
    }

    /// All pieces in the order of time.
    pub fn all(&self) -> &[Stroke] {
        &self.strokes
    }

    /// The pieces that are there at a time.
    pub fn until(&self, time_s: f64) -> &[Stroke] {
        let n = self.times_s.partition_point(|time| *time <= time_s);
        self.strokes.get(..n).unwrap_or_default()
    }
}

fn add_mark(ground: &Ground<'_>, mark: &SceneMark, timed: &mut Vec<(f64, Stroke)>) {
    let mut from: Option<(&TireMarkPoint, [f32; 2])> = None;
    for point in &mark.points {
        let place = in_picture(ground, point.place_m);
        let (Some((before, start)), Some(end)) = (from, place) else {
            from = place.map(|place| (point, place));
            continue;
        };
        let way = [end[0] - start[0], end[1] - start[1]];
        let length = way[0].hypot(way[1]);
        if length < LEAST_PIECE {
            continue;
        }
        if before.darkness > 0.0 {
            let half_width = half_width(ground, before, point, way.map(|part| part / length));
            let share = SHARES[0] + (SHARES[1] - SHARES[0]) * before.darkness as f32;
            let (under, rubber) = colors_of(ground);
            let color = mixed(under, rubber, share);
            let stroke = Stroke { ends: [start, end], half_width, color, opacity: 1.0 };
            timed.push((point.time_s, stroke));
        }
        from = Some((point, end));
    }
}

/// Colours of the ground and of rubber on it. A picture of a road has its own brightness in both themes.
fn colors_of(ground: &Ground<'_>) -> (Color32, Color32) {
    match ground.has_picture() {
        true => (ASPHALT, mark_color(false)),
        false => (ground_color(ground.dark), mark_color(ground.dark)),
    }
}

fn in_picture(ground: &Ground<'_>, [x, y]: [f64; 2]) -> Option<[f32; 2]> {
    let [px, py, _] = ground.projection.project([x, y, 0.0])?;
    (px.is_finite() && py.is_finite()).then_some([px as f32, py as f32])
}

/// Half the width of a piece across its direction in the picture, pixels.
///
/// - `along`: that direction, of unit length.
fn half_width(
    ground: &Ground<'_>,
    from: &TireMarkPoint,
    to: &TireMarkPoint,
    along: [f32; 2],
) -> f32 {
    let least = LEAST_HALF_WIDTH * ground.points as f32;
    let way = [to.place_m[0] - from.place_m[0], to.place_m[1] - from.place_m[1]];
    let length = way[0].hypot(way[1]).max(1e-9);
    let edge = [-way[1], way[0]].map(|part| part / length * from.width_m / 2.0);
    let beside = [from.place_m[0] + edge[0], from.place_m[1] + edge[1]];
    let [Some(middle), Some(side)] = [from.place_m, beside].map(|at| in_picture(ground, at)) else {
        return least;
    };
    let across = along[0] * (side[1] - middle[1]) - along[1] * (side[0] - middle[0]);
    across.abs().max(least)
}
