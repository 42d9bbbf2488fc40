//! The opinion at the front of a report: short, with probabilities before medians, what differs between
//! variants, and who gives it.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::units::UnitSystem;
use impactlab_document::report::{
    Block, Language, Paper, ReportDocument, SectionKind, Table, pdf, report_case,
};
use impactlab_reconstruct::evidence::Stated;
use impactlab_reconstruct::hand::HandMethod;
use impactlab_study::case_file::{CaseFile, Expert, Variant};
use impactlab_study::{HandRequest, ImpactRequest, Library, Request, ScenarioChoice};

use crate::report::{english, impact_case, pit, position_alone, report, settings, staged};

fn opinion(document: &ReportDocument) -> &[Block] {
    assert_eq!(document.sections[0].kind, SectionKind::Opinion);
    &document.sections[0].blocks
}

fn tables(document: &ReportDocument) -> Vec<&Table> {
    let blocks = opinion(document).iter();
    let tables = blocks.filter_map(|block| match block {
        Block::Table(table) => Some(table),
        _ => None,
    });
    tables.collect()
}

fn says(document: &ReportDocument, text: &str) -> bool {
    opinion(document).iter().any(|block| match block {
        Block::Heading { text: of, .. }
        | Block::Paragraph { text: of }
        | Block::Notice { text: of } => of.contains(text),
        Block::List { items } => items.iter().any(|item| item.contains(text)),
        Block::Table(table) => table.rows.iter().flatten().any(|cell| cell.contains(text)),
        Block::Picture(_) => false,
    })
}

/// The variants of the example differ in the driver and in the mass: that is named, and nothing else.
#[test]
fn variants_stand_beside_each_other_with_what_differs_and_courses_come_first() {
    let (document, _) = pit();
    let all = tables(document);
    assert!(all[0].caption.starts_with("Courses of events"), "{}", all[0].caption);
    let figures = all[1];
    assert_eq!(figures.columns.len(), 4);
    let differs = &figures.rows[0];
    assert!(differs[2].contains("brake"), "{differs:?}");
    assert!(differs[3].contains("1500 kg") && !differs[3].contains("brake"), "{differs:?}");
    assert!(figures.rows.iter().any(|row| row[0].contains("quarter turn") && row[1].contains('%')));
    assert!(says(document, "not validated against real collisions"));
    assert!(says(document, "No single estimate of vehicle or road"));
}

/// The annex, with its contents, begins on page 3 or before.
///
/// - `first`, `annex`, `last`: what the opinion begins with, the annex, and the last line of its contents,
///   without spaces.
pub fn assert_two_pages(document: &ReportDocument, [first, annex, last]: [&str; 3]) {
    let bytes = pdf(document, None).expect("a PDF");
    let read = lopdf::Document::load_mem(&bytes).expect("readable");
    let text = |page: u32| -> String {
        let text = read.extract_text(&[page]).expect("text");
        text.split_whitespace().collect()
    };
    assert!(text(1).contains(first));
    let is_contents = |page: &u32| text(*page).contains(annex) && text(*page).contains(last);
    assert!((1..=3).any(|page| is_contents(&page)), "the annex begins behind page 3");
}

#[test]
fn the_opinion_of_the_example_takes_at_most_two_pages() {
    let (document, _) = pit();
    assert_two_pages(document, ["Questionandanswer", "Annex", "10Logofthecase"]);
}

#[test]
fn who_gives_the_opinion_is_of_the_case_and_what_was_not_said_is_said() {
    let mut case = impact_case("pit", "");
    let en = settings(Language::En, UnitSystem::Si, Paper::A4);
    let (document, _) = report(&case, &en);
    assert!(says(&document, "Expert: not stated"));
    case.expert = Expert { name: Some("A. Beispiel".to_owned()), ..Expert::default() };
    let (document, _) = report(&case, &en);
    assert!(says(&document, "Expert: A. Beispiel"));
    assert!(says(&document, "Instruction: not stated"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case.impactlab");
    case.save(&path, impactlab_core::data::Existing::Refuse).expect("saved");
    assert_eq!(CaseFile::load(&path).expect("a case").expert, case.expert);
}

/// A reconstruction names its speeds and what they hinge on, with the hash of the evidence.
#[test]
fn a_reconstruction_has_an_opinion_with_its_materials() {
    let (_, case, document, _) = staged();
    assert!(says(document, "struck car"));
    assert!(says(document, &case.files[0].sha256));
}

/// A file of another client, which the window had drawn earlier, stood among the materials of the opinion, and
/// the report of one variant listed the files of the others.
#[test]
fn a_report_names_no_file_that_its_questions_do_not_rest_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = ["told.toml", "other.toml", "unasked.toml", "drawn.toml"].map(|name| {
        let path = folder.path().join(name);
        fs::copy("assets/scenarios/pit_right_rear.toml", &path).expect("copied");
        path
    });
    let [told, other, unasked, drawn] = &paths;
    let ask =
        |path: &Path| Request::from(ImpactRequest::new(ScenarioChoice::File(path.to_owned())));
    let variant = |name: &str, path: &Path| Variant {
        name: name.to_owned(),
        questions: vec![ask(path)],
        ..Variant::default()
    };
    let mut case = CaseFile::new("case", variant("first", told));
    case.variants[0].unasked = vec![ask(unasked)];
    case.variants[0].view = serde_json::json!({"recording": drawn});
    case.variants.push(variant("second", other));
    case.record_files();
    assert_eq!(case.files.len(), paths.len());
    let mut go_on = |_: impactlab_study::Event<'_>| ControlFlow::Continue(());
    let (library, variants) = (Library::default(), ["first".to_owned()]);
    let made = report_case(&case, None, &variants, &english(), &library, &mut go_on);
    let (document, _) = made.expect("a case").complete().expect("nobody cancels");
    let text = document.to_markdown();
    assert!(text.contains("told.toml"), "{text}");
    for name in ["other.toml", "unasked.toml", "drawn.toml"] {
        assert!(!text.contains(name), "{name}: {text}");
    }
}

/// Where the figures over all courses of events may be true of none, the opinion had no others.
#[test]
fn each_course_of_events_has_its_probability_and_its_speed_in_the_opinion() {
    let courses = tables(position_alone())[0];
    assert!(courses.caption.starts_with("Courses of events"), "{}", courses.caption);
    assert!(courses.rows.len() > 1, "{:?}", courses.rows);
    for row in &courses.rows {
        let is_told = row[1].contains(" ± ") && row[1].contains("; speed of the struck car: ");
        assert!(is_told, "{row:?}");
    }
}

/// A calculation by hand: what vehicle 1 had before it struck one at rest, of 1500 and 1200 kg.
fn by_hand() -> CaseFile {
    by_hand_with(Some(1.0))
}

/// - `sigma_m_s`: of both speeds after the impact, if it is stated.
fn by_hand_with(sigma_m_s: Option<f64>) -> CaseFile {
    let stated = |value, sigma| Stated { value: Some(value), sigma };
    let inputs = [
        ("mass_1_kg", stated(1500.0, Some(30.0))),
        ("mass_2_kg", stated(1200.0, Some(30.0))),
        ("speed_after_1_m_s", stated(8.0, sigma_m_s)),
        ("speed_after_2_m_s", stated(9.0, sigma_m_s)),
        ("speed_2_m_s", stated(0.0, Some(0.0))),
    ];
    let inputs = inputs.map(|(key, stated)| (key.to_owned(), stated)).into_iter().collect();
    let asked = HandRequest { inputs, ..HandRequest::new(HandMethod::MomentumInLine) };
    let questions = vec![asked.into()];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    CaseFile::new("hand", variant)
}

/// The opinion named a table of section 1, and section 8 said that no answer depends on anything.
#[test]
fn what_moves_a_calculation_by_hand_stands_where_the_opinion_says() {
    let (document, _) = report(&by_hand(), &english());
    assert!(says(&document, "stands in section 8"));
    let section = document.section(SectionKind::Sensitivity).expect("a section");
    assert!(section.title.starts_with("8 "), "{}", section.title);
    let tables = section.blocks.iter().filter_map(|block| match block {
        Block::Table(table) => Some(table),
        _ => None,
    });
    let names: Vec<&str> = tables.flat_map(|table| &table.rows).map(|row| &*row[0]).collect();
    assert!(names.contains(&"mass of vehicle 1 + 30 kg"), "{names:?}");
}

/// “v1 = (m1 v1' + m2 v2' − m2 v2)/m1; Beide Fahrzeuge bewegen sich” was the condition.
#[test]
fn the_condition_of_a_calculation_by_hand_is_a_sentence() {
    let settings = settings(Language::De, UnitSystem::Si, Paper::A4);
    let (document, _) = report(&by_hand(), &settings);
    let answers = document.section(SectionKind::Answers).expect("answers");
    let is_sentence = |block: &Block| match block {
        Block::Paragraph { text } => text.contains("/m1. Voraussetzung: Beide Fahrzeuge"),
        _ => false,
    };
    assert!(answers.blocks.iter().any(is_sentence), "{:?}", answers.blocks);
}

/// The question was named as the source of a standard deviation that it does not state.
#[test]
fn a_standard_deviation_of_the_program_has_the_program_as_its_source() {
    let is_told = |sigma_m_s| {
        let (document, _) = report(&by_hand_with(sigma_m_s), &english());
        let inputs = document.section(SectionKind::Inputs).expect("inputs");
        inputs.blocks.iter().any(|block| match block {
            Block::Table(table) => {
                let mut cells = table.rows.iter().flatten();
                cells.any(|cell| cell.contains("question; ± is that of the program"))
            }
            _ => false,
        })
    };
    assert!(is_told(None));
    assert!(!is_told(Some(1.0)));
}

/// What each section says in paragraphs.
fn paragraphs(document: &ReportDocument, kind: SectionKind) -> String {
    let section = document.section(kind).expect("a section");
    let texts = section.blocks.iter().filter_map(|block| match block {
        Block::Paragraph { text } => Some(text.as_str()),
        _ => None,
    });
    texts.collect::<Vec<_>>().join(" ")
}

/// The axes of reconstructions stood in section 5, and sections 6 and 7 told of models of which there are none.
#[test]
fn the_annex_of_a_calculation_by_hand_tells_of_no_models() {
    let (document, _) = report(&by_hand(), &english());
    for (kind, part) in [
        (SectionKind::Method, "its sources stand in section 1"),
        (SectionKind::Validity, "holds stands in section 1. Each restriction"),
        (SectionKind::Validation, "exercises whose answers are published"),
    ] {
        let told = paragraphs(&document, kind);
        assert!(told.contains(part), "{told}");
        for wrong in ["Axes are those", "models of the opinion", "answered by a model"] {
            assert!(!told.contains(wrong), "{wrong}: {told}");
        }
    }
    // The errors of some inputs are drawn together, of which a note tells.
    let answers = paragraphs(&document, SectionKind::Answers);
    assert!(answers.contains("depend on each other no more than the notes say"), "{answers}");
    let (document, _) = pit();
    assert!(paragraphs(document, SectionKind::Method).contains("Axes are those of ISO 8855"));
}

/// Readers by ear get the file that they need: PDF/UA-1, with a title and headers of rows.
#[test]
fn the_pdf_says_that_it_can_be_read_by_ear() {
    let (document, _) =
        report(&impact_case("pit", ""), &settings(Language::De, UnitSystem::Si, Paper::A4));
    let bytes = pdf(&document, None).expect("a PDF");
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("pdfuaid:part"), "no identifier of PDF/UA");
    let read = lopdf::Document::load_mem(&bytes).expect("readable");
    let scopes = read.objects.values().filter_map(|object| object.as_dict().ok());
    let is_row = |of: &lopdf::Dictionary| {
        of.get(b"Scope").and_then(|scope| scope.as_name()).is_ok_and(|name| name == b"Row")
    };
    let in_attributes = |of: &lopdf::Dictionary| {
        let all = of.get(b"A").and_then(|a| a.as_array());
        all.is_ok_and(|all| all.iter().filter_map(|a| a.as_dict().ok()).any(is_row))
            || of.get(b"A").and_then(|a| a.as_dict()).is_ok_and(is_row)
    };
    assert!(scopes.into_iter().any(|of| is_row(of) || in_attributes(of)), "no row has a header");
}
