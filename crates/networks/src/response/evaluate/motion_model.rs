//! The models that are compared.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::learning::LearningError;
use crate::response::{
    MotionDistribution, N_RESIDUAL, ResponseCase, ResponseModel, Tuning, rollout,
};
use impactlab_core::vehicle::VehicleState;

/// The kind of a model of the motion.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum MotionModelKind {
    /// The 4DOF model by the vehicle's data sheet.
    Untuned,
    /// The 4DOF model with tire and roll parameters from the fine-tune trajectories.
    Tuned,
    /// The plain network.
    Plain,
    /// The response network.
    Network,
}

/// A model that predicts the motion after an impact, to be compared with others.
#[derive(Debug)]
pub enum MotionModel {
    /// See [`MotionModelKind::Untuned`].
    Untuned,
    /// See [`MotionModelKind::Tuned`].
    Tuned(Tuning),
    /// See [`MotionModelKind::Plain`].
    Plain(Box<ResponseModel>),
    /// See [`MotionModelKind::Network`].
    Network(Box<ResponseModel>),
}

/// The motion that a model predicts for a trajectory.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PredictedMotion {
    /// Central path, with every latent factor at zero.
    pub states: Vec<VehicleState<f64>>,
    /// Paths in which mechanics must hold: those of the components, with the latent factors at their means.
    pub paths: Vec<Vec<VehicleState<f64>>>,
    /// The distribution of the motion, if the model predicts one.
    pub distribution: Option<MotionDistribution>,
}

impl MotionModelKind {
    /// The name of the model in tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Untuned => "4DOF untuned",
            Self::Tuned => "4DOF tuned",
            Self::Plain => "NN-only",
            Self::Network => "PINN",
        }
    }
}

impl MotionModel {
    /// The kind of the model.
    pub fn kind(&self) -> MotionModelKind {
        match self {
            Self::Untuned => MotionModelKind::Untuned,
            Self::Tuned(_) => MotionModelKind::Tuned,
            Self::Plain(_) => MotionModelKind::Plain,
            Self::Network(_) => MotionModelKind::Network,
        }
    }

    /// The central path of a case.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub(crate) fn path(
        &self,
        case: &ResponseCase,
    ) -> Result<Vec<VehicleState<f64>>, LearningError> {
        match self {
            Self::Plain(model) | Self::Network(model) => {
                let initial = case.states.first().copied().unwrap_or_default();
                Ok(model.predictor(&case.vehicle)?.central_path(&initial, &case.inputs))
            }
            Self::Untuned | Self::Tuned(_) => Ok(self.predict(case)?.states),
        }
    }

    /// Predicts the motion after the impact of a case.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub(crate) fn predict(&self, case: &ResponseCase) -> Result<PredictedMotion, LearningError> {
        let initial = case.states.first().copied().unwrap_or_default();
        let four_dof = |vehicle| {
            let states = rollout(vehicle, initial, &case.inputs, [0.0; N_RESIDUAL]);
            PredictedMotion { paths: vec![states.clone()], states, distribution: None }
        };
        Ok(match self {
            Self::Untuned => four_dof(&case.vehicle),
            Self::Tuned(tuning) => four_dof(&tuning.apply(&case.vehicle)),
            Self::Plain(model) | Self::Network(model) => {
                let predictor = model.predictor(&case.vehicle)?;
                let distribution = predictor.forecast(&initial, &case.inputs);
                let states = |component: crate::response::ComponentPath| component.states;
                PredictedMotion {
                    states: predictor.central_path(&initial, &case.inputs),
                    paths: predictor
                        .paths(&initial, &case.inputs)
                        .into_iter()
                        .map(states)
                        .collect(),
                    distribution: Some(distribution),
                }
            }
        })
    }
}
