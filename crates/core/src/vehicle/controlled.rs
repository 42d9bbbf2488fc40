//! A vehicle with what acts on its wheels and the ground under them.

use crate::vehicle::{
    Controls, FrictionZone, TireParameters, VehicleParameters, Wheel, friction_at,
};

/// A vehicle with what brakes and locks its wheels, and the ground that it moves on.
#[derive(Debug, Clone, Copy)]
pub struct ControlledVehicle<'a> {
    /// The vehicle, whose tires have the friction of the ground outside the zones.
    pub vehicle: &'a VehicleParameters,
    /// What steers, drives, brakes and locks the wheels.
    pub controls: &'a Controls,
    /// Parts of the ground with their own friction.
    pub friction_zones: &'a [FrictionZone],
}

impl ControlledVehicle<'_> {
    /// The tires with the friction of the ground at a place `[X, Y]`, m.
    pub fn tires_at(&self, place_m: [f64; 2]) -> TireParameters {
        let tires = self.vehicle.tires;
        TireParameters {
            friction: friction_at(self.friction_zones, place_m, tires.friction),
            ..tires
        }
    }

    /// Whether a wheel is locked, see [`Controls::is_locked`], on the ground at its place.
    ///
    /// - `place_m`: place `[X, Y]` of the wheel, m;
    /// - `velocity_m_s`: velocity of its centre along and across its own plane, m/s;
    /// - `load_n`: its vertical load, N.
    pub fn is_locked(
        &self,
        time_s: f64,
        wheel: Wheel,
        place_m: [f64; 2],
        velocity_m_s: [f64; 2],
        load_n: f64,
    ) -> bool {
        let tires = self.tires_at(place_m);
        self.controls.is_locked(time_s, wheel, velocity_m_s, load_n, &tires)
    }
}
