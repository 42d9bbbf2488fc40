//! AdamW with clipping and a schedule; its state can be saved and taken up again to the bit.
//!
//! ```text
//! η_t = η·share(t)      ĝ = g·min(1, c/‖g‖)      ‖g‖ over all parameters together
//! m ← β₁ m + (1 − β₁) ĝ          v ← β₂ v + (1 − β₂) ĝ²
//! θ ← θ·(1 − η_t λ) − η_t·(m/(1 − β₁ᵗ)) / (√(v/(1 − β₂ᵗ)) + ε)
//! ```
//!
//! Source: I. Loshchilov, F. Hutter, Decoupled Weight Decay Regularization, ICLR 2019, algorithm 2.

use candle_core::backprop::GradStore;
use candle_core::{DType, Tensor, Var};
use serde::{Deserialize, Serialize};

use crate::nn::named_tensors::{check_no_other, find};
use crate::nn::parameters::Parameter;
use crate::nn::storage::number_type;
use crate::nn::{
    Expected, NamedTensors, NnError, Parameters, Schedule, check_number, check_numbers,
};

/// The settings of [`AdamW`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AdamWConfig {
    /// η, above 0: how far a parameter moves in a step at most, about.
    pub learning_rate: f64,
    /// β₁, 0 to below 1: memory of the mean gradient.
    pub beta_1: f64,
    /// β₂, 0 to below 1: memory of the mean squared gradient.
    pub beta_2: f64,
    /// ε, above 0: keeps parameters with tiny gradients still.
    pub epsilon: f64,
    /// λ, at least 0: pull of weights to zero, apart from the gradient.
    pub weight_decay: f64,
    /// Whether biases, scales and shifts (parameters of one dimension) are pulled to zero too.
    pub decay_biases: bool,
    /// c, above 0: longest gradient of all parameters together; none for no limit.
    pub max_gradient_norm: Option<f64>,
    /// How η changes over the steps.
    pub schedule: Schedule,
}

impl Default for AdamWConfig {
    fn default() -> Self {
        Self {
            learning_rate: 1e-3,
            beta_1: 0.9,
            beta_2: 0.999,
            epsilon: 1e-8,
            weight_decay: 1e-2,
            decay_biases: false,
            max_gradient_norm: None,
            schedule: Schedule::Constant,
        }
    }
}

impl AdamWConfig {
    fn check(&self) -> Result<(), NnError> {
        let below_one = |x: f64| (0.0..1.0).contains(&x);
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let decay = self.weight_decay;
        let norm = self.max_gradient_norm.unwrap_or(1.0);
        let settings = [
            ("learning_rate", self.learning_rate, positive(self.learning_rate), "above 0"),
            ("beta_1", self.beta_1, below_one(self.beta_1), "at least 0 and below 1"),
            ("beta_2", self.beta_2, below_one(self.beta_2), "at least 0 and below 1"),
            ("epsilon", self.epsilon, positive(self.epsilon), "above 0"),
            ("weight_decay", decay, decay == 0.0 || positive(decay), "at least 0"),
            ("max_gradient_norm", norm, positive(norm), "above 0"),
        ];
        match settings.into_iter().find(|(_, _, is_good, _)| !is_good) {
            None => Ok(()),
            Some((name, value, _, expected)) => Err(NnError::Setting { name, value, expected }),
        }
    }
}

/// The result of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Number of steps taken, including this one.
    pub step: u64,
    /// ‖g‖ before clipping.
    pub gradient_norm: f64,
    /// η_t.
    pub learning_rate: f64,
}

/// Largest number of steps of a state that is taken over.
const MAX_STEPS: f64 = 1e12;

/// The state from which a training can be resumed to the same bits.
#[derive(Debug, Clone)]
pub struct OptimizerState {
    /// Steps taken.
    pub step: u64,
    /// `first_moment.NAME` and `second_moment.NAME` of every parameter.
    pub moments: NamedTensors,
}

/// The optimiser of a network's [`Parameters`].
#[derive(Debug)]
pub struct AdamW {
    config: AdamWConfig,
    step: u64,
    /// In the order of the parameters.
    moments: Vec<Moments>,
}

/// Running means of one parameter's gradient and of its square, of the parameter's shape.
#[derive(Debug)]
struct Moments {
    /// Of the parameter.
    name: String,
    /// m.
    first: Tensor,
    /// v.
    second: Tensor,
}

/// The numbers of one step, the same for all parameters.
#[derive(Debug, Clone, Copy)]
struct Rates {
    /// min(1, c/‖g‖).
    clip: f64,
    /// η_t/(1 − β₁ᵗ).
    step_size: f64,
    /// 1/√(1 − β₂ᵗ).
    root_scale: f64,
    /// η_t λ.
    decay: f64,
}

impl AdamW {
    /// An optimiser before its first step.
    ///
    /// # Errors
    /// [`NnError::Setting`] for a setting out of range, [`NnError::NumberType`].
    pub fn new(config: AdamWConfig, parameters: &Parameters) -> Result<Self, NnError> {
        config.check()?;
        let moments = parameters.iter().map(|(name, variable)| Moments::zero(name, variable));
        Ok(Self { config, step: 0, moments: moments.collect::<Result<_, _>>()? })
    }

    /// The settings.
    pub fn config(&self) -> &AdamWConfig {
        &self.config
    }

    /// Steps taken.
    pub fn steps_taken(&self) -> u64 {
        self.step
    }

    /// Moves the trained parameters by one step against the gradients; those on which the loss does not
    /// depend stay.
    ///
    /// - `parameters`: those that the optimiser was made for.
    /// - `gradients`: of the loss, from `loss.backward()`.
    ///
    /// # Errors
    /// [`NnError::NonFiniteGradient`] with the first such parameter, before any is changed;
    /// [`NnError::MissingTensor`] if the parameters are others.
    pub fn step(
        &mut self,
        parameters: &Parameters,
        gradients: &GradStore,
    ) -> Result<StepReport, NnError> {
        let entries = parameters.entries();
        self.check_same(entries)?;
        let mut sum_of_squares = 0.0;
        let mut found = Vec::with_capacity(entries.len());
        for entry in entries {
            let gradient = gradients.get(&entry.variable).filter(|_| entry.trained);
            let gradient = gradient.map(|gradient| gradient.detach().contiguous()).transpose()?;
            if let Some(gradient) = &gradient {
                let squares =
                    gradient.to_dtype(DType::F64)?.sqr()?.sum_all()?.to_scalar::<f64>()?;
                if !squares.is_finite() {
                    return Err(NnError::NonFiniteGradient { name: entry.name.clone() });
                }
                sum_of_squares += squares;
            }
            found.push(gradient);
        }
        let gradient_norm = sum_of_squares.sqrt();
        let learning_rate = self.config.learning_rate * self.config.schedule.share(self.step);
        self.step += 1;
        let rates = self.rates(learning_rate, gradient_norm);
        for ((entry, moments), gradient) in entries.iter().zip(&mut self.moments).zip(&found) {
            if let Some(gradient) = gradient {
                let decays = self.config.decay_biases || entry.variable.rank() > 1;
                let decay = if decays { rates.decay } else { 0.0 };
                moments.update(
                    &entry.variable,
                    gradient,
                    &self.config,
                    Rates { decay, ..rates },
                )?;
            }
        }
        Ok(StepReport { step: self.step, gradient_norm, learning_rate })
    }

    fn rates(&self, learning_rate: f64, gradient_norm: f64) -> Rates {
        let clip = match self.config.max_gradient_norm {
            Some(max) if gradient_norm > max => max / gradient_norm,
            _ => 1.0,
        };
        let steps = self.step as f64;
        Rates {
            clip,
            step_size: learning_rate / (1.0 - self.config.beta_1.powf(steps)),
            root_scale: 1.0 / (1.0 - self.config.beta_2.powf(steps)).sqrt(),
            decay: learning_rate * self.config.weight_decay,
        }
    }

    /// The step and all moments.
    pub fn export(&self) -> OptimizerState {
        let tensors = self.moments.iter().flat_map(|moments| {
            let [first, second] = moments.tensor_names();
            [(first, moments.first.clone()), (second, moments.second.clone())]
        });
        OptimizerState { step: self.step, moments: tensors.collect() }
    }

    /// Takes over the state of an exported optimiser. Nothing is changed unless all tensors fit.
    ///
    /// # Errors
    /// [`NnError::MissingTensor`], [`NnError::UnexpectedTensor`], [`NnError::WrongShape`],
    /// [`NnError::NonFinite`], [`NnError::NumberType`].
    pub fn import(&mut self, state: &OptimizerState) -> Result<(), NnError> {
        check_number("step", state.step as f64, Expected::Magnitude(MAX_STEPS))?;
        let imported = self.moments.iter().map(|moments| moments.imported(&state.moments));
        let imported = imported.collect::<Result<Vec<_>, _>>()?;
        let is_known = |tensor: &str| {
            self.moments
                .iter()
                .any(|moments| moments.tensor_names().iter().any(|name| name == tensor))
        };
        check_no_other(&state.moments, is_known)?;
        (self.moments, self.step) = (imported, state.step);
        Ok(())
    }

    /// The parameters must be those of the moments, in the same order.
    fn check_same(&self, entries: &[Parameter]) -> Result<(), NnError> {
        fn name(moments: &Moments) -> &str {
            &moments.name
        }
        let names = entries.iter().map(|entry| entry.name.as_str());
        let known = self.moments.iter().map(name);
        if names.clone().eq(known.clone()) {
            return Ok(());
        }
        let differing = known.zip(names.clone()).find(|(known, name)| known != name);
        let missing = differing.map(|(known, _)| known).or(self.moments.last().map(name));
        Err(NnError::MissingTensor { name: missing.unwrap_or_default().to_owned() })
    }
}

impl Moments {
    fn zero(name: &str, variable: &Var) -> Result<Self, NnError> {
        number_type(variable, name)?;
        let zero = variable.as_detached_tensor().zeros_like()?;
        Ok(Self { name: name.to_owned(), first: zero.clone(), second: zero })
    }

    fn tensor_names(&self) -> [String; 2] {
        ["first_moment", "second_moment"].map(|moment| format!("{moment}.{}", self.name))
    }

    /// One step of the parameter.
    ///
    /// - `gradient`: of the parameter's shape.
    fn update(
        &mut self,
        variable: &Var,
        gradient: &Tensor,
        config: &AdamWConfig,
        rates: Rates,
    ) -> Result<(), NnError> {
        let mean = |old: &Tensor, new: &Tensor, beta: f64| (old * beta)? + (new * (1.0 - beta))?;
        let gradient = (gradient * rates.clip)?;
        self.first = mean(&self.first, &gradient, config.beta_1)?;
        self.second = mean(&self.second, &gradient.sqr()?, config.beta_2)?;
        let root = ((self.second.sqrt()? * rates.root_scale)? + config.epsilon)?;
        let step = ((&self.first * rates.step_size)? / root)?;
        let decayed = (variable.as_detached_tensor() * (1.0 - rates.decay))?;
        Ok(variable.set(&(decayed - step)?)?)
    }

    /// The same with the values of exported tensors.
    fn imported(&self, tensors: &NamedTensors) -> Result<Self, NnError> {
        let [first, second] = self.tensor_names();
        let value = |name: &str| -> Result<Tensor, NnError> {
            let tensor = find(tensors, name, self.first.dims())?;
            Ok(tensor.detach().to_dtype(self.first.dtype())?.contiguous()?)
        };
        let (first, second_moment) = (value(&first)?, value(&second)?);
        let squares = second_moment.flatten_all()?.to_dtype(DType::F64)?.to_vec1::<f64>()?;
        check_numbers(&second, &squares, Expected::NotNegative)?;
        Ok(Self { name: self.name.clone(), first, second: second_moment })
    }
}
