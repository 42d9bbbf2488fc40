//! How the answers of a report were computed, with the sources.

use std::collections::BTreeSet;

use crate::report::Block;
use crate::report::numbers::Wording;
use impactlab_core::bibliography as sources;

/// By what an answer is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Method {
    /// Planar impact with restitution and friction.
    Impact,
    /// The 4DOF model of the struck vehicle.
    FourDof,
    /// The contact law of two outlines.
    ContactLaw,
    /// The force network.
    ForceNetwork,
    /// The response network.
    ResponseNetwork,
    /// From the evidence to the speeds.
    Reconstruction,
    /// What a data sheet leaves open, by rule.
    DataSheet,
}

impl Method {
    /// What it is called.
    pub fn name(self, wording: &Wording) -> &'static str {
        let words = wording.words;
        match self {
            Self::Impact => words.method_impact,
            Self::FourDof => words.method_four_dof,
            Self::ContactLaw => words.method_contact,
            Self::ForceNetwork => words.method_force,
            Self::ResponseNetwork => words.method_response,
            Self::Reconstruction => words.method_reconstruction,
            Self::DataSheet => words.method_sheet,
        }
    }

    /// How it works, in a paragraph.
    fn text(self, wording: &Wording) -> &'static str {
        let words = wording.words;
        match self {
            Self::Impact => words.method_impact_text,
            Self::FourDof => words.method_four_dof_text,
            Self::ContactLaw => words.method_contact_text,
            Self::ForceNetwork => words.method_force_text,
            Self::ResponseNetwork => words.method_response_text,
            Self::Reconstruction => words.method_reconstruction_text,
            Self::DataSheet => words.method_sheet_text,
        }
    }

    /// What is neglected and how far it holds.
    pub fn limits(self, wording: &Wording) -> &'static str {
        let words = wording.words;
        match self {
            Self::Impact => words.limits_impact,
            Self::FourDof => words.limits_four_dof,
            Self::ContactLaw => words.limits_contact,
            Self::ForceNetwork => words.limits_force,
            Self::ResponseNetwork => words.limits_response,
            Self::Reconstruction => words.limits_reconstruction,
            Self::DataSheet => words.limits_sheet,
        }
    }

    /// Its sources as the program documents them.
    fn sources(self) -> &'static [&'static str] {
        match self {
            Self::Impact => &[
                sources::Kudlich1966::TEXT,
                sources::Slibar1966::TEXT,
                sources::Brach2011::TEXT,
                sources::CarpenterWelcher2019::TEXT,
            ],
            Self::FourDof => &[sources::PitPinnPaper::TEXT, sources::Gillespie1992::TEXT],
            Self::ContactLaw => &[sources::EdsmacManual::TEXT, sources::Campbell1974::TEXT],
            Self::ForceNetwork => {
                &[sources::PitPinnPaper::TEXT, sources::RasmussenWilliams2006::TEXT]
            }
            Self::ResponseNetwork => &[sources::PitPinnPaper::TEXT],
            Self::Reconstruction => &[
                sources::DelMoral2006::TEXT,
                sources::Jasra2011::TEXT,
                sources::OwenZhou2000::TEXT,
                sources::Cornuet2012::TEXT,
                sources::GelmanMengStern1996::TEXT,
                sources::KennedyOHagan2001::TEXT,
            ],
            Self::DataSheet => &[
                sources::Heydinger1999::TEXT,
                sources::KktseInertia2020::TEXT,
                sources::Ncap2004::TEXT,
                sources::Cvs2024::TEXT,
            ],
        }
    }
}

/// A paragraph for each method, and the sources of all, numbered.
pub(super) fn method_blocks(methods: &BTreeSet<Method>, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let mut cited: Vec<&'static str> = Vec::new();
    let mut blocks = vec![Block::paragraph(words.axes_text)];
    for method in methods {
        let numbers: Vec<String> = method
            .sources()
            .iter()
            .map(|source| {
                let known = cited.iter().position(|known| known == source);
                let idx = known.unwrap_or_else(|| {
                    cited.push(source);
                    cited.len() - 1
                });
                format!("[{}]", idx + 1)
            })
            .collect();
        blocks.push(Block::heading(2, method.name(wording)));
        let text = method.text(wording);
        blocks.push(Block::paragraph(format!("{text} {}: {}.", words.sources, numbers.join(", "))));
    }
    if !cited.is_empty() {
        blocks.push(Block::heading(2, words.sources));
        let cited = cited.iter().enumerate();
        let items = cited.map(|(idx, text)| format!("[{}] {}", idx + 1, citation(text))).collect();
        blocks.push(Block::List { items });
    }
    blocks
}

/// The first paragraph of the documentation of a source, without marks of Markdown.
fn citation(text: &str) -> String {
    let first = text.lines().map(str::trim).take_while(|line| !line.is_empty());
    let joined = first.collect::<Vec<_>>().join(" ");
    joined.chars().filter(|c| !matches!(c, '*' | '`' | '[' | ']')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_citation_has_authors_title_and_year_and_no_marks() {
        let text = citation(sources::OwenZhou2000::TEXT);
        assert!(
            text.starts_with("A. Owen, Y. Zhou, Safe and effective importance sampling"),
            "{text}"
        );
        assert!(text.contains("2000"), "{text}");
        assert!(!citation(sources::PitPinnPaper::TEXT).contains('|'));
    }
}
