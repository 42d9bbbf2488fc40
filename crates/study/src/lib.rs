//! The run layer: every question that can be asked of the program, and every answer, once for the
//! window and the command line.
//!
//! A question is a plain value that can be written to JSON ([`Request`]); its answer carries a plain
//! value that can be written to JSON ([`Report`]) and, for pictures, what the report was made from.
//! What a question leaves open is decided here and nowhere else: the vehicle, the contact point, the
//! speed, how many curves are drawn from which seed, and what happens to cases that cannot be read.
//! Each such decision that concerns the answer is listed in the answer as a [`Caveat`](impactlab_core::uncertainty::Caveat).
//!
//! ```
//! use std::ops::ControlFlow;
//! use std::path::PathBuf;
//!
//! use impactlab_study::{ImpactRequest, Library, Question, ScenarioChoice};
//!
//! let scenario = PathBuf::from("pit-right-rear");
//! let request = ImpactRequest::new(ScenarioChoice::File(scenario));
//! let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()))?;
//! let report = answer.complete().expect("nobody cancelled").report;
//! assert!(report.struck.delta_v_magnitude_m_s > 1.0);
//! # Ok::<(), impactlab_study::StudyError>(())
//! ```

pub mod analysis;
pub mod case_file;
pub mod facts;

mod ask;
mod caveats;
#[cfg(test)]
mod examples;
mod measured;
mod questions;

pub use ask::answer::Answer;
pub use ask::checks::check_window;
pub use ask::cost::{Cost, CostPart};
pub use ask::error::StudyError;
pub use ask::inputs::{
    ATLAS_ENDING, BadCases, ConfigChoice, DEFAULT_STRIKING, DEFAULT_VEHICLE, EvaluatedCases,
    InputError, InputFile, InputKind, MODEL_ENDING, ModelChoice, ScenarioChoice, SeriesFile,
    TrainingOptions, VehicleChoice, checkpoint_beside, take_vehicle,
};
pub use ask::library::Library;
pub use ask::provenance::Provenance;
pub use ask::question::{Event, Observer, Question, Sampling};
pub use ask::request::{AnyAnswer, Report, Request};
pub use ask::schema::{JsonKind, json_kinds};
pub use ask::word::word;
pub use measured::{
    HeldIntervals, Measured, Measurement, Measurements, TriedMotion, ValidationTable,
};
pub use questions::check::report::{
    CaseFlag, CheckReport, ColumnReport, DatasetReport, FileReport, InputFileReport, PathProblem,
    ProposedColumn, RecordedForceReport,
};
pub use questions::check::request::{
    CheckAnswer, CheckRequest, CheckedContent, CheckedDataset, CheckedFile, CheckedItem, check_path,
};
pub use questions::evaluate::compare::{
    CompareAnswer, CompareReport, CompareRequest, DEFAULT_CHOICES,
};
pub use questions::evaluate::force::{
    CrossValidateForceReport, EvaluateForceAnswer, EvaluateForceReport, EvaluateForceRequest,
    EvaluatedForceCases, ForceEvaluation,
};
pub use questions::evaluate::pairs::{
    EvaluatePairsAnswer, EvaluatePairsReport, EvaluatePairsRequest, PairGroup, PairSplit,
    StruckSummary,
};
pub use questions::evaluate::reconstruction::{
    EvaluateReconstructionAnswer, EvaluateReconstructionReport, EvaluateReconstructionRequest,
};
pub use questions::evaluate::response::{EvaluateResponseAnswer, EvaluateResponseRequest};
pub use questions::hand::{
    DEFAULT_HAND_DRAWS, HandInputReport, HandMethodAnswer, HandReport, HandRequest, HandResult,
    HandSensitivityReport,
};
pub use questions::impact::{BodyReport, ImpactAnswer, ImpactReport, ImpactRequest, SkidReport};
pub use questions::predict::force::{
    ForceQuestion, ImpulseReport, PredictForceAnswer, PredictForceReport, PredictForceRequest,
};
pub use questions::predict::force_source::ForceSource;
pub use questions::predict::implied_contact::{ImpliedContactReport, MomentumReport};
pub use questions::predict::impulse_rival::ImpulseRival;
pub use questions::predict::motion::{
    COARSE_DRAWS, DEFAULT_DRAWS, PredictMotionAnswer, PredictMotionReport, PredictMotionRequest,
    StrikingReport,
};
pub use questions::predict::recorded_impulse::RecordedImpulse;
pub use questions::reconstruct::evidence_choice::EvidenceChoice;
pub use questions::reconstruct::later_contacts::LaterContactsReport;
pub use questions::reconstruct::paths::{NamedPath, ReconstructedPaths};
pub use questions::reconstruct::request::{
    ReconstructAnswer, ReconstructReport, ReconstructRequest,
};
pub use questions::replay::report::{
    ContactPose, ContactState, ReplayAnswer, ReplayPoint, ReplayReport, ReplaySample, StartPose,
    Travelled, YawRateCheck,
};
pub use questions::replay::request::{DEFAULT_REPLAY_DRAWS, ReplayRequest};
pub use questions::simulate::dataset::{
    ReplayedCaseReport, SimulateDatasetAnswer, SimulateDatasetReport, SimulateDatasetRequest,
};
pub use questions::simulate::drive::{ASSUMED_SPEED_M_S, Drive};
pub use questions::simulate::flag::{FlagReport, FlaggedContact};
pub use questions::simulate::motion_source::{ASSUMED_CONTACT, MotionSource};
pub use questions::simulate::pairs::{PairReplay, SimulatedPair, SimulatedPairs};
pub use questions::simulate::recorded_force::{RecordedForceAnswer, RecordedForceRequest};
pub use questions::simulate::report::{
    EndState, ForceReport, FrictionZoneReport, RestState, SimulateReport,
};
pub use questions::simulate::request::{DEFAULT_DURATION_S, SimulateAnswer, SimulateRequest};
pub use questions::simulate::tire_marks::TireMarkReport;
pub use questions::simulate::vehicle_uncertainty::VehicleUncertainty;
pub use questions::train::fine_tune::{FineTuneRequest, Learning};
pub use questions::train::force::{TrainForceAnswer, TrainForceReport, TrainForceRequest};
pub use questions::train::motion_logs::{DEFAULT_LOG_DURATION_S, LogReport, MotionLogs};
pub use questions::train::response::{
    ResponseTrainingAnswer, ResponseTrainingReport, TrainResponseRequest,
};
