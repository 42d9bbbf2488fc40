//! What came of a training.

use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::text::{PrintedAnswer, print_answer};
use impactlab_core::units::UnitSystem;
use impactlab_study::Answer;

/// A report of a training, and where its model was written.
#[derive(Serialize)]
struct Trained<'a, R> {
    model: &'a Path,
    #[serde(flatten)]
    report: &'a Answer<R>,
}

/// Prints what came of a training.
///
/// - `model`: the file that was written.
pub(in crate::cli) fn print_trained<'a, R: Serialize>(
    console: &mut Console<'_>,
    model: &'a Path,
    report: &'a Answer<R>,
) -> Result<Verdict, CliError>
where
    PrintedAnswer<'a>: From<&'a Answer<R>>,
{
    console.print(&Trained { model, report }, |out| {
        let answer = PrintedAnswer::from(report).written(Some(model));
        print_answer(out, answer, UnitSystem::default())
    })?;
    Ok(Verdict::Clean)
}
