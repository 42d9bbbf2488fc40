//! The five questions that a forecast answers, each in a sentence: will it spin, where does it stop, does it
//! cross into the next lane, how sure is that, and what would change it?

use impactlab_core::units::Quantity;

use crate::PredictMotionReport;
use crate::analysis::PlaceChance;
use crate::facts::answer::{name_of, place_at};
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::HeldIntervals;

/// Lanes, kerbs and zones that are named of each vehicle.
const N_PLACES: usize = 2;

/// Values with a space between them.
fn words(values: Vec<Value>) -> Value {
    Value::Joined(values, " ")
}

impl PredictMotionReport {
    /// The answer in five sentences.
    pub fn answer_card(&self) -> FactTable {
        let facts = vec![
            Fact::new(Term::WillItSpin, self.spin_sentence()),
            Fact::new(Term::WhereDoesItStop, self.stop_sentence()),
            Fact::new(Term::IntoNextLane, self.lane_sentence()),
            Fact::new(Term::HowSure, self.sureness_sentence()),
            Fact::new(Term::WhatWouldChangeIt, self.change_sentence()),
        ];
        FactTable::new(Term::TheAnswer, facts)
    }

    fn spin_sentence(&self) -> Value {
        let part = |term: Term, share| words(vec![term.into(), self.chance(share)]);
        let turns = self.outcome.p_quarter_turn.zip(self.outcome.p_half_turn);
        let Some((quarter, half)) = turns else { return Term::AfterSecondContact.into() };
        let parts = vec![part(Term::TurnedQuarter, quarter), part(Term::TurnedHalf, half)];
        Value::Joined(parts, ", ")
    }

    fn stop_sentence(&self) -> Value {
        let outcome = &self.outcome;
        let mut parts = match &self.rest {
            Some(rest) => {
                let share = Value::ShareOfDraws(rest.share_at_rest, rest.n_draws);
                let distance = Value::drawn(Quantity::Length, &rest.distance_m);
                let mut parts = vec![
                    words(vec![Term::RestsIn.into(), share]),
                    words(vec![Term::At.into(), place_at(&rest.x_m, &rest.y_m)]),
                    words(vec![Term::AfterPath.into(), distance]),
                ];
                if !rest.is_nearly_all_at_rest() {
                    parts.push(Term::OthersStillMove.into());
                }
                parts
            }
            None => {
                let is_at_rest = outcome.is_at_rest;
                let term = if is_at_rest { Term::RestsAfter } else { Term::MovesAfter };
                let time = Value::Given(Quantity::Time, outcome.time_s);
                let place = place_at(&outcome.x_m, &outcome.y_m);
                let speed = Value::Decimals(Quantity::Speed, outcome.speed_m_s, 0);
                let speed = words(vec![Term::WithSpeed.into(), speed]);
                let parts = [words(vec![term.into(), time]), words(vec![Term::At.into(), place])];
                parts.into_iter().chain((!is_at_rest).then_some(speed)).collect()
            }
        };
        if !self.is_end_known() {
            parts.push(Term::AfterSecondContact.into());
        }
        Value::Joined(parts, ", ")
    }

    fn lane_sentence(&self) -> Value {
        if self.places.is_empty() {
            return Term::LanesNotCounted.into();
        }
        let named = |term: Term, place: &PlaceChance, share: f64| {
            words(vec![
                term.into(),
                name_of(place),
                Term::WithChance.into(),
                self.place_chance(share),
            ])
        };
        let [struck, striking] = self.entered_places();
        let struck = struck
            .into_iter()
            .take(N_PLACES)
            .map(|it| named(Term::StruckComesOver, it, it.struck_enters));
        let striking = striking
            .into_iter()
            .take(N_PLACES)
            .map(|it| named(Term::StrikingComesOver, it, it.striking_enters));
        let all: Vec<Value> = struck.chain(striking).collect();
        match all.is_empty() {
            true => Term::NoOtherLane.into(),
            false => Value::Joined(all, "; "),
        }
    }

    /// Whether the methods agree, and how often such intervals held.
    fn sureness_sentence(&self) -> Value {
        let verdict = |subject: Term, verdict: Term| words(vec![subject.into(), verdict.into()]);
        let ends = self.rival.as_ref().map(|it| verdict(Term::EndsVerdict, self.ends_verdict(it)));
        let impulses = self.impulses.as_ref();
        let impulses = impulses.map(|it| verdict(Term::ImpulsesVerdict, it.verdict()));
        let held = match self.worst_held() {
            Some(held) => {
                let count = Value::CountOf(held.in_90, held.n);
                words(vec![Term::HeldAtWorst.into(), count, Term::ComputedMotions.into()])
            }
            None => Term::HeldNotCounted.into(),
        };
        let parts = ends.into_iter().chain(impulses).chain([held]).collect();
        Value::Joined(parts, "; ")
    }

    /// The quantity whose intervals of 90 % held least often; none where that was not counted.
    fn worst_held(&self) -> Option<&'static HeldIntervals> {
        let held = self.measurement()?.held_of(Some(self.tried_motion));
        held.into_iter().min_by(|a, b| a.share_in_90().total_cmp(&b.share_in_90()))
    }

    fn change_sentence(&self) -> Value {
        self.hinges().unwrap_or_else(|| match self.n_vehicles {
            0 => Term::NothingDrawn.into(),
            _ => Term::TooFewDrawn.into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Sensitivity;
    use crate::facts::FactWriter;
    use crate::facts::answer::tests::{forecast, place};
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};
    use impactlab_core::vehicle::SheetQuantity;

    fn sentences(report: &PredictMotionReport, language: Language) -> Vec<[String; 2]> {
        let english = FactWriter::english(UnitSystem::Si);
        let format = NumberFormat { language, ..english.format };
        let text = report.answer_card().to_text(&FactWriter { format, ..english });
        let cells = text.rows.into_iter().map(|row| row.cells);
        cells.map(|cells| <[String; 2]>::try_from(cells).expect("question and answer")).collect()
    }

    /// The five questions in their order, each with numbers of the answer, whatever is not known.
    #[test]
    fn five_questions_are_answered_first() {
        let report = forecast(None);
        let table = &report.facts()[0];
        assert_eq!(*table, report.answer_card());
        let rows = sentences(&report, Language::En);
        let questions: Vec<&str> = rows.iter().map(|[question, _]| question.as_str()).collect();
        assert_eq!(
            questions,
            [
                "Will it spin?",
                "Where does it stop?",
                "Does it cross into the next lane?",
                "How sure is that?",
                "What would change it?"
            ]
        );
        let quarter = format!("{:.1} %", 100.0 * report.outcome.p_quarter_turn.unwrap());
        assert!(rows[0][1].contains(&quarter), "{rows:?}");
        assert!(rows[1][1].starts_with("not within the forecast") && rows[1][1].contains("km/h"));
        assert!(rows[2][1].contains("site"), "{rows:?}");
        assert!(rows[3][1].contains("of 90 % held") && rows[3][1].contains("4DOF"), "{rows:?}");
        for [question, answer] in sentences(&report, Language::De) {
            assert!(question.ends_with('?') && answer.len() > 10, "{question} {answer}");
        }
    }

    /// “turned by 90° or more at the end with 90.4 % ± 3.1 %” was told of a car after a second contact, which is not
    /// computed.
    #[test]
    fn after_a_second_contact_no_turn_has_a_probability() {
        let mut report = forecast(None);
        (report.outcome.p_quarter_turn, report.outcome.p_half_turn) = (None, None);
        let spin = &sentences(&report, Language::En)[0][1];
        assert!(spin.starts_with("without a probability, since a second contact"), "{spin}");
        let table = report.answer_table().to_text(&FactWriter::english(UnitSystem::Si));
        assert!(table.rows[..2].iter().all(|row| row.cells[1] == *spin), "{:?}", table.rows);
    }

    /// “yaw inertia, 0.0 % of the variance of the place, 87.3 % of that of the heading” was told of five draws.
    #[test]
    fn a_handful_of_draws_does_not_say_what_the_end_depends_on() {
        let by_chance = Sensitivity {
            quantity: SheetQuantity::YawInertia,
            label: "yaw inertia",
            position_share: 0.0,
            heading_share: 0.873,
            chance_share: 0.77,
        };
        let report = forecast(None);
        for (n_vehicles, begins) in [(5, "not known: too few"), (200, "yaw inertia")] {
            let sensitivity = vec![by_chance.clone()];
            let report = PredictMotionReport { n_vehicles, sensitivity, ..report.clone() };
            let told = &sentences(&report, Language::En)[4][1];
            assert!(told.starts_with(begins), "{told}");
        }
    }

    #[test]
    fn lanes_are_named_with_their_chance_and_that_none_is_entered_is_said() {
        let report = forecast(None);
        let lane = |struck_starts| {
            let places = vec![place("left lane", struck_starts)];
            let report = PredictMotionReport { places, ..report.clone() };
            sentences(&report, Language::En)[2][1].clone()
        };
        let entered = lane(false);
        assert!(entered.starts_with("the struck vehicle comes over left lane with"), "{entered}");
        assert!(lane(true).starts_with("in no draw"), "{}", lane(true));
    }
}
