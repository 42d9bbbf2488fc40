//! Which answers something is said of.

use crate::report::build::VariantParts;
use crate::report::numbers::Wording;

/// Answers of one kind in some variants.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AnswerNames<'a> {
    /// The kind of their question, or its heading.
    pub title: &'a str,
    /// The variants.
    pub variants: Vec<&'a str>,
}

impl AnswerNames<'_> {
    /// The kind and, where a case has several variants, their names.
    pub fn text(&self, all: &[VariantParts], wording: &Wording) -> String {
        match (all.len(), self.variants.len()) {
            (1, _) => self.title.to_owned(),
            (all, n) if all == n => format!("{} ({})", self.title, wording.words.all_variants),
            _ => format!("{} ({})", self.title, self.variants.join(", ")),
        }
    }
}
