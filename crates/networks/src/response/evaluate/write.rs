//! A comparison as files.

use std::fmt::Write;
use std::path::Path;

use crate::response::evaluate::{Comparison, all_tables};
use impactlab_core::data::{DataError, Existing, write_atomically};

/// All tables of a comparison as Markdown.
pub fn to_markdown(comparison: &Comparison) -> String {
    let mut text = format!(
        "# {}\n\n{} trajectories that no model has seen, seed {}, {} choices of the trajectories.\n",
        comparison.data,
        comparison.test.len(),
        comparison.seed,
        comparison.n_choices
    );
    for (title, _, table) in all_tables(comparison) {
        if !table.rows.is_empty() {
            // Writing to a string does not fail.
            let _ = write!(text, "\n## {title}\n\n{}", table.to_markdown());
        }
    }
    text
}

/// Writes `comparison.json`, `comparison.md` and each table as CSV into a folder, which must exist and
/// have no files of these names.
///
/// - `restrictions`: what restricts the comparison, for the tables.
///
/// # Errors
/// [`DataError::Io`] with the file.
pub fn write_comparison(
    folder: &Path,
    comparison: &Comparison,
    restrictions: Option<&str>,
) -> Result<(), DataError> {
    let file = folder.join("comparison.json");
    let to_error = |source: serde_json::Error| DataError::io(&file, source.into());
    // A line for each number of all paths would be long.
    let json = serde_json::to_vec(comparison).map_err(to_error)?;
    write_atomically(&file, Existing::Refuse, |out| out.write_all(&json))?;
    for (_, name, table) in all_tables(comparison) {
        let csv = table.to_csv(restrictions);
        write_atomically(&folder.join(name), Existing::Refuse, |out| {
            out.write_all(csv.as_bytes())
        })?;
    }
    let mut text = to_markdown(comparison);
    if let Some(restrictions) = restrictions {
        // Writing to a string does not fail.
        let _ = write!(text, "\nRestrictions: {restrictions}\n");
    }
    write_atomically(&folder.join("comparison.md"), Existing::Refuse, |out| {
        out.write_all(text.as_bytes())
    })
}
