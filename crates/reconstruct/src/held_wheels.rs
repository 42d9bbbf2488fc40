//! Wheels that damage holds in the motion of a particle.

use crate::evidence::After;
use crate::{Latent, LatentValues};
use impactlab_core::collision::Side;
use impactlab_core::vehicle::{DamagedWheel, Wheel};

/// When a wheel that an impact blocks is caught, s after the first contact.
pub(crate) const BLOCKED_FROM_S: f64 = 0.03;

/// Wheels of a car that damage holds or may hold.
#[derive(Debug, Clone)]
pub(crate) struct HeldWheels {
    pub after: After,
    pub near: [Wheel; 2],
    pub which: Latent,
    pub drag: Latent,
    /// When a held wheel is caught, s.
    pub from_s: f64,
}

impl HeldWheels {
    /// The wheels that are held in the motion of a particle.
    pub fn damage(&self, values: &LatentValues) -> Vec<DamagedWheel> {
        let locked =
            |wheel| DamagedWheel { wheel, start_s: self.from_s, drag_share_of_friction: None };
        let drag = values.get(self.drag);
        let dragged = |wheel| DamagedWheel {
            drag_share_of_friction: (drag < 1.0).then_some(drag),
            ..locked(wheel)
        };
        if !self.after.wheels_are_known() {
            let idx = values.blocked_of_two(self.which);
            return idx.map(|idx| dragged(self.near[idx])).into_iter().collect();
        }
        let blocked = self.after.blocked_wheels.iter().flatten().copied();
        let dragging = self.after.dragging_wheels.iter().flatten().copied();
        let dragging = dragging.filter(|wheel| !blocked.clone().any(|locked| locked == *wheel));
        blocked.clone().map(locked).chain(dragging.map(dragged)).collect()
    }
}

/// The two wheels next to the damage, the nearer one first.
pub(crate) fn wheels_near(side: Side, is_behind_cg: bool) -> [Wheel; 2] {
    match (side, is_behind_cg) {
        (Side::Left, true) => [Wheel::RearLeft, Wheel::FrontLeft],
        (Side::Left, false) => [Wheel::FrontLeft, Wheel::RearLeft],
        (Side::Right, true) => [Wheel::RearRight, Wheel::FrontRight],
        (Side::Right, false) => [Wheel::FrontRight, Wheel::RearRight],
        (Side::Front, _) => [Wheel::FrontLeft, Wheel::FrontRight],
        (Side::Rear, _) => [Wheel::RearLeft, Wheel::RearRight],
    }
}
