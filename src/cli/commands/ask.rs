//! `impactlab ask`: answers a question that stands in a file.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, under_bar};
use impactlab_core::data::{MAX_SETTINGS_BYTES, read_utf8, without_byte_order_mark};
use impactlab_study::{InputKind, Request};

/// Answer a question that stands in a JSON file, as --print-request writes it
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct AskArgs {
    /// The question
    #[arg(value_name = "REQUEST.json")]
    request: PathBuf,
}

const EXAMPLES: &str = "\
Example:
  impactlab impact assets/scenarios/pit_right_rear.toml --print-request > request.json
  impactlab ask request.json

The answer is JSON: the same as the command of the question prints with --json. A training writes
its model only through its own command.

Exit code 1 if there is no answer, or one that the command of the question ends with 1 for too.";

/// Answers the question and prints the report.
pub(in crate::cli) fn run(args: &AskArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let path = &args.request;
    let is_other = |error: CliError| match InputKind::Request.refuse_other(path) {
        Ok(()) => error,
        Err(other) => other.into(),
    };
    let text = read_utf8(path, MAX_SETTINGS_BYTES).map_err(|error| is_other(error.into()))?;
    let request: Request = serde_json::from_str(without_byte_order_mark(&text))
        .map_err(|source| is_other(CliError::Request { path: path.clone(), source }))?;
    if console.print_request {
        print_json(console.out, &request)?;
        return Ok(Verdict::Clean);
    }
    let report = under_bar(|observer| request.run(&console.library, observer))?;
    let report = report.complete().ok_or(CliError::Cancelled)?;
    print_json(console.out, &report)?;
    Ok(Verdict::from_problems(report.has_problems()))
}
