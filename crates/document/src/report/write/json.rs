//! A report as JSON.

use crate::report::ReportDocument;

impl ReportDocument {
    /// The document as indented JSON with a line end. Pictures are told by caption and description.
    ///
    /// # Errors
    /// [`serde_json::Error`], which a document of texts does not raise.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}
