//! How far a predicted force lies from the recorded one, and how honest its spread is.

mod prediction;

mod figures;
mod point;
mod probabilistic;

pub use figures::{Coverage, Figures, ProbabilisticFigures};
pub use point::PointErrors;
pub use prediction::Prediction;
pub use probabilistic::{
    BAND_LEVELS, Covered, N_PIT_BINS, ProbabilisticScores, ProbabilisticSettings,
};
