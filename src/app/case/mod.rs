//! The case that is open in the window: its variants, its file, and what is asked before it is left.

mod bar;
mod command;
mod known;
mod leaving;
mod trust;
mod update;
mod version_1;

pub use bar::case_bar_ui;
pub use command::{CaseCommand, Leaving, LeavingStage, VariantCommand};
pub use known::KnownCase;
pub use leaving::leaving_ui;
pub use trust::{TrustedCase, trust_ui};

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::app::project::Project;
use impactlab_study::case_file::{CaseFile, Expert, Variant};
use impactlab_study::{ForceQuestion, ForceSource};

/// Name of a case that has no file yet, and of the first variant of a case.
const UNTITLED: &str = "untitled";

const FIRST_VARIANT: &str = "base";

/// The case that is open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenCase {
    /// What stands in its file. The variant that is shown is in the project, and is written here when
    /// another is shown and when the case is saved.
    pub file: CaseFile,
    /// Its file; `None` before it is saved for the first time.
    pub path: Option<PathBuf>,
    /// The text that was last read from the file or written to it.
    pub on_disk: Option<String>,
    /// What the case held then, by [`OpenCase::fingerprint`].
    pub saved: Option<String>,
}

impl Default for OpenCase {
    fn default() -> Self {
        let variant = Variant { name: FIRST_VARIANT.to_owned(), ..Variant::default() };
        Self { file: CaseFile::new(UNTITLED, variant), path: None, on_disk: None, saved: None }
    }
}

impl OpenCase {
    /// A case that was read, with what was wrong with the forms of its variants, if it is of version 1.
    fn from_file(mut file: CaseFile) -> (Self, Vec<String>) {
        let mut problems = Vec::new();
        for variant in &mut file.variants {
            if let Err(error) = version_1::take_forms(variant) {
                let name = &variant.name;
                problems.push(format!("the forms of variant {name:?} are not used: {error}"));
            }
        }
        (Self { file, path: None, on_disk: None, saved: None }, problems)
    }

    /// The file with the project in the variant that is shown. Questions that are still those of the file
    /// stay as they stand there, and so does a variant that cannot be shown.
    pub fn with_shown(&self, project: &Project) -> CaseFile {
        let mut file = self.file.clone();
        let name = file.shown.clone();
        if let Some(variant) = file.variant_mut(&name) {
            let Ok(in_file) = project.with_variant(variant) else { return file };
            let now = project.to_variant(&name);
            let is_same = in_file.to_variant(&name).questions == now.questions;
            let before = std::mem::take(variant);
            let questions = if is_same { before.questions } else { now.questions };
            *variant = Variant { questions, notes: before.notes, forms: before.forms, ..now };
        }
        file
    }

    /// What the case holds, by its content: name, notes and variants.
    ///
    /// - `shown`: the project in the variant that is shown.
    pub fn fingerprint(&self, shown: &Project) -> String {
        fingerprint_of(&self.with_shown(shown))
    }

    /// Whether there is something in the case that is not in its file. A case without a file holds
    /// something as soon as it is not what the program starts with; which data are looked at does not
    /// count for it.
    pub fn is_changed(&self, shown: &Project) -> bool {
        if let Some(saved) = &self.saved {
            return *saved != self.fingerprint(shown);
        }
        let start = Project::default();
        let mut blank = shown.clone();
        if blank.predict_motion.force != ForceSource::usual(&blank.simulate.source) {
            return true;
        }
        blank.predict_motion.force.clone_from(&start.predict_motion.force);
        blank.simulate.source.clone_from(&start.simulate.source);
        if matches!(blank.predict_force.collision, ForceQuestion::Case { .. }) {
            let scenario = blank.impact.scenario.clone();
            blank.predict_force.collision = ForceQuestion::Scenario(scenario);
        }
        blank.keep_in_step();
        let is_blank = |variant: &Variant| *variant == start.to_variant(FIRST_VARIANT);
        let CaseFile { name, notes, expert, variants, .. } = &self.file;
        let is_new = name == UNTITLED
            && notes.is_empty()
            && *expert == Expert::default()
            && variants.len() == 1
            && variants.iter().all(|variant| variant.notes.is_empty());
        !(is_new && is_blank(&blank.to_variant(&self.file.shown)))
    }
}

fn fingerprint_of(file: &CaseFile) -> String {
    // What JSON cannot hold, such as a file name that is not Unicode, is seen all the same.
    let variants = serde_json::to_string(&file.variants);
    let variants = variants.unwrap_or_else(|_| format!("{:?}", file.variants));
    format!("{}\n{}\n{:?}\n{variants}", file.name, file.notes, file.expert)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_change_is_seen_where_a_file_name_is_not_unicode() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        use std::path::PathBuf;

        use impactlab_study::{ImpactRequest, ScenarioChoice};

        let path = PathBuf::from(OsStr::from_bytes(b"caf\xe9.toml"));
        let file = |paper| {
            let scenario = ScenarioChoice::File(path.clone());
            let questions = vec![ImpactRequest { paper, ..ImpactRequest::new(scenario) }.into()];
            CaseFile::new("case", Variant { questions, ..Variant::default() })
        };
        assert_ne!(fingerprint_of(&file(false)), fingerprint_of(&file(true)));
    }
}
