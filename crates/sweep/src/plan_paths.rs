//! Paths of the files that the rows of a plan read: absolute in memory, relative to the folder of the plan
//! in its file, and the content of the files in its digest.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use serde_json::Value;

use crate::SweepError;
use crate::plan::{FORMAT_OF_FILES, PLAN_FILE, Plan};
use impactlab_study::Request;
use impactlab_study::case_file::{UsedFile, begin_paths_at, end_paths_at, replace_strings};

impl Plan {
    /// The plan with absolute paths in place of those that are relative to a folder.
    ///
    /// - `requests`: of its rows, which name the files.
    /// - `working_directory`: to which paths of requests are relative.
    pub(crate) fn with_absolute_paths(
        &self,
        requests: &[Request],
        working_directory: &Path,
    ) -> Result<Self, serde_json::Error> {
        let named: HashSet<_> = requests.iter().flat_map(Request::named_paths).collect();
        let is_relative = |text: &str| {
            let path = Path::new(text);
            !text.is_empty() && path.is_relative() && named.contains(path)
        };
        self.with_changed_paths(|value| {
            replace_strings(value, &|text| is_relative(text).then(|| format!("./{text}")));
            begin_paths_at(value, working_directory);
        })
    }

    /// The plan that a file in `folder` says.
    pub(crate) fn with_paths_begun_at(&self, folder: &Path) -> Result<Self, SweepError> {
        self.between_file_and_memory(folder, begin_paths_at)
    }

    /// The plan as its file in `folder` says it.
    pub(crate) fn with_paths_ended_at(&self, folder: &Path) -> Result<Self, SweepError> {
        // Folders of data sets stand in questions, too.
        let paths: HashSet<&Path> =
            self.files.iter().flat_map(|file| file.path.ancestors()).collect();
        self.between_file_and_memory(folder, |value, folder| end_paths_at(value, &paths, folder))
    }

    /// The plan as a value that has the digests of files in place of their paths.
    pub(crate) fn by_content(&self) -> Value {
        // A plan is made of numbers, texts and maps with texts as keys, which JSON can write.
        let mut value = serde_json::to_value(self).unwrap_or_default();
        let digests = self.files.iter().map(|file| (file.path.as_path(), file.sha256.as_str()));
        let digests: HashMap<_, _> = digests.collect();
        replace_strings(&mut value, &|text| {
            let path = Path::new(text);
            if let Some(digest) = digests.get(path) {
                return Some((*digest).to_owned());
            }
            let is_within = |file: &&UsedFile| path.is_absolute() && file.path.starts_with(path);
            let within = self.files.iter().filter(is_within);
            let of_folder: Vec<&str> = within.map(|file| file.sha256.as_str()).collect();
            (!of_folder.is_empty()).then(|| of_folder.concat())
        });
        value
    }

    fn between_file_and_memory(
        &self,
        folder: &Path,
        change: impl Fn(&mut Value, &Path),
    ) -> Result<Self, SweepError> {
        if self.format != FORMAT_OF_FILES {
            return Ok(self.clone());
        }
        // The folder of `plan.json` alone has no letters.
        let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let absolute = std::path::absolute(here)
            .map_err(|source| SweepError::Input { path: folder.to_owned(), source })?;
        self.with_changed_paths(|value| change(value, &absolute))
            .map_err(|source| SweepError::NoPlan { path: folder.join(PLAN_FILE), source })
    }

    fn with_changed_paths(
        &self,
        change: impl FnOnce(&mut Value),
    ) -> Result<Self, serde_json::Error> {
        let Self { question, vary, files, .. } = self;
        let mut value = serde_json::to_value((question, vary, files))?;
        change(&mut value);
        let (question, vary, files) = serde_json::from_value(value)?;
        Ok(Self { question, vary, files, ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use impactlab_study::Library;

    /// `run_chunk("plan.json", 0)` of Python failed for plans that read files.
    #[test]
    fn a_plan_in_the_working_directory_needs_no_name_of_a_folder() {
        let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/atlas/pit.toml");
        let mut plan = Plan::read(&plan, &Library::default()).unwrap();
        let path = std::env::current_dir().unwrap().join("a.toml");
        plan.files = vec![UsedFile { path, bytes: 1, sha256: "ab".repeat(32) }];
        plan.format = FORMAT_OF_FILES;
        for folder in ["", "."] {
            let written = plan.with_paths_ended_at(Path::new(folder)).unwrap();
            assert_eq!(written.files[0].path, PathBuf::from("./a.toml"), "{folder:?}");
            assert_eq!(written.with_paths_begun_at(Path::new(folder)).unwrap(), plan);
        }
    }
}
