//! How often intervals of answers held what had happened.

use impactlab_core::numerics::wilson_interval;

use crate::ModelChoice;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::{HeldIntervals, Measured, Measurement, TriedMotion};
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
    ///
    /// - `kind`: of motions of that kind, where these were counted by themselves.
    pub(crate) fn held_table(&self, kind: Option<TriedMotion>) -> Option<FactTable> {
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
        let rows = self.held_of(kind).into_iter().map(row).collect();
        FactTable::new(Term::HeldIntervals, rows).with_columns(&columns).unless_empty()
    }
}

/// What was measured of answers by a model; none for a model that is not the default one.
pub(super) fn measurement_of(subject: Measured, model: &str) -> Option<&'static Measurement> {
    ModelChoice::is_default(model).then(|| Measurement::shipped(subject)).flatten()
}

/// How often intervals of answers by a model held; likewise.
pub(crate) fn held_intervals(
    subject: Measured,
    model: &str,
    kind: Option<TriedMotion>,
) -> Option<FactTable> {
    measurement_of(subject, model)?.held_table(kind)
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
        let quantity = "peak".to_owned();
        let held = HeldIntervals { quantity, in_50: 10, in_90: 19, n: 25, of: None };
        let measurement = Measurement { held: vec![held], ..measurement.clone() };
        let table = measurement.held_table(None).unwrap();
        let text = table.to_text(&FactWriter::english(UnitSystem::Si));
        assert_eq!(text.rows[0].cells, ["peak", "25", "40.0 %", "76.0 %", "56.6 %", "88.5 %"]);
        assert!(held_intervals(Measured::ForceNetwork, "other.safetensors", None).is_none());
        assert!(held_intervals(Measured::ForceNetwork, "shipped", None).is_some());
    }

    /// Of a braked car it was told how often regions held of coasting and of braked ones together.
    #[test]
    fn of_a_braked_car_what_held_of_braked_cars_is_told() {
        let measurement = Measurement::shipped(Measured::ResponseNetwork).unwrap();
        let of = |kind| match &measurement.held_of(kind)[..] {
            [held] => (held.in_50, held.in_90, held.n),
            several => panic!("{several:?}"),
        };
        let [coasting, braked] = [TriedMotion::Coasting, TriedMotion::Braked].map(Some).map(of);
        assert_eq!(of(None), (coasting.0 + braked.0, coasting.1 + braked.1, coasting.2 + braked.2));
        assert!(braked.1 * coasting.2 < coasting.1 * braked.2, "{braked:?} {coasting:?}");
        // As the table beside them says.
        let lines = &measurement.tables[0].lines;
        let share = |(_, in_90, n): (usize, usize, usize)| {
            format!(" {:.0} % |", in_90 as f64 / n as f64 * 100.0)
        };
        for (name, held) in [("| coasting |", coasting), ("| braked |", braked)] {
            let line = lines.iter().find(|line| line.starts_with(name)).unwrap();
            assert!(line.ends_with(&share(held)), "{line} {held:?}");
        }
        // Where a kind was not counted by itself, all are told.
        let pairs = Measurement::shipped(Measured::Pairs).unwrap();
        assert_eq!(pairs.held_of(Some(TriedMotion::PushOnFlank)), pairs.held_of(None));
        assert!(pairs.held_of(Some(TriedMotion::Untried)).is_empty());
        assert!(pairs.held_table(Some(TriedMotion::Untried)).is_none());
        let others = pairs.held_of(Some(TriedMotion::AcrossOrBehind));
        let held_less = |of: &&HeldIntervals| of.n == 7 && of.share_in_90() < NINETY;
        assert!(others.len() == 2 && others.iter().all(held_less), "{others:?}");
    }
}
