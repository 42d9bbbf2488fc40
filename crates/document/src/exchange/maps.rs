//! A scene on a map: KML and GeoJSON, for a ground whose place on the earth is known.
//!
//! Written are the lanes, kerbs, zones, lines and points of the ground, and the paths of the cars, their
//! marks and lines and what was found, each with its role. What restricts the answer is the description of
//! the whole. Of paths GeoJSON has the times of the points. Outlines and pictures are not written.

use std::io::Write;

use crate::exchange::ExchangeError;
use crate::exchange::looks::role_name;
use crate::scene::{Scene, SceneRole};
use impactlab_core::site::{MapFeature, MapFormat, MapShape, map_file};

/// Writes a scene for a map.
///
/// # Errors
/// [`ExchangeError::Unknown`] for a ground of which latitude and longitude are not known; the error of the
/// operating system.
pub fn map(scene: &Scene, format: MapFormat, out: &mut dyn Write) -> Result<(), ExchangeError> {
    let geographic = scene.ground.as_ref().and_then(|ground| ground.geographic.as_ref());
    let geographic = geographic.ok_or_else(|| ExchangeError::Unknown {
        name: scene.title.clone(),
        what: "latitude and longitude of the ground ([origin] of the site file)",
    })?;
    let paths = scene.paths.iter().map(|path| {
        let is_place = |at: &[f64; 2]| at.iter().all(|value| value.is_finite());
        let states = path.motion.states().iter().map(|state| [state.pose.x_m, state.pose.y_m]);
        let (at_m, times_s): (Vec<_>, Vec<_>) =
            states.zip(path.motion.time_s().iter().copied()).filter(|(at, _)| is_place(at)).unzip();
        MapFeature { times_s, ..line("path", &path.name, path.role, at_m) }
    });
    let lines =
        scene.lines.iter().map(|of| line("scene_line", &of.name, of.role, of.points_m.clone()));
    let marks = scene.marks.iter().flat_map(|mark| {
        let pieces = mark.pieces();
        pieces.map(move |piece| {
            let at_m = piece.iter().map(|point| point.place_m).collect();
            line("tire_mark", &mark.name, SceneRole::TireMark, at_m)
        })
    });
    let points = scene.points.iter().map(|point| MapFeature {
        shape: MapShape::Point,
        ..line("scene_point", &point.name, point.role, vec![point.at_m])
    });
    let ground = geographic.features.iter().cloned();
    let found = paths.chain(lines).chain(marks).chain(points).filter(is_whole);
    let features: Vec<MapFeature> = ground.chain(found).collect();
    let restrictions = scene.caveats.in_units(scene.units).text();
    let title = (scene.title.as_str(), restrictions.as_deref());
    let text = map_file(format, title, &features, &geographic.frame);
    Ok(out.write_all(text.as_bytes())?)
}

/// Whether a feature has as many points as its shape needs.
fn is_whole(feature: &MapFeature) -> bool {
    match feature.shape {
        MapShape::Point => !feature.at_m.is_empty(),
        MapShape::Line | MapShape::Area => feature.at_m.len() > 1,
    }
}

fn line(kind: &'static str, name: &str, role: SceneRole, at_m: Vec<[f64; 2]>) -> MapFeature {
    let properties = vec![("role", role_name(role).to_lowercase())];
    MapFeature { properties, ..MapFeature::new(kind, name, MapShape::Line, at_m) }
}
