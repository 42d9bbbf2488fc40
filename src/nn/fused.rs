//! Fully connected layers as operations of candle: one layer, or a whole stack.

use std::sync::OnceLock;

use candle_core::{
    CpuStorage, CustomOp2, CustomOp3, Device, Error, Layout, Result as TensorResult, Shape, Tensor,
};

use crate::nn::element::Element;
use crate::nn::kernel::{Kept, Layer, Stack};
use crate::nn::storage::{NumberType, contiguous, cpu_storage, slices};
use crate::nn::workspace::Workspace;
use crate::nn::{Activation, Linear, NnError};

/// A stack of layers when no gradient is asked for: nothing is kept, no graph grows.
///
/// - `x`: in one piece, of the first layer's width.
pub(crate) fn forward_untracked(
    x: &Tensor,
    number_type: NumberType,
    layers: &[Linear],
    workspace: &Workspace,
) -> Result<Tensor, NnError> {
    Ok(match number_type {
        NumberType::F32 => untracked::<f32>(x, layers, workspace)?,
        NumberType::F64 => untracked::<f64>(x, layers, workspace)?,
    })
}

fn untracked<T: Element>(
    x: &Tensor,
    layers: &[Linear],
    workspace: &Workspace,
) -> TensorResult<Tensor> {
    const NAME: &str = "fused layers";
    let tensors = layers.iter().flat_map(|layer| layer.tensors());
    let guards: Vec<_> = tensors.map(Tensor::storage_and_layout).collect();
    let slices = slices::<T>(&guards, NAME)?;
    let (pairs, _) = slices.as_chunks::<2>();
    let stack = layers.iter().zip(pairs).map(|(layer, &[weight, bias])| Layer {
        weight,
        bias,
        activation: layer.activation(),
    });
    let (storage, layout) = x.storage_and_layout();
    let x_values = contiguous::<T>(cpu_storage(&storage, NAME)?, layout, NAME)?;
    let width = slices.last().map_or(0, |bias| bias.len());
    let (y, _) = Stack::new(stack.collect(), workspace).forward(x_values, false);
    Tensor::from_vec(y, with_last_dim(x.dims(), width), &Device::Cpu)
}

/// One call of a layer; keeps what the way back needs.
pub(crate) struct FusedLinear<T: Element> {
    activation: Activation,
    workspace: Workspace,
    kept: OnceLock<Kept<T>>,
}

impl<T: Element> FusedLinear<T> {
    pub(crate) fn new(activation: Activation, workspace: &Workspace) -> Self {
        Self { activation, workspace: workspace.clone(), kept: OnceLock::new() }
    }
}

impl<T: Element> CustomOp3 for FusedLinear<T> {
    fn name(&self) -> &'static str {
        "fused linear"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        weight: &CpuStorage,
        weight_layout: &Layout,
        bias: &CpuStorage,
        bias_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let weight = contiguous::<T>(weight, weight_layout, self.name())?;
        let bias = contiguous::<T>(bias, bias_layout, self.name())?;
        let layer = Layer { weight, bias, activation: self.activation };
        let x = contiguous::<T>(x, x_layout, self.name())?;
        let (y, kept) = Stack::new(vec![layer], &self.workspace).forward(x, true);
        // A call has one forward pass, so nothing is kept yet.
        kept.map(|kept| self.kept.set(kept));
        Ok((T::to_cpu_storage_owned(y), with_last_dim(x_layout.dims(), bias.len())))
    }

    fn bwd(
        &self,
        x: &Tensor,
        weight: &Tensor,
        bias: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let guards = [x, weight, bias, &gradient].map(Tensor::storage_and_layout);
        let slices = slices::<T>(&guards, self.name())?;
        let layer = Layer { weight: slices[1], bias: slices[2], activation: self.activation };
        let kept = self.kept.get().ok_or(Error::BackwardNotSupported { op: self.name() })?;
        let wants_dx = x.track_op();
        let (dx, mut parameters) =
            Stack::new(vec![layer], &self.workspace).backward(slices[0], kept, slices[3], wants_dx);
        let bias_gradient = parameters.split_off(slices[1].len());
        let dx = dx.map(|dx| Tensor::from_vec(dx, x.shape(), &Device::Cpu)).transpose()?;
        let to_tensor = |values, of: &Tensor| Tensor::from_vec(values, of.shape(), &Device::Cpu);
        Ok((
            dx,
            weight.track_op().then(|| to_tensor(parameters, weight)).transpose()?,
            bias.track_op().then(|| to_tensor(bias_gradient, bias)).transpose()?,
        ))
    }
}

/// One call of a stack of layers: of x and of all parameters in one piece, weight and bias of the
/// first layer, of the second, and so on.
pub(crate) struct FusedStack<T: Element> {
    /// `[n_in, n_out]` and activation of each layer.
    layers: Vec<([usize; 2], Activation)>,
    workspace: Workspace,
    kept: OnceLock<Kept<T>>,
}

impl<T: Element> FusedStack<T> {
    pub(crate) fn new(layers: &[Linear], workspace: &Workspace) -> Self {
        let layers = layers.iter().map(|layer| (layer.widths(), layer.activation()));
        let (layers, workspace) = (layers.collect(), workspace.clone());
        Self { layers, workspace, kept: OnceLock::new() }
    }

    fn stack<'a>(&'a self, mut parameters: &'a [T]) -> TensorResult<Stack<'a, T>> {
        let mut layers = Vec::with_capacity(self.layers.len());
        for &([n_in, n_out], activation) in &self.layers {
            let too_short = Error::RequiresContiguous { op: "fused layers" };
            let (own, rest) = parameters.split_at_checked(n_in * n_out + n_out).ok_or(too_short)?;
            let (weight, bias) = own.split_at(n_in * n_out);
            layers.push(Layer { weight, bias, activation });
            parameters = rest;
        }
        Ok(Stack::new(layers, &self.workspace))
    }
}

impl<T: Element> CustomOp2 for FusedStack<T> {
    fn name(&self) -> &'static str {
        "fused layers"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        parameters: &CpuStorage,
        parameters_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let stack = self.stack(contiguous(parameters, parameters_layout, self.name())?)?;
        let (y, kept) = stack.forward(contiguous(x, x_layout, self.name())?, true);
        // A call has one forward pass, so nothing is kept yet.
        kept.map(|kept| self.kept.set(kept));
        let width = self.layers.last().map_or(0, |([_, n_out], _)| *n_out);
        Ok((T::to_cpu_storage_owned(y), with_last_dim(x_layout.dims(), width)))
    }

    fn bwd(
        &self,
        x: &Tensor,
        parameters: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let guards = [x, parameters, &gradient].map(Tensor::storage_and_layout);
        let slices = slices::<T>(&guards, self.name())?;
        let kept = self.kept.get().ok_or(Error::BackwardNotSupported { op: self.name() })?;
        let stack = self.stack(slices[1])?;
        let (dx, sums) = stack.backward(slices[0], kept, slices[2], x.track_op());
        let dx = dx.map(|dx| Tensor::from_vec(dx, x.shape(), &Device::Cpu)).transpose()?;
        Ok((dx, Some(Tensor::from_vec(sums, parameters.shape(), &Device::Cpu)?)))
    }
}

/// `[…, old]` becomes `[…, width]`.
fn with_last_dim(dims: &[usize], width: usize) -> Shape {
    let mut dims = dims.to_vec();
    if let Some(last) = dims.last_mut() {
        *last = width;
    }
    dims.into()
}
