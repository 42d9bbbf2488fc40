//! Tables of reports: who gave each distribution of the prior, and marks of tires.

use std::path::PathBuf;

use impactlab_core::collision::Scenario;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_core::vehicle::{Braking, Ending};
use impactlab_document::report::Block;
use impactlab_document::report::{Language, Paper, ReportDocument, SectionKind, Table};
use impactlab_study::analysis::PulseSetup;
use impactlab_study::case_file::{CaseFile, CaseReport, Variant};
use impactlab_study::{MotionSource, Report, ScenarioChoice, SimulateReport, SimulateRequest};

use crate::report::{english, impact_case, pit, report, settings, staged};

/// The tables of a document whose caption begins so.
fn tables<'a>(document: &'a ReportDocument, caption: &str) -> Vec<&'a Table> {
    let blocks = document.sections.iter().flat_map(|section| &section.blocks);
    let tables = blocks.filter_map(|block| match block {
        Block::Table(table) => Some(table),
        _ => None,
    });
    tables.filter(|table| table.caption.starts_with(caption)).collect()
}

#[test]
fn each_distribution_of_the_prior_says_who_gave_it() {
    let (_, _, document, _) = staged();
    let priors = tables(document, "found: prior distributions");
    let [priors] = priors[..] else { panic!("one table: {}", priors.len()) };
    let says = |label: &str| {
        let of_label = |row: &&Vec<String>| row[0] == label;
        priors.rows.iter().find(of_label).map(|row| [&*row[2], &*row[3]]).expect(label)
    };
    for (label, class, source) in [
        ("friction of the road", "measured", "prior; measured, by the evidence"),
        ("mass of the struck car", "measured", "prior; measured, by the evidence"),
        ("mass of the striking car", "measured", "prior; measured, by the evidence"),
        ("contact along the side", "measured", "prior; measured, by the evidence"),
        (
            "yaw inertia over the estimate",
            "estimated by rule",
            "prior; rule of the data sheet with its scatter",
        ),
        (
            "rolling resistance",
            "estimated by rule",
            "prior; rule of the data sheet with its scatter",
        ),
        ("speed of the struck car", "assumed", "prior; default of the program"),
        ("driver brakes from", "assumed", "prior; default of the program"),
    ] {
        assert_eq!(says(label), [class, source], "{label}");
    }
}

/// A case that simulates the shipped scenario with brakes that lock its wheels.
fn braked_simulation() -> CaseFile {
    let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
    let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
    let question = SimulateRequest {
        vehicle_draws: Some(0),
        ending: Some(Ending { brake: Some(Braking::new(0.3, 1.5, 0.1)), ..Ending::default() }),
        ..SimulateRequest::new(source)
    };
    let questions = vec![question.into()];
    CaseFile::new("braked", Variant { name: "braked".to_owned(), questions, ..Variant::default() })
}

fn simulated(answers: &CaseReport) -> &SimulateReport {
    let Some(Report::Simulate(report)) = answers.variants[0].reports().next() else {
        panic!("a simulation");
    };
    report
}

#[test]
fn computed_tire_marks_have_the_figures_of_the_answer_in_both_languages_and_units() {
    let case = braked_simulation();
    for (language, units, caption, [locked, struck]) in [
        (
            Language::En,
            UnitSystem::Si,
            "Tire marks that the simulation leaves",
            ["locked", "struck, "],
        ),
        (
            Language::De,
            UnitSystem::Us,
            "Reifenspuren, die die Simulation hinterlässt",
            ["blockiert", "gestoßenes Fahrzeug, "],
        ),
    ] {
        let (document, answers) = report(&case, &settings(language, units, Paper::A4));
        let marks = &simulated(&answers).tire_marks;
        assert!(marks.len() > 3, "{marks:?}");
        let [table] = tables(&document, caption)[..] else { panic!("{caption}: one table") };
        assert_eq!(table.rows.len(), marks.len());
        let shown = |quantity: Quantity, si: f64, decimals: usize| {
            let unit = quantity.display_unit(units);
            let text = format!("{:.decimals$} {}", unit.from_si(si), unit.symbol);
            if language == Language::De { text.replace('.', ",") } else { text }
        };
        for (row, mark) in table.rows.iter().zip(marks) {
            let [from, end] = [mark.from_s, mark.to_s].map(|of| shown(Quantity::Time, of, 2));
            assert_eq!(row[2], shown(Quantity::Length, mark.length_m, 1));
            assert_eq!([&row[3], &row[5]], [&from, &end]);
            let unit = Quantity::Length.display_unit(units);
            for (cell, [x, y]) in [(&row[4], mark.start_m), (&row[6], mark.end_m)] {
                let [x, y] = [x, y].map(|si| {
                    let text = format!("{:.1}", unit.from_si(si));
                    if text == "-0.0" { "0.0".to_owned() } else { text }
                });
                let place = format!("({x}; {y}) {}", unit.symbol);
                let decimal = if language == Language::De { "," } else { "." };
                assert_eq!(*cell, place.replace('.', decimal), "{mark:?}");
            }
        }
        let says =
            |column: usize, text: &str| table.rows.iter().any(|row| row[column].contains(text));
        assert!(says(1, locked) && says(0, struck), "{:?}", table.rows);
    }
    // Without a simulation there are no marks and no table of them.
    let (document, _) = report(&impact_case("pit", ""), &english());
    assert!(tables(&document, "Tire marks").is_empty());
}

#[test]
fn found_tire_marks_stand_beside_the_computed_ones() {
    let (_, _, document, answers) = staged();
    let Some(Report::Reconstruct(report)) = answers.variants[0].reports().next() else {
        panic!("a reconstruction");
    };
    let [table] = tables(document, "Tire marks that were found beside")[..] else {
        panic!("one table")
    };
    assert_eq!((report.marks.len(), table.rows.len()), (4, 4));
    let shown =
        |si: Option<f64>| si.map_or_else(|| "no mark".to_owned(), |si| format!("{si:.2} m"));
    for (row, mark) in table.rows.iter().zip(&report.marks) {
        let computed = mark.mean_distance_m.map(|_| mark.computed_length_m);
        let lengths = [Some(mark.found_length_m), computed];
        let distances = [mark.mean_distance_m, mark.largest_distance_m];
        let expected: Vec<String> = lengths.into_iter().chain(distances).map(shown).collect();
        assert_eq!(row[1..], expected, "{mark:?}");
    }
}

/// A case that simulates a scenario whose numbers stand in the question.
fn inline_simulation() -> CaseFile {
    let scenario = ScenarioChoice::Inline(Box::new(Scenario::example()));
    let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
    let question = SimulateRequest { vehicle_draws: Some(0), ..SimulateRequest::new(source) };
    let questions = vec![question.into()];
    CaseFile::new("inline", Variant { name: "inline".to_owned(), questions, ..Variant::default() })
}

/// Names and words of files stood in the inputs as they are written there.
#[test]
fn inputs_are_told_in_words_of_the_field() {
    let english = ["CG behind front", "restitution acts", "method of integration"];
    let german =
        ["Schwerpunkt hinter der Front", "Stoßziffer bezogen auf", "Integrationsverfahren"];
    for (language, names) in [(Language::En, english), (Language::De, german)] {
        let case = inline_simulation();
        let (document, _) = report(&case, &settings(language, UnitSystem::Si, Paper::A4));
        let markdown = document.to_markdown();
        for name in names {
            assert!(markdown.contains(name), "{name:?} is not in the report");
        }
        for raw in ["| vx |", "velocity along X", "längs X", "cg from front", "Automatic", "Rk4"] {
            assert!(!markdown.contains(raw), "{raw:?} is in the report");
        }
    }
}

/// What nobody changed is one sentence, and no row of a table.
#[test]
fn settings_that_nobody_changed_are_gathered() {
    let (document, _) = report(&inline_simulation(), &english());
    let inputs = document.section(SectionKind::Inputs).expect("inputs");
    let sentence = inputs.blocks.iter().find_map(|block| match block {
        Block::Paragraph { text } if text.starts_with("Left at the defaults of the program") => {
            Some(text)
        }
        _ => None,
    });
    let sentence = sentence.expect("a sentence");
    assert!(sentence.contains("method of integration Runge–Kutta, 4th order"), "{sentence}");
    assert!(!sentence.contains("restitution"), "{sentence}");
    let rows = inputs.blocks.iter().filter_map(|block| match block {
        Block::Table(table) => Some(&table.rows),
        _ => None,
    });
    let mut cells = rows.flatten().flatten();
    assert!(cells.all(|cell| cell != "method of integration"));
}

/// A restitution that the question gives was “assumed by the program”, as the force network does not use it.
#[test]
fn what_is_given_and_not_used_is_not_assumed() {
    let (document, _) = pit();
    let inputs = document.section(SectionKind::Inputs).expect("inputs");
    let rows = inputs.blocks.iter().flat_map(|block| match block {
        Block::Table(table) => table.rows.as_slice(),
        _ => &[],
    });
    let unused: Vec<&Vec<String>> =
        rows.filter(|row| row.iter().any(|cell| cell == "not used")).collect();
    assert!(!unused.is_empty(), "the force network does not use the restitution");
    for row in unused {
        assert!(row.iter().any(|cell| cell == "given"), "{row:?}");
    }
}
