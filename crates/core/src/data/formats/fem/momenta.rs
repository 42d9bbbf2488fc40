//! The momenta of the parts of a model: what a contact gives to a car its parts must gain.

use crate::data::ForceHistory;
use crate::data::formats::fem::deck::{DeckUnits, Dimension, shown};
use crate::numerics::interpolate;

/// Velocities at the start that differ by less than this share of the largest are those of one car.
const SAME_VELOCITY: f64 = 0.02;

/// Largest difference of momentum and impulse, as a share of the impulse.
const LARGEST: f64 = 0.05;

/// Momenta of all parts at the same instants.
#[derive(Debug, Clone, Default)]
pub(super) struct Momenta {
    pub time: Vec<f64>,
    pub parts: Vec<PartMomentum>,
}

/// The momentum of one part along x and y, and its velocity at the start.
#[derive(Debug, Clone, Default)]
pub(super) struct PartMomentum {
    pub start: [f64; 2],
    pub momentum: [Vec<f64>; 2],
}

impl Momenta {
    /// Compares an impulse with the change of momentum of the parts that begin with one velocity, as
    /// those of one car do.
    ///
    /// - returns what is found, in words, and whether it contradicts the impulse; `None` where nothing
    ///   can be compared.
    pub(super) fn check(
        &self,
        force: &ForceHistory,
        deck: Option<DeckUnits>,
    ) -> Option<(String, bool)> {
        let acting = self.acting(force)?;
        let groups = self.groups();
        let [_, _] = groups.as_slice() else {
            let text = "the momenta of the parts are not compared with the impulse: which parts are one \
                        car does not follow from their first velocities";
            return Some((text.to_owned(), false));
        };
        let (start, error) = self.nearest(&groups, &acting)?;
        let per_unit = deck.map_or(1.0, |deck| deck.si_per_unit(Dimension::Velocity));
        let unit = deck.map_or("", |_| " m/s");
        let [x, y] = start.map(|component| shown(component * per_unit));
        let percent = shown(100.0 * error);
        let car = format!("the parts that begin with ({x}, {y}){unit}");
        match error > LARGEST {
            false => Some((
                format!(
                    "the momentum of {car} changes by the impulse of this force to {percent} %, so that \
                         it is the force on them"
                ),
                false,
            )),
            true => Some((
                format!(
                    "the momentum of no car changes by the impulse of this force; that of {car} comes \
                     nearest and differs by {percent} %: other contacts or the road act, too, or it is \
                     another side"
                ),
                true,
            )),
        }
    }

    /// The velocity at the start of the parts that a force acts on, in the units of the model; `None` where
    /// their momenta do not tell which these are, or are not known from before the force.
    pub(super) fn start_of(&self, force: &ForceHistory) -> Option<[f64; 2]> {
        let acting = self.acting(force)?;
        let groups = self.groups();
        let [_, _] = groups.as_slice() else { return None };
        let (start, error) = self.nearest(&groups, &acting)?;
        let is_known = error <= LARGEST && self.begin_before(force);
        is_known.then_some(start).filter(|start| start.iter().all(|value| value.is_finite()))
    }

    /// Whether the momenta are known from before a force.
    pub(super) fn begin_before(&self, force: &ForceHistory) -> bool {
        self.acting(force).is_some_and(|acting| acting.share_before <= LARGEST)
    }

    /// The velocities of all parts at the start, in the units of the model.
    pub(super) fn starts(&self) -> Vec<[f64; 2]> {
        self.parts.iter().map(|part| part.start).collect()
    }

    /// What a force gives while the momenta are known; `None` if that is nothing.
    fn acting(&self, force: &ForceHistory) -> Option<Acting> {
        let from = self.time.first()?.max(*force.time_s.first()?);
        let to = self.time.last()?.min(*force.time_s.last()?);
        let sum = force.cumulative();
        let at = |time: f64| -> Option<[f64; 2]> {
            let [x, y] =
                [&sum.px_n_s, &sum.py_n_s].map(|sums| interpolate(&sum.knots_s, sums, time));
            Some([x?, y?])
        };
        let ([x0, y0], [x1, y1]) = (at(from)?, at(to)?);
        let impulse = [x1 - x0, y1 - y0];
        let size = impulse[0].hypot(impulse[1]);
        let is_some = to > from && size.is_finite() && size > 0.0;
        is_some.then(|| Acting { from, to, impulse, size, share_before: x0.hypot(y0) / size })
    }

    /// The velocity at the start of the parts whose momentum changes most nearly by an impulse, and by how
    /// much it differs, as a share of the impulse.
    fn nearest(&self, groups: &[Vec<usize>], acting: &Acting) -> Option<([f64; 2], f64)> {
        let Acting { from, to, impulse: [px, py], size, .. } = *acting;
        let over = |values: &[f64]| {
            Some(interpolate(&self.time, values, to)? - interpolate(&self.time, values, from)?)
        };
        let error = |group: &Vec<usize>| -> Option<f64> {
            let gained = |axis: usize| -> Option<f64> {
                let parts = group.iter().filter_map(|at| self.parts.get(*at));
                parts.map(|part| over(part.momentum.get(axis)?)).sum()
            };
            Some((gained(0)? - px).hypot(gained(1)? - py) / size)
        };
        let errors = groups.iter().filter_map(|group| Some((group, error(group)?)));
        let errors = errors.filter(|(_, error)| error.is_finite());
        let (group, error) = errors.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let start = group.first().and_then(|at| self.parts.get(*at)).map(|part| part.start)?;
        Some((start, error))
    }

    /// The parts by their velocities at the start.
    fn groups(&self) -> Vec<Vec<usize>> {
        by_velocity(&self.starts()).into_iter().map(|(_, group)| group).collect()
    }
}

/// What a force gives over a time.
struct Acting {
    from: f64,
    to: f64,
    impulse: [f64; 2],
    /// Magnitude of the impulse.
    size: f64,
    /// What it gave before, as a share of the impulse.
    share_before: f64,
}

/// The indices of velocities that hardly differ, with the first of them.
pub(super) fn by_velocity(velocities: &[[f64; 2]]) -> Vec<([f64; 2], Vec<usize>)> {
    let largest = velocities.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    let mut groups: Vec<([f64; 2], Vec<usize>)> = Vec::new();
    for (at, velocity) in velocities.iter().enumerate() {
        let is_same = |of: &[f64; 2]| {
            (of[0] - velocity[0]).hypot(of[1] - velocity[1]) <= SAME_VELOCITY * largest
        };
        let is_many = groups.len() > MOST_GROUPS;
        match groups.iter_mut().find(|(of, _)| is_same(of)) {
            Some((_, group)) => group.push(at),
            None if is_many => break,
            None => groups.push((*velocity, vec![at])),
        }
    }
    groups
}

/// More groups than this are not those of two cars.
const MOST_GROUPS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{ForceAxes, Sampling};

    /// Two cars of two parts each; the second drives at 10 and loses 4 of momentum to the first.
    fn pair(gain: f64) -> Momenta {
        let part = |start: [f64; 2], from: f64, to: f64| PartMomentum {
            start,
            momentum: [vec![from, to], vec![0.0, 0.0]],
        };
        let parts = vec![
            part([0.0, 0.0], 0.0, gain / 2.0),
            part([10.0, 0.0], 10.0, 7.0),
            part([0.01, 0.0], 0.0, gain / 2.0),
            part([10.0, 0.0], 10.0, 9.0),
        ];
        Momenta { time: vec![0.0, 2.0], parts }
    }

    #[test]
    fn the_parts_of_one_car_gain_the_impulse_of_the_force_on_it() {
        let force = |sign: f64| ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::Instant,
            time_s: vec![0.0, 1.0, 2.0],
            fx_n: vec![0.0, sign * 4.0, 0.0],
            fy_n: vec![0.0; 3],
            mz_n_m: None,
        };
        let (text, is_wrong) = pair(4.0).check(&force(1.0), Some(DeckUnits::KgMmMs)).unwrap();
        assert!(!is_wrong && text.contains("(0, 0) m/s"), "{text}");
        assert_eq!(pair(4.0).start_of(&force(1.0)), Some([0.0, 0.0]));
        assert_eq!(pair(4.0).start_of(&force(-1.0)), Some([10.0, 0.0]));
        assert_eq!(pair(3.0).start_of(&force(1.0)), None, "the momenta contradict the force");
        let late = Momenta { time: vec![1.0, 2.0], ..pair(2.0) };
        assert_eq!(late.start_of(&force(1.0)), None, "half of the force acted before");
        let (text, is_wrong) = pair(4.0).check(&force(-1.0), None).unwrap();
        assert!(!is_wrong && text.contains("(10.00, 0) changes"), "{text}");
        let (text, is_wrong) = pair(3.0).check(&force(1.0), None).unwrap();
        assert!(is_wrong && text.contains("25.00 %"), "{text}");
        let mut one = pair(4.0);
        one.parts.iter_mut().for_each(|part| part.start = [0.0; 2]);
        assert!(!one.check(&force(1.0), None).unwrap().1);
    }
}
