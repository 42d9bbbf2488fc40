//! Writes a report: JSON, Markdown, PDF.

mod json;

mod markdown;

mod pdf;

pub use pdf::{Drawing, PdfError, Pixels, pdf};
