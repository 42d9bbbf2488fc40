//! What one answer contributes to the sections of a report.

use std::collections::BTreeSet;

use crate::figure::Figure;
use crate::report::method::Method;
use crate::report::opinion::PartOpinion;
use crate::report::{Block, InputClass, PictureContent};
use crate::scene::SceneStill;
use impactlab_core::uncertainty::Caveats;

/// A picture before it has a number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PartPicture {
    /// What it shows.
    pub caption: String,
    /// What is drawn.
    pub content: PictureContent,
}

impl PartPicture {
    /// Curves over axes.
    pub fn figure(caption: String, figure: Figure) -> Self {
        Self { caption, content: PictureContent::Figure(Box::new(figure)) }
    }

    /// Cars on the ground at a moment.
    pub fn still(caption: String, still: SceneStill) -> Self {
        Self { caption, content: PictureContent::Scene(still) }
    }
}

/// A value that an answer rests on.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct InputRow {
    /// What it belongs to, such as the struck car.
    pub group: String,
    /// What it is.
    pub label: String,
    /// The value with its unit.
    pub value: String,
    /// Where it comes from.
    pub class: InputClass,
    /// Source and uncertainty.
    pub source: String,
}

/// A line of the table of provenance.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct PartProvenance {
    /// Version of the program that answered.
    pub version: String,
    /// Seeds and numbers of draws.
    pub seeds: Vec<String>,
}

/// What one answer contributes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Part {
    /// Kind of question.
    pub kind: String,
    /// Heading: kind of question and name of the collision.
    pub title: String,
    /// What it says on the first pages; none for an answer that no opinion is given on.
    pub opinion: Option<PartOpinion>,
    /// The question and its answer.
    pub answer: Vec<Block>,
    /// Of these what is left out where the impact and the force of the same collision are questions of
    /// their own.
    pub of_first_force: Vec<Block>,
    /// Of these what the opinion has, if this answer speaks for its variant.
    pub in_opinion: Vec<Block>,
    /// Scenes and curves.
    pub pictures: Vec<PartPicture>,
    /// What it rests on.
    pub inputs: Vec<InputRow>,
    /// What was found and how well it is explained.
    pub evidence: Vec<Block>,
    /// What it depends on.
    pub sensitivity: Vec<Block>,
    /// How far models apply, a sentence each.
    pub domain: Vec<String>,
    /// What restricts it and what it rests on.
    pub caveats: Caveats,
    /// Where it comes from.
    pub provenance: PartProvenance,
    /// By what it was computed.
    pub methods: BTreeSet<Method>,
}
