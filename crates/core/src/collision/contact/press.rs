//! Strips of a contact that are pressed together side by side in the lanes of vector registers.

use pulp::{Simd, WithSimd};

use crate::collision::contact::{PressedStrips, Strip, press_together};
use crate::numerics::{MAX_LANES, Packed};

/// Numbers of a strip.
const N_STRIP: usize = 7;

/// Two strips with the overlap that they share, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pressing {
    /// The strips.
    pub strips: [Strip<f64>; 2],
    /// D, m.
    pub overlap_m: f64,
}

/// Presses pairs of strips together, each to the last digit as [`press_together`] does.
///
/// - `pressed`: takes the loads and deflections in the order of the pairs.
pub(super) fn press_side_by_side(pressings: &[Pressing], pressed: &mut Vec<PressedStrips<f64>>) {
    pressed.clear();
    pulp::Arch::new().dispatch(SideBySide { pressings, pressed });
}

impl<T> Strip<T> {
    /// Its numbers in the order of its fields.
    #[inline(always)]
    fn into_array(self) -> [T; N_STRIP] {
        let Self {
            greatest_m,
            dent_m,
            load_there_n_per_m,
            onset_n_per_m,
            elastic_depth_m,
            per_stiffness_m2_per_n,
            saturation_n_per_m,
        } = self;
        [
            greatest_m,
            dent_m,
            load_there_n_per_m,
            onset_n_per_m,
            elastic_depth_m,
            per_stiffness_m2_per_n,
            saturation_n_per_m,
        ]
    }

    /// The strip with these numbers.
    #[inline(always)]
    fn from_array(numbers: [T; N_STRIP]) -> Self {
        let [
            greatest_m,
            dent_m,
            load_there_n_per_m,
            onset_n_per_m,
            elastic_depth_m,
            per_stiffness_m2_per_n,
            saturation_n_per_m,
        ] = numbers;
        Self {
            greatest_m,
            dent_m,
            load_there_n_per_m,
            onset_n_per_m,
            elastic_depth_m,
            per_stiffness_m2_per_n,
            saturation_n_per_m,
        }
    }
}

struct SideBySide<'a> {
    pressings: &'a [Pressing],
    pressed: &'a mut Vec<PressedStrips<f64>>,
}

impl WithSimd for SideBySide<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for chunk in self.pressings.chunks(Packed::<S>::N) {
            let last = chunk.len() - 1;
            let lane = |lane: usize| &chunk[lane.min(last)];
            let [a, b] = [0, 1].map(|side| {
                let rows: [[f64; N_STRIP]; MAX_LANES] =
                    std::array::from_fn(|i| lane(i).strips[side].into_array());
                Strip::from_array(Packed::columns(simd, &rows))
            });
            let overlaps_m: [f64; MAX_LANES] = std::array::from_fn(|i| lane(i).overlap_m);
            let found = press_together([&a, &b], Packed::new(simd, &overlaps_m));
            let loads_n_per_m = found.load_n_per_m.to_array();
            let [of_a, of_b] = found.deflections_m.map(Packed::to_array);
            self.pressed.extend((0..chunk.len()).map(|i| PressedStrips {
                load_n_per_m: loads_n_per_m[i],
                deflections_m: [of_a[i], of_b[i]],
            }));
        }
    }
}
