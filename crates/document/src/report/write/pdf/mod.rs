//! A report as PDF: tagged, with an outline, embedded fonts, and tables that go over pages.
//!
//! The layout is found first, page by page, so that the number of pages is known; then the pages are
//! drawn by `krilla`.

mod fonts;

mod lines;

mod page;

mod flow;

mod contents;

mod figures;

mod table;

mod widths;

mod units;

mod draw;

mod vectors;

mod error;

pub use draw::pdf;
pub use error::PdfError;
