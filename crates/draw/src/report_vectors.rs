//! A picture as lines, areas and texts: the shapes of which it consists before they become pixels.

use egui::emath::{Rot2, TSTransform};
use egui::epaint::{
    CircleShape, ClippedShape, ColorMode, Mesh, PathShape, RectShape, TextShape, TextureId,
};
use egui::{Color32, Pos2, Rect, Shape, Stroke, Vec2};

use impactlab_document::report::{VectorMark, VectorPicture, VectorShape};

/// Corners of the polygon that stands for a circle.
const CIRCLE_CORNERS: usize = 24;

/// Shapes as a picture of a size; `None` where one of them is neither line nor area nor text, such as an
/// image.
pub(crate) fn vector_picture(shapes: &[ClippedShape], size: Vec2) -> Option<VectorPicture> {
    let whole = Rect::from_min_size(Pos2::ZERO, size);
    let mut marks = Vec::new();
    for clipped in shapes {
        if clipped.transform_after_tessellation != TSTransform::IDENTITY {
            return None;
        }
        let seen = clipped.clip_rect.intersect(whole);
        if !seen.is_positive() {
            continue;
        }
        let clip = [seen.left(), seen.top(), seen.width(), seen.height()];
        let mut found = Vec::new();
        add(&clipped.shape, &mut found)?;
        marks.extend(found.into_iter().map(|shape| VectorMark { clip, shape }));
    }
    Some(VectorPicture { size: [size.x, size.y], marks })
}

fn add(shape: &Shape, found: &mut Vec<VectorShape>) -> Option<()> {
    match shape {
        Shape::Noop => {}
        Shape::Vec(shapes) => {
            for shape in shapes {
                add(shape, found)?;
            }
        }
        Shape::Circle(circle) => found.push(of_circle(circle)),
        Shape::LineSegment { points, stroke } => {
            found.push(outline(&[points.to_vec()], false, Color32::TRANSPARENT, *stroke));
        }
        Shape::Path(path) => found.push(of_path(path)?),
        Shape::Rect(rect) => found.push(of_rect(rect)?),
        Shape::Text(text) => add_text(text, found),
        Shape::Mesh(mesh) => found.push(of_mesh(mesh)?),
        _ => return None,
    }
    Some(())
}

/// Lines through points. A line is interrupted where a point has no place.
fn outline(lines: &[Vec<Pos2>], is_closed: bool, fill: Color32, stroke: Stroke) -> VectorShape {
    let lines = lines.iter().flat_map(|line| line.split(|point| !point.is_finite()));
    let contours = lines.filter(|line| line.len() > 1);
    let place = |point: &Pos2| [point.x, point.y];
    let contours = contours.map(|line| line.iter().map(place).collect::<Vec<_>>());
    let is_seen = stroke.width > 0.0 && stroke.color.a() > 0;
    VectorShape::Outline {
        contours: contours.collect(),
        is_closed,
        fill: (fill.a() > 0).then(|| fill.to_srgba_unmultiplied()),
        stroke: is_seen.then(|| (stroke.width, stroke.color.to_srgba_unmultiplied())),
    }
}

fn of_circle(circle: &CircleShape) -> VectorShape {
    let corner = |idx: usize| {
        let angle = std::f32::consts::TAU * idx as f32 / CIRCLE_CORNERS as f32;
        circle.center + circle.radius * Vec2::angled(angle)
    };
    let corners = (0..CIRCLE_CORNERS).map(corner).collect();
    outline(&[corners], true, circle.fill, circle.stroke)
}

fn of_path(path: &PathShape) -> Option<VectorShape> {
    let ColorMode::Solid(color) = path.stroke.color else { return None };
    let stroke = Stroke::new(path.stroke.width, color);
    Some(outline(std::slice::from_ref(&path.points), path.closed, path.fill, stroke))
}

fn of_rect(shape: &RectShape) -> Option<VectorShape> {
    let rect = shape.rect;
    if shape.brush.is_some() || shape.angle != 0.0 {
        return None;
    }
    let corners = vec![rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
    Some(outline(&[corners], true, shape.fill, shape.stroke))
}

/// Triangles of one colour, all turned the same way round: the area of all of them has no seams.
fn of_mesh(mesh: &Mesh) -> Option<VectorShape> {
    let color = mesh.vertices.first()?.color;
    let is_plain = mesh.vertices.iter().all(|vertex| vertex.color == color);
    if !is_plain || mesh.texture_id != TextureId::default() {
        return None;
    }
    let triangle = |indices: &[u32]| {
        let corner = |idx: &u32| Some(mesh.vertices.get(*idx as usize)?.pos);
        let mut corners: Vec<Pos2> = indices.iter().map(corner).collect::<Option<_>>()?;
        let [a, b, c] = corners[..] else { return None };
        let (side, other) = (b - a, c - a);
        if side.x * other.y < side.y * other.x {
            corners.swap(1, 2);
        }
        Some(corners)
    };
    let triangles: Vec<Vec<Pos2>> = mesh.indices.chunks(3).map(triangle).collect::<Option<_>>()?;
    Some(outline(&triangles, true, color, Stroke::NONE))
}

/// Each word of a text for itself, so that it begins where it does on screen.
fn add_text(text: &TextShape, found: &mut Vec<VectorShape>) {
    let Some(section) = text.galley.job.sections.first() else { return };
    let rotation = Rot2::from_angle(text.angle);
    for row in &text.galley.rows {
        for word in row.row.glyphs.split(|glyph| glyph.chr.is_whitespace()) {
            let Some(first) = word.first() else { continue };
            let vertex = row.row.visuals.mesh.vertices.get(first.first_vertex as usize);
            let own = vertex.map(|vertex| vertex.color).filter(|it| *it != Color32::PLACEHOLDER);
            let color = text.override_text_color.or(own).unwrap_or(text.fallback_color);
            let at = text.pos + rotation * (row.pos.to_vec2() + first.pos.to_vec2());
            found.push(VectorShape::Text {
                at: [at.x, at.y],
                angle_rad: text.angle,
                size: section.format.font_id.size,
                color: color.gamma_multiply(text.opacity_factor).to_srgba_unmultiplied(),
                text: word.iter().map(|glyph| glyph.chr).collect(),
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Canvas;
    use crate::offscreen::shapes_offscreen;

    fn drawn(ui: impl FnMut(&mut egui::Ui)) -> Option<VectorPicture> {
        let canvas = Canvas { size_px: [400, 300], scale: 2.0, dark: false };
        let shapes = shapes_offscreen(canvas, ui).unwrap();
        vector_picture(&shapes, canvas.size_points())
    }

    #[test]
    fn words_lines_and_areas_stay_what_they_are() {
        let picture = drawn(|ui| {
            ui.label("Yaw rate");
            let points = [[10.0, 90.0], [50.0, 40.0], [f32::NAN, 0.0], [90.0, 60.0], [95.0, 60.0]];
            let points = points.map(|[x, y]| egui::pos2(x, y)).to_vec();
            ui.painter().add(Shape::line(points, Stroke::new(1.5, Color32::RED)));
            let mut mesh = Mesh::default();
            for [x, y] in [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 9.0]] {
                mesh.colored_vertex(egui::pos2(x, y), Color32::BLUE);
            }
            mesh.add_triangle(0, 1, 2);
            mesh.add_triangle(1, 2, 3);
            ui.painter().add(Shape::mesh(mesh));
        });
        let shapes: Vec<VectorShape> =
            picture.unwrap().marks.into_iter().map(|mark| mark.shape).collect();
        let says = |word: &str| {
            shapes.iter().any(|it| matches!(it, VectorShape::Text { text, .. } if text == word))
        };
        assert!(says("Yaw") && says("rate"), "{shapes:?}");
        let line = shapes.iter().find_map(|shape| match shape {
            VectorShape::Outline { contours, stroke: Some((width, [255, 0, 0, 255])), .. } => {
                Some((contours.iter().map(Vec::len).collect::<Vec<_>>(), *width))
            }
            _ => None,
        });
        assert_eq!(line, Some((vec![2, 2], 1.5)), "{shapes:?}");
        let area = shapes.iter().find_map(|shape| match shape {
            VectorShape::Outline { contours, fill: Some([0, 0, 255, 255]), .. } => Some(contours),
            _ => None,
        });
        let turned = |corners: &Vec<[f32; 2]>| {
            let [a, b, c] = corners[..] else { panic!("{corners:?}") };
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let turns: Vec<f32> = area.unwrap().iter().map(turned).collect();
        assert_eq!(turns, [81.0, 81.0]);
    }

    #[test]
    fn an_image_stays_pixels() {
        let picture = drawn(|ui| {
            let mut mesh = Mesh::with_texture(TextureId::User(7));
            mesh.colored_vertex(Pos2::ZERO, Color32::WHITE);
            ui.painter().add(Shape::mesh(mesh));
        });
        assert_eq!(picture, None);
    }
}
