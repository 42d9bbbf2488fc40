//! The facts of a method by hand.

use impactlab_core::numerics::share_standard_error;
use impactlab_core::units::Quantity;
use impactlab_reconstruct::hand::YawMarkBias;

use crate::facts::table::RECONSTRUCTED;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{HandInputReport, HandReport, HandResult, HandSensitivityReport};

impl HandReport {
    /// What the answer says: the numbers, what they come from, what moves them, and how the method works.
    pub fn facts(&self) -> Vec<FactTable> {
        let formula = FactTable::new(
            Term::HandFormula,
            vec![
                Fact::text(Term::HandEquation, self.equation),
                Fact::text(Term::HandHolds, self.holds.as_str()),
            ],
        );
        let tables = [Some(self.result_table()), self.sensitivity_table(), self.bias_table()];
        let tables = tables.into_iter().flatten();
        tables.chain([self.input_table(), formula]).collect()
    }

    /// The numbers with their intervals.
    pub fn result_table(&self) -> FactTable {
        let nothing = || Value::Text(String::new());
        let row = |result: &HandResult| {
            // Its digits are those that its standard deviation leaves.
            let at_values = match result.sigma.filter(|sigma| *sigma > 0.0) {
                Some(sigma) => Value::Measured(result.quantity, result.value, sigma),
                None => Value::Number(result.quantity, result.value),
            };
            let values = vec![Value::Estimate(result.quantity, result.estimate.clone()), at_values];
            Fact::row(Value::Phrase(result.label.to_owned()), values)
        };
        let mut facts: Vec<Fact> = self.results.iter().map(row).collect();
        facts.extend(self.avoided_share.map(|share| {
            let n = self.draws.saturating_sub(self.draws_left_out);
            let chance = Value::Chance(share, Some(share_standard_error(share, n as f64)));
            Fact::row(Value::Term(Term::HandAvoided), vec![chance, nothing()])
        }));
        FactTable::new(Term::HandResults, facts)
            .with_levels(RECONSTRUCTED)
            .with_columns(&[Term::Median, Term::HandAtValues])
    }

    /// The inputs, and whose they are.
    pub fn input_table(&self) -> FactTable {
        let row = |input: &HandInputReport| {
            let value = match input.sigma == 0.0 {
                true => Value::Given(input.quantity, input.value),
                false => Value::Measured(input.quantity, input.value, input.sigma),
            };
            let source = match (input.is_value_assumed, input.is_sigma_assumed) {
                (true, _) => Term::Assumed,
                (false, true) => Term::HandSigmaAssumed,
                (false, false) => Term::Stated,
            };
            Fact::row(Value::Phrase(input.label.to_owned()), vec![value, Value::Term(source)])
        };
        FactTable::new(Term::HandInputs, self.inputs.iter().map(row).collect())
            .with_columns(&[Term::Value, Term::HandSource])
    }

    /// By how much the results move if one input is larger; none where no input moves them.
    pub fn sensitivity_table(&self) -> Option<FactTable> {
        let row = |of: &HandSensitivityReport| {
            let step = Value::Sigma(of.quantity, of.step);
            let name = Value::Joined(vec![Value::Phrase(of.label.to_owned()), step], " + ");
            let changes = of.changes.iter().zip(&self.results);
            let values = changes.map(|(change, result)| match change {
                Some(change) => Value::Number(result.quantity, *change),
                None => Value::Text(String::new()),
            });
            Fact::row(name, values.collect())
        };
        let rows = self.sensitivities.iter().map(row).collect();
        let columns = self.results.iter().map(|result| Value::Phrase(result.label.to_owned()));
        let table = FactTable::new(Term::HandSensitivities, rows);
        FactTable { columns: columns.collect(), ..table }.unless_empty()
    }

    /// The critical speed against the truth on marks of the 4DOF model; none of other methods.
    pub fn bias_table(&self) -> Option<FactTable> {
        let YawMarkBias { runs, mean_ratio, range, .. } = self.yaw_mark_bias.as_ref()?;
        let rows = runs.iter().map(|run| {
            let name = Value::Number(Quantity::Speed, run.true_speed_m_s);
            let values = vec![
                Value::Number(Quantity::Angle, run.steer_rad),
                Value::Number(Quantity::Length, run.radius_m),
                Value::Number(Quantity::Speed, run.mark_speed_m_s),
                Value::Share(run.mark_speed_m_s / run.true_speed_m_s),
            ];
            Fact::row(name, values)
        });
        let nothing = || Value::Text(String::new());
        let span = Value::span(range.map(Value::Share));
        let mean = Value::Joined(vec![Value::Share(*mean_ratio), span], "; ");
        let mean = vec![nothing(), nothing(), nothing(), mean];
        let mean = Fact::row(Value::Term(Term::HandBiasMean), mean);
        let columns =
            [Term::HandBiasSteer, Term::HandBiasRadius, Term::HandBiasSpeed, Term::HandBiasRatio];
        let table = FactTable::new(Term::HandBias, rows.chain([mean]).collect());
        Some(table.with_rows(Term::HandBiasTruth).with_columns(&columns))
    }
}
