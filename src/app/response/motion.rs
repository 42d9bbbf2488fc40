//! Where the struck vehicle goes, made ready to be drawn: bands over time, and the density of its
//! position.

use std::sync::Arc;

use crate::analysis::{DensityMap, DensityTask, MotionBands};
use crate::data::Outcome;
use crate::render::DensityGpu;
use crate::study::{
    Library, Observer, PredictMotionAnswer, PredictMotionRequest, Question, StudyError,
};

/// Every how many steps the bands over time have an edge: 50 ms.
const BAND_STRIDE: usize = 5;

/// A question for a motion whose answer is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionQuestion {
    /// What is asked.
    pub request: PredictMotionRequest,
}

/// Where the struck vehicle goes.
pub struct MotionAnswer {
    /// What was answered.
    pub answer: PredictMotionAnswer,
    /// Its intervals over time, for the figures.
    pub bands: MotionBands,
}

impl MotionAnswer {
    /// Whether the force was predicted.
    pub fn is_predicted(&self) -> bool {
        self.answer.report.force_model.is_some()
    }
}

impl Question for MotionQuestion {
    type Answer = MotionAnswer;
    const NAME: &'static str = PredictMotionRequest::NAME;

    fn answer(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<MotionAnswer>, StudyError> {
        let answered = self.request.answer(library, observer)?;
        Ok(answered.map(|answer| {
            let bands = MotionBands::of(&answer.forecast.distribution, BAND_STRIDE);
            MotionAnswer { answer, bands }
        }))
    }
}

/// Asks for the density of a forecast's position.
#[derive(Clone)]
pub struct DensityQuestion {
    /// The forecast.
    pub motion: Arc<MotionAnswer>,
    /// From when to when, s.
    pub window_s: [f64; 2],
    /// What computes it; the CPU without.
    pub gpu: Option<Arc<DensityGpu>>,
}

impl PartialEq for DensityQuestion {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.motion, &other.motion) && self.window_s == other.window_s
    }
}

impl Question for DensityQuestion {
    type Answer = DensityMap;
    const NAME: &'static str = "density";

    /// What the graphics processor refuses, the CPU computes.
    fn answer(
        &self,
        _library: &Library,
        _observer: &mut Observer<'_>,
    ) -> Result<Outcome<DensityMap>, StudyError> {
        let task = DensityTask::new(&self.motion.answer.forecast.distribution, self.window_s);
        let computed =
            self.gpu.as_ref().and_then(|gpu| gpu.density_on(&task.position, &task.grid).ok());
        Ok(Outcome::Complete(match computed {
            Some(values) => task.with(values),
            None => task.on_cpu(),
        }))
    }
}
