//! Any question and any answer, as JSON reads and writes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use crate::ask::schema::JsonKind;
use crate::questions::evaluate::compare::CompareReport;
use crate::{
    Answer, CheckReport, CheckRequest, CompareRequest, EvaluateForceRequest, EvaluatePairsReport,
    EvaluatePairsRequest, EvaluateReconstructionReport, EvaluateReconstructionRequest,
    EvaluateResponseRequest, FineTuneRequest, ForceEvaluation, HandReport, HandRequest,
    ImpactReport, ImpactRequest, Library, Observer, PredictForceReport, PredictForceRequest,
    PredictMotionReport, PredictMotionRequest, Provenance, Question, ReconstructReport,
    ReconstructRequest, ReplayReport, ReplayRequest, ResponseTrainingReport, SimulateDatasetReport,
    SimulateDatasetRequest, SimulateReport, SimulateRequest, StudyError, TrainForceReport,
    TrainForceRequest, TrainResponseRequest,
};
use impactlab_core::data::Outcome;
use impactlab_core::uncertainty::Caveats;

macro_rules! questions {
    ($(#[doc = $meaning:literal] $variant:ident($request:ty) -> $report:ty;)+) => {
        /// Any question that can be asked.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "question", rename_all = "snake_case")]
        pub enum Request {
            $(#[doc = $meaning] $variant(Box<$request>),)+
        }

        /// The answer to any question, as it is told.
        #[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
        #[serde(untagged)]
        pub enum Report {
            $(#[doc = $meaning] $variant(Box<Answer<$report>>),)+
        }

        /// The answer to any question, with what its report was made from and figures are drawn from.
        pub enum AnyAnswer {
            $(#[doc = $meaning] $variant(Box<<$request as Question>::Answer>),)+
        }

        impl Report {
            /// What restricts the answer and what it rests on.
            pub fn caveats(&self) -> &Caveats {
                match self {
                    $(Self::$variant(answer) => &answer.caveats,)+
                }
            }

            /// Where the answer comes from.
            pub fn provenance(&self) -> &Provenance {
                match self {
                    $(Self::$variant(answer) => &answer.provenance,)+
                }
            }

            /// Whether the answer says that something is wrong with what was asked of
            /// ([`Question::has_problems`]).
            pub fn has_problems(&self) -> bool {
                match self {
                    $(Self::$variant(answer) => <$request>::has_problems(answer),)+
                }
            }
        }

        impl AnyAnswer {
            /// What is told of the answer.
            pub fn into_report(self) -> Report {
                match self {
                    $(Self::$variant(answer) => Report::$variant(Box::new(answer.report)),)+
                }
            }

            /// What restricts the answer and what it rests on.
            pub fn caveats(&self) -> &Caveats {
                match self {
                    $(Self::$variant(answer) => &answer.report.caveats,)+
                }
            }

            /// Where the answer comes from.
            pub fn provenance(&self) -> &Provenance {
                match self {
                    $(Self::$variant(answer) => &answer.report.provenance,)+
                }
            }
        }

        /// An answer is written as it is told.
        impl Serialize for AnyAnswer {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self {
                    $(Self::$variant(answer) => answer.report.serialize(serializer),)+
                }
            }
        }

        impl Request {
            /// Every kind of question with the schemas of question and answer.
            pub(crate) fn kinds() -> Vec<JsonKind> {
                vec![$(JsonKind::question::<$request, Answer<$report>>(stringify!($variant), $meaning),)+]
            }

            /// Answers the question, whichever it is.
            ///
            /// # Errors
            /// [`StudyError`] says what is wrong with the question or with a file.
            pub fn answer(
                &self,
                library: &Library,
                observer: &mut Observer<'_>,
            ) -> Result<Outcome<AnyAnswer>, StudyError> {
                match self {
                    $(Self::$variant(request) => {
                        let answer = request.answer(library, observer)?;
                        Ok(answer.map(|answer| AnyAnswer::$variant(Box::new(answer))))
                    })+
                }
            }

            /// Answers the question and keeps what is told of the answer.
            ///
            /// # Errors
            /// As for [`Request::answer`].
            pub fn run(
                &self,
                library: &Library,
                observer: &mut Observer<'_>,
            ) -> Result<Outcome<Report>, StudyError> {
                Ok(self.answer(library, observer)?.map(AnyAnswer::into_report))
            }
        }

        $(impl From<$request> for Request {
            fn from(request: $request) -> Self {
                Self::$variant(Box::new(request))
            }
        })+
    };
}

questions! {
    /// What is in files and data sets, and what is wrong with them.
    Check(CheckRequest) -> CheckReport;
    /// The impulse solution of a scenario.
    Impact(ImpactRequest) -> ImpactReport;
    /// The motion of one vehicle by the 4DOF model.
    Simulate(SimulateRequest) -> SimulateReport;
    /// The 4DOF model against every recorded motion of a data set.
    SimulateDataset(SimulateDatasetRequest) -> SimulateDatasetReport;
    /// The distribution of an impact force history.
    PredictForce(PredictForceRequest) -> PredictForceReport;
    /// The distribution of the motion after an impact.
    PredictMotion(PredictMotionRequest) -> PredictMotionReport;
    /// How fast both cars were, from the evidence.
    Reconstruct(ReconstructRequest) -> ReconstructReport;
    /// What a method by hand gives.
    Hand(HandRequest) -> HandReport;
    /// What a vehicle did up to the first contact, from its event data recorder.
    Replay(ReplayRequest) -> ReplayReport;
    /// A training of the force network.
    TrainForce(TrainForceRequest) -> TrainForceReport;
    /// A pre-training of the response network.
    TrainResponse(TrainResponseRequest) -> ResponseTrainingReport;
    /// A fine-tuning of the response network.
    FineTune(FineTuneRequest) -> ResponseTrainingReport;
    /// How well a force network does.
    EvaluateForce(EvaluateForceRequest) -> ForceEvaluation;
    /// How well both vehicles of recorded pairs are forecast.
    EvaluatePairs(EvaluatePairsRequest) -> EvaluatePairsReport;
    /// How well the speeds of staged collisions are reconstructed.
    EvaluateReconstruction(EvaluateReconstructionRequest) -> EvaluateReconstructionReport;
    /// How well a response network does.
    EvaluateResponse(EvaluateResponseRequest) -> CompareReport;
    /// Which response model does best.
    Compare(CompareRequest) -> CompareReport;
}
