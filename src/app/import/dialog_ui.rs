//! Draws the import dialog: first lines, header and units, a channel and a unit for each column, clock and
//! axes on the left; on the right the curve as it will be read (`preview_ui`).

use std::sync::Arc;

use egui::{ComboBox, Grid, Rect, RichText, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::import::column_row::column_ui;
use crate::app::import::dialog::ImportDialog;
use crate::app::looks;
use crate::app::model::file_name;
use crate::app::panels::{file_vehicle_ui, start_fields};
use crate::app::widgets::{choice_row, notice_ui, working_ui};
use impactlab_core::data::{
    Channel, ColumnMap, DeckUnits, FileKind, HeaderLine, ReadSettings, Severity, Sheet, SheetRef,
    Table, VelocityAxes, VelocityFit,
};
use impactlab_core::ranges::{CONTACT_X, CONTACT_Y};

/// Size of the dialog and of its parts, points.
const WIDTH: f32 = 1060.0;

const BODY_HEIGHT: f32 = 560.0;

const WINDOW_MARGIN: f32 = 48.0;

const LEFT_SHARE: f32 = 0.58;

const GAP: f32 = 4.0 * looks::GRID;

const LINES_HEIGHT: f32 = 110.0;

const COLUMNS_HEIGHT: f32 = 220.0;

/// What is said of a force that points out of the vehicle at its contact point.
const PULLS: &str = "the force pulls at the contact point instead of pushing into the vehicle; change the \
                     sign of its components or the contact point";

impl ImportDialog {
    /// Draws the dialog and adds a command when the user confirms or cancels.
    pub fn ui(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let window = ui.ctx().content_rect().size();
        let width = WIDTH.min(window.x - WINDOW_MARGIN);
        ui.set_width(width);
        ui.horizontal(|ui| {
            ui.heading("Which column is which?");
            ui.label(RichText::new(file_name(&self.path)).strong())
                .on_hover_text(self.path.display().to_string());
        });
        ui.separator();
        let height = BODY_HEIGHT.min(window.y - 3.0 * WINDOW_MARGIN);
        let body = ScrollArea::vertical().id_salt("import").max_height(height);
        body.auto_shrink([false, false]).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(LEFT_SHARE * width);
                    self.lines_ui(ui);
                    self.columns_ui(ui);
                    self.settings_ui(ui);
                });
                ui.add_space(GAP);
                ui.vertical(|ui| {
                    // Long texts in its grids wrap at this edge; they made the dialog wider.
                    ui.shrink_clip_rect(Rect::everything_left_of(ui.max_rect().right()));
                    self.preview_ui(ui);
                    self.left_open_ui(ui);
                });
            });
        });
        ui.separator();
        self.buttons_ui(ui, commands);
    }

    /// Draws the first lines of the file, and the choice of the lines of header and units.
    fn lines_ui(&mut self, ui: &mut Ui) {
        let table = match &self.table {
            Some((_, Ok(table))) => Some(Arc::clone(table)),
            Some((_, Err(problem))) => {
                notice_ui(ui, Severity::Error, problem);
                None
            }
            None => {
                return working_ui(ui, "reading the file");
            }
        };
        let read = table.as_ref().map(|table| (table.has_header(), table.header_line()));
        let header = self.settings.header.or(read.map(|(has_header, line)| match has_header {
            true => HeaderLine::Line(line),
            false => HeaderLine::None,
        }));
        let units =
            self.settings.units_line.or(table.as_ref().and_then(|table| table.units_line()));
        ui.horizontal(|ui| {
            if let Some(sheet) = table.as_ref().and_then(|table| table.sheet()) {
                let is_of_model = table.as_ref().is_some_and(|table| table.is_of_model());
                self.sheet_ui(ui, sheet, is_of_model);
            }
            self.header_ui(ui, header);
            self.units_line_ui(ui, units);
        });
        let is_sheet = table.as_ref().is_some_and(|table| table.sheet().is_some());
        self.deck_ui(ui, table.as_deref());
        self.signs_ui(ui, table.as_ref().map(|table| table.dialect()), is_sheet);
        let lines = ScrollArea::both().id_salt("lines").max_height(LINES_HEIGHT);
        lines.auto_shrink([false, true]).show(ui, |ui| {
            for (number, text) in &self.beginning {
                let is_header = header == Some(HeaderLine::Line(*number));
                let mut line = RichText::new(format!("{number:4}  {text}")).monospace();
                if is_header || units == Some(*number) {
                    line = line.strong().underline();
                }
                ui.add(egui::Label::new(line).extend());
            }
        });
        ui.separator();
    }

    fn sheet_ui(&mut self, ui: &mut Ui, shown: &Sheet, is_of_model: bool) {
        let name = ui.label(if is_of_model { "Contact, side or node" } else { "Sheet" });
        let combo = ComboBox::from_id_salt("sheet").selected_text(&shown.name);
        let list = combo.show_ui(ui, |ui| {
            for (idx, sheet) in shown.all.iter().enumerate() {
                if ui.selectable_label(*sheet == shown.name, sheet).clicked() {
                    // Lines that were chosen are those of the other sheet.
                    let sheet = Some(SheetRef::Number(idx + 1));
                    let deck = self.settings.deck;
                    self.settings = ReadSettings { sheet, deck, ..ReadSettings::default() };
                }
            }
        });
        list.response.labelled_by(name.id);
    }

    /// Draws the choice of the units of a finite-element model, with those that its numbers suggest.
    fn deck_ui(&mut self, ui: &mut Ui, table: Option<&Table>) {
        let Some(table) = table.filter(|table| table.is_of_model()) else { return };
        ui.horizontal(|ui| {
            let name = ui.label("Units of the model");
            let chosen = &mut self.settings.deck;
            let text = chosen.map_or("not said: choose", DeckUnits::name);
            let combo = ComboBox::from_id_salt("deck").selected_text(text).width(120.0);
            let list = combo.show_ui(ui, |ui| {
                for deck in DeckUnits::ALL {
                    ui.selectable_value(chosen, Some(deck), deck.name());
                }
            });
            list.response.labelled_by(name.id);
            if let Some((deck, why)) = table.proposed_deck()
                && ui.button(format!("Take {}", deck.name())).on_hover_text(why).clicked()
            {
                *chosen = Some(deck);
            }
        });
        if let Some((_, why)) = table.proposed_deck() {
            ui.weak(why);
        }
    }

    fn header_ui(&mut self, ui: &mut Ui, shown: Option<HeaderLine>) {
        let name = ui.label("Header");
        let text = |header| match header {
            Some(HeaderLine::Line(line)) => format!("line {line}"),
            Some(HeaderLine::None) => "none".to_owned(),
            None => "?".to_owned(),
        };
        let combo = ComboBox::from_id_salt("header").selected_text(text(shown)).width(90.0);
        let lines = self.beginning.iter().map(|(number, _)| HeaderLine::Line(*number));
        let options: Vec<HeaderLine> = lines.chain([HeaderLine::None]).collect();
        let shown = combo.show_ui(ui, |ui| {
            for option in options {
                let is_chosen = shown == Some(option);
                if ui.selectable_label(is_chosen, text(Some(option))).clicked() {
                    self.settings.header = Some(option);
                }
            }
        });
        shown.response.labelled_by(name.id);
    }

    fn units_line_ui(&mut self, ui: &mut Ui, shown: Option<u64>) {
        let name = ui.label("Units");
        let text =
            |line: Option<u64>| line.map_or("none".to_owned(), |line| format!("line {line}"));
        let combo = ComboBox::from_id_salt("units line").selected_text(text(shown)).width(90.0);
        let lines: Vec<u64> = self.beginning.iter().map(|(number, _)| *number).collect();
        let shown = combo.show_ui(ui, |ui| {
            if ui.selectable_label(self.settings.units_line.is_none(), "as found").clicked() {
                self.settings.units_line = None;
            }
            for line in lines {
                if ui.selectable_label(shown == Some(line), text(Some(line))).clicked() {
                    self.settings.units_line = Some(line);
                }
            }
        });
        shown.response.labelled_by(name.id);
    }

    /// Draws a row for each column with its channel and its unit.
    fn columns_ui(&mut self, ui: &mut Ui) {
        let columns = ScrollArea::both().id_salt("columns").max_height(COLUMNS_HEIGHT);
        columns.auto_shrink([false, true]).show(ui, |ui| {
            Grid::new("mapping").striped(true).show(ui, |ui| {
                for title in ["Column", "First values", "holds", "in"] {
                    ui.strong(title);
                }
                ui.end_row();
                for column in &mut self.choices.columns {
                    column_ui(ui, column);
                    ui.end_row();
                }
            });
        });
        let hint = "The SI unit for every column: s, m, rad, N. A time keeps the unit that the file states, and \
                    one that counts from 1970 has the unit of its numbers";
        if ui.small_button("All SI").on_hover_text(hint).clicked() {
            self.choices.take_si_units();
        }
        if let Some(channel) = self.choices.missing_force() {
            let label = format!("{} is zero throughout", channel.label());
            ui.checkbox(&mut self.choices.other_force_is_zero, label);
        }
        let n_of = |channel| {
            self.choices.columns.iter().filter(|of| of.channel() == Some(channel)).count()
        };
        for channel in [Channel::Fx, Channel::Fy, Channel::FxBody, Channel::FyBody, Channel::Mz] {
            if n_of(channel) > 1 {
                let text = format!("{}: {} columns are added up", channel.label(), n_of(channel));
                ui.weak(text);
            }
        }
    }

    /// Draws clock, direction of y, and the axes of the velocities.
    fn settings_ui(&mut self, ui: &mut Ui) {
        ui.separator();
        Grid::new("settings").num_columns(2).show(ui, |ui| {
            let name = ui.label("Add to the time");
            let mut shift_ms = self.settings.time_shift_s.unwrap_or(0.0) * 1e3;
            ui.horizontal(|ui| {
                let field = egui::DragValue::new(&mut shift_ms).speed(0.1).suffix(" ms");
                let field = ui.add(field).labelled_by(name.id);
                if field.on_hover_text("So that the contact begins at 0").changed() {
                    self.settings.time_shift_s = (shift_ms != 0.0).then_some(shift_ms / 1e3);
                }
                self.zero_ui(ui);
            });
            ui.end_row();
            let text = |right: bool| if right { "right (SAE J670)" } else { "left (ISO 8855)" };
            let is_right = &mut self.settings.y_to_right;
            choice_row(ui, "y points to the", is_right, &[false, true], text);
            self.headings_ui(ui);
            self.velocities_ui(ui);
            self.antenna_ui(ui);
        });
    }

    /// Draws the place of the antenna, for positions that follow from latitude and longitude.
    fn antenna_ui(&mut self, ui: &mut Ui) {
        let is_receiver = self.choices.has_geographic_place() || self.settings.antenna_m.is_some();
        if !(is_receiver && self.choices.has(Channel::Yaw)) {
            return;
        }
        let name = ui.label("Antenna from the CG");
        let mut place_m = self.settings.antenna_m.unwrap_or_default();
        ui.horizontal(|ui| {
            let mut is_changed = false;
            let fields = [("ahead", CONTACT_X), ("to the left", CONTACT_Y)];
            for (place_m, (side, range)) in place_m.iter_mut().zip(fields) {
                let field = egui::DragValue::new(place_m).speed(0.01).suffix(" m");
                let field = ui.add(field.range(range.low..=range.high)).labelled_by(name.id);
                is_changed |= field.on_hover_text(side).changed();
                ui.weak(side);
            }
            if is_changed {
                self.settings.antenna_m = (place_m != [0.0; 2]).then_some(place_m);
            }
        });
        ui.end_row();
    }

    /// Draws the button with which the time begins at 0, where it does not.
    fn zero_ui(&mut self, ui: &mut Ui) {
        let Some((map, Ok(preview))) = &self.preview else { return };
        let shift_s = map.settings.time_shift_s.unwrap_or(0.0) - preview.first_s;
        let button = egui::Button::new("First row at 0").small();
        let button = ui.add_enabled(preview.first_s != 0.0, button);
        if button.on_hover_text(format!("Adds {shift_s} s to the time")).clicked() {
            self.settings.time_shift_s = (shift_s != 0.0).then_some(shift_s);
        }
    }

    fn headings_ui(&mut self, ui: &mut Ui) {
        if !self.choices.has(Channel::Yaw) {
            return;
        }
        let text = |is_compass: bool| match is_compass {
            false => "yaw angles, from x to the left",
            true => "compass headings, from north to the right",
        };
        let is_compass = &mut self.settings.compass_headings;
        choice_row(ui, "Headings are", is_compass, &[false, true], text);
    }

    fn velocities_ui(&mut self, ui: &mut Ui) {
        if !(self.choices.has(Channel::Vx) && self.choices.has(Channel::Vy)) {
            return;
        }
        let name = ui.label("v_x, v_y are in");
        let text = |axes| match axes {
            VelocityAxes::Body => "body axes",
            VelocityAxes::World => "world axes",
        };
        let mut chosen = self.settings.velocities.unwrap_or(VelocityAxes::Body);
        ui.horizontal(|ui| {
            let combo = ComboBox::from_id_salt("velocities").selected_text(text(chosen));
            let shown = combo.show_ui(ui, |ui| {
                [VelocityAxes::Body, VelocityAxes::World]
                    .into_iter()
                    .any(|axes| ui.selectable_value(&mut chosen, axes, text(axes)).clicked())
            });
            if shown.inner == Some(true) {
                (self.settings.velocities, self.says_velocities) = (Some(chosen), true);
            }
            shown.response.labelled_by(name.id);
            let fit = self.preview.as_ref().and_then(|(_, preview)| preview.as_ref().ok()?.fit);
            ui.weak(match fit {
                Some(VelocityFit::Body) => "the path says: body axes",
                Some(VelocityFit::World) => "the path says: world axes",
                Some(VelocityFit::Both) => "the path fits both alike",
                Some(VelocityFit::Neither(_)) => "the path fits neither",
                None => "not checked: that takes x, y and yaw",
            });
        });
        ui.end_row();
    }

    /// Draws what a force or a motion does not say about the struck vehicle. The variant gets it with the
    /// file.
    fn left_open_ui(&mut self, ui: &mut Ui) {
        let Some((_, Ok(preview))) = &self.preview else { return };
        let title = match preview.kind {
            FileKind::Force => "What a force does not say about the struck vehicle",
            FileKind::Trajectory => "What a motion does not say about the vehicle",
            FileKind::Steer | FileKind::Wheels => return,
        };
        ui.separator();
        ui.strong(title);
        let Some([said, _]) = &mut self.said else {
            ui.weak("As the variant says that asks about this file");
            return;
        };
        if preview.impulse_n_s.is_some_and(|impulse_n_s| said.pulls(impulse_n_s)) {
            // Above the fold of a small window.
            notice_ui(ui, Severity::Warning, PULLS);
        }
        Grid::new("import start").num_columns(2).show(ui, |ui| {
            file_vehicle_ui(ui, &mut said.vehicle, self.units);
            if preview.kind == FileKind::Force {
                start_fields(ui, &mut said.start, preview.begins_m_s, self.units);
            }
        });
    }

    fn buttons_ui(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        // The curve that is shown must be that of what is opened.
        let is_shown = |(map, preview): &(ColumnMap, Result<_, _>)| {
            preview.is_ok() && *map == self.map() && self.choices.open_questions().is_empty()
        };
        let is_ready = self.is_settled() && self.preview.as_ref().is_some_and(is_shown);
        ui.horizontal(|ui| {
            let open = egui::Button::new("Open with these columns");
            if ui.add_enabled(is_ready, open).clicked() {
                commands.push(Command::OpenMapped(self.path.clone(), self.map()));
            }
            let reset = egui::Button::new("Reset");
            let reset = ui.add_enabled(self.is_settled(), reset);
            if reset.on_hover_text("The choices that the dialog began with").clicked() {
                self.reset();
            }
            if ui.button("Cancel").clicked() {
                commands.push(Command::CloseDialog);
            }
        });
    }
}
