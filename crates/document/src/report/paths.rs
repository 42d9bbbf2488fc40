//! Files by their names: a report says the same wherever the case lies.

use std::path::{Path, PathBuf};

use impactlab_core::data::write::with_name_for_path;
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
        let variants = case.variants.iter();
        let questions =
            variants.flat_map(|variant| variant.questions.iter().chain(&variant.unasked));
        let of_question = |question: &Request| {
            let written = question.written_path().map(Path::to_owned);
            let read = [question.input_files(), question.named_paths()].concat();
            read.into_iter().chain(written)
        };
        let mut paths: Vec<PathBuf> = questions.flat_map(of_question).collect();
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
        let replace =
            |text: String, (path, name): &(String, String)| with_name_for_path(&text, path, name);
        self.names.iter().fold(text.to_owned(), replace)
    }

    /// The name of a file.
    pub fn name(&self, path: &Path) -> String {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        name.unwrap_or_else(|| path.to_string_lossy().into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_study::case_file::Variant;
    use impactlab_study::{
        ForceQuestion, ImpactRequest, ModelChoice, PredictForceRequest, ScenarioChoice,
    };

    /// A report said the home folder with a network that was not there, and had no slash in any unit where a
    /// file was called `/s`.
    #[test]
    fn paths_are_shown_by_their_names_and_nothing_else_is() {
        let scenario = |path: &str| ScenarioChoice::File(path.into());
        let mut force = PredictForceRequest::new(ForceQuestion::Scenario(scenario("/s")));
        force.model = ModelChoice::file("/home/ann/gone/own.safetensors");
        let questions = vec![force.into()];
        let unasked = vec![ImpactRequest::new(scenario("/home/ann/gone/later.toml")).into()];
        let variant = Variant { questions, unasked, ..Variant::default() };
        let paths = ShownPaths::from_case(&CaseFile::new("case", variant));
        for (text, expected) in [
            ("/home/ann/gone/own.safetensors: does not exist", "own.safetensors: does not exist"),
            ("the file /home/ann/gone/later.toml is not used", "the file later.toml is not used"),
            ("20 m/s in \"/s\"", "20 m/s in \"s\""),
            ("/s: 1 m/s", "s: 1 m/s"),
            ("", ""),
        ] {
            assert_eq!(paths.shown(text), expected);
        }
    }
}
