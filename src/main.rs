//! The `impactlab` program: hands over to the command line, which opens the window if asked to.

use std::process::ExitCode;

fn main() -> ExitCode {
    impactlab::cli::run()
}
