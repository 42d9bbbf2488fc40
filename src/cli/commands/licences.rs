//! `impactlab licences`: the notices of third parties.

use clap::Args;
use serde_json::json;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json};
use impactlab_networks::shipped::LICENCES;

/// Print the licences of the crates and fonts that the program contains
#[derive(Debug, Args)]
#[command(after_help = "JSON: {licences}, the same text")]
pub(in crate::cli) struct LicencesArgs {}

/// Prints the notices.
pub(in crate::cli) fn run(console: &mut Console<'_>) -> Result<Verdict, CliError> {
    if console.json {
        print_json(console.out, &json!({ "licences": LICENCES }))?;
    } else {
        console.out.write_all(LICENCES.as_bytes()).map_err(CliError::Output)?;
    }
    Ok(Verdict::Clean)
}
