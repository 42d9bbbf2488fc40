//! Analysis of the cases of force and trajectory data sets.

use crate::analysis::{Analysis, AnalysisError, Settings, StruckVehicle, striking::striking_track};
use impactlab_core::collision::{Footprint, SecondContact};
use impactlab_core::compare::{MotionError, ReplayError, recorded_manoeuvre};
use impactlab_core::data::{
    Case, DatasetKind, ForceAttributes, TrajectoryAttributes, check_contact_within,
    contact_interval,
};
use impactlab_core::vehicle::{ContactLoad, ContactPoint, Manoeuvre, VehicleState};

/// Analyses a case of a force or a trajectory data set.
///
/// # Errors
/// [`AnalysisError`] if an attribute or a column is missing or the motion diverges.
pub fn analyse_case(case: &Case, settings: &Settings) -> Result<Analysis, AnalysisError> {
    match case.kind {
        DatasetKind::Trajectory => analyse_trajectory_case(case, settings),
        DatasetKind::Force => analyse_force_case(case, settings),
    }
}

/// Replays a recorded trajectory from its initial state with its recorded force and friction; where
/// friction zones are given, these hold instead.
fn analyse_trajectory_case(case: &Case, settings: &Settings) -> Result<Analysis, AnalysisError> {
    let recorded = recorded_manoeuvre(case, &settings.struck)?;
    let manoeuvre = Manoeuvre { friction_zones: settings.friction_zones.clone(), ..recorded };
    let friction = TrajectoryAttributes::read(&case.attributes)?.mu;
    let vehicle = settings.struck.clone().with_friction(friction);
    let name = || case.name.clone();
    let motion = vehicle
        .simulate(&manoeuvre, settings.integrator)
        .map_err(|source| ReplayError::Simulation { case: name(), source })?;
    let error = MotionError::between(&motion.series, &case.series)
        .map_err(|source| ReplayError::Series { case: name(), source })?;
    let struck = |load: &ContactLoad| StruckVehicle {
        vehicle: vehicle.clone(),
        initial: manoeuvre.initial,
        contact: load.contact,
        controls: manoeuvre.controls.clone(),
        friction_zones: manoeuvre.friction_zones.clone(),
    };
    Ok(Analysis {
        name: case.name.clone(),
        footprint: Footprint::from(&settings.struck.geometry),
        struck: manoeuvre.contact_load.as_ref().map(struck),
        controls: manoeuvre.controls.clone(),
        has_stability_control: manoeuvre.controls.has_stability_control(),
        friction_zones: settings.friction_zones.clone(),
        force: manoeuvre.contact_load.map(|load| load.force),
        vehicle,
        simulation: Some(motion),
        reference: Some(case.series.clone()),
        pair: None,
        phases: Vec::new(),
        dents_m: Default::default(),
        second_contact: None,
        striking: None,
        error: Some(error),
        notes: Vec::new(),
    })
}

/// Simulates the struck vehicle of a force case from the origin, heading along X, with the case's
/// velocities and yaw rate and under the recorded force and yaw moment. The force acts at the height of the CG
/// if the case gives no contact height.
fn analyse_force_case(case: &Case, settings: &Settings) -> Result<Analysis, AnalysisError> {
    let attributes = ForceAttributes::read(&case.attributes)?;
    let force = case.force_history()?;
    check_contact_within(&force, settings.duration_s)?;
    let [mass_kg, _] = attributes.mass_kg;
    let [yaw_inertia, _] = attributes.yaw_inertia_kg_m2;
    let vehicle = settings.struck.clone().with_mass(mass_kg, yaw_inertia);
    let [vx_body_m_s, vy_body_m_s] = attributes.struck_velocity_m_s;
    let [x_body_m, y_body_m] = attributes.contact_m;
    let height_m = attributes.contact_height_m.unwrap_or(vehicle.geometry.cg_height_m);
    let contact = ContactPoint { x_body_m, y_body_m, height_m };
    let load = ContactLoad { force: force.clone(), contact, recorded_moment: true };
    let [yaw_rate_rad_s, _] = attributes.yaw_rate_rad_s;
    let initial =
        VehicleState { vx_body_m_s, vy_body_m_s, yaw_rate_rad_s, ..VehicleState::default() };
    let controls = settings.ending.controls(&vehicle);
    let manoeuvre = Manoeuvre {
        initial,
        contact_load: Some(load),
        controls: controls.clone(),
        duration_s: settings.duration_s,
        ends_at_rest: settings.ends_at_rest,
        friction_zones: settings.friction_zones.clone(),
    };
    let motion = vehicle.simulate(&manoeuvre, settings.integrator)?;
    let footprint = Footprint::from(&vehicle.geometry);
    let striking = striking_track(case, &attributes, settings)?;
    let end_s = contact_interval(&force).map_or(0.0, |(_, end_s)| end_s);
    let second_contact = striking.as_ref().and_then(|striking| {
        SecondContact::find(
            (footprint, &motion.series),
            (striking.footprint, &striking.motion),
            end_s,
        )
    });
    let mut notes = Vec::new();
    if attributes.separated == Some(false) {
        notes.push("still in contact when the run ended: the force is cut there".to_owned());
    }
    Ok(Analysis {
        name: case.name.clone(),
        footprint,
        controls: motion.applied_controls.clone().unwrap_or_else(|| controls.clone()),
        has_stability_control: controls.has_stability_control(),
        simulation: Some(motion),
        vehicle: vehicle.clone(),
        force: Some(force),
        friction_zones: settings.friction_zones.clone(),
        struck: Some(StruckVehicle {
            vehicle,
            initial,
            contact,
            controls,
            friction_zones: settings.friction_zones.clone(),
        }),
        reference: None,
        pair: None,
        phases: Vec::new(),
        dents_m: Default::default(),
        second_contact,
        striking,
        error: None,
        notes,
    })
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use impactlab_core::data::{Channel, Dataset};
    use impactlab_core::vehicle::Preset;
    use impactlab_core::vehicle::frames::world_from_body;

    fn load(name: &str) -> Dataset {
        let mut report = |_| ControlFlow::Continue(());
        Dataset::load(
            &Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets")).join(name),
            &mut report,
        )
        .unwrap()
        .complete()
        .unwrap()
    }

    #[test]
    fn on_ice_a_finite_element_case_ends_with_the_recorded_motion() {
        // The finite-element runs have no tires, so that the 4DOF model without friction must
        // reproduce them.
        let dataset = load("fea-wide");
        let mut settings = Settings::of_preset(Preset::Target);
        let struck = &mut settings.struck;
        struck.tires.friction = 1e-9;
        struck.tires.rolling_resistance = 0.0;
        struck.mass.roll_yaw_product_kg_m2 = 0.0;
        for case in dataset.cases.iter().step_by(9) {
            let analysis = analyse_case(case, &settings).unwrap();
            let recorded = |name| case.attributes.number(name).unwrap();
            let motion = analysis.simulation.unwrap().series;
            let last = |channel| *motion.require(channel).unwrap().last().unwrap();
            let body = [last(Channel::Vx), last(Channel::Vy)];
            let [vx, vy] = world_from_body(last(Channel::Yaw), body);
            for (name, got, expected) in [
                ("v_x", vx, recorded("target_vx_end_m_s")),
                ("v_y", vy, recorded("target_vy_end_m_s")),
                ("r", last(Channel::YawRate), recorded("target_yaw_rate_end_rad_s")),
            ] {
                assert!((got - expected).abs() < 0.01, "{} {name}: {got} {expected}", case.name);
            }
            let striking = analysis.striking.unwrap().motion;
            let end = case.series.n_samples() - 1;
            let yaw = striking.require(Channel::Yaw).unwrap()[end];
            assert!((yaw - recorded("bullet_yaw_end_rad")).abs() < 1e-3, "{}: {yaw}", case.name);
        }
    }

    #[test]
    fn a_trajectory_case_has_reference_and_error() {
        let dataset = load("trajectories-pulse");
        let analysis =
            analyse_case(&dataset.cases[0], &Settings::of_preset(Preset::Reference)).unwrap();
        assert!(analysis.reference.is_some());
        assert!(analysis.error.unwrap().average_error_m < 1.0);
    }
}
