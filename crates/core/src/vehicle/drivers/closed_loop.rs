//! What acts on a vehicle by the motion of the vehicle itself, beside the histories of [`Controls`].
//!
//! [`Controls`]: crate::vehicle::Controls

use crate::vehicle::drivers::numbers::keep_said;
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

    /// Standard normal variables that [`ClosedLoop::drawn`] takes.
    pub const N_DRAWN: usize =
        StabilityControl::N_DRAWN + AntiLock::N_DRAWN + Countersteer::N_DRAWN + PitDriver::N_DRAWN;

    /// The same with every number drawn that nobody said, see `drawn` of each driver and system. A number
    /// that differs from the usual one was said.
    ///
    /// - `z`: standard normal variables, in their order.
    #[must_use]
    pub fn drawn(&self, z: [f64; Self::N_DRAWN]) -> Self {
        let mut normals = z.into_iter();
        let esc_z = take(&mut normals);
        let abs_z = take(&mut normals);
        let countersteer_z = take(&mut normals);
        let pit_z = take(&mut normals);
        let esc = self.esc.map(|mut known| {
            let mut drawn = StabilityControl::drawn(esc_z);
            let mut usual = StabilityControl::default();
            keep_said(known.numbers(), usual.numbers(), drawn.numbers());
            drawn
        });
        let abs = self.abs.map(|mut known| {
            let mut drawn = AntiLock::drawn(abs_z);
            keep_said(known.numbers(), AntiLock::default().numbers(), drawn.numbers());
            drawn
        });
        let countersteer = self.countersteer.map(|mut known| {
            let mut drawn = Countersteer::drawn(countersteer_z);
            keep_said(known.numbers(), Countersteer::default().numbers(), drawn.numbers());
            drawn
        });
        let pit = self.pit.map(|mut known| {
            let (mut drawn, mut usual) = (known.drawn(pit_z), PitDriver::default());
            if known.end != usual.end {
                drawn.end = known.end;
            }
            keep_said(known.numbers(), usual.numbers(), drawn.numbers());
            drawn
        });
        Self { esc, abs, countersteer, pit, ..self.clone() }
    }

    /// What [`ClosedLoop::drawn`] draws, for a person; empty where nothing acts.
    pub fn distributions(&self) -> Vec<&'static str> {
        let all = [
            (
                self.esc.is_some(),
                "stability control: threshold 4 to 8 deg/s, full braking from 0.15 to \
             0.35 rad/s of error, slip 0.1 to 0.15, rear share 0.25 to 0.75, dead time 0.1 to 0.2 s, \
             rise 0.15 to 0.25 s, gives up at 30° to 60° of side slip or, in a third, never",
            ),
            (self.abs.is_some(), "anti-lock system: 0.9 to 0.98 of the peak friction"),
            (
                self.countersteer.is_some(),
                "countersteering: after 0.4 to 1.8 s (90 %, median 0.8), at up \
             to 180° to 540° and 300 to 500 deg/s of the steering wheel, gains on side slip 0.6 to 1.4 \
             and on the yaw rate 0 to 0.3 s",
            ),
            (
                self.pit.is_some(),
                "driver of the PIT: 90° to 180° of the steering wheel within 0.2 to \
             0.5 s, up to 2 to 4 m/s², until the struck car has turned by 30° to 90°, each end equally \
             likely",
            ),
        ];
        all.into_iter().filter(|(acts, _)| *acts).map(|(_, text)| text).collect()
    }

    /// The last instant at which something begins or changes by the clock alone, s.
    pub(in crate::vehicle) fn last_change_s(&self) -> f64 {
        let brake = self.brake.map(|brake| brake.start_s + brake.rise_s);
        let reaction = self.countersteer.map(|driver| driver.delay_s);
        let pit = self.pit.and_then(|driver| driver.longest_s);
        [brake, reaction, pit].into_iter().flatten().fold(0.0, f64::max)
    }
}

fn take<const N: usize>(normals: &mut impl Iterator<Item = f64>) -> [f64; N] {
    std::array::from_fn(|_| normals.next().unwrap_or(0.0))
}
