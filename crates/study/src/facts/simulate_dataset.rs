//! The facts of the simulation of a data set.

use impactlab_core::compare::ErrorSummary;
use impactlab_core::numerics::Summary;
use impactlab_core::units::Quantity;

use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{ReplayedCaseReport, SimulateDatasetReport};

impl SimulateDatasetReport {
    /// What the answer says: how far simulation and record lie apart, over all cases and in each, and
    /// which cases are left out.
    pub fn facts(&self) -> Vec<FactTable> {
        let of = vec![
            Fact::new(Term::Vehicle, Value::Text(self.vehicle.clone())),
            Fact::new(Term::Equations, Value::Phrase(self.equations.clone())),
            Fact::new(Term::Integration, Value::Phrase(self.integrator.clone())),
        ];
        let tables = [FactTable::new(Term::Replay, of), self.case_table(), self.summary_table()];
        tables.into_iter().chain(left_out(&self.failures)).collect()
    }

    fn case_table(&self) -> FactTable {
        let row = |case: &ReplayedCaseReport| {
            let flags: Vec<&str> = case.flags.iter().map(|f| f.caveat.text.as_str()).collect();
            let spin = case.spin.then_some(Value::Term(Term::Spin));
            let error = &case.error;
            let values = vec![
                spin.unwrap_or_else(|| Value::Text(String::new())),
                Value::Decimals(Quantity::Length, error.average_error_m, 3),
                Value::Decimals(Quantity::Length, error.final_error_m, 3),
                Value::Decimals(Quantity::Angle, error.final_heading_error_rad, 1),
                Value::English(flags.join("; ")),
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

    fn summary_table(&self) -> FactTable {
        let groups = [
            (Term::AllCases, &self.overall),
            (Term::Spinning, &self.spinning),
            (Term::NotSpinning, &self.not_spinning),
        ];
        let rows = groups.into_iter().flat_map(|(group, summary)| {
            let ErrorSummary { average_error_m, final_error_m, final_heading_error_rad, .. } =
                summary.as_ref()?;
            let row = |error, quantity, summary: &Summary| {
                let Summary { n, mean, std, median, p90, max, .. } = *summary;
                let sizes = [mean, std, median, p90, max];
                let sizes = sizes.map(|si| Value::Decimals(quantity, si, 3));
                let values = [Value::Term(error), Value::Count(n)].into_iter().chain(sizes);
                Fact::row(Value::Term(group), values.collect())
            };
            Some([
                row(Term::PathError, Quantity::Length, average_error_m),
                row(Term::EndError, Quantity::Length, final_error_m),
                row(Term::EndHeadingError, Quantity::Angle, final_heading_error_rad),
            ])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::compare::MotionError;
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
            violations: 0,
            flags: Vec::new(),
        };
        let report = SimulateDatasetReport {
            dataset: "set".into(),
            vehicle: "car".to_owned(),
            equations: "corrected".to_owned(),
            integrator: "rk4".to_owned(),
            cases: vec![case],
            overall: None,
            spinning: None,
            not_spinning: None,
            failures: Vec::new(),
        };
        let text = report.case_table().to_text(&FactWriter::english(UnitSystem::Us));
        assert_eq!(text.rows[0].cells, ["c1", "spin", "1.000 ft", "10.000 ft", "0.5 deg", ""]);
        assert_eq!(text.header.len(), text.rows[0].cells.len());
    }
}
