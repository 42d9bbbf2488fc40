//! The words that stand for the variants of an enum in reports.

use std::fmt::Debug;

/// The name of a variant without fields in snake case, as JSON spells it: `FrontLeft` is
/// `front_left`.
pub fn word(variant: &impl Debug) -> String {
    let mut word = String::new();
    for c in format!("{variant:?}").chars() {
        if c.is_uppercase() && !word.is_empty() {
            word.push('_');
        }
        word.extend(c.to_lowercase());
    }
    word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_in_snake_case() {
        assert_eq!(word(&impactlab_core::vehicle::Wheel::FrontLeft), "front_left");
        assert_eq!(word(&impactlab_core::data::Severity::Info), "info");
    }
}
