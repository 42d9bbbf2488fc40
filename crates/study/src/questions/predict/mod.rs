//! What the networks predict.

pub(crate) mod both_vehicles;
pub(crate) mod force;
pub(crate) mod force_source;
pub(crate) mod implied_contact;
pub(crate) mod impulse_rival;
pub(crate) mod motion;
mod one_vehicle;
pub(crate) mod recorded_impulse;
