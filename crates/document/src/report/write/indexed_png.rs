//! Pictures as PNG with a palette: a third of the bytes of true colours, and next to no difference to
//! be seen in plots and drawn scenes.

use std::collections::BTreeMap;

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::report::Pixels;

/// Colours of a palette.
const MOST_COLORS: usize = 256;

/// Red, green and blue.
type Rgb = [u8; 3];

/// A picture as the bytes of a PNG file. Pictures of reports are opaque.
///
/// # Errors
/// If the pixels are not as many as the size says.
pub(super) fn indexed_png(pixels: &Pixels) -> Result<Vec<u8>, EncodingError> {
    let palette = Palette::of(pixels);
    let [width, height] = pixels.size_px;
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(palette.colors.concat());
    encoder.set_compression(Compression::High);
    // Numbers of colours are no brightness that could be told from that of the pixel beside it.
    encoder.set_filter(Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    let indices: Vec<u8> = colors(pixels).map(|color| palette.index(color)).collect();
    writer.write_image_data(&indices)?;
    writer.finish()?;
    Ok(bytes)
}

/// The colours of the pixels in their order.
fn colors(pixels: &Pixels) -> impl Iterator<Item = Rgb> {
    pixels.rgba.chunks_exact(4).filter_map(|pixel| pixel.first_chunk::<3>().copied())
}

/// The colours of a picture, or as many that stand for them.
struct Palette {
    colors: Vec<Rgb>,
    /// For each colour of the picture, the number of that which stands for it.
    numbers: BTreeMap<Rgb, u8>,
}

impl Palette {
    /// The colours that are cut apart where they differ most, in the middle: a few pixels of a colour of
    /// their own, such as a line, keep it.
    fn of(pixels: &Pixels) -> Self {
        let mut counts: BTreeMap<Rgb, u64> = BTreeMap::new();
        for color in colors(pixels) {
            *counts.entry(color).or_default() += 1;
        }
        let mut groups = vec![Group { colors: counts.into_iter().collect() }];
        while groups.len() < MOST_COLORS {
            let widest = groups.iter().enumerate().max_by_key(|(_, group)| group.weight());
            let Some((idx, _)) = widest.filter(|(_, group)| group.weight() > 0) else { break };
            let halves = groups.swap_remove(idx).halves();
            groups.extend(halves);
        }
        let mut palette = Self { colors: Vec::new(), numbers: BTreeMap::new() };
        for (number, group) in (0..=u8::MAX).zip(&groups) {
            palette.colors.push(group.mean());
            palette.numbers.extend(group.colors.iter().map(|(color, _)| (*color, number)));
        }
        palette
    }

    fn index(&self, color: Rgb) -> u8 {
        self.numbers.get(&color).copied().unwrap_or(0)
    }
}

/// Colours that have one number, with how many pixels have each.
struct Group {
    colors: Vec<(Rgb, u64)>,
}

impl Group {
    /// The component in which the colours differ most, and how much.
    fn widest(&self) -> (usize, u8) {
        let width = |component: usize| {
            let values = || self.colors.iter().filter_map(|(color, _)| color.get(component));
            let (least, most) = (values().min(), values().max());
            most.zip(least).map_or(0, |(most, least)| most - least)
        };
        let widths = [0, 1, 2].map(|component| (component, width(component)));
        widths.into_iter().max_by_key(|(_, width)| *width).unwrap_or((0, 0))
    }

    /// How much is gained by cutting it: many pixels of colours that differ much.
    fn weight(&self) -> u64 {
        let (_, width) = self.widest();
        let n: u64 = self.colors.iter().map(|(_, n)| n).sum();
        // A few pixels of a colour of their own, such as a line, count more than their number.
        n.isqrt() * u64::from(width) * u64::from(width)
    }

    /// The colours below and above the middle of the widest component, neither of them empty.
    fn halves(self) -> [Self; 2] {
        let (component, _) = self.widest();
        let of = |color: &Rgb| u16::from(color.get(component).copied().unwrap_or(0));
        let values = || self.colors.iter().map(|(color, _)| of(color));
        let ends = values().min().unwrap_or(0) + values().max().unwrap_or(0);
        let is_below = |(color, _): &(Rgb, u64)| 2 * of(color) <= ends;
        let (below, above) = self.colors.iter().copied().partition(is_below);
        [Self { colors: below }, Self { colors: above }]
    }

    fn mean(&self) -> Rgb {
        let n: u64 = self.colors.iter().map(|(_, n)| n).sum();
        [0, 1, 2].map(|component| {
            let value = |(color, n): &(Rgb, u64)| Some(u64::from(*color.get(component)?) * n);
            let sum: u64 = self.colors.iter().filter_map(value).sum();
            u8::try_from((sum + n / 2) / n.max(1)).unwrap_or(u8::MAX)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(png: &[u8]) -> Vec<Rgb> {
        let read = image::load_from_memory(png).unwrap().to_rgb8();
        read.pixels().map(|pixel| pixel.0).collect()
    }

    fn picture(size_px: [u32; 2], color: impl Fn(u32, u32) -> Rgb) -> Pixels {
        let [width, height] = size_px;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let rgba = places.flat_map(|(x, y)| {
            let [red, green, blue] = color(x, y);
            [red, green, blue, 255]
        });
        Pixels { size_px, rgba: rgba.collect() }
    }

    #[test]
    fn a_picture_of_few_colors_stays_as_it_is() {
        let few = picture([40, 30], |x, y| [(x / 4 * 20) as u8, (y / 3 * 20) as u8, 7]);
        let read = read(&indexed_png(&few).unwrap());
        assert_eq!(read, colors(&few).collect::<Vec<_>>());
    }

    #[test]
    fn of_many_colors_none_is_far_off_and_the_file_is_small() {
        let many = picture([300, 200], |x, y| {
            let line = u8::from(x % 50 == 0) * 255;
            [(x * 255 / 300) as u8, (y * 255 / 200) as u8, line]
        });
        let png = indexed_png(&many).unwrap();
        let far = read(&png).into_iter().zip(colors(&many)).map(|(shown, color)| {
            (0..3).map(|idx| shown[idx].abs_diff(color[idx])).max().unwrap_or(0)
        });
        assert!(far.max() < Some(40));
        assert!(png.len() < 300 * 200, "{} bytes", png.len());
        assert_eq!(png, indexed_png(&many).unwrap());
    }

    #[test]
    fn pixels_that_are_too_few_are_an_error() {
        let few = Pixels { size_px: [3, 3], rgba: vec![0; 8] };
        assert!(indexed_png(&few).is_err());
    }
}
