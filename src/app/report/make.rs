//! Makes a report on a thread of its own: asks the questions, lays out the document, draws its pictures.

use std::sync::Arc;

use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_document::report::{Pixels, ReportDocument, ReportSettings, report_case};
use impactlab_draw::report_picture;
use impactlab_study::case_file::{CaseFile, CaseOnDisk, Change};
use impactlab_study::{Event, Library};

/// What a report was made of. Another origin gives another report.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportOrigin {
    /// The content of the case, by [`OpenCase::fingerprint`](crate::app::case::OpenCase::fingerprint).
    pub fingerprint: String,
    /// How often a file in use had been opened again, which may have been changed.
    pub n_reopened: u64,
    /// The variants that are told of; empty for all.
    pub variants: Vec<String>,
    /// How it is written.
    pub settings: ReportSettings,
}

/// A report with its pictures.
#[derive(Debug)]
pub struct MadeReport {
    /// The document.
    pub document: Arc<ReportDocument>,
    /// Its pictures in their order, drawn or not.
    pub pictures: Vec<DrawnPicture>,
    /// Number of questions without an answer.
    pub n_unanswered: usize,
    /// What is not as it was when the case was saved.
    pub changes: Vec<Change>,
    /// What it was made of.
    pub origin: ReportOrigin,
}

/// A picture, or why it could not be drawn.
pub type DrawnPicture = Result<Pixels, String>;

/// Makes a report: asks the questions, lays out the document and draws its pictures.
///
/// # Errors
/// A message for the user.
pub(super) fn make_report(
    case: &CaseFile,
    on_disk: Option<&CaseOnDisk>,
    origin: ReportOrigin,
    library: &Library,
    tell: &mut ProgressCallback<'_>,
) -> Result<Outcome<Arc<MadeReport>>, String> {
    let mut observer = |event: Event<'_>| match event {
        Event::Progress(progress) => tell(progress),
        Event::Training(_) | Event::Sampling(_) => std::ops::ControlFlow::Continue(()),
    };
    let (variants, settings) = (origin.variants.as_slice(), &origin.settings);
    let answered = report_case(case, on_disk, variants, settings, library, &mut observer);
    let (document, report) = match answered.map_err(|error| error_chain(&error))? {
        Outcome::Complete(answered) => answered,
        Outcome::Cancelled => return Ok(Outcome::Cancelled),
    };
    let n = document.pictures().count() as u64;
    let mut pictures = Vec::new();
    for (i, picture) in document.pictures().enumerate() {
        if tell(Progress::new(i as u64, n, "drawing pictures")).is_break() {
            return Ok(Outcome::Cancelled);
        }
        pictures.push(report_picture(&picture.content));
    }
    let answers = report.variants.iter().flat_map(|variant| &variant.answers);
    Ok(Outcome::Complete(Arc::new(MadeReport {
        document: Arc::new(document),
        pictures,
        n_unanswered: answers.filter(|answer| answer.error.is_some()).count(),
        changes: report.changes,
        origin,
    })))
}
