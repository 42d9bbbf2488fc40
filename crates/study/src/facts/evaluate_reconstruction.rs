//! The facts of an evaluation of reconstructions.

use impactlab_core::units::Quantity;
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_reconstruct::evaluate::{MethodSummary, QuantitySummary, SCORED};

use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{EvaluateReconstructionReport, word};

impl EvaluateReconstructionReport {
    /// What the answer says: how well each method finds each quantity, what time it takes, and which
    /// cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let cases = vec![Value::Count(self.n_cases), Value::Phrase(word(&self.split))];
        let mut facts = vec![
            Fact::new(Term::Cases, Value::Joined(cases, ", ")),
            Fact::new(Term::Particles, Value::Count(self.n_particles)),
        ];
        if self.stopped {
            facts.push(Fact::new(Term::Stopped, Value::Term(Term::StoppedEarly)));
        }
        let times = FactTable::new(Term::CaseTimes, self.summary.iter().map(time_row).collect())
            .with_rows(Term::KnownEvidence)
            .with_columns(&[
                Term::Method,
                Term::Cases,
                Term::Median,
                Term::Percentile90,
                Term::SufficientEss,
            ]);
        let scored = SCORED.into_iter().filter_map(|quantity| self.quantity_table(quantity));
        let first = FactTable::new(Term::StagedCollisions, facts);
        let tables = std::iter::once(first).chain(scored).chain([times]);
        tables.chain(left_out(&self.left_out)).collect()
    }

    fn quantity_table(&self, quantity: ReconstructedQuantity) -> Option<FactTable> {
        let row = |summary: &MethodSummary| {
            let of = summary.quantities.iter().find(|of| of.name == quantity.key())?;
            Some(quantity_row(summary, of, quantity.quantity()))
        };
        let title = [Value::Phrase(quantity.label().to_owned()), Term::TruthsInIntervals.into()];
        let table = FactTable::new(
            Value::Joined(title.to_vec(), ": "),
            self.summary.iter().filter_map(row).collect(),
        );
        let columns = [
            Term::Method,
            Term::Number,
            Term::Level50,
            Term::Level80,
            Term::Level90,
            Term::Level95,
            Term::MedianSizeOfError,
            Term::MedianError,
            Term::MedianWidth,
            Term::MeanCrps,
        ];
        table.with_rows(Term::KnownEvidence).with_columns(&columns).unless_empty()
    }
}

fn quantity_row(summary: &MethodSummary, of: &QuantitySummary, quantity: Quantity) -> Fact {
    let coverage = [of.coverage_50, of.coverage_80, of.coverage_90, of.coverage_95];
    let sizes = [of.median_absolute_error, of.median_error, of.median_width_90, of.mean_crps];
    let sizes = sizes.map(|si| Value::Decimals(quantity, si, 2));
    let values = [Value::Phrase(summary.method.label().to_owned()), Value::Count(of.n)];
    let values = values.into_iter().chain(coverage.map(Value::Share)).chain(sizes);
    Fact::row(Value::Phrase(summary.known.label().to_owned()), values.collect())
}

fn time_row(summary: &MethodSummary) -> Fact {
    let seconds = |s| Value::Decimals(Quantity::Time, s, 1);
    let sufficient = summary.n_sufficient_ess.map(Value::Count);
    let values = vec![
        Value::Phrase(summary.method.label().to_owned()),
        Value::Count(summary.n_cases),
        seconds(summary.median_seconds),
        seconds(summary.p90_seconds),
        sufficient.unwrap_or_else(|| Value::Text(String::new())),
    ];
    Fact::row(Value::Phrase(summary.known.label().to_owned()), values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::UnitSystem;
    use impactlab_reconstruct::evaluate::{
        KnownEvidence, ReconstructionMethod, SUFFICIENT_ESS, StagedSplit,
    };

    #[test]
    fn each_speed_that_a_method_knows_has_a_table_in_the_chosen_units() {
        let quantity = QuantitySummary {
            name: SCORED[0].key(),
            unit: "m/s",
            n: 4,
            coverage_50: 0.5,
            coverage_80: 0.75,
            coverage_90: 1.0,
            coverage_95: 1.0,
            median_absolute_error: 0.447_04,
            median_error: -0.447_04,
            median_width_90: 4.4704,
            mean_crps: 0.223_52,
        };
        let summary = MethodSummary {
            known: KnownEvidence::RestOnly,
            method: ReconstructionMethod::ALL[0],
            n_cases: 4,
            median_seconds: 1.25,
            p90_seconds: 2.0,
            n_sufficient_ess: Some(3),
            quantities: vec![quantity],
        };
        let report = EvaluateReconstructionReport {
            data: "staged".into(),
            split: StagedSplit::All,
            n_cases: 4,
            n_particles: 100,
            stopped: true,
            summary: vec![summary],
            cases: Vec::new(),
            left_out: Vec::new(),
        };
        let texts: Vec<_> = report.facts();
        let texts: Vec<_> =
            texts.iter().map(|of| of.to_text(&FactWriter::english(UnitSystem::Us))).collect();
        let [facts, speed, times] = &texts[..] else { panic!("{texts:?}") };
        assert_eq!(facts.rows.len(), 3);
        assert_eq!(speed.rows[0].cells[7..], ["1.00 mph", "-1.00 mph", "10.00 mph", "0.50 mph"]);
        assert!([speed, times].iter().all(|of| of.header.len() == of.rows[0].cells.len()));
        assert!(times.header[5].contains(&format!("{SUFFICIENT_ESS}")), "{:?}", times.header);
    }
}
