//! Trained models as files.

use std::error::Error;
use std::path::Path;

use crate::learning::LearningError;
use crate::nn::{Checkpoint, ModelKind};
use impactlab_core::data::Existing;
use impactlab_core::numerics::sha256_hex;

/// A trained model that files hold.
pub trait ModelFile: Sized {
    /// What its files say they hold, see [`kind_of_file`](crate::nn::kind_of_file).
    const KIND: ModelKind;

    /// What can go wrong with a model.
    type Error: From<LearningError> + Error + Send + Sync + 'static;

    /// Puts the model into a file.
    ///
    /// # Errors
    /// A tensor that cannot be copied, or something that cannot be written as JSON.
    fn put(&self, file: &mut Checkpoint) -> Result<(), Self::Error>;

    /// Takes the model out of a file.
    ///
    /// # Errors
    /// What is missing in the file or has another form.
    fn take(file: &mut Checkpoint) -> Result<Self, Self::Error>;

    /// Writes the model, whole or not at all.
    ///
    /// - `existing`: what happens to a file that exists already.
    ///
    /// # Errors
    /// As for [`ModelFile::put`], and the system's if the file cannot be written.
    fn save(&self, path: &Path, existing: Existing) -> Result<(), Self::Error> {
        let mut file = Checkpoint::new(Self::KIND);
        self.put(&mut file)?;
        Ok(file.write(path, existing).map_err(LearningError::from)?)
    }

    /// SHA-256 of the file that [`ModelFile::save`] writes, hexadecimal.
    ///
    /// # Errors
    /// As for [`ModelFile::put`].
    fn sha256(&self) -> Result<String, Self::Error> {
        let mut file = Checkpoint::new(Self::KIND);
        self.put(&mut file)?;
        Ok(sha256_hex([file.to_bytes().map_err(LearningError::from)?.as_slice()]))
    }

    /// Reads a model.
    ///
    /// # Errors
    /// What is wrong with the file, whose name every error states.
    fn load(path: &Path) -> Result<Self, Self::Error> {
        Ok(Self::load_with_digest(path)?.0)
    }

    /// Reads a model, and gives the SHA-256 of its file, hexadecimal.
    ///
    /// # Errors
    /// As for [`ModelFile::load`].
    fn load_with_digest(path: &Path) -> Result<(Self, String), Self::Error> {
        let read = Checkpoint::read_with_digest(path, Self::KIND);
        let (file, sha256) = read.map_err(LearningError::from)?;
        let model = taken::<Self>(file).map_err(|error| {
            let (path, source) = (path.to_owned(), Box::new(error));
            LearningError::InFile { path, what: "a model", source }
        })?;
        Ok((model, sha256))
    }

    /// Takes a model that is part of the program.
    ///
    /// # Errors
    /// As for [`ModelFile::load`].
    fn from_bytes(bytes: &[u8]) -> Result<Self, Self::Error> {
        taken(Checkpoint::from_bytes(bytes, Self::KIND).map_err(LearningError::from)?)
    }
}

fn taken<M: ModelFile>(mut file: Checkpoint) -> Result<M, M::Error> {
    let model = M::take(&mut file)?;
    file.check_all_taken().map_err(LearningError::from)?;
    Ok(model)
}
