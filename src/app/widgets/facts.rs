//! The facts of an answer as grids that can be copied.

use egui::{Button, Grid, Label, ScrollArea, Ui};

use crate::app::widgets::{notice_in_row_ui, value_ui};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_study::facts::{FactTable, FactWriter, TextRow, TextTable};

/// Largest width of the names, points: a longer name goes on in the next line.
const NAME_WIDTH: f32 = 150.0;

/// Width that a value takes beside others, points.
const VALUE_WIDTH: f32 = 150.0;

/// What is said of a table that cannot be copied.
pub const OUTDATED_TABLE: &str = "This table is not the answer to what is asked now: it can be copied as soon as that is computed";

/// Draws tables of facts below each other, with a button that copies them to the clipboard, separated
/// by tabs. Those of an answer that is greyed, which is not of what is asked any more, cannot be copied.
///
/// - `name`: the case or scenario to which they belong; it tells the tables of a pane apart and is the
///   first cell of what is copied.
pub fn facts_ui(ui: &mut Ui, name: &str, tables: &[FactTable], units: UnitSystem) {
    let tables = texts(tables, units);
    for (idx, table) in tables.iter().enumerate() {
        ui.horizontal_wrapped(|ui| {
            ui.strong(&table.title);
            if idx > 0 {
                return;
            }
            let hint = "As tables for a spreadsheet, separated by tabs";
            let is_current = ui.opacity() >= 1.0;
            let copy = ui.add_enabled(is_current, Button::new("Copy table").small());
            let copy = copy.on_hover_text(hint).on_disabled_hover_text(OUTDATED_TABLE);
            if copy.clicked() {
                ui.ctx().copy_text(copied(name, &tables));
            }
        });
        let is_stacked = table.header.len() > 2 && ui.available_width() < width_beside(table);
        ScrollArea::horizontal()
            .id_salt(("facts", name, idx))
            .show(ui, |ui| table_ui(ui, (name, idx), table, is_stacked));
    }
}

/// Draws a table of questions and their answers in sentences, each answer below its question.
pub fn sentences_ui(ui: &mut Ui, table: &FactTable, units: UnitSystem) {
    for row in table.to_text(&FactWriter::english(units)).rows {
        let mut cells = row.cells.into_iter();
        cells.next().map(|question| ui.strong(question));
        cells.next().map(|sentence| ui.add(Label::new(sentence).wrap()));
    }
}

/// Tables of facts as text, separated by tabs.
///
/// - `name`: what they belong to, in the first cell.
pub fn facts_text(name: &str, tables: &[FactTable], units: UnitSystem) -> String {
    copied(name, &texts(tables, units))
}

fn texts(tables: &[FactTable], units: UnitSystem) -> Vec<TextTable> {
    tables.iter().map(|table| table.to_text(&FactWriter::english(units))).collect()
}

/// The width that a table needs with its values beside each other, points.
fn width_beside(table: &TextTable) -> f32 {
    NAME_WIDTH + VALUE_WIDTH * (table.header.len() - 1) as f32
}

/// - `is_stacked`: the values of a row stand below each other, so that a narrow pane cuts off no
///   interval.
fn table_ui(ui: &mut Ui, id: (&str, usize), table: &TextTable, is_stacked: bool) {
    let n_columns = if is_stacked { 2 } else { table.header.len() };
    Grid::new(("facts", id)).striped(true).num_columns(n_columns).show(ui, |ui| {
        if !table.is_list() {
            let titles = table.header.iter().zip(&table.header_hints).take(n_columns);
            for (title, hint) in titles {
                let title = ui.strong(title);
                hint.map(|hint| title.on_hover_text(hint));
            }
            ui.end_row();
        }
        for row in &table.rows {
            name_ui(ui, row);
            let values = row.cells.iter().enumerate().skip(1);
            if is_stacked {
                ui.vertical(|ui| {
                    for (idx, _) in values.filter(|(idx, cell)| *idx == 1 || !cell.is_empty()) {
                        let title = (idx > 1).then(|| table.header[idx].as_str());
                        ui.horizontal(|ui| {
                            title.map(|title| ui.weak(title));
                            cell_ui(ui, row, idx);
                        });
                    }
                });
            } else {
                values.for_each(|(idx, _)| cell_ui(ui, row, idx));
            }
            ui.end_row();
        }
    });
}

fn name_ui(ui: &mut Ui, row: &TextRow) {
    ui.vertical(|ui| {
        ui.set_max_width(NAME_WIDTH);
        let name = ui.add(Label::new(row.cells.first().map_or("", String::as_str)).wrap());
        row.hint.map(|hint| name.on_hover_text(hint));
    });
}

/// A value of a row; the last one of a row to be looked at has the sign of a warning.
fn cell_ui(ui: &mut Ui, row: &TextRow, idx: usize) {
    let cell = row.cells.get(idx).map_or("", String::as_str);
    if row.is_warning && idx + 1 == row.cells.len() {
        ui.horizontal(|ui| notice_in_row_ui(ui, Severity::Warning, cell));
    } else {
        value_ui(ui, cell);
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
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT, Queryable};

    use super::*;
    use impactlab_study::facts::{Fact, Term, Value};

    /// The table of a greyed answer was copied without a mark, though no figure of it could be saved.
    #[test]
    fn a_table_that_is_not_of_what_is_asked_cannot_be_copied() {
        let text = |text: &str| Value::English(text.to_owned());
        let table = FactTable {
            title: text("Force"),
            rows: text("quantity"),
            columns: vec![text("value")],
            levels: &[],
            facts: vec![Fact::text(Term::Origin, "shipped")],
        };
        for (opacity, is_disabled) in [(1.0, false), (0.35, true)] {
            let tables = [table.clone(), table.clone()];
            let harness = Harness::new_ui(move |ui| {
                ui.multiply_opacity(opacity);
                facts_ui(ui, "c001", &tables, UnitSystem::Si);
            });
            let copy = harness.get_by_label("Copy table");
            assert_eq!(copy.accesskit_node().is_disabled(), is_disabled);
        }
    }

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
