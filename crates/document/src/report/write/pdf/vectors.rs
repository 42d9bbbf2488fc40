//! Draws the lines, areas and texts of a picture onto a page.

use krilla::color::rgb;
use krilla::geom::{Path, PathBuilder, Rect, Transform};
use krilla::num::NormalizedF32;
use krilla::paint::{Fill, FillRule, LineJoin, Stroke};
use krilla::surface::Surface;

use crate::report::write::pdf::draw::Lettering;
use crate::report::write::pdf::fonts::Fonts;
use crate::report::{VectorPicture, VectorShape};

/// Draws a picture so that it fills the width of its place.
///
/// - `rect_pt`: left, top, width, height of the place.
pub(super) fn draw_vectors(
    surface: &mut Surface<'_>,
    [left, top, width, height]: [f32; 4],
    picture: &VectorPicture,
    fonts: &Fonts,
) {
    let [picture_width, picture_height] = picture.size;
    let scale = (width / picture_width).min(height / picture_height);
    if !scale.is_finite() || scale <= 0.0 {
        return;
    }
    surface.push_transform(&Transform::from_row(scale, 0.0, 0.0, scale, left, top));
    for marks in picture.marks.chunk_by(|a, b| a.clip == b.clip) {
        let [left, top, width, height] = marks.first().map_or([0.0; 4], |mark| mark.clip);
        let clip = Rect::from_xywh(left, top, width, height).and_then(path_of_rect);
        let Some(clip) = clip else { continue };
        surface.push_clip_path(&clip, &FillRule::NonZero);
        for mark in marks {
            draw_shape(surface, &mark.shape, fonts);
        }
        surface.pop();
    }
    surface.pop();
}

fn path_of_rect(rect: Rect) -> Option<Path> {
    let mut builder = PathBuilder::new();
    builder.push_rect(rect);
    builder.finish()
}

fn draw_shape(surface: &mut Surface<'_>, shape: &VectorShape, fonts: &Fonts) {
    match shape {
        VectorShape::Outline { contours, is_closed, fill, stroke } => {
            let Some(path) = path(contours, *is_closed) else { return };
            // With neither, the path would be drawn in black.
            if fill.is_none() && stroke.is_none() {
                return;
            }
            surface.set_fill(fill.map(filled));
            surface.set_stroke(stroke.map(|(width, color)| Stroke {
                paint: rgb_of(color).into(),
                opacity: opacity_of(color),
                width,
                line_join: LineJoin::Round,
                ..Stroke::default()
            }));
            surface.draw_path(&path);
            surface.set_stroke(None);
        }
        VectorShape::Text { at, angle_rad, size, color, text } => {
            let [x, y] = *at;
            surface.push_transform(&Transform::from_rotate_at(angle_rad.to_degrees(), x, y));
            surface.set_fill(Some(filled(*color)));
            surface.set_stroke(None);
            Lettering { fonts, size_pt: *size }.draw(surface, text, *at);
            surface.pop();
        }
    }
}

/// Lines through all contours; `None` if there is nothing to draw.
fn path(contours: &[Vec<[f32; 2]>], is_closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for contour in contours {
        let Some(([x, y], behind)) = contour.split_first() else { continue };
        builder.move_to(*x, *y);
        for [x, y] in behind {
            builder.line_to(*x, *y);
        }
        if is_closed {
            builder.close();
        }
    }
    builder.finish()
}

fn filled(color: [u8; 4]) -> Fill {
    Fill { paint: rgb_of(color).into(), opacity: opacity_of(color), rule: FillRule::NonZero }
}

fn rgb_of([red, green, blue, _]: [u8; 4]) -> rgb::Color {
    rgb::Color::new(red, green, blue)
}

fn opacity_of([.., opacity]: [u8; 4]) -> NormalizedF32 {
    NormalizedF32::new(f32::from(opacity) / 255.0).unwrap_or(NormalizedF32::ONE)
}
