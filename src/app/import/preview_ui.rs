//! Draws the right side of the import dialog: the curve as it will be read, its numbers, what is doubtful about
//! them, and buttons that correct it.

use egui::{Button, Grid, Ui};

use crate::app::import::dialog::ImportDialog;
use crate::app::widgets::{notice_ui, value_row};
use impactlab_core::data::{Correction, FileKind, Severity};
use impactlab_draw::{FigureOptions, figure_ui};

const CURVE_HEIGHT: f32 = 260.0;

impl ImportDialog {
    /// Draws the curve with its numbers and what is doubtful about them, or what has to be said first.
    pub(super) fn preview_ui(&mut self, ui: &mut Ui) {
        let questions = self.choices.open_questions();
        let mut chosen = None;
        if !questions.is_empty() && matches!(self.table, Some((_, Ok(_)))) {
            ui.strong("To be said before the file can be opened");
            for question in questions {
                notice_ui(ui, Severity::Warning, question);
            }
        } else {
            match &self.preview {
                None => drop(ui.weak("the curve as it will be read")),
                Some((_, Err(refusal))) => {
                    notice_ui(ui, Severity::Error, &refusal.text);
                    chosen = buttons_ui(ui, &refusal.corrections);
                }
                Some((_, Ok(_))) => chosen = self.curve_ui(ui),
            }
        }
        if let Some(correction) = chosen {
            self.correct(correction);
        }
        self.corrected_ui(ui);
    }

    /// Draws the curve.
    ///
    /// - returns the correction that was clicked.
    fn curve_ui(&self, ui: &mut Ui) -> Option<Correction> {
        let Some((_, Ok(preview))) = &self.preview else { return None };
        ui.strong(match preview.kind {
            FileKind::Force => "A force, as it will be read",
            FileKind::Trajectory => "A trajectory, as it will be read",
            FileKind::Steer => "Steering, as it will be read",
            FileKind::Wheels => "Torques at the wheels, as they will be read",
        });
        let options = FigureOptions {
            id: "import".to_owned(),
            height: Some(CURVE_HEIGHT),
            ..FigureOptions::default()
        };
        figure_ui(ui, &preview.figure, &options);
        Grid::new("import numbers").num_columns(2).striped(true).show(ui, |ui| {
            for (name, text) in &preview.numbers {
                value_row(ui, name, text);
            }
        });
        let mut chosen = None;
        let mut offered: Vec<Correction> = Vec::new();
        for remark in &preview.remarks {
            match remark.is_doubt {
                true => notice_ui(ui, Severity::Warning, &remark.text),
                false => ui.weak(format!("• {}", remark.text)),
            };
            // What corrects two remarks stands below the first of them.
            let is_new = |correction: &&Correction| !offered.contains(correction);
            let new: Vec<Correction> = remark.corrections.iter().filter(is_new).cloned().collect();
            chosen = chosen.or(buttons_ui(ui, &new));
            offered.extend(new);
        }
        chosen
    }

    /// Draws the corrections that were made; a click takes one back.
    fn corrected_ui(&mut self, ui: &mut Ui) {
        if self.corrected.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.weak("Corrected; a click takes it back");
        let mut taken_back = None;
        ui.horizontal_wrapped(|ui| {
            for (idx, (correction, _)) in self.corrected.iter().enumerate() {
                let button = Button::new(correction.label()).selected(true);
                if ui.add(button).on_hover_text(correction.to_string()).clicked() {
                    taken_back = Some(idx);
                }
            }
        });
        if let Some(idx) = taken_back {
            self.take_back(idx);
        }
    }
}

/// Draws a button for each correction.
///
/// - returns the one that was clicked.
fn buttons_ui(ui: &mut Ui, corrections: &[Correction]) -> Option<Correction> {
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for correction in corrections {
            let button = ui.button(correction.label());
            if button.on_hover_text(format!("Map {correction}")).clicked() {
                chosen = Some(correction.clone());
            }
        }
    });
    chosen
}
