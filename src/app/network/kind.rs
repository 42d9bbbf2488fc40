//! Which of the two networks something is about.

use serde::{Deserialize, Serialize};

/// One of the two networks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Network {
    /// The force network, which predicts the impact force from the collision.
    #[default]
    Force,
    /// The response network, which predicts the motion of the struck vehicle from the impact force.
    Response,
}

impl Network {
    /// Both networks.
    pub const ALL: [Self; 2] = [Self::Force, Self::Response];

    /// Returns the name of a model of this network for use in a sentence, such as “force model”.
    pub fn model(self) -> &'static str {
        match self {
            Self::Force => "force model",
            Self::Response => "response model",
        }
    }

    /// Returns the name of the network for headings and lists.
    pub fn label(self) -> &'static str {
        match self {
            Self::Force => "Force network",
            Self::Response => "Response network",
        }
    }

    /// Returns the name without ending that is proposed for a file with a model of this network.
    pub fn stem(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Response => "response",
        }
    }
}
