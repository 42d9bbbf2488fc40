//! The reconstruction in the window: its evidence, its run, and what is shown of it. The panes Evidence,
//! Reconstructed scene and Speeds show them.

mod cars;
mod live;
mod preview;
mod question;
mod settings;
mod stored_runs;
mod update;

pub use cars::{BuiltCars, CarsSource, ReconstructedCars, ShownPaths};
pub use live::LiveParticles;
pub use preview::EvidencePreview;
pub use question::{PreparedReconstruction, ReconstructionQuestion};
pub use settings::ReconstructionView;
pub use stored_runs::StoredRuns;

use std::path::PathBuf;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use crate::app::question_job::QuestionJob;
use impactlab_core::jobs::Progress;
use impactlab_core::vehicle::{Path, TireMark};
use impactlab_reconstruct::evidence::Evidence;
use impactlab_study::{NamedPath, ReconstructRequest, ReconstructedPaths};

/// A path that is followed in the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FollowedParticle {
    /// A particle of median speed.
    #[default]
    Median,
    /// One of those that are drawn, by its number.
    Draw(usize),
}

/// An action on the reconstruction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReconstructionCommand {
    /// Begin with an empty form of a collision.
    New,
    /// Begin with an empty form of a single car.
    NewSingleCar,
    /// Take the evidence of the shipped example.
    Example,
    /// Reconstruct from the evidence.
    Run,
    /// Stop sampling; what was sampled is kept.
    Cancel,
    /// Show the particles of one course of events alone, by its number; `None` shows all.
    ShowMode(Option<usize>),
    /// Follow a particle from the start on.
    Play(FollowedParticle),
    /// Let clicks in the scene add points to a mark.
    AddPoints(Option<MarkKey>),
}

/// Tells a mark apart from others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MarkKey {
    /// The key of its section, which is that of its car.
    pub section: &'static str,
    /// Its number among those of the car.
    pub idx: usize,
}

/// An evidence file that was read.
pub struct ReadEvidence {
    /// The file.
    pub path: PathBuf,
    /// What stands in it, or what is wrong with it.
    pub evidence: Result<Evidence, String>,
}

/// Evidence, run and answer of the reconstruction, which are not saved.
#[derive(Default)]
pub struct ReconstructionSession {
    /// The file of the evidence, where the project names one.
    pub file: Option<ReadEvidence>,
    /// Where runs are kept; `None` if this window keeps none.
    pub stored_runs: Option<StoredRuns>,
    /// What follows from the evidence before anything is sampled.
    pub preview: Option<EvidencePreview>,
    /// The run and the latest answer.
    pub run: QuestionJob<ReconstructionQuestion>,
    /// How many answers there have been, so that two of them can be told apart.
    pub n_answers: u64,
    /// The scene with the cars as bodies.
    pub cars: ReconstructedCars,
    /// The latest particles of the run that is under way.
    pub live: Option<LiveParticles>,
    news: Option<Receiver<LiveParticles>>,
    /// The course of events that is shown alone, by its number.
    pub mode: Option<usize>,
    /// The particle that is followed.
    pub followed: FollowedParticle,
    /// The mark to which clicks in the scene add points.
    pub adds_to: Option<MarkKey>,
}

impl ReconstructionSession {
    /// The latest answer, if there is one.
    pub fn answer(&self) -> Option<&PreparedReconstruction> {
        self.run.ok().map(std::sync::Arc::as_ref)
    }

    /// The time that the run still takes, as far as that can be told.
    pub fn time_left(&self) -> Option<Duration> {
        let job = self.run.job()?;
        told_time(job.progress(), job.time_left()?)
    }

    /// Whether the answer is not of what is asked now.
    pub fn is_outdated(&self, request: Option<&ReconstructRequest>) -> bool {
        let latest = self.run.latest.as_ref();
        latest.is_some_and(|latest| Some(&latest.question.request) != request)
    }

    /// The path that is followed, with its name.
    pub fn followed_path(&self) -> Option<(String, &Path)> {
        let paths = self.answer()?.paths_of(self.mode);
        match self.followed {
            FollowedParticle::Median => {
                let median = paths.median.as_ref()?;
                Some((median.name.clone(), &median.path))
            }
            FollowedParticle::Draw(idx) => {
                Some((format!("draw {}", idx + 1), paths.drawn.get(idx)?))
            }
        }
    }

    /// Paths of the other courses of events, beside that of the most probable one.
    pub fn other_paths(&self) -> &[NamedPath] {
        let is_median = self.followed == FollowedParticle::Median;
        let answer = self.answer().filter(|_| is_median);
        answer.map_or(&[], |answer| answer.paths_of(self.mode).others.as_slice())
    }

    /// The courses of events that can stand side by side: all of them, if none is shown alone and no draw
    /// is followed.
    pub fn courses(&self) -> Vec<(String, &ReconstructedPaths)> {
        let is_of_all = self.mode.is_none() && self.followed == FollowedParticle::Median;
        let answer = self.answer().filter(|_| is_of_all);
        answer.map_or_else(Vec::new, PreparedReconstruction::courses)
    }

    /// The marks that tires leave along the path that is followed, where they are known.
    pub fn followed_marks(&self) -> Option<&[TireMark]> {
        let is_median = self.followed == FollowedParticle::Median;
        let paths = self.answer().filter(|_| is_median)?.paths_of(self.mode);
        Some(&paths.marks)
    }

    /// When the last car on the path that is followed, or on that of another course of events, stops, s; 0
    /// without any.
    pub fn end_time_s(&self) -> f64 {
        let followed = self.followed_path().map(|(_, path)| path);
        let paths = followed.into_iter().chain(self.other_paths().iter().map(|of| &of.path));
        let ends_s = paths.filter_map(|path| path.points.last()).map(|point| point.time_s);
        ends_s.fold(0.0, f64::max)
    }
}

/// The time left as it is told: nothing before a twentieth of the work is done since the run began or went on,
/// since its first steps say little of the others; then rounded up, so that it does not flicker.
fn told_time(progress: &Progress, left: Duration) -> Option<Duration> {
    let &Progress { done, done_before, total, .. } = progress;
    let (passed, all) = (done.saturating_sub(done_before), total.saturating_sub(done_before));
    let left_s = left.as_secs_f64().ceil() as u64;
    let step_s = match left_s {
        0..60 => 5,
        60..600 => 30,
        _ => 300,
    };
    (all > 0 && 20 * passed >= all)
        .then(|| Duration::from_secs(left_s.div_ceil(step_s).saturating_mul(step_s)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_left_is_told_late_and_in_round_numbers() {
        let told = |done, total, left_ms| {
            let progress = Progress::new(done, total, "").going_on_from(200);
            told_time(&progress, Duration::from_millis(left_ms)).map(|left| left.as_secs())
        };
        assert_eq!([told(200, 1000, 9000), told(239, 1000, 9000), told(300, 0, 9000)], [None; 3]);
        assert_eq!(told(240, 1000, 12_300), Some(15));
        assert_eq!(told(500, 1000, 61_000), Some(90));
        assert_eq!(told(500, 1000, 700_000), Some(900));
        assert_eq!(told(1000, 1000, 0), Some(0));
    }
}
