//! A table of the report on the screen.

use std::sync::Arc;

use egui::text::LayoutJob;
use egui::{
    Align, Galley, Label, Layout, Rect, RichText, Sense, Stroke, TextStyle, Ui, UiBuilder, Vec2,
    pos2, vec2,
};

use impactlab_document::report::{Table, column_widths};

/// Room beside and above the text of a cell, points.
const PADDING: Vec2 = vec2(5.0, 3.0);
/// The widest that a single word makes a column, as a share of the table.
const WIDEST_WORD: f32 = 0.35;

/// Draws a table over the width that there is; its cells can be selected and copied.
///
/// - `id`: section and number of the block, unlike those of any other table.
pub(super) fn table_ui(ui: &mut Ui, table: &Table, id: (&str, usize)) {
    ui.add(Label::new(RichText::new(&table.caption).italics()).wrap());
    let widths = widths(ui, table);
    let titles: Vec<String> = table.columns.iter().map(|column| column.title.clone()).collect();
    ui.push_id(id, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        row_ui(ui, table, &widths, &titles, true);
        for row in &table.rows {
            row_ui(ui, table, &widths, row, false);
        }
    });
}

/// Width of each column, points.
fn widths(ui: &Ui, table: &Table) -> Vec<f32> {
    let width = ui.available_width();
    let texts = |idx: usize| {
        let cells = table.rows.iter().filter_map(move |row| row.get(idx));
        cells.chain(table.columns.get(idx).map(|column| &column.title))
    };
    let padded = |width: f32| width.ceil() + 2.0 * PADDING.x + 1.0;
    let line = |text: &str| galley(ui, text, f32::INFINITY).size().x;
    let columns = 0..table.columns.len();
    let whole = |idx| texts(idx).map(|text| line(text)).fold(8.0, f32::max);
    let wanted: Vec<f32> = columns.clone().map(|idx| padded(whole(idx))).collect();
    let word = |text: &String| text.split_whitespace().map(line).fold(8.0, f32::max);
    let least: Vec<f32> = columns
        .map(|idx| padded(texts(idx).map(word).fold(8.0, f32::max)).min(WIDEST_WORD * width))
        .collect();
    column_widths(&wanted, &least, width)
}

/// The lines of a text within a width. egui keeps them from frame to frame.
fn galley(ui: &Ui, text: &str, width: f32) -> Arc<Galley> {
    let font = TextStyle::Body.resolve(ui.style());
    let job = LayoutJob::simple(text.to_owned(), font, ui.visuals().text_color(), width);
    ui.fonts_mut(|fonts| fonts.layout_job(job))
}

fn row_ui(ui: &mut Ui, table: &Table, widths: &[f32], cells: &[String], is_header: bool) {
    let high = |(text, width): (&String, &f32)| {
        galley(ui, text, (width - 2.0 * PADDING.x).max(1.0)).size().y
    };
    let height = cells.iter().zip(widths).map(high).fold(0.0, f32::max);
    let size = vec2(ui.available_width(), height + 2.0 * PADDING.y);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let line = Stroke::new(if is_header { 1.0 } else { 0.5 }, ui.visuals().weak_text_color());
    ui.painter().hline(rect.x_range(), rect.bottom(), line);
    if !ui.is_rect_visible(rect) {
        return;
    }
    let mut left = rect.left();
    for ((text, width), column) in cells.iter().zip(widths).zip(&table.columns) {
        let cell = Rect::from_min_size(
            pos2(left, rect.top()) + PADDING,
            vec2((width - 2.0 * PADDING.x).max(1.0), height),
        );
        let align = if column.is_numeric { Align::RIGHT } else { Align::LEFT };
        let place = UiBuilder::new().max_rect(cell).layout(Layout::top_down(align));
        let text = RichText::new(text);
        let text = if is_header { text.strong() } else { text };
        // A child of its own: what follows the row begins below its rectangle, not below the last cell.
        ui.new_child(place).add(Label::new(text).wrap());
        left += width;
    }
}
