//! The particles of a run that is under way.

use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use impactlab_core::numerics::quantile_of_sorted;
use impactlab_study::{Event, ReconstructedPaths, Sampling};

/// Shortest time between two pictures of the particles.
const BETWEEN: Duration = Duration::from_secs(1);

/// Particles that are not the answer yet.
#[derive(Debug, Clone)]
pub struct LiveParticles {
    /// Paths of some of them.
    pub paths: ReconstructedPaths,
    /// Power of the likelihood that they have reached, 0 to 1.
    pub temperature: f64,
    /// The middle 90 % of their speeds of the struck or single car, m/s.
    pub speeds_m_s: Option<[f64; 2]>,
    /// Whether they are of a single car.
    pub is_of_single_car: bool,
}

/// Watches a run, and sends its particles every now and then.
pub(super) fn watch(sender: Sender<LiveParticles>) -> impl FnMut(&Event<'_>) + Send + 'static {
    let mut last: Option<Instant> = None;
    move |event| {
        let Event::Sampling(sampling) = event else { return };
        if last.is_some_and(|last| last.elapsed() < BETWEEN) {
            return;
        }
        // Sending fails only after the window has forgotten the run.
        let _ = sender.send(particles(sampling));
        last = Some(Instant::now());
    }
}

fn particles(sampling: &Sampling<'_>) -> LiveParticles {
    let Sampling { target, temperature, z } = *sampling;
    let model = target.model();
    let speed = |z: &Vec<f64>| model.speed_m_s(&model.prior().values(z));
    let mut speeds: Vec<f64> = z.iter().map(speed).collect();
    speeds.sort_by(f64::total_cmp);
    let ends = [0.05, 0.95].map(|share| quantile_of_sorted(&speeds, share));
    let speeds_m_s = match ends {
        [Some(low), Some(high)] => Some([low, high]),
        _ => None,
    };
    let paths = ReconstructedPaths::from_particles(target, z);
    let is_of_single_car = model.is_of_single_car();
    LiveParticles { paths, temperature, speeds_m_s, is_of_single_car }
}
