//! Parts that several panels use.

mod figure_frame;
mod quantity;

pub use figure_frame::figure_frame;
pub use quantity::{SliderRange, duration_text, quantity_field, quantity_slider, value_row};
