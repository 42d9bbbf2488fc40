//! The input of the equations of motion: steer angle, drive and brakes of the wheels, ground below them,
//! collision force.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::numerics::Lanes;
use crate::vehicle::tire::WheelEffort;

/// Point of the vehicle at which the collision force acts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactPoint<T = f64> {
    /// Coordinate x of the point in body axes, m: its distance in front of the CG.
    #[serde(rename = "x_m")]
    pub x_body_m: T,
    /// Coordinate y of the point in body axes, m: its distance to the left of the CG.
    #[serde(rename = "y_m")]
    pub y_body_m: T,
    /// Height of the point above the ground, m.
    pub height_m: T,
}

/// Collision force that acts ON the vehicle at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollisionForce<T> {
    /// Force `[F_x, F_y]` in world or body axes, N.
    pub force_n: [T; 2],
    /// Whether `force_n` is given in world axes, so that it has to be rotated by the yaw angle ψ
    /// into body axes.
    pub in_world_axes: bool,
    /// Yaw moment about the CG, N m. If it is `None`, the moment `x_c F_y − y_c F_x` of the force
    /// at the contact point is used.
    pub yaw_moment_n_m: Option<T>,
    /// Contact point.
    pub contact: ContactPoint<T>,
}

/// Input u(t) of the equations of motion: steer angle, drive and brakes of the wheels, collision
/// force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleInput<T> {
    /// Steer angle δ of the front road wheels, rad, positive to the left.
    pub steer_rad: T,
    /// What drives, brakes or locks each wheel, in the order of [`Wheel::ALL`](crate::vehicle::Wheel::ALL). With `None` all
    /// wheels roll freely.
    pub wheels: Option<[WheelEffort<T>; 4]>,
    /// Friction of the ground under each wheel over that of the tires of the vehicle, more than 0, in
    /// the same order. With `None` it is that of the tires.
    pub friction_share: Option<[T; 4]>,
    /// Collision force; `None` if there is no contact.
    pub collision: Option<CollisionForce<T>>,
}

impl<T: From<f64>> VehicleInput<T> {
    /// Input of a vehicle that coasts: steering wheel, throttle and brake are released (δ = 0, all
    /// wheels roll freely) and there is no contact.
    pub fn released() -> Self {
        Self { steer_rad: T::from(0.0), wheels: None, friction_share: None, collision: None }
    }
}

impl VehicleInput<f64> {
    /// [`VehicleInput::released`] as a constant.
    pub const RELEASED: Self =
        Self { steer_rad: 0.0, wheels: None, friction_share: None, collision: None };

    /// Whether something brakes or locks a wheel.
    pub fn is_braked(&self) -> bool {
        self.wheels.iter().flatten().any(|wheel| wheel.braking_n > 0.0 || wheel.locked > 0.0)
    }
}

impl<T: Lanes> VehicleInput<T> {
    /// Whether a wheel is driven, so that the energy of the vehicle may grow.
    pub fn is_driven(&self) -> bool {
        let is_driven = |force_n: T| force_n.constant(0.0).any_less(force_n.abs());
        self.wheels.iter().flatten().any(|wheel| is_driven(wheel.drive_n))
    }

    /// Converts every component to another scalar type.
    #[inline(always)]
    pub fn map<U: Lanes>(self, convert: impl Fn(T) -> U + Copy) -> VehicleInput<U> {
        VehicleInput {
            steer_rad: convert(self.steer_rad),
            wheels: self.wheels.map(|wheels| wheels.map(|wheel| wheel.map(convert))),
            friction_share: self.friction_share.map(|shares| shares.map(convert)),
            collision: self.collision.map(|collision| CollisionForce {
                force_n: collision.force_n.map(convert),
                in_world_axes: collision.in_world_axes,
                yaw_moment_n_m: collision.yaw_moment_n_m.map(convert),
                contact: ContactPoint {
                    x_body_m: convert(collision.contact.x_body_m),
                    y_body_m: convert(collision.contact.y_body_m),
                    height_m: convert(collision.contact.height_m),
                },
            }),
        }
    }
}
