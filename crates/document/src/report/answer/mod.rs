//! What each kind of answer contributes to a report.

mod atlas;

mod facts;

mod generic;

mod hand;

mod impact;

mod inputs;

mod vehicle_inputs;

mod zone_inputs;

mod simulate;

mod predict_force;

mod predict_motion;

mod reconstruct;

mod replay;

mod evidence;

mod evidence_inputs;

mod tire_marks;

pub(super) mod stills;

pub(super) use crate::report::answer::evidence_inputs::stated_rows;
pub(super) use crate::report::answer::facts::{capitalized, facts_table, with_writer};
pub(super) use crate::report::answer::inputs::given_rows;

pub use crate::report::answer::vehicle_inputs::{VehicleParameter, vehicle_parameters};

use crate::report::answer::facts::notes;
use crate::report::answer::stills::Grounds;
use crate::report::numbers::Wording;
use crate::report::parts::Part;
use crate::report::paths::ShownPaths;
use impactlab_study::{AnyAnswer, Request};

/// Language and names with which an answer is written.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    /// Numbers and texts.
    pub wording: &'a Wording,
    /// Files by their names.
    pub paths: &'a ShownPaths,
    /// The grounds that scenes of the report lie on.
    pub grounds: &'a Grounds,
}

/// What an answer contributes. A kind of answer that has no text of its own is told as a table of all
/// that is in it.
pub(super) fn part_of(request: &Request, answer: &AnyAnswer, context: Context<'_>) -> Part {
    let mut part = match (request, answer) {
        (_, AnyAnswer::Impact(answer)) => impact::part(answer, context),
        (_, AnyAnswer::Hand(answer)) => hand::part(&answer.report, context),
        (_, AnyAnswer::Replay(answer)) => replay::part(&answer.report, context),
        (Request::Simulate(request), AnyAnswer::Simulate(answer)) => {
            simulate::part(request, answer, context)
        }
        (_, AnyAnswer::PredictForce(answer)) => predict_force::part(answer, context),
        (Request::PredictMotion(request), AnyAnswer::PredictMotion(answer)) => {
            predict_motion::part(request, answer, context)
        }
        (Request::Reconstruct(request), AnyAnswer::Reconstruct(answer)) => {
            reconstruct::part(request, answer, context)
        }
        (request, other) => generic::part(request, other, context),
    };
    part.answer.extend(notes(&part.caveats, context.wording));
    inputs::with_request(part, request, context)
}
