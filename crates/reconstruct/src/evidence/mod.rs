//! What is found after a collision, and how well each item of it is known.

mod defaults;
#[cfg(test)]
pub(crate) mod examples;
mod file;
mod items;
mod write;

pub use defaults::{
    DEFAULT_ANGLE_SIGMA_RAD, DEFAULT_DAMAGE_SIGMA_M, DEFAULT_EDR_SPEED_SHARE, DEFAULT_FRICTION,
    DEFAULT_FRICTION_SIGMA, DEFAULT_HEADING_SIGMA_RAD, DEFAULT_MARK_SIGMA_M, DEFAULT_MASS_SHARE,
    DEFAULT_REST_SIGMA_M, DEFAULT_VIDEO_SIGMA_M, default_edr_speed_sigma,
};
pub use items::{
    After, CarEvidence, Damage, DriverBraked, Edr, Evidence, Mark, MarkKind, Measured, PriorRanges,
    RestPose, VideoPosition,
};
