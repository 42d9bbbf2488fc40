//! What drivers and stability control did to the wheels, as curves.

use egui::Color32;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use image::RgbaImage;
use impactlab::app::{App, Command, Pane, PlaybackCommand};
use impactlab_core::collision::Scenario;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{
    Braking, Countersteer, Ending, Integrator, PitDriver, Preset, StabilityControl,
};
use impactlab_document::figure::{Figure, Role, control_figures};
use impactlab_draw::{Canvas, figure_image, theme};
use impactlab_study::analysis::{PulseSetup, Settings, analyse_scenario};

use crate::harness::{apply, is_idle, open, state, step_until};
use crate::pictures::{picture_folder, save};

const SCENARIO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");

/// A car that is turned by a PIT, with stability control, whose driver countersteers and brakes; and the
/// driver who turns it.
fn endings() -> [Ending; 2] {
    let struck = Ending {
        esc: Some(StabilityControl::default()),
        countersteer: Some(Countersteer::default()),
        brake: Some(Braking::new(1.2, 0.6, 0.3)),
        ..Ending::default()
    };
    [struck, Ending { pit: Some(PitDriver::default()), ..Ending::default() }]
}

fn figures() -> Vec<Figure> {
    let [ending, striking_ending] = endings();
    let mut scenario = Scenario::example();
    scenario.striking_ending = Some(striking_ending);
    let settings = Settings {
        struck: Preset::Reference.parameters(),
        striking: Preset::Bullet2000.parameters(),
        integrator: Integrator::Rk4,
        duration_s: 4.0,
        ending,
        ends_at_rest: false,
        one_contact: false,
        friction_zones: Vec::new(),
    };
    let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).expect("it runs");
    control_figures(&analysis, &Caveats::default(), UnitSystem::Si)
}

/// Number of pixels that have nearly a colour.
fn n_pixels(image: &RgbaImage, color: Color32) -> usize {
    let [r, g, b, _] = color.to_array();
    let is_near = |pixel: &&image::Rgba<u8>| {
        let difference = |i: usize, of: u8| u32::from(pixel.0[i].abs_diff(of));
        difference(0, r) + difference(1, g) + difference(2, b) < 24
    };
    image.pixels().filter(is_near).count()
}

#[test]
fn the_curves_of_both_vehicles_are_drawn_on_light_and_on_dark_ground() {
    let figures = figures();
    assert_eq!(figures.len(), 4, "steering, brakes, drive, and the brakes of the car with ESC");
    for (idx, figure) in figures.iter().enumerate() {
        for dark in [false, true] {
            let canvas = Canvas { size_px: [640, 300], scale: 1.0, dark };
            let image = figure_image(figure, canvas).expect("a picture");
            let name = format!("controls-{idx}-{}.png", if dark { "dark" } else { "light" });
            image.save(picture_folder().join(name)).expect("a picture is written");
            for element in figure.elements.iter().filter(|element| element.role() != Role::Muted) {
                let n = n_pixels(&image, theme::color(element.role(), dark));
                assert!(n > 60, "{}: {} has {n} pixels", figure.y.label, element.name());
            }
        }
    }
}

#[test]
fn the_motion_panel_shows_what_both_drivers_do_or_that_nobody_does_anything() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the simulation", is_idle);
    apply(&mut harness, Command::Show(Pane::Motion));
    harness.run_steps(4);
    let says = |harness: &Harness<'_, App>, text: &str| {
        harness.query_all_by_label_contains(text).next().is_some()
    };
    let [struck, striking] = endings();
    let scenario = harness.state_mut().state_mut().project.scenario_mut().expect("a scenario");
    (scenario.ending, scenario.striking_ending) = (None, None);
    harness.run_steps(4);
    step_until(&mut harness, "the coasting cars", is_idle);
    assert!(says(&harness, "Nobody steers, brakes or accelerates"));
    save(&mut harness, "controls-none.png");
    let scenario = harness.state_mut().state_mut().project.scenario_mut().expect("a scenario");
    (scenario.ending, scenario.striking_ending) = (Some(struck), Some(striking));
    harness.run_steps(4);
    step_until(&mut harness, "the drivers", is_idle);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(1.8)));
    harness.run_steps(4);
    assert!(!says(&harness, "Nobody steers"));
    assert!(says(&harness, "What drivers and systems do"));
    // The values at the cursor stand above the plots, in the units that are shown.
    let values = |harness: &Harness<'_, App>, unit: &str| {
        let heads = ["Steer angle of the road wheels: ", "Drive torque of all wheels: "];
        heads.map(|head| {
            let found = harness.query_all_by_label_contains(head).next();
            let node = found.unwrap_or_else(|| panic!("no plot {head}"));
            let node = egui_kittest::kittest::NodeT::accesskit_node(&node);
            let text = node.value().or_else(|| node.label()).expect("a text");
            assert!(text.contains("striking vehicle "), "{text}");
            assert!(head.starts_with("Steer") || text.ends_with(unit), "{text}");
        })
    };
    values(&harness, " kN m");
    harness.get_by_label("Inputs").click();
    harness.run_steps(30);
    for dark in [false, true] {
        harness.state_mut().state_mut().view.dark = dark;
        harness.run_steps(4);
        save(&mut harness, if dark { "controls-dark.png" } else { "controls-light.png" });
    }
    harness.state_mut().state_mut().view.units = UnitSystem::Us;
    harness.run_steps(4);
    values(&harness, " lbf ft");
    assert!(state(&harness).analysis().is_some());
}
