//! The panes of the report: its settings with its sections, and its text.

mod form;
mod pages;
mod table;

pub use form::report_ui;
pub use pages::report_pages_ui;
