//! The files of `impactlab reconstruct`.

use std::path::Path;

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::files::write_json;
use impactlab_core::data::{Existing, write_restricted_table};
use impactlab_study::ReconstructAnswer;

/// Writes the particles as CSV and the report as JSON into a folder that exists.
pub(in crate::cli) fn write_reconstruction(
    path: &Path,
    answer: &ReconstructAnswer,
    report: &impl Serialize,
) -> Result<(), CliError> {
    let restrictions = answer.report.caveats.text();
    let columns = answer.particle_columns();
    let header: Vec<String> = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
    let rows = (0..answer.particles.z.len()).map(|idx| {
        columns.iter().filter_map(|(_, values)| values.get(idx)).map(f64::to_string).collect()
    });
    let table = path.join("particles.csv");
    write_restricted_table(&table, Existing::Refuse, &header, rows, restrictions.as_deref())?;
    write_json(&path.join("reconstruction.json"), report)
}
