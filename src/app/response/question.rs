//! What the response network is asked: where the struck vehicle goes, and where it is likely to be.

use std::sync::Arc;

use crate::analysis::{
    Analysis, DensityMap, DensityTask, MotionBands, MotionForecast, MotionForecastSettings,
    forecast_collision, forecast_forces,
};
use crate::app::latest::Question;
use crate::error_chain;
use crate::force::{ForceModel, ForceScenario};
use crate::render::DensityGpu;
use crate::response::ResponseModel;

/// Every how many steps the bands over time have an edge: 50 ms.
const BAND_STRIDE: usize = 5;

/// What is to be forecast.
#[derive(Clone)]
pub struct MotionQuestion {
    /// By whom.
    pub model: Arc<ResponseModel>,
    /// The struck vehicle and the given force.
    pub analysis: Arc<Analysis>,
    /// The network that predicts the force and the collision it is asked about; the given force
    /// without.
    pub predicted: Option<(Arc<ForceModel>, ForceScenario)>,
    /// Draws and duration.
    pub settings: MotionForecastSettings,
}

/// Where the struck vehicle goes.
pub struct MotionAnswer {
    /// What was looked at.
    pub analysis: Arc<Analysis>,
    /// Whether the force was predicted.
    pub is_predicted: bool,
    /// The forecast.
    pub forecast: MotionForecast,
    /// Its intervals over time.
    pub bands: MotionBands,
}

impl Question for MotionQuestion {
    type Answer = MotionAnswer;
    const NAME: &'static str = "forecast motion";

    fn is_same(&self, other: &Self) -> bool {
        let of = |question: &Self| question.predicted.as_ref().map(|(model, _)| Arc::as_ptr(model));
        let scenario = |question: &Self| question.predicted.as_ref().map(|(_, of)| of.clone());
        Arc::ptr_eq(&self.model, &other.model)
            && Arc::ptr_eq(&self.analysis, &other.analysis)
            && of(self) == of(other)
            && scenario(self) == scenario(other)
            && self.settings == other.settings
    }

    fn answer(&self) -> Result<MotionAnswer, String> {
        let (Some(struck), Some(force)) = (&self.analysis.struck, &self.analysis.force) else {
            return Err("there is no force on a vehicle here".to_owned());
        };
        let forecast = match &self.predicted {
            Some((model, scenario)) => {
                forecast_collision(scenario, (model, &self.model), struck, &self.settings)
            }
            None => {
                forecast_forces(std::slice::from_ref(force), &self.model, struck, &self.settings)
            }
        };
        let forecast = forecast.map_err(|error| error_chain(&error))?;
        Ok(MotionAnswer {
            analysis: Arc::clone(&self.analysis),
            is_predicted: self.predicted.is_some(),
            bands: MotionBands::of(&forecast.distribution, BAND_STRIDE),
            forecast,
        })
    }
}

/// Of which forecast and window the density is wanted.
#[derive(Clone)]
pub struct DensityQuestion {
    /// The forecast.
    pub motion: Arc<MotionAnswer>,
    /// From when to when, s.
    pub window_s: [f64; 2],
    /// What computes it; the CPU without.
    pub gpu: Option<Arc<DensityGpu>>,
}

impl Question for DensityQuestion {
    type Answer = DensityMap;
    const NAME: &'static str = "density";

    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.motion, &other.motion) && self.window_s == other.window_s
    }

    /// What the graphics processor refuses, the CPU computes.
    fn answer(&self) -> Result<DensityMap, String> {
        let task = DensityTask::new(&self.motion.forecast.distribution, self.window_s);
        let computed =
            self.gpu.as_ref().and_then(|gpu| gpu.density_on(&task.position, &task.grid).ok());
        Ok(match computed {
            Some(values) => task.with(values),
            None => task.on_cpu(),
        })
    }
}
