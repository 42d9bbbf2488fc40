//! What the force network is compared with: the selected case.

use std::path::PathBuf;

use impactlab_core::uncertainty::ForceCurve;
use impactlab_networks::force::{ForceCase, ForceScenario};

/// The selected case with its recorded force.
pub struct RecordedCase {
    /// Folder of the data set.
    pub dataset: PathBuf,
    /// Name of the case.
    pub case: String,
    /// The collision of the case as it was before the impact.
    pub scenario: ForceScenario,
    /// The recorded force over time, in the axes of the case.
    pub curve: ForceCurve,
    /// The case in the canonical form in which the models see it.
    pub canonical: ForceCase,
}
