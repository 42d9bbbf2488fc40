//! The scene of a reconstruction: paths of particles over what was found.

use std::sync::Arc;

use crate::scene::simulation::{add, add_marks, outline_m};
use crate::scene::{
    CarBody, CarLook, CarMotion, CarShape, Scene, SceneCar, SceneLine, ScenePath, ScenePoint,
    SceneRole,
};
use impactlab_core::collision::{Footprint, Pose};
use impactlab_core::numerics::interpolate;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{Path, TireMark, VehicleParameters};
use impactlab_reconstruct::Cars;
use impactlab_reconstruct::evidence::{Evidence, RestPose};
use impactlab_study::{NamedPath, ReconstructAnswer, ReconstructedPaths};

/// Longest interval at which the motion along a path is kept, s.
const STEP_S: f64 = 0.05;

/// What the scene of a reconstruction shows.
#[derive(Debug, Clone, Copy)]
pub struct ReconstructionParts<'a> {
    /// What was found.
    pub evidence: &'a Evidence,
    /// The vehicles.
    pub cars: &'a Cars,
    /// Paths of particles.
    pub drawn: &'a [Path],
    /// The path that the car drives, with its name.
    pub followed: Option<(&'a str, &'a Path)>,
    /// Paths of other courses of events, which cars drive that shine through.
    pub others: &'a [NamedPath],
    /// The marks that tires leave along the path that the car drives.
    pub marks: &'a [TireMark],
    /// System of units of the labels.
    pub units: UnitSystem,
    /// What restricts the answer.
    pub caveats: &'a Caveats,
}

impl<'a> ReconstructionParts<'a> {
    /// What the scene of an answer shows, with a particle of median speed that drives; one of each where
    /// several courses of events are possible.
    pub fn new(
        answer: &'a ReconstructAnswer,
        paths: &'a ReconstructedPaths,
        units: UnitSystem,
        caveats: &'a Caveats,
    ) -> Self {
        Self {
            evidence: answer.target.evidence(),
            cars: answer.target.model().cars(),
            drawn: &paths.drawn,
            followed: paths.median.as_ref().map(|path| (path.name.as_str(), &path.path)),
            others: &paths.others,
            marks: &paths.marks,
            units,
            caveats,
        }
    }
}

/// The scene of a reconstruction.
pub fn reconstruction_scene(input: &ReconstructionParts<'_>) -> Scene {
    let ReconstructionParts { evidence, cars, .. } = *input;
    let mut scene = Scene {
        title: evidence.case.clone(),
        units: input.units,
        caveats: input.caveats.clone(),
        ..Scene::default()
    };
    let shape = shape_of(&cars.struck.parameters);
    let particles = input.drawn.iter().filter_map(|path| motion_of(path, &shape.body));
    scene.paths.extend(particles.map(|motion| ScenePath {
        name: "particles".to_owned(),
        role: SceneRole::Muted,
        is_dashed: false,
        has_ticks: false,
        motion: Arc::new(motion),
    }));
    add_marks(&mut scene, input.marks);
    add_found(&mut scene, evidence);
    let (driven, struck_at_rest) = match evidence.is_single_car() {
        true => ("car", ["car at rest, 90 % ellipse", "car, found"]),
        false => ("struck", ["struck car at rest, 90 % ellipse", "struck, found"]),
    };
    for (rest, shape, [name, tag]) in [
        (
            &evidence.striking_rest,
            shape_of(&cars.striking.parameters),
            ["striking car at rest, 90 % ellipse", "striking, found"],
        ),
        (&evidence.rest, Arc::clone(&shape), struck_at_rest),
    ] {
        if let Some(rest) = rest {
            add_rest(&mut scene, rest, &shape, [name, tag]);
        }
    }
    // The likeliest one is drawn last and named first.
    for (idx, NamedPath { name, chance, path }) in input.others.iter().enumerate().rev() {
        let (motion, role) = (motion_of(path, &shape.body), SceneRole::Variant(idx + 1));
        // Its probability, so that not the colour alone says which one it is.
        let tag = chance.as_deref().unwrap_or(driven);
        add(&mut scene, [name, tag], role, CarLook::Ghost, &shape, motion);
    }
    if let Some((name, path)) = input.followed {
        let motion = motion_of(path, &shape.body);
        let named = [name, driven];
        add(&mut scene, named, SceneRole::Simulated, CarLook::Solid, &shape, motion);
    }
    let driving = scene.cars.iter().filter(|car| car.role != SceneRole::Evidence);
    scene.end_s = driving.map(|car| car.motion.end_s()).fold(0.0, f64::max);
    scene
}

fn shape_of(vehicle: &VehicleParameters) -> Arc<CarShape> {
    let outline = Footprint::from(&vehicle.geometry);
    Arc::new(CarShape::new(CarBody::new(vehicle, &outline)))
}

/// The motion along a path, at even intervals of which the last one ends with the path.
fn motion_of(path: &Path, body: &CarBody) -> Option<CarMotion> {
    let points = &path.points;
    let times: Vec<f64> = points.iter().map(|point| point.time_s).collect();
    let start_s = *times.first()?;
    let duration_s = times.last()? - start_s;
    let n_steps = (duration_s / STEP_S).ceil().clamp(1.0, 1e5) as usize;
    let step_s = duration_s / n_steps as f64;
    let at = |values: &[f64], time_s| interpolate(&times, values, time_s);
    let [x, y, yaw]: [Vec<f64>; 3] = [
        points.iter().map(|point| point.x_m).collect(),
        points.iter().map(|point| point.y_m).collect(),
        points.iter().map(|point| point.yaw_rad).collect(),
    ];
    let pose = |step: usize| {
        let time_s = start_s + step as f64 * step_s;
        Some(Pose { x_m: at(&x, time_s)?, y_m: at(&y, time_s)?, yaw_rad: at(&yaw, time_s)? })
    };
    let poses: Option<Vec<Pose>> = (0..=n_steps).map(pose).collect();
    Some(CarMotion::from_poses(&poses?, step_s, body)?.later_by(start_s))
}

/// What was found, but for the cars at rest.
fn add_found(scene: &mut Scene, evidence: &Evidence) {
    for place in evidence.places().into_iter().filter(|place| !place.is_rest()) {
        let role = match place.is_of_striking_car() {
            true => SceneRole::Striking,
            false => SceneRole::Evidence,
        };
        let (name, points_m) = (place.name, place.points_m);
        if place.is_line {
            let (is_dashed, is_above_cars) = (true, false);
            scene.lines.push(SceneLine { name, role, is_dashed, is_above_cars, points_m });
        } else {
            let point = |at_m| ScenePoint { name: name.clone(), role, at_m };
            scene.points.extend(points_m.into_iter().map(point));
        }
    }
}

/// A car as it was found at rest, with the ellipse that holds its place with 90 %.
fn add_rest(scene: &mut Scene, rest: &RestPose, shape: &Arc<CarShape>, [name, tag]: [&str; 2]) {
    let line = |name: &str, is_dashed, points_m| SceneLine {
        name: name.to_owned(),
        role: SceneRole::Evidence,
        is_dashed,
        is_above_cars: false,
        points_m,
    };
    scene.lines.push(line(name, false, rest.ellipse_90_m()));
    let Some(pose) = rest.pose() else { return };
    scene.lines.push(line("", true, outline_m(&shape.body, &pose)));
    scene.cars.push(SceneCar {
        name: name.to_owned(),
        tag: tag.to_owned(),
        role: SceneRole::Evidence,
        look: CarLook::Ghost,
        shape: Arc::clone(shape),
        motion: Arc::new(CarMotion::standing(pose)),
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::data::TomlFile;
    use impactlab_core::vehicle::{PathEnd, PathPoint, Preset};

    #[test]
    fn the_marks_of_each_car_have_the_colour_of_the_car() {
        let text = r#"
            case = "marks"
            struck_car = { mass_kg = 1500 }
            striking_car = { mass_kg = 1500 }
            damage = { side = "right", x_m = -1.7 }
            mark = [{ wheel = "FL", points_m = [[1, 2], [3, 4]] }]
            striking_mark = [{ wheel = "FL", points_m = [[1, 5], [3, 6]] }]
        "#;
        let file = TomlFile { path: std::path::Path::new("case.toml"), text };
        let mut scene = Scene::default();
        add_found(&mut scene, &Evidence::from_toml(file).unwrap());
        let drawn: Vec<_> = scene.lines.iter().map(|it| (it.role, it.points_m[0])).collect();
        let expected = [(SceneRole::Evidence, [1.0, 2.0]), (SceneRole::Striking, [1.0, 5.0])];
        assert_eq!(drawn, expected);
    }

    /// A point of a car that drives straight on at 10 m/s.
    fn point(time_s: f64) -> PathPoint {
        PathPoint {
            time_s,
            x_m: 10.0 * time_s,
            y_m: 0.0,
            yaw_rad: 0.0,
            vx_body_m_s: 10.0,
            vy_body_m_s: 0.0,
            yaw_rate_rad_s: 0.0,
        }
    }

    /// The tag was what stood before the first colon of a name.
    #[test]
    fn the_car_of_another_course_of_events_has_its_probability_beside_it() {
        let text = r#"
            case = "courses"
            struck_car = { mass_kg = 1500 }
            striking_car = { mass_kg = 1500 }
            damage = { side = "right", x_m = -1.7 }
            mark = [{ wheel = "FL", points_m = [[1, 2], [3, 4]] }]
        "#;
        let file = TomlFile { path: std::path::Path::new("case.toml"), text };
        let evidence = Evidence::from_toml(file).unwrap();
        let cars = Cars::new(&evidence, None, None);
        let named = |name: &str, chance: Option<&str>| NamedPath {
            name: name.to_owned(),
            chance: chance.map(str::to_owned),
            path: Path { points: vec![point(0.0), point(1.0)], end: PathEnd::Rest },
        };
        let others = [named("26.3 %: it turns", Some("26.3 %")), named("draw 3: it turns", None)];
        let scene = reconstruction_scene(&ReconstructionParts {
            evidence: &evidence,
            cars: &cars,
            drawn: &[],
            followed: None,
            others: &others,
            marks: &[],
            units: UnitSystem::Si,
            caveats: &Caveats::default(),
        });
        let mut tags: Vec<&str> = scene.cars.iter().map(|car| car.tag.as_str()).collect();
        tags.sort_unstable();
        assert_eq!(tags, ["26.3 %", "struck"]);
        assert!(scene.paths.iter().all(|path| path.is_dashed), "as in the plan");
    }

    #[test]
    fn a_motion_begins_and_ends_with_its_path() {
        let body = shape_of(&Preset::Reference.parameters()).body;
        for (start_s, end_s) in [(0.0, 1.0), (0.0, 0.97), (0.2, 3.211), (0.0, 0.01)] {
            let points = vec![point(start_s), point((start_s + end_s) / 2.0), point(end_s)];
            let motion = motion_of(&Path { points, end: PathEnd::Rest }, &body).unwrap();
            let first_s = motion.time_s().first().copied().unwrap();
            assert_eq!(first_s, start_s, "{start_s} to {end_s} s");
            assert!((motion.end_s() - end_s).abs() < 1e-12, "{} of {end_s} s", motion.end_s());
            for time_s in [start_s, 0.5 * (start_s + end_s), end_s] {
                let x_m = motion.at(time_s).pose.x_m;
                assert!((x_m - 10.0 * time_s).abs() < 1e-9, "{x_m} m at {time_s} s");
            }
        }
    }
}
