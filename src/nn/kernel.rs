//! Rows through fully connected layers and back, block by block.
//!
//! ```text
//! zₗ = yₗ₋₁ Wₗᵀ + bₗ      yₗ = act(zₗ)      y₀ = x
//! δₗ = gₗ·act'(zₗ)      gₗ₋₁ = δₗ Wₗ      dL/dWₗ = δₗᵀ yₗ₋₁      dL/dbₗ = Σ_rows δₗ
//! ```
//!
//! A block of rows passes all layers before the next one starts, so that its numbers stay in the
//! caches. Blocks are shared out among groups whose number depends on the rows alone; each group
//! adds up its own gradients, and the groups' sums are added in their order. So the result is the
//! same for any number of threads.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use crate::nn::Activation;
use crate::nn::activation::{add_bias, add_column_sums, bias_silu, bias_silu_with_slope, to_delta};
use crate::nn::element::Element;
use crate::nn::workspace::{Buffer, Workspace};

/// Groups of rows at most: as many threads can share the work.
const MAX_GROUPS: usize = 8;

/// Rows of a group at least; fewer leave a product too little to do.
const MIN_GROUP_ROWS: usize = 128;

/// Rows of a block at most.
const MAX_BLOCK_ROWS: usize = 512;

/// Below so many products of a row with a parameter, one thread is faster than two.
const MIN_PARALLEL_PRODUCTS: usize = 4_000_000;

/// Numbers that one task adds up over the groups.
const SUM_BLOCK: usize = 16_384;

/// One layer: weight `[n_out, n_in]` and bias `[n_out]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layer<'a, T> {
    pub(crate) weight: &'a [T],
    pub(crate) bias: &'a [T],
    pub(crate) activation: Activation,
}

/// Layers one after the other, at least one.
#[derive(Debug)]
pub(crate) struct Stack<'a, T> {
    layers: Vec<Layer<'a, T>>,
    workspace: &'a Workspace,
}

/// What the forward pass keeps for the way back, per group of rows: block after block, and in each
/// layer after layer, the slope and the result `[rows, n_out]`.
#[derive(Debug)]
pub(crate) struct Kept<T: Element> {
    groups: Vec<Buffer<T>>,
}

impl<T: Element> Layer<'_, T> {
    fn n_out(&self) -> usize {
        self.bias.len()
    }

    fn n_in(&self) -> usize {
        self.weight.len() / self.bias.len()
    }

    /// How many slopes are kept of each row.
    fn slope_width(&self, with_slopes: bool) -> usize {
        match self.activation {
            Activation::Silu if with_slopes => self.n_out(),
            _ => 0,
        }
    }

    /// y, `[rows, n_out]`, and its slope, of the same shape unless empty.
    fn forward(&self, x: &[T], y: &mut [T], slope: &mut [T]) {
        let (n_in, n_out) = (self.n_in(), self.n_out());
        let rows = y.len() / n_out;
        let weight = MatRef::from_row_major_slice(self.weight, n_out, n_in).transpose();
        let x = MatRef::from_row_major_slice(x, rows, n_in);
        let target = MatMut::from_row_major_slice_mut(y, rows, n_out);
        matmul(target, Accum::Replace, x, weight, T::ONE, Par::Seq);
        match self.activation {
            Activation::None => add_bias(y, self.bias),
            Activation::Silu if slope.is_empty() => bias_silu(y, self.bias),
            Activation::Silu => bias_silu_with_slope(y, slope, self.bias),
        }
    }

    /// Adds to the gradients of the parameters, and writes that of x unless it is empty.
    ///
    /// - `gradient`: of y, `[rows, n_out]`; becomes δ.
    /// - `parameters`: gradients of weight and bias, one after the other.
    fn backward(
        &self,
        x: &[T],
        (gradient, slope): (&mut [T], &[T]),
        parameters: &mut [T],
        dx: &mut [T],
    ) {
        let (n_in, n_out) = (self.n_in(), self.n_out());
        let rows = gradient.len() / n_out;
        let (weight_gradient, bias_gradient) = parameters.split_at_mut(self.weight.len());
        match self.activation {
            Activation::None => add_column_sums(bias_gradient, gradient),
            Activation::Silu => to_delta(gradient, slope, bias_gradient),
        }
        let delta = MatRef::from_row_major_slice(gradient, rows, n_out);
        let x = MatRef::from_row_major_slice(x, rows, n_in);
        let target = MatMut::from_row_major_slice_mut(weight_gradient, n_out, n_in);
        matmul(target, Accum::Add, delta.transpose(), x, T::ONE, Par::Seq);
        if !dx.is_empty() {
            let weight = MatRef::from_row_major_slice(self.weight, n_out, n_in);
            let target = MatMut::from_row_major_slice_mut(dx, rows, n_in);
            matmul(target, Accum::Replace, delta, weight, T::ONE, Par::Seq);
        }
    }
}

/// How rows are shared out among groups.
#[derive(Debug, Clone, Copy)]
struct Groups {
    n_groups: usize,
    rows: usize,
    /// Groups that one task takes at least.
    min_per_task: usize,
}

impl Groups {
    fn new(n_rows: usize, n_parameters: usize) -> Self {
        let n_groups = n_rows.div_ceil(MIN_GROUP_ROWS).clamp(1, MAX_GROUPS);
        let is_small = n_rows * n_parameters < MIN_PARALLEL_PRODUCTS;
        let min_per_task = if is_small { MAX_GROUPS } else { 1 };
        Self { n_groups, rows: n_rows.div_ceil(n_groups).max(1), min_per_task }
    }
}

impl<'a, T: Element> Stack<'a, T> {
    /// The layers fit onto each other: n_out of one is n_in of the next.
    pub(crate) fn new(layers: Vec<Layer<'a, T>>, workspace: &'a Workspace) -> Self {
        Self { layers, workspace }
    }

    fn n_in(&self) -> usize {
        self.layers.first().map_or(1, Layer::n_in)
    }

    fn n_out(&self) -> usize {
        self.layers.last().map_or(1, Layer::n_out)
    }

    fn n_parameters(&self) -> usize {
        self.layers.iter().map(|layer| layer.weight.len() + layer.bias.len()).sum()
    }

    /// How many numbers of each row are kept: results of all layers but the last, and slopes if
    /// `with_slopes`.
    fn kept_width(&self, with_slopes: bool) -> usize {
        let inner = self.layers.split_last().map_or(&[][..], |(_, inner)| inner);
        let results: usize = inner.iter().map(Layer::n_out).sum();
        let slopes = self.layers.iter().map(|layer| layer.slope_width(with_slopes));
        results + slopes.sum::<usize>()
    }

    /// All layers for all rows.
    ///
    /// - `x`: `[rows, n_in]`.
    /// - returns `[rows, n_out]`, and what the way back needs if `is_tracked`.
    pub(crate) fn forward(&self, x: &[T], is_tracked: bool) -> (Vec<T>, Option<Kept<T>>) {
        let n_rows = x.len() / self.n_in();
        let groups = Groups::new(n_rows, self.n_parameters());
        let (n_in, n_out) = (self.n_in(), self.n_out());
        let mut y = vec![T::ZERO; n_rows * n_out];
        let parts = x.par_chunks(groups.rows * n_in).zip(y.par_chunks_mut(groups.rows * n_out));
        let kept = parts.with_min_len(groups.min_per_task).map(|(x, y)| {
            let width = self.kept_width(is_tracked);
            let kept_rows =
                if is_tracked { x.len() / n_in } else { MAX_BLOCK_ROWS.min(groups.rows) };
            let mut kept = Buffer::take(self.workspace, kept_rows * width);
            let blocks = x.chunks(MAX_BLOCK_ROWS * n_in).zip(y.chunks_mut(MAX_BLOCK_ROWS * n_out));
            for (i, (x, y)) in blocks.enumerate() {
                let start = if is_tracked { i * MAX_BLOCK_ROWS * width } else { 0 };
                let end = start + x.len() / n_in * width;
                self.forward_block(x, y, &mut kept[start..end], is_tracked);
            }
            is_tracked.then_some(kept)
        });
        // Not into an option, which would stop the other groups at the first `None`.
        let groups: Vec<Option<Buffer<T>>> = kept.collect();
        let groups = groups.into_iter().collect::<Option<Vec<_>>>();
        (y, groups.map(|groups| Kept { groups }))
    }

    fn forward_block(&self, x: &[T], y: &mut [T], mut kept: &mut [T], is_tracked: bool) {
        let rows = x.len() / self.n_in();
        let Some((last, inner)) = self.layers.split_last() else { return };
        let mut input = x;
        for layer in inner {
            let slope = split_off_mut(&mut kept, rows * layer.slope_width(is_tracked));
            let output = split_off_mut(&mut kept, rows * layer.n_out());
            layer.forward(input, output, slope);
            input = output;
        }
        last.forward(input, y, kept);
    }

    /// The gradients of x, `[rows, n_in]` if wanted, and of all parameters: weight and bias of the
    /// first layer, of the second, and so on.
    ///
    /// - `gradient`: of y, `[rows, n_out]`.
    pub(crate) fn backward(
        &self,
        x: &[T],
        kept: &Kept<T>,
        gradient: &[T],
        wants_dx: bool,
    ) -> (Option<Vec<T>>, Vec<T>) {
        let (n_in, n_out, n_parameters) = (self.n_in(), self.n_out(), self.n_parameters());
        let groups = Groups::new(x.len() / n_in, n_parameters);
        let mut dx = vec![T::ZERO; if wants_dx { x.len() } else { 0 }];
        let mut sums = Buffer::zeros(self.workspace, groups.n_groups * n_parameters);
        let dx_parts: Vec<&mut [T]> = match wants_dx {
            true => dx.chunks_mut(groups.rows * n_in).collect(),
            false => kept.groups.iter().map(|_| Default::default()).collect(),
        };
        let parts = x.par_chunks(groups.rows * n_in).zip(gradient.par_chunks(groups.rows * n_out));
        let parts = parts.zip(dx_parts).zip(&kept.groups).zip(sums.par_chunks_mut(n_parameters));
        let parts = parts.with_min_len(groups.min_per_task);
        parts.for_each(|((((x, gradient), dx), kept), sums)| {
            self.backward_group([x, gradient, kept], dx, sums);
        });
        (wants_dx.then_some(dx), sum_of_groups(&sums, n_parameters))
    }

    fn backward_group(&self, [x, gradient, kept]: [&[T]; 3], dx: &mut [T], sums: &mut [T]) {
        let (n_in, n_out, width) = (self.n_in(), self.n_out(), self.kept_width(true));
        let widest = self.layers.iter().map(Layer::n_out).max().unwrap_or(0);
        let n_scratch = 2 * (x.len() / n_in).min(MAX_BLOCK_ROWS) * widest;
        let mut scratch = Buffer::take(self.workspace, n_scratch);
        let blocks = x.chunks(MAX_BLOCK_ROWS * n_in).zip(gradient.chunks(MAX_BLOCK_ROWS * n_out));
        for (i, (x, gradient)) in blocks.enumerate() {
            let (first, rows) = (i * MAX_BLOCK_ROWS, x.len() / n_in);
            let kept = &kept[first * width..(first + rows) * width];
            let dx = match dx.is_empty() {
                true => &mut [],
                false => &mut dx[first * n_in..(first + rows) * n_in],
            };
            self.backward_block([x, gradient, kept], dx, sums, &mut scratch);
        }
    }

    fn backward_block(
        &self,
        [x, gradient, mut kept]: [&[T]; 3],
        dx: &mut [T],
        mut sums: &mut [T],
        scratch: &mut [T],
    ) {
        let rows = x.len() / self.n_in();
        let mut inputs = Vec::with_capacity(self.layers.len());
        let mut input = x;
        for layer in &self.layers {
            let slope = split_off(&mut kept, rows * layer.slope_width(true));
            inputs.push((input, slope));
            // Nothing is left for the last layer, whose result is not kept.
            let n_left = kept.len();
            input = split_off(&mut kept, (rows * layer.n_out()).min(n_left));
        }
        let (mut current, mut next) = scratch.split_at_mut(scratch.len() / 2);
        current[..gradient.len()].copy_from_slice(gradient);
        for (i, (layer, (input, slope))) in self.layers.iter().zip(inputs).enumerate().rev() {
            let n_parameters = layer.weight.len() + layer.bias.len();
            let parameters = split_off_end_mut(&mut sums, n_parameters);
            let delta = &mut current[..rows * layer.n_out()];
            let target = if i == 0 { &mut *dx } else { &mut next[..input.len()] };
            layer.backward(input, (delta, slope), parameters, target);
            std::mem::swap(&mut current, &mut next);
        }
    }
}

/// The first `n` numbers, which are taken off the slice.
fn split_off<'a, T>(slice: &mut &'a [T], n: usize) -> &'a [T] {
    let (first, rest) = slice.split_at(n);
    *slice = rest;
    first
}

/// The first `n` numbers, which are taken off the slice.
fn split_off_mut<'a, T>(slice: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    let (first, rest) = std::mem::take(slice).split_at_mut(n);
    *slice = rest;
    first
}

/// The last `n` numbers, which are taken off the slice.
fn split_off_end_mut<'a, T>(slice: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    let n_rest = slice.len() - n;
    let (rest, last) = std::mem::take(slice).split_at_mut(n_rest);
    *slice = rest;
    last
}

/// The sum of the rows of `[n_groups, width]` in their order.
fn sum_of_groups<T: Element>(groups: &[T], width: usize) -> Vec<T> {
    let mut sums = groups[..width].to_vec();
    sums.par_chunks_mut(SUM_BLOCK).enumerate().for_each(|(block, sums)| {
        for group in groups.chunks_exact(width).skip(1) {
            let part = &group[block * SUM_BLOCK..][..sums.len()];
            sums.iter_mut().zip(part).for_each(|(sum, &value)| *sum += value);
        }
    });
    sums
}
