//! A forecast in the scene of a simulation: its draws as ghosts, its central path, density and regions.

use std::sync::Arc;

use crate::scene::simulation::{add, striking_shape, struck_shape};
use crate::scene::{
    CarLook, CarMotion, CarShape, Scene, SceneCar, SceneDensity, SceneLine, ScenePath, SceneRole,
};
use impactlab_core::collision::Pose;
use impactlab_core::vehicle::VehicleState;
use impactlab_networks::response::{MotionDistribution, STEP_S};
use impactlab_study::analysis::{Analysis, DensityMap, MotionForecast};

/// What a forecast adds to a scene.
#[derive(Debug, Clone, Copy)]
pub struct ForecastScene<'a> {
    /// The analysis whose struck vehicle the forecast is of.
    pub analysis: &'a Analysis,
    /// The forecast.
    pub forecast: &'a MotionForecast,
    /// Density of the position, with its regions; at an instant, or over a window.
    pub density: Option<&'a Arc<DensityMap>>,
    /// Time of a second contact, which is not computed, s: no density is shown after it.
    pub until_s: f64,
    /// How many of the draws of the forecast are shown as ghosts; all of them where there are fewer.
    pub n_ghosts: usize,
}

impl ForecastScene<'_> {
    /// How many draws are shown as ghosts unless somebody chooses.
    pub const N_GHOSTS: usize = 30;
}

/// Adds a forecast to the scene of its simulation.
pub fn add_forecast(scene: &mut Scene, input: &ForecastScene<'_>) {
    let shape = struck_shape(input.analysis);
    let chosen = |motion: &MotionDistribution| -> Vec<Vec<Pose>> {
        motion.draws().iter().take(input.n_ghosts).map(|states| poses(states)).collect()
    };
    let drawn = chosen(&input.forecast.distribution);
    let struck = ghosts(scene, &drawn, &shape, STRUCK_GHOSTS);
    let striking = input.forecast.both.as_ref().zip(input.analysis.striking.as_ref());
    let striking = striking.map(|(both, track)| {
        ghosts(scene, &chosen(&both.striking), &striking_shape(track), STRIKING_GHOSTS)
    });
    // Behind the cars that are there already.
    scene.cars.splice(0..0, striking.into_iter().flatten().chain(struck));
    if let Some(map) = input.density.filter(|map| map.window_s[1] <= input.until_s) {
        add_density(scene, map);
    }
    if let (Some(both), Some(track)) = (&input.forecast.both, &input.analysis.striking) {
        let shape = striking_shape(track);
        let motion = CarMotion::from_poses(&poses(&both.striking_central), STEP_S, &shape.body);
        let named = ["striking vehicle of the forecast", "forecast"];
        add(scene, named, SceneRole::Striking, CarLook::Ghost, &shape, motion);
    }
    let motion = CarMotion::from_poses(&poses(&input.forecast.central), STEP_S, &shape.body);
    let named = ["central path of the forecast", "forecast"];
    add(scene, named, SceneRole::Forecast, CarLook::Ghost, &shape, motion);
}

/// Name and role of the draws of each vehicle.
const STRUCK_GHOSTS: (&str, SceneRole) = ("draws of the forecast", SceneRole::Forecast);
const STRIKING_GHOSTS: (&str, SceneRole) = ("draws of the striking vehicle", SceneRole::Striking);

/// Adds the paths of draws, and gives their cars.
fn ghosts(
    scene: &mut Scene,
    drawn: &[Vec<Pose>],
    shape: &Arc<CarShape>,
    (name, role): (&str, SceneRole),
) -> Vec<SceneCar> {
    let mut ghosts = Vec::new();
    for poses in drawn {
        let Some(motion) = CarMotion::from_poses(poses, STEP_S, &shape.body).map(Arc::new) else {
            continue;
        };
        scene.paths.push(ScenePath {
            name: name.to_owned(),
            role: SceneRole::Muted,
            is_dashed: false,
            has_ticks: false,
            motion: Arc::clone(&motion),
        });
        ghosts.push(SceneCar {
            name: name.to_owned(),
            tag: String::new(),
            role,
            look: CarLook::Ghost,
            shape: Arc::clone(shape),
            motion,
        });
    }
    ghosts
}

fn poses(states: &[VehicleState<f64>]) -> Vec<Pose> {
    states.iter().map(Pose::from_state).collect()
}

/// Adds a density and the edges of its regions.
fn add_density(scene: &mut Scene, map: &Arc<DensityMap>) {
    let [from_s, to_s] = map.window_s;
    let when = match to_s > from_s {
        true => format!("{from_s:.2} to {to_s:.2} s"),
        false => format!("{to_s:.2} s"),
    };
    let name = format!("density of the CG, {when}");
    for region in &map.regions {
        let lines = region.outlines.iter().map(|points_m| SceneLine {
            name: format!("{:.0} % region", 100.0 * region.level),
            role: SceneRole::Forecast,
            is_dashed: region.level < 0.75,
            is_above_cars: true,
            points_m: points_m.clone(),
        });
        scene.lines.extend(lines);
    }
    let peak = map.values.iter().copied().fold(0.0, f64::max);
    if peak > 0.0 {
        scene.density = Some(SceneDensity { name, map: Arc::clone(map), peak });
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use crate::scene::{SimulationScene, simulation_scene};
    use impactlab_core::uncertainty::Caveats;
    use impactlab_core::units::UnitSystem;
    use impactlab_study::{
        Event, ForceSource, Library, MotionSource, PredictMotionRequest, Question,
    };

    #[test]
    fn ghosts_are_motions_of_the_forecast() {
        let dataset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/trajectories-fea");
        let source = MotionSource::Case { dataset, case: "FE_c002".to_owned() };
        let request = PredictMotionRequest::new(source, ForceSource::Given);
        let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap().complete().unwrap();
        let (analysis, forecast) = (&answer.analysis, &answer.forecast);
        let caveats = Caveats::default();
        let mut scene = simulation_scene(&SimulationScene {
            analysis,
            others: &[],
            units: UnitSystem::Si,
            caveats: &caveats,
        });
        let input = ForecastScene { analysis, forecast, density: None, until_s: 4.0, n_ghosts: 20 };
        add_forecast(&mut scene, &input);
        let is_ghost = |car: &&SceneCar| car.name == STRUCK_GHOSTS.0;
        let mut ends: Vec<Pose> = Vec::new();
        for ghost in scene.cars.iter().filter(is_ghost) {
            let shown: Vec<Pose> = ghost.motion.states().iter().map(|state| state.pose).collect();
            let is_shown = |states: &Vec<VehicleState<f64>>| poses(states) == shown;
            assert!(forecast.distribution.draws().iter().any(is_shown), "{shown:?}");
            ends.extend(shown.last().copied());
        }
        assert_eq!(ends.len(), 20);
        // No two are the same.
        for (i, end) in ends.iter().enumerate() {
            assert!(!ends[..i].contains(end), "{end:?}");
        }
    }
}
