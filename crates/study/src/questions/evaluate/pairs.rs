//! How well forecasts of two vehicles to the end do on recorded pairs: `evaluate pairs`.

use std::ops::ControlFlow;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::check_count;
use crate::{Answer, Event, Library, ModelChoice, Observer, Provenance, Question, StudyError};
use impactlab_core::collision::contact::{ContactConditions, ContactOutline, FaceLaws};
use impactlab_core::compare::{PairCase, PairRecords};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::sha256_hex;
use impactlab_core::ranges::DRAWS;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_networks::pair::{
    EvaluatedPair, PairQuestion, PairSettings, PairSummary, VehicleSummary, evaluate_pair,
    forecast_pair,
};
use impactlab_networks::response::ResponseModel;

/// Which recorded pairs of a folder.
///
/// The cases are put into the order of the SHA-256 of their names in hexadecimal digits; a case and its
/// twin with other electronics (the same name with an `e` behind it) stand together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PairSplit {
    /// All of them.
    #[default]
    All,
    /// The first half, rounded down: those that the contact law was fitted to.
    Fitted,
    /// The others.
    Reported,
}

/// Asks how well both vehicles of recorded pairs are forecast from their initial states and what their
/// drivers did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EvaluatePairsRequest {
    /// The folder of recorded pairs.
    pub data: PathBuf,
    /// Which of its cases.
    #[serde(default)]
    pub split: PairSplit,
    /// If not empty: those of them that have these names.
    #[serde(default)]
    pub only: Vec<String>,
    /// Number of draws of each case.
    #[serde(default = "default_draws")]
    pub draws: usize,
    /// Seed of all draws.
    #[serde(default)]
    pub seed: u64,
    /// The response network that corrects both vehicles while they are apart after the first contact.
    #[serde(default)]
    pub model: ModelChoice,
    /// Whether the equations of motion stand alone, without the network.
    #[serde(default)]
    pub physics_only: bool,
}

fn default_draws() -> usize {
    100
}

/// Forecasts of recorded pairs beside their records, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct EvaluatePairsReport {
    /// The folder.
    pub data: PathBuf,
    /// Which of its cases.
    pub split: PairSplit,
    /// Number of cases that were asked for.
    pub n_cases: usize,
    /// Number of draws of each.
    pub n_draws: usize,
    /// Whether the evaluation was stopped before all cases were done.
    pub stopped: bool,
    /// The struck vehicle over all cases; none without a case.
    pub overall: Option<VehicleSummary>,
    /// The striking vehicle over all cases.
    pub striking: Option<VehicleSummary>,
    /// Over all cases, and over those of which something is said.
    pub groups: Vec<PairGroup>,
    /// Each case.
    pub cases: Vec<EvaluatedPair>,
    /// Cases that have no forecast, and why.
    pub left_out: Vec<String>,
}

/// Cases of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PairGroup {
    /// What they have in common.
    pub name: String,
    /// Their forecasts beside their records.
    #[serde(flatten)]
    pub summary: PairSummary,
}

/// A finished evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluatePairsAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<EvaluatePairsReport>,
}

impl EvaluatePairsRequest {
    /// An evaluation in which nothing else is said.
    pub fn new(data: impl Into<PathBuf>) -> Self {
        Self {
            data: data.into(),
            split: PairSplit::default(),
            only: Vec::new(),
            draws: default_draws(),
            seed: 0,
            model: ModelChoice::default(),
            physics_only: false,
        }
    }

    /// The names of the cases, in the order of the table.
    fn names(&self, records: &PairRecords) -> Result<Vec<String>, StudyError> {
        let all: Vec<String> = records.names().map(str::to_owned).collect();
        if let Some(unknown) = self.only.iter().find(|name| !all.contains(name)) {
            return Err(StudyError::NoSuchCase {
                path: self.data.clone(),
                case: unknown.clone(),
                n_cases: all.len(),
                first: all.first().cloned().unwrap_or_default(),
            });
        }
        let mut shuffled = all.clone();
        shuffled.sort_by_cached_key(|name| sha256_hex([name.trim_end_matches('e').as_bytes()]));
        let (fitted, reported) = shuffled.split_at(shuffled.len() / 2);
        let is_chosen = |name: &String| match self.split {
            PairSplit::All => true,
            PairSplit::Fitted => fitted.contains(name),
            PairSplit::Reported => reported.contains(name),
        };
        let is_named = |name: &String| self.only.is_empty() || self.only.contains(name);
        Ok(all.into_iter().filter(|name| is_chosen(name) && is_named(name)).collect())
    }

    fn evaluated(
        &self,
        case: &PairCase,
        model: Option<&ResponseModel>,
        observer: &mut Observer<'_>,
        [done, total]: [usize; 2],
    ) -> Result<Outcome<EvaluatedPair>, String> {
        let message =
            |error: &dyn std::error::Error| format!("{}: {}", case.name, error_chain(error));
        let outline = |i: usize| {
            ContactOutline::from_vehicle(&case.vehicles[i]).map_err(|error| message(&error))
        };
        let faces =
            |i: usize| FaceLaws::by_class(&case.vehicles[i]).map_err(|error| message(&error));
        let predictor = |i: usize| {
            let predictor = model.map(|model| model.predictor(&case.vehicles[i]));
            predictor.transpose().map_err(|error| message(&error))
        };
        let outlines = [outline(0)?, outline(1)?];
        let predictors = [predictor(0)?, predictor(1)?];
        let usual = ContactConditions::default();
        let height_m = case.contact_height_m.unwrap_or(usual.height_m);
        let question = PairQuestion {
            vehicles: [&case.vehicles[0], &case.vehicles[1]],
            manoeuvres: [&case.manoeuvres[0], &case.manoeuvres[1]],
            outlines: [&outlines[0], &outlines[1]],
            faces: [faces(0)?, faces(1)?],
            conditions: ContactConditions { height_m, ..usual },
            predictors: [predictors[0].as_ref(), predictors[1].as_ref()],
            drawn: [&[]; 2],
            first_forces: &[],
        };
        let settings =
            PairSettings { n_draws: self.draws, seed: self.seed, ..PairSettings::default() };
        let mut report = |progress: Progress| {
            let share = progress.fraction().map_or(0.0, f64::from);
            let position = 1000.0 * (done as f64 + share);
            let what = format!("{}: {}", case.name, progress.message);
            observer(Event::Progress(Progress::new(position as u64, 1000 * total as u64, what)))
        };
        let forecast =
            forecast_pair(&question, &settings, &mut report).map_err(|error| message(&error))?;
        let Outcome::Complete(forecast) = forecast else { return Ok(Outcome::Cancelled) };
        let evaluated = evaluate_pair(case, &forecast).map_err(|error| message(&error))?;
        Ok(Outcome::Complete(evaluated))
    }
}

impl Question for EvaluatePairsRequest {
    type Answer = EvaluatePairsAnswer;
    type Report = Answer<EvaluatePairsReport>;
    const NAME: &'static str = "evaluate";

    fn check(&self) -> Result<(), StudyError> {
        check_count("draws", &DRAWS, self.draws)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<EvaluatePairsAnswer>, StudyError> {
        if !PairRecords::is_at(&self.data) {
            return Err(StudyError::WrongKind {
                path: self.data.clone(),
                got: "no data set of recorded pairs".to_owned(),
                expected: "a folder with cases.csv, cases/ and vehicles/",
            });
        }
        let records = PairRecords::open(&self.data)?;
        let names = self.names(&records)?;
        let model = match self.physics_only {
            true => None,
            false => Some(library.response_model(&self.model)?),
        };
        let (mut cases, mut left_out, mut stopped) = (Vec::new(), Vec::new(), false);
        for (done, name) in names.iter().enumerate() {
            if observer(Event::Progress(Progress::new(
                1000 * done as u64,
                1000 * names.len() as u64,
                name.as_str(),
            ))) == ControlFlow::Break(())
            {
                stopped = true;
                break;
            }
            let loaded = match records.load(name) {
                Some(Ok(case)) => case,
                Some(Err(error)) => {
                    left_out.push(format!("{name}: {}", error_chain(&error)));
                    continue;
                }
                None => continue,
            };
            match self.evaluated(&loaded, model.as_deref(), observer, [done, names.len()]) {
                Ok(Outcome::Complete(evaluated)) => cases.push(evaluated),
                Ok(Outcome::Cancelled) => {
                    stopped = true;
                    break;
                }
                Err(problem) => left_out.push(problem),
            }
        }
        if stopped && cases.is_empty() {
            return Ok(Outcome::Cancelled);
        }
        let groups = groups(&cases);
        let all = groups.first().map(|group| group.summary.clone());
        let digest = match self.physics_only {
            true => None,
            false => Some(library.response_model_digest(&self.model)?),
        };
        let provenance = Provenance::from_seed(self.seed).with_models(digest);
        let missing = left_out_caveat(cases.len(), names.len());
        let report = EvaluatePairsReport {
            data: self.data.clone(),
            split: self.split,
            n_cases: names.len(),
            n_draws: self.draws,
            stopped,
            overall: all.as_ref().map(|all| all.struck.clone()),
            striking: all.map(|all| all.striking),
            groups,
            cases,
            left_out,
        };
        let report = Answer { report, caveats: missing.into_iter().collect(), provenance };
        Ok(Outcome::Complete(EvaluatePairsAnswer { report }))
    }
}

/// All cases, each kind, and those with and without stability control, where there are several.
fn groups(cases: &[EvaluatedPair]) -> Vec<PairGroup> {
    let group = |name: &str, is_in: &dyn Fn(&EvaluatedPair) -> bool| {
        let summary = PairSummary::from_cases(cases.iter().filter(|case| is_in(case)))?;
        Some(PairGroup { name: name.to_owned(), summary })
    };
    let mut kinds: Vec<&str> = cases.iter().map(|case| case.kind.as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut found: Vec<PairGroup> = group("all", &|_| true).into_iter().collect();
    if kinds.len() > 1 {
        found.extend(kinds.iter().filter_map(|kind| group(kind, &|case| case.kind == *kind)));
    }
    let n_controlled = cases.iter().filter(|case| case.has_stability_control).count();
    if 0 < n_controlled && n_controlled < cases.len() {
        found.extend(group("with stability control", &|case| case.has_stability_control));
        found.extend(group("without stability control", &|case| !case.has_stability_control));
    }
    found
}

/// Cases that have no forecast.
fn left_out_caveat(n_answers: usize, n_expected: usize) -> Option<Caveat> {
    let n_missing = n_expected.saturating_sub(n_answers);
    (n_missing > 0).then(|| {
        let text = format!("{n_missing} of {n_expected} cases have no forecast");
        Caveat::new(CaveatKind::LeftOut, text)
            .with_value("cases without a forecast", n_missing as f64)
            .with_range([0.0, 0.0])
    })
}
