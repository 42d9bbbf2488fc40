//! How the answers of a report were computed, with the sources.

use std::collections::BTreeSet;

use crate::report::numbers::Wording;
use crate::report::{Block, Table};
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
        let row = |(idx, text): (usize, &&str)| [format!("[{}]", idx + 1), numbered(text, &cited)];
        let rows = cited.iter().enumerate().map(row).collect();
        let columns = [words.number, words.source_title];
        blocks.push(Block::Table(Table::new(words.sources, columns, rows)));
    }
    blocks
}

/// A citation in which other sources are told by their numbers.
fn numbered(text: &str, cited: &[&'static str]) -> String {
    let mut told = citation(text);
    for (key, name, source) in NAMED {
        let number = cited.iter().position(|known| known == source);
        let number = number.map_or_else(|| (*name).to_owned(), |idx| format!("[{}]", idx + 1));
        told = told.replace(key, &number);
    }
    told
}

/// Sources that others name: the key in the program, authors and year, and the text.
const NAMED: &[(&str, &str, &str)] = &[
    ("Kudlich1966", "Kudlich 1966", sources::Kudlich1966::TEXT),
    ("Heydinger1999", "Heydinger 1999", sources::Heydinger1999::TEXT),
    ("KktseInertia2020", "kktse.github.io 2020", sources::KktseInertia2020::TEXT),
];

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

    /// Keys of the program, such as “Heydinger1999”, stood in the list.
    #[test]
    fn sources_are_named_by_their_numbers_and_not_by_keys_of_the_program() {
        let cited = [sources::Heydinger1999::TEXT, sources::KktseInertia2020::TEXT];
        assert!(numbered(cited[0], &cited).contains("[2]"), "{}", numbered(cited[0], &cited));
        let all = [
            Method::Impact,
            Method::FourDof,
            Method::ContactLaw,
            Method::ForceNetwork,
            Method::ResponseNetwork,
            Method::Reconstruction,
            Method::DataSheet,
        ];
        for source in all.iter().flat_map(|method| method.sources()) {
            let told = numbered(source, &[]);
            let mut words = told.split(|c: char| !c.is_alphanumeric());
            let is_key = |word: &str| {
                let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
                let is_name = name.len() > 2 && name.chars().all(char::is_alphabetic);
                is_name && word.len() == name.len() + 4
            };
            assert!(!words.any(is_key), "{told}");
        }
    }
}
