//! Every case of a trajectory data set, or of one of recorded pairs, against its recorded motion: `simulate
//! --dataset`.

use crate::caveats::assumed;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::inputs::{OpenVehicle, struck_vehicle};
use crate::ask::question::progress_of;
use crate::caveats::restrictions;
use crate::questions::simulate::pairs::{PairReplay, SimulatedPair, SimulatedPairs};
use crate::{
    Answer, FlagReport, Library, Observer, Provenance, Question, StudyError, VehicleChoice, word,
};
use impactlab_core::compare::{
    DatasetReplay, ErrorSummary, MotionError, PairRecords, Replay, replay_dataset,
};
use impactlab_core::data::{DataError, Dataset, DatasetKind, Outcome};
use impactlab_core::error_chain;
use impactlab_core::uncertainty::{CaveatSubject, Caveats};
use impactlab_core::vehicle::{Equations, Integrator, Motion};

/// Asks how far the 4DOF model lies from every recorded motion of a data set. Both vehicles of a recorded pair
/// are followed through all contacts, by what their drivers did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulateDatasetRequest {
    /// The data set; trainings and evaluations call theirs `data`, which is read here, too.
    #[serde(alias = "data")]
    pub dataset: PathBuf,
    /// One case of it, instead of all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case: Option<String>,
    /// The struck vehicle; recorded pairs have their own.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// Which equations of motion; those of the vehicle file if not given.
    #[serde(default)]
    pub equations: Option<Equations>,
    /// How they are integrated.
    #[serde(default)]
    pub integrator: Integrator,
}

/// How far the simulation lies from the recorded motions, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SimulateDatasetReport {
    /// The data set.
    pub dataset: PathBuf,
    /// The struck vehicle; `null` where each case has its own.
    pub vehicle: Option<String>,
    /// Which equations of motion; `null` where they are those of the vehicle files of the cases.
    pub equations: Option<String>,
    /// How they are integrated.
    pub integrator: String,
    /// Each case.
    pub cases: Vec<ReplayedCaseReport>,
    /// The struck vehicle over all cases.
    pub overall: Option<ErrorSummary>,
    /// Over cases that turn by 90° or more.
    pub spinning: Option<ErrorSummary>,
    /// Over the other cases.
    pub not_spinning: Option<ErrorSummary>,
    /// Recorded pairs: the striking vehicle and the contact over all cases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pairs: Option<SimulatedPairs>,
    /// Cases that could not be read or simulated, and why.
    pub failures: Vec<String>,
}

/// One case, simulated and compared.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ReplayedCaseReport {
    /// Its name.
    pub case: String,
    /// Whether the recorded motion is a spin.
    pub spin: bool,
    /// How far the simulation of the struck vehicle lies from the record.
    #[serde(flatten)]
    pub error: MotionError,
    /// How often the simulated kinetic energy grows without a force; not counted of recorded pairs, whose
    /// drivers accelerate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violations: Option<usize>,
    /// A recorded pair: the striking vehicle and the contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pair: Option<SimulatedPair>,
    /// Wheel lift and roll beyond the limit.
    pub flags: Vec<FlagReport>,
}

/// A simulated data set.
#[derive(Debug)]
pub struct SimulateDatasetAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<SimulateDatasetReport>,
    /// The motions.
    pub replay: DatasetReplay,
    /// The motions of recorded pairs.
    pub pairs: Vec<PairReplay>,
}

impl Question for SimulateDatasetRequest {
    type Answer = SimulateDatasetAnswer;
    type Report = Answer<SimulateDatasetReport>;
    const NAME: &'static str = "simulate";

    fn check(&self) -> Result<(), StudyError> {
        Ok(())
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn has_problems(report: &Self::Report) -> bool {
        !report.failures.is_empty()
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<SimulateDatasetAnswer>, StudyError> {
        if PairRecords::is_at(&self.dataset) {
            return self.solve_pairs(observer);
        }
        let Outcome::Complete(dataset) = library.dataset(&self.dataset, observer)? else {
            return Ok(Outcome::Cancelled);
        };
        if dataset.kind != DatasetKind::Trajectory {
            return Err(StudyError::WrongKind {
                path: self.dataset.clone(),
                got: "a data set of forces".to_owned(),
                expected: "one of trajectories",
            });
        }
        let mut caveats = Caveats::default();
        let own = OpenVehicle::OfDataset(dataset.vehicle_file.as_deref());
        let vehicle = struck_vehicle(&self.vehicle, &own, &mut caveats)?;
        caveats.extend(assumed::medians(CaveatSubject::VehicleParameter, &vehicle));
        let vehicle = match self.equations {
            Some(equations) => vehicle.with_equations(equations),
            None => vehicle,
        };
        let cases = match &self.case {
            Some(name) => std::slice::from_ref(take_case(&dataset, name)?),
            None => &dataset.cases,
        };
        let mut report = progress_of(observer);
        let replay = replay_dataset(cases, &vehicle, self.integrator, &mut report);
        let Outcome::Complete(replay) = replay else { return Ok(Outcome::Cancelled) };
        let unread = self.case.is_none().then_some(&dataset.problems);
        let problems = unread.into_iter().flatten().map(|problem| error_chain(problem));
        let failed = replay.failures.iter().map(|failure| error_chain(failure));
        let summary =
            |choose: fn(&Replay) -> bool| ErrorSummary::from_replays(&replay.cases, choose);
        let cases: Vec<ReplayedCaseReport> =
            replay.cases.iter().map(ReplayedCaseReport::from_replay).collect();
        let failures: Vec<String> = problems.chain(failed).collect();
        let flagged = restrictions::flagged_cases_caveats(&cases).into_iter();
        let left_out = restrictions::left_out_caveat(failures.len(), "cases");
        caveats.extend(flagged.chain(left_out));
        let report = SimulateDatasetReport {
            dataset: self.dataset.clone(),
            vehicle: Some(vehicle.name.clone()),
            equations: Some(word(&vehicle.equations)),
            integrator: word(&self.integrator),
            cases,
            overall: summary(|_| true),
            spinning: summary(|replay| replay.spin),
            not_spinning: summary(|replay| !replay.spin),
            pairs: None,
            failures,
        };
        let report = Answer { report, caveats, provenance: Provenance::default() };
        Ok(Outcome::Complete(SimulateDatasetAnswer { report, replay, pairs: Vec::new() }))
    }
}

impl SimulateDatasetAnswer {
    /// Every motion: its case, the name of its file without the ending, the motion. That of the striking
    /// vehicle of a pair follows that of the struck one.
    pub fn motions(&self) -> impl Iterator<Item = (&str, String, &Motion)> {
        let alone = self.replay.cases.iter();
        let alone = alone.map(|case| (case.case.as_str(), case.case.clone(), &case.motion));
        let pairs =
            self.pairs.iter().flat_map(|PairReplay { case, motions: [struck, striking] }| {
                let file = format!("{case}_striking");
                [(case.as_str(), case.clone(), struck), (case.as_str(), file, striking)]
            });
        alone.chain(pairs)
    }
}

impl Answer<SimulateDatasetReport> {
    /// What restricts the motion of one case.
    pub fn caveats_of(&self, case: &str) -> Caveats {
        let flags = self
            .cases
            .iter()
            .filter(|replayed| replayed.case == case)
            .flat_map(|replayed| &replayed.flags);
        let assumptions = self.caveats.assumptions().cloned();
        flags.map(|flag| flag.caveat.clone()).chain(assumptions).collect()
    }
}

impl ReplayedCaseReport {
    fn from_replay(replay: &Replay) -> Self {
        Self {
            case: replay.case.clone(),
            spin: replay.spin,
            error: replay.error.clone(),
            violations: Some(replay.violations),
            pair: None,
            flags: replay.motion.flags.iter().map(FlagReport::from).collect(),
        }
    }
}

/// The case of this name, or the error that says what there is.
///
/// A case that could not be read gives the reason for it.
pub(crate) fn take_case<'a>(
    dataset: &'a Dataset,
    name: &str,
) -> Result<&'a impactlab_core::data::Case, StudyError> {
    if let Some(case) = dataset.case(name) {
        return Ok(case);
    }
    let file = format!("{name}.csv");
    let is_about = |problem: &&DataError| {
        let text = problem.to_string();
        text.contains(&file) || text.contains(&format!("{name:?}"))
    };
    Err(match dataset.problems.iter().find(is_about) {
        Some(problem) => {
            let (path, problem) = (dataset.root.clone(), error_chain(problem));
            StudyError::CaseUnreadable { path, problem }
        }
        None => StudyError::NoSuchCase {
            path: dataset.root.clone(),
            case: name.to_owned(),
            n_cases: dataset.cases.len(),
            first: dataset.cases.first().map_or(String::new(), |case| case.name.clone()),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every other question about a whole data set calls it `data`, which was refused here.
    #[test]
    fn the_data_set_is_read_by_the_name_that_other_questions_have_for_it() {
        let [dataset, data] = ["dataset", "data"].map(|key| {
            let text = format!("{{\"{key}\": \"datasets/pairs\", \"case\": \"d001\"}}");
            serde_json::from_str::<SimulateDatasetRequest>(&text).unwrap()
        });
        assert_eq!(data, dataset);
        assert_eq!(data.dataset, PathBuf::from("datasets/pairs"));
    }
}
