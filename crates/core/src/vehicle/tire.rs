//! Horizontal force of the road on one tire.
//!
//! Computes the lateral force, the rolling resistance and the drive or brake force of a wheel for
//! any motion of its centre: rolling forwards or backwards, sliding sideways, or at rest.
//! Source: simplified magic formula of [`PitPinnPaper`](crate::bibliography::PitPinnPaper),
//! `eq:tire_model`, `eq:tire_model3`.
//! Assumes a steady state (no relaxation length), no camber, no aligning moment, and friction that
//! does not depend on the load. The inertia of the wheel's spin counts where the vehicle turns under
//! it (see [`WheelSlip::force_n`]).
//!
//! Departures from the paper:
//! - The leading minus of `eq:tire_model` is omitted: with α = δ − atan(…) it would supply energy
//!   to the vehicle.
//! - The slip angle is α = −atan2(w, |u| + ε) in the axes of the wheel. It is also correct for a
//!   wheel that rolls backwards, where atan(w/u) has the wrong sign and atan2(w, u) gives the full
//!   lateral force at α = π. The force decreases linearly to zero as the wheel comes to rest.
//! - The stiffness factor is `C = c/μ` with the cornering coefficient c (cornering stiffness over
//!   vertical load). The slope at zero slip is then that of the tire for any friction of the road.
//! - Rolling resistance opposes the motion and vanishes at rest: −f(|u|) F_z tanh(u/u₀).
//! - A braked wheel stays inside the friction circle, and locks where the brake asks for more than
//!   the road can hold (see [`WheelSlip::force_n`]).
//! - Friction may decrease from its peak to a sliding value as the slip angle grows (see
//!   [`TireParameters`]).

use serde::{Deserialize, Serialize};

use crate::numerics::{Four, Lanes};
use crate::vehicle::constants::TireConstants;

/// Regularisation ε of the slip angle, m/s. Near standstill the lateral force is proportional to
/// the lateral velocity, which decays at a rate of c g / ε ≈ 400 1/s; the reference step of 1 ms
/// resolves this.
pub const SLIP_ANGLE_SPEED_M_S: f64 = 0.5;

/// Speed u₀ below which the rolling resistance decreases to zero, m/s.
pub(super) const ROLLING_RESISTANCE_SPEED_M_S: f64 = 0.05;

/// Slip angle over which friction decreases from its peak to its sliding value, rad. It is about
/// three times the slip angle at the peak (0.15 to 0.17 rad for the reference tires), since car
/// tires slide fully at a slip of 0.6 to 0.8. The value was chosen and not fitted;
/// `docs/VALIDATION.md` reports the results for other values.
const SLIDING_SLIP_ANGLE_RAD: f64 = 0.5;

/// Sliding speed below which the force on a locked wheel decreases to zero, m/s. A vehicle on locked
/// wheels then comes to rest at a rate of μ g / ε ≈ 160 1/s, without chatter.
pub(super) const LOCKED_SLIDING_SPEED_M_S: f64 = 0.05;

/// By how much the braking force must exceed what the road can hold until the wheel is locked, as a
/// share of the latter. In between the wheel slips more and more.
pub(super) const LOCKING_SHARE: f64 = 0.15;

/// Regularisation ε of the slip S of a wheel whose spin lags, m/s.
const SPIN_LAG_SLIP_M_S: f64 = 0.2;

/// Share of the friction that is taken for the force of a wheel whose spin lags where it has less.
const LEAST_LAGGING_SHARE: f64 = 0.2;

/// Passes through slip, time constant and rolling speed of a wheel whose spin lags. With four of them
/// the mean error over the shipped trajectories changes by 0.002 m or less.
const SPIN_LAG_PASSES: usize = 2;

/// Equivalent mass of a spinning wheel as a share of the mass of the vehicle, where nobody states the
/// inertia: median of 13 multibody cars, which lie between 0.0095 and 0.0137.
pub(super) const WHEEL_MASS_SHARE: f64 = 0.0115;

/// Parameters of the tires of one vehicle and of the road under them. Both axles have the same
/// friction and rolling resistance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TireParameters {
    /// Cornering coefficient c of the front tires, 1/rad: cornering stiffness over vertical load.
    pub cornering_coefficient_front_per_rad: f64,
    /// Cornering coefficient c of the rear tires, 1/rad: cornering stiffness over vertical load.
    pub cornering_coefficient_rear_per_rad: f64,
    /// Peak friction coefficient μ between tire and road.
    pub friction: f64,
    /// Ratio of sliding friction to peak friction. With a value of 1, friction does not decrease
    /// beyond the peak.
    pub sliding_friction_ratio: f64,
    /// Constant part f_r0 of the rolling resistance coefficient f = f_r0 + f_r1 |u| + f_r2 u².
    pub rolling_resistance: f64,
    /// Coefficient f_r1 of the part of f that is proportional to the speed of the wheel, s/m.
    pub rolling_resistance_s_m: f64,
    /// Coefficient f_r2 of the part of f that is proportional to the square of the speed, s²/m². It
    /// may represent the air drag of the vehicle.
    pub rolling_resistance_s2_m2: f64,
    /// Rolling radius of the tires, m, by which a torque becomes a force at the road.
    #[serde(default = "usual_rolling_radius_m")]
    pub rolling_radius_m: f64,
    /// Moment of inertia I_w of one wheel with its tire about its axis of rotation, kg m². With a
    /// value of 0 a wheel follows every change of speed at once.
    #[serde(default)]
    pub wheel_inertia_kg_m2: f64,
    /// Friction κ of a wheel along its plane over that across it, of its peak and of sliding alike.
    #[serde(default = "same_in_all_directions", skip_serializing_if = "is_same_in_all_directions")]
    pub longitudinal_friction_ratio: f64,
}

/// A wheel that holds along its plane what it holds across it.
pub(in crate::vehicle) const SAME_IN_ALL_DIRECTIONS: f64 = 1.0;

fn same_in_all_directions() -> f64 {
    SAME_IN_ALL_DIRECTIONS
}

fn is_same_in_all_directions(ratio: &f64) -> bool {
    *ratio == SAME_IN_ALL_DIRECTIONS
}

/// Rolling radius of a usual car tire, such as 205/55 R16, m.
fn usual_rolling_radius_m() -> f64 {
    0.31
}

/// Quantities of the tire force that depend on the motion of a wheel only, and not on its vertical
/// load.
#[derive(Debug, Clone, Copy)]
pub struct WheelSlip<T> {
    /// Slip angle α, rad, −π/2 to π/2.
    pub slip_angle_rad: T,
    /// Friction coefficient μ(α) at this slip angle.
    friction: T,
    /// C α. The lateral force over its limit is `sin(atan(C α))`.
    stiffness: T,
    /// `1/((C α)² + 1)`.
    flattening: T,
    /// Rolling resistance over vertical load, with a sign opposite to the motion.
    rolling_share: T,
    /// Direction in which the wheel rolls, −1 to 1, smooth at rest.
    direction: T,
    /// Velocity `[u, w]` of the centre of the wheel in the axes of the wheel, m/s.
    velocity_m_s: [T; 2],
    /// `m_w r`: equivalent mass of the spinning wheel times the yaw rate of the vehicle, kg/s.
    turning_mass_kg_s: T,
    /// Sliding friction coefficient of a locked wheel across its plane.
    locked_friction: T,
    /// κ.
    longitudinal_ratio: T,
    /// 1/κ.
    per_longitudinal_ratio: T,
}

/// What the road holds of a wheel.
#[derive(Debug, Clone, Copy)]
pub(super) struct WheelHold {
    /// Largest force across the wheel, μ(α) F_z, N.
    pub friction_n: f64,
    /// Largest braking force F_max, beyond which the wheel locks, N; see [`WheelSlip::force_n`].
    pub largest_braking_n: f64,
    /// Slip angle α, rad.
    pub slip_angle_rad: f64,
}

/// Forces over vertical load of a wheel that rolls freely: those of [`WheelSlip`], which are in
/// proportion to the load but for the lag of the spin.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeWheel<T> {
    slip: WheelSlip<T>,
    /// Rolling resistance.
    along: T,
    /// Side force without lag.
    side: T,
    /// Force that the lag is taken from.
    size: T,
    /// Drag of a lag of one.
    drag: T,
}

/// What drives, brakes or locks a wheel, beside its rolling resistance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelEffort<T> {
    /// Drive torque over the rolling radius of the tire, N, positive forwards.
    pub drive_n: T,
    /// Torque of brake, engine or bent bodywork against the rotation of the wheel, over the rolling
    /// radius, N, 0 or more. It acts against the rolling in either direction and holds at rest.
    pub braking_n: T,
    /// 1 for a wheel that cannot turn, 0 for one that can.
    pub locked: T,
}

impl<T: From<f64>> WheelEffort<T> {
    /// A wheel that rolls freely.
    pub fn none() -> Self {
        Self { drive_n: T::from(0.0), braking_n: T::from(0.0), locked: T::from(0.0) }
    }
}

impl WheelEffort<f64> {
    /// [`WheelEffort::none`] as a constant.
    pub const FREE: Self = Self { drive_n: 0.0, braking_n: 0.0, locked: 0.0 };
}

impl<T> WheelEffort<T> {
    /// Converts every component to another scalar type.
    pub fn map<U>(self, convert: impl Fn(T) -> U) -> WheelEffort<U> {
        let Self { drive_n, braking_n, locked } = self;
        WheelEffort {
            drive_n: convert(drive_n),
            braking_n: convert(braking_n),
            locked: convert(locked),
        }
    }
}

/// Width of a tire over its rolling radius where nobody says it: 0.2 m for 0.31 m.
pub const TIRE_WIDTH_RATIO: f64 = 0.65;

impl TireParameters {
    /// Width of a tire by a rule, m: 0.65 rolling radii, as of 205/55 R16.
    pub fn width_m(&self) -> f64 {
        TIRE_WIDTH_RATIO * self.rolling_radius_m
    }

    /// Equivalent mass `m_w = I_w/R²` of a spinning wheel, kg.
    pub fn wheel_mass_kg(&self) -> f64 {
        self.wheel_inertia_kg_m2 / (self.rolling_radius_m * self.rolling_radius_m)
    }
}

impl<T: Lanes> TireConstants<T> {
    /// The tires on a ground of another friction: peak, sliding and locked friction change alike.
    ///
    /// The cornering stiffness stays, as it belongs to the tire: C = c/μ is divided by the share.
    ///
    /// - `share`: friction of the ground over that of the tires.
    #[inline(always)]
    pub(super) fn on_ground(mut self, share: T) -> Self {
        self.friction *= share;
        self.sliding_friction *= share;
        self
    }

    /// Computes slip angle, friction and rolling resistance of a wheel, or of four.
    ///
    /// - `stiffness_1_rad`: C of the wheel, 1/rad;
    /// - `velocity_m_s`: velocity `[u, w]` of its centre in the axes of the wheel, m/s, with u in its
    ///   plane and w to the left;
    /// - `yaw_rate_rad_s`: yaw rate r of the vehicle, rad/s.
    #[inline(always)]
    pub(super) fn slip(
        &self,
        stiffness_1_rad: T,
        velocity_m_s: [T; 2],
        yaw_rate_rad_s: T,
    ) -> WheelSlip<T> {
        let [u, w] = velocity_m_s;
        let (zero, one) = (u.constant(0.0), u.constant(1.0));
        let speed = u.abs();
        // This equals −atan2(w, |u| + ε), since |u| + ε is positive.
        let slip_angle_rad = (-w).atan_ratio(speed + SLIP_ANGLE_SPEED_M_S);
        let beyond_peak = slip_angle_rad * slip_angle_rad * SLIDING_SLIP_ANGLE_RAD.powi(-2);
        let sliding_loss = match zero.any_less(self.sliding_loss) {
            true => (one - (-beyond_peak).exp()) * self.sliding_loss,
            false => zero,
        };
        let stiffness = slip_angle_rad * stiffness_1_rad;
        let resistance = speed * speed * self.rolling_resistance_s2_m2
            + speed * self.rolling_resistance_s_m
            + self.rolling_resistance;
        let direction = (u * (1.0 / ROLLING_RESISTANCE_SPEED_M_S)).smooth_sign();
        WheelSlip {
            slip_angle_rad,
            friction: (one - sliding_loss) * self.friction,
            stiffness,
            flattening: (stiffness * stiffness + 1.0).recip(),
            rolling_share: -resistance * direction,
            direction,
            velocity_m_s,
            turning_mass_kg_s: yaw_rate_rad_s * self.wheel_mass_kg,
            locked_friction: self.sliding_friction,
            longitudinal_ratio: self.longitudinal_ratio,
            per_longitudinal_ratio: self.per_longitudinal_ratio,
        }
    }
}

impl<T: Lanes> FreeWheel<T> {
    /// Force `[F_x, F_y]` of the road on the wheel in its axes, N: that of [`WheelSlip::force_n`]
    /// without an effort.
    #[inline(always)]
    pub(super) fn force_n(&self, vertical_load_n: T) -> [T; 2] {
        let [lag, across] = self.slip.spin_lag(self.size * vertical_load_n);
        let force_n = [
            (self.along - self.drag * lag) * vertical_load_n,
            self.side * across * vertical_load_n,
        ];
        in_circle(force_n, self.slip.friction * vertical_load_n)
    }
}

/// A force, scaled to the friction circle of this radius where it is larger.
#[inline(always)]
fn in_circle<T: Lanes>([fx, fy]: [T; 2], limit_n: T) -> [T; 2] {
    let (squared, limit) = (fx * fx + fy * fy, limit_n * limit_n + 1e-12);
    if !limit.any_less(squared) {
        return [fx, fy];
    }
    let scale = limit.if_less(squared, (limit / squared).sqrt(), fx.constant(1.0));
    [fx * scale, fy * scale]
}

impl<T: Lanes> WheelSlip<T> {
    /// What the force on the wheel needs if it rolls freely.
    #[inline(always)]
    pub(super) fn free(self) -> FreeWheel<T> {
        let (along, side) = self.shared(self.rolling_share, self.friction);
        let squared = side * side;
        let size = lagging(squared, self.friction);
        FreeWheel { slip: self, along, side, size, drag: squared / size }
    }

    /// Force `[F_x, F_y]` of the road on the tire in the axes of the wheel, N, which lies inside the
    /// friction ellipse `(F_x/κ)² + F_y² = (μ F_z)²`, a circle if the wheel holds as much along its
    /// plane as across it (κ = 1).
    ///
    /// ```text
    /// turning   F_w = clamp(F_drive − f(|u|) F_z tanh(u/u₀) − F_brake tanh(u/u₀), ±κ μ(α) F_z)
    ///           F_y = sin(atan(C α)) √((μ(α) F_z)² − (F_w/κ)²) |w|/S
    ///           F_x = F_w − |F_y| (u − u_w)/|w|              both scaled to the ellipse
    /// locked    F   = −μ_s F_z [κ u, w]/√(u² + w² + ε²)      μ_s: sliding friction across the wheel
    /// F = (1 − λ) F_turning + λ F_locked
    /// ```
    ///
    /// The road can turn a wheel against a brake with at most F_max = κ μ(α) F_z |u|/√(u² + w²), the
    /// part of the friction along the wheel: a wheel that slides sideways is locked by little
    /// braking, one that rolls straight only by more than κ μ F_z. The share λ of the locked state
    /// grows from 0 to 1 while the braking force grows from F_max to 1.15 F_max.
    ///
    /// A wheel under a large slip angle has little grip along its plane. The vehicle turns under it
    /// at the yaw rate r, and the speed u along its plane changes by r w; the wheel is spun up or
    /// down with a delay τ, so that its circumference moves at u_w and not at u. In a steady rotation
    ///
    /// ```text
    /// u_w = (u − τ r w)/(1 + (r τ)²)    τ = m_w S/|F|    S² = (u − u_w)² + w²    m_w = I_w/R²
    /// ```
    ///
    /// with |F| the force of the tire without the delay. At small slip angles F_x is the inertia
    /// force −m_w r w; of a spinning car it is a drag.
    /// Source of the wheel with slip: H. B. Pacejka, Tire and Vehicle Dynamics, 3rd ed., 2012,
    /// sections 1.2 and 8.2; the solution for a steady rotation is ours.
    ///
    /// - `vertical_load_n`: vertical load F_z, N, 0 or more.
    #[inline(always)]
    pub fn force_n(&self, vertical_load_n: T, effort: &WheelEffort<T>) -> [T; 2] {
        let wanted = self.rolling_share * vertical_load_n + effort.drive_n
            - effort.braking_n * self.direction;
        let turning = self.turning_n(vertical_load_n, wanted);
        let share = self.locked_share(vertical_load_n, effort);
        if !share.constant(0.0).any_less(share) {
            return turning;
        }
        let [u, w] = self.velocity_m_s;
        let speed_squared = u * u + w * w;
        let sliding = (speed_squared + LOCKED_SLIDING_SPEED_M_S.powi(2)).sqrt();
        let sliding_n = -vertical_load_n * self.locked_friction / sliding;
        let locked = [sliding_n * self.longitudinal_ratio * u, sliding_n * w];
        [
            turning[0] + (locked[0] - turning[0]) * share,
            turning[1] + (locked[1] - turning[1]) * share,
        ]
    }

    /// Force on a wheel that turns, N.
    ///
    /// - `wanted_n`: the force along the wheel that drive, brake and rolling resistance ask for.
    #[inline(always)]
    fn turning_n(&self, vertical_load_n: T, wanted_n: T) -> [T; 2] {
        let limit = self.friction * vertical_load_n;
        let (along, side) = self.shared(wanted_n * self.per_longitudinal_ratio, limit);
        let squared = side * side;
        let size = lagging(squared, limit);
        let [lag, across] = self.spin_lag(size);
        let drag = squared / size * lag * self.per_longitudinal_ratio;
        let [fx, fy] = in_circle([along - drag, side * across], limit);
        [fx * self.longitudinal_ratio, fy]
    }

    /// The force along the wheel within the limit of friction, and the side force in what it leaves:
    /// x/√(x² + 1) equals sin(atan(x)) and needs no trigonometric functions.
    #[inline(always)]
    fn shared(&self, wanted: T, limit: T) -> (T, T) {
        // If the longitudinal force reaches the limit, there is no lateral force. The root is not
        // used there, because its derivative at zero is infinite.
        let along = wanted.abs().if_less(limit, wanted, limit * wanted.sign());
        let room = (limit * limit - wanted * wanted) * self.flattening;
        let side = self.stiffness * room.sqrt();
        (along, wanted.abs().if_less(limit, side, wanted.constant(0.0)))
    }

    /// `[(u − u_w)/S, √(w² + ε²)/S]`: the direction of the slip of a wheel whose spin lags.
    ///
    /// Numerators and denominators are kept apart until the end, since divisions take longest:
    /// with `r τ = a/b`
    ///
    /// ```text
    /// u − u_w = a (u a + w b)/(a² + b²)
    /// ```
    ///
    /// - `force_n`: force of the tire without the lag, N.
    #[inline(always)]
    fn spin_lag(&self, force_n: T) -> [T; 2] {
        let [u, w] = self.velocity_m_s;
        // A micronewton more than nothing, so that the lag of a lifted wheel is a number.
        let force_n = force_n + 1e-6;
        let rest = w * w + SPIN_LAG_SLIP_M_S * SPIN_LAG_SLIP_M_S;
        let across = rest.sqrt();
        let (mut lag, mut slip, mut below) = (w.constant(0.0), across, w.constant(1.0));
        for _ in 0..SPIN_LAG_PASSES {
            let (a, b) = (self.turning_mass_kg_s * slip, force_n * below);
            below = a * a + b * b;
            lag = a * (u * a + w * b);
            slip = (lag * lag + rest * (below * below)).sqrt();
        }
        let per_slip = slip.recip();
        [lag * per_slip, across * below * per_slip]
    }

    /// How far the wheel is locked, 0 to 1.
    #[inline(always)]
    fn locked_share(&self, vertical_load_n: T, effort: &WheelEffort<T>) -> T {
        let (zero, one) = (self.friction.constant(0.0), self.friction.constant(1.0));
        let largest_n = self.largest_braking_n(vertical_load_n);
        let beyond = (effort.braking_n - largest_n) / (largest_n * LOCKING_SHARE + 1e-3);
        let by_brake = beyond.clamped(zero, one);
        by_brake + (one - by_brake) * effort.locked
    }

    /// F_max, N.
    #[inline(always)]
    fn largest_braking_n(&self, vertical_load_n: T) -> T {
        let [u, w] = self.velocity_m_s;
        // A millimetre per second more than nothing, so that it is a number at rest.
        let along = u.abs() / (u * u + w * w + 1e-6).sqrt();
        self.friction * self.longitudinal_ratio * vertical_load_n * along
    }
}

impl WheelSlip<Four<f64>> {
    /// What the road holds of the four wheels.
    pub(super) fn holds(&self, vertical_loads_n: [f64; 4]) -> [WheelHold; 4] {
        let loads = Four(vertical_loads_n);
        let Four(friction_n) = self.friction * loads;
        let Four(largest_n) = self.largest_braking_n(loads);
        let Four(angles_rad) = self.slip_angle_rad;
        std::array::from_fn(|wheel| WheelHold {
            friction_n: friction_n[wheel],
            largest_braking_n: largest_n[wheel],
            slip_angle_rad: angles_rad[wheel],
        })
    }
}

/// Size of the force that the lag of the spin is taken from: smooth where the wheel changes from left
/// to right, and nowhere more than the side force; a number with a derivative also without friction.
#[inline(always)]
fn lagging<T: Lanes>(side_squared: T, limit: T) -> T {
    let floor = limit * LEAST_LAGGING_SHARE;
    (side_squared + floor * floor + 1e-30).sqrt()
}

#[cfg(test)]
#[path = "tire_tests.rs"]
mod tests;
