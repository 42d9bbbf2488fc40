//! Looks texts up in the language of a report.

use crate::report::Language;
use crate::report::language::words::Words;
use crate::report::language::{de, de_sources, de_terms, de_training, en};
use impactlab_core::uncertainty::{CaveatKind, CaveatSubject};
use impactlab_core::vehicle::BuiltInVehicle;

/// The texts of the report itself.
pub(in crate::report) fn words_of(language: Language) -> &'static Words {
    match language {
        Language::En => &en::WORDS,
        Language::De => &de::WORDS,
    }
}

/// A label of the program in a language; `None` if the language has none for it.
pub(in crate::report) fn phrase_of(language: Language, text: &str) -> Option<String> {
    if language == Language::En || text.is_empty() {
        return Some(text.to_owned());
    }
    if let Some((_, term)) = terms().find(|(english, _)| *english == text) {
        return Some((*term).to_owned());
    }
    if let Some(label) = caveat_label(language, text) {
        return Some(label.to_owned());
    }
    if let Some(name) = BuiltInVehicle::german_name(text) {
        return Some(name);
    }
    let filled = templates().find_map(|(english, german)| {
        let rests = rests(english, text)?.into_iter().map(|rest| rest_of(language, rest));
        let rests = rests.collect::<Option<Vec<String>>>()?;
        let fill = |german: String, rest: &String| german.replacen("{}", rest, 1);
        Some(rests.iter().fold((*german).to_owned(), fill))
    });
    filled.or_else(|| {
        let (rule, source) = rule_with_source(text)?;
        Some(format!("{} ({})", phrase_of(language, rule)?, phrase_of(language, source)?))
    })
}

/// A name that the program gave where nobody gave one, such as “base 2” of a variant, in a language; `None` for
/// any other.
pub(in crate::report) fn given_name_of(language: Language, name: &str) -> Option<String> {
    let is_english = language == Language::En;
    let known = |name: &str| {
        let mut names = de_terms::GIVEN_NAMES.iter().filter(|_| !is_english);
        names.find(|(english, _)| *english == name).map(|(_, german)| (*german).to_owned())
    };
    known(name).or_else(|| {
        let (before, number) = name.rsplit_once(' ')?;
        number.parse::<usize>().ok()?;
        Some(format!("{} {number}", known(before)?))
    })
}

/// A rule, and its source in the brackets behind it.
fn rule_with_source(text: &str) -> Option<(&str, &str)> {
    let inner = text.strip_suffix(')')?;
    let mut n_open = 1_usize;
    let opens = inner.char_indices().rev().find_map(|(at, letter)| {
        match letter {
            ')' => n_open += 1,
            '(' => n_open -= 1,
            _ => {}
        }
        (n_open == 0).then_some(at)
    })?;
    Some((inner.get(..opens)?.strip_suffix(' ')?, inner.get(opens + 1..)?))
}

fn terms() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    de_terms::TERMS.iter().chain(de_sources::TERMS).chain(de_training::TERMS)
}

fn templates() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    let german = de_terms::TEMPLATES.iter().chain(de_sources::TEMPLATES);
    german.chain(de_training::TEMPLATES)
}

/// What stands in a template: a label, a list of labels, or a name or number. Of a list every part must be
/// known, since one that is not, as in “the car turns right by 90° to 270°, the driver brakes”, is of another label.
fn rest_of(language: Language, rest: &str) -> Option<String> {
    if let Some(known) = phrase_of(language, rest) {
        return Some(known);
    }
    if !rest.contains(", ") {
        return Some(rest.replace("deg/", "°/").replace(" deg", "°"));
    }
    let parts = rest.split(", ").map(|part| phrase_of(language, part));
    Some(parts.collect::<Option<Vec<String>>>()?.join(", "))
}

/// What stands in a text where a template has `{}`; `None` if it is not made from it.
fn rests<'a>(template: &str, text: &'a str) -> Option<Vec<&'a str>> {
    let (first, behind) = template.split_once("{}")?;
    let mut rest = text.strip_prefix(first)?;
    let pieces: Vec<&str> = behind.split("{}").collect();
    let (last, between) = pieces.split_last()?;
    let mut rests = Vec::new();
    for piece in between {
        let (found, behind) = rest.split_once(piece)?;
        rests.push(found);
        rest = behind;
    }
    rests.push(rest.strip_suffix(last)?);
    Some(rests)
}

/// What caveats are called.
fn caveat_label(language: Language, text: &str) -> Option<&'static str> {
    let kinds = CaveatKind::ALL.iter().map(|kind| (kind.label(), kind.label_in(language)));
    let subjects = CaveatSubject::ALL.iter().map(|it| (it.label(), it.label_in(language)));
    kinds.chain(subjects).find(|(english, _)| *english == text).map(|(_, label)| label)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{BRAKES_ALONE, ReplayCurve, WheelInput};
    use crate::report::keys::bare;
    use impactlab_core::collision::{SCENARIO_PRESETS, Scenario};
    use impactlab_core::vehicle::built_in_vehicle;
    use impactlab_core::vehicle::sheet::{DataSheet, SheetQuantity, VehicleClass};
    use impactlab_reconstruct::hand::HandMethod;
    use impactlab_reconstruct::{Latent, ReconstructedQuantity};
    use impactlab_study::case_file::CaseFile;
    use impactlab_study::{Measurements, json_kinds};
    use impactlab_sweep::atlas::Measure;
    use serde_json::Value;
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn a_source_is_what_the_last_bracket_holds() {
        let parts = rule_with_source("a rule (by class) of two (a source (1999))");
        assert_eq!(parts, Some(("a rule (by class) of two", "a source (1999)")));
        assert_eq!(["a) b)", "a(b)", "a (b"].map(rule_with_source), [None; 3]);
        // Each bracket of a name that was tried as that of a source doubled the work.
        assert_eq!(phrase_of(Language::De, &format!("qqq{}", " (qq)".repeat(60))), None);
    }

    /// Lanes without a name and the first variant of a case were English in a German report.
    #[test]
    fn a_name_of_the_program_is_translated_and_one_of_a_person_stays() {
        let german = |name: &str| given_name_of(Language::De, name);
        assert_eq!(german("lane 12").as_deref(), Some("Fahrstreifen 12"));
        assert_eq!(german("base").as_deref(), Some("Grundfall"));
        assert_eq!(["oncoming lane 1", "base b"].map(german), [None, None]);
        assert_eq!(given_name_of(Language::En, "base"), None);
    }

    /// “PIT, right rear quarter” stood in every heading of a German report.
    #[test]
    fn scenarios_and_variants_of_the_program_have_german_names() {
        let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/examples/pit.impactlab");
        let case = CaseFile::load(Path::new(example)).unwrap();
        let scenarios = SCENARIO_PRESETS.iter().map(|(id, _)| Path::new(id));
        let scenarios = scenarios.map(|id| Scenario::preset_or_file(id).unwrap().name);
        let variants = case.variants.into_iter().map(|variant| variant.name);
        for name in scenarios.chain(variants) {
            assert!(given_name_of(Language::De, &name).is_some(), "{name}");
        }
        let pit = given_name_of(Language::De, "PIT, right rear quarter");
        assert_eq!(pit.as_deref(), Some("PIT, hinten rechts"));
    }

    #[test]
    fn every_label_of_the_program_has_a_german_one() {
        let latents = Latent::ALL.iter().map(|latent| latent.label());
        let quantities = ReconstructedQuantity::EVERY.iter().map(|quantity| quantity.label());
        let sheet = SheetQuantity::ALL.iter().map(|quantity| quantity.label());
        let controls = WheelInput::ALL.into_iter().map(WheelInput::label).chain([BRAKES_ALONE]);
        let replayed = ReplayCurve::ALL.into_iter().map(ReplayCurve::label);
        let measures = Measure::all().map(Measure::label);
        let shown = controls.chain(replayed).chain(measures);
        for label in latents.chain(quantities).chain(sheet).chain(shown) {
            assert!(phrase_of(Language::De, label).is_some(), "{label}");
        }
        for method in HandMethod::ALL {
            let fields = method.fields().iter().map(|field| field.label);
            let outputs = method.outputs().iter().map(|output| output.label);
            for label in fields.chain(outputs).chain([method.label(), "points of the mark"]) {
                assert!(phrase_of(Language::De, label).is_some(), "{label}");
            }
        }
        let measured = Measurements::shipped();
        for held in measured.iter().flat_map(|measurement| &measurement.held) {
            assert!(phrase_of(Language::De, &held.quantity).is_some(), "{}", held.quantity);
        }
        let tables = measured.iter().flat_map(|measurement| &measurement.tables);
        let lines = tables.flat_map(|table| &table.lines);
        for cell in lines.flat_map(|line| line.split('|')).map(str::trim) {
            let has_words = cell.chars().filter(|c| c.is_alphabetic()).count() > 1;
            assert!(!has_words || phrase_of(Language::De, cell).is_some(), "{cell}");
        }
        for car in ["the car", "the struck car"] {
            for turn in ["by less than 90°", "left by 90° to 270°", "right by 270° to 450°"] {
                let turn = format!("{car} turns {turn}");
                assert!(phrase_of(Language::De, &turn).is_some(), "{turn}");
            }
        }
        for part in ["the driver brakes", "the driver does not brake", "no wheel blocked"] {
            assert!(phrase_of(Language::De, part).is_some(), "{part}");
        }
    }

    #[test]
    fn a_label_with_numbers_in_it_is_translated_around_them() {
        let german = |text: &str| phrase_of(Language::De, text);
        let scaled = german("scaled in proportion to the mass, from 2000 to 1500 kg");
        assert!(scaled.is_some_and(|text| text.contains("von 2000 auf 1500 kg")));
        let force =
            german("force: haversine of 100 ms that carries the impulse of the momentum solution");
        assert!(force.is_some_and(|text| text.contains("Haversine") && text.contains("100 ms")));
        assert_eq!(german("scaled in proportion to nothing"), None);
    }

    /// Rules of data sheets were quoted in English in a German report.
    #[test]
    fn every_rule_of_a_data_sheet_is_translated() {
        let sheets = VehicleClass::ALL.map(|class| DataSheet::new("car", class));
        for estimate in sheets.iter().flat_map(DataSheet::estimates) {
            for part in estimate.rule.split("; ").chain(estimate.source.split("; ")) {
                assert!(phrase_of(Language::De, part).is_some(), "{part}");
            }
        }
    }

    /// Sources of the vehicles that come with the program stood in English in a German report.
    #[test]
    fn name_source_and_rules_of_every_vehicle_are_translated() {
        for vehicle in BuiltInVehicle::all() {
            let car = &vehicle.parameters;
            let notes = car.estimates.values().chain(car.stated.values()).chain([&car.source]);
            for part in notes.flat_map(|note| note.split("; ")) {
                let german = phrase_of(Language::De, part);
                assert!(german.is_some(), "{}: {part}", vehicle.id);
            }
        }
        let german = |id: &str| phrase_of(Language::De, &built_in_vehicle(id).unwrap().name);
        let reference = "Referenzfahrzeug (Mehrkörpermodell, 2000 kg)";
        assert_eq!(german("reference-2000").as_deref(), Some(reference));
        let unknown = "gewöhnlicher Pkw, Modell unbekannt";
        assert_eq!(german("generic-car").as_deref(), Some(unknown));
    }

    #[test]
    fn a_list_in_brackets_is_translated_part_by_part() {
        let source = "NHTSA NCAP 2004 rollover measurements, with a driver's weight (mass, CG)";
        let expected =
            "NHTSA NCAP 2004, Kippversuche, mit dem Gewicht eines Fahrers (Masse, Schwerpunkt)";
        assert_eq!(phrase_of(Language::De, source).as_deref(), Some(expected));
    }

    /// “the car turns right by 90° to 270°, the driver brakes” lost its direction and kept its English end.
    #[test]
    fn a_template_takes_no_other_label_in() {
        for text in ["the car turns right by 90° to 270°, the driver brakes", "mark 1, unheard of"]
        {
            assert_eq!(phrase_of(Language::De, text), None, "{text}");
        }
    }

    /// What is told of an answer in sections of their own, or of a question in its title.
    const ELSEWHERE: [&str; 8] = [
        "question",
        "caveats",
        "notes",
        "badges",
        "assumptions",
        "version",
        "seed",
        "model_digests",
    ];

    /// Adds every name in what a schema describes.
    fn add_names(schema: &Value, root: &Value, within: &[&str], names: &mut BTreeSet<String>) {
        let of = |key: &str| schema.get(key).cloned().unwrap_or_default();
        if let Some(path) = of("$ref").as_str().and_then(|path| path.strip_prefix('#'))
            && !within.contains(&path)
        {
            let within = [within, &[path]].concat();
            add_names(root.pointer(path).unwrap(), root, &within, names);
        }
        for (name, field) in of("properties").as_object().into_iter().flatten() {
            if !ELSEWHERE.contains(&name.as_str()) {
                names.insert(name.clone());
                add_names(field, root, within, names);
            }
        }
        let choices = ["allOf", "anyOf", "oneOf"].map(of);
        let choices = choices.iter().filter_map(Value::as_array).flatten();
        for part in choices.chain(schema.get("items")) {
            add_names(part, root, within, names);
        }
    }

    /// The report of a training stood in English in a German case.
    #[test]
    fn every_name_in_a_training_is_translated() {
        for kind in json_kinds() {
            if !["train_force", "train_response", "fine_tune"].contains(&kind.name.as_str()) {
                continue;
            }
            for schema in [kind.request.to_value(), kind.answer.to_value()] {
                let mut names = BTreeSet::new();
                add_names(&schema, &schema, &[], &mut names);
                assert!(names.len() > 8, "{}: {names:?}", kind.name);
                for name in names {
                    let words = bare(&name);
                    assert!(phrase_of(Language::De, &words).is_some(), "{}: {name}", kind.name);
                }
            }
        }
    }

    /// Stability control was ESP, ESC, “Stabilitätsprogramm” and “Stabilitätsregelung” in one report.
    #[test]
    fn stability_control_has_one_german_name() {
        for (english, german) in terms() {
            let is_named = ["ESC", "tability control"].iter().any(|word| english.contains(word));
            let is_esc = is_named || *english == "esc";
            assert!(!is_esc || german.contains("ESC"), "{english}: {german}");
        }
    }

    /// A lane was “Spur”, which is a tire mark in the same report.
    #[test]
    fn a_lane_is_no_mark_in_german() {
        for (english, german) in terms().filter(|(english, _)| english.contains("lane")) {
            assert!(!german.contains("Spur") && !german.contains("spur"), "{english}: {german}");
        }
    }

    #[test]
    fn no_label_is_translated_twice() {
        let all: Vec<&str> = terms().map(|(english, _)| *english).collect();
        for (idx, english) in all.iter().enumerate() {
            assert!(!all[idx + 1..].contains(english), "{english}");
        }
    }
}
