//! The sums of a half pass: the elements of one vehicle in the outline of the other one (`force.rs`).

use crate::collision::contact::bodies::Relative;
use crate::collision::contact::{
    ContactConditions, ContactForce, FULL_FRICTION_SPEED_M_S, PlanarMotion,
};
use crate::vehicle::frames::Heading;

/// The sums over the elements of a half pass, in body axes of the vehicle whose outline is entered.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PassSums {
    /// On the vehicle whose elements they are.
    pub force_n: [f64; 2],
    /// About the CG of the vehicle that is entered, N m.
    pub moment_n_m: f64,
    pub size_n: f64,
    pub size_times_place_n_m: [f64; 2],
    pub normal_load_n: f64,
    pub overlap_m: f64,
    pub unloading_stiffness_n_per_m: f64,
    pub friction_power_w: f64,
    pub normal_power_w: f64,
}

/// An element that is pressed by its partner.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PressedElement {
    /// Normal load without damping, N.
    pub load_n: f64,
    /// Largest load with damping, N; `None` where a face is pressed in further than before.
    pub limit_n: Option<f64>,
    /// Deflection of the element, m.
    pub deflection_m: f64,
    pub unloading_stiffness_n_per_m: f64,
}

impl PassSums {
    /// Adds an element with its normal load and the friction that it causes.
    pub(super) fn add(
        &mut self,
        pressed: &PressedElement,
        conditions: &ContactConditions,
        place_m: [f64; 2],
        [nx, ny]: [f64; 2],
        relative: &Relative,
    ) {
        let [vx, vy] = relative.velocity_at_m_s(place_m);
        let approach_m_s = -(vx * nx + vy * ny);
        let damping = 1.0 + conditions.damping_s_m * approach_m_s.max(0.0);
        let load_n = match pressed.limit_n {
            Some(limit_n) => (pressed.load_n * damping).min(limit_n),
            None => pressed.load_n,
        };
        let sliding_m_s = vy * nx - vx * ny;
        let share = (sliding_m_s / FULL_FRICTION_SPEED_M_S).clamp(-1.0, 1.0);
        let across_n = -conditions.friction * load_n * share;
        let [fx, fy] = [load_n * nx - across_n * ny, load_n * ny + across_n * nx];
        let size_n = fx.hypot(fy);
        self.force_n = [self.force_n[0] + fx, self.force_n[1] + fy];
        self.moment_n_m += place_m[0] * fy - place_m[1] * fx;
        self.size_n += size_n;
        for (sum, place) in self.size_times_place_n_m.iter_mut().zip(place_m) {
            *sum += size_n * place;
        }
        self.normal_load_n += load_n;
        self.friction_power_w -= across_n * sliding_m_s;
        self.normal_power_w += load_n * approach_m_s;
    }
}

/// The force on the struck vehicle from both half passes.
pub(super) fn total(sums: &[PassSums; 2], motions: &[PlanarMotion; 2]) -> ContactForce {
    let positions_m = motions.map(|motion| motion.position_m);
    let [dx, dy] = [0, 1].map(|axis| positions_m[1][axis] - positions_m[0][axis]);
    let (mut force_n, mut moment_n_m) = ([0.0; 2], 0.0);
    let (mut size_n, mut place_m) = (0.0, [0.0; 2]);
    for (own, of_pass) in sums.iter().enumerate() {
        let entered = 1 - own;
        let heading = Heading::new(motions[entered].yaw_rad);
        // On the struck vehicle.
        let sign = if own == 0 { 1.0 } else { -1.0 };
        let [fx, fy] = heading.world_from_body(of_pass.force_n).map(|force| sign * force);
        force_n = [force_n[0] + fx, force_n[1] + fy];
        let to_struck_n_m = if entered == 1 { dx * fy - dy * fx } else { 0.0 };
        moment_n_m += sign * of_pass.moment_n_m + to_struck_n_m;
        let [px, py] = heading.world_from_body(of_pass.size_times_place_n_m);
        size_n += of_pass.size_n;
        for (axis, moment) in [px, py].into_iter().enumerate() {
            place_m[axis] += moment + of_pass.size_n * positions_m[entered][axis];
        }
    }
    let [fx, fy] = force_n;
    ContactForce {
        force_world_n: force_n,
        yaw_moments_n_m: [moment_n_m, dx * fy - dy * fx - moment_n_m],
        point_world_m: place_m.map(|place| place / size_n),
        normal_load_n: sums[0].normal_load_n + sums[1].normal_load_n,
        overlap_m: sums[0].overlap_m.max(sums[1].overlap_m),
        unloading_stiffness_n_per_m: sums[0].unloading_stiffness_n_per_m
            + sums[1].unloading_stiffness_n_per_m,
        friction_power_w: sums[0].friction_power_w + sums[1].friction_power_w,
        normal_power_w: sums[0].normal_power_w + sums[1].normal_power_w,
    }
}
