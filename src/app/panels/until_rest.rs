//! The choice whether motions are followed to rest, which asks first what the driver does.

use egui::{Id, Ui};

use crate::app::panels::ending::hard_braking;
use crate::app::project::Project;
use impactlab_core::ranges::REST_LIMIT;
use impactlab_core::vehicle::Ending;
use impactlab_study::{DEFAULT_DURATION_S, MotionSource};

/// Draws the choice whether motions are followed to rest. Where nobody has said what the driver does, that
/// is asked before: it decides by far the most where the vehicle stops.
pub(super) fn until_rest_ui(ui: &mut Ui, project: &mut Project) {
    let id = Id::unique("the driver is asked about");
    let was_asking = ui.data(|data| data.get_temp(id)).unwrap_or(false);
    let mut is_asking = was_asking && is_driver_open(project);
    let hint = "Simulation and forecast end where the vehicle has come to rest, at the latest after \
                the duration";
    let mut is_on = project.simulate.until_rest || is_asking;
    if ui.checkbox(&mut is_on, "Until rest").on_hover_text(hint).changed() {
        is_asking = is_on && is_driver_open(project);
        follow(project, is_on && !is_asking);
    }
    if is_asking && let Some(ending) = driver_ui(ui) {
        if let Some(open) = driver_mut(project) {
            *open = Some(ending);
        }
        is_asking = false;
        follow(project, true);
    }
    ui.data_mut(|data| data.insert_temp(id, is_asking));
}

/// Asks what the driver does; `None` until there is an answer.
fn driver_ui(ui: &mut Ui) -> Option<Ending> {
    let mut answer = None;
    ui.label("What does the driver do? It decides where the vehicle stops.");
    ui.horizontal_wrapped(|ui| {
        if ui.button("Brakes hard").clicked() {
            answer = Some(Ending { brake: Some(hard_braking()), ..Ending::default() });
        }
        if ui.button("Lets it roll").clicked() {
            answer = Some(Ending::default());
        }
    });
    answer
}

/// What the driver does, where the question says it; `None` for a record, which has the driver that it has.
fn driver_mut(project: &mut Project) -> Option<&mut Option<Ending>> {
    match &project.simulate.source {
        MotionSource::Scenario { .. } => project.scenario_mut().map(|of| &mut of.ending),
        MotionSource::Drive(_) => Some(&mut project.simulate.ending),
        MotionSource::Case { .. } | MotionSource::Trajectory { .. } => None,
    }
}

/// Whether nobody has said what the driver does.
fn is_driver_open(project: &mut Project) -> bool {
    let is_named = project.simulate.ending.is_some();
    driver_mut(project).is_some_and(|ending| ending.is_none()) && !is_named
}

/// Follows motions to rest, or for a duration. The duration is then the time after which they are followed
/// no further: where it was the usual one, it becomes the usual one of that.
fn follow(project: &mut Project, until_rest: bool) {
    let (before, after) = match until_rest {
        true => (DEFAULT_DURATION_S, REST_LIMIT.high),
        false => (REST_LIMIT.high, DEFAULT_DURATION_S),
    };
    if project.simulate.until_rest != until_rest && project.simulate.duration_s == before {
        project.simulate.duration_s = after;
    }
    project.simulate.until_rest = until_rest;
}
