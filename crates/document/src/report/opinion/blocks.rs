//! The opinion as blocks of the report.

use std::collections::BTreeSet;

use crate::report::answer::capitalized;
use crate::report::beside::{NamedRows, beside, taken_rows_alike, told_alike};
use crate::report::build::{VariantParts, parts_of};
use crate::report::method::{Method, of_kinds};
use crate::report::numbers::{Wording, fill};
use crate::report::opinion::differences::differences;
use crate::report::opinion::part::{PartOpinion, Rank};
use crate::report::opinion::words::{OpinionWords, opinion_words};
use crate::report::parts::Part;
use crate::report::paths::ShownPaths;
use crate::report::provenance::own_file;
use crate::report::{Block, Table};
use impactlab_core::uncertainty::CaveatKind;
use impactlab_study::case_file::{CaseFile, CaseOnDisk, UsedFile};

/// What stands where a variant has nothing.
const NONE: &str = "–";

/// What the opinion is made of.
#[derive(Clone, Copy)]
pub(in crate::report) struct Asked<'a> {
    /// The case.
    pub case: &'a CaseFile,
    /// Its file, if it is as it stands there.
    pub on_disk: Option<&'a CaseOnDisk>,
    /// Its variants with their answers.
    pub variants: &'a [VariantParts],
    /// Numbers and texts.
    pub wording: &'a Wording,
    /// Files by their names.
    pub paths: &'a ShownPaths,
}

/// A variant with an answer that speaks for it; a variant with several is told once for each.
struct Spoken<'a> {
    name: String,
    notes: &'a str,
    part: &'a Part,
}

impl<'a> Spoken<'a> {
    fn opinions(&self) -> impl Iterator<Item = &'a PartOpinion> {
        self.part.opinion.iter()
    }
}

/// The opinion.
pub(in crate::report) fn opinion_blocks(asked: Asked<'_>) -> Vec<Block> {
    let words = opinion_words(asked.wording.language);
    let spoken = spoken(asked.variants);
    let mut blocks = vec![Block::heading(2, words.question_and_answer)];
    blocks.extend(answers(&spoken, asked.wording));
    blocks.extend(courses(&spoken, asked.wording));
    blocks.extend(figures(&spoken, asked.wording));
    let is_given = !spoken.is_empty();
    if is_given {
        blocks.push(Block::heading(2, words.how_sure));
        blocks.extend(held(&spoken, asked.wording));
        blocks.push(Block::heading(2, words.hinges));
        blocks.push(Block::List { items: sentences(&spoken, |of| &of.hinges) });
    }
    // Of questions without any answer the program has nothing to warn of.
    if asked.variants.iter().any(|variant| parts_of(variant).next().is_some()) {
        blocks.push(Block::heading(2, words.warnings));
        blocks.extend(warnings(asked.variants, asked.wording));
    }
    // What is computed by hand says itself what it takes.
    let methods = methods_of(&spoken);
    if !methods.is_empty() {
        blocks.push(Block::heading(2, words.not_considered));
        let limit = |method: &Method| {
            format!("{}: {}", method.name(asked.wording), method.limits(asked.wording))
        };
        let of_answers = sentences(&spoken, |of| &of.left_out);
        let items = methods.iter().map(limit).chain(of_answers).collect();
        blocks.push(Block::List { items });
    }
    blocks.push(Block::heading(2, words.who));
    blocks.extend(who(asked));
    blocks
}

/// The answers of the highest rank of each variant. A variant without any says nothing here; that its
/// questions have no answer stands above.
fn spoken(variants: &[VariantParts]) -> Vec<Spoken<'_>> {
    let of_variant = |variant: &'_ VariantParts| {
        let rank = |part: &&Part| part.opinion.as_ref().map(|opinion| opinion.rank);
        parts_of(variant).filter_map(|part| rank(&part)).max()
    };
    let each = variants.iter().flat_map(|variant| {
        let highest = of_variant(variant);
        let is_highest =
            |part: &&Part| part.opinion.as_ref().is_some_and(|it| Some(it.rank) == highest);
        let parts: Vec<&Part> = parts_of(variant).filter(is_highest).collect();
        let n_parts = parts.len();
        (1..).zip(parts).map(move |(number, part)| Spoken {
            // Two forecasts of a variant have rows of the same names.
            name: match n_parts {
                1 => variant.name.clone(),
                _ => format!("{} ({number})", variant.name),
            },
            notes: variant.notes.trim(),
            part,
        })
    });
    each.collect()
}

/// Whether every answer is a calculation by hand, and there is one.
pub(in crate::report) fn are_by_hand(variants: &[VariantParts]) -> bool {
    let is_by_hand =
        |part: &Part| part.opinion.as_ref().is_some_and(|opinion| opinion.rank == Rank::Hand);
    let mut parts = variants.iter().flat_map(parts_of).peekable();
    parts.peek().is_some() && parts.all(is_by_hand)
}

/// By what the answers of the opinion were computed; what these methods leave out is said there.
pub(in crate::report) fn considered_methods(variants: &[VariantParts]) -> BTreeSet<Method> {
    methods_of(&spoken(variants))
}

fn methods_of(spoken: &[Spoken<'_>]) -> BTreeSet<Method> {
    spoken.iter().flat_map(|it| &it.part.methods).copied().collect()
}

/// Each question once, and below it the answer of each variant.
fn answers(spoken: &[Spoken<'_>], wording: &Wording) -> Vec<Block> {
    let words = opinion_words(wording.language);
    let mut questions: Vec<(&str, Vec<String>)> = Vec::new();
    for variant in spoken {
        for opinion in variant.opinions() {
            let values = [("name", &*variant.name), ("answer", &*opinion.answer)];
            let answer = match spoken.len() {
                1 => opinion.answer.clone(),
                _ => fill(words.of_variant, &values),
            };
            match questions.iter_mut().find(|(question, _)| *question == opinion.question) {
                Some((_, answers)) => answers.push(answer),
                None => questions.push((&opinion.question, vec![answer])),
            }
        }
    }
    if questions.is_empty() {
        return vec![Block::paragraph(words.nothing_to_say)];
    }
    let blocks = questions.into_iter().flat_map(|(question, answers)| {
        let answer = match <[String; 1]>::try_from(answers) {
            Ok([one]) => Block::paragraph(one),
            Err(items) => Block::List { items },
        };
        [Block::paragraph(question), answer]
    });
    blocks.collect()
}

/// Courses of events of the variants beside each other, before any median.
fn courses(spoken: &[Spoken<'_>], wording: &Wording) -> Vec<Block> {
    let words = opinion_words(wording.language);
    let rows = |it: &Spoken<'_>| it.opinions().flat_map(|of| of.courses.clone()).collect();
    let mut columns: Vec<(String, NamedRows)> =
        spoken.iter().map(|it| (it.name.clone(), rows(it))).collect();
    // A variant that has one course alone, or none, says nothing of those of the others.
    let names: Vec<String> =
        columns.iter().flat_map(|(_, rows)| rows.iter().map(|[name, _]| name.clone())).collect();
    for (_, rows) in columns.iter_mut().filter(|(_, rows)| rows.is_empty()) {
        rows.extend(names.iter().map(|name| [name.clone(), NONE.to_owned()]));
    }
    let titles = [words.course, words.probability];
    let mut blocks = beside(words.courses, titles, &columns, words.in_no_draw);
    let is_forecast = |of: &PartOpinion| of.rank == Rank::Forecast && !of.courses.is_empty();
    if spoken.iter().flat_map(Spoken::opinions).any(is_forecast) {
        blocks.push(Block::paragraph(words.turns_of_courses));
    }
    blocks
}

/// The figures of the variants beside each other, with what differs between them and what was written about
/// them; what all of them say alike stands below.
fn figures(spoken: &[Spoken<'_>], wording: &Wording) -> Vec<Block> {
    let words = opinion_words(wording.language);
    let has_notes = spoken.iter().any(|it| !it.notes.is_empty());
    let column = |(idx, it): (usize, &Spoken<'_>)| {
        let differs = match (idx, spoken.first()) {
            (0, _) | (_, None) => words.first_variant.to_owned(),
            (_, Some(first)) => differences(&[first.part], &[it.part], wording),
        };
        let differs = (spoken.len() > 1).then(|| [words.differs.to_owned(), differs]);
        let notes = match it.notes.is_empty() {
            true => NONE.to_owned(),
            false => wording.remarks(it.notes),
        };
        let notes = has_notes.then(|| [words.notes.to_owned(), notes]);
        let figures = it.opinions().flat_map(|of| of.figures.clone());
        (it.name.clone(), differs.into_iter().chain(notes).chain(figures).collect())
    };
    let mut columns: Vec<(String, NamedRows)> = spoken.iter().enumerate().map(column).collect();
    // As in the annex.
    let alike = match columns.len() {
        0 | 1 => NamedRows::new(),
        _ => taken_rows_alike(&mut columns),
    };
    let title = figures_title(spoken, words);
    let mut blocks = beside(title, [wording.words.quantity, wording.words.value], &columns, NONE);
    blocks.extend(told_alike(&alike, wording));
    blocks
}

/// The title of the figures, which says what stands in brackets.
fn figures_title(spoken: &[Spoken<'_>], words: &OpinionWords) -> &'static str {
    // What a simulation varies is less than what a forecast does not know, and an impact varies nothing.
    if vary_nothing(spoken, words) {
        return words.figures_of_impact;
    }
    if are_all(spoken, Rank::Simulation) {
        return words.figures_of_simulation;
    }
    let mut figures = spoken.iter().flat_map(Spoken::opinions).flat_map(|of| &of.figures);
    // Few particles of a reconstruction allow medians alone.
    if !figures.any(|[_, value]| value.contains('(')) {
        return words.figures_alone;
    }
    match spoken.iter().flat_map(Spoken::opinions).any(|of| of.is_doubtful) {
        true => words.figures_in_doubt,
        false => words.figures,
    }
}

/// Whether the answers are those of impacts, or of motions of which no vehicles were drawn.
fn vary_nothing(spoken: &[Spoken<'_>], words: &OpinionWords) -> bool {
    let mut figures = spoken.iter().flat_map(Spoken::opinions).flat_map(|of| &of.figures);
    let is_drawn = figures.any(|[name, _]| name.ends_with(words.over_draws));
    are_all(spoken, Rank::Impact) || (are_all(spoken, Rank::Simulation) && !is_drawn)
}

/// Whether all answers are of one rank.
fn are_all(spoken: &[Spoken<'_>], rank: Rank) -> bool {
    spoken.iter().flat_map(Spoken::opinions).all(|of| of.rank == rank)
}

/// How often such intervals held, each table once and with the variants that it is of unless all are, and what the
/// known error is.
fn held(spoken: &[Spoken<'_>], wording: &Wording) -> Vec<Block> {
    let words = opinion_words(wording.language);
    let mut tables: Vec<(&Block, Vec<&str>)> = Vec::new();
    for it in spoken {
        for table in it.opinions().filter_map(|of| of.held.as_ref()) {
            match tables.iter_mut().find(|(known, _)| *known == table) {
                Some((_, names)) => names.push(&it.name),
                None => tables.push((table, vec![&*it.name])),
            }
        }
    }
    let named = |(table, names): (&Block, Vec<&str>)| match table {
        Block::Table(table) if names.len() < spoken.len() => {
            let caption = format!("{}: {}", names.join(", "), table.caption);
            Block::Table(Table { caption, ..table.clone() })
        }
        table => table.clone(),
    };
    let mut blocks: Vec<Block> = tables.into_iter().map(named).collect();
    // Of bounds and of intervals that were tried nothing is said where none were counted.
    let is_counted = !blocks.is_empty();
    let is_doubtful = |it: &&Spoken<'_>| it.opinions().any(|of| of.is_doubtful);
    let doubtful: Vec<&str> = spoken.iter().filter(is_doubtful).map(|it| &*it.name).collect();
    let is_outside = |it: &&Spoken<'_>| {
        // Of the force alone it was counted outside of what its network has learned from, too.
        let is_counted = |of: &PartOpinion| of.held.is_some() && of.rank != Rank::Force;
        it.opinions().any(is_counted) && it.part.caveats.has(CaveatKind::OutsideDomain)
    };
    let outside: Vec<&str> = spoken.iter().filter(is_outside).map(|it| &*it.name).collect();
    if !is_counted && doubtful.len() < spoken.len() {
        blocks.push(Block::paragraph(match vary_nothing(spoken, words) {
            true => wording.words.no_intervals,
            false => words.not_counted,
        }));
    }
    let n_all = spoken.len();
    blocks.extend(said_of(&doubtful, n_all, words.counted_of_others, words));
    blocks.extend(said_of(&outside, n_all, words.counted_inside, words));
    let known = if is_counted { words.known_error } else { words.known_error_uncounted };
    if is_counted && methods_of(spoken).contains(&Method::ContactLaw) {
        blocks.push(Block::paragraph(words.held_without_network));
    }
    let errors = [known, words.known_error_single_car, words.known_error_driven];
    let methods = methods_of(spoken);
    let errors = of_kinds(&methods, errors).filter(|_| !methods.is_empty());
    blocks.extend(errors.map(Block::paragraph));
    blocks
}

/// A sentence on some of the variants, with their names unless it is on all of them; none if it is on none.
fn said_of(names: &[&str], n_all: usize, sentence: &str, words: &OpinionWords) -> Option<Block> {
    let text = match names.len() {
        0 => return None,
        n if n == n_all => sentence.to_owned(),
        _ => fill(words.of_variant, &[("name", &names.join(", ")), ("answer", sentence)]),
    };
    Some(Block::paragraph(text))
}

/// Sentences of the answers, each once, with the variants that have it unless all do.
fn sentences<'a>(
    spoken: &[Spoken<'a>],
    of_opinion: impl Fn(&'a PartOpinion) -> &'a Vec<String>,
) -> Vec<String> {
    let mut items: Vec<(String, Vec<&str>)> = Vec::new();
    for variant in spoken {
        for sentence in variant.opinions().flat_map(&of_opinion) {
            match items.iter_mut().find(|(known, _)| known == sentence) {
                Some((_, of)) => of.push(&variant.name),
                None => items.push((sentence.clone(), vec![&*variant.name])),
            }
        }
    }
    let item = |(sentence, of): (String, Vec<&str>)| match of.len() == spoken.len() {
        true => sentence,
        false => format!("{}: {sentence}", of.join(", ")),
    };
    items.into_iter().map(item).collect()
}

/// The warnings of all answers by name, each with the variants that have it.
fn warnings(variants: &[VariantParts], wording: &Wording) -> Vec<Block> {
    let words = opinion_words(wording.language);
    let mut found: Vec<(&str, Vec<&str>)> = Vec::new();
    for variant in variants {
        for caveat in parts_of(variant).flat_map(|part| part.caveats.iter()) {
            if !caveat.is_warning() {
                continue;
            }
            let label = caveat.kind.label_in(wording.language);
            match found.iter_mut().find(|(known, _)| *known == label) {
                Some((_, of)) if of.contains(&&*variant.name) => {}
                Some((_, of)) => of.push(&variant.name),
                None => found.push((label, vec![&variant.name])),
            }
        }
    }
    if found.is_empty() {
        return vec![Block::paragraph(words.no_warnings)];
    }
    let item = |(label, of): (&str, Vec<&str>)| match variants.len() {
        1 => label.to_owned(),
        _ => format!("{label} ({})", of.join(", ")),
    };
    let all: Vec<String> = found.into_iter().map(item).collect();
    let all = capitalized(&all.join("; "));
    vec![Block::paragraph(format!("{all}. {}", words.warnings_told))]
}

/// Who gives the opinion, for whom, from which materials; and the place for the signature.
fn who(asked: Asked<'_>) -> Vec<Block> {
    let words = opinion_words(asked.wording.language);
    let expert = &asked.case.expert;
    let line = |template: &str, text: &Option<String>| {
        let text = text.as_deref().map(str::trim).filter(|text| !text.is_empty());
        fill(template, &[("text", text.unwrap_or(words.not_stated))])
    };
    let mut items = vec![
        line(words.expert, &expert.name),
        line(words.qualifications, &expert.qualifications),
        line(words.instruction, &expert.instruction),
    ];
    let material = |path: &std::path::PathBuf| {
        let sha256 = match UsedFile::read(path) {
            Ok(file) => file.sha256,
            Err(_) => asked.wording.words.missing.to_owned(),
        };
        let values = [("name", &*asked.paths.name(path)), ("sha256", &*sha256)];
        fill(words.material, &values)
    };
    // By name: the folders of a package are others than those of the case.
    let mut used = asked.case.used_paths();
    used.sort_by_key(|path| (asked.paths.name(path), path.clone()));
    used.dedup();
    let materials: Vec<String> = used.iter().map(material).collect();
    match materials.is_empty() {
        true => items.push(words.no_materials.to_owned()),
        false => items.push(format!("{} {}", words.materials, materials.join("; "))),
    }
    items.push(own_file(asked.on_disk, asked.wording, asked.paths));
    vec![
        Block::List { items },
        Block::paragraph(words.traced),
        Block::paragraph(asked.wording.words.signature),
    ]
}

#[cfg(test)]
#[path = "blocks_tests.rs"]
mod tests;
