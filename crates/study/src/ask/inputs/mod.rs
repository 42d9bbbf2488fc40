//! What questions refer to: vehicles, scenarios, files, models, settings, cases.

mod cases;
mod chosen_vehicle;
mod config;
pub(crate) mod data_files;
mod file;
mod input_file;
mod input_kind;
mod model;
mod read_files;
mod scenario;
mod vehicle;

pub use cases::{BadCases, EvaluatedCases};
pub(crate) use cases::{
    UsableCases, data_name, data_names, dataset_folders, force_cases, response_cases,
};
pub use chosen_vehicle::take_vehicle;
pub use config::{ConfigChoice, TrainingOptions, checkpoint_beside};
pub use file::SeriesFile;
pub use input_file::{InputError, InputFile};
pub use input_kind::{ATLAS_ENDING, InputKind, MODEL_ENDING};
pub use model::ModelChoice;
pub use scenario::ScenarioChoice;
pub use vehicle::{DEFAULT_STRIKING, DEFAULT_VEHICLE, VehicleChoice};
pub(crate) use vehicle::{OpenVehicle, striking_vehicle, struck_vehicle};
