//! A figure as it is exported: with its title, and with one line of what restricts it below it.
//!
//! A picture shows an answer. Everything that restricts it stands with the answer itself, in the report
//! and in the numbers of the picture; the picture has the first of it and how much more there is.

use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{FontId, Rect, RichText, Sense, TextStyle, Ui, Vec2, pos2, vec2};

use crate::{FigureOptions, figure_ui, theme};
use impactlab_core::data::Severity;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Language, NumberFormat};
use impactlab_document::figure::Figure;

/// Size of the line, and height of the room that it takes, points.
const TEXT_SIZE: f32 = 10.5;
pub(crate) const LINE_HEIGHT: f32 = 15.0;
/// Size of the title of a figure, points.
const TITLE_SIZE: f32 = 15.0;
/// Room between the line and the number of the others, points.
const BETWEEN: f32 = 8.0;
/// Narrowest line, as a number of letters, that stands beside the number of the others in words, and
/// beside where they are listed.
const LEAST_LETTERS: [f32; 2] = [30.0, 48.0];
/// Largest share of the height of a picture that its legend takes, and height of a row of it, points.
const LEGEND_SHARE: f32 = 0.3;
const LEGEND_ROW_HEIGHT: f32 = 18.0;

/// Size of the names in the legend of a picture, points: in a window there is less room for them.
const LEGEND_SIZE: f32 = 11.5;

/// Draws a figure below its title, if it has one, and above the line of what restricts it.
pub fn picture_ui(ui: &mut Ui, figure: &Figure) {
    let width = ui.available_width();
    if !figure.title.is_empty() {
        ui.label(RichText::new(&figure.title).strong().size(TITLE_SIZE));
    }
    if let Some(small) = ui.style_mut().text_styles.get_mut(&TextStyle::Small) {
        small.size = LEGEND_SIZE;
    }
    let format = NumberFormat { language: figure.language, ..NumberFormat::default() };
    let line = RestrictionLine::new(&figure.caveats, &format);
    let height = line.as_ref().map(|_| ui.available_height() - LINE_HEIGHT);
    let legend_rows = (LEGEND_SHARE * ui.available_height() / LEGEND_ROW_HEIGHT).max(1.0) as usize;
    let options = FigureOptions { height, legend_rows, ..FigureOptions::default() };
    figure_ui(ui, figure, &options);
    if let Some(line) = line {
        let bottom = ui.max_rect().bottom();
        let left_top = pos2(ui.max_rect().left(), bottom - LINE_HEIGHT);
        line.ui(ui, Rect::from_min_size(left_top, vec2(width, LINE_HEIGHT)));
    }
}

/// What restricts a picture, in a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RestrictionLine {
    severity: Severity,
    /// What it is about.
    label: String,
    text: String,
    /// How many restrictions and assumptions there are beside it.
    n_others: usize,
    language: Language,
}

impl RestrictionLine {
    /// The first restriction, or else what was assumed; `None` where there is neither.
    pub(crate) fn new(caveats: &Caveats, format: &NumberFormat) -> Option<Self> {
        let language = format.language;
        let (restrictions, n_assumed) = (caveats.restrictions(), caveats.assumptions().count());
        if let Some(first) = restrictions.first() {
            let kind = first.kind.label_in(language);
            let label = match (first.is_warning(), language) {
                (true, Language::En) => format!("Warning: {kind}: "),
                (true, Language::De) => format!("Warnung: {kind}: "),
                (false, _) => format!("{}: ", capitalised(kind)),
            };
            let n_others = restrictions.len() - 1 + n_assumed;
            let (severity, text) = (first.severity, first.statement_in(language));
            return Some(Self { severity, label, text, n_others, language });
        }
        let summary = caveats.summaries().into_iter().next()?;
        let of_kind = caveats.assumptions().filter(|caveat| caveat.kind == summary.kind).count();
        let text = match language {
            Language::En => None,
            Language::De => summary.text_in(format, &str::to_owned),
        };
        Some(Self {
            severity: Severity::Info,
            label: format!("{}: ", capitalised(summary.kind.label_in(language))),
            text: text.unwrap_or(summary.text),
            n_others: n_assumed - of_kind,
            language,
        })
    }

    /// How many others there are, in as many words as a line of a width has room for.
    fn others(&self, width: f32) -> String {
        let [in_words, with_place] = LEAST_LETTERS.map(|letters| letters * TEXT_SIZE);
        match (self.n_others, self.language) {
            (0, _) => String::new(),
            (n, _) if width < in_words => format!("+{n}"),
            (n, Language::En) if width < with_place => format!("and {n} more"),
            (n, Language::De) if width < with_place => format!("und {n} weitere"),
            (n, Language::En) => format!("and {n} more, listed with the answer"),
            (n, Language::De) => format!("und {n} weitere, bei der Antwort aufgeführt"),
        }
    }

    /// Draws the line. The number of the others always stands there; the sentence ends with “…” where it
    /// is too long.
    pub(crate) fn ui(&self, ui: &mut Ui, rect: Rect) {
        let visuals = ui.visuals();
        let (strong, weak) = (visuals.strong_text_color(), visuals.text_color());
        let color = theme::severity_color(self.severity, visuals.dark_mode);
        let format = |color| TextFormat::simple(FontId::proportional(TEXT_SIZE), color);
        let others = self.others(rect.width());
        let mut job = LayoutJob::single_section(others.clone(), format(weak));
        job.wrap = TextWrapping::truncate_at_width(rect.width());
        let others_galley = ui.painter().layout_job(job);
        let taken = if others.is_empty() { 0.0 } else { others_galley.size().x + BETWEEN };
        let line = |text: &str| {
            let mut job = LayoutJob::default();
            job.append(&self.label, 0.0, format(color));
            job.append(text, 0.0, format(strong));
            job.wrap = TextWrapping::truncate_at_width((rect.width() - taken).max(0.0));
            ui.painter().layout_job(job)
        };
        let mut galley = line(&self.text);
        let mut kept = self.text.as_str();
        // A list is cut between its parts, a text between its sentences, and a long sentence between its words.
        while galley.elided {
            let Some(before) = shorter(kept) else { break };
            kept = before;
            galley = line(&format!("{kept} …"));
        }
        let place = |x: f32, size: Vec2| pos2(x, rect.center().y - size.y / 2.0);
        let end = rect.left() + galley.size().x;
        ui.painter().galley(place(rect.left(), galley.size()), galley, strong);
        if !others.is_empty() {
            let at = place(end + BETWEEN, others_galley.size());
            ui.painter().galley(at, others_galley, weak);
        }
        let whole = format!("{}{} {others}", self.label, self.text);
        let response = ui.interact(rect, ui.scope_id().with("restriction"), Sense::hover());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, whole.trim()));
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A text without its last part or sentence; `None` if it has one alone.
fn without_last_part(text: &str) -> Option<&str> {
    let end = text.rfind("; ").max(text.rfind(". "))?;
    text.get(..=end)
}

/// A text without its last part or sentence, or without its last word if it has one alone; `None` if that is
/// one word.
fn shorter(text: &str) -> Option<&str> {
    without_last_part(text).or_else(|| text.rsplit_once(' ').map(|(before, _)| before))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};

    /// “no speed in it is a safe speed” was cut from below every map, as a long sentence stood behind it.
    #[test]
    fn a_text_is_cut_between_parts_and_sentences() {
        let text = "a study; no speed of 4.5 m/s is safe. Hatched: few rows";
        let shorter = without_last_part(text);
        assert_eq!(shorter, Some("a study; no speed of 4.5 m/s is safe."));
        assert_eq!(shorter.and_then(without_last_part), Some("a study;"));
        assert_eq!(without_last_part("a study;"), None);
    }

    /// A sentence that was longer than the line ended as “the masses of 2000 and 16…”.
    #[test]
    fn a_long_sentence_is_cut_between_words() {
        assert_eq!(shorter("a study; no speed is safe"), Some("a study;"));
        assert_eq!(shorter("masses of 2000 and 1600"), Some("masses of 2000 and"));
        assert_eq!(shorter("masses"), None);
    }

    /// “Fahrer offen: striking vehicle: Zum Verhalten …” stood below the figures of a German report.
    #[test]
    fn what_a_restriction_is_about_is_in_the_language_of_the_figure() {
        let text = "Zum Verhalten des Fahrers liegt keine Angabe vor";
        let open = Caveat::new(CaveatKind::DriverOpen, text);
        let open = Caveat { subject: Some(CaveatSubject::Striking), ..open };
        let german = NumberFormat { language: Language::De, ..NumberFormat::default() };
        let line = RestrictionLine::new(&Caveats::from(vec![open]), &german).unwrap();
        assert_eq!(line.text, format!("stoßendes Fahrzeug: {text}"));
    }

    #[test]
    fn a_warning_comes_first_and_the_others_are_counted() {
        let rest = Caveat::new(CaveatKind::NotAtRest, "not at rest: it still moves");
        let warning = Caveat::new(CaveatKind::WheelLift, "a wheel lifts");
        let friction = Caveat::assumed(CaveatSubject::RoadFriction, "0.7", "it is dry");
        let note = Caveat::new(CaveatKind::Note, "a note restricts nothing");
        let all = Caveats::from(vec![rest.clone(), note.clone(), friction.clone(), warning]);
        let english = NumberFormat::default();
        let line = RestrictionLine::new(&all, &english).unwrap();
        assert_eq!((line.label.as_str(), line.n_others), ("Warning: wheel lift: ", 2));
        let others = [300.0, 340.0, 600.0].map(|width| line.others(width));
        assert_eq!(others, ["+2", "and 2 more", "and 2 more, listed with the answer"]);
        let german = NumberFormat { language: Language::De, ..english };
        assert_eq!(
            RestrictionLine::new(&all, &german).unwrap().label,
            "Warnung: abgehobenes Rad: "
        );
        let all = Caveats::from(vec![friction.clone(), rest]);
        let line = RestrictionLine::new(&all, &english).unwrap();
        assert_eq!((line.label.as_str(), line.n_others), ("Not at rest: ", 1));
        let unused = Caveat::not_used("restitution, 0.15", "the network knows it");
        let assumed = Caveats::from(vec![unused, friction]);
        let line = RestrictionLine::new(&assumed, &english).unwrap();
        assert_eq!((line.text.as_str(), line.n_others), ("road friction", 1));
        let line = RestrictionLine::new(&assumed, &german).unwrap();
        assert_eq!(line.text, "Reibbeiwert der Fahrbahn");
        assert_eq!(RestrictionLine::new(&Caveats::from(vec![note]), &english), None);
    }
}
