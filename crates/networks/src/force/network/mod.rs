//! The force network: its inputs, its layers, and the distribution that it predicts.

mod features;

mod domain;

mod force_network;

pub(crate) use domain::ForceDomain;
pub(crate) use features::{N_FEATURES, N_INSTANT_FEATURES, features, instant_features};
pub use features::{OpenFeatures, OutsideTraining, Standardisation};
pub(crate) use force_network::{ForceNetwork, NetworkInput, NetworkOutput};
