//! Why a PDF cannot be written.

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
    #[error("the PDF cannot be put together: {why}")]
    Krilla {
        /// Why.
        why: String,
    },
}
