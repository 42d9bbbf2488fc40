//! What an answer says, as plain tables that the terminal, the window and reports print alike.
//!
//! A report gives its facts once: each has a name from [`Term`], which knows every language, and a
//! [`Value`] in SI units. [`FactTable::to_text`] writes them with the one
//! [`NumberFormat`](impactlab_core::units::NumberFormat); what is left to a printer is where the cells
//! go.

mod table;
mod term;
mod writer;

mod answer;
mod answer_card;
mod both_vehicles;
mod check;
mod compare;
mod contact;
mod evaluate_force;
mod evaluate_pairs;
mod evaluate_reconstruction;
mod force_beside;
mod hand;
mod held;
mod impact;
mod impulse_rival;
mod predict_force;
mod predict_motion;
mod reconstruct;
mod replay;
mod simulate;
mod simulate_dataset;
mod training;

pub use held::HeldTooSeldom;
pub use table::{Fact, FactTable, TextRow, TextTable, Value};
pub use term::Term;
pub use training::{
    force_model_table, force_settings_table, response_model_table, response_settings_table,
};
pub use writer::FactWriter;
