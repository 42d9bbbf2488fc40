//! The workspace Report: a report of the case as it is, on screen and in a file.

use std::path::PathBuf;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, CaseCommand, Command, Leaving, MadeReport, Output, ReportCommand, TaskKey, Workspace,
};
use impactlab_core::units::UnitSystem;
use impactlab_document::report::{
    Language, ReportFormat, ReportSettings, SectionKind, report_case,
};
use impactlab_study::case_file::CaseFile;
use impactlab_study::{Library, MotionSource};
use tempfile::TempDir;

use crate::harness::{apply, open_at, state, step_until, type_into};
use crate::looks::collisions;
use crate::pictures::save;

const PIT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/examples/pit.impactlab");
const DATE: &str = "2026-11-24";

fn made<'a>(harness: &'a Harness<'_, App>) -> &'a MadeReport {
    state(harness).session.report.made.as_ref().expect("a report")
}

/// Opens the workspace on the shipped case, of which one variant is to be told.
fn opened(size: [f32; 2]) -> Harness<'static, App> {
    let mut harness = open_at((size, 1.0), &[PIT], None);
    step_until(&mut harness, "the networks", |state| {
        !state.session.is_waiting()
            && state.session.force.model.current.is_some()
            && state.session.response.model.current.is_some()
    });
    let view = &mut harness.state_mut().state_mut().view.report;
    view.shown_variant_only = true;
    view.date = DATE.to_owned();
    apply(&mut harness, Command::ShowWorkspace(Workspace::Report));
    harness.run_steps(2);
    harness
}

fn make(harness: &mut Harness<'static, App>) {
    harness.get_by_label("Make the report").click();
    harness.run_steps(2);
    step_until(harness, "the report", |state| {
        !state.session.report.is_running && state.session.report.made.is_some()
    });
}

#[test]
fn the_report_on_screen_is_the_one_of_the_case_file() {
    let folder = TempDir::new().expect("a folder");
    let mut harness = opened([1440.0, 900.0]);
    assert!(harness.query_by_label_contains("No report yet").is_some());
    save(&mut harness, "report-empty.png");
    make(&mut harness);
    save(&mut harness, "report.png");

    let case_file = folder.path().join("pit.impactlab");
    apply(&mut harness, Command::Write(Output::Case, case_file.clone()));
    step_until(&mut harness, "the case file", |state| {
        !state.session.tasks.is_running(&TaskKey::SaveCase)
    });
    let case = CaseFile::load(&case_file).expect("a case");
    let settings = ReportSettings {
        language: Language::En,
        units: UnitSystem::Si,
        paper: impactlab_document::report::Paper::A4,
        date: DATE.parse().expect("a day"),
    };
    let outcome = report_case(
        &case,
        None,
        std::slice::from_ref(&case.shown),
        &settings,
        &Library::default(),
        &mut |_| std::ops::ControlFlow::Continue(()),
    );
    let (of_file, _) = outcome.expect("answers").complete().expect("a report");
    let shown = &made(&harness).document;
    for kind in [SectionKind::Answers, SectionKind::Inputs, SectionKind::Sensitivity] {
        assert_eq!(shown.section(kind), of_file.section(kind), "{kind:?}");
    }
    assert_eq!(made(&harness).pictures.len(), shown.pictures().count());
    assert!(made(&harness).pictures.iter().all(Result::is_ok));
    for section in [SectionKind::Pictures, SectionKind::Validation, SectionKind::Provenance] {
        apply(&mut harness, Command::Report(ReportCommand::ShowSection(section)));
        harness.run_steps(20);
        save(&mut harness, &format!("report-{section:?}.png").to_lowercase());
        assert_eq!(collisions(&harness), [""; 0], "{section:?}");
    }
    harness.state_mut().state_mut().view.dark = true;
    harness.run_steps(2);
    save(&mut harness, "report-dark.png");
}

#[test]
fn a_report_is_saved_as_its_ending_says_unless_the_case_has_changed() {
    let folder = TempDir::new().expect("a folder");
    let mut harness = opened([1100.0, 700.0]);
    make(&mut harness);
    let document = made(&harness).document.clone();
    for name in ["report.pdf", "report.md", "report.json"] {
        let path = folder.path().join(name);
        apply(&mut harness, Command::Write(Output::Report(document.clone()), path.clone()));
        step_until(&mut harness, name, |state| !state.session.tasks.is_writing());
        let format = ReportFormat::from_path(&path).expect("a format");
        let drawing = &impactlab_draw::report_drawing;
        let expected = document.bytes(format, Some(drawing)).expect("a report");
        assert!(std::fs::read(&path).expect("a file") == expected, "{name}");
    }
    let other: PathBuf = folder.path().join("report.docx");
    apply(&mut harness, Command::Write(Output::Report(document), other.clone()));
    step_until(&mut harness, "the refusal", |state| !state.session.tasks.is_writing());
    assert!(!other.exists());
    let message = &state(&harness).session.messages.last().expect("a message").text;
    assert!(message.contains(".json"), "{message}");

    assert!(harness.query_by_label("Save…").is_some());
    let is_outdated = |harness: &Harness<'_, App>| state(harness).session.report.is_outdated;
    assert!(!is_outdated(&harness));
    harness.state_mut().state_mut().project.simulate.duration_s += 1.0;
    harness.run_steps(3);
    assert!(is_outdated(&harness));
    assert!(harness.query_by_label_contains("make it again to save it").is_some());
    save(&mut harness, "report-outdated.png");
    harness.state_mut().state_mut().project.simulate.duration_s -= 1.0;
    harness.run_steps(3);
    assert!(!is_outdated(&harness));
    harness.state_mut().state_mut().view.report.date = "tomorrow".to_owned();
    harness.run_steps(3);
    assert!(is_outdated(&harness));
    assert!(harness.query_by_label_contains("YYYY-MM-DD").is_some());
}

#[test]
fn a_report_is_cancelled_and_none_is_made_of_nothing() {
    let mut harness = opened([1440.0, 900.0]);
    harness.get_by_label("Make the report").click();
    harness.run_steps(2);
    apply(&mut harness, Command::Report(ReportCommand::Cancel));
    step_until(&mut harness, "the end", |state| !state.session.report.is_running);
    assert!(state(&harness).session.report.made.is_none());

    apply(&mut harness, Command::Case(CaseCommand::Leave(Leaving::New)));
    apply(&mut harness, Command::ShowWorkspace(Workspace::Report));
    harness.state_mut().state_mut().project.simulate.source = MotionSource::default();
    harness.run_steps(3);
    assert!(state(&harness).session.report.asks_nothing);
    assert!(harness.query_by_label_contains("asks nothing yet").is_some());
}

/// Who signs was asked under *Name…* in the bar of the case, where nobody looked for it.
#[test]
fn who_gives_the_opinion_is_entered_where_the_report_is_made() {
    let mut harness = opened([1440.0, 900.0]);
    type_into(&mut harness, "Expert", "J. Doe, P.E.");
    let expert = &state(&harness).case.file.expert;
    assert_eq!(expert.name.as_deref(), Some("J. Doe, P.E."));
    assert!(state(&harness).is_case_changed());
}
