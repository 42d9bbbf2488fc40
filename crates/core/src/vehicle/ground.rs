//! The friction of the ground under each wheel of a vehicle, where it has zones.

use crate::vehicle::frames::Heading;
use crate::vehicle::{FrictionZone, VehicleParameters, VehicleState, Wheel};

/// Distance from the CG within which a zone may be under a wheel before the next step ends, m.
const NEAR_M: f64 = 5.0;

/// Zones of the ground, prepared for one vehicle. The friction under a wheel is that of the place on
/// the ground below its centre at the start of a step; it is held over the step.
#[derive(Debug, Clone)]
pub(super) struct Ground<'a> {
    zones: Vec<PreparedZone<'a>>,
    /// Places of the wheels in the axes of the vehicle, m.
    wheels_m: [[f64; 2]; 4],
}

/// A zone with what is asked first.
#[derive(Debug, Clone)]
struct PreparedZone<'a> {
    zone: &'a FrictionZone,
    /// Lowest and highest `[X, Y]` of the border, m.
    box_m: [[f64; 2]; 2],
    /// Friction of the zone over that of the tires of the vehicle.
    share: f64,
}

impl<'a> Ground<'a> {
    pub fn new(zones: &'a [FrictionZone], vehicle: &VehicleParameters) -> Self {
        let prepared = |zone: &'a FrictionZone| {
            let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            for corner in &zone.border_m {
                for axis in 0..2 {
                    low[axis] = low[axis].min(corner[axis]);
                    high[axis] = high[axis].max(corner[axis]);
                }
            }
            let share = zone.friction / vehicle.tires.friction;
            PreparedZone { zone, box_m: [low, high], share }
        };
        let wheels_m = Wheel::ALL.map(|wheel| vehicle.geometry.wheel_place_m(wheel));
        Self { zones: zones.iter().map(prepared).collect(), wheels_m }
    }

    /// Whether there are zones.
    pub fn has_zones(&self) -> bool {
        !self.zones.is_empty()
    }

    /// Whether a zone is so near that a wheel may stand in it within the next step.
    pub fn has_zones_near(&self, x: &VehicleState<f64>) -> bool {
        let place_m = [x.x_m, x.y_m];
        self.zones.iter().any(|zone| {
            let [low, high] = zone.box_m;
            (0..2).all(|axis| (low[axis] - NEAR_M..=high[axis] + NEAR_M).contains(&place_m[axis]))
        })
    }

    /// Friction of the ground under each wheel over that of the tires, in the order of
    /// [`Wheel::ALL`]; `None` where no wheel stands in a zone.
    pub fn friction_share(&self, x: &VehicleState<f64>) -> Option<[f64; 4]> {
        if self.zones.is_empty() {
            return None;
        }
        let heading = Heading::new(x.yaw_rad);
        let of_wheels = self.wheels_m.map(|place_m| {
            let [dx, dy] = heading.world_from_body(place_m);
            self.zone_share([x.x_m + dx, x.y_m + dy])
        });
        let stands_in_zone = of_wheels.iter().any(Option::is_some);
        stands_in_zone.then(|| of_wheels.map(|share| share.unwrap_or(1.0)))
    }

    /// Friction over that of the tires in the zone at a place; `None` where there is none.
    fn zone_share(&self, place_m: [f64; 2]) -> Option<f64> {
        let zone = self.zones.iter().rev().find(|zone| zone.holds(place_m))?;
        Some(zone.share)
    }
}

impl PreparedZone<'_> {
    fn holds(&self, place_m: [f64; 2]) -> bool {
        let [low, high] = self.box_m;
        let is_near = |axis: usize| (low[axis]..=high[axis]).contains(&place_m[axis]);
        is_near(0) && is_near(1) && self.zone.holds(place_m)
    }
}

#[cfg(test)]
#[path = "ground_tests.rs"]
mod tests;
