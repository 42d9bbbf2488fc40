//! Which files a question reads.

use std::path::{Path, PathBuf};

use crate::{
    ConfigChoice, Drive, ForceQuestion, ForceSource, ModelChoice, MotionSource, Request,
    ScenarioChoice, SeriesFile, SimulateRequest, TrainingOptions, VehicleChoice,
};
use impactlab_core::data::Dataset;
use impactlab_core::site::Site;

impl Request {
    /// The files that the question names and those of its data sets, in their order, each once.
    /// Trained networks are left out; every report has their digests. Whether the files exist is
    /// found when the question is answered.
    pub fn input_files(&self) -> Vec<PathBuf> {
        let mut files = Files::default();
        match self {
            Self::Check(request) => request.paths.iter().for_each(|path| files.path(path)),
            Self::Impact(request) => files.scenario(&request.scenario),
            Self::Simulate(request) => files.simulation(request),
            Self::SimulateDataset(request) => {
                files.path(&request.dataset);
                files.vehicle(&request.vehicle);
            }
            Self::PredictForce(request) => match &request.collision {
                ForceQuestion::Scenario(scenario) => files.scenario(scenario),
                ForceQuestion::Case { dataset, .. } => files.path(dataset),
                ForceQuestion::Numbers { .. } => {}
            },
            Self::PredictMotion(request) => {
                files.simulation(&request.motion);
                if let ForceSource::File(path) = &request.force {
                    files.path(path);
                }
            }
            Self::Reconstruct(request) => {
                if let Some(path) = request.evidence.file() {
                    files.path(path);
                }
                files.vehicle(&request.vehicle);
                files.vehicle(&request.striking);
                files.site(request.site.as_deref());
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
            }
            Self::EvaluateForce(request) => files.path(&request.data),
            Self::EvaluateReconstruction(request) => files.paths(&request.evidence_files()),
            Self::EvaluateResponse(request) => {
                files.path(&request.data);
                files.vehicle(&request.vehicle);
            }
            Self::Compare(request) => {
                files.path(&request.data);
                files.vehicle(&request.vehicle);
                files.config(&request.config);
            }
        }
        files.0
    }

    /// Every file that the answer rests on: those of [`Request::input_files`] and trained networks.
    pub fn files_read(&self) -> Vec<PathBuf> {
        let networks: Vec<&ModelChoice> = match self {
            Self::PredictForce(request) => vec![&request.model],
            Self::PredictMotion(request) => match &request.force {
                ForceSource::Predicted(model) => vec![model, &request.response_model],
                ForceSource::Given | ForceSource::File(_) => vec![&request.response_model],
            },
            Self::FineTune(request) => request.model.iter().collect(),
            Self::EvaluateForce(request) => vec![&request.model],
            Self::EvaluateResponse(request) => vec![&request.model],
            Self::Compare(request) => request.model.iter().collect(),
            _ => Vec::new(),
        };
        let networks = networks.into_iter().filter_map(ModelChoice::path).map(Path::to_owned);
        self.input_files().into_iter().chain(networks).collect()
    }
}

/// Files in the order in which they were first named.
#[derive(Default)]
struct Files(Vec<PathBuf>);

impl Files {
    /// A file, or the files of a data set.
    fn path(&mut self, path: &Path) {
        let named = if path.is_dir() { Dataset::files(path) } else { vec![path.to_owned()] };
        for file in named {
            if !self.0.contains(&file) {
                self.0.push(file);
            }
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

    /// A site file with the files that it names.
    fn site(&mut self, site: Option<&Path>) {
        if let Some(site) = site {
            self.path(site);
            self.paths(&Site::files_named_by(site));
        }
    }
}
