//! The printed example of EDSMAC: an Escort runs into the side of a Sentra.

use crate::collision::Footprint;
use crate::collision::contact::test_pairs::{TestCar, alike, on_level_tires, simulate, state_at};
use crate::collision::contact::{ContactConditions, FaceLaw, Recovery};

/// Radius of the corners, m; EDSMAC's outlines are rectangles whose sides are found radially.
const CORNER_RADIUS_M: f64 = 0.25;
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::{DamagedWheel, Ending, SteerHistory, VehicleParameters, VehicleState, Wheel};

/// Numbers of a car as printed. Axes of SAE: y to the right, yaw clockwise.
struct PrintedCar {
    mass_kg: f64,
    yaw_inertia_kg_m2: f64,
    ends_m: [f64; 2],
    width_m: f64,
    stiffness_n_cm2: f64,
    axles_m: [f64; 2],
    track_m: f64,
    tire_friction: f64,
    cornering_n_deg: f64,
}

const ESCORT: PrintedCar = PrintedCar {
    mass_kg: 1124.55,
    yaw_inertia_kg_m2: 1612.78,
    ends_m: [1.7856, -2.5209],
    width_m: 1.6942,
    stiffness_n_cm2: 100.25,
    axles_m: [0.9322, -1.5672],
    track_m: 1.4351,
    tire_friction: 0.72,
    cornering_n_deg: 765.1,
};

const SENTRA: PrintedCar = PrintedCar {
    mass_kg: 1149.52,
    yaw_inertia_kg_m2: 1922.12,
    ends_m: [1.7399, -2.5273],
    width_m: 1.7144,
    stiffness_n_cm2: 89.20,
    axles_m: [0.9169, -1.6231],
    track_m: 1.4493,
    tire_friction: 0.74,
    cornering_n_deg: 504.0,
};

impl PrintedCar {
    /// A car with constant loads of its wheels, as in EDSMAC: it does not roll, and its CG lies on the
    /// ground.
    fn vehicle(&self) -> VehicleParameters {
        let [front_m, rear_m] = self.ends_m;
        let footprint = Footprint {
            length_m: front_m - rear_m,
            width_m: self.width_m,
            cg_from_front_m: front_m,
        };
        let mut vehicle = on_level_tires(self.mass_kg, self.yaw_inertia_kg_m2, footprint);
        let [front_axle_m, rear_axle_m] = self.axles_m;
        let wheelbase_m = front_axle_m - rear_axle_m;
        vehicle.geometry.cg_to_front_axle_m = front_axle_m;
        vehicle.geometry.cg_to_rear_axle_m = -rear_axle_m;
        vehicle.geometry.track_width_m = self.track_m;
        vehicle.geometry.cg_height_m = 0.0;
        vehicle.suspension.roll_axis_height_m = 0.0;
        vehicle.tires.friction = self.tire_friction;
        vehicle.tires.sliding_friction_ratio = 1.0;
        let weight_n = self.mass_kg * STANDARD_GRAVITY_M_S2;
        let cornering_n_rad = self.cornering_n_deg * 180.0 / std::f64::consts::PI;
        let coefficient = |other_axle_m: f64| {
            cornering_n_rad / (weight_n * other_axle_m.abs() / wheelbase_m / 2.0)
        };
        vehicle.tires.cornering_coefficient_front_per_rad = coefficient(rear_axle_m);
        vehicle.tires.cornering_coefficient_rear_per_rad = coefficient(front_axle_m);
        vehicle
    }

    fn car(&self, printed: Printed, element_m: f64) -> TestCar {
        let law = FaceLaw::linear(self.stiffness_n_cm2 * 1e4, Recovery::EDSMAC).unwrap();
        TestCar::new(self.vehicle(), [CORNER_RADIUS_M, element_m], alike(law), printed.state())
    }
}

/// A printed state: X, Y, m; ψ, °; U, V, km/h; r, °/s.
#[derive(Clone, Copy)]
struct Printed([f64; 6]);

impl Printed {
    /// In the axes of ISO 8855.
    fn state(self) -> VehicleState<f64> {
        let [x, y, yaw, u, v, rate] = self.0;
        VehicleState {
            x_m: x,
            y_m: -y,
            yaw_rad: -yaw.to_radians(),
            vx_body_m_s: u / 3.6,
            vy_body_m_s: -v / 3.6,
            yaw_rate_rad_s: -rate.to_radians(),
            ..VehicleState::default()
        }
    }

    fn from_state(x: &VehicleState<f64>) -> Self {
        Self([
            x.x_m,
            -x.y_m,
            -x.yaw_rad.to_degrees(),
            x.vx_body_m_s * 3.6,
            -x.vy_body_m_s * 3.6,
            -x.yaw_rate_rad_s.to_degrees(),
        ])
    }
}

const AT_IMPACT: [Printed; 2] = [
    Printed([6.22, 13.73, 195.10, 31.07, -2.15, 15.77]),
    Printed([3.50, 13.33, -90.0, 35.0, 0.0, 0.0]),
];

const AT_SEPARATION: [Printed; 2] = [
    Printed([5.69, 13.51, 202.5, 15.9, 4.8, 128.8]),
    Printed([3.31, 12.53, -84.2, 28.2, -16.7, 118.9]),
];

/// States of both cars 0.09 s after the impact, and how long they are in contact, s.
fn example(element_m: f64, steer_rad: f64, step_divisor: usize) -> ([Printed; 2], f64) {
    let mut cars = [ESCORT.car(AT_IMPACT[0], element_m), SENTRA.car(AT_IMPACT[1], element_m)];
    let locked = |wheel| DamagedWheel { wheel, start_s: -1.0, drag_share_of_friction: None };
    let damage = Wheel::ALL.map(locked).to_vec();
    let ending = Ending { damage, ..Ending::default() };
    cars[0].manoeuvre.controls = ending.controls(&cars[0].vehicle);
    cars[1].manoeuvre.controls.steer =
        Some(SteerHistory { time_s: vec![0.0], steer_rad: vec![steer_rad] });
    // The car that is run into is the struck one.
    let conditions = ContactConditions { friction: 0.55, damping_s_m: 0.0, height_m: 0.0 };
    let motion = simulate([&cars[1], &cars[0]], conditions, step_divisor).unwrap();
    let end_s = motion.phases[0].end_s.unwrap();
    let [sentra, escort] =
        motion.motions.each_ref().map(|motion| Printed::from_state(&state_at(motion, 9)));
    ([escort, sentra], end_s - motion.phases[0].start_s)
}

/// What may differ: X, Y, m; ψ, °; U, V, km/h; r, °/s.
const TOLERANCES: [f64; 6] = [0.15, 0.15, 2.5, 1.2, 1.2, 9.0];

/// The steer angle of the Sentra is not printed, and 4.5° to the right was taken for it. Neither that angle nor the length of the elements decides.
#[test]
fn the_printed_example_is_met() {
    for (element_m, steer_deg) in [(0.04, 4.5), (0.04, 0.0), (0.02, 4.5), (0.1, 4.5)] {
        let (cars, contact_s) = example(element_m, -f64::to_radians(steer_deg), 1);
        for ((got, printed), label) in cars.iter().zip(AT_SEPARATION).zip(["Escort", "Sentra"]) {
            for (i, tolerance) in TOLERANCES.into_iter().enumerate() {
                let (got, printed) = (got.0[i], printed.0[i]);
                assert!(
                    (got - printed).abs() < tolerance,
                    "{label}, number {i}, elements of {element_m} m, steer {steer_deg}°: {got}, \
                     printed {printed}"
                );
            }
        }
        assert!((0.06..0.1).contains(&contact_s), "{contact_s} s, printed 0.090 s");
    }
}

#[test]
fn half_the_step_hardly_changes_the_printed_example() {
    let [usual, half] = [1, 2].map(|divisor| example(0.04, -0.08, divisor).0);
    for (usual, half) in usual.iter().zip(half) {
        let off: [f64; 6] = std::array::from_fn(|i| (usual.0[i] - half.0[i]).abs());
        let limits = [0.01, 0.01, 0.1, 0.1, 0.1, 0.5];
        assert!(off.iter().zip(limits).all(|(off, limit)| *off < limit), "{off:?}");
    }
}
