//! What was asked, and what came out: each question once, with the answers of all variants beside each
//! other.

use crate::report::beside::{Said, beside_each_other};
use crate::report::build::{VariantParts, parts_of};
use crate::report::numbers::{Wording, fill};
use crate::report::parts::Part;
use crate::report::{Block, Language, ReportDate, Table};
use impactlab_core::uncertainty::Caveat;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_study::case_file::CaseFile;

/// A question with the variants that have an answer to it.
struct Question<'a> {
    title: &'a str,
    answers: Vec<(&'a str, &'a Part)>,
}

/// What the report is about, and every question with its answers.
pub(super) fn answer_blocks(
    case: &CaseFile,
    date: &ReportDate,
    variants: &[VariantParts],
    wording: &Wording,
) -> Vec<Block> {
    let words = wording.words;
    let date = date.written(wording.language);
    let (name, version) = (wording.given_name(&case.name), impactlab_core::program::version());
    let values = [("case", &*name), ("date", &*date), ("version", version)];
    let mut blocks = Vec::new();
    blocks.push(Block::paragraph(fill(words.intro, &values)));
    blocks.push(Block::paragraph(units_text(wording)));
    if wording.language != Language::En {
        blocks.push(Block::paragraph(words.language_note));
    }
    if variants.len() > 1 {
        blocks.push(Block::paragraph(words.variants_beside));
    }
    let notes = case.notes.lines().map(str::trim).filter(|line| !line.is_empty());
    let notes: Vec<Block> = notes.map(Block::paragraph).collect();
    if !notes.is_empty() {
        blocks.push(Block::heading(2, words.notes));
        blocks.extend(notes);
    }
    blocks.extend(without_answer(variants, wording));
    let mut told: Vec<Block> = Vec::new();
    for question in questions(variants) {
        told.push(Block::heading(2, question.title));
        let said = question.answers.iter().map(|(name, part)| {
            let variant = variants.iter().find(|variant| variant.name == *name);
            let others = Others::of(part, variant, wording);
            let speaks = variant.is_some_and(|variant| speaks_for(part, variant));
            Said { name, blocks: part_blocks(part, others, speaks, wording) }
        });
        let said: Vec<Said<'_>> = said.collect();
        told.extend(beside_each_other(&said, wording));
        told.extend(not_answered(&question, variants, wording));
    }
    blocks.extend(without_what_was_told(told, wording));
    blocks
}

/// A restriction with its sentence.
pub(super) fn warning(caveat: &Caveat, wording: &Wording) -> String {
    let (warning, label) = (wording.words.warning, caveat.kind.label_in(wording.language));
    format!("{warning}: {label}: {}", wording.caveat_text(caveat))
}

/// The questions in the order in which they are first asked. Two of one variant that have the same
/// heading are two questions.
fn questions(variants: &[VariantParts]) -> Vec<Question<'_>> {
    let mut questions: Vec<Question<'_>> = Vec::new();
    for variant in variants {
        for part in variant.answers.iter().flatten() {
            let name: &str = &variant.name;
            let is_free = |question: &&mut Question<'_>| {
                question.title == part.title && question.answers.iter().all(|(of, _)| *of != name)
            };
            match questions.iter_mut().find(is_free) {
                Some(question) => question.answers.push((name, part)),
                None => {
                    questions.push(Question { title: &part.title, answers: vec![(name, part)] });
                }
            }
        }
    }
    questions
}

/// Which variants have no answer to a question that others have one to.
fn not_answered(
    question: &Question<'_>,
    variants: &[VariantParts],
    wording: &Wording,
) -> Option<Block> {
    let is_missing = |variant: &&VariantParts| {
        question.answers.iter().all(|(name, _)| *name != variant.name.as_str())
    };
    let names: Vec<&str> = variants.iter().filter(is_missing).map(|it| &*it.name).collect();
    let text = || fill(wording.words.not_answered_for, &[("names", &names.join(", "))]);
    (!names.is_empty()).then(|| Block::paragraph(text()))
}

/// Questions without an answer, with the reason.
fn without_answer<'a>(
    variants: &'a [VariantParts],
    wording: &'a Wording,
) -> impl Iterator<Item = Block> + 'a {
    let words = wording.words;
    let errors = variants.iter().flat_map(|variant| {
        let errors = variant.answers.iter().filter_map(|answer| answer.as_ref().err());
        errors.map(|error| (&*variant.name, error))
    });
    errors.map(move |(name, error)| {
        let error = wording.quoted(error);
        Block::notice(match variants.len() {
            1 => fill(words.no_answer, &[("error", &error)]),
            _ => fill(words.no_answer_of, &[("name", name), ("error", &error)]),
        })
    })
}

/// What the variant says of the same collision in answers to other questions.
#[derive(Clone, Copy)]
struct Others<'a> {
    impact: Option<&'a Part>,
    force: Option<&'a Part>,
}

impl<'a> Others<'a> {
    fn of(part: &Part, variant: Option<&'a VariantParts>, wording: &Wording) -> Self {
        let collision = part.title.strip_prefix(&*part.kind).unwrap_or_default();
        let find = |kind: &str| {
            let mut answers = variant?.answers.iter().flatten();
            let is_other = |of: &&Part| of.kind == kind && part.kind != kind;
            answers.find(|of| is_other(of) && of.title.strip_prefix(kind) == Some(collision))
        };
        let words = wording.words;
        Self { impact: find(words.title_impact), force: find(words.title_force) }
    }

    /// Whether a row stands in the answer of the force as it is.
    fn has_row(self, table: &Table, row: &[String]) -> bool {
        let blocks: &[Block] = self.force.map_or(&[], |force| force.answer.as_slice());
        blocks.iter().any(|block| match block {
            Block::Table(of) => of.columns == table.columns && of.rows.iter().any(|it| it == row),
            _ => false,
        })
    }
}

/// Whether the tables of the opinion on a variant have all figures of an answer: of several of the highest
/// rank they have those of the first.
fn speaks_for(part: &Part, variant: &VariantParts) -> bool {
    let rank = |part: &Part| part.opinion.as_ref().map(|opinion| opinion.rank);
    let highest = parts_of(variant).filter_map(rank).max();
    let first = parts_of(variant).find(|part| highest.is_some() && rank(part) == highest);
    first.is_some_and(|first| std::ptr::eq(first, part))
}

/// A question with what may be wrong with its answer, and the answer without what the opinion has, or
/// others say of the force of the same collision.
///
/// - `speaks`: whether the opinion has it.
fn part_blocks(part: &Part, others: Others<'_>, speaks: bool, wording: &Wording) -> Vec<Block> {
    let warnings = part.caveats.iter().filter(|caveat| caveat.is_warning());
    let notices = warnings.map(|caveat| Block::notice(warning(caveat, wording)));
    let (question, rest) = part.answer.split_at(part.answer.len().min(1));
    let is_said = others.impact.is_some() && others.force.is_some();
    let rest = rest.iter().filter(|block| !(is_said && part.of_first_force.contains(block)));
    let rest = rest.filter(|block| !(speaks && part.in_opinion.contains(block)));
    let rest = rest.map(|block| match block {
        Block::Table(table) if part.kind == wording.words.title_motion => {
            let rows = table.rows.iter().filter(|row| !others.has_row(table, row));
            Block::Table(Table { rows: rows.cloned().collect(), ..table.clone() })
        }
        block => block.clone(),
    });
    question.iter().cloned().chain(notices).chain(rest).collect()
}

/// The units of the report, of every quantity that it may tell.
fn units_text(wording: &Wording) -> String {
    let symbols = Quantity::ALL.iter().map(|of| of.display_unit(wording.units).symbol);
    let symbols = symbols.filter(|symbol| !symbol.is_empty());
    let units: Vec<String> = symbols.map(|symbol| wording.symbol(symbol)).collect();
    let text = match wording.units {
        UnitSystem::Si => wording.words.units_si,
        UnitSystem::Us => wording.words.units_us,
    };
    fill(text, &[("units", &units.join(", "))])
}

/// Blocks in which each table and note stands once: what several answers have in common, such as the two
/// methods beside each other, is said with the first of them, and so is what stands below such a table.
fn without_what_was_told(blocks: Vec<Block>, wording: &Wording) -> Vec<Block> {
    let note = wording.words.noted.split('{').next().unwrap_or_default();
    let mut kept: Vec<Block> = Vec::new();
    let mut is_below_repeated = false;
    for block in blocks {
        let is_told_again = match &block {
            Block::Table(_) => kept.contains(&block),
            Block::Paragraph { text } => {
                (is_below_repeated || text.starts_with(note)) && kept.contains(&block)
            }
            _ => false,
        };
        is_below_repeated = is_told_again;
        if !is_told_again {
            kept.push(block);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::opinion::{PartOpinion, Rank};
    use crate::report::{Paper, ReportSettings};

    fn forecast(distance: &str, rank: Rank) -> Part {
        let figures = vec![["distance".to_owned(), distance.to_owned()]];
        let rows = vec![figures[0].clone()];
        let table = Block::Table(Table::new("Numbers", ["Quantity", "Value"], rows));
        let opinion = PartOpinion {
            rank,
            question: "Where does it go?".to_owned(),
            answer: String::new(),
            courses: Vec::new(),
            figures,
            held: None,
            is_doubtful: false,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        Part {
            opinion: Some(opinion),
            answer: vec![Block::paragraph("Where does it go?"), table.clone()],
            in_opinion: vec![table],
            ..Part::default()
        }
    }

    /// Inertias in slug ft² and impulses in lbf s stood in a report whose units were “ft, mph, degrees, lbf, ft lbf,
    /// lb”.
    #[test]
    fn every_unit_of_the_report_is_listed() {
        let date = ReportDate::new(2026, 1, 2).unwrap();
        for (language, units, listed) in [
            (Language::En, UnitSystem::Si, ["deg/s", "kg m²", "kN s", "kJ"]),
            (Language::En, UnitSystem::Us, ["deg/s", "slug ft²", "lbf s", "ft lbf"]),
            (Language::De, UnitSystem::Us, ["°/s", "slug ft²", "lbf s", "ft lbf"]),
        ] {
            let paper = Paper::A4;
            let told = units_text(&Wording::new(&ReportSettings { language, units, paper, date }));
            for unit in listed {
                assert!(told.contains(&format!(" {unit}, ")), "{unit}: {told}");
            }
        }
    }

    /// Of two forecasts of a variant the numbers of the second stood nowhere.
    #[test]
    fn only_what_the_opinion_has_is_left_out_of_an_answer() {
        let parts = [
            forecast("1 m", Rank::Simulation),
            forecast("2 m", Rank::Forecast),
            forecast("3 m", Rank::Forecast),
        ];
        let answers = parts.into_iter().map(Ok).collect();
        let variant = VariantParts { name: "a".to_owned(), notes: String::new(), answers };
        let wording = Wording::english(UnitSystem::Si);
        let others = Others { impact: None, force: None };
        let n_blocks =
            |part: &Part| part_blocks(part, others, speaks_for(part, &variant), &wording).len();
        assert_eq!(parts_of(&variant).map(n_blocks).collect::<Vec<_>>(), [2, 1, 2]);
    }
}
