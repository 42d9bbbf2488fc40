//! Trained models as files.

use std::path::Path;

use crate::data::Existing;
use crate::learning::LearningError;
use crate::nn::{Checkpoint, ModelKind};

/// A trained model that files hold.
pub trait ModelFile: Sized {
    /// What its files say they hold, see [`kind_of_file`](crate::nn::kind_of_file).
    const KIND: ModelKind;

    /// What can go wrong with a model.
    type Error: From<LearningError>;

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

    /// Reads a model.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn load(path: &Path) -> Result<Self, Self::Error> {
        taken(Checkpoint::read(path, Self::KIND).map_err(LearningError::from)?)
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
