//! The crush contact of two vehicles and their motion to the end, with sustained and renewed contact.
//!
//! - `law`, `stiffness`: the load of a face over its deflection, and how stiff faces are;
//! - `outline`: rounded outlines, cut into elements;
//! - `touch`: how far outlines are from touching;
//! - `bodies`, `force`, `half_pass`, `press`: the force between two outlines, and the history of their
//!   elements, which are pressed together side by side;
//! - `first_force`: a known force of the first contact, and how the law takes over from it;
//! - `phases`: when they were in contact, with which impulse;
//! - `vehicle_pair`, `coupled`: two 4DOF vehicles on their tires with this force between them.
//!
//! It generalises [`crush`](crate::collision::crush), which is fitted to one nose against one side, to
//! any face against any face.

mod law;
mod stiffness;

mod bodies;
mod force;
mod half_pass;
mod outline;
mod press;

mod coupled;
mod error;
mod first_force;
mod phases;
#[cfg(test)]
mod test_pairs;
mod touch;
mod vehicle_pair;

pub use bodies::{
    CONTACT_DAMPING_S_M, CONTACT_FRICTION, CONTACT_FRICTION_SIGMA, CONTACT_HEIGHT_M, ContactBody,
    ContactConditions, FULL_FRICTION_SPEED_M_S, PlanarMotion,
};
pub use coupled::PairRun;
pub use error::PairError;
pub use first_force::{HandOver, LAW_SCALE_RANGE};
pub use force::{ContactForce, PairContact};
pub use law::{
    CRUSHED_RECOVERY, ELASTIC_RECOVERY, FaceLaw, FaceLawError, FaceParameters, PressedStrips,
    RECOVERY_END_M, Recovery, Strip, press_together,
};
pub use outline::{ContactOutline, OutlineElement, USUAL_CORNER_SHARE, USUAL_ELEMENT_M};
pub use phases::{CONTACT_GAP_S, ContactPhase, PhaseOfVehicle};
pub use stiffness::{
    BarrierTest, ByFace, ELASTIC_DEPTH_LOG_SIGMA, ELASTIC_DEPTH_M, FaceLaws, FaceStiffness,
    PRINTED_FACTORS, SATURATION_DEPTH_M, STIFFNESS_LOG_SIGMA, STIFFNESS_RULE, STIFFNESS_SOURCE,
    TESTED_LOG_SIGMA, class_estimates, class_stiffness, stiffness_log_sigma,
};
pub use touch::way_to_touch_m;
pub use vehicle_pair::{ContactEnergy, CoupledSettings, PairMotion, PairVehicle, VehiclePair};
