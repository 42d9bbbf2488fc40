//! Runs of the sampler that are kept on disk: the answer is back a few seconds after the program was
//! started again, and a run that was killed goes on.
//!
//! ```text
//! reconstructions/DIGEST.run    the latest state of the run of one question
//! ```
//!
//! The digest is that of the question and of this build of the program, so that a run goes on only where it would give
//! the same particles again. The files only save time: one that cannot be used is sampled again.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use impactlab_core::data::list_folder;
use impactlab_study::{ReconstructRequest, StudyError};

/// Name of the folder in the user's data folder.
const FOLDER: &str = "reconstructions";

/// Ending of the files.
const ENDING: &str = "run";

/// Runs that are kept, each of which takes some megabytes.
const MAX_RUNS: usize = 20;

/// The folder of the runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredRuns {
    folder: PathBuf,
}

impl StoredRuns {
    /// The runs in the user's data folder.
    pub fn new(data_folder: &Path) -> Self {
        Self { folder: data_folder.join(FOLDER) }
    }

    /// The file of the run of a question, whether it exists or not.
    ///
    /// # Errors
    /// As [`ReconstructRequest::run_digest`].
    pub fn file_of(&self, request: &ReconstructRequest) -> Result<PathBuf, StudyError> {
        let digest = request.run_digest()?;
        Ok(self.folder.join(digest).with_extension(ENDING))
    }

    /// Whether the run of a question is kept.
    pub fn holds(&self, request: &ReconstructRequest) -> bool {
        self.file_of(request).is_ok_and(|path| path.exists())
    }

    /// The question with its run, of which the oldest ones make room for it.
    ///
    /// # Errors
    /// As [`ReconstructRequest::run_digest`].
    pub fn resumed(&self, request: &ReconstructRequest) -> Result<ReconstructRequest, StudyError> {
        let path = self.file_of(request)?;
        // Where the folder cannot be made, sampling says so when it writes its first state.
        let _ = std::fs::create_dir_all(&self.folder);
        self.make_room(&path);
        Ok(ReconstructRequest { checkpoint: Some(path), resume: true, ..request.clone() })
    }

    /// Removes the oldest runs beyond the number that is kept.
    fn make_room(&self, needed: &Path) {
        let paths = list_folder(&self.folder).unwrap_or_default();
        let is_other =
            |path: &PathBuf| path.extension().is_some_and(|of| of == ENDING) && path != needed;
        let date = |path: &PathBuf| path.metadata().and_then(|of| of.modified()).ok();
        let mut dated: Vec<(Option<SystemTime>, PathBuf)> =
            paths.into_iter().filter(is_other).map(|path| (date(&path), path)).collect();
        dated.sort();
        let surplus = (dated.len() + 1).saturating_sub(MAX_RUNS);
        for (_, path) in dated.into_iter().take(surplus) {
            // A file that stays costs nothing but its place.
            let _ = std::fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_study::EvidenceChoice;

    #[test]
    fn the_oldest_runs_make_room_and_nothing_else_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let runs = StoredRuns::new(folder.path());
        std::fs::create_dir_all(&runs.folder).unwrap();
        let write = |name: String, age_s: u64| {
            let file = std::fs::File::create(runs.folder.join(name)).unwrap();
            let date = SystemTime::now() - std::time::Duration::from_secs(age_s);
            file.set_modified(date).unwrap();
        };
        (0..25).for_each(|idx| write(format!("{idx}.{ENDING}"), 1000 + idx));
        write("notes.txt".to_owned(), 9000);
        let needed = runs.folder.join(format!("24.{ENDING}"));
        runs.make_room(&needed);
        let left = list_folder(&runs.folder).unwrap();
        assert_eq!(left.len(), MAX_RUNS + 1, "{left:?}");
        assert!(needed.exists() && runs.folder.join("notes.txt").exists());
        assert!(runs.folder.join("0.run").exists() && !runs.folder.join("23.run").exists());
    }

    #[test]
    fn evidence_that_cannot_be_read_has_no_run() {
        let folder = tempfile::tempdir().unwrap();
        let missing = EvidenceChoice::File(folder.path().join("none.toml"));
        assert!(!StoredRuns::new(folder.path()).holds(&ReconstructRequest::new(missing)));
    }
}
