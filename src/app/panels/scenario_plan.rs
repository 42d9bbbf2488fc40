//! The plan of a scenario, in which the vehicles are dragged: position, heading and velocity.

use egui::{Id, Ui};

use crate::app::command::Command;
use crate::app::widgets::figure_frame;
use impactlab_core::collision::{self, ContactLocation, Pose, Scenario, ScenarioVehicle, Side};
use impactlab_core::numerics::nearest_multiple;
use impactlab_core::ranges::{HEADING, POSITION, SPEED};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_document::figure::{
    Axis, Figure, FigureElement, LineStyle, Role, impact_figure, vehicle_outline,
};
use impactlab_draw::FigureOptions;
use impactlab_study::ImpactAnswer;

/// Height of the plan, points.
const HEIGHT: f32 = 240.0;
/// Distance from the pointer at which a handle is taken, points.
const REACH: f64 = 14.0;
/// The arrow of a velocity reaches to where the vehicle is after this time, s.
const ARROW_S: f64 = 0.25;

/// What is dragged.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Handle {
    /// The CG.
    Position,
    /// The front end.
    Heading,
    /// The tip of the velocity.
    Velocity,
}

/// A vehicle that is being dragged.
#[derive(Debug, Clone)]
struct Drag {
    handle: Handle,
    is_struck: bool,
    /// The scenario when the drag began.
    before: Scenario,
    /// The view, which stays while something is dragged.
    view: [[f64; 2]; 2],
}

/// Draws the plan with its handles, and changes the scenario as they are dragged.
///
/// - `solved`: the momentum solution, if there is one, of this scenario or of one just before.
pub fn scenario_plan_ui(
    ui: &mut Ui,
    scenario: &mut Scenario,
    solved: Option<&ImpactAnswer>,
    units: UnitSystem,
    reset: bool,
    commands: &mut Vec<Command>,
) {
    let id = Id::unique("scenario drag");
    let drag = ui.data(|data| data.get_temp::<Drag>(id));
    let solved = solved.filter(|answer| answer.scenario == *scenario);
    let figure = solved
        .and_then(|ImpactAnswer { scenario, solution, report }| {
            impact_figure(scenario, solution, &report.caveats, units).ok()
        })
        .unwrap_or_else(|| outlines_figure(scenario, units));
    let figure = with_handles(figure, scenario);
    let options = FigureOptions {
        id: "impact".to_owned(),
        height: Some(HEIGHT),
        reset,
        legend: false,
        view: drag.as_ref().map(|drag| drag.view),
        pans: false,
        ..FigureOptions::default()
    };
    let response = figure_frame(ui, &figure.title, &figure, &options, commands);
    ui.weak("Drag a dot: the middle moves the car, its front turns it, the arrow is its speed.");
    let unit = figure.x.unit;
    let si = |point: [f64; 2]| point.map(|value| unit.to_si(value));
    let Some([from, to]) = response.drag.map(|ends| ends.map(si)) else {
        ui.data_mut(|data| data.remove::<Drag>(id));
        return;
    };
    let drag = drag.or_else(|| {
        let reach_m = unit.to_si(response.x_per_point * REACH);
        let (is_struck, handle) = nearest_handle(scenario, from, reach_m)?;
        Some(Drag { handle, is_struck, before: scenario.clone(), view: response.view })
    });
    if let Some(drag) = drag {
        if from != to {
            drag.apply([from, to], scenario);
        }
        ui.data_mut(|data| data.insert_temp(id, drag));
    }
}

impl Drag {
    /// Puts the scenario to where the pointer is. What is not possible is left as it was.
    fn apply(&self, [from, to]: [[f64; 2]; 2], scenario: &mut Scenario) {
        let moved = [to[0] - from[0], to[1] - from[1]];
        let before = &self.before;
        let [struck, striking] = poses(before);
        let pose = if self.is_struck { struck } else { striking };
        let Some(pose) = pose else { return };
        let vehicle = if self.is_struck { &mut scenario.struck } else { &mut scenario.striking };
        let (dx, dy) = (to[0] - pose.x_m, to[1] - pose.y_m);
        match self.handle {
            Handle::Position if self.is_struck => {
                let place =
                    [before.struck_x_world_m + moved[0], before.struck_y_world_m + moved[1]];
                if place.iter().all(|value| POSITION.contains(*value)) {
                    [scenario.struck_x_world_m, scenario.struck_y_world_m] = place;
                }
            }
            Handle::Position => move_striking(before, moved, &mut scenario.contact.location),
            Handle::Heading => {
                let heading = nearest_multiple(dy.atan2(dx), 0.1_f64.to_radians());
                if HEADING.contains(heading) {
                    vehicle.heading_rad = heading;
                }
            }
            Handle::Velocity => {
                let velocity = [dx, dy].map(|value| nearest_multiple(value / ARROW_S, 0.01));
                if SPEED.contains(velocity[0].hypot(velocity[1])) {
                    [vehicle.vx_world_m_s, vehicle.vy_world_m_s] = velocity;
                }
            }
        }
    }
}

/// Moves the striking vehicle, in the way in which the scenario places it.
fn move_striking(before: &Scenario, [dx, dy]: [f64; 2], location: &mut ContactLocation) {
    match (before.contact.location, location) {
        (
            ContactLocation::Side { side, offset_m: start },
            ContactLocation::Side { offset_m, .. },
        ) => {
            let [ahead, left] = body_from_world(before.struck.heading_rad, [dx, dy]);
            let along = match side {
                Side::Left | Side::Right => ahead,
                Side::Front | Side::Rear => left,
            };
            let half = match side {
                Side::Left | Side::Right => before.struck.length_m / 2.0,
                Side::Front | Side::Rear => before.struck.width_m / 2.0,
            };
            *offset_m = nearest_multiple((start + along).clamp(-half, half), 1e-3);
        }
        (
            ContactLocation::Footprints { striking_x_world_m: x, striking_y_world_m: y }
            | ContactLocation::Point { striking_x_world_m: x, striking_y_world_m: y, .. },
            ContactLocation::Footprints { striking_x_world_m, striking_y_world_m }
            | ContactLocation::Point { striking_x_world_m, striking_y_world_m, .. },
        ) => {
            let place = [x + dx, y + dy];
            if place.iter().all(|value| POSITION.contains(*value)) {
                [*striking_x_world_m, *striking_y_world_m] =
                    place.map(|value| nearest_multiple(value, 1e-3));
            }
        }
        _ => {}
    }
}

/// Poses of the struck and the striking vehicle. The striking vehicle has none where it is placed
/// so that it touches, and cannot.
fn poses(scenario: &Scenario) -> [Option<Pose>; 2] {
    if let Ok(geometry) = scenario.geometry() {
        return [Some(geometry.struck), Some(geometry.striking)];
    }
    let pose = |[x_m, y_m]: [f64; 2], vehicle: &ScenarioVehicle| Pose {
        x_m,
        y_m,
        yaw_rad: vehicle.heading_rad,
    };
    let striking = match scenario.contact.location {
        ContactLocation::Footprints { striking_x_world_m, striking_y_world_m }
        | ContactLocation::Point { striking_x_world_m, striking_y_world_m, .. } => {
            Some([striking_x_world_m, striking_y_world_m])
        }
        ContactLocation::Side { .. } => None,
    };
    [
        Some(pose([scenario.struck_x_world_m, scenario.struck_y_world_m], &scenario.struck)),
        striking.map(|place| pose(place, &scenario.striking)),
    ]
}

/// The handles of a vehicle with their places, m. The velocity stands first: it is on top.
fn handles(vehicle: &ScenarioVehicle, pose: &Pose) -> [(Handle, [f64; 2]); 3] {
    let tip =
        [pose.x_m + vehicle.vx_world_m_s * ARROW_S, pose.y_m + vehicle.vy_world_m_s * ARROW_S];
    [
        (Handle::Velocity, tip),
        (Handle::Heading, pose.world_from_body([vehicle.cg_from_front_m, 0.0])),
        (Handle::Position, [pose.x_m, pose.y_m]),
    ]
}

/// The handle that is nearest to a point, if one is within reach: whether it is of the struck
/// vehicle, and which.
fn nearest_handle(scenario: &Scenario, [x, y]: [f64; 2], reach_m: f64) -> Option<(bool, Handle)> {
    let [struck, striking] = poses(scenario);
    let of = |is_struck: bool, vehicle: &ScenarioVehicle, pose: Option<Pose>| {
        let places = pose.into_iter().flat_map(|pose| handles(vehicle, &pose));
        let apart =
            places.map(move |(handle, [px, py])| ((px - x).hypot(py - y), (is_struck, handle)));
        apart.collect::<Vec<_>>()
    };
    let all =
        [of(true, &scenario.struck, struck), of(false, &scenario.striking, striking)].concat();
    let near = all.into_iter().filter(|(distance_m, _)| *distance_m <= reach_m);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
}

/// Both vehicles, with what they are called and drawn as.
fn vehicles(scenario: &Scenario) -> [(&'static str, Role, &ScenarioVehicle); 2] {
    [
        (collision::Role::Struck.label(), Role::Simulation, &scenario.struck),
        (collision::Role::Striking.label(), Role::Striking, &scenario.striking),
    ]
}

/// Both vehicles without an impulse, while there is no solution.
fn outlines_figure(scenario: &Scenario, units: UnitSystem) -> Figure {
    let x = Axis::shown("X, along the road", Quantity::Length, units);
    let y = Axis::shown("Y, to the left", Quantity::Length, units);
    let placed = vehicles(scenario).into_iter().zip(poses(scenario));
    let elements = placed.filter_map(|((name, role, vehicle), pose)| {
        let (style, footprint) = (LineStyle::Solid, vehicle.footprint());
        Some(vehicle_outline(name, role, style, &footprint, &pose?, x.unit))
    });
    let elements = elements.flatten().collect();
    let title = format!("{}: no solution here", scenario.name);
    Figure::new(title, [x, y], elements).plan()
}

/// The figure with the velocities of both vehicles and the dots by which they are dragged.
fn with_handles(mut figure: Figure, scenario: &Scenario) -> Figure {
    let unit = figure.x.unit;
    let shown = |point: [f64; 2]| point.map(|value| unit.from_si(value));
    for ((name, role, vehicle), pose) in vehicles(scenario).into_iter().zip(poses(scenario)) {
        let Some(pose) = pose else { continue };
        let places = handles(vehicle, &pose).map(|(_, place)| place);
        let velocity = format!("velocity of the {name}, way in {ARROW_S} s");
        let (from, tip) = (shown([pose.x_m, pose.y_m]), shown(places[0]));
        let points = places.map(shown).to_vec();
        figure.elements.push(FigureElement::dashed(velocity, role, vec![from, tip]));
        figure.elements.push(FigureElement::points(format!("handles of the {name}"), role, points));
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dragged(handle: Handle, is_struck: bool, to: [f64; 2]) -> Scenario {
        let mut scenario = Scenario::example();
        let [struck, striking] = poses(&scenario).map(Option::unwrap);
        let (vehicle, pose) = match is_struck {
            true => (&scenario.struck, struck),
            false => (&scenario.striking, striking),
        };
        let places = handles(vehicle, &pose);
        let from = places.iter().find(|(of, _)| *of == handle).unwrap().1;
        let found = nearest_handle(&scenario, from, 0.1);
        assert_eq!(found, Some((is_struck, handle)));
        let view = [[0.0; 2]; 2];
        let drag = Drag { handle, is_struck, before: scenario.clone(), view };
        drag.apply([from, [from[0] + to[0], from[1] + to[1]]], &mut scenario);
        scenario
    }

    #[test]
    fn each_handle_changes_what_it_stands_for() {
        let before = Scenario::example();
        let moved = dragged(Handle::Position, true, [2.0, -1.0]);
        assert_eq!([moved.struck_x_world_m, moved.struck_y_world_m], [2.0, -1.0]);
        let faster = dragged(Handle::Velocity, true, [1.25, 0.0]);
        assert!((faster.struck.vx_world_m_s - before.struck.vx_world_m_s - 5.0).abs() < 0.011);
        let turned = dragged(Handle::Heading, false, [0.0, 0.3]);
        assert!(turned.striking.heading_rad > before.striking.heading_rad);
        let ContactLocation::Side { offset_m, .. } =
            dragged(Handle::Position, false, [0.2, 3.0]).contact.location
        else {
            unreachable!("the example places the striking vehicle at a side")
        };
        let ContactLocation::Side { offset_m: start, .. } = before.contact.location else {
            unreachable!("the example places the striking vehicle at a side")
        };
        assert!((offset_m - start - 0.2).abs() < 1e-3, "{start} to {offset_m}");
    }

    #[test]
    fn a_vehicle_that_touches_nothing_is_still_drawn() {
        let mut scenario = Scenario::example();
        scenario.contact.location =
            ContactLocation::Footprints { striking_x_world_m: -40.0, striking_y_world_m: 0.0 };
        assert!(scenario.geometry().is_err());
        let figure = with_handles(outlines_figure(&scenario, UnitSystem::Si), &scenario);
        let n_outlines =
            figure.elements.iter().filter(|of| matches!(of, FigureElement::Polygon(_))).count();
        assert_eq!(n_outlines, 2);
    }
}
