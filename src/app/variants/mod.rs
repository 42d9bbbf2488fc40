//! The answers of the variants that are not in the forms, so that all variants are shown side by side.

mod answers;
mod differences;
mod update;

pub use answers::{
    AnsweredVariant, OtherVariants, are_others_awaited, other_forecasts, other_simulations,
};
pub use differences::VariantDifferences;
