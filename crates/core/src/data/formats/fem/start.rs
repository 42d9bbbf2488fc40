//! The velocities with which the cars of a model begin.

use crate::data::formats::fem::deck::{DeckUnits, Dimension};
use crate::data::formats::fem::momenta::{Momenta, by_velocity};
use crate::data::formats::fem::results::{History, Kind, Results};

/// More velocities than these are not told apart as those of cars.
const MOST_SHOWN: usize = 4;

/// Velocities at the start of a finite-element run, m/s along the axes of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelStart {
    /// That of the parts on which the force acts, by what their momenta gain, or of all parts where they begin
    /// alike; `None` where this does not tell which parts these are.
    pub of_force_m_s: Option<[f64; 2]>,
    /// Those that parts begin with, or nodes and rigid bodies in a file without parts.
    pub all_m_s: Vec<[f64; 2]>,
}

impl ModelStart {
    /// What a file says of the start.
    ///
    /// - `forces`: those that are read as one;
    /// - returns `None` where the file says nothing.
    pub(super) fn new(results: &Results, forces: &[&History], deck: DeckUnits) -> Option<Self> {
        let per_unit = deck.si_per_unit(Dimension::Velocity);
        let in_si = |velocity: [f64; 2]| velocity.map(|component| component * per_unit);
        let of_force = match (forces, &results.momenta) {
            ([only], Some(momenta)) if only.kind == Kind::Contact => {
                only.force().and_then(|force| momenta.start_of(&force))
            }
            _ => None,
        };
        let momenta = results.momenta.as_ref();
        let mut all = momenta.map_or_else(|| of_motions(results), Momenta::starts);
        let n_starts = all.len();
        all.retain(|velocity| velocity.iter().all(|value| value.is_finite()));
        let groups = by_velocity(&all);
        // Where all parts begin alike, it does not matter on which of them the force acts.
        let is_before = |parts: &Momenta| {
            let begins = |history: &&History| {
                history.force().is_some_and(|force| parts.begin_before(&force))
            };
            forces.iter().all(begins)
        };
        let of_all = match groups.as_slice() {
            [(velocity, starts)] if starts.len() == n_starts && momenta.is_some_and(is_before) => {
                Some(*velocity)
            }
            _ => None,
        };
        let of_force = of_force.or(of_all);
        let is_told = of_force.is_some() || (1..=MOST_SHOWN).contains(&groups.len());
        is_told.then(|| Self {
            of_force_m_s: of_force.map(in_si),
            all_m_s: groups.into_iter().map(|(velocity, _)| in_si(velocity)).collect(),
        })
    }
}

impl ModelStart {
    /// The same along the axes in which the force is read.
    ///
    /// - `y_to_right`: whether y of the model points to the right.
    pub(in crate::data) fn along_axes(&self, y_to_right: bool) -> Self {
        let turned = |[x, y]: [f64; 2]| [x, if y_to_right { 0.0 - y } else { y }];
        let all_m_s = self.all_m_s.iter().copied().map(turned).collect();
        Self { of_force_m_s: self.of_force_m_s.map(turned), all_m_s }
    }
}

/// The first velocities of all nodes and rigid bodies.
fn of_motions(results: &Results) -> Vec<[f64; 2]> {
    let nodes = results.histories.iter().filter(|history| history.kind.is_motion());
    let first = |node: &History| Some([*node.values("vx").first()?, *node.values("vy").first()?]);
    nodes.filter_map(first).collect()
}
