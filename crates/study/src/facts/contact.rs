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
                Value::Given(Quantity::Ratio, self.restitution),
                Value::Phrase(self.restitution_form.label().to_owned()),
            ],
            " ",
        );
        let friction = Value::Joined(
            vec![
                Value::Text("μ_c".to_owned()),
                Value::Number(Quantity::Ratio, self.friction_limit),
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
            Fact::vector(Term::MomentumBeside, Quantity::Impulse, momentum.impulse_n_s),
            Fact::new(Term::MomentumSurface, momentum.surface()),
        ]
    }
}
