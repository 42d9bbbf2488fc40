//! What the models were measured against, and how far they were off: the error rates that answers and
//! reports state.
//!
//! All of it stands in `assets/validation.toml`, which `cargo run --release --example validation` writes.
//! Beside each measurement stand the digest of the data that it was made with and a few numbers that a
//! build must still compute, so that a test fails if data or program have changed and the measurement was
//! not made again. (A digest of the source would change with every comment.)

use std::collections::BTreeMap;
use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use impactlab_reconstruct::evaluate::KnownEvidence;

const FILE: &str = include_str!("../../../assets/validation.toml");

static MEASUREMENTS: LazyLock<Result<Measurements, toml::de::Error>> =
    LazyLock::new(|| toml::from_str(FILE));

/// All measurements.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurements {
    /// Each of them.
    #[serde(rename = "measurement")]
    pub all: Vec<Measurement>,
}

/// One measurement, with what it was made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    /// What was measured.
    pub subject: Measured,
    /// When, as `YYYY-MM-DD`.
    pub date: String,
    /// The command that measures it.
    pub command: String,
    /// The files and folders that it reads.
    pub data: Vec<String>,
    /// SHA-256 over their names and contents.
    pub data_sha256: String,
    /// Numbers that a build must still compute, by name.
    pub probe: BTreeMap<String, f64>,
    /// The tables of `docs/VALIDATION.md` that it fills, as far as a report shows them.
    #[serde(rename = "table")]
    pub tables: Vec<ValidationTable>,
    /// How often intervals of an answer held the true value.
    #[serde(rename = "held", default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<HeldIntervals>,
    /// The same over all cases, also those that were looked at while the method was set.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held_in_all: Vec<HeldIntervals>,
}

/// What a measurement is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measured {
    /// Impulses of the momentum solution.
    Impact,
    /// Motions of the 4DOF model.
    FourDof,
    /// Forces of the shipped network.
    ForceNetwork,
    /// Motions of the shipped network, of cars that it has not seen.
    ResponseNetwork,
    /// Motions of two vehicles through all contacts, of recorded pairs.
    Pairs,
    /// Reconstructions from all of the evidence.
    ReconstructionOfEverything,
    /// Reconstructions without the event data recorder.
    ReconstructionWithoutEdr,
    /// Reconstructions from the rest poses alone.
    ReconstructionOfRest,
}

/// Lines of a table of `docs/VALIDATION.md`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValidationTable {
    /// The heading in that document below which it stands.
    pub heading: String,
    /// Header and rows, each a line of that document.
    pub lines: Vec<String>,
}

/// In how many cases the interval of a quantity held the true value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldIntervals {
    /// The quantity.
    pub quantity: String,
    /// In how many cases the interval of 50 % held.
    pub in_50: usize,
    /// … of 90 %.
    pub in_90: usize,
    /// Number of cases.
    pub n: usize,
    /// Which of the cases these are; all of them if nothing is said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<TriedMotion>,
}

/// A kind of motion among those that were tried; of some it was counted by itself how often intervals held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TriedMotion {
    /// One vehicle by itself; nothing acts on its wheels, which may be steered.
    Coasting,
    /// One vehicle by itself, wheels of which are braked, dragged or locked.
    Braked,
    /// Both vehicles, of which one hits a flank of the other and travels much the same way, as in a PIT.
    PushOnFlank,
    /// Both vehicles, of which one is hit across or from behind, as in a T-bone or a rear-end collision.
    AcrossOrBehind,
    /// Both vehicles, of which one is hit in its front, comes towards the other, or stands or rolls back as its flank
    /// is pushed: no such pair was tried.
    Untried,
}

impl HeldIntervals {
    /// Share of the cases whose interval of 90 % held.
    pub fn share_in_90(&self) -> f64 {
        self.in_90 as f64 / self.n.max(1) as f64
    }
}

impl Measured {
    /// The measurement of reconstructions from such evidence.
    pub fn reconstruction_of(known: KnownEvidence) -> Self {
        match known {
            KnownEvidence::Everything => Self::ReconstructionOfEverything,
            KnownEvidence::WithoutEdr => Self::ReconstructionWithoutEdr,
            KnownEvidence::RestOnly => Self::ReconstructionOfRest,
        }
    }
}

impl Measurements {
    /// Those of the shipped program.
    pub fn shipped() -> &'static [Measurement] {
        MEASUREMENTS.as_ref().map_or(&[], |measurements| &measurements.all)
    }
}

impl Measurement {
    /// The measurement of a subject in the shipped program.
    pub fn shipped(subject: Measured) -> Option<&'static Self> {
        Measurements::shipped().iter().find(|measurement| measurement.subject == subject)
    }

    /// How often intervals held of motions of a kind; of all where those of the kind were not counted by
    /// themselves, and none where they were not tried.
    pub fn held_of(&self, kind: Option<TriedMotion>) -> Vec<&HeldIntervals> {
        if kind == Some(TriedMotion::Untried) {
            return Vec::new();
        }
        let of = |kind| self.held.iter().filter(move |held| held.of == kind).collect::<Vec<_>>();
        let own = of(kind);
        if own.is_empty() { of(None) } else { own }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_is_read_and_every_subject_has_a_table() {
        let measurements = MEASUREMENTS.as_ref().unwrap();
        assert_eq!(measurements.all.len(), 8);
        for measurement in &measurements.all {
            assert!(!measurement.tables.is_empty() && !measurement.probe.is_empty());
            for held in measurement.held.iter().chain(&measurement.held_in_all) {
                assert!(held.in_50 <= held.in_90 && held.in_90 <= held.n, "{held:?}");
            }
            for all in &measurement.held_in_all {
                let of = |held: &&HeldIntervals| held.quantity == all.quantity;
                let some = measurement.held.iter().find(of).unwrap();
                let are_fewer = some.in_50 <= all.in_50 && some.in_90 <= all.in_90;
                assert!(are_fewer && some.n < all.n, "{some:?} {all:?}");
            }
        }
    }
}
