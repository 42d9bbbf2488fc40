//! The formats of a report, by the ending of its file.

use std::path::{Path, PathBuf};

use crate::report::{Drawing, PdfError, ReportDocument, pdf};

/// A format in which a report is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    /// Tagged PDF with embedded fonts.
    Pdf,
    /// Markdown with pipe tables and its pictures in it.
    Markdown,
    /// The document as it is in memory.
    Json,
}

/// A path whose ending is that of no format.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: cannot be made; expected a name that ends in .pdf, .md or .json", path.display())]
pub struct FormatError {
    path: PathBuf,
}

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The PDF cannot be made.
    #[error(transparent)]
    Pdf(#[from] PdfError),
    /// The JSON cannot be made.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

impl ReportFormat {
    /// The format of a file, by its ending; upper and lower case are alike.
    ///
    /// # Errors
    /// [`FormatError`] if no format has this ending.
    pub fn from_path(path: &Path) -> Result<Self, FormatError> {
        let ending = path.extension().map(|end| end.to_ascii_lowercase());
        match ending.as_deref().and_then(|end| end.to_str()) {
            Some("pdf") => Ok(Self::Pdf),
            Some("md") => Ok(Self::Markdown),
            Some("json") => Ok(Self::Json),
            _ => Err(FormatError { path: path.to_owned() }),
        }
    }
}

impl ReportDocument {
    /// The content of its file. The same document gives the same bytes.
    ///
    /// - `drawing`: draws the pictures; with `None` their captions stand alone. JSON has none.
    ///
    /// # Errors
    /// [`WriteError`] if a picture cannot be drawn, or the file cannot be made.
    pub fn bytes(
        &self,
        format: ReportFormat,
        drawing: Option<&Drawing<'_>>,
    ) -> Result<Vec<u8>, WriteError> {
        match format {
            ReportFormat::Pdf => Ok(pdf(self, drawing)?),
            ReportFormat::Markdown => match drawing {
                Some(drawing) => Ok(self.to_markdown_with_pictures(drawing)?.into_bytes()),
                None => Ok(self.to_markdown().into_bytes()),
            },
            ReportFormat::Json => Ok(self.to_json()?.into_bytes()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_gives_the_format_and_no_other_is_taken() {
        for (path, expected) in [
            ("a/report.pdf", ReportFormat::Pdf),
            ("REPORT.PDF", ReportFormat::Pdf),
            ("r.md", ReportFormat::Markdown),
            ("r.v2.json", ReportFormat::Json),
        ] {
            assert_eq!(ReportFormat::from_path(Path::new(path)).unwrap(), expected, "{path}");
        }
        for path in ["report", "report.docx", ".pdf", "pdf"] {
            let error = ReportFormat::from_path(Path::new(path)).unwrap_err().to_string();
            assert!(error.contains(path) && error.contains(".json"), "{error}");
        }
    }
}
