//! What acts on a vehicle by the motion of the vehicle itself, beside the histories of [`Controls`].
//!
//! [`Controls`]: crate::vehicle::Controls

use crate::units::{Phrase, PhraseValue};
use crate::vehicle::drivers::{AntiLock, Countersteer, FollowedSpeed, PitDriver, StabilityControl};
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
    /// The driver keeps a speed that is known over time.
    pub followed_speed: Option<FollowedSpeed>,
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
            followed_speed: None,
        };
        let acts = closed_loop.acts_on_wheels() || closed_loop.steers();
        acts.then_some(closed_loop)
    }

    /// Whether it brakes or drives wheels.
    pub fn acts_on_wheels(&self) -> bool {
        self.esc.is_some() || self.brake.is_some() || self.drives()
    }

    /// Whether it steers.
    pub fn steers(&self) -> bool {
        self.countersteer.is_some() || self.pit.is_some()
    }

    /// Whether it drives wheels.
    pub fn drives(&self) -> bool {
        self.pit.is_some() || self.followed_speed.is_some()
    }

    /// Standard normal variables that [`ClosedLoop::drawn`] takes.
    pub const N_DRAWN: usize =
        StabilityControl::N_DRAWN + AntiLock::N_DRAWN + Countersteer::N_DRAWN + PitDriver::N_DRAWN;

    /// The same with every number drawn that is not stated, see `drawn` of each driver and system.
    ///
    /// - `z`: standard normal variables, in their order.
    #[must_use]
    pub fn drawn(&self, z: [f64; Self::N_DRAWN]) -> Self {
        let mut normals = z.into_iter();
        let esc_z = take(&mut normals);
        let abs_z = take(&mut normals);
        let countersteer_z = take(&mut normals);
        let pit_z = take(&mut normals);
        Self {
            esc: self.esc.map(|esc| esc.drawn(esc_z)),
            abs: self.abs.map(|abs| abs.drawn(abs_z)),
            brake: self.brake,
            countersteer: self.countersteer.map(|driver| driver.drawn(countersteer_z)),
            pit: self.pit.map(|driver| driver.drawn(pit_z)),
            followed_speed: self.followed_speed.clone(),
        }
    }

    /// What [`ClosedLoop::drawn`] draws, for a person; empty where nothing acts or everything is stated.
    pub fn distributions(&self) -> Vec<Phrase> {
        let all = [
            (
                Phrase::new("stability control", "Fahrdynamikregelung (ESC)"),
                self.esc.as_ref().map(StabilityControl::distributions),
            ),
            (
                Phrase::new("anti-lock system", "Antiblockiersystem"),
                self.abs.as_ref().map(AntiLock::distributions),
            ),
            (
                Phrase::new("countersteering", "Gegenlenken"),
                self.countersteer.as_ref().map(Countersteer::distributions),
            ),
            (
                Phrase::new("driver of the PIT", "Fahrer, der das PIT ausführt"),
                self.pit.as_ref().map(PitDriver::distributions),
            ),
        ];
        all.into_iter()
            .filter_map(|(name, drawn)| Some((name, drawn.filter(|drawn| !drawn.is_empty())?)))
            .map(|(name, drawn)| {
                Phrase::new("{0}: {1}", "{0}: {1}")
                    .with(PhraseValue::phrase(name))
                    .with(PhraseValue::phrase(Phrase::joined(drawn, ", ")))
            })
            .collect()
    }

    /// The last instant at which something begins or changes by the clock alone, s.
    pub(in crate::vehicle) fn last_change_s(&self) -> f64 {
        let brake = self.brake.map(|brake| brake.start_s + brake.rise_s);
        let reaction = self.countersteer.map(|driver| driver.acting().delay_s);
        let pit = self.pit.and_then(|driver| driver.longest_s);
        let followed = self.followed_speed.as_ref().and_then(FollowedSpeed::last_change_s);
        [brake, reaction, pit, followed].into_iter().flatten().fold(0.0, f64::max)
    }
}

fn take<const N: usize>(normals: &mut impl Iterator<Item = f64>) -> [f64; N] {
    std::array::from_fn(|_| normals.next().unwrap_or(0.0))
}
