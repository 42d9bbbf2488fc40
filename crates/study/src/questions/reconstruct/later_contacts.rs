//! Whether a reconstruction follows both cars through later contacts.

use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::NumberFormat;

/// Share of the particles whose cars meet again from which on later contacts are followed: as much as the
/// intervals of 90 % leave out at one end.
const FOLLOWED_FROM: f64 = 0.05;

/// What a reconstruction makes of later contacts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct LaterContactsReport {
    /// Share of the particles of a reconstruction from the first contact alone whose cars meet again.
    pub meet_again_share: f64,
    /// Whether both cars were then followed through all contacts.
    pub are_followed: bool,
}

impl LaterContactsReport {
    /// What is done where some of the particles of the first contact alone meet again.
    ///
    /// - `one_contact`: whether it is asked that no later contact is followed.
    pub(super) fn new(meet_again_share: f64, one_contact: bool) -> Self {
        let are_followed = !one_contact && meet_again_share >= FOLLOWED_FROM;
        Self { meet_again_share, are_followed }
    }

    /// What a person should know of it; `None` where the cars part for good.
    pub(super) fn caveat(&self) -> Option<Caveat> {
        let share = NumberFormat::default().chance(self.meet_again_share, None);
        let meet =
            format!("after the first contact alone the cars meet again in {share} of the motions");
        if self.are_followed {
            let text = format!(
                "{meet}: both were followed through all contacts, the first one by momentum, later ones by \
                 the crush of their outlines"
            );
            return Some(Caveat::new(CaveatKind::Note, text));
        }
        (self.meet_again_share >= FOLLOWED_FROM).then(|| {
            let text = format!(
                "{meet}, which is left out here: the speeds are those of motions that end otherwise; leave \
                 out --one-contact"
            );
            Caveat::new(CaveatKind::SecondContact, text)
                .with_value("share of the motions in which the cars meet again", self.meet_again_share)
                .with_range([0.0, FOLLOWED_FROM])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn later_contacts_are_followed_where_there_are_some_and_a_person_hears_of_it() {
        let kind = |share, one_contact| {
            let report = LaterContactsReport::new(share, one_contact);
            (report.are_followed, report.caveat().map(|caveat| caveat.kind))
        };
        assert_eq!(kind(0.01, false), (false, None));
        assert_eq!(kind(0.3, false), (true, Some(CaveatKind::Note)));
        assert_eq!(kind(0.3, true), (false, Some(CaveatKind::SecondContact)));
    }
}
