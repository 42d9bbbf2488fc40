//! How much of the evidence of a case is used.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Cars;
use crate::evidence::Evidence;

/// How much of the evidence of a case is used, so that what each part of it brings can be told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KnownEvidence {
    /// All of it.
    Everything,
    /// All but the records of the event data recorders.
    WithoutEdr,
    /// The rest poses with damage, masses and friction: no marks, no record, no positions, and
    /// nothing of what driver and wheels did after the impact.
    RestOnly,
}

impl KnownEvidence {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Everything, Self::WithoutEdr, Self::RestOnly];

    /// A few words for a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Everything => "everything",
            Self::WithoutEdr => "without EDR",
            Self::RestOnly => "rest only",
        }
    }

    /// What such evidence is alike among the staged collisions that reconstructions were measured on, all of
    /// which are of a flank that was hit behind the CG and of a known rest pose; none of any other evidence, such as
    /// a recorder alone, and of a single car.
    pub fn like(evidence: &Evidence, cars: &Cars) -> Option<Self> {
        let has_record = evidence.edr.or(evidence.striking_edr).is_some();
        let has_marks = !evidence.marks.is_empty() || !evidence.striking_marks.is_empty();
        let like = match (has_record, has_marks) {
            (true, _) => Self::Everything,
            (false, true) => Self::WithoutEdr,
            (false, false) => Self::RestOnly,
        };
        let is_tried = evidence.free_rest().is_some() && cars.is_hit_behind_cg(evidence);
        (!evidence.is_single_car() && is_tried).then_some(like)
    }

    /// What is used of the evidence.
    pub fn select(self, evidence: &Evidence) -> Evidence {
        match self {
            Self::Everything => evidence.clone(),
            Self::WithoutEdr => evidence.without_edr(),
            Self::RestOnly => evidence.rest_only(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// Of a car that was hit at its rear end it was told how often intervals of flanks that were hit behind the
    /// CG had held, though no other impact has been tried.
    #[test]
    fn an_impact_elsewhere_than_behind_the_cg_is_like_no_staged_collision() {
        let like = |name: &str, has_rest: bool| {
            let folder =
                Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/evidence"));
            let mut evidence = Evidence::load(&folder.join(name)).unwrap();
            evidence.rest = evidence.rest.filter(|_| has_rest);
            KnownEvidence::like(&evidence, &Cars::new(&evidence, None, None))
        };
        assert_eq!(like("spin.toml", true), Some(KnownEvidence::Everything));
        assert_eq!(like("inline.toml", true), None);
        // Neither is a recorder alone.
        assert_eq!(like("spin.toml", false), None);
    }
}
