//! How often intervals of answers held what had happened.

use impactlab_core::numerics::wilson_interval;

use crate::ModelChoice;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::{HeldIntervals, Measured, Measurement};
use impactlab_reconstruct::evaluate::KnownEvidence;

/// Share of the truths that an interval of 90 % says that it holds.
const NINETY: f64 = 0.9;

/// A quantity of an answer whose intervals of 90 % held the truth less often than that when they were tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldTooSeldom {
    /// The quantity, with how often they held over all cases.
    pub held: &'static HeldIntervals,
    /// Whether more of the evidence was known in these cases than in that of the answer, like which they were
    /// not counted.
    pub is_of_everything: bool,
}

impl HeldTooSeldom {
    /// What was counted of a quantity in reconstructions from such evidence, or else from all of it; none where
    /// intervals held often enough, and where nothing was counted.
    ///
    /// - `quantity`: its label.
    pub(super) fn of_reconstruction(known: KnownEvidence, quantity: &str) -> Option<Self> {
        let of = |known| {
            let measured = Measurement::shipped(Measured::reconstruction_of(known))?;
            measured.held_in_all.iter().find(|held| held.quantity == quantity)
        };
        let of_everything = || Some((of(KnownEvidence::Everything)?, true));
        let own = of(known).map(|held| (held, false));
        let (held, is_of_everything) = own.or_else(of_everything)?;
        (held.share_in_90() < NINETY).then_some(Self { held, is_of_everything })
    }
}

impl Measurement {
    /// How often such intervals held, with the bounds of 95 % confidence; none if it was not counted.
    pub(crate) fn held_table(&self) -> Option<FactTable> {
        let columns =
            [Term::Cases, Term::In50, Term::In90, Term::ConfidenceFrom, Term::ConfidenceTo];
        let row = |held: &HeldIntervals| {
            let share = |count: usize| Value::Share(count as f64 / held.n as f64);
            let [from, to] = wilson_interval(held.in_90, held.n);
            let values = vec![
                Value::Count(held.n),
                share(held.in_50),
                share(held.in_90),
                Value::Share(from),
                Value::Share(to),
            ];
            Fact::row(Value::Phrase(held.quantity.clone()), values)
        };
        let rows = self.held.iter().map(row).collect();
        FactTable::new(Term::HeldIntervals, rows).with_columns(&columns).unless_empty()
    }
}

/// What was measured of answers by a model; none for a model that is not the default one.
pub(super) fn measurement_of(subject: Measured, model: &str) -> Option<&'static Measurement> {
    ModelChoice::is_default(model).then(|| Measurement::shipped(subject)).flatten()
}

/// How often intervals of answers by a model held; likewise.
pub(crate) fn held_intervals(subject: Measured, model: &str) -> Option<FactTable> {
    measurement_of(subject, model)?.held_table()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::UnitSystem;

    /// The speeds held; the heading between the cars is too narrow, also where it was counted with more of the
    /// evidence alone.
    #[test]
    fn a_quantity_whose_intervals_held_too_seldom_is_known() {
        let of = HeldTooSeldom::of_reconstruction;
        for known in KnownEvidence::ALL {
            assert_eq!(of(known, "speed of the struck car"), None, "{known:?}");
            let heading = of(known, "relative heading of the cars").unwrap();
            assert!(heading.held.share_in_90() < 0.9, "{heading:?}");
            assert_eq!(heading.is_of_everything, known != KnownEvidence::Everything, "{known:?}");
        }
        assert_eq!(of(KnownEvidence::Everything, "friction of the road"), None);
    }

    #[test]
    fn what_held_is_told_with_its_number_and_bounds() {
        let measurement = Measurement::shipped(Measured::ForceNetwork).unwrap();
        let held = HeldIntervals { quantity: "peak".to_owned(), in_50: 10, in_90: 19, n: 25 };
        let measurement = Measurement { held: vec![held], ..measurement.clone() };
        let table = measurement.held_table().unwrap();
        let text = table.to_text(&FactWriter::english(UnitSystem::Si));
        assert_eq!(text.rows[0].cells, ["peak", "25", "40.0 %", "76.0 %", "56.6 %", "88.5 %"]);
        assert!(held_intervals(Measured::ForceNetwork, "other.safetensors").is_none());
        assert!(held_intervals(Measured::ForceNetwork, "shipped").is_some());
    }
}
