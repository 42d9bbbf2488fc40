//! The facts of an answer as grids that can be copied.

use egui::{Grid, Label, ScrollArea, Ui};

use crate::app::looks::{self, Icon};
use crate::app::widgets::value_ui;
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_draw::theme;
use impactlab_study::facts::{FactTable, FactWriter, TextRow, TextTable};

/// Largest width of the names, points: a longer name goes on in the next line.
const NAME_WIDTH: f32 = 150.0;

/// Draws tables of facts below each other, with a button that copies them to the clipboard, separated
/// by tabs.
///
/// - `name`: the case or scenario to which they belong; it tells the tables of a pane apart and is the
///   first cell of what is copied.
pub fn facts_ui(ui: &mut Ui, name: &str, tables: &[FactTable], units: UnitSystem) {
    let tables: Vec<TextTable> =
        tables.iter().map(|table| table.to_text(&FactWriter::english(units))).collect();
    for (idx, table) in tables.iter().enumerate() {
        ui.horizontal_wrapped(|ui| {
            ui.strong(&table.title);
            let hint = "As tables for a spreadsheet, separated by tabs";
            if idx == 0 && ui.small_button("Copy table").on_hover_text(hint).clicked() {
                ui.ctx().copy_text(copied(name, &tables));
            }
        });
        ScrollArea::horizontal()
            .id_salt(("facts", name, idx))
            .show(ui, |ui| table_ui(ui, (name, idx), table));
    }
}

fn table_ui(ui: &mut Ui, id: (&str, usize), table: &TextTable) {
    Grid::new(("facts", id)).striped(true).num_columns(table.header.len()).show(ui, |ui| {
        if !table.is_list() {
            for (title, hint) in table.header.iter().zip(&table.header_hints) {
                let title = ui.strong(title);
                hint.map(|hint| title.on_hover_text(hint));
            }
            ui.end_row();
        }
        for row in &table.rows {
            row_ui(ui, row);
            ui.end_row();
        }
    });
}

fn row_ui(ui: &mut Ui, row: &TextRow) {
    let last = row.cells.len().saturating_sub(1);
    for (idx, cell) in row.cells.iter().enumerate() {
        match idx {
            0 => {
                ui.vertical(|ui| {
                    ui.set_max_width(NAME_WIDTH);
                    let name = ui.add(Label::new(cell).wrap());
                    row.hint.map(|hint| name.on_hover_text(hint));
                });
            }
            idx if idx == last && row.is_warning => {
                let color = theme::severity_color(Severity::Warning, ui.visuals().dark_mode);
                ui.horizontal(|ui| {
                    looks::icon_ui(ui, Icon::TriangleAlert, color);
                    ui.colored_label(color, cell);
                });
            }
            _ => value_ui(ui, cell),
        }
    }
}

/// The tables as tab-separated text, one after the other.
fn copied(name: &str, tables: &[TextTable]) -> String {
    let lines = tables.iter().flat_map(|table| {
        let mut header = table.header.clone();
        if let Some(first) = header.first_mut() {
            *first = table.title.clone();
        }
        std::iter::once(header).chain(table.rows.iter().map(|row| row.cells.clone()))
    });
    let lines = lines.map(|cells| cells.join("\t"));
    std::iter::once(name.to_owned()).chain(lines).collect::<Vec<String>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_copied_tables_have_a_row_a_fact() {
        let row = |cells: [&str; 2]| TextRow {
            cells: cells.map(str::to_owned).to_vec(),
            hint: None,
            is_warning: false,
        };
        let table = TextTable {
            title: "Force".to_owned(),
            header: ["quantity", "median"].map(str::to_owned).to_vec(),
            header_hints: vec![None, None],
            rows: vec![row(["peak", "162 kN"]), row(["duration", "0.08 s"])],
        };
        assert_eq!(copied("c001", &[table]), "c001\nForce\tmedian\npeak\t162 kN\nduration\t0.08 s");
    }
}
