//! The facts of an evaluation of forecasts of recorded pairs.

use impactlab_core::units::Quantity;
use impactlab_networks::pair::{EvaluatedTwins, TwinOutcome, TwinSummary, VehicleSummary};

use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{EvaluatePairsReport, PairGroup, word};

impl EvaluatePairsReport {
    /// What the answer says: how far each vehicle is from where it was recorded, how often its turn and
    /// its regions were right, what stability control changes, and which cases are left out.
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
        let twins = self.overall.as_ref().and_then(|overall| overall.twins);
        let twins = twins.into_iter().flat_map(|all| [self.twin_table(), twin_summary(&all)]);
        tables.chain(twins).chain(left_out(&self.left_out)).collect()
    }

    fn twin_table(&self) -> FactTable {
        FactTable::new(Term::StabilityTwins, self.twins.iter().map(twin_row).collect())
            .with_rows(Term::Case)
            .with_columns(&[
                Term::RecordedTurnWithout,
                Term::ForecastTurnWithout,
                Term::QuarterTurnChanceWithout,
                Term::RecordedTurnWith,
                Term::ForecastTurnWith,
                Term::QuarterTurnChanceWith,
                Term::SavedRecorded,
                Term::SavedForecast,
            ])
    }
}

fn twin_row(twins: &EvaluatedTwins) -> Fact {
    let of_outcome = |outcome: &TwinOutcome| {
        [
            Value::Decimals(Quantity::Angle, outcome.recorded_turn_rad, 0),
            Value::Decimals(Quantity::Angle, outcome.forecast_turn_rad, 0),
            Value::Share(outcome.quarter_turn_probability),
        ]
    };
    let saved = |is_saved: bool| match is_saved {
        true => Value::Term(Term::Saved),
        false => Value::Term(Term::NotSaved),
    };
    let turns = [of_outcome(&twins.outcomes.without), of_outcome(&twins.outcomes.with)].concat();
    let effect = [saved(twins.saved_recorded), saved(twins.saved_forecast)];
    Fact::row(Value::Text(twins.cases.with.clone()), turns.into_iter().chain(effect).collect())
}

/// How many twins are saved, and how many are forecast as recorded.
fn twin_summary(all: &TwinSummary) -> FactTable {
    let of = |term: Term, n: usize| Fact::new(term, Value::CountOf(n, all.n));
    let (saved, turns) = (&all.saved, &all.quarter_turns);
    let facts = vec![
        of(Term::EffectRight, all.n_right),
        of(Term::SavedAndForecast, saved.both),
        of(Term::SavedNotForecast, saved.recorded_alone),
        of(Term::ForecastNotSaved, saved.forecast_alone),
        of(Term::NeitherSavedNorForecast, saved.neither),
        of(Term::TurnsWithoutRecorded, turns.without.recorded),
        of(Term::TurnsWithoutForecast, turns.without.forecast),
        of(Term::TurnsWithRecorded, turns.with.recorded),
        of(Term::TurnsWithForecast, turns.with.forecast),
    ];
    FactTable::new(Term::EffectOfStabilityControl, facts)
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
