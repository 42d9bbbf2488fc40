//! The case that is open in the window: its variants, its file, and what is asked before it is left.

mod bar;

mod leaving;

mod update;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::app::state::Project;
use impactlab_core::data::write::sha256_hex;
use impactlab_study::SeriesFile;
use impactlab_study::case_file::{CaseFile, Variant};

pub use bar::case_bar_ui;
pub use leaving::{Leaving, leaving_ui};
pub use update::SavedCase;

/// Name of a case that has no file yet, and of the first variant of a case.
const UNTITLED: &str = "untitled";
const FIRST_VARIANT: &str = "base";

/// The case that is open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenCase {
    /// What stands in its file. The variant that is shown is in the forms of the window, and is written
    /// here when another is shown and when the case is saved.
    pub file: CaseFile,
    /// Its file; `None` before it is saved for the first time.
    pub path: Option<PathBuf>,
    /// SHA-256 of the text that was last read from the file or written to it.
    pub on_disk: Option<String>,
    /// What the case held then, by [`OpenCase::fingerprint`].
    pub saved: Option<String>,
}

/// The forms of the window for a variant.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Forms {
    /// Vehicles, subject and settings.
    pub project: Project,
    /// The data that the subject needs, with the columns that the user has assigned.
    pub sources: Vec<SeriesFile>,
}

/// An action on the variants of the case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum VariantCommand {
    /// Show another variant.
    Show(String),
    /// Make a copy of the variant that is shown, and show it.
    Duplicate,
    /// Give the variant that is shown another name.
    Rename(String),
    /// Remove the variant that is shown.
    Remove,
}

impl Default for OpenCase {
    fn default() -> Self {
        let variant = Variant { name: FIRST_VARIANT.to_owned(), ..Variant::default() };
        Self { file: CaseFile::new(UNTITLED, variant), path: None, on_disk: None, saved: None }
    }
}

impl OpenCase {
    /// What the case holds, by its content: name, notes, and the forms of all variants.
    ///
    /// - `shown`: the forms of the window.
    pub fn fingerprint(&self, shown: &Forms) -> String {
        let live = serde_json::to_value(shown).unwrap_or_default();
        let forms = |variant: &Variant| {
            let is_shown = variant.name == self.file.shown;
            let forms = if is_shown { &live } else { &variant.forms };
            format!("{}\n{forms}\n", variant.name)
        };
        let variants: String = self.file.variants.iter().map(forms).collect();
        sha256_hex(format!("{}\n{}\n{variants}", self.file.name, self.file.notes).as_bytes())
    }

    /// Whether there is something in the case that is not in its file. A case without a file holds
    /// something as soon as it is not what the program starts with; which data are looked at does not
    /// count for it.
    pub fn is_changed(&self, shown: &Forms) -> bool {
        match &self.saved {
            Some(saved) => *saved != self.fingerprint(shown),
            None => {
                let blank = |forms: &Forms| Forms {
                    project: Project { subject: None, ..forms.project.clone() },
                    sources: Vec::new(),
                };
                let start = Self::default();
                self.fingerprint(&blank(shown)) != start.fingerprint(&Forms::default())
            }
        }
    }
}
