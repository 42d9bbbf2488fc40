//! Draws evidence of a motion from the likelihood, for simulation-based calibration.

use rand::Rng;
use rand_distr::{ChiSquared, Distribution, StandardNormal};

use crate::CollisionMotion;
use crate::evidence::{Evidence, Measured};
use crate::likelihood::{ReconstructionTarget, Track};

impl ReconstructionTarget {
    /// Evidence of the kind and the accuracy of that of this case, of another motion: rest pose and
    /// positions with an error of the path that they share, and the recorded speeds.
    ///
    /// Marks, a recorded change of velocity and the rest pose of the striking car stay as they are: the
    /// likelihood of a mark depends on which place of the path is nearest to it, and bounds may be
    /// anywhere about what they enclose, so that neither says how such evidence arises.
    ///
    /// - returns `None` for a motion that could not be computed, and for cars that draw apart.
    pub fn drawn(&self, motion: &CollisionMotion, rng: &mut impl Rng) -> Option<Evidence> {
        if motion.impact.is_some_and(|impact| !impact.is_collision()) {
            return None;
        }
        let mut evidence = self.evidence().clone();
        evidence.marks.clear();
        evidence.striking_marks.clear();
        let discrepancy = self.discrepancy();
        let (residuals, whole_m) = evidence.path_residuals(discrepancy, motion)?;
        let noise: Vec<f64> = residuals.iter().map(|_| StandardNormal.sample(rng)).collect();
        let freedom = discrepancy.degrees_of_freedom;
        let scale = (freedom / ChiSquared::new(freedom).ok()?.sample(rng)).sqrt();
        let errors = discrepancy.correlated(&residuals, whole_m, &noise)?;
        let mut moves = residuals.iter().zip(errors).map(|(at, error)| scale * error - at.residual);
        let mut add = |value: &mut f64| *value += moves.next().unwrap_or(f64::NAN);
        if let Some(rest) = &mut evidence.rest {
            let heading = rest.heading_rad.iter_mut().flat_map(|heading| &mut heading.value);
            rest.x_m.iter_mut().chain(&mut rest.y_m).chain(heading).for_each(&mut add);
        }
        for found in &mut evidence.positions {
            found.x_m.iter_mut().chain(&mut found.y_m).for_each(&mut add);
        }
        let speeds_m_s = motion.impact.map(|of| [of.struck_speed_m_s, of.striking_speed_m_s]);
        let recorders = [&mut evidence.edr, &mut evidence.striking_edr];
        for (edr, speed_m_s) in recorders.into_iter().zip(speeds_m_s.into_iter().flatten()) {
            if let Some(edr) = edr
                && let Some(Measured { sigma, .. }) = edr.speed_before()
            {
                let error: f64 = StandardNormal.sample(rng);
                let value = speed_m_s + sigma * error;
                edr.speed_before_m_s = Some(Measured { value, sigma }.into());
            }
        }
        let track = Track::from_path(&motion.path)?;
        for found in &mut evidence.speeds {
            let at = track.at_time(found.time_s.unwrap_or(0.0));
            if let (Some(Measured { sigma, .. }), Some((_, at))) = (found.speed(), at) {
                let error: f64 = StandardNormal.sample(rng);
                let value = at.vx_body_m_s.hypot(at.vy_body_m_s) + sigma * error;
                found.speed_m_s = Some(Measured { value, sigma }.into());
            }
        }
        Some(evidence)
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::evidence::VideoPosition;
    use crate::evidence::examples::{SPIN, read};
    use crate::{Cars, Discrepancy, ForwardModel};

    #[test]
    fn what_is_drawn_errs_as_the_likelihood_says() {
        let mut evidence = read(SPIN);
        let at = |time_s| VideoPosition {
            time_s: Some(time_s),
            x_m: Some(0.0),
            y_m: Some(0.0),
            sigma_m: None,
        };
        evidence.positions = vec![at(0.5), at(0.6)];
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let z = vec![0.0; model.prior().components().len()];
        let motion = model.motions(&[z], |motion| motion).pop().unwrap();
        let discrepancy = Discrepancy::default();
        let target = ReconstructionTarget::new(evidence.clone(), model, discrepancy);
        let (expected, _) = evidence.path_residuals(&discrepancy, &motion).unwrap();

        let true_m_s = motion.impact.unwrap().struck_speed_m_s;
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let n = 4000;
        let (mut squares, mut both, mut speeds) = (vec![0.0; expected.len()], 0.0, 0.0);
        for _ in 0..n {
            let drawn = target.drawn(&motion, &mut rng).unwrap();
            let (found, _) = drawn.path_residuals(&discrepancy, &motion).unwrap();
            squares.iter_mut().zip(&found).for_each(|(sum, at)| *sum += at.residual.powi(2));
            both += found[3].residual * found[5].residual;
            let speed = drawn.recorder().speed_before().unwrap().value;
            speeds += ((speed - true_m_s) / 0.8_f64).powi(2);
        }
        // The variance of a Student distribution of ν degrees of freedom is ν/(ν − 2) of its scale.
        let freedom = discrepancy.degrees_of_freedom;
        let heavier = freedom / (freedom - 2.0);
        for (idx, (sum, at)) in squares.iter().zip(&expected).enumerate() {
            let ratio = sum / f64::from(n) / (heavier * discrepancy.variance(at));
            assert!((ratio - 1.0).abs() < 0.15, "residual {idx}: {ratio}");
        }
        let correlation = both / (squares[3] * squares[5]).sqrt();
        assert!(correlation > 0.2, "neighbouring positions err together: {correlation}");
        assert!((speeds / f64::from(n) - 1.0).abs() < 0.1, "{speeds}");
    }
}
