//! The run layer: every question that can be asked of the program, and every answer, once for the
//! window and the command line.
//!
//! A question is a plain value that can be written to JSON ([`Request`]); its answer carries a plain
//! value that can be written to JSON ([`Report`]) and, for pictures, what the report was made from.
//! What a question leaves open is decided here and nowhere else: the vehicle, the contact point, the
//! speed, how many curves are drawn from which seed, and what happens to cases that cannot be read.
//! Each such decision that concerns the answer is listed in the report as an [`Assumption`].
//!
//! ```
//! use std::ops::ControlFlow;
//! use std::path::PathBuf;
//!
//! use crate::{ImpactRequest, Library, Question, ScenarioChoice};
//!
//! let scenario = PathBuf::from("assets/scenarios/pit_right_rear.toml");
//! let request = ImpactRequest { scenario: ScenarioChoice::File(scenario), paper: false };
//! let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()))?;
//! let report = answer.complete().expect("nobody cancelled").report;
//! assert!(report.target.delta_v_magnitude_m_s > 1.0);
//! # Ok::<(), crate::StudyError>(())
//! ```

pub mod analysis;
pub mod case_file;

mod assumption;
mod badges;
mod checks;
mod error;
#[cfg(test)]
mod examples;
mod finite;
mod library;
mod provenance;
mod question;
mod word;

mod inputs;

mod check;
mod check_report;
mod compare;
mod drive;
mod evaluate_force;
mod evaluate_reconstruction;
mod evaluate_response;
mod fine_tune;
mod impact;
mod implied_contact;
mod motion_logs;
mod motion_source;
mod predict_force;
mod predict_motion;
mod reconstruct;
mod reconstructed_paths;
mod reconstruction_domain;
mod reconstruction_estimates;
mod recorded_force;
mod simulate;
mod simulate_dataset;
mod simulate_report;
mod tire_marks;
mod train_force;
mod train_response;
mod trust;
mod unused;
mod vehicle_uncertainty;

mod cost;
mod request;

pub use assumption::{AssumedQuantity, Assumption};
pub use check::{CheckAnswer, CheckRequest, CheckedContent, CheckedItem, check_path};
pub use check_report::{
    CaseFlag, CheckReport, ColumnReport, DatasetReport, FileReport, InputFileReport, PathProblem,
    ProposedColumn, RecordedForceReport,
};
pub use checks::check_window;
pub use compare::{CompareAnswer, CompareReport, CompareRequest, DEFAULT_CHOICES};
pub use cost::{Cost, CostPart};
pub use drive::{ASSUMED_SPEED_M_S, Drive};
pub use error::StudyError;
pub use evaluate_force::{
    CrossValidateForceReport, EvaluateForceAnswer, EvaluateForceReport, EvaluateForceRequest,
    EvaluatedForceCases, ForceEvaluation,
};
pub use evaluate_reconstruction::{
    EvaluateReconstructionAnswer, EvaluateReconstructionReport, EvaluateReconstructionRequest,
};
pub use evaluate_response::{EvaluateResponseAnswer, EvaluateResponseRequest};
pub use fine_tune::{FineTuneRequest, Learning};
pub use impact::{BodyReport, ImpactAnswer, ImpactReport, ImpactRequest};
pub use implied_contact::{ImpliedContactReport, MomentumReport};
pub use inputs::{
    BadCases, ConfigChoice, DEFAULT_STRIKING, DEFAULT_VEHICLE, EvaluatedCases, ModelChoice,
    ScenarioChoice, SeriesFile, TrainingOptions, VehicleChoice, checkpoint_beside,
};
pub use library::Library;
pub use motion_logs::{DEFAULT_LOG_DURATION_S, LogReport, MotionLogs};
pub use motion_source::{ASSUMED_CONTACT, MotionSource};
pub use predict_force::{
    ForceQuestion, ImpulseReport, PredictForceAnswer, PredictForceReport, PredictForceRequest,
};
pub use predict_motion::{
    COARSE_DRAWS, DEFAULT_DRAWS, ForceSource, PredictMotionAnswer, PredictMotionReport,
    PredictMotionRequest,
};
pub use provenance::Provenance;
pub use question::{Event, Observer, Question, Sampling};
pub use reconstruct::{EvidenceChoice, ReconstructAnswer, ReconstructReport, ReconstructRequest};
pub use reconstructed_paths::ReconstructedPaths;
pub use recorded_force::{RecordedForceAnswer, RecordedForceRequest};
pub use request::{Answer, Report, Request};
pub use simulate::{DEFAULT_DURATION_S, DEFAULT_VEHICLE_DRAWS, SimulateAnswer, SimulateRequest};
pub use simulate_dataset::{
    ReplayedCaseReport, SimulateDatasetAnswer, SimulateDatasetReport, SimulateDatasetRequest,
};
pub use simulate_report::{
    EndState, FlagReport, ForceReport, FrictionZoneReport, RestState, SimulateReport,
};
pub use tire_marks::TireMarkReport;
pub use train_force::{TrainForceAnswer, TrainForceReport, TrainForceRequest};
pub use train_response::{ResponseTrainingAnswer, ResponseTrainingReport, TrainResponseRequest};
pub use trust::{Trust, TrustLine};
pub use vehicle_uncertainty::VehicleUncertainty;
pub use word::word;
