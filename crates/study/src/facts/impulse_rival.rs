//! The facts of the force network beside a momentum solution.

use impactlab_core::units::Quantity;

use crate::ImpulseRival;
use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};

impl ImpulseRival {
    /// Whether the two say the same.
    pub fn verdict(&self) -> Term {
        match (self.is_in_network_intervals, self.is_in_momentum_intervals) {
            (true, true) => Term::ImpulsesAgree,
            (true, false) => Term::AgreeInNetwork,
            (false, true) => Term::AgreeInMomentum,
            (false, false) => Term::MethodsDisagree,
        }
    }

    /// Whether the force network says the same, with both values and their intervals.
    pub fn table(&self) -> FactTable {
        let agree = self.verdict();
        let radians = 1.0_f64.to_radians();
        let pdof = |term, deg: &impactlab_core::units::Estimate| {
            Fact::estimate(term, Quantity::Angle, &deg.scaled(radians))
        };
        let estimate = Fact::estimate;
        let mut facts = vec![
            Fact::new(Term::MethodsVerdict, Value::Term(agree)),
            Fact::new(Term::OtherMethod, Value::Term(Term::RivalNetwork)),
            estimate(Term::MomentumImpulse, Quantity::Impulse, &self.momentum_impulse_n_s),
            estimate(Term::NetworkImpulse, Quantity::Impulse, &self.network_impulse_n_s),
            estimate(Term::MomentumDeltaV, Quantity::Speed, &self.momentum_delta_v_m_s),
            estimate(Term::NetworkDeltaV, Quantity::Speed, &self.network_delta_v_m_s),
            pdof(Term::MomentumPdof, &self.momentum_pdof_deg),
            pdof(Term::NetworkPdof, &self.network_pdof_deg),
        ];
        if self.applicability < 1.0 {
            facts.push(Fact::new(Term::NetworkShare, Value::Share(self.applicability)));
        }
        if agree != Term::ImpulsesAgree {
            facts.push(Fact::new(Term::WhyApart, Value::Term(Term::NetworkLearned)));
        }
        FactTable::new(Term::Agreement, facts).with_levels(PREDICTED)
    }
}
