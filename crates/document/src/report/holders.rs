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

impl<'a> AnswerNames<'a> {
    /// Adds a variant; one that has two such answers is named once.
    pub fn add(&mut self, variant: &'a str) {
        if !self.variants.contains(&variant) {
            self.variants.push(variant);
        }
    }

    /// The kind and, where a case has several variants, their names.
    pub fn text(&self, all: &[VariantParts], wording: &Wording) -> String {
        match (all.len(), self.variants.len()) {
            (1, _) => self.title.to_owned(),
            (all, n) if all == n => format!("{} ({})", self.title, wording.words.all_variants),
            _ => format!("{} ({})", self.title, self.variants.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::UnitSystem;

    /// Two answers of one of two variants were those of “all variants”.
    #[test]
    fn two_answers_of_a_variant_are_not_those_of_all() {
        let variant = |name: &str| VariantParts {
            name: name.to_owned(),
            notes: String::new(),
            answers: Vec::new(),
        };
        let all = ["a", "b"].map(variant);
        let wording = Wording::english(UnitSystem::Si);
        let mut names = AnswerNames { title: "Impact", variants: vec!["a"] };
        names.add("a");
        assert_eq!(names.text(&all, &wording), "Impact (a)");
        names.add("b");
        assert_eq!(names.text(&all, &wording), "Impact (all variants)");
    }
}
