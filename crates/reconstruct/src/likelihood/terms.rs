//! The evidence item by item against one motion.

use crate::evidence::{Evidence, Mark, MarkKind, Measured, RestPose};
use crate::likelihood::discrepancy::{Discrepancy, PathResidual, student};
use crate::likelihood::onset::Onset;
use crate::likelihood::track::{Nearest, Track};
use crate::{CollisionMotion, Latent};
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::vehicle::Wheel;

/// Degrees of freedom of the Student distributions of single numbers.
const SINGLE_DEGREES_OF_FREEDOM: f64 = 4.0;

/// Share of what one end of a mark says that it says by itself: the wheels of a braked car lock
/// together, so that what the model errs by is in part the same for all of them. Assumed.
const OWN_ONSET: f64 = 0.5;

/// How often the kind of a mark is told wrongly. Assumed.
const WRONG_KIND: f64 = 0.05;

/// Range of the share of a mark on which the wheel is locked over which its kind is open.
const KIND_SCATTER: f64 = 0.12;

/// One item of the evidence against one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct EvidenceTerm {
    /// Name for a person.
    pub name: String,
    /// Symbol of the unit of both numbers; empty for a pure number.
    pub unit: &'static str,
    /// What the motion would leave.
    pub expected: f64,
    /// What was found.
    pub found: f64,
    /// Squared distance between both in units of what measurement and model err by.
    pub distance: f64,
    /// Number of observations in the distance.
    pub n: usize,
}

/// Collects what a motion says of the evidence.
pub(super) struct Comparison<'a> {
    evidence: &'a Evidence,
    discrepancy: &'a Discrepancy,
    motion: &'a CollisionMotion,
    track: &'a Track,
    log_likelihood: f64,
    path: Vec<PathResidual>,
    terms: Vec<EvidenceTerm>,
    /// Whether the terms are wanted, and not the likelihood alone.
    is_told: bool,
}

/// Logarithm of the likelihood of a motion, and its terms if they are wanted.
pub(super) fn compared(
    (evidence, discrepancy): (&Evidence, &Discrepancy),
    motion: &CollisionMotion,
    is_told: bool,
) -> (f64, Vec<EvidenceTerm>) {
    let Some(track) = Track::of(&motion.path) else { return (f64::NEG_INFINITY, Vec::new()) };
    let mut comparison = Comparison::new((evidence, discrepancy), (motion, &track), is_told);
    comparison.add_rest();
    comparison.add_positions();
    for mark in &evidence.marks {
        comparison.add_mark(mark);
    }
    comparison.add_edr();
    let of_path = discrepancy.log_density(&comparison.path, track.whole_m());
    comparison.log_likelihood += of_path;
    comparison.add_striking_rest();
    if is_told {
        comparison.add_measured();
    }
    (comparison.log_likelihood, comparison.terms)
}

/// The residuals of rest pose and positions, in this order, and the distance travelled in all, m.
pub(super) fn path_residuals(
    of: (&Evidence, &Discrepancy),
    motion: &CollisionMotion,
) -> Option<(Vec<PathResidual>, f64)> {
    let track = Track::of(&motion.path)?;
    let mut comparison = Comparison::new(of, (motion, &track), false);
    comparison.add_rest();
    comparison.add_positions();
    Some((comparison.path, track.whole_m()))
}

impl<'a> Comparison<'a> {
    fn new(
        (evidence, discrepancy): (&'a Evidence, &'a Discrepancy),
        (motion, track): (&'a CollisionMotion, &'a Track),
        is_told: bool,
    ) -> Self {
        let (path, terms) = (Vec::new(), Vec::new());
        Self { evidence, discrepancy, motion, track, log_likelihood: 0.0, path, terms, is_told }
    }

    fn tell(
        &mut self,
        name: &str,
        unit: &'static str,
        numbers: [f64; 2],
        (distance, n): (f64, usize),
    ) {
        if self.is_told {
            let [expected, found] = numbers;
            self.terms.push(EvidenceTerm { name: name.into(), unit, expected, found, distance, n });
        }
    }

    /// Adds one coordinate of the path to the block whose errors go together.
    fn add_residual(&mut self, name: &str, at: PathResidual, [expected, found]: [f64; 2]) {
        let distance = at.residual * at.residual / self.discrepancy.variance(&at);
        let unit = if at.direction == [0.0; 2] { "rad" } else { "m" };
        self.tell(name, unit, [expected, found], (distance, 1));
        self.path.push(at);
    }

    /// A number by itself.
    ///
    /// - `weight`: 1, or less where other numbers err with it.
    fn add_single(
        &mut self,
        name: &str,
        unit: &'static str,
        [expected, found]: [f64; 2],
        (sigma, weight): (f64, f64),
    ) {
        let distance = ((found - expected) / sigma).powi(2);
        let density = student(distance, 1.0, SINGLE_DEGREES_OF_FREEDOM) - sigma.ln();
        self.log_likelihood += weight * density;
        self.tell(name, unit, [expected, found], (distance, 1));
    }

    fn add_rest(&mut self) {
        let Some(rest) = self.evidence.rest else { return };
        self.add_pose(["rest x", "rest y", "rest heading"], &rest, self.track.rest());
    }

    fn add_pose(&mut self, names: [&str; 3], found: &RestPose, [x_m, y_m, yaw_rad]: [f64; 3]) {
        let travelled_m = self.track.whole_m();
        let turned_rad = self.track.turned_rad.last().copied().unwrap_or(0.0);
        let at = PathResidual {
            travelled_m,
            turned_rad,
            direction: [1.0, 0.0],
            lever: 0.0,
            residual: found.x_m - x_m,
            sigma: found.position_sigma_m,
        };
        self.add_residual(names[0], at, [x_m, found.x_m]);
        let across = PathResidual { direction: [0.0, 1.0], residual: found.y_m - y_m, ..at };
        self.add_residual(names[1], across, [y_m, found.y_m]);
        if let Some(Measured { value, sigma }) = found.heading_rad {
            let residual = wrap_angle_rad(value - yaw_rad);
            let turned = PathResidual { direction: [0.0; 2], lever: 1.0, residual, sigma, ..at };
            self.add_residual(names[2], turned, [value - residual, value]);
        }
    }

    fn add_positions(&mut self) {
        for found in &self.evidence.positions {
            let Some((idx, at)) = self.track.at_time(found.time_s) else { continue };
            let along = PathResidual {
                travelled_m: self.track.travelled_m[idx],
                turned_rad: self.track.turned_rad[idx],
                direction: [1.0, 0.0],
                lever: 0.0,
                residual: found.x_m - at.x_m,
                sigma: found.sigma_m,
            };
            let name = |axis: &str| format!("position at {} s, {axis}", found.time_s);
            self.add_residual(&name("x"), along, [at.x_m, found.x_m]);
            let across =
                PathResidual { direction: [0.0, 1.0], residual: found.y_m - at.y_m, ..along };
            self.add_residual(&name("y"), across, [at.y_m, found.y_m]);
        }
    }

    fn add_mark(&mut self, mark: &Mark) {
        let place_m = self.motion.vehicle.geometry.wheel_place_m(mark.wheel);
        let wheel = self.track.wheel(place_m);
        let nearest = wheel.nearest(&mark.points_m);
        let onset = Onset::of(self.motion, self.track, mark.wheel, &wheel);
        let name = format!("mark {}", word(mark.wheel));
        let (mut squares, mut distance) = (0.0, 0.0);
        for at in &nearest {
            let residual = self.of_mark(at, place_m, mark.sigma_m);
            squares += at.offset_m[0].powi(2) + at.offset_m[1].powi(2);
            let variance = self.discrepancy.variance(&residual);
            distance += (at.offset_m[0].powi(2) + at.offset_m[1].powi(2)) / variance;
            self.path.push(residual);
            self.add_beyond_end(at, residual);
        }
        let n = nearest.len() as f64;
        // The points of a mark err together, so that their mean counts as one observation.
        let off_m = (squares / n).sqrt();
        self.tell(&format!("{name}, distance to the path"), "m", [0.0, off_m], (distance / n, 1));
        let weight = (3.0 / n).min(1.0);
        for at in &nearest {
            let sigma_m = self.discrepancy.onset_sigma_m(self.track.travelled_m[at.idx]);
            let off = onset.distance_m(&wheel, at.idx) / sigma_m;
            self.log_likelihood += weight * student(off * off, 1.0, SINGLE_DEGREES_OF_FREEDOM);
        }
        let (Some(first), Some(last)) = (nearest.first(), nearest.last()) else { return };
        let n_marks = self.evidence.marks.len() as f64;
        let common = OWN_ONSET + (1.0 - OWN_ONSET) / n_marks;
        for (at, step, end) in [(first, -1, "start"), (last, 1, "end")] {
            let sigma_m = self.discrepancy.onset_sigma_m(self.track.travelled_m[at.idx]);
            let expected_m = onset.end_m(&wheel, at.idx, step);
            // A wheel that never slides: as far off as can be.
            let expected_m = expected_m.unwrap_or(at.travelled_m + 30.0);
            let numbers = [expected_m, at.travelled_m];
            let name = format!("{name}, {end} along the path");
            self.add_single(&name, "m", numbers, (sigma_m, common));
        }
        if let Some(kind) = mark.kind {
            let share = onset.locked_share(&wheel, first.idx, last.idx);
            self.log_likelihood += kind_probability(kind, share).ln();
        }
    }

    /// A point of a mark as a residual across the path.
    fn of_mark(&self, at: &Nearest, place_m: [f64; 2], sigma_m: f64) -> PathResidual {
        let [tx, ty] = at.tangent;
        let normal = [-ty, tx];
        let arm_m = self.track.arm_m(at.idx, place_m);
        PathResidual {
            travelled_m: self.track.travelled_m[at.idx],
            turned_rad: self.track.turned_rad[at.idx],
            direction: normal,
            lever: normal[1] * arm_m[0] - normal[0] * arm_m[1],
            residual: normal[0] * at.offset_m[0] + normal[1] * at.offset_m[1],
            sigma: sigma_m,
        }
    }

    /// A point beyond the end of the path, where the car was not.
    fn add_beyond_end(&mut self, at: &Nearest, across: PathResidual) {
        let along_m = at.offset_m[0] * at.tangent[0] + at.offset_m[1] * at.tangent[1];
        let variance = self.discrepancy.variance(&PathResidual {
            direction: at.tangent,
            lever: 0.0,
            ..across
        });
        self.log_likelihood +=
            student(along_m * along_m / variance, 1.0, SINGLE_DEGREES_OF_FREEDOM) / 2.0;
    }

    fn add_edr(&mut self) {
        let edr = &self.evidence.edr;
        if let Some(Measured { value, sigma }) = edr.speed_before_m_s {
            let expected = self.motion.impact.struck_speed_m_s;
            let distance = ((value - expected) / sigma).powi(2);
            self.log_likelihood -= distance / 2.0;
            self.tell("EDR speed before the impact", "m/s", [expected, value], (distance, 1));
        }
        if edr.delta_v_x_m_s.is_none() && edr.delta_v_y_m_s.is_none() {
            return;
        }
        let end_s = edr.ends_s.unwrap_or(self.motion.values.get(Latent::PulseDuration));
        let Some(recorded) = self.track.recorded_delta_v_m_s(edr.sensor_m, end_s) else { return };
        let size = recorded[0].hypot(recorded[1]);
        let sigma = self.discrepancy.delta_v_share * size + 0.03;
        for (name, bounds, expected) in [
            ("EDR delta-v along x", edr.delta_v_x_m_s, recorded[0]),
            ("EDR delta-v along y", edr.delta_v_y_m_s, recorded[1]),
        ] {
            let Some([low, high]) = bounds else { continue };
            let beyond = (low - expected).max(expected - high).max(0.0) / sigma;
            let distance = beyond * beyond;
            self.log_likelihood += student(distance, 1.0, SINGLE_DEGREES_OF_FREEDOM);
            self.tell(name, "m/s", [expected, (low + high) / 2.0], (distance, 1));
        }
    }

    fn add_striking_rest(&mut self) {
        let Some(found) = self.evidence.striking_rest else { return };
        let track = self.motion.striking_path.as_ref().and_then(Track::of);
        let Some(track) = track else {
            self.log_likelihood = f64::NEG_INFINITY;
            return;
        };
        let of = (self.evidence, self.discrepancy);
        let mut of_striking = Comparison::new(of, (self.motion, &track), self.is_told);
        let names = ["striking car rest x", "striking car rest y", "striking car rest heading"];
        of_striking.add_pose(names, &found, track.rest());
        let density = of_striking.discrepancy.log_density(&of_striking.path, track.whole_m());
        let terms = std::mem::take(&mut of_striking.terms);
        self.log_likelihood += density;
        self.terms.extend(terms);
    }

    /// What was measured by itself: it is part of the prior, and told beside the rest.
    fn add_measured(&mut self) {
        let values = &self.motion.values;
        let (evidence, damage) = (self.evidence, &self.evidence.damage);
        let heading = self.motion.impact.heading_difference_rad;
        for (name, unit, found, expected) in [
            ("road friction", "", evidence.friction, values.get(Latent::RoadFriction)),
            (
                "mass of the struck car",
                "kg",
                evidence.struck_car.mass_kg,
                values.get(Latent::StruckMass),
            ),
            (
                "mass of the striking car",
                "kg",
                evidence.striking_car.mass_kg,
                values.get(Latent::StrikingMass),
            ),
            ("damage along the side", "m", Some(damage.along_m), values.get(Latent::ContactAlong)),
            ("angle of the damage", "rad", damage.angle_rad, heading),
        ] {
            let Some(Measured { value, sigma }) = found else { continue };
            let distance = ((value - expected) / sigma).powi(2);
            self.tell(name, unit, [expected, value], (distance, 1));
        }
    }
}

/// Probability that a mark is told to be of a kind, by the share of its length on which the wheel is
/// locked.
fn kind_probability(kind: MarkKind, locked_share: f64) -> f64 {
    let locked = 1.0 / (1.0 + (-(locked_share - 0.5) / KIND_SCATTER).exp());
    let right = match kind {
        MarkKind::Locked => locked,
        MarkKind::SideSlip => 1.0 - locked,
    };
    WRONG_KIND + (1.0 - 2.0 * WRONG_KIND) * right
}

/// A wheel as in an evidence file.
fn word(wheel: Wheel) -> &'static str {
    ["FL", "FR", "RL", "RR"][wheel.index()]
}
