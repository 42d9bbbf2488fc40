//! The state of the 4DOF vehicle and its kinematics.

use crate::numerics::Lanes;
use crate::vehicle::frames::Heading;

/// State x = [v_x, v_y, ψ, r, φ, φ̇, X, Y] of the vehicle (`eq:state_vector`). Velocities are in
/// body axes, the position is in world axes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct VehicleState<T> {
    /// Velocity v_x of the CG along the x axis of the body (forward), m/s.
    pub vx_body_m_s: T,
    /// Velocity v_y of the CG along the y axis of the body (to the left), m/s.
    pub vy_body_m_s: T,
    /// Yaw angle ψ, rad, counter-clockwise positive.
    pub yaw_rad: T,
    /// Yaw rate r, rad/s, counter-clockwise positive.
    pub yaw_rate_rad_s: T,
    /// Roll angle φ, rad, positive if the body leans to the right.
    pub roll_rad: T,
    /// Roll rate φ̇, rad/s.
    pub roll_rate_rad_s: T,
    /// Position X of the CG in world axes, m.
    pub x_m: T,
    /// Position Y of the CG in world axes, m.
    pub y_m: T,
}

/// Number of components of the state.
pub const N_STATE: usize = 8;

/// Number of components of the state that are velocities: v_x, v_y, r, φ̇.
pub const N_ACCELERATION: usize = 4;

impl<T: Lanes> VehicleState<T> {
    /// Converts the state to an array in the order of `eq:state_vector`, `[8]`.
    #[inline(always)]
    pub fn to_array(self) -> [T; N_STATE] {
        let Self {
            vx_body_m_s,
            vy_body_m_s,
            yaw_rad,
            yaw_rate_rad_s,
            roll_rad,
            roll_rate_rad_s,
            x_m,
            y_m,
        } = self;
        [vx_body_m_s, vy_body_m_s, yaw_rad, yaw_rate_rad_s, roll_rad, roll_rate_rad_s, x_m, y_m]
    }

    /// Creates the state from an array in the order of `eq:state_vector`, `[8]`.
    #[inline(always)]
    pub fn from_array(array: [T; N_STATE]) -> Self {
        let [
            vx_body_m_s,
            vy_body_m_s,
            yaw_rad,
            yaw_rate_rad_s,
            roll_rad,
            roll_rate_rad_s,
            x_m,
            y_m,
        ] = array;
        Self {
            vx_body_m_s,
            vy_body_m_s,
            yaw_rad,
            yaw_rate_rad_s,
            roll_rad,
            roll_rate_rad_s,
            x_m,
            y_m,
        }
    }

    /// Converts every component to another scalar type.
    #[inline(always)]
    pub fn map<U: Lanes>(self, convert: impl Fn(T) -> U) -> VehicleState<U> {
        VehicleState::from_array(self.to_array().map(convert))
    }

    /// A time derivative of the state with further accelerations.
    ///
    /// - `acceleration`: v̇_x, v̇_y in m/s², ṙ, φ̈ in rad/s².
    #[inline(always)]
    #[must_use]
    pub fn accelerated(mut self, acceleration: [T; N_ACCELERATION]) -> Self {
        let [ax, ay, yaw, roll] = acceleration;
        self.vx_body_m_s += ax;
        self.vy_body_m_s += ay;
        self.yaw_rate_rad_s += yaw;
        self.roll_rate_rad_s += roll;
        self
    }

    /// The same pose without any motion.
    pub(crate) fn at_rest(self) -> Self {
        let still = self.x_m.constant(0.0);
        Self {
            vx_body_m_s: still,
            vy_body_m_s: still,
            yaw_rate_rad_s: still,
            roll_rate_rad_s: still,
            ..self
        }
    }

    /// The components [X, Y, ψ, v_x, v_y, r] of the planar motion, by which trajectories are
    /// compared.
    pub fn planar(&self) -> [T; 6] {
        [self.x_m, self.y_m, self.yaw_rad, self.vx_body_m_s, self.vy_body_m_s, self.yaw_rate_rad_s]
    }
}

impl<T: Lanes> VehicleState<T> {
    /// Time derivative ẋ of the state, from its heading, the acceleration `[a_x, a_y]` of the CG in
    /// body axes, m/s², and the angular accelerations `[ṙ, φ̈]`, rad/s².
    ///
    /// ```text
    /// v̇_x = a_x + v_y r      v̇_y = a_y − v_x r
    /// Ẋ = v_x cos ψ − v_y sin ψ      Ẏ = v_x sin ψ + v_y cos ψ
    /// ```
    #[inline(always)]
    pub fn derivative(
        &self,
        heading: Heading<T>,
        [ax, ay]: [T; 2],
        [yaw_acceleration, roll_acceleration]: [T; 2],
    ) -> Self {
        let [x_dot, y_dot] = heading.world_from_body([self.vx_body_m_s, self.vy_body_m_s]);
        Self {
            vx_body_m_s: ax + self.vy_body_m_s * self.yaw_rate_rad_s,
            vy_body_m_s: ay - self.vx_body_m_s * self.yaw_rate_rad_s,
            yaw_rad: self.yaw_rate_rad_s,
            yaw_rate_rad_s: yaw_acceleration,
            roll_rad: self.roll_rate_rad_s,
            roll_rate_rad_s: roll_acceleration,
            x_m: x_dot,
            y_m: y_dot,
        }
    }
}

impl VehicleState<f64> {
    /// State of a vehicle at the origin of the world axes that drives straight ahead along X at a
    /// given speed, m/s.
    pub fn driving_straight(speed_m_s: f64) -> Self {
        Self { vx_body_m_s: speed_m_s, ..Self::default() }
    }
}
