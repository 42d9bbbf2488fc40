//! Where an answer comes from: what makes it possible to ask again and get the same.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::StudyError;
use impactlab_core::data::write::ModelDigest;
use impactlab_core::program;
use impactlab_networks::learning::ModelFile;

/// What digests call a force network.
pub(crate) const FORCE_NETWORK: &str = "force";

/// What digests call a response network.
pub(crate) const RESPONSE_NETWORK: &str = "response";

/// What a digest calls a network that the answer itself brings forth.
const TRAINED: &str = "trained";

/// Version of the program, seed and trained networks of an answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Version of the program that answered, [`program::version`].
    pub version: Cow<'static, str>,
    /// The seed of all draws, where there are any and the report does not have it elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The trained networks that answered, or that were trained, by the content of their files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub model_digests: Vec<ModelDigest>,
}

impl Default for Provenance {
    /// An answer of this program without draws and networks.
    fn default() -> Self {
        Self { version: program::version().into(), seed: None, model_digests: Vec::new() }
    }
}

impl Provenance {
    /// An answer with draws.
    pub(crate) fn from_seed(seed: u64) -> Self {
        Self { seed: Some(seed), ..Self::default() }
    }

    /// The same with trained networks.
    pub(crate) fn with_models(self, models: impl IntoIterator<Item = ModelDigest>) -> Self {
        Self { model_digests: models.into_iter().collect(), ..self }
    }

    /// The same with a network that was just trained.
    pub(crate) fn with_trained<M: ModelFile>(
        mut self,
        network: &'static str,
        model: &M,
    ) -> Result<Self, StudyError>
    where
        StudyError: From<M::Error>,
    {
        let (name, sha256) = (TRAINED.to_owned(), model.sha256()?);
        self.model_digests.push(ModelDigest { network: network.into(), name, sha256 });
        Ok(self)
    }
}
