//! The heart of attention as one operation: scores, softmax and weighted values of every head.
//!
//! ```text
//! A = softmax(s·Q Kᵀ)      O = A V                                  per sequence and head
//! D = G Vᵀ      E = s·A∘(D − rowsum(A∘D))                           G = dL/dO
//! dL/dQ = E K      dL/dK = Eᵀ Q      dL/dV = Aᵀ G
//! ```
//!
//! Weights are computed anew on the way back: keeping them costs more, since `[n, n]` numbers per
//! head leave the caches. Heads are read in place; sequences are spread over the threads.

use candle_core::{
    CpuStorage, CustomOp3, DType, Device, Error, Layout, Result as TensorResult, Shape, Tensor,
};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use crate::nn::element::{Element, min_blocks_per_task, vectorized};
use crate::nn::softmax::{softmax_backward_row, softmax_row};
use crate::nn::storage::{contiguous, slices};

/// Attention of `heads` heads with scaled dot products.
pub(crate) struct AttentionCore {
    pub(crate) heads: usize,
}

/// The sizes of one call.
#[derive(Debug, Clone, Copy)]
struct Sizes {
    batch: usize,
    n_queries: usize,
    n_keys: usize,
    channels: usize,
    heads: usize,
}

impl Sizes {
    /// - `queries`: `[batch, n_queries, channels]`.
    /// - `keys`, `values`: `[batch, n_keys, channels]`.
    fn new(heads: usize, [queries, keys, values]: [&[usize]; 3]) -> TensorResult<Self> {
        match (queries, keys) {
            (&[batch, n_queries, channels], &[key_batch, n_keys, key_channels])
                if batch == key_batch && channels == key_channels && values == keys =>
            {
                Ok(Self { batch, n_queries, n_keys, channels, heads })
            }
            _ => Err(Error::ShapeMismatchBinaryOp {
                lhs: queries.into(),
                rhs: keys.into(),
                op: "attention",
            }),
        }
    }

    fn is_empty(&self) -> bool {
        self.batch * self.n_queries * self.n_keys * self.channels == 0
    }

    fn query_size(&self) -> usize {
        self.n_queries * self.channels
    }

    fn key_size(&self) -> usize {
        self.n_keys * self.channels
    }

    fn head_channels(&self) -> usize {
        self.channels / self.heads
    }

    fn scale<T: Element>(&self) -> T {
        T::from_f64(1.0 / (self.head_channels() as f64).sqrt())
    }

    /// The columns of a head in one sequence: `[n, head_channels]` out of `[n, channels]`.
    fn head<'a, T>(&self, sequence: &'a [T], head: usize) -> MatRef<'a, T> {
        let rows = sequence.len() / self.channels;
        let all = MatRef::from_row_major_slice(sequence, rows, self.channels);
        all.subcols(head * self.head_channels(), self.head_channels())
    }

    /// The same, to be written to.
    fn head_mut<'a, T>(&self, sequence: &'a mut [T], head: usize) -> MatMut<'a, T> {
        let rows = sequence.len() / self.channels;
        let all = MatMut::from_row_major_slice_mut(sequence, rows, self.channels);
        all.subcols_mut(head * self.head_channels(), self.head_channels())
    }

    fn by_queries_and_keys<'a, T>(&self, values: &'a [T]) -> MatRef<'a, T> {
        MatRef::from_row_major_slice(values, self.n_queries, self.n_keys)
    }

    fn by_queries_and_keys_mut<'a, T>(&self, values: &'a mut [T]) -> MatMut<'a, T> {
        MatMut::from_row_major_slice_mut(values, self.n_queries, self.n_keys)
    }

    /// A of one head, `[n_queries, n_keys]`.
    fn weights<T: Element>(&self, queries: MatRef<'_, T>, keys: MatRef<'_, T>, weights: &mut [T]) {
        let scores = self.by_queries_and_keys_mut(weights);
        matmul(scores, Accum::Replace, queries, keys.transpose(), T::ONE, Par::Seq);
        vectorized(
            #[inline(always)]
            || {
                for row in weights.chunks_exact_mut(self.n_keys) {
                    softmax_row(row, self.scale());
                }
            },
        );
    }

    /// O of one sequence.
    fn forward<T: Element>(&self, [queries, keys, values]: [&[T]; 3], output: &mut [T]) {
        let mut weights = vec![T::ZERO; self.n_queries * self.n_keys];
        for head in 0..self.heads {
            self.weights(self.head(queries, head), self.head(keys, head), &mut weights);
            let (output, weights) =
                (self.head_mut(output, head), self.by_queries_and_keys(&weights));
            matmul(output, Accum::Replace, weights, self.head(values, head), T::ONE, Par::Seq);
        }
    }

    /// The gradients of queries, keys and values of one sequence.
    fn backward<T: Element>(
        &self,
        [queries, keys, values, gradient]: [&[T]; 4],
        [dq, dk, dv]: [&mut [T]; 3],
    ) {
        let mut weights = vec![T::ZERO; self.n_queries * self.n_keys];
        let mut slopes = vec![T::ZERO; self.n_queries * self.n_keys];
        for head in 0..self.heads {
            let [q, k] = [queries, keys].map(|sequence| self.head(sequence, head));
            let [v, g] = [values, gradient].map(|sequence| self.head(sequence, head));
            self.weights(q, k, &mut weights);
            let target = self.by_queries_and_keys_mut(&mut slopes);
            matmul(target, Accum::Replace, g, v.transpose(), T::ONE, Par::Seq);
            vectorized(
                #[inline(always)]
                || {
                    let rows = slopes.chunks_exact_mut(self.n_keys);
                    for (slopes, weights) in rows.zip(weights.chunks_exact(self.n_keys)) {
                        softmax_backward_row(slopes, weights, self.scale());
                    }
                },
            );
            let [weights, slopes] = [&weights, &slopes].map(|all| self.by_queries_and_keys(all));
            matmul(self.head_mut(dq, head), Accum::Replace, slopes, k, T::ONE, Par::Seq);
            matmul(
                self.head_mut(dk, head),
                Accum::Replace,
                slopes.transpose(),
                q,
                T::ONE,
                Par::Seq,
            );
            matmul(
                self.head_mut(dv, head),
                Accum::Replace,
                weights.transpose(),
                g,
                T::ONE,
                Par::Seq,
            );
        }
    }

    /// How many sequences one task takes at least.
    fn min_sequences_per_task(&self) -> usize {
        min_blocks_per_task(self.batch * self.heads * self.n_queries * self.n_keys)
    }
}

impl AttentionCore {
    fn forward<T: Element>(
        &self,
        arguments: [(&CpuStorage, &Layout); 3],
    ) -> TensorResult<(CpuStorage, Shape)> {
        let sizes = Sizes::new(self.heads, arguments.map(|(_, layout)| layout.dims()))?;
        let [(q, q_layout), (k, k_layout), (v, v_layout)] = arguments;
        let q = contiguous::<T>(q, q_layout, self.name())?;
        let k = contiguous::<T>(k, k_layout, self.name())?;
        let v = contiguous::<T>(v, v_layout, self.name())?;
        let mut output = vec![T::ZERO; q.len()];
        if !sizes.is_empty() {
            let sequences = output.par_chunks_mut(sizes.query_size());
            let sequences = sequences.zip(q.par_chunks(sizes.query_size()));
            let sequences = sequences.zip(k.par_chunks(sizes.key_size()));
            let sequences = sequences.zip(v.par_chunks(sizes.key_size()));
            let sequences = sequences.with_min_len(sizes.min_sequences_per_task());
            sequences.for_each(|(((output, q), k), v)| sizes.forward([q, k, v], output));
        }
        Ok((T::to_cpu_storage_owned(output), q_layout.shape().clone()))
    }

    /// The gradients of queries, keys and values.
    fn backward<T: Element>(
        &self,
        tensors: [&Tensor; 3],
        gradient: &Tensor,
    ) -> TensorResult<[Tensor; 3]> {
        let sizes = Sizes::new(self.heads, tensors.map(Tensor::dims))?;
        let [queries, keys, values] = tensors;
        let guards = [queries, keys, values, gradient].map(Tensor::storage_and_layout);
        let slices = slices::<T>(&guards, self.name())?;
        let mut gradients = tensors.map(|tensor| vec![T::ZERO; tensor.elem_count()]);
        if !sizes.is_empty() {
            let [dq, dk, dv] = &mut gradients;
            let dq = dq.par_chunks_mut(sizes.query_size());
            let sequences = dq.zip(dk.par_chunks_mut(sizes.key_size()));
            let sequences = sequences.zip(dv.par_chunks_mut(sizes.key_size())).enumerate();
            let sequences = sequences.with_min_len(sizes.min_sequences_per_task());
            sequences.for_each(|(i, ((dq, dk), dv))| {
                let (query_size, key_size) = (sizes.query_size(), sizes.key_size());
                let widths = [query_size, key_size, key_size, query_size];
                let of = |which: usize| &slices[which][i * widths[which]..][..widths[which]];
                sizes.backward([of(0), of(1), of(2), of(3)], [dq, dk, dv]);
            });
        }
        let [dq, dk, dv] = gradients;
        let to_tensor = |values, of: &Tensor| Tensor::from_vec(values, of.shape(), &Device::Cpu);
        Ok([to_tensor(dq, queries)?, to_tensor(dk, keys)?, to_tensor(dv, values)?])
    }
}

impl CustomOp3 for AttentionCore {
    fn name(&self) -> &'static str {
        "attention"
    }

    fn cpu_fwd(
        &self,
        queries: &CpuStorage,
        queries_layout: &Layout,
        keys: &CpuStorage,
        keys_layout: &Layout,
        values: &CpuStorage,
        values_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let arguments = [(queries, queries_layout), (keys, keys_layout), (values, values_layout)];
        match queries {
            CpuStorage::F64(_) => self.forward::<f64>(arguments),
            _ => self.forward::<f32>(arguments),
        }
    }

    fn bwd(
        &self,
        queries: &Tensor,
        keys: &Tensor,
        values: &Tensor,
        _output: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let (tensors, gradient) = ([queries, keys, values], gradient.contiguous()?);
        let [dq, dk, dv] = match gradient.dtype() {
            DType::F64 => self.backward::<f64>(tensors, &gradient)?,
            _ => self.backward::<f32>(tensors, &gradient)?,
        };
        Ok((Some(dq), Some(dk), Some(dv)))
    }
}
