//! The crush contact of two vehicles.
//!
//! - `law`, `stiffness`: the load of a face over its deflection, and how stiff faces are.
//!
//! It generalises [`crush`](crate::collision::crush), which is fitted to one nose against one side, to
//! any face against any face.

mod law;
mod stiffness;

pub use law::{
    CRUSHED_RECOVERY, ELASTIC_RECOVERY, FaceLaw, FaceLawError, FaceParameters, PressedStrips,
    RECOVERY_END_M, Recovery, Strip, press_together,
};
pub use stiffness::{
    BarrierTest, ByFace, ELASTIC_DEPTH_M, FaceLaws, FaceStiffness, SATURATION_DEPTH_M,
    STIFFNESS_LOG_SIGMA, class_stiffness,
};
