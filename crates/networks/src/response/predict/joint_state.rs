//! ξ: the state of the vehicle and the latent factors in one vector, the order that the joint
//! distribution of a motion has them in.
//!
//! ```text
//! ξ = [v_x, v_y, r, φ, φ̇, z_1 … z_m, ψ, X, Y]
//! ```

use nalgebra::{SMatrix, SVector};

use crate::response::N_RESIDUAL;
use crate::response::predict::latents::{N_LATENTS, N_OF_COLLISION};
use impactlab_core::vehicle::VehicleState;

/// Number of components of ξ.
pub(crate) const N_JOINT: usize = 8 + N_LATENTS;
/// The first components of ξ, on which the features of the network depend: velocities and roll.
pub(super) const N_SEEN: usize = 5;
/// The first components of ξ, on which the step depends: these and the latent factors.
pub(super) const N_DYNAMIC: usize = N_SEEN + N_LATENTS;
/// Place of the heading in ξ.
pub(super) const PSI: usize = N_DYNAMIC;
/// Place of X in ξ.
pub(super) const X: usize = N_DYNAMIC + 1;
/// Place of Y in ξ.
pub(super) const Y: usize = N_DYNAMIC + 2;
/// Places in ξ of the components to which each step adds noise: v_x, v_y, r, φ̇.
pub(super) const NOISY: [usize; N_RESIDUAL] = [0, 1, 2, 4];
/// Places in ξ of the latent factors of the collision, which matter as long as a force acts.
pub(super) const OF_COLLISION: [usize; N_OF_COLLISION] = [N_DYNAMIC - 2, N_DYNAMIC - 1];
/// Variance that is added to every component of ξ so that no covariance is singular.
pub(super) const LEAST_VARIANCE: f64 = 1e-12;

pub(super) type Mean = SVector<f64, N_JOINT>;
pub(super) type Covariance = SMatrix<f64, N_JOINT, N_JOINT>;

/// The offset of a sigma point from the centre after a step, where the step was taken from the mean's
/// pose and the point has another.
///
/// - `offset`: offset from the centre of the step from the mean's pose;
/// - `[dx, dy]`: displacement in that step, m;
/// - `pose`: offset of the point's pose from the mean's, with sine and cosine of its heading.
#[inline]
pub(super) fn turned(offset: &Mean, [dx, dy]: [f64; 2], pose: &Mean, [sin, cos]: [f64; 2]) -> Mean {
    let mut offset = offset + pose;
    offset[X] += cos * dx - sin * dy - dx;
    offset[Y] += sin * dx + cos * dy - dy;
    offset
}

/// The vector ξ of a state with latent factors.
#[inline]
pub(super) fn mean_of(x: &VehicleState<f64>, latents: &[f64; N_LATENTS]) -> Mean {
    let mut mean = Mean::zeros();
    let state = [x.vx_body_m_s, x.vy_body_m_s, x.yaw_rate_rad_s, x.roll_rad, x.roll_rate_rad_s];
    for (slot, value) in mean.iter_mut().zip(state.iter().chain(latents)) {
        *slot = *value;
    }
    mean[PSI] = x.yaw_rad;
    mean[X] = x.x_m;
    mean[Y] = x.y_m;
    mean
}

/// The state in a vector ξ.
#[inline]
pub(super) fn state_of(point: &Mean) -> VehicleState<f64> {
    VehicleState {
        vx_body_m_s: point[0],
        vy_body_m_s: point[1],
        yaw_rate_rad_s: point[2],
        roll_rad: point[3],
        roll_rate_rad_s: point[4],
        yaw_rad: point[PSI],
        x_m: point[X],
        y_m: point[Y],
    }
}

/// The latent factors in a vector ξ.
#[inline]
pub(super) fn latents_of(point: &Mean) -> [f64; N_LATENTS] {
    std::array::from_fn(|m| point[N_SEEN + m])
}

/// Takes the latent factors of the collision out of the distribution once the collision is over.
pub(super) fn forget(covariance: &mut Covariance) {
    for i in OF_COLLISION {
        covariance.fill_row(i, 0.0);
        covariance.fill_column(i, 0.0);
        covariance[(i, i)] = LEAST_VARIANCE;
    }
}
