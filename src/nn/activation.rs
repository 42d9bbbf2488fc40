//! The Swish activation fused with the bias, forward and backward, over rows in one pass each.
//!
//! ```text
//! z = x Wᵀ + b      y = z·σ(z)      dy/dz = σ(z) + y·(1 − σ(z))      σ(z) = 1/(1 + e⁻ᶻ)
//! ```
//!
//! The slope dy/dz is kept from the forward pass, so the backward pass has no exponential.
//! All rows are as long as the bias.

use serde::{Deserialize, Serialize};

use crate::nn::element::{Element, vectorized};

/// What follows the sum of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Activation {
    /// Nothing: y = z.
    None,
    /// Swish with β = 1, also called SiLU: y = z·σ(z).
    Silu,
}

/// z + b in place. `z`: `[rows, width]`.
pub(crate) fn add_bias<T: Element>(z: &mut [T], bias: &[T]) {
    vectorized(
        #[inline(always)]
        || {
            for row in z.chunks_exact_mut(bias.len()) {
                for (z, &b) in row.iter_mut().zip(bias) {
                    *z += b;
                }
            }
        },
    );
}

/// y = silu(z + b) in place. `z`: `[rows, width]`.
pub(crate) fn bias_silu<T: Element>(z: &mut [T], bias: &[T]) {
    vectorized(
        #[inline(always)]
        || {
            for row in z.chunks_exact_mut(bias.len()) {
                for (z, &b) in row.iter_mut().zip(bias) {
                    let sum = *z + b;
                    *z = sum * sum.sigmoid();
                }
            }
        },
    );
}

/// y = silu(z + b), or z + b, in place. `z`: `[rows, width]`.
pub(crate) fn bias_silu_rows(z: &mut [f32], bias: &[f32], swish: bool) {
    if swish { bias_silu(z, bias) } else { add_bias(z, bias) }
}

/// y = silu(z + b) in place, and the slopes dy/dz. `z`, `slope`: `[rows, width]`.
pub(crate) fn bias_silu_with_slope<T: Element>(z: &mut [T], slope: &mut [T], bias: &[T]) {
    let width = bias.len();
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
}

/// δ = g·dy/dz in place, and its sums over the rows added to `sums`: the gradients of z and b.
pub(crate) fn to_delta<T: Element>(gradient: &mut [T], slope: &[T], sums: &mut [T]) {
    let width = sums.len();
    vectorized(
        #[inline(always)]
        || {
            for (g, slope) in gradient.chunks_exact_mut(width).zip(slope.chunks_exact(width)) {
                for ((g, &slope), sum) in g.iter_mut().zip(slope).zip(&mut *sums) {
                    *g *= slope;
                    *sum += *g;
                }
            }
        },
    );
}

/// Sums over the rows of `[rows, width]`, added to `sums`.
pub(crate) fn add_column_sums<T: Element>(sums: &mut [T], values: &[T]) {
    vectorized(
        #[inline(always)]
        || {
            for row in values.chunks_exact(sums.len()) {
                for (sum, &value) in sums.iter_mut().zip(row) {
                    *sum += value;
                }
            }
        },
    );
}
