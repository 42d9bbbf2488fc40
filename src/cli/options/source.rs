//! What a path and `--case` choose: a case of a data set, a single file, or a scenario.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::CliError;
use impactlab_core::collision::SCENARIO_PRESETS;
use impactlab_core::compare::PairRecords;
use impactlab_core::data::{ColumnMap, DataError, DatasetKind, FileKind};
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    Drive, InputKind, Library, MotionSource, ScenarioChoice, SeriesFile, StudyError,
};

/// What is shown: a case, a file or a scenario.
#[derive(Debug, Args)]
pub(in crate::cli) struct SourceArgs {
    /// A data set (with --case), a single file, or a scenario: a .toml file, or `pit-right-rear`
    pub(in crate::cli) path: PathBuf,
    /// The case of the data set
    #[arg(long, value_name = "NAME")]
    case: Option<String>,
    /// For a single file, which column is what: time=1:ms,fx=Kraft X:kN
    #[arg(long)]
    map: Option<ColumnMap>,
}

impl SourceArgs {
    /// The options that are given beside the path, each with whether it is there.
    pub(in crate::cli) fn given(&self) -> [(&'static str, bool); 2] {
        [("--case", self.case.is_some()), ("--map", self.map.is_some())]
    }

    /// What drives the motion: the case, the recorded motion, the force or steer angle of a file, or
    /// the scenario.
    ///
    /// - `start`: what a single file does not say.
    pub(in crate::cli) fn motion_source(
        &self,
        library: &Library,
        start: Drive,
    ) -> Result<MotionSource, CliError> {
        let path = self.path.clone();
        if !path.is_dir() {
            if let Some(case) = self.case.clone() {
                return Err(CliError::CaseOfFile { path, case });
            }
            if is_scenario(&path) {
                return match self.map {
                    Some(_) => Err(CliError::MapOfScenario { path }),
                    None => Ok(MotionSource::Scenario {
                        scenario: ScenarioChoice::File(path),
                        pulse: PulseSetup::default(),
                    }),
                };
            }
            let file = SeriesFile { path, map: self.map.clone() };
            let kind: FileKind = library.series(&file)?.kind;
            return Ok(MotionSource::from_file(file, kind, start));
        }
        if self.map.is_some() {
            return Err(StudyError::MapOfFolder { path }.into());
        }
        match &self.case {
            Some(case) => Ok(MotionSource::Case { dataset: path, case: case.clone() }),
            None if has_cases(&path) => Err(CliError::CaseNeeded { path }),
            None => Err(DataError::NotRecognised { path }.into()),
        }
    }
}

/// Whether a folder is a data set of cases that can be simulated one by one.
fn has_cases(path: &Path) -> bool {
    PairRecords::is_at(path) || DatasetKind::from_folder(path).is_some()
}

/// Whether a path is a scenario by its content, its ending or its name.
fn is_scenario(path: &Path) -> bool {
    let is_preset = SCENARIO_PRESETS.iter().any(|(name, _)| Path::new(name) == path);
    is_preset || InputKind::from_path(path).is_toml()
}
