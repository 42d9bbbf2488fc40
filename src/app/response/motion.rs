//! The predicted motion of the struck vehicle, prepared for drawing: bands over time, and the
//! density of its position.

use std::sync::Arc;

use impactlab_core::data::Outcome;
use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::units::{Estimate, Interval};
use impactlab_draw::DensityGpu;
use impactlab_study::analysis::{DensityMap, DensityTask, MotionBands};
use impactlab_study::{
    Answer, Library, Observer, PredictMotionAnswer, PredictMotionReport, PredictMotionRequest,
    Question, StudyError, check_window,
};

/// A question for a predicted motion, whose answer is prepared for drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionQuestion {
    /// The question for the motion itself.
    pub request: PredictMotionRequest,
}

/// A predicted motion with its bands.
pub struct MotionAnswer {
    /// The answer to the question for the motion.
    pub answer: PredictMotionAnswer,
    /// The intervals of the states over time, for the figures.
    pub bands: MotionBands,
    /// Size of the impulse of the force with its interval of 90 %, N s, if a network predicted the force.
    pub impulse_n_s: Option<Estimate>,
}

impl MotionAnswer {
    /// Time of the last instant, s.
    pub fn end_s(&self) -> f64 {
        self.answer.forecast.end_s()
    }

    /// Whether the force that drives the motion was predicted by a force network.
    pub fn is_predicted(&self) -> bool {
        self.answer.report.force_model.is_some()
    }
}

impl Question for MotionQuestion {
    type Answer = MotionAnswer;
    type Report = Answer<PredictMotionReport>;
    const NAME: &'static str = PredictMotionRequest::NAME;

    fn check(&self) -> Result<(), StudyError> {
        self.request.check()
    }

    fn coarse(&self) -> Option<Self> {
        Some(Self { request: self.request.coarse()? })
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<MotionAnswer>, StudyError> {
        let answered = self.request.solve(library, observer)?;
        Ok(answered.map(|answer| {
            let bands = MotionBands::for_figure(&answer.forecast.distribution);
            let impulse_n_s = impulse_n_s(&answer);
            MotionAnswer { answer, bands, impulse_n_s }
        }))
    }
}

/// Size of the impulse by the force network with its intervals, as the answer says it; where it does not, that
/// of the drawn forces.
fn impulse_n_s(answer: &PredictMotionAnswer) -> Option<Estimate> {
    answer.report.force_model.as_ref()?;
    if let Some(impulses) = &answer.report.impulses {
        return Some(impulses.network_impulse_n_s.clone());
    }
    let impulses = answer.forecast.forces.iter().map(|force| {
        let [x, y] = force.impulse_n_s();
        x.hypot(y)
    });
    let mut sizes: Vec<f64> = impulses.collect();
    sizes.sort_by(f64::total_cmp);
    let [low, median, high] = [0.05, 0.5, 0.95].map(|share| quantile_of_sorted(&sizes, share));
    let interval = Interval { level: 0.9, low: low?, high: high? };
    Some(Estimate { median: median?, intervals: vec![interval] })
}

/// A question for the density of the predicted position.
#[derive(Clone)]
pub struct DensityQuestion {
    /// The predicted motion.
    pub motion: Arc<MotionAnswer>,
    /// First and last time over which the density is averaged, s; equal for a single time.
    pub window_s: [f64; 2],
    /// The graphics processor that computes the density; `None` computes it on the CPU.
    pub gpu: Option<Arc<DensityGpu>>,
}

/// The density of a predicted position.
pub struct DensityAnswer {
    /// The prediction to which it belongs.
    pub motion: Arc<MotionAnswer>,
    /// The density.
    pub map: Arc<DensityMap>,
}

/// Two questions are equal if they refer to the same prediction in memory and the same times. The
/// processor is left out, because it does not change the answer.
impl PartialEq for DensityQuestion {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.motion, &other.motion) && self.window_s == other.window_s
    }
}

impl Question for DensityQuestion {
    type Answer = DensityAnswer;
    type Report = ();
    const NAME: &'static str = "density";

    fn check(&self) -> Result<(), StudyError> {
        check_window(self.window_s)
    }

    fn report(_answer: &Self::Answer) -> &() {
        &()
    }

    /// Computes the density on the graphics processor, or on the CPU if there is none or it reports
    /// an error.
    fn solve(
        &self,
        _library: &Library,
        _observer: &mut Observer<'_>,
    ) -> Result<Outcome<DensityAnswer>, StudyError> {
        let task = DensityTask::new(&self.motion.answer.forecast.distribution, self.window_s);
        let computed =
            self.gpu.as_ref().and_then(|gpu| gpu.density_on(&task.position, &task.grid).ok());
        let map = match computed {
            Some(values) => task.with(values),
            None => task.on_cpu(),
        };
        let (motion, map) = (Arc::clone(&self.motion), Arc::new(map));
        Ok(Outcome::Complete(DensityAnswer { motion, map }))
    }
}
