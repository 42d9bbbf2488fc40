//! A German report is German: no English word stands in it outside of what was published or named so.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use impactlab_core::units::UnitSystem;
use impactlab_document::report::{Block, Language, Paper, ReportDocument};
use impactlab_study::case_file::CaseFile;

use crate::report::{report, settings, staged};
use crate::report_opinion::assert_two_pages;

/// Words of English that are none of German.
const ENGLISH: [&str; 17] = [
    "the",
    "of",
    "and",
    "with",
    "from",
    "by",
    "to",
    "is",
    "are",
    "or",
    "not",
    "at",
    "estimated",
    "measured",
    "class",
    "speed",
    "car",
];

/// What is quoted as the file of the multibody model has it.
const QUOTED: [&str; 1] = ["„unsprung and links“"];

/// The notes of the example are the user's, and German here.
const NOTES: [(&str, &str); 2] = [
    (
        "Two 2000 kg cars at 54 km/h, bullet at 18 deg; made up, not measured.",
        "Zwei Fahrzeuge, erdacht.",
    ),
    (
        "A PIT at 54 km/h: does it matter whether the driver brakes, and how heavy the car is?",
        "Kommt es auf die Bremsung an?",
    ),
];

/// Texts with English words. Titles of publications stand in a table of their own, whose German words are
/// checked beside the code.
fn english(document: &ReportDocument) -> Vec<String> {
    let of_block = |block: &Block| match block {
        Block::Heading { text, .. } | Block::Paragraph { text } | Block::Notice { text } => {
            vec![text.clone()]
        }
        Block::List { items } => items.clone(),
        Block::Table(table) if table.columns.iter().any(|of| of.title == "Quelle") => Vec::new(),
        Block::Table(table) => {
            let titles = table.columns.iter().map(|column| column.title.clone()).collect();
            [vec![table.caption.clone()], titles, table.rows.concat()].concat()
        }
        Block::Picture(picture) => vec![picture.caption.clone(), picture.alt.clone()],
    };
    let texts = document.sections.iter().flat_map(|section| &section.blocks).flat_map(of_block);
    texts.filter(|text| is_english(text)).collect()
}

fn is_english(text: &str) -> bool {
    let text = QUOTED.iter().fold(text.to_owned(), |text, quoted| text.replace(quoted, ""));
    let mut words = text.split(|c: char| !c.is_alphabetic()).map(str::to_lowercase);
    words.any(|word| ENGLISH.contains(&&*word))
}

#[test]
fn an_english_word_is_seen() {
    assert!(is_english("Spur FL, distance to the path") && is_english("„said with it“"));
    assert!(!is_english("dreht um etwa 180° nach rechts; „unsprung and links“"));
}

/// The German report of the example, asked once for all tests.
pub fn german_example() -> &'static ReportDocument {
    static EXAMPLE: OnceLock<ReportDocument> = OnceLock::new();
    EXAMPLE.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples/pit.impactlab");
        let text = fs::read_to_string(&path).expect("the example");
        let text = NOTES.iter().fold(text, |text, (english, german)| {
            assert!(text.contains(english), "{english} is a name of the example");
            text.replace(english, german)
        });
        let case = CaseFile::parse(&text, &path).expect("a case");
        report(&case, &settings(Language::De, UnitSystem::Si, Paper::A4)).0
    })
}

#[test]
fn a_german_report_of_the_example_has_no_english_words() {
    let document = german_example();
    assert_eq!(english(document), Vec::<String>::new());
    // The signature stood alone on a third page.
    assert_two_pages(document, ["BeweisfrageundAntwort", "Anhang", "10ProtokolldesFalls"]);
}

#[test]
fn a_german_report_of_a_reconstruction_has_no_english_words() {
    let (_, case, _, _) = staged();
    let (document, _) = report(case, &settings(Language::De, UnitSystem::Si, Paper::A4));
    assert_eq!(english(&document), Vec::<String>::new());
}
