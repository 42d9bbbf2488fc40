//! The facts of a reconstruction.

use impactlab_core::units::Quantity;
use impactlab_reconstruct::evaluate::KnownEvidence;
use impactlab_reconstruct::{
    BudgetItem, ComparedBy, EvidenceFit, HandCheck, LeftOut, MarkComparison, Mode,
    QuantityEstimate, SpeedChange, SpeedHinge,
};

use crate::facts::held::HeldTooSeldom;
use crate::facts::simulate::zones;
use crate::facts::table::{PREDICTED, RECONSTRUCTED};
use crate::facts::{Fact, FactTable, Term, Value};
use crate::measured::{Measured, Measurement};
use crate::{LaterContactsReport, ReconstructReport};

impl ReconstructReport {
    /// What the answer says: the courses of events where there are several, what the speeds hinge on, the
    /// speeds, how well the evidence is explained, and what further evidence would bring.
    pub fn facts(&self) -> Vec<FactTable> {
        let courses = (self.modes.len() > 1).then(|| self.course_table());
        let tables = [
            courses,
            self.hinge_table(),
            Some(self.speed_table()),
            self.hand_table(),
            self.fit_table(),
            self.path_fit_table(),
            self.left_out_table(),
            self.mark_table(),
            self.budget_table(),
            self.held_table(),
        ];
        tables.into_iter().flatten().collect()
    }

    /// How often such intervals held; none where there are no intervals, and of an impact elsewhere than on a
    /// flank behind the CG, of cars that met otherwise than those that were tried or were followed through later
    /// contacts, and of a single car, on which it was not measured.
    pub fn held_table(&self) -> Option<FactTable> {
        let known = self.known.filter(|_| self.met_as_tried && self.is_of_one_impact())?;
        Measurement::shipped(Measured::reconstruction_of(known))?.held_table(None)
    }

    /// The quantities whose intervals of 90 % held too seldom when intervals of one impact were tried; of an
    /// impact elsewhere, too, of which nothing better is known.
    pub fn held_too_seldom(&self) -> Vec<HeldTooSeldom> {
        if !self.is_of_one_impact() {
            return Vec::new();
        }
        let known = self.known.unwrap_or(KnownEvidence::Everything);
        let of = |of: &QuantityEstimate| HeldTooSeldom::of_reconstruction(known, of.label());
        self.quantities.iter().filter_map(of).collect()
    }

    /// Whether there are intervals, of cars that were not followed through later contacts.
    fn is_of_one_impact(&self) -> bool {
        let are_followed = self.later_contacts.is_some_and(|later| later.are_followed);
        self.has_intervals() && !are_followed
    }

    /// The quantities with their intervals.
    pub fn speed_table(&self) -> FactTable {
        let mut facts: Vec<Fact> = self.quantities.iter().map(quantity_fact).collect();
        facts.extend(zones(&self.friction_zones));
        let meet_again = self.later_contacts.filter(LaterContactsReport::is_told);
        facts.extend(meet_again.map(|later| {
            let error = Some(later.meet_again_standard_error);
            Fact::new(Term::MeetAgainByImpact, Value::Chance(later.meet_again_share, error))
        }));
        facts.extend([
            Fact::new(Term::Motions, Value::Count(self.n_simulations)),
            Fact::new(Term::Particles, Value::Count(self.n_particles)),
            Fact::new(Term::EffectiveSamples, Value::Fixed(self.ess, 0)),
        ]);
        FactTable::new(self.speeds_title(), facts).with_levels(RECONSTRUCTED)
    }

    /// What the table of quantities is called.
    fn speeds_title(&self) -> Term {
        if self.kind.is_collision() { Term::Speeds } else { Term::SpeedAtStart }
    }

    /// The car whose speed is asked for, as a heading.
    fn asked_car(&self) -> Term {
        if self.kind.is_collision() { Term::StruckCar } else { Term::SingleCar }
    }

    /// By how much the speeds move if one quantity is larger, by the particles; none with too few of them.
    pub fn hinge_table(&self) -> Option<FactTable> {
        let row = |hinge: &SpeedHinge| {
            let step = Value::Sigma(hinge.quantity(), hinge.step);
            let name = vec![Value::Phrase(hinge.input.label().to_owned()), step];
            let change = |of: SpeedChange| {
                Value::Change(Quantity::Speed, of.change_m_s, of.standard_error_m_s)
            };
            let speeds = std::iter::once(hinge.struck_speed).chain(hinge.striking_speed);
            Fact::row(Value::Joined(name, " + "), speeds.map(change).collect())
        };
        let rows = self.hinges.iter().map(row).collect();
        let columns = match self.kind.is_collision() {
            true => &[Term::StruckCar, Term::StrikingCar][..],
            false => &[Term::SingleCar],
        };
        FactTable::new(Term::Hinges, rows).with_columns(columns).unless_empty()
    }

    /// What one computes by hand, each number from its own part of the evidence; none if nothing holds.
    pub fn hand_table(&self) -> Option<FactTable> {
        let row = |check: &HandCheck| {
            let speed = Value::Measured(Quantity::Speed, check.value_m_s, check.sigma_m_s);
            let values = vec![speed, Value::Phrase(check.holds.to_owned())];
            Fact::row(Value::Phrase(check.speed.label().to_owned()), values)
        };
        let rows = self.by_hand.iter().map(row).collect();
        let columns = [Term::OneSigma, Term::HoldsBy];
        FactTable::new(Term::ByHand, rows).with_columns(&columns).unless_empty()
    }

    /// The courses of events, the most probable one first.
    pub fn course_table(&self) -> FactTable {
        let row = |mode: &Mode| {
            let speed = mode.quantities.first();
            let speed = speed.map(|of| Value::drawn(of.quantity(), &of.estimate));
            // All particles of one course do not make it certain.
            let values = vec![
                Value::Chance(mode.probability, Some(mode.standard_error)),
                speed.unwrap_or_else(|| Value::Text(String::new())),
            ];
            Fact::row(Value::Phrase(mode.name.clone()), values)
        };
        let columns = [Term::Probability, self.asked_car()];
        let rows = self.modes.iter().map(row).collect();
        let table = FactTable::new(Term::Courses, rows).with_rows(Term::Course);
        table.with_levels(PREDICTED).with_columns(&columns)
    }

    /// The quantities within each course of events; none if there is one course only.
    pub fn course_tables(&self) -> Vec<FactTable> {
        let table = |mode: &Mode| {
            let title = vec![Value::Term(Term::IfThis), Value::Phrase(mode.name.clone())];
            let facts = mode.quantities.iter().map(quantity_fact).collect();
            let table = FactTable::new(self.speeds_title(), facts).with_levels(RECONSTRUCTED);
            FactTable { title: Value::Joined(title, ": "), ..table }
        };
        let several = self.modes.iter().filter(|_| self.modes.len() > 1);
        several.map(table).collect()
    }

    /// Each item of the evidence that is a number: found, expected, and whether anything explains it; none
    /// without any.
    pub fn fit_table(&self) -> Option<FactTable> {
        fit_table(&self.fit, ComparedBy::is_found, [Term::Fit, Term::Found])
    }

    /// The same of marks against the computed paths: how far they lie from these, and where along them they
    /// begin and end, which is computed and not found.
    pub fn path_fit_table(&self) -> Option<FactTable> {
        fit_table(&self.fit, |by| !by.is_found(), [Term::PathFit, Term::ByMark])
    }

    /// The speed that is asked for without each part of the evidence, and whether the part goes with the
    /// others; none if there is one part only.
    pub fn left_out_table(&self) -> Option<FactTable> {
        let row = |part: &LeftOut| {
            let speed = part.struck_speed.as_ref();
            let nothing = || Value::Text(String::new());
            let verdict = match (part.p, part.is_contradicted) {
                (None, _) => Term::NotJudged,
                (Some(_), true) => Term::Contradicted,
                (Some(_), false) => Term::GoesWithOthers,
            };
            let values = vec![
                part.p.map_or_else(nothing, Value::ProbabilityBound),
                Value::Fixed(part.ess, 0),
                Value::Term(verdict),
                speed.map_or_else(nothing, |of| Value::drawn(of.quantity(), &of.estimate)),
            ];
            let name = Value::Phrase(part.evidence.clone());
            Fact { is_warning: part.is_contradicted, ..Fact::row(name, values) }
        };
        let rows = self.left_out.iter().map(row).collect();
        let columns = [Term::SoFarOff, Term::IndependentDraws, Term::Verdict, self.asked_car()];
        FactTable::new(Term::LeftOutEvidence, rows)
            .with_rows(Term::WithoutPart)
            .with_levels(PREDICTED)
            .with_columns(&columns)
            .unless_empty()
    }

    /// The marks that were found beside those of a particle of median speed; none if none was found.
    pub fn mark_table(&self) -> Option<FactTable> {
        let length = |m| Value::Decimals(Quantity::Length, m, 2);
        let known = |m: Option<f64>| m.map_or(Value::Term(Term::NoMark), length);
        let row = |mark: &MarkComparison| {
            // A wheel that leaves no mark has no computed length, and not one of 0 m.
            let computed = mark.mean_distance_m.map(|_| mark.computed_length_m);
            let values = vec![
                length(mark.found_length_m),
                known(computed),
                known(mark.mean_distance_m),
                known(mark.largest_distance_m),
            ];
            let wheel = Value::Phrase(mark.wheel.label().to_owned());
            let name = match mark.is_of_striking_car {
                true => Value::Joined(vec![Value::Term(Term::StrikingCar), wheel], ", "),
                false => wheel,
            };
            Fact::row(name, values)
        };
        let columns =
            [Term::FoundLength, Term::ComputedLength, Term::MeanDistance, Term::LargestDistance];
        let rows = self.marks.iter().map(row).collect();
        let table = FactTable::new(Term::MarksCompared, rows).with_rows(Term::Wheel);
        table.with_columns(&columns).unless_empty()
    }

    /// What further evidence would bring, the most useful first; what cannot be believed is last. None
    /// with too few particles.
    pub fn budget_table(&self) -> Option<FactTable> {
        let mut items: Vec<&BudgetItem> = self.budget.iter().collect();
        items.sort_by(|a, b| {
            b.believable.cmp(&a.believable).then(a.then_m_s.total_cmp(&b.then_m_s))
        });
        let row = |item: &&BudgetItem| {
            let sigma = Value::Sigma(item.quantity(), item.sigma);
            let name = vec![Value::Phrase(item.measurement().to_owned()), sigma];
            let half = |m_s| Value::Rough(Quantity::Speed, m_s);
            let then = match item.believable {
                true => half(item.then_m_s),
                false => Value::Term(Term::NotBelievable),
            };
            Fact::row(Value::Joined(name, ", ± "), vec![half(item.now_m_s), then])
        };
        let rows = items.iter().map(row).collect();
        let columns = [Term::Now, Term::Then];
        let title = match self.kind.is_collision() {
            true => Term::Budget,
            false => Term::BudgetAtStart,
        };
        FactTable::new(title, rows).with_columns(&columns).unless_empty()
    }
}

fn quantity_fact(of: &QuantityEstimate) -> Fact {
    let value = Value::drawn(of.quantity(), &of.estimate);
    Fact::row(Value::Phrase(of.label().to_owned()), vec![value])
}

/// Some items of the evidence and what is expected of them; none without any.
///
/// - `is_wanted`: by what they are compared;
/// - `title`, `found`: what the table is called, and its column of what is compared.
fn fit_table(
    fit: &[EvidenceFit],
    is_wanted: impl Fn(ComparedBy) -> bool,
    [title, found]: [Term; 2],
) -> Option<FactTable> {
    let columns = [found, Term::Expected, Term::TailProbability, Term::Verdict];
    let wanted = fit.iter().filter(|item| is_wanted(item.compared_by));
    let table = FactTable::new(title, wanted.map(fit_fact).collect());
    table.with_rows(Term::EvidenceItem).with_columns(&columns).unless_empty()
}

fn fit_fact(item: &EvidenceFit) -> Fact {
    let is_warning = item.is_unexplained();
    let verdict = if is_warning { Term::Unexplained } else { Term::Explained };
    let values = vec![
        in_unit(item.found, item.unit),
        in_unit(item.expected, item.unit),
        Value::Probability(item.p),
        Value::Term(verdict),
    ];
    Fact { is_warning, ..Fact::row(Value::Phrase(item.evidence.clone()), values) }
}

/// A number of an item of the evidence, whose unit is that of SI, as finely as such things are measured.
fn in_unit(value: f64, unit: &str) -> Value {
    match Quantity::from_si_symbol(unit) {
        Some(quantity @ Quantity::Length) => Value::Decimals(quantity, value, 2),
        Some(quantity @ (Quantity::Angle | Quantity::Speed | Quantity::AngularVelocity)) => {
            Value::Decimals(quantity, value, 1)
        }
        Some(quantity) => Value::Number(quantity, value),
        None => Value::Fixed(value, 3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::FactWriter;
    use impactlab_core::units::{Language, UnitSystem};

    fn item(evidence: &str, unit: &'static str, found: f64) -> EvidenceFit {
        EvidenceFit {
            evidence: evidence.to_owned(),
            unit,
            expected: 2.0 * found,
            found,
            compared_by: ComparedBy::Number,
            p: 1e-5,
        }
    }

    /// “Found” was said of a distance to a path that was computed.
    #[test]
    fn what_was_computed_of_a_mark_is_not_said_to_have_been_found() {
        let found = item("rest x", "m", 1.0);
        let compared_by = ComparedBy::DistanceToPath;
        let off = EvidenceFit { compared_by, ..item("mark FL, distance to the path", "m", 0.3) };
        let items = [found, off];
        let table = |is_wanted: fn(ComparedBy) -> bool, terms: [Term; 2]| {
            let table = fit_table(&items, is_wanted, terms).unwrap();
            let text = table.to_text(&FactWriter::english(UnitSystem::Si));
            let rows: Vec<String> = text.rows.iter().map(|row| row.cells[0].clone()).collect();
            (text.header[1].clone(), rows)
        };
        let (column, rows) = table(ComparedBy::is_found, [Term::Fit, Term::Found]);
        assert_eq!(column, "found");
        assert_eq!(rows, ["rest x"]);
        let (column, rows) = table(|by| !by.is_found(), [Term::PathFit, Term::ByMark]);
        assert_eq!(column, "computed from the mark");
        assert_eq!(rows, ["mark FL, distance to the path"]);
        assert_eq!(fit_table(&items[..1], |by| !by.is_found(), [Term::Fit, Term::Found]), None);
    }

    /// The fit was in SI units, whatever units were chosen.
    #[test]
    fn the_fit_of_the_evidence_is_in_the_chosen_units() {
        let items = [item("rest x", "m", 0.3048), item("EDR speed", "m/s", 0.447_04)];
        let table = fit_table(&items, ComparedBy::is_found, [Term::Fit, Term::Found]).unwrap();
        let text = table.to_text(&FactWriter::english(UnitSystem::Us));
        let cells: Vec<&str> =
            text.rows.iter().flat_map(|row| &row.cells).map(String::as_str).collect();
        let expected = [
            ["rest x", "1.00 ft", "2.00 ft", "< 0.001", "not explained"],
            ["EDR speed", "1.0 mph", "2.0 mph", "< 0.001", "not explained"],
        ];
        assert_eq!(cells, expected.concat());
        assert!(text.rows.iter().all(|row| row.is_warning));
    }

    /// An effective sample size of 2000 stood beside 1000 particles, and nothing said how that can be.
    #[test]
    fn the_effective_sample_size_is_said_to_be_that_of_all_motions() {
        let term = Term::EffectiveSamples;
        assert!(term.label(Language::En).contains("all motions"));
        assert!(term.label(Language::De).contains("aller Bewegungen"));
        assert!(term.hint().is_some_and(|hint| hint.contains("exceed")));
    }
}
