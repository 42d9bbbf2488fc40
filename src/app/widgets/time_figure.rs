//! A figure over time in which two cursors can be set, and what its curves do between them.

use std::collections::BTreeSet;

use egui::{Grid, Modifiers, Ui, Window};

use crate::app::command::Command;
use crate::app::widgets::figure_frame;
use impactlab_core::units::significant;
use impactlab_document::figure::{CurveStatistics, Figure, curve_statistics};
use impactlab_draw::{FigureOptions, FigureResponse};

/// The columns of the table after the name of the curve.
const COLUMNS: [&str; 6] = ["Curve", "Mean", "Lowest", "Highest", "Change", "Integral"];

/// The two cursors, and what the curves of the figures on screen do between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BetweenCursors {
    /// The times of the cursors, s; `None` if they are not set.
    pub span_s: Option<[f64; 2]>,
    /// Figures that were drawn in this frame.
    figures: Vec<Measured>,
    /// What restricts them.
    restrictions: BTreeSet<String>,
}

/// The curves of a figure between the cursors.
#[derive(Debug, Clone, PartialEq)]
struct Measured {
    quantity: String,
    /// Of ordinate and abscissa.
    units: [&'static str; 2],
    curves: Vec<CurveStatistics>,
}

/// Draws a figure over time. A drag with Shift sets the two cursors.
pub fn time_figure(
    ui: &mut Ui,
    heading: &str,
    figure: &Figure,
    options: FigureOptions,
    between: &mut BetweenCursors,
    commands: &mut Vec<Command>,
) -> FigureResponse {
    let unit = figure.x.unit;
    let span = between.span_s.map(|ends| ends.map(|time_s| unit.from_si(time_s)));
    let options = FigureOptions { span, ..options };
    let mut response = figure_frame(ui, heading, figure, &options, commands);
    if let Some(span) = span {
        let units = [figure.y.unit.symbol, unit.symbol];
        let curves = curve_statistics(figure, span);
        between.figures.push(Measured { quantity: figure.y.label.clone(), units, curves });
        between.restrictions.extend(figure.caveats.text());
    }
    let is_selecting = ui.input(|input| input.modifiers.matches_exact(Modifiers::SHIFT));
    if let Some([from, to]) = response.drag.filter(|_| is_selecting) {
        let [from, to] = [from[0].min(to[0]), from[0].max(to[0])].map(|x| unit.to_si(x));
        between.span_s = (to > from).then_some([from, to]);
        response.picked_x = None;
    }
    response
}

impl BetweenCursors {
    /// Draws the table in a window of its own, if the cursors are set, and forgets the figures of this
    /// frame.
    pub fn ui(&mut self, ui: &mut Ui) {
        let figures = std::mem::take(&mut self.figures);
        let restrictions = std::mem::take(&mut self.restrictions);
        let Some([from, to]) = self.span_s else { return };
        let mut is_open = true;
        let title = format!("Between {} and {} s", significant(from), significant(to));
        let window = Window::new(title).id(egui::Id::unique("between cursors")).open(&mut is_open);
        let beside = ui.ctx().content_rect().left_bottom() + egui::vec2(24.0, -340.0);
        window.resizable(true).default_width(420.0).default_pos(beside).show(ui.ctx(), |ui| {
            if ui.button("Copy").on_hover_text("Tab-separated, for a spreadsheet").clicked() {
                ui.ctx().copy_text(table(&figures, &restrictions));
            }
            Grid::new("between cursors").striped(true).num_columns(COLUMNS.len()).show(ui, |ui| {
                COLUMNS.iter().for_each(|column| drop(ui.strong(*column)));
                ui.end_row();
                for row in figures.iter().flat_map(rows) {
                    let [name, numbers @ ..] = row;
                    ui.label(name);
                    numbers.into_iter().for_each(|number| drop(ui.monospace(number)));
                    ui.end_row();
                }
            });
        });
        if !is_open {
            self.span_s = None;
        }
    }
}

/// The rows of one figure, each number with its unit.
fn rows(
    Measured { quantity, units: [of_y, of_x], curves }: &Measured,
) -> Vec<[String; COLUMNS.len()]> {
    let with = |value: f64, unit: &str| format!("{} {unit}", significant(value));
    let row = |curve: &CurveStatistics| {
        let CurveStatistics { name, mean, range, change, integral } = curve;
        [
            format!("{quantity}, {name}"),
            with(*mean, of_y),
            with(range[0], of_y),
            with(range[1], of_y),
            with(*change, of_y),
            with(*integral, &format!("{of_y} {of_x}")),
        ]
    };
    curves.iter().map(row).collect()
}

fn table(figures: &[Measured], restrictions: &BTreeSet<String>) -> String {
    let rows = figures.iter().flat_map(rows).map(|row| row.join("\t"));
    let restriction_lines = restrictions.iter().map(|text| format!("Restrictions\t{text}"));
    let lines: Vec<String> =
        std::iter::once(COLUMNS.join("\t")).chain(rows).chain(restriction_lines).collect();
    lines.join("\n") + "\n"
}
