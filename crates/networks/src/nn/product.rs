//! Matrix products of tensors as an operation of our own: candle's asks the operating system for the
//! number of cores at every product, which takes longer than a product of the sizes here.
//!
//! ```text
//! C = A B       dL/dA = G Bᵀ      dL/dB = Aᵀ G
//! C = A Bᵀ      dL/dA = G B       dL/dB = Gᵀ A            G = dL/dC
//! ```

use candle_core::{
    CpuStorage, CustomOp2, Device, Error, Layout, Result as TensorResult, Shape, Tensor,
};
use ndarray::ArrayView2;
use ndarray::linalg::general_mat_mul;

use crate::nn::NnError;
use crate::nn::element::NetworkNumber;
use crate::nn::storage::{NumberType, contiguous, cpu_storage, number_type};

/// A B for each matrix of a batch.
///
/// - `a`: `[…, m, k]`.
/// - `b`: `[…, k, n]`, with the same leading dimensions.
/// - returns `[…, m, n]`.
///
/// # Errors
/// [`NnError::NumberType`], [`NnError::Tensor`] for shapes that do not fit.
pub fn product(a: &Tensor, b: &Tensor) -> Result<Tensor, NnError> {
    apply(a, b, false)
}

/// A Bᵀ for each matrix of a batch.
///
/// - `a`: `[…, m, k]`.
/// - `b`: `[…, n, k]`, with the same leading dimensions.
/// - returns `[…, m, n]`.
///
/// # Errors
/// As for [`product`].
pub fn product_with_transposed(a: &Tensor, b: &Tensor) -> Result<Tensor, NnError> {
    apply(a, b, true)
}

fn apply(a: &Tensor, b: &Tensor, transposes_b: bool) -> Result<Tensor, NnError> {
    let (a, b) = (a.contiguous()?, b.contiguous()?);
    Ok(match number_type(&a, "matrix product")? {
        NumberType::F32 => a.apply_op2(&b, MatrixProduct::<f32>::new(transposes_b))?,
        NumberType::F64 => a.apply_op2(&b, MatrixProduct::<f64>::new(transposes_b))?,
    })
}

struct MatrixProduct<T> {
    transposes_b: bool,
    number: std::marker::PhantomData<T>,
}

/// Matrices one after the other, row by row, and whether each is to be read transposed.
#[derive(Clone, Copy)]
struct Matrices<'a, T> {
    values: &'a [T],
    shape: [usize; 2],
    is_transposed: bool,
}

impl<'a, T: NetworkNumber> Matrices<'a, T> {
    fn new(values: &'a [T], dims: &[usize], is_transposed: bool) -> Option<Self> {
        let (_, &[rows, columns]) = dims.split_last_chunk::<2>()?;
        Some(Self { values, shape: [rows, columns], is_transposed })
    }

    /// Rows and columns as they are read.
    fn read_shape(&self) -> [usize; 2] {
        let [rows, columns] = self.shape;
        if self.is_transposed { [columns, rows] } else { [rows, columns] }
    }

    fn matrix(&self, idx: usize) -> Option<ArrayView2<'a, T>> {
        let size = self.shape[0] * self.shape[1];
        let values = self.values.get(idx * size..(idx + 1) * size)?;
        let view = ArrayView2::from_shape(self.shape, values).ok()?;
        Some(if self.is_transposed { view.reversed_axes() } else { view })
    }
}

/// C of each pair, row by row; `None` if the shapes do not fit.
fn products<T: NetworkNumber>(n: usize, a: Matrices<'_, T>, b: Matrices<'_, T>) -> Option<Vec<T>> {
    let ([m, k], [k_of_b, width]) = (a.read_shape(), b.read_shape());
    if k != k_of_b {
        return None;
    }
    let mut all = vec![T::ZERO; n * m * width];
    for (idx, values) in all.chunks_exact_mut((m * width).max(1)).enumerate() {
        let mut c = ndarray::ArrayViewMut2::from_shape([m, width], values).ok()?;
        general_mat_mul(T::ONE, &a.matrix(idx)?, &b.matrix(idx)?, T::ZERO, &mut c);
    }
    Some(all)
}

impl<T: NetworkNumber> MatrixProduct<T> {
    fn new(transposes_b: bool) -> Self {
        Self { transposes_b, number: std::marker::PhantomData }
    }

    fn mismatch(&self, a: &[usize], b: &[usize]) -> Error {
        Error::ShapeMismatchBinaryOp { lhs: a.into(), rhs: b.into(), op: "matrix product" }
    }
}

impl<T: NetworkNumber> CustomOp2 for MatrixProduct<T> {
    fn name(&self) -> &'static str {
        "matrix product"
    }

    fn cpu_fwd(
        &self,
        a: &CpuStorage,
        a_layout: &Layout,
        b: &CpuStorage,
        b_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let (a_dims, b_dims) = (a_layout.dims(), b_layout.dims());
        let mismatch = || self.mismatch(a_dims, b_dims);
        let a = Matrices::new(contiguous::<T>(a, a_layout, self.name())?, a_dims, false);
        let b =
            Matrices::new(contiguous::<T>(b, b_layout, self.name())?, b_dims, self.transposes_b);
        let (a, b) = a.zip(b).ok_or_else(mismatch)?;
        let batch = &a_dims[..a_dims.len() - 2];
        if batch != &b_dims[..b_dims.len() - 2] {
            return Err(mismatch());
        }
        let c = products(batch.iter().product(), a, b).ok_or_else(mismatch)?;
        let dims = [batch, &[a.read_shape()[0], b.read_shape()[1]]].concat();
        Ok((T::to_cpu_storage_owned(c), dims.into()))
    }

    fn bwd(
        &self,
        a: &Tensor,
        b: &Tensor,
        _c: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let n = a.dims().iter().rev().skip(2).product();
        let guards = [a, b, &gradient].map(Tensor::storage_and_layout);
        let read = |i: usize, is_transposed: bool| -> TensorResult<Matrices<'_, T>> {
            let (storage, layout) = &guards[i];
            let values = contiguous::<T>(cpu_storage(storage, self.name())?, layout, self.name())?;
            let matrices = Matrices::new(values, layout.dims(), is_transposed);
            matrices.ok_or_else(|| self.mismatch(a.dims(), b.dims()))
        };
        let gradient_of = |input: &Tensor, left: Matrices<'_, T>, right: Matrices<'_, T>| {
            let values = products(n, left, right);
            let values = values.ok_or_else(|| self.mismatch(a.dims(), b.dims()))?;
            Tensor::from_vec(values, input.shape(), &Device::Cpu)
        };
        let da = match a.track_op() {
            true => Some(gradient_of(a, read(2, false)?, read(1, !self.transposes_b)?)?),
            false => None,
        };
        let db = match (b.track_op(), self.transposes_b) {
            (false, _) => None,
            (true, true) => Some(gradient_of(b, read(2, true)?, read(0, false)?)?),
            (true, false) => Some(gradient_of(b, read(0, true)?, read(2, false)?)?),
        };
        Ok((da, db))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::gradient_check::{
        assert_close, assert_gradients, random_tensor, random_variable,
    };
    use candle_core::DType;

    #[test]
    fn gradients_are_those_of_central_differences() {
        let (a, b) = (random_variable(&[2, 3, 4], 1), random_variable(&[2, 4, 5], 2));
        assert_gradients(&[a.clone(), b.clone()], || product(&a, &b).unwrap());
        let b = random_variable(&[2, 5, 4], 3);
        assert_gradients(&[a.clone(), b.clone()], || product_with_transposed(&a, &b).unwrap());
    }

    #[test]
    fn it_equals_candles_product() {
        for [m, k, n] in [[1, 1, 1], [7, 3, 5], [300, 70, 33]] {
            let a = random_tensor(&[2, m, k], DType::F32, 1);
            let b = random_tensor(&[2, k, n], DType::F32, 2);
            let expected = a.matmul(&b).unwrap();
            assert_close(&product(&a, &b).unwrap(), &expected, 1e-5);
            let transposed = b.transpose(1, 2).unwrap();
            assert_close(&product_with_transposed(&a, &transposed).unwrap(), &expected, 1e-5);
        }
    }

    #[test]
    fn shapes_that_do_not_fit_are_refused() {
        let a = random_tensor(&[2, 3, 4], DType::F32, 1);
        for dims in [&[2, 3, 4][..], &[3, 4, 5], &[4, 5], &[4]] {
            assert!(product(&a, &random_tensor(dims, DType::F32, 2)).is_err(), "{dims:?}");
        }
    }
}
