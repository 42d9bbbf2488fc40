//! How variants of a case, and further courses of events, are told apart in every picture and every file: by a
//! colour each, and by dashes where the colours come again.

/// Number of variants from which on a colour comes again, with other dashes.
pub const N_VARIANT_COLORS: usize = 8;

/// Colours for a light and a dark ground. They and the colour of the simulation are told apart by everybody:
/// where two hues are the same to an eye, their lightness differs. A test of the theme measures it.
const COLORS: [[[u8; 3]; 2]; N_VARIANT_COLORS] = [
    [[100, 60, 0], [255, 210, 50]],
    [[20, 40, 160], [140, 120, 255]],
    [[70, 20, 100], [160, 120, 150]],
    [[100, 0, 30], [0, 255, 180]],
    [[210, 100, 150], [220, 250, 130]],
    [[210, 40, 80], [180, 250, 255]],
    [[150, 20, 90], [200, 120, 110]],
    [[140, 140, 30], [230, 100, 60]],
];

/// Dashes of the variants. Those of lines that are no variant's are the first.
const DASHES: [Dashes; 3] = [
    Dashes { length: 10.0, sample: &[[-0.5, -0.1], [0.1, 0.5]] },
    Dashes { length: 5.0, sample: &[[-0.5, -0.28], [-0.11, 0.11], [0.28, 0.5]] },
    Dashes { length: 18.0, sample: &[[-0.5, 0.22], [0.4, 0.5]] },
];

/// How a dashed line is dashed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dashes {
    /// Length of a dash, points.
    pub length: f32,
    /// From where to where the dashes of its sample in a legend are, as shares of its width on both sides of
    /// the middle.
    pub sample: &'static [[f32; 2]],
}

impl Dashes {
    /// Length of the gap between two dashes, points: that of plots, where it is in the golden ratio to a dash.
    pub fn gap(self) -> f32 {
        self.length / std::f32::consts::GOLDEN_RATIO
    }
}

impl Default for Dashes {
    fn default() -> Self {
        DASHES[0]
    }
}

/// The colours of a variant for a light and a dark ground, 8 bits each for red, green and blue.
///
/// - `idx`: number of the variant among those beside the one in the forms.
pub fn variant_colors(idx: usize) -> [[u8; 3]; 2] {
    COLORS[idx % COLORS.len()]
}

/// The dashes of a variant.
///
/// - `idx`: as in [`variant_colors`].
pub fn variant_dashes(idx: usize) -> Dashes {
    DASHES[idx % DASHES.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_that_comes_again_is_dashed_otherwise() {
        let look = |idx| (variant_colors(idx), variant_dashes(idx));
        for idx in 0..3 * N_VARIANT_COLORS {
            let is_same = |other: &usize| look(*other) == look(idx);
            assert_eq!((0..idx).find(is_same), None, "{idx}");
        }
    }
}
