//! Tables that go over pages: the header is repeated, and a row that is higher than the room that is
//! left is divided where a page of its own would be wasted.

use crate::report::Table;
use crate::report::write::pdf::flow::{Flow, LEADING, MARGIN_PT, Role, Style, caption_style};
use crate::report::write::pdf::fonts::Fonts;
use crate::report::write::pdf::lines::lines;
use crate::report::write::pdf::page::{Ink, Item, Owner};
use crate::report::write::pdf::units::with_units_in_titles;
use crate::report::write::pdf::widths::{CellStyle, fits_words, widths_of};

/// Size of the text in a table, points, and smaller ones for tables whose words are wider than its columns.
const CELL_PT: [f32; 4] = [9.5, 8.5, 7.5, 6.5];
/// Distance between its base lines over its size.
const STEP: f32 = 1.2;
/// Distance of the text from the sides of its cell, points.
const PADDING_PT: f32 = 3.5;
/// The same above and below.
const HIGH_PADDING_PT: f32 = 1.1;
/// Rows that a table has at the least before it goes on on the next page.
const KEPT_ROWS: usize = 4;
/// Rows that it has at the least there; with fewer than both it is not divided.
const LAST_ROWS: usize = 3;

/// A table that is being set.
struct Setting<'a> {
    table: &'a Table,
    /// Size of the text, points.
    size_pt: f32,
    /// Left edge and width of each column, points.
    columns: Vec<[f32; 2]>,
    owner: Owner,
}

/// Lines of the cells of a row.
type Cells = Vec<Vec<String>>;

/// Height of what of a table stands on one page: caption, header and the first rows.
pub(super) fn beginning_pt(flow: &Flow<'_>, table: &Table) -> f32 {
    let table = &with_units_in_titles(table);
    Setting::new(table, flow).beginning_pt(flow)
}

/// Sets a table.
pub(super) fn flow_table(flow: &mut Flow<'_>, table: &Table) {
    if table.columns.is_empty() {
        return;
    }
    let table = &with_units_in_titles(table);
    let setting = Setting::new(table, flow);
    let header = setting.header_cells(flow.fonts);
    let together_pt = setting.beginning_pt(flow);
    flow.need(together_pt);
    let summary = table.caption.clone();
    let owner = flow.part(Role::Table { summary }, None);
    let setting = Setting { owner, ..setting };
    if !table.caption.is_empty() {
        let caption = flow.part(Role::Caption, owner);
        flow.text(&table.caption, Style { is_bold: true, ..caption_style() }, caption);
        flow.y_pt += 1.5;
    }
    setting.header(flow, &header, true);
    let first_of_last = table.rows.len().saturating_sub(LAST_ROWS);
    for (idx, row) in table.rows.iter().enumerate() {
        if idx > 0 && idx == first_of_last {
            setting.keep_last(flow, &header);
        }
        setting.row(flow, row, &header);
    }
}

impl<'a> Setting<'a> {
    /// The largest text of which no word is broken.
    fn new(table: &'a Table, flow: &Flow<'_>) -> Self {
        let (fonts, width_pt) = (flow.fonts, flow.width_pt());
        let style = |size_pt| CellStyle { size_pt, padding_pt: PADDING_PT };
        let [.., least_pt] = CELL_PT;
        let fits = |size_pt: &f32| fits_words(table, style(*size_pt), fonts, width_pt);
        let size_pt = CELL_PT.into_iter().find(fits).unwrap_or(least_pt);
        let mut left_pt = MARGIN_PT;
        let place = |width: f32| {
            let column = [left_pt, width];
            left_pt += width;
            column
        };
        let widths = widths_of(table, style(size_pt), fonts, width_pt);
        let columns = widths.into_iter().map(place).collect();
        Self { table, size_pt, columns, owner: None }
    }

    /// Distance between base lines, points.
    fn step_pt(&self) -> f32 {
        STEP * self.size_pt
    }

    fn height_pt(&self, cells: &Cells) -> f32 {
        let n = cells.iter().map(Vec::len).max().unwrap_or(0);
        n as f32 * self.step_pt() + 2.0 * HIGH_PADDING_PT
    }

    fn cells(&self, row: &[String], fonts: &Fonts) -> Cells {
        let cells = row.iter().zip(&self.columns);
        cells
            .map(|(cell, [_, width])| lines(cell, fonts, self.size_pt, width - 2.0 * PADDING_PT))
            .collect()
    }

    fn header_cells(&self, fonts: &Fonts) -> Cells {
        let titles: Vec<String> = self.table.columns.iter().map(|it| it.title.clone()).collect();
        self.cells(&titles, fonts)
    }

    fn beginning_pt(&self, flow: &Flow<'_>) -> f32 {
        let n_rows = self.table.rows.len();
        let n_kept = if n_rows < KEPT_ROWS + LAST_ROWS { n_rows } else { KEPT_ROWS };
        let rows = self.table.rows.iter().take(n_kept);
        let rows_pt: f32 = rows.map(|row| self.height_pt(&self.cells(row, flow.fonts))).sum();
        let caption_pt = match self.table.caption.is_empty() {
            true => 0.0,
            false => 2.0 * caption_style().size_pt * LEADING,
        };
        let header_pt = self.height_pt(&self.header_cells(flow.fonts));
        caption_pt + header_pt + rows_pt.min(0.5 * flow.page_pt())
    }

    /// The titles of the columns; told to readers once.
    fn header(&self, flow: &mut Flow<'_>, cells: &Cells, is_first: bool) {
        let height_pt = self.height_pt(cells);
        let rect_pt = [MARGIN_PT, flow.y_pt, flow.width_pt(), height_pt];
        flow.push(Item::Fill { rect_pt, ink: Ink::Shade });
        let row = if is_first { flow.part(Role::Row, self.owner) } else { None };
        let owners: Vec<Owner> = cells
            .iter()
            .map(|_| if is_first { flow.part(Role::HeaderCell, row) } else { None })
            .collect();
        let all = cells.iter().map(Vec::len).max().unwrap_or(0);
        self.slice(flow, cells, &owners, 0, all, true);
    }

    /// Goes on with a new page where the last rows do not all fit, so that none of them stands alone.
    fn keep_last(&self, flow: &mut Flow<'_>, header: &Cells) {
        let last = self.table.rows.iter().rev().take(LAST_ROWS);
        let last_pt: f32 = last.map(|row| self.height_pt(&self.cells(row, flow.fonts))).sum();
        if flow.room_pt() < last_pt && last_pt < 0.4 * flow.page_pt() {
            flow.new_page();
            self.header(flow, header, false);
        }
    }

    fn row(&self, flow: &mut Flow<'_>, row: &[String], header: &Cells) {
        let cells = self.cells(row, flow.fonts);
        let n = cells.iter().map(Vec::len).max().unwrap_or(0);
        let owner = flow.part(Role::Row, self.owner);
        // The first cell says what its row is about.
        let role =
            |idx: usize| if idx == 0 && cells.len() > 1 { Role::RowHeaderCell } else { Role::Cell };
        let owners: Vec<Owner> = (0..cells.len()).map(|idx| flow.part(role(idx), owner)).collect();
        let mut done = 0;
        while done < n {
            let room = (flow.room_pt() - 2.0 * HIGH_PADDING_PT) / self.step_pt();
            let fits = room.max(0.0) as usize;
            let left = n - done;
            // A row that fits onto a page is not divided.
            let is_small = left as f32 * self.step_pt() < 0.4 * flow.page_pt();
            if fits < left && (is_small || fits < 3) {
                flow.new_page();
                self.header(flow, header, false);
                let room = (flow.room_pt() - 2.0 * HIGH_PADDING_PT) / self.step_pt();
                if room < 1.0 {
                    return; // A page that does not hold a line holds no table.
                }
                continue;
            }
            let take = left.min(fits);
            self.slice(flow, &cells, &owners, done, take, false);
            done += take;
        }
    }

    /// Some lines of all cells of a row, and the rule below them.
    fn slice(
        &self,
        flow: &mut Flow<'_>,
        cells: &Cells,
        owners: &[Owner],
        from: usize,
        n: usize,
        is_bold: bool,
    ) {
        let top_pt = flow.y_pt;
        let ink = if is_bold { Ink::Heading } else { Ink::Text };
        for (idx, (cell, [left_pt, width_pt])) in cells.iter().zip(&self.columns).enumerate() {
            let is_numeric = self.table.columns.get(idx).is_some_and(|column| column.is_numeric);
            let owner = owners.get(idx).copied().flatten();
            for (row, line) in cell.iter().skip(from).take(n).enumerate() {
                let text_pt = self.size_pt * flow.fonts.width(line);
                let free_pt = (width_pt - 2.0 * PADDING_PT - text_pt).max(0.0);
                let indent_pt = if is_numeric { free_pt } else { 0.0 };
                // A cell without text would be missing in its row.
                let line = if line.is_empty() { " " } else { line };
                flow.y_pt = top_pt + HIGH_PADDING_PT + row as f32 * self.step_pt();
                let style = Style {
                    size_pt: self.size_pt,
                    ink,
                    is_bold,
                    left_pt: left_pt + PADDING_PT + indent_pt,
                };
                flow.line(line, style, owner);
            }
        }
        flow.y_pt = top_pt + n as f32 * self.step_pt() + 2.0 * HIGH_PADDING_PT;
        let rect_pt = [MARGIN_PT, flow.y_pt - 0.5, flow.width_pt(), 0.5];
        flow.push(Item::Fill { rect_pt, ink: Ink::Rule });
    }
}
