//! A tire mark of either car: where the path of a wheel was, where the wheel slid, and whether it was
//! locked.

use impactlab_core::ranges::{EVIDENCE_POSITION, POSITION_SIGMA};
use impactlab_core::vehicle::Wheel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::{Choice, Field, Fields, Group, Item, PointsMut, Section, Sigma, Word};
use crate::likelihood::{
    Comparison, NEVER_M, Nearest, Onset, PathResidual, SINGLE_DEGREES_OF_FREEDOM, student,
};

/// Share of what one end of a mark says that it says by itself: the wheels of a braked car lock
/// together, so that what the model errs by is in part the same for all of them. Assumed.
const OWN_ONSET: f64 = 0.5;

/// How often the kind of a mark is told wrongly. Assumed.
const WRONG_KIND: f64 = 0.05;

/// Range of the share of a mark on which the wheel is locked over which its kind is open.
const KIND_SCATTER: f64 = 0.12;

/// A mark of the struck car in a file, a form and a report.
pub const STRUCK: Section = Section {
    key: "mark",
    title: "tire mark",
    group: Group::Scene,
    is_required: false,
    missing: "needs at least two points: type them, or Add points and click along it in the scene",
};
/// A mark of the striking car, likewise.
pub const STRIKING: Section =
    Section { key: "striking_mark", title: "tire mark of the striking car", ..STRUCK };

const WHEEL: Choice = Choice { key: "wheel", label: "wheel", is_required: true, none: "" };
const KIND: Choice =
    Choice { key: "kind", label: "left by", is_required: false, none: "cannot be told" };
const POINTS: Field = Field::new("points", "points", EVIDENCE_POSITION);
const SIGMA: Sigma = Sigma::fixed(
    "sigma",
    "± of a point",
    POSITION_SIGMA,
    0.10,
    "half the width of the tread of a tire; assumed",
);

/// What left a mark.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum MarkKind {
    /// A wheel that slid sideways.
    SideSlip,
    /// A locked wheel.
    Locked,
}

impl Word for MarkKind {
    const ALL: &'static [Self] = &[Self::SideSlip, Self::Locked];

    fn word(self) -> &'static str {
        self.into()
    }

    fn label(self) -> &'static str {
        match self {
            Self::SideSlip => "sliding sideways",
            Self::Locked => "a locked wheel",
        }
    }
}

/// A tire mark.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// The wheel that left it.
    pub wheel: Wheel,
    /// What left most of it, if that can be told.
    pub kind: Option<MarkKind>,
    /// Points along it in the order of time, m; the first is where it starts, the last where it ends.
    pub points_m: Vec<[f64; 2]>,
    /// Standard deviation of a point along each axis, m; `None` for that of the program.
    pub sigma_m: Option<f64>,
}

impl Default for Mark {
    fn default() -> Self {
        Self { wheel: Wheel::RearRight, kind: None, points_m: Vec::new(), sigma_m: None }
    }
}

impl Item for Mark {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { wheel, kind, points_m, sigma_m } = self;
        visitor.choice(&WHEEL, wheel);
        visitor.optional_choice(&KIND, kind);
        visitor.points(&POINTS, &SIGMA, PointsMut { points_m, sigma_m });
    }
}

impl Mark {
    /// Standard deviation of a point along each axis, m.
    pub fn sigma_m(&self) -> f64 {
        self.sigma_m.unwrap_or(SIGMA.default_at(0.0))
    }

    /// - `n_marks`: number of marks of the car, whose ends are in part one witness.
    pub(super) fn compare(&self, n_marks: usize, comparison: &mut Comparison<'_>) {
        let name = format!("mark {}", self.wheel.word());
        comparison.part(&name, |comparison| self.add_to(&name, n_marks, comparison));
    }

    fn add_to(&self, name: &str, n_marks: usize, comparison: &mut Comparison<'_>) {
        let car = comparison.car;
        let place_m = car.vehicle.geometry.wheel_place_m(self.wheel);
        let wheel = car.track.wheel(place_m);
        let nearest = wheel.nearest(&self.points_m);
        let onset = Onset::new(car, self.wheel, &wheel);
        let (mut squares, mut distance) = (0.0, 0.0);
        for at in &nearest {
            let residual = self.residual(at, place_m, comparison);
            squares += at.offset_m[0].powi(2) + at.offset_m[1].powi(2);
            let variance = comparison.discrepancy.variance(&residual);
            distance += (at.offset_m[0].powi(2) + at.offset_m[1].powi(2)) / variance;
            comparison.path.push(residual);
            add_beyond_end(at, residual, comparison);
        }
        let n = nearest.len() as f64;
        // The points of a mark err together, so that their mean counts as one observation.
        let off_m = (squares / n).sqrt();
        let name_of_distance = format!("{name}, distance to the path");
        comparison.tell_distance(&name_of_distance, off_m, distance / n);
        let weight = (3.0 / n).min(1.0);
        for at in &nearest {
            let sigma_m = comparison.onset_sigma_m(at.idx);
            let off = onset.distance_m(&wheel, at.idx) / sigma_m;
            comparison.log_likelihood +=
                weight * student(off * off, 1.0, SINGLE_DEGREES_OF_FREEDOM);
        }
        let (Some(first), Some(last)) = (nearest.first(), nearest.last()) else { return };
        let common = OWN_ONSET + (1.0 - OWN_ONSET) / n_marks as f64;
        for (at, step, end) in [(first, -1, "start"), (last, 1, "end")] {
            let sigma_m = comparison.onset_sigma_m(at.idx);
            let expected_m = onset.end_m(&wheel, at.idx, step);
            // A wheel that never slides: as far off as can be.
            let expected_m = expected_m.unwrap_or(at.travelled_m + NEVER_M);
            let numbers = [expected_m, at.travelled_m];
            let name = format!("{name}, {end} along the path");
            comparison.add_place(&name, numbers, sigma_m, common);
        }
        if let Some(kind) = self.kind {
            let share = onset.locked_share(&wheel, first.idx, last.idx);
            comparison.log_likelihood += kind_probability(kind, share).ln();
        }
    }

    /// A point of the mark as a residual across the path.
    fn residual(
        &self,
        at: &Nearest,
        place_m: [f64; 2],
        comparison: &Comparison<'_>,
    ) -> PathResidual {
        let track = comparison.car.track;
        let [tx, ty] = at.tangent;
        let normal = [-ty, tx];
        let arm_m = track.arm_m(at.idx, place_m);
        PathResidual {
            travelled_m: track.travelled_m[at.idx],
            turned_rad: track.turned_rad[at.idx],
            direction: normal,
            lever: normal[1] * arm_m[0] - normal[0] * arm_m[1],
            residual: normal[0] * at.offset_m[0] + normal[1] * at.offset_m[1],
            sigma: self.sigma_m(),
        }
    }
}

/// A point beyond the end of the path, where the car was not.
fn add_beyond_end(at: &Nearest, across: PathResidual, comparison: &mut Comparison<'_>) {
    let along_m = at.offset_m[0] * at.tangent[0] + at.offset_m[1] * at.tangent[1];
    let along = PathResidual { direction: at.tangent, lever: 0.0, ..across };
    let variance = comparison.discrepancy.variance(&along);
    comparison.log_likelihood +=
        student(along_m * along_m / variance, 1.0, SINGLE_DEGREES_OF_FREEDOM) / 2.0;
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
