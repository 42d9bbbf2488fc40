//! How commands speak: results on standard output, progress on standard error.

mod command_line;
mod escaped;
mod output;
mod progress;
mod targets;

pub(super) use command_line::{Console, Verdict, print_caveats, print_settings};
pub(super) use escaped::{Escaped, shown_path, within_line};
pub(super) use output::{print_json, print_table};
pub(super) use progress::under_bar;
pub(super) use targets::Targets;
