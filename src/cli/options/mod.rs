//! What several commands take as options.

mod choices;
mod quantity;
mod source;
mod training;

pub(super) use choices::{
    BadCasesArg, EquationsArg, IntegratorArg, SamplingArg, SplitArg, UnitsArg, VehicleArg,
};
pub(super) use quantity::{
    contact_point, friction, size_px, speed_m_s, time_s, window_s, yaw_rate_rad_s,
};
pub(super) use source::SourceArgs;
pub(super) use training::TrainingArgs;
