//! A figure as it is exported: with its title, and with what restricts it as text below it.

use egui::text::{LayoutJob, TextFormat};
use egui::{Color32, FontId, RichText, Ui};

use crate::{FigureOptions, figure_ui, theme};
use impactlab_core::data::Severity;
use impactlab_core::uncertainty::{Caveat, Caveats};
use impactlab_document::figure::Figure;

/// Size of the text below a figure, points.
const TEXT_SIZE: f32 = 10.5;
/// Largest share of the height of the picture that the text takes.
const LARGEST_SHARE: f32 = 0.4;
/// Room above and between the paragraphs, points.
const SPACING: f32 = 3.0;

/// Draws a figure below its title and above what restricts it: label and sentence of each badge,
/// and what was assumed. Where the picture is too small for all of it, the values that were assumed
/// are only counted; what does not fit even then is said to be in the table of the figure.
pub fn picture_ui(ui: &mut Ui, figure: &Figure) {
    framed_ui(ui, &figure.title, &figure.caveats, |ui, height| {
        figure_ui(ui, figure, &FigureOptions { height, ..FigureOptions::default() });
    });
}

/// Draws something below its title and above what restricts it, as [`picture_ui`] does.
///
/// - `draw`: given the height that is left, points; `None` if that is all the space there is.
pub fn framed_ui(
    ui: &mut Ui,
    title: &str,
    caveats: &Caveats,
    draw: impl FnOnce(&mut Ui, Option<f32>),
) {
    let area = ui.available_size();
    let heading = ui.label(RichText::new(title).strong().size(15.0));
    let paragraphs = fitting(ui, caveats, [area.x, area.y * LARGEST_SHARE]);
    let text_height: f32 = paragraphs.iter().map(|job| height(ui, job, area.x) + SPACING).sum();
    let between = ui.spacing().item_spacing.y;
    let rest = area.y - heading.rect.height() - text_height - 2.0 * between - SPACING;
    draw(ui, (!paragraphs.is_empty()).then_some(rest));
    if !paragraphs.is_empty() {
        ui.add_space(SPACING);
    }
    ui.spacing_mut().item_spacing.y = SPACING;
    for job in paragraphs {
        ui.add(egui::Label::new(job).wrap());
    }
}

/// A paragraph below a figure.
struct Paragraph {
    severity: Severity,
    label: &'static str,
    text: String,
}

impl From<&Caveat> for Paragraph {
    fn from(caveat: &Caveat) -> Self {
        let (severity, label) = (caveat.severity, caveat.kind.label());
        Self { severity, label, text: caveat.statement() }
    }
}

/// The paragraphs below a figure, as many as fit into width and height, points.
fn fitting(ui: &Ui, caveats: &Caveats, [width, largest]: [f32; 2]) -> Vec<LayoutJob> {
    let restrictions: Vec<LayoutJob> =
        caveats.restrictions().iter().map(|caveat| layout(ui, &Paragraph::from(*caveat))).collect();
    let all = |assumed: Vec<Paragraph>| -> Vec<LayoutJob> {
        let assumed = assumed.iter().map(|paragraph| layout(ui, paragraph));
        restrictions.iter().cloned().chain(assumed).collect()
    };
    let size = |jobs: &[LayoutJob]| -> f32 {
        jobs.iter().map(|job| height(ui, job, width) + SPACING).sum()
    };
    let in_full = all(together(caveats));
    if size(&in_full) <= largest {
        return in_full;
    }
    let mut short = all(counted(caveats));
    if size(&short) <= largest {
        return short;
    }
    let n_all = short.len();
    while !short.is_empty() && size(&short) > largest - TEXT_SIZE - SPACING {
        short.pop();
    }
    let text = format!("{} more, see the numbers of this figure (CSV)", n_all - short.len());
    short.push(layout(ui, &Paragraph { severity: Severity::Warning, label: "not shown", text }));
    short
}

/// What was assumed, and what is not used, in a paragraph each.
fn together(caveats: &Caveats) -> Vec<Paragraph> {
    grouped(caveats, |texts| texts.join("; "))
}

/// How many values were assumed, and how many are not used.
fn counted(caveats: &Caveats) -> Vec<Paragraph> {
    let count = |texts: Vec<String>| {
        let n = texts.len();
        format!(
            "{n} {}, see the numbers of this figure (CSV)",
            if n == 1 { "value" } else { "values" }
        )
    };
    grouped(caveats, count)
}

/// The assumptions as one paragraph for each label.
fn grouped(caveats: &Caveats, joined: impl Fn(Vec<String>) -> String) -> Vec<Paragraph> {
    let mut groups: Vec<(&'static str, Vec<String>)> = Vec::new();
    for caveat in caveats.assumptions() {
        let (label, text) = (caveat.kind.label(), caveat.statement());
        match groups.iter_mut().find(|(known, _)| *known == label) {
            Some((_, texts)) => texts.push(text),
            None => groups.push((label, vec![text])),
        }
    }
    let severity = Severity::Info;
    let paragraph = |(label, texts)| Paragraph { severity, label, text: joined(texts) };
    groups.into_iter().map(paragraph).collect()
}

/// A paragraph with its label in the colour of its severity. The severity of a warning is a word, too.
fn layout(ui: &Ui, paragraph: &Paragraph) -> LayoutJob {
    let visuals = ui.visuals();
    let color = theme::severity_color(paragraph.severity, visuals.dark_mode);
    let format = |color: Color32| TextFormat::simple(FontId::proportional(TEXT_SIZE), color);
    let label = match paragraph.severity > Severity::Info {
        true => format!("Warning: {}: ", paragraph.label),
        false => format!("{}: ", capitalised(paragraph.label)),
    };
    let mut job = LayoutJob::default();
    job.append(&label, 0.0, format(color));
    job.append(&paragraph.text, 0.0, format(visuals.strong_text_color()));
    job
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Height of a paragraph in lines of a width, points.
fn height(ui: &Ui, job: &LayoutJob, width: f32) -> f32 {
    let mut job = job.clone();
    job.wrap.max_width = width;
    ui.painter().layout_job(job).size().y
}
