//! Two vehicles that may touch each other, and one as seen from the other.

use crate::collision::contact::{ContactOutline, FaceLaws};
use crate::numerics::Lanes;
use crate::vehicle::VehicleState;
use crate::vehicle::frames::Heading;

/// Coefficient of friction between vehicles where nobody says it; it lies between 0.1 and 0.9, with a
/// standard deviation of [`CONTACT_FRICTION_SIGMA`]. [`EdsmacManual`](crate::bibliography::EdsmacManual)
/// has 0.55, fits to finite-element runs 0.3; pushing pairs come out nearest with 0.42, which holds for
/// what this law leaves out as well (wheels and corners that hook).
pub const CONTACT_FRICTION: f64 = 0.42;

/// Standard deviation of the coefficient of friction between vehicles.
pub const CONTACT_FRICTION_SIGMA: f64 = 0.12;

/// Sliding speed ζ from which on there is full friction, m/s.
pub const FULL_FRICTION_SPEED_M_S: f64 = 0.2;

/// c: damping of faces that are pressed in again, s/m: the bounces at the beginning of a steady push on
/// tires end within 3 s.
pub const CONTACT_DAMPING_S_M: f64 = 3.0;

/// Height of the contact force above the ground where nobody says it, m: of bumpers and sills. Recorded
/// pairs without a height have it, whose own lie at 0.47 to 0.57 m; a scenario says how high its contact is.
pub const CONTACT_HEIGHT_M: f64 = 0.5;

/// What the contact of two vehicles has beside their faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactConditions {
    /// Coefficient μ_c of friction between the vehicles, 0 or more.
    pub friction: f64,
    /// c: damping of faces that are pressed in again, s/m, 0 or more.
    pub damping_s_m: f64,
    /// Height of the contact force above the ground, m, 0 or more.
    pub height_m: f64,
}

impl Default for ContactConditions {
    fn default() -> Self {
        Self {
            friction: CONTACT_FRICTION,
            damping_s_m: CONTACT_DAMPING_S_M,
            height_m: CONTACT_HEIGHT_M,
        }
    }
}

/// A vehicle that another one may touch.
#[derive(Debug, Clone, Copy)]
pub struct ContactBody<'a> {
    /// Its outline.
    pub outline: &'a ContactOutline,
    /// Laws of its faces.
    pub faces: FaceLaws,
}

/// Position and velocity of a vehicle in the plane, world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarMotion {
    /// Position `[X, Y]` of the CG, m.
    pub position_m: [f64; 2],
    /// Yaw angle ψ, rad.
    pub yaw_rad: f64,
    /// Velocity of the CG, m/s.
    pub velocity_m_s: [f64; 2],
    /// Yaw rate r, rad/s.
    pub yaw_rate_rad_s: f64,
}

impl From<&VehicleState<f64>> for PlanarMotion {
    fn from(x: &VehicleState<f64>) -> Self {
        let heading = Heading::new(x.yaw_rad);
        Self {
            position_m: [x.x_m, x.y_m],
            yaw_rad: x.yaw_rad,
            velocity_m_s: heading.world_from_body([x.vx_body_m_s, x.vy_body_m_s]),
            yaw_rate_rad_s: x.yaw_rate_rad_s,
        }
    }
}

impl PlanarMotion {
    /// The motion after a time with its present velocities.
    pub fn after(&self, time_s: f64) -> Self {
        let ([x, y], [vx, vy]) = (self.position_m, self.velocity_m_s);
        Self {
            position_m: [x + vx * time_s, y + vy * time_s],
            yaw_rad: self.yaw_rad + self.yaw_rate_rad_s * time_s,
            ..*self
        }
    }
}

/// One vehicle as seen from another one, whose outline it enters, in body axes of the latter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Relative {
    /// Sine and cosine of the difference of their yaw angles.
    pub turn: [f64; 2],
    /// CG of the vehicle, m.
    offset_m: [f64; 2],
    /// Velocity of its CG relative to that of the vehicle that is entered, m/s.
    velocity_m_s: [f64; 2],
    /// Yaw rates of the vehicle and of the one that is entered, rad/s.
    yaw_rates_rad_s: [f64; 2],
}

impl Relative {
    pub fn new(motions: &[PlanarMotion; 2], own: usize) -> Self {
        let (own, entered) = (&motions[own], &motions[1 - own]);
        let heading = Heading::new(entered.yaw_rad);
        let between = |own: [f64; 2], entered: [f64; 2]| {
            heading.body_from_world([own[0] - entered[0], own[1] - entered[1]])
        };
        let (sin, cos) = Lanes::sin_cos(own.yaw_rad - entered.yaw_rad);
        Self {
            turn: [sin, cos],
            offset_m: between(own.position_m, entered.position_m),
            velocity_m_s: between(own.velocity_m_s, entered.velocity_m_s),
            yaw_rates_rad_s: [own.yaw_rate_rad_s, entered.yaw_rate_rad_s],
        }
    }

    pub fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [sin, cos] = self.turn;
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// A point of the vehicle in the axes of the one that is entered, m.
    pub fn entered_from_own(&self, point_m: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turned(point_m);
        [x + self.offset_m[0], y + self.offset_m[1]]
    }

    /// Velocity of the vehicle at a place, relative to that of the vehicle that is entered, m/s.
    pub fn velocity_at_m_s(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [own, entered] = self.yaw_rates_rad_s;
        let [dx, dy] = [x - self.offset_m[0], y - self.offset_m[1]];
        let [vx, vy] = self.velocity_m_s;
        [vx - own * dy + entered * y, vy + own * dx - entered * x]
    }
}
