//! How far the sampling of a reconstruction is.

use impactlab_core::jobs::Progress;
use impactlab_reconstruct::ReconstructionTarget;
use impactlab_reconstruct::sampler::{SamplerReport, SamplerSettings};

/// How far the sampling is: half of it is reaching the posterior.
///
/// - `settings`: those of the sampler, which end it.
pub(super) fn progress(
    report: &SamplerReport<'_>,
    target: &ReconstructionTarget,
    settings: &SamplerSettings,
) -> Progress {
    let of_posterior = (report.ess.unwrap_or(0.0) / settings.least_ess).min(1.0);
    let share = 0.5 * report.temperature.powf(0.2) + 0.5 * of_posterior;
    // Where the sample stays small, the evaluations end it.
    let spent = report.n_evaluations as f64 / settings.max_evaluations as f64;
    let through = match target.model().follows_later_contacts() {
        true => ", through all contacts",
        false => "",
    };
    let message = format!("{} motions{through}", report.n_evaluations);
    Progress::new((1000.0 * share.max(spent.min(1.0))) as u64, 1000, message)
}
