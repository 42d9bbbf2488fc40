//! What restricts an answer is in every picture and table of it, and what is not of what is asked any
//! more is not saved.

use egui::OutputCommand;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use impactlab::app::{App, Command, Output, Pane};
use impactlab_core::data::Severity;
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_document::figure::{
    Axis, Figure, FigureElement, ForceComponent, ForecastFigure, Role, forecast_figure,
};
use impactlab_draw::{Canvas, figure_image, picture_ui, theme};

use crate::harness::{apply, is_idle, open, state, step_until};

const SENTENCE: &str =
    "mass of the striking vehicle [kg] is 3900, the force network has learned from 800 to 3000";

fn figure(caveats: &Caveats) -> Figure {
    let axis = |label| Axis::shown(label, Quantity::Ratio, UnitSystem::Si);
    let line = FigureElement::line("line", Role::Model, vec![[0.0, 0.0], [1.0, 1.0]]);
    Figure::new("A forecast", [axis("x"), axis("y")], vec![line]).with_caveats(caveats)
}

fn outside() -> Caveats {
    Caveats::from(vec![Caveat::new(CaveatKind::OutsideDomain, SENTENCE)])
}

/// Number of pixels of a picture with a colour, within a tolerance, below a share of its height.
fn n_pixels(image: &image::RgbaImage, color: egui::Color32, below: f64) -> usize {
    let first = (f64::from(image.height()) * below) as u32;
    let wanted = color.to_array();
    let is_close = |pixel: &image::Rgba<u8>| {
        pixel.0.iter().zip(wanted).take(3).all(|(is, wanted)| is.abs_diff(wanted) < 12)
    };
    image.enumerate_pixels().filter(|(_, y, pixel)| *y >= first && is_close(pixel)).count()
}

#[test]
fn a_picture_says_what_restricts_it_in_words_and_in_both_themes() {
    let shown = figure(&outside());
    let harness =
        Harness::builder().with_size([600.0, 400.0]).build_ui(|ui| picture_ui(ui, &shown));
    harness.get_by_label_contains(&format!("Warning: outside the domain: {SENTENCE}"));
    for dark in [false, true] {
        let canvas = Canvas { dark, ..Canvas::default() };
        let color = theme::severity_color(Severity::Warning, dark);
        let n = |caveats: &Caveats| {
            let image = figure_image(&figure(caveats), canvas).expect("a picture");
            n_pixels(&image, color, 0.85)
        };
        assert!(n(&outside()) > 100, "dark {dark}: {}", n(&outside()));
        assert_eq!(n(&Caveats::default()), 0, "dark {dark}");
    }
}

/// A picture is no list of warnings: it has the first one and how many more there are.
#[test]
fn a_picture_has_one_line_of_what_restricts_it() {
    let caveat = |i: usize| Caveat::new(CaveatKind::OutsideDomain, format!("{SENTENCE}, {i}"));
    let shown = figure(&(0..40).map(caveat).collect());
    let harness =
        Harness::builder().with_size([600.0, 300.0]).build_ui(|ui| picture_ui(ui, &shown));
    let lines: Vec<_> = harness.query_all_by_label_contains(SENTENCE).collect();
    let [line] = lines[..] else { panic!("{} lines", lines.len()) };
    let node = line.accesskit_node();
    let label = node.label().or(node.value()).expect("a text");
    assert!(label.ends_with("and 39 more, listed with the answer"), "{label}");
    assert!(line.rect().max.y <= 300.0 && line.rect().height() < 20.0, "{:?}", line.rect());
}

/// The text that the last frame has put on the clipboard.
fn copied(harness: &Harness<'_, App>) -> Option<String> {
    harness.output().platform_output.commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
}

/// The window on a collision with a striking vehicle that is heavier than any that the force
/// network knows.
fn with_heavy_striking() -> Harness<'static, App> {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", is_idle);
    harness.state_mut().state_mut().project.scenario_mut().expect("a scenario").striking.mass_kg =
        3900.0;
    apply(&mut harness, Command::PredictScenario);
    apply(&mut harness, Command::Show(Pane::ForcePrediction));
    step_until(&mut harness, "the prediction", |state| {
        let forecast = &state.session.force.forecast;
        let name = forecast.ok().map(|answer| answer.report.scenario.as_str());
        name == Some(state.project.impact.scenario.name().as_str()) && !forecast.is_waiting()
    });
    harness
}

#[test]
fn what_the_window_exports_says_what_restricts_it() {
    let mut harness = with_heavy_striking();
    let answer = state(&harness).session.force.forecast.ok().expect("an answer").clone();
    let is_outside = |badge: &&Caveat| badge.kind == CaveatKind::OutsideDomain;
    let sentence =
        answer.report.caveats.iter().find(is_outside).expect("it is outside").text.clone();
    harness.get_all_by_label("Export").next().expect("a figure").click();
    harness.run_steps(3);
    harness.get_by_label("Copy numbers").click();
    let copied = (0..4).find_map(|_| {
        harness.step();
        copied(&harness)
    });
    let copied = copied.expect("a copy");
    assert!(copied.lines().next().unwrap_or_default().ends_with(",restrictions"), "{copied}");
    assert!(copied.contains(&format!("warning: outside the domain: {sentence}")), "{copied}");

    let folder = tempfile::tempdir().expect("a folder");
    let input = ForecastFigure {
        name: "heavy",
        forecast: &answer.forecast,
        levels: &[0.9],
        recorded: None,
        physics: None,
        pulses: &[],
        units: UnitSystem::Si,
        caveats: &answer.report.caveats,
    };
    let figure = forecast_figure(ForceComponent::Y, &input);
    for name in ["force.png", "force.csv"] {
        let path = folder.path().join(name);
        apply(&mut harness, Command::Write(Output::Picture(Box::new(figure.clone())), path));
        step_until(&mut harness, "the export", |state| !state.session.tasks.is_writing());
    }
    let csv = std::fs::read_to_string(folder.path().join("force.csv")).expect("a table");
    assert!(csv.contains(&sentence), "{csv}");
    let png = image::open(folder.path().join("force.png")).expect("a picture").to_rgba8();
    let color = theme::severity_color(Severity::Warning, state(&harness).view.dark);
    assert!(n_pixels(&png, color, 0.6) > 100);
}

#[test]
fn what_is_not_of_what_is_asked_any_more_is_not_saved() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", is_idle);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("old.csv");
    let old = figure(&Caveats::default().outdated_if(true));
    let before = state(&harness).session.messages.len();
    for command in [
        Command::Write(Output::Picture(Box::new(old.clone())), path.clone()),
        Command::CopyNumbers(Box::new(old)),
    ] {
        apply(&mut harness, command);
        assert_eq!(copied(&harness), None);
    }
    let messages = &state(&harness).session.messages[before..];
    let warnings =
        messages.iter().filter(|message| message.text.contains("not the answer to what"));
    assert_eq!(warnings.count(), 2, "{messages:?}");
    assert!(!path.exists() && !state(&harness).session.tasks.is_writing());

    // A question that is awaited makes the figures of the answer before outdated at once.
    harness.state_mut().state_mut().project.simulate.duration_s += 1.0;
    harness.step();
    let session = &state(&harness).session;
    let report = &session.analysis.ok().expect("the old answer").report;
    assert_eq!(session.simulation_caveats(report).is_outdated(), session.analysis.is_waiting());
}
