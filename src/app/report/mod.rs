//! The report in the window: its settings, the task that makes it, and what it was made of. The panes
//! Report and Report pages show them.

mod make;

mod update;

pub use make::{MadeReport, ReportOrigin};

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::SystemTime;

use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use serde::{Deserialize, Serialize};

use impactlab_core::data::Outcome;
use impactlab_core::units::UnitSystem;
use impactlab_document::report::{Language, Paper, ReportDate, ReportSettings, SectionKind};

/// How reports are written, which is saved. Their units are those of the window.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReportView {
    /// Language.
    pub language: Language,
    /// Size of the pages; `None` is the usual one where the units are.
    pub pages: Option<Paper>,
    /// The date that the report bears as the user typed it; today if it is empty.
    pub date: String,
    /// Whether only the variant that is shown is told of.
    pub shown_variant_only: bool,
}

/// An action on the report.
#[derive(Debug, Clone)]
pub enum ReportCommand {
    /// Ask the questions of the case and make the report of the answers.
    Make,
    /// Stop making it. The report that was there stays.
    Cancel,
    /// Show the report that was made, or why there is none.
    Made(Result<Outcome<Arc<MadeReport>>, String>),
    /// Bring a section to the top of its pane.
    ShowSection(SectionKind),
}

/// The report that is shown, and the one that is being made; not saved.
#[derive(Default)]
pub struct ReportSession {
    /// Whether a report is being made.
    pub is_running: bool,
    textures: BTreeMap<usize, TextureHandle>,
    /// The latest report.
    pub made: Option<Arc<MadeReport>>,
    /// Why the latest attempt gave none.
    pub problem: Option<String>,
    /// Whether the case or the settings were changed after the report was made.
    pub is_outdated: bool,
    /// Whether the case asks nothing that a report could answer.
    pub asks_nothing: bool,
    /// The section that is to be brought to the top of its pane.
    pub wanted_section: Option<SectionKind>,
}

impl ReportView {
    /// The date of the report.
    ///
    /// # Errors
    /// A message for the user if what was typed is no day, or if the clock tells none.
    pub fn report_date(&self) -> Result<ReportDate, String> {
        match self.date.trim() {
            "" => ReportDate::from_instant(SystemTime::now())
                .ok_or_else(|| "the clock of this machine tells no day: type one".to_owned()),
            text => text
                .parse()
                .map_err(|error: impactlab_document::report::DateError| error.to_string()),
        }
    }

    /// How a report is written now.
    ///
    /// # Errors
    /// As for [`ReportView::report_date`].
    pub fn settings(&self, units: UnitSystem) -> Result<ReportSettings, String> {
        let (language, paper) = (self.language, self.pages.unwrap_or_else(|| Paper::usual(units)));
        Ok(ReportSettings { language, units, paper, date: self.report_date()? })
    }
}

impl ReportSession {
    /// Shows the report that was made. A cancelled one leaves what was there.
    fn take(&mut self, result: Result<Outcome<Arc<MadeReport>>, String>) {
        self.is_running = false;
        match result {
            Ok(Outcome::Complete(made)) => {
                self.textures.clear();
                (self.made, self.problem) = (Some(made), None);
            }
            Ok(Outcome::Cancelled) => {}
            Err(why) => self.problem = Some(why),
        }
    }

    /// A picture of the report, by its number from 0, or why it was not drawn. It is given to the
    /// graphics when it is first asked for.
    pub fn texture(
        &mut self,
        context: &Context,
        idx: usize,
    ) -> Option<Result<TextureHandle, String>> {
        if let Some(texture) = self.textures.get(&idx) {
            return Some(Ok(texture.clone()));
        }
        let pixels = match self.made.as_ref()?.pictures.get(idx)? {
            Ok(pixels) => pixels,
            Err(why) => return Some(Err(why.clone())),
        };
        let size = pixels.size_px.map(|side| side as usize);
        let image = ColorImage::from_rgba_unmultiplied(size, &pixels.rgba);
        let texture = context.load_texture("report picture", image, TextureOptions::LINEAR);
        self.textures.insert(idx, texture.clone());
        Some(Ok(texture))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_those_that_go_with_the_units_unless_they_are_chosen() {
        let paper = |pages: Option<Paper>, units: UnitSystem| {
            let view = ReportView { pages, ..ReportView::default() };
            view.settings(units).unwrap().paper
        };
        assert_eq!(paper(None, UnitSystem::Si), Paper::A4);
        assert_eq!(paper(None, UnitSystem::Us), Paper::Letter);
        assert_eq!(paper(Some(Paper::A4), UnitSystem::Us), Paper::A4);
    }

    #[test]
    fn a_date_is_the_one_that_was_typed_or_today() {
        let of = |date: &str| ReportView { date: date.to_owned(), ..ReportView::default() };
        assert_eq!(of(" 2026-03-01 ").report_date().unwrap().to_string(), "2026-03-01");
        assert_eq!(of("").report_date().ok(), ReportDate::from_instant(SystemTime::now()));
        let error = of("1 March").report_date().unwrap_err();
        assert!(error.contains("YYYY-MM-DD"), "{error}");
    }
}
