//! Properties that the 4DOF vehicle must have for all parameters: symmetry, energy, rest,
//! closed-form solutions and exact derivatives.

use impactlab_core::data::Channel;
use impactlab_core::data::{ForceAxes, ForceHistory, Sampling};
use impactlab_core::numerics::{Stage, rk4_step};
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{
    CollisionForce, ContactLoad, ContactPoint, Controls, Integrator, Manoeuvre, Preset,
    SteerHistory, VehicleInput, VehicleParameters, VehicleState,
};
use nalgebra::SVector;
use proptest::prelude::*;

const CONTACT: ContactPoint = ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: 0.52 };

fn pit_force(fx_n: f64, fy_n: f64) -> ForceHistory {
    let time_s: Vec<f64> = (0..=120).map(|ms| f64::from(ms) * 1e-3).collect();
    let shape = |t: f64| (std::f64::consts::PI * t / 0.12).sin().powi(2);
    ForceHistory {
        axes: ForceAxes::World,
        sampling: Sampling::Instant,
        fx_n: time_s.iter().map(|&t| fx_n * shape(t)).collect(),
        fy_n: time_s.iter().map(|&t| fy_n * shape(t)).collect(),
        mz_n_m: None,
        time_s,
    }
}

fn pit(fy_n: f64, contact: ContactPoint, speed_m_s: f64, duration_s: f64) -> Manoeuvre {
    let force = pit_force(8e3, fy_n);
    Manoeuvre {
        initial: VehicleState::driving_straight(speed_m_s),
        contact_load: Some(ContactLoad { force, contact, recorded_moment: false }),
        duration_s,
        ..Manoeuvre::default()
    }
}

/// Returns the kinetic energy plus the energy stored in the roll spring and in the raised sprung
/// mass, J.
fn energy_j(vehicle: &VehicleParameters, x: &VehicleState<f64>) -> f64 {
    let (mass, suspension) = (&vehicle.mass, &vehicle.suspension);
    let planar = mass.mass_kg * (x.vx_body_m_s.powi(2) + x.vy_body_m_s.powi(2)) / 2.0;
    let (r, p) = (x.yaw_rate_rad_s, x.roll_rate_rad_s);
    let spin = mass.yaw_inertia_kg_m2 * r * r / 2.0
        + mass.roll_inertia_kg_m2 * p * p / 2.0
        + mass.roll_yaw_product_kg_m2 * r * p;
    let lowered = STANDARD_GRAVITY_M_S2
        * mass.sprung_mass_kg
        * suspension.roll_arm_m
        * (1.0 - x.roll_rad.cos());
    planar + spin + suspension.roll_stiffness_n_m_rad * x.roll_rad.powi(2) / 2.0 - lowered
}

#[test]
fn the_kinetic_energy_never_rises_without_a_force() {
    let vehicle = Preset::Reference.parameters();
    for (speed, slip_deg, rate) in [
        (30.0_f64, 0.0_f64, 2.0),
        (20.0, 60.0, 1.0),
        (10.0, 120.0, -3.0),
        (25.0, 180.0, 0.5),
        (0.5, 90.0, 4.0),
    ] {
        let (sin, cos) = slip_deg.to_radians().sin_cos();
        let mut state = VehicleState {
            vx_body_m_s: speed * cos,
            vy_body_m_s: speed * sin,
            yaw_rate_rad_s: rate,
            ..VehicleState::default()
        };
        let planar = |x: &VehicleState<f64>| {
            energy_j(&vehicle, &VehicleState { roll_rad: 0.0, roll_rate_rad_s: 0.0, ..*x })
        };
        let mut before = planar(&state);
        for step in 0..6000 {
            let f = |_: Stage, x: &[f64; 8]| {
                let state = VehicleState::from_array(*x);
                vehicle.evaluate(&state, &VehicleInput::released()).derivative.to_array()
            };
            state = VehicleState::from_array(rk4_step(f, &state.to_array(), 1e-3));
            let after = planar(&state);
            // Roll transfers some energy to yaw through I_xz, so that the planar energy may grow by
            // a small share of the roll energy.
            let from_roll = energy_j(&vehicle, &state) - after;
            assert!(
                after <= before + from_roll.abs() * 0.02 + 1e-9,
                "{speed} m/s at {slip_deg} deg, {rate} rad/s, step {step}: {before} J, then {after} J"
            );
            before = after;
        }
    }
}

#[test]
fn a_mirrored_impact_gives_the_mirrored_motion() {
    let vehicle = Preset::Reference.parameters();
    let left = vehicle.simulate(&pit(40e3, CONTACT, 20.0, 4.0), Integrator::Rk4).unwrap();
    let mirrored_contact = ContactPoint { y_body_m: -CONTACT.y_body_m, ..CONTACT };
    let right =
        vehicle.simulate(&pit(-40e3, mirrored_contact, 20.0, 4.0), Integrator::Rk4).unwrap();
    for (channel, sign) in [
        (Channel::X, 1.0),
        (Channel::Y, -1.0),
        (Channel::Yaw, -1.0),
        (Channel::Roll, -1.0),
        (Channel::Vx, 1.0),
        (Channel::Vy, -1.0),
        (Channel::YawRate, -1.0),
    ] {
        let pairs = left
            .series
            .require(channel)
            .unwrap()
            .iter()
            .zip(right.series.require(channel).unwrap());
        for (a, b) in pairs {
            assert!((a - sign * b).abs() < 1e-12, "{channel:?}: {a} {b}");
        }
    }
    assert!(left.series.require(Channel::Yaw).unwrap()[400].abs() > 1.0, "no spin, no test");
}

#[test]
fn a_free_coast_down_is_that_of_rolling_resistance() {
    let mut vehicle = Preset::Reference.parameters();
    vehicle.tires.rolling_resistance_s2_m2 = 0.0;
    let manoeuvre = Manoeuvre {
        initial: VehicleState::driving_straight(20.0),
        duration_s: 10.0,
        ..Manoeuvre::default()
    };
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
    let deceleration = 0.01 * STANDARD_GRAVITY_M_S2;
    for (&t, &vx) in motion.series.time_s().iter().zip(motion.series.require(Channel::Vx).unwrap())
    {
        assert!((vx - (20.0 - deceleration * t)).abs() < 1e-9, "{t} s: {vx} m/s");
    }
}

#[test]
fn steady_cornering_is_that_of_the_linear_bicycle() {
    // The closed-form solution at small slip is r = v δ / (L + K v²) with K = m/L (l_r/C_f −
    // l_f/C_r). A left turn is positive.
    let mut vehicle = Preset::Reference.parameters();
    vehicle.tires.rolling_resistance = 0.0;
    vehicle.tires.rolling_resistance_s2_m2 = 0.0;
    let (speed, steer) = (15.0, 0.002);
    let manoeuvre = Manoeuvre {
        initial: VehicleState::driving_straight(speed),
        controls: Controls {
            steer: Some(SteerHistory { time_s: vec![0.0, 0.5], steer_rad: vec![0.0, steer] }),
            ..Controls::default()
        },
        duration_s: 8.0,
        ..Manoeuvre::default()
    };
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
    let rate = *motion.series.require(Channel::YawRate).unwrap().last().unwrap();

    let (lf, lr) = (vehicle.geometry.cg_to_front_axle_m, vehicle.geometry.cg_to_rear_axle_m);
    let wheelbase = lf + lr;
    let axle_load = |arm: f64| vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2 * arm / wheelbase;
    let front = vehicle.tires.cornering_coefficient_front_per_rad * axle_load(lr);
    let rear = vehicle.tires.cornering_coefficient_rear_per_rad * axle_load(lf);
    let understeer = vehicle.mass.mass_kg / wheelbase * (lr / front - lf / rear);
    // The ε in the slip angle reduces the stiffness of each tire by the factor u/(u + ε).
    let softened = understeer * (speed + 0.5) / speed;
    let expected = speed * steer / (wheelbase + softened * speed * speed);
    assert!(
        rate > 0.0 && (rate / expected - 1.0).abs() < 5e-3,
        "{rate} rad/s, expected {expected}"
    );
}

#[test]
fn a_spin_ends_at_rest_and_stays_there() {
    for preset in [Preset::Reference, Preset::ScaledStruck] {
        let vehicle = preset.parameters();
        let manoeuvre = Manoeuvre {
            initial: VehicleState { yaw_rate_rad_s: 8.0, ..VehicleState::driving_straight(8.0) },
            duration_s: 60.0,
            ..Manoeuvre::default()
        };
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
        let column = |channel| motion.series.require(channel).unwrap();
        let yaw = column(Channel::Yaw);
        assert!(
            yaw[6000].abs() > std::f64::consts::TAU,
            "{}: turned {} rad",
            vehicle.name,
            yaw[6000]
        );
        for (name, channel, bound) in [
            ("v_x", Channel::Vx, 1e-3),
            ("v_y", Channel::Vy, 1e-3),
            ("r", Channel::YawRate, 1e-3),
            ("roll", Channel::Roll, 1e-3),
        ] {
            let worst = column(channel)[5000..].iter().fold(0.0_f64, |worst, v| worst.max(v.abs()));
            assert!(worst < bound, "{}: {name} still {worst:e} after 50 s", vehicle.name);
        }
        let reversals =
            column(Channel::YawRate)[5000..].windows(2).filter(|w| w[0] * w[1] < 0.0).count();
        assert!(
            reversals < 5,
            "{}: {reversals} changes of the yaw rate's sign at rest",
            vehicle.name
        );
    }
}

#[test]
fn rk4_converges_with_the_fourth_order_in_a_smooth_manoeuvre() {
    let vehicle = Preset::Reference.parameters();
    let start = VehicleState {
        vy_body_m_s: 1.0,
        yaw_rate_rad_s: 0.4,
        ..VehicleState::driving_straight(20.0)
    };
    let input = VehicleInput { steer_rad: 0.02, ..VehicleInput::released() };
    let end = |n: u32| {
        let h = 0.5 / f64::from(n);
        let f = |_: Stage, x: &[f64; 8]| {
            vehicle.evaluate(&VehicleState::from_array(*x), &input).derivative.to_array()
        };
        (0..n).fold(start.to_array(), |x, _| rk4_step(f, &x, h))
    };
    let distance = |a: [f64; 8], b: [f64; 8]| (SVector::from(a) - SVector::from(b)).norm();
    let exact = end(4000);
    let order = (distance(end(50), exact) / distance(end(100), exact)).log2();
    assert!((order - 4.0).abs() < 0.3, "order {order}");
}

#[test]
fn the_step_of_the_reference_is_fine_enough() {
    let vehicle = Preset::Reference.parameters();
    let manoeuvre = pit(40e3, CONTACT, 20.0, 4.0);
    let at_1_ms = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
    let at_10_ms = vehicle.simulate(&manoeuvre, Integrator::Euler).unwrap();
    let end = |motion: &impactlab_core::vehicle::Motion| {
        let last = |channel| *motion.series.require(channel).unwrap().last().unwrap();
        [last(Channel::X), last(Channel::Y)]
    };
    let ([x, y], [ex, ey]) = (end(&at_1_ms), end(&at_10_ms));
    let gap = (x - ex).hypot(y - ey);
    assert!(gap > 1e-3 && gap < 3.0, "Euler at 10 ms is {gap} m from RK4 at 1 ms");
}

#[test]
fn the_impulse_changes_the_momentum_by_itself() {
    // On ice, the change of velocity is the impulse of the force history over the mass, although
    // the moment of the force turns the car.
    let mut vehicle = Preset::Reference.parameters().with_friction(1e-9);
    vehicle.tires.rolling_resistance = 0.0;
    vehicle.tires.rolling_resistance_s2_m2 = 0.0;
    let motion = vehicle.simulate(&pit(40e3, CONTACT, 20.0, 1.0), Integrator::Rk4).unwrap();
    let last = |channel| *motion.series.require(channel).unwrap().last().unwrap();
    let (sin, cos) = last(Channel::Yaw).sin_cos();
    let (vx, vy) = (last(Channel::Vx), last(Channel::Vy));
    let [px, py] = pit_force(8e3, 40e3).impulse_n_s();
    let world = [vx * cos - vy * sin, vx * sin + vy * cos];
    assert!((world[0] - 20.0 - px / 2000.0).abs() < 1e-5, "{world:?}");
    assert!((world[1] - py / 2000.0).abs() < 1e-5, "{world:?}");
}

fn any_state() -> impl Strategy<Value = [f64; 8]> {
    let smooth_u = prop_oneof![-30.0..-1.0, 1.0..30.0];
    (smooth_u, -15.0..15.0, -3.0..3.0, -3.0..3.0, -0.2..0.2, -0.5..0.5)
        .prop_map(|(vx, vy, yaw, r, roll, p)| [vx, vy, yaw, r, roll, p, 5.0, -3.0])
}

proptest! {
    #[test]
    fn dual_numbers_give_the_jacobian_of_finite_differences(
        x in any_state(), fx in -5e4..5e4, fy in -5e4..5e4, steer in -0.5..0.5,
    ) {
        let vehicle = Preset::Reference.parameters();
        // The equations use |u| of each wheel, which has a kink at zero. States near it are
        // excluded.
        prop_assume!((x[0].abs() - x[3].abs() * 0.8).abs() > 0.5 && x[0].abs() > x[3].abs());
        let input = VehicleInput {
            steer_rad: steer,
            collision: Some(CollisionForce { force_n: [fx, fy], in_world_axes: true, yaw_moment_n_m: None, contact: CONTACT }),
            ..VehicleInput::released()
        };
        let f = |x: [f64; 8]| vehicle.evaluate(&VehicleState::from_array(x), &input).derivative.to_array();
        let (value, jacobian) = vehicle.jacobian(&VehicleState::from_array(x), &input);
        let plain = f(x);
        let h = 1e-6;
        for column in 0..8 {
            let shifted = |sign: f64| { let mut y = x; y[column] += sign * h; f(y) };
            let (up, down) = (shifted(1.0), shifted(-1.0));
            for row in 0..8 {
                let difference = (up[row] - down[row]) / (2.0 * h);
                let exact = jacobian[(row, column)];
                let scale = 1.0 + exact.abs();
                prop_assert!((value[row] - plain[row]).abs() < 1e-9 * (1.0 + plain[row].abs()));
                // The vertical loads are limited at zero. Only at that kink do the one-sided slopes
                // differ.
                let one_sided = ((up[row] - plain[row]) / h - (plain[row] - down[row]) / h).abs();
                prop_assert!((difference - exact).abs() < 1e-4 * scale + one_sided, "d{row}/d{column}: {exact} {difference}");
            }
        }
    }
}
