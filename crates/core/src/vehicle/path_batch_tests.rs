use super::*;
use crate::data::{ForceAxes, ForceHistory, Sampling};
use crate::vehicle::{
    Braking, ContactLoad, ContactPoint, DamagedWheel, Ending, HeldSteer, Manoeuvre, Preset,
    VehicleParameters, Wheel,
};

/// A struck car at 12 to 30 m/s that coasts, brakes, or has a locked wheel or a turned one.
fn manoeuvres(vehicle: &VehicleParameters) -> Vec<Manoeuvre> {
    let brake = |share_of_friction| Some(Braking::new(0.8, share_of_friction, 0.3));
    let locked =
        DamagedWheel { wheel: Wheel::RearRight, start_s: 0.03, drag_share_of_friction: None };
    let steer = Some(HeldSteer { start_s: 0.1, rise_s: 0.3, road_wheel_rad: 0.03 });
    let endings = [
        Ending { brake: brake(0.3), ..Ending::default() },
        Ending { brake: brake(1.5), ..Ending::default() },
        Ending { damage: vec![locked], ..Ending::default() },
        Ending { brake: brake(0.6), steer, ..Ending::default() },
    ];
    (0..24)
        .map(|i| {
            let speed = 12.0 + f64::from(i % 6) * 3.5;
            let force = ForceHistory {
                axes: ForceAxes::World,
                sampling: Sampling::Instant,
                time_s: vec![0.0, 0.05, 0.1],
                fx_n: vec![0.0, 8e3, 0.0],
                fy_n: vec![0.0, 4e4 + 2e3 * f64::from(i), 0.0],
                mz_n_m: None,
            };
            let contact = ContactPoint { x_body_m: -1.6, y_body_m: -0.9, height_m: 0.55 };
            Manoeuvre {
                initial: VehicleState::driving_straight(speed),
                contact_load: Some(ContactLoad { force, contact, recorded_moment: false }),
                controls: endings[i as usize % 4].controls(vehicle),
                duration_s: 30.0,
                ends_at_rest: true,
                friction_zones: Vec::new(),
            }
        })
        .collect()
}

#[test]
fn a_path_ends_where_the_reference_steps_end() {
    let vehicle = Preset::Reference.parameters().with_friction(0.75);
    let manoeuvres = manoeuvres(&vehicle);
    let runs: Vec<SimulationRun<'_>> =
        manoeuvres.iter().map(|manoeuvre| SimulationRun { vehicle: &vehicle, manoeuvre }).collect();
    let limit = PathLimit { distance_m: 1e4 };
    let paths = simulate_paths(&runs, limit, |_, path| path);
    for (i, (run, path)) in runs.iter().zip(&paths).enumerate() {
        let reference = run.vehicle.simulate(run.manoeuvre, Integrator::Rk4).unwrap();
        let end = |channel| *reference.series.require(channel).unwrap().last().unwrap();
        use crate::data::Channel as C;
        let last = path.points.last().unwrap();
        assert_eq!(path.end, PathEnd::Rest, "run {i}");
        let off_m = (last.x_m - end(C::X)).hypot(last.y_m - end(C::Y));
        let off_rad = (last.yaw_rad - end(C::Yaw)).abs();
        assert!(off_m < 0.03 && off_rad < 0.01, "run {i}: {off_m} m, {off_rad} rad");
    }
}

#[test]
fn a_path_does_not_depend_on_those_beside_it() {
    let vehicle = Preset::Reference.parameters().with_friction(0.75);
    let manoeuvres = manoeuvres(&vehicle);
    let runs: Vec<SimulationRun<'_>> =
        manoeuvres.iter().map(|manoeuvre| SimulationRun { vehicle: &vehicle, manoeuvre }).collect();
    let limit = PathLimit { distance_m: 40.0 };
    let together = simulate_paths(&runs, limit, |_, path| path);
    for (i, run) in runs.iter().enumerate() {
        let alone = simulate_paths(std::slice::from_ref(run), limit, |_, path| path);
        assert_eq!(alone[0], together[i], "run {i}");
        let last = alone[0].points.last().unwrap();
        assert_eq!(alone[0].end == PathEnd::Far, last.x_m.hypot(last.y_m) > 40.0, "run {i}");
    }
}
