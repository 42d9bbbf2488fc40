//! What several commands take as options.

mod camera_key;
mod choices;
mod ending;
mod evidence;
mod learning_data;
mod overwrite;
mod quantity;
mod source;
mod training;
mod trust;

pub(super) use camera_key::{CameraKeyArg, camera_key};
pub(super) use choices::{
    AXLES, BadCasesArg, EQUATIONS, INTEGRATORS, SAMPLINGS, SIDES, SPLITS, UNITS, Values,
    VehicleArg, Words, one_of, one_value_of,
};
pub(super) use ending::EndingArgs;
pub(super) use evidence::EvidenceArgs;
pub(super) use learning_data::LearningDataArgs;
pub(super) use overwrite::OverwriteArg;
pub(super) use quantity::{contact_point, count, film_section, number, size_px, window_s};
pub(super) use source::SourceArgs;
pub(super) use training::TrainingArgs;
pub(super) use trust::TrustArg;
