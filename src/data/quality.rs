//! What looks wrong with a case, or should be known before it is used.
//!
//! The limits were set on the shipped data (400 cases): clean cases raise no warning. What they
//! show at most: momentum residual 0.31 %, force before contact 3.4 % of the peak, spikes 0.24 of
//! the peak, steps that differ by 0.4 % (rounded times).

use std::fmt;

use crate::data::{
    Case, Channel, DatasetKind, ForceAxes, ForceHistory, Sampling, TimeSeries, contact_interval,
};

/// Momentum residual that raises a warning, as a share of the impulse.
const MOMENTUM_RESIDUAL: f64 = 0.01;
/// Momentum residual that is an error: mass, force or velocities are wrong.
const MOMENTUM_RESIDUAL_ERROR: f64 = 0.1;
/// Longest step over the median step.
const SAMPLING_GAP: f64 = 5.0;
/// Largest deviation of a step from the median step, as a share of it.
const NON_UNIFORM: f64 = 0.01;
/// Excess of one sample over its neighbours, as a share of the peak of the others.
const SPIKE: f64 = 0.3;
/// The same excess over its robust standard deviation.
const SPIKE_SIGMA: f64 = 20.0;
/// Contact samples below which a spike cannot be told from a short pulse.
const SPIKE_MIN_SAMPLES: usize = 40;
/// Mean force before contact as a share of the peak.
const DRIFT: f64 = 0.05;
/// Share of the peak at which the force has surely begun.
const ONSET_SHARE_OF_PEAK: f64 = 0.1;
/// Samples before contact that a mean needs.
const DRIFT_MIN_SAMPLES: usize = 5;
/// Force that no car reaches, N: fixed-barrier tests at 56 km/h peak below 1 MN.
const IMPLAUSIBLE_FORCE_N: f64 = 2e6;
/// Force at the end as a share of the peak.
const NOT_SEPARATED: f64 = 0.01;
/// Contact that no impact takes, s: times in ms were read as s.
const LONG_CONTACT_S: f64 = 2.0;
/// Standard deviation of a normal variable over its median absolute deviation.
const SIGMA_PER_MAD: f64 = 1.4826;

/// What a flag is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlagKind {
    /// `|∫F dt − m ΔV| / |∫F dt|`; for trajectories, against the impulse in `cases.csv`.
    MomentumResidual,
    /// Longest step over the median step.
    SamplingGap,
    /// Largest deviation of a step from the median step, as a share of it.
    NonUniformSampling,
    /// A single sample that stands out from its neighbours, as a share of the others' peak.
    Spike,
    /// Mean force before contact, as a share of the peak.
    Drift,
    /// Peak force, N.
    ImplausibleForce,
    /// Duration of the contact, s.
    LongContact,
    /// There is no force at all; the value is the peak, N.
    NoForce,
    /// Still in contact at the end: force there as a share of the peak, by the curve or by the
    /// table of cases.
    NotSeparated,
    /// The bullet's corner stays caught, by the table of cases.
    Hooked,
}

impl FlagKind {
    /// In a word or two, for a table.
    pub fn label(self) -> &'static str {
        match self {
            Self::MomentumResidual => "momentum",
            Self::SamplingGap => "gap",
            Self::NonUniformSampling => "uneven",
            Self::Spike => "spike",
            Self::Drift => "drift",
            Self::ImplausibleForce => "force?",
            Self::LongContact => "long",
            Self::NoForce => "no force",
            Self::NotSeparated => "cut",
            Self::Hooked => "hooked",
        }
    }
}

/// How much a flag matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Good to know.
    Info,
    /// Look at it before using the case.
    Warning,
    /// Do not use the case before it is mended.
    Error,
}

/// Something found in a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flag {
    /// What it is about.
    pub kind: FlagKind,
    /// How much it matters.
    pub severity: Severity,
    /// What was found, in the unit that [`FlagKind`] names.
    pub value: f64,
    /// What is accepted.
    pub limit: f64,
    /// When, s, if it happens at a time.
    pub time_s: Option<f64>,
}

/// Checks a case of a data set.
///
/// Momentum: a force case is checked against `m_t_kg` and the target's velocities in its file, in
/// world axes. For a trajectory that would count the tires' impulse too, so its force is checked
/// against `impulse_x_n_s`, `impulse_y_n_s` of `cases.csv`, in the heading axes of both.
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

/// Checks a file on its own.
pub fn check_series(series: &TimeSeries, sampling: Sampling) -> Vec<Flag> {
    let mut flags = check_sampling(series.time_s());
    if let Ok(force) = ForceHistory::from_series(series, sampling) {
        flags.extend(check_force(&force));
    }
    flags
}

impl Flag {
    /// A flag if the value is beyond the limit.
    fn beyond(kind: FlagKind, severity: Severity, value: f64, limit: f64) -> Option<Self> {
        let flag = Self { kind, severity, value, limit, time_s: None };
        (value > limit).then_some(flag)
    }

    fn at(self, time_s: f64) -> Self {
        Self { time_s: Some(time_s), ..self }
    }
}

/// A flag that the table of cases raises.
fn stated(kind: FlagKind, severity: Severity) -> Flag {
    Flag { kind, severity, value: 1.0, limit: 0.0, time_s: None }
}

impl fmt::Display for Flag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (value, limit) = (self.value, self.limit);
        let (percent, limit_percent) = (100.0 * value, 100.0 * limit);
        match self.kind {
            FlagKind::MomentumResidual => write!(
                f,
                "impulse and momentum differ by {percent:.2} %, limit {limit_percent} %; \
                 check mass, force unit and axes"
            ),
            FlagKind::SamplingGap => write!(
                f,
                "a step {value:.1} times the median step, limit {limit}; samples are missing"
            ),
            FlagKind::NonUniformSampling => {
                write!(f, "steps differ by {percent:.1} %, limit {limit_percent} %")
            }
            FlagKind::Spike => write!(
                f,
                "one sample stands out by {percent:.0} % of the peak, limit {limit_percent} %"
            ),
            FlagKind::Drift => write!(
                f,
                "force before contact is {percent:.1} % of the peak, limit {limit_percent} %; \
                 remove the offset"
            ),
            FlagKind::ImplausibleForce => write!(
                f,
                "peak force {:.2} MN, limit {} MN; check the unit",
                value / 1e6,
                limit / 1e6
            ),
            FlagKind::LongContact => {
                write!(f, "contact takes {value:.1} s, limit {limit} s; check the unit of time")
            }
            FlagKind::NoForce => write!(f, "the force is zero throughout"),
            FlagKind::NotSeparated => {
                write!(f, "still in contact at the end: the impulse is not complete")
            }
            FlagKind::Hooked => write!(f, "the bullet's corner stays caught"),
        }?;
        match self.time_s {
            Some(time_s) => write!(f, " (at {time_s:.4} s)"),
            None => Ok(()),
        }
    }
}

fn check_sampling(time_s: &[f64]) -> Vec<Flag> {
    let steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let Some(typical) = median(steps.clone()) else {
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
        warning(FlagKind::NotSeparated, last_n / peak_n, NOT_SEPARATED),
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

/// Mean force over the first half of the samples before the force has surely begun, as a share of
/// the peak; 0 where there are too few of them.
fn drift(force: &ForceHistory, magnitude_n: &[f64], peak_n: f64) -> f64 {
    let has_begun = |n: &f64| *n > ONSET_SHARE_OF_PEAK * peak_n;
    let n_before = magnitude_n.iter().position(has_begun).unwrap_or(0) / 2;
    if n_before < DRIFT_MIN_SAMPLES {
        return 0.0;
    }
    let mean = |axis: &[f64]| axis.iter().take(n_before).sum::<f64>() / n_before as f64;
    mean(&force.fx_n).hypot(mean(&force.fy_n)) / peak_n
}

/// The worst single sample that stands out from its four neighbours.
///
/// A sample's deviation is that from the median of its neighbours. It is a spike if this is far
/// beyond the deviations of the whole contact (median absolute deviation), and beyond the range of
/// the neighbours by a good part of the peak: steep but continuous curves do the first, not both.
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
                let flag = Flag::beyond(FlagKind::Spike, Severity::Warning, excess, SPIKE);
                let at = force.time_s.get(i + 2).copied().unwrap_or(0.0);
                worst = flag.map(|flag| flag.at(at)).or(worst);
            }
        }
    }
    worst
}

/// Of five samples: how far the middle one is from the median of the others, and their range.
fn deviation(samples: &[f64]) -> (f64, f64) {
    let &[a, b, middle, c, d] = samples else {
        return (0.0, 0.0);
    };
    let mut others = [a, b, c, d];
    others.sort_by(f64::total_cmp);
    let [low, second, third, high] = others;
    ((middle - (second + third) / 2.0).abs(), high - low)
}

/// `m ΔV` of the target over the file, N s, in world axes.
fn momentum_change_n_s(case: &Case) -> Option<(f64, f64)> {
    let mass_kg = case.attributes.number("m_t_kg")?;
    let change = |channel| {
        let velocity = case.series.get(channel)?;
        Some(mass_kg * (velocity.last()? - velocity.first()?))
    };
    change(Channel::TargetVx).zip(change(Channel::TargetVy))
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

fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    values.sort_by(f64::total_cmp);
    values.get(middle).copied()
}
