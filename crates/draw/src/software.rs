//! Draws the triangles of egui on the CPU, which needs no graphics driver and gives the same
//! picture on every machine. The crate `egui_software_backend` does this for older versions of egui
//! only.
//!
//! The rules are those of egui's own renderers: colours are premultiplied sRGB and blended in that
//! space, textures are filtered linearly and clamped at their edges, and a pixel belongs to a
//! triangle if its centre does.
//!
//! Left out: paint callbacks, which the figures do not use.

use std::collections::HashMap;
use std::ops::Range;

use egui::epaint::{ClippedPrimitive, ImageDelta, Mesh, Primitive, TextureId, Vertex};
use egui::{Color32, ColorImage, ImageData, Pos2, Rect, TexturesDelta};
use image::RgbaImage;

/// A renderer for frames of egui, with the textures that earlier frames have set.
#[derive(Debug, Default)]
pub struct SoftwareRenderer {
    textures: HashMap<TextureId, ColorImage>,
}

impl SoftwareRenderer {
    /// Applies new and changed textures and removes those that are no longer used. The delta is
    /// empty afterwards.
    #[expect(clippy::iter_over_hash_type, reason = "textures do not depend on each other")]
    pub fn update_textures(&mut self, delta: &mut TexturesDelta) {
        for (id, patches) in delta.set.drain() {
            for patch in patches {
                self.update_texture(id, patch);
            }
        }
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    /// Replaces a texture, or a rectangle of it if the patch has a position.
    fn update_texture(&mut self, id: TextureId, patch: ImageDelta) {
        let ImageData::Color(image) = patch.image;
        let Some([x0, y0]) = patch.pos else {
            self.textures.insert(id, (*image).clone());
            return;
        };
        let Some(texture) = self.textures.get_mut(&id) else {
            return;
        };
        let (width, texture_width) = (image.size[0], texture.size[0]);
        for (row, pixels) in image.pixels.chunks_exact(width.max(1)).enumerate() {
            let start = (y0 + row) * texture_width + x0;
            if let Some(target) = texture.pixels.get_mut(start..start + width) {
                target.copy_from_slice(pixels);
            }
        }
    }

    /// Draws a frame of a given [width, height] in pixels over a background. The picture is opaque.
    pub fn draw(
        &self,
        primitives: &[ClippedPrimitive],
        [width, height]: [u32; 2],
        pixels_per_point: f32,
        background: Color32,
    ) -> RgbaImage {
        let mut image = ColorImage::filled([width as usize, height as usize], background);
        self.draw_over(primitives, pixels_per_point, &mut image);
        let opaque = |color: &Color32| image::Rgba([color.r(), color.g(), color.b(), 255]);
        let mut drawn = RgbaImage::new(width, height);
        for (pixel, color) in drawn.pixels_mut().zip(&image.pixels) {
            *pixel = opaque(color);
        }
        drawn
    }

    /// Draws a frame over an image of the same size, whose pixels are opaque and stay so.
    pub fn draw_over(
        &self,
        primitives: &[ClippedPrimitive],
        pixels_per_point: f32,
        image: &mut ColorImage,
    ) {
        let [width, height] = image.size;
        let mut frame = Frame { width, height, pixels: std::mem::take(&mut image.pixels) };
        for ClippedPrimitive { clip_rect, primitive } in primitives {
            let Primitive::Mesh(mesh) = primitive else {
                continue;
            };
            if let Some(texture) = self.textures.get(&mesh.texture_id) {
                frame.draw_mesh(mesh, texture, *clip_rect * pixels_per_point, pixels_per_point);
            }
        }
        image.pixels = frame.pixels;
    }
}

struct Frame {
    width: usize,
    height: usize,
    pixels: Vec<Color32>,
}

impl Frame {
    fn draw_mesh(&mut self, mesh: &Mesh, texture: &ColorImage, clip: Rect, scale: f32) {
        for corners in mesh.indices.chunks_exact(3) {
            let vertex = |corner: usize| mesh.vertices.get(corners[corner] as usize);
            if let (Some(a), Some(b), Some(c)) = (vertex(0), vertex(1), vertex(2)) {
                let scaled =
                    [a, b, c].map(|v| Vertex { pos: (v.pos.to_vec2() * scale).to_pos2(), ..*v });
                self.draw_triangle(scaled, texture, clip);
            }
        }
    }

    fn draw_triangle(&mut self, [a, mut b, mut c]: [Vertex; 3], texture: &ColorImage, clip: Rect) {
        let mut area = Edge { from: a.pos, to: b.pos }.area(c.pos);
        if area < 0.0 {
            std::mem::swap(&mut b, &mut c);
            area = -area;
        }
        if !(area > 0.0 && area.is_finite()) {
            return;
        }
        let bounds = Rect::from_points(&[a.pos, b.pos, c.pos]).intersect(clip);
        let pixel_range = |low: f32, high: f32, n: usize| {
            let first = (low - 0.5).ceil().max(0.0) as usize;
            let end = ((high - 0.5).floor() + 1.0).clamp(0.0, n as f32) as usize;
            first..end
        };
        let flat = a.color == b.color && b.color == c.color;
        let untextured = a.uv == b.uv && b.uv == c.uv;
        let constant_texel = untextured.then(|| sample(texture, a.uv));
        let even = constant_texel.filter(|_| flat).map(|texel| textured(channels(a.color), texel));
        let edges = [(b, c), (c, a), (a, b)].map(|(from, to)| Edge { from: from.pos, to: to.pos });
        let columns = pixel_range(bounds.min.x, bounds.max.x, self.width);
        for y in pixel_range(bounds.min.y, bounds.max.y, self.height) {
            let y_center = y as f32 + 0.5;
            let inside = |columns: Range<usize>, edge: &Edge| edge.owned(columns, y_center);
            let columns = edges.iter().fold(columns.clone(), inside);
            if let Some(over) = even {
                let row = y * self.width;
                let pixels = self.pixels.get_mut(row + columns.start..row + columns.end);
                blend_all(pixels.unwrap_or_default(), over);
                continue;
            }
            for x in columns {
                let p = Pos2::new(x as f32 + 0.5, y_center);
                let [wa, wb, wc] = edges.map(|edge| edge.area(p) / area);
                let color = if flat {
                    channels(a.color)
                } else {
                    mix([channels(a.color), channels(b.color), channels(c.color)], [wa, wb, wc])
                };
                let texel = constant_texel.unwrap_or_else(|| {
                    let uv = a.uv.to_vec2() * wa + b.uv.to_vec2() * wb + c.uv.to_vec2() * wc;
                    sample(texture, uv.to_pos2())
                });
                let pixel = &mut self.pixels[y * self.width + x];
                *pixel = blend(*pixel, textured(color, texel));
            }
        }
    }
}

/// An edge of a triangle that is clockwise on screen, where y points down.
#[derive(Clone, Copy)]
struct Edge {
    from: Pos2,
    to: Pos2,
}

impl Edge {
    /// Twice the signed area of the triangle of the edge and `p`: positive on the inner side.
    fn area(self, p: Pos2) -> f32 {
        let Self { from, to } = self;
        (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x)
    }

    /// Whether `p` belongs to the triangle as far as this edge says.
    fn owns(self, p: Pos2) -> bool {
        let area = self.area(p);
        area > 0.0 || (area == 0.0 && self.is_top_left())
    }

    /// Whether it is a top or a left edge of its triangle. A pixel centre on such an edge belongs to
    /// the triangle, so that a pixel on an edge shared by two triangles is drawn once.
    fn is_top_left(self) -> bool {
        let Self { from, to } = self;
        (from.y == to.y && to.x > from.x) || to.y < from.y
    }

    /// Those of the columns of a row of pixels that it owns. Along a row the area grows or shrinks all
    /// the way, rounding included, so that they are all on one side of a column.
    fn owned(self, columns: Range<usize>, y: f32) -> Range<usize> {
        let shrinks = self.to.y > self.from.y;
        let (mut low, mut high) = (columns.start, columns.end);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.owns(Pos2::new(middle as f32 + 0.5, y)) == shrinks {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        if shrinks { columns.start..low } else { low..columns.end }
    }
}

fn channels(color: Color32) -> [f32; 4] {
    color.to_array().map(f32::from)
}

fn mix(colors: [[f32; 4]; 3], weights: [f32; 3]) -> [f32; 4] {
    std::array::from_fn(|i| (0..3).map(|corner| colors[corner][i] * weights[corner]).sum())
}

/// Colour of a texture at the coordinates `uv` (0 to 1), filtered linearly and clamped at the
/// edges; channels 0 to 255.
fn sample(texture: &ColorImage, uv: Pos2) -> [f32; 4] {
    let [width, height] = texture.size;
    if width == 0 || height == 0 {
        return [0.0; 4];
    }
    let along = |share: f32, n: usize| {
        let at = (share * n as f32 - 0.5).clamp(0.0, (n - 1) as f32);
        let low = at as usize;
        (low, (low + 1).min(n - 1), at - low as f32)
    };
    let ((x0, x1, fx), (y0, y1, fy)) = (along(uv.x, width), along(uv.y, height));
    let texel = |x: usize, y: usize| channels(texture.pixels[y * width + x]);
    let (top, bottom) = ([texel(x0, y0), texel(x1, y0)], [texel(x0, y1), texel(x1, y1)]);
    std::array::from_fn(|i| {
        let row = |pair: [[f32; 4]; 2]| pair[0][i] * (1.0 - fx) + pair[1][i] * fx;
        row(top) * (1.0 - fy) + row(bottom) * fy
    })
}

/// A colour times one of a texture.
fn textured(color: [f32; 4], texel: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|i| color[i] * texel[i] / 255.0)
}

/// The same colour composited over every pixel.
fn blend_all(pixels: &mut [Color32], over: [f32; 4]) {
    if over[3] == 255.0 {
        pixels.fill(blend(Color32::TRANSPARENT, over));
        return;
    }
    for pixel in pixels {
        *pixel = blend(*pixel, over);
    }
}

/// The colour `over` composited over `under`; both are premultiplied.
fn blend(under: Color32, over: [f32; 4]) -> Color32 {
    let keep = 1.0 - over[3] / 255.0;
    let under = channels(under);
    let [r, g, b, a] = std::array::from_fn(|i| rounded(over[i] + under[i] * keep));
    Color32::from_rgba_premultiplied(r, g, b, a)
}

/// A channel of 0 to 255, rounded as [`f32::round`] does, which is a function call for each channel on
/// processors for which no newer instructions are assumed.
fn rounded(channel: f32) -> u8 {
    let whole = channel as u8;
    whole.saturating_add(u8::from(channel - f32::from(whole) >= 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(color: Color32) -> ClippedPrimitive {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(Rect::from_min_max(Pos2::new(1.0, 1.0), Pos2::new(3.0, 3.0)), color);
        let clip_rect = Rect::from_min_max(Pos2::ZERO, Pos2::new(2.0, 9.0));
        ClippedPrimitive { clip_rect, primitive: Primitive::Mesh(mesh) }
    }

    fn renderer() -> SoftwareRenderer {
        let white = ColorImage::filled([1, 1], Color32::WHITE);
        SoftwareRenderer { textures: [(TextureId::default(), white)].into() }
    }

    #[test]
    fn pixels_inside_triangle_and_clip_are_blended_once() {
        let half = Color32::from_rgba_premultiplied(100, 0, 0, 128);
        let image = renderer().draw(&[square(half)], [8, 8], 2.0, Color32::from_gray(200));
        for y in 0..8 {
            for x in 0..8 {
                let inside = (2..4).contains(&x) && (2..6).contains(&y);
                let expected = if inside { [200, 100, 100, 255] } else { [200, 200, 200, 255] };
                assert_eq!(image.get_pixel(x, y).0, expected, "at {x}, {y}");
            }
        }
    }

    #[test]
    fn channels_are_rounded_as_numbers_are() {
        let halves = (0..1100).map(|i| i as f32 / 4.0 - 10.0);
        let near = [0.499_999_97, 0.500_000_06, 254.499_98, 255.49, 1e9, -1e9, f32::NAN];
        for channel in halves.chain(near) {
            assert_eq!(rounded(channel), channel.round() as u8, "{channel}");
        }
    }

    /// Corners at centres and corners of pixels too, where edges go through centres.
    #[test]
    fn an_edge_owns_the_same_columns_of_a_row_as_pixel_by_pixel() {
        let mut state = 1_u64;
        let mut random = |step: f32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let share = (state >> 40) as f32 / (1_u64 << 24) as f32;
            ((share * 60.0 - 10.0) / step).round() * step
        };
        let mut n_owned = 0;
        for i in 0..3000 {
            let step = [1e-4, 0.5, 1.0][i % 3];
            let [from, to] = [(); 2].map(|()| Pos2::new(random(step), random(step)));
            let edge = Edge { from, to };
            for y in [0.5, 7.5, 20.5] {
                let alone = |x: &usize| edge.owns(Pos2::new(*x as f32 + 0.5, y));
                let expected: Vec<usize> = (2..40).filter(alone).collect();
                assert_eq!(edge.owned(2..40, y).collect::<Vec<_>>(), expected, "{from} {to} {y}");
                n_owned += expected.len();
            }
        }
        assert!((100_000..242_000).contains(&n_owned), "{n_owned} of 342000");
    }

    #[test]
    fn a_patch_changes_its_part_of_a_texture() {
        let mut renderer = renderer();
        let id = TextureId::Managed(7);
        let options = egui::TextureOptions::LINEAR;
        let whole = ColorImage::filled([3, 2], Color32::BLACK);
        let patch = ColorImage::filled([2, 1], Color32::RED);
        let mut delta = TexturesDelta::default();
        delta.push(id, ImageDelta::full(whole, options));
        delta.push(id, ImageDelta::partial([1, 1], patch, options));
        renderer.update_textures(&mut delta);
        let red: Vec<bool> =
            renderer.textures[&id].pixels.iter().map(|p| *p == Color32::RED).collect();
        assert_eq!(red, [false, false, false, false, true, true]);
        assert!(delta.is_empty());
    }
}
