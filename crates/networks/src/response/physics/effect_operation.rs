//! The effects beside the 4DOF model as an operation of candle, with exact gradients.

use std::sync::Arc;

use candle_core::{CpuStorage, CustomOp2, Device, Layout, Result as TensorResult, Shape, Tensor};
use nalgebra::{SMatrix, SVector};
use num_dual::DualSVec64;

use crate::nn::NnError;
use crate::nn::storage::{contiguous, cpu_storage};
use crate::response::physics::step_operations::{StepRow, array, check, map_rows};
use crate::response::{Effects, N_EFFECTS, N_RESIDUAL, combined, effects};
use impactlab_core::vehicle::{N_STATE, VehicleState};

/// The residual acceleration by the effects.
///
/// - `x`: `[rows, 8]`, `strengths`: of each row, `[rows, N_EFFECTS]`, f64;
/// - returns `[rows, 4]`.
///
/// # Errors
/// [`NnError::Tensor`] for another shape or type.
pub(crate) fn effect_rows(
    x: &Tensor,
    strengths: &Tensor,
    rows: &Arc<Vec<StepRow>>,
) -> Result<Tensor, NnError> {
    check(x, N_STATE, rows)?;
    check(strengths, N_EFFECTS, rows)?;
    let strengths = strengths.contiguous()?;
    Ok(x.contiguous()?.apply_op2(&strengths, EffectOperation(rows.clone()))?)
}

struct EffectOperation(Arc<Vec<StepRow>>);

impl EffectOperation {
    fn jacobian(
        row: &StepRow,
        x: SVector<f64, N_STATE>,
        strengths: &[f64],
    ) -> SMatrix<f64, N_RESIDUAL, N_STATE> {
        let input = row.input.map(DualSVec64::<N_STATE>::from);
        let f = |x: SVector<DualSVec64<N_STATE>, N_STATE>| {
            let state = VehicleState::from_array(x.into());
            let now = row.vehicle.evaluate(&state, &input);
            let effects = effects(&row.vehicle, &state, &now);
            SVector::from(combined(&effects, strengths))
        };
        num_dual::jacobian(f, &x).1
    }

    fn at(row: &StepRow, x: [f64; N_STATE]) -> Effects<f64> {
        let state = VehicleState::from_array(x);
        effects(&row.vehicle, &state, &row.vehicle.evaluate(&state, &row.input))
    }
}

impl CustomOp2 for EffectOperation {
    fn name(&self) -> &'static str {
        "effects beside the 4DOF model"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        strengths: &CpuStorage,
        strengths_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let x = contiguous::<f64>(x, x_layout, self.name())?;
        let strengths = contiguous::<f64>(strengths, strengths_layout, self.name())?;
        let values = map_rows(&self.0, |idx, row| {
            let strengths: [f64; N_EFFECTS] = array(strengths, idx);
            combined(&Self::at(row, array(x, idx)), &strengths)
        });
        Ok((CpuStorage::F64(values), (self.0.len(), N_RESIDUAL).into()))
    }

    fn bwd(
        &self,
        x: &Tensor,
        strengths: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let guards = [x, strengths, &gradient].map(Tensor::storage_and_layout);
        let [states, of_rows, given] = guards.each_ref().map(|(storage, layout)| {
            contiguous::<f64>(cpu_storage(storage, self.name())?, layout, self.name())
        });
        let (states, of_rows, given) = (states?, of_rows?, given?);
        let to_states = map_rows::<N_STATE>(&self.0, |idx, row| {
            let strengths: [f64; N_EFFECTS] = array(of_rows, idx);
            let jacobian = Self::jacobian(row, SVector::from(array(states, idx)), &strengths);
            jacobian.tr_mul(&SVector::from(array::<N_RESIDUAL>(given, idx))).into()
        });
        let to_strengths = map_rows::<N_EFFECTS>(&self.0, |idx, row| {
            let given: [f64; N_RESIDUAL] = array(given, idx);
            let share = |effect: [f64; N_RESIDUAL]| {
                effect.into_iter().zip(given).map(|(effect, given)| effect * given).sum()
            };
            Self::at(row, array(states, idx)).map(share)
        });
        Ok((
            Some(Tensor::from_vec(to_states, x.shape(), &Device::Cpu)?),
            Some(Tensor::from_vec(to_strengths, strengths.shape(), &Device::Cpu)?),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::gradient_check::{assert_gradients, random_variable};
    use crate::response::physics::step_operations::tests::{rows, states};

    #[test]
    fn gradients_of_the_effects_are_exact() {
        let (x, strengths, rows) = (states(), random_variable(&[2, N_EFFECTS], 1), rows());
        assert_gradients(&[x.clone(), strengths.clone()], || {
            effect_rows(&x, &strengths, &rows).unwrap()
        });
    }
}
