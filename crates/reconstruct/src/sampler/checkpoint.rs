//! A run of the sampler on disk, so that it survives being killed.
//!
//! ```text
//! 64 characters: SHA-256 of what follows, hexadecimal | the run, CBOR
//! ```

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::population::Population;
use super::{SamplerError, SamplerSettings};
use impactlab_core::data::write::WriterLock;
use impactlab_core::data::{Existing, read_bytes, write_atomically};
use impactlab_core::numerics::sha256_hex;
use impactlab_core::program;

/// Largest checkpoint that is read, bytes: many times that of the longest run.
const MAX_BYTES: u64 = 1 << 30;

/// The file that a run is saved in every now and then.
#[derive(Debug, Clone, PartialEq)]
pub struct SamplerCheckpoint {
    /// The file. It is replaced.
    pub path: PathBuf,
    /// Digest of all that the likelihood is made from, such as evidence, priors and models. Only a
    /// run of the same digest and settings goes on from the file.
    pub digest: String,
    /// Whether to go on from the file if it exists.
    pub resume: bool,
}

/// The content of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved<S> {
    kind: String,
    version: String,
    digest: String,
    settings: SamplerSettings,
    state: S,
}

/// What the file says that it is.
const KIND: &str = "impactlab reconstruction 4";

/// Length of the checksum at the beginning of the file.
const CHECKSUM_BYTES: usize = 64;

impl SamplerCheckpoint {
    /// Takes the right to write the file, for as long as the result is held.
    pub(super) fn claim(&self) -> Result<WriterLock, SamplerError> {
        Ok(WriterLock::claim_checkpoint(&self.path)?)
    }

    /// The state of the saved run, if it is to be resumed and there is one.
    ///
    /// - `dim`: number of variables of the target.
    pub(super) fn read(
        &self,
        settings: &SamplerSettings,
        dim: usize,
    ) -> Result<Option<Population>, SamplerError> {
        if !(self.resume && self.path.exists()) {
            return Ok(None);
        }
        let bytes = read_bytes(&self.path, MAX_BYTES)?;
        let bad = |reason: String| SamplerError::Checkpoint { path: self.path.clone(), reason };
        let content = unsealed(&bytes).map_err(|reason| bad(reason.to_owned()))?;
        let saved: Saved<Population> =
            ciborium::from_reader(content).map_err(|error| bad(error.to_string()))?;
        let differs = [
            ("kind", saved.kind != KIND),
            ("version of the program", saved.version != program::version()),
            ("question", saved.digest != self.digest),
            ("seed", saved.settings.seed != settings.seed),
            ("setting of the sampler", saved.settings != *settings),
        ];
        if let Some((what, _)) = differs.into_iter().find(|(_, differs)| *differs) {
            return Err(SamplerError::OtherRun { path: self.path.clone(), what });
        }
        saved.state.check(dim).map_err(|reason| bad(reason.to_owned()))?;
        Ok(Some(saved.state))
    }

    /// Saves the state of a run, whole or not at all.
    pub(super) fn write(
        &self,
        settings: &SamplerSettings,
        state: &Population,
    ) -> Result<(), SamplerError> {
        let saved = Saved {
            kind: KIND.to_owned(),
            version: program::version().to_owned(),
            digest: self.digest.clone(),
            settings: *settings,
            state,
        };
        write_atomically(&self.path, Existing::Replace, |writer| {
            let mut content = Vec::new();
            ciborium::into_writer(&saved, &mut content).map_err(std::io::Error::other)?;
            writer.write_all(sha256_hex([content.as_slice()]).as_bytes())?;
            writer.write_all(&content)
        })?;
        Ok(())
    }
}

/// What stands behind the checksum, if that fits.
fn unsealed(bytes: &[u8]) -> Result<&[u8], &'static str> {
    let (checksum, content) =
        bytes.split_at_checked(CHECKSUM_BYTES).ok_or("it is shorter than its checksum")?;
    match sha256_hex([content]).as_bytes() == checksum {
        true => Ok(content),
        false => Err("it is damaged: its checksum does not fit"),
    }
}
