//! The response network beside the tuned and the untuned 4DOF model and a plain network: `compare`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::{check, check_count};
use crate::ask::inputs::{UsableCases, data_name, dataset_folders, response_cases};
use crate::ask::question::progress_of;
use crate::caveats::restrictions;
use crate::facts::FactWriter;
use crate::{
    Answer, BadCases, ConfigChoice, Library, ModelChoice, Observer, Provenance, Question,
    StudyError, VehicleChoice,
};
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{DataError, Existing, Outcome, write_bytes};
use impactlab_core::ranges::{CHOICES, TRAJECTORIES, TRAJECTORY_SETS};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_networks::response::evaluate::{
    Comparison, ComparisonSettings, all_tables, compare_models, compare_on_unseen_cars,
};
use impactlab_networks::response::{
    ResponseCase, ResponseConfig, ResponseModel, ResponseTrainingSet,
};

/// Numbers of trajectories to fine-tune on where nobody says them.
const DEFAULT_TRAJECTORIES: [usize; 2] = [5, 20];
/// Choices of the trajectories for each number where nobody says how many.
pub const DEFAULT_CHOICES: u64 = 3;

/// Asks which response model does best on motions that none has seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompareRequest {
    /// A trajectory data set; a share of its cases is kept apart for the test. With
    /// [`CompareRequest::leave_one_car_out`] a folder of such sets, one for each car.
    pub data: PathBuf,
    /// Whether each car is asked about that the network has not seen: a network that knows how cars
    /// differ as it is, another trained on the other cars.
    #[serde(default)]
    pub leave_one_car_out: bool,
    /// With [`CompareRequest::leave_one_car_out`]: data sets that are learned from beside.
    #[serde(default)]
    pub beside: Vec<PathBuf>,
    /// Numbers of trajectories to fine-tune on.
    #[serde(default = "default_trajectories")]
    pub trajectories: Vec<usize>,
    /// Choices of the trajectories for each number.
    #[serde(default = "default_choices")]
    pub choices: u64,
    /// Seed of the split and of the first choice.
    #[serde(default)]
    pub seed: u64,
    /// A pre-trained response network; pre-trained here if not given.
    #[serde(default)]
    pub model: Option<ModelChoice>,
    /// The struck vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// Settings of the networks.
    #[serde(default)]
    pub config: ConfigChoice,
    /// What happens to cases that cannot be used.
    #[serde(default)]
    pub bad_cases: BadCases,
}

fn default_trajectories() -> Vec<usize> {
    DEFAULT_TRAJECTORIES.to_vec()
}

fn default_choices() -> u64 {
    DEFAULT_CHOICES
}

impl CompareRequest {
    /// A comparison on a data set in which nothing else is said.
    pub fn new(data: impl Into<PathBuf>) -> Self {
        Self {
            data: data.into(),
            leave_one_car_out: false,
            beside: Vec::new(),
            trajectories: default_trajectories(),
            choices: DEFAULT_CHOICES,
            seed: 0,
            model: None,
            vehicle: VehicleChoice::default(),
            config: ConfigChoice::default(),
            bad_cases: BadCases::default(),
        }
    }
}

impl CompareRequest {
    /// The settings of the networks, and the network that was given, if one was.
    pub(crate) fn settings(
        &self,
        library: &Library,
    ) -> Result<(ResponseConfig, Option<Arc<ResponseModel>>), StudyError> {
        let start = self.model.as_ref().map(|model| library.response_model(model)).transpose()?;
        Ok((self.config.response(start.as_deref())?, start))
    }

    /// The trajectories, and why others are left out.
    pub(crate) fn cases(
        &self,
        caveats: &mut Caveats,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<UsableCases<ResponseCase>>, StudyError> {
        let folders = match self.leave_one_car_out {
            true => {
                [self.beside.clone(), dataset_folders(std::slice::from_ref(&self.data))?].concat()
            }
            false => vec![self.data.clone()],
        };
        let mut usable = UsableCases { cases: Vec::new(), left_out: Vec::new() };
        for folder in folders {
            let cases =
                response_cases(&folder, &self.vehicle, self.bad_cases, caveats, library, observer)?;
            let Outcome::Complete(of_folder) = cases else { return Ok(Outcome::Cancelled) };
            usable.cases.extend(of_folder.cases);
            usable.left_out.extend(of_folder.left_out);
        }
        Ok(Outcome::Complete(usable))
    }
}

impl CompareReport {
    /// Names of its files but for the tables: all numbers, and the text.
    pub const FILES: [&str; 2] = ["comparison.json", "comparison.md"];
}

impl Answer<CompareReport> {
    /// Writes [`CompareReport::FILES`] and each table as CSV into a folder, which must exist and have no
    /// files of these names.
    ///
    /// # Errors
    /// [`DataError::Io`] with the file.
    pub fn write(&self, folder: &Path) -> Result<(), DataError> {
        let [json_name, text_name] = CompareReport::FILES;
        let file = folder.join(json_name);
        let to_error = |source: serde_json::Error| DataError::io(&file, source.into());
        // A line for each number of all paths would be long.
        let json = serde_json::to_vec(&self.comparison).map_err(to_error)?;
        let markdown = FactWriter::english(UnitSystem::default()).markdown(&self.facts());
        let markdown =
            self.caveats.appended_to(format!("# {}\n\n{markdown}", self.comparison.data));
        let restrictions = self.caveats.text();
        let tables = all_tables(&self.comparison).into_iter();
        let tables = tables.map(|(_, name, table)| (name, table.to_csv(restrictions.as_deref())));
        let texts = tables.chain([(text_name, markdown)]);
        let files = texts.map(|(name, text)| (folder.join(name), text.into_bytes()));
        std::iter::once((file.clone(), json))
            .chain(files)
            .try_for_each(|(path, bytes)| write_bytes(&path, Existing::Refuse, &bytes))
    }

    /// Version of the program, seed and the networks that were given.
    pub fn provenance_with_seed(&self) -> Provenance {
        Provenance { seed: Some(self.comparison.seed), ..self.provenance.clone() }
    }
}

/// A finished comparison, or the evaluation of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CompareReport {
    /// The models, their metrics and the cases.
    #[serde(flatten)]
    pub comparison: Comparison,
    /// Cases that were left out, and why.
    pub left_out: Vec<String>,
}

/// A finished comparison, or the evaluation of one model.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<CompareReport>,
}

impl CompareAnswer {
    /// - `models`: the networks that were given; the comparison has the seed itself.
    pub(crate) fn new(
        comparison: Comparison,
        left_out: Vec<String>,
        mut caveats: Caveats,
        models: impl IntoIterator<Item = ModelDigest>,
    ) -> Self {
        let provenance = Provenance::default().with_models(models);
        caveats.extend(restrictions::left_out_caveat(left_out.len(), "cases"));
        let report = CompareReport { comparison, left_out };
        Self { report: Answer { report, caveats, provenance } }
    }
}

impl Question for CompareRequest {
    type Answer = CompareAnswer;
    type Report = Answer<CompareReport>;
    const NAME: &'static str = "compare";

    fn check(&self) -> Result<(), StudyError> {
        check_count("trajectories", &TRAJECTORY_SETS, self.trajectories.len())?;
        for n in &self.trajectories {
            check_count("trajectories", &TRAJECTORIES, *n)?;
        }
        check("choices", &CHOICES, self.choices as f64)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<CompareAnswer>, StudyError> {
        let (config, start) = self.settings(library)?;
        let digest = |model| library.response_model_digest(model);
        let digest = self.model.as_ref().map(digest).transpose()?;
        let mut caveats = Caveats::default();
        let cases = self.cases(&mut caveats, library, observer)?;
        let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
        let settings = ComparisonSettings {
            config,
            trajectories: self.trajectories.clone(),
            n_choices: self.choices,
            seed: self.seed,
        };
        let name = data_name(&self.data);
        let mut report = progress_of(observer);
        let compared = match self.leave_one_car_out {
            true => {
                let start = start.as_deref().ok_or(StudyError::NoStart)?;
                let set = ResponseTrainingSet { name, train: usable.cases, test: Vec::new() };
                compare_on_unseen_cars(&set, start, &settings, &mut report)?
            }
            false => {
                compare_models(&name, &usable.cases, start.as_deref(), &settings, &mut report)?
            }
        };
        Ok(match compared {
            None => Outcome::Cancelled,
            Some(comparison) => {
                Outcome::Complete(CompareAnswer::new(comparison, usable.left_out, caveats, digest))
            }
        })
    }
}
