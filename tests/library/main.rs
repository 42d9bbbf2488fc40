//! The core library through its public interface, on the shipped data and on bad input.
//!
//! One program: each test program of its own would link everything anew.

mod data_bad_input;
mod data_dialects;
mod data_quality;
mod data_shipped;
mod force_baselines;
mod force_model;
mod layering;
mod response_model;
mod validation_collision;
mod vehicle;
