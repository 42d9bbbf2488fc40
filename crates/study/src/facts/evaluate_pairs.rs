//! The facts of an evaluation of forecasts of recorded pairs.

use impactlab_core::units::Quantity;
use impactlab_networks::pair::VehicleSummary;

use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{EvaluatePairsReport, PairGroup, word};

impl EvaluatePairsReport {
    /// What the answer says: how far each vehicle is from where it was recorded, how often its turn and
    /// its regions were right, and which cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let cases = vec![Value::Count(self.n_cases), Value::Phrase(word(&self.split))];
        let mut facts = vec![
            Fact::new(Term::Cases, Value::Joined(cases, ", ")),
            Fact::new(Term::PairDraws, Value::Count(self.n_draws)),
        ];
        if self.stopped {
            facts.push(Fact::new(Term::Stopped, Value::Term(Term::StoppedEarly)));
        }
        let first = FactTable::new(Term::RecordedPairs, facts);
        let of_vehicle = |title: Term, summary: fn(&PairGroup) -> &VehicleSummary| {
            let row = |group: &PairGroup| vehicle_row(group, summary(group));
            FactTable::new(title, self.groups.iter().map(row).collect())
                .with_rows(Term::Cases)
                .with_columns(&[
                    Term::Number,
                    Term::MeanPathError,
                    Term::MedianPathError,
                    Term::MedianEndError,
                    Term::QuarterTurnRight,
                    Term::HalfTurnRight,
                    Term::PathIn50,
                    Term::PathIn90,
                    Term::EndIn50,
                    Term::EndIn90,
                ])
                .unless_empty()
        };
        let vehicles = [
            of_vehicle(Term::StruckVehicle, |group| &group.summary.struck),
            of_vehicle(Term::StrikingVehicle, |group| &group.summary.striking),
        ];
        let tables = std::iter::once(first).chain(vehicles.into_iter().flatten());
        tables.chain(left_out(&self.left_out)).collect()
    }
}

fn vehicle_row(group: &PairGroup, summary: &VehicleSummary) -> Fact {
    let length = |metres| Value::Decimals(Quantity::Length, metres, 2);
    let values = vec![
        Value::Count(group.summary.n),
        length(summary.average_error_m.mean),
        length(summary.average_error_m.median),
        length(summary.end_error_m.median),
        Value::Share(summary.quarter_turn_right),
        Value::Share(summary.half_turn_right),
        Value::Share(summary.coverage.of_50),
        Value::Share(summary.coverage.of_90),
        Value::Share(summary.end_coverage.of_50),
        Value::Share(summary.end_coverage.of_90),
    ];
    Fact::row(Value::Phrase(group.name.clone()), values)
}
