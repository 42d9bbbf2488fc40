//! The contents of the annex: its sections with their pages, which are known when all is set.

use crate::report::language::words_of;
use crate::report::write::pdf::flow::{Flow, LEADING, MARGIN_PT, Role, Style};
use crate::report::write::pdf::page::{Ink, Item, Owner};
use crate::report::{ReportDocument, SectionKind};

/// Size of the lines, points.
const LINE_PT: f32 = 11.0;
/// Columns in which they stand, and the room between them, points.
const N_COLUMNS: usize = 2;
const BETWEEN_PT: f32 = 24.0;

/// The line of a section.
struct ContentsLine {
    title: String,
    /// Right end and base line, points.
    ends_pt: [f32; 2],
    owner: Owner,
}

/// Lines of the contents that wait for the numbers of their pages.
pub(super) struct Contents {
    lines: Vec<ContentsLine>,
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
        let sections = document.sections.iter();
        let sections: Vec<_> = sections.filter(|it| it.kind != SectionKind::Opinion).collect();
        let n_rows = sections.len().div_ceil(N_COLUMNS);
        let (top_pt, step_pt) = (flow.y_pt, LINE_PT * LEADING);
        let all_between_pt = (N_COLUMNS - 1) as f32 * BETWEEN_PT;
        let column_pt = (flow.width_pt() - all_between_pt) / N_COLUMNS as f32;
        let mut lines = Vec::new();
        for (idx, section) in sections.into_iter().enumerate() {
            let [column, row] = [idx / n_rows.max(1), idx % n_rows.max(1)].map(|of| of as f32);
            let left_pt = MARGIN_PT + column * (column_pt + BETWEEN_PT);
            let style = Style { size_pt: LINE_PT, ink: Ink::Text, is_bold: false, left_pt };
            let owner = flow.part(Role::Paragraph, None);
            flow.y_pt = top_pt + row * step_pt;
            flow.line(&section.title, style, owner);
            let base_pt = flow.y_pt + LINE_PT * (0.5 * (LEADING - 1.0) + 0.8);
            let ends_pt = [left_pt + column_pt, base_pt];
            lines.push(ContentsLine { title: section.title.clone(), ends_pt, owner });
        }
        flow.y_pt = top_pt + n_rows as f32 * step_pt;
        Self { lines, page: flow.pages.len() - 1 }
    }

    /// Writes the pages of the sections.
    pub fn with_pages(self, flow: &mut Flow<'_>) {
        for ContentsLine { title, ends_pt: [right_pt, base_pt], owner } in self.lines {
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
