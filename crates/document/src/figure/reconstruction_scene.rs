//! The scene of a reconstruction from above: what was found, and the paths of particles over it.

use crate::figure::scene::vehicle_outline;
use crate::figure::{Axis, Figure, FigureElement, LineStyle, Path, Role, Series};
use impactlab_core::collision::{Footprint, Pose, Side};
use impactlab_core::numerics::{NORMAL_QUANTILE_95, interpolate};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_core::vehicle::{Path as VehiclePath, PathPoint, TireMark};
use impactlab_reconstruct::Cars;
use impactlab_reconstruct::evidence::{Evidence, Measured};
use impactlab_study::{NamedPath, ReconstructAnswer, ReconstructedPaths};

/// Name of the struck or single car at rest in the legend.
pub fn struck_at_rest(evidence: &Evidence) -> &'static str {
    match evidence.is_single_car() {
        true => "car at rest, 90 % ellipse",
        false => "struck car at rest, 90 % ellipse",
    }
}
/// Name of the striking car at rest in the legend.
pub const STRIKING_AT_REST: &str = "striking car at rest, 90 % ellipse";

/// A path with the car on it.
#[derive(Debug, Clone, Copy)]
pub struct FollowedPath<'a> {
    /// Its name in the legend.
    pub name: &'a str,
    /// The path.
    pub path: &'a VehiclePath,
    /// Time at which the car is drawn, s after the first contact.
    pub time_s: f64,
}

/// What the scene of a reconstruction shows.
#[derive(Debug, Clone, Copy)]
pub struct ReconstructionScene<'a> {
    /// What was found.
    pub evidence: &'a Evidence,
    /// The vehicles, for their outlines.
    pub cars: &'a Cars,
    /// Paths in the background.
    pub drawn: &'a [VehiclePath],
    /// The path in front of them.
    pub followed: Option<FollowedPath<'a>>,
    /// Paths of other courses of events, with the car at their ends.
    pub others: &'a [NamedPath],
    /// The marks that the tires leave along the path in front.
    pub marks: &'a [TireMark],
}

impl<'a> ReconstructionScene<'a> {
    /// The scene of an answer, with a particle of median speed at its end; one of each where several
    /// courses of events are possible.
    pub fn new(answer: &'a ReconstructAnswer, paths: &'a ReconstructedPaths) -> Self {
        let at_end = |NamedPath { name, path, .. }: &'a NamedPath| FollowedPath {
            name,
            path,
            time_s: f64::INFINITY,
        };
        Self {
            evidence: answer.target.evidence(),
            cars: answer.target.model().cars(),
            drawn: &paths.drawn,
            followed: paths.median.as_ref().map(at_end),
            others: &paths.others,
            marks: &paths.marks,
        }
    }
}

/// The paths of the struck or single car from above, over what was found.
pub fn reconstruction_scene_figure(
    scene: &ReconstructionScene<'_>,
    caveats: &Caveats,
    units: UnitSystem,
) -> Figure {
    let (x, y, title) = match scene.evidence.is_single_car() {
        true => ("X", "Y", "where the car went"),
        false => (
            "X, along the heading before the impact",
            "Y, to the left",
            "where the struck car went",
        ),
    };
    let [x, y] = [x, y].map(|label| Axis::shown(label, Quantity::Length, units));
    let shown = |[px, py]: [f64; 2]| [x.unit.from_si(px), y.unit.from_si(py)];
    let path = |name: &str, role: Role, path: &VehiclePath| {
        let seen = |point: &PathPoint| shown([point.x_m, point.y_m]);
        FigureElement::Path(Path {
            series: Series {
                name: name.to_owned(),
                role,
                // As the lines of other variants, each with dashes of its own.
                style: match role {
                    Role::Variant(_) => LineStyle::Dashed,
                    _ => LineStyle::Solid,
                },
                points: path.points.iter().map(seen).collect(),
            },
            time_s: path.points.iter().map(|point| point.time_s).collect(),
            yaw_rad: path.points.iter().map(|point| point.yaw_rad).collect(),
        })
    };
    let drawn = scene.drawn.iter().map(|drawn| path("particles", Role::Muted, drawn));
    let mut elements: Vec<FigureElement> = drawn.collect();
    if !scene.evidence.is_single_car() {
        elements.extend(contact_elements(scene, &shown, units));
    }
    elements.extend(scene.marks.iter().map(|mark| {
        let points = mark.points.iter().map(|point| shown(point.place_m)).collect();
        FigureElement::line("tire marks, computed", Role::Simulation, points)
    }));
    elements.extend(evidence_elements(scene, &shown, units));
    let others = scene.others.iter().enumerate().map(|(idx, NamedPath { name, path, .. })| {
        (Role::Variant(idx + 1), FollowedPath { name, path, time_s: f64::INFINITY })
    });
    let front = scene.followed.map(|followed| (Role::Model, followed));
    for (role, FollowedPath { name, path: followed, time_s }) in others.chain(front) {
        elements.push(path(name, role, followed));
        if let Some(pose) = pose_on(followed, time_s) {
            let footprint = Footprint::from(&scene.cars.struck.parameters.geometry);
            let style = LineStyle::Solid;
            elements.extend(vehicle_outline(name, role, style, &footprint, &pose, x.unit));
        }
    }
    let title = format!("{}: {title}", scene.evidence.case);
    Figure::new(title, [x, y], elements).plan().with_caveats(&caveats.in_units(units))
}

/// Where a car is on a path at a time; beyond its ends, at the end. `None` for a path without points.
fn pose_on(path: &VehiclePath, time_s: f64) -> Option<Pose> {
    let last = path.points.last()?;
    let time_s = time_s.min(last.time_s);
    let times: Vec<f64> = path.points.iter().map(|point| point.time_s).collect();
    let at = |coordinate: fn(&PathPoint) -> f64| {
        let values: Vec<f64> = path.points.iter().map(coordinate).collect();
        interpolate(&times, &values, time_s)
    };
    Some(Pose { x_m: at(|p| p.x_m)?, y_m: at(|p| p.y_m)?, yaw_rad: at(|p| p.yaw_rad)? })
}

/// The struck car at the first contact, and the place of that on its side with its 90 % interval.
fn contact_elements(
    scene: &ReconstructionScene<'_>,
    shown: &impl Fn([f64; 2]) -> [f64; 2],
    units: UnitSystem,
) -> Vec<FigureElement> {
    let (damage, cars) = (&scene.evidence.damage, scene.cars);
    let footprint = Footprint::from(&cars.struck.parameters.geometry);
    let pose = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0 };
    let unit = Quantity::Length.display_unit(units);
    let (name, style) = ("struck car at first contact", LineStyle::Dashed);
    let depth_m = damage.depth_m.unwrap_or_else(|| cars.depth_of(damage.struck_side()));
    let at = |along_m: f64| match damage.struck_side() {
        Side::Left | Side::Right => shown([along_m, depth_m]),
        Side::Front | Side::Rear => shown([depth_m, along_m]),
    };
    let mut elements =
        Vec::from(vehicle_outline(name, Role::Target, style, &footprint, &pose, unit));
    if let Some(Measured { value: along_m, sigma }) = damage.along() {
        let reach_m = NORMAL_QUANTILE_95 * sigma;
        let ends = vec![at(along_m - reach_m), at(along_m + reach_m)];
        let name = "contact by the damage, 90 %";
        elements.push(FigureElement::line(name, Role::Pulse, ends));
        elements.push(FigureElement::points(name, Role::Pulse, vec![at(along_m)]));
    }
    elements
}

/// What was found: marks, positions, the rest poses with their 90 % ellipses.
fn evidence_elements(
    scene: &ReconstructionScene<'_>,
    shown: &impl Fn([f64; 2]) -> [f64; 2],
    units: UnitSystem,
) -> Vec<FigureElement> {
    let ReconstructionScene { evidence, cars, .. } = scene;
    let mut elements = Vec::new();
    for place in evidence.places().into_iter().filter(|place| !place.is_rest()) {
        let points: Vec<[f64; 2]> = place.points_m.iter().map(|at| shown(*at)).collect();
        let role = match (place.is_line, place.is_of_striking_car()) {
            (true, true) => Role::Validation,
            (true, false) => Role::Striking,
            (false, _) => Role::Pulse,
        };
        if place.is_line {
            elements.push(FigureElement::dashed(&place.name, role, points.clone()));
        }
        elements.push(FigureElement::points(&place.name, role, points));
    }
    for (rest, car, name) in [
        (&evidence.striking_rest, &cars.striking, STRIKING_AT_REST),
        (&evidence.rest, &cars.struck, struck_at_rest(evidence)),
    ] {
        let Some(rest) = rest else { continue };
        let ellipse = rest.ellipse_90_m().into_iter().map(shown).collect();
        elements.push(FigureElement::line(name, Role::Reference, ellipse));
        if let Some(pose) = rest.pose() {
            let unit = Quantity::Length.display_unit(units);
            let footprint = Footprint::from(&car.parameters.geometry);
            let (role, style) = (Role::Reference, LineStyle::Dashed);
            elements.extend(vehicle_outline(name, role, style, &footprint, &pose, unit));
        }
    }
    elements
}
