//! What one answer contributes to the opinion.

use crate::report::Block;

/// How much of the case an answer decides. Of each variant the answers of the highest rank speak.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::report) enum Rank {
    /// A number by hand.
    Hand,
    /// The way up to the contact.
    Replay,
    /// The impulse alone.
    Impact,
    /// The force over time.
    Force,
    /// One motion.
    Simulation,
    /// The motion with its uncertainty.
    Forecast,
    /// Speeds from what was found.
    Reconstruction,
}

/// What one answer contributes to the opinion.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct PartOpinion {
    /// How much it decides.
    pub rank: Rank,
    /// What was asked, a sentence.
    pub question: String,
    /// What came out, in sentences.
    pub answer: String,
    /// Courses of events with their probabilities, and with the speed in each where speeds are asked for; empty
    /// where there is one only.
    pub courses: Vec<[String; 2]>,
    /// The figures that variants are compared by, with their values.
    pub figures: Vec<[String; 2]>,
    /// How often such intervals held; none where that was not measured.
    pub held: Option<Block>,
    /// Whether it is restricted so that what was counted of others says nothing of it.
    pub is_doubtful: bool,
    /// What the answer hinges on, in sentences.
    pub hinges: Vec<String>,
    /// What this answer left out beside all that its methods do, in sentences.
    pub left_out: Vec<String>,
}
