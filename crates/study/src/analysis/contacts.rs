//! When and how two vehicles are in contact, over draws of their motions and in a single one.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::FEWEST_DRAWS;
use impactlab_core::collision::contact::{ContactPhase, PhaseOfVehicle};
use impactlab_core::numerics::unwrapped_rad;
use impactlab_core::units::Estimate;
use impactlab_networks::pair::{PairDraw, PairForecast};

/// Phases beyond which none is listed.
const MOST_PHASES: usize = 4;

/// Share of the draws below which a phase is not listed.
const LEAST_SHARE: f64 = 0.05;

/// Share of the impulse of the largest phase below which a graze is not told.
const LEAST_IMPULSE_SHARE: f64 = 0.01;

/// Interval of the instants at which the probability of contact is told, s.
const INSTANT_S: f64 = 0.1;

/// When and how two vehicles are in contact over draws of their motions, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ContactsOutcome {
    /// Draws that were followed.
    pub n_draws: usize,
    /// Draws that could not be followed.
    pub n_failed: usize,
    /// Draws whose first contact is that of a known force; that of the others is the contact law's.
    pub n_known_forces: usize,
    /// Probability that the vehicles part and meet again. A phase with less than 1 % of the impulse of the
    /// largest one is a graze and does not count.
    pub meet_again_probability: f64,
    /// Probability that they are in contact for more than 0.3 s.
    pub long_contact_probability: f64,
    /// Time for which they are in contact, s.
    pub duration_s: Estimate,
    /// Size of the impulse of all contacts, N s.
    pub impulse_n_s: Estimate,
    /// Share of the impulse that comes after the known force of the first contact; none where no draw has
    /// one.
    pub later_impulse_share: Option<Estimate>,
    /// Scale of the loads of the contact law at the end of that force; likewise.
    pub law_scale: Option<Estimate>,
    /// Share of the known forces whose scale was outside of its bounds.
    pub clamped_share: f64,
    /// Phases of contact in the order of time.
    pub phases: Vec<PhaseForecast>,
    /// Probability that the vehicles are in contact, over time.
    pub in_contact: Vec<InContact>,
}

/// Probability of contact at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct InContact {
    /// Time from the first contact, s.
    pub time_s: f64,
    /// Share of the draws in contact.
    pub probability: f64,
}

/// A phase of contact over the draws in which it occurs; over few of them the medians alone.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PhaseForecast {
    /// Share of the draws in which it occurs.
    pub probability: f64,
    /// When it begins, s.
    pub start_s: Estimate,
    /// How long it lasts, to the end of the motion at the most, s.
    pub duration_s: Estimate,
    /// Size of its impulse, N s.
    pub impulse_n_s: Estimate,
    /// Largest force, N.
    pub peak_force_n: Estimate,
    /// The struck vehicle.
    pub struck: PhaseOfVehicleForecast,
    /// The striking vehicle.
    pub striking: PhaseOfVehicleForecast,
}

/// What a phase does to a vehicle, over the draws.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PhaseOfVehicleForecast {
    /// Δv by the contact force, as an event data recorder integrates it, m/s.
    pub delta_v_m_s: Estimate,
    /// Principal direction of force, rad clockwise from the heading; none without an impulse.
    pub pdof_rad: Option<Estimate>,
}

/// A phase of contact of a single motion, SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct ContactPhaseReport {
    /// When it begins, s.
    pub start_s: f64,
    /// When it ends, s; none if the vehicles still are in contact at the end.
    pub end_s: Option<f64>,
    /// Impulse `[P_X, P_Y]` on the struck vehicle, world axes, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest force, N.
    pub peak_force_n: f64,
    /// The struck vehicle.
    pub struck: PhaseOfVehicleReport,
    /// The striking vehicle.
    pub striking: PhaseOfVehicleReport,
}

/// What a phase does to a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PhaseOfVehicleReport {
    /// Δv by the contact force, as an event data recorder integrates it, m/s.
    pub delta_v_m_s: f64,
    /// Principal direction of force, rad clockwise from the heading; none without an impulse.
    pub pdof_rad: Option<f64>,
}

impl From<&ContactPhase> for ContactPhaseReport {
    fn from(phase: &ContactPhase) -> Self {
        let of_vehicle = |i: usize| {
            let it: &PhaseOfVehicle = &phase.vehicles[i];
            PhaseOfVehicleReport { delta_v_m_s: it.delta_v_m_s, pdof_rad: pdof_rad(it) }
        };
        Self {
            start_s: phase.start_s,
            end_s: phase.end_s,
            impulse_n_s: phase.impulse_world_n_s,
            peak_force_n: phase.peak_force_n,
            struck: of_vehicle(0),
            striking: of_vehicle(1),
        }
    }
}

/// Phases of contact without grazes.
pub(crate) fn told(phases: &[ContactPhase]) -> Vec<&ContactPhase> {
    let size_n_s = |phase: &ContactPhase| {
        let [x, y] = phase.impulse_world_n_s;
        x.hypot(y)
    };
    let largest_n_s = phases.iter().map(size_n_s).fold(0.0, f64::max);
    phases.iter().filter(|phase| size_n_s(phase) >= LEAST_IMPULSE_SHARE * largest_n_s).collect()
}

/// Principal direction of the force on a vehicle, rad.
fn pdof_rad(it: &PhaseOfVehicle) -> Option<f64> {
    it.principal_direction.map(|direction| direction.angle_deg().to_radians())
}

impl ContactsOutcome {
    /// Over the draws of a forecast.
    ///
    /// - `end_s`: where a contact that has not ended is cut off.
    pub(super) fn new(found: &PairForecast, end_s: f64) -> Self {
        let draws = &found.draws;
        let spread = |value: &dyn Fn(&PairDraw) -> f64| {
            Estimate::from_draws(draws.iter().map(value).collect())
        };
        let hand_overs: Vec<_> =
            draws.iter().filter_map(|draw| Some((draw, draw.hand_over?))).collect();
        let later = |(draw, first): &(&PairDraw, _)| later_share(draw, first);
        let n_clamped = hand_overs.iter().filter(|(_, it)| it.is_clamped).count();
        let last_s = draws.iter().map(|draw| draw.end_s()).fold(0.0, f64::max).min(end_s);
        let n_instants = (last_s / INSTANT_S + 1e-9).floor() as usize;
        let in_contact = |instant: usize| {
            let time_s = instant as f64 * INSTANT_S;
            let probability = found.share(|draw| draw.is_in_contact(time_s));
            InContact { time_s, probability }
        };
        let n_told = |draw: &PairDraw| told(&draw.phases).len();
        let n_most = draws.iter().map(n_told).max().unwrap_or(0);
        let phases = (0..n_most.min(MOST_PHASES)).filter_map(|n| PhaseForecast::new(found, n));
        Self {
            n_draws: draws.len(),
            n_failed: found.failed.as_ref().map_or(0, |(n, _)| *n),
            n_known_forces: hand_overs.len(),
            meet_again_probability: found.share(|draw| n_told(draw) > 1),
            long_contact_probability: found.share(|draw| draw.contact_s(draw.end_s()) > 0.3),
            duration_s: spread(&|draw| draw.contact_s(draw.end_s())),
            impulse_n_s: spread(&PairDraw::impulse_n_s),
            later_impulse_share: of_some(hand_overs.iter().map(later).collect()),
            law_scale: of_some(hand_overs.iter().map(|(_, it)| it.scale).collect()),
            clamped_share: n_clamped as f64 / hand_overs.len().max(1) as f64,
            phases: phases.take_while(|phase| phase.probability >= LEAST_SHARE).collect(),
            in_contact: (0..=n_instants).map(in_contact).collect(),
        }
    }
}

/// What some of the draws say; none of none, and the median alone of few.
fn of_some(values: Vec<f64>) -> Option<Estimate> {
    let n = values.len();
    (n > 0).then(|| without_few(Estimate::from_draws(values), n))
}

/// What a number of draws says; of few the median alone, since their intervals would be too narrow.
fn without_few(estimate: Estimate, n_draws: usize) -> Estimate {
    if n_draws < FEWEST_DRAWS { estimate.without_intervals() } else { estimate }
}

/// Share of the impulse of a draw that comes after its known force.
fn later_share(draw: &PairDraw, first: &impactlab_core::collision::contact::HandOver) -> f64 {
    let total = |axis: usize| -> f64 {
        draw.phases.iter().map(|phase| phase.impulse_world_n_s[axis]).sum()
    };
    let [x, y] = first.impulse_world_n_s;
    let (known, later) = (x.hypot(y), (total(0) - x).hypot(total(1) - y));
    if known + later > 0.0 { later / (known + later) } else { 0.0 }
}

impl PhaseForecast {
    /// The phase with a number over the draws in which it occurs; `None` if it occurs in none.
    fn new(found: &PairForecast, number: usize) -> Option<Self> {
        let phases: Vec<(&ContactPhase, f64)> = found
            .draws
            .iter()
            .filter_map(|draw| Some((told(&draw.phases).get(number).copied()?, draw.end_s())))
            .collect();
        Self::over(&phases, found.draws.len())
    }

    /// - `phases`: of the draws in which it occurs, each with the end of its motion, s.
    fn over(phases: &[(&ContactPhase, f64)], n_draws: usize) -> Option<Self> {
        let spread = |value: &dyn Fn(&(&ContactPhase, f64)) -> f64| {
            of_some(phases.iter().map(value).collect())
        };
        let of_vehicle = |i: usize| -> Option<PhaseOfVehicleForecast> {
            let directions: Vec<f64> =
                phases.iter().filter_map(|(phase, _)| pdof_rad(&phase.vehicles[i])).collect();
            Some(PhaseOfVehicleForecast {
                delta_v_m_s: spread(&|(phase, _)| phase.vehicles[i].delta_v_m_s)?,
                pdof_rad: direction(&directions).map(|it| without_few(it, directions.len())),
            })
        };
        Some(Self {
            probability: phases.len() as f64 / n_draws as f64,
            start_s: spread(&|(phase, _)| phase.start_s)?,
            duration_s: spread(&|(phase, end_s)| phase.end_s.unwrap_or(*end_s) - phase.start_s)?,
            impulse_n_s: spread(&|(phase, _)| {
                let [x, y] = phase.impulse_world_n_s;
                x.hypot(y)
            })?,
            peak_force_n: spread(&|(phase, _)| phase.peak_force_n)?,
            struck: of_vehicle(0)?,
            striking: of_vehicle(1)?,
        })
    }
}

/// The spread of directions about their mean direction, rad; `None` without any. Its median lies within
/// −π and π.
fn direction(angles_rad: &[f64]) -> Option<Estimate> {
    let drawn = || Estimate::from_draws(unwrapped_rad(angles_rad));
    let estimate = (!angles_rad.is_empty()).then(drawn)?;
    let turns = ((estimate.median + PI) / (2.0 * PI)).floor() * 2.0 * PI;
    Some(estimate.mapped(|angle| angle - turns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::PrincipalDirectionOfForce;

    /// “0.07077 (0.07077 to 0.07077)” was the share of one draw of 40.
    #[test]
    fn of_few_draws_the_median_alone_is_told() {
        assert_eq!(of_some(Vec::new()), None);
        let one = of_some(vec![0.07]).unwrap();
        assert!(one.median == 0.07 && one.intervals.is_empty(), "{one:?}");
        assert_eq!(of_some(vec![0.5; FEWEST_DRAWS]).unwrap().intervals.len(), 2);
    }

    /// A third contact in 3 of 60 draws had intervals of three numbers, the 90 % narrower than the draws lay apart.
    #[test]
    fn a_phase_of_few_draws_is_told_by_its_medians_alone() {
        let principal_direction = Some(PrincipalDirectionOfForce::from_angle(1.0));
        let of_vehicle = PhaseOfVehicle {
            impulse_body_n_s: [3.0, 4.0],
            yaw_impulse_n_m_s: 0.0,
            delta_v_m_s: 2.0,
            principal_direction,
        };
        let phase = ContactPhase {
            start_s: 0.5,
            end_s: None,
            impulse_world_n_s: [3.0, 4.0],
            peak_force_n: 9.0,
            vehicles: [of_vehicle; 2],
        };
        let found = |n: usize| PhaseForecast::over(&vec![(&phase, 2.0); n], 60);
        let [few, many] = [3, FEWEST_DRAWS].map(|n| found(n).unwrap());
        let estimates = |it: &PhaseForecast| {
            let pdof_rad = [&it.struck, &it.striking].map(|of| of.pdof_rad.clone().unwrap());
            let delta_v_m_s = [&it.struck, &it.striking].map(|of| of.delta_v_m_s.clone());
            let [start_s, duration_s] = [it.start_s.clone(), it.duration_s.clone()];
            let of_phase = [start_s, duration_s, it.impulse_n_s.clone(), it.peak_force_n.clone()];
            [&pdof_rad[..], &delta_v_m_s[..], &of_phase[..]].concat()
        };
        assert!(estimates(&few).iter().all(|it| it.intervals.is_empty()), "{few:?}");
        assert!(estimates(&many).iter().all(|it| it.intervals.len() == 2), "{many:?}");
        assert_eq!((few.probability, few.duration_s.median), (0.05, 1.5));
        assert!(found(0).is_none());
    }

    #[test]
    fn directions_on_both_sides_of_straight_back_are_near_each_other() {
        let found = direction(&[3.1, -3.1, 3.0, -3.0, 3.12]).unwrap();
        let [low, high] = found.ninety();
        assert!(high - low < 0.3, "{found:?}");
        assert!(found.median.abs() > 3.0 && found.median.abs() <= PI, "{found:?}");
        assert_eq!(direction(&[]), None);
    }
}
