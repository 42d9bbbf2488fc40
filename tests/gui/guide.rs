//! The pictures of the window in the tutorials, and of the shipped atlas. `UPDATE_GUIDE=1` draws them anew;
//! look at the difference.

use std::path::Path;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use image::{Rgba, RgbaImage, imageops};
use impactlab::app::{
    App, Command, Network, Pane, ReconstructionCommand, TrainingCommand, VariantCommand,
};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{AtlasFigure, Figure, atlas_figure, sensitivity_figure};
use impactlab_draw::{Canvas, figure_image};
use impactlab_study::ConfigChoice;
use impactlab_sweep::Outcome;
use impactlab_sweep::atlas::Atlas;

use crate::harness::{apply, ask_few_draws, is_forecast, is_idle, open_at, state, step_until};
use crate::pictures::save;
use crate::settings::SMALL_FORCE;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/pictures");
const PIT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/examples/pit.toml");
const SITE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sites/country-road/site.toml");
const EVIDENCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/staged/evidence/s24.toml");
const FORCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");

/// A trial with the simplest centre, as the tutorial begins.
const TRIAL: &str = "\
centre = \"momentum\"
[crush]
folds = 2
";

fn opened(path: &str) -> Harness<'static, App> {
    open_at(([1280.0, 800.0], 1.0), &[path], None)
}

/// Draws a step of a tutorial, whose picture must be in the guide and of this size.
fn step(harness: &mut Harness<'_, App>, name: &str) {
    harness.run_steps(4);
    save(harness, name);
    let image = harness.render().expect("the software renderer always draws");
    kept(name, &image);
}

/// Whether the pictures of the guide are drawn anew.
fn is_updating() -> bool {
    std::env::var_os("UPDATE_GUIDE").is_some()
}

/// The picture of the guide that is drawn now as `image`; `UPDATE_GUIDE=1` replaces it.
fn kept(name: &str, image: &RgbaImage) -> RgbaImage {
    let path = Path::new(FOLDER).join(name);
    if is_updating() {
        image.save(&path).expect("a picture is written");
    }
    let kept = image::open(&path).expect("UPDATE_GUIDE=1 draws it").to_rgba8();
    assert_eq!(kept.dimensions(), image.dimensions(), "{name}: UPDATE_GUIDE=1 draws it anew");
    kept
}

#[test]
fn a_pit_from_the_scenario_to_two_variants() {
    let mut harness = opened(PIT);
    step_until(&mut harness, "the simulation", is_idle);
    // The guide shows the usual forecast. A window of this size is drawn with few motions as well.
    if !is_updating() {
        ask_few_draws(&mut harness);
    }
    step_until(&mut harness, "the forecast", is_forecast);
    step(&mut harness, "tutorial-pit-window-scenario.png");

    apply(&mut harness, Command::Open(vec![SITE.into()]));
    step_until(&mut harness, "the ground", |state| state.session.ground.shown().is_some());
    let asked = &mut harness.state_mut().state_mut().project.simulate;
    (asked.until_rest, asked.duration_s) = (true, 120.0);
    harness.run_steps(4);
    step_until(&mut harness, "the forecast to rest", is_forecast);
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    step(&mut harness, "tutorial-pit-window-forecast.png");

    apply(&mut harness, Command::Variant(VariantCommand::Duplicate));
    let scenario = harness.state_mut().state_mut().project.scenario_mut().expect("a scenario");
    scenario.striking.vx_world_m_s *= 1.1;
    scenario.striking.vy_world_m_s *= 1.1;
    harness.run_steps(4);
    apply(&mut harness, Command::Show(Pane::Variants));
    step_until(&mut harness, "both variants", |state| {
        let variants = state.answered_variants();
        variants.len() == 2 && variants.iter().all(|of| of.forecast.is_some() && !of.is_waiting)
    });
    step(&mut harness, "tutorial-pit-window-variants.png");
}

#[test]
fn a_staged_collision_from_its_evidence_to_the_speeds() {
    let mut harness = opened(EVIDENCE);
    harness.run_steps(4);
    step(&mut harness, "tutorial-reconstruction-window-evidence.png");

    // The guide shows bands of many particles. A window of this size is drawn with few as well.
    let request = harness.state_mut().state_mut().project.reconstruct.as_mut();
    request.expect("evidence").particles = if is_updating() { 500 } else { 50 };
    apply(&mut harness, Command::Reconstruct(ReconstructionCommand::Run));
    step_until(&mut harness, "the speeds", |state| {
        let of = &state.session.reconstruction;
        !of.run.is_running() && of.answer().is_some()
    });
    step(&mut harness, "tutorial-reconstruction-window-speeds.png");
}

#[test]
fn own_data_from_the_cases_to_a_training() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = folder.path().join("trial.toml");
    std::fs::write(&config, [SMALL_FORCE, TRIAL].concat()).expect("a file");
    let mut harness = opened(FORCES);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Show(Pane::Cases));
    step(&mut harness, "tutorial-own-data-window-cases.png");

    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.epochs = Some(20);
    form.training.config = ConfigChoice::File(config);
    apply(&mut harness, Command::Show(Pane::Training));
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "the end", |state| {
        let training = &state.session.force.training;
        training.is_over && !training.run.is_running()
    });
    assert!(state(&harness).session.force.training.problem.is_none());
    // What stands in the field for the file of settings is a path of this machine.
    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.training.config = ConfigChoice::default();
    assert!(harness.query_all_by_label_contains("Losses while training on").count() > 0);
    step(&mut harness, "tutorial-own-data-window-training.png");
}

/// A figure as a picture of half the width of a page.
fn picture(figure: &Figure) -> RgbaImage {
    let canvas = Canvas { size_px: [960, 720], scale: 1.5, dark: false };
    figure_image(figure, canvas).expect("a picture")
}

/// A map of the shipped atlas over two axes.
///
/// - `held`: axes with their bins; the others are averaged over.
fn map(
    axes: [&str; 2],
    held: &[(&str, usize)],
    outcome: Outcome,
    case: Option<[f64; 2]>,
) -> RgbaImage {
    let atlas = Atlas::shipped().expect("it comes with the program");
    let axis = |word: &str| atlas.axis(word).expect("an axis");
    let mut bins = vec![None; atlas.axes.len()];
    for (word, bin) in held {
        bins[axis(word)] = Some(*bin);
    }
    let (held, measure, units) = (&bins[..], outcome.into(), UnitSystem::Si);
    let (axes, other_networks) = (axes.map(axis), &[]);
    let of = AtlasFigure { atlas, axes, held, measure, case, units, other_networks };
    picture(&atlas_figure(&of))
}

fn beside(left: &RgbaImage, right: &RgbaImage) -> RgbaImage {
    let mut both = RgbaImage::new(left.width() + right.width(), left.height());
    imageops::replace(&mut both, left, 0, 0);
    imageops::replace(&mut both, right, i64::from(left.width()), 0);
    both
}

/// A picture of the shipped atlas, which a page of the guide must show as it is drawn now, with words for
/// whoever does not see it and with what it is.
fn shown(page: &str, name: &str, image: &RgbaImage) {
    let kept = kept(name, image);
    let differs = |(kept, drawn): &(&Rgba<u8>, &Rgba<u8>)| {
        kept.0.iter().zip(drawn.0).any(|(kept, drawn)| kept.abs_diff(drawn) > 2)
    };
    let n_pixels = image.pixels().len();
    let n_differ = kept.pixels().zip(image.pixels()).filter(differs).count();
    assert!(n_differ * 1000 <= n_pixels, "{name}: {n_differ} pixels; UPDATE_GUIDE=1 draws it anew");

    let page = Path::new(FOLDER).with_file_name(page);
    let text = std::fs::read_to_string(&page).expect("a page");
    let (before, after) =
        text.split_once(&format!("](pictures/{name})")).expect("the page shows the picture");
    let alt = before.rsplit_once("![").expect("words for the picture").1;
    assert!(alt.len() > 60 && !alt.contains('\n'), "{name}: {alt:?}");
    let caption = after.split("\n\n").nth(1).unwrap_or_default();
    assert!(caption.starts_with('*') && caption.contains("model study"), "{name}: {caption:?}");
}

#[test]
fn the_pictures_of_the_atlas_are_those_of_the_atlas_that_is_shipped() {
    let speeds = ["speed", "closing"];
    let of_esc = |esc| map(speeds, &[("esc", esc)], Outcome::Turns90, None);
    shown("atlas-trainers.md", "atlas-spin.png", &beside(&of_esc(0), &of_esc(1)));

    let half_turn = map(speeds, &[], Outcome::Turns180, None);
    let atlas = Atlas::shipped().expect("the shipped atlas");
    let indices = atlas.sensitivity(Outcome::Turns90).expect("the shipped atlas has Sobol indices");
    let bars = picture(&sensitivity_figure(Outcome::Turns90.label(), atlas, &indices, &[]));
    shown("atlas-policy.md", "atlas-influence.png", &beside(&half_turn, &bars));

    // Contact 0.1 m ahead of the rear axle, closing at 4 m/s.
    let door = map(["overlap", "closing"], &[], Outcome::DoorContact, Some([0.1, 4.0]));
    shown("atlas-litigators.md", "atlas-case.png", &door);
}
