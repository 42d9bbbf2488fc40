//! One file per model: its tensors, and beside them what is needed to use it, as JSON.
//!
//! The file is a safetensors file, which other tools open too. It says what kind of model it is
//! and in which version, and carries a checksum: a single flipped bit is found. The same contents
//! give the same bytes.

use std::io::Read;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::nn::checkpoint_bytes::{LENGTH_BYTES, MAX_HEADER_BYTES, decode, encode, kind_in_header};
use crate::nn::{NamedTensors, NnError};
use impactlab_core::data::{
    DataError, Existing, MAX_MODEL_BYTES, open_file, read_bytes, write_bytes,
};
use impactlab_core::numerics::sha256_hex;

/// What a model file is for, so that none is mistaken for another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModelKind {
    /// Such as `force network`.
    pub name: &'static str,
    /// Rises whenever the meaning of tensors or metadata changes.
    pub version: u32,
}

/// The contents of a model file.
#[derive(Debug, Clone)]
pub struct Checkpoint {
    pub(crate) kind: ModelKind,
    pub(crate) metadata: Map<String, Value>,
    pub(crate) tensors: NamedTensors,
}

impl Checkpoint {
    /// Nothing yet.
    pub fn new(kind: ModelKind) -> Self {
        Self { kind, metadata: Map::new(), tensors: NamedTensors::new() }
    }

    /// What kind of model it is.
    pub fn kind(&self) -> ModelKind {
        self.kind
    }

    /// Puts a piece of metadata in, such as the config, seed or hash of the data; replaces an
    /// earlier one of this key. Infinite numbers and NaN become `null`, as JSON has none.
    ///
    /// # Errors
    /// [`NnError::Metadata`] if it cannot be written as JSON.
    pub fn put<T: Serialize>(&mut self, key: &str, value: &T) -> Result<(), NnError> {
        let to_error = |source| NnError::Metadata { key: key.to_owned(), source };
        self.metadata.insert(key.to_owned(), serde_json::to_value(value).map_err(to_error)?);
        Ok(())
    }

    /// The piece of metadata of this key.
    ///
    /// # Errors
    /// [`NnError::MissingMetadata`], [`NnError::Metadata`] if it has another form.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Result<T, NnError> {
        let missing = || NnError::MissingMetadata { key: key.to_owned() };
        let value = self.metadata.get(key).ok_or_else(missing)?;
        let to_error = |source| NnError::Metadata { key: key.to_owned(), source };
        T::deserialize(value).map_err(to_error)
    }

    /// The piece of metadata of this key, if the file has it.
    ///
    /// # Errors
    /// [`NnError::Metadata`] if it has another form.
    pub fn find<T: DeserializeOwned>(&self, key: &str) -> Result<Option<T>, NnError> {
        self.metadata.contains_key(key).then(|| self.get(key)).transpose()
    }

    /// Puts tensors of 32 or 64 bits in, named `group.NAME`.
    pub fn put_group(&mut self, group: &str, tensors: NamedTensors) {
        let named = tensors.into_iter().map(|(name, tensor)| (format!("{group}.{name}"), tensor));
        self.tensors.extend(named);
    }

    /// Takes the tensors named `group.NAME` out.
    pub fn take_group(&mut self, group: &str) -> NamedTensors {
        let prefix = format!("{group}.");
        let all = std::mem::take(&mut self.tensors);
        let (taken, left): (NamedTensors, _) =
            all.into_iter().partition(|(name, _)| name.starts_with(&prefix));
        self.tensors = left;
        taken.into_iter().map(|(name, tensor)| (name[prefix.len()..].to_owned(), tensor)).collect()
    }

    /// To be called when all groups that the model knows are taken.
    ///
    /// # Errors
    /// [`NnError::UnexpectedTensor`] with the first that was not.
    pub fn check_all_taken(&self) -> Result<(), NnError> {
        match self.tensors.keys().next() {
            None => Ok(()),
            Some(name) => Err(NnError::UnexpectedTensor { name: name.clone() }),
        }
    }

    /// Writes the file whole or not at all.
    ///
    /// - `existing`: what happens to a file that exists already.
    ///
    /// # Errors
    /// [`NnError::File`] with the system's reason, [`NnError::NumberType`],
    /// [`NnError::EmptyTensor`], [`NnError::NonFinite`] with the first tensor that is not to be
    /// saved.
    pub fn write(&self, path: &Path, existing: Existing) -> Result<(), NnError> {
        let bytes = self.to_bytes()?;
        Ok(write_bytes(path, existing, &bytes)?)
    }

    /// The contents of the file that [`Checkpoint::write`] writes.
    ///
    /// # Errors
    /// As within [`Checkpoint::write`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, NnError> {
        encode(self)
    }

    /// Reads a file that [`Checkpoint::write`] wrote.
    ///
    /// # Errors
    /// [`NnError::File`] if it cannot be read, [`NnError::InFile`] with the reason if it is damaged
    /// or holds something else.
    pub fn read(path: &Path, kind: ModelKind) -> Result<Self, NnError> {
        Ok(Self::read_with_digest(path, kind)?.0)
    }

    /// Reads such a file, and gives the SHA-256 of the bytes that were read, hexadecimal.
    ///
    /// # Errors
    /// As for [`Checkpoint::read`].
    pub fn read_with_digest(path: &Path, kind: ModelKind) -> Result<(Self, String), NnError> {
        let bytes = read_bytes(path, MAX_MODEL_BYTES)?;
        let in_file = |source| NnError::InFile { path: path.to_owned(), source: Box::new(source) };
        let file = Self::from_bytes(&bytes, kind).map_err(in_file)?;
        Ok((file, sha256_hex([bytes.as_slice()])))
    }

    /// Takes the contents of such a file.
    ///
    /// # Errors
    /// As within [`Checkpoint::read`], without the name of the file.
    pub fn from_bytes(bytes: &[u8], kind: ModelKind) -> Result<Self, NnError> {
        match bytes.len() as u64 {
            n if n > MAX_MODEL_BYTES => Err(NnError::TooLarge { bytes: n, limit: MAX_MODEL_BYTES }),
            _ => decode(bytes, kind),
        }
    }
}

/// What kind of model a file says it holds; only its header is read, and no checksum.
///
/// # Errors
/// As for [`Checkpoint::read`].
pub fn kind_of_file(path: &Path) -> Result<String, NnError> {
    let to_error = |source| DataError::io(path, source);
    let (file, _) = open_file(path, MAX_MODEL_BYTES)?;
    let mut bytes = Vec::new();
    file.take(LENGTH_BYTES as u64 + MAX_HEADER_BYTES).read_to_end(&mut bytes).map_err(to_error)?;
    let in_file = |source| NnError::InFile { path: path.to_owned(), source: Box::new(source) };
    kind_in_header(&bytes).map_err(in_file)
}
