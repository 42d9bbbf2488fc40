//! Where a motion lies outside of what the response network has learned from.

use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_networks::response::OutsideDomain;

/// Share of the response network below which it is told that a part of the draws lies outside.
const LEAST_APPLICABILITY: f64 = 0.95;

/// A quantity of a motion that lies outside what a response network has learned from.
pub(super) fn outside_domain_caveat(outside: &OutsideDomain) -> Caveat {
    let OutsideDomain { quantity, value, range } = outside;
    let [low, high] = *range;
    let text = Phrase::new(
        "{0} is {1}, the response network has learned from {2} to {3}",
        "{0} beträgt {1}; das Bewegungsnetz hat an Werten von {2} bis {3} gelernt",
    )
    .with(PhraseValue::Heading((*quantity).to_owned()))
    .with(PhraseValue::of_named(quantity, *value))
    .with(PhraseValue::of_named(quantity, low))
    .with(PhraseValue::of_named(quantity, high));
    Caveat::new(CaveatKind::OutsideDomain, text).with_value(*quantity, *value).with_range(*range)
}

/// That draws of what a data sheet leaves open lie outside, where the usual one of them does not: of such a
/// share no single quantity is the cause, and nothing said why it is below one.
///
/// - `applicability`: mean of the draws.
pub(super) fn partly_outside_caveat(
    applicability: f64,
    outside: &[OutsideDomain],
) -> Option<Caveat> {
    let is_told = outside.is_empty() && applicability < LEAST_APPLICABILITY;
    is_told.then(|| {
        let text = Phrase::new(
            "with what the data sheet leaves open, {0} of the answer lies outside of what the response network \
             has learned from; there the bare physics answers, with wider bands",
            "mit dem, was das Datenblatt offenlässt, liegt die Antwort zu {0} außerhalb dessen, woran das \
             Bewegungsnetz gelernt hat; dort antwortet die bloße Physik mit breiteren Bändern",
        )
        .with(PhraseValue::Share(1.0 - applicability));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value("share of the response network", applicability)
            .with_range([LEAST_APPLICABILITY, 1.0])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of the network was 85 % of a Camry by its sheet, and nothing said why.
    #[test]
    fn a_share_below_one_is_told_of_where_no_single_quantity_lies_outside() {
        assert_eq!(partly_outside_caveat(0.96, &[]), None);
        let told = partly_outside_caveat(0.85, &[]).unwrap();
        assert_eq!(told.kind, CaveatKind::OutsideDomain);
        assert!(told.text.contains("15.0 % of the answer lies outside"), "{}", told.text);
        let mass = OutsideDomain { quantity: "mass [kg]", value: 3000.0, range: [800.0, 2500.0] };
        assert_eq!(partly_outside_caveat(0.85, &[mass]), None);
    }
}
