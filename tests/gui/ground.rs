//! The ground in the window: opened, measured, scaled, and part of the questions.

use std::path::{Path, PathBuf};

use egui::Pos2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, Command, GroundCommand, Measure, Output, Pane, PlaybackCommand, ReconstructionCommand,
    State,
};
use impactlab_core::units::UnitSystem;

use crate::harness::{apply, is_forecast, is_idle, open, open_with_few_draws, step_until};
use crate::pictures::save;
use crate::reconstruct::evidence_in;

const SITE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sites/country-road/site.toml");

const SCENARIO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");

/// The shipped scenario on its road.
fn on_road() -> Harness<'static, App> {
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Open(vec![SITE.into()]));
    step_until(&mut harness, "the ground", |state| {
        state.session.ground.shown().is_some() && is_idle(state) && state.analysis().is_some()
    });
    apply(&mut harness, Command::Show(Pane::Scene));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(1.0)));
    harness.run_steps(4);
    harness
}

fn click(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.drag_at(at);
    harness.step();
    harness.drop_at(at);
    harness.run_steps(2);
}

/// Chooses what is measured in the menu of the pane.
fn choose(harness: &mut Harness<'_, App>, measure: &str) {
    harness.get_by_label("Measure").click();
    harness.run_steps(2);
    harness.get_by_label(measure).click();
    harness.run_steps(2);
}

fn on_screen(harness: &Harness<'_, App>, at_m: [f64; 2]) -> Pos2 {
    harness.state().state().session.scene.view.on_screen(at_m).expect("before the camera")
}

#[test]
fn a_site_file_is_opened_drawn_and_asked_with() {
    let mut harness = on_road();
    let state = harness.state().state();
    let request = state.simulate_request().expect("a question");
    assert_eq!(request.site.as_deref(), Some(Path::new(SITE)));
    let report = &state.analysis().expect("an answer").analysis;
    assert_eq!(report.friction_zones.len(), 2, "the simulation knows the zones");
    let entry = state.contents(&state.chain()).into_iter().find(|entry| entry.label == "Site");
    assert_eq!(entry.expect("in the tree").detail, "Country road, synthetic");
    save(&mut harness, "ground-above.png");
    let with = harness.render().expect("a picture");
    harness.get_by_label("Perspective").click();
    harness.run_steps(4);
    save(&mut harness, "ground-perspective.png");
    harness.state_mut().state_mut().view.dark = true;
    harness.run_steps(4);
    save(&mut harness, "ground-dark.png");
    harness.state_mut().state_mut().view.dark = false;
    harness.get_by_label("From above").click();
    apply(&mut harness, Command::Undo);
    harness.run_steps(4);
    apply(&mut harness, Command::Ground(GroundCommand::Remove));
    step_until(&mut harness, "no ground", |state| {
        state.session.ground.shown().is_none() && is_idle(state)
    });
    assert!(harness.render().expect("a picture") != with);
    assert_eq!(harness.state().state().simulate_request().expect("a question").site, None);
}

/// “not counted: that takes a site with lanes” was said without a way to one.
#[test]
fn lanes_that_are_not_counted_lead_to_a_site_and_to_both_vehicles() {
    let says = |harness: &Harness<'_, App>, text: &str| {
        harness.query_all_by_label_contains(text).next().is_some()
    };
    let mut harness = open_with_few_draws(SCENARIO);
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    harness.run_steps(4);
    assert!(says(&harness, "not counted: that takes a site with lanes"));
    assert!(says(&harness, "For lanes: a site.") && says(&harness, "Open site…"));
    assert!(says(&harness, "Site: none, lanes are not counted"), "in the contents");
    save(&mut harness, "forecast-without-site.png");

    apply(&mut harness, Command::Open(vec![SITE.into()]));
    step_until(&mut harness, "the site", |state| {
        state.session.ground.shown().is_some() && is_forecast(state)
    });
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    harness.run_steps(4);
    assert!(!says(&harness, "For lanes: "));

    harness.state_mut().state_mut().project.simulate.one_contact = true;
    harness.run_steps(4);
    step_until(&mut harness, "the forecast of one contact", is_forecast);
    assert!(says(&harness, "For lanes: both vehicles."));
    harness.get_by_label("Follow both vehicles").click();
    harness.run_steps(4);
    assert!(!harness.state().state().project.simulate.one_contact);
}

#[test]
fn lengths_are_measured_by_clicks_and_stay_on_the_ground() {
    let mut harness = on_road();
    choose(&mut harness, "Length of a line");
    for at_m in [[4.0, -2.0], [10.0, -2.0], [10.0, 3.0]] {
        let at = on_screen(&harness, at_m);
        click(&mut harness, at);
    }
    harness.key_press(egui::Key::Escape);
    harness.run_steps(2);
    let measuring = &harness.state().state().session.scene.measuring;
    assert_eq!(measuring.done.len(), 1, "Esc ends the line");
    assert_eq!(measuring.measure, Some(Measure::Length));
    let value = measuring.done[0].value().expect("a length");
    assert!((value - 11.0).abs() < 0.2, "{value} m");
    let text = measuring.done[0].text(UnitSystem::Us).expect("a length");
    assert!(text.contains("ft (last part"), "{text}");
    choose(&mut harness, "Area within a border");
    for at_m in [[20.0, -1.0], [26.0, -1.0], [26.0, 4.0], [20.0, 4.0]] {
        let at = on_screen(&harness, at_m);
        click(&mut harness, at);
    }
    harness.key_press(egui::Key::Escape);
    choose(&mut harness, "Angle of two lines");
    for at_m in [[36.0, 0.0], [30.0, 0.0], [30.0, 5.0]] {
        let at = on_screen(&harness, at_m);
        click(&mut harness, at);
    }
    harness.run_steps(2);
    let before = harness.state().state().session.scene.measuring.done.clone();
    assert_eq!(before.len(), 3);
    let area = before[1].value().expect("an area");
    assert!((area - 30.0).abs() < 1.5, "{area} m²");
    let angle = before[2].value().expect("an angle").to_degrees();
    assert!((angle - 90.0).abs() < 3.0, "{angle} deg");
    save(&mut harness, "ground-measured.png");
    harness.get_by_label("Perspective").click();
    harness.run_steps(4);
    save(&mut harness, "ground-measured-perspective.png");
    assert_eq!(harness.state().state().session.scene.measuring.done, before);
    harness.key_press(egui::Key::Delete);
    harness.run_steps(2);
    assert_eq!(harness.state().state().session.scene.measuring.done.len(), 2);
}

/// A picture of 400 x 300 pixels of which nothing says how large they are.
fn bare_picture(folder: &Path) -> PathBuf {
    let path = folder.join("drone.png");
    let picture = image::RgbImage::from_fn(400, 300, |x, y| {
        image::Rgb([
            (x / 2) as u8,
            (y / 2) as u8,
            if (x / 20 + y / 20) % 2 == 0 { 90 } else { 160 },
        ])
    });
    picture.save(&path).expect("a picture");
    path
}

#[test]
fn an_orthophoto_alone_is_scaled_by_two_points_undone_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = bare_picture(folder.path());
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Open(vec![path.clone()]));
    step_until(&mut harness, "the ground", |state| {
        state.session.ground.shown().is_some() && is_idle(state) && state.analysis().is_some()
    });
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(0.2)));
    harness.run_steps(4);
    let width_m = |harness: &Harness<'_, App>| {
        let ground = harness.state().state().session.ground.shown().expect("a ground").clone();
        let photo = ground.site.orthophoto.clone().expect("an orthophoto");
        (400.0 * photo.map.pixel_size_m()[0], photo.is_placed)
    };
    assert_eq!(width_m(&harness), (20.0, false), "0.05 m a pixel, said not to be known");
    let is_reported = harness
        .state()
        .state()
        .session
        .messages
        .iter()
        .any(|message| message.text.contains("nothing says where its pixels lie"));
    assert!(is_reported, "the user is told");
    choose(&mut harness, "Scale of the orthophoto");
    for at_m in [[-6.0, 2.0], [4.0, 2.0]] {
        let at = on_screen(&harness, at_m);
        click(&mut harness, at);
    }
    harness.state_mut().state_mut().session.scene.measuring.distance_m = Some(25.0);
    harness.run_steps(2);
    save(&mut harness, "ground-scale.png");
    // 25 m became 25 ft when the units were changed before the scale was set.
    harness.state_mut().state_mut().view.units = UnitSystem::Us;
    harness.run_steps(2);
    harness.get_by_label("Set scale").click();
    harness.run_steps(4);
    harness.state_mut().state_mut().view.units = UnitSystem::Si;
    harness.run_steps(2);
    let (scaled_m, is_placed) = width_m(&harness);
    assert!((scaled_m - 50.0).abs() < 0.5 && is_placed, "{scaled_m} m");
    let map = harness.state().state().project.beside.orthophoto;
    let first = map.expect("kept in the project").pixel([-6.0, 2.0]);
    assert!((first[0] - 80.0).abs() < 2.0, "the first point stays: {first:?}");

    let site = folder.path().join("site.toml");
    apply(&mut harness, Command::Write(Output::Site, site.clone()));
    step_until(&mut harness, "the site", |state| {
        state.session.ground.shown().is_some() && is_idle(state) && state.analysis().is_some()
    });
    assert_eq!(width_m(&harness), (scaled_m, true), "read back from the file");
    let read = impactlab_core::site::Site::load(&site).expect("a site file");
    assert_eq!(read.orthophoto.expect("an orthophoto").file, path);
}

#[test]
fn a_ground_that_cannot_be_read_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("site.toml");
    std::fs::write(&path, "[orthophoto]\nfile = \"none.png\"\n").expect("written");
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Open(vec![path]));
    step_until(&mut harness, "the error", |state| state.session.ground.problem.is_some());
    let problem = harness.state().state().session.ground.problem.clone().expect("an error");
    assert!(problem.contains("none.png: does not exist"), "{problem}");
}

/// The wheels of a reconstruction stand on the zones of the ground that is shown, and on nothing that is
/// not.
#[test]
fn a_reconstruction_stands_on_the_zones_of_the_ground() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = evidence_in(folder.path());
    let mut harness = open(&[path.to_str().expect("a plain name")]);
    harness.run_steps(4);
    let site_of_question = |harness: &Harness<'_, App>| {
        harness.state().state().project.reconstruct.clone().expect("a question").site
    };
    assert_eq!(site_of_question(&harness), None);
    let n_priors = |harness: &Harness<'_, App>| {
        harness.state().state().session.reconstruction.preview.as_ref().map(|of| of.priors.len())
    };
    let without = n_priors(&harness).expect("a prior");
    harness.state_mut().state_mut().project.reconstruct.as_mut().expect("evidence").particles = 60;
    apply(&mut harness, Command::Reconstruct(ReconstructionCommand::Run));
    let is_answered = |state: &State| {
        let of = &state.session.reconstruction;
        !of.run.is_running() && of.answer().is_some()
    };
    step_until(&mut harness, "the speeds", is_answered);
    let is_outdated = |harness: &Harness<'_, App>| {
        let State { project, session, .. } = harness.state().state();
        session.reconstruction.is_outdated(project.reconstruct.as_ref())
    };
    assert!(!is_outdated(&harness));

    apply(&mut harness, Command::Open(vec![SITE.into()]));
    step_until(&mut harness, "the zones", |state| {
        state.project.reconstruct.as_ref().is_some_and(|of| of.site.is_some())
    });
    apply(&mut harness, Command::Show(Pane::Evidence));
    harness.run_steps(4);
    assert_eq!(site_of_question(&harness).as_deref(), Some(Path::new(SITE)));
    assert!(is_outdated(&harness), "the speeds are those without the zones");
    assert_eq!(n_priors(&harness), Some(without + 1));
    assert!(harness.query_by_label_contains("friction zones of site.toml").is_some());
    step_until(&mut harness, "the ground", |state| state.session.ground.shown().is_some());
    harness.get_by_label("Show the site").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("Picture of the scene").is_some());
    apply(&mut harness, Command::Show(Pane::Evidence));
    harness.run_steps(4);

    // Another ground, which cannot be read, leaves none of the zones of this one.
    let torn = folder.path().join("torn.png");
    std::fs::write(&torn, "no picture").expect("written");
    apply(&mut harness, Command::Open(vec![torn]));
    step_until(&mut harness, "the problem", |state| state.session.ground.problem.is_some());
    harness.run_steps(2);
    assert_eq!(site_of_question(&harness), None);

    apply(&mut harness, Command::Open(vec![SITE.into()]));
    step_until(&mut harness, "the zones", |state| {
        state.project.reconstruct.as_ref().is_some_and(|of| of.site.is_some())
    });
    apply(&mut harness, Command::Ground(GroundCommand::Remove));
    harness.run_steps(4);
    assert_eq!(site_of_question(&harness), None);
    assert!(!is_outdated(&harness));
}

/// A ground without zones, such as an orthophoto, changes no answer.
#[test]
fn an_orthophoto_leaves_the_reconstruction_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let evidence = evidence_in(folder.path());
    let picture = bare_picture(folder.path());
    let mut harness = open(&[evidence.to_str().expect("a plain name")]);
    harness.run_steps(4);
    apply(&mut harness, Command::Open(vec![picture]));
    step_until(&mut harness, "the ground", |state| state.session.ground.shown().is_some());
    harness.run_steps(2);
    assert_eq!(harness.state().state().project.reconstruct.as_ref().expect("evidence").site, None);
}
