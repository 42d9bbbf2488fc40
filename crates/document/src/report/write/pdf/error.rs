//! Why a PDF cannot be written.

use krilla::configure::ConfigurationError;
use krilla::error::KrillaError;

/// A PDF that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum PdfError {
    /// A font of the program cannot be read.
    #[error("the font {name} cannot be read")]
    Font {
        /// Name of the font.
        name: &'static str,
    },
    /// A page has no size.
    #[error("a page of {width_pt} by {height_pt} points has no size")]
    Page {
        /// Width, points.
        width_pt: f32,
        /// Height, points.
        height_pt: f32,
    },
    /// A picture could not be drawn.
    #[error("figure {number} cannot be drawn: {why}")]
    Picture {
        /// Its number.
        number: usize,
        /// Why.
        why: String,
    },
    /// The PDF cannot be put together.
    #[error(
        "the PDF cannot be put together: {why}; the report as Markdown (.md) has the same content"
    )]
    Assembly {
        /// Why.
        why: &'static str,
    },
}

impl From<ConfigurationError> for PdfError {
    /// Reports are written to one standard, which does not contradict itself.
    fn from(_: ConfigurationError) -> Self {
        Self::Assembly { why: "the standard of the file contradicts itself" }
    }
}

impl From<KrillaError> for PdfError {
    /// What the writer of PDF files refuses, in words for somebody who has not seen its code.
    fn from(error: KrillaError) -> Self {
        let why = match error {
            KrillaError::Font(..) => "a font of the program cannot be embedded",
            KrillaError::Validation(_) => "it would not conform to the standard of the file",
            KrillaError::Limit(_) => "it is larger than a PDF may be",
            KrillaError::DuplicateNamedDestination(_)
            | KrillaError::DuplicateTagId(..)
            | KrillaError::UnknownTagId(..) => "its links or its structure contradict themselves",
            KrillaError::Image(..) | KrillaError::SixteenBitImage(..) => {
                "a picture cannot be embedded"
            }
        };
        Self::Assembly { why }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn a_refused_pdf_is_told_in_words() {
        let refused = KrillaError::DuplicateNamedDestination(Arc::new("table-3".to_owned()));
        assert_eq!(
            PdfError::from(refused).to_string(),
            "the PDF cannot be put together: its links or its structure contradict themselves; the report \
             as Markdown (.md) has the same content"
        );
    }
}
