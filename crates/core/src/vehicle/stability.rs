//! How short the steps of an explicit integrator must be for a vehicle, and which vehicles are none.
//!
//! A Runge–Kutta step of length h follows a mode that decays at the rate λ only while h λ stays below
//! 2.78, and one that oscillates at the angular frequency λ while it stays below 2.83; beyond, the
//! step feeds energy in. The fastest modes are those of a vehicle that hardly moves:
//!
//! ```text
//! side force of an axle     c g/ε (1 + m x²/I_zz')              ε: regularisation of the slip angle
//! ... through the roll      c g/ε m_s h |x I_xz|/(I_zz I_xx − I_xz²)
//! rolling resistance        f g/u₀ (1 + m w²/(4 I_zz'))
//! locked wheels             μ g/ε' (1 + m (x² + w²/4)/I_zz')
//! roll                      max(B/I_xx', √((K_φ + m_s g h)/I_xx'))
//! I_zz' = I_zz (1 − I_xz²/(I_zz I_xx)), I_xx' likewise
//! ```
//!
//! x is the distance of the axle from the CG; each bound puts the whole weight on one axle. At speed
//! the modes of the tires are slower, so that the bound holds for every motion.
//! Source of the limits: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed.,
//! 1996, section IV.2.

use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::tire::{
    LOCKED_SLIDING_SPEED_M_S, ROLLING_RESISTANCE_SPEED_M_S, SLIP_ANGLE_SPEED_M_S,
};
use crate::vehicle::{FrictionZone, VehicleParameters};

/// Largest h λ of a step: half of what the linear modes would bear, as the tires are not linear. The
/// vehicles that come with the program have at most 0.96 at the reference step of 1 ms.
const MAX_RATE_TIMES_STEP: f64 = 1.4;

/// Steps into which one step may be divided.
const MAX_SUBSTEPS: usize = 100;

/// Shortest step that the bounds on parameters assume, s: the reference step, divided.
const SHORTEST_STEP_S: f64 = 1e-3 / MAX_SUBSTEPS as f64;

/// Fastest rate that a vehicle may have, 1/s.
const MAX_RATE_1_S: f64 = MAX_RATE_TIMES_STEP / SHORTEST_STEP_S;

/// Largest `|I_xz|/√(I_zz I_xx)`: 1 would be a body without thickness.
pub(super) const MAX_COUPLING: f64 = 0.95;

/// A parameter that does not go with the others.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{key} is {value}, expected {expected}")]
pub struct VehicleMismatch {
    /// The key in a vehicle file.
    pub key: &'static str,
    /// Its value.
    pub value: f64,
    /// The bound, with the keys that it follows from.
    pub expected: String,
}

impl VehicleParameters {
    /// The first relation between parameters that is not met: such a vehicle would fall over by
    /// itself, or turns faster than any step follows.
    ///
    /// # Errors
    /// [`VehicleMismatch`], which names the parameters.
    pub fn check_relations(&self) -> Result<(), VehicleMismatch> {
        let (mass, suspension) = (&self.mass, &self.suspension);
        let least = |key, value: f64, least: f64, why: &str| match value >= least {
            true => Ok(()),
            false => Err(VehicleMismatch {
                key,
                value,
                expected: format!("at least {least:.4} ({why})"),
            }),
        };
        let coupling = (mass.yaw_inertia_kg_m2 * mass.roll_inertia_kg_m2).sqrt() * MAX_COUPLING;
        let product = mass.roll_yaw_product_kg_m2;
        let is_within = product.abs() <= coupling; // not if it is NaN
        if !is_within {
            return Err(VehicleMismatch {
                key: "mass.roll_yaw_product_kg_m2",
                value: product,
                expected: format!(
                    "{:.4} to {coupling:.4} (0.95 times the root of mass.yaw_inertia_kg_m2 × \
                     mass.roll_inertia_kg_m2)",
                    -coupling
                ),
            });
        }
        let arm_m = suspension.roll_arm_m;
        least(
            "mass.roll_inertia_kg_m2",
            mass.roll_inertia_kg_m2,
            mass.sprung_mass_kg * arm_m * arm_m,
            "mass.sprung_mass_kg × suspension.roll_arm_m², as it is about the roll axis",
        )?;
        least(
            "suspension.roll_stiffness_n_m_rad",
            suspension.roll_stiffness_n_m_rad,
            self.weight_moment_n_m(),
            "mass.sprung_mass_kg × g × suspension.roll_arm_m, or the body falls over by itself",
        )?;
        let rates = self.fastest_rates_1_s();
        self.check_rates(&rates)
    }

    fn check_rates(&self, rates: &Rates) -> Result<(), VehicleMismatch> {
        let (mass, suspension) = (&self.mass, &self.suspension);
        let is_too_fast = |rate: f64| rate.is_nan() || rate > MAX_RATE_1_S;
        let too_light = |key, value, others: &str| {
            Err(VehicleMismatch {
                key,
                value,
                expected: format!(
                    "more beside {others}: the simulation cannot follow so fast a change"
                ),
            })
        };
        if is_too_fast(rates.tires_1_s) {
            let others = "mass.mass_kg, the distances of the axles from the CG \
                          (geometry.cg_to_front_axle_m, geometry.cg_to_rear_axle_m) and the \
                          cornering coefficients";
            return too_light("mass.yaw_inertia_kg_m2", mass.yaw_inertia_kg_m2, others);
        }
        if is_too_fast(rates.rolling_1_s) {
            let others = "mass.mass_kg, geometry.track_width_m and tires.rolling_resistance";
            return too_light("mass.yaw_inertia_kg_m2", mass.yaw_inertia_kg_m2, others);
        }
        if is_too_fast(rates.roll_1_s) {
            let others = format!(
                "suspension.roll_damping_n_m_s_rad of {} and suspension.roll_stiffness_n_m_rad of {}",
                suspension.roll_damping_n_m_s_rad, suspension.roll_stiffness_n_m_rad
            );
            return too_light("mass.roll_inertia_kg_m2", mass.roll_inertia_kg_m2, &others);
        }
        Ok(())
    }

    /// Into how many parts a step of this length must be divided; 1 for an ordinary vehicle at the
    /// reference step.
    pub(crate) fn substeps(&self, step_s: f64) -> usize {
        let Rates { tires_1_s, rolling_1_s, roll_1_s } = self.fastest_rates_1_s();
        parts(tires_1_s.max(rolling_1_s).max(roll_1_s), step_s)
    }

    /// The same for a vehicle whose wheels may be braked or locked.
    ///
    /// - `zones`: parts of the ground with their own friction.
    pub(crate) fn braked_substeps(&self, step_s: f64, zones: &[FrictionZone]) -> usize {
        let frictions = zones.iter().map(|zone| zone.friction);
        let friction = frictions.fold(self.tires.friction, f64::max);
        self.substeps(step_s).max(parts(self.braked_rate_1_s(friction), step_s))
    }

    /// The same for the roll alone, where something else bounds the energy of the planar motion.
    pub fn roll_substeps(&self, step_s: f64) -> usize {
        parts(self.roll_rate_bound_1_s(), step_s)
    }

    /// λ₀: fastest rate of the tires at rest, 1/s. At a speed v it is `λ₀ ε/(v + ε)`.
    pub(super) fn tire_rate_at_rest_1_s(&self) -> f64 {
        self.fastest_rates_1_s().tires_1_s
    }

    /// `m_s g h`, N m/rad.
    fn weight_moment_n_m(&self) -> f64 {
        self.mass.sprung_mass_kg * STANDARD_GRAVITY_M_S2 * self.suspension.roll_arm_m
    }

    /// Longest step that follows the roll of the body, s.
    pub(super) fn roll_step_s(&self) -> f64 {
        MAX_RATE_TIMES_STEP / self.roll_rate_bound_1_s()
    }

    fn fastest_rates_1_s(&self) -> Rates {
        let (mass, geometry, tires) = (&self.mass, &self.geometry, &self.tires);
        let yaw_inertia = mass.yaw_inertia_kg_m2 * self.uncoupled_share();
        let determinant = yaw_inertia * mass.roll_inertia_kg_m2;
        let by_roll =
            mass.sprung_mass_kg * self.suspension.roll_arm_m * mass.roll_yaw_product_kg_m2.abs()
                / determinant;
        let axle = |coefficient: f64, arm_m: f64| {
            let at_rest = coefficient * STANDARD_GRAVITY_M_S2 / SLIP_ANGLE_SPEED_M_S;
            at_rest * (1.0 + mass.mass_kg * arm_m * (arm_m / yaw_inertia) + arm_m * by_roll)
        };
        let half_track_m = geometry.track_width_m / 2.0;
        Rates {
            tires_1_s: axle(tires.cornering_coefficient_front_per_rad, geometry.cg_to_front_axle_m)
                .max(axle(tires.cornering_coefficient_rear_per_rad, geometry.cg_to_rear_axle_m)),
            rolling_1_s: tires.rolling_resistance * STANDARD_GRAVITY_M_S2
                / ROLLING_RESISTANCE_SPEED_M_S
                * (1.0 + mass.mass_kg * half_track_m * half_track_m / yaw_inertia),
            roll_1_s: self.roll_rate_bound_1_s(),
        }
    }

    /// Fastest decay of a motion on locked wheels, 1/s: `max(κ, 1) μ g/ε (1 + m x²/I_zz')`.
    ///
    /// - `friction`: the largest friction of the ground.
    fn braked_rate_1_s(&self, friction: f64) -> f64 {
        let (mass, geometry) = (&self.mass, &self.geometry);
        let arm_m = geometry.cg_to_front_axle_m.max(geometry.cg_to_rear_axle_m);
        let arm_m = arm_m.hypot(geometry.track_width_m / 2.0);
        let yaw_inertia = mass.yaw_inertia_kg_m2 * self.uncoupled_share();
        let friction = friction * self.tires.longitudinal_friction_ratio.max(1.0);
        let at_rest = friction * STANDARD_GRAVITY_M_S2 / LOCKED_SLIDING_SPEED_M_S;
        at_rest * (1.0 + mass.mass_kg * arm_m * (arm_m / yaw_inertia))
    }

    fn roll_rate_bound_1_s(&self) -> f64 {
        let suspension = &self.suspension;
        let roll_inertia = self.mass.roll_inertia_kg_m2 * self.uncoupled_share();
        let stiffness = suspension.roll_stiffness_n_m_rad + self.weight_moment_n_m();
        (suspension.roll_damping_n_m_s_rad / roll_inertia).max((stiffness / roll_inertia).sqrt())
    }

    /// `1 − I_xz²/(I_zz I_xx)`.
    fn uncoupled_share(&self) -> f64 {
        let mass = &self.mass;
        let product = mass.roll_yaw_product_kg_m2;
        1.0 - product * product / (mass.yaw_inertia_kg_m2 * mass.roll_inertia_kg_m2)
    }
}

/// Bounds on the rates of the motion, 1/s.
struct Rates {
    tires_1_s: f64,
    rolling_1_s: f64,
    roll_1_s: f64,
}

fn parts(rate_1_s: f64, step_s: f64) -> usize {
    // A rate that is not finite is refused with the relations.
    (rate_1_s * step_s / MAX_RATE_TIMES_STEP).ceil().clamp(1.0, f64::from(u16::MAX)) as usize
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::data::Channel;
    use crate::vehicle::{Integrator, Manoeuvre, Motion, Preset, SimulationError, VehicleState};

    fn coasting(
        vehicle: &VehicleParameters,
        initial: VehicleState<f64>,
    ) -> Result<Motion, SimulationError> {
        let manoeuvre = Manoeuvre { initial, duration_s: 1.0, ..Manoeuvre::default() };
        vehicle.simulate(&manoeuvre, Integrator::Rk4)
    }

    #[test]
    fn the_steps_of_the_vehicles_of_the_program_are_not_divided() {
        for preset in Preset::ALL {
            let vehicle = preset.parameters();
            assert_eq!(vehicle.check_relations(), Ok(()), "{preset:?}");
            assert_eq!((vehicle.substeps(1e-3), vehicle.roll_substeps(0.01)), (1, 1), "{preset:?}");
        }
    }

    #[test]
    fn a_light_stiff_car_stops_instead_of_spinning_up() {
        // With steps of 1 ms its yaw rate grew without bound.
        let mut vehicle = Preset::Reference.parameters();
        vehicle.mass.yaw_inertia_kg_m2 = 200.0;
        vehicle.tires.cornering_coefficient_rear_per_rad = 60.0;
        assert!(vehicle.substeps(1e-3) > 1);
        let initial =
            VehicleState { vx_body_m_s: 1.0, yaw_rate_rad_s: 3.0, ..VehicleState::default() };
        let motion = coasting(&vehicle, initial).unwrap().series;
        let rates = motion.require(Channel::YawRate).unwrap();
        assert!(rates.last().unwrap().abs() < 0.1, "{rates:?}");
        assert!(rates.iter().all(|rate| rate.abs() <= 3.01), "{rates:?}");
    }

    #[test]
    fn a_body_that_falls_over_by_itself_is_refused_also_with_the_mass_of_a_case() {
        let mut vehicle = Preset::Reference.parameters().with_mass(2500.0, Some(1.0));
        let error = coasting(&vehicle, VehicleState::driving_straight(10.0)).unwrap_err();
        assert!(error.to_string().contains("mass.roll_yaw_product_kg_m2"), "{error}");
        vehicle = Preset::Reference.parameters();
        vehicle.suspension.roll_stiffness_n_m_rad = 5e3;
        let error = coasting(&vehicle, VehicleState::driving_straight(10.0)).unwrap_err();
        assert!(matches!(error, SimulationError::Vehicle(_)), "{error}");
        assert!(error.to_string().contains("suspension.roll_arm_m"), "{error}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn energy_does_not_grow_without_a_force(
            factors in prop::array::uniform10(-1.1..1.1_f64),
            speed in 0.1..40.0_f64, course in -3.2..3.2_f64, yaw_rate in -6.0..6.0_f64,
        ) {
            let mut vehicle = Preset::Reference.parameters();
            let changed = [
                &mut vehicle.mass.yaw_inertia_kg_m2,
                &mut vehicle.mass.roll_inertia_kg_m2,
                &mut vehicle.geometry.cg_to_front_axle_m,
                &mut vehicle.geometry.cg_to_rear_axle_m,
                &mut vehicle.geometry.track_width_m,
                &mut vehicle.geometry.cg_height_m,
                &mut vehicle.suspension.roll_stiffness_n_m_rad,
                &mut vehicle.suspension.roll_damping_n_m_s_rad,
                &mut vehicle.tires.cornering_coefficient_front_per_rad,
                &mut vehicle.tires.friction,
            ];
            for (value, factor) in changed.into_iter().zip(factors) {
                *value *= factor.exp();
            }
            let (sin, cos) = course.sin_cos();
            let initial = VehicleState {
                vx_body_m_s: speed * cos,
                vy_body_m_s: speed * sin,
                yaw_rate_rad_s: yaw_rate,
                ..VehicleState::default()
            };
            // A gain is an error, and so is a vehicle that is none.
            match coasting(&vehicle, initial) {
                Ok(motion) => {
                    let series = &motion.series;
                    let last = |channel| *series.require(channel).unwrap().last().unwrap();
                    let end = VehicleState {
                        vx_body_m_s: last(Channel::Vx),
                        vy_body_m_s: last(Channel::Vy),
                        yaw_rate_rad_s: last(Channel::YawRate),
                        roll_rad: last(Channel::Roll),
                        roll_rate_rad_s: last(Channel::RollRate),
                        ..VehicleState::default()
                    };
                    let share = vehicle.energy_j(&end) / vehicle.energy_j(&initial);
                    prop_assert!(share <= 1.01, "{share}");
                }
                Err(SimulationError::Vehicle(_) | SimulationError::EnergyGain { .. }) => {}
                Err(error) => prop_assert!(false, "{error}"),
            }
        }
    }
}
