//! Points that fill a cube evenly, each by its index alone: the Sobol sequence, scrambled as Owen has it.
//!
//! The sequence ends after 2¹⁶ points and 256 dimensions. Longer sweeps go on with further sequences that
//! are scrambled independently of it, one for each 2¹⁶ points: each is as even by itself, and their mean
//! is unbiased. Dimensions beyond 256 are padded with further sequences likewise.

use rand::Rng as _;
use sobol_burley::NUM_DIMENSIONS;
use sobol_burley::parts::{hash, owen_scramble_rev, sobol_rev};

use impactlab_core::numerics::random_stream;

/// Points of a sequence.
const N_POINTS: u64 = 1 << 16;

/// What scrambles the order of the points.
const ORDER: u32 = 0x79c6_8e4a;

/// A point of the unit cube; its coordinates are between 0 and 1, and neither.
pub(crate) fn point(seed: u64, index: u64, n_dimensions: usize) -> Vec<f64> {
    let (page, within) = (index / N_POINTS, index % N_POINTS);
    // Below 2¹⁶, so that nothing is cut off.
    let reversed = (within as u32).reverse_bits();
    let mut scramble = (u32::MAX, 0);
    (0..n_dimensions as u32)
        .map(|dimension| {
            let (block, dimension) = (dimension / NUM_DIMENSIONS, dimension % NUM_DIMENSIONS);
            if scramble.0 != block {
                let purpose = format!("points of a sweep, block {block}");
                scramble = (block, random_stream(seed, &purpose, page).next_u32());
            }
            let order = owen_scramble_rev(reversed, hash(scramble.1 ^ ORDER));
            let sobol = sobol_rev(order, dimension);
            let own = hash(dimension ^ scramble.1.wrapping_mul(0x9c8f_2d3b));
            let value = owen_scramble_rev(sobol, hash(own)).reverse_bits();
            (f64::from(value) + 0.5) / 4_294_967_296.0
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_even_in_every_dimension_and_depend_on_seed_and_index_alone() {
        for seed in [0, 1, 77] {
            for page in [0, 1, 70_000] {
                let all: Vec<Vec<f64>> =
                    (0..1024).map(|i| point(seed, page * N_POINTS + i, 300)).collect();
                for dimension in [0, 1, 7, 255, 256, 299] {
                    let mut cells: Vec<u32> =
                        all.iter().map(|point| (point[dimension] * 1024.0) as u32).collect();
                    cells.sort_unstable();
                    assert_eq!(cells, (0..1024).collect::<Vec<_>>(), "{seed} {page} {dimension}");
                }
            }
        }
        assert_ne!(point(0, 5, 3), point(1, 5, 3));
        assert_ne!(point(0, 5, 3), point(0, 5 + N_POINTS, 3));
        assert_eq!(point(9, 12, 2), point(9, 12, 300)[..2]);
    }

    #[test]
    fn an_integral_is_found_far_better_than_by_chance() {
        let mut squares = 0.0;
        for seed in 0..20 {
            let value = |i| point(seed, i, 4).iter().map(|x| x * x).product::<f64>();
            let mean = (0..4096).map(value).sum::<f64>() / 4096.0;
            squares += (mean - 1.0 / 81.0).powi(2);
        }
        // By chance: the standard deviation of the product, 0.038, over the root of 4096.
        let error = (squares / 20.0).sqrt();
        assert!(error < 0.2 * 0.038 / 64.0, "{error}");
    }

    #[test]
    fn pairs_of_dimensions_are_even_too() {
        let mut counts = [[0; 16]; 16];
        for i in 0..4096 {
            let point = point(3, i, 8);
            counts[(point[2] * 16.0) as usize][(point[5] * 16.0) as usize] += 1;
        }
        let off = counts.iter().flatten().map(|n: &i32| (n - 16).abs()).max();
        assert!(off <= Some(10), "{counts:?}");
    }
}
