//! Which lanes, kerbs and zones of the ground the vehicles come to, over the draws of a forecast.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::MotionForecast;
use impactlab_core::collision::{Footprint, Pose};
use impactlab_core::site::Site;
use impactlab_core::vehicle::FrictionZone;

/// Every how many samples of a path its outline is looked at: at 30 m/s a vehicle goes 0.6 m in that time.
const STRIDE: usize = 2;

/// How likely the vehicles come to a lane, a kerb or a zone of friction of the site.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PlaceChance {
    /// What the site calls it; its number where it has no name.
    pub name: String,
    /// Whether the site gives it no name, so that the program did.
    #[serde(skip)]
    pub is_unnamed: bool,
    /// Whether a part of the struck vehicle is over it at first contact.
    pub struck_starts: bool,
    /// Probability that a part of the struck vehicle comes over it; 1 where it is over it at first contact.
    pub struck_enters: f64,
    /// Probability that a part of the struck vehicle is over it at the end.
    pub struck_ends: f64,
    /// Whether a part of the striking vehicle is over it at first contact.
    pub striking_starts: bool,
    /// Probability that a part of the striking vehicle comes over it, likewise.
    pub striking_enters: f64,
    /// Probability that a part of the striking vehicle is over it at the end.
    pub striking_ends: f64,
}

/// How likely the vehicles come to the lanes, kerbs and zones of friction of the site.
///
/// - `outlines`: those of the struck and of the striking vehicle;
/// - returns nothing where the draws of the forecast are not whole motions of both vehicles.
pub fn place_chances(
    site: &Site,
    forecast: &MotionForecast,
    outlines: [Footprint; 2],
) -> Vec<PlaceChance> {
    let Some(both) = &forecast.both else { return Vec::new() };
    let paths = [&forecast.paths, &both.striking_paths];
    let chance = |name: &str, fallback: String, is_over: &dyn Fn(&Footprint, &Pose) -> bool| {
        let over = |i: usize, pose: &Pose| is_over(&outlines[i], pose);
        let share = |i: usize, holds: &dyn Fn(&[Pose]) -> bool| {
            let n = paths[i].len().max(1) as f64;
            paths[i].iter().filter(|path| holds(path)).count() as f64 / n
        };
        let enters = |i| {
            share(i, &|path| {
                path.iter().step_by(STRIDE).chain(path.last()).any(|pose| over(i, pose))
            })
        };
        let ends = |i| share(i, &|path| path.last().is_some_and(|pose| over(i, pose)));
        // All draws begin at the same place.
        let starts = |i: usize| {
            let first = paths[i].first().and_then(|path| path.first());
            first.is_some_and(|pose| over(i, pose))
        };
        let is_unnamed = name.is_empty() || name == FrictionZone::UNNAMED;
        let name = if name.is_empty() { fallback } else { name.to_owned() };
        PlaceChance {
            name,
            is_unnamed,
            struck_starts: starts(0),
            struck_enters: enters(0),
            struck_ends: ends(0),
            striking_starts: starts(1),
            striking_enters: enters(1),
            striking_ends: ends(1),
        }
    };
    let lanes = site.lanes.iter().enumerate().map(|(i, lane)| {
        let border: Vec<[f64; 2]> =
            lane.left_m.iter().chain(lane.right_m.iter().rev()).copied().collect();
        chance(&lane.name, format!("lane {}", i + 1), &|of, pose| of.lies_over(pose, &border))
    });
    let kerbs = site.kerbs.iter().enumerate().map(|(i, kerb)| {
        chance(&kerb.name, format!("kerb {}", i + 1), &|of, pose| of.crosses(pose, &kerb.line_m))
    });
    let zones = site.friction_zones.iter().enumerate().map(|(i, zone)| {
        let fallback = format!("friction zone {}", i + 1);
        chance(&zone.name, fallback, &|of, pose| of.lies_over(pose, &zone.border_m))
    });
    lanes.chain(kerbs).chain(zones).collect()
}
