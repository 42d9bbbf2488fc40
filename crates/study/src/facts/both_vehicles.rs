//! The facts of two vehicles that were followed through all contacts.

use impactlab_core::collision::PrincipalDirectionOfForce;
use impactlab_core::units::{Estimate, Quantity};
use impactlab_networks::pair::{Course, CourseShare};

use crate::StrikingReport;
use crate::analysis::{
    ContactPhaseReport, ContactsOutcome, MonteCarloError, PhaseForecast, PhaseOfVehicleForecast,
    PhaseOfVehicleReport,
};
use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};

/// Change of velocity below which an object does not move, m/s: a wall is solved with 10⁸ kg.
const FIXED_DELTA_V_M_S: f64 = 1e-3;

/// Columns of a table of phases of contact, the last two of the striking vehicle.
const PHASE_COLUMNS: [Term; 7] = [
    Term::PhaseStart,
    Term::PhaseDuration,
    Term::Impulse,
    Term::PhaseStruckDeltaV,
    Term::PhaseStruckPdof,
    Term::PhaseStrikingDeltaV,
    Term::PhaseStrikingPdof,
];

/// How many of them are of the striking vehicle.
const N_OF_STRIKING: usize = 2;

impl From<Course> for Term {
    fn from(course: Course) -> Self {
        match course {
            Course::Missed => Self::CourseMissed,
            Course::Across => Self::CourseAcross,
            Course::Hooked => Self::CourseHooked,
            Course::Recovers => Self::CourseRecovers,
            Course::Turns => Self::CourseTurns,
            Course::Spins => Self::CourseSpins,
        }
    }
}

/// What becomes of the struck vehicle; none where it was not asked.
///
/// - `n_draws`: of which these are shares.
pub(super) fn course_table(courses: &[CourseShare], n_draws: usize) -> Option<FactTable> {
    let row = |share: &CourseShare| {
        Fact::new(share.course.into(), Value::chance_of_draws(share.probability, n_draws))
    };
    FactTable::new(Term::StruckCourses, courses.iter().map(row).collect())
        .with_rows(Term::Course)
        .with_columns(&[Term::Probability])
        .unless_empty()
}

impl ContactsOutcome {
    /// When and how the vehicles are in contact.
    pub(super) fn tables(&self) -> Vec<FactTable> {
        [Some(self.table()), self.phase_table()].into_iter().flatten().collect()
    }

    fn table(&self) -> FactTable {
        let n_law = self.n_draws.saturating_sub(self.n_known_forces);
        let mut facts = vec![
            Fact::new(Term::FirstByLaw, Value::CountOf(n_law, self.n_draws)),
            Fact::new(
                Term::LongContact,
                Value::chance_of_draws(self.long_contact_probability, self.n_draws),
            ),
            Fact::new(
                Term::MeetAgain,
                Value::chance_of_draws(self.meet_again_probability, self.n_draws),
            ),
            Fact::drawn(Term::TimeInContact, Quantity::Time, &self.duration_s),
            Fact::drawn(Term::TotalImpulse, Quantity::Impulse, &self.impulse_n_s),
        ];
        let later = self.later_impulse_share.as_ref();
        facts.extend(later.map(|share| Fact::drawn(Term::LaterShare, Quantity::Ratio, share)));
        let scale = self.law_scale.as_ref();
        facts.extend(scale.map(|scale| Fact::drawn(Term::LawScale, Quantity::Ratio, scale)));
        if self.n_failed > 0 {
            facts.push(Fact::new(Term::LeftOut, Value::Count(self.n_failed)));
        }
        FactTable::new(Term::Contacts, facts).with_levels(PREDICTED)
    }

    /// The phases of contact, at their medians; none without any.
    fn phase_table(&self) -> Option<FactTable> {
        let row = |(number, phase): (usize, &PhaseForecast)| {
            let median = |quantity, it: &Estimate| Value::Rough(quantity, it.median);
            let of_vehicle = |it: &PhaseOfVehicleForecast| {
                let pdof = it.pdof_rad.as_ref().map(|angle| angle.median);
                [median(Quantity::Speed, &it.delta_v_m_s), pdof_value(pdof)]
            };
            let mut values = vec![
                Value::chance_of_draws(phase.probability, self.n_draws),
                median(Quantity::Time, &phase.start_s),
                median(Quantity::Time, &phase.duration_s),
                median(Quantity::Impulse, &phase.impulse_n_s),
            ];
            values.extend(of_vehicle(&phase.struck));
            values.extend(of_vehicle(&phase.striking));
            Fact::row(Value::Count(number + 1), values)
        };
        let rows = self.phases.iter().enumerate().map(row).collect();
        let columns: Vec<Term> = [Term::Probability].into_iter().chain(PHASE_COLUMNS).collect();
        let table = FactTable::new(Term::PhasesAtMedian, rows).with_rows(Term::Phase);
        table.with_columns(&columns).unless_empty()
    }
}

/// The phases of contact of a single motion; none without any. A wall or a pole has no change of velocity.
pub(super) fn phase_table(phases: &[ContactPhaseReport]) -> Option<FactTable> {
    let is_fixed = phases.iter().all(|phase| phase.striking.delta_v_m_s.abs() < FIXED_DELTA_V_M_S);
    let n_columns = PHASE_COLUMNS.len() - if is_fixed { N_OF_STRIKING } else { 0 };
    let columns: Vec<Term> = PHASE_COLUMNS.into_iter().take(n_columns).collect();
    let row = |(number, phase): (usize, &ContactPhaseReport)| {
        let duration = match phase.end_s {
            Some(end_s) => Value::Rough(Quantity::Time, end_s - phase.start_s),
            None => Value::Term(Term::ToTheEnd),
        };
        let [x, y] = phase.impulse_n_s;
        let of_vehicle = |it: &PhaseOfVehicleReport| {
            [Value::Rough(Quantity::Speed, it.delta_v_m_s), pdof_value(it.pdof_rad)]
        };
        let mut values = vec![
            Value::Rough(Quantity::Time, phase.start_s),
            duration,
            Value::Rough(Quantity::Impulse, x.hypot(y)),
        ];
        values.extend(of_vehicle(&phase.struck));
        values.extend(of_vehicle(&phase.striking));
        values.truncate(n_columns);
        Fact::row(Value::Count(number + 1), values)
    };
    let rows = phases.iter().enumerate().map(row).collect();
    let table = FactTable::new(Term::Phases, rows).with_rows(Term::Phase);
    table.with_columns(&columns).unless_empty()
}

/// A principal direction of force, clockwise from the heading within one turn, to the degree: that from straight
/// ahead is 0°, not 360°.
fn pdof_value(angle_rad: Option<f64>) -> Value {
    match angle_rad {
        Some(angle_rad) => {
            let pdof = PrincipalDirectionOfForce::from_angle(angle_rad);
            Value::Decimals(Quantity::Angle, pdof.written_rad(0), 0)
        }
        None => Value::Term(Term::NoImpulse),
    }
}

impl StrikingReport {
    /// How the motion of the striking vehicle ends.
    pub(super) fn table(&self) -> FactTable {
        let outcome = &self.outcome;
        let mut facts = vec![Fact::new(Term::Vehicle, Value::Name(self.vehicle.clone()))];
        match &self.rest {
            Some(rest) => facts.extend([
                Fact::new(Term::Followed, Value::Term(Term::UntilStruckRests)),
                Fact::new(Term::ShareAtRest, Value::ShareOfDraws(rest.share_at_rest, rest.n_draws)),
            ]),
            None => {
                let is_at_rest = outcome.is_at_rest;
                let end = if is_at_rest { Term::AtRestAfter } else { Term::StillMovingAfter };
                facts.push(Fact::new(end, Value::Rounded(Quantity::Time, outcome.time_s)));
            }
        }
        facts.extend([
            Fact::drawn(Term::EndX, Quantity::Length, &outcome.x_m),
            Fact::drawn(Term::EndY, Quantity::Length, &outcome.y_m),
            Fact::drawn(Term::HeadingChange, Quantity::Angle, &outcome.heading_change_rad),
            Fact::rough(Term::SpeedAtEnd, Quantity::Speed, outcome.speed_m_s),
        ]);
        let region = outcome.region_90_m2.filter(|_| self.rest.is_none());
        facts.extend(region.map(|area_m2| Fact::new(Term::Region90, Value::Area(area_m2))));
        facts.extend(outcome.monte_carlo.iter().flat_map(MonteCarloError::facts));
        if self.applicability < 1.0 {
            facts.push(Fact::new(Term::Applicability, Value::Share(self.applicability)));
        }
        FactTable::new(Term::StrikingForecast, facts).with_levels(PREDICTED)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::UnitSystem;

    /// A wall was told to have a Δv of 0 km/h from 270°, and the car one from 360°.
    #[test]
    fn a_wall_has_no_change_of_velocity_and_straight_ahead_is_no_whole_turn() {
        let of = |delta_v_m_s, pdof_deg: f64| PhaseOfVehicleReport {
            delta_v_m_s,
            pdof_rad: Some(pdof_deg.to_radians()),
        };
        let told = |striking| {
            let phase = ContactPhaseReport {
                start_s: 0.0,
                end_s: Some(0.1),
                impulse_n_s: [-22_000.0, 0.0],
                peak_force_n: 4e5,
                struck: of(16.0, 359.9),
                striking,
            };
            phase_table(&[phase]).unwrap().to_text(&FactWriter::english(UnitSystem::Si))
        };
        let [wall, car] = [told(of(2.2e-4, 270.0)), told(of(11.0, 180.2))];
        assert_eq!((wall.header.len(), wall.rows[0].cells.len()), (6, 6), "{:?}", wall.header);
        assert_eq!(wall.rows[0].cells[5], "0 deg");
        // A single motion knows a phase no better than the median of many.
        assert_eq!(wall.rows[0].cells[2..5], ["0.10 s", "22 kN s", "58 km/h"]);
        assert_eq!((car.header.len(), &*car.rows[0].cells[7]), (8, "180 deg"));
    }
}
