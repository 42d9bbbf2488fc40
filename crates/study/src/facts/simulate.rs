//! The facts of the simulation of one vehicle.

use impactlab_core::units::Quantity;
use impactlab_core::vehicle::{Integrator, RoadSlope};

use crate::analysis::{MonteCarloError, RestOutcome, Sensitivity};
use crate::facts::both_vehicles::phase_table;
use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{
    ForceReport, FrictionZoneReport, ImpulseRival, RestState, SimulateReport, SkidReport,
    TireMarkReport, VehicleUncertainty, word,
};

impl SimulateReport {
    /// What the answer says: the motion, whether the force network gives the same impulse, the marks, and how
    /// its end varies with what the data sheet leaves open.
    pub fn facts(&self) -> Vec<FactTable> {
        let drawn = self.uncertainty.iter().flat_map(VehicleUncertainty::facts);
        let beside = self.rival.as_ref().map(ImpulseRival::table);
        let tables = [Some(self.motion_table()), self.contact_table(), beside, self.mark_table()];
        tables.into_iter().flatten().chain(drawn).collect()
    }

    /// The phases of contact of both vehicles; none where one was followed by itself.
    pub fn contact_table(&self) -> Option<FactTable> {
        phase_table(&self.contacts)
    }

    /// How the motion goes, with every input at its median.
    pub fn motion_table(&self) -> FactTable {
        FactTable::new(Term::Motion, self.motion())
    }

    fn motion(&self) -> Vec<Fact> {
        let mut facts = vec![
            Fact::new(Term::Vehicle, Value::Name(self.vehicle.clone())),
            Fact::new(Term::Equations, Value::Phrase(self.equations.clone())),
            Fact::new(Term::Integration, integration(&self.integrator)),
            Fact::new(Term::RoadFriction, Value::Given(Quantity::Ratio, self.friction)),
            Fact::new(Term::Duration, Value::Given(Quantity::Time, self.duration_s)),
        ];
        facts.extend(slope_facts(self.slope));
        facts.extend(self.skids.iter().map(SkidReport::fact));
        facts.extend(zones(&self.friction_zones));
        facts.extend(self.force.iter().flat_map(|force| force.facts(self.momentum.is_some())));
        let surface = self.momentum.as_ref().map(|momentum| momentum.surface());
        facts.extend(surface.map(|surface| Fact::new(Term::MomentumSurface, surface)));
        let delta_v = self.delta_v_m_s;
        let speed = |value| Fact::rough_vector(Term::DeltaVContact, Quantity::Speed, value);
        facts.extend(delta_v.map(speed));
        if let Some(end) = &self.end {
            facts.push(Fact::rough_vector(Term::EndPosition, Quantity::Length, [end.x_m, end.y_m]));
            let distance = self.distance_m;
            facts.extend(distance.map(|m| Fact::rough(Term::Distance, Quantity::Length, m)));
            facts.push(Fact::rough(Term::FinalHeading, Quantity::Angle, end.yaw_rad));
            let turn = self.largest_yaw_change_rad;
            facts.extend(turn.map(|rad| Fact::rough(Term::LargestTurn, Quantity::Angle, rad)));
            match &self.rest {
                Some(rest) => facts.extend(rest.facts()),
                None => facts.extend([
                    Fact::rough(Term::FinalSpeed, Quantity::Speed, end.speed_m_s),
                    Fact::new(Term::AtRest, Value::Term(Term::StillMoving)),
                ]),
            }
        }
        if let Some(error) = &self.error {
            let length = |term, m| Fact::number(term, Quantity::Length, m);
            facts.push(length(Term::AverageError, error.average_error_m));
            facts.push(length(Term::FinalError, error.final_error_m));
        }
        facts
    }

    /// The marks that tires leave; none without marks.
    pub fn mark_table(&self) -> Option<FactTable> {
        let columns = [
            Term::MarkCause,
            Term::MarkLength,
            Term::FromTime,
            Term::FromPlace,
            Term::ToTime,
            Term::ToPlace,
        ];
        let row = |mark: &TireMarkReport| {
            let wheel = [mark.vehicle, mark.wheel.label()].map(|of| Value::Phrase(of.to_owned()));
            let values = vec![
                Value::Phrase(mark.kind.label().to_owned()),
                Value::Decimals(Quantity::Length, mark.length_m, 1),
                Value::Decimals(Quantity::Time, mark.from_s, 2),
                Value::Place(mark.start_m),
                Value::Decimals(Quantity::Time, mark.to_s, 2),
                Value::Place(mark.end_m),
            ];
            Fact::row(Value::Joined(wheel.to_vec(), ", "), values)
        };
        let rows = self.tire_marks.iter().map(row).collect();
        let table = FactTable::new(Term::Marks, rows).with_rows(Term::Wheel);
        table.with_columns(&columns).unless_empty()
    }
}

/// What the method of integration of a report is called.
///
/// - `name`: its word in the report.
pub(super) fn integration(name: &str) -> Value {
    let known = Integrator::ALL.into_iter().find(|method| word(method) == name);
    Value::Phrase(known.map_or_else(|| name.to_owned(), |method| method.label().to_owned()))
}

/// Zones with their own friction, if there are any.
pub(super) fn zones(zones: &[FrictionZoneReport]) -> Option<Fact> {
    let zone = |zone: &FrictionZoneReport| {
        let name = Value::Text(zone.name.clone());
        Value::Joined(vec![name, Value::Given(Quantity::Ratio, zone.friction)], " ")
    };
    let all = Value::Joined(zones.iter().map(zone).collect(), "; ");
    (!zones.is_empty()).then(|| Fact::new(Term::FrictionZones, all))
}

/// Grade and cross slope of the road, where it has any.
fn slope_facts(slope: Option<RoadSlope>) -> impl Iterator<Item = Fact> {
    let facts = |RoadSlope { grade, cross_slope }| {
        [(Term::RoadGrade, grade), (Term::RoadCrossSlope, cross_slope)]
            .map(|(term, value)| Fact::new(term, Value::Given(Quantity::Ratio, value)))
    };
    slope.map(facts).into_iter().flatten()
}

impl ForceReport {
    /// - `is_rough`: whether it is the pulse of an impulse solution, which nobody has measured.
    fn facts(&self, is_rough: bool) -> Vec<Fact> {
        let words = |text: &str| Value::Phrase(text.replace('_', " "));
        let file = self.path.clone().map(|path| Fact::new(Term::ForceFile, Value::File(path)));
        let contact = self.contact_start_s.zip(self.contact_end_s).map(|(from_s, to_s)| {
            let ends = [from_s, to_s].map(|s| Value::Rounded(Quantity::Time, s));
            Fact::new(Term::Contact, Value::span(ends))
        });
        let (impulse, peak) = (Term::ImpulseOnStruck, Term::PeakForce);
        let size = match is_rough {
            true => [
                Fact::rough_vector(impulse, Quantity::Impulse, self.impulse_n_s),
                Fact::rough(peak, Quantity::Force, self.peak_n),
            ],
            false => [
                Fact::vector(impulse, Quantity::Impulse, self.impulse_n_s),
                Fact::number(peak, Quantity::Force, self.peak_n),
            ],
        };
        let facts = [
            Fact::new(Term::ForceAxes, words(&self.axes)),
            Fact::new(Term::ForceSampling, words(&self.sampling)),
            Fact::new(Term::YawMoment, words(self.yaw_moment)),
        ];
        file.into_iter().chain(facts).chain(size).chain(contact).collect()
    }
}

impl RestState {
    fn facts(&self) -> [Fact; 4] {
        [
            Fact::rough(Term::AtRestAfter, Quantity::Time, self.time_s),
            Fact::rough(Term::DistanceToRest, Quantity::Length, self.distance_m),
            Fact::rough_vector(Term::RestPosition, Quantity::Length, [self.x_m, self.y_m]),
            Fact::rough(Term::HeadingAtRest, Quantity::Angle, self.yaw_rad),
        ]
    }
}

impl VehicleUncertainty {
    /// How the end varies over the drawn vehicles, and which estimates it depends on.
    pub fn facts(&self) -> Vec<FactTable> {
        [Some(self.draw_table()), self.sensitivity_table()].into_iter().flatten().collect()
    }

    /// Which estimates the end depends on; none if no share is clear.
    pub fn sensitivity_table(&self) -> Option<FactTable> {
        sensitivity(&self.sensitivity)
    }

    /// How the end varies over the drawn vehicles.
    pub fn draw_table(&self) -> FactTable {
        let estimate = Fact::drawn;
        let mut facts = vec![Fact::new(Term::VehiclesDrawn, Value::Count(self.n_draws))];
        if self.n_failed > 0 {
            facts.push(Fact::new(Term::LeftOut, Value::Count(self.n_failed)));
        }
        facts.extend([
            estimate(Term::EndX, Quantity::Length, &self.x_m),
            estimate(Term::EndY, Quantity::Length, &self.y_m),
            estimate(Term::FinalHeading, Quantity::Angle, &self.yaw_rad),
            estimate(Term::FinalSpeed, Quantity::Speed, &self.speed_m_s),
        ]);
        facts.extend(self.rest.iter().flat_map(|rest| rest.facts(true)));
        facts.extend(self.monte_carlo.iter().flat_map(MonteCarloError::facts));
        let n = self.n_draws.saturating_sub(self.n_failed);
        let chance = |chance| Value::chance_of_draws(chance, n);
        let second = self.second_contact_probability.map(chance);
        facts.extend(second.map(|chance| Fact::new(Term::SecondContact, chance)));
        FactTable::new(Term::Draws, facts).with_levels(PREDICTED)
    }
}

impl MonteCarloError {
    /// How much of the intervals and of the region is chance.
    pub(super) fn facts(&self) -> [Fact; 2] {
        [
            Fact::new(Term::MonteCarlo, Value::Share(self.interval_share)),
            Fact::new(Term::MonteCarloRegion, Value::Area(self.region_90_m2)),
        ]
    }
}

impl RestOutcome {
    /// When, where and after what distance the vehicle comes to rest. Draws that still move count with
    /// where they are when they are followed no further; where they are more than a few, the names say so.
    ///
    /// - `is_known`: whether no second contact comes before, after which none of this has a probability.
    pub(crate) fn facts(&self, is_known: bool) -> Vec<Fact> {
        let mut facts = vec![
            Fact::new(Term::ShareAtRest, Value::ShareOfDraws(self.share_at_rest, self.n_draws)),
            Fact::new(Term::RestLimit, Value::Given(Quantity::Time, self.limit_s)),
        ];
        let [time, distance, x, y, heading] = match self.is_nearly_all_at_rest() {
            true => [
                Term::TimeToRest,
                Term::DistanceToRest,
                Term::RestX,
                Term::RestY,
                Term::HeadingAtRest,
            ],
            false => [
                Term::TimeToRestOrLimit,
                Term::DistanceToRestOrLimit,
                Term::RestXOrLimit,
                Term::RestYOrLimit,
                Term::HeadingAtRestOrLimit,
            ],
        };
        let estimates = [
            (time, Quantity::Time, &self.time_s),
            (distance, Quantity::Length, &self.distance_m),
            (x, Quantity::Length, &self.x_m),
            (y, Quantity::Length, &self.y_m),
            (heading, Quantity::Angle, &self.yaw_rad),
        ];
        facts.extend(estimates.map(|(term, quantity, estimate)| match is_known {
            true => Fact::drawn(term, quantity, estimate),
            false => Fact::drawn(term, quantity, &estimate.without_intervals()),
        }));
        let regions = [(Term::Region50, self.region_50_m2), (Term::Region90, self.region_90_m2)];
        let regions = regions.into_iter().filter(|_| is_known);
        let regions = regions.filter_map(|(term, area_m2)| Some((term, area_m2?)));
        facts.extend(regions.map(|(term, area_m2)| Fact::new(term, Value::Area(area_m2))));
        facts
    }
}

/// Shares of the estimates in the variance of the end, as far as they are more than chance; none if no
/// vehicles were drawn or no share is clear.
pub(super) fn sensitivity(shares: &[Sensitivity]) -> Option<FactTable> {
    let row = |share: &Sensitivity| {
        let values = [share.position_share, share.heading_share].map(Value::Share);
        Fact::row(Value::Phrase(share.label.to_owned()), values.to_vec())
    };
    let rows = shares.iter().filter(|share| share.is_clear()).map(row).collect();
    let columns = [Term::Position, Term::Heading];
    FactTable::new(Term::Sensitivity, rows).with_columns(&columns).unless_empty()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::UnitSystem;

    /// “33.50 m (x 33.44, y -2.037)” was told of one motion, whose end is known to some metres.
    #[test]
    fn a_single_motion_is_told_as_roughly_as_a_median_without_an_interval() {
        let (time_s, yaw_rad, distance_m) = (3.5134, -2.9, 163.96);
        let rest = RestState { time_s, x_m: 163.44, y_m: -2.037, yaw_rad, distance_m };
        let table = FactTable::new(Term::Motion, rest.facts().to_vec());
        let text = table.to_text(&FactWriter::english(UnitSystem::Si));
        let values: Vec<&str> = text.rows.iter().map(|row| row.cells[1].as_str()).collect();
        assert_eq!(values, ["3.5 s", "164 m", "163 m (x 163, y -2.0)", "-166 deg"]);
    }
}
