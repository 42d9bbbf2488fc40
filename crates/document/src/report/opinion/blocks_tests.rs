//! Tests of the opinion as blocks.

use super::*;
use crate::report::Language;
use impactlab_core::uncertainty::Caveat;
use impactlab_core::units::UnitSystem;
use impactlab_study::case_file::Variant;

/// Which of two forecasts of a variant an answer was of stood nowhere, and the figures were those of the
/// first.
#[test]
fn each_of_two_forecasts_of_a_variant_has_its_name_and_its_figures() {
    let forecast = |answer: &str| Part {
        opinion: Some(PartOpinion {
            rank: Rank::Forecast,
            question: "Where does it go?".to_owned(),
            answer: answer.to_owned(),
            courses: Vec::new(),
            figures: vec![["distance".to_owned(), answer.to_owned()]],
            held: None,
            is_doubtful: false,
            hinges: Vec::new(),
            left_out: Vec::new(),
        }),
        ..Part::default()
    };
    let forecasts = ["1 m", "2 m"].map(|answer| Ok(forecast(answer))).into();
    let variant = VariantParts { name: "a".to_owned(), notes: String::new(), answers: forecasts };
    let (variants, wording) = ([variant], Wording::english(UnitSystem::Si));
    let spoken = spoken(&variants);
    let told = format!("{:?}", answers(&spoken, &wording));
    assert!(told.contains("a (1)") && told.contains("a (2)"), "{told}");
    let told = format!("{:?}", figures(&spoken, &wording));
    assert!(told.contains("1 m") && told.contains("2 m"), "{told}");
}

/// “The program warns of nothing” stood in the opinion of a question without an answer, between empty lists.
#[test]
fn of_a_question_without_an_answer_no_more_is_said_than_that() {
    let answers = vec![Err("there is no such file".to_owned())];
    let variants = [VariantParts { name: "a".to_owned(), notes: String::new(), answers }];
    let case = CaseFile::new("case", Variant { name: "a".to_owned(), ..Variant::default() });
    let (wording, paths) = (Wording::english(UnitSystem::Si), ShownPaths::default());
    let asked =
        Asked { case: &case, on_disk: None, variants: &variants, wording: &wording, paths: &paths };
    let told = format!("{:?}", opinion_blocks(asked));
    assert!(told.contains("No answer of the case") && told.contains("Expert"), "{told}");
    assert!(!told.contains("no warning") && !told.contains("not considered"), "{told}");
}

/// “agree: each lies in the 90 % intervals of the other” stood three times in one row.
#[test]
fn a_figure_that_is_the_same_in_all_variants_is_told_once() {
    let variant = |name: &str, path: &str| {
        let row = |name: &str, value: &str| [name.to_owned(), value.to_owned()];
        let opinion = PartOpinion {
            rank: Rank::Forecast,
            question: "Where does it go?".to_owned(),
            answer: path.to_owned(),
            courses: Vec::new(),
            figures: vec![row("distance", path), row("the methods", "agree")],
            held: None,
            is_doubtful: false,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        let part = Part { opinion: Some(opinion), ..Part::default() };
        VariantParts { name: name.to_owned(), notes: String::new(), answers: vec![Ok(part)] }
    };
    let wording = Wording::english(UnitSystem::Si);
    let told = |variants: &[VariantParts]| figures(&spoken(variants), &wording);
    let both = told(&[variant("a", "1 m"), variant("b", "2 m")]);
    let [Block::Table(table), text] = &both[..] else { panic!("{both:?}") };
    assert!(table.rows.iter().all(|row| row[0] != "the methods"), "{table:?}");
    let once = "The same in each of these variants: the methods: agree.";
    assert_eq!(*text, Block::paragraph(once));
    // One variant has them all in its table.
    let one = told(&[variant("a", "1 m")]);
    let [Block::Table(table)] = &one[..] else { panic!("{one:?}") };
    assert_eq!(table.rows, [["distance", "1 m"], ["the methods", "agree"]]);
}

/// What the opinion says of how often intervals of an answer held.
///
/// - `table`: what was counted.
fn told_of_held(rank: Rank, table: Option<Block>, methods: &[Method]) -> String {
    told_of_variants([("a", false, table)], rank, methods)
}

/// The same of several variants.
///
/// - `variants`: name, whether it is doubtful, and what was counted.
fn told_of_variants<const N: usize>(
    variants: [(&str, bool, Option<Block>); N],
    rank: Rank,
    methods: &[Method],
) -> String {
    let variants = variants.map(|(name, is_doubtful, held)| {
        let opinion = PartOpinion {
            rank,
            question: "How does it move?".to_owned(),
            answer: "1 m".to_owned(),
            courses: Vec::new(),
            figures: vec![["distance, over the drawn vehicles".to_owned(), "1 m".to_owned()]],
            held,
            is_doubtful,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        let methods = methods.iter().copied().collect();
        let part = Part { opinion: Some(opinion), methods, ..Part::default() };
        VariantParts { name: name.to_owned(), notes: String::new(), answers: vec![Ok(part)] }
    });
    format!("{:?}", held(&spoken(&variants), &Wording::english(UnitSystem::Si)))
}

/// “It was not counted” stood above an annex in which it was.
#[test]
fn what_was_counted_is_not_said_of_a_doubtful_answer() {
    let table = || Some(Block::paragraph("19 of 20"));
    let (rank, methods) = (Rank::Reconstruction, [Method::Reconstruction]);
    let told = told_of_variants([("a", true, None)], rank, &methods);
    assert!(
        told.contains("says nothing about an answer") && !told.contains("not counted"),
        "{told}"
    );
    let told = told_of_variants([("a", false, table()), ("b", true, None)], rank, &methods);
    assert!(told.contains("19 of 20") && told.contains("“b”: How often"), "{told}");
    let told = told_of_variants([("a", false, None), ("b", true, None)], rank, &methods);
    assert!(told.contains("not counted") && told.contains("“b”: How often"), "{told}");
}

/// How often intervals held of coasting and of braked cars stood in two tables, of which none said whose it was.
#[test]
fn what_was_counted_of_one_variant_bears_its_name() {
    let table = |n: &str| {
        let rows = vec![["place at the end".to_owned(), n.to_owned()]];
        Some(Block::Table(Table::new("Held", ["Quantity", "Cases"], rows)))
    };
    let told = |second: &str| {
        let variants = [("a", false, table("48")), ("b", false, table(second))];
        told_of_variants(variants, Rank::Forecast, &[Method::ResponseNetwork])
    };
    let (other, same) = (told("24"), told("48"));
    assert!(other.contains("\"a: Held\"") && other.contains("\"b: Held\""), "{other}");
    assert!(same.contains("\"Held\"") && !same.contains(": Held"), "{same}");
}

/// “The intervals were tried …; the bounds are those of 95 % confidence” stood below “it was not counted”.
#[test]
fn intervals_that_were_not_counted_are_not_said_to_have_been_tried() {
    let told = told_of_held(Rank::Simulation, None, &[Method::Impact, Method::FourDof]);
    assert!(told.contains("it was not counted"), "{told}");
    assert!(!told.contains("were tried") && !told.contains("confidence"), "{told}");
}

/// “In brackets the interval that holds with a probability of 90 %” stood above components along x and y.
#[test]
fn figures_of_what_varies_nothing_have_no_intervals_and_say_so() {
    for rank in [Rank::Impact, Rank::Simulation] {
        no_intervals_are_told_of(rank);
    }
}

fn no_intervals_are_told_of(rank: Rank) {
    let opinion = PartOpinion {
        rank,
        question: "Which impulse?".to_owned(),
        answer: "2 kN s".to_owned(),
        courses: Vec::new(),
        figures: vec![["impulse".to_owned(), "2 kN s (x 1, y 1.7)".to_owned()]],
        held: None,
        is_doubtful: false,
        hinges: Vec::new(),
        left_out: Vec::new(),
    };
    let part = Part { opinion: Some(opinion), ..Part::default() };
    let (name, notes) = ("a".to_owned(), String::new());
    let variants = [VariantParts { name, notes, answers: vec![Ok(part)] }];
    let (spoken, wording) = (spoken(&variants), Wording::english(UnitSystem::Si));
    let told = format!("{:?}", figures(&spoken, &wording));
    assert!(told.contains("no intervals") && !told.contains("90 %"), "{told}");
    let told = format!("{:?}", held(&spoken, &wording));
    assert!(told.contains("have no interval") && !told.contains("not counted"), "{told}");
}

/// “In brackets the interval that holds with a probability of 90 %” stood above medians without any, and above
/// intervals of evidence that contradicts itself.
#[test]
fn figures_of_a_reconstruction_say_what_stands_in_brackets() {
    let title = |value: &str, is_doubtful| {
        let opinion = PartOpinion {
            rank: Rank::Reconstruction,
            question: "How fast?".to_owned(),
            answer: value.to_owned(),
            courses: Vec::new(),
            figures: vec![["speed".to_owned(), value.to_owned()]],
            held: None,
            is_doubtful,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        let part = Part { opinion: Some(opinion), ..Part::default() };
        let (name, notes) = ("a".to_owned(), String::new());
        let variants = [VariantParts { name, notes, answers: vec![Ok(part)] }];
        figures_title(&spoken(&variants), opinion_words(Language::En))
    };
    assert!(title("67 (60 to 75) km/h", false).contains("probability of 90 %"));
    assert!(title("67 (60 to 75) km/h", true).contains("as far as it can be relied on"));
    assert_eq!(title("110 km/h", true), "Figures, which have no intervals");
}

/// “95.8 % of 48 cases” stood without a word beside an answer on a car that no network knows.
#[test]
fn what_was_counted_inside_of_the_domain_is_said_to_be_so() {
    let told = |kinds: &[CaveatKind]| {
        let caveats = kinds.iter().map(|kind| Caveat::new(*kind, "heavy")).collect();
        let opinion = PartOpinion {
            rank: Rank::Forecast,
            question: String::new(),
            answer: String::new(),
            courses: Vec::new(),
            figures: Vec::new(),
            held: Some(Block::paragraph("48 of 48")),
            is_doubtful: false,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        let part = Part { opinion: Some(opinion), caveats, ..Part::default() };
        let (name, notes) = ("a".to_owned(), String::new());
        let variants = [VariantParts { name, notes, answers: vec![Ok(part)] }];
        format!("{:?}", held(&spoken(&variants), &Wording::english(UnitSystem::Si)))
    };
    assert!(told(&[CaveatKind::OutsideDomain]).contains("outside the domain"));
    assert!(!told(&[]).contains("outside the domain"));
}

/// Section 7 alone said that the pairs were computed without the force network.
#[test]
fn what_was_counted_without_the_force_network_is_said_to_be_so() {
    let table = || Some(Block::paragraph("48 of 48"));
    let with_contact = [Method::ResponseNetwork, Method::ContactLaw, Method::ForceNetwork];
    let told = told_of_held(Rank::Forecast, table(), &with_contact);
    assert!(told.contains("without the force network"), "{told}");
    let told = told_of_held(Rank::Forecast, table(), &[Method::ResponseNetwork]);
    assert!(!told.contains("without the force network"), "{told}");
}

/// Of a variant whose driver is known to have braked, and which has one course of events, each course of the other
/// was “in no draw”.
#[test]
fn a_variant_with_one_course_does_not_say_that_there_is_none() {
    let variant = |name: &str, courses: &[&str]| {
        let row = |course: &&str| [(*course).to_owned(), "50.0 %".to_owned()];
        let opinion = PartOpinion {
            rank: Rank::Reconstruction,
            question: "How fast was it?".to_owned(),
            answer: String::new(),
            courses: courses.iter().map(row).collect(),
            figures: Vec::new(),
            held: None,
            is_doubtful: false,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        let answers = vec![Ok(Part { opinion: Some(opinion), ..Part::default() })];
        VariantParts { name: name.to_owned(), notes: String::new(), answers }
    };
    let variants = [
        variant("unknown", &["it brakes", "it coasts"]),
        variant("brakes", &[]),
        variant("other", &["it brakes", "it turns"]),
    ];
    let blocks = courses(&spoken(&variants), &Wording::english(UnitSystem::Si));
    let [Block::Table(table)] = &blocks[..] else { panic!("{blocks:?}") };
    let expected = [
        ["it brakes", "50.0 %", "–", "50.0 %"],
        ["it coasts", "50.0 %", "–", "in no draw"],
        ["it turns", "in no draw", "–", "50.0 %"],
    ];
    assert_eq!(table.rows, expected);
}
