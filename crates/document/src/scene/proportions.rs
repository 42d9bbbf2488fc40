//! Proportions of a body by its kind. They are plausible for the kind, and those of no make.

use crate::scene::BodyClass;
use impactlab_core::numerics::interpolate;

/// Proportions of a body. Places along it are shares of the length from the front end; heights are
/// shares of the height of the roof.
#[derive(Debug, Clone, Copy)]
pub(super) struct Proportions {
    /// Heights of the bonnet at its front edge, at the windscreen and of the sill.
    pub nose: f64,
    pub cowl: f64,
    pub sill: f64,
    /// Foot and top of the windscreen, end of the roof and foot of the rear window.
    pub cabin: [f64; 4],
    /// Heights of the body at the foot of the rear window and at the tail.
    pub deck: f64,
    pub tail: f64,
    /// Half width of the roof over that of the body.
    pub roof_width: f64,
}

/// Half width of the body over that of its widest part, along the body.
const TAPER_PLACES: [f64; 8] = [0.0, 0.02, 0.06, 0.14, 0.86, 0.95, 0.985, 1.0];
const TAPER_WIDTHS: [f64; 8] = [0.70, 0.86, 0.955, 1.0, 1.0, 0.965, 0.90, 0.80];

impl Proportions {
    pub fn from_class(class: BodyClass) -> Self {
        let proportions = |nose, [cowl, deck, tail]: [f64; 3], cabin, roof_width| Self {
            nose,
            cowl,
            sill: 0.15,
            cabin,
            deck,
            tail,
            roof_width,
        };
        match class {
            BodyClass::Hatch => {
                proportions(0.47, [0.66, 0.66, 0.60], [0.24, 0.42, 0.86, 0.965], 0.72)
            }
            BodyClass::Saloon => {
                proportions(0.46, [0.65, 0.70, 0.65], [0.26, 0.43, 0.68, 0.84], 0.70)
            }
            BodyClass::Estate => {
                proportions(0.46, [0.65, 0.66, 0.60], [0.26, 0.42, 0.90, 0.98], 0.71)
            }
            BodyClass::Suv => {
                proportions(0.50, [0.64, 0.63, 0.57], [0.24, 0.38, 0.89, 0.975], 0.76)
            }
            BodyClass::Van => proportions(0.40, [0.55, 0.56, 0.50], [0.13, 0.29, 0.95, 0.99], 0.82),
            BodyClass::Pickup => {
                proportions(0.51, [0.63, 0.61, 0.60], [0.25, 0.36, 0.54, 0.58], 0.76)
            }
        }
    }

    /// Height of the upper side of the body below the cabin, over the height of the roof.
    pub fn top(&self, place: f64) -> f64 {
        let [foot, _, _, end] = self.cabin;
        let places = [0.0, 0.025, foot, end, 0.985_f64.max(end + 0.003), 1.0];
        let last = self.tail - 0.05;
        let heights = [
            self.nose - 0.05,
            self.nose,
            self.cowl,
            self.deck,
            self.tail,
            last.max(self.sill + 0.1),
        ];
        interpolate(&places, &heights, place).unwrap_or(self.cowl)
    }

    /// Half width over that of the widest part.
    pub fn taper(place: f64) -> f64 {
        interpolate(&TAPER_PLACES, &TAPER_WIDTHS, place).unwrap_or(1.0)
    }

    /// Places at which the shape of the body changes, without the wheel arches.
    pub fn places(&self) -> Vec<f64> {
        let [foot, _, _, end] = self.cabin;
        let mut places = TAPER_PLACES.to_vec();
        places.extend([0.035, foot, (foot + end) / 2.0, end]);
        places
    }
}
