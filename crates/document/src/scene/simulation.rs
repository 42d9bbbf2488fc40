//! The scene of a simulation: struck and striking vehicle, the recorded motion, the impulse.

use std::sync::Arc;

use crate::scene::contact_force::contact_force;
use crate::scene::crush_outline::add_crush;
use crate::scene::dents::add_dents;
use crate::scene::{
    CarBody, CarLook, CarMotion, CarShape, Scene, SceneArrow, SceneCar, SceneCross, SceneLine,
    SceneMark, ScenePath, SceneRole,
};
use impactlab_core::collision::Pose;
use impactlab_core::data::{ForceAxes, TimeSeries};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};
use impactlab_core::vehicle::frames::world_from_body;
use impactlab_core::vehicle::{TireMark, tire_marks};
use impactlab_study::analysis::{Analysis, StruckVehicle, VehicleTrack};

/// Length of the arrow of an impulse that is as large as 4 m/s of a car's mass, m.
const ARROW_PER_SPEED_S: f64 = 0.75;
/// Shortest and longest arrow, m.
const ARROW_LENGTHS_M: [f64; 2] = [1.2, 5.0];

/// Another motion that is drawn beside the simulation: a variant of the case, or a recording.
#[derive(Debug, Clone, Copy)]
pub struct OtherMotion<'a> {
    /// Its name.
    pub name: &'a str,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// The motion.
    pub motion: &'a TimeSeries,
    /// Time of the scene at which the motion has its own time zero, s.
    pub offset_s: f64,
    /// The analysis whose car it is; that of the simulation if `None`.
    pub of: Option<&'a Analysis>,
}

/// What the scene of a simulation shows.
#[derive(Debug, Clone, Copy)]
pub struct SimulationScene<'a> {
    /// Motions, force and vehicles.
    pub analysis: &'a Analysis,
    /// Other motions beside it.
    pub others: &'a [OtherMotion<'a>],
    /// System of units of the labels.
    pub units: UnitSystem,
    /// What restricts the answer.
    pub caveats: &'a Caveats,
}

/// The scene of a simulation over its whole duration.
pub fn simulation_scene(input: &SimulationScene<'_>) -> Scene {
    let SimulationScene { analysis, others, units, caveats } = *input;
    let mut scene =
        Scene { title: analysis.name.clone(), units, caveats: caveats.clone(), ..Scene::default() };
    add_striking(&mut scene, analysis);
    let shape = struck_shape(analysis);
    if let Some(series) = &analysis.reference {
        let look = if analysis.simulation.is_some() { CarLook::Ghost } else { CarLook::Solid };
        let motion = CarMotion::from_series(series, &shape.body, None);
        let named =
            ["recorded", if look == CarLook::Solid { "struck, recorded" } else { "recorded" }];
        add(&mut scene, named, SceneRole::Recorded, look, &shape, motion);
    }
    for other in others {
        let shape = other.of.map_or_else(|| Arc::clone(&shape), struck_shape);
        let motion = CarMotion::from_series(other.motion, &shape.body, None);
        let motion = motion.map(|motion| motion.later_by(other.offset_s));
        add(&mut scene, [other.name, ""], other.role, CarLook::Ghost, &shape, motion);
    }
    if let Some(simulated) = &analysis.simulation {
        let controls = analysis.controlled();
        add_marks(&mut scene, &tire_marks(&simulated.series, controls));
        let motion = CarMotion::from_series(&simulated.series, &shape.body, Some(controls));
        let tag = if analysis.is_alone() { "car" } else { "struck" };
        let named = ["4DOF simulation", tag];
        add(&mut scene, named, SceneRole::Simulated, CarLook::Solid, &shape, motion);
    }
    scene.end_s = scene.struck().map_or(0.0, |car| car.motion.end_s());
    match analysis.pair {
        Some(_) => add_dents(&mut scene, analysis),
        None => add_crush(&mut scene, analysis),
    }
    scene.forces.extend(contact_force(analysis, units));
    scene.arrows.extend(impulse_arrow(analysis, units));
    scene.crosses.extend(analysis.second_contact.as_ref().map(|second| SceneCross {
        name: "second contact".to_owned(),
        at_m: second.point_m,
        time_s: second.time_s,
    }));
    scene
}

/// The meshes of the struck car.
pub(super) fn struck_shape(analysis: &Analysis) -> Arc<CarShape> {
    Arc::new(CarShape::new(CarBody::new(&analysis.vehicle, &analysis.footprint)))
}

/// The meshes of the striking car.
pub(super) fn striking_shape(track: &VehicleTrack) -> Arc<CarShape> {
    let (vehicle, footprint) = (&track.start.vehicle, &track.footprint);
    Arc::new(match vehicle.fixed {
        Some(object) => CarShape::of_fixed(object, CarBody::of_fixed(object, footprint)),
        None => CarShape::new(CarBody::new(vehicle, footprint)),
    })
}

/// Adds the striking vehicle, if it is known.
pub(super) fn add_striking(scene: &mut Scene, analysis: &Analysis) {
    let Some(track) = &analysis.striking else { return };
    let shape = striking_shape(track);
    let controls = track.controlled();
    add_marks(scene, &tire_marks(&track.motion, controls));
    let motion = CarMotion::from_series(&track.motion, &shape.body, Some(controls));
    let named = match track.start.vehicle.fixed {
        Some(object) => [object.word(); 2],
        None => ["striking vehicle", "striking"],
    };
    add(scene, named, SceneRole::Striking, CarLook::Solid, &shape, motion);
}

/// Adds marks of tires that are computed.
pub(super) fn add_marks(scene: &mut Scene, marks: &[TireMark]) {
    scene.marks.extend(marks.iter().map(|mark| SceneMark {
        name: "tire marks, computed".to_owned(),
        points: mark.points.clone(),
    }));
}

/// Adds a car with its path and where it starts, if it has a motion.
///
/// - `name`, `tag`: in the legend and beside the car.
pub(super) fn add(
    scene: &mut Scene,
    [name, tag]: [&str; 2],
    role: SceneRole,
    look: CarLook,
    shape: &Arc<CarShape>,
    motion: Option<CarMotion>,
) {
    let Some(motion) = motion.map(Arc::new) else { return };
    if let Some(start) = motion.states().first().filter(|_| look == CarLook::Solid) {
        scene.lines.push(SceneLine {
            name: String::new(),
            role,
            is_dashed: false,
            is_above_cars: false,
            points_m: outline_m(&shape.body, &start.pose),
        });
    }
    scene.paths.push(ScenePath {
        name: name.to_owned(),
        role,
        is_dashed: role.is_dashed(),
        has_ticks: true,
        motion: Arc::clone(&motion),
    });
    scene.cars.push(SceneCar {
        name: name.to_owned(),
        tag: tag.to_owned(),
        role,
        look,
        shape: Arc::clone(shape),
        motion,
    });
}

/// The outline of a car on the ground, with a chevron that points ahead, m.
pub(super) fn outline_m(body: &CarBody, pose: &Pose) -> Vec<[f64; 2]> {
    let (front, rear, side) = (body.front_m, body.rear_m(), body.width_m / 2.0);
    let shoulder = front - 0.15 * body.length_m;
    let corners = [
        [front, 0.0],
        [shoulder, side],
        [front, side],
        [rear, side],
        [rear, -side],
        [front, -side],
        [shoulder, -side],
        [front, 0.0],
        [front, side],
        [front, -side],
    ];
    corners.map(|corner| pose.world_from_body(corner)).to_vec()
}

/// The impulse on the struck vehicle as an arrow that ends where the force acts.
fn impulse_arrow(analysis: &Analysis, units: UnitSystem) -> Option<SceneArrow> {
    let (force, struck) = (analysis.force.as_ref()?, analysis.struck.as_ref()?);
    let StruckVehicle { vehicle, initial, contact, .. } = struck;
    let own = force.impulse_n_s();
    let impulse = match force.axes {
        ForceAxes::World => own,
        // The force turns with the vehicle; over the contact it hardly does.
        ForceAxes::Body => world_from_body(initial.yaw_rad, own),
    };
    let size = impulse[0].hypot(impulse[1]);
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let [shortest, longest] = ARROW_LENGTHS_M;
    let length_m = (ARROW_PER_SPEED_S * size / vehicle.mass.mass_kg).clamp(shortest, longest);
    let pose = Pose::from_state(initial);
    let tip = pose.world_from_body([contact.x_body_m, contact.y_body_m]);
    let back = length_m / size;
    let tail = [tip[0] - impulse[0] * back, tip[1] - impulse[1] * back];
    let of_first = if analysis.pair.is_some() { " of the first contact" } else { "" };
    let shown = NumberFormat::english(units).rough(Quantity::Impulse, size);
    Some(SceneArrow {
        name: format!("impulse on the struck vehicle{of_first}, {shown}"),
        role: SceneRole::Evidence,
        ends_m: [tail, tip],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::Scenario;
    use impactlab_core::vehicle::{Ending, Integrator, Preset, VehicleState};
    use impactlab_study::analysis::{
        DriveSetup, PulseSetup, Settings, analyse_drive, analyse_scenario,
    };

    fn settings() -> Settings {
        Settings {
            struck: Preset::Target.parameters(),
            striking: Preset::Bullet2000.parameters(),
            ending: Ending::default(),
            integrator: Integrator::Rk4,
            duration_s: 1.0,
            ends_at_rest: false,
            one_contact: false,
            friction_zones: Vec::new(),
        }
    }

    fn scene(analysis: &Analysis) -> Scene {
        let caveats = &Caveats::default();
        simulation_scene(&SimulationScene { analysis, others: &[], units: UnitSystem::Us, caveats })
    }

    /// “680.3 lbf s” and “up to 13168 lbf” stood in the legend, of a force that nobody has measured.
    #[test]
    fn impulse_and_force_have_two_digits_in_the_legend() {
        let scenario = Scenario::example();
        let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings()).unwrap();
        let scene = scene(&analysis);
        let names = scene.arrows.iter().map(|arrow| &arrow.name);
        let names: Vec<&String> = names.chain(scene.forces.iter().map(|of| &of.name)).collect();
        assert_eq!(names.len(), 2, "{names:?}");
        for name in names {
            let number = name.split(' ').rev().find(|word| word.parse::<f64>().is_ok()).unwrap();
            let digits = number.trim_start_matches(['0', '.']).trim_end_matches('0');
            let n_digits = digits.chars().filter(char::is_ascii_digit).count();
            assert!(n_digits <= 2, "{name}");
        }
        assert!(scene.cars.iter().any(|car| car.tag == "struck"));
    }

    /// A car that nothing strikes was tagged as struck.
    #[test]
    fn a_car_that_touches_nothing_is_no_struck_one() {
        let setup = DriveSetup {
            initial: VehicleState { vx_body_m_s: 20.0, ..VehicleState::default() },
            load: None,
            steer: None,
            wheels: None,
            notes: Vec::new(),
        };
        let analysis = analyse_drive("straight", setup, &settings()).unwrap();
        let scene = scene(&analysis);
        let tags: Vec<&str> = scene.cars.iter().map(|car| &*car.tag).collect();
        assert_eq!(tags, ["car"]);
    }
}
