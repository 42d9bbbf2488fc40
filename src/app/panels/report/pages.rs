//! The “Report text” pane: the document as it will be written, on paper of its own colour, so that it
//! looks in both themes as it will be printed.

use egui::{Align, Color32, Frame, Label, Margin, RichText, ScrollArea, Stroke, TextureHandle, Ui};

use crate::app::panels::report::table::table_ui;
use crate::app::panes::PaneContext;
use crate::app::report::ReportSession;
use crate::app::widgets::empty_ui;
use impactlab_core::data::Severity;
use impactlab_document::report::{Block, Picture, Section};
use impactlab_draw::theme;

/// Widest column of text, points.
const WIDEST: f32 = 820.0;
/// Room between the text and the edge of the paper, points.
const PAPER_MARGIN: i8 = 28;
/// Sizes of headings, points: title, section, and the two below it.
const HEADINGS: [f32; 4] = [22.0, 18.0, 15.0, 13.5];
/// Space before a heading, points.
const BEFORE_HEADING: f32 = 12.0;

/// Draws the report, or what to do for one.
pub fn report_pages_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let report = &mut pane.session.report;
    let Some(made) = report.made.clone() else {
        let text = "Make the report in the pane at the left. It tells question and answers with their \
             intervals, inputs with their sources, evidence, method, validity, validation, seeds and \
             digests of files and networks.";
        return empty_ui(ui, "No report yet", text);
    };
    let wanted = report.wanted_section.take();
    let is_outdated = report.is_outdated;
    ScrollArea::vertical().auto_shrink(false).id_salt("report text").show(ui, |ui| {
        if is_outdated {
            ui.multiply_opacity(OUTDATED_OPACITY);
        }
        ui.style_mut().visuals = theme::visuals(false);
        let width = ui.available_width().min(WIDEST);
        let margin = (ui.available_width() - width) / 2.0;
        ui.horizontal(|ui| {
            ui.add_space(margin);
            let paper = Frame::new().fill(Color32::WHITE).inner_margin(Margin::same(PAPER_MARGIN));
            paper.show(ui, |ui| {
                ui.set_width(width - 2.0 * f32::from(PAPER_MARGIN));
                ui.vertical(|ui| {
                    heading_ui(ui, &made.document.title, HEADINGS[0]);
                    ui.weak(&made.document.date);
                    let mut idx = 0;
                    for section in &made.document.sections {
                        let heading = heading_ui(ui, &section.title, HEADINGS[1]);
                        if wanted == Some(section.kind) {
                            heading.scroll_to_me(Some(Align::TOP));
                        }
                        section_ui(ui, section, report, &mut idx);
                    }
                });
            });
        });
    });
}

/// Share of its colour that a report keeps that is not of the case as it is.
const OUTDATED_OPACITY: f32 = 0.5;

fn heading_ui(ui: &mut Ui, text: &str, size: f32) -> egui::Response {
    ui.add_space(BEFORE_HEADING);
    ui.add(Label::new(RichText::new(text).size(size).strong()).wrap())
}

/// Draws the blocks of a section.
///
/// - `n_before`: how many pictures stand before it; those of the section are added.
fn section_ui(ui: &mut Ui, section: &Section, report: &mut ReportSession, n_before: &mut usize) {
    for (idx, block) in section.blocks.iter().enumerate() {
        match block {
            Block::Heading { level, text } => {
                let size = HEADINGS[usize::from(*level).clamp(2, 3)];
                heading_ui(ui, text, size);
            }
            Block::Paragraph { text } => drop(ui.add(Label::new(text).wrap())),
            Block::Notice { text } => notice_ui(ui, text),
            Block::List { items } => {
                for item in items {
                    ui.horizontal_top(|ui| {
                        ui.label("•");
                        ui.add(Label::new(item).wrap());
                    });
                }
            }
            Block::Table(table) => table_ui(ui, table, (section.title.as_str(), idx)),
            Block::Picture(picture) => {
                picture_ui(ui, picture, report.texture(ui.ctx(), *n_before));
                *n_before += 1;
            }
        }
        ui.add_space(4.0);
    }
}

/// Draws what must not be overlooked, with a bar at its left.
fn notice_ui(ui: &mut Ui, text: &str) {
    let color = theme::severity_color(Severity::Warning, false);
    let frame = Frame::new().stroke(Stroke::new(1.0, color)).inner_margin(Margin::same(8));
    frame.show(ui, |ui| ui.add(Label::new(RichText::new(text).strong()).wrap()));
}

/// Draws a picture over the whole width, and its caption.
fn picture_ui(ui: &mut Ui, picture: &Picture, texture: Option<Result<TextureHandle, String>>) {
    match texture {
        Some(Ok(texture)) => {
            let (width, size) = (ui.available_width(), texture.size_vec2());
            let shown = egui::vec2(width, width * size.y / size.x.max(1.0));
            ui.add(egui::Image::new((texture.id(), shown)).alt_text(&picture.alt));
        }
        Some(Err(why)) => notice_ui(ui, &why),
        None => {}
    }
    ui.add(Label::new(RichText::new(&picture.caption).italics()).wrap());
}
