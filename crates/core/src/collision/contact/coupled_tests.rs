//! Tests of two vehicles with the contact force between them: closed forms, conservation, symmetry,
//! energy, steps and elements.

use proptest::prelude::*;

use super::*;
use crate::collision::Footprint;
use crate::collision::contact::CoupledSettings;
use crate::collision::contact::test_pairs::{
    TestCar, alike, free_body, last_state, mirrored, on_level_tires, pit_manoeuvre, simulate,
    state_at,
};
use crate::collision::contact::{FaceLaw, FaceLaws, FaceParameters, Recovery};
use crate::data::Channel;
use crate::vehicle::{DrivenAxle, Driving, Ending, Integrator, Manoeuvre, SimulationError};

const UNDAMPED: ContactConditions =
    ContactConditions { friction: 0.4, damping_s_m: 0.0, height_m: 0.5 };

const BOX: Footprint = Footprint { length_m: 4.2, width_m: 1.6, cg_from_front_m: 2.0 };

/// A car of 1500 kg that stands, struck from behind by one of 1200 kg with 12 m/s.
fn collinear(laws: [FaceLaw; 2], width_m: f64) -> [TestCar; 2] {
    let footprint = Footprint { width_m, ..BOX };
    let behind_m = -(footprint.length_m - footprint.cg_from_front_m) - footprint.cg_from_front_m;
    let car = |mass_kg, law, x_m, vx_body_m_s| {
        let initial = VehicleState { x_m, vx_body_m_s, ..VehicleState::default() };
        TestCar::new(free_body(mass_kg, 2500.0, footprint), [0.0, 0.1], alike(law), initial)
    };
    [car(1500.0, laws[0], 0.0, 0.0), car(1200.0, laws[1], behind_m, 12.0)]
}

/// What a collinear contact gives: sum of the greatest deflections and that of the struck car, m;
/// duration, s; peak, N; impulse, N s; restitution; loss, J.
fn collinear_results(cars: &[TestCar; 2], share: f64, step_divisor: usize) -> [f64; 7] {
    let motion = simulate([&cars[0], &cars[1]], UNDAMPED, step_divisor).unwrap();
    let [phase] = motion.phases[..] else { panic!("{:?}", motion.phases) };
    let deflections = [0, 1]
        .map(|i: usize| motion.dents_m[i].iter().copied().fold(0.0, f64::max) / (1.0 - share));
    let [struck, striking] = motion.motions.each_ref().map(last_state);
    let energy = &motion.energy;
    // Nothing but the faces takes energy.
    assert!(energy.friction_heat_j.abs() < 1e-6 && energy.stored_j.abs() < 1e-9, "{energy:?}");
    [
        deflections[0] + deflections[1],
        deflections[0],
        phase.end_s.unwrap() - phase.start_s,
        phase.peak_force_n,
        phase.impulse_world_n_s[0],
        (struck.vx_body_m_s - striking.vx_body_m_s) / 12.0,
        energy.absorbed_j,
    ]
}

fn assert_near(got: [f64; 7], expected: [f64; 7], tolerances: [f64; 7], label: &str) {
    for (i, ((got, expected), tolerance)) in
        got.into_iter().zip(expected).zip(tolerances).enumerate()
    {
        let off = (got / expected - 1.0).abs();
        assert!(off < tolerance, "{label}, number {i}: {got}, expected {expected}, off {off:.2e}");
    }
}

/// δ_max = v₀ √(m/k), t = (π/2)(1 + √ρ) √(m/k), e = √ρ, J = (1 + e) m v₀, with the reduced mass m.
#[test]
fn linear_springs_follow_their_closed_form() {
    let share = 0.0302;
    let recovery = Recovery::constant(share);
    let laws = [1.6e6, 1.0e6].map(|k| FaceLaw::linear(k / BOX.width_m, recovery).unwrap());
    let cars = collinear(laws, BOX.width_m);
    let expected = [0.394_97, 0.151_91, 60.686e-3, 243.06e3, 9390.3, 0.173_78, 46.55e3];
    // The numbers are printed with five digits. The duration is a whole number of steps, one of which
    // may be lost at either end.
    let usual = [1e-4, 1e-4, 1.2e-2, 1e-4, 1e-4, 5e-4, 1e-4];
    assert_near(collinear_results(&cars, share, 1), expected, usual, "usual steps");
    let fine = [3e-5, 3e-5, 1e-3, 3e-5, 3e-5, 5e-5, 3e-5];
    assert_near(collinear_results(&cars, share, 16), expected, fine, "steps divided by 16");
}

/// ω = √(w B/m), δ_max = −A/B + √((A/B)² + (v₀/ω)²), t_load = atan(v₀ B/(ω A))/ω. Two equal faces in
/// series with twice the B have the law of one.
#[test]
fn crush_without_elastic_branch_follows_its_closed_form() {
    let (width_m, share) = (1.2, 0.03);
    let law = FaceLaw::new(FaceParameters {
        onset_n_per_m: 34e3,
        stiffness_n_per_m2: 2.0 * 0.45e6,
        elastic_depth_m: 0.0,
        saturation_depth_m: f64::INFINITY,
        recovery: Recovery::constant(share),
    })
    .unwrap();
    let cars = collinear([law; 2], width_m);
    let unload_s = share * 0.3528 / 12.0 / 0.159_69 * std::f64::consts::FRAC_PI_2;
    let loss_j = 0.5 * (2000.0 / 3.0) * 144.0 * (1.0 - 0.159_69_f64.powi(2));
    let expected = [0.3528, 0.1764, 48.962e-3 + unload_s, 231.31e3, 9277.5, 0.159_69, loss_j];
    let usual = [1e-4, 1e-4, 1.2e-2, 1e-4, 1e-4, 2e-4, 1e-4];
    assert_near(collinear_results(&cars, share, 1), expected, usual, "usual steps");
    let fine = [3e-5, 3e-5, 1e-3, 3e-5, 3e-5, 1e-4, 3e-5];
    assert_near(collinear_results(&cars, share, 16), expected, fine, "steps divided by 16");
}

#[test]
fn a_steady_push_accelerates_both_cars_and_its_work_is_accounted_for() {
    let footprint = Footprint { length_m: 4.4, width_m: 1.8, cg_from_front_m: 2.1 };
    let mut cars = [(1500.0, 0.0, 5.0), (1800.0, -4.5, 6.0)].map(|(mass_kg, x_m, speed_m_s)| {
        let vehicle = on_level_tires(mass_kg, 2600.0, footprint);
        let faces = FaceLaws::by_class(&vehicle).unwrap();
        let initial = VehicleState { x_m, ..VehicleState::driving_straight(speed_m_s) };
        TestCar::new(vehicle, [0.25, 0.08], faces, initial)
    });
    let torque_n_m = 1500.0;
    let drive = Driving { torque_n_m, axle: DrivenAxle::Front, start_s: 0.0, rise_s: 0.01 };
    let ending = Ending { drive: Some(drive), ..Ending::default() };
    cars[1].manoeuvre.controls = ending.controls(&cars[1].vehicle);
    for car in &mut cars {
        car.manoeuvre.duration_s = 5.0;
    }
    let motion = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
    // Blows part the cars for ever shorter moments; then the push does not end.
    let (first, last) = (motion.phases.first().unwrap(), motion.phases.last().unwrap());
    assert!(first.start_s < 0.11 && first.end_s.is_some(), "{:?}", motion.phases);
    assert!(last.start_s < 3.0 && last.end_s.is_none(), "{:?}", motion.phases);
    let force_n = torque_n_m / cars[1].vehicle.tires.rolling_radius_m;
    let expected = force_n / (1500.0 + 1800.0);
    for (i, motion) in motion.motions.iter().enumerate() {
        let [from, to] = [300, 500].map(|sample| state_at(motion, sample).vx_body_m_s);
        let got = (to - from) / 2.0;
        assert!((got / expected - 1.0).abs() < 2e-3, "car {i}: {got} m/s², expected {expected}");
        let forces_n = &motion.series.require(Channel::FxBody).unwrap()[300..500];
        let pushed_n = forces_n.iter().sum::<f64>() / 200.0;
        let share = if i == 0 { 1500.0 } else { -1500.0 };
        assert!((pushed_n / (share * expected) - 1.0).abs() < 5e-3, "car {i}: {pushed_n} N");
    }
    let energies = |sample| -> f64 {
        let of_car = |i: usize| cars[i].momentum(&state_at(&motion.motions[i], sample))[3];
        of_car(0) + of_car(1)
    };
    let way_m = state_at(&motion.motions[1], 500).x_m - state_at(&motion.motions[1], 0).x_m;
    let gained_j = energies(500) - energies(0);
    let absorbed_j = motion.energy.absorbed_j;
    // The force rises over the first 10 ms, which 5 ms of the way at 6 m/s lack.
    let driven_j = force_n * (way_m - 0.005 * 6.0);
    let off = (driven_j - gained_j - absorbed_j) / driven_j;
    assert!(off.abs() < 1e-4, "{driven_j} J driven, {gained_j} gained, {absorbed_j} absorbed");
    let energy = &motion.energy;
    assert!(energy.crush_heat_j > 100.0 && energy.friction_heat_j >= 0.0, "{energy:?}");
    // What is not accounted for is of first order in the step.
    let fine = simulate([&cars[0], &cars[1]], ContactConditions::default(), 4).unwrap().energy;
    let residuals_j = [energy, &fine].map(|energy| energy.residual_j().abs());
    assert!(residuals_j[0] < 0.06 * absorbed_j, "{energy:?}");
    assert!(residuals_j[1] < 0.4 * residuals_j[0], "{energy:?}, {fine:?}");
}

/// Two cars without tires that meet, in any direction.
#[derive(Debug, Clone)]
struct Meeting {
    /// Mass, kg; yaw inertia, kg m²; length and width, m; yaw angle, rad; yaw rate, rad/s.
    cars: [[f64; 6]; 2],
    /// Bearing of the second car from the first one, rad; velocity of the first one towards it and
    /// across, m/s.
    bearing_rad: f64,
    approach_m_s: [f64; 2],
}

fn meeting() -> impl Strategy<Value = Meeting> {
    let car = || (900.0..2500.0, 1200.0..4500.0, 3.6..5.2, 1.6..2.0, -3.1..3.1, -2.0..2.0);
    let number = (car(), car(), -3.1..3.1, (6.0..22.0, -5.0..5.0));
    number.prop_map(|(first, second, bearing_rad, (towards, across))| Meeting {
        cars: [first, second].map(|(a, b, c, d, e, f)| [a, b, c, d, e, f]),
        bearing_rad,
        approach_m_s: [towards, across],
    })
}

impl Meeting {
    fn cars(&self) -> [TestCar; 2] {
        let (sin, cos) = self.bearing_rad.sin_cos();
        let [towards, across] = self.approach_m_s;
        let approach = [towards * cos - across * sin, towards * sin + across * cos];
        let places_m = [[40.0, -25.0], [40.0 + 5.6 * cos, -25.0 + 5.6 * sin]];
        let velocities_m_s = [[3.0 + approach[0], approach[1]], [3.0, 0.0]];
        [0, 1].map(|i| {
            let [mass_kg, inertia, length_m, width_m, yaw_rad, yaw_rate_rad_s] = self.cars[i];
            let footprint = Footprint { length_m, width_m, cg_from_front_m: 0.45 * length_m };
            let vehicle = free_body(mass_kg, inertia, footprint);
            let faces = FaceLaws::by_class(&vehicle).unwrap();
            let [vx_body_m_s, vy_body_m_s] = body_from_world(yaw_rad, velocities_m_s[i]);
            let [x_m, y_m] = places_m[i];
            let initial = VehicleState {
                x_m,
                y_m,
                yaw_rad,
                yaw_rate_rad_s,
                vx_body_m_s,
                vy_body_m_s,
                ..VehicleState::default()
            };
            let mut car = TestCar::new(vehicle, [0.25, 0.08], faces, initial);
            car.manoeuvre.duration_s = 0.6;
            car
        })
    }
}

fn sums(cars: &[TestCar; 2], states: &[VehicleState<f64>; 2]) -> [f64; 4] {
    let [a, b] = [0, 1].map(|i| cars[i].momentum(&states[i]));
    std::array::from_fn(|i| a[i] + b[i])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn momentum_is_kept_and_no_energy_comes_from_a_contact(meeting in meeting()) {
        let cars = meeting.cars();
        let before = sums(&cars, &[0, 1].map(|i| cars[i].manoeuvre.initial));
        let motion = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
        let after = sums(&cars, &motion.motions.each_ref().map(last_state));
        let mass_kg: f64 = cars.iter().map(|car| car.vehicle.mass.mass_kg).sum();
        let scale_n_s = mass_kg * 10.0;
        for (axis, arm_m) in [(0, 1.0), (1, 1.0), (2, 50.0)] {
            let off = (after[axis] - before[axis]) / (scale_n_s * arm_m);
            prop_assert!(off.abs() < 1e-9, "{axis}: {} and {}", before[axis], after[axis]);
        }
        let lost_j = before[3] - after[3];
        let absorbed_j = motion.energy.absorbed_j;
        prop_assert!((lost_j - absorbed_j).abs() < 1e-9 * before[3], "{lost_j}, {absorbed_j}");
        prop_assert!(absorbed_j > -1e-6 * before[3], "{absorbed_j} J of {}", before[3]);
        prop_assert!(motion.energy.friction_heat_j >= 0.0);
        prop_assert!(motion.energy.stored_j >= 0.0);
    }

    #[test]
    fn a_mirrored_contact_is_the_mirror_image(meeting in meeting()) {
        let cars = meeting.cars();
        let straight = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
        let cars = cars.map(TestCar::mirrored);
        let seen = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
        for i in 0..2 {
            let expected = mirrored(last_state(&straight.motions[i])).to_array();
            let got = last_state(&seen.motions[i]).to_array();
            for (got, expected) in got.iter().zip(expected) {
                prop_assert!((got - expected).abs() < 1e-7, "{i}: {got:?}, {expected:?}");
            }
        }
    }

    #[test]
    fn exchanged_cars_have_exchanged_motions(meeting in meeting()) {
        let cars = meeting.cars();
        let straight = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
        let exchanged = simulate([&cars[1], &cars[0]], ContactConditions::default(), 1).unwrap();
        for i in 0..2 {
            let expected = last_state(&straight.motions[i]).to_array();
            let got = last_state(&exchanged.motions[1 - i]).to_array();
            for (got, expected) in got.iter().zip(expected) {
                prop_assert!((got - expected).abs() < 1e-7, "{i}: {got:?}, {expected:?}");
            }
        }
        prop_assert_eq!(straight.phases.len(), exchanged.phases.len());
    }
}

/// Largest distance of both cars between two motions, m, and of the headings, rad.
fn difference(a: &PairMotion, b: &PairMotion) -> [f64; 2] {
    let mut largest = [0.0_f64; 2];
    for i in 0..2 {
        let n = a.motions[i].series.time_s().len();
        assert_eq!(n, b.motions[i].series.time_s().len());
        for sample in 0..n {
            let [a, b] = [a, b].map(|motion| state_at(&motion.motions[i], sample));
            let apart_m = (a.x_m - b.x_m).hypot(a.y_m - b.y_m);
            largest = [largest[0].max(apart_m), largest[1].max((a.yaw_rad - b.yaw_rad).abs())];
        }
    }
    largest
}

#[test]
fn half_the_step_and_half_the_elements_hardly_change_a_pit_manoeuvre() {
    let run = |longest_element_m, step_divisor| {
        let cars = pit_manoeuvre(longest_element_m);
        simulate([&cars[0], &cars[1]], ContactConditions::default(), step_divisor).unwrap()
    };
    let usual = run(0.08, 1);
    let [phase, ..] = usual.phases[..] else { panic!("no contact") };
    let turned_rad = last_state(&usual.motions[0]).yaw_rad;
    assert!(phase.end_s.is_none_or(|end_s| end_s > 0.4) && turned_rad > 0.5, "{phase:?}");
    // Half the elements: 11 cm and 3.5° of a turn by 60° after 1.5 s.
    for (other, label, limits) in [
        (run(0.08, 2), "half the step", [0.002, 0.001]),
        (run(0.04, 1), "half the elements", [0.2, 0.1]),
    ] {
        let off = difference(&usual, &other);
        assert!(off[0] < limits[0] && off[1] < limits[1], "{label}: {off:?} m, rad");
    }
    assert_eq!(usual, run(0.08, 1), "another run is another motion");
}

/// What thousands of motions are followed with.
#[test]
fn long_steps_and_long_elements_change_a_pit_manoeuvre_by_less_than_a_car_width() {
    let run = |longest_element_m, has_long_steps| {
        let cars = pit_manoeuvre(longest_element_m);
        let vehicles = [&cars[0], &cars[1]].map(TestCar::in_pair);
        let conditions = ContactConditions::default();
        let settings = CoupledSettings { has_long_steps, ..CoupledSettings::default() };
        VehiclePair { vehicles, conditions, settings }.simulate().unwrap()
    };
    let usual = run(0.08, false);
    for (other, label, limits) in [
        (run(0.08, true), "long steps", [0.02, 0.01]),
        (run(0.2, true), "long elements, too", [0.5, 0.25]),
    ] {
        let off = difference(&usual, &other);
        assert!(
            other != usual && off[0] < limits[0] && off[1] < limits[1],
            "{label}: {off:?} m, rad"
        );
    }
}

#[test]
fn vehicles_that_do_not_meet_move_as_by_themselves() {
    let mut cars = pit_manoeuvre(0.08);
    cars[1].manoeuvre.initial.y_m = 12.0;
    let motion = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
    assert!(motion.phases.is_empty() && motion.energy == ContactEnergy::default());
    for (car, motion) in cars.iter().zip(&motion.motions) {
        let alone = car.vehicle.simulate(&car.manoeuvre, Integrator::Rk4).unwrap();
        assert_eq!(alone.series.time_s(), motion.series.time_s());
        for channel in alone.series.channels() {
            let [got, expected] =
                [motion, &alone].map(|motion| motion.series.require(channel).unwrap());
            for (got, expected) in got.iter().zip(expected) {
                let off = (got - expected).abs();
                // The steps of a pair follow the speed.
                assert!(off <= 1e-6 * expected.abs().max(1.0), "{channel:?}: {got}, {expected}");
            }
        }
    }
}

#[test]
fn a_blow_above_the_roll_axes_rolls_the_cars_away_from_each_other() {
    let mut cars = pit_manoeuvre(0.08);
    for car in &mut cars {
        car.manoeuvre.duration_s = 0.2;
    }
    let roll_at = |height_m: f64| {
        let vehicles = cars.each_ref().map(TestCar::in_pair);
        let conditions = ContactConditions { height_m, ..ContactConditions::default() };
        let motion = VehiclePair { vehicles, conditions, settings: CoupledSettings::default() }
            .simulate()
            .unwrap();
        motion.motions.each_ref().map(|motion| last_state(motion).roll_rad)
    };
    let (low, high) = (roll_at(0.2), roll_at(0.9));
    // The struck car is pushed to the right and leans to the right, the striking one to the left.
    assert!(high[0] > low[0] + 0.005 && high[1] < low[1] - 0.005, "{low:?} and {high:?}");
}

#[test]
fn what_does_not_go_together_is_refused() {
    let cars = pit_manoeuvre(0.08);
    let vehicles = cars.each_ref().map(TestCar::in_pair);
    let good = VehiclePair {
        vehicles,
        conditions: ContactConditions::default(),
        settings: CoupledSettings::default(),
    };
    let slippery = ContactConditions { friction: f64::NAN, ..good.conditions };
    let name = |pair: VehiclePair<'_>| match pair.simulate() {
        Err(PairError::Range { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    assert_eq!(name(VehiclePair { conditions: slippery, ..good }), "friction");
    assert_eq!(
        name(VehiclePair {
            settings: CoupledSettings { step_divisor: 0, ..good.settings },
            ..good
        }),
        "step_divisor"
    );
    let longer = Manoeuvre { duration_s: 2.0, ..cars[1].manoeuvre.clone() };
    let mut pair = good;
    pair.vehicles[1].manoeuvre = &longer;
    let expected = PairError::Durations { struck_s: 1.5, striking_s: 2.0 };
    assert_eq!(pair.simulate(), Err(expected));
    let endless = Manoeuvre { duration_s: f64::NAN, ..cars[1].manoeuvre.clone() };
    pair.vehicles = pair.vehicles.map(|it| PairVehicle { manoeuvre: &endless, ..it });
    assert!(matches!(pair.simulate(), Err(PairError::Durations { .. })));
    let forever = Manoeuvre { duration_s: f64::INFINITY, ..cars[1].manoeuvre.clone() };
    pair.vehicles = pair.vehicles.map(|it| PairVehicle { manoeuvre: &forever, ..it });
    match pair.simulate() {
        Err(PairError::Vehicle { role, source: SimulationError::Duration(_) }) => {
            assert_eq!(role, "struck");
        }
        other => panic!("{other:?}"),
    }
}
