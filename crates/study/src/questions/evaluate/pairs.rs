//! How well forecasts of two vehicles to the end do on recorded pairs: `evaluate pairs`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::check_count;
use crate::questions::recorded_pair::{ReadyPair, of_case};
use crate::{Answer, Event, Library, ModelChoice, Observer, Provenance, Question, StudyError};
use impactlab_core::compare::{PairCase, PairRecords};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_core::numerics::sha256_hex;
use impactlab_core::ranges::DRAWS;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_core::vehicle::Manoeuvre;
use impactlab_networks::pair::{
    ByControl, EvaluatedPair, EvaluatedTwins, PairForecast, PairSettings, PairSummary, TwinOutcome,
    TwinSummary, VehicleSummary, evaluate_pair,
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
#[serde(deny_unknown_fields)]
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
    pub overall: Option<StruckSummary>,
    /// The striking vehicle over all cases.
    pub striking: Option<VehicleSummary>,
    /// Over all cases, and over those of which something is said.
    pub groups: Vec<PairGroup>,
    /// Each case, with the brake torques of the struck vehicle as recorded, those of its stability control
    /// among them.
    pub cases: Vec<EvaluatedPair>,
    /// Each case with stability control whose twin without it is recorded as well: forecasts of both with
    /// our systems in the place of the recorded brake torques of the struck vehicle.
    pub twins: Vec<EvaluatedTwins>,
    /// Cases that have no forecast, and why.
    pub left_out: Vec<String>,
}

/// The struck vehicle over all cases.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StruckSummary {
    /// Its forecasts beside its records.
    #[serde(flatten)]
    pub vehicle: VehicleSummary,
    /// What its stability control changes; none without twins.
    pub twins: Option<TwinSummary>,
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

    /// Follows a pair over draws.
    fn forecast(
        &self,
        case: &PairCase,
        struck: &Manoeuvre,
        model: Option<&ResponseModel>,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<PairForecast>, String> {
        let settings =
            PairSettings { n_draws: self.draws, seed: self.seed, ..PairSettings::default() };
        ReadyPair::new(case, model)?.forecast(struck, &settings, report)
    }
}

/// The cases of `names` with stability control whose twins without it are recorded as well.
fn twins_of(records: &PairRecords, names: &[String]) -> Vec<ByControl<String>> {
    let twins = names.iter().filter_map(|name| {
        let without = records.attributes(name)?.twin_without_stability_control?;
        records.attributes(&without)?;
        Some(ByControl { without, with: name.clone() })
    });
    twins.collect()
}

/// Twins of which both outcomes are known.
fn evaluated_twins(
    twins: Vec<ByControl<String>>,
    outcomes: &BTreeMap<String, TwinOutcome>,
) -> Vec<EvaluatedTwins> {
    let evaluated = twins.into_iter().filter_map(|cases| {
        let [without, with] = [&cases.without, &cases.with].map(|name| outcomes.get(name).copied());
        let outcomes = ByControl { without: without?, with: with? };
        Some(EvaluatedTwins::new(cases, outcomes))
    });
    evaluated.collect()
}

/// Goes through cases until all of them are done or the observer ends it.
struct CaseByCase<'a, 'o> {
    records: &'a PairRecords,
    observer: &'a mut Observer<'o>,
    n_done: usize,
    n_total: usize,
    left_out: Vec<String>,
    stopped: bool,
}

impl CaseByCase<'_, '_> {
    /// What comes of each case.
    fn each<T>(
        &mut self,
        names: &[&String],
        mut answer: impl FnMut(&PairCase, &mut ProgressCallback<'_>) -> Result<Outcome<T>, String>,
    ) -> Vec<T> {
        let mut found = Vec::with_capacity(names.len());
        for name in names {
            let (observer, [n_done, n_total]) = (&mut *self.observer, [self.n_done, self.n_total]);
            let mut report = |progress: Progress| {
                let share = progress.fraction().map_or(0.0, f64::from);
                let position = 1000.0 * (n_done as f64 + share);
                let what = format!("{name}: {}", progress.message);
                let total = 1000 * n_total as u64;
                observer(Event::Progress(Progress::new(position as u64, total, what)))
            };
            self.stopped = self.stopped || report(Progress::new(0, 1, "reading")).is_break();
            if self.stopped {
                break;
            }
            let Some(loaded) = self.records.load(name) else { continue };
            let loaded = loaded.map_err(|error| format!("{name}: {}", error_chain(&error)));
            match loaded.and_then(|case| answer(&case, &mut report)) {
                Ok(Outcome::Complete(it)) => found.push(it),
                Ok(Outcome::Cancelled) => self.stopped = true,
                // A case and its twin may have the same fault.
                Err(problem) if self.left_out.contains(&problem) => {}
                Err(problem) => self.left_out.push(problem),
            }
            self.n_done += 1;
        }
        found
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

    fn has_problems(report: &Self::Report) -> bool {
        !report.left_out.is_empty()
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
        let model = model.as_deref();
        let twins = twins_of(&records, &names);
        let mut work = CaseByCase {
            records: &records,
            observer,
            n_done: 0,
            n_total: names.len() + 2 * twins.len(),
            left_out: Vec::new(),
            stopped: false,
        };
        let all: Vec<&String> = names.iter().collect();
        let cases = work.each(&all, |case, report| {
            let forecast = self.forecast(case, &case.manoeuvres[0], model, report)?;
            let Outcome::Complete(forecast) = forecast else { return Ok(Outcome::Cancelled) };
            let evaluated =
                evaluate_pair(case, &forecast).map_err(|error| of_case(case, &error))?;
            Ok(Outcome::Complete(evaluated))
        });
        let both: Vec<&String> =
            twins.iter().flat_map(|cases| [&cases.without, &cases.with]).collect();
        let outcomes = work.each(&both, |case, report| {
            let struck = case.struck_with_own_systems(case.attributes.has_stability_control);
            let forecast = self.forecast(case, &struck, model, report)?;
            let Outcome::Complete(forecast) = forecast else { return Ok(Outcome::Cancelled) };
            let outcome =
                TwinOutcome::new(case, &forecast).map_err(|error| of_case(case, &error))?;
            Ok(Outcome::Complete((case.name.clone(), outcome)))
        });
        let CaseByCase { left_out, stopped, .. } = work;
        if stopped && cases.is_empty() {
            return Ok(Outcome::Cancelled);
        }
        let twins = evaluated_twins(twins, &outcomes.into_iter().collect());
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
            overall: all.as_ref().map(|all| StruckSummary {
                vehicle: all.struck.clone(),
                twins: TwinSummary::from_twins(&twins),
            }),
            striking: all.map(|all| all.striking),
            groups,
            cases,
            twins,
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
        let text = Phrase::new(
            "{0} of {1} cases have no forecast",
            "{0} von {1} Fällen haben keine Vorhersage",
        )
        .with(PhraseValue::Name(n_missing.to_string()))
        .with(PhraseValue::Name(n_expected.to_string()));
        Caveat::new(CaveatKind::LeftOut, text)
            .with_value("cases without a forecast", n_missing as f64)
            .with_range([0.0, 0.0])
    })
}
