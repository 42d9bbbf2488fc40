//! How often intervals of answers held what had happened.

use impactlab_core::numerics::wilson_interval;

use crate::ModelChoice;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::{HeldIntervals, Measured, Measurement};

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
