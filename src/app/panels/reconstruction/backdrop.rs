//! Picture and lines of the ground below the plan in which evidence is placed.

use std::sync::{Arc, Weak};

use egui::{Color32, ColorImage, Id, TextureHandle, TextureOptions, Ui};

use impactlab_core::site::extent_of;
use impactlab_core::units::Unit;
use impactlab_document::figure::{Figure, FigureElement, Path};
use impactlab_document::scene::{GroundLineKind, GroundPicture, PictureLevel, SceneGround, TILE};
use impactlab_draw::Backdrop;

/// Longest side of the picture, pixels.
const MAX_SIDE: usize = 2048;

/// Cosine of the largest angle by which the sides of a picture may not be at right angles.
const SQUARE: f64 = 1e-3;

/// Distance from the evidence beyond which the ground is left out, m: it would make the plan too small.
const NEAR_M: f64 = 40.0;

/// Most lines that are drawn.
const MAX_LINES: usize = 5000;

/// The picture as the graphics card has it.
#[derive(Clone)]
struct Loaded {
    picture: Arc<GroundPicture>,
    texture: TextureHandle,
}

/// Lines of a ground, in the units of the axes of a plan.
type Lines = Arc<Vec<Vec<[f64; 2]>>>;

/// The lines of a ground about what a plan shows, which stay the same from frame to frame.
#[derive(Clone)]
struct FoundLines {
    ground: Weak<SceneGround>,
    about: [[f64; 2]; 2],
    unit: Unit,
    lines: Lines,
}

/// The picture of a ground about what a plan shows, if it has one that is not skewed or mirrored.
pub(super) fn backdrop(ui: &Ui, ground: &SceneGround, figure: &Figure) -> Option<Backdrop> {
    let picture = ground.picture.as_ref()?;
    let (column_m, row_m) = (picture.map.per_column_m, picture.map.per_row_m);
    let [across_m, down_m] = [column_m, row_m].map(|[x, y]| x.hypot(y));
    let scalar = column_m[0] * row_m[0] + column_m[1] * row_m[1];
    let cross = column_m[0] * row_m[1] - column_m[1] * row_m[0];
    if scalar.abs() > SQUARE * across_m * down_m || cross >= 0.0 {
        return None;
    }
    let unit = figure.x.unit;
    let [low_m, high_m] = about(figure)?.map(|at| at.map(|value| unit.to_si(value)));
    let corners_m = [low_m, [high_m[0], low_m[1]], high_m, [low_m[0], high_m[1]]];
    let [from, to] = extent_of(corners_m.map(|corner_m| picture.map.pixel(corner_m)))?;
    let sides = picture.size().map(|side| side as f64);
    let [from, to] = [from, to].map(|at| [0, 1].map(|axis| at[axis].clamp(0.0, sides[axis])));
    if (0..2).any(|axis| to[axis] <= from[axis]) {
        return None;
    }
    let middle_m = picture.map.ground_m([0, 1].map(|axis| (from[axis] + to[axis]) / 2.0));
    let size_m = [(to[0] - from[0]) * across_m, (to[1] - from[1]) * down_m];
    Some(Backdrop {
        texture: texture(ui, picture)?.id(),
        part: [from, to].map(|at| [0, 1].map(|axis| at[axis] / sides[axis])),
        centre: middle_m.map(|value| unit.from_si(value)),
        size: size_m.map(|side| unit.from_si(side)),
        turn_rad: column_m[1].atan2(column_m[0]),
    })
}

/// Lowest and highest coordinates of what a plan shows and of the ground about it, in the units of its axes.
fn about(figure: &Figure) -> Option<[[f64; 2]; 2]> {
    let shown = figure.elements.iter().filter_map(|element| match element {
        FigureElement::Line(series)
        | FigureElement::Points(series)
        | FigureElement::Polygon(series)
        | FigureElement::Path(Path { series, .. })
        | FigureElement::Arrow(series) => Some(&series.points),
        _ => None,
    });
    let room = figure.x.unit.from_si(NEAR_M);
    let [low, high] = extent_of(shown.flatten().copied())?;
    Some([low.map(|value| value - room), high.map(|value| value + room)])
}

/// The lines of a ground about what a plan shows, in the units of its axes: those of a survey, then kerbs and
/// those of a drawing.
pub(super) fn lines_below(ui: &Ui, ground: &Arc<SceneGround>, figure: &Figure) -> Lines {
    let unit = figure.x.unit;
    let Some(about) = about(figure) else { return Lines::default() };
    let id = Id::unique("lines below the plan");
    let found: Option<FoundLines> = ui.data(|data| data.get_temp(id));
    let is_same = |of: &FoundLines| {
        std::ptr::eq(of.ground.as_ptr(), Arc::as_ptr(ground))
            && (of.about, of.unit) == (about, unit)
    };
    if let Some(found) = found.filter(is_same) {
        return found.lines;
    }
    let lines = Arc::new(lines_within(ground, about, unit));
    let found =
        FoundLines { ground: Arc::downgrade(ground), about, unit, lines: Arc::clone(&lines) };
    ui.data_mut(|data| data.insert_temp(id, found));
    lines
}

/// The parts of the lines of a ground within a rectangle, in the unit of that.
fn lines_within(ground: &SceneGround, rect: [[f64; 2]; 2], unit: Unit) -> Vec<Vec<[f64; 2]>> {
    let kinds = [GroundLineKind::Surveyed, GroundLineKind::Kerb, GroundLineKind::Drawing];
    let of_kind = |kind| ground.lines.iter().filter(move |line| line.kind == kind);
    let lines = kinds.into_iter().flat_map(of_kind);
    let parts = lines.flat_map(|line| {
        let points = line.points_m.iter().map(|at_m| at_m.map(|value| unit.from_si(value)));
        parts_within(&points.collect::<Vec<_>>(), rect)
    });
    parts.take(MAX_LINES).collect()
}

/// The parts of a line within a rectangle.
fn parts_within(points: &[[f64; 2]], rect: [[f64; 2]; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    let sides = points.iter().zip(points.iter().skip(1));
    for [from, to] in sides.filter_map(|(from, to)| side_within([*from, *to], rect)) {
        match parts.last_mut() {
            Some(part) if part.last() == Some(&from) => part.push(to),
            _ => parts.push(vec![from, to]),
        }
    }
    parts
}

/// The part of the straight line between two points within a rectangle of the lowest and the highest
/// coordinates.
fn side_within(ends: [[f64; 2]; 2], [low, high]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let [from, to] = ends;
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        // Infinite along the edges of the rectangle.
        let share = |edge: f64| (edge - from[axis]) / (to[axis] - from[axis]);
        let (at_low, at_high) = (share(low[axis]), share(high[axis]));
        enters = enters.max(at_low.min(at_high));
        leaves = leaves.min(at_low.max(at_high));
    }
    let at = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis])),
    };
    (enters < leaves).then(|| [at(enters), at(leaves)])
}

/// The texture of a picture, made anew for another one.
fn texture(ui: &Ui, picture: &Arc<GroundPicture>) -> Option<TextureHandle> {
    let id = Id::unique("ground below the plan");
    let loaded: Option<Loaded> = ui.data(|data| data.get_temp(id));
    if let Some(loaded) = loaded.filter(|loaded| loaded.picture.has_pixels_of(picture)) {
        return Some(loaded.texture);
    }
    let is_small = |level: &&PictureLevel| level.size().iter().all(|side| *side <= MAX_SIDE);
    let level = picture.levels().iter().find(is_small).or(picture.levels().last())?;
    let texture =
        ui.ctx().load_texture("ground below the plan", image(level), TextureOptions::LINEAR);
    let loaded = Loaded { picture: Arc::clone(picture), texture: texture.clone() };
    ui.data_mut(|data| data.insert_temp(id, loaded));
    Some(texture)
}

fn image(level: &PictureLevel) -> ColorImage {
    let [width, height] = level.size();
    let mut pixels = vec![Color32::TRANSPARENT; width * height];
    for ([left, top], tile) in level.tiles() {
        let n = TILE.min(width.saturating_sub(left));
        for (y, line) in (top..height).zip(tile.chunks_exact(TILE)) {
            let start = y * width + left;
            let Some(place) = pixels.get_mut(start..start + n) else { continue };
            for (pixel, [red, green, blue, opacity]) in place.iter_mut().zip(line) {
                *pixel = Color32::from_rgba_unmultiplied(*red, *green, *blue, *opacity);
            }
        }
    }
    ColorImage::new([width, height], pixels)
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};
    use image::RgbaImage;

    use super::*;
    use impactlab_core::site::PixelMap;
    use impactlab_core::units::{Quantity, UnitSystem};
    use impactlab_document::figure::{Axis, Role};
    use impactlab_document::scene::GroundLine;

    /// A plan that shows two places.
    fn plan(points: Vec<[f64; 2]>) -> Figure {
        let axis = || Axis::shown("X", Quantity::Length, UnitSystem::Si);
        let marks = FigureElement::line("marks", Role::Simulation, points);
        Figure::new("plan", [axis(), axis()], vec![marks])
    }

    fn placed(map: PixelMap) -> Option<Backdrop> {
        let picture = Arc::new(GroundPicture::new(&RgbaImage::new(200, 100), map));
        let ground = SceneGround { picture: Some(picture), ..SceneGround::default() };
        let figure = plan(vec![[10.0, 0.0], [30.0, 20.0]]);
        let mut found = None;
        let _ = Context::default().run_ui(RawInput::default(), |ui| {
            found = backdrop(ui, &ground, &figure);
            // The same texture again.
            assert_eq!(backdrop(ui, &ground, &figure), found);
        });
        found
    }

    fn is_near(found: [f64; 2], expected: [f64; 2]) -> bool {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9)
    }

    #[test]
    fn a_picture_lies_where_its_pixels_do() {
        let upright =
            PixelMap { corner_m: [10.0, 20.0], per_column_m: [0.1, 0.0], per_row_m: [0.0, -0.1] };
        let at = placed(upright).unwrap();
        assert!(is_near(at.centre, [20.0, 15.0]) && is_near(at.size, [20.0, 10.0]), "{at:?}");
        assert_eq!((at.turn_rad, at.part), (0.0, [[0.0; 2], [1.0; 2]]));
        // Its columns run along Y.
        let turned =
            PixelMap { corner_m: [0.0, 0.0], per_column_m: [0.0, 0.1], per_row_m: [0.1, 0.0] };
        let at = placed(turned).unwrap();
        assert!(is_near(at.centre, [5.0, 10.0]) && is_near(at.size, [20.0, 10.0]), "{at:?}");
        assert!((at.turn_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        let mirrored = PixelMap { per_row_m: [0.0, 0.1], ..upright };
        let skewed = PixelMap { per_row_m: [0.05, -0.1], ..upright };
        assert_eq!([mirrored, skewed].map(placed), [None; 2]);
    }

    /// A picture of a whole district made the plan a dot.
    #[test]
    fn of_a_large_picture_the_part_about_the_evidence_is_shown() {
        let large = PixelMap {
            corner_m: [-990.0, 510.0],
            per_column_m: [10.0, 0.0],
            per_row_m: [0.0, -10.0],
        };
        let at = placed(large).unwrap();
        assert!(is_near(at.centre, [20.0, 10.0]) && is_near(at.size, [100.0, 100.0]), "{at:?}");
        assert!(is_near(at.part[0], [0.48, 0.45]) && is_near(at.part[1], [0.53, 0.55]), "{at:?}");
        assert_eq!(placed(PixelMap { corner_m: [500.0, 510.0], ..large }), None);
    }

    #[test]
    fn surveyed_lines_lie_below_a_plan_in_its_units_but_not_those_far_from_it() {
        let line = |kind, points_m: &[[f64; 2]]| GroundLine {
            kind,
            points_m: points_m.to_vec(),
            width_m: 0.0,
        };
        let surveyed = [[0.0, 3.048], [30.48, 3.048], [5000.0, 3.048]];
        let mut lines = vec![line(GroundLineKind::Marking, &[[0.0, 0.0], [1.0, 0.0]])];
        // As many as are drawn at most, none of which is.
        let far = line(GroundLineKind::Surveyed, &[[4000.0, 0.0], [4001.0, 0.0]]);
        lines.resize(lines.len() + MAX_LINES, far);
        lines.push(line(GroundLineKind::Surveyed, &surveyed));
        let ground = Arc::new(SceneGround { lines, ..SceneGround::default() });
        let axis = || Axis::shown("X", Quantity::Length, UnitSystem::Us);
        let plan = |elements| Figure::new("plan", [axis(), axis()], elements);
        let mark = |end: f64| {
            plan(vec![FigureElement::line("mark", Role::Muted, vec![[0.0, 0.0], [end, 0.0]])])
        };
        let _ = Context::default().run_ui(RawInput::default(), |ui| {
            let found = lines_below(ui, &ground, &mark(50.0));
            assert_eq!(found.len(), 1, "{found:?}");
            // The last one ends 40 m beyond the mark.
            let ends: Vec<[f64; 2]> = found[0].iter().map(|at| at.map(f64::round)).collect();
            assert_eq!(ends, [[0.0, 10.0], [100.0, 10.0], [181.0, 10.0]]);
            assert!(Arc::ptr_eq(&found, &lines_below(ui, &ground, &mark(50.0))));
            let other = lines_below(ui, &ground, &mark(60.0));
            assert_eq!(other[0][2][0].round(), 191.0);
            let bare = Arc::new(SceneGround::default());
            assert!(lines_below(ui, &bare, &mark(60.0)).is_empty());
            assert!(lines_below(ui, &ground, &plan(Vec::new())).is_empty());
        });
    }

    /// A straight edge whose ends both lie beyond the plan was missing in it.
    #[test]
    fn a_line_is_cut_where_it_leaves_the_plan() {
        let within = |points: &[[f64; 2]]| parts_within(points, [[0.0, 0.0], [10.0, 20.0]]);
        assert_eq!(within(&[[-5.0, 5.0], [15.0, 5.0]]), [[[0.0, 5.0], [10.0, 5.0]]]);
        assert_eq!(within(&[[5.0, 30.0], [5.0, -10.0]]), [[[5.0, 20.0], [5.0, 0.0]]]);
        assert_eq!(within(&[[-5.0, 0.0], [10.0, 15.0]]), [[[0.0, 5.0], [10.0, 15.0]]]);
        // Out and in again, about a corner, and past it.
        let twice = within(&[[5.0, 5.0], [15.0, 5.0], [15.0, 8.0], [6.0, 8.0]]);
        assert_eq!(twice, [[[5.0, 5.0], [10.0, 5.0]], [[10.0, 8.0], [6.0, 8.0]]]);
        let inside = [[1.0, 1.0], [2.0, 1.0], [2.0, 1.0], [2.0, 3.0]];
        assert_eq!(within(&inside), [inside]);
        assert!(within(&[[-5.0, 18.0], [5.0, 28.0]]).is_empty());
        assert!(within(&[[11.0, 5.0], [11.0, 15.0]]).is_empty());
        assert!(within(&[[3.0, 3.0]]).is_empty() && within(&[]).is_empty());
    }

    #[test]
    fn pixels_keep_their_places() {
        let map = PixelMap { corner_m: [0.0; 2], per_column_m: [1.0, 0.0], per_row_m: [0.0, -1.0] };
        let mut pixels = RgbaImage::new(150, 140);
        pixels.put_pixel(149, 130, image::Rgba([255, 0, 0, 255]));
        let picture = GroundPicture::new(&pixels, map);
        let shown = image(&picture.levels()[0]);
        assert_eq!(shown.size, [150, 140]);
        let red: Vec<usize> =
            (0..shown.pixels.len()).filter(|idx| shown.pixels[*idx] == Color32::RED).collect();
        assert_eq!(red, [130 * 150 + 149]);
    }
}
