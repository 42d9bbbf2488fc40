//! Lines with smooth edges, drawn over the pixels of some rows.

use egui::Color32;

/// A straight piece of a line in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Ends, pixels.
    pub ends: [[f32; 2]; 2],
    /// Half of the width, pixels.
    pub half_width: f32,
    /// Colour.
    pub color: Color32,
    /// Opacity, 0 to 1.
    pub opacity: f32,
}

/// Rows of a picture.
pub struct Rows<'a> {
    /// Pixels row by row.
    pub pixels: &'a mut [Color32],
    /// Width of a row.
    pub width: usize,
    /// Number of the first row in the picture.
    pub first: usize,
}

impl Rows<'_> {
    /// Number of rows.
    pub fn n_rows(&self) -> usize {
        self.pixels.len() / self.width.max(1)
    }

    /// Draws a stroke with round ends.
    pub fn stroke(&mut self, stroke: &Stroke) {
        let [[x0, y0], [x1, y1]] = stroke.ends;
        let reach = stroke.half_width + 1.0;
        let (top, bottom) = (self.first as f32, (self.first + self.n_rows()) as f32);
        if y0.max(y1) + reach < top || y0.min(y1) - reach > bottom {
            return;
        }
        let (dx, dy) = (x1 - x0, y1 - y0);
        let squared = dx * dx + dy * dy;
        let inverse = if squared > 1e-9 { 1.0 / squared } else { 0.0 };
        let low_row = (y0.min(y1) - reach).floor().max(top) as usize;
        let high_row = ((y0.max(y1) + reach).ceil().min(bottom)).max(0.0) as usize;
        for row in low_row..high_row {
            let py = row as f32 + 0.5;
            // The part of the row that the stroke can reach.
            let [mut left, mut right] = [x0.min(x1), x0.max(x1)];
            if dy.abs() > 1e-3 {
                let at = |y: f32| x0 + dx * ((y - y0) / dy).clamp(0.0, 1.0);
                let (a, b) = (at(py - reach), at(py + reach));
                [left, right] = [a.min(b), a.max(b)];
            }
            let from = (left - reach).floor().max(0.0) as usize;
            let to = ((right + reach).ceil().max(0.0) as usize).min(self.width);
            let start = (row - self.first) * self.width;
            for column in from..to {
                let px = column as f32 + 0.5;
                let along = (((px - x0) * dx + (py - y0) * dy) * inverse).clamp(0.0, 1.0);
                let (ox, oy) = (px - x0 - along * dx, py - y0 - along * dy);
                let distance = (ox * ox + oy * oy).sqrt();
                let cover = (stroke.half_width + 0.5 - distance).clamp(0.0, 1.0);
                if cover > 0.0
                    && let Some(pixel) = self.pixels.get_mut(start + column)
                {
                    *pixel = over(*pixel, stroke.color, cover * stroke.opacity);
                }
            }
        }
    }
}

/// A colour over another that is opaque.
pub fn over(under: Color32, color: Color32, share: f32) -> Color32 {
    let weight = (share * 256.0) as u32;
    let mix = |a: u8, b: u8| ((u32::from(a) * (256 - weight) + u32::from(b) * weight) >> 8) as u8;
    Color32::from_rgb(
        mix(under.r(), color.r()),
        mix(under.g(), color.g()),
        mix(under.b(), color.b()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_covers_its_width_and_rows_agree_with_the_whole() {
        let draw = |parts: usize| {
            let (width, height) = (40_usize, 24_usize);
            let mut pixels = vec![Color32::BLACK; width * height];
            let rows = height / parts;
            for (idx, part) in pixels.chunks_mut(width * rows).enumerate() {
                let mut band = Rows { pixels: part, width, first: idx * rows };
                for ends in [[[5.0, 12.0], [35.0, 12.0]], [[6.5, 2.0], [30.0, 21.0]]] {
                    let color = Color32::WHITE;
                    band.stroke(&Stroke { ends, half_width: 1.0, color, opacity: 1.0 });
                }
            }
            pixels
        };
        let whole = draw(1);
        assert_eq!(whole, draw(4));
        let at = |x: usize, y: usize| whole[y * 40 + x].r();
        assert_eq!((at(10, 11), at(10, 12)), (255, 255), "two pixels of full colour");
        assert_eq!((at(2, 12), at(20, 3)), (0, 0));
        assert!(at(4, 11) > 0, "the end is round");
    }
}
