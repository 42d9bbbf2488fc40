//! The note of something that is kept: what it is and how it came to be.

use serde::{Deserialize, Serialize};

use crate::app::network::Network;
use crate::app::panes::Pane;
use impactlab_core::units::UnitSystem;
use impactlab_study::Request;
use impactlab_study::facts::{FactTable, FactWriter, Term, TextRow};

/// Version of the format of notes.
pub(super) const VERSION: u32 = 1;

/// What is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArchiveKind {
    /// A model of the force network.
    ForceModel,
    /// A model of the response network.
    ResponseModel,
    /// A comparison of response models.
    Comparison,
    /// An evaluation of a response model.
    ResponseEvaluation,
    /// An evaluation of a force model.
    ForceEvaluation,
}

impl ArchiveKind {
    /// Returns the name for lists and sentences, such as “force model”.
    pub fn label(self) -> &'static str {
        match self {
            Self::ForceModel => "force model",
            Self::ResponseModel => "response model",
            Self::Comparison => "comparison of response models",
            Self::ResponseEvaluation => "evaluation of a response model",
            Self::ForceEvaluation => "evaluation of a force model",
        }
    }

    /// Returns the network of a model; `None` for what is no model.
    pub fn network(self) -> Option<Network> {
        match self {
            Self::ForceModel => Some(Network::Force),
            Self::ResponseModel => Some(Network::Response),
            Self::Comparison | Self::ResponseEvaluation | Self::ForceEvaluation => None,
        }
    }

    /// Returns the pane that shows a comparison or an evaluation; `None` for a model.
    pub fn pane(self) -> Option<Pane> {
        match self {
            Self::ForceModel | Self::ResponseModel => None,
            Self::Comparison | Self::ResponseEvaluation => Some(Pane::ModelComparison),
            Self::ForceEvaluation => Some(Pane::Evaluation),
        }
    }
}

impl From<Network> for ArchiveKind {
    fn from(network: Network) -> Self {
        match network {
            Network::Force => Self::ForceModel,
            Network::Response => Self::ResponseModel,
        }
    }
}

/// A fact as it is stored.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StoredFact {
    /// What it is, such as “cases learned from”.
    pub label: String,
    /// The value with its unit.
    pub text: String,
}

impl StoredFact {
    /// A fact with a label and a value.
    pub fn new(label: impl Into<String>, text: impl ToString) -> Self {
        Self { label: label.into(), text: text.to_string() }
    }

    /// The facts of a table with one column of values.
    pub fn from_table(table: &FactTable) -> Vec<Self> {
        let text = table.to_text(&FactWriter::english(UnitSystem::default()));
        let fact = |row: TextRow| {
            let mut cells = row.cells.into_iter();
            Some(Self { label: cells.next()?, text: cells.next()? })
        };
        text.rows.into_iter().filter_map(fact).collect()
    }

    /// The table of facts.
    pub fn table(title: Term, facts: &[Self]) -> FactTable {
        let facts = facts.iter().map(|fact| (fact.label.as_str(), fact.text.as_str()));
        FactTable::from_texts(title, facts)
    }
}

/// The note of a model, a comparison or an evaluation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArchiveEntry {
    /// Version of the format.
    pub version: u32,
    /// Version of the program that made it.
    pub program: String,
    /// What it is.
    pub kind: ArchiveKind,
    /// What the user calls it.
    pub name: String,
    /// When it was finished: UTC, RFC 3339.
    pub finished: String,
    /// Whether the training was cancelled, so that the model is what had been reached by then.
    pub is_cancelled: bool,
    /// Name of the data.
    pub data: String,
    /// What is known of it in numbers.
    pub figures: Vec<StoredFact>,
    /// The settings that are not the usual ones.
    pub settings: Vec<StoredFact>,
    /// The question that it answers.
    pub question: Request,
    /// SHA-256 of the content, hexadecimal.
    pub sha256: String,
    /// Size of the content, bytes.
    pub bytes: u64,
}

impl ArchiveEntry {
    /// The note of something that is finished now. Its digest and its size are filled in when it is
    /// written.
    pub fn new(kind: ArchiveKind, name: String, data: String, question: Request) -> Self {
        Self {
            version: VERSION,
            program: crate::VERSION.to_owned(),
            kind,
            name,
            finished: humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string(),
            is_cancelled: false,
            data,
            figures: Vec::new(),
            settings: Vec::new(),
            question,
            sha256: String::new(),
            bytes: 0,
        }
    }

    /// When it was finished, for a person: `2026-11-23 10:20 UTC`.
    pub fn finished_text(&self) -> String {
        moment_text(&self.finished)
    }
}

/// A moment as RFC 3339 has it, for a person: `2026-11-23 10:20 UTC`.
pub(in crate::app) fn moment_text(rfc3339: &str) -> String {
    match (rfc3339.get(..10), rfc3339.get(11..16)) {
        (Some(day), Some(time)) => format!("{day} {time} UTC"),
        _ => rfc3339.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_of_a_note_are_shown_as_they_were_stored() {
        let note = r#"[{"label":"Best epoch","text":"3 of 7"}]"#;
        let facts: Vec<StoredFact> = serde_json::from_str(note).unwrap();
        let table = StoredFact::table(Term::Figures, &facts);
        assert_eq!(StoredFact::from_table(&table), facts);
    }
}
