//! Files by their names: a report says the same wherever the case lies.

use std::path::{Path, PathBuf};

use impactlab_study::Request;
use impactlab_study::case_file::CaseFile;

/// Paths of a case with what is shown for each.
#[derive(Debug, Default)]
pub(super) struct ShownPaths {
    /// The longest first, so that a file is replaced before its folder.
    names: Vec<(String, String)>,
}

impl ShownPaths {
    /// The paths that a case names.
    pub fn from_case(case: &CaseFile) -> Self {
        let questions = case.variants.iter().flat_map(|variant| &variant.questions);
        let mut paths: Vec<PathBuf> = questions.flat_map(Request::input_files).collect();
        paths.extend(case.used_paths());
        paths.extend(case.files.iter().map(|file| file.path.clone()));
        paths.sort();
        paths.dedup();
        let name = |path: &PathBuf| {
            let name = path.file_name()?.to_string_lossy().into_owned();
            // A name alone, such as that of a scenario that comes with the program, stays as it is.
            (path.components().count() > 1).then(|| (path.to_string_lossy().into_owned(), name))
        };
        let mut names: Vec<(String, String)> = paths.iter().filter_map(name).collect();
        names.sort_by_key(|(path, _)| std::cmp::Reverse(path.len()));
        Self { names }
    }

    /// A text with file names in place of paths.
    pub fn shown(&self, text: &str) -> String {
        let replace = |text: String, (path, name): &(String, String)| text.replace(path, name);
        self.names.iter().fold(text.to_owned(), replace)
    }

    /// The name of a file.
    pub fn name(&self, path: &Path) -> String {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        name.unwrap_or_else(|| path.to_string_lossy().into_owned())
    }
}
