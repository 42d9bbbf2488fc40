//! What a force sample in a file stands for: the one place where that is decided.
//!
//! | File | A sample is |
//! | --- | --- |
//! | in `forces/` or `trajectories/` of a data set | as in that kind of data set |
//! | with the target's motion beside the force (`target_vx`), as from a finite-element run | the mean over an interval centred at its instant |
//! | a trajectory with the force in heading axes (`fx_body`) | the mean over the coming interval |
//! | anything else, such as a measured force | the value at its instant |
//!
//! `--sampling` overrules it, and every command that uses a force prints what was taken.

use std::path::Path;

use clap::ValueEnum;

use crate::data::{Channel, DatasetKind, FileKind, Loaded, Sampling};

/// What a force sample stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum SamplingArg {
    /// The value at its instant
    Instant,
    /// The mean over an interval centred at its instant
    CentredMean,
    /// The mean from its instant to the next one
    ComingMean,
}

impl From<SamplingArg> for Sampling {
    fn from(sampling: SamplingArg) -> Self {
        match sampling {
            SamplingArg::Instant => Self::Instant,
            SamplingArg::CentredMean => Self::CentredMean,
            SamplingArg::ComingMean => Self::ComingMean,
        }
    }
}

/// What the force samples of a file stand for; see the table above.
pub(super) fn sampling_of(path: &Path, loaded: &Loaded) -> Sampling {
    let has = |channel| loaded.series.get(channel).is_some();
    if let Some(kind) = dataset_kind(path) {
        kind.sampling()
    } else if has(Channel::TargetVx) {
        Sampling::CentredMean
    } else if loaded.kind == FileKind::Trajectory && has(Channel::FxBody) && !has(Channel::Fx) {
        Sampling::ComingMean
    } else {
        Sampling::Instant
    }
}

/// The kind of the data set in whose folder of cases the file lies.
fn dataset_kind(path: &Path) -> Option<DatasetKind> {
    let folder = path.parent()?;
    let root = folder.parent()?;
    let kind = DatasetKind::of_folder(root)?;
    let is_case = folder.file_name().is_some_and(|name| name == kind.folder());
    (is_case && root.join("cases.csv").is_file()).then_some(kind)
}
