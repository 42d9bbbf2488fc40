//! The heart of attention as one operation: scores, softmax and weighted values of every head.
//!
//! ```text
//! A = softmax(s·Q Kᵀ)      O = A V                                  per sequence and head
//! D = G Vᵀ      E = s·A∘(D − rowsum(A∘D))
//! dL/dQ = E K      dL/dK = Eᵀ Q      dL/dV = Aᵀ G                   G = dL/dO
//! ```
//!
//! Weights are computed anew on the way back: keeping them costs more, since `[n, n]` numbers per
//! head leave the caches. Heads are read in place; sequences are spread over the threads.

use candle_core::backend::BackendStorage;
use candle_core::{
    CpuStorage, CustomOp3, Device, Error, Layout, Result as TensorResult, Shape, Tensor,
};
use rayon::prelude::*;

use crate::nn::element::{Element, cpu_storage, min_blocks_per_task, vectorized};
use crate::nn::softmax::{softmax_backward_row, softmax_row};

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

/// Queries, keys, values or a gradient, `[batch, n, channels]`, with the place of the first number.
#[derive(Clone, Copy)]
struct Sequences<'a> {
    storage: &'a CpuStorage,
    start: usize,
    n: usize,
}

impl Sizes {
    fn new(
        heads: usize,
        queries: &[usize],
        keys: &[usize],
        values: &[usize],
    ) -> TensorResult<Self> {
        match (queries, keys) {
            (&[batch, n_queries, channels], &[key_batch, n_keys, key_channels])
                if batch == key_batch
                    && channels == key_channels
                    && values == keys
                    && n_keys > 0 =>
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

    fn head_channels(&self) -> usize {
        self.channels / self.heads
    }

    fn scale<T: Element>(&self) -> T {
        T::from_f64(1.0 / (self.head_channels() as f64).sqrt())
    }

    /// Where the head of a sequence lies, `[n, head_channels]`.
    fn head(&self, of: Sequences<'_>, sequence: usize, head: usize) -> Layout {
        let shape = Shape::from((of.n, self.head_channels()));
        let start = of.start + sequence * of.n * self.channels + head * self.head_channels();
        Layout::new(shape, vec![self.channels, 1], start)
    }

    /// A Bᵀ of one head, `[a.n, b.n]`.
    fn product_of_rows(
        &self,
        [a, b]: [Sequences<'_>; 2],
        sequence: usize,
        head: usize,
    ) -> TensorResult<CpuStorage> {
        let a_layout = self.head(a, sequence, head);
        let b_layout = self.head(b, sequence, head).transpose(0, 1)?;
        let sizes = (1, a.n, b.n, self.head_channels());
        a.storage.matmul(b.storage, sizes, &a_layout, &b_layout)
    }

    /// M·B of one head, `[m_rows, head_channels]`, written into its columns of `target`.
    fn product_into<T: Element>(
        &self,
        (matrix, layout): (&CpuStorage, &Layout),
        (b, sequence, head): (Sequences<'_>, usize, usize),
        target: &mut [T],
    ) -> TensorResult<()> {
        let (rows, inner) = layout.shape().dims2()?;
        let width = self.head_channels();
        let b_layout = self.head(b, sequence, head);
        let product = matrix.matmul(b.storage, (1, rows, width, inner), layout, &b_layout)?;
        let product = T::cpu_storage_data(product)?;
        let columns = head * width..(head + 1) * width;
        for (to, from) in target.chunks_exact_mut(self.channels).zip(product.chunks_exact(width)) {
            to[columns.clone()].copy_from_slice(from);
        }
        Ok(())
    }

    /// A of one head, `[n_queries, n_keys]`.
    fn weights<T: Element>(
        &self,
        [queries, keys]: [Sequences<'_>; 2],
        sequence: usize,
        head: usize,
    ) -> TensorResult<Vec<T>> {
        let scores = self.product_of_rows([queries, keys], sequence, head)?;
        let (mut scores, scale) = (T::cpu_storage_data(scores)?, self.scale::<T>());
        vectorized(
            #[inline(always)]
            || scores.chunks_exact_mut(self.n_keys).for_each(|row| softmax_row(row, scale)),
        );
        Ok(scores)
    }

    /// Gradients of queries, keys and values of one sequence, added up in the three slices.
    fn backward<T: Element>(
        &self,
        [queries, keys, values, gradient]: [Sequences<'_>; 4],
        sequence: usize,
        [dq, dk, dv]: [&mut [T]; 3],
    ) -> TensorResult<()> {
        let by_rows = Layout::contiguous((self.n_queries, self.n_keys));
        let by_columns = by_rows.transpose(0, 1)?;
        for head in 0..self.heads {
            let weights = self.weights::<T>([queries, keys], sequence, head)?;
            let slopes = self.product_of_rows([gradient, values], sequence, head)?;
            let mut slopes = T::cpu_storage_data(slopes)?;
            vectorized(
                #[inline(always)]
                || {
                    let rows = slopes.chunks_exact_mut(self.n_keys);
                    for (slopes, weights) in rows.zip(weights.chunks_exact(self.n_keys)) {
                        softmax_backward_row(slopes, weights, self.scale());
                    }
                },
            );
            let (weights, slopes) =
                (T::to_cpu_storage_owned(weights), T::to_cpu_storage_owned(slopes));
            self.product_into((&slopes, &by_rows), (keys, sequence, head), dq)?;
            self.product_into((&slopes, &by_columns), (queries, sequence, head), dk)?;
            self.product_into((&weights, &by_columns), (gradient, sequence, head), dv)?;
        }
        Ok(())
    }

    /// How many sequences one task takes at least.
    fn min_sequences_per_task(&self) -> usize {
        min_blocks_per_task(self.batch * self.heads * self.n_queries * self.n_keys)
    }
}

impl AttentionCore {
    /// The sizes, and where queries, keys and values lie.
    fn place<'a>(
        &self,
        arguments: [(&'a CpuStorage, &Layout); 3],
    ) -> TensorResult<(Sizes, [Sequences<'a>; 3])> {
        let [queries, keys, values] = arguments.map(|(_, layout)| layout.dims());
        let sizes = Sizes::new(self.heads, queries, keys, values)?;
        let of = |(storage, layout): (&'a CpuStorage, &Layout), n| {
            let (start, _) =
                layout.contiguous_offsets().ok_or(Error::RequiresContiguous { op: "attention" })?;
            Ok::<_, Error>(Sequences { storage, start, n })
        };
        let [queries, keys, values] = arguments;
        let queries = of(queries, sizes.n_queries)?;
        Ok((sizes, [queries, of(keys, sizes.n_keys)?, of(values, sizes.n_keys)?]))
    }

    fn forward<T: Element>(
        &self,
        arguments: [(&CpuStorage, &Layout); 3],
    ) -> TensorResult<(CpuStorage, Shape)> {
        let (sizes, [queries, keys, values]) = self.place(arguments)?;
        let shape = arguments[0].1.shape().clone();
        let mut output = vec![T::ZERO; shape.elem_count()];
        let by_rows = Layout::contiguous((sizes.n_queries, sizes.n_keys));
        let sequences = output.par_chunks_mut((sizes.n_queries * sizes.channels).max(1));
        let sequences = sequences.enumerate().with_min_len(sizes.min_sequences_per_task());
        sequences.try_for_each(|(sequence, output)| {
            for head in 0..self.heads {
                let weights = sizes.weights::<T>([queries, keys], sequence, head)?;
                let weights = T::to_cpu_storage_owned(weights);
                sizes.product_into((&weights, &by_rows), (values, sequence, head), output)?;
            }
            Ok::<(), Error>(())
        })?;
        Ok((T::to_cpu_storage_owned(output), shape))
    }

    /// The gradients of queries, keys and values.
    fn backward<T: Element>(
        &self,
        arguments: [(&CpuStorage, &Layout); 3],
        (gradient, gradient_layout): (&CpuStorage, &Layout),
    ) -> TensorResult<[Tensor; 3]> {
        let (sizes, [queries, keys, values]) = self.place(arguments)?;
        let start = gradient_layout.start_offset();
        let gradient = Sequences { storage: gradient, start, n: sizes.n_queries };
        let mut gradients = arguments.map(|(_, layout)| vec![T::ZERO; layout.shape().elem_count()]);
        let [dq, dk, dv] = &mut gradients;
        let (query_size, key_size) =
            (sizes.n_queries * sizes.channels, sizes.n_keys * sizes.channels);
        let sequences = dq.par_chunks_mut(query_size.max(1));
        let sequences = sequences.zip(dk.par_chunks_mut(key_size.max(1)));
        let sequences = sequences.zip(dv.par_chunks_mut(key_size.max(1))).enumerate();
        let sequences = sequences.with_min_len(sizes.min_sequences_per_task());
        sequences.try_for_each(|(sequence, ((dq, dk), dv))| {
            sizes.backward([queries, keys, values, gradient], sequence, [dq, dk, dv])
        })?;
        let [dq, dk, dv] = gradients;
        let [q_shape, k_shape, v_shape] = arguments.map(|(_, layout)| layout.shape().clone());
        Ok([
            Tensor::from_vec(dq, q_shape, &Device::Cpu)?,
            Tensor::from_vec(dk, k_shape, &Device::Cpu)?,
            Tensor::from_vec(dv, v_shape, &Device::Cpu)?,
        ])
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
        let gradient = gradient.contiguous()?;
        let guards = [queries, keys, values, &gradient].map(Tensor::storage_and_layout);
        let [queries, keys, values, gradient] = &guards;
        let arguments = [
            (cpu_storage(&queries.0, self.name())?, queries.1),
            (cpu_storage(&keys.0, self.name())?, keys.1),
            (cpu_storage(&values.0, self.name())?, values.1),
        ];
        let gradient = (cpu_storage(&gradient.0, self.name())?, gradient.1);
        let [dq, dk, dv] = match gradient.0 {
            CpuStorage::F64(_) => self.backward::<f64>(arguments, gradient)?,
            _ => self.backward::<f32>(arguments, gradient)?,
        };
        Ok((Some(dq), Some(dk), Some(dv)))
    }
}
