//! The force of the first contact by each method, and as it was recorded, side by side.

use impactlab_core::units::Quantity;

use crate::PredictMotionReport;
use crate::facts::impact::pdof_value;
use crate::facts::{Fact, FactTable, Term, Value};

impl PredictMotionReport {
    /// The force by network, momentum solution and record; none where nothing stands beside the force that
    /// moves the vehicle.
    pub fn force_table(&self) -> Option<FactTable> {
        let columns = [self.network_column(), self.momentum_column(), self.record_column()];
        let columns: Vec<(Term, [Value; 5])> = columns.into_iter().flatten().collect();
        let terms = [
            Term::ImpulseSize,
            Term::StruckDeltaV,
            Term::Pdof,
            Term::PeakForce,
            Term::ContactDuration,
        ];
        let row = |(idx, term): (usize, Term)| {
            let values = columns.iter().filter_map(|(_, values)| values.get(idx).cloned());
            Fact::row(term.into(), values.collect())
        };
        let facts = terms.into_iter().enumerate().map(row).collect();
        let titles: Vec<Term> = columns.iter().map(|(title, _)| *title).collect();
        let table = FactTable::new(Term::ForceByMethod, facts).with_columns(&titles);
        (!titles.is_empty()).then_some(table)
    }

    fn network_column(&self) -> Option<(Term, [Value; 5])> {
        let of = self.impulses.as_ref()?;
        let values = [
            Value::Estimate(Quantity::Impulse, of.network_impulse_n_s.clone()),
            Value::Estimate(Quantity::Speed, of.network_delta_v_m_s.clone()),
            Value::Estimate(Quantity::Angle, of.network_pdof_deg.scaled(1.0_f64.to_radians())),
            Value::Estimate(Quantity::Force, of.network_peak_n.clone()),
            Value::Estimate(Quantity::Time, of.network_duration_s.clone()),
        ];
        Some((Term::ByNetwork, values))
    }

    /// A momentum solution has no course of the force.
    fn momentum_column(&self) -> Option<(Term, [Value; 5])> {
        let of = self.impulses.as_ref()?;
        let values = [
            Value::Estimate(Quantity::Impulse, of.momentum_impulse_n_s.clone()),
            Value::Estimate(Quantity::Speed, of.momentum_delta_v_m_s.clone()),
            Value::Estimate(Quantity::Angle, of.momentum_pdof_deg.scaled(1.0_f64.to_radians())),
            Term::NoImpulse.into(),
            Term::NoImpulse.into(),
        ];
        Some((Term::ByMomentum, values))
    }

    fn record_column(&self) -> Option<(Term, [Value; 5])> {
        let of = self.recorded.as_ref()?;
        let number = |quantity, value: Option<f64>| match value {
            Some(value) => Value::Number(quantity, value),
            None => Term::NoImpulse.into(),
        };
        let values = [
            number(Quantity::Impulse, Some(of.impulse_magnitude_n_s)),
            number(Quantity::Speed, Some(of.delta_v_m_s)),
            of.force.pdof_deg.map_or_else(|| Term::NoImpulse.into(), pdof_value),
            number(Quantity::Force, Some(of.force.peak_n)),
            number(Quantity::Time, of.duration_s()),
        ];
        Some((Term::ByRecord, values))
    }
}
