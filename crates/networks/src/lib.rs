//! The two networks and what they share. Only this crate knows how a network is computed.
//!
//! 1. [`nn`]: layers, parameters, optimiser and files of networks;
//! 2. [`learning`]: what the trainings of both networks have in common;
//! 3. [`force`], [`response`]: the network that predicts the contact force, and the network that
//!    predicts the motion, each with its baselines;
//! 4. [`pair`]: both vehicles with all contacts between them, to the end;
//! 5. [`shipped`]: the trained networks and notices that are part of the program.

pub mod force;
pub mod learning;
pub mod nn;
pub mod pair;
pub mod response;
pub mod shipped;
