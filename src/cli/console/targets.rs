//! What a command is going to write, and what it has read by then: a file that is read is never
//! replaced, and a folder of results says what they were made from.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::cli::CliError;
use impactlab_core::data::write::{FileDigest, MANIFEST_FILE, RunRecord, check_inputs};
use impactlab_core::data::{Existing, check_target};
use impactlab_study::{Provenance, Request};

/// The files that a command will write, and what it has asked and read since.
#[derive(Debug, Default)]
pub(in crate::cli) struct Targets {
    files: Vec<PathBuf>,
    has_folder: bool,
    /// How the files of a folder came about, as far as it is known.
    record: RunRecord,
    /// Everything that was read for the folder.
    read: Vec<PathBuf>,
    /// What the question was made from, which does not name it any more.
    made_from: Vec<PathBuf>,
    /// The files whose content stands in the record.
    digested: HashSet<PathBuf>,
}

impl Targets {
    /// Adds a file, and says what stands in its way.
    pub(super) fn add(&mut self, path: &Path, existing: Existing) -> Result<(), CliError> {
        self.add_unchecked(path);
        Ok(check_target(path, existing)?)
    }

    /// Adds a file of which the question that writes it sees itself whether it can be written.
    pub(super) fn add_unchecked(&mut self, path: &Path) {
        self.files.push(path.to_owned());
    }

    /// Says that there will be a folder of results, whose manifest has what is asked from now on.
    pub(super) fn expect_folder(&mut self) {
        self.has_folder = true;
        let inputs = self.made_from.clone();
        self.digest(&inputs);
        self.read.extend(inputs);
    }

    /// Takes files of which a question was made before there was a folder.
    ///
    /// # Errors
    /// Where one of them will be written.
    pub(super) fn make_from(&mut self, inputs: &[PathBuf]) -> Result<(), CliError> {
        self.made_from.extend_from_slice(inputs);
        self.read(inputs)
    }

    /// The files that a question was made from.
    pub(super) fn made_from(&self) -> &[PathBuf] {
        &self.made_from
    }

    /// Takes a question that is about to be asked. Of several the last one stands in a manifest, since
    /// it holds those before it.
    ///
    /// # Errors
    /// Where a file that it reads is one of those that will be written.
    pub(super) fn ask(&mut self, request: &Request) -> Result<(), CliError> {
        self.refuse(&request.files_read())?;
        if self.has_folder {
            self.record.request = serde_json::to_value(request).map_err(CliError::NotUnicode)?;
            self.read.extend(request.files_read());
            self.digest(&request.input_files());
        }
        Ok(())
    }

    /// Takes files that are about to be read.
    ///
    /// # Errors
    /// Where one of them will be written.
    pub(super) fn read(&mut self, inputs: &[PathBuf]) -> Result<(), CliError> {
        self.refuse(inputs)?;
        if self.has_folder {
            self.read.extend_from_slice(inputs);
            self.digest(inputs);
        }
        Ok(())
    }

    /// Takes seed and networks of an answer into the manifest.
    pub(super) fn answered(&mut self, provenance: &Provenance) {
        self.record.seed = provenance.seed.or(self.record.seed);
        let of = provenance.model_digests.iter();
        let new: Vec<_> = of.filter(|of| !self.record.models.contains(of)).cloned().collect();
        self.record.models.extend(new);
    }

    /// How the files of a folder came about, and everything that was read for them.
    pub(super) fn run_record(&self) -> (RunRecord, Vec<PathBuf>) {
        let command = std::env::args_os().map(|arg| arg.to_string_lossy().into_owned()).collect();
        (RunRecord { command, ..self.record.clone() }, self.read.clone())
    }

    /// Checks that no file is one of the results in a folder, which is there by now.
    ///
    /// - `known`: names of the results beside the manifest.
    ///
    /// # Errors
    /// [`CliError::IsResult`].
    pub(super) fn refuse_results(&self, folder: &Path, known: &[&str]) -> Result<(), CliError> {
        let place = |path: &Path| {
            let path = std::path::absolute(path).ok()?;
            Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?))
        };
        let names = known.iter().copied().chain([MANIFEST_FILE]);
        let results: Vec<PathBuf> = names.filter_map(|name| place(&folder.join(name))).collect();
        let is_result = |path: &&PathBuf| place(path).is_some_and(|path| results.contains(&path));
        match self.files.iter().find(is_result) {
            None => Ok(()),
            Some(path) => Err(CliError::IsResult { path: path.clone() }),
        }
    }

    fn refuse(&self, inputs: &[PathBuf]) -> Result<(), CliError> {
        Ok(self.files.iter().try_for_each(|target| check_inputs(target, inputs))?)
    }

    /// Adds the content of files. One that cannot be read is left out: the question that names it says
    /// why.
    fn digest(&mut self, files: &[PathBuf]) {
        for path in files.iter().filter(|path| self.digested.insert((*path).clone())) {
            let digest = FileDigest::from_file(path.to_string_lossy(), path).ok();
            self.record.inputs.extend(digest);
        }
    }
}
