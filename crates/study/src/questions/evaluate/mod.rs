//! How well networks and reconstructions do.

pub(crate) mod compare;
pub(crate) mod force;
pub(crate) mod pairs;
pub(crate) mod reconstruction;
pub(crate) mod reconstruction_estimates;
pub(crate) mod response;
