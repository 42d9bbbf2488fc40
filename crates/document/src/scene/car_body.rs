//! Outer dimensions of a car, from which its picture is built.

use crate::scene::BodyClass;
use impactlab_core::collision::Footprint;
use impactlab_core::vehicle::{TIRE_WIDTH_RATIO, VehicleParameters, Wheel};

/// Wheels of a car, in the order of [`Wheel::ALL`].
pub const N_WHEELS: usize = 4;

/// Share of the half width of the body within which the outer side of a tire lies.
const TIRE_INSIDE: f64 = 0.985;

/// Outer dimensions of a car and places of its wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarBody {
    /// Kind of body.
    pub class: BodyClass,
    /// Outer length, m.
    pub length_m: f64,
    /// Outer width without mirrors, m.
    pub width_m: f64,
    /// Height of the roof above the ground, m.
    pub height_m: f64,
    /// Distance from the CG to the front end, m.
    pub front_m: f64,
    /// Distances from the CG to the front axle, forward, and to the rear axle, backward, m.
    pub axles_m: [f64; 2],
    /// Distance between the middles of the wheels of an axle, m.
    pub track_m: f64,
    /// Radius of the wheels, m.
    pub wheel_radius_m: f64,
}

impl CarBody {
    /// The body of a vehicle; the outline is that of the figures, which a scenario may set.
    pub fn new(vehicle: &VehicleParameters, outline: &Footprint) -> Self {
        let class = BodyClass::from_vehicle(vehicle);
        Self {
            class,
            length_m: outline.length_m,
            width_m: outline.width_m,
            height_m: class.roof_height_m(vehicle.geometry.cg_height_m),
            front_m: outline.cg_from_front_m,
            axles_m: [vehicle.geometry.cg_to_front_axle_m, vehicle.geometry.cg_to_rear_axle_m],
            track_m: vehicle.geometry.track_width_m,
            wheel_radius_m: vehicle.tires.rolling_radius_m,
        }
    }

    /// x of the rear end, m; negative.
    pub fn rear_m(&self) -> f64 {
        self.front_m - self.length_m
    }

    /// Width of a tire, m.
    pub fn wheel_width_m(&self) -> f64 {
        TIRE_WIDTH_RATIO * self.wheel_radius_m
    }

    /// Centre of a wheel in body axes, m. A track that is wider than the body is drawn as wide as the
    /// body allows.
    pub fn wheel_m(&self, wheel: Wheel) -> [f64; 3] {
        let [front, rear] = self.axles_m;
        let x = if wheel.is_front() { front } else { -rear };
        let widest = TIRE_INSIDE * self.width_m / 2.0 - self.wheel_width_m() / 2.0;
        let side = (self.track_m / 2.0).min(widest.max(0.0));
        let is_left = matches!(wheel, Wheel::FrontLeft | Wheel::RearLeft);
        [x, if is_left { side } else { -side }, self.wheel_radius_m]
    }
}
