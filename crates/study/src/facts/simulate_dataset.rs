//! The facts of the simulation of a data set.

use impactlab_core::compare::{ErrorSummary, MotionError};
use impactlab_core::numerics::Summary;
use impactlab_core::units::Quantity;
use impactlab_networks::pair::Compared;

use crate::facts::simulate::integration;
use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{ReplayedCaseReport, SimulateDatasetReport, SimulatedPair, SimulatedPairs};

impl SimulateDatasetReport {
    /// What the answer says: how far simulation and record lie apart, over all cases and in each, and
    /// which cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let own = || Value::Term(Term::OfEachCase);
        let vehicle = self.vehicle.as_ref().map_or_else(own, |name| Value::Text(name.clone()));
        let equations =
            self.equations.as_ref().map_or_else(own, |word| Value::Phrase(word.clone()));
        let of = vec![
            Fact::new(Term::Vehicle, vehicle),
            Fact::new(Term::Equations, equations),
            Fact::new(Term::Integration, integration(&self.integrator)),
        ];
        let cases = match &self.pairs {
            None => self.case_table(),
            Some(_) => self.pair_table(),
        };
        let tables = [FactTable::new(Term::Replay, of), cases, self.summary_table()];
        let contact = self.pairs.as_ref().map(contact_table);
        tables.into_iter().chain(contact).chain(left_out(&self.failures)).collect()
    }

    fn case_table(&self) -> FactTable {
        let row = |case: &ReplayedCaseReport| {
            let spin = case.spin.then_some(Value::Term(Term::Spin));
            let error = &case.error;
            let values = vec![
                spin.unwrap_or_else(|| Value::Text(String::new())),
                Value::Decimals(Quantity::Length, error.average_error_m, 3),
                Value::Decimals(Quantity::Length, error.final_error_m, 3),
                Value::Decimals(Quantity::Angle, error.final_heading_error_rad, 1),
                flags(case),
            ];
            Fact::row(Value::Text(case.case.clone()), values)
        };
        let columns = [
            Term::KindOfMotion,
            Term::PathError,
            Term::EndError,
            Term::EndHeadingError,
            Term::Flags,
        ];
        let rows = self.cases.iter().map(row).collect();
        FactTable::new(Term::ReplayedCases, rows).with_rows(Term::Case).with_columns(&columns)
    }

    /// A row for each recorded pair.
    fn pair_table(&self) -> FactTable {
        let length = |metres| Value::Decimals(Quantity::Length, metres, 2);
        let angle = |rad| Value::Decimals(Quantity::Angle, rad, 1);
        let errors = |error: &MotionError| {
            [
                length(error.average_error_m),
                length(error.final_error_m),
                angle(error.final_heading_error_rad),
            ]
        };
        let both = |compared: &Compared, quantity, decimals| {
            let value = |si| Value::Decimals(quantity, si, decimals);
            let recorded = compared.recorded.map(value);
            [value(compared.forecast), recorded.unwrap_or_else(|| Value::Text(String::new()))]
        };
        let row = |(case, pair): (&ReplayedCaseReport, &SimulatedPair)| {
            let values = errors(&case.error)
                .into_iter()
                .chain(errors(&pair.striking))
                .chain(both(&pair.contact_s, Quantity::Time, 2))
                .chain(both(&pair.impulse_n_s, Quantity::Impulse, 2))
                .chain([flags(case)]);
            Fact::row(Value::Text(case.case.clone()), values.collect())
        };
        let pairs = self.cases.iter().filter_map(|case| Some((case, case.pair.as_ref()?)));
        let rows = pairs.map(row).collect();
        FactTable::new(Term::ReplayedCases, rows).with_rows(Term::Case).with_columns(&[
            Term::StruckPathError,
            Term::StruckEndError,
            Term::StruckHeadingError,
            Term::StrikingPathError,
            Term::StrikingEndError,
            Term::StrikingHeadingError,
            Term::ContactTime,
            Term::ContactTimeRecorded,
            Term::ContactImpulse,
            Term::ContactImpulseRecorded,
            Term::Flags,
        ])
    }

    fn summary_table(&self) -> FactTable {
        let striking = self.pairs.as_ref().map(|pairs| (Term::StrikingVehicle, &pairs.striking));
        let groups = [
            (Term::AllCases, &self.overall),
            (Term::Spinning, &self.spinning),
            (Term::NotSpinning, &self.not_spinning),
        ];
        let groups = groups.into_iter().filter_map(|(group, all)| Some((group, all.as_ref()?)));
        let rows = groups.chain(striking).map(|(group, summary)| {
            let ErrorSummary { average_error_m, final_error_m, final_heading_error_rad, .. } =
                summary;
            let row = |error, quantity, summary: &Summary| {
                let Summary { n, mean, std, median, p90, max, .. } = *summary;
                let sizes = [mean, std, median, p90, max];
                let sizes = sizes.map(|si| Value::Decimals(quantity, si, 3));
                let values = [Value::Term(error), Value::Count(n)].into_iter().chain(sizes);
                Fact::row(Value::Term(group), values.collect())
            };
            [
                row(Term::PathError, Quantity::Length, average_error_m),
                row(Term::EndError, Quantity::Length, final_error_m),
                row(Term::EndHeadingError, Quantity::Angle, final_heading_error_rad),
            ]
        });
        let columns = [
            Term::ErrorKind,
            Term::Number,
            Term::Mean,
            Term::StandardDeviation,
            Term::Median,
            Term::Percentile90,
            Term::Largest,
        ];
        let rows = rows.flatten().collect();
        FactTable::new(Term::ReplaySummary, rows).with_rows(Term::Cases).with_columns(&columns)
    }
}

/// What is flagged in a case.
fn flags(case: &ReplayedCaseReport) -> Value {
    let flags: Vec<&str> = case.flags.iter().map(|flag| flag.caveat.text.as_str()).collect();
    Value::English(flags.join("; "))
}

/// The contact of recorded pairs.
fn contact_table(pairs: &SimulatedPairs) -> FactTable {
    let of = |term, value: Option<f64>, word: fn(f64) -> Value| {
        value.map(|value| Fact::new(term, word(value)))
    };
    let ratio = |value| Value::Fixed(value, 2);
    let facts = [
        of(Term::ContactTimeRatio, pairs.contact_ratio, ratio),
        of(Term::ContactTimeError, pairs.contact_error, Value::Share),
        of(Term::ContactImpulseRatio, pairs.impulse_ratio, ratio),
        of(Term::ContactImpulseError, pairs.impulse_error, Value::Share),
    ];
    FactTable::new(Term::ContactOfPairs, facts.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::UnitSystem;

    #[test]
    fn a_replay_is_in_the_chosen_units() {
        let error = MotionError {
            average_error_m: 0.3048,
            final_error_m: 3.048,
            final_heading_error_rad: 0.5_f64.to_radians(),
            horizon_error_m: [0.0; 4],
            rmse_x_m: 0.0,
            rmse_y_m: 0.0,
            rmse_vx_body_m_s: None,
            rmse_vy_body_m_s: None,
            rmse_yaw_rate_rad_s: None,
        };
        let case = ReplayedCaseReport {
            case: "c1".to_owned(),
            spin: true,
            error,
            violations: Some(0),
            pair: None,
            flags: Vec::new(),
        };
        let report = SimulateDatasetReport {
            dataset: "set".into(),
            vehicle: Some("car".to_owned()),
            equations: Some("corrected".to_owned()),
            integrator: "rk4".to_owned(),
            cases: vec![case],
            overall: None,
            spinning: None,
            not_spinning: None,
            pairs: None,
            failures: Vec::new(),
        };
        let text = report.case_table().to_text(&FactWriter::english(UnitSystem::Us));
        assert_eq!(text.rows[0].cells, ["c1", "spin", "1.000 ft", "10.000 ft", "0.5 deg", ""]);
        assert_eq!(text.header.len(), text.rows[0].cells.len());
        let of = report.facts()[0].to_text(&FactWriter::english(UnitSystem::Us));
        assert_eq!(of.rows[2].cells[1], "Runge–Kutta, 4th order");
    }
}
