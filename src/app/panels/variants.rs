//! The “Variants” pane: the answers of all variants of the case in one table.

use egui::{Button, Grid, Id, Label, RichText, ScrollArea, TextEdit, Ui};

use crate::app::case::VariantCommand;
use crate::app::command::Command;
use crate::app::panes::PaneContext;
use crate::app::variants::AnsweredVariant;
use crate::app::widgets::{OUTDATED_TABLE, severity_color};
use impactlab_core::data::Severity;
use impactlab_core::units::{Estimate, NumberFormat, Quantity, UnitSystem};
use impactlab_study::analysis::MotionOutcome;
use impactlab_study::facts::{FactWriter, Term};

/// The columns of the table.
const COLUMNS: [&str; 11] = [
    "Variant",
    "What differs",
    "Turn of 90° or more",
    "Forecast: X (90 %)",
    "Forecast: Y (90 %)",
    "Heading (90 %)",
    "Warnings",
    "Δv with tires",
    "4DOF: X, Y at the end",
    "4DOF: at rest after",
    "Notes",
];
/// What the columns are, as the hint of their headings.
const MEANING: &str = "What differs: from the first variant. Turn of 90° or more: how probable it is at the end of \
    the forecast. Δv: of the 4DOF model over the contact, with what the tires add (the momentum \
    solution alone stands in the Scenario panel). 4DOF: without an interval. Forecast: median and \
    interval of 90 % where the car is at the end.";
/// What stands where a variant has no such figure.
const NONE: &str = "–";
/// Differences that are named; the others are told on hover.
const MOST_NAMED: usize = 4;
/// Width of texts in the table, points.
const TEXT_WIDTH: f32 = 170.0;
/// Between columns and between rows of the table, points.
const COLUMN_SPACING: [f32; 2] = [16.0, 4.0];

/// Draws the table, in which a click on the name of a variant shows it.
pub fn variants_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, variants, commands, .. } = pane;
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut view.shows_all_variants, "Show all variants in plots and tables");
        let rows: Vec<_> = variants.iter().map(|variant| cells(variant, view.units)).collect();
        let is_current = !variants.iter().any(|variant| variant.is_waiting);
        let copy = ui.add_enabled(is_current, Button::new("Copy table"));
        let copy = copy.on_hover_text("Tab-separated, for a spreadsheet");
        if copy.on_disabled_hover_text(OUTDATED_TABLE).clicked() {
            let line = |row: &[String; 11]| row.join("\t").replace('\n', " ");
            let lines: Vec<_> = rows.iter().map(line).collect();
            ui.ctx().copy_text(format!("{}\n{}\n", COLUMNS.join("\t"), lines.join("\n")));
        }
    });
    if variants.len() < 2 {
        ui.weak("This case has one variant. Copy in the bar above makes another, to be changed.");
    }
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        let grid = Grid::new("variants").num_columns(COLUMNS.len()).striped(true);
        grid.spacing(COLUMN_SPACING).show(ui, |ui| {
            let titles = COLUMNS.map(|column| ui.strong(column).on_hover_text(MEANING).id);
            ui.end_row();
            let [.., notes] = titles;
            for variant in variants.iter() {
                row_ui(ui, variant, view.units, notes, commands);
            }
        });
    });
}

/// Draws a variant.
///
/// - `title`: of the column of notes.
fn row_ui(
    ui: &mut Ui,
    variant: &AnsweredVariant,
    units: UnitSystem,
    title: Id,
    commands: &mut Vec<Command>,
) {
    let name = ui.selectable_label(variant.is_shown, &variant.name);
    if name.on_hover_text("Show it in the forms").clicked() && !variant.is_shown {
        commands.push(Command::Variant(VariantCommand::Show(variant.name.clone())));
    }
    let [_, differs, turn, x, y, heading, warnings, delta_v, end, rest, _] = cells(variant, units);
    ui.vertical(|ui| {
        ui.set_max_width(TEXT_WIDTH);
        let all = variant.differs.as_deref().unwrap_or_default();
        let text = ui.add(Label::new(differs).wrap());
        if all.len() > MOST_NAMED {
            text.on_hover_text(all.join("\n"));
        }
    });
    let show = |ui: &mut Ui, cells: &[String]| {
        for cell in cells {
            let text = RichText::new(cell).monospace();
            ui.label(if variant.is_waiting { text.weak() } else { text });
        }
    };
    if let Some(problem) = &variant.problem {
        let color = severity_color(ui, Severity::Error);
        ui.colored_label(color, "not computed").on_hover_text(problem);
        // All columns but those of the name, what differs, the problem and the notes.
        (0..COLUMNS.len() - 4).for_each(|_| drop(ui.label("")));
    } else {
        show(ui, &[turn, x, y, heading]);
        let texts = warning_texts(variant, units);
        let warning = severity_color(ui, Severity::Warning);
        match texts.is_empty() {
            true => ui.label(warnings),
            false => ui.colored_label(warning, warnings).on_hover_text(texts.join("\n")),
        };
        show(ui, &[delta_v, end, rest]);
    }
    let mut notes = variant.notes.clone();
    let field = TextEdit::multiline(&mut notes).id_salt(("variant notes", &variant.name));
    let field = field.desired_rows(1).desired_width(TEXT_WIDTH);
    if ui.add(field).labelled_by(title).changed() {
        let name = variant.name.clone();
        commands.push(Command::Variant(VariantCommand::Note { name, notes }));
    }
    ui.end_row();
}

/// What a variant asks otherwise than the first one.
fn differs(variant: &AnsweredVariant) -> String {
    let Some(all) = &variant.differs else { return "the first one".to_owned() };
    match all.len() {
        0 => "nothing".to_owned(),
        n if n > MOST_NAMED => {
            format!("{}; and {} more", all[..MOST_NAMED].join("; "), n - MOST_NAMED)
        }
        _ => all.join("; "),
    }
}

/// What the table shows of a variant.
fn cells(variant: &AnsweredVariant, units: UnitSystem) -> [String; 11] {
    let report = variant.simulation.as_ref().map(|answer| &answer.report);
    let forecast = variant.forecast.as_ref().map(|answer| &answer.answer.report);
    let of = |text: Option<String>| match text {
        Some(text) => text,
        None if variant.is_waiting => "computing…".to_owned(),
        None => NONE.to_owned(),
    };
    let delta_v = report.and_then(|report| report.delta_v_magnitude_m_s);
    let end = report.and_then(|report| report.end);
    let rest = report.and_then(|report| report.rest.as_ref());
    let format = NumberFormat::english(units);
    let spread = |quantity: Quantity, of: fn(&MotionOutcome) -> &Estimate| {
        forecast.map(|report| format.drawn_in_words(quantity, of(&report.outcome)))
    };
    let turn = forecast.and_then(|report| {
        report.answer_table().value_text(Term::QuarterTurn, &FactWriter::english(units))
    });
    [
        variant.name.clone(),
        differs(variant),
        of(turn),
        of(spread(Quantity::Length, |outcome| &outcome.x_m)),
        of(spread(Quantity::Length, |outcome| &outcome.y_m)),
        of(spread(Quantity::Angle, |outcome| &outcome.heading_change_rad)),
        match warning_texts(variant, units).len() {
            0 => NONE.to_owned(),
            n => n.to_string(),
        },
        of(delta_v.map(|m_s| format.rough(Quantity::Speed, m_s))),
        of(end.map(|end| format.rough_vector(Quantity::Length, [end.x_m, end.y_m], ["x", "y"]))),
        of(rest.map(|rest| format.rough(Quantity::Time, rest.time_s))),
        variant.notes.clone(),
    ]
}

/// What restricts the answers of a variant, a sentence each.
fn warning_texts(variant: &AnsweredVariant, units: UnitSystem) -> Vec<String> {
    let simulated = variant.simulation.iter().flat_map(|answer| &answer.report.caveats);
    let forecast = variant.forecast.iter().flat_map(|answer| &answer.answer.report.caveats);
    let mut texts: Vec<String> = Vec::new();
    for caveat in simulated.chain(forecast).filter(|caveat| caveat.is_warning()) {
        let text = format!("{}: {}", caveat.kind.label(), caveat.in_units(units).text);
        if !texts.contains(&text) {
            texts.push(text);
        }
    }
    texts
}
