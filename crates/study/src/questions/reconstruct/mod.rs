//! From the evidence to the speeds before the collision.

pub(crate) mod paths;
pub(crate) mod request;
