//! What the trainings of the force network and of the response network have in common.
//!
//! Cases: [`TrainingCase`], [`split()`], [`TrainingSet`]. Settings: [`TrainSettings`],
//! [`check_settings`].
//! A training under way: [`EpochLoop`], [`TrainingReport`], [`TrainingFile`]. What it leaves behind:
//! [`TrainingRecord`], [`ModelFile`].

mod error;

mod case;

mod split;

mod load;

mod training_set;

mod memory;
mod setting;
mod train_settings;

mod record;

mod report;

mod training_file;

mod epochs;

mod model_file;

pub use case::{CaseId, TrainingCase, content_digest, n_steps};
pub use epochs::{EpochLoop, run_epochs};
pub use error::LearningError;
pub use load::{LoadError, cases_and_problems, check_kind, load_cases, load_dataset};
pub use memory::MAX_MEMORY_BYTES;
pub(crate) use memory::{check_memory, sum};
pub use model_file::ModelFile;
pub use record::{EpochDetail, EpochRecord, TrainingRecord};
pub(crate) use report::FitSteps;
pub use report::{
    EpochReport, EpochSummary, FitReport, NamedLoss, PhysicsBalance, TrainingProgress,
    TrainingReport,
};
pub use setting::{check_relation, check_settings, load_settings};
pub use split::{Split, TEST_SHARE, folds, split};
pub use train_settings::TrainSettings;
pub use training_file::{SavedTraining, TrainingFile, stored_epochs};
pub use training_set::TrainingSet;
