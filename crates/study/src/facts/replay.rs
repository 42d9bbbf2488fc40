//! The facts of a replay of a recorder.

use impactlab_core::units::Quantity;

use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{ReplayReport, ReplaySample};

impl ReplayReport {
    /// What the answer says: the car at the contact, its way, where it came from, and the recorded yaw rate.
    pub fn facts(&self) -> Vec<FactTable> {
        let tables = [self.contact_table(), self.way_table(), self.start_table()];
        tables.into_iter().chain(self.yaw_table()).chain([self.sample_table()]).collect()
    }

    /// The car at the first contact.
    pub fn contact_table(&self) -> FactTable {
        let at = &self.at_contact;
        let facts = vec![
            Fact::estimate(Term::RecorderSpeed, Quantity::Speed, &at.speed_m_s),
            Fact::estimate(Term::RecorderSideslip, Quantity::Angle, &at.sideslip_rad),
            Fact::estimate(
                Term::RecorderYawRateAtContact,
                Quantity::AngularVelocity,
                &at.yaw_rate_rad_s,
            ),
        ];
        FactTable::new(Term::RecorderAtContact, facts).with_levels(PREDICTED)
    }

    /// The way from the first sample to the first contact.
    pub fn way_table(&self) -> FactTable {
        let way = &self.travelled;
        let facts = vec![
            Fact::estimate(Term::RecorderAhead, Quantity::Length, &way.ahead_m),
            Fact::estimate(Term::RecorderLeft, Quantity::Length, &way.left_m),
            Fact::estimate(Term::RecorderTurn, Quantity::Angle, &way.turn_rad),
            Fact::estimate(Term::RecorderLength, Quantity::Length, &way.length_m),
            Fact::estimate(Term::RecorderFrictionUse, Quantity::Ratio, &self.friction_use),
        ];
        FactTable::new(Term::RecorderWay, facts).with_levels(PREDICTED)
    }

    /// Where the car was at the first sample.
    pub fn start_table(&self) -> FactTable {
        let start = &self.start;
        let facts = vec![
            Fact::estimate(Term::RecorderStartX, Quantity::Length, &start.x_m),
            Fact::estimate(Term::RecorderStartY, Quantity::Length, &start.y_m),
            Fact::estimate(Term::RecorderStartHeading, Quantity::Angle, &start.yaw_rad),
        ];
        FactTable::new(Term::RecorderStart, facts).with_levels(PREDICTED)
    }

    /// The recorded yaw rate against the computed one; none if none was recorded.
    pub fn yaw_table(&self) -> Option<FactTable> {
        let check = self.yaw_rate.as_ref()?;
        let difference = Value::Number(Quantity::AngularVelocity, check.difference_rad_s);
        let mut facts = vec![
            Fact::new(Term::RecorderYawDifference, difference),
            Fact::new(Term::RecorderYawDeviations, Value::Fixed(check.deviations, 1)),
        ];
        for (term, estimate) in [
            (Term::RecorderYawFactor, &check.factor),
            (Term::RecorderYawRatio, &check.implied_steering_ratio),
        ] {
            let estimate = estimate.as_ref();
            facts.extend(estimate.map(|of| Fact::estimate(term, Quantity::Ratio, of)));
        }
        if check.disagrees {
            facts.iter_mut().for_each(|fact| fact.is_warning = true);
        }
        Some(FactTable::new(Term::RecorderYawCheck, facts).with_levels(PREDICTED))
    }

    /// The recorded samples beside the computed motion.
    pub fn sample_table(&self) -> FactTable {
        let has_yaw_rate =
            self.samples.iter().any(|sample| sample.recorded_yaw_rate_rad_s.is_some());
        let row = |sample: &ReplaySample| {
            let recorded = sample.recorded_yaw_rate_rad_s;
            let recorded = recorded.map(|rate| Value::Number(Quantity::AngularVelocity, rate));
            let recorded = recorded.unwrap_or_else(|| Value::Text(String::new()));
            let computed = sample.yaw_rate_rad_s.clone();
            // Recorders round to whole units.
            let mut values = vec![Value::Decimals(Quantity::Speed, sample.recorded_speed_m_s, 1)];
            values.extend(has_yaw_rate.then_some(recorded));
            values.push(Value::Estimate(Quantity::AngularVelocity, computed));
            Fact::row(Value::Decimals(Quantity::Time, sample.recorder_time_s, 2), values)
        };
        let table = FactTable::new(Term::RecorderSamples, self.samples.iter().map(row).collect());
        let columns = [
            Some(Term::RecorderRecordedSpeed),
            has_yaw_rate.then_some(Term::RecorderRecordedYawRate),
            Some(Term::RecorderComputedYawRate),
        ];
        let columns: Vec<Term> = columns.into_iter().flatten().collect();
        table.with_rows(Term::RecorderTime).with_levels(PREDICTED).with_columns(&columns)
    }
}
