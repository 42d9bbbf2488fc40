//! Features and step of the vehicle as operations of candle, with the exact Jacobians of the one
//! physics implementation: its lines, run on dual numbers.

use std::sync::Arc;

use candle_core::{
    CpuStorage, CustomOp1, CustomOp2, DType, Device, Layout, Result as TensorResult, Shape, Tensor,
};
use nalgebra::{SMatrix, SVector};
use num_dual::DualSVec64;
use rayon::prelude::*;

use crate::nn::NnError;
use crate::nn::storage::{contiguous, cpu_storage};
use crate::response::{Correction, N_FEATURES, N_RESIDUAL, features};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleParameters, VehicleState};

/// Rows that are worth a task of their own.
const MIN_ROWS_PER_TASK: usize = 16;

/// State and residual acceleration together.
const N_BOTH: usize = N_STATE + N_RESIDUAL;

/// Inputs of a row of a batch besides its state.
#[derive(Debug, Clone)]
pub(crate) struct StepRow {
    pub vehicle: Arc<VehicleParameters>,
    /// Input over the coming step.
    pub input: VehicleInput<f64>,
    /// Since the impact began, s.
    pub time_s: f64,
}

/// The features of states.
///
/// - `x`: `[rows, 8]`, f64;
/// - returns `[rows, N_FEATURES]`.
///
/// # Errors
/// [`NnError::Tensor`] for another shape or type.
pub(crate) fn feature_rows(x: &Tensor, rows: &Arc<Vec<StepRow>>) -> Result<Tensor, NnError> {
    check(x, N_STATE, rows)?;
    Ok(x.contiguous()?.apply_op1(FeatureOperation(rows.clone()))?)
}

/// The states after a step.
///
/// - `x`: `[rows, 8]`, `value`: what the correction takes, `[rows, 4]`, f64;
/// - returns `[rows, 8]`.
///
/// # Errors
/// [`NnError::Tensor`] for another shape or type.
pub(crate) fn step_rows(
    correction: Correction,
    [x, value]: [&Tensor; 2],
    rows: &Arc<Vec<StepRow>>,
) -> Result<Tensor, NnError> {
    check(x, N_STATE, rows)?;
    check(value, N_RESIDUAL, rows)?;
    let value = value.contiguous()?;
    Ok(x.contiguous()?.apply_op2(&value, StepOperation { correction, rows: rows.clone() })?)
}

pub(in crate::response) fn check(
    tensor: &Tensor,
    width: usize,
    rows: &[StepRow],
) -> Result<(), NnError> {
    let expected = [rows.len(), width];
    if tensor.dims() != expected || tensor.dtype() != DType::F64 {
        let name = format!("rows of {:?}", tensor.dtype());
        return Err(NnError::WrongShape {
            name,
            expected: expected.to_vec(),
            got: tensor.dims().to_vec(),
        });
    }
    Ok(())
}

struct FeatureOperation(Arc<Vec<StepRow>>);

struct StepOperation {
    correction: Correction,
    rows: Arc<Vec<StepRow>>,
}

impl FeatureOperation {
    fn jacobian(
        row: &StepRow,
        x: SVector<f64, N_STATE>,
    ) -> (SVector<f64, N_FEATURES>, SMatrix<f64, N_FEATURES, N_STATE>) {
        let input = row.input.map(DualSVec64::<N_STATE>::from);
        let f = |x: SVector<DualSVec64<N_STATE>, N_STATE>| {
            let state = VehicleState::from_array(x.into());
            SVector::from(features(&row.vehicle, &state, &input, row.time_s))
        };
        num_dual::jacobian(f, &x)
    }
}

impl StepOperation {
    fn jacobian(
        correction: Correction,
        row: &StepRow,
        both: SVector<f64, N_BOTH>,
    ) -> (SVector<f64, N_STATE>, SMatrix<f64, N_STATE, N_BOTH>) {
        let input = row.input.map(DualSVec64::<N_BOTH>::from);
        let f = |both: SVector<DualSVec64<N_BOTH>, N_BOTH>| {
            let state = VehicleState::from_array(std::array::from_fn(|i| both[i]));
            let residual = std::array::from_fn(|i| both[N_STATE + i]);
            let next = correction.step(&row.vehicle, &state, &input, residual);
            SVector::from(next.to_array())
        };
        num_dual::jacobian(f, &both)
    }
}

/// `f` of each row, one after the other; the result of a row does not depend on the others.
pub(in crate::response) fn map_rows<const N: usize>(
    rows: &[StepRow],
    f: impl Fn(usize, &StepRow) -> [f64; N] + Sync,
) -> Vec<f64> {
    let values: Vec<[f64; N]> = rows
        .par_iter()
        .enumerate()
        .with_min_len(MIN_ROWS_PER_TASK)
        .map(|(idx, row)| f(idx, row))
        .collect();
    values.into_flattened()
}

pub(in crate::response) fn array<const N: usize>(values: &[f64], row_idx: usize) -> [f64; N] {
    std::array::from_fn(|i| values.get(row_idx * N + i).copied().unwrap_or(f64::NAN))
}

impl CustomOp1 for FeatureOperation {
    fn name(&self) -> &'static str {
        "features of the vehicle"
    }

    fn cpu_fwd(&self, x: &CpuStorage, layout: &Layout) -> TensorResult<(CpuStorage, Shape)> {
        let x = contiguous::<f64>(x, layout, self.name())?;
        let values = map_rows(&self.0, |idx, row| {
            let state = VehicleState::from_array(array(x, idx));
            features(&row.vehicle, &state, &row.input, row.time_s)
        });
        Ok((CpuStorage::F64(values), (self.0.len(), N_FEATURES).into()))
    }

    fn bwd(&self, x: &Tensor, _y: &Tensor, gradient: &Tensor) -> TensorResult<Option<Tensor>> {
        let gradient = gradient.contiguous()?;
        let (x_guard, gradient_guard) = (x.storage_and_layout(), gradient.storage_and_layout());
        let values =
            contiguous::<f64>(cpu_storage(&x_guard.0, self.name())?, x_guard.1, self.name())?;
        let given = contiguous::<f64>(
            cpu_storage(&gradient_guard.0, self.name())?,
            gradient_guard.1,
            self.name(),
        )?;
        let back = map_rows::<N_STATE>(&self.0, |idx, row| {
            let (_, jacobian) = Self::jacobian(row, SVector::from(array(values, idx)));
            jacobian.tr_mul(&SVector::from(array::<N_FEATURES>(given, idx))).into()
        });
        Ok(Some(Tensor::from_vec(back, x.shape(), &Device::Cpu)?))
    }
}

impl CustomOp2 for StepOperation {
    fn name(&self) -> &'static str {
        "step of the vehicle"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        residual: &CpuStorage,
        residual_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let x = contiguous::<f64>(x, x_layout, self.name())?;
        let residual = contiguous::<f64>(residual, residual_layout, self.name())?;
        let values = map_rows(&self.rows, |idx, row| {
            let state = VehicleState::from_array(array(x, idx));
            let value = array(residual, idx);
            self.correction.step(&row.vehicle, &state, &row.input, value).to_array()
        });
        Ok((CpuStorage::F64(values), (self.rows.len(), N_STATE).into()))
    }

    fn bwd(
        &self,
        x: &Tensor,
        residual: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let guards = [x, residual, &gradient].map(Tensor::storage_and_layout);
        let [states, residuals, given] = guards.each_ref().map(|(storage, layout)| {
            contiguous::<f64>(cpu_storage(storage, "step of the vehicle")?, layout, "step")
        });
        let (states, residuals, given) = (states?, residuals?, given?);
        let back = map_rows::<N_BOTH>(&self.rows, |idx, row| {
            let (x, a) = (array::<N_STATE>(states, idx), array::<N_RESIDUAL>(residuals, idx));
            let both = SVector::from_fn(|i, _| if i < N_STATE { x[i] } else { a[i - N_STATE] });
            let (_, jacobian) = Self::jacobian(self.correction, row, both);
            jacobian.tr_mul(&SVector::from(array::<N_STATE>(given, idx))).into()
        });
        let back = Tensor::from_vec(back, (self.rows.len(), N_BOTH), &Device::Cpu)?;
        Ok((Some(back.narrow(1, 0, N_STATE)?), Some(back.narrow(1, N_STATE, N_RESIDUAL)?)))
    }
}

#[cfg(test)]
pub(in crate::response) mod tests {
    use super::*;
    use crate::nn::gradient_check::{assert_gradients, random_variable};
    use candle_core::Var;
    use impactlab_core::vehicle::{CollisionForce, ContactPoint, Preset};

    pub(in crate::response) fn rows() -> Arc<Vec<StepRow>> {
        let vehicle = Arc::new(Preset::Reference.parameters());
        let contact = ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: 0.5 };
        let collision = CollisionForce {
            force_n: [1e3, 2e4],
            in_world_axes: true,
            yaw_moment_n_m: None,
            contact,
        };
        let struck = VehicleInput { collision: Some(collision), ..VehicleInput::released() };
        let row = |input, time_s| StepRow { vehicle: vehicle.clone(), input, time_s };
        Arc::new(vec![row(struck, 0.05), row(VehicleInput::released(), 1.0)])
    }

    /// States of a car that slides and turns.
    pub(in crate::response) fn states() -> Var {
        let x = [
            [12.0, 2.0, 0.3, 0.8, 0.02, -0.1, 3.0, 1.0],
            [15.0, -4.0, -0.5, -1.1, -0.03, 0.2, 20.0, 4.0],
        ];
        Var::from_tensor(&Tensor::new(&x, &Device::Cpu).unwrap()).unwrap()
    }

    #[test]
    fn gradients_of_the_features_are_exact() {
        let (x, rows) = (states(), rows());
        assert_gradients(std::slice::from_ref(&x), || feature_rows(&x, &rows).unwrap());
    }

    #[test]
    fn gradients_of_the_step_are_exact() {
        let (x, value, rows) = (states(), random_variable(&[2, N_RESIDUAL], 1), rows());
        for correction in [Correction::Acceleration, Correction::StateOffset, Correction::Whole] {
            assert_gradients(&[x.clone(), value.clone()], || {
                step_rows(correction, [&x, &value], &rows).unwrap()
            });
        }
    }

    #[test]
    fn another_shape_is_refused() {
        let x = Tensor::zeros((3, N_STATE), DType::F64, &Device::Cpu).unwrap();
        assert!(feature_rows(&x, &rows()).is_err());
    }
}
