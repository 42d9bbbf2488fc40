//! A PIT with drivers and systems in both cars.

use crate::collision::contact::{
    ContactConditions, ContactOutline, CoupledSettings, PairMotion, PairVehicle, VehiclePair,
};
use crate::data::Channel;
use crate::vehicle::{
    Ending, LibraryVehicle, Manoeuvre, PitDriver, PitEnd, StabilityControl, VehicleParameters,
    VehicleState,
};

/// A car that drives at 20 m/s and one beside its rear, whose driver turns into it, for 3 s.
fn pit(endings: [&Ending; 2], distance_m: f64) -> PairMotion {
    let car = |id| LibraryVehicle::from_id(id).unwrap().parameters();
    let vehicles = [car("toyota-camry-2018"), car("ford-explorer-2020")];
    let outlines = vehicles.each_ref().map(|it| ContactOutline::from_vehicle(it).unwrap());
    let manoeuvre = |vehicle: &VehicleParameters, ending: &Ending, x_m, y_m| Manoeuvre {
        initial: VehicleState { x_m, y_m, ..VehicleState::driving_straight(20.0) },
        controls: ending.controls(vehicle),
        duration_s: 3.0,
        ..Manoeuvre::default()
    };
    let manoeuvres = [
        manoeuvre(&vehicles[0], endings[0], 0.0, 0.0),
        manoeuvre(&vehicles[1], endings[1], -3.6, distance_m),
    ];
    let of_pair =
        |i: usize| PairVehicle::by_class(&vehicles[i], &manoeuvres[i], &outlines[i]).unwrap();
    let conditions = ContactConditions::default();
    VehiclePair {
        vehicles: [of_pair(0), of_pair(1)],
        conditions,
        settings: CoupledSettings::default(),
    }
    .simulate()
    .unwrap()
}

fn column(motion: &PairMotion, vehicle: usize, channel: Channel) -> &[f64] {
    motion.motions[vehicle].series.require(channel).unwrap()
}

fn striking(end: PitEnd) -> Ending {
    // The striking car is to the left of the struck one and turns to the right.
    let driver = PitDriver {
        steering_wheel_rad: Some(-1.8),
        struck_turn_rad: Some(30_f64.to_radians()),
        end: Some(end),
        ..PitDriver::default()
    };
    Ending { pit: Some(driver), ..Ending::default() }
}

#[test]
fn the_striking_driver_lets_go_when_the_struck_car_has_turned() {
    let coasts = Ending::default();
    let [pushing, braking] =
        [PitEnd::KeepPushing, PitEnd::Brake].map(|end| pit([&coasts, &striking(end)], 2.3));
    let yaw = column(&braking, 0, Channel::Yaw);
    let turned = yaw.iter().position(|yaw| yaw.abs() >= 30_f64.to_radians()).unwrap();
    let steer = column(&braking, 1, Channel::SteerFl);
    let full_rad = -1.8 / 16.0;
    assert!((steer[turned - 1] - full_rad).abs() < 1e-12, "{} rad", steer[turned - 1]);
    assert!(steer[turned] > full_rad, "it sees the turn at the instant at which it stands");
    assert_eq!(steer[turned + 60], 0.0);
    assert_eq!(
        column(&braking, 0, Channel::Yaw)[..=turned],
        column(&pushing, 0, Channel::Yaw)[..=turned]
    );
    assert!((column(&pushing, 1, Channel::SteerFl).last().unwrap() - full_rad).abs() < 1e-12);
    let speed = |motion| *column(motion, 1, Channel::Vx).last().unwrap();
    assert!(speed(&braking) < speed(&pushing) - 3.0);
}

#[test]
fn a_struck_car_with_stability_control_turns_less_and_without_contact_not_at_all() {
    let esc = Ending { esc: Some(StabilityControl::default()), ..Ending::default() };
    let turned = |ending: &Ending, distance_m| {
        let motion = pit([ending, &striking(PitEnd::Brake)], distance_m);
        column(&motion, 0, Channel::Yaw).iter().fold(0.0, |most: f64, yaw| most.max(yaw.abs()))
    };
    let [alone, controlled] = [Ending::default(), esc.clone()].map(|ending| turned(&ending, 2.3));
    assert!(controlled < alone - 0.02, "{controlled} {alone} rad");
    assert!(turned(&esc, 30.0) < 1e-12);
}
