//! The mechanical energy of the 4DOF vehicle, which nothing but a force, a drive, the slope of the road or
//! work on the roll model may increase.

use crate::numerics::{Lanes, LanesOver};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::{VehicleConstants, VehicleParameters, VehicleState};

impl VehicleParameters {
    /// Kinetic energy and potential of roll, J; zero for an upright vehicle at rest.
    ///
    /// ```text
    /// E = m (v_x² + v_y²)/2 + I_zz r²/2 + I_xz r φ̇ + I_xx φ̇²/2 + K_φ φ²/2 − m_s g h (1 − cos φ)
    /// ```
    pub fn energy_j(&self, x: &VehicleState<f64>) -> f64 {
        let (mass, suspension) = (&self.mass, &self.suspension);
        let (yaw_rate, roll_rate) = (x.yaw_rate_rad_s, x.roll_rate_rad_s);
        let speed_squared = x.vx_body_m_s * x.vx_body_m_s + x.vy_body_m_s * x.vy_body_m_s;
        let kinetic = mass.mass_kg * speed_squared
            + mass.yaw_inertia_kg_m2 * yaw_rate * yaw_rate
            + 2.0 * mass.roll_yaw_product_kg_m2 * yaw_rate * roll_rate
            + mass.roll_inertia_kg_m2 * roll_rate * roll_rate;
        let weight_moment = mass.sprung_mass_kg * STANDARD_GRAVITY_M_S2 * suspension.roll_arm_m;
        // 1 − cos φ = 2 sin²(φ/2), which does not lose its digits at a small roll angle.
        let lowered = 2.0 * (x.roll_rad / 2.0).sin().powi(2);
        let springs = suspension.roll_stiffness_n_m_rad * x.roll_rad * x.roll_rad / 2.0;
        kinetic / 2.0 + springs - weight_moment * lowered
    }
}

impl<P: Copy> VehicleConstants<P> {
    /// Energy of the planar motion, `m (v_x² + v_y²)/2 + I_zz r²/2`, J.
    #[inline(always)]
    pub fn planar_energy_j<T: Lanes + LanesOver<P>>(&self, x: &VehicleState<T>) -> T {
        let speed_squared = x.vx_body_m_s * x.vx_body_m_s + x.vy_body_m_s * x.vy_body_m_s;
        let spin_squared = x.yaw_rate_rad_s * x.yaw_rate_rad_s;
        speed_squared * self.body.half_mass_kg + spin_squared * self.body.half_yaw_inertia_kg_m2
    }

    /// Energy of the planar motion at one place, with what the weight gives on the way to another one of a
    /// road with a slope, J. Below zero, the vehicle does not get there by itself.
    #[inline(always)]
    pub fn energy_brought_j<T: Lanes + LanesOver<P>>(
        &self,
        from: &VehicleState<T>,
        to: &VehicleState<T>,
    ) -> T {
        let kinetic_j = self.planar_energy_j(from);
        match self.slope_m_s2 {
            None => kinetic_j,
            Some([g_x, g_y]) => {
                let along = (to.x_m - from.x_m) * g_x + (to.y_m - from.y_m) * g_y;
                kinetic_j + along * self.body.half_mass_kg * 2.0
            }
        }
    }

    /// A state whose velocities are scaled down where its planar motion has more than this energy.
    ///
    /// - `most_j`: J; below zero as zero.
    #[inline(always)]
    pub fn with_energy_up_to<T: Lanes + LanesOver<P>>(
        &self,
        mut x: VehicleState<T>,
        most_j: T,
    ) -> VehicleState<T> {
        let (energy_j, none) = (self.planar_energy_j(&x), most_j.constant(0.0));
        let most_j = most_j.if_less(none, none, most_j);
        if most_j.any_less(energy_j) {
            let share = most_j.if_less(energy_j, (most_j / energy_j).sqrt(), none.constant(1.0));
            x.vx_body_m_s *= share;
            x.vy_body_m_s *= share;
            x.yaw_rate_rad_s *= share;
        }
        x
    }

    /// The end of a step over which nothing pushes or drives the vehicle, with the energy that it has
    /// brought along at most.
    #[inline(always)]
    pub fn without_energy_gain<T: Lanes + LanesOver<P>>(
        &self,
        before: &VehicleState<T>,
        after: VehicleState<T>,
    ) -> VehicleState<T> {
        self.with_energy_up_to(after, self.energy_brought_j(before, &after))
    }
}

/// Growth of the energy without a force beyond which a motion is wrong, as a share of the energy at
/// the end of the force. The roll model takes some energy from the tires that it does not take from
/// the planar motion, since a wheel is not moved sideways by roll; of ordinary vehicles, that is less
/// than a tenth of this.
pub const MAX_ENERGY_GAIN: f64 = 0.01;

/// Speed of a vehicle whose energy is too small to grow, m/s.
const NEGLIGIBLE_SPEED_M_S: f64 = 1e-3;

/// The energy of a vehicle along its motion, while nothing pushes it.
#[derive(Debug, Default)]
pub(super) struct EnergyWatch {
    /// Since the end of the force; `None` before the first sample and while a force acts.
    released: Option<Released>,
}

/// What the energy is compared with.
#[derive(Debug, Clone, Copy)]
struct Released {
    /// Energy at the end of the force, J.
    energy_j: f64,
    /// Energy that the weight had given along the slope of the road by then, J.
    by_slope_j: f64,
    /// The lowest energy since then, less what the weight has given, J.
    lowest_j: f64,
}

impl EnergyWatch {
    /// Growth above the lowest energy since the force has ended, as a share of the energy at its end and of
    /// what the slope of the road exchanges.
    ///
    /// - `is_pushed`: whether a force acts over the interval that begins.
    pub(super) fn gain(
        &mut self,
        vehicle: &VehicleParameters,
        x: &VehicleState<f64>,
        is_pushed: bool,
    ) -> f64 {
        let energy_j = vehicle.energy_j(x);
        let [g_x, g_y] = vehicle.slope.gravity_m_s2();
        let by_slope_j = vehicle.mass.mass_kg * (g_x * x.x_m + g_y * x.y_m);
        let own_j = energy_j - by_slope_j;
        let negligible_j = vehicle.mass.mass_kg * NEGLIGIBLE_SPEED_M_S.powi(2) / 2.0;
        let released = self.released.unwrap_or(Released { energy_j, by_slope_j, lowest_j: own_j });
        let lowest_j = released.lowest_j.min(own_j);
        self.released = (!is_pushed).then_some(Released { lowest_j, ..released });
        let exchanged_j =
            (by_slope_j - released.by_slope_j).abs() + lean_on_slope_j(vehicle) / MAX_ENERGY_GAIN;
        (own_j - released.lowest_j) / (released.energy_j + exchanged_j + negligible_j)
    }
}

/// Most energy that the body takes up where it leans on a road with a slope, J: that of twice its steady
/// lean.
fn lean_on_slope_j(vehicle: &VehicleParameters) -> f64 {
    let [g_x, g_y] = vehicle.slope.gravity_m_s2();
    let moment = vehicle.mass.sprung_mass_kg * vehicle.suspension.roll_arm_m * g_x.hypot(g_y);
    2.0 * moment * moment / vehicle.suspension.roll_stiffness_n_m_rad
}
