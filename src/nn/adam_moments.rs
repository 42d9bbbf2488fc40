//! The running means that AdamW keeps of a parameter's gradient, and its update in one pass.

use std::cell::RefCell;

use candle_core::{
    CpuStorage, DType, Device, Error, InplaceOp2, Layout, Result as TensorResult, Shape, Tensor,
    Var,
};
use rayon::prelude::*;

use crate::nn::element::{Element, min_blocks_per_task, vectorized};
use crate::nn::named_tensors::find;
use crate::nn::storage::{contiguous, contiguous_mut};
use crate::nn::{AdamWConfig, NamedTensors, NnError};

/// Numbers that one task updates.
const BLOCK: usize = 8192;

/// The numbers of one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates {
    /// min(1, c/‖g‖).
    clip: f64,
    beta_1: f64,
    beta_2: f64,
    epsilon: f64,
    /// η_t/(1 − β₁ᵗ).
    step_size: f64,
    /// 1/√(1 − β₂ᵗ).
    root_scale: f64,
    /// 1 − η_t λ.
    keep: f64,
}

impl Rates {
    /// - `step`: t, from 1.
    pub(crate) fn new(config: &AdamWConfig, step: u64, learning_rate: f64, norm: f64) -> Self {
        let clip = match config.max_gradient_norm {
            Some(max) if norm > max => max / norm,
            _ => 1.0,
        };
        let steps = step as f64;
        Self {
            clip,
            beta_1: config.beta_1,
            beta_2: config.beta_2,
            epsilon: config.epsilon,
            step_size: learning_rate / (1.0 - config.beta_1.powf(steps)),
            root_scale: 1.0 / (1.0 - config.beta_2.powf(steps)).sqrt(),
            keep: 1.0 - learning_rate * config.weight_decay,
        }
    }

    /// Without the pull to zero if `decays` is false.
    pub(crate) fn with_decay(self, decays: bool) -> Self {
        if decays { self } else { Self { keep: 1.0, ..self } }
    }
}

/// m and v of one parameter, in its number type.
#[derive(Debug)]
pub(crate) struct Moments {
    name: String,
    shape: Shape,
    values: Values,
}

#[derive(Debug)]
enum Values {
    F32([Vec<f32>; 2]),
    F64([Vec<f64>; 2]),
}

impl Moments {
    pub(crate) fn zero(name: &str, variable: &Var) -> Result<Self, NnError> {
        let n = variable.elem_count();
        let values = match variable.dtype() {
            DType::F32 => Values::F32([vec![0.0; n], vec![0.0; n]]),
            DType::F64 => Values::F64([vec![0.0; n], vec![0.0; n]]),
            other => {
                let (name, got) = (name.to_owned(), format!("{other:?}"));
                return Err(NnError::NumberType { name, expected: "f32 or f64", got });
            }
        };
        Ok(Self { name: name.to_owned(), shape: variable.shape().clone(), values })
    }

    /// The parameter's name.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    fn tensor_names(&self) -> [String; 2] {
        ["first_moment", "second_moment"].map(|moment| format!("{moment}.{}", self.name))
    }

    /// Whether an exported tensor of this name is one of these.
    pub(crate) fn has(&self, tensor_name: &str) -> bool {
        self.tensor_names().iter().any(|name| name == tensor_name)
    }

    /// One step of the parameter, in place.
    ///
    /// - `gradient`: in one piece, of the parameter's shape.
    pub(crate) fn update(
        &mut self,
        variable: &Var,
        gradient: &Tensor,
        rates: Rates,
    ) -> Result<(), NnError> {
        match &mut self.values {
            Values::F32(moments) => {
                variable.inplace_op2(gradient, &Update { moments: RefCell::new(moments), rates })
            }
            Values::F64(moments) => {
                variable.inplace_op2(gradient, &Update { moments: RefCell::new(moments), rates })
            }
        }?;
        Ok(())
    }

    /// Copies with their names.
    pub(crate) fn export(&self) -> Result<[(String, Tensor); 2], NnError> {
        let to_tensor = |which: usize| match &self.values {
            Values::F32(moments) => Tensor::from_slice(&moments[which], &self.shape, &Device::Cpu),
            Values::F64(moments) => Tensor::from_slice(&moments[which], &self.shape, &Device::Cpu),
        };
        let [first, second] = self.tensor_names();
        Ok([(first, to_tensor(0)?), (second, to_tensor(1)?)])
    }

    /// The same with the values of exported tensors.
    pub(crate) fn imported(&self, tensors: &NamedTensors) -> Result<Self, NnError> {
        let [first, second] = self.tensor_names();
        let dims = self.shape.dims();
        let values = match &self.values {
            Values::F32(_) => {
                Values::F32([values_of(tensors, &first, dims)?, values_of(tensors, &second, dims)?])
            }
            Values::F64(_) => {
                Values::F64([values_of(tensors, &first, dims)?, values_of(tensors, &second, dims)?])
            }
        };
        Ok(Self { name: self.name.clone(), shape: self.shape.clone(), values })
    }
}

fn values_of<T: Element>(
    tensors: &NamedTensors,
    name: &str,
    dims: &[usize],
) -> Result<Vec<T>, NnError> {
    let tensor = find(tensors, name, dims)?;
    Ok(tensor.detach().to_dtype(T::DTYPE)?.flatten_all()?.to_vec1::<T>()?)
}

/// The update of θ, m and v with g, all of one length.
struct Update<'a, T> {
    /// Borrowed while the update runs; candle passes the operation itself by shared reference.
    moments: RefCell<&'a mut [Vec<T>; 2]>,
    rates: Rates,
}

impl<T: Element> InplaceOp2 for Update<'_, T> {
    fn name(&self) -> &'static str {
        "AdamW step"
    }

    fn cpu_fwd(
        &self,
        theta: &mut CpuStorage,
        theta_layout: &Layout,
        gradient: &CpuStorage,
        gradient_layout: &Layout,
    ) -> TensorResult<()> {
        let gradient = contiguous::<T>(gradient, gradient_layout, self.name())?;
        let theta = contiguous_mut::<T>(theta, theta_layout, self.name())?;
        let (mut moments, rates) = (self.moments.borrow_mut(), self.rates);
        let [first, second] = &mut **moments;
        if [theta.len(), first.len(), second.len()] != [gradient.len(); 3] {
            return Err(Error::RequiresContiguous { op: self.name() });
        }
        let blocks = theta.par_chunks_mut(BLOCK).zip(gradient.par_chunks(BLOCK));
        let blocks = blocks.zip(first.par_chunks_mut(BLOCK)).zip(second.par_chunks_mut(BLOCK));
        let blocks = blocks.with_min_len(min_blocks_per_task(gradient.len()));
        blocks.for_each(|(((theta, gradient), first), second)| {
            vectorized(
                #[inline(always)]
                || update_block([theta, first, second], gradient, rates),
            );
        });
        Ok(())
    }
}

#[inline(always)]
fn update_block<T: Element>([theta, m, v]: [&mut [T]; 3], gradient: &[T], rates: Rates) {
    let clip = T::from_f64(rates.clip);
    let (beta_1, one_minus_1) = (T::from_f64(rates.beta_1), T::from_f64(1.0 - rates.beta_1));
    let (beta_2, one_minus_2) = (T::from_f64(rates.beta_2), T::from_f64(1.0 - rates.beta_2));
    let (step_size, keep) = (T::from_f64(rates.step_size), T::from_f64(rates.keep));
    let (root_scale, epsilon) = (T::from_f64(rates.root_scale), T::from_f64(rates.epsilon));
    let values = theta.iter_mut().zip(m).zip(v).zip(gradient);
    for (((theta, m), v), &g) in values {
        let g = g * clip;
        *m = beta_1 * *m + one_minus_1 * g;
        *v = beta_2 * *v + one_minus_2 * (g * g);
        *theta = keep * *theta - step_size * *m / (v.sqrt() * root_scale + epsilon);
    }
}
