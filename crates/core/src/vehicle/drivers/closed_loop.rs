//! What acts on a vehicle by the motion of the vehicle itself, beside the histories of [`Controls`].
//!
//! [`Controls`]: crate::vehicle::Controls

use crate::vehicle::drivers::{AntiLock, Countersteer, PitDriver, StabilityControl};
use crate::vehicle::{Braking, Ending};

/// Drivers and systems that act by what they see of the motion.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ClosedLoop {
    /// Stability control.
    pub esc: Option<StabilityControl>,
    /// Anti-lock system of the service brake.
    pub abs: Option<AntiLock>,
    /// Pedal of the service brake, which the anti-lock system watches.
    pub brake: Option<Braking>,
    /// The driver countersteers.
    pub countersteer: Option<Countersteer>,
    /// The driver carries out a PIT. He steers until the wheels are straight again; then the one who
    /// countersteers may.
    pub pit: Option<PitDriver>,
}

impl ClosedLoop {
    /// The part of an ending that acts by the motion; `None` if there is none. A car with a stability
    /// control has an anti-lock system, as it is part of it.
    pub(in crate::vehicle) fn from_ending(ending: &Ending) -> Option<Self> {
        let abs = ending.anti_lock();
        let closed_loop = Self {
            esc: ending.esc,
            abs,
            brake: ending.brake.filter(|_| abs.is_some()),
            countersteer: ending.countersteer,
            pit: ending.pit,
        };
        let acts = closed_loop.acts_on_wheels() || closed_loop.steers();
        acts.then_some(closed_loop)
    }

    /// Whether it brakes or drives wheels.
    pub fn acts_on_wheels(&self) -> bool {
        self.esc.is_some() || self.brake.is_some() || self.pit.is_some()
    }

    /// Whether it steers.
    pub fn steers(&self) -> bool {
        self.countersteer.is_some() || self.pit.is_some()
    }

    /// Whether it drives wheels.
    pub fn drives(&self) -> bool {
        self.pit.is_some()
    }

    /// The last instant at which something begins or changes by the clock alone, s.
    pub(in crate::vehicle) fn last_change_s(&self) -> f64 {
        let brake = self.brake.map(|brake| brake.start_s + brake.rise_s);
        let reaction = self.countersteer.map(|driver| driver.delay_s);
        let pit = self.pit.and_then(|driver| driver.longest_s);
        [brake, reaction, pit].into_iter().flatten().fold(0.0, f64::max)
    }
}
