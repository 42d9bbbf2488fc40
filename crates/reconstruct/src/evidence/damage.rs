//! Where and in which direction the struck car was hit. Place and angle are measured by themselves, so
//! that they are parts of the prior.

use impactlab_core::collision::Side;
use impactlab_core::ranges::{ANGLE_SIGMA, CONTACT_X, CONTACT_Y, EVIDENCE_HEADING, POSITION_SIGMA};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Latent;
use crate::evidence::{Choice, Field, Fields, Group, Item, Measured, Section, Sigma, Stated};
use crate::likelihood::Comparison;

/// The damage in a file, a form and a report.
pub const SECTION: Section = Section {
    key: "damage",
    title: "damage of the struck car",
    group: Group::Scene,
    is_required: true,
    missing: "has not been placed: choose the struck side, and type where along it the first contact was",
};

const SIDE: Choice =
    Choice { key: "side", label: "struck side", is_required: true, none: "not known" };
const ANGLE: Field = Field::new("angle", "angle of the cars", EVIDENCE_HEADING).turned();
const ANGLE_SIGMA_FIELD: Sigma = Sigma::fixed(
    "angle_sigma",
    "±",
    ANGLE_SIGMA,
    0.17,
    "damage is bent by the turn of the cars during the contact; assumed",
);

/// Where and in which direction the struck car was hit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Damage {
    /// Struck side; `None` until it is entered.
    pub side: Option<Side>,
    /// Middle of the first contact along that side, from the CG, m: forward on the left and the right
    /// side, to the left at front and rear.
    pub along_m: Option<Stated>,
    /// Depth of the contact point at right angles to the side, from the CG, m; half the width of the
    /// car, or its end, if `None`.
    pub depth_m: Option<f64>,
    /// Heading of the striking car against that of the struck car by the damage, rad.
    pub angle_rad: Option<Stated>,
}

impl Item for Damage {
    fn fields(&mut self, visitor: &mut impl Fields) {
        let Self { side, along_m, depth_m, angle_rad } = self;
        visitor.optional_choice(&SIDE, side);
        let [x, y] = [
            Field::new("x", "contact ahead of the CG", CONTACT_X),
            Field::new("y", "contact to the left of the CG", CONTACT_Y).turned(),
        ];
        let (along, depth) = if is_flank(*side) { (x, y) } else { (y, x) };
        visitor.measured(&along.required(), &along_sigma(*side), along_m);
        visitor.number(&beyond_side(depth, *side).with_default("at the side"), depth_m);
        visitor.measured(&ANGLE, &ANGLE_SIGMA_FIELD, angle_rad);
    }
}

/// Whether the contact is told along a flank, as it is until the side is known.
fn is_flank(side: Option<Side>) -> bool {
    matches!(side, None | Some(Side::Left | Side::Right))
}

fn along_sigma(side: Option<Side>) -> Sigma {
    let key = if is_flank(side) { "x_sigma" } else { "y_sigma" };
    let source = "a third of the width of a usual dent; assumed";
    Sigma::fixed(key, "±", POSITION_SIGMA, 0.10, source)
}

/// The coordinate at right angles to a side, on that side of the CG.
fn beyond_side(depth: Field, side: Option<Side>) -> Field {
    let (limits, expected) = match side {
        None => return depth,
        Some(Side::Left) => ([0.0, f64::INFINITY], "a point on the left of the car"),
        Some(Side::Right) => ([f64::NEG_INFINITY, 0.0], "a point on the right of the car"),
        Some(Side::Front) => ([0.0, f64::INFINITY], "a point on the front of the car"),
        Some(Side::Rear) => ([f64::NEG_INFINITY, 0.0], "a point on the rear of the car"),
    };
    Field { range: depth.range.within(limits), ..depth }.with_expected(expected)
}

impl Damage {
    /// Middle of the first contact along the side, m; `None` until it is entered.
    pub fn along(&self) -> Option<Measured> {
        along_sigma(self.side).resolve(self.along_m)
    }

    /// Heading of the striking car against that of the struck car by the damage, rad.
    pub fn angle(&self) -> Option<Measured> {
        ANGLE_SIGMA_FIELD.resolve(self.angle_rad)
    }

    /// The struck side, and the right one until it is entered: drawn and shown beforehand is a car that may be hit
    /// there, but nothing is computed of evidence without a side ([`Evidence::missing`](crate::evidence::Evidence::missing)).
    pub fn struck_side(&self) -> Side {
        self.side.unwrap_or(Side::Right)
    }

    /// The damage of another side, of which no place is known: coordinates are of one side.
    #[must_use]
    pub fn on_side(self, side: Option<Side>) -> Self {
        let along_m = self.along_m.filter(|_| is_flank(self.side) == is_flank(side));
        Self { side, along_m, depth_m: None, ..self }
    }

    pub(super) fn compare(&self, comparison: &mut Comparison<'_>) {
        let along_m = comparison.value(Latent::ContactAlong);
        comparison.tell_measured("damage along the side", "m", self.along(), along_m);
        let Some(impact) = &comparison.motion.impact else { return };
        let angle_rad = impact.heading_difference_rad;
        comparison.tell_measured("angle of the damage", "rad", self.angle(), angle_rad);
    }
}
