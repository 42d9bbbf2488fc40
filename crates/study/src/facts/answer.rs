//! The numbers of the answer to a forecast in one table: does it spin, where does it stop, does it come into
//! another lane, do the methods agree, and what does it hinge on?

use impactlab_core::units::{Estimate, Quantity};

use crate::analysis::{FEWEST_DRAWS, MotionOutcome, PlaceChance, RestOutcome, Sensitivity};
use crate::facts::table::PREDICTED;
use crate::facts::{Fact, FactTable, Term, Value};
use crate::{ImpulseRival, PredictMotionReport};

/// Share of the variance of the end from which on an estimate is named.
const NAMED_SHARE: f64 = 0.1;

/// Lanes, kerbs and zones that are named of each vehicle.
const N_PLACES: usize = 3;

/// What a lane, a kerb or a zone is called: as in the file of the site, or a name of the program.
pub(super) fn name_of(place: &PlaceChance) -> Value {
    match place.is_unnamed {
        true => Value::Name(place.name.clone()),
        false => Value::Text(place.name.clone()),
    }
}

impl PredictMotionReport {
    /// The answer in one table.
    pub fn answer_table(&self) -> FactTable {
        let mut facts = vec![
            Fact::new(Term::QuarterTurn, self.turn_chance(self.outcome.p_quarter_turn)),
            Fact::new(Term::HalfTurn, self.turn_chance(self.outcome.p_half_turn)),
        ];
        facts.extend(self.end_facts());
        facts.extend(self.place_facts());
        facts.extend(match &self.impulses {
            Some(impulses) => self.impulse_facts(impulses),
            None => self.law_facts(),
        });
        let verdict = self.rival.as_ref().map(|rival| self.ends_verdict(rival));
        facts.extend(verdict.map(|term| Fact::new(Term::EndsVerdict, Value::Term(term))));
        facts.extend(self.hinges().map(|value| Fact::new(Term::HingesOn, value)));
        FactTable::new(Term::AnswerNumbers, facts).with_levels(PREDICTED)
    }

    /// The same without what its card says in full.
    pub(super) fn number_table(&self) -> FactTable {
        let table = self.answer_table();
        let in_card = [Term::EndsVerdict, Term::ImpulsesVerdict, Term::HingesOn].map(Value::Term);
        let facts = table.facts.into_iter().filter(|fact| !in_card.contains(&fact.name)).collect();
        FactTable { facts, ..table }
    }

    /// Probability of a turn, which has none after a second contact.
    fn turn_chance(&self, chance: Option<f64>) -> Value {
        chance.map_or(Term::AfterSecondContact.into(), |chance| self.chance(chance))
    }

    /// Where it stops, or where it is and how fast.
    fn end_facts(&self) -> Vec<Fact> {
        let outcome = &self.outcome;
        match &self.rest {
            Some(rest) => {
                // Draws that still move count with where they are then.
                let term = match rest.is_nearly_all_at_rest() {
                    true => Term::WhereAtRest,
                    false => Term::WhereAtRestOrLimit,
                };
                let share = Value::ShareOfDraws(rest.share_at_rest, rest.n_draws);
                let place = place_at(&rest.x_m, &rest.y_m);
                vec![Fact::new(Term::ShareAtRest, share), Fact::new(term, place)]
            }
            None => {
                let term = match outcome.is_at_rest {
                    true => Term::WhereAtRest,
                    false => Term::WhereAtEnd,
                };
                let place = place_at(&outcome.x_m, &outcome.y_m);
                let after = Value::Given(Quantity::Time, outcome.time_s);
                let text = vec![place, after];
                vec![Fact::new(term, Value::Joined(text, "; t = "))]
            }
        }
    }

    /// Probability over the draws of both vehicles.
    pub(super) fn place_chance(&self, share: f64) -> Value {
        let n_draws = self.contacts.as_ref().map_or(0, |contacts| contacts.n_draws);
        Value::chance_of_draws(share, n_draws)
    }

    /// The likeliest lanes, kerbs and zones that the struck and the striking vehicle come over and were not
    /// on.
    pub(super) fn entered_places(&self) -> [Vec<&PlaceChance>; 2] {
        let likeliest = |starts: fn(&PlaceChance) -> bool, enters: fn(&PlaceChance) -> f64| {
            let entered = |place: &&PlaceChance| !starts(place) && enters(place) > 0.0;
            let mut places: Vec<&PlaceChance> = self.places.iter().filter(entered).collect();
            places.sort_by(|a, b| enters(b).total_cmp(&enters(a)));
            places.truncate(N_PLACES);
            places
        };
        [
            likeliest(|it| it.struck_starts, |it| it.struck_enters),
            likeliest(|it| it.striking_starts, |it| it.striking_enters),
        ]
    }

    fn place_facts(&self) -> Vec<Fact> {
        let named = |term: Term, place: &PlaceChance, share: f64| {
            let name = vec![Value::Term(term), name_of(place)];
            Fact::row(Value::Joined(name, " "), vec![self.place_chance(share)])
        };
        let [struck, striking] = self.entered_places();
        let struck_end = match self.outcome.stands(self.rest.as_ref()) {
            true => Term::StruckEndsOver,
            false => Term::StruckIsOver,
        };
        // The striking vehicle is followed until the struck one stands, and may drive on.
        let of_striking = self.striking.as_ref();
        let striking_stands = of_striking.is_some_and(|of| of.outcome.stands(of.rest.as_ref()));
        let striking_end = match striking_stands {
            true => Term::StrikingEndsOver,
            false => Term::StrikingIsOver,
        };
        let struck = struck.into_iter().flat_map(|place| {
            [
                named(Term::StruckComesOver, place, place.struck_enters),
                named(struck_end, place, place.struck_ends),
            ]
        });
        let striking = striking.into_iter().flat_map(|place| {
            [
                named(Term::StrikingComesOver, place, place.striking_enters),
                named(striking_end, place, place.striking_ends),
            ]
        });
        struck.chain(striking).collect()
    }

    /// The impulse of the first contact by both methods and as recorded, the one that moves the vehicle first.
    fn impulse_facts(&self, impulses: &ImpulseRival) -> Vec<Fact> {
        let network = (Term::NetworkImpulse, &impulses.network_impulse_n_s);
        let momentum = (Term::MomentumImpulse, &impulses.momentum_impulse_n_s);
        let (moved_by, both) = match (&self.force_model, &self.recorded) {
            (Some(_), _) if self.is_first_by_law() => (self.without_network(), [network, momentum]),
            (Some(_), _) => (Term::ForceNetwork, [network, momentum]),
            (None, None) => (Term::MomentumSolution, [momentum, network]),
            (None, Some(_)) => (Term::Record, [momentum, network]),
        };
        let estimate = |(term, of): (Term, &Estimate)| Fact::estimate(term, Quantity::Impulse, of);
        let record = self.recorded.as_ref().map(|it| {
            Fact::number(Term::RecordImpulse, Quantity::Impulse, it.impulse_magnitude_n_s)
        });
        // Of the contact law, which neither of both is.
        let by_law = self.contacts.as_ref().filter(|_| self.is_first_by_law());
        let by_law = by_law.map(|contacts| (Term::TotalImpulse, &contacts.impulse_n_s));
        let mut sizes: Vec<Fact> = by_law.into_iter().chain(both).map(estimate).collect();
        let place = if moved_by == Term::Record { 0 } else { sizes.len() };
        sizes.splice(place..place, record);
        let verdict = Fact::new(Term::ImpulsesVerdict, Value::Term(impulses.verdict()));
        let moved_by = Fact::new(Term::MovedFirstBy, Value::Term(moved_by));
        [moved_by].into_iter().chain(sizes).chain([verdict]).collect()
    }

    /// The impulse of the contact law beside that of the momentum solution, where the force network says nothing.
    fn law_facts(&self) -> Vec<Fact> {
        let Some(contacts) = self.contacts.as_ref().filter(|_| self.is_first_by_law()) else {
            return Vec::new();
        };
        let momentum = self.implied_contact.as_ref().map(|implied| {
            let impulse_n_s = implied.momentum.impulse_n_s;
            Fact::rough_vector(Term::MomentumBeside, Quantity::Impulse, impulse_n_s)
        });
        let by_law = vec![
            Fact::new(Term::MovedFirstBy, Value::Term(self.without_network())),
            Fact::estimate(Term::TotalImpulse, Quantity::Impulse, &contacts.impulse_n_s),
        ];
        by_law.into_iter().chain(momentum).collect()
    }

    /// Whether the first contact follows from the contact law in most draws, since the force network hardly
    /// applies.
    fn is_first_by_law(&self) -> bool {
        self.contacts.is_some() && self.force_applicability.is_some_and(|share| share < 0.5)
    }

    /// What the first contact follows from where the force network does not apply.
    fn without_network(&self) -> Term {
        if self.n_momentum_pulses() > 0 { Term::LawAndMomentum } else { Term::ContactLaw }
    }

    /// Draws whose first contact is the momentum solution in place of the contact law.
    pub(crate) fn n_momentum_pulses(&self) -> usize {
        let contacts = self.contacts.as_ref().filter(|_| self.force_model.is_some());
        contacts.map_or(0, |contacts| contacts.n_known_forces.saturating_sub(self.n_forces))
    }

    /// Estimates of vehicle and road that the end depends on; none where so few vehicles were drawn that one
    /// of many estimates goes with the end by chance.
    pub(super) fn hinges(&self) -> Option<Value> {
        let named = |share: &&Sensitivity| {
            share.is_clear() && share.position_share.max(share.heading_share) >= NAMED_SHARE
        };
        let text = |share: &Sensitivity| {
            let part =
                |of: f64, term| Value::Joined(vec![Value::Share(of), Value::Term(term)], " ");
            let parts = vec![
                Value::Phrase(share.label.to_owned()),
                part(share.position_share, Term::OfPlace),
                part(share.heading_share, Term::OfHeading),
            ];
            Value::Joined(parts, ", ")
        };
        let all: Vec<Value> = self.sensitivity.iter().filter(named).map(text).collect();
        let value = match all.is_empty() {
            true => Value::Term(Term::HingesOnNone),
            false => Value::Joined(all, "; "),
        };
        (self.n_vehicles >= FEWEST_DRAWS).then_some(value)
    }
}

/// A place with its intervals.
pub(super) fn place_at(x_m: &Estimate, y_m: &Estimate) -> Value {
    let of = |axis: &str, estimate: &Estimate| {
        let estimate = Value::drawn(Quantity::Length, estimate);
        Value::Joined(vec![Value::Text(axis.to_owned()), estimate], " ")
    };
    Value::Joined(vec![of("X", x_m), of("Y", y_m)], ", ")
}

impl MotionOutcome {
    /// Whether the vehicle stands where its motion ends, in nearly all draws.
    ///
    /// - `rest`: where and when it comes to rest, of a motion that is followed to there.
    pub(crate) fn stands(&self, rest: Option<&RestOutcome>) -> bool {
        rest.map_or(self.is_at_rest, RestOutcome::is_nearly_all_at_rest)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::analysis::PulseSetup;
    use crate::facts::FactWriter;
    use crate::{
        ForceSource, Library, MotionSource, PredictMotionRequest, Question, ScenarioChoice,
    };
    use impactlab_core::collision::{ContactLocation, Scenario, Side};
    use impactlab_core::units::UnitSystem;

    pub fn forecast(force: Option<ForceSource>) -> PredictMotionReport {
        forecast_of(Scenario::example(), force)
    }

    fn forecast_of(scenario: Scenario, force: Option<ForceSource>) -> PredictMotionReport {
        let scenario = ScenarioChoice::Inline(Box::new(scenario));
        let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
        let force = force.unwrap_or_else(|| ForceSource::usual(&source));
        let request = PredictMotionRequest { draws: 8, ..PredictMotionRequest::new(source, force) };
        let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap();
        answer.complete().unwrap().report.report
    }

    /// A place that the struck vehicle comes over in every draw and ends on in half of them, and on which
    /// the striking one stays.
    pub fn place(name: &str, struck_starts: bool) -> PlaceChance {
        PlaceChance {
            name: name.to_owned(),
            is_unnamed: false,
            struck_starts,
            struck_enters: 1.0,
            struck_ends: 0.5,
            striking_starts: true,
            striking_enters: 1.0,
            striking_ends: 1.0,
        }
    }

    fn names(report: &PredictMotionReport) -> Vec<String> {
        let text = report.answer_table().to_text(&FactWriter::english(UnitSystem::Si));
        text.rows.into_iter().map(|row| row.cells[0].clone()).collect()
    }

    /// What moves the vehicle stands before what does not, and both stand there.
    #[test]
    fn the_impulse_that_moves_the_vehicle_stands_first() {
        let size = |report: &PredictMotionReport| {
            let names = names(report);
            let at = |of: &str| names.iter().position(|name| name.ends_with(of)).unwrap();
            [at("impulse, force network"), at("impulse, momentum solution")]
        };
        let [network, momentum] = size(&forecast(None));
        assert!(network < momentum);
        let [network, momentum] = size(&forecast(Some(ForceSource::Given)));
        assert!(momentum < network);
    }

    /// “The force of the first contact is that of: the force network” stood beside “in 96.6 % of the draws the
    /// first contact follows from the contact law”.
    #[test]
    fn where_the_network_hardly_applies_the_contact_law_is_what_moves_the_vehicle_first() {
        let report = forecast(None);
        let with =
            |share| PredictMotionReport { force_applicability: Some(share), ..report.clone() };
        // Its impulse is that of neither method.
        let has_total =
            |share| names(&with(share)).iter().any(|name| name.contains("all contacts"));
        assert!(has_total(0.03) && !has_total(1.0));
        // Where the network says nothing, that of the momentum solution stands beside it.
        let silent = PredictMotionReport { impulses: None, ..with(0.0) };
        let both = ["impulse of all contacts", "momentum solution beside it"];
        assert!(both.iter().all(|of| names(&silent).iter().any(|name| name == of)), "{silent:?}");
        let moved_by = |share| {
            let text = with(share).answer_table().to_text(&FactWriter::english(UnitSystem::Si));
            let is_of_force = |cells: &Vec<String>| cells[0].starts_with("the force of the first");
            let cells = text.rows.into_iter().map(|row| row.cells).find(is_of_force).unwrap();
            cells[1].clone()
        };
        assert_eq!([1.0, 0.03].map(moved_by), ["the force network", "the contact law"]);
    }

    /// Two cars that meet head-on at 110 km/h drove on by the contact law alone, their impulse 5.6 to 7.3 kN s
    /// with 90 %; the momentum solution has 23.8 kN s.
    #[test]
    fn fronts_that_meet_follow_contact_law_and_momentum_solution_alike() {
        let mut scenario = Scenario::example();
        scenario.struck.vx_world_m_s = 14.0;
        scenario.striking.heading_rad = 175_f64.to_radians();
        scenario.striking.vx_world_m_s = -16.0;
        scenario.striking.vy_world_m_s = 1.4;
        let location = ContactLocation::Side { side: Side::Front, offset_m: 0.4 };
        scenario.contact.location = location;
        let report = forecast_of(scenario, None);
        assert_eq!((report.n_forces, report.n_momentum_pulses()), (0, 4));
        let text = report.answer_table().to_text(&FactWriter::english(UnitSystem::Si));
        let cells: Vec<String> = text.rows.into_iter().flat_map(|row| row.cells).collect();
        let expected = "the contact law and the momentum solution, half of the draws each";
        assert!(cells.iter().any(|cell| cell == expected), "{cells:?}");
        // The impulses of both lie in one interval, and neither is called another method beside it.
        let estimate = &report.contacts.as_ref().unwrap().impulse_n_s;
        let ninety = estimate.intervals.iter().find(|it| (it.level - 0.9).abs() < 1e-9).unwrap();
        assert!(ninety.high > 1.5 * ninety.low, "{estimate:?}");
        assert!(report.rival.is_none());
    }

    /// A lane that every draw comes into is told; one on which the vehicle was is not.
    #[test]
    fn a_place_that_the_vehicle_was_on_is_not_told() {
        let places = vec![place("own lane", true), place("other lane", false)];
        let names = names(&PredictMotionReport { places, ..forecast(None) });
        assert!(
            names.contains(&"the struck vehicle comes over other lane".to_owned()),
            "{names:?}"
        );
        assert!(!names.iter().any(|name| name.contains("own lane")), "{names:?}");
        assert!(!names.iter().any(|name| name.contains("striking vehicle")), "{names:?}");
    }

    /// “ends on” was said of a vehicle that drove on at 53 km/h when the forecast was over.
    #[test]
    fn a_vehicle_that_still_moves_ends_nowhere() {
        let places = vec![place("other lane", false)];
        let report = PredictMotionReport { places, ..forecast(None) };
        assert!(!report.outcome.stands(report.rest.as_ref()));
        let names = names(&report);
        assert!(!names.iter().any(|name| name.contains("vehicle ends on")), "{names:?}");
        let expected = "the struck vehicle is last on other lane";
        assert!(names.iter().any(|name| name == expected), "{names:?}");
    }
}
