//! The commands: each parses its options into a request, asks it, writes files and prints.

pub(super) mod app;
pub(super) mod ask;
pub(super) mod case;
pub(super) mod check;
pub(super) mod compare;
pub(super) mod condition;
pub(super) mod evaluate;
mod evaluate_force;
mod evaluate_reconstruction;
mod evaluate_response;
pub(super) mod fine_tune;
pub(super) mod impact;
pub(super) mod licences;
pub(super) mod predict;
mod predict_force;
mod predict_motion;
pub(super) mod ranges;
pub(super) mod reconstruct;
pub(super) mod render;
mod render_figure;
mod render_forecast;
mod render_reconstruction;
pub(super) mod simulate;
pub(super) mod train;
mod train_force;
mod train_response;
pub(super) mod vehicles;
