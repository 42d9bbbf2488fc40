//! Lets a document flow over pages.

use crate::report::write::pdf::PdfError;
use crate::report::write::pdf::contents::Contents;
use crate::report::write::pdf::fonts::Fonts;
use crate::report::write::pdf::lines::lines;
use crate::report::write::pdf::page::{Ink, Item, OutlineEntry, Owner, PageItems};
use crate::report::write::pdf::table::{beginning_pt, flow_table};
use crate::report::{Block, ReportDocument, SectionKind};

/// Distance of the text from the edges of the page, points.
pub(super) const MARGIN_PT: f32 = 48.0;
/// The same from top and bottom, which hold header and footer.
const HIGH_MARGIN_PT: f32 = 52.0;
/// Distance between base lines over the size of the font.
pub(super) const LEADING: f32 = 1.24;
/// Size of running text, points.
const BODY_PT: f32 = 11.0;
/// Size of captions, points.
pub(super) const CAPTION_PT: f32 = 9.5;
/// Room below a heading that keeps it from the foot of a page, points.
const BELOW_HEADING_PT: f32 = 72.0;
/// Distance of the text of an item from the left edge of the text, points.
const ITEM_PT: f32 = 12.0;
/// Lines of a text that stand together at the foot of a page and at the top of the next one; a text that is
/// too short for both is not divided.
const KEPT_LINES: usize = 2;

/// What a part of the document is, for readers that cannot see the page.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Role {
    Heading { level: u8, text: String },
    Paragraph,
    List,
    ListItem,
    ListBody,
    Table { summary: String },
    Row,
    HeaderCell,
    RowHeaderCell,
    Cell,
    Caption,
    Figure { alt: String },
}

/// A part of the document and what it is in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub role: Role,
    pub parent: Owner,
}

/// The pages with what they mean.
pub(super) struct Flow<'a> {
    pub fonts: &'a Fonts,
    pub size_pt: [f32; 2],
    pub pages: Vec<PageItems>,
    pub parts: Vec<Part>,
    pub outline: Vec<OutlineEntry>,
    /// Where the next line begins, points from the top.
    pub y_pt: f32,
}

/// How a text is set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Style {
    pub size_pt: f32,
    pub ink: Ink,
    pub is_bold: bool,
    /// Distance from the left edge of the page, points.
    pub left_pt: f32,
}

impl<'a> Flow<'a> {
    /// Sets a document.
    pub fn from_document(document: &ReportDocument, fonts: &'a Fonts) -> Result<Self, PdfError> {
        let size_pt = document.paper.size_pt();
        let (pages, parts, outline) = (vec![PageItems::default()], Vec::new(), Vec::new());
        let mut flow = Self { fonts, size_pt, pages, parts, outline, y_pt: HIGH_MARGIN_PT };
        flow.heading(1, 19.0, &document.title, &[]);
        let mut contents = None;
        for section in &document.sections {
            flow.space(10.0);
            flow.heading(1, 15.0, &section.title, &section.blocks);
            let mut blocks = section.blocks.as_slice();
            while !blocks.is_empty() {
                blocks = flow.first_of(blocks);
            }
            if section.kind == SectionKind::Opinion {
                flow.new_page();
                contents = Some(Contents::without_pages(&mut flow, document));
            }
        }
        if let Some(contents) = contents {
            contents.with_pages(&mut flow);
        }
        Ok(flow)
    }

    /// Width of the text, points.
    pub fn width_pt(&self) -> f32 {
        self.size_pt[0] - 2.0 * MARGIN_PT
    }

    /// Room that is left on the page, points.
    pub fn room_pt(&self) -> f32 {
        self.size_pt[1] - HIGH_MARGIN_PT - self.y_pt
    }

    /// Room of a whole page, points.
    pub fn page_pt(&self) -> f32 {
        self.size_pt[1] - 2.0 * HIGH_MARGIN_PT
    }

    /// Goes on with a new page.
    pub fn new_page(&mut self) {
        self.pages.push(PageItems::default());
        self.y_pt = HIGH_MARGIN_PT;
    }

    /// Goes on with a new page unless there is room.
    pub fn need(&mut self, height_pt: f32) {
        if self.room_pt() < height_pt && self.y_pt > HIGH_MARGIN_PT {
            self.new_page();
        }
    }

    /// Leaves room, except at the top of a page.
    pub fn space(&mut self, height_pt: f32) {
        if self.y_pt > HIGH_MARGIN_PT {
            self.y_pt += height_pt;
        }
    }

    /// A new part of the document.
    pub fn part(&mut self, role: Role, parent: Owner) -> Owner {
        self.parts.push(Part { role, parent });
        Some(self.parts.len() - 1)
    }

    /// Puts something onto the page.
    pub fn push(&mut self, item: Item) {
        if let Some(page) = self.pages.last_mut() {
            page.items.push(item);
        }
    }

    /// Sets a text line by line, over pages if need be; no line of it stands alone on a page.
    pub fn text(&mut self, text: &str, style: Style, owner: Owner) {
        let width_pt = self.size_pt[0] - MARGIN_PT - style.left_pt;
        let step_pt = style.size_pt * LEADING;
        let lines = lines(text, self.fonts, style.size_pt, width_pt);
        for (idx, line) in lines.iter().enumerate() {
            self.need(kept_lines(idx, lines.len()) as f32 * step_pt);
            self.line(line, style, owner);
            self.y_pt += step_pt;
        }
    }

    /// Sets one line without going on.
    pub fn line(&mut self, text: &str, style: Style, owner: Owner) {
        // A little of the leading stands above the line.
        let base_pt = self.y_pt + style.size_pt * (0.5 * (LEADING - 1.0) + 0.8);
        self.push(Item::Text {
            at_pt: [style.left_pt, base_pt],
            size_pt: style.size_pt,
            ink: style.ink,
            is_bold: style.is_bold,
            text: text.to_owned(),
            owner,
        });
    }

    /// A heading, which stays with what follows it.
    fn heading(&mut self, level: u8, size_pt: f32, text: &str, behind: &[Block]) {
        self.need(size_pt * LEADING + self.below_heading_pt(behind));
        let page = self.pages.len() - 1;
        let entry = OutlineEntry { level, text: text.to_owned(), page, y_pt: self.y_pt };
        self.outline.push(entry);
        let owner = self.part(Role::Heading { level, text: text.to_owned() }, None);
        let style = Style { size_pt, ink: Ink::Heading, is_bold: true, left_pt: MARGIN_PT };
        self.text(text, style, owner);
        self.space(3.0);
    }

    /// Room that the beginning of what follows a heading takes, further headings included.
    fn below_heading_pt(&self, blocks: &[Block]) -> f32 {
        match blocks {
            [Block::Heading { .. }, behind @ ..] => 24.0 + self.below_heading_pt(behind),
            [Block::Picture(picture), ..] if picture.content.is_half_wide() => {
                self.pair_pt(&[picture.as_ref()]) + 8.0
            }
            [Block::Picture(picture), ..] => self.scene_pt(picture) + 8.0,
            [Block::Table(table), ..] => beginning_pt(self, table) + 8.0,
            [Block::List { items }, behind @ ..] => {
                self.list_to_end_pt(items, behind).unwrap_or(BELOW_HEADING_PT)
            }
            _ => BELOW_HEADING_PT,
        }
    }

    /// Room of a list with the paragraphs behind it, which stay together if half a page is enough: a place for
    /// a signature alone on a page belongs to nothing.
    fn list_to_end_pt(&self, items: &[String], behind: &[Block]) -> Option<f32> {
        let height_pt = |text: &str, left_pt: f32| {
            let lines = lines(text, self.fonts, BODY_PT, self.width_pt() - left_pt);
            lines.len() as f32 * BODY_PT * LEADING
        };
        let list_pt: f32 = items.iter().map(|item| height_pt(item, ITEM_PT) + 1.5).sum();
        let paragraph_pt = |block: &Block| match block {
            Block::Paragraph { text } => Some(height_pt(text, 0.0) + 4.0),
            _ => None,
        };
        let behind_pt: f32 = behind.iter().map_while(paragraph_pt).sum();
        let all_pt = list_pt + 4.0 + behind_pt;
        (behind_pt > 0.0 && all_pt <= 0.5 * self.page_pt()).then_some(all_pt)
    }

    pub(super) fn block(&mut self, block: &Block, behind: &[Block]) {
        let body = Style { size_pt: BODY_PT, ink: Ink::Text, is_bold: false, left_pt: MARGIN_PT };
        match block {
            Block::Heading { level, text } => {
                self.space(6.0);
                let size_pt = if *level <= 2 { 12.5 } else { 11.5 };
                self.heading(*level, size_pt, text, behind);
            }
            Block::Paragraph { text } => {
                let owner = self.part(Role::Paragraph, None);
                self.text(text, body, owner);
                self.space(4.0);
            }
            Block::Notice { text } => self.notice(text, body),
            Block::List { items } => {
                let together_pt = self.list_to_end_pt(items, behind);
                self.need(together_pt.unwrap_or_default());
                self.list(items, body);
            }
            Block::Table(table) => {
                self.space(2.0);
                flow_table(self, table);
                self.space(6.0);
            }
            Block::Picture(picture) => self.scene(picture),
        }
    }

    /// A text on a ground of its own, a line at a time.
    fn notice(&mut self, text: &str, body: Style) {
        let style = Style { ink: Ink::Warning, is_bold: true, left_pt: MARGIN_PT + 8.0, ..body };
        let owner = self.part(Role::Paragraph, None);
        let step_pt = style.size_pt * LEADING;
        let width_pt = self.width_pt();
        self.space(2.0);
        let lines = lines(text, self.fonts, style.size_pt, width_pt - 16.0);
        for (idx, line) in lines.iter().enumerate() {
            self.need(kept_lines(idx, lines.len()) as f32 * step_pt);
            let rect_pt = [MARGIN_PT, self.y_pt, width_pt, step_pt];
            self.push(Item::Fill { rect_pt, ink: Ink::WarningShade });
            self.push(Item::Fill {
                rect_pt: [MARGIN_PT, self.y_pt, 3.0, step_pt],
                ink: Ink::Warning,
            });
            self.line(line, style, owner);
            self.y_pt += step_pt;
        }
        self.space(6.0);
    }

    fn list(&mut self, items: &[String], body: Style) {
        let list = self.part(Role::List, None);
        for item in items {
            let entry = self.part(Role::ListItem, list);
            let owner = self.part(Role::ListBody, entry);
            let n_lines = lines(item, self.fonts, body.size_pt, self.width_pt() - ITEM_PT).len();
            let step_pt = body.size_pt * LEADING;
            // The point stands on the page of the first line.
            self.need(kept_lines(0, n_lines) as f32 * step_pt);
            let y_pt = self.y_pt + 0.62 * body.size_pt;
            self.push(Item::Fill { rect_pt: [MARGIN_PT + 3.0, y_pt, 2.5, 2.5], ink: Ink::Muted });
            self.text(item, Style { left_pt: MARGIN_PT + ITEM_PT, ..body }, owner);
            self.space(1.5);
        }
        self.space(4.0);
    }
}

/// How many lines of a text stay together from one on.
///
/// - `idx`: number of the line;
/// - `n_lines`: lines of the text.
fn kept_lines(idx: usize, n_lines: usize) -> usize {
    match idx {
        0 if n_lines < 2 * KEPT_LINES => n_lines,
        0 => KEPT_LINES,
        _ if n_lines >= 2 * KEPT_LINES && idx + KEPT_LINES == n_lines => KEPT_LINES,
        _ => 1,
    }
}

/// How captions are set.
pub(super) fn caption_style() -> Style {
    Style { size_pt: CAPTION_PT, ink: Ink::Muted, is_bold: false, left_pt: MARGIN_PT }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{Axis, Figure};
    use crate::report::{Language, Paper, Picture, PictureContent, Section, Table};
    use impactlab_core::units::{Quantity, UnitSystem};

    fn document(paper: Paper, blocks: Vec<Block>) -> ReportDocument {
        ReportDocument {
            title: "x".repeat(300),
            case: "a case".to_owned(),
            date: "2026-11-24".to_owned(),
            date_iso: "2026-11-24".to_owned(),
            day: (2026, 11, 24),
            language: Language::En,
            units: UnitSystem::Si,
            paper,
            program: "0".to_owned(),
            sections: vec![Section {
                kind: SectionKind::Answers,
                title: "Section".to_owned(),
                blocks,
            }],
        }
    }

    #[test]
    fn nothing_stands_beyond_the_margins_and_every_text_is_set_once() {
        let long = "word ".repeat(900) + &"y".repeat(4000);
        let row =
            |n: usize| [format!("row {n}"), long.chars().take(n * 40).collect(), String::new()];
        let rows = (0..120).map(row).collect();
        let table = Table::new("A table", ["first", "second", "third"], rows).numeric(&[0]);
        let blocks = vec![
            Block::notice(long.clone()),
            Block::List { items: vec![long.clone(), String::new()] },
            Block::Table(table),
            Block::paragraph(long.clone()),
        ];
        for paper in [Paper::A4, Paper::Letter] {
            keeps_within_margins(&document(paper, blocks.clone()));
        }
    }

    fn keeps_within_margins(document: &ReportDocument) {
        let fonts = Fonts::load().unwrap();
        let flow = Flow::from_document(document, &fonts).unwrap();
        assert!(flow.pages.len() > 20);
        let [width_pt, height_pt] = flow.size_pt;
        let mut headers = 0;
        for item in flow.pages.iter().flat_map(|page| &page.items) {
            let (left, top, right, bottom) = match item {
                Item::Text { at_pt: [x, y], size_pt, text, owner, .. } => {
                    headers += usize::from(text == "second" && owner.is_none());
                    (*x, *y - size_pt, x + size_pt * fonts.width(text), *y)
                }
                Item::Fill { rect_pt: [x, y, w, h], .. }
                | Item::Picture { rect_pt: [x, y, w, h], .. } => (*x, *y, x + w, y + h),
            };
            assert!(left >= MARGIN_PT - 0.1 && right <= width_pt - MARGIN_PT + 0.1, "{item:?}");
            assert!(top >= 50.0 && bottom <= height_pt - HIGH_MARGIN_PT + 1.0, "{item:?}");
        }
        assert!(headers > 10, "the header of the table is repeated {headers} times");
    }

    /// The last line of a paragraph stood alone at the top of a page, and the first one at the foot.
    #[test]
    fn no_line_of_a_text_stands_alone_on_a_page() {
        const WORD: &str = "wordofaline";
        let fonts = Fonts::load().unwrap();
        let n_lines = |page: &PageItems| {
            let is_line =
                |item: &&Item| matches!(item, Item::Text { text, .. } if text.starts_with(WORD));
            page.items.iter().filter(is_line).count()
        };
        let is_point =
            |item: &Item| matches!(item, Item::Fill { rect_pt: [_, _, w, _], .. } if *w == 2.5);
        for (n_above, n_words) in (33..41).flat_map(|n| [9, 16, 23, 30].map(|of| (n, of))) {
            let text = vec![WORD; n_words].join(" ");
            for block in [
                Block::paragraph(text.clone()),
                Block::notice(text.clone()),
                Block::List { items: vec![text] },
            ] {
                let is_list = matches!(block, Block::List { .. });
                let mut blocks = vec![Block::paragraph("above"); n_above];
                blocks.push(block);
                let document =
                    ReportDocument { title: "short".to_owned(), ..document(Paper::A4, blocks) };
                let flow = Flow::from_document(&document, &fonts).unwrap();
                let parts: Vec<usize> = flow.pages.iter().map(n_lines).filter(|n| *n > 0).collect();
                let is_kept = parts.len() == 1 || parts.iter().all(|n| *n >= KEPT_LINES);
                assert!(is_kept, "{n_above} above, {n_words} words: {parts:?} lines");
                let first = flow.pages.iter().find(|page| n_lines(page) > 0).unwrap();
                assert_eq!(first.items.iter().any(is_point), is_list, "{n_above}, {n_words}");
            }
        }
    }

    /// The place for a signature stood alone on the second page of an opinion.
    #[test]
    fn a_signature_stands_on_the_page_of_what_is_signed() {
        let fonts = Fonts::load().unwrap();
        for n_lines in 20..60 {
            let mut blocks: Vec<Block> = (0..n_lines).map(|_| Block::paragraph("line")).collect();
            blocks.push(Block::heading(2, "Expert"));
            blocks.push(Block::List { items: vec!["name".to_owned(), "instruction".to_owned()] });
            blocks.push(Block::paragraph("Place, date, signature"));
            let document = document(Paper::A4, blocks);
            let flow = Flow::from_document(&document, &fonts).unwrap();
            let page_of = |wanted: &str| {
                flow.pages.iter().position(|page| {
                    let is_it =
                        |item: &Item| matches!(item, Item::Text { text, .. } if text == wanted);
                    page.items.iter().any(is_it)
                })
            };
            let pages = ["Expert", "name", "Place, date, signature"].map(page_of);
            assert!(
                pages[0].is_some() && pages.iter().all(|page| *page == pages[0]),
                "{n_lines}: {pages:?}"
            );
        }
    }

    /// The last row of a table stood alone on the next page.
    #[test]
    fn no_table_is_divided_after_fewer_than_four_rows_or_before_fewer_than_three() {
        let fonts = Fonts::load().unwrap();
        let papers = [Paper::A4, Paper::Letter];
        let all = (30..60).flat_map(|n| [(n, 9), (n, 6)]);
        for (paper, (n_lines, n_all)) in
            papers.into_iter().flat_map(|of| all.clone().map(move |n| (of, n)))
        {
            let mut blocks = vec![Block::paragraph("above"); n_lines];
            let rows = (0..n_all).map(|n| [format!("row {n}"), "a value".to_owned()]).collect();
            blocks.push(Block::Table(Table::new("A table", ["name", "value"], rows)));
            let document = document(paper, blocks);
            let flow = Flow::from_document(&document, &fonts).unwrap();
            let n_rows = |page: &PageItems| {
                let is_row = |item: &&Item| matches!(item, Item::Text { text, .. } if text.starts_with("row "));
                page.items.iter().filter(is_row).count()
            };
            let parts: Vec<usize> = flow.pages.iter().map(n_rows).filter(|n| *n > 0).collect();
            let is_kept = match parts[..] {
                [all] => all == n_all,
                [first, last] => n_all > 6 && first >= 4 && last >= 3,
                _ => false,
            };
            assert!(is_kept, "{paper:?}, {n_lines} lines above: {parts:?} rows");
        }
    }

    #[test]
    fn eight_plots_fit_onto_a_page_two_beside_each_other() {
        let fonts = Fonts::load().unwrap();
        let axis = Axis::shown("x", Quantity::Time, UnitSystem::Si);
        let figure = Figure::new("plot", [axis.clone(), axis], Vec::new());
        let plot = |number: usize| {
            Block::Picture(Box::new(Picture {
                number,
                caption: format!("Figure {number}: a caption"),
                alt: "a plot".to_owned(),
                content: PictureContent::Figure(Box::new(figure.clone())),
            }))
        };
        let mut document = document(Paper::A4, (0..9).map(plot).collect());
        document.title = "short".to_owned();
        let flow = Flow::from_document(&document, &fonts).unwrap();
        let places = |page: &PageItems| -> Vec<[f32; 4]> {
            let place = |item: &Item| match item {
                Item::Picture { rect_pt, .. } => Some(*rect_pt),
                _ => None,
            };
            page.items.iter().filter_map(place).collect()
        };
        let first = places(&flow.pages[0]);
        assert_eq!((first.len(), places(&flow.pages[1]).len()), (8, 1));
        for pair in first.chunks(2) {
            let [left, right] = [pair[0], pair[1]];
            assert_eq!(left[1], right[1]);
            assert!(left[0] + left[2] < right[0], "{left:?} {right:?}");
        }
    }
}
