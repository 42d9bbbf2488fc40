//! Asks a case its questions and puts the report together.

use std::collections::BTreeSet;

use crate::report::answer::stills::Grounds;
use crate::report::answer::{Context, part_of};
use crate::report::answers::{answer_blocks, warning};
use crate::report::beside::{Said, beside_each_other};
use crate::report::document::{Section, SectionKind};
use crate::report::holders::AnswerNames;
use crate::report::input_table::input_tables;
use crate::report::method::{Method, method_blocks};
use crate::report::numbers::{Wording, fill};
use crate::report::opinion::{
    Asked, are_by_hand, considered_methods, missing_inputs, opinion_blocks,
};
use crate::report::parts::{InputRow, Part, PartProvenance};
use crate::report::paths::ShownPaths;
use crate::report::picture_blocks::picture_blocks;
use crate::report::provenance::{change_notice, log_blocks, network_name, provenance_blocks};
use crate::report::validation::validation_blocks;
use crate::report::validity::validity_blocks;
use crate::report::{Block, ReportDocument, ReportSettings};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::uncertainty::CaveatKind;
use impactlab_study::case_file::{CaseError, CaseFile, CaseOnDisk, CaseReport, Variant};
use impactlab_study::{Library, ModelChoice, Observer};

/// A variant with what its questions contribute.
pub(super) struct VariantParts {
    /// What it is called.
    pub name: String,
    /// What the analyst wrote about it.
    pub notes: String,
    /// Question by question: what it contributes, or why it has no answer.
    pub answers: Vec<Result<Part, String>>,
}

/// Asks every question of a case once and makes the report of the answers. It names no file that these questions
/// do not rest on: not those of other variants, and none that is filled in and not asked.
///
/// - `on_disk`: the file of the case, if the case is as it stands there;
/// - `variants`: names of the variants that are asked; empty for all.
///
/// # Errors
/// [`CaseError::NoVariant`].
pub fn report_case(
    case: &CaseFile,
    on_disk: Option<&CaseOnDisk>,
    variants: &[String],
    settings: &ReportSettings,
    library: &Library,
    observer: &mut Observer<'_>,
) -> Result<Outcome<(ReportDocument, CaseReport)>, CaseError> {
    let (wording, paths) = (Wording::new(settings), ShownPaths::from_case(case));
    let case = &case.asked(variants)?;
    let grounds = Grounds::default();
    let context = Context { wording: &wording, paths: &paths, grounds: &grounds };
    let mut parts: Vec<VariantParts> = Vec::new();
    let outcome = case.ask_each(variants, library, observer, &mut |variant, request, answer| {
        let part = match answer {
            Ok(answer) => Ok(part_of(request, answer, context)),
            Err(error) => Err(paths.shown(&error_chain(error))),
        };
        let name = shown_name(case, variant, &wording);
        match parts.last_mut() {
            Some(last) if last.name == name => last.answers.push(part),
            _ => {
                parts.push(VariantParts { name, notes: variant.notes.clone(), answers: vec![part] })
            }
        }
    })?;
    let Outcome::Complete(mut report) = outcome else { return Ok(Outcome::Cancelled) };
    report.changes.extend(on_disk.and_then(CaseOnDisk::change));
    let builder =
        Builder { case, on_disk, report: &report, settings, wording: &wording, paths: &paths };
    let document = builder.document(&parts);
    Ok(Outcome::Complete((document, report)))
}

/// What a variant is called; as it is where another variant has its name in the language of the report.
fn shown_name(case: &CaseFile, variant: &Variant, wording: &Wording) -> String {
    let name = wording.given_name(&variant.name);
    if case.variant(&name).is_some() { variant.name.clone() } else { name }
}

struct Builder<'a> {
    case: &'a CaseFile,
    on_disk: Option<&'a CaseOnDisk>,
    report: &'a CaseReport,
    settings: &'a ReportSettings,
    wording: &'a Wording,
    paths: &'a ShownPaths,
}

impl Builder<'_> {
    fn document(&self, variants: &[VariantParts]) -> ReportDocument {
        let (settings, words) = (self.settings, self.wording.words);
        let blocks = |kind| match kind {
            SectionKind::Opinion => self.opinion(variants),
            SectionKind::Answers => {
                answer_blocks(self.case, &settings.date, variants, self.wording)
            }
            SectionKind::Pictures => self.pictures(variants),
            SectionKind::Inputs => input_blocks(variants, self.wording),
            SectionKind::Evidence => {
                or(distinct(variants, |part| &part.evidence), words.no_evidence)
            }
            SectionKind::Method if are_by_hand(variants) => {
                vec![Block::paragraph(words.method_by_hand)]
            }
            SectionKind::Method => {
                or(method_blocks(&methods(variants), self.wording), words.no_methods)
            }
            SectionKind::Validity => validity_blocks(variants, &methods(variants), self.wording),
            SectionKind::Validation => self.validation(variants),
            SectionKind::Sensitivity => or(self.sensitivity(variants), words.no_sensitivity),
            SectionKind::Provenance => self.provenance(variants),
            SectionKind::Log => log_blocks(self.case, self.wording),
        };
        // The opinion has no number; the sections of its annex are counted from 1.
        let numbered = SectionKind::ALL.iter().copied().enumerate();
        let sections = numbered.map(|(number, kind)| {
            let title = section_title(kind, self.wording);
            let title = if number == 0 { title.to_owned() } else { format!("{number} {title}") };
            Section { kind, title, blocks: blocks(kind) }
        });
        let case = self.wording.given_name(&self.case.name);
        ReportDocument {
            title: format!("{}: {case}", words.report),
            case,
            date: settings.date.written(settings.language),
            date_iso: settings.date.to_string(),
            day: settings.date.parts(),
            language: settings.language,
            units: settings.units,
            paper: settings.paper,
            program: impactlab_core::program::version().to_owned(),
            sections: sections.collect(),
        }
    }

    /// What has changed or has no answer, where methods do not agree, and the opinion.
    fn opinion(&self, variants: &[VariantParts]) -> Vec<Block> {
        let (case, on_disk) = (self.case, self.on_disk);
        let (wording, paths) = (self.wording, self.paths);
        let mut blocks: Vec<Block> = Vec::new();
        blocks.extend(change_notice(&self.report.changes, wording, paths));
        blocks.extend(self.unanswered(variants));
        blocks.extend(self.disagreements(variants));
        blocks.extend(self.other_networks());
        blocks.extend(opinion_blocks(Asked { case, on_disk, variants, wording, paths }));
        blocks
    }

    /// Where two methods do not say the same of one collision, for the first page.
    fn disagreements(&self, variants: &[VariantParts]) -> Vec<Block> {
        let mut said = BTreeSet::new();
        for variant in variants {
            for part in variant.answers.iter().flatten() {
                let apart = part.caveats.iter();
                let apart = apart.filter(|caveat| caveat.kind == CaveatKind::Disagreement);
                said.extend(apart.map(|caveat| {
                    let warning = warning(caveat, self.wording);
                    match variants.len() > 1 {
                        true => format!("{}, {}: {warning}", variant.name, part.title),
                        false => format!("{}: {warning}", part.title),
                    }
                }));
            }
        }
        said.into_iter().map(Block::notice).collect()
    }

    /// How many questions have no answer.
    fn unanswered(&self, variants: &[VariantParts]) -> Option<Block> {
        let all: Vec<_> = variants.iter().flat_map(|variant| &variant.answers).collect();
        let n = all.iter().filter(|answer| answer.is_err()).count();
        let values = [("n", &*n.to_string()), ("all", &*all.len().to_string())];
        (n > 0).then(|| Block::notice(fill(self.wording.words.unanswered_notice, &values)))
    }

    /// Every picture once, with its number.
    fn pictures(&self, variants: &[VariantParts]) -> Vec<Block> {
        or(picture_blocks(variants, self.wording), self.wording.words.no_pictures)
    }

    fn validation(&self, variants: &[VariantParts]) -> Vec<Block> {
        let words = self.wording.words;
        if are_by_hand(variants) {
            return vec![Block::paragraph(words.validation_by_hand)];
        }
        let (methods, opinion) = (methods(variants), considered_methods(variants));
        let mut blocks: Vec<Block> = Vec::new();
        // Those without tables stand together at the end.
        for is_asked in [true, false] {
            let some = methods.iter().filter(|method| opinion.contains(*method) == is_asked);
            blocks
                .extend(some.flat_map(|method| validation_blocks(*method, &opinion, self.wording)));
        }
        if blocks.is_empty() {
            return vec![Block::paragraph(words.no_methods)];
        }
        let text = Block::paragraph(words.validation_text);
        [text].into_iter().chain(self.other_networks()).chain(blocks).collect()
    }

    /// That networks answered which are not the default ones, of which alone limits and measurements are.
    fn other_networks(&self) -> Option<Block> {
        let models = self.report.models();
        let others = models.iter().filter(|model| !ModelChoice::is_default(&model.name));
        let told = others.map(|model| {
            let name = self.wording.name(&self.paths.shown(&model.name));
            format!("{} ({name})", network_name(&model.network, self.wording))
        });
        let list = told.collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>().join(", ");
        let text = self.wording.words.other_networks;
        (!list.is_empty()).then(|| Block::Notice { text: fill(text, &[("list", &list)]) })
    }

    fn sensitivity(&self, variants: &[VariantParts]) -> Vec<Block> {
        let parts = |variant| parts_of(variant).filter(|part| !part.sensitivity.is_empty());
        let mut titles: Vec<&str> = Vec::new();
        for part in variants.iter().flat_map(parts) {
            if !titles.contains(&&*part.title) {
                titles.push(&part.title);
            }
        }
        let of_title = |title: &str| {
            let said = variants.iter().flat_map(|variant| {
                let parts = parts(variant).filter(|part| part.title == title);
                parts.map(|part| Said { name: &variant.name, blocks: part.sensitivity.clone() })
            });
            let said: Vec<Said<'_>> = said.collect();
            let names: Vec<&str> = said.iter().map(|said| said.name).collect();
            let is_of_all = variants.iter().all(|variant| names.contains(&&*variant.name));
            let heading = match is_of_all {
                true => title.to_owned(),
                false => format!("{title} ({})", names.join(", ")),
            };
            let mut blocks = vec![Block::heading(2, heading)];
            blocks.extend(beside_each_other(&said, self.wording));
            blocks
        };
        titles.into_iter().flat_map(of_title).collect()
    }

    fn provenance(&self, variants: &[VariantParts]) -> Vec<Block> {
        let mut answers: Vec<(AnswerNames<'_>, &PartProvenance)> = Vec::new();
        for variant in variants {
            for part in parts_of(variant) {
                let is_alike = |(names, provenance): &&mut (AnswerNames<'_>, &PartProvenance)| {
                    names.title == part.title && **provenance == part.provenance
                };
                match answers.iter_mut().find(is_alike) {
                    Some((names, _)) => names.add(&variant.name),
                    None => {
                        let variants = vec![&*variant.name];
                        answers
                            .push((AnswerNames { title: &part.title, variants }, &part.provenance));
                    }
                }
            }
        }
        let named: Vec<(String, PartProvenance)> = answers
            .into_iter()
            .map(|(names, provenance)| (names.text(variants, self.wording), provenance.clone()))
            .collect();
        provenance_blocks((self.case, self.on_disk), self.report, &named, self.wording, self.paths)
    }
}

/// The answers that there are.
pub(super) fn parts_of(variant: &VariantParts) -> impl Iterator<Item = &Part> {
    variant.answers.iter().filter_map(|answer| answer.as_ref().ok())
}

/// The inputs of each variant; of the later ones only what the first does not have, and what they lack of it.
fn input_blocks(variants: &[VariantParts], wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let mut blocks = vec![Block::paragraph(words.inputs_text)];
    let mut first: Option<(&str, Vec<&InputRow>)> = None;
    for variant in variants {
        let mut seen = BTreeSet::new();
        let all = parts_of(variant).flat_map(|part| &part.inputs);
        let all: Vec<&InputRow> = all.filter(|row| seen.insert(*row)).collect();
        let mut rows = all.clone();
        if let Some((name, known)) = &first {
            rows.retain(|row| !known.contains(row));
            let text = if rows.is_empty() { words.inputs_all_same } else { words.inputs_same_as };
            let mut text = fill(text, &[("name", name)]);
            let lacks = missing_inputs(known, &all).join("; ");
            if !lacks.is_empty() {
                text = format!("{text} {}", fill(words.inputs_without, &[("list", &lacks)]));
            }
            blocks.push(Block::heading(2, fill(words.variant, &[("name", &variant.name)])));
            blocks.push(Block::paragraph(text));
        }
        blocks.extend(input_tables(&variant.name, &rows, wording));
        first.get_or_insert((&variant.name, all));
    }
    blocks
}

fn methods(variants: &[VariantParts]) -> BTreeSet<Method> {
    variants.iter().flat_map(parts_of).flat_map(|part| &part.methods).copied().collect()
}

/// What the parts contribute, each once.
fn distinct(variants: &[VariantParts], blocks_of: impl Fn(&Part) -> &Vec<Block>) -> Vec<Block> {
    let mut written: Vec<&Vec<Block>> = Vec::new();
    for blocks in variants.iter().flat_map(parts_of).map(&blocks_of) {
        if !written.contains(&blocks) {
            written.push(blocks);
        }
    }
    written.into_iter().flatten().cloned().collect()
}

/// Blocks, or a sentence if there are none.
fn or(blocks: Vec<Block>, otherwise: &str) -> Vec<Block> {
    if blocks.is_empty() { vec![Block::paragraph(otherwise)] } else { blocks }
}

fn section_title(kind: SectionKind, wording: &Wording) -> &'static str {
    let words = wording.words;
    match kind {
        SectionKind::Opinion => words.section_opinion,
        SectionKind::Answers => words.section_answers,
        SectionKind::Pictures => words.section_pictures,
        SectionKind::Inputs => words.section_inputs,
        SectionKind::Evidence => words.section_evidence,
        SectionKind::Method => words.section_method,
        SectionKind::Validity => words.section_validity,
        SectionKind::Validation => words.section_validation,
        SectionKind::Sensitivity => words.section_sensitivity,
        SectionKind::Provenance => words.section_provenance,
        SectionKind::Log => words.section_log,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{InputClass, Language, Paper, ReportDate};
    use impactlab_core::units::UnitSystem;

    /// The answers of “base” and “Grundfall” were those of one variant in a German report.
    #[test]
    fn no_two_variants_have_one_name_in_a_report() {
        let german = Wording::new(&ReportSettings {
            language: Language::De,
            units: UnitSystem::Si,
            paper: Paper::A4,
            date: ReportDate::new(2026, 1, 2).unwrap(),
        });
        let variant = |name: &str| Variant { name: name.to_owned(), ..Variant::default() };
        for (second, told) in
            [("Grundfall", ["base", "Grundfall"]), ("coasts", ["Grundfall", "rollt aus"])]
        {
            let mut case = CaseFile::new("case", variant("base"));
            case.variants.push(variant(second));
            let names = case.variants.iter().map(|variant| shown_name(&case, variant, &german));
            assert_eq!(names.collect::<Vec<_>>(), told, "{second}");
        }
    }

    /// Of a car that coasts the report said “As in variant “driver brakes””, and nothing of the brake.
    #[test]
    fn what_a_later_variant_lacks_of_the_first_is_said() {
        let wording = Wording::english(UnitSystem::Si);
        let variant = |name: &str, inputs: &[[&str; 2]]| {
            let row = |[group, label]: &[&str; 2]| InputRow {
                group: (*group).to_owned(),
                label: (*label).to_owned(),
                value: "1".to_owned(),
                class: InputClass::Given,
                source: wording.words.source_question.to_owned(),
            };
            let inputs = inputs.iter().map(row).collect();
            let answers = vec![Ok(Part { inputs, ..Part::default() })];
            VariantParts { name: name.to_owned(), notes: String::new(), answers }
        };
        let brake = [["car", "mass"], ["after, brake", "from"], ["after, brake", "share"]];
        let variants = [
            variant("brakes", &brake),
            variant("coasts", &brake[..1]),
            variant("brakes later", &brake),
            variant("steers", &[["car", "mass"], ["car", "angle"], ["after, brake", "from"]]),
        ];
        let blocks = input_blocks(&variants, &wording);
        let paragraphs = blocks.iter().filter_map(|block| match block {
            Block::Paragraph { text } => Some(text.as_str()),
            _ => None,
        });
        let expected = [
            "As in variant “brakes”. Not in this variant: brake.",
            "As in variant “brakes”.",
            "As in variant “brakes”, except for what the table says. Not in this variant: brake, share.",
        ];
        assert_eq!(paragraphs.skip(1).collect::<Vec<_>>(), expected);
    }
}
