//! The energy of an impact.

use crate::collision::impact::{dot, multiply};
use crate::numerics::Scalar;

/// Kinetic energy that two vehicles lose in an impact, J: the work of the contact force along the
/// relative motion of the contact points.
///
/// ```text
/// ∫ F·v_rel dt = v_rel(0)·P − ½ Pᵀ K P
/// ```
///
/// The energy depends on the impulse alone and not on the history of the force, because `v_rel(t) =
/// v_rel(0) − K ∫₀ᵗ F dt` for rigid bodies. The paper's `½ m_eff V_rel² (1 − e²)`
/// (`eq:physic_cons2`) is the special case of a central impact along the normal.
///
/// - `relative_velocity_m_s`: velocity of the contact point of the striking vehicle relative to
///   that of the struck vehicle before the impact, m/s;
/// - `inverse_mass_1_kg`: inverse mass matrix `[2, 2]` of [`Impact::inverse_mass_1_kg`](crate::collision::Impact::inverse_mass_1_kg), 1/kg;
/// - `impulse_n_s`: impulse on the struck vehicle, N s.
///
/// All three arguments are in the same axes.
pub fn contact_work_j<T: Scalar>(
    relative_velocity_m_s: [T; 2],
    inverse_mass_1_kg: [[T; 2]; 2],
    impulse_n_s: [T; 2],
) -> T {
    let loss_of_velocity = multiply(inverse_mass_1_kg, impulse_n_s);
    dot(relative_velocity_m_s, impulse_n_s) - dot(impulse_n_s, loss_of_velocity) * 0.5
}
