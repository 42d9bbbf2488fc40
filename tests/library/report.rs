//! Reports: every section, the numbers of the answers as the window shows them, and the same bytes from the
//! same case.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use impactlab_core::collision::Scenario;
use impactlab_core::data::Existing;
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};
use impactlab_core::units::{Estimate, NumberFormat, Phrase, Quantity, UnitSystem};
use impactlab_core::vehicle::Integrator;
use impactlab_document::report::{
    Block, Language, Paper, ReportDate, ReportDocument, ReportSettings, SectionKind, pdf,
    report_case,
};
use impactlab_study::analysis::PulseSetup;
use impactlab_study::case_file::{CaseFile, CaseReport, Variant, pack, unpack};
use impactlab_study::{
    EvidenceChoice, ForceQuestion, ForceSource, ImpactRequest, Library, Measurements, ModelChoice,
    MotionSource, PredictForceRequest, PredictMotionRequest, ReconstructRequest, Report,
    ScenarioChoice, SimulateDatasetRequest, VehicleChoice,
};

use crate::report_pdf::gray;

/// Particles of a reconstruction that is asked only for the look of its report.
const FEW_PARTICLES: usize = 200;

pub fn settings(language: Language, units: UnitSystem, paper: Paper) -> ReportSettings {
    let date = ReportDate::new(2026, 11, 24).expect("a day");
    ReportSettings { language, units, paper, date }
}

pub fn english() -> ReportSettings {
    settings(Language::En, UnitSystem::Si, Paper::A4)
}

pub fn report(case: &CaseFile, settings: &ReportSettings) -> (ReportDocument, CaseReport) {
    let mut go_on = |_: impactlab_study::Event<'_>| ControlFlow::Continue(());
    let outcome = report_case(case, None, &[], settings, &Library::default(), &mut go_on);
    outcome.expect("a case").complete().expect("nobody cancels")
}

/// The example of the program, asked once for all tests.
pub fn pit() -> &'static (ReportDocument, CaseReport) {
    static PIT: OnceLock<(ReportDocument, CaseReport)> = OnceLock::new();
    PIT.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples/pit.impactlab");
        report(&CaseFile::load(&path).expect("a case"), &english())
    })
}

/// A case that reconstructs a staged collision, in a folder of its own.
fn reconstruction(folder: &Path) -> CaseFile {
    reconstruction_of("datasets/staged/evidence/s03.toml", folder)
}

/// The same of other evidence.
pub fn reconstruction_of(evidence: &str, folder: &Path) -> CaseFile {
    let staged = Path::new(env!("CARGO_MANIFEST_DIR")).join(evidence);
    let evidence = folder.join("evidence.toml");
    fs::copy(staged, &evidence).expect("copied");
    let question = ReconstructRequest {
        particles: FEW_PARTICLES,
        ..ReconstructRequest::new(EvidenceChoice::File(evidence))
    };
    let variant = Variant {
        name: "found".to_owned(),
        questions: vec![question.into()],
        ..Variant::default()
    };
    let mut case = CaseFile::new("Staged", variant);
    case.record_files();
    case
}

/// The reconstruction, asked once for all tests that only read it.
pub fn staged() -> &'static (tempfile::TempDir, CaseFile, ReportDocument, CaseReport) {
    static STAGED: OnceLock<(tempfile::TempDir, CaseFile, ReportDocument, CaseReport)> =
        OnceLock::new();
    STAGED.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let case = reconstruction(folder.path());
        let (document, answers) = report(&case, &english());
        (folder, case, document, answers)
    })
}

/// The report of a collision of which little more is known than a position, asked once for all tests.
pub fn position_alone() -> &'static ReportDocument {
    static DOCUMENT: OnceLock<ReportDocument> = OnceLock::new();
    DOCUMENT.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let case = reconstruction_of("docs/guide/examples/position_alone.toml", folder.path());
        report(&case, &english()).0
    })
}

pub fn impact_case(name: &str, notes: &str) -> CaseFile {
    let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
    let question = ImpactRequest::new(scenario);
    let variant =
        Variant { name: name.to_owned(), questions: vec![question.into()], ..Variant::default() };
    let mut case = CaseFile::new(name, variant);
    case.notes = notes.to_owned();
    case
}

/// All text of a document, a cell or paragraph a line.
pub fn texts(document: &ReportDocument) -> Vec<String> {
    let of_block = |block: &Block| match block {
        Block::Heading { text, .. } | Block::Paragraph { text } | Block::Notice { text } => {
            vec![text.clone()]
        }
        Block::List { items } => items.clone(),
        Block::Table(table) => [vec![table.caption.clone()], table.rows.concat()].concat(),
        Block::Picture(picture) => vec![picture.caption.clone(), picture.alt.clone()],
    };
    document.sections.iter().flat_map(|section| &section.blocks).flat_map(of_block).collect()
}

/// That a number which has no interval is told, in two digits.
fn assert_says_roughly(document: &ReportDocument, quantity: Quantity, si: f64) {
    assert_says(document, &NumberFormat::english(UnitSystem::Si).rough(quantity, si));
}

pub fn assert_says(document: &ReportDocument, text: &str) {
    assert!(texts(document).iter().any(|of| of.contains(text)), "{text:?} is not in the report");
}

/// What a report says of a caveat, in its units and in parts; without those that name an option of the
/// command line or a key of a file.
fn told(phrase: Option<&Phrase>, text: &str) -> Vec<String> {
    let english = NumberFormat::english(UnitSystem::Si);
    let own = str::to_owned;
    let text = phrase.map_or_else(|| text.to_owned(), |phrase| phrase.say_shown(&english, &own));
    let is_told = |part: &&str| ![": --", " (--", ": ["].iter().any(|of| part.contains(of));
    let told = text.split("; ").filter(is_told);
    told.map(|part| part.replace("docs/guide/limits.md", "section 7")).collect()
}

fn assert_tells(document: &ReportDocument, caveat: &Caveat) {
    let reason = caveat.reason.as_deref().unwrap_or_default();
    let texts = told(caveat.text_phrase.as_ref(), &caveat.text);
    let reasons = told(caveat.reason_phrase.as_ref(), reason);
    texts.iter().chain(&reasons).for_each(|part| assert_says(document, part));
}

#[test]
fn the_example_has_every_section_and_the_numbers_of_its_answers() {
    let (document, answers) = pit();
    for &kind in SectionKind::ALL {
        let section = document.section(kind).expect("every section");
        assert!(!section.blocks.is_empty(), "{kind:?} says nothing");
    }
    assert!(answers.is_clean());
    let interval = |quantity: Quantity, estimate: &Estimate| {
        let text = NumberFormat::english(UnitSystem::Si).estimate(quantity, estimate);
        assert_says(document, &text.median);
        assert_says(document, &text.at(0.9).expect("90 %").range);
    };
    let mut kinds = [0; 4];
    for answer in answers.variants.iter().flat_map(|variant| variant.reports()) {
        match answer {
            Report::Impact(report) => {
                kinds[0] += 1;
                assert!(report.rival.is_some(), "its intervals stand beside the impact");
                let roughly = |quantity, si| assert_says_roughly(document, quantity, si);
                for body in [&report.struck, &report.striking] {
                    roughly(Quantity::Speed, body.delta_v_magnitude_m_s);
                    roughly(Quantity::AngularVelocity, body.yaw_rate_rad_s);
                    roughly(Quantity::Angle, body.pdof_deg.expect("a direction").to_radians());
                }
                roughly(Quantity::Impulse, report.impulse_magnitude_n_s);
                roughly(Quantity::Energy, report.dissipated_energy_j);
            }
            Report::Simulate(report) => {
                kinds[1] += 1;
                let end = report.end.expect("an end");
                assert_says_roughly(document, Quantity::Speed, end.speed_m_s);
                let distance_m = report.distance_m.expect("a path");
                assert_says_roughly(document, Quantity::Length, distance_m);
                assert_says_roughly(document, Quantity::Angle, end.yaw_rad);
            }
            Report::PredictForce(report) => {
                kinds[2] += 1;
                interval(Quantity::Force, &report.peak_n);
                interval(Quantity::Impulse, &report.impulse_n_s.magnitude);
            }
            Report::PredictMotion(report) => {
                kinds[3] += 1;
                let outcome = &report.outcome;
                assert!(report.is_end_known(), "{:?}", report.flags);
                for (quantity, estimate) in [
                    (Quantity::Length, &outcome.x_m),
                    (Quantity::Angle, &outcome.heading_change_rad),
                ] {
                    interval(quantity, estimate);
                }
                assert_says(document, "Courses of events");
                assert_says(document, "Phases of contact");
            }
            other => panic!("an answer of another kind: {other:?}"),
        }
        let fields = serde_json::to_value(answer).expect("JSON");
        let is_shown = |caveat: &Caveat| {
            let of_answers = &document.section(SectionKind::Answers).expect("answers").blocks;
            let parts = told(caveat.text_phrase.as_ref(), &caveat.text);
            of_answers.iter().any(|block| {
                let is_in =
                    |part: &String| matches!(block, Block::Notice { text } if text.contains(part));
                parts.iter().all(is_in)
            })
        };
        let caveats: Caveats = serde_json::from_value(fields.clone()).expect("caveats");
        let restricting = caveats.iter().filter(|caveat| caveat.kind != CaveatKind::Note);
        restricting.for_each(|caveat| assert_tells(document, caveat));
        for caveat in caveats.iter().filter(|caveat| caveat.is_warning()) {
            assert!(is_shown(caveat), "{caveat} does not stand at the answer");
        }
        for model in fields["model_digests"].as_array().into_iter().flatten() {
            assert_says(document, model["sha256"].as_str().expect("a digest"));
        }
    }
    assert_eq!(kinds, [3, 3, 3, 3]);
    assert!(document.pictures().count() >= 9, "{}", document.pictures().count());
}

/// What restricts such an answer was once read back from its JSON, and was left out where that failed.
#[test]
fn an_answer_without_a_text_of_its_own_keeps_every_caveat() {
    let dataset = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/trajectories-fea");
    let question = SimulateDatasetRequest {
        dataset,
        case: Some("FE_c001".to_owned()),
        vehicle: VehicleChoice::named("toyota-camry-2018"),
        equations: None,
        integrator: Integrator::default(),
    };
    let variant = Variant { questions: vec![question.into()], ..Variant::default() };
    let (document, answers) = report(&CaseFile::new("Data", variant), &english());
    let Some(Report::SimulateDataset(answer)) = answers.variants[0].reports().next() else {
        panic!("an answer");
    };
    assert!(answer.caveats.assumptions().count() > 0, "{:?}", answer.caveats);
    answer.caveats.iter().for_each(|caveat| assert_tells(&document, caveat));
}

#[test]
fn notes_of_variants_stand_in_their_table() {
    let mut case = impact_case("Noted", "");
    // The scenario has notes of its own, which stand among the inputs.
    let named =
        |document: &ReportDocument| texts(document).iter().filter(|text| *text == "notes").count();
    let before = named(&report(&case, &english()).0);
    case.variants[0].notes = "the road was wet".to_owned();
    let (document, _) = report(&case, &english());
    assert_eq!(named(&document), before + 1);
    assert_says(&document, "the road was wet");
}

/// An own network was said to have learned from the collisions of the shipped one, and to err as that does.
#[test]
fn what_the_shipped_networks_did_is_not_said_of_a_network_of_the_user() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/models/force.safetensors");
    let report_of = |model: ModelChoice| {
        let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
        let usual = PredictForceRequest::new(ForceQuestion::Scenario(scenario));
        let question = PredictForceRequest { model, ..usual };
        let variant = Variant {
            name: "own".to_owned(),
            questions: vec![question.into()],
            ..Variant::default()
        };
        report(&CaseFile::new("own", variant), &english()).0
    };
    let other =
        "Answered by other networks than the default ones: force network (force.safetensors).";
    let own = report_of(ModelChoice::file(&file));
    for kind in [SectionKind::Opinion, SectionKind::Validation] {
        let blocks = &own.section(kind).expect("a section").blocks;
        let is_told =
            |block: &Block| matches!(block, Block::Notice { text } if text.contains(other));
        assert!(blocks.iter().any(is_told), "{blocks:?}");
    }
    let shipped = report_of(ModelChoice::default());
    assert!(!texts(&shipped).iter().any(|text| text.contains("Answered by other networks")));
}

pub fn count_of(document: &ReportDocument, start: &str) -> usize {
    texts(document).iter().filter(|text| text.starts_with(start)).count()
}

#[test]
fn the_same_case_gives_the_same_bytes_also_from_its_package() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, case, first, _) = staged();
    let zip = folder.path().join("case.zip");
    pack(case, &zip, Existing::Refuse).expect("packed");
    let unpacked = unpack(&zip, &folder.path().join("elsewhere")).expect("unpacked");
    let (again, _) = report(&CaseFile::load(&unpacked).expect("a case"), &english());
    assert_eq!(first.to_json().expect("JSON"), again.to_json().expect("JSON"));
    assert_eq!(first.to_markdown(), again.to_markdown());
    let [first, again] = [first, &again].map(|of| pdf(of, Some(&gray)).expect("a PDF"));
    assert!(first == again, "the PDF of the package is another one");
}

/// “28.30 km/h” and “163.9 m²” stood beside places that are known to some metres.
#[test]
fn what_a_forecast_knows_roughly_has_two_digits() {
    const ROUGH: [&str; 6] = [
        "speed at the end, mean",
        "yaw rate at the end, mean",
        "area that holds the position",
        "sampling error of the 90 % area",
        "distance between the two",
        "the other errs by less",
    ];
    let (document, _) = pit();
    let n_digits = |cell: &str| {
        let number: String = cell.chars().take_while(|c| *c != ' ').collect();
        let number = number.trim_start_matches(['-', '0', '.']).replace('.', "");
        // Zeros at the end of a whole number only say how large it is.
        if cell.contains('.') { number.len() } else { number.trim_end_matches('0').len() }
    };
    let blocks = document.sections.iter().flat_map(|section| &section.blocks);
    let tables = blocks.filter_map(|block| match block {
        Block::Table(table) => Some(table),
        _ => None,
    });
    let mut n_checked = 0;
    for row in tables.flat_map(|table| &table.rows) {
        if ROUGH.iter().any(|name| row[0].starts_with(name)) {
            n_checked += 1;
            assert!(row[1..].iter().all(|cell| n_digits(cell) <= 2), "{row:?}");
        }
    }
    assert!(n_checked >= ROUGH.len(), "{n_checked}");
}

/// Courses and figures of the opinion stood in the annex once more.
#[test]
fn no_table_of_the_opinion_is_told_again() {
    let (document, _) = pit();
    let rows = |kind: SectionKind| -> Vec<&Vec<String>> {
        let blocks = &document.section(kind).expect("a section").blocks;
        let tables = blocks.iter().filter_map(|block| match block {
            Block::Table(table) => Some(&table.rows),
            _ => None,
        });
        tables.flatten().collect()
    };
    let told = rows(SectionKind::Opinion);
    let again: Vec<_> =
        rows(SectionKind::Answers).into_iter().filter(|row| told.contains(row)).collect();
    assert!(told.len() > 5 && again.is_empty(), "{again:?}");
}

#[test]
fn german_has_its_decimal_sign_date_and_words_and_us_units_their_symbols() {
    let case = impact_case("pit", "");
    let (german, answers) = report(&case, &settings(Language::De, UnitSystem::Us, Paper::A4));
    let Some(Report::Impact(answer)) = answers.variants[0].reports().next() else {
        panic!("an impact");
    };
    let format = NumberFormat { units: UnitSystem::Us, language: Language::De };
    let delta_v = format.rough(Quantity::Speed, answer.struck.delta_v_magnitude_m_s);
    assert!(delta_v.ends_with("mph"));
    assert_says(&german, &delta_v);
    assert_eq!(german.date, "24.11.2026");
    for word in ["Stoßziffer", "Gierrate", "Reibbeiwert", "Geschwindigkeitsänderung"] {
        assert_says(&german, word);
    }
    // What there is in English only stands in quotation marks.
    assert_says(&german, "stehen in Anführungszeichen");
    let bytes = pdf(&german, None).expect("a PDF");
    let read = lopdf::Document::load_mem(&bytes).expect("readable");
    let language = read.catalog().and_then(|catalog| catalog.get(b"Lang")).expect("a language");
    assert_eq!(language.as_str().expect("a text"), b"de");
}

#[test]
fn a_file_that_is_missing_is_said_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = reconstruction(folder.path());
    fs::remove_file(folder.path().join("evidence.toml")).expect("removed");
    let (document, answers) = report(&case, &english());
    assert!(!answers.is_clean());
    let first = &document.sections[0].blocks[..2];
    assert!(
        matches!(&first[0], Block::Notice { text } if text.contains("evidence.toml is missing")),
        "{first:?}"
    );
    assert!(matches!(&first[1], Block::Notice { text } if text.starts_with("Questions without")));
    assert_says(&document, "No answer: ");
    let folder = folder.path().display().to_string();
    assert!(!document.to_markdown().contains(&folder), "a path of this machine is in the report");
}

#[test]
fn hostile_names_break_neither_tables_nor_pages() {
    let long = "Wolfeschlegelsteinhausenbergerdorff".repeat(40);
    for name in [
        "a|b|c\n| --- |\r\n# heading",
        "<script>alert(1)</script> &amp; [x](y) `z`",
        "\u{202e}right to left\u{0}\u{7f}\u{1b}[31m",
        "漢字 🚗 \u{10ffff} e\u{301}",
        "",
        "   ",
        &long,
    ] {
        let mut case = impact_case(name, name);
        case.note(name);
        for language in [Language::En, Language::De] {
            let (document, _) = report(&case, &settings(language, UnitSystem::Si, Paper::Letter));
            check_tables(&document.to_markdown());
            let bytes = pdf(&document, None).unwrap_or_else(|error| panic!("{name:?}: {error}"));
            let read = lopdf::Document::load_mem(&bytes).expect("readable");
            assert!(!read.get_pages().is_empty());
            let json: serde_json::Value =
                serde_json::from_str(&document.to_json().expect("JSON")).expect("JSON");
            assert_eq!(json["case"], name);
        }
    }
}

/// Every row of a table in Markdown has as many cells as the one above it.
fn check_tables(markdown: &str) {
    let mut width = None;
    for line in markdown.lines() {
        if !line.starts_with('|') {
            width = None;
            continue;
        }
        let n = line.replace("\\\\", "").replace("\\|", "").matches('|').count();
        assert_eq!(*width.get_or_insert(n), n, "{line}");
    }
}

#[test]
fn the_numbers_of_the_validation_are_those_of_the_document() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/VALIDATION.md");
    let text = fs::read_to_string(path).expect("the document");
    let tables = Measurements::shipped().iter().flat_map(|measurement| &measurement.tables);
    for table in tables {
        let (_, below) = text.split_once(&format!("{}\n", table.heading)).expect("a heading");
        for line in &table.lines {
            assert!(below.lines().any(|of| of == line), "{line} is not below {}", table.heading);
        }
    }
}

/// What the two methods say of one collision stood apart, and that they do not agree on page five.
#[test]
fn where_methods_disagree_the_first_page_says_so() {
    // Ten times the stiffness of an impact: the momentum solution takes it, the network does not know it.
    let mut scenario = Scenario::example();
    scenario.contact.restitution = Some(1.0);
    scenario.contact.friction_limit = Some(2.0);
    let source = MotionSource::Scenario {
        scenario: ScenarioChoice::Inline(Box::new(scenario)),
        pulse: PulseSetup::default(),
    };
    let force = ForceSource::Predicted(ModelChoice::default());
    let mut question =
        PredictMotionRequest { draws: 5, ..PredictMotionRequest::new(source, force) };
    question.motion.one_contact = true;
    let variant = Variant { questions: vec![question.into()], ..Variant::default() };
    let (document, answers) = report(&CaseFile::new("PIT", variant), &english());
    let Some(Report::PredictMotion(answer)) = answers.variants[0].reports().next() else {
        panic!("an answer");
    };
    let rival = answer.rival.as_ref().expect("the 4DOF model");
    assert!(!rival.is_within_known_error(), "{rival:?}");
    let blocks = &document.section(SectionKind::Opinion).expect("an opinion").blocks;
    let Some(Block::Notice { text }) = blocks.first() else { panic!("{:?}", blocks.first()) };
    assert!(text.contains("network and physics do not say the same"), "{text}");
    assert_says(&document, "Do the methods agree?");
}
