//! Reads the plan that a person writes.
//!
//! ```toml
//! name = "PIT at 35 to 45 mph"
//! question = "pit"                  # or "request"
//! design = "sobol"                  # or "saltelli", "grid"
//! n = 100000                        # rows; base points (saltelli); rows a cell (grid)
//! chunk = 2000                      # rows of a file, 1000 if not given
//! seed = 1                          # 0 if not given
//!
//! [pit]
//! scenario = "pit-right-rear"       # what does not vary: a file, or one that comes with the program
//! limit_s = 30                      # followed to rest, at the latest for so long
//! friction_sigma = 0.05             # 0 if friction varies, else 0.075 of it
//! pairs = [{ struck = "toyota-camry-2018", striking = "ford-explorer-2020" }]
//!
//! [vary.target_speed_m_s]           # a name of PitInput
//! uniform = [15.6, 20.1]            # normal, lognormal, triangular, list, steps; low and high cut off
//! ```
//!
//! Of a request, `[request]` has its `file`, `seed_at`, and `[[request.outcomes]]` with `name`, `at` and
//! `unit`; each `[vary.NAME]` says with `at` where its value goes.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use crate::SweepError;
use crate::chunk::CAVEATS;
use crate::pit::PitInput;
use crate::plan::{
    Design, FORMAT, FORMAT_OF_FILES, PickedOutcome, PitQuestion, Plan, RequestQuestion,
    SweptQuestion, VehiclePairIds, files_of, networks,
};
use crate::row::sampled_requests;
use crate::vary::{Distribution, Vary};
use impactlab_core::collision::{SCENARIO_PRESETS, Scenario};
use impactlab_core::data::{
    MAX_SETTINGS_BYTES, TomlError, TomlFile, read_utf8, without_byte_order_mark,
};
use impactlab_core::program;
use impactlab_core::vehicle::{built_in_vehicle, usual_road_sigma};
use impactlab_study::{DEFAULT_VEHICLE, Library, Request};

/// Time after which a motion is followed no further where nobody says it, s.
const DEFAULT_LIMIT_S: f64 = 30.0;

/// Rows of a chunk where nobody says it.
const DEFAULT_CHUNK: u64 = 1000;

/// Most steps between two ends.
const MOST_STEPS: usize = 10_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlanFile {
    #[serde(default)]
    name: String,
    question: Kind,
    #[serde(default)]
    design: Design,
    n: u64,
    #[serde(default = "default_chunk")]
    chunk: u64,
    #[serde(default)]
    seed: u64,
    pit: Option<PitFile>,
    request: Option<RequestFile>,
    vary: BTreeMap<String, VaryFile>,
}

fn default_chunk() -> u64 {
    DEFAULT_CHUNK
}

#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Pit,
    Request,
}

#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct PitFile {
    scenario: Option<String>,
    limit_s: Option<f64>,
    friction_sigma: Option<f64>,
    pairs: Vec<VehiclePairIds>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RequestFile {
    file: String,
    #[serde(default)]
    seed_at: Places,
    outcomes: Vec<PickedOutcome>,
}

/// One JSON pointer, or several.
#[derive(Deserialize)]
#[serde(untagged)]
enum Places {
    One(String),
    Many(Vec<String>),
}

impl Default for Places {
    fn default() -> Self {
        Self::Many(Vec::new())
    }
}

impl Places {
    fn into_vec(self) -> Vec<String> {
        match self {
            Self::One(place) => vec![place],
            Self::Many(places) => places,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct VaryFile {
    uniform: Option<[f64; 2]>,
    normal: Option<[f64; 2]>,
    lognormal: Option<[f64; 2]>,
    triangular: Option<[f64; 3]>,
    list: Option<Vec<Value>>,
    steps: Option<(f64, f64, usize)>,
    #[serde(default)]
    weights: Vec<f64>,
    low: Option<f64>,
    high: Option<f64>,
    #[serde(default)]
    at: Places,
    unit: Option<String>,
}

/// The keys of distributions.
const DISTRIBUTIONS: [&str; 6] = ["uniform", "normal", "lognormal", "triangular", "list", "steps"];

impl Plan {
    /// Reads the plan that a person has written, and resolves it: what it names is read and stands in it.
    ///
    /// # Errors
    /// [`SweepError::Toml`] with file, line and column; and if what it names cannot be read.
    pub fn read(path: &Path, library: &Library) -> Result<Self, SweepError> {
        let text = TomlFile::read(path)?;
        let file = TomlFile { path, text: &text };
        let written: PlanFile = file.to()?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let question = match written.question {
            Kind::Pit => {
                if written.request.is_some() {
                    return Err(file.wrong_value("request", "", "no [request] of a pit").into());
                }
                let varies = |input: PitInput| written.vary.contains_key(input.name());
                let pit = written.pit.unwrap_or_default();
                let question = pit.resolved(file, folder, varies(PitInput::Friction))?;
                SweptQuestion::Pit(Box::new(question))
            }
            Kind::Request => {
                if written.pit.is_some() {
                    return Err(file.wrong_value("pit", "", "no [pit] of a request").into());
                }
                let Some(request) = written.request else {
                    return Err(file.wrong_value("request", "missing", "[request]").into());
                };
                SweptQuestion::Request(Box::new(request.resolved(folder)?))
            }
        };
        let mut vary = Vec::with_capacity(written.vary.len());
        for (name, of_file) in written.vary {
            vary.push(of_file.resolved(file, name, matches!(question, SweptQuestion::Pit(_)))?);
        }
        if matches!(question, SweptQuestion::Pit(_)) {
            vary.sort_by_key(|vary| PitInput::from_name(&vary.name));
        }
        let plan = Self {
            format: FORMAT,
            name: written.name,
            question,
            design: written.design,
            n: written.n,
            chunk: written.chunk,
            seed: written.seed,
            vary,
            program: program::version().to_owned(),
            networks: networks(library)?,
            files: Vec::new(),
        };
        plan.checked(file)
    }

    /// A column of the name of the one that the rows of a request have for their caveats. Plans of former
    /// programs may have it.
    fn fault_of_caveats(&self) -> Option<(String, String)> {
        let expected = || format!("a name that no other column has, not {CAVEATS:?}");
        if self.vary.iter().any(|vary| vary.name == CAVEATS) {
            return Some((format!("vary.{CAVEATS}"), expected()));
        }
        let is_outcome = self.outcomes().iter().any(|(name, _)| name == CAVEATS);
        is_outcome.then(|| ("request.outcomes".to_owned(), expected()))
    }

    /// The plan with the files that its rows read, if nothing is wrong with it.
    fn checked(mut self, file: TomlFile<'_>) -> Result<Self, SweepError> {
        if let Some((key, expected)) = self.fault().or_else(|| self.fault_of_caveats()) {
            let mut inner = DISTRIBUTIONS.iter().map(|name| format!("{key}.{name}"));
            let inner = inner.find(|key| file.contains(key));
            let value = if file.contains(&key) { "this" } else { "missing" };
            return Err(file.wrong_value(&inner.unwrap_or(key), value, &expected).into());
        }
        let wrong = |source| SweepError::Request { path: file.path.to_owned(), source };
        if let SweptQuestion::Request(question) = &self.question {
            // The first row shows whether values and places go together.
            let requests = sampled_requests(question, &self).map_err(wrong)?;
            if requests.iter().any(|request| request.written_path().is_some()) {
                let expected = "a request that writes no file itself";
                return Err(file.wrong_value("request.file", "", expected).into());
            }
            let here = std::env::current_dir()
                .map_err(|source| SweepError::Input { path: file.path.to_owned(), source })?;
            self = self.with_absolute_paths(&requests, &here).map_err(wrong)?;
        }
        if let SweptQuestion::Request(question) = &self.question {
            self.files = files_of(&sampled_requests(question, &self).map_err(wrong)?)?;
            if !self.files.is_empty() {
                self.format = FORMAT_OF_FILES;
            }
        }
        Ok(self)
    }
}

impl PitFile {
    fn resolved(
        self,
        file: TomlFile<'_>,
        folder: &Path,
        friction_varies: bool,
    ) -> Result<PitQuestion, SweepError> {
        let name = self.scenario.as_deref().unwrap_or("pit-right-rear");
        let is_preset = SCENARIO_PRESETS.iter().any(|(preset, _)| *preset == name);
        let scenario = match is_preset {
            true => Scenario::preset_or_file(Path::new(name))?,
            false => Scenario::load(&folder.join(name))?,
        };
        if PitInput::side(&scenario).is_none() {
            let expected = "a scenario whose contact is on the left or right side, from = \"side\"";
            return Err(file.wrong_value("pit.scenario", name, expected).into());
        }
        let limit_s = self.limit_s.unwrap_or(DEFAULT_LIMIT_S);
        let struck = scenario.struck_vehicle.as_deref().and_then(built_in_vehicle);
        let friction = struck.unwrap_or_else(|| DEFAULT_VEHICLE.parameters()).tires.friction;
        let usual = if friction_varies { 0.0 } else { usual_road_sigma(friction) };
        let road_sigma = self.friction_sigma.unwrap_or(usual);
        Ok(PitQuestion { scenario, pairs: self.pairs, road_sigma, limit_s })
    }
}

impl RequestFile {
    fn resolved(self, folder: &Path) -> Result<RequestQuestion, SweepError> {
        let path = folder.join(&self.file);
        let text = read_utf8(&path, MAX_SETTINGS_BYTES)?;
        let wrong = |source| SweepError::Request { path: path.clone(), source };
        let request: Request =
            serde_json::from_str(without_byte_order_mark(&text)).map_err(wrong)?;
        // With what the file leaves out, so that it can be varied too.
        let value = serde_json::to_value(&request).map_err(wrong)?;
        let (seed_at, outcomes) = (self.seed_at.into_vec(), self.outcomes);
        Ok(RequestQuestion { request: value, seed_at, outcomes })
    }
}

impl VaryFile {
    fn resolved(self, file: TomlFile<'_>, name: String, is_pit: bool) -> Result<Vary, TomlError> {
        let key = format!("vary.{name}");
        let wrong = |inner: &str, expected: &str| {
            Err(file.wrong_value(&format!("{key}.{inner}"), "missing", expected))
        };
        let given = [
            self.uniform.is_some(),
            self.normal.is_some(),
            self.lognormal.is_some(),
            self.triangular.is_some(),
            self.list.is_some(),
            self.steps.is_some(),
        ];
        if given.into_iter().filter(|is_given| *is_given).count() != 1 {
            return Err(file.wrong_value(&key, "this", &format!("one of {DISTRIBUTIONS:?}")));
        }
        let is_cut = self.low.or(self.high).is_some();
        if is_cut && self.normal.or(self.lognormal).is_none() {
            let inner = if self.low.is_some() { "low" } else { "high" };
            return wrong(inner, "no ends but of normal or lognormal");
        }
        if !self.weights.is_empty() && self.list.is_none() {
            return wrong("weights", "no weights but of a list");
        }
        let (low, high) = (self.low, self.high);
        let distribution = if let Some([low, high]) = self.uniform {
            Distribution::Uniform { low, high }
        } else if let Some([mean, sigma]) = self.normal {
            Distribution::Normal { mean, sigma, low, high }
        } else if let Some([median, log_sigma]) = self.lognormal {
            Distribution::Lognormal { median, log_sigma, low, high }
        } else if let Some([low, mode, high]) = self.triangular {
            Distribution::Triangular { low, mode, high }
        } else if let Some((low, high, n)) = self.steps {
            let at = |i: usize| low + (high - low) * i as f64 / (n - 1) as f64;
            let is_count = (2..=MOST_STEPS).contains(&n);
            if !is_count || !at(n - 1).is_finite() || !(1..n).all(|i| at(i - 1) < at(i)) {
                let counts = format!("number of values from 2 to {MOST_STEPS}");
                let expected =
                    format!("[low, high, {counts}] with low < high, each above the last");
                return wrong("steps", &expected);
            }
            let values = (0..n).map(|i| Value::from(at(i))).collect();
            Distribution::List { values, weights: Vec::new() }
        } else {
            let (values, weights) = (self.list.unwrap_or_default(), self.weights);
            Distribution::List { values, weights }
        };
        let at = self.at.into_vec();
        if !is_pit {
            let unit = self.unit.unwrap_or_else(|| "1".to_owned());
            return Ok(Vary { name, unit, at, distribution });
        }
        let Some(input) = PitInput::from_name(&name) else {
            let known = <PitInput as strum::VariantArray>::VARIANTS.iter().map(|it| it.name());
            let known: Vec<&str> = known.collect();
            return Err(file.wrong_value(&key, "this", &format!("one of {known:?}")));
        };
        if !at.is_empty() {
            return wrong("at", "no place: a pit knows where its inputs go");
        }
        if self.unit.is_some() {
            return wrong("unit", "no unit: the name of the input has it");
        }
        Ok(Vary { name, unit: input.unit().to_owned(), at, distribution })
    }
}
