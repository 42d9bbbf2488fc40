//! Checks of the quality of a case. They flag what looks wrong with it and what a user should know
//! before using it.
//!
//! The limits were set on the shipped data (400 cases), whose clean cases raise no warning. The
//! largest values of these cases are a momentum residual of 0.31 %, a force before contact of 3.4 %
//! of the peak, spikes of 0.24 of the peak, and time steps that differ by 0.4 % because times are
//! rounded.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{
    Case, Channel, DatasetKind, ForceAxes, ForceHistory, Loaded, Sampling, TimeSeries,
    contact_interval, cut_at_s, quality_jumps, quality_motion,
};
use crate::numerics::{SIGMA_PER_MAD, median};

/// Momentum residual above which a warning is raised, as a share of the impulse.
const MOMENTUM_RESIDUAL: f64 = 0.01;
/// Momentum residual above which the case has an error, as a share of the impulse: mass, force or
/// velocities are wrong.
const MOMENTUM_RESIDUAL_ERROR: f64 = 0.1;
/// Ratio of the longest time step to the median step above which samples are missing.
const SAMPLING_GAP: f64 = 5.0;
/// Largest relative deviation of a time step from the median step that counts as uniform.
const NON_UNIFORM: f64 = 0.01;
/// Excess of one sample over its neighbours above which it is a spike, as a share of the peak of
/// the other samples.
const SPIKE: f64 = 0.3;
/// Deviation of a sample from its neighbours above which it can be a spike, in robust standard
/// deviations.
const SPIKE_SIGMA: f64 = 20.0;
/// Smallest number of samples in contact with which spikes are looked for; with fewer, a spike
/// cannot be distinguished from a short pulse.
const SPIKE_MIN_SAMPLES: usize = 40;
/// The same of a sample whose neighbours differ by less than a share of the peak: one before or after the contact, as a
/// number that stands for none. Those of the shipped data are below 0.09.
const ISOLATED: f64 = 0.12;
const ISOLATED_RANGE: f64 = 0.01;
/// Rows from which a force stays at its largest value, and the least share of the peak that this is.
const HELD_ROWS: usize = 5;
const HELD_SHARE_OF_PEAK: f64 = 0.3;
/// Share of that value that the rows beside them have at least, and by how much it is less half as many rows farther.
const FLANK: f64 = 0.5;
const STEEP: f64 = 0.05;
/// Mean force before contact above which a warning is raised, as a share of the peak.
const DRIFT: f64 = 0.05;
/// Share of the peak above which the force has certainly begun.
const ONSET_SHARE_OF_PEAK: f64 = 0.1;
/// Smallest number of samples before contact over which a mean is computed.
const DRIFT_MIN_SAMPLES: usize = 5;
/// Force above which the unit is doubtful, N: cars in tests against a fixed barrier at 56 km/h have
/// peaks below 1 MN.
const IMPLAUSIBLE_FORCE_N: f64 = 2e6;
/// Peak force below which the unit is doubtful, N: bumpers of cars at walking speed touch with more.
/// A force in kN that is read in N is below it up to 1 MN.
const SMALL_FORCE_N: f64 = 1e3;
/// Impulses outside of which the units of force and time are doubtful, N s. They change the velocity
/// of a car of 1.5 t by 0.2 km/h and by 480 km/h.
const PLAUSIBLE_IMPULSE_N_S: [f64; 2] = [100.0, 2e5];
/// Force at the end of the record above which the vehicles have not separated, as a share of the
/// peak.
const NOT_SEPARATED: f64 = 0.01;
/// Duration of a contact above which the unit of time is doubtful, s: no impact takes so long,
/// times in ms were probably read as s.
const LONG_CONTACT_S: f64 = 2.0;

/// The property of a case that a flag concerns; it decides the unit of [`Flag::value`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlagKind {
    /// Difference between the impulse and the change of momentum, `|∫F dt − m ΔV| / |∫F dt|`; for
    /// trajectories, between the impulse and that in `cases.csv`.
    MomentumResidual,
    /// Longest time step as a ratio to the median step.
    SamplingGap,
    /// Largest relative deviation of a time step from the median step.
    NonUniformSampling,
    /// Excess of a single sample over its neighbours, as a share of the peak of the other samples.
    Spike,
    /// Mean force before contact, as a share of the peak.
    Drift,
    /// Peak force, N.
    ImplausibleForce,
    /// Peak force, N, which is far below that of a collision. The limit is the smallest one.
    SmallForce,
    /// Impulse, N s, which no collision of cars has. The limit is the smallest or the largest one.
    ImplausibleImpulse,
    /// Duration of the contact, s.
    LongContact,
    /// The force is zero throughout; the value is the peak, N.
    NoForce,
    /// The vehicles are still in contact at the end of the record. The value is the force at the
    /// end as a share of the peak, or 1 if only the table of cases states it.
    NotSeparated,
    /// The force at the first row, as a share of the peak: what came before it is not in the file.
    BegunBefore,
    /// Largest value of a component of the force, N, at which it stays over several rows between steep flanks: that of a
    /// transducer at its limit.
    Saturated,
    /// Distance from one row of a motion to the next, m, which no vehicle goes in the time.
    PathJump,
    /// Largest speed along a path, m/s, which is that of no collision.
    SlowPath,
    /// Mean speed along a path, m/s, which no vehicle has.
    FastPath,
    /// Turn of a vehicle from one row to the next, rad, which may as well be one to the other side.
    YawStep,
    /// Step of a recorded speed from one row to the next, m/s, which no vehicle makes.
    SpeedJump,
    /// Step of a yaw angle, rad, likewise.
    YawJump,
    /// Step of a yaw rate, rad/s, likewise.
    YawRateJump,
    /// Step of an angle of the road wheels or of the steering wheel, rad, likewise.
    SteerJump,
    /// A corner of the striking vehicle stays hooked to the struck vehicle, as the table of cases
    /// states.
    Hooked,
}

impl FlagKind {
    /// A label of one or two words for a table.
    pub fn label(self) -> &'static str {
        match self {
            Self::MomentumResidual => "momentum",
            Self::SamplingGap => "gap",
            Self::NonUniformSampling => "uneven",
            Self::Spike => "spike",
            Self::Drift => "drift",
            Self::ImplausibleForce => "force?",
            Self::SmallForce => "small",
            Self::ImplausibleImpulse => "impulse?",
            Self::LongContact => "long",
            Self::NoForce => "no force",
            Self::NotSeparated => "cut",
            Self::BegunBefore => "begun",
            Self::Saturated => "limit?",
            Self::PathJump => "jump",
            Self::SlowPath => "slow",
            Self::FastPath => "fast",
            Self::YawStep => "turn?",
            Self::SpeedJump => "speed?",
            Self::YawJump => "yaw?",
            Self::YawRateJump => "yaw rate?",
            Self::SteerJump => "steer?",
            Self::Hooked => "hooked",
        }
    }
}

/// How much a flag matters for the use of the case.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The user should know about it; the case can be used.
    Info,
    /// The user should look at it before using the case.
    Warning,
    /// The case should not be used before it is corrected.
    Error,
}

/// A finding about a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flag {
    /// The property that the flag concerns.
    pub kind: FlagKind,
    /// How much the finding matters.
    pub severity: Severity,
    /// The value that was found, in the unit that [`FlagKind`] states.
    pub value: f64,
    /// The largest value that is accepted, in the same unit.
    pub limit: f64,
    /// The time of the finding, s; `None` if it has no particular time.
    pub time_s: Option<f64>,
}

/// Checks a case of a data set, with the attributes from its table.
///
/// The momentum of a force case is compared with `m_t_kg` times the change of the velocity of the
/// struck vehicle in its file, in world axes. In a trajectory this change contains the impulse of
/// the tires too; its force is compared with `impulse_x_n_s` and `impulse_y_n_s` of `cases.csv`
/// instead, both in heading axes.
///
/// - returns the findings; none if the case is without fault.
pub fn check_case(case: &Case) -> Vec<Flag> {
    let mut flags = check_series(&case.series, case.kind.sampling());
    let attributes = &case.attributes;
    if let Ok(force) = case.force_history() {
        let expected = match case.kind {
            DatasetKind::Force => momentum_change_n_s(case),
            DatasetKind::Trajectory => {
                attributes.number("impulse_x_n_s").zip(attributes.number("impulse_y_n_s"))
            }
        };
        let axes = match case.kind {
            DatasetKind::Force => ForceAxes::World,
            DatasetKind::Trajectory => ForceAxes::Body,
        };
        let expected = expected.filter(|_| force.axes == axes);
        flags.extend(expected.and_then(|expected| momentum_residual(&force, expected)));
    }
    let separated = attributes.flag("separated").or(attributes.flag("fe_separated"));
    let is_flagged = flags.iter().any(|flag| flag.kind == FlagKind::NotSeparated);
    if separated == Some(false) && !is_flagged {
        flags.push(stated(FlagKind::NotSeparated, Severity::Warning));
    }
    if attributes.flag("hooked") == Some(true) {
        flags.push(stated(FlagKind::Hooked, Severity::Info));
    }
    flags
}

/// Checks a time series on its own: its time steps and, if it has one, its contact force.
///
/// - `sampling`: what a sample of the force stands for.
/// - returns the findings; none if the series is without fault.
pub fn check_series(series: &TimeSeries, sampling: Sampling) -> Vec<Flag> {
    let mut flags = check_sampling(series.time_s());
    if let Ok(force) = ForceHistory::from_series(series, sampling) {
        flags.extend(check_force(&force));
    }
    flags
}

/// Checks a single file, whose force may be in another unit than it was read in.
///
/// - returns the findings of [`check_series`], and whether peak and impulse are those of a collision
///   of cars, whether the file begins before the force does, whether a vehicle can go along its path,
///   whether its rows tell to which side it turns, and whether a column has numbers that stand for none.
pub fn check_file(loaded: &Loaded) -> Vec<Flag> {
    let sampling = loaded.force_sampling();
    let mut flags = check_series(&loaded.series, sampling);
    flags.extend(quality_motion::check_path(&loaded.series));
    flags.extend(quality_motion::check_yaw(&loaded.series));
    flags.extend(quality_jumps::check_jumps(&loaded.series));
    let force = ForceHistory::from_series(&loaded.series, sampling).ok();
    let peak = force.as_ref().and_then(ForceHistory::peak).filter(|(peak_n, _)| *peak_n > 0.0);
    let (Some(force), Some((peak_n, peak_at))) = (force, peak) else {
        return flags;
    };
    flags.extend(begun_before(&force, peak_n));
    flags.extend(saturated(&force, peak_n));
    let stated = |kind, value, limit| Flag { value, limit, ..stated(kind, Severity::Warning) };
    if peak_n < SMALL_FORCE_N {
        flags.push(stated(FlagKind::SmallForce, peak_n, SMALL_FORCE_N).at(peak_at));
    } else {
        let [x, y] = force.impulse_n_s();
        let (impulse, [low, high]) = (x.hypot(y), PLAUSIBLE_IMPULSE_N_S);
        if !(low..=high).contains(&impulse) {
            let limit = if impulse < low { low } else { high };
            flags.push(stated(FlagKind::ImplausibleImpulse, impulse, limit));
        }
    }
    flags
}

impl Flag {
    /// A flag if the value exceeds the limit.
    fn beyond(kind: FlagKind, severity: Severity, value: f64, limit: f64) -> Option<Self> {
        let flag = Self { kind, severity, value, limit, time_s: None };
        (value > limit).then_some(flag)
    }

    fn at(self, time_s: f64) -> Self {
        Self { time_s: Some(time_s), ..self }
    }
}

/// A flag for a property that holds or does not hold, without a limit.
fn stated(kind: FlagKind, severity: Severity) -> Flag {
    Flag { kind, severity, value: 1.0, limit: 0.0, time_s: None }
}

fn check_sampling(time_s: &[f64]) -> Vec<Flag> {
    let steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let Some(typical) = median(steps.iter().copied()) else {
        return Vec::new();
    };
    let longest = steps.iter().zip(time_s).max_by(|a, b| a.0.total_cmp(b.0));
    let deviations = steps.iter().map(|step| (step / typical - 1.0).abs());
    let deviation = deviations.fold(0.0, f64::max);
    let gap = longest.and_then(|(step, at)| {
        let (kind, severity) = (FlagKind::SamplingGap, Severity::Warning);
        Some(Flag::beyond(kind, severity, step / typical, SAMPLING_GAP)?.at(*at))
    });
    let (kind, severity) = (FlagKind::NonUniformSampling, Severity::Info);
    let non_uniform = Flag::beyond(kind, severity, deviation, NON_UNIFORM);
    gap.or(non_uniform).into_iter().collect()
}

fn check_force(force: &ForceHistory) -> Vec<Flag> {
    let Some((peak_n, peak_at)) = force.peak() else {
        return Vec::new();
    };
    let magnitude_n: Vec<f64> = magnitudes(force).collect();
    let Some((start, end)) = contact_interval(force) else {
        return vec![Flag { value: peak_n, ..stated(FlagKind::NoForce, Severity::Warning) }];
    };
    let warning = |kind, value, limit| Flag::beyond(kind, Severity::Warning, value, limit);
    let last_n = magnitude_n.last().copied().unwrap_or(0.0);
    let implausible = warning(FlagKind::ImplausibleForce, peak_n, IMPLAUSIBLE_FORCE_N);
    [
        implausible.map(|flag| flag.at(peak_at)),
        warning(FlagKind::LongContact, end - start, LONG_CONTACT_S),
        cut_at_s(force)
            .and_then(|_| warning(FlagKind::NotSeparated, last_n / peak_n, NOT_SEPARATED)),
        warning(FlagKind::Drift, drift(force, &magnitude_n, peak_n), DRIFT),
        spike(force, &magnitude_n),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn magnitudes(force: &ForceHistory) -> impl Iterator<Item = f64> + '_ {
    force.fx_n.iter().zip(&force.fy_n).map(|(x, y)| x.hypot(*y))
}

/// A force that is there at the first row; a sample that is a mean over its step may be.
fn begun_before(force: &ForceHistory, peak_n: f64) -> Option<Flag> {
    let first_n = magnitudes(force).next().filter(|_| force.sampling == Sampling::Instant)?;
    let (kind, severity) = (FlagKind::BegunBefore, Severity::Warning);
    Flag::beyond(kind, severity, first_n / peak_n, ONSET_SHARE_OF_PEAK)
}

/// A component of the force, of a considerable share of the peak, that stays at its largest value.
fn saturated(force: &ForceHistory, peak_n: f64) -> Option<Flag> {
    let axes = [&force.fx_n, &force.fy_n];
    let (row_idx, limit_n) = axes.into_iter().find_map(|axis| held_peak(axis, peak_n))?;
    let flag = Flag { value: limit_n, ..stated(FlagKind::Saturated, Severity::Warning) };
    Some(flag.at(force.time_s.get(row_idx).copied()?))
}

/// The row from which a component stays at its largest size, and this size, N. A pulse that is constant from its first
/// row to its last one does so too, and one whose numbers are coarse about its peak; neither has flanks that are cut off.
pub(super) fn held_peak(axis: &[f64], peak_n: f64) -> Option<(usize, f64)> {
    let limit_n = axis.iter().fold(0.0, |of: f64, value| of.max(value.abs()));
    let is_at_limit = |value: &&f64| value.abs() >= limit_n;
    let from = axis.iter().position(|value| is_at_limit(&value))?;
    let n_rows = axis.iter().skip(from).take_while(is_at_limit).count();
    if n_rows < HELD_ROWS || limit_n < HELD_SHARE_OF_PEAK * peak_n {
        return None;
    }
    let steps_n = axis.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let finest_n = steps_n.filter(|step_n| *step_n > 0.0).fold(f64::INFINITY, f64::min);
    let is_whole = |value: &f64| (value / finest_n - (value / finest_n).round()).abs() < 1e-3;
    // Between numbers that are so coarse, a peak that is round stays at its value and leaves it by one step.
    let rounding_n = if axis.iter().all(is_whole) { 3.0 * finest_n } else { 0.0 };
    let is_cut = |near: Option<usize>, far: usize| {
        let size_n = |idx: usize| axis.get(idx).map(|value| value.abs());
        let (Some(near_n), Some(far_n)) = (near.and_then(size_n), size_n(far)) else {
            return false;
        };
        (FLANK * limit_n..limit_n - rounding_n).contains(&near_n) && far_n < (1.0 - STEEP) * limit_n
    };
    let (before, after) = (from.checked_sub(1), from + n_rows);
    // As far as the record goes.
    let far_before = from.saturating_sub(1 + n_rows / 2);
    let far_after = (after + n_rows / 2).min(axis.len() - 1);
    let is_held = is_cut(before, far_before) && is_cut(Some(after), far_after);
    is_held.then_some((from, limit_n))
}

/// Mean force over the first half of the samples before the force has certainly begun, as a share
/// of the peak; 0 if there are too few of them.
fn drift(force: &ForceHistory, magnitude_n: &[f64], peak_n: f64) -> f64 {
    let has_begun = |n: &f64| *n > ONSET_SHARE_OF_PEAK * peak_n;
    let n_before = magnitude_n.iter().position(has_begun).unwrap_or(0) / 2;
    if n_before < DRIFT_MIN_SAMPLES {
        return 0.0;
    }
    let mean = |axis: &[f64]| axis.iter().take(n_before).sum::<f64>() / n_before as f64;
    mean(&force.fx_n).hypot(mean(&force.fy_n)) / peak_n
}

/// The sample that deviates most from its four neighbours, if it is a spike.
///
/// The deviation of a sample is that from the median of its neighbours. The sample is a spike if
/// its deviation is far larger than the robust standard deviation over the whole contact (from the
/// median absolute deviation), and larger than the range of its neighbours by a considerable share
/// of the peak. A steep but continuous curve satisfies the first condition only.
fn spike(force: &ForceHistory, magnitude_n: &[f64]) -> Option<Flag> {
    let mut ordered = magnitude_n.to_vec();
    ordered.sort_by(|a, b| b.total_cmp(a));
    let [largest, second, ..] = *ordered.as_slice() else {
        return None;
    };
    let is_contact = |i: usize| magnitude_n.get(i).is_some_and(|n| *n > 0.01 * second);
    let mut worst: Option<Flag> = None;
    for axis in [&force.fx_n, &force.fy_n] {
        let deviations: Vec<(f64, f64)> = axis.windows(5).map(deviation).collect();
        let in_contact = deviations.iter().enumerate().filter(|(i, _)| is_contact(i + 2));
        let in_contact: Vec<f64> = in_contact.map(|(_, (deviation, _))| *deviation).collect();
        if in_contact.len() < SPIKE_MIN_SAMPLES {
            continue;
        }
        let sigma = SIGMA_PER_MAD * median(in_contact).unwrap_or(0.0);
        for (i, (deviation, range)) in deviations.iter().enumerate() {
            let is_peak = magnitude_n.get(i + 2) == Some(&largest);
            let peak_of_others = if is_peak { second } else { largest };
            let excess = (deviation - range) / peak_of_others;
            let is_worse = worst.is_none_or(|flag| flag.value < excess);
            if *deviation > SPIKE_SIGMA * sigma && is_worse {
                let is_isolated = *range < ISOLATED_RANGE * peak_of_others;
                let limit = if is_isolated { ISOLATED } else { SPIKE };
                let flag = Flag::beyond(FlagKind::Spike, Severity::Warning, excess, limit);
                let at = force.time_s.get(i + 2).copied().unwrap_or(0.0);
                worst = flag.map(|flag| flag.at(at)).or(worst);
            }
        }
    }
    worst
}

/// For five samples: the distance of the middle one from the median of the other four, and the
/// range of these four.
fn deviation(samples: &[f64]) -> (f64, f64) {
    let &[a, b, middle, c, d] = samples else {
        return (0.0, 0.0);
    };
    let mut others = [a, b, c, d];
    others.sort_by(f64::total_cmp);
    let [low, second, third, high] = others;
    ((middle - (second + third) / 2.0).abs(), high - low)
}

/// The change of momentum `m ΔV` of the struck vehicle from the first to the last sample, N s,
/// world axes.
fn momentum_change_n_s(case: &Case) -> Option<(f64, f64)> {
    let mass_kg = case.attributes.number("m_t_kg")?;
    let change = |channel| {
        let velocity = case.series.get(channel)?;
        Some(mass_kg * (velocity.last()? - velocity.first()?))
    };
    change(Channel::StruckVx).zip(change(Channel::StruckVy))
}

fn momentum_residual(force: &ForceHistory, expected_n_s: (f64, f64)) -> Option<Flag> {
    let [x, y] = force.impulse_n_s();
    let impulse = x.hypot(y);
    if impulse == 0.0 {
        return None;
    }
    let residual = (x - expected_n_s.0).hypot(y - expected_n_s.1) / impulse;
    let severity = match residual > MOMENTUM_RESIDUAL_ERROR {
        true => Severity::Error,
        false => Severity::Warning,
    };
    Flag::beyond(FlagKind::MomentumResidual, severity, residual, MOMENTUM_RESIDUAL)
}
