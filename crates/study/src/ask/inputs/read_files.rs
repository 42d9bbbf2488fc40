//! Which files a question reads.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::ask::inputs::data_files::files_of_data;
use crate::{
    ConfigChoice, Drive, ForceQuestion, ForceSource, ModelChoice, MotionSource, Request,
    ScenarioChoice, SeriesFile, SimulateRequest, TrainingOptions, VehicleChoice,
};
use impactlab_core::site::Site;

/// A file or folder that a question names.
struct Named {
    path: PathBuf,
    role: Role,
}

/// What a question names a file for.
#[derive(PartialEq)]
enum Role {
    /// Data and settings; the folder of a data set stands for its files.
    Input,
    /// The ground, which names files itself.
    Site,
    /// A trained network.
    Network,
}

impl Request {
    /// The files that the question names and those of its data sets, in their order, each once.
    /// Trained networks are left out; every report has their digests. Whether the files exist is
    /// found when the question is answered.
    pub fn input_files(&self) -> Vec<PathBuf> {
        let named = self.named().into_iter().filter(|named| named.role != Role::Network);
        each_once(named.flat_map(Named::files))
    }

    /// Every file that the answer rests on: those of [`Request::input_files`] and trained networks.
    pub fn files_read(&self) -> Vec<PathBuf> {
        each_once(self.named().into_iter().flat_map(Named::files))
    }

    /// The files and folders that stand in the question, trained networks among them. Nothing is read.
    pub fn named_paths(&self) -> Vec<PathBuf> {
        each_once(self.named().into_iter().map(|named| named.path))
    }

    /// The file or folder that the question itself writes while it is answered.
    pub fn written_path(&self) -> Option<&Path> {
        match self {
            Self::Reconstruct(request) => request.checkpoint.as_deref(),
            Self::EvaluateReconstruction(request) => request.finished.as_deref(),
            Self::TrainForce(request) => request.training.checkpoint.as_deref(),
            Self::TrainResponse(request) => request.training.checkpoint.as_deref(),
            Self::FineTune(request) => request.training.checkpoint.as_deref(),
            _ => None,
        }
    }

    /// Whether the question trains a network.
    pub fn is_training(&self) -> bool {
        matches!(self, Self::TrainForce(_) | Self::TrainResponse(_) | Self::FineTune(_))
    }

    fn named(&self) -> Vec<Named> {
        let mut files = Files::default();
        match self {
            Self::Check(request) => files.paths(&request.paths),
            Self::Impact(request) => files.scenario(&request.scenario),
            Self::Simulate(request) => files.simulation(request),
            Self::SimulateDataset(request) => {
                files.path(&request.dataset);
                files.vehicle(&request.vehicle);
            }
            Self::PredictForce(request) => {
                match &request.collision {
                    ForceQuestion::Scenario(scenario) => files.scenario(scenario),
                    ForceQuestion::Case { dataset, .. } => files.path(dataset),
                    ForceQuestion::Numbers { .. } => {}
                }
                files.network(&request.model);
            }
            Self::PredictMotion(request) => {
                files.simulation(&request.motion);
                match &request.force {
                    ForceSource::File(path) => files.path(path),
                    ForceSource::Predicted(model) => files.network(model),
                    ForceSource::Given => {}
                }
                files.network(&request.response_model);
            }
            Self::Reconstruct(request) => {
                if let Some(path) = request.evidence.file() {
                    files.path(path);
                }
                files.vehicle(&request.vehicle);
                files.vehicle(&request.striking);
                files.site(request.site.as_deref());
            }
            Self::Hand(_) => {}
            Self::Replay(request) => {
                files.path(&request.recorder);
                files.vehicle(&request.vehicle);
            }
            Self::TrainForce(request) => {
                files.paths(std::iter::once(&request.data).chain(&request.extra));
                files.training(&request.training);
            }
            Self::TrainResponse(request) => {
                files.path(&request.data);
                files.vehicle(&request.vehicle);
                files.training(&request.training);
            }
            Self::FineTune(request) => {
                files.paths(&request.data);
                let logs = request.logs.iter();
                files.paths(logs.flat_map(|logs| logs.logs.iter().chain(&logs.forces)));
                files.vehicle(&request.vehicle);
                files.training(&request.training);
                request.model.iter().for_each(|model| files.network(model));
            }
            Self::EvaluateForce(request) => {
                files.path(&request.data);
                files.network(&request.model);
            }
            Self::EvaluatePairs(request) => {
                files.path(&request.data);
                files.network(&request.model);
            }
            Self::EvaluateReconstruction(request) => files.path(&request.data),
            Self::EvaluateResponse(request) => {
                files.path(&request.data);
                files.vehicle(&request.vehicle);
                files.network(&request.model);
            }
            Self::Compare(request) => {
                files.path(&request.data);
                files.vehicle(&request.vehicle);
                files.config(&request.config);
                request.model.iter().for_each(|model| files.network(model));
            }
        }
        files.0
    }
}

impl Named {
    /// The file, the files of a data set, or a site with the files that it names.
    fn files(self) -> Vec<PathBuf> {
        let Self { path, role } = self;
        match role {
            Role::Site => {
                std::iter::once(path.clone()).chain(Site::files_named_by(&path)).collect()
            }
            Role::Network => vec![path],
            Role::Input => files_of_data(&path),
        }
    }
}

/// Paths in their order, without those that come again.
fn each_once(paths: impl Iterator<Item = PathBuf>) -> Vec<PathBuf> {
    let mut seen = HashSet::new();
    paths.filter(|path| seen.insert(path.clone())).collect()
}

/// Files in the order in which they are named.
#[derive(Default)]
struct Files(Vec<Named>);

impl Files {
    /// A file, or the folder of a data set.
    fn path(&mut self, path: &Path) {
        self.add(path, Role::Input);
    }

    fn add(&mut self, path: &Path, role: Role) {
        self.0.push(Named { path: path.to_owned(), role });
    }

    fn network(&mut self, model: &ModelChoice) {
        if let Some(path) = model.path() {
            self.add(path, Role::Network);
        }
    }

    fn paths<'a>(&mut self, paths: impl IntoIterator<Item = &'a PathBuf>) {
        paths.into_iter().for_each(|path| self.path(path));
    }

    fn series(&mut self, files: [&Option<SeriesFile>; 3]) {
        files.into_iter().flatten().for_each(|file| self.path(&file.path));
    }

    fn vehicle(&mut self, choice: &VehicleChoice) {
        if let VehicleChoice::File(path) = choice {
            self.path(path);
        }
    }

    fn scenario(&mut self, choice: &ScenarioChoice) {
        if let Some(path) = choice.file() {
            self.path(path);
        }
    }

    fn config(&mut self, choice: &ConfigChoice) {
        if let Some(path) = choice.file() {
            self.path(path);
        }
    }

    fn training(&mut self, options: &TrainingOptions) {
        self.config(&options.config);
    }

    fn simulation(&mut self, request: &SimulateRequest) {
        match &request.source {
            MotionSource::Case { dataset, .. } => self.path(dataset),
            MotionSource::Trajectory { file, .. } => self.path(&file.path),
            MotionSource::Drive(Drive { force, steer, wheels, .. }) => {
                self.series([force, steer, wheels])
            }
            MotionSource::Scenario { scenario, .. } => self.scenario(scenario),
        }
        self.vehicle(&request.vehicle);
        self.vehicle(&request.striking);
        self.site(request.site.as_deref());
    }

    fn site(&mut self, site: Option<&Path>) {
        if let Some(site) = site {
            self.add(site, Role::Site);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;
    use crate::CheckRequest;

    #[test]
    fn the_time_to_list_files_grows_with_their_number_only() {
        let path = |i: usize| PathBuf::from(format!("/no/such/forces/k{:06}.csv", i % 100_000));
        let paths: Vec<PathBuf> = (0..200_000).map(path).collect();
        let request = Request::from(CheckRequest { paths: paths.clone(), all: false, map: None });
        let started = Instant::now();
        assert_eq!(request.files_read(), paths[..100_000]);
        assert_eq!(request.named_paths(), paths[..100_000]);
        // It took minutes when each path was compared with all before it.
        assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
    }
}
