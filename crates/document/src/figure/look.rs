//! Colours and dashes of the roles in every picture and every file.
//!
//! The palette is that of [`OkabeIto2008`](impactlab_core::bibliography::OkabeIto2008), whose colours can be
//! distinguished with any of the common colour-vision deficiencies. Colours that are too pale for a
//! white background or too dark for a black one are shifted in lightness. Variants of a case, and further
//! courses of events, have a colour each, and other dashes where the colours come again.

use crate::figure::Role;

/// Number of variants from which on a colour comes again, with other dashes.
pub const N_VARIANT_COLORS: usize = 8;

/// Colours of the variants for a light and a dark ground. They and the colour of the simulation are told
/// apart by everybody: where two hues are the same to an eye, their lightness differs. A test of the theme
/// measures it.
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

impl Role {
    /// Its colour, 8 bits each for red, green and blue.
    ///
    /// - `dark`: whether the background is dark.
    pub fn rgb(self, dark: bool) -> [u8; 3] {
        let on_light_and_dark = match self {
            Self::Simulation | Self::ComponentX | Self::Model => [[0, 114, 178], [86, 180, 233]],
            Self::Reference => [[60, 60, 60], [215, 215, 215]],
            Self::Target | Self::LeftWheel => [[0, 128, 96], [0, 190, 140]],
            Self::Striking | Self::ComponentY | Self::Validation => [[213, 94, 0], [240, 130, 50]],
            Self::Resultant => [[60, 60, 60], [225, 225, 225]],
            Self::Pulse => [[170, 80, 140], [220, 145, 190]],
            Self::RightWheel => [[110, 70, 170], [170, 140, 230]],
            Self::Variant(idx) => COLORS[idx % COLORS.len()],
            Self::Muted => [[150, 150, 150], [120, 120, 120]],
        };
        on_light_and_dark[usize::from(dark)]
    }

    /// How its lines are dashed where they are.
    pub fn dashes(self) -> Dashes {
        match self {
            Self::Variant(idx) => DASHES[idx % DASHES.len()],
            _ => Dashes::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_that_comes_again_is_dashed_otherwise() {
        let look = |idx| {
            let role = Role::Variant(idx);
            ([false, true].map(|dark| role.rgb(dark)), role.dashes())
        };
        for idx in 0..3 * N_VARIANT_COLORS {
            let is_same = |other: &usize| look(*other) == look(idx);
            assert_eq!((0..idx).find(is_same), None, "{idx}");
        }
    }
}
