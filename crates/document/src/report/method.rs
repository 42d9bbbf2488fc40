//! How the answers of a report were computed, with the sources.

use std::collections::BTreeSet;

use crate::report::language::phrase_of;
use crate::report::numbers::{Wording, fill};
use crate::report::{Block, Language, Table};
use impactlab_core::bibliography as sources;
use impactlab_core::collision::contact::USUAL_ELEMENT_M;
use impactlab_core::units::{Quantity, UnitSystem};

/// By what an answer is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Method {
    /// Planar impact with restitution and friction.
    Impact,
    /// The 4DOF model of the struck vehicle.
    FourDof,
    /// The 4DOF model of a single car.
    FourDofAlone,
    /// The contact law of two outlines.
    ContactLaw,
    /// The force network.
    ForceNetwork,
    /// The response network.
    ResponseNetwork,
    /// From the evidence to the speeds.
    Reconstruction,
    /// From the evidence of a single car to its speed.
    SingleCar,
    /// What a data sheet leaves open, by rule.
    DataSheet,
}

/// Closing speeds of the finite-element runs of slow PITs, lowest and highest, and highest of all runs, m/s.
const CLOSING_SPEEDS_M_S: [f64; 3] = [0.8, 5.0, 12.0];

/// A text on finite-element runs with their closing speeds in the units of the report.
pub(super) fn with_speeds(text: &str, wording: &Wording) -> String {
    let [slow, middle, fast] = CLOSING_SPEEDS_M_S.map(|si| wording.rough(Quantity::Speed, si));
    fill(text, &[("slow", &slow), ("middle", &middle), ("fast", &fast)])
}

impl Method {
    /// What it is called.
    pub fn name(self, wording: &Wording) -> &'static str {
        let words = wording.words;
        match self {
            Self::Impact => words.method_impact,
            Self::FourDof => words.method_four_dof,
            Self::FourDofAlone => words.method_four_dof_alone,
            Self::ContactLaw => words.method_contact,
            Self::ForceNetwork => words.method_force,
            Self::ResponseNetwork => words.method_response,
            Self::Reconstruction => words.method_reconstruction,
            Self::SingleCar => words.method_single_car,
            Self::DataSheet => words.method_sheet,
        }
    }

    /// How it works, in a paragraph.
    fn text(self, wording: &Wording) -> String {
        let words = wording.words;
        let text = match self {
            Self::Impact => words.method_impact_text,
            Self::FourDof => words.method_four_dof_text,
            Self::FourDofAlone => words.method_four_dof_alone_text,
            Self::ContactLaw => words.method_contact_text,
            Self::ForceNetwork => words.method_force_text,
            Self::ResponseNetwork => words.method_response_text,
            Self::Reconstruction => words.method_reconstruction_text,
            Self::SingleCar => words.method_single_car_text,
            Self::DataSheet => words.method_sheet_text,
        };
        let length = Quantity::Length.display_unit(wording.units).from_si(USUAL_ELEMENT_M);
        let element = match wording.units {
            UnitSystem::Si => wording.with_unit(&format!("{:.0}", 100.0 * length), "cm"),
            UnitSystem::Us => wording.with_unit(&format!("{:.1}", 12.0 * length), "in"),
        };
        fill(text, &[("element", &element)])
    }

    /// What is neglected and how far it holds.
    pub fn limits(self, wording: &Wording) -> String {
        let words = wording.words;
        let text = match self {
            Self::Impact => words.limits_impact,
            Self::FourDof => words.limits_four_dof,
            Self::FourDofAlone => words.limits_four_dof_alone,
            Self::ContactLaw => words.limits_contact,
            Self::ForceNetwork => words.limits_force,
            Self::ResponseNetwork => words.limits_response,
            Self::Reconstruction => words.limits_reconstruction,
            Self::SingleCar => words.limits_single_car,
            Self::DataSheet => words.limits_sheet,
        };
        with_speeds(text, wording)
    }

    /// Its sources as the program documents them.
    fn sources(self) -> &'static [&'static str] {
        match self {
            Self::Impact => &[
                sources::Kudlich1966::TEXT,
                sources::Slibar1966::TEXT,
                sources::Brach2011::TEXT,
                sources::CarpenterWelcher2019::TEXT,
            ],
            Self::FourDof | Self::FourDofAlone => {
                &[sources::PitPinnPaper::TEXT, sources::Gillespie1992::TEXT]
            }
            Self::ContactLaw => &[sources::EdsmacManual::TEXT, sources::Campbell1974::TEXT],
            Self::ForceNetwork => {
                &[sources::PitPinnPaper::TEXT, sources::RasmussenWilliams2006::TEXT]
            }
            Self::ResponseNetwork => &[sources::PitPinnPaper::TEXT],
            Self::Reconstruction | Self::SingleCar => &[
                sources::DelMoral2006::TEXT,
                sources::Jasra2011::TEXT,
                sources::OwenZhou2000::TEXT,
                sources::Cornuet2012::TEXT,
                sources::GelmanMengStern1996::TEXT,
                sources::KennedyOHagan2001::TEXT,
            ],
            Self::DataSheet => &[
                sources::Heydinger1999::TEXT,
                sources::KktseInertia2020::TEXT,
                sources::Ncap2004::TEXT,
                sources::Cvs2024::TEXT,
            ],
        }
    }
}

/// Of three texts those of collisions, of the reconstruction of a single car, and of one that is driven, by
/// what the methods answer.
pub(super) fn of_kinds(
    methods: &BTreeSet<Method>,
    [collision, single_car, driven]: [&'static str; 3],
) -> impl Iterator<Item = &'static str> {
    const OF_SINGLE_CAR: [Method; 3] = [Method::FourDofAlone, Method::SingleCar, Method::DataSheet];
    let is_single_car = methods.contains(&Method::SingleCar);
    let is_driven = !is_single_car && methods.contains(&Method::FourDofAlone);
    let is_alone = is_single_car || is_driven;
    let is_collision = !is_alone || methods.iter().any(|method| !OF_SINGLE_CAR.contains(method));
    let told = [(is_collision, collision), (is_single_car, single_car), (is_driven, driven)];
    told.into_iter().filter_map(|(is_told, text)| is_told.then_some(text))
}

/// A paragraph for each method, and the sources of all, numbered.
pub(super) fn method_blocks(methods: &BTreeSet<Method>, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let mut cited: Vec<&'static str> = Vec::new();
    let axes = [words.axes_text, words.axes_single_car_text, words.axes_driven_text];
    let axes = of_kinds(methods, axes);
    let mut blocks: Vec<Block> = axes.map(Block::paragraph).collect();
    for method in methods {
        let numbers: Vec<String> = method
            .sources()
            .iter()
            .map(|source| {
                let known = cited.iter().position(|known| known == source);
                let idx = known.unwrap_or_else(|| {
                    cited.push(source);
                    cited.len() - 1
                });
                format!("[{}]", idx + 1)
            })
            .collect();
        blocks.push(Block::heading(2, method.name(wording)));
        let text = method.text(wording);
        blocks.push(Block::paragraph(format!("{text} {}: {}.", words.sources, numbers.join(", "))));
    }
    if !cited.is_empty() {
        let row = |(idx, text): (usize, &&str)| {
            [format!("[{}]", idx + 1), numbered(text, &cited, wording)]
        };
        let rows = cited.iter().enumerate().map(row).collect();
        let columns = [words.number, words.source_title];
        blocks.push(Block::Table(Table::new(words.sources, columns, rows)));
    }
    blocks
}

/// A source by itself, in the language of the report.
pub(super) fn citation(text: &str, wording: &Wording) -> String {
    numbered(text, &[], wording)
}

/// A citation in which other sources are told by their numbers.
fn numbered(text: &str, cited: &[&'static str], wording: &Wording) -> String {
    let mut told = match wording.language {
        Language::En => first_paragraph(text).replace('*', ""),
        Language::De => in_german(&first_paragraph(text), wording),
    };
    for (key, name, source) in NAMED {
        let number = cited.iter().position(|known| known == source);
        let number = number.map_or_else(|| (*name).to_owned(), |idx| format!("[{}]", idx + 1));
        told = told.replace(key, &number);
    }
    told
}

/// Sources that others name: the key in the program, authors and year, and the text.
const NAMED: &[(&str, &str, &str)] = &[
    ("Kudlich1966", "Kudlich 1966", sources::Kudlich1966::TEXT),
    ("Heydinger1999", "Heydinger 1999", sources::Heydinger1999::TEXT),
    ("KktseInertia2020", "kktse.github.io 2020", sources::KktseInertia2020::TEXT),
];

/// The first paragraph of the documentation of a source, without marks of Markdown but those of titles.
fn first_paragraph(text: &str) -> String {
    let first = text.lines().map(str::trim).take_while(|line| !line.is_empty());
    let joined = first.collect::<Vec<_>>().join(" ");
    joined.chars().filter(|c| !matches!(c, '`' | '[' | ']')).collect()
}

/// A citation with its titles in quotation marks, as they were published, and German words around them.
///
/// - `citation`: with titles between asterisks.
fn in_german(citation: &str, wording: &Wording) -> String {
    let pieces: Vec<&str> = citation.split('*').collect();
    let mut told = String::new();
    for (idx, piece) in pieces.iter().enumerate() {
        if idx % 2 == 1 {
            told.push_str(&format!("„{piece}“"));
        } else if idx + 1 < pieces.len() {
            told.push_str(&piece.replace(" and ", " und "));
        } else {
            let [publication, between, remark] = behind_title(piece);
            let known =
                |part: &str| phrase_of(Language::De, part).unwrap_or_else(|| part.to_owned());
            let publication: Vec<String> = publication.split(", ").map(known).collect();
            told.push_str(&format!("{}{between}{}", publication.join(", "), wording.term(remark)));
        }
    }
    told
}

/// What stands behind the last title of a citation: the publication, and what it is cited for.
fn behind_title(text: &str) -> [&str; 3] {
    if let Some(remark) = text.strip_prefix(": ") {
        return ["", ": ", remark];
    }
    let parts = text.split_once(". ");
    parts.map_or([text, "", ""], |(publication, remark)| [publication, ". ", remark])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Paper, ReportDate, ReportSettings};

    const ALL: [Method; 9] = [
        Method::Impact,
        Method::FourDof,
        Method::FourDofAlone,
        Method::ContactLaw,
        Method::ForceNetwork,
        Method::ResponseNetwork,
        Method::Reconstruction,
        Method::SingleCar,
        Method::DataSheet,
    ];

    /// “Elements of 8 cm” stood in a report in US units.
    #[test]
    fn elements_of_outlines_are_in_the_units_of_the_report() {
        let told = |units| Method::ContactLaw.text(&Wording::english(units));
        assert!(told(UnitSystem::Si).contains("elements of 8 cm;"), "{}", told(UnitSystem::Si));
        assert!(told(UnitSystem::Us).contains("elements of 3.1 in;"), "{}", told(UnitSystem::Us));
    }

    /// “Close at 0.5 to 12 m/s” stood in a report whose speeds are in mph.
    #[test]
    fn closing_speeds_are_in_the_units_of_the_report() {
        let told = |units| Method::ForceNetwork.limits(&Wording::english(units));
        assert!(
            told(UnitSystem::Si).contains("close at up to 43 km/h;"),
            "{}",
            told(UnitSystem::Si)
        );
        assert!(
            told(UnitSystem::Us).contains("close at up to 27 mph;"),
            "{}",
            told(UnitSystem::Us)
        );
    }

    /// What a source is cited for stood in English in a German report.
    #[test]
    fn a_german_citation_has_its_title_as_published_and_german_words_around_it() {
        const BY_HAND: [&str; 3] = [
            sources::Davis2014::TEXT,
            sources::NiehoffGabler2006::TEXT,
            sources::Richardson2012::TEXT,
        ];
        for source in ALL.iter().flat_map(|method| method.sources()).chain(&BY_HAND) {
            let citation = first_paragraph(source);
            let [.., remark] = behind_title(citation.rsplit('*').next().unwrap_or_default());
            assert!(phrase_of(Language::De, remark).is_some(), "{remark}");
        }
        let wording = Wording::new(&ReportSettings {
            language: Language::De,
            units: UnitSystem::Si,
            paper: Paper::A4,
            date: ReportDate::new(2026, 1, 2).unwrap(),
        });
        assert_eq!(
            numbered(sources::Brach2011::TEXT, &[], &wording),
            "R. M. Brach, R. M. Brach, „Vehicle Accident Analysis and Reconstruction Methods“, 2. Aufl., \
             SAE International, 2011. Ebene Stoßmechanik, Stoßziffer und Impulsverhältnis."
        );
        let edsmac = numbered(sources::EdsmacManual::TEXT, &[], &wording);
        assert!(edsmac.contains("Collisions“ und „EDSMAC4“, Programmhandbücher"), "{edsmac}");
    }

    #[test]
    fn a_citation_has_authors_title_and_year_and_no_marks() {
        let english = Wording::english(UnitSystem::Si);
        let citation = |text| numbered(text, &[], &english);
        let text = citation(sources::OwenZhou2000::TEXT);
        assert!(
            text.starts_with("A. Owen, Y. Zhou, Safe and effective importance sampling"),
            "{text}"
        );
        assert!(text.contains("2000"), "{text}");
        assert!(!citation(sources::PitPinnPaper::TEXT).contains('|'));
    }

    /// Keys of the program, such as “Heydinger1999”, stood in the list.
    #[test]
    fn sources_are_named_by_their_numbers_and_not_by_keys_of_the_program() {
        let cited = [sources::Heydinger1999::TEXT, sources::KktseInertia2020::TEXT];
        let english = Wording::english(UnitSystem::Si);
        let first = numbered(cited[0], &cited, &english);
        assert!(first.contains("[2]"), "{first}");
        for source in ALL.iter().flat_map(|method| method.sources()) {
            let told = numbered(source, &[], &english);
            let mut words = told.split(|c: char| !c.is_alphanumeric());
            let is_key = |word: &str| {
                let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
                let is_name = name.len() > 2 && name.chars().all(char::is_alphabetic);
                is_name && word.len() == name.len() + 4
            };
            assert!(!words.any(is_key), "{told}");
        }
    }
}
