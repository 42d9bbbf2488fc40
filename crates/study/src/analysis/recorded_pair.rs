//! Analysis of a recorded pair: both vehicles from their recorded starts, with what their drivers did,
//! through all contacts.

use crate::analysis::scenario::analysis;
use crate::analysis::{Analysis, AnalysisError, ContactPair, Settings, StruckVehicle};
use impactlab_core::collision::Footprint;
use impactlab_core::collision::contact::ContactConditions;
use impactlab_core::compare::{MotionError, PairCase};
use impactlab_core::vehicle::ContactPoint;

/// Follows both vehicles of a recorded pair, with the contact law at its medians from the start on. The
/// recorded motion of the struck vehicle is the reference.
///
/// - `settings`: the two vehicles and the zones of the ground; all else is the case's.
///
/// # Errors
/// [`AnalysisError`] if a motion diverges or a vehicle has no outline.
pub fn analyse_recorded_pair(
    case: &PairCase,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let usual_m = ContactConditions::default().height_m;
    let height_m = case.contact_height_m.unwrap_or(usual_m);
    let [x_body_m, y_body_m] = case.contact.place_m.unwrap_or_default();
    let vehicles = [&settings.struck, &settings.striking];
    let start = |i: usize| StruckVehicle {
        vehicle: vehicles[i].clone(),
        initial: case.manoeuvres[i].initial,
        contact: ContactPoint { x_body_m, y_body_m, height_m },
        controls: case.manoeuvres[i].controls.clone(),
        friction_zones: settings.friction_zones.clone(),
    };
    let [struck, striking] = [start(0), start(1)];
    let pair = ContactPair::new([&struck, &striking])?;
    let duration_s = case.manoeuvres[0].duration_s;
    let settings = Settings { duration_s, ends_at_rest: false, ..settings.clone() };
    let moved = pair.simulate([&struck, &striking], None, &settings)?;
    let [motion, striking_motion] = moved.motions;
    let error = MotionError::between(&motion.series, &case.motions[0])?;
    let outlines = vehicles.map(|vehicle| Footprint::from(&vehicle.geometry));
    Ok(Analysis {
        name: case.name.clone(),
        phases: moved.phases,
        dents_m: moved.dents_m,
        pair: Some(pair),
        reference: Some(case.motions[0].clone()),
        error: Some(error),
        ..analysis(struck, striking, outlines, None, motion, striking_motion)
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use impactlab_core::compare::PairRecords;
    use impactlab_core::vehicle::Preset;

    #[test]
    fn a_recorded_pair_has_both_motions_their_contacts_and_the_record_beside() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/pairs"));
        let case = PairRecords::open(root).unwrap().load("d041").unwrap().unwrap();
        let [struck, striking] = case.vehicles.clone();
        let settings = Settings {
            struck,
            striking,
            duration_s: 1.0,
            ends_at_rest: true,
            ..Settings::of_preset(Preset::Target)
        };
        let analysis = analyse_recorded_pair(&case, &settings).unwrap();
        let motion = analysis.simulation.unwrap().series;
        let end_s = *case.motions[0].time_s().last().unwrap();
        assert!((motion.time_s().last().unwrap() - end_s).abs() < 0.02, "as long as the record");
        assert_eq!(analysis.reference.as_ref(), Some(&case.motions[0]));
        assert!(analysis.error.unwrap().average_error_m < 3.0);
        assert!(!analysis.phases.is_empty() && analysis.force.is_none());
        let striking = analysis.striking.unwrap();
        assert_eq!(striking.motion.time_s(), motion.time_s());
        assert_eq!(striking.start.initial, case.manoeuvres[1].initial);
    }
}
