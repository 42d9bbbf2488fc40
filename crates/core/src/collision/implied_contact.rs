//! Restitution and impulse ratio that a known impulse implies: the inverse of the planar impact.

use crate::collision::impact::{dot, multiply, perpendicular};
use crate::collision::{Impact, contact_work_j};

/// Coefficient of restitution and impulse ratio that a known impulse implies; see
/// [`Impact::implied_contact`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpliedContact {
    /// Coefficient of restitution e. It lies outside the interval from 0 to 1 if the model of rigid
    /// bodies does not fit the impulse.
    pub restitution: f64,
    /// Impulse ratio `P_τ / P_n`, with the sign of `P_τ`.
    pub impulse_ratio: f64,
}

/// What many impulses imply that may each have acted, such as draws of a predicted force; see
/// [`Impact::implied_contacts`].
#[derive(Debug, Clone, PartialEq)]
pub struct ImpliedContacts {
    /// Of each impulse that implies one.
    pub contacts: Vec<ImpliedContact>,
    /// Share of the impulses with a restitution between 0 and 1.
    pub p_rigid: f64,
    /// Share of the impulses that would add kinetic energy to the two vehicles.
    pub p_energy_gain: f64,
}

impl Impact<f64> {
    /// What each of many impulses implies, and how many of them no contact of two bodies brings about.
    ///
    /// - `impulses_world_n_s`: impulses on the struck vehicle in world axes, N s.
    pub fn implied_contacts(&self, impulses_world_n_s: &[[f64; 2]]) -> ImpliedContacts {
        let implied = |impulse: &[f64; 2]| self.implied_contact(*impulse);
        let contacts: Vec<ImpliedContact> = impulses_world_n_s.iter().filter_map(implied).collect();
        let (v, k) = (self.relative_velocity_m_s(), self.inverse_mass_1_kg());
        let gains = |impulse: &&[f64; 2]| contact_work_j(v, k, **impulse) < 0.0;
        let rigid = contacts.iter().filter(|contact| (0.0..=1.0).contains(&contact.restitution));
        let share = |n: usize| n as f64 / impulses_world_n_s.len() as f64;
        ImpliedContacts {
            p_rigid: share(rigid.count()),
            p_energy_gain: share(impulses_world_n_s.iter().filter(gains).count()),
            contacts,
        }
    }

    /// Computes the coefficient of restitution and the impulse ratio that a known impulse implies,
    /// for instance a measured one. This is the inverse of [`Impact::solve`].
    ///
    /// ```text
    /// e = (K P)·n / v_n − 1          P_τ / P_n
    /// ```
    ///
    /// Only the normal of the contact surface is used.
    ///
    /// - `impulse_n_s`: impulse on the struck vehicle in world axes, N s.
    /// - returns `None` if the contact points do not approach each other before the impact, or if
    ///   the normal component of the impulse is not positive.
    pub fn implied_contact(&self, impulse_n_s: [f64; 2]) -> Option<ImpliedContact> {
        let normal = self.surface.normal();
        let closing = dot(self.relative_velocity_m_s(), normal);
        let p_n = dot(impulse_n_s, normal);
        let restored = dot(multiply(self.inverse_mass_1_kg(), impulse_n_s), normal);
        (closing > 0.0 && p_n > 0.0).then(|| ImpliedContact {
            restitution: restored / closing - 1.0,
            impulse_ratio: dot(impulse_n_s, perpendicular(normal)) / p_n,
        })
    }
}
