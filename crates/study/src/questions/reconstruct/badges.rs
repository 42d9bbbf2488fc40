//! Badges of the answer of a reconstruction: too few particles, several courses of events, evidence that
//! nothing explains.

use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{NumberFormat, Quantity};
use impactlab_core::vehicle::FrictionZone;
use impactlab_reconstruct::sampler::Particles;
use impactlab_reconstruct::{EvidenceFit, LEAST_ESS_FOR_INTERVALS, LeftOut, Mode};

/// Effective sample size below which intervals may be too narrow.
const LEAST_ESS: f64 = 400.0;

/// That the evidence leaves more than one course of events possible.
pub(super) fn several_courses(modes: &[Mode]) -> Option<Caveat> {
    let format = NumberFormat::default();
    let course = |mode: &Mode| {
        let chance = format.chance(mode.probability, Some(mode.standard_error));
        format!("{} with {chance}", mode.name)
    };
    let courses: Vec<String> = modes.iter().map(course).collect();
    (modes.len() > 1).then(|| {
        let text = format!(
            "{} courses of events are possible ({}): a median or an interval over all of them may be true of \
             none; use those of each course",
            modes.len(),
            courses.join("; ")
        );
        Caveat::new(CaveatKind::SeveralCourses, text)
            .with_value("courses of events", modes.len() as f64)
            .with_range([1.0, 1.0])
    })
}

/// Whether there are enough particles, and whether they are of the posterior.
pub(super) fn of_particles(particles: &Particles) -> Vec<Caveat> {
    let stopped = (!particles.is_posterior()).then(|| {
        let text = "sampling was stopped before all of the evidence was used: these particles are \
                    not of the posterior, and no intervals are given; let the run end";
        Caveat::new(CaveatKind::FewParticles, text)
            .with_value("temperature", particles.temperature)
            .with_range([1.0, f64::INFINITY])
    });
    let few = (particles.ess < LEAST_ESS).then(|| {
        let consequence = match particles.ess < LEAST_ESS_FOR_INTERVALS {
            true => "no intervals are given, which would rest on single draws",
            false => "intervals may be too narrow",
        };
        let text = format!(
            "the sample is equivalent to {:.0} independent draws, expected {LEAST_ESS}: {consequence}; more \
             particles: --particles",
            particles.ess
        );
        Caveat::new(CaveatKind::FewParticles, text)
            .with_value("effective sample size", particles.ess)
            .with_range([LEAST_ESS, f64::INFINITY])
    });
    stopped.into_iter().chain(few).collect()
}

/// What the intervals have been tried on, as long as that is not enough.
pub(super) fn of_validation(zones: &[FrictionZone]) -> Caveat {
    let on_zones = match zones.is_empty() {
        true => "",
        false => ", all of which stood on one friction",
    };
    let text = format!(
        "intervals were tried on 40 simulated collisions of one make of car{on_zones} and on no real \
         one; how often they held is in docs/guide/limits.md"
    );
    Caveat::new(CaveatKind::HardlyValidated, text)
}

/// Parts of the evidence that the others contradict, though the answer follows them.
pub(super) fn of_left_out(left_out: &[LeftOut]) -> Vec<Caveat> {
    let format = NumberFormat::default();
    let contradicted = left_out.iter().filter(|part| part.is_contradicted);
    contradicted
        .filter_map(|part| Some((part, part.p?)))
        .map(|(part, p)| {
            let without = part.struck_speed.as_ref().map_or_else(String::new, |speed| {
                let speed = format.estimate_in_words(Quantity::Speed, &speed.estimate);
                format!("; without it the struck car had {speed}")
            });
            let text = format!(
                "{} does not go with the rest of the evidence: one of them is wrong or misread{without}",
                part.evidence
            );
            Caveat::new(CaveatKind::EvidenceUnexplained, text)
                .with_value(format!("p of {} by the others", part.evidence), p)
        })
        .collect()
}

/// Evidence that no particle explains.
pub(super) fn of_fit(fit: &[EvidenceFit]) -> Vec<Caveat> {
    let unexplained = fit.iter().filter(|item| item.is_unexplained());
    unexplained
        .map(|item| {
            let shown = |value: f64| format!("{value:.3} {}", item.unit).trim_end().to_owned();
            let text = format!(
                "{}: found {}, expected {}: items of the evidence contradict each other, or the course \
                 of events is another one; do not rely on the intervals",
                item.evidence,
                shown(item.found),
                shown(item.expected),
            );
            Caveat::new(CaveatKind::EvidenceUnexplained, text)
                .with_value(format!("p of {}", item.evidence), item.p)
                .with_range([EvidenceFit::UNEXPLAINED_BELOW, 1.0])
        })
        .collect()
}
