//! Cases of a force data set in the form from which force models learn: canonical scenarios, and
//! forces on the common time grid.

use std::f64::consts::FRAC_PI_4;
use std::path::Path;

use crate::force::ForceScenario;
use crate::learning::{
    LoadError, TrainingCase, cases_and_problems, content_digest, load_cases, load_dataset, n_steps,
};
use impactlab_core::data::{
    Case, DataError, Dataset, DatasetKind, ForceAxes, ForceHistory, Outcome, SeriesError,
    contact_interval,
};
use impactlab_core::jobs::ProgressCallback;
use impactlab_core::uncertainty::{CURVE_INTERVAL_S, CURVE_N_INSTANTS, ForceCurve};

/// Step to which the numbers of a scenario are rounded before they are hashed, in their units. A file
/// that was written again with fewer digits keeps its hash.
const DIGEST_STEP: f64 = 1e-4;

/// Step to which forces are rounded before they are hashed, N. Peaks are some 50 kN.
const DIGEST_STEP_N: f64 = 1.0;

/// Smallest impulse of a collision as a share of the impulse of |F|. What is learned is relative to the
/// impulse.
const LEAST_NET_SHARE: f64 = 0.01;

/// Mean force in the last millisecond of a contact above which the record was cut, as a share of the
/// peak: a force that comes to zero has at most a few per cent there.
const CUT_SHARE_OF_PEAK: f64 = 0.1;

/// Largest angle of the contact normal from across the struck vehicle in a case that is learned from, rad.
const LARGEST_TURN_RAD: f64 = FRAC_PI_4;

/// A collision with its force curve, in the canonical form of [`ForceScenario::canonical`].
#[derive(Debug, Clone, PartialEq)]
pub struct ForceCase {
    /// Its name in the data set.
    pub name: String,
    /// The canonical scenario.
    pub scenario: ForceScenario,
    /// Whether the recorded case is the mirror image of this one.
    pub mirrored: bool,
    /// Force on the struck vehicle over the time from the start of the record, mirrored like the
    /// scenario. Its duration lasts from the first touch to the last separation.
    pub curve: ForceCurve,
    /// First touch, s from the start of the record.
    pub onset_s: f64,
    /// Impulse of the curve within the time grid, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest `|F|` of the curve, whose values are means over 1 ms, N.
    pub peak_n: f64,
    /// Time of the peak, s.
    pub peak_time_s: f64,
    /// Whether a corner of the striking vehicle stays hooked to the struck vehicle; `false` if the
    /// case does not state it.
    pub hooked: bool,
    /// Whether the vehicles are separated at the end; `true` if the case does not state it.
    pub separated: bool,
    /// SHA-256 of scenario and curve in hexadecimal digits. It does not depend on name, folder or side
    /// of the case.
    pub digest: String,
}

/// Why a case cannot be learned from.
#[derive(Debug, thiserror::Error)]
pub enum ForceCaseError {
    /// An attribute in the table of cases is missing or wrong.
    #[error(transparent)]
    Attributes(#[from] DataError),
    /// A column of its file is missing or wrong.
    #[error("case {case}")]
    Series {
        /// Name of the case.
        case: String,
        /// What is wrong with the file.
        source: SeriesError,
    },
    /// The force is given in axes that turn with the struck vehicle by an unknown angle.
    #[error("case {case}: the force is in body axes, expected world axes (fx_n, fy_n)")]
    BodyAxes {
        /// Name of the case.
        case: String,
    },
    /// The forces cancel out, which those of a collision do not: both vehicles are pushed apart.
    #[error(
        "case {case}: the forces cancel out, their impulse is {percent:.2} % of that of |F|; expected \
         a push in one direction, check the signs"
    )]
    NoNetImpulse {
        /// Name of the case.
        case: String,
        /// Impulse as a share of the impulse of the magnitude, %.
        percent: f64,
    },
    /// The blow is not against a flank, which is all that the network's physics knows.
    #[error(
        "case {case}: the contact normal is turned by {turn_deg:.0}° from across the struck vehicle; the \
         force network learns from blows against a flank"
    )]
    NotAFlank {
        /// Name of the case.
        case: String,
        /// Angle of the normal from across, degrees.
        turn_deg: f64,
    },
    /// There is no force within the time grid.
    #[error("case {case}: no force in the first {grid_s} s of the record")]
    NoForce {
        /// Name of the case.
        case: String,
        /// Length of the time grid, s.
        grid_s: f64,
    },
}

impl ForceCase {
    /// The canonical form of a case of a force data set.
    ///
    /// The contact lasts from `t_start_s` to `t_end_s` if the table has these columns. Otherwise
    /// [`contact_interval`] gives it: from the first to the last instant above 1 % of the peak.
    ///
    /// # Errors
    /// [`ForceCaseError`].
    pub fn from_case(case: &Case) -> Result<Self, ForceCaseError> {
        let name = || case.name.clone();
        let scenario = ForceScenario::from_case(case)?;
        let history = case
            .force_history()
            .map_err(|source| ForceCaseError::Series { case: name(), source })?;
        if history.axes != ForceAxes::World {
            return Err(ForceCaseError::BodyAxes { case: name() });
        }
        let number = |column| case.attributes.number(column);
        let interval = number("t_start_s").zip(number("t_end_s"));
        let interval = interval.or_else(|| contact_interval(&history));
        let start_s = record_start_s(&history);
        let (curve, onset_s) = match interval.zip(curve_on_grid(&history, start_s)) {
            Some(((from, to), curve)) => {
                (ForceCurve { duration_s: to - from, ..curve }, from - start_s)
            }
            None => {
                let grid_s = CURVE_N_INSTANTS as f64 * CURVE_INTERVAL_S;
                return Err(ForceCaseError::NoForce { case: name(), grid_s });
            }
        };
        let total_n_s: f64 = curve.magnitude_n().iter().sum::<f64>() * CURVE_INTERVAL_S;
        let [px, py] = curve.impulse_n_s();
        let net_share = px.hypot(py) / total_n_s;
        if net_share < LEAST_NET_SHARE {
            return Err(ForceCaseError::NoNetImpulse { case: name(), percent: 100.0 * net_share });
        }
        let (scenario, mirrored) = scenario.canonical();
        let turn_rad = scenario.normal_turn_rad();
        if turn_rad.abs() > LARGEST_TURN_RAD {
            return Err(ForceCaseError::NotAFlank {
                case: name(),
                turn_deg: turn_rad.to_degrees(),
            });
        }
        let curve = if mirrored { curve.mirrored() } else { curve };
        let (peak_n, peak_time_s) = curve.peak();
        Ok(Self {
            name: name(),
            digest: digest(&scenario, &curve),
            scenario,
            mirrored,
            onset_s,
            impulse_n_s: curve.impulse_n_s(),
            peak_n,
            peak_time_s,
            hooked: case.attributes.flag("hooked").unwrap_or(false),
            separated: case.attributes.flag("separated").unwrap_or(true),
            curve,
        })
    }

    /// The cases of a force data set that can be learned from, and the problems of the others.
    pub fn from_dataset(dataset: &Dataset) -> (Vec<Self>, Vec<ForceCaseError>) {
        cases_and_problems(dataset, Self::from_case)
    }

    /// All cases of a folder with a force data set.
    ///
    /// # Errors
    /// [`LoadError`] with the first thing that is wrong.
    pub fn load_all(
        root: &Path,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<Vec<Self>>, LoadError> {
        Ok(match load_dataset(root, DatasetKind::Force, report)? {
            Outcome::Complete(dataset) => Outcome::Complete(load_cases(&dataset, Self::from_case)?),
            Outcome::Cancelled => Outcome::Cancelled,
        })
    }

    /// Whether the vehicles part for good: they do not hook and are separated at the end.
    pub fn is_clean(&self) -> bool {
        self.separated && !self.hooked
    }

    /// Time of the end of a record that ends during the contact, s from its start; `None` if the
    /// vehicles have separated.
    pub fn cut_at_s(&self) -> Option<f64> {
        let end_s = self.onset_s + self.curve.duration_s;
        // The cell in which the contact ends is filled in part.
        let last = (end_s / CURVE_INTERVAL_S).floor() as usize;
        let cells = [last.saturating_sub(1), last];
        let force_n = |i: usize| Some(self.curve.fx_n.get(i)?.hypot(*self.curve.fy_n.get(i)?));
        let last_n = cells.into_iter().filter_map(force_n).fold(0.0, f64::max);
        let ends_early = !self.separated || last_n > CUT_SHARE_OF_PEAK * self.peak_n;
        ends_early.then_some(end_s)
    }

    /// A canonical curve in the axes of the recorded case.
    pub fn as_recorded(&self, curve: &ForceCurve) -> ForceCurve {
        if self.mirrored { curve.mirrored() } else { curve.clone() }
    }
}

/// Means of a force history over the cells of the time grid that starts at `start_s`, zero outside the
/// record. The duration is not set. `None` if all forces on the grid are zero.
pub fn curve_on_grid(history: &ForceHistory, start_s: f64) -> Option<ForceCurve> {
    let cumulative = history.cumulative();
    let mut curve = ForceCurve::default();
    for i in 0..CURVE_N_INSTANTS {
        let edge = |i: usize| start_s + i as f64 * CURVE_INTERVAL_S;
        let ([fx, fy], _) = cumulative.mean_over(edge(i), edge(i + 1));
        curve.fx_n.push(fx);
        curve.fy_n.push(fy);
    }
    (curve.peak().0 > 0.0).then_some(curve)
}

/// Start of the first interval of a record, s.
fn record_start_s(history: &ForceHistory) -> f64 {
    history.cumulative().knots_s.first().copied().unwrap_or(0.0)
}

fn digest(scenario: &ForceScenario, curve: &ForceCurve) -> String {
    let [vx, vy] = scenario.relative_velocity_m_s();
    let [m_t, m_b] = scenario.mass_kg;
    let known = [m_t, m_b, vx, vy, scenario.theta_b_rad].map(|value| n_steps(value, DIGEST_STEP));
    let forces = curve.fx_n.iter().chain(&curve.fy_n).map(|force| n_steps(*force, DIGEST_STEP_N));
    let duration = n_steps(curve.duration_s, DIGEST_STEP);
    // Of cars that do not turn it is what it was before yaw rates were told.
    let turning = scenario.yaw_rate_rad_s.map(|rate| n_steps(rate, DIGEST_STEP));
    let turning = turning.into_iter().filter(|_| scenario.yaw_rate_rad_s != [0.0; 2]);
    content_digest(known.into_iter().chain(forces).chain([duration]).chain(turning))
}

impl TrainingCase for ForceCase {
    fn name(&self) -> &str {
        &self.name
    }

    fn digest(&self) -> &str {
        &self.digest
    }

    fn is_ordinary(&self) -> bool {
        self.is_clean()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::learning::{TEST_SHARE, split};
    use impactlab_core::collision::ImpulseFeatures;
    use impactlab_core::data::{Channel, TimeSeries};

    /// The cases of a shipped data set.
    pub(crate) fn shipped(name: &str) -> Vec<ForceCase> {
        let root =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("datasets").join(name);
        let mut report = |_| ControlFlow::Continue(());
        let dataset = Dataset::load(&root, &mut report).unwrap().complete().unwrap();
        let (cases, problems) = ForceCase::from_dataset(&dataset);
        assert!(problems.is_empty(), "{problems:?}");
        cases
    }

    #[test]
    fn the_shipped_cases_keep_their_impulse_peak_and_duration() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("datasets/fea");
        let mut report = |_| ControlFlow::Continue(());
        let dataset = Dataset::load(&root, &mut report).unwrap().complete().unwrap();
        assert_eq!(dataset.cases.len(), 100);
        let mut off_s = Vec::new();
        for recorded in &dataset.cases {
            let case = ForceCase::from_case(recorded).unwrap();
            let number = |name| recorded.attributes.number(name).unwrap();
            let sign = if case.mirrored { -1.0 } else { 1.0 };
            // What comes after 0.25 s is not in the curve.
            if number("t_end_s") < 0.25 {
                let [px, py] = case.impulse_n_s;
                let off = (px - number("impulse_x_n_s")).hypot(sign * py - number("impulse_y_n_s"));
                let total = px.hypot(py);
                assert!(off < 2e-3 * total, "{}: {off} of {total} N s", case.name);
            }
            // The table has the peak of 0.5 ms means.
            let ratio = case.peak_n / number("peak_force_n");
            assert!((0.85..1.001).contains(&ratio), "{}: peak {ratio}", case.name);
            let from_force = contact_interval(&recorded.force_history().unwrap()).unwrap();
            off_s.push((from_force.1 - from_force.0 - case.curve.duration_s).abs());
            assert!(case.scenario.theta_b_rad > 0.0 && case.impulse_n_s[1] > 0.0, "{}", case.name);
        }
        // Where the table gave no times: weak contact at the end is cut.
        let off_s = impactlab_core::numerics::Summary::from_values(off_s).unwrap();
        assert!(off_s.median < 5e-3 && off_s.p90 < 0.025, "{off_s:?}");
    }

    #[test]
    fn a_record_that_ends_in_contact_is_cut_and_a_clean_one_is_not() {
        for case in &shipped("fea") {
            let cut_at_s = case.cut_at_s();
            if !case.separated {
                assert!(cut_at_s.is_some_and(|at_s| at_s > case.peak_time_s), "{}", case.name);
            } else if case.is_clean() {
                assert_eq!(cut_at_s, None, "{}", case.name);
            }
        }
    }

    /// What is learned is relative to the impulse, which was zero.
    #[test]
    fn forces_that_cancel_out_are_refused() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("datasets/fea");
        let mut report = |_| ControlFlow::Continue(());
        let dataset = Dataset::load(&root, &mut report).unwrap().complete().unwrap();
        let mut case = dataset.case("c001").unwrap().clone();
        let mut series = TimeSeries::new(case.series.time_s().to_vec()).unwrap();
        let n = series.n_samples();
        let alternating = |i: usize| if i.is_multiple_of(2) { 1e3 } else { -1e3 };
        series.insert(Channel::Fx, vec![0.0; n]).unwrap();
        series.insert(Channel::Fy, (0..n).map(|i| alternating(i / 20)).collect()).unwrap();
        case.series = series;
        let error = ForceCase::from_case(&case).unwrap_err().to_string();
        assert!(error.starts_with("case c001: the forces cancel out"), "{error}");
    }

    #[test]
    fn the_shipped_cases_split_as_in_the_first_trials() {
        let cases = shipped("fea");
        let split = split(&cases, 0, TEST_SHARE);
        let count = |is_counted: &dyn Fn(&ForceCase) -> bool| {
            split.test.iter().filter(|idx| is_counted(&cases[**idx])).count()
        };
        assert_eq!((split.train.len(), split.test.len()), (75, 25));
        assert_eq!(count(&ForceCase::is_clean), 22);
        assert_eq!((count(&|case| case.hooked), count(&|case| !case.separated)), (3, 3));
        // By an independent script that hashes "0:c001" and so on.
        let first: Vec<&str> =
            split.test.iter().take(3).map(|idx| cases[*idx].name.as_str()).collect();
        assert_eq!(first, ["c002", "c006", "c008"]);
    }

    #[test]
    fn a_case_is_recognised_mirrored_and_renamed() {
        let cases = shipped("fea");
        let case = &cases[0];
        let (mirrored, _) = case.scenario.mirrored().canonical();
        let again = digest(&mirrored, &case.curve.mirrored().mirrored());
        assert_eq!(again, case.digest);
        let mut other = case.curve.clone();
        other.fy_n[20] += 5.0;
        assert_ne!(digest(&case.scenario, &other), case.digest);
        let digests: std::collections::BTreeSet<_> = cases.iter().map(|c| &c.digest).collect();
        assert_eq!(digests.len(), cases.len(), "two cases with one digest");
        assert_eq!(case.digest.len(), 64);
    }

    #[test]
    fn curves_turn_back_to_the_recorded_axes_and_keep_their_peak() {
        for case in &shipped("fea") {
            let recorded = case.as_recorded(&case.curve);
            let features = ImpulseFeatures::from_history(&case.curve.to_history()).unwrap();
            assert!((features.peak_n - case.peak_n).abs() < 1e-9, "{}", case.name);
            assert_eq!(
                recorded.fy_n[30],
                case.curve.fy_n[30] * if case.mirrored { -1.0 } else { 1.0 }
            );
        }
    }
}
