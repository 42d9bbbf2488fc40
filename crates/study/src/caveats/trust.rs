//! What stands beside an answer wherever it goes: into a picture, a table or the clipboard.

use crate::{AssumedQuantity, Assumption};
use impactlab_core::uncertainty::Badge;

/// What restricts an answer and what it rests on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trust {
    /// What restricts it, without the badges that only count the assumptions.
    pub badges: Vec<Badge>,
    /// What was assumed for it, and what was given and is not used.
    pub assumptions: Vec<Assumption>,
    /// Whether it is not the answer to what is asked any more. It is not exported then.
    pub is_outdated: bool,
}

/// What a [`Trust`] says in one statement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrustLine {
    /// Whether the numbers may be wrong, rather than rest on something that the user can supply.
    pub is_warning: bool,
    /// What it is about: `outside the domain`.
    pub label: String,
    /// The statement itself.
    pub text: String,
}

impl Trust {
    /// Badges and assumptions of a report.
    pub fn new(badges: &[Badge], assumptions: &[Assumption]) -> Self {
        let badges = badges.iter().filter(|badge| !badge.kind.is_assumption()).cloned().collect();
        Self { badges, assumptions: assumptions.to_vec(), is_outdated: false }
    }

    /// The same, marked if it is not of what is asked any more.
    #[must_use]
    pub fn outdated_if(self, is_outdated: bool) -> Self {
        Self { is_outdated: self.is_outdated || is_outdated, ..self }
    }

    /// Adds what restricts another variant of the case and does not restrict this one alike.
    pub fn add_variant(&mut self, name: &str, other: &Self) {
        let badges = other.badges.iter().filter(|badge| !self.badges.contains(badge));
        let badges: Vec<Badge> = badges
            .map(|badge| Badge { text: format!("{name}: {}", badge.text), ..badge.clone() })
            .collect();
        let assumptions = other.assumptions.iter().filter(|of| !self.assumptions.contains(of));
        let assumptions: Vec<Assumption> = assumptions
            .map(|of| Assumption { value: format!("{} ({name})", of.value), ..of.clone() })
            .collect();
        self.badges.extend(badges);
        self.assumptions.extend(assumptions);
        self.is_outdated |= other.is_outdated;
    }

    /// What the badges say, the warnings first.
    pub fn restrictions(&self) -> Vec<TrustLine> {
        let outdated = self.is_outdated.then(|| TrustLine {
            is_warning: true,
            label: "outdated".to_owned(),
            text: "this is not the answer to what is asked now".to_owned(),
        });
        let line = |badge: &Badge| {
            let label = badge.kind.label();
            // Many texts begin with their label, which stands before them already.
            let begin = format!("{label}: ");
            let text = badge.text.strip_prefix(&begin).unwrap_or(&badge.text).to_owned();
            TrustLine { is_warning: badge.kind.is_warning(), label: label.to_owned(), text }
        };
        let mut lines: Vec<TrustLine> =
            outdated.into_iter().chain(self.badges.iter().map(line)).collect();
        lines.sort_by_key(|line| !line.is_warning);
        lines
    }

    /// What was assumed and what is not used, a value each without its reason.
    pub fn assumed(&self) -> Vec<TrustLine> {
        let line = |of: &Assumption| match of.quantity {
            AssumedQuantity::NotUsed => TrustLine {
                is_warning: false,
                label: "not used".to_owned(),
                text: of.value.clone(),
            },
            quantity => TrustLine {
                is_warning: false,
                label: "assumed".to_owned(),
                text: format!("{}: {}", quantity.label(), of.value),
            },
        };
        self.assumptions.iter().map(line).collect()
    }

    /// A text that is copied or written, with all of it at the end.
    pub fn appended_to(&self, text: String) -> String {
        match self.text() {
            Some(said) => format!("{text}\nRestrictions: {said}\n"),
            None => text,
        }
    }

    /// All of it as one line of text, for [`RESTRICTIONS_COLUMN`](impactlab_core::data::RESTRICTIONS_COLUMN);
    /// `None` if there is nothing to say.
    pub fn text(&self) -> Option<String> {
        let said = |line: TrustLine| {
            let severity = if line.is_warning { "warning" } else { "note" };
            format!("{severity}: {}: {}", line.label, line.text)
        };
        let lines = self.restrictions().into_iter().chain(self.assumed());
        let text: Vec<String> = lines.map(said).collect();
        (!text.is_empty()).then(|| text.join(" | "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::uncertainty::BadgeKind;

    #[test]
    fn warnings_come_first_and_every_value_that_was_assumed_is_named() {
        let badges = [
            Badge::new(BadgeKind::Assumed, "speed before the impact"),
            Badge::new(BadgeKind::NotAtRest, "still moving"),
            Badge::new(BadgeKind::OutsideDomain, "bullet mass is 9000"),
        ];
        let assumptions = [
            Assumption::new(AssumedQuantity::Speed, "15 m/s", "nobody said it"),
            Assumption::new(AssumedQuantity::NotUsed, "restitution, 0.3", "no effect"),
        ];
        let trust = Trust::new(&badges, &assumptions);
        let expected = "warning: outside the domain: bullet mass is 9000 | \
                        note: not at rest: still moving | \
                        note: assumed: speed before the impact: 15 m/s | \
                        note: not used: restitution, 0.3";
        assert_eq!(trust.text().unwrap(), expected);
        assert!(trust.outdated_if(true).text().unwrap().starts_with("warning: outdated: "));
        assert_eq!(Trust::default().text(), None);
    }

    #[test]
    fn a_variant_adds_what_does_not_hold_for_the_first() {
        let badge = |text: &str| Badge::new(BadgeKind::SecondContact, text);
        let mut trust = Trust::new(&[badge("at 0.3 s")], &[]);
        trust.add_variant("fast", &Trust::new(&[badge("at 0.3 s"), badge("at 0.2 s")], &[]));
        let texts: Vec<&str> = trust.badges.iter().map(|badge| badge.text.as_str()).collect();
        assert_eq!(texts, ["at 0.3 s", "fast: at 0.2 s"]);
    }
}
