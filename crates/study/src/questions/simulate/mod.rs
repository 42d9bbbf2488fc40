//! Motions by the 4DOF model, and the forces that are recorded for them.

pub(crate) mod dataset;
pub(crate) mod drive;
pub(crate) mod flag;
pub(crate) mod motion_source;
pub(crate) mod pairs;
pub(crate) mod recorded_force;
pub(crate) mod report;
pub(crate) mod request;
pub(crate) mod tire_marks;
pub(crate) mod vehicle_uncertainty;
