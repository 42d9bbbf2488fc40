//! What an output folder holds and how it was made.

use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path};
use std::time::SystemTime;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::write::FileDigest;
use crate::data::write::machine::{replace_strings, without_machine};

/// Name of the manifest in its folder.
pub const MANIFEST_FILE: &str = "manifest.json";

/// What the manifest of every folder says of its maker.
const PROGRAM: &str = "impactlab";

/// The largest manifest of an earlier run that is read, bytes.
const MAX_MANIFEST_BYTES: u64 = 64 << 20;

/// How the files of a folder came about.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct RunRecord {
    /// The command line; empty where the window wrote the folder.
    pub command: Vec<String>,
    /// The question that was answered, as JSON.
    pub request: serde_json::Value,
    /// The seed of all draws, where there are any.
    pub seed: Option<u64>,
    /// The trained networks that answered, by the SHA-256 of their files.
    pub models: Vec<ModelDigest>,
    /// The files that were read.
    pub inputs: Vec<FileDigest>,
}

/// A trained network by the content of its file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ModelDigest {
    /// Which network it is.
    pub network: Cow<'static, str>,
    /// What it was asked for by: a word, a file or what the window calls it.
    pub name: String,
    /// SHA-256 of the file, hexadecimal; of a network that stands in no file yet, of the file that
    /// it would be saved in.
    pub sha256: String,
}

/// What is in `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Manifest {
    /// The program that wrote the folder.
    pub program: &'static str,
    /// Its version.
    pub version: &'static str,
    /// Whether all files are in place; `false` is found only after the program was killed while it
    /// put them there.
    pub complete: bool,
    /// When the work began, RFC 3339 in UTC.
    pub started: String,
    /// How long it took, s.
    pub seconds: f64,
    /// Command, request, seed, models and inputs.
    #[serde(flatten)]
    pub run: RunRecord,
    /// The files in the folder that the run has written, but the manifest.
    pub files: Vec<FileDigest>,
}

impl RunRecord {
    /// The same without what it says of the machine, as a folder of results goes to others.
    fn without_machine(mut self) -> Self {
        let working_folder = std::env::current_dir().ok();
        let named = |text: &str| without_machine(text, working_folder.as_deref());
        let rename = |text: &mut String| {
            if let Some(name) = named(text) {
                *text = name;
            }
        };
        // Where a program lies is not what it is; the version says that.
        self.command.iter_mut().take(1).for_each(|program| *program = PROGRAM.to_owned());
        self.command.iter_mut().skip(1).for_each(rename);
        self.inputs.iter_mut().for_each(|input| rename(&mut input.name));
        self.models.iter_mut().for_each(|model| rename(&mut model.name));
        replace_strings(&mut self.request, &named);
        self
    }
}

impl Manifest {
    /// The manifest of a run that began at `started`.
    pub(super) fn new(run: RunRecord, started: SystemTime, files: Vec<FileDigest>) -> Self {
        Self {
            program: PROGRAM,
            version: crate::program::version(),
            complete: true,
            started: humantime::format_rfc3339_seconds(started).to_string(),
            seconds: started.elapsed().map_or(0.0, |elapsed| elapsed.as_secs_f64()),
            run: run.without_machine(),
            files,
        }
    }
}

/// The part of an earlier run's manifest that says which files are the program's own.
#[derive(Debug, Deserialize)]
struct EarlierManifest {
    program: String,
    files: Vec<FileDigest>,
}

/// The files of an earlier run in a folder; `None` if it has no manifest that this program has
/// written.
///
/// A name that leads out of the folder is no name of ours and is left out.
pub(super) fn earlier_files(folder: &Path) -> Option<Vec<FileDigest>> {
    let path = folder.join(MANIFEST_FILE);
    if !path.symlink_metadata().ok()?.is_file() {
        return None;
    }
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(MAX_MANIFEST_BYTES).read_to_end(&mut bytes).ok()?;
    let mut earlier: EarlierManifest = serde_json::from_slice(&bytes).ok()?;
    earlier.files.retain(|file| is_plain_name(&file.name));
    (earlier.program == PROGRAM).then_some(earlier.files)
}

/// Whether a text is the name of a file in a folder and nothing else.
fn is_plain_name(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!(components.next(), Some(Component::Normal(part)) if part == name)
        && components.next().is_none()
}
