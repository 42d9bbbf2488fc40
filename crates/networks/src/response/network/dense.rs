//! Fully connected layers over a few dozen rows, for predictions: no tensors, no threads.
//!
//! Rows and outputs are filled up to whole blocks, so that a block of the product stays in vector
//! registers: six rows times sixteen outputs.

use candle_core::{DType, Tensor};

use crate::nn::NnError;
use crate::nn::bias_silu_rows;
use crate::response::network::response_network::ResponseNetwork;

/// Rows of a block, and of one where there are no more than these: motion and mirrored motion of a
/// single state.
const ROWS: usize = 6;
const FEW_ROWS: usize = 2;
/// Outputs of a block.
const COLUMNS: usize = 16;

/// Rows of numbers, each as long as `stride`; what fills them up has no meaning.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    pub values: Vec<f32>,
    pub stride: usize,
}

/// A fully connected layer.
#[derive(Debug, Clone)]
pub(crate) struct Dense {
    /// Blocks of outputs one after the other, each `[n_in, COLUMNS]`.
    weight: Vec<[f32; COLUMNS]>,
    /// `[stride]`.
    bias: Vec<f32>,
    n_in: usize,
    n_out: usize,
}

impl Rows {
    /// Room for `n` rows, at least as wide as `width`, and as many more as fill a block.
    pub(crate) fn reset(&mut self, n: usize, width: usize) {
        self.stride = width.next_multiple_of(COLUMNS);
        let n = if n <= FEW_ROWS { FEW_ROWS } else { n.next_multiple_of(ROWS) };
        self.values.resize(n * self.stride, 0.0);
    }

    pub(crate) fn row(&self, idx: usize) -> &[f32] {
        let start = idx * self.stride;
        self.values.get(start..start + self.stride).unwrap_or_default()
    }

    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut [f32]> {
        self.values.chunks_exact_mut(self.stride.max(1))
    }
}

impl Dense {
    /// The layer of this name.
    pub(crate) fn from_network(network: &ResponseNetwork, name: &str) -> Result<Self, NnError> {
        let find = |part: &str| {
            let name = format!("{name}.{part}");
            let found =
                network.parameters().get(&name).map(|variable| variable.as_detached_tensor());
            found.ok_or(NnError::MissingTensor { name })
        };
        Self::from_tensors(&find("weight")?.t()?, &find("bias")?)
    }

    /// - `weight`: `[n_in, n_out]`, `bias`: `[n_out]`.
    pub(crate) fn from_tensors(weight: &Tensor, bias: &Tensor) -> Result<Self, NnError> {
        let (n_in, n_out) = weight.dims2()?;
        let values = |tensor: &Tensor| -> Result<Vec<f32>, NnError> {
            Ok(tensor.to_dtype(DType::F32)?.contiguous()?.flatten_all()?.to_vec1()?)
        };
        let (weight, mut bias) = (values(weight)?, values(bias)?);
        bias.resize(n_out.next_multiple_of(COLUMNS), 0.0);
        let block = |first: usize| {
            weight
                .chunks_exact(n_out.max(1))
                .map(move |row| std::array::from_fn(|k| row.get(first + k).copied().unwrap_or(0.0)))
        };
        let weight = (0..n_out).step_by(COLUMNS).flat_map(block).collect();
        Ok(Self { weight, bias, n_in, n_out })
    }

    pub(crate) fn n_out(&self) -> usize {
        self.n_out
    }

    /// `x W + b` of every row, then Swish where wanted.
    pub(crate) fn forward(&self, x: &Rows, out: &mut Rows, swish: bool) {
        let n_rows = x.values.len() / x.stride.max(1);
        out.reset(n_rows, self.n_out);
        match n_rows {
            FEW_ROWS => pulp::Arch::new().dispatch(Product::<FEW_ROWS> { layer: self, x, out }),
            _ => pulp::Arch::new().dispatch(Product::<ROWS> { layer: self, x, out }),
        }
        bias_silu_rows(&mut out.values, &self.bias, swish);
    }
}

/// `x W`, R rows at a time. A closure in its place would be a function of its own, compiled without
/// the vector instructions.
struct Product<'a, const R: usize> {
    layer: &'a Dense,
    x: &'a Rows,
    out: &'a mut Rows,
}

impl<const R: usize> pulp::NullaryFnOnce for Product<'_, R> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Dense { weight, bias, n_in, .. } = self.layer;
        let (x_stride, stride) = (self.x.stride, bias.len());
        let out_blocks = self.out.values.chunks_exact_mut(R * stride);
        for (x_rows, out_rows) in self.x.values.chunks_exact(R * x_stride).zip(out_blocks) {
            let x_rows: [&[f32]; R] = std::array::from_fn(|r| &x_rows[r * x_stride..][..*n_in]);
            for (block, weights) in weight.chunks_exact(*n_in).enumerate() {
                let mut sums = [[0.0_f32; COLUMNS]; R];
                for (i, weights) in weights.iter().enumerate() {
                    for r in 0..R {
                        for k in 0..COLUMNS {
                            sums[r][k] += x_rows[r][i] * weights[k];
                        }
                    }
                }
                for (out, sums) in out_rows.chunks_exact_mut(stride).zip(&sums) {
                    out[block * COLUMNS..(block + 1) * COLUMNS].copy_from_slice(sums);
                }
            }
        }
    }
}
