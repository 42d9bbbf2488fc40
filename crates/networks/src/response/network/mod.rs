//! The response network: its layers and losses for training, and the same network for one vehicle,
//! without tensors, for predictions.

mod layers;
pub(super) mod response_network;

pub(super) mod one_step;

pub(super) mod loss;

pub(super) mod rollout_loss;

mod dense;
mod folded_attention;
pub(super) mod vehicle_network;

pub use loss::ResponseLossTerms;
