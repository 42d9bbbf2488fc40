//! Files without time series, read as what their content says they are.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde_json::Value;

use crate::case_file::CaseFile;
use crate::caveats::bodies::{doubtful, unusual_phrases};
use crate::questions::reconstruct::assumed::unused;
use crate::{InputKind, Request};
use impactlab_core::collision::Scenario;
use impactlab_core::compare::PairRecords;
use impactlab_core::data::{
    CASES_FILE, MAX_RESULTS_BYTES, MAX_SETTINGS_BYTES, TomlFile, read_utf8, without_byte_order_mark,
};
use impactlab_core::error_chain;
use impactlab_core::site::{
    CloudFormat, CloudSummary, Site, SiteError, read_drawing, read_picture, survey_cloud,
};
use impactlab_core::units::{NumberFormat, Phrase, UnitSystem};
use impactlab_core::vehicle::{VehicleParameters, hidden_zones};
use impactlab_networks::nn::kind_of_file;
use impactlab_networks::response::evaluate::Comparison;
use impactlab_reconstruct::evidence::Evidence;

/// A file that was read. It is small, or only its header was read.
#[derive(Debug)]
pub enum InputFile {
    /// A case with its variants.
    Case(Box<CaseFile>),
    /// The evidence of a reconstruction.
    Evidence(Box<Evidence>),
    /// A collision of two vehicles.
    Scenario(Box<Scenario>),
    /// A vehicle.
    Vehicle(Box<VehicleParameters>),
    /// A ground, or a picture as a ground of its own.
    Site(Box<Site>),
    /// A point cloud, of which every point was read.
    Cloud(Box<CloudSummary>),
    /// A trained network: which one its header names.
    Network(String),
    /// A comparison of response networks.
    Comparison(Box<Comparison>),
    /// A data set of recorded pairs of vehicles.
    Pairs(Box<PairRecords>),
    /// A question.
    Request(Box<Request>),
    /// The state of an unfinished reconstruction, which its question goes on from.
    Checkpoint,
    /// The settings of a training, which the training itself checks.
    Settings,
    /// An atlas, or the plan of a sweep, which their own readers check.
    OfSweep,
}

/// Why a file cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// Its content is not what its kind needs.
    #[error("{message} (read as {kind})")]
    Wrong {
        /// What it was taken for.
        kind: InputKind,
        /// What is wrong, with its causes.
        message: String,
    },
    /// It has no content.
    #[error("{}: is empty", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// It is JSON, but no kind that the program reads.
    #[error(
        "{}: is neither a question (as --print-request writes it), a case nor a comparison of response \
         networks; answers are for other programs: ask the question again to see its answer",
        path.display()
    )]
    NotRecognisedJson {
        /// The file.
        path: PathBuf,
    },
    /// It is a TOML file, but it has no key of any kind.
    #[error(
        "{}: is neither evidence (struck_car, damage), a scenario (target, bullet, contact), \
         a vehicle (mass, geometry, tires or data_sheet), a site (orthophoto, lane, kerb, \
         friction_zone, line, point, dxf), the settings of a training nor the plan of a sweep (question, vary)",
        path.display()
    )]
    NotRecognised {
        /// The file.
        path: PathBuf,
    },
}

impl InputError {
    /// The error of a reader.
    ///
    /// - `kind`: what the file was taken for.
    pub fn new(kind: InputKind, error: &dyn Error) -> Self {
        Self::Wrong { kind, message: error_chain(error) }
    }
}

impl InputFile {
    /// Finds out what a file holds and reads it.
    ///
    /// # Errors
    /// [`InputError`], which says what the file was taken for.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        Self::load_as(path, InputKind::from_path(path))
    }

    /// Reads a file whose kind is known already.
    ///
    /// # Errors
    /// As for [`InputFile::load`]; also if the path holds time series.
    pub fn load_as(path: &Path, kind: InputKind) -> Result<Self, InputError> {
        fn read<T, E: Error>(
            kind: InputKind,
            result: Result<T, E>,
            file: impl FnOnce(Box<T>) -> InputFile,
        ) -> Result<InputFile, InputError> {
            match result {
                Ok(content) => Ok(file(Box::new(content))),
                Err(error) => Err(InputError::new(kind, &error)),
            }
        }
        match kind {
            InputKind::Case => read(kind, CaseFile::load(path), Self::Case),
            InputKind::Evidence => read(kind, Evidence::load(path), Self::Evidence),
            InputKind::Scenario => read(kind, Scenario::load(path), Self::Scenario),
            InputKind::Vehicle => read(kind, VehicleParameters::load(path), Self::Vehicle),
            InputKind::Site | InputKind::Orthophoto | InputKind::Survey => {
                read(kind, Site::load(path), Self::Site)
            }
            InputKind::PointCloud => read(kind, read_cloud(path), Self::Cloud),
            InputKind::Network => read(kind, kind_of_file(path), |kind| Self::Network(*kind)),
            InputKind::Comparison if is_other_json(path) => {
                Err(InputError::NotRecognisedJson { path: path.to_owned() })
            }
            InputKind::Comparison => read(kind, Comparison::load(path), Self::Comparison),
            InputKind::Pairs => {
                let is_table = path.file_name().is_some_and(|name| name == CASES_FILE);
                let folder = if is_table { path.parent().unwrap_or(path) } else { path };
                read(kind, PairRecords::open(folder), Self::Pairs)
            }
            InputKind::Request => read_request(path),
            InputKind::Checkpoint => Ok(Self::Checkpoint),
            InputKind::Settings => read(kind, TomlFile::read(path), |_| Self::Settings),
            InputKind::Atlas => Ok(Self::OfSweep),
            InputKind::Plan => read(kind, TomlFile::read(path), |_| Self::OfSweep),
            InputKind::UnknownToml => match TomlFile::read(path) {
                Ok(text) if text.trim().is_empty() => {
                    Err(InputError::Empty { path: path.to_owned() })
                }
                Ok(_) => Err(InputError::NotRecognised { path: path.to_owned() }),
                Err(error) => Err(InputError::new(kind, &error)),
            },
            InputKind::Dataset | InputKind::Folder | InputKind::Series => {
                Err(InputError::NotRecognised { path: path.to_owned() })
            }
        }
    }

    /// What it calls itself, else the name of the file.
    pub(crate) fn name(&self, path: &Path) -> String {
        match self {
            Self::Case(case) => case.name.clone(),
            Self::Evidence(evidence) => evidence.case.clone(),
            Self::Scenario(scenario) => scenario.name.clone(),
            Self::Vehicle(vehicle) => vehicle.name.clone(),
            Self::Site(site) => site.name.clone(),
            Self::Cloud(_)
            | Self::Network(_)
            | Self::Comparison(_)
            | Self::Pairs(_)
            | Self::Request(_)
            | Self::Checkpoint
            | Self::Settings
            | Self::OfSweep => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        }
    }

    /// What of it no answer uses, a sentence each: what evidence says and a reconstruction from it does not
    /// depend on, and what a case has filled in and does not ask.
    pub(crate) fn unused(&self) -> Vec<String> {
        match self {
            Self::Case(case) => case.unused(),
            Self::Evidence(evidence) => {
                unused(evidence, false).iter().map(ToString::to_string).collect()
            }
            _ => Vec::new(),
        }
    }

    /// What it consists of, in words, with what it names read as well.
    ///
    /// - `kind`: what it was read as.
    ///
    /// # Errors
    /// [`InputError`] if picture or drawing of a site cannot be read.
    pub(crate) fn contents(&self, kind: InputKind) -> Result<Vec<String>, InputError> {
        match self {
            Self::Case(case) => {
                let variants = case.variants.iter();
                Ok(variants.map(|variant| format!("variant {:?}", variant.name)).collect())
            }
            Self::Site(site) => {
                let wrong = |error: &dyn Error| InputError::new(kind, error);
                if let Some(orthophoto) = &site.orthophoto {
                    read_picture(&orthophoto.file).map_err(|error| wrong(&error))?;
                }
                let origin = site.origin.unwrap_or_default();
                let drawing = site.drawing.as_ref().map(|drawing| read_drawing(drawing, &origin));
                let drawing = drawing.transpose().map_err(|error| wrong(&error))?;
                let summary = drawing.as_ref().map(|drawing| drawing.summary());
                let of_drawing = drawing.iter().zip(&site.drawing);
                let of_drawing = of_drawing.flat_map(|(drawing, file)| drawing.notes(&file.file));
                let contents =
                    site.contents(summary.as_ref(), UnitSystem::Si).into_iter().chain(of_drawing);
                let hidden = said(&hidden_zones(&site.friction_zones));
                Ok(contents.chain(site.notes.iter().cloned()).chain(hidden).collect())
            }
            Self::Cloud(summary) => {
                Ok(summary.contents().into_iter().chain(summary.unit_note.clone()).collect())
            }
            Self::Vehicle(vehicle) => Ok(said(&unusual_phrases(vehicle))),
            Self::Evidence(evidence) => Ok(said(&evidence.odd())),
            Self::Scenario(scenario) => {
                Ok(doubtful(scenario).into_iter().map(|caveat| caveat.text).collect())
            }
            Self::Network(kind) => Ok(vec![kind.clone()]),
            Self::Pairs(records) => pairs_contents(records, kind),
            Self::OfSweep => Ok(vec!["checked by its own command".to_owned()]),
            _ => Ok(Vec::new()),
        }
    }
}

/// Phrases in the words of the program.
fn said(phrases: &[Phrase]) -> Vec<String> {
    phrases.iter().map(|phrase| phrase.say(&NumberFormat::default())).collect()
}

/// How many cases there are of each kind of collision, with every case read.
fn pairs_contents(records: &PairRecords, kind: InputKind) -> Result<Vec<String>, InputError> {
    let names: Vec<&str> = records.names().collect();
    let problem =
        |name: &&str| Some(format!("{name}: {}", error_chain(&records.load(name)?.err()?)));
    let problems: Vec<String> = names.par_iter().filter_map(problem).collect();
    if let Some(first) = problems.first() {
        let message =
            format!("{} of {} cases cannot be read, such as {first}", problems.len(), names.len());
        return Err(InputError::Wrong { kind, message });
    }
    let mut kinds: Vec<String> =
        names.iter().filter_map(|name| Some(records.attributes(name)?.kind)).collect();
    kinds.sort();
    let counted = kinds.chunk_by(|a, b| a == b).filter(|of_kind| !of_kind[0].is_empty());
    let counted = counted.map(|of_kind| format!("{} {}", of_kind.len(), of_kind[0]));
    Ok([format!("{} cases", names.len())].into_iter().chain(counted).collect())
}

/// Reads all points of a cloud.
fn read_cloud(path: &Path) -> Result<CloudSummary, SiteError> {
    let format = CloudFormat::from_path(path).unwrap_or(CloudFormat::Las);
    survey_cloud(path, format, None, &mut |_| ControlFlow::Continue(()))
}

/// Whether a file is JSON that has not what every comparison has.
fn is_other_json(path: &Path) -> bool {
    let text = read_utf8(path, MAX_RESULTS_BYTES).ok();
    let json = |text: String| serde_json::from_str::<Value>(without_byte_order_mark(&text)).ok();
    let found = text.and_then(json);
    found.is_some_and(|found| ["models", "test"].iter().any(|key| found.get(key).is_none()))
}

fn read_request(path: &Path) -> Result<InputFile, InputError> {
    let kind = InputKind::Request;
    let text =
        read_utf8(path, MAX_SETTINGS_BYTES).map_err(|error| InputError::new(kind, &error))?;
    match serde_json::from_str(without_byte_order_mark(&text)) {
        Ok(request) => Ok(InputFile::Request(Box::new(request))),
        Err(error) => {
            let message = format!("{}: {error}", path.display());
            Err(InputError::Wrong { kind, message })
        }
    }
}
