//! Draws evidence of a motion from the likelihood, for simulation-based calibration.

use rand::Rng;
use rand_distr::{ChiSquared, Distribution, StandardNormal};

use crate::reconstruct::CollisionMotion;
use crate::reconstruct::evidence::{Evidence, RestPose};
use crate::reconstruct::likelihood::ReconstructionTarget;
use crate::reconstruct::likelihood::terms::path_residuals;

impl ReconstructionTarget {
    /// Evidence of the kind and the accuracy of that of this case, of another motion: rest pose and
    /// positions with an error of the path that they share, and the recorded speed.
    ///
    /// Marks, a recorded change of velocity and the rest pose of the striking car stay as they are: the
    /// likelihood of a mark depends on which place of the path is nearest to it, and bounds may be
    /// anywhere about what they enclose, so that neither says how such evidence arises.
    ///
    /// - returns `None` for a motion that could not be computed.
    pub fn drawn(&self, motion: &CollisionMotion, rng: &mut impl Rng) -> Option<Evidence> {
        let mut evidence = self.evidence().clone();
        evidence.marks.clear();
        let discrepancy = self.discrepancy();
        let (residuals, whole_m) = path_residuals((&evidence, discrepancy), motion)?;
        let noise: Vec<f64> = residuals.iter().map(|_| StandardNormal.sample(rng)).collect();
        let freedom = discrepancy.degrees_of_freedom;
        let scale = (freedom / ChiSquared::new(freedom).ok()?.sample(rng)).sqrt();
        let errors = discrepancy.correlated(&residuals, whole_m, &noise)?;
        let mut moves = residuals.iter().zip(errors).map(|(at, error)| scale * error - at.residual);
        let mut add = |value: &mut f64| *value += moves.next().unwrap_or(f64::NAN);
        if let Some(RestPose { x_m, y_m, heading_rad, .. }) = &mut evidence.rest {
            add(x_m);
            add(y_m);
            heading_rad.iter_mut().for_each(|heading| add(&mut heading.value));
        }
        for found in &mut evidence.positions {
            add(&mut found.x_m);
            add(&mut found.y_m);
        }
        if let Some(speed) = &mut evidence.edr.speed_before_m_s {
            let error: f64 = StandardNormal.sample(rng);
            speed.value = motion.impact.target_speed_m_s + speed.sigma * error;
        }
        Some(evidence)
    }
}
