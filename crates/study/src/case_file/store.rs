//! Reads and writes the file of a case.

use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use crate::case_file::on_disk::sealed;
use crate::case_file::paths::{absolute, relative, replace_strings};
use crate::case_file::{CaseError, CaseFile};
use impactlab_core::data::{
    Existing, MAX_RESULTS_BYTES, read_utf8, without_byte_order_mark, write_bytes,
};

/// Ending of the names of case files.
pub const CASE_ENDING: &str = "impactlab";

/// What every case file says that it is, and the version of its schema. Version 1 had no common part of
/// the questions, and forms of the window beside them.
pub(crate) const FORMAT: &str = "impactlab case";
pub(super) const VERSION: u32 = 2;

/// What is read of a file before anything else.
#[derive(Deserialize)]
struct Header {
    format: String,
    version: u32,
}

impl CaseFile {
    /// Reads a case. Whether its files are there is not looked at; see [`CaseFile::changes`].
    ///
    /// # Errors
    /// [`CaseError`], with line and column where the text is wrong.
    pub fn load(path: &Path) -> Result<Self, CaseError> {
        let text = read_utf8(path, MAX_RESULTS_BYTES)?;
        Self::parse(&text, path)
    }

    /// Reads a case from the text of its file.
    ///
    /// - `path`: of the file, whose folder relative paths begin at.
    ///
    /// # Errors
    /// As for [`CaseFile::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, CaseError> {
        let wrong = |source: serde_json::Error| CaseError::syntax(path, &source);
        let text = without_byte_order_mark(text);
        let header: Header = serde_json::from_str(text).map_err(wrong)?;
        if header.format != FORMAT {
            return Err(CaseError::Format { path: path.to_owned(), got: header.format });
        }
        if header.version > VERSION {
            let (path, got) = (path.to_owned(), header.version);
            return Err(CaseError::Version { path, got, expected: VERSION });
        }
        let case: Self = serde_json::from_str(text).map_err(wrong)?;
        let case = Self { version: VERSION, ..case };
        case.check_names(path)?;
        let io = |source| CaseError::Io { path: path.to_owned(), source };
        let folder = folder_of(&std::path::absolute(path).map_err(io)?);
        let to_absolute = |text: &str| Some(absolute(text, &folder)?.to_str()?.to_owned());
        case.with_paths(&to_absolute).map_err(wrong)
    }

    /// The text of the case's file, with its seal.
    ///
    /// - `path`: of the file, absolute.
    ///
    /// # Errors
    /// [`CaseError::Syntax`] if a number is not finite.
    pub fn to_text(&self, path: &Path) -> Result<String, CaseError> {
        self.check_writable()?;
        let wrong = |source: serde_json::Error| CaseError::syntax(path, &source);
        let (folder, used) = (folder_of(path), self.used_paths());
        let to_relative = |text: &str| {
            let path = Path::new(text);
            let is_used = used.iter().any(|used| used == path);
            if is_used { relative(path, &folder) } else { None }
        };
        let mut case = self.with_paths(&to_relative).map_err(wrong)?;
        case.program = impactlab_core::program::version().to_owned();
        Ok(sealed(&serde_json::to_string_pretty(&case).map_err(wrong)?))
    }

    /// Writes a case, whole or not at all.
    ///
    /// # Errors
    /// [`CaseError::Data`], as for [`write_bytes`].
    pub fn save(&self, path: &Path, existing: Existing) -> Result<(), CaseError> {
        let io = |source| CaseError::Io { path: path.to_owned(), source };
        let path = std::path::absolute(path).map_err(io)?;
        let text = self.to_text(&path)?;
        Ok(write_bytes(&path, existing, text.as_bytes())?)
    }

    /// The same case with other paths in variants, files and models.
    pub(super) fn with_paths(
        &self,
        change: &impl Fn(&str) -> Option<String>,
    ) -> Result<Self, serde_json::Error> {
        let mut of_variants = serde_json::to_value(&self.variants)?;
        let mut of_files = serde_json::to_value(&self.files)?;
        let mut of_models = serde_json::to_value(&self.models)?;
        for value in [&mut of_variants, &mut of_files, &mut of_models] {
            replace_strings(value, change);
        }
        let (variants, files, models) = (typed(of_variants)?, typed(of_files)?, typed(of_models)?);
        Ok(Self { variants, files, models, ..self.clone() })
    }
}

fn typed<T: for<'de> Deserialize<'de>>(value: Value) -> Result<T, serde_json::Error> {
    serde_json::from_value(value)
}

fn folder_of(path: &Path) -> std::path::PathBuf {
    path.parent().map(Path::to_owned).unwrap_or_default()
}
