//! What the draws of two vehicles come to: courses of events, contacts, where the vehicles are.

use std::f64::consts::FRAC_PI_4;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::pair::{PairDraw, PairForecast};
use impactlab_core::collision::contact::ContactPhase;
use impactlab_core::numerics::{is_half_turn, is_quarter_turn, wrap_angle_rad};
use impactlab_core::uncertainty::PlanarMixture;

/// What becomes of the struck vehicle.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Course {
    /// The vehicles do not touch each other.
    Missed,
    /// At the end it stands across the front of the striking vehicle, which still pushes it.
    Across,
    /// At the end it is in contact otherwise.
    Hooked,
    /// It turns by less than a quarter.
    Recovers,
    /// It turns by a quarter or more, and by less than a half.
    Turns,
    /// It turns by a half or more.
    Spins,
}

/// A course of events and how likely it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CourseShare {
    /// The course.
    pub course: Course,
    /// Share of the draws, 0 to 1.
    pub probability: f64,
}

impl Course {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Missed, Self::Across, Self::Hooked, Self::Recovers, Self::Turns, Self::Spins];
}

impl PairDraw {
    /// Largest change of the heading of a vehicle from its beginning, rad, beyond a turn.
    pub fn largest_turn_rad(&self, vehicle: usize) -> f64 {
        let states = &self.states[vehicle];
        let first = states.first().map_or(0.0, |state| state.yaw_rad);
        states.iter().map(|state| (state.yaw_rad - first).abs()).fold(0.0, f64::max)
    }

    /// Whether the vehicles still are in contact at the end.
    fn is_in_contact_at_end(&self) -> bool {
        self.phases.last().is_some_and(|phase| phase.end_s.is_none())
    }

    /// Whether the headings at the end are nearer to a right angle than to any other.
    fn is_across_at_end(&self) -> bool {
        let [struck, striking] = self.states.each_ref().map(|states| states.last());
        let turn = struck.zip(striking).map(|(a, b)| wrap_angle_rad(a.yaw_rad - b.yaw_rad).abs());
        turn.is_some_and(|turn| (FRAC_PI_4..=3.0 * FRAC_PI_4).contains(&turn))
    }

    /// Whether the vehicles are in contact at an instant, s.
    pub fn is_in_contact(&self, time_s: f64) -> bool {
        let holds = |phase: &ContactPhase| {
            (phase.start_s..=phase.end_s.unwrap_or(f64::INFINITY)).contains(&time_s)
        };
        self.phases.iter().any(holds)
    }

    /// What becomes of the struck vehicle.
    pub fn course(&self) -> Course {
        match self.largest_turn_rad(0) {
            _ if self.phases.is_empty() => Course::Missed,
            _ if self.is_in_contact_at_end() => match self.is_across_at_end() {
                true => Course::Across,
                false => Course::Hooked,
            },
            turn if is_half_turn(turn) => Course::Spins,
            turn if is_quarter_turn(turn) => Course::Turns,
            _ => Course::Recovers,
        }
    }

    /// Time for which the vehicles are in contact, s.
    ///
    /// - `end_s`: where a contact that has not ended is cut off.
    pub fn contact_s(&self, end_s: f64) -> f64 {
        self.phases.iter().map(|phase| phase.end_s.unwrap_or(end_s) - phase.start_s).sum()
    }

    /// Size of the impulse on the struck vehicle over all contacts, N s.
    pub fn impulse_n_s(&self) -> f64 {
        let sum =
            |axis: usize| self.phases.iter().map(|it| it.impulse_world_n_s[axis]).sum::<f64>();
        sum(0).hypot(sum(1))
    }
}

impl PairForecast {
    /// Share of the draws for which something holds, 0 to 1.
    pub fn share(&self, holds: impl Fn(&PairDraw) -> bool) -> f64 {
        let n = self.draws.iter().filter(|draw| holds(draw)).count();
        n as f64 / self.draws.len().max(1) as f64
    }

    /// Every course that occurs, the likeliest first.
    pub fn courses(&self) -> Vec<CourseShare> {
        let share = |course: Course| {
            let probability = self.share(|draw| draw.course() == course);
            (probability > 0.0).then_some(CourseShare { course, probability })
        };
        let mut shares: Vec<CourseShare> = Course::ALL.into_iter().filter_map(share).collect();
        shares.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        shares
    }

    /// Poses of a vehicle at an instant over the draws: X, Y, m, heading, rad.
    pub fn poses(&self, vehicle: usize, instant: usize) -> Vec<[f64; 3]> {
        let states = self.draws.iter().filter_map(|draw| draw.state(vehicle, instant));
        states.map(|state| [state.x_m, state.y_m, state.yaw_rad]).collect()
    }

    /// Distribution of the position of a vehicle at an instant.
    pub fn position(&self, vehicle: usize, instant: usize) -> PlanarMixture {
        PlanarMixture::from_poses(&self.poses(vehicle, instant))
    }
}
