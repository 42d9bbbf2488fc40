//! Restitution and impulse ratio that a known impulse implies: the inverse of the planar impact.

use crate::collision::Impact;
use crate::collision::impact::{dot, multiply, perpendicular};

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

impl Impact<f64> {
    /// Computes the coefficient of restitution and the impulse ratio that a known impulse implies,
    /// for instance a measured one. This is the inverse of [`Impact::solve`].
    ///
    /// ```text
    /// e = (K P)·n / v_n − 1          P_τ / P_n
    /// ```
    ///
    /// Only the normal of the contact surface is used.
    ///
    /// - `impulse_n_s`: impulse on the target in world axes, N s.
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
