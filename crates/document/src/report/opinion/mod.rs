//! The opinion at the front of a report: question and answer in a sentence, the variants beside each
//! other, how often such intervals held, what the answer hinges on, what was not considered, and who
//! gives it. Everything in it is traced in the sections behind it.

mod part;

mod of_answer;

mod differences;

mod blocks;

mod words;

pub use differences::variant_differences;

pub(super) use differences::missing_inputs;

pub(super) use blocks::{Asked, are_by_hand, considered_methods, opinion_blocks};
pub(super) use of_answer::{
    condition_of_hand, opinion_of_force, opinion_of_forecast, opinion_of_hand, opinion_of_impact,
    opinion_of_reconstruction, opinion_of_replay, opinion_of_simulation,
};
pub(super) use part::PartOpinion;
#[cfg(test)]
pub(super) use part::Rank;
