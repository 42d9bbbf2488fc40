//! The outlines of two cars, dented where they overlap most, from then on.
//!
//! The time is that of the largest overlap of the rigid outlines while the force acts; where the overlap
//! still grows when the force ends, it is that end, and the name says so. Each car takes half
//! of the penetration (see [`DentedOutlines`]), so that the lines say where damage is to be looked for, and
//! not how deep it is.

use std::sync::Arc;

use crate::scene::{CarBody, Scene, SceneCar, SceneCrush, SceneRole};
use impactlab_core::collision::{DentedOutlines, Footprint, MovingFootprint, Pose, overlap_m};
use impactlab_core::data::contact_interval;
use impactlab_study::analysis::Analysis;

/// Interval at which the overlap is looked at, s, and how often at most.
const STEP_S: f64 = 1e-3;
const MAX_STEPS: f64 = 2000.0;
/// Overlap below which no dent is drawn, m.
const LEAST_OVERLAP_M: f64 = 0.02;
/// Share of the penetration that the struck car takes.
const STRUCK_SHARE: f64 = 0.5;

/// Adds the dented outlines of struck and striking car, if their outlines overlap while the force acts.
pub(super) fn add_crush(scene: &mut Scene, analysis: &Analysis) {
    let contact = analysis.force.as_ref().and_then(contact_interval);
    let struck = scene.cars.iter().find(|car| car.role == SceneRole::Simulated);
    let (Some((start_s, end_s)), Some(struck), Some(striking)) =
        (contact, struck, scene.striking())
    else {
        return;
    };
    let cars = [struck, striking];
    let footprints = cars.map(|car| footprint(&car.shape.body));
    let Some((time_s, poses)) = largest_overlap(cars, &footprints, start_s, end_s) else { return };
    let [of_struck, of_striking] = &footprints;
    let dented =
        DentedOutlines::new([(of_struck, &poses[0]), (of_striking, &poses[1])], STRUCK_SHARE);
    let Some(DentedOutlines { dent_m, outlines_m }) = dented else { return };
    let when = match end_s - time_s > STEP_S / 2.0 {
        true => format!("at the largest overlap, at {time_s:.3} s"),
        false => {
            format!("at the end of the force, at {time_s:.3} s, where the overlap still grows")
        }
    };
    let crushes = cars.iter().zip(&poses).zip(outlines_m).map(|((car, pose), outline_m)| {
        let in_body = |line: &[[f64; 2]]| line.iter().map(|at| pose.body_from_world(*at)).collect();
        SceneCrush {
            name: format!("crush outlines {when}: rigid outlines, half each"),
            from_s: time_s,
            outline_m: in_body(&outline_m),
            dent_m: in_body(&dent_m),
            motion: Arc::clone(&car.motion),
        }
    });
    let crushes: Vec<SceneCrush> = crushes.collect();
    scene.crushes.extend(crushes);
}

fn footprint(body: &CarBody) -> Footprint {
    Footprint { length_m: body.length_m, width_m: body.width_m, cg_from_front_m: body.front_m }
}

/// When the outlines overlap most, and where the cars are then; `None` if they hardly do.
fn largest_overlap(
    cars: [&SceneCar; 2],
    footprints: &[Footprint; 2],
    start_s: f64,
    end_s: f64,
) -> Option<(f64, [Pose; 2])> {
    let n_steps = ((end_s - start_s) / STEP_S).ceil().clamp(1.0, MAX_STEPS) as usize;
    let mut largest: Option<(f64, f64, [Pose; 2])> = None;
    for step in 0..=n_steps {
        let time_s = start_s + (end_s - start_s) * step as f64 / n_steps as f64;
        let poses = cars.map(|car| car.at(time_s).pose);
        let [struck, striking] = [0, 1].map(|i| MovingFootprint::at_rest(footprints[i], poses[i]));
        let depth_m = overlap_m(&struck, &striking);
        if largest.as_ref().is_none_or(|(most_m, ..)| depth_m > *most_m) {
            largest = Some((depth_m, time_s, poses));
        }
    }
    largest
        .filter(|(depth_m, ..)| *depth_m >= LEAST_OVERLAP_M)
        .map(|(_, time_s, poses)| (time_s, poses))
}
