//! One step of the vehicle with a residual acceleration: what the response network learns inside of.
//!
//! ```text
//! ẋ = f(x, u) + [a, 0]        a = residual of [v̇_x, v̇_y, ṙ, φ̈]
//! ```
//!
//! over 10 ms by one Runge–Kutta step; the shipped trajectories come out as with steps of 1 ms to
//! 0.1 mm. Without a contact force and with the throttle released the planar kinetic energy does not
//! grow: a step that would make it grow is scaled back to the energy before it, on a slope to that with
//! what the weight has given.

use serde::{Deserialize, Serialize};

use impactlab_core::numerics::{Lanes, LanesOver, rk4_step, rk4_step_from};
use impactlab_core::vehicle::frames::Heading;
use impactlab_core::vehicle::{
    N_ACCELERATION, N_STATE, OUTPUT_INTERVAL_S, VehicleConstants, VehicleInput, VehicleParameters,
    VehicleState,
};

/// Length of a step, s: the interval of simulated motions and of the trajectory data sets.
pub const STEP_S: f64 = OUTPUT_INTERVAL_S;

/// Numbers of a residual acceleration: v̇_x, v̇_y in m/s², ṙ, φ̈ in rad/s².
pub const N_RESIDUAL: usize = N_ACCELERATION;

/// Signs of a residual acceleration mirrored at the vehicle's longitudinal plane.
pub const RESIDUAL_MIRROR: [f64; N_RESIDUAL] = [1.0, -1.0, -1.0, -1.0];

/// What a network corrects, and how.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Correction {
    /// A residual acceleration inside the Runge–Kutta step of the 4DOF model.
    #[default]
    Acceleration,
    /// An offset of v_x, v_y, r, φ̇ after the step of the 4DOF model, as the paper has it: with its
    /// bounds some 50 g per step.
    StateOffset,
    /// The whole acceleration of the CG along the body's axes, ṙ and φ̈, without the 4DOF model:
    /// only rates are integrated. The plain network of the comparison.
    Whole,
}

/// The 4DOF model of a vehicle, prepared for steps of [`STEP_S`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepModel<P = f64> {
    pub constants: VehicleConstants<P>,
    /// Parts into which a step is divided. Without a force the energy of the planar motion is bounded
    /// by the step, and that of the roll by its division.
    n_substeps: usize,
}

impl StepModel {
    pub fn new(vehicle: &VehicleParameters) -> Self {
        Self { constants: vehicle.constants(), n_substeps: vehicle.roll_substeps(STEP_S) }
    }
}

impl Correction {
    /// The state after a step.
    ///
    /// - `value`: v̇_x, v̇_y, ṙ, φ̈ in m/s² and rad/s², or for [`Correction::StateOffset`] v_x, v_y,
    ///   r, φ̇ in m/s and rad/s.
    pub fn step<T: Lanes>(
        self,
        vehicle: &VehicleParameters,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
        value: [T; N_RESIDUAL],
    ) -> VehicleState<T> {
        let model = StepModel::new(vehicle);
        self.step_from(&model, x, u, &model.constants.evaluate(x, u).derivative, value)
    }

    /// [`Correction::step`] where the time derivative by the 4DOF model at the beginning is known.
    ///
    /// - `now`: that derivative.
    #[inline(always)]
    pub(crate) fn step_from<P: Copy, T: Lanes + LanesOver<P>>(
        self,
        model: &StepModel<P>,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
        now: &VehicleState<T>,
        value: [T; N_RESIDUAL],
    ) -> VehicleState<T> {
        match self {
            Self::Acceleration => step_from(model, x, u, now, value),
            Self::StateOffset => {
                let none = [x.vx_body_m_s.constant(0.0); N_RESIDUAL];
                let mut next = step_from(model, x, u, now, none);
                let [vx, vy, yaw, roll] = value;
                next.vx_body_m_s += vx;
                next.vy_body_m_s += vy;
                next.yaw_rate_rad_s += yaw;
                next.roll_rate_rad_s += roll;
                next
            }
            Self::Whole => {
                let [ax, ay, yaw, roll] = value;
                let f = |_, x: &[T; N_STATE]| {
                    let x = VehicleState::from_array(*x);
                    x.derivative(Heading::new(x.yaw_rad), [ax, ay], [yaw, roll]).to_array()
                };
                VehicleState::from_array(rk4_step(f, &x.to_array(), STEP_S))
            }
        }
    }

    /// Change of the velocities over a step by a unit of the value in [`Correction::step`].
    pub fn change_per_unit(self) -> f64 {
        match self {
            Self::Acceleration | Self::Whole => STEP_S,
            Self::StateOffset => 1.0,
        }
    }
}

/// The state after a step of the 4DOF model.
///
/// - `u`: the input, its force the mean over the step.
/// - `residual`: v̇_x, v̇_y, m/s², ṙ, φ̈, rad/s², constant over the step.
pub fn step<T: Lanes>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    u: &VehicleInput<T>,
    residual: [T; N_RESIDUAL],
) -> VehicleState<T> {
    Correction::Acceleration.step(vehicle, x, u, residual)
}

#[inline(always)]
fn step_from<P: Copy, T: Lanes + LanesOver<P>>(
    model: &StepModel<P>,
    x: &VehicleState<T>,
    u: &VehicleInput<T>,
    now: &VehicleState<T>,
    residual: [T; N_RESIDUAL],
) -> VehicleState<T> {
    let StepModel { constants, n_substeps } = model;
    let h = STEP_S / *n_substeps as f64;
    let derivative = |_, x: &[T; N_STATE]| with_residual(constants.derivative(x, u), residual);
    let mut next = x.to_array();
    let mut start = with_residual(now.to_array(), residual);
    for substep in 0..*n_substeps {
        if substep > 0 {
            start = with_residual(constants.derivative(&next, u), residual);
        }
        next = rk4_step_from(&start, derivative, &next, h);
    }
    let next = VehicleState::from_array(next);
    let is_free = u.collision.is_none() && !u.is_driven();
    if is_free { constants.without_energy_gain(x, next) } else { next }
}

/// The time derivative of a state with a residual acceleration.
#[inline(always)]
fn with_residual<T: Lanes>(derivative: [T; N_STATE], residual: [T; N_RESIDUAL]) -> [T; N_STATE] {
    VehicleState::from_array(derivative).accelerated(residual).to_array()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use pulp::{Simd, WithSimd};

    use super::*;
    use impactlab_core::numerics::Packed;
    use impactlab_core::vehicle::{CollisionForce, ContactPoint, Preset, WheelEffort};

    /// A step from several states side by side.
    struct Steps<'a> {
        vehicle: &'a VehicleParameters,
        states: [VehicleState<f64>; 8],
        u: VehicleInput<f64>,
        a: [f64; N_RESIDUAL],
    }

    impl WithSimd for Steps<'_> {
        type Output = Vec<[f64; N_STATE]>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let states = self.states.map(VehicleState::to_array);
            let x = std::array::from_fn(|i| {
                Packed::new(simd, &std::array::from_fn(|lane| states[lane][i]))
            });
            let splat = |value| Packed::splat(simd, value);
            let x = VehicleState::from_array(x);
            let next = step(self.vehicle, &x, &self.u.map(splat), self.a.map(splat));
            let next = next.to_array().map(Packed::to_array);
            (0..Packed::<S>::N).map(|lane| next.map(|values| values[lane])).collect()
        }
    }

    fn state(vx_body_m_s: f64, vy_body_m_s: f64, yaw_rate_rad_s: f64) -> VehicleState<f64> {
        VehicleState { vx_body_m_s, vy_body_m_s, yaw_rate_rad_s, ..VehicleState::default() }
    }

    #[test]
    fn a_residual_pushes_by_itself() {
        let vehicle = Preset::Reference.parameters();
        let (x, u) = (state(20.0, 0.0, 0.0), VehicleInput::released());
        let plain = step(&vehicle, &x, &u, [0.0; 4]);
        let pushed = step(&vehicle, &x, &u, [-2.0, 0.0, 0.0, 0.0]);
        assert!(
            (pushed.vx_body_m_s - plain.vx_body_m_s + 0.02).abs() < 1e-5,
            "{pushed:?} {plain:?}"
        );
    }

    /// A car whose planar motion stands still has no energy there, so that the step takes away what
    /// the roll gives to it through the product of inertia: of a roll without dampers that is a few
    /// per cent in three seconds, which a fiftieth of the reference car's damping outweighs.
    #[test]
    fn a_roll_without_dampers_does_not_diverge() {
        for stiffness in [1.0, 11.5, 14.74, 243.0] {
            let mut vehicle = Preset::Reference.parameters();
            vehicle.suspension.roll_stiffness_n_m_rad *= stiffness;
            vehicle.suspension.roll_damping_n_m_s_rad = 0.0;
            let mut x = VehicleState { roll_rad: -0.125, ..state(0.0, 0.0, 0.0) };
            let before = vehicle.energy_j(&x);
            for _ in 0..300 {
                x = step(&vehicle, &x, &VehicleInput::released(), [0.0; 4]);
                assert!(vehicle.energy_j(&x) <= before * 1.05, "{stiffness}: {x:?}");
            }
        }
    }

    proptest! {
        #[test]
        fn energy_does_not_grow_without_a_force(
            vx in -40.0..40.0, vy in -20.0..20.0, r in -4.0..4.0,
            a in prop::array::uniform4(-10.0..10.0),
        ) {
            let vehicle = Preset::Reference.parameters();
            let x = state(vx, vy, r);
            let next = step(&vehicle, &x, &VehicleInput::released(), a);
            let constants = vehicle.constants();
            let [before, after] = [&x, &next].map(|x| constants.planar_energy_j(x));
            prop_assert!(after <= before * (1.0 + 1e-12), "{before} {after}");
        }

        #[test]
        fn a_stiff_or_strongly_damped_roll_does_not_diverge(
            stiffness in 1.0..300.0_f64, damping in 0.02..300.0_f64, roll in -0.2..0.2_f64,
        ) {
            let mut vehicle = Preset::Reference.parameters();
            vehicle.suspension.roll_stiffness_n_m_rad *= stiffness;
            vehicle.suspension.roll_damping_n_m_s_rad *= damping;
            let mut x = VehicleState { roll_rad: roll, ..state(0.0, 0.0, 0.0) };
            let before = vehicle.energy_j(&x);
            for _ in 0..100 {
                x = step(&vehicle, &x, &VehicleInput::released(), [0.0; 4]);
                prop_assert!(vehicle.energy_j(&x) <= before * (1.0 + 1e-9), "{x:?}");
            }
        }

        #[test]
        fn states_side_by_side_go_where_each_goes_to_the_last_digit(
            of_lanes in prop::array::uniform8(prop::array::uniform3(-15.0..15.0)),
            efforts in prop::option::of(prop::array::uniform4([-9e3..9e3_f64, 0.0..9e3, 0.0..1.0])),
            push_n in prop::option::of(prop::array::uniform2(-3e4..3e4)),
            a in prop::array::uniform4(-10.0..10.0),
        ) {
            let vehicle = Preset::Reference.parameters();
            let contact = ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: 0.5 };
            let collision = push_n.map(|force_n| CollisionForce {
                force_n, in_world_axes: true, yaw_moment_n_m: None, contact,
            });
            let effort = |[drive_n, braking_n, locked]: [f64; 3]| {
                WheelEffort { drive_n, braking_n, locked }
            };
            let wheels = efforts.map(|wheels| wheels.map(effort));
            let u = VehicleInput { steer_rad: 0.1, wheels, friction_share: None, collision };
            let states = of_lanes.map(|[vx, vy, r]| VehicleState {
                yaw_rad: vy, roll_rad: r / 50.0, ..state(vx, vy, r / 3.0)
            });
            let steps = pulp::Arch::new().dispatch(Steps { vehicle: &vehicle, states, u, a });
            for (next, x) in steps.iter().zip(&states) {
                prop_assert_eq!(*next, step(&vehicle, x, &u, a).to_array());
            }
        }

        #[test]
        fn mirrored_in_mirrored_out(
            vx in -40.0..40.0, vy in -20.0..20.0, r in -4.0..4.0,
            a in prop::array::uniform4(-3.0..3.0),
        ) {
            let vehicle = Preset::Reference.parameters();
            let u = VehicleInput::released();
            let next = step(&vehicle, &state(vx, vy, r), &u, a);
            let mirrored: [f64; 4] = std::array::from_fn(|i| a[i] * RESIDUAL_MIRROR[i]);
            let other = step(&vehicle, &state(vx, -vy, -r), &u, mirrored);
            prop_assert!((next.vx_body_m_s - other.vx_body_m_s).abs() < 1e-9);
            prop_assert!((next.vy_body_m_s + other.vy_body_m_s).abs() < 1e-9);
            prop_assert!((next.yaw_rate_rad_s + other.yaw_rate_rad_s).abs() < 1e-9);
        }
    }
}
