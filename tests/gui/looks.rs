//! Whether the window can be read in a small window and on a dense screen.

use std::collections::BTreeSet;
use std::path::Path;

use egui::{Id, Rect, Shape};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Pane, State, Subject, Workspace};
use impactlab_study::{ForceSource, ModelChoice};

use crate::harness::{apply, is_idle, open_at, step_until};
use crate::pictures::save;

/// Share of the smaller of two texts that another one may cover, as the boxes of lines are higher than
/// their letters.
const MAX_COVERED: f32 = 0.25;

/// A text that can be seen.
struct Seen {
    text: String,
    place: Rect,
}

fn add_texts(shape: &Shape, clip: Rect, texts: &mut Vec<Seen>) {
    match shape {
        Shape::Text(shape) => {
            // A text that begins in the middle of a line leaves the place before it to others.
            let at = shape.pos.to_vec2();
            let rows = shape.galley.rows.iter().map(|row| {
                (row.text(), row.rect_without_leading_space().translate(at).intersect(clip))
            });
            let is_seen =
                |(text, place): &(String, Rect)| !text.trim().is_empty() && place.is_positive();
            if shape.angle == 0.0 && shape.opacity_factor > 0.0 {
                texts.extend(rows.filter(is_seen).map(|(text, place)| Seen { text, place }));
            }
        }
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| add_texts(shape, clip, texts)),
        _ => {}
    }
}

/// Pairs of texts of the last frame that stand on each other.
pub fn collisions(harness: &Harness<'_, App>) -> Vec<String> {
    let mut texts = Vec::new();
    for clipped in &harness.output().shapes {
        add_texts(&clipped.shape, clipped.clip_rect, &mut texts);
    }
    assert!(texts.len() > 20, "nothing is shown");
    let mut found = Vec::new();
    for (i, a) in texts.iter().enumerate() {
        for b in &texts[i + 1..] {
            let both = a.place.intersect(b.place);
            let covered = if both.is_positive() { both.area() } else { 0.0 };
            if covered > MAX_COVERED * a.place.area().min(b.place.area()) {
                found.push(format!("{:?} on {:?} at {:?}", a.text, b.text, both.center()));
            }
        }
    }
    found
}

fn is_answered(state: &State) -> bool {
    let session = &state.session;
    is_idle(state)
        && session.response.forecast.ok().is_some()
        && !session.response.forecast.is_waiting()
        && !session.force.forecast.is_waiting()
}

/// Every view of the window at a size, none of which has texts on each other.
fn every_view_is_readable(name: &str, size: ([f32; 2], f32)) {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");
    let mut harness = open_at(size, &[data], None);
    step_until(&mut harness, "case", is_idle);
    apply(&mut harness, Command::Select(Subject::Scenario));
    apply(&mut harness, Command::PredictScenario);
    harness.state_mut().state_mut().project.predict_motion.force =
        ForceSource::Predicted(ModelChoice::default());
    let views = [
        (Workspace::Case, Pane::Scene),
        (Workspace::Case, Pane::MotionForecast),
        (Workspace::Case, Pane::ForcePrediction),
        (Workspace::Case, Pane::Vehicle),
        (Workspace::Case, Pane::Variants),
        (Workspace::Data, Pane::Motion),
        (Workspace::Models, Pane::Models),
        (Workspace::Models, Pane::Training),
        (Workspace::Atlas, Pane::AtlasMap),
        (Workspace::Atlas, Pane::Sweep),
    ];
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    step_until(&mut harness, "forecast", is_answered);
    let mut found = Vec::new();
    for dark in [false, true] {
        harness.state_mut().state_mut().view.dark = dark;
        for (workspace, pane) in views {
            apply(&mut harness, Command::ShowWorkspace(workspace));
            apply(&mut harness, Command::Show(pane));
            let has_maps =
                |state: &State| pane != Pane::AtlasMap || !state.session.atlas.maps().is_empty();
            step_until(&mut harness, "view", |state| is_answered(state) && has_maps(state));
            let theme = if dark { "dark" } else { "light" };
            let file = format!("{name}_{workspace:?}_{pane:?}_{theme}.png").to_lowercase();
            save(&mut harness, &file);
            let view = format!("{workspace:?}, {pane:?}");
            found.extend(collisions(&harness).into_iter().map(|text| format!("{view}: {text}")));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn no_text_stands_on_another_in_a_small_window() {
    every_view_is_readable("small", ([1280.0, 720.0], 1.0));
}

#[test]
fn no_text_stands_on_another_on_a_dense_screen() {
    every_view_is_readable("dense", ([1280.0, 800.0], 2.0));
}

#[test]
fn the_data_workspace_shows_a_screenful_of_cases_in_a_small_window() {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");
    let mut harness = open_at(([1280.0, 720.0], 1.0), &[data], None);
    step_until(&mut harness, "case", is_idle);
    apply(&mut harness, Command::ShowWorkspace(Workspace::Data));
    harness.run_steps(4);
    // Rows out of sight are not drawn.
    assert!(harness.query_by_label("c008").is_some());
    let legend = harness.get_by_label("F_x").rect();
    assert!(legend.bottom() < 720.0 && legend.right() < 1280.0, "{legend:?}");
}

/// A data set that was opened stood below the end of the list.
#[test]
fn the_list_of_data_scrolls_to_the_set_that_is_listed() {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets");
    let mut harness = open_at(([1280.0, 720.0], 1.0), &[data], None);
    step_until(&mut harness, "the shipped data", is_idle);
    apply(&mut harness, Command::ShowWorkspace(Workspace::Data));
    let mut top_of_first = |listed: &str| {
        apply(&mut harness, Command::List(Path::new(data).join(listed)));
        harness.run_steps(60);
        harness.get_by_label("fea · 100 force curves").rect().top()
    };
    let scrolled = top_of_first("trajectories-pulse");
    assert!(scrolled < top_of_first("fea"), "{scrolled}");
}

/// Badges and legend left it a strip.
#[test]
fn the_scene_has_room_in_a_small_window() {
    let scenario = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");
    let mut harness = open_at(([1280.0, 720.0], 1.0), &[scenario], None);
    step_until(&mut harness, "the simulation", is_idle);
    apply(&mut harness, Command::ShowWorkspace(Workspace::Data));
    harness.run_steps(4);
    let scene = harness.get_by_label("Picture of the scene").rect();
    assert!(scene.height() > 100.0, "{scene:?}");
}

#[test]
fn a_click_in_the_legend_hides_a_curve_and_shows_it_again() {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");
    let mut harness = open_at(([1440.0, 900.0], 1.0), &[data], None);
    step_until(&mut harness, "case", is_idle);
    apply(&mut harness, Command::ShowWorkspace(Workspace::Data));
    harness.run_steps(4);
    let hidden = |harness: &Harness<'_, App>| -> BTreeSet<String> {
        let id = Id::unique(("hidden in", "force"));
        harness.ctx.data(|data| data.get_temp(id)).unwrap_or_default()
    };
    for expected in [vec!["F_x"], vec![]] {
        harness.get_by_label("F_x").click();
        harness.run_steps(4);
        assert!(hidden(&harness).iter().eq(expected.iter()), "{:?}", hidden(&harness));
    }
}
