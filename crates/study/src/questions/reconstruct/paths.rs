//! Particles of a reconstruction, simulated again: their paths for pictures, and marks beside those that were
//! found.

use crate::ReconstructAnswer;
use impactlab_core::units::NumberFormat;
use impactlab_core::vehicle::{Path, TireMark};
use impactlab_reconstruct::sampler::Particles;
use impactlab_reconstruct::{
    MarkComparison, Mode, Posterior, QuantityEstimate, ReconstructionTarget, StrikingMotion,
};

/// Paths that are drawn.
const N_PATHS: usize = 40;

/// Paths of particles, to be drawn.
#[derive(Debug, Clone, Default)]
pub struct ReconstructedPaths {
    /// Paths of the struck car, some of the particles.
    pub drawn: Vec<Path>,
    /// Path of the particle whose speed of the struck car is nearest to the median; of the most probable
    /// one of several courses of events.
    pub median: Option<NamedPath>,
    /// The same of each other course of events.
    pub others: Vec<NamedPath>,
    /// The marks that the tires leave in the motion of `median`: those of the struck car, and those of the
    /// striking car where it is followed.
    pub marks: Vec<TireMark>,
}

/// A path with its name in a legend.
#[derive(Debug, Clone)]
pub struct NamedPath {
    /// The name; where several courses of events are possible, as [`ReconstructedPaths::course_name`] tells it.
    pub name: String,
    /// The probability that the name begins with, where it is that of one of several courses of events.
    pub chance: Option<String>,
    /// The path.
    pub path: Path,
}

impl ReconstructedPaths {
    /// What the path of a particle of median speed is called.
    const MEDIAN: &str = "a particle of median speed";

    /// Simulates paths of an answer's particles, with English names.
    pub fn from_answer(answer: &ReconstructAnswer) -> Self {
        Self::in_language(answer, &NumberFormat::default(), &str::to_owned)
    }

    /// The same with the names of several courses of events in a language.
    ///
    /// - `term`: a label of the program in the language of the format.
    pub fn in_language(
        answer: &ReconstructAnswer,
        format: &NumberFormat,
        term: &dyn Fn(&str) -> String,
    ) -> Self {
        let all: Vec<usize> = (0..answer.particles.z.len()).collect();
        let drawn = drawn(answer, &all);
        let report = &answer.report;
        match report.modes.as_slice() {
            [first, rest @ ..] if !rest.is_empty() => {
                let of = |mode: &Mode| {
                    let name = Self::course_name(mode, format, term);
                    let (path, marks) = followed(answer, name, &mode.members, &mode.quantities)?;
                    let chance = Some(course_chance(mode, format));
                    Some((NamedPath { chance, ..path }, marks))
                };
                let (median, marks) = of(first).unzip();
                let others = rest.iter().filter_map(|mode| Some(of(mode)?.0)).collect();
                Self { drawn, median, others, marks: marks.unwrap_or_default() }
            }
            _ => Self::new(drawn, followed(answer, Self::MEDIAN, &all, &report.quantities)),
        }
    }

    /// What one of several courses of events is called in a legend: its probability, and its name.
    ///
    /// - `term`: a label of the program in the language of the format.
    pub fn course_name(
        mode: &Mode,
        format: &NumberFormat,
        term: &dyn Fn(&str) -> String,
    ) -> String {
        format!("{}: {}", course_chance(mode, format), term(&mode.name))
    }

    /// What stands above one of several courses of events: its probability with its standard error, and its
    /// name.
    pub fn course_title(mode: &Mode) -> String {
        let chance = NumberFormat::default().chance(mode.probability, Some(mode.standard_error));
        format!("{chance}: {}", mode.name)
    }

    /// Simulates paths of the particles of one course of events.
    pub fn from_mode(answer: &ReconstructAnswer, mode: &Mode) -> Self {
        let followed = followed(answer, Self::MEDIAN, &mode.members, &mode.quantities);
        Self::new(drawn(answer, &mode.members), followed)
    }

    /// Simulates paths of particles that are still moving, of which there is no median.
    pub fn from_particles(target: &ReconstructionTarget, z: &[Vec<f64>]) -> Self {
        let every = z.len().div_ceil(N_PATHS).max(1);
        let chosen: Vec<Vec<f64>> = z.iter().step_by(every).cloned().collect();
        let drawn = target.model().motions(&chosen, |motion| motion.path);
        Self { drawn, ..Self::default() }
    }

    fn new(drawn: Vec<Path>, followed: Option<(NamedPath, Vec<TireMark>)>) -> Self {
        let (median, marks) = followed.unzip();
        Self { drawn, median, others: Vec::new(), marks: marks.unwrap_or_default() }
    }
}

/// The probability of one of several courses of events, as a legend tells it.
fn course_chance(mode: &Mode, format: &NumberFormat) -> String {
    format.chance(mode.probability, None)
}

/// Paths of some of the particles of these numbers.
fn drawn(answer: &ReconstructAnswer, members: &[usize]) -> Vec<Path> {
    let z = &answer.particles.z;
    let every = members.len().div_ceil(N_PATHS).max(1);
    let some = members.iter().step_by(every);
    let chosen: Vec<Vec<f64>> = some.filter_map(|idx| z.get(*idx).cloned()).collect();
    answer.target.model().motions(&chosen, |motion| motion.path)
}

/// The path of that one of some particles whose speed is nearest to their median, with its tire marks.
fn followed(
    answer: &ReconstructAnswer,
    name: impl Into<String>,
    members: &[usize],
    quantities: &[QuantityEstimate],
) -> Option<(NamedPath, Vec<TireMark>)> {
    let nearest = answer.posterior.nearest_to_median(members, quantities)?;
    let z = std::slice::from_ref(answer.particles.z.get(nearest)?);
    let model = answer.target.model();
    let mut motions = model.motions(z, |motion| {
        let mut marks = motion.tire_marks();
        marks.extend(motion.striking.iter().flat_map(StrikingMotion::tire_marks));
        (marks, motion.path)
    });
    let (marks, path) = motions.pop()?;
    Some((NamedPath { name: name.into(), chance: None, path }, marks))
}

/// The marks that were found beside those of the particle of median speed, or of that of the most probable
/// of several courses of events.
pub(super) fn compared_marks(
    target: &ReconstructionTarget,
    particles: &Particles,
    posterior: &Posterior,
    quantities: &[QuantityEstimate],
    modes: &[Mode],
) -> Vec<MarkComparison> {
    let evidence = target.evidence();
    if evidence.marks.is_empty() && evidence.striking_marks.is_empty() {
        return Vec::new();
    }
    let all: Vec<usize> = (0..particles.z.len()).collect();
    let median = match modes.first() {
        Some(course) => posterior.nearest_to_median(&course.members, &course.quantities),
        None => posterior.nearest_to_median(&all, quantities),
    };
    let Some(z) = median.and_then(|idx| particles.z.get(idx)) else { return Vec::new() };
    let compared = |motion| MarkComparison::of_both_cars(evidence, &motion);
    target.model().motions(std::slice::from_ref(z), compared).concat()
}
