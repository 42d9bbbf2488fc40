//! Every case of a data set of recorded pairs against its recorded motions: `simulate --dataset`.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::caveats::restrictions;
use crate::caveats::unused::{contact_at_medians, integrator_of_pair, vehicle_of_pair};
use crate::questions::recorded_pair::{ReadyPair, no_such_pair, of_case};
use crate::{
    Answer, Event, FlagReport, Observer, Provenance, ReplayedCaseReport, SimulateDatasetAnswer,
    SimulateDatasetReport, SimulateDatasetRequest, StudyError, VehicleChoice, word,
};
use impactlab_core::collision::Role;
use impactlab_core::collision::contact::PairMotion;
use impactlab_core::compare::{
    DatasetReplay, ErrorSummary, MotionError, PairCase, PairRecords, largest_yaw_change_rad,
};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::is_quarter_turn;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::vehicle::Motion;
use impactlab_networks::pair::{Compared, PairDraw};

/// Cases that are simulated side by side between two reports of progress.
const BLOCK_CASES: usize = 8;

/// What is told of a simulated pair beside the struck vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SimulatedPair {
    /// How far the simulation of the striking vehicle lies from the record.
    pub striking: MotionError,
    /// Time for which the vehicles are in contact, s.
    pub contact_s: Compared,
    /// Impulse on the struck vehicle over all contacts, N s.
    pub impulse_n_s: Compared,
}

/// What is told of simulated pairs over all cases beside the struck vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SimulatedPairs {
    /// The striking vehicle.
    pub striking: ErrorSummary,
    /// Median over the cases of the simulated duration of contact over the recorded one.
    pub contact_ratio: Option<f64>,
    /// Median over the cases of the simulated impulse over the recorded one.
    pub impulse_ratio: Option<f64>,
    /// Median over the cases of the size of the relative error of the duration of contact.
    pub contact_error: Option<f64>,
    /// Median over the cases of the size of the relative error of the impulse.
    pub impulse_error: Option<f64>,
}

/// The motions of a simulated pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PairReplay {
    /// Name of the case.
    pub case: String,
    /// Of the struck and of the striking vehicle.
    pub motions: [Motion; 2],
}

impl SimulateDatasetRequest {
    /// Simulates recorded pairs.
    pub(super) fn solve_pairs(
        &self,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<SimulateDatasetAnswer>, StudyError> {
        let records = PairRecords::open(&self.dataset)?;
        let names = self.pair_names(&records)?;
        let (mut found, mut failures) = (Vec::new(), Vec::new());
        let n_cases = names.len() as u64;
        for block in names.chunks(BLOCK_CASES) {
            let done = (found.len() + failures.len()) as u64;
            if observer(Event::Progress(Progress::new(done, n_cases, "simulating"))).is_break() {
                return Ok(Outcome::Cancelled);
            }
            let simulated: Vec<_> =
                block.par_iter().filter_map(|name| self.simulated(&records, name)).collect();
            for simulated in simulated {
                match simulated {
                    Ok(simulated) => found.push(simulated),
                    Err(problem) => failures.push(problem),
                }
            }
        }
        let (cases, pairs): (Vec<ReplayedCaseReport>, Vec<PairReplay>) = found.into_iter().unzip();
        let mut caveats = Caveats::default();
        caveats.extend(restrictions::flagged_cases_caveats(&cases));
        caveats.extend(restrictions::left_out_caveat(failures.len(), "cases"));
        caveats.extend(integrator_of_pair(self.integrator));
        caveats.extend(
            (self.vehicle != VehicleChoice::Automatic).then(|| vehicle_of_pair(Role::Struck)),
        );
        caveats.extend([contact_at_medians(false)]);
        let summary = |choose: fn(&ReplayedCaseReport) -> bool| {
            let chosen = cases.iter().filter(|case| choose(case));
            ErrorSummary::from_errors(chosen.map(|case| &case.error))
        };
        let report = SimulateDatasetReport {
            dataset: self.dataset.clone(),
            vehicle: None,
            equations: self.equations.map(|equations| word(&equations)),
            integrator: word(&self.integrator),
            overall: summary(|_| true),
            spinning: summary(|case| case.spin),
            not_spinning: summary(|case| !case.spin),
            pairs: SimulatedPairs::from_cases(&cases),
            cases,
            failures,
        };
        let report = Answer { report, caveats, provenance: Provenance::default() };
        let replay = DatasetReplay::default();
        Ok(Outcome::Complete(SimulateDatasetAnswer { report, replay, pairs }))
    }

    fn pair_names(&self, records: &PairRecords) -> Result<Vec<String>, StudyError> {
        let all: Vec<String> = records.names().map(str::to_owned).collect();
        match &self.case {
            None => Ok(all),
            Some(name) if all.contains(name) => Ok(vec![name.clone()]),
            Some(name) => Err(no_such_pair(&self.dataset, name, records)),
        }
    }

    /// A case; `None` if there is none of this name.
    fn simulated(
        &self,
        records: &PairRecords,
        name: &str,
    ) -> Option<Result<(ReplayedCaseReport, PairReplay), String>> {
        let loaded = records.load(name)?;
        let loaded = loaded.map_err(|error| format!("{name}: {}", error_chain(&error)));
        Some(loaded.and_then(|mut case| {
            if let Some(equations) = self.equations {
                case.vehicles = case.vehicles.map(|vehicle| vehicle.with_equations(equations));
            }
            compared(&case, ReadyPair::new(&case, None)?.median_motion()?)
        }))
    }
}

/// A simulated pair beside its record.
fn compared(
    case: &PairCase,
    motion: PairMotion,
) -> Result<(ReplayedCaseReport, PairReplay), String> {
    let error = |i: usize| {
        MotionError::between(&motion.motions[i].series, &case.motions[i])
            .map_err(|error| of_case(case, &error))
    };
    let [struck, striking] = [error(0)?, error(1)?];
    let turn_rad =
        largest_yaw_change_rad(&case.motions[0]).map_err(|error| of_case(case, &error))?;
    let of_vehicle = |(role, motion): (Role, &Motion)| -> Vec<FlagReport> {
        motion.flags.iter().map(|flag| FlagReport::of_vehicle(role, flag)).collect()
    };
    let flags = Role::ALL.into_iter().zip(&motion.motions).flat_map(of_vehicle).collect();
    let end_s = case.motions[0].time_s().last().copied().unwrap_or(0.0);
    let motions = motion.motions.clone();
    let simulated = PairDraw::from_motion(0, motion);
    let contact_s = Compared { forecast: simulated.contact_s(end_s), recorded: case.contact_s() };
    let impulse_n_s = Compared { forecast: simulated.impulse_n_s(), recorded: case.impulse_n_s() };
    let report = ReplayedCaseReport {
        case: case.name.clone(),
        spin: is_quarter_turn(turn_rad),
        error: struck,
        violations: None,
        pair: Some(SimulatedPair { striking, contact_s, impulse_n_s }),
        flags,
    };
    Ok((report, PairReplay { case: case.name.clone(), motions }))
}

impl SimulatedPairs {
    /// Over cases; `None` without a pair.
    fn from_cases(cases: &[ReplayedCaseReport]) -> Option<Self> {
        let pairs: Vec<&SimulatedPair> =
            cases.iter().filter_map(|case| case.pair.as_ref()).collect();
        let contacts = || pairs.iter().map(|pair| pair.contact_s);
        let impulses = || pairs.iter().map(|pair| pair.impulse_n_s);
        Some(Self {
            striking: ErrorSummary::from_errors(pairs.iter().map(|pair| &pair.striking))?,
            contact_ratio: Compared::median_ratio(contacts()),
            impulse_ratio: Compared::median_ratio(impulses()),
            contact_error: Compared::median_error(contacts()),
            impulse_error: Compared::median_error(impulses()),
        })
    }
}
