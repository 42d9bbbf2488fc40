//! Paths of particles of a reconstruction, simulated again for pictures.

use crate::ReconstructAnswer;
use impactlab_core::vehicle::{Path, TireMark};
use impactlab_reconstruct::{Mode, QuantityEstimate, ReconstructionTarget};

/// Paths that are drawn.
const N_PATHS: usize = 40;

/// Paths of particles, to be drawn.
#[derive(Debug, Clone, Default)]
pub struct ReconstructedPaths {
    /// Paths of the struck car, some of the particles.
    pub drawn: Vec<Path>,
    /// Path of the particle whose speed of the struck car is nearest to the median.
    pub median: Option<Path>,
    /// The marks that the tires of the struck car leave in the motion of that particle.
    pub marks: Vec<TireMark>,
}

impl ReconstructedPaths {
    /// What the path of a particle of median speed is called.
    pub const MEDIAN: &str = "a particle of median speed";

    /// Simulates paths of an answer's particles.
    pub fn from_answer(answer: &ReconstructAnswer) -> Self {
        let all: Vec<usize> = (0..answer.particles.z.len()).collect();
        Self::among(answer, &all, &answer.report.quantities)
    }

    /// Simulates paths of the particles of one course of events.
    pub fn from_mode(answer: &ReconstructAnswer, mode: &Mode) -> Self {
        Self::among(answer, &mode.members, &mode.quantities)
    }

    /// Simulates paths of particles that are still moving, of which there is no median.
    pub fn from_particles(target: &ReconstructionTarget, z: &[Vec<f64>]) -> Self {
        let every = z.len().div_ceil(N_PATHS).max(1);
        let chosen: Vec<Vec<f64>> = z.iter().step_by(every).cloned().collect();
        let drawn = target.model().motions(&chosen, |motion| motion.path);
        Self { drawn, ..Self::default() }
    }

    fn among(
        answer: &ReconstructAnswer,
        members: &[usize],
        quantities: &[QuantityEstimate],
    ) -> Self {
        let z = &answer.particles.z;
        let every = members.len().div_ceil(N_PATHS).max(1);
        let some = members.iter().step_by(every);
        let chosen: Vec<Vec<f64>> = some.filter_map(|idx| z.get(*idx).cloned()).collect();
        let model = answer.target.model();
        let drawn = model.motions(&chosen, |motion| motion.path);
        let nearest = answer.posterior.nearest_to_median(members, quantities);
        let nearest = nearest.and_then(|idx| z.get(idx)).map(std::slice::from_ref);
        let followed =
            nearest.map(|z| model.motions(z, |motion| (motion.tire_marks(), motion.path)));
        let (marks, median) = followed.and_then(|mut followed| followed.pop()).unzip();
        Self { drawn, median, marks: marks.unwrap_or_default() }
    }
}
