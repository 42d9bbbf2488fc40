//! The app, driven without a display and drawn on the CPU.

mod harness;
mod network_figures;
mod pictures;
mod snapshots;
mod workflow;
