//! The command line: one file per command, which parses, calls the core and prints.
//!
//! - Results go to stdout: aligned text, or JSON with `--json` (SI units, the unit in every key).
//! - Errors go to stderr, once, as one line `error: what: why`; progress too, if stderr is
//!   a terminal.
//! - Exit codes: 0 = all is well; 1 = the work failed or found problems; 2 = wrong usage.

mod run;

mod app;
mod check;
mod check_report;
mod check_text;
mod compare;
mod evaluate;
mod evaluate_response;
mod fine_tune;
mod fine_tune_log;
mod impact;
mod predict;
mod predict_motion;
mod predict_motion_files;
mod render;
mod render_figure;
mod render_forecast;
mod simulate;
mod simulate_answer;
mod simulate_dataset;
mod simulate_single;
mod train;
mod train_response;
mod vehicles;

mod case_choice;
mod error;
mod output;
mod progress;
mod quantity;
mod response_training;
mod vehicle_choice;

pub use error::CliError;
pub use run::run;
