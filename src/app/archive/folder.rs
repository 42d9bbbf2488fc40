//! The folders in which models, comparisons and evaluations are kept, and their files.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::app::archive::entry::VERSION;
use crate::app::archive::{ArchiveEntry, ArchiveError, ArchiveKind};
use impactlab_core::data::write::FileDigest;
use impactlab_core::data::{Existing, MAX_RESULTS_BYTES, list_folder, read_bytes, write_bytes};
use impactlab_study::MODEL_ENDING;

/// The ending of notes.
pub const NOTE_ENDING: &str = "note";

/// The ending of comparisons and evaluations.
const RESULT_ENDING: &str = "json";

/// The user's data folder, in which results are kept.
#[derive(Debug, Clone)]
pub struct ArchiveFolder(PathBuf);

/// What is kept.
#[derive(Debug, Clone, Default)]
pub struct ArchiveList {
    /// Everything that is whole, the latest first.
    pub entries: Vec<ArchiveEntry>,
    /// What cannot be used, and why.
    pub problems: Vec<ArchiveProblem>,
}

/// A file that was kept and cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ArchiveProblem {
    /// The files that belong together and are useless.
    pub files: Vec<PathBuf>,
    /// What is wrong, with the name of the file.
    pub reason: String,
}

/// The version of a note.
#[derive(Deserialize)]
struct NoteVersion {
    version: u32,
}

impl ArchiveFolder {
    /// The folders in the user's data folder.
    pub fn new(data_folder: PathBuf) -> Self {
        Self(data_folder)
    }

    /// Returns the file with the content of an entry.
    pub fn path_of(&self, entry: &ArchiveEntry) -> PathBuf {
        self.content(entry.kind, &entry.sha256)
    }

    fn content(&self, kind: ArchiveKind, sha256: &str) -> PathBuf {
        let (folder, ending) = match kind.network() {
            Some(_) => ("models", MODEL_ENDING),
            None => ("comparisons", RESULT_ENDING),
        };
        self.0.join(folder).join(format!("{sha256}.{ending}"))
    }

    /// Keeps something. If the same content is kept already, it keeps its name and its date; a
    /// model that was kept of a cancelled training takes those of a completed one.
    ///
    /// - `draft`: its note, with the digest of the content;
    /// - `write`: writes the content to a file.
    ///
    /// # Errors
    /// [`ArchiveError`] if a file cannot be written.
    pub fn put(
        &self,
        draft: ArchiveEntry,
        write: impl FnOnce(&Path) -> Result<(), ArchiveError>,
    ) -> Result<ArchiveEntry, ArchiveError> {
        let path = self.path_of(&draft);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(ArchiveError::io(folder))?;
        }
        let before = self.read_note(&path.with_extension(NOTE_ENDING));
        match before {
            Ok(before) if before.is_cancelled == draft.is_cancelled || draft.is_cancelled => {
                return Ok(before);
            }
            _ => {}
        }
        write(&path)?;
        let bytes = fs::metadata(&path).map_err(ArchiveError::io(&path))?.len();
        let entry = ArchiveEntry { bytes, ..draft };
        self.write_note(&entry)?;
        Ok(entry)
    }

    fn write_note(&self, entry: &ArchiveEntry) -> Result<(), ArchiveError> {
        let path = self.path_of(entry).with_extension(NOTE_ENDING);
        let text = serde_json::to_string_pretty(entry)
            .map_err(|error| ArchiveError::Content(error.to_string()))?;
        Ok(write_bytes(&path, Existing::Replace, text.as_bytes())?)
    }

    /// Gives something another name.
    ///
    /// # Errors
    /// [`ArchiveError`] if its note cannot be written.
    pub fn rename(&self, entry: ArchiveEntry, name: String) -> Result<ArchiveEntry, ArchiveError> {
        let renamed = ArchiveEntry { name, ..entry };
        self.write_note(&renamed)?;
        Ok(renamed)
    }

    /// Reads the content of something and checks its digest.
    ///
    /// # Errors
    /// [`ArchiveError`] if it cannot be read or is not what was kept.
    pub fn read_content(&self, entry: &ArchiveEntry) -> Result<Vec<u8>, ArchiveError> {
        self.check_content(entry)?;
        Ok(read_bytes(&self.path_of(entry), MAX_RESULTS_BYTES)?)
    }

    fn check_content(&self, entry: &ArchiveEntry) -> Result<(), ArchiveError> {
        let path = self.path_of(entry);
        let got = FileDigest::from_file("", &path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => ArchiveError::NoContent { path: path.clone() },
            _ => ArchiveError::io(&path)(error),
        })?;
        if got.sha256 != entry.sha256 {
            let (expected, got) = (entry.sha256.clone(), got.sha256);
            return Err(ArchiveError::OtherContent { path, expected, got });
        }
        Ok(())
    }

    /// Reads the note at a path and checks that the content is what was kept.
    fn read_note(&self, path: &Path) -> Result<ArchiveEntry, ArchiveError> {
        let entry = note_at(path)?;
        self.check_content(&entry)?;
        Ok(entry)
    }

    /// Reads all notes, and the content of all files to check that it is what was kept.
    pub fn read(&self) -> ArchiveList {
        let mut list = ArchiveList::default();
        for name in ["models", "comparisons"] {
            let folder = self.0.join(name);
            if folder.symlink_metadata().is_err() {
                continue; // Nothing has been kept yet.
            }
            match list_folder(&folder) {
                Ok(paths) => self.read_folder(paths, &mut list),
                Err(error) => {
                    let problem = ArchiveProblem { files: Vec::new(), reason: error.to_string() };
                    list.problems.push(problem);
                }
            }
        }
        list.entries.sort_by(|a, b| (&b.finished, &a.name).cmp(&(&a.finished, &b.name)));
        list
    }

    fn read_folder(&self, mut paths: Vec<PathBuf>, list: &mut ArchiveList) {
        paths.sort();
        let has_ending = |path: &Path, ending: &str| path.extension().is_some_and(|e| e == ending);
        for path in &paths {
            if has_ending(path, NOTE_ENDING) {
                match self.read_note(path) {
                    Ok(entry) => list.entries.push(entry),
                    Err(error) => {
                        let stem = path.with_extension("");
                        let of_it = |other: &&PathBuf| other.with_extension("") == stem;
                        let files = paths.iter().filter(of_it).cloned().collect();
                        list.problems.push(ArchiveProblem { files, reason: error.to_string() });
                    }
                }
            } else if [MODEL_ENDING, RESULT_ENDING].iter().any(|ending| has_ending(path, ending))
                && !paths.contains(&path.with_extension(NOTE_ENDING))
            {
                let reason = ArchiveError::NoNote { path: path.clone() }.to_string();
                list.problems.push(ArchiveProblem { files: vec![path.clone()], reason });
            }
        }
    }
}

/// Returns the name of the model that is kept in a file; `None` for a file of the user.
pub fn name_of(path: &Path) -> Option<String> {
    Some(note_at(&path.with_extension(NOTE_ENDING)).ok()?.name)
}

fn note_at(path: &Path) -> Result<ArchiveEntry, ArchiveError> {
    let bytes = read_bytes(path, MAX_RESULTS_BYTES)?;
    let damaged = |error: serde_json::Error| ArchiveError::Note {
        path: path.to_owned(),
        line: error.line(),
        column: error.column(),
        reason: error.to_string(),
    };
    let NoteVersion { version } = serde_json::from_slice(&bytes).map_err(damaged)?;
    if version != VERSION {
        let path = path.to_owned();
        return Err(ArchiveError::Version { path, expected: VERSION, got: version });
    }
    serde_json::from_slice(&bytes).map_err(damaged)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::numerics::sha256_hex;
    use impactlab_study::{EvaluateForceRequest, ModelChoice, Request};

    fn draft(content: &[u8], name: &str) -> ArchiveEntry {
        let question = EvaluateForceRequest::new(ModelChoice::default(), "data");
        let entry = ArchiveEntry::new(
            ArchiveKind::ForceEvaluation,
            name.to_owned(),
            "data".to_owned(),
            Request::from(question),
        );
        ArchiveEntry { sha256: sha256_hex([content]), ..entry }
    }

    fn put(folder: &ArchiveFolder, content: &[u8], draft: ArchiveEntry) -> ArchiveEntry {
        let write = |path: &Path| fs::write(path, content).map_err(ArchiveError::io(path));
        folder.put(draft, write).unwrap()
    }

    #[test]
    fn the_same_content_is_kept_once_and_nothing_is_replaced() {
        let root = tempfile::tempdir().unwrap();
        let folder = ArchiveFolder::new(root.path().to_owned());
        assert!(folder.read().entries.is_empty() && folder.read().problems.is_empty());
        let cancelled = ArchiveEntry { is_cancelled: true, ..draft(b"a", "half") };
        put(&folder, b"a", cancelled.clone());
        put(&folder, b"b", draft(b"b", "other"));
        assert_eq!(folder.read().entries.len(), 2);
        // A completed training takes the place of the cancelled one with the same weights, and
        // not the other way round.
        put(&folder, b"a", draft(b"a", "whole"));
        let entry = put(&folder, b"a", cancelled);
        assert_eq!((entry.name.as_str(), entry.is_cancelled), ("whole", false));
        let entry = put(&folder, b"a", draft(b"a", "again"));
        assert_eq!(entry.name, "whole");
        let renamed = folder.rename(entry, "mine".to_owned()).unwrap();
        assert_eq!(name_of(&folder.path_of(&renamed)).as_deref(), Some("mine"));
        assert_eq!(folder.read().entries.len(), 2);
    }

    #[test]
    fn what_is_damaged_is_named_and_hurts_nothing_else() {
        let root = tempfile::tempdir().unwrap();
        let folder = ArchiveFolder::new(root.path().to_owned());
        let whole = put(&folder, b"whole", draft(b"whole", "whole"));
        let reason = |folder: &ArchiveFolder| {
            let list = folder.read();
            assert_eq!(list.entries, std::slice::from_ref(&whole));
            assert_eq!(list.problems.len(), 1, "{:?}", list.problems);
            list.problems[0].clone()
        };
        let other = put(&folder, b"other", draft(b"other", "other"));
        let path = folder.path_of(&other);
        let note = path.with_extension(NOTE_ENDING);
        let text = fs::read_to_string(&note).unwrap();

        fs::write(&path, "tampered").unwrap();
        let problem = reason(&folder);
        assert!(problem.reason.contains("is damaged: its SHA-256 begins with"), "{problem:?}");
        assert_eq!(problem.files.len(), 2);
        fs::write(&path, "other").unwrap();
        fs::write(&note, &text[..text.len() / 2]).unwrap();
        assert!(reason(&folder).reason.contains("the note is damaged"));
        fs::write(&note, text.replace("\"version\": 1", "\"version\": 9")).unwrap();
        assert!(reason(&folder).reason.contains("by a later version"));
        fs::remove_file(&note).unwrap();
        assert!(reason(&folder).reason.contains("has no note"));
        fs::write(&note, &text).unwrap();
        fs::remove_file(&path).unwrap();
        assert!(reason(&folder).reason.contains("only its note is left"));
    }
}
