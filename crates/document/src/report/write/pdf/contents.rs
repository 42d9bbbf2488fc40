//! The contents of the annex: its sections with their pages, which are known when all is set.

use crate::report::language::words_of;
use crate::report::write::pdf::flow::{Flow, LEADING, MARGIN_PT, Role, Style};
use crate::report::write::pdf::page::{Ink, Item, Owner};
use crate::report::{ReportDocument, SectionKind};

/// Size of the lines, points.
const LINE_PT: f32 = 11.0;

/// Lines of the contents that wait for the numbers of their pages.
pub(super) struct Contents {
    /// Title of a section, distance of its base line from the top in points, and its part.
    lines: Vec<(String, f32, Owner)>,
    /// The page that they stand on.
    page: usize,
}

impl Contents {
    /// Sets the titles of the sections behind the opinion, without their pages.
    pub fn without_pages(flow: &mut Flow<'_>, document: &ReportDocument) -> Self {
        let annex = words_of(document.language).annex;
        let owner = flow.part(Role::Heading { level: 1, text: annex.to_owned() }, None);
        let heading = Style { size_pt: 16.0, ink: Ink::Heading, is_bold: true, left_pt: MARGIN_PT };
        flow.text(annex, heading, owner);
        flow.space(4.0);
        let style = Style { size_pt: LINE_PT, ink: Ink::Text, is_bold: false, left_pt: MARGIN_PT };
        let mut lines = Vec::new();
        for section in &document.sections {
            if section.kind == SectionKind::Opinion {
                continue;
            }
            let owner = flow.part(Role::Paragraph, None);
            let base_pt = flow.y_pt + LINE_PT * (0.5 * (LEADING - 1.0) + 0.8);
            flow.text(&section.title, style, owner);
            lines.push((section.title.clone(), base_pt, owner));
        }
        Self { lines, page: flow.pages.len() - 1 }
    }

    /// Writes the pages of the sections.
    pub fn with_pages(self, flow: &mut Flow<'_>) {
        let right_pt = flow.size_pt[0] - MARGIN_PT;
        for (title, base_pt, owner) in self.lines {
            let entry = flow.outline.iter().find(|entry| entry.level == 1 && entry.text == title);
            let Some(number) = entry.map(|entry| (entry.page + 1).to_string()) else { continue };
            let left_pt = right_pt - LINE_PT * flow.fonts.width(&number);
            let item = Item::Text {
                at_pt: [left_pt, base_pt],
                size_pt: LINE_PT,
                ink: Ink::Text,
                is_bold: false,
                text: number,
                owner,
            };
            if let Some(page) = flow.pages.get_mut(self.page) {
                page.items.push(item);
            }
        }
    }
}
