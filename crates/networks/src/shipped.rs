//! The trained networks and the notices of third parties that are part of the program, so that it
//! works in any folder.
//!
//! A [`ModelSource`] names a model: one of the words `shipped` and `shipped-pretrained`, or the
//! path of a file. A file whose name is such a word is named with its folder, as `./shipped`.
//!
//! Vehicles and scenarios that are part of the program are defined with their types:
//! [`Preset`](impactlab_core::vehicle::Preset), [`SCENARIO_PRESETS`](impactlab_core::collision::SCENARIO_PRESETS).

use std::ffi::OsString;
use std::fmt::{self, Display};
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::{ForceError, ForceModel};
use crate::learning::{LearningError, ModelFile};
use crate::response::ResponseModel;
use impactlab_core::numerics::sha256_hex;

/// The word for the trained model that is part of the program.
const SHIPPED: &str = "shipped";

/// The word for the response network that is part of the program, before any fine-tuning.
const SHIPPED_PRETRAINED: &str = "shipped-pretrained";

/// The notices of third parties: crates and fonts that are part of the program, who has their
/// copyright, and the texts of their licences.
pub const LICENCES: &str = include_str!("../../../assets/licences.txt");

const FORCE_MODEL: &[u8] = include_bytes!("../../../assets/models/force.safetensors");
const RESPONSE_MODEL: &[u8] = include_bytes!("../../../assets/models/response.safetensors");
const PRETRAINED_RESPONSE_MODEL: &[u8] =
    include_bytes!("../../../assets/models/response_pretrained.safetensors");

/// The source of a model. In text and files it is written as its word or as the path of its file.
#[derive(
    Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(from = "PathBuf", into = "PathBuf")]
pub enum ModelSource {
    /// The trained model that is part of the program, written `shipped`.
    #[default]
    Shipped,
    /// The response network that is part of the program, pre-trained on simulations and not yet
    /// fine-tuned, written `shipped-pretrained`. There is no force network of this kind: loading it
    /// as one fails.
    ShippedPretrained,
    /// The model in a file.
    File(PathBuf),
}

impl ModelSource {
    /// Loads the force network.
    ///
    /// # Errors
    /// [`ForceError`] if the file cannot be read or is not a force network, which is always the
    /// case for [`ModelSource::ShippedPretrained`].
    pub fn force_model(&self) -> Result<ForceModel, ForceError> {
        Ok(self.force_model_with_digest()?.0)
    }

    /// Loads the force network and returns it with the SHA-256 of its file, hexadecimal.
    ///
    /// # Errors
    /// As for [`ModelSource::force_model`].
    pub fn force_model_with_digest(&self) -> Result<(ForceModel, String), ForceError> {
        self.load(FORCE_MODEL)
    }

    /// Loads the response network.
    ///
    /// # Errors
    /// [`LearningError`] if the file cannot be read or is not a response network.
    pub fn response_model(&self) -> Result<ResponseModel, LearningError> {
        Ok(self.response_model_with_digest()?.0)
    }

    /// Loads the response network and returns it with the SHA-256 of its file, hexadecimal.
    ///
    /// # Errors
    /// As for [`ModelSource::response_model`].
    pub fn response_model_with_digest(&self) -> Result<(ResponseModel, String), LearningError> {
        self.load(RESPONSE_MODEL)
    }

    /// Loads a network of either kind.
    ///
    /// - `shipped`: the file of the one that is part of the program.
    fn load<M: ModelFile>(&self, shipped: &[u8]) -> Result<(M, String), M::Error> {
        let bytes = match self {
            Self::Shipped => shipped,
            Self::ShippedPretrained => PRETRAINED_RESPONSE_MODEL,
            Self::File(path) => return M::load_with_digest(path),
        };
        Ok((M::from_bytes(bytes)?, sha256_hex([bytes])))
    }

    /// The word of a model that is part of the program, or the path of a file.
    pub fn path(&self) -> &Path {
        match self {
            Self::Shipped => Path::new(SHIPPED),
            Self::ShippedPretrained => Path::new(SHIPPED_PRETRAINED),
            Self::File(path) => path,
        }
    }
}

impl Display for ModelSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.path().display().fmt(f)
    }
}

impl From<PathBuf> for ModelSource {
    fn from(path: PathBuf) -> Self {
        match path.to_str() {
            Some(SHIPPED) => Self::Shipped,
            Some(SHIPPED_PRETRAINED) => Self::ShippedPretrained,
            _ => Self::File(path),
        }
    }
}

impl From<OsString> for ModelSource {
    fn from(argument: OsString) -> Self {
        PathBuf::from(argument).into()
    }
}

impl From<ModelSource> for PathBuf {
    fn from(source: ModelSource) -> Self {
        source.path().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> ModelSource {
        PathBuf::from(text).into()
    }

    #[test]
    fn words_are_shipped_models_and_all_else_is_a_file() {
        assert_eq!(source("shipped"), ModelSource::Shipped);
        assert_eq!(source("shipped-pretrained"), ModelSource::ShippedPretrained);
        assert_eq!(source("./shipped"), ModelSource::File("./shipped".into()));
        for text in ["shipped", "shipped-pretrained", "my/model.safetensors"] {
            assert_eq!(source(text).to_string(), text);
            let json = serde_json::to_string(&source(text)).unwrap();
            assert_eq!(json, format!("{text:?}"));
            assert_eq!(serde_json::from_str::<ModelSource>(&json).unwrap(), source(text));
        }
    }

    #[test]
    fn every_shipped_model_is_the_one_of_its_file() {
        let file = |name: &str| {
            source(&format!(
                "{}/../../assets/models/{name}.safetensors",
                env!("CARGO_MANIFEST_DIR")
            ))
        };
        let of_file = file("force").force_model().unwrap();
        let embedded = ModelSource::Shipped.force_model().unwrap();
        assert_eq!(embedded.record().data_digest, of_file.record().data_digest);
        for (shipped, name) in
            [("shipped", "response"), ("shipped-pretrained", "response_pretrained")]
        {
            let of_file = file(name).response_model().unwrap();
            let embedded = source(shipped).response_model().unwrap();
            assert_eq!(embedded.n_parameters(), of_file.n_parameters(), "{name}");
            assert_eq!(embedded.record().train.len(), of_file.record().train.len(), "{name}");
        }
    }

    #[test]
    fn a_response_network_is_no_force_network() {
        let text =
            impactlab_core::error_chain(&ModelSource::ShippedPretrained.force_model().unwrap_err());
        assert!(text.contains("response network"), "{text}");
    }
}
