use super::*;
use crate::vehicle::{
    Braking, DamagedWheel, Ending, FrictionZone, Integrator, Manoeuvre, Preset, VehicleState,
};

/// The marks of the reference car from a state, and its motion.
fn driven(
    ending: &Ending,
    initial: VehicleState<f64>,
    friction_zones: &[FrictionZone],
) -> (Vec<TireMark>, TimeSeries) {
    let vehicle = Preset::Reference.parameters();
    let controls = ending.controls(&vehicle);
    let manoeuvre = Manoeuvre {
        initial,
        controls: controls.clone(),
        duration_s: 8.0,
        ends_at_rest: true,
        friction_zones: friction_zones.to_vec(),
        ..Manoeuvre::default()
    };
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap().series;
    let vehicle_on_ground =
        ControlledVehicle { vehicle: &vehicle, controls: &controls, friction_zones };
    (tire_marks(&motion, vehicle_on_ground), motion)
}

fn braked(share: f64) -> Ending {
    Ending { brake: Some(Braking::new(0.5, share, 0.1)), ..Ending::default() }
}

#[test]
fn a_car_that_rolls_or_brakes_without_locking_leaves_no_mark() {
    for ending in [Ending::default(), braked(0.6)] {
        let (marks, _) = driven(&ending, VehicleState::driving_straight(20.0), &[]);
        assert_eq!(marks, []);
    }
}

#[test]
fn a_locked_stop_leaves_four_marks_from_where_it_locks_to_where_it_stands() {
    let (marks, motion) = driven(&braked(1.6), VehicleState::driving_straight(20.0), &[]);
    assert_eq!(marks.len(), 4);
    let end_m = *motion.require(Channel::X).unwrap().last().unwrap();
    let geometry = Preset::Reference.parameters().geometry;
    for mark in &marks {
        let wheel = mark.wheel;
        assert_eq!(mark.kind(), TireMarkKind::Locked, "{wheel:?}");
        let [first, last] = mark.ends().unwrap();
        // The force rises from 0.5 s to 0.6 s, and asks for more than the road holds on the way.
        assert!((0.52..0.62).contains(&first.time_s), "{wheel:?} from {} s", first.time_s);
        let [x, y] = geometry.wheel_place_m(wheel);
        let [off_x, off_y] = [end_m + x - last.place_m[0], y - last.place_m[1]];
        // At 1 m/s it stands within 0.1 m.
        assert!((0.0..0.15).contains(&off_x) && off_y.abs() < 1e-6, "{wheel:?}: {off_x}");
        let length_m = last.place_m[0] - first.place_m[0];
        assert!((mark.length_m() - length_m).abs() < 1e-6, "{wheel:?}");
    }
    // Braking loads the front.
    let middle = |mark: &TireMark| mark.points[mark.points.len() / 2];
    assert!(middle(&marks[0]).darkness > 1.2 * middle(&marks[2]).darkness);
}

#[test]
fn a_wheel_that_is_locked_by_damage_marks_alone() {
    let damage =
        vec![DamagedWheel { wheel: Wheel::RearLeft, start_s: 0.2, drag_share_of_friction: None }];
    let ending = Ending { damage, ..Ending::default() };
    let (marks, _) = driven(&ending, VehicleState::driving_straight(10.0), &[]);
    let wheels: Vec<Wheel> = marks.iter().map(|mark| mark.wheel).collect();
    assert_eq!(wheels, [Wheel::RearLeft]);
}

#[test]
fn a_spin_leaves_side_slip_marks_that_swing_with_the_car() {
    let initial = VehicleState { yaw_rate_rad_s: 3.0, ..VehicleState::driving_straight(15.0) };
    let (marks, motion) = driven(&Ending::default(), initial, &[]);
    let yaw_rad = motion.require(Channel::Yaw).unwrap().last().copied().unwrap();
    assert!(yaw_rad > 1.0, "it spins by {yaw_rad} rad");
    for wheel in Wheel::ALL {
        let longest = marks.iter().filter(|mark| mark.wheel == wheel);
        let longest = longest.max_by(|a, b| a.length_m().total_cmp(&b.length_m())).unwrap();
        assert_eq!(longest.kind(), TireMarkKind::SideSlip, "{wheel:?}");
        assert!(longest.length_m() > 3.0, "{wheel:?}: {} m", longest.length_m());
    }
    for point in marks.iter().flat_map(|mark| &mark.points) {
        assert!((0.0..=1.0).contains(&point.darkness), "{point:?}");
        assert!((0.05..0.3).contains(&point.width_m), "{point:?}");
    }
}

/// The striking car of a recording has neither velocities nor loads.
#[test]
fn marks_follow_from_poses_alone() {
    let initial = VehicleState { yaw_rate_rad_s: 3.0, ..VehicleState::driving_straight(15.0) };
    let (expected, motion) = driven(&Ending::default(), initial, &[]);
    let mut poses = TimeSeries::new(motion.time_s().to_vec()).unwrap();
    for channel in [Channel::X, Channel::Y, Channel::Yaw] {
        poses.insert(channel, motion.require(channel).unwrap().to_vec()).unwrap();
    }
    let (vehicle, controls) = (Preset::Reference.parameters(), crate::vehicle::Controls::default());
    let controlled =
        ControlledVehicle { vehicle: &vehicle, controls: &controls, friction_zones: &[] };
    let got = tire_marks(&poses, controlled);
    let length = |marks: &[TireMark]| marks.iter().map(TireMark::length_m).sum::<f64>();
    assert!((length(&got) / length(&expected) - 1.0).abs() < 0.05);
    assert_eq!(tire_marks(&TimeSeries::new(vec![0.0, 1.0]).unwrap(), controlled), []);
}

#[test]
fn on_ice_a_mark_is_fainter() {
    let ice = FrictionZone {
        name: "ice".to_owned(),
        border_m: vec![[-99.0, 0.0], [99.0, 0.0], [99.0, 9.0], [-99.0, 9.0]],
        friction: 0.1,
    };
    let initial = VehicleState::driving_straight(10.0);
    let (marks, _) = driven(&braked(1.6), initial, &[ice]);
    let first = |wheel: Wheel| {
        marks.iter().find(|mark| mark.wheel == wheel).map(|mark| mark.points[3].darkness).unwrap()
    };
    assert!(first(Wheel::FrontLeft) < 0.3 * first(Wheel::FrontRight));
}
