//! What a vehicle did up to the first contact, from speed and steering of its event data recorder.

mod record;
mod restrictions;
mod unknowns;
mod yaw_rate;

pub(crate) mod report;
pub(crate) mod request;

#[cfg(test)]
mod tests;
