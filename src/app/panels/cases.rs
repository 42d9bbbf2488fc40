//! The “Cases” pane: a table of the cases of the listed data set, which can be filtered and sorted.

use egui::{RichText, Sense, Ui};
use egui_extras::{Column, TableBuilder, TableRow};

use crate::app::case_row::{CaseColumn, CaseRow};
use crate::app::case_table::{CaseTable, listed_in};
use crate::app::command::Command;
use crate::app::panes::PaneContext;
use crate::app::state::{Subject, View};
use crate::app::widgets::{empty_ui, notice_ui, severity_color};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;

/// Height of a row of the table, points.
const ROW_HEIGHT: f32 = 20.0;
/// Examples of filters, shown while the filter field is empty.
const FILTER_HINT: &str = "Filter: c012, hooked, spin=1, m_b_kg>2000";

/// Draws the filter, the number of cases that pass it, and the table. A click on a row selects its
/// case. The table scrolls to the selected case when the filter changes and when the plots fit
/// their view again, as they do after a selection.
pub fn cases_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    if listed_in(&session.sources, view).is_none() {
        let text = "The cases of a data set stand here, and a click on one shows it. Open a data set in the Data pane (a folder with cases.csv and forces/ or trajectories/), or click one that is open there.";
        return empty_ui(ui, "No data set is listed", text);
    }
    let before = view.filter.clone();
    filter_ui(ui, view);
    let show_selected = before != view.filter || session.fit_plots;
    let (Some(table), Some(path)) =
        (session.cases.table(&session.sources, &session.replays, view), view.listed.clone())
    else {
        return;
    };
    if let Some(error) = table.error {
        notice_ui(ui, Severity::Error, error.to_string());
        return;
    }
    let subject = project.subject();
    let hint = if subject.is_none() { ": click one to see it" } else { "" };
    let number = format!("{} of {} cases{hint}", table.len(), table.checked.dataset.cases.len());
    let selected = match &subject {
        Some(Subject::Case { dataset, case }) if *dataset == path => Some(case.as_str()),
        _ => None,
    };
    let columns = CaseColumn::for_kind(table.checked.dataset.kind);
    let table = Table { cases: table, columns, selected };
    ui.horizontal_wrapped(|ui| {
        ui.weak(number);
        let copy = ui.small_button("Copy cases");
        let hint = "The cases that are listed, in their order, separated by tabs for a spreadsheet";
        if copy.on_hover_text(hint).clicked() {
            ui.ctx().copy_text(table.text(view.units));
        }
    });
    if let Some(case) = table.ui(ui, view, show_selected) {
        commands.push(Command::Select(Subject::Case { dataset: path, case }));
    }
}

fn filter_ui(ui: &mut Ui, view: &mut View) {
    ui.horizontal(|ui| {
        let field = egui::TextEdit::singleline(&mut view.filter).hint_text(FILTER_HINT);
        let width = ui.available_width() - 30.0;
        ui.add(field.desired_width(width)).on_hover_text(
            "Words that must all hold: part of a name or flag, a column of yes and no, or a column and a value with =, !=, <, <=, > or >=, with the column names of cases.csv in SI units",
        );
        if ui.button("×").on_hover_text("Show all cases").clicked() {
            view.filter.clear();
        }
    });
}

/// What the table shows.
struct Table<'a> {
    /// The cases that pass the filter, in the order in which they are shown.
    cases: CaseTable<'a>,
    /// The columns after those of the name and the flags.
    columns: &'static [CaseColumn],
    /// Name of the selected case, if it belongs to the listed data set.
    selected: Option<&'a str>,
}

/// Width and height of the triangle beside the heading that the cases are sorted by, points.
const ARROW: f32 = 7.0;

impl Table<'_> {
    /// Draws the table and returns the name of the case that the user clicked, if any.
    ///
    /// - `show_selected`: whether the table scrolls to the selected case.
    fn ui(&self, ui: &mut Ui, view: &mut View, show_selected: bool) -> Option<String> {
        let mut picked = None;
        let units = view.units;
        egui::ScrollArea::horizontal().show(ui, |ui| {
            // A selectable label would consume the click that is meant for its row.
            ui.style_mut().interaction.selectable_labels = false;
            let mut table = TableBuilder::new(ui)
                .striped(true)
                .sense(Sense::click())
                .auto_shrink(false)
                .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
                .column(Column::initial(58.0).resizable(true))
                .column(Column::initial(84.0).resizable(true).clip(true))
                .columns(Column::initial(72.0).at_least(36.0).resizable(true), self.columns.len());
            let selected = self.selected.filter(|_| show_selected);
            if let Some(index) = selected.and_then(|name| self.cases.position(name)) {
                table = table.scroll_to_row(index, None);
            }
            let table = table.header(ROW_HEIGHT, |mut header| self.header_ui(&mut header, view));
            table.body(|body| {
                body.rows(ROW_HEIGHT, self.cases.len(), |mut row| {
                    let Some(case) = self.cases.row(row.index()) else { return };
                    row.set_selected(Some(case.name) == self.selected);
                    self.row_ui(&mut row, &case, units);
                    if row.response().clicked() {
                        picked = Some(case.name.to_owned());
                    }
                });
            });
        });
        picked
    }

    /// The table as text, separated by tabs.
    fn text(&self, units: UnitSystem) -> String {
        let titles = self.columns.iter().map(|column| column.heading(units));
        let titles = ["Case", "Flags"].map(str::to_owned).into_iter().chain(titles);
        let line = |case: CaseRow<'_>| {
            let flags: Vec<&str> = case.flags.iter().map(|flag| flag.kind.label()).collect();
            let values = self.columns.iter().map(|column| case.text(column, units));
            let cells = [case.name.to_owned(), flags.join(", ")].into_iter().chain(values);
            cells.collect::<Vec<String>>().join("\t")
        };
        let head = titles.collect::<Vec<String>>().join("\t");
        let rows = (0..self.cases.len()).filter_map(|idx| self.cases.row(idx)).map(line);
        std::iter::once(head).chain(rows).collect::<Vec<String>>().join("\n") + "\n"
    }

    fn header_ui(&self, header: &mut TableRow<'_, '_>, view: &mut View) {
        let units = view.units;
        let attributes = self.columns.iter().map(|c| (c.key, c.heading(units)));
        let fixed = [("case", "Case".to_owned()), ("flags", "Flags".to_owned())];
        for (key, title) in fixed.into_iter().chain(attributes) {
            header.col(|ui| {
                let sorted = view.sort_column.as_deref() == Some(key);
                let order = match (sorted, view.sort_descending) {
                    (false, _) => "",
                    (true, false) => ", now the smallest first",
                    (true, true) => ", now the largest first",
                };
                if sorted {
                    arrow_ui(ui, view.sort_descending);
                }
                let text = RichText::new(&title).strong();
                let label = egui::Label::new(text).sense(Sense::click()).truncate();
                if ui.add(label).on_hover_text(format!("Sort by {title}{order}")).clicked() {
                    sort_by(view, key);
                }
            });
        }
    }

    fn row_ui(&self, row: &mut TableRow<'_, '_>, case: &CaseRow<'_>, units: UnitSystem) {
        row.col(|ui| drop(ui.label(case.name)));
        row.col(|ui| {
            for flag in case.flags {
                let color = severity_color(ui, flag.severity);
                ui.colored_label(color, flag.kind.label()).on_hover_text(flag.to_string());
            }
        });
        for column in self.columns {
            row.col(|ui| drop(ui.label(case.text(column, units))));
        }
    }
}

/// Draws a triangle that points up where the smallest stands first, else down. The font has none.
fn arrow_ui(ui: &mut Ui, is_descending: bool) {
    let (area, _) = ui.allocate_exact_size(egui::vec2(ARROW, ARROW), Sense::hover());
    let corners = match is_descending {
        false => [area.left_bottom(), area.center_top(), area.right_bottom()],
        true => [area.left_top(), area.right_top(), area.center_bottom()],
    };
    let color = ui.visuals().strong_text_color();
    ui.painter().add(egui::Shape::convex_polygon(corners.to_vec(), color, egui::Stroke::NONE));
}

/// Changes the sorting after a click on the heading of a column: from unsorted to ascending, then
/// descending, then unsorted again.
fn sort_by(view: &mut View, key: &str) {
    let sorted = view.sort_column.as_deref() == Some(key);
    (view.sort_column, view.sort_descending) = match (sorted, view.sort_descending) {
        (false, _) => (Some(key.to_owned()), false),
        (true, false) => (Some(key.to_owned()), true),
        (true, true) => (None, false),
    };
}
