//! Restitution and friction of a contact: those of a momentum solution, and those that a predicted
//! impulse implies.

use impactlab_core::units::Quantity;

use crate::facts::{Fact, Term, Value};
use crate::{ImpliedContactReport, MomentumReport};

impl MomentumReport {
    /// Restitution and friction limit of the solution, and its regime.
    pub(super) fn surface(&self) -> Value {
        let restitution = Value::Joined(
            vec![
                Value::Text("e".to_owned()),
                Value::Rounded(Quantity::Ratio, self.restitution),
                Value::Phrase(self.restitution_form.label().to_owned()),
            ],
            " ",
        );
        let friction = Value::Joined(
            vec![
                Value::Text("μ_c".to_owned()),
                Value::Rounded(Quantity::Ratio, self.friction_limit),
            ],
            " ",
        );
        let regime = Value::Phrase(self.regime.label().to_owned());
        Value::Joined(vec![restitution, friction, regime], "; ")
    }
}

impl ImpliedContactReport {
    /// Restitution and impulse ratio that a predicted impulse implies, and what the momentum solution
    /// with the values of the collision says.
    pub(super) fn facts(&self) -> [Fact; 4] {
        let momentum = &self.momentum;
        [
            Fact::estimate(Term::ImpliedRestitution, Quantity::Ratio, &self.restitution),
            Fact::estimate(Term::ImpliedRatio, Quantity::Ratio, &self.impulse_ratio),
            Fact::rough_vector(Term::MomentumBeside, Quantity::Impulse, momentum.impulse_n_s),
            Fact::new(Term::MomentumSurface, momentum.surface()),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::{FactTable, FactWriter};
    use impactlab_core::collision::Scenario;
    use impactlab_core::units::UnitSystem;

    /// A share of the critical ratio had all digits of what is computed of it.
    #[test]
    fn friction_has_the_digits_that_it_was_given_with_and_four_at_the_most() {
        let told = |limit: f64| {
            let mut scenario = Scenario::example();
            scenario.contact.friction_limit = Some(limit);
            let impact = scenario.impact().unwrap();
            let report = MomentumReport::from_impact(&impact, 0.0).unwrap();
            let facts = vec![Fact::new(Term::MomentumSurface, report.surface())];
            let table = FactTable::new(Term::Impact, facts);
            table.to_text(&FactWriter::english(UnitSystem::Si)).rows[0].cells[1].clone()
        };
        assert!(told(0.4).contains("μ_c 0.4;"), "{}", told(0.4));
        assert!(told(0.412_837_641).contains("μ_c 0.4128;"), "{}", told(0.412_837_641));
    }
}
