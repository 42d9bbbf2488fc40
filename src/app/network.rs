//! The two networks, where the app treats them alike.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error_chain;
use crate::force::ForceModel;
use crate::learning::{EpochRecord, EpochSummary, ModelFile};
use crate::response::ResponseModel;
use crate::shipped::ModelSource;

/// One of the two.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Network {
    /// Scenario to impact force.
    #[default]
    Force,
    /// Impact force to motion.
    Response,
}

impl Network {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Force, Self::Response];

    /// In a sentence: “force model”.
    pub fn model(self) -> &'static str {
        match self {
            Self::Force => "force model",
            Self::Response => "response model",
        }
    }

    /// As a choice.
    pub fn label(self) -> &'static str {
        match self {
            Self::Force => "Force network",
            Self::Response => "Response network",
        }
    }

    /// What a file with such a model is called at first.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Force => "force.safetensors",
            Self::Response => "response.safetensors",
        }
    }
}

/// A model that files hold and trainings make.
pub trait TrainedModel: Sized + Send + Sync + 'static {
    /// Of which network.
    const NETWORK: Network;

    /// Reads the model of a file, or the one that comes with the program.
    ///
    /// # Errors
    /// A message for the user.
    fn read(source: &ModelSource) -> Result<Self, String>;

    /// # Errors
    /// A message for the user.
    fn write(&self, path: &Path) -> Result<(), String>;

    /// What the data that it learned from were called.
    fn data(&self) -> &str;

    /// Every epoch of its training.
    fn history(&self) -> Vec<EpochSummary>;

    /// The epoch whose weights it has, where that is not the last one.
    fn best_epoch(&self) -> Option<usize>;
}

impl TrainedModel for ForceModel {
    const NETWORK: Network = Network::Force;

    fn read(source: &ModelSource) -> Result<Self, String> {
        source.force_model().map_err(|error| error_chain(&error))
    }

    fn write(&self, path: &Path) -> Result<(), String> {
        self.save(path).map_err(|error| error_chain(&error))
    }

    fn data(&self) -> &str {
        &self.record().data
    }

    fn history(&self) -> Vec<EpochSummary> {
        self.record().history.iter().map(EpochRecord::summary).collect()
    }

    fn best_epoch(&self) -> Option<usize> {
        Some(self.record().detail.best_epoch)
    }
}

impl TrainedModel for ResponseModel {
    const NETWORK: Network = Network::Response;

    fn read(source: &ModelSource) -> Result<Self, String> {
        source.response_model().map_err(|error| error_chain(&error))
    }

    fn write(&self, path: &Path) -> Result<(), String> {
        self.save(path).map_err(|error| error_chain(&error))
    }

    fn data(&self) -> &str {
        &self.record().data
    }

    fn history(&self) -> Vec<EpochSummary> {
        self.record().history.iter().map(EpochRecord::summary).collect()
    }

    fn best_epoch(&self) -> Option<usize> {
        None
    }
}
