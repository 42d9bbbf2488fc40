//! What is done: parts of rows in one file, and the physics that rows share, each in a file of its own.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use impactlab_core::data::write::WriterLock;
use impactlab_core::data::{Existing, write_atomically};
use impactlab_networks::force::{CentreCurve, CentreModel};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::judged::JudgedCase;
use crate::{Answer, told};

/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 30;

/// A row of one task, done.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Part {
    /// Name of the row and what the task is called, for a person.
    pub row: String,
    pub task: String,
    /// SHA-256 of all that it depends on but the build.
    pub identity: String,
    /// The build that has computed it.
    pub build: String,
    pub seconds: f64,
    pub cases: Vec<JudgedCase>,
}

/// The physics fitted to the cases of a task.
pub type Physics = (CentreModel, Vec<CentreCurve>);

#[derive(Default, Serialize, Deserialize)]
struct Content {
    parts: Vec<Part>,
}

/// What is done, and where it lies.
pub struct Store {
    folder: PathBuf,
    content: Content,
    takes_other_builds: bool,
    /// Held as long as the store is used.
    _lock: WriterLock,
}

impl Store {
    /// Reads what is done; the folder is made where there is none.
    ///
    /// - `takes_other_builds`: whether what other builds of the program have done counts.
    pub fn open(folder: &Path, takes_other_builds: bool) -> Answer<Self> {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let path = folder.join("rows.json");
        let lock = WriterLock::claim_checkpoint(&path).map_err(told)?;
        let content: Content = read(&path)?.unwrap_or_default();
        let store = Self { folder: folder.to_owned(), content, takes_other_builds, _lock: lock };
        let n_others = store.content.parts.iter().filter(|part| !store.counts(part)).count();
        if n_others > 0 {
            eprintln!("{n_others} parts of other builds do not count (--other-builds)");
        }
        Ok(store)
    }

    fn counts(&self, part: &Part) -> bool {
        self.takes_other_builds || part.build == impactlab::VERSION
    }

    /// The part of an identity; of several the latest.
    pub fn find(&self, identity: &str) -> Option<&Part> {
        let is_it = |part: &&Part| part.identity == identity && self.counts(part);
        self.content.parts.iter().rev().find(is_it)
    }

    /// Adds a part, which is on the disk afterwards.
    pub fn add(&mut self, part: Part) -> Answer<()> {
        self.content.parts.push(part);
        write(&self.folder.join("rows.json"), &self.content)
    }

    /// Where the physics of an identity lies, of this build alone.
    pub fn physics_path(&self, identity: &str) -> PathBuf {
        let build = impactlab::VERSION.rsplit('+').next().unwrap_or_default();
        let name: String = identity.chars().take(16).collect();
        self.folder.join(format!("physics-{build}-{name}.json"))
    }
}

/// The physics of a file; `None` where there is no such file, or not for so many cases.
pub fn read_physics(path: &Path, n_cases: usize) -> Answer<Option<Physics>> {
    let physics: Option<Physics> = read(path)?;
    Ok(physics.filter(|(_, centres)| centres.len() == n_cases))
}

/// Writes physics for the next row that needs them.
pub fn write_physics(path: &Path, physics: &Physics) -> Answer<()> {
    write(path, physics)
}

fn read<T: DeserializeOwned>(path: &Path) -> Answer<Option<T>> {
    let named = |problem: String| format!("{}: {problem}", path.display());
    match fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(named(error.to_string())),
        Ok(found) if !found.is_file() || found.len() > MAX_BYTES => {
            return Err(named(format!("expected a file of at most {MAX_BYTES} bytes")));
        }
        Ok(_) => {}
    }
    let text = fs::read(path).map_err(|error| named(error.to_string()))?;
    serde_json::from_slice(&text).map(Some).map_err(|error| named(error.to_string()))
}

fn write<T: Serialize>(path: &Path, content: &T) -> Answer<()> {
    let written = write_atomically(path, Existing::Replace, |file| {
        serde_json::to_writer(file, content).map_err(io::Error::from)
    });
    written.map_err(told)
}
