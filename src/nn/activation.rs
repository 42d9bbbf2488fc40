//! The Swish activation fused with the bias, forward and backward, over rows in one pass each.
//!
//! ```text
//! z = x Wᵀ + b      y = z·σ(z)      dy/dz = σ(z) + y·(1 − σ(z))      σ(z) = 1/(1 + e⁻ᶻ)
//! ```
//!
//! The slope dy/dz is kept from the forward pass, so the backward pass has no exponential.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::nn::element::{Element, ROWS_PER_BLOCK, min_blocks_per_task, sum_of_rows, vectorized};

/// What follows the sum of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Activation {
    /// Nothing: y = z.
    None,
    /// Swish with β = 1, also called SiLU: y = z·σ(z).
    Silu,
}

/// z + b in place. `z`: `[rows, width]`, `bias`: `[width]`.
pub(crate) fn add_bias<T: Element>(z: &mut [T], bias: &[T]) {
    each_block(z, bias, |z, &b| *z += b);
}

/// y = silu(z + b) in place. `z`: `[rows, width]`, `bias`: `[width]`.
pub(crate) fn bias_silu<T: Element>(z: &mut [T], bias: &[T]) {
    each_block(z, bias, |z, &b| {
        let sum = *z + b;
        *z = sum * sum.sigmoid();
    });
}

/// y = silu(z + b) in place, and the slopes dy/dz, both `[rows, width]`.
pub(crate) fn bias_silu_with_slope<T: Element>(z: &mut [T], bias: &[T]) -> Vec<T> {
    let mut slope = vec![T::ZERO; z.len()];
    let (width, min_len) = (bias.len().max(1), min_blocks_per_task(z.len()));
    let blocks = z.par_chunks_mut(ROWS_PER_BLOCK * width);
    let blocks = blocks.zip(slope.par_chunks_mut(ROWS_PER_BLOCK * width));
    blocks.with_min_len(min_len).for_each(|(z, slope)| {
        vectorized(
            #[inline(always)]
            || {
                for (z, slope) in z.chunks_exact_mut(width).zip(slope.chunks_exact_mut(width)) {
                    for ((z, slope), &b) in z.iter_mut().zip(slope).zip(bias) {
                        let sum = *z + b;
                        let sigmoid = sum.sigmoid();
                        *z = sum * sigmoid;
                        *slope = sigmoid + *z * (T::ONE - sigmoid);
                    }
                }
            },
        );
    });
    slope
}

/// δ = g·dy/dz, `[rows, width]`, and its sums over the rows, `[width]`: the gradients of z and b.
pub(crate) fn silu_backward<T: Element>(
    gradient: &[T],
    slope: &[T],
    width: usize,
) -> (Vec<T>, Vec<T>) {
    let mut delta = vec![T::ZERO; gradient.len()];
    let size = ROWS_PER_BLOCK * width.max(1);
    let mut sums = vec![T::ZERO; gradient.len().div_ceil(size) * width];
    let blocks = delta.par_chunks_mut(size).zip(sums.par_chunks_mut(width.max(1)));
    let blocks = blocks.zip(gradient.par_chunks(size)).zip(slope.par_chunks(size));
    let blocks = blocks.with_min_len(min_blocks_per_task(gradient.len()));
    blocks.for_each(|(((delta, sums), gradient), slope)| {
        vectorized(
            #[inline(always)]
            || {
                let rows = delta.chunks_exact_mut(width);
                let rows = rows.zip(gradient.chunks_exact(width)).zip(slope.chunks_exact(width));
                for ((delta, gradient), slope) in rows {
                    let values = delta.iter_mut().zip(gradient).zip(slope).zip(&mut *sums);
                    for (((delta, &gradient), &slope), sum) in values {
                        *delta = gradient * slope;
                        *sum += *delta;
                    }
                }
            },
        );
    });
    (delta, sum_of_rows(&sums, width))
}

/// Sums over the rows of `[rows, width]`.
pub(crate) fn column_sums<T: Element>(values: &[T], width: usize) -> Vec<T> {
    let size = ROWS_PER_BLOCK * width.max(1);
    let mut sums = vec![T::ZERO; values.len().div_ceil(size) * width];
    let blocks = sums.par_chunks_mut(width.max(1)).zip(values.par_chunks(size));
    blocks.with_min_len(min_blocks_per_task(values.len())).for_each(|(sums, values)| {
        vectorized(
            #[inline(always)]
            || {
                for row in values.chunks_exact(width) {
                    sums.iter_mut().zip(row).for_each(|(sum, &value)| *sum += value);
                }
            },
        );
    });
    sum_of_rows(&sums, width)
}

/// Applies `f(value, bias)` to every value of `[rows, width]`.
#[inline(always)]
fn each_block<T: Element>(values: &mut [T], bias: &[T], f: impl Fn(&mut T, &T) + Sync + Copy) {
    let (width, min_len) = (bias.len().max(1), min_blocks_per_task(values.len()));
    let blocks = values.par_chunks_mut(ROWS_PER_BLOCK * width).with_min_len(min_len);
    blocks.for_each(|block| {
        vectorized(
            #[inline(always)]
            || {
                for row in block.chunks_exact_mut(width) {
                    row.iter_mut().zip(bias).for_each(|(value, bias)| f(value, bias));
                }
            },
        );
    });
}
