//! Whether the evidence is of a collision or of a single car.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the evidence is of.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum EvidenceKind {
    /// A car that was struck by another one.
    #[default]
    Collision,
    /// One car that struck nothing: it left marks or came to rest.
    SingleCar,
}

impl EvidenceKind {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Collision, Self::SingleCar];

    /// Its word in a file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Whether it is of a collision.
    pub fn is_collision(&self) -> bool {
        *self == Self::Collision
    }
}
