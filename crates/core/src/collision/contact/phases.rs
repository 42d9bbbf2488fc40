//! When two vehicles were in contact, and what each contact did to them.

use crate::collision::PrincipalDirectionOfForce;
use crate::collision::contact::{ContactForce, PlanarMotion};
use crate::vehicle::frames::Heading;

/// Longest interruption of the force within one phase of contact, s.
pub const CONTACT_GAP_S: f64 = 0.025;

/// A phase in which two vehicles are in contact, with interruptions of at most [`CONTACT_GAP_S`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPhase {
    /// When it begins, s.
    pub start_s: f64,
    /// When it ends, s; `None` if the vehicles still are in contact at the end of their motion.
    pub end_s: Option<f64>,
    /// Impulse `[P_X, P_Y]` on the struck vehicle, world axes, N s. The striking vehicle has the
    /// opposite one.
    pub impulse_world_n_s: [f64; 2],
    /// Largest magnitude of the force, N.
    pub peak_force_n: f64,
    /// Of the struck and of the striking vehicle.
    pub vehicles: [PhaseOfVehicle; 2],
}

/// What a phase of contact did to one vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseOfVehicle {
    /// Impulse in the body axes at each instant, `∫R(−ψ) F dt`, N s.
    pub impulse_body_n_s: [f64; 2],
    /// Impulse of the yaw moment about its CG, N m s.
    pub yaw_impulse_n_m_s: f64,
    /// Δv by the contact force alone: `|∫R(−ψ) F dt|/m`, m/s, as an event data recorder integrates it.
    pub delta_v_m_s: f64,
    /// Principal direction of the force in body axes; `None` without an impulse.
    pub principal_direction: Option<PrincipalDirectionOfForce>,
}

/// Collects the phases of contact along a motion.
#[derive(Debug)]
pub(super) struct PhaseWatch {
    masses_kg: [f64; 2],
    ended: Vec<ContactPhase>,
    current: Option<OpenPhase>,
}

/// A phase that may go on.
#[derive(Debug, Clone, Copy)]
struct OpenPhase {
    start_s: f64,
    last_s: f64,
    impulse_world_n_s: [f64; 2],
    peak_force_n: f64,
    impulses_body_n_s: [[f64; 2]; 2],
    yaw_impulses_n_m_s: [f64; 2],
}

impl PhaseWatch {
    pub fn new(masses_kg: [f64; 2]) -> Self {
        Self { masses_kg, ended: Vec::new(), current: None }
    }

    /// When the first phase begins, s; `None` before that.
    pub fn first_s(&self) -> Option<f64> {
        let ended = self.ended.first().map(|phase| phase.start_s);
        ended.or(self.current.map(|phase| phase.start_s))
    }

    /// Adds a step over which a force is held.
    ///
    /// - `motions`: in the middle of the step.
    pub fn add(
        &mut self,
        [start_s, end_s]: [f64; 2],
        force: Option<&ContactForce>,
        motions: &[PlanarMotion; 2],
    ) {
        let is_over = |phase: &OpenPhase| end_s - phase.last_s > CONTACT_GAP_S;
        let Some(force) = force else {
            if let Some(phase) = self.current.take_if(|phase| is_over(phase)) {
                self.ended.push(phase.closed(Some(phase.last_s), self.masses_kg));
            }
            return;
        };
        let step_s = end_s - start_s;
        let phase = self.current.get_or_insert(OpenPhase {
            start_s,
            last_s: end_s,
            impulse_world_n_s: [0.0; 2],
            peak_force_n: 0.0,
            impulses_body_n_s: [[0.0; 2]; 2],
            yaw_impulses_n_m_s: [0.0; 2],
        });
        let [fx, fy] = force.force_world_n;
        phase.last_s = end_s;
        phase.peak_force_n = phase.peak_force_n.max(fx.hypot(fy));
        phase.impulse_world_n_s[0] += fx * step_s;
        phase.impulse_world_n_s[1] += fy * step_s;
        for (i, sign) in [1.0, -1.0].into_iter().enumerate() {
            let heading = Heading::new(motions[i].yaw_rad);
            let [along, across] = heading.body_from_world([sign * fx, sign * fy]);
            phase.impulses_body_n_s[i][0] += along * step_s;
            phase.impulses_body_n_s[i][1] += across * step_s;
            phase.yaw_impulses_n_m_s[i] += force.yaw_moments_n_m[i] * step_s;
        }
    }

    /// All phases.
    ///
    /// - `end_s`: end of the motion.
    pub fn finish(mut self, end_s: f64) -> Vec<ContactPhase> {
        if let Some(phase) = self.current {
            let has_ended = end_s > phase.last_s + 1e-9;
            self.ended.push(phase.closed(has_ended.then_some(phase.last_s), self.masses_kg));
        }
        self.ended
    }
}

impl OpenPhase {
    fn closed(&self, end_s: Option<f64>, masses_kg: [f64; 2]) -> ContactPhase {
        let of_vehicle = |i: usize| {
            let impulse_body_n_s: [f64; 2] = self.impulses_body_n_s[i];
            let [x, y] = impulse_body_n_s;
            PhaseOfVehicle {
                impulse_body_n_s,
                yaw_impulse_n_m_s: self.yaw_impulses_n_m_s[i],
                delta_v_m_s: x.hypot(y) / masses_kg[i],
                principal_direction: PrincipalDirectionOfForce::from_impulse(impulse_body_n_s, 0.0),
            }
        };
        ContactPhase {
            start_s: self.start_s,
            end_s,
            impulse_world_n_s: self.impulse_world_n_s,
            peak_force_n: self.peak_force_n,
            vehicles: [of_vehicle(0), of_vehicle(1)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(force_world_n: [f64; 2]) -> ContactForce {
        ContactForce {
            force_world_n,
            yaw_moments_n_m: [300.0, -200.0],
            point_world_m: [0.0; 2],
            normal_load_n: 0.0,
            overlap_m: 0.0,
            unloading_stiffness_n_per_m: 0.0,
            friction_power_w: 0.0,
            normal_power_w: 0.0,
        }
    }

    fn heading(yaw_rad: f64) -> PlanarMotion {
        PlanarMotion { position_m: [0.0; 2], yaw_rad, velocity_m_s: [0.0; 2], yaw_rate_rad_s: 0.0 }
    }

    /// The phases of a force that acts in some steps of 10 ms.
    fn phases(acts: &[bool]) -> Vec<ContactPhase> {
        let mut watch = PhaseWatch::new([1000.0, 2000.0]);
        let motions = [heading(0.0), heading(std::f64::consts::FRAC_PI_2)];
        for (i, acts) in acts.iter().enumerate() {
            let start_s = 0.01 * i as f64;
            let now = acts.then(|| force([0.0, 5e4]));
            watch.add([start_s, start_s + 0.01], now.as_ref(), &motions);
        }
        watch.finish(0.01 * acts.len() as f64)
    }

    #[test]
    fn short_gaps_belong_to_a_phase_and_long_ones_end_it() {
        let (on, off) = (true, false);
        let found = phases(&[off, on, on, off, off, on, off, off, off, on, on, on]);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0].start_s - 0.01).abs() < 1e-12, "{found:?}");
        assert!((found[0].end_s.unwrap() - 0.06).abs() < 1e-12, "{found:?}");
        assert!((found[1].start_s - 0.09).abs() < 1e-12 && found[1].end_s.is_none(), "{found:?}");
        assert!((found[0].impulse_world_n_s[1] - 1500.0).abs() < 1e-9, "{found:?}");
        assert!(phases(&[off, off]).is_empty());
    }

    #[test]
    fn each_vehicle_has_its_delta_v_and_the_direction_that_it_sees() {
        let found = phases(&[true, true, false]);
        let [struck, striking] = found[0].vehicles;
        assert!((struck.delta_v_m_s - 1.0).abs() < 1e-12, "{struck:?}");
        assert!((striking.delta_v_m_s - 0.5).abs() < 1e-12, "{striking:?}");
        // Pushed to the left: from the right. The striking vehicle heads along Y and is pushed back.
        let clocks = [struck, striking].map(|it| it.principal_direction.unwrap().clock());
        assert_eq!(clocks, [3, 12]);
        assert!((struck.yaw_impulse_n_m_s - 6.0).abs() < 1e-12, "{struck:?}");
    }
}
