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
            Self::Check(asked) => asked.paths.iter().for_each(|path| files.path(path)),
            Self::Impact(asked) => files.scenario(&asked.scenario),
            Self::Simulate(asked) => files.simulation(asked),
            Self::SimulateDataset(asked) => {
                files.path(&asked.dataset);
                files.vehicle(&asked.vehicle);
            }
            Self::PredictForce(asked) => match &asked.collision {
                ForceQuestion::Scenario(scenario) => files.scenario(scenario),
                ForceQuestion::Case { dataset, .. } => files.path(dataset),
                ForceQuestion::Numbers { .. } => {}
            },
            Self::PredictMotion(asked) => {
                files.simulation(&asked.motion);
                if let ForceSource::File(path) = &asked.force {
                    files.path(path);
                }
            }
            Self::Reconstruct(asked) => {
                if let Some(path) = asked.evidence.file() {
                    files.path(path);
                }
                files.vehicle(&asked.vehicle);
                files.vehicle(&asked.striking);
                files.site(asked.site.as_deref());
            }
            Self::TrainForce(asked) => {
                files.paths(std::iter::once(&asked.data).chain(&asked.extra));
                files.training(&asked.training);
            }
            Self::TrainResponse(asked) => {
                files.path(&asked.data);
                files.vehicle(&asked.vehicle);
                files.training(&asked.training);
            }
            Self::FineTune(asked) => {
                files.paths(&asked.data);
                let logs = asked.logs.iter();
                files.paths(logs.flat_map(|logs| logs.logs.iter().chain(&logs.forces)));
                files.vehicle(&asked.vehicle);
                files.training(&asked.training);
            }
            Self::EvaluateForce(asked) => files.path(&asked.data),
            Self::EvaluateReconstruction(asked) => files.paths(&asked.evidence_files()),
            Self::EvaluateResponse(asked) => {
                files.path(&asked.data);
                files.vehicle(&asked.vehicle);
            }
            Self::Compare(asked) => {
                files.path(&asked.data);
                files.vehicle(&asked.vehicle);
                files.config(&asked.config);
            }
        }
        files.0
    }

    /// Every file that the answer rests on: those of [`Request::input_files`] and trained networks.
    pub fn files_read(&self) -> Vec<PathBuf> {
        let networks: Vec<&ModelChoice> = match self {
            Self::PredictForce(asked) => vec![&asked.model],
            Self::PredictMotion(asked) => match &asked.force {
                ForceSource::Predicted(model) => vec![model, &asked.response_model],
                ForceSource::Given | ForceSource::File(_) => vec![&asked.response_model],
            },
            Self::FineTune(asked) => asked.model.iter().collect(),
            Self::EvaluateForce(asked) => vec![&asked.model],
            Self::EvaluateResponse(asked) => vec![&asked.model],
            Self::Compare(asked) => asked.model.iter().collect(),
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

    fn simulation(&mut self, asked: &SimulateRequest) {
        match &asked.source {
            MotionSource::Case { dataset, .. } => self.path(dataset),
            MotionSource::Trajectory { file, .. } => self.path(&file.path),
            MotionSource::Drive(Drive { force, steer, wheels, .. }) => {
                self.series([force, steer, wheels])
            }
            MotionSource::Scenario { scenario, .. } => self.scenario(scenario),
        }
        self.vehicle(&asked.vehicle);
        self.vehicle(&asked.striking);
        self.site(asked.site.as_deref());
    }

    /// A site file with the files that it names.
    fn site(&mut self, site: Option<&Path>) {
        if let Some(site) = site {
            self.path(site);
            self.paths(&Site::files_named_by(site));
        }
    }
}
