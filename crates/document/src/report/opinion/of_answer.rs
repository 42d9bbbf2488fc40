//! What each kind of answer contributes to the opinion. Figures are those of the tables of facts, so that
//! opinion and annex cannot say different ones.

use crate::report::answer::{Context, capitalized, facts_table, with_writer};
use crate::report::numbers::fill;
use crate::report::opinion::part::{PartOpinion, Rank};
use crate::report::opinion::words::{OpinionWords, opinion_words};
use impactlab_core::uncertainty::CaveatKind;
use impactlab_core::units::Quantity;
use impactlab_study::facts::{Fact, FactTable, Term, Value};
use impactlab_study::{
    Answer, HandReport, ImpactReport, PredictForceReport, PredictMotionReport, ReconstructReport,
    ReplayReport, SimulateReport,
};

/// Facts of a simulation that variants are compared by.
const SIMULATED: [Term; 8] = [
    Term::AtRestAfter,
    Term::DistanceToRest,
    Term::EndPosition,
    Term::FinalHeading,
    Term::FinalSpeed,
    Term::EndX,
    Term::EndY,
    Term::AtRest,
];

/// Facts of a force that variants are compared by.
const FORCE: [Term; 4] = [Term::ImpulseSize, Term::PeakForce, Term::ContactDuration, Term::Pdof];

/// Facts of a forecast that the opinion has in other places.
const ELSEWHERE: [Term; 1] = [Term::HingesOn];

/// A forecast of the motion.
pub(in crate::report) fn opinion_of_forecast(
    report: &PredictMotionReport,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let table = report.answer_table();
    let cell = |term| value_of(&table, term, context).unwrap_or_default();
    let turns = [("quarter", &*cell(Term::QuarterTurn)), ("half", &*cell(Term::HalfTurn))];
    let mut sentences = match report.is_end_known() {
        true => vec![fill(words.turns, &turns)],
        false => Vec::new(),
    };
    let format = &**context.wording;
    let time = format.rounded(Quantity::Time, report.outcome.time_s);
    match &report.rest {
        Some(rest) => {
            let share = format.percent(rest.share_at_rest);
            let limit = format.given(Quantity::Time, rest.limit_s);
            let distance = format.drawn_in_words(Quantity::Length, &rest.distance_m);
            let n = rest.n_draws.to_string();
            let values =
                [("share", &*share), ("n", &*n), ("limit", &*limit), ("distance", &*distance)];
            if rest.is_nearly_all_at_rest() {
                sentences.push(fill(words.comes_to_rest, &values));
            } else {
                sentences.push(fill(words.partly_at_rest, &values));
                sentences.push(words.lower_bounds.to_owned());
            }
        }
        None => {
            let is_at_rest = report.outcome.is_at_rest;
            let template = if is_at_rest { words.at_rest } else { words.still_moves };
            let speed = format.rough(Quantity::Speed, report.outcome.speed_m_s);
            sentences.push(fill(template, &[("time", &time), ("speed", &speed)]));
        }
    }
    if !report.is_end_known() {
        sentences.push(context.wording.words.after_second_contact.to_owned());
    }
    let course = |table: &FactTable| rows_of(table, |_| true, context);
    PartOpinion {
        rank: Rank::Forecast,
        question: question.to_owned(),
        answer: sentences.join(" "),
        courses: report.course_table().as_ref().map(course).unwrap_or_default(),
        figures: rows_of(&table, |term| !ELSEWHERE.contains(&term), context),
        held: report.held_table().map(|table| facts_table(&table, context)),
        is_doubtful: false,
        hinges: vec![match value_of(&table, Term::HingesOn, context) {
            Some(none) if none == Term::HingesOnNone.label(format.language) => {
                words.no_hinge.to_owned()
            }
            Some(hinges) => fill(words.end_hinges, &[("hinges", &hinges)]),
            None if report.n_vehicles > 0 => words.too_few_drawn.to_owned(),
            None => words.nothing_drawn.to_owned(),
        }],
        left_out: Vec::new(),
    }
}

/// A reconstruction.
pub(in crate::report) fn opinion_of_reconstruction(
    report: &ReconstructReport,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let speeds = report.speed_table();
    // That the cars meet again and that this is not followed is no detail of the annex.
    let is_told = |fact: &&Fact| {
        matches!(fact.name, Value::Phrase(_)) || is_one_of(fact, &[Term::MeetAgainByImpact])
    };
    let speeds =
        FactTable { facts: speeds.facts.iter().filter(is_told).cloned().collect(), ..speeds };
    let figures = rows_of(&speeds, |_| true, context);
    let mut sentences = Vec::new();
    if report.modes.len() > 1 {
        sentences.push(words.several_courses.to_owned());
        if !report.tells_way {
            sentences.push(words.courses_of_prior.to_owned());
        }
    }
    // Both speeds, or that of the single car; the table below has the other figures.
    let n_told = if report.kind.is_collision() { 2 } else { 1 };
    sentences.push(capitalized(&told(&figures, n_told)));
    if !report.has_intervals() {
        sentences.push(words.no_intervals.to_owned());
    }
    let courses = match (report.modes.len() > 1, figures.first()) {
        (true, Some([speed, _])) => courses_of(report, speed, context),
        _ => Vec::new(),
    };
    let hinges = report.hinge_table().map(|table| hinge_sentences(&table, words, context));
    PartOpinion {
        rank: Rank::Reconstruction,
        question: question.to_owned(),
        answer: sentences.join(" "),
        courses,
        figures,
        held: report.held_table().map(|table| facts_table(&table, context)),
        is_doubtful: false,
        hinges: hinges.unwrap_or_else(|| vec![words.too_few_to_say.to_owned()]),
        left_out: later_contacts_left_out(report, &speeds, context).into_iter().collect(),
    }
}

/// That the cars meet again, where that was not followed; `None` where it was, or where they part for good.
///
/// - `speeds`: the table that has the share of the motions.
fn later_contacts_left_out(
    report: &ReconstructReport,
    speeds: &FactTable,
    context: Context<'_>,
) -> Option<String> {
    let words = opinion_words(context.wording.language);
    report.later_contacts.filter(|later| later.is_told() && !later.are_followed)?;
    let share = value_of(speeds, Term::MeetAgainByImpact, context)?;
    Some(fill(words.later_contacts_left_out, &[("share", &share)]))
}

/// Several courses of events by name: how probable each is, and the speed that is asked for in it, since that
/// over all of them may be true of none.
///
/// - `speed`: what the speed is called.
fn courses_of(report: &ReconstructReport, speed: &str, context: Context<'_>) -> Vec<[String; 2]> {
    let table = FactTable { levels: &[], ..report.course_table() };
    let rows = with_writer(context, |writer| table.to_text(writer).rows);
    let told = rows.into_iter().filter_map(|row| {
        let [name, chance, value] = <[String; 3]>::try_from(row.cells).ok()?;
        Some([name, format!("{chance}; {speed}: {value}")])
    });
    told.collect()
}

/// One motion, and how its end varies with what the data sheet leaves open.
pub(in crate::report) fn opinion_of_simulation(
    report: &SimulateReport,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let simulated = |term| SIMULATED.contains(&term);
    let mut figures = rows_of(&report.motion_table(), simulated, context);
    let answer = format!("{} {}", words.at_medians, told(&figures, figures.len()));
    let drawn = report.uncertainty.as_ref();
    let of_draws = drawn.map(|drawn| rows_of(&drawn.draw_table(), simulated, context));
    let over = |[name, value]: [String; 2]| [format!("{name}, {}", words.over_draws), value];
    figures.extend(of_draws.into_iter().flatten().map(over));
    let shares = drawn.and_then(|drawn| drawn.sensitivity_table());
    let hinges = shares.map(|table| share_sentences(&table, words, context));
    PartOpinion {
        rank: Rank::Simulation,
        question: question.to_owned(),
        answer,
        courses: Vec::new(),
        figures,
        held: None,
        is_doubtful: false,
        hinges: hinges.unwrap_or_else(|| vec![words.nothing_drawn.to_owned()]),
        left_out: Vec::new(),
    }
}

/// A force over time.
pub(in crate::report) fn opinion_of_force(
    report: &PredictForceReport,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let figures = rows_of(&report.force_table(), |term| FORCE.contains(&term), context);
    PartOpinion {
        rank: Rank::Force,
        question: question.to_owned(),
        answer: capitalized(&told(&figures, figures.len())),
        courses: Vec::new(),
        figures,
        held: report.held_table().map(|table| facts_table(&table, context)),
        is_doubtful: false,
        hinges: vec![words.force_hinges.to_owned()],
        left_out: Vec::new(),
    }
}

/// An impulse alone.
pub(in crate::report) fn opinion_of_impact(
    report: &ImpactReport,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let [contact, vehicles] = report.solution_tables();
    let vehicle_terms = [Term::DeltaV, Term::YawRateAfter];
    let columns: Vec<String> = with_writer(context, |writer| {
        vehicles.to_text(writer).header.into_iter().skip(1).collect()
    });
    let of_vehicles = FactTable {
        facts: vehicles
            .facts
            .iter()
            .filter(|fact| is_one_of(fact, &vehicle_terms))
            .cloned()
            .collect(),
        ..vehicles
    };
    let mut figures = rows_of(&contact, |term| term == Term::ImpulseOnStruck, context);
    for row in with_writer(context, |writer| of_vehicles.to_text(writer).rows) {
        let (name, values) = row.cells.split_first().map_or(("", &[][..]), |(n, v)| (&**n, v));
        let named = columns.iter().zip(values);
        figures.extend(named.map(|(of, value)| [format!("{name}, {of}"), value.clone()]));
    }
    PartOpinion {
        rank: Rank::Impact,
        question: question.to_owned(),
        answer: capitalized(&told(&figures, figures.len())),
        courses: Vec::new(),
        figures,
        held: None,
        is_doubtful: false,
        hinges: vec![words.impact_hinges.to_owned()],
        left_out: Vec::new(),
    }
}

/// The sentence that says under which condition a method by hand holds.
pub(in crate::report) fn condition_of_hand(report: &HandReport, context: Context<'_>) -> String {
    let holds = report.method.holds().say(context.wording);
    fill(opinion_words(context.wording.language).hand_holds, &[("holds", &holds)])
}

/// A method by hand.
pub(in crate::report) fn opinion_of_hand(
    report: &HandReport,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let figures = rows_of(&report.result_table(), |_| true, context);
    let answer = capitalized(&told(&figures, 1));
    PartOpinion {
        rank: Rank::Hand,
        question: question.to_owned(),
        answer: format!("{answer} {}", condition_of_hand(report, context)),
        courses: Vec::new(),
        figures,
        held: None,
        is_doubtful: false,
        hinges: vec![words.hand_hinges.to_owned()],
        left_out: Vec::new(),
    }
}

/// A car up to the first contact, by its recorder.
pub(in crate::report) fn opinion_of_replay(
    answer: &Answer<ReplayReport>,
    question: &str,
    context: Context<'_>,
) -> PartOpinion {
    let words = opinion_words(context.wording.language);
    let tables = [answer.contact_table(), answer.way_table()];
    let figures: Vec<[String; 2]> =
        tables.iter().flat_map(|table| rows_of(table, |_| true, context)).collect();
    // The speed; the table below has the other figures.
    let mut sentences = vec![capitalized(&told(&figures, 1))];
    if answer.caveats.has(CaveatKind::DoubtfulData) {
        sentences.push(words.doubtful_record.to_owned());
    }
    PartOpinion {
        rank: Rank::Replay,
        question: question.to_owned(),
        answer: sentences.join(" "),
        courses: Vec::new(),
        figures,
        held: None,
        is_doubtful: false,
        hinges: vec![words.replay_hinges.to_owned()],
        left_out: Vec::new(),
    }
}

fn is_one_of(fact: &Fact, terms: &[Term]) -> bool {
    matches!(&fact.name, Value::Term(term) if terms.contains(term))
}

/// Name and first value of the facts whose term is wanted; those without a term are. A number has its
/// interval of 90 % in brackets.
fn rows_of(
    table: &FactTable,
    is_wanted: impl Fn(Term) -> bool,
    context: Context<'_>,
) -> Vec<[String; 2]> {
    let keeps = |fact: &Fact| match &fact.name {
        Value::Term(term) => is_wanted(*term),
        _ => true,
    };
    rows_where(table, keeps, context)
}

/// The value of a fact as text; none if the table has no such fact.
fn value_of(table: &FactTable, term: Term, context: Context<'_>) -> Option<String> {
    let rows = rows_where(table, |fact| is_one_of(fact, &[term]), context);
    rows.into_iter().next().map(|[_, value]| value)
}

/// Name and first value of some facts.
fn rows_where(
    table: &FactTable,
    keeps: impl Fn(&Fact) -> bool,
    context: Context<'_>,
) -> Vec<[String; 2]> {
    let facts = table.facts.iter().filter(|fact| keeps(fact)).cloned().collect();
    let table = FactTable { facts, levels: &[], ..table.clone() };
    let rows = with_writer(context, |writer| table.to_text(writer).rows);
    let cells = rows.into_iter().map(|row| {
        let mut cells = row.cells.into_iter();
        [cells.next().unwrap_or_default(), cells.next().unwrap_or_default()]
    });
    cells.collect()
}

/// The first figures in a sentence.
fn told(figures: &[[String; 2]], n: usize) -> String {
    let each = figures.iter().take(n).map(|[name, value]| format!("{name}: {value}"));
    format!("{}.", each.collect::<Vec<_>>().join("; "))
}

/// By how much speeds move with one quantity, a sentence each.
fn hinge_sentences(table: &FactTable, words: &OpinionWords, context: Context<'_>) -> Vec<String> {
    let rows = with_writer(context, |writer| table.to_text(writer).rows);
    let sentence = |cells: Vec<String>| match cells.as_slice() {
        [name, struck, striking, ..] => Some(fill(
            words.speed_hinges,
            &[("name", name), ("struck", struck), ("striking", striking)],
        )),
        [name, speed] => Some(fill(words.car_hinges, &[("name", name), ("speed", speed)])),
        _ => None,
    };
    rows.into_iter().filter_map(|row| sentence(row.cells)).collect()
}

/// Shares of estimates in the variance of the end, a sentence each.
fn share_sentences(table: &FactTable, words: &OpinionWords, context: Context<'_>) -> Vec<String> {
    let rows = with_writer(context, |writer| table.to_text(writer).rows);
    let sentence = |cells: Vec<String>| match cells.as_slice() {
        [name, place, heading, ..] => Some(fill(
            words.share_hinges,
            &[("name", name), ("place", place), ("heading", heading)],
        )),
        _ => None,
    };
    rows.into_iter().filter_map(|row| sentence(row.cells)).collect()
}
