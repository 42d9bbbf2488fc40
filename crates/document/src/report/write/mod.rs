//! Writes a report: JSON, Markdown, PDF.

mod json;

mod markdown;

mod indexed_png;

mod pdf;

mod pictures;

mod vectors;

mod columns;

mod format;

pub use columns::column_widths;
pub use format::{FormatError, ReportFormat, WriteError};
pub use pdf::{PdfError, pdf};
pub use pictures::{Drawing, Drawn, Medium, Pixels};
pub use vectors::{VectorMark, VectorPicture, VectorShape};
