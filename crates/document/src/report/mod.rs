//! The report that an expert signs: from a case and its answers to a document, and from that to PDF,
//! Markdown and JSON.
//!
//! ```text
//! case ──> questions, each asked once ──┬──> answers ──> parts: opinion, answer, inputs, pictures, … ──> document
//!                                       └──> changes, digests, log ─────────────────────────────────────^
//! ```
//!
//! - [`report_case`] asks the questions and makes the [`ReportDocument`], which is plain data.
//! - [`ReportDocument::to_json`], [`ReportDocument::to_markdown`] and [`pdf`] write it. Pictures are
//!   drawn by a function that the caller passes on, since drawing is the work of a crate above: plots as
//!   lines and texts for the PDF, all else as pixels.
//! - Numbers are formatted by [`units`](impactlab_core::units), as those in the window.
//! - The same case, files, settings and date give the same bytes: nothing reads a clock.

mod document;

mod settings;

mod language;

mod numbers;

mod keys;

mod labels;

mod flatten;

mod paths;

mod method;

mod validation;

mod answer;

mod parts;

mod opinion;

mod provenance;

mod validity;

mod beside;

mod alt;

mod holders;

mod answers;

mod input_table;

mod picture_blocks;

mod build;

mod write;

pub use answer::{VehicleParameter, vehicle_parameters};
pub use build::report_case;
pub use document::{
    Block, Column, InputClass, Picture, PictureContent, ReportDocument, Section, SectionKind, Table,
};
pub use impactlab_core::units::Language;
pub use numbers::without_options;
pub use opinion::variant_differences;
pub use settings::{DateError, Paper, ReportDate, ReportSettings};
pub use write::{
    Drawing, Drawn, FormatError, Medium, PdfError, Pixels, ReportFormat, VectorMark, VectorPicture,
    VectorShape, WriteError, column_widths, pdf,
};
