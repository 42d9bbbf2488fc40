//! The files of `impactlab evaluate force`.

use std::io;
use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use impactlab_core::data::write::json_without_machine;
use impactlab_core::data::{Existing, write_atomically, write_bytes};
use impactlab_core::units::UnitSystem;
use impactlab_study::facts::FactWriter;
use impactlab_study::{Answer, ForceEvaluation};

/// Writes an evaluation as JSON and Markdown, or a cross-validation as JSON, into a folder that
/// exists.
pub(in crate::cli) fn write_force_evaluation(
    path: &Path,
    answer: &Answer<ForceEvaluation>,
) -> Result<(), CliError> {
    match &answer.report {
        ForceEvaluation::Cases(report) => {
            write_json(&path.join("evaluation.json"), answer)?;
            let tables = FactWriter::english(UnitSystem::default()).markdown(&report.facts());
            let text = answer.caveats.appended_to(tables);
            write_bytes(&path.join("evaluation.md"), Existing::Refuse, text.as_bytes())?;
        }
        ForceEvaluation::Folds(_) => {
            write_json(&path.join("cross_validation.json"), answer)?;
        }
    }
    Ok(())
}

/// Writes a report as indented JSON into a file that does not exist yet, in a folder that goes to others.
pub(in crate::cli) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), CliError> {
    let json = serde_json::to_string_pretty(value).map_err(io::Error::from)?;
    let json = json_without_machine(&json);
    write_atomically(path, Existing::Refuse, |out| writeln!(out, "{json}"))?;
    Ok(())
}
