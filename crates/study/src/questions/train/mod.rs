//! Trainings of the networks.

pub(crate) mod fine_tune;
pub(crate) mod force;
pub(crate) mod motion_logs;
pub(crate) mod response;
