//! The facts of a predicted motion.

use impactlab_core::units::{Estimate, Quantity};
use impactlab_networks::response::LEAST_MOTIONS;

use crate::analysis::{
    ContactsOutcome, MonteCarloError, MotionOutcome, PlaceChance, RestOutcome, Rival, RivalForce,
};
use crate::caveats::domain::LEAST_APPLICABILITY;
use crate::facts::answer::name_of;
use crate::facts::both_vehicles::course_table;
use crate::facts::held::measurement_of;
use crate::facts::simulate::sensitivity;
use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::{Measured, Measurement};
use crate::{FlagReport, PredictMotionReport, StrikingReport};

impl PredictMotionReport {
    /// What the answer says: the five sentences of its card, and what they rest on.
    pub fn facts(&self) -> Vec<FactTable> {
        [self.answer_card()].into_iter().chain(self.detail_tables()).collect()
    }

    /// What stands below the card: how the motion ends, and what that depends on.
    pub fn detail_tables(&self) -> Vec<FactTable> {
        let numbers = Some(self.number_table());
        let first = [self.course_table(), numbers, self.force_table(), Some(self.motion_table())];
        let held = self.held_table();
        let last = [self.places_table(), self.rival_table(), self.sensitivity_table(), held];
        let tables = first.into_iter().flatten().chain(self.both_vehicles_tables());
        tables.chain(last.into_iter().flatten()).collect()
    }

    /// How often such intervals held; none where that was not measured on such forecasts.
    pub fn held_table(&self) -> Option<FactTable> {
        self.measurement()?.held_table(Some(self.tried_motion))
    }

    /// Where it was counted how often intervals of such forecasts held; none where it was not.
    pub(super) fn measurement(&self) -> Option<&'static Measurement> {
        let subject = match self.contacts {
            Some(_) => Measured::Pairs,
            None => Measured::ResponseNetwork,
        };
        measurement_of(subject, &self.response_model).filter(|_| self.is_measured())
    }

    /// Whether it is a forecast of the kind of which that was counted: the vehicles that were tried lie within what
    /// the network has learned from, and a single one was moved by a force that was known.
    fn is_measured(&self) -> bool {
        if self.contacts.is_none() {
            let is_force_known = self.force_model.is_none() && self.recorded.is_some();
            return is_force_known && self.is_end_known() && self.applicability >= 1.0;
        }
        let striking = self.striking.iter().map(|it| it.applicability);
        striking.chain([self.applicability]).all(|share| share >= LEAST_APPLICABILITY)
    }

    /// What becomes of the struck vehicle; none where it was followed by itself.
    pub fn course_table(&self) -> Option<FactTable> {
        let n_draws = self.contacts.as_ref().map_or(0, |contacts| contacts.n_draws);
        course_table(&self.courses, n_draws)
    }

    /// Which lanes, kerbs and zones of the site the vehicles come to; likewise, and none without a site.
    pub fn places_table(&self) -> Option<FactTable> {
        let n_draws = self.contacts.as_ref().map_or(0, |contacts| contacts.n_draws);
        let chance = |share: f64| Value::chance_of_draws(share, n_draws);
        let row = |place: &PlaceChance| {
            let shares = [
                place.struck_enters,
                place.struck_ends,
                place.striking_enters,
                place.striking_ends,
            ];
            Fact::row(name_of(place), shares.map(chance).to_vec())
        };
        FactTable::new(Term::PlacesOfSite, self.places.iter().map(row).collect())
            .with_rows(Term::PlaceOfSite)
            .with_columns(&[
                Term::StruckEnters,
                Term::StruckEndsThere,
                Term::StrikingEnters,
                Term::StrikingEndsThere,
            ])
            .unless_empty()
    }

    /// How the motion of the striking vehicle ends, and how the vehicles are in contact; likewise.
    pub fn both_vehicles_tables(&self) -> Vec<FactTable> {
        let striking = self.striking.as_ref().map(StrikingReport::table);
        let contacts = self.contacts.iter().flat_map(ContactsOutcome::tables);
        striking.into_iter().chain(contacts).collect()
    }

    /// Until when positions have a probability, s: to the first second contact, which is not computed.
    pub fn known_until_s(&self) -> f64 {
        self.flags.iter().map(FlagReport::known_until_s).fold(f64::INFINITY, f64::min)
    }

    /// Whether positions at the end have a probability.
    pub fn is_end_known(&self) -> bool {
        self.outcome.time_s <= self.known_until_s()
    }

    /// Takes from the end of the motion what has no probability after a second contact: intervals, regions and
    /// how likely it has turned, so that no reader of the answer finds them.
    pub(crate) fn without_probabilities_after_contact(mut self) -> Self {
        if !self.is_end_known() {
            let outcome = &self.outcome;
            let [x_m, y_m, heading_change_rad] =
                [&outcome.x_m, &outcome.y_m, &outcome.heading_change_rad]
                    .map(Estimate::without_intervals);
            self.outcome = MotionOutcome {
                x_m,
                y_m,
                heading_change_rad,
                region_90_m2: None,
                p_quarter_turn: None,
                p_half_turn: None,
                ..self.outcome
            };
            self.rest = self.rest.as_ref().map(RestOutcome::after_contact);
        }
        self
    }

    /// How the motion ends.
    pub fn motion_table(&self) -> FactTable {
        FactTable::new(Term::Forecast, self.motion()).with_levels(PREDICTED)
    }

    /// Whether the 4DOF model without a network says the same; none where it says nothing.
    pub fn rival_table(&self) -> Option<FactTable> {
        let rival = self.rival.as_ref()?;
        let (method, why) = match rival.force {
            RivalForce::Same => (Term::RivalSameForce, Term::NetworkCorrects),
            RivalForce::Momentum => (Term::RivalMomentum, Term::OtherForce),
        };
        let is_known = self.is_end_known();
        let agree = self.ends_verdict(rival);
        let mut facts = vec![
            Fact::new(Term::MethodsVerdict, Value::Term(agree)),
            Fact::new(Term::OtherMethod, Value::Term(method)),
            Fact::new(Term::ComparedAfter, Value::Rounded(Quantity::Time, rival.time_s)),
            Fact::new(Term::ForecastPlace, Value::RoughPlace(rival.forecast_m)),
            Fact::new(Term::RivalPlace, Value::RoughPlace([rival.x_m, rival.y_m])),
            Fact::new(
                Term::RivalHeading,
                Value::Decimals(Quantity::Angle, rival.heading_change_rad, 0),
            ),
            Fact::rough(Term::Apart, Quantity::Length, rival.apart_m),
            Fact::rough(Term::RivalError, Quantity::Length, rival.known_error_m),
        ];
        if is_known {
            facts.push(Fact::new(Term::RivalRegion, Value::Chance(rival.region_level, None)));
        }
        if agree != Term::MethodsAgree {
            facts.push(Fact::new(Term::WhyApart, Value::Term(why)));
        }
        Some(FactTable::new(Term::Agreement, facts))
    }

    /// Whether both methods end alike. After a second contact no place has a probability.
    pub(super) fn ends_verdict(&self, rival: &Rival) -> Term {
        let is_known = self.is_end_known();
        let is_in_region = is_known && rival.is_in_region();
        match (is_in_region, rival.is_within_known_error()) {
            (true, true) => Term::MethodsAgree,
            (true, false) => Term::AgreeInRegion,
            (false, true) if is_known => Term::AgreeWithinError,
            (false, true) => Term::AgreeWithinErrorAlone,
            (false, false) => Term::MethodsDisagree,
        }
    }

    /// Which estimates of the vehicle the end depends on; none if no share is clear.
    pub fn sensitivity_table(&self) -> Option<FactTable> {
        sensitivity(&self.sensitivity)
    }

    /// A probability over the draws. Those under one force, or of one vehicle, are not independent and
    /// count once, unless there is but one.
    pub(super) fn chance(&self, chance: f64) -> Value {
        let n = match (&self.contacts, self.n_drawn()) {
            (Some(contacts), _) => contacts.n_draws,
            (None, Some(n_drawn)) => n_drawn,
            (None, None) => LEAST_MOTIONS,
        };
        Value::chance_of_draws(chance, n)
    }

    /// How many forces or vehicles were drawn, whichever are fewer; none where there is one of each.
    fn n_drawn(&self) -> Option<usize> {
        [self.n_forces, self.n_vehicles].into_iter().filter(|n| *n > 1).min()
    }

    fn motion(&self) -> Vec<Fact> {
        let outcome = &self.outcome;
        let mut facts = vec![
            Fact::new(Term::Vehicle, Value::Name(self.vehicle.clone())),
            match self.force_model {
                Some(_) => Fact::new(Term::ForcesDrawn, Value::Count(self.n_forces)),
                None => Fact::new(Term::MovedBy, Value::Term(Term::GivenForce)),
            },
        ];
        let n_pulses = self.n_momentum_pulses();
        if n_pulses > 0 {
            facts.push(Fact::new(Term::PulsesDrawn, Value::Count(n_pulses)));
        }
        facts.extend(self.force.clone().map(|path| Fact::new(Term::ForceFile, Value::File(path))));
        if self.n_vehicles > 0 {
            facts.push(Fact::new(Term::VehiclesDrawn, Value::Count(self.n_vehicles)));
        }
        let is_known = self.is_end_known();
        match &self.rest {
            Some(rest) => facts.extend(rest.facts(is_known)),
            None => {
                let end =
                    if outcome.is_at_rest { Term::AtRestAfter } else { Term::StillMovingAfter };
                facts.push(Fact::new(end, Value::Rounded(Quantity::Time, outcome.time_s)));
            }
        }
        // A motion to rest has said its end with the rest.
        if self.rest.is_none() {
            facts.extend([
                Fact::drawn(Term::EndX, Quantity::Length, &outcome.x_m),
                Fact::drawn(Term::EndY, Quantity::Length, &outcome.y_m),
            ]);
        }
        facts.extend([Fact::drawn(
            Term::HeadingChange,
            Quantity::Angle,
            &outcome.heading_change_rad,
        )]);
        if !outcome.stands(self.rest.as_ref()) {
            facts.extend([
                Fact::rough(Term::SpeedAtEnd, Quantity::Speed, outcome.speed_m_s),
                Fact::rough(Term::YawRateAtEnd, Quantity::AngularVelocity, outcome.yaw_rate_rad_s),
            ]);
        }
        let contacts = self.flags.iter().filter_map(|flag| flag.contact);
        let second = contacts.filter_map(|contact| contact.probability);
        facts.extend(second.map(|share| Fact::new(Term::SecondContact, self.chance(share))));
        let region = outcome.region_90_m2.filter(|_| self.rest.is_none() && is_known);
        facts.extend(region.map(|area_m2| Fact::new(Term::Region90, Value::Area(area_m2))));
        let error = outcome.monte_carlo.iter().filter(|_| is_known);
        facts.extend(error.flat_map(MonteCarloError::facts));
        let hooking = self.hooking_probability;
        facts.extend(hooking.map(|chance| Fact::new(Term::Hooking, Value::Chance(chance, None))));
        facts.extend(self.implied_contact.iter().flat_map(|implied| implied.facts()));
        if self.applicability < 1.0 {
            facts.push(Fact::new(Term::Applicability, Value::Share(self.applicability)));
        }
        facts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caveats::restrictions::predicted_motion_caveats;
    use crate::facts::FactWriter;
    use crate::facts::answer::tests::forecast;
    use crate::{ForceReport, RecordedImpulse, TriedMotion};
    use impactlab_core::numerics::share_standard_error;
    use impactlab_core::uncertainty::CaveatKind;
    use impactlab_core::units::UnitSystem;

    /// Of a car of 400 kg, of which the network has half a say, it was told that intervals had held in 45 of 48
    /// motions of cars that it knows.
    #[test]
    fn what_held_is_not_told_of_vehicles_that_the_network_does_not_know() {
        let report = forecast(None);
        assert!(report.held_table().is_some());
        let light = PredictMotionReport { applicability: 0.495, ..report.clone() };
        let mut heavy = report;
        heavy.striking.as_mut().unwrap().applicability = 0.02;
        for report in [light, heavy] {
            assert_eq!(report.held_table(), None);
            let card = report.answer_card().to_text(&FactWriter::english(UnitSystem::Si));
            let sureness = &card.rows[3].cells[1];
            assert!(sureness.contains("it was not counted"), "{sureness}");
        }
    }

    /// A car that a pulse of the momentum solution moves, whose impulse is off by a quarter, was told what had held
    /// of cars under the force that was recorded.
    #[test]
    fn what_held_under_a_recorded_force_is_not_told_of_another_force() {
        let force = ForceReport {
            path: None,
            sampling: "instant".to_owned(),
            axes: "world".to_owned(),
            impulse_n_s: [0.0, 3000.0],
            peak_n: 6e4,
            peak_time_s: 0.05,
            pdof_deg: None,
            pdof_clock: None,
            contact_start_s: Some(0.0),
            contact_end_s: Some(0.1),
            yaw_moment: "recorded",
        };
        let (impulse_magnitude_n_s, delta_v_m_s) = (3000.0, 1.5);
        let recorded = RecordedImpulse { force, impulse_magnitude_n_s, delta_v_m_s };
        let predicted = PredictMotionReport {
            contacts: None,
            striking: None,
            tried_motion: TriedMotion::Coasting,
            recorded: Some(recorded),
            ..forecast(None)
        };
        let by_record = PredictMotionReport { force_model: None, ..predicted.clone() };
        let by_pulse = PredictMotionReport { recorded: None, ..by_record.clone() };
        let is_told = |report: &PredictMotionReport| report.held_table().is_some();
        assert!(predicted.force_model.is_some());
        assert_eq!([&by_record, &by_pulse, &predicted].map(is_told), [true, false, false]);
    }

    /// Draws that could not be followed stood in a table of details alone, and the others told of all.
    #[test]
    fn draws_that_could_not_be_followed_restrict_the_answer() {
        let mut report = forecast(None);
        let left_out = |report: &PredictMotionReport| {
            let caveats = predicted_motion_caveats(report, &[]).into_iter();
            caveats
                .filter(|it| it.kind == CaveatKind::LeftOut)
                .map(|it| it.text)
                .collect::<Vec<_>>()
        };
        assert_eq!(left_out(&report), [""; 0]);
        report.contacts.as_mut().unwrap().n_failed = 3;
        assert_eq!(left_out(&report), ["3 draws of the forecast could not be used"]);
    }

    /// The region that holds an end far beside the forecast was one “of 100.0 %”.
    #[test]
    fn no_region_of_a_forecast_is_certain() {
        let mut report = forecast(None);
        for (level, told) in [(1.0, "> 99.9 %"), (0.392, "39.2 %"), (0.0, "< 0.1 %")] {
            report.rival.as_mut().unwrap().region_level = level;
            let table = report.rival_table().unwrap();
            let text = table.to_text(&FactWriter::english(UnitSystem::Si));
            assert!(text.rows.iter().any(|row| row.cells[1] == told), "{told}: {text:?}");
        }
    }

    #[test]
    fn many_vehicles_under_few_forces_do_not_make_a_chance_surer() {
        let report = PredictMotionReport { contacts: None, ..forecast(None) };
        let with = |n_forces, n_vehicles| {
            PredictMotionReport { n_forces, n_vehicles, ..report.clone() }.chance(0.3)
        };
        let of = |n: usize| Value::Chance(0.3, Some(share_standard_error(0.3, n as f64)));
        assert_eq!([with(10, 32), with(10, 0)], [of(10), of(10)]);
        // A given force is one, and is known.
        assert_eq!([with(1, 32), with(1, 0)], [of(32), of(LEAST_MOTIONS)]);
    }
}
