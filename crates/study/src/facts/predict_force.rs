//! The facts of a predicted force.

use impactlab_core::units::Quantity;

use crate::PredictForceReport;
use crate::facts::held::held_intervals;
use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::Measured;

/// Courses of a contact that are told one by one; where bodies or contact are open there is one for each of
/// those that they may be.
const MOST_COURSES: usize = 8;

impl PredictForceReport {
    /// What the answer says: the force with its intervals, and the courses that the contact may take.
    pub fn facts(&self) -> Vec<FactTable> {
        let tables = [Some(self.force_table()), self.course_table(), self.held_table()];
        tables.into_iter().flatten().collect()
    }

    /// How often such intervals held; none outside of what the network has learned from, where the cases
    /// that were counted lie.
    pub fn held_table(&self) -> Option<FactTable> {
        held_intervals(Measured::ForceNetwork, &self.model, None)
            .filter(|_| self.applicability >= 1.0)
    }

    /// The force with its intervals.
    pub fn force_table(&self) -> FactTable {
        FactTable::new(Term::Force, self.force()).with_levels(PREDICTED)
    }

    fn force(&self) -> Vec<Fact> {
        let impulse = &self.impulse_n_s;
        let pdof_rad = self.pdof_interval_deg.scaled(1.0_f64.to_radians());
        let hooking = self.hooking_probability;
        let mut facts = vec![
            Fact::estimate(Term::ImpulseSize, Quantity::Impulse, &impulse.magnitude),
            Fact::estimate(Term::ImpulseX, Quantity::Impulse, &impulse.x),
            Fact::estimate(Term::ImpulseY, Quantity::Impulse, &impulse.y),
            Fact::estimate(Term::PeakForce, Quantity::Force, &self.peak_n),
            Fact::estimate(Term::PeakTime, Quantity::Time, &self.peak_time_s),
            Fact::estimate(Term::ContactDuration, Quantity::Time, &self.duration_s),
            Fact::estimate(Term::Pdof, Quantity::Angle, &pdof_rad),
            Fact::new(Term::ClockDirection, Value::Clock(self.pdof_clock)),
            Fact::new(
                Term::Hooking,
                hooking.map_or(Value::Term(Term::Unknown), |chance| Value::Chance(chance, None)),
            ),
        ];
        match &self.implied_contact {
            Some(implied) => facts.extend(implied.facts()),
            None => {
                let start = self.momentum_impulse_n_s;
                facts.push(Fact::rough_vector(Term::NetworkStart, Quantity::Impulse, start));
            }
        }
        let open = [
            (Term::ContactPoint, self.is_contact_open),
            (Term::StrikingBody, self.is_body_open),
            (Term::StruckBody, self.is_struck_body_open),
        ];
        let drawn = |term| Fact::new(term, Value::Term(Term::DrawnFromTraining));
        facts.extend(open.into_iter().filter(|(_, is_open)| *is_open).map(|(term, _)| drawn(term)));
        facts
    }

    /// The likeliest components of the mixture, if there are several, and what the others have together.
    pub fn course_table(&self) -> Option<FactTable> {
        let columns = [Term::Impulse, Term::PeakForce, Term::ContactDuration];
        let row = |mode: &crate::analysis::Mode| {
            let values = vec![
                Value::RoughVector(Quantity::Impulse, mode.impulse_n_s, ["x", "y"]),
                Value::Rough(Quantity::Force, mode.peak_n),
                Value::Rough(Quantity::Time, mode.duration_s),
            ];
            Fact::row(Value::Chance(mode.weight, None), values)
        };
        let (told, others) = self.modes.split_at(self.modes.len().min(MOST_COURSES));
        let rest = || {
            let weight = others.iter().map(|mode| mode.weight).sum();
            let none = Value::Term(Term::NoImpulse);
            let values = vec![Value::Term(Term::OtherCourses), none.clone(), none];
            Fact::row(Value::Chance(weight, None), values)
        };
        let rows = told.iter().map(row).chain((!others.is_empty()).then(rest)).collect();
        let table = FactTable::new(Term::ForceModes, rows)
            .with_rows(Term::Probability)
            .with_columns(&columns);
        (self.modes.len() > 1).then_some(table)
    }
}
