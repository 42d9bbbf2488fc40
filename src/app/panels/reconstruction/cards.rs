//! The cards of the evidence: one for each item, with its fields.

use egui::{CollapsingHeader, Grid, Ui};

use crate::app::looks::{self, Icon, icon_button};
use crate::app::panels::reconstruction::fields::{
    FieldRows, ShownFields, is_narrow, sentence_case,
};
use crate::app::panels::vehicle::evidence_vehicle_ui;
use crate::app::reconstruction::{MarkKey, ReconstructionCommand};
use crate::app::widgets::vehicle_label;
use impactlab_core::units::UnitSystem;
use impactlab_reconstruct::evidence::{
    Damage, Evidence, Group, Item, Items, SINGLE_CAR, STRIKING_CAR, STRUCK_CAR, Section,
};
use impactlab_study::VehicleChoice;

/// The data sheets of the cars that the user can choose.
pub struct SheetChoices<'a> {
    /// The choice for the struck and for the striking car.
    pub chosen: [&'a mut VehicleChoice; 2],
    /// Vehicles of the user.
    pub own: &'a [VehicleChoice],
}

/// Draws the cards of all items, and the menu that adds another.
///
/// - `adds_to`: the mark to which clicks in the scene add points;
/// - returns what the user asks for beside the edits.
pub fn cards_ui(
    ui: &mut Ui,
    evidence: &mut Evidence,
    sheets: SheetChoices<'_>,
    adds_to: Option<MarkKey>,
    units: UnitSystem,
) -> Option<ReconstructionCommand> {
    ui.menu_button((looks::icon(Icon::Plus), "Add evidence"), |ui| {
        evidence.items(&mut AddMenu { ui });
    });
    let side = evidence.damage.side;
    let width = ui.available_width() - egui::Frame::group(ui.style()).total_margin().sum().x;
    let mut cards = Cards { ui, width, units, sheets, adds_to, group: Group::Scene, command: None };
    evidence.items(&mut cards);
    cards.group = Group::Cars;
    evidence.items(&mut cards);
    let command = cards.command;
    let damage = &mut evidence.damage;
    if damage.side != side {
        *damage = Damage { side, ..*damage }.on_side(damage.side);
    }
    command
}

/// The picture of an item.
fn icon(section: &Section) -> Icon {
    match section.key {
        "rest" | "striking_rest" => Icon::Flag,
        "mark" | "striking_mark" => Icon::Route,
        "damage" => Icon::Hammer,
        "edr" | "striking_edr" | "recorded_speed" => Icon::Cpu,
        "position" => Icon::Video,
        "struck_car" | "striking_car" | "car" => Icon::Car,
        "after" | "wheels" => Icon::CarFront,
        _ => Icon::Ruler,
    }
}

/// Draws the items of a group.
struct Cards<'u, 's> {
    ui: &'u mut Ui,
    /// Width inside of a card, points: a row that is wider widens no other card.
    width: f32,
    units: UnitSystem,
    sheets: SheetChoices<'s>,
    adds_to: Option<MarkKey>,
    group: Group,
    command: Option<ReconstructionCommand>,
}

impl Cards<'_, '_> {
    /// Draws a card with a grid of its fields.
    ///
    /// - returns whether the user removes it.
    fn card(
        &mut self,
        section: &'static Section,
        idx: Option<usize>,
        is_removable: bool,
        item: &mut impl Item,
    ) -> bool {
        let number = idx.map_or(String::new(), |idx| format!(" {}", idx + 1));
        let title = sentence_case(&format!("{}{number}", section.title));
        let Self { units, width, adds_to, sheets, command, .. } = self;
        let width = *width;
        let [struck, striking] = &mut sheets.chosen;
        let chosen = match section.key {
            key if [STRUCK_CAR.key, SINGLE_CAR.key].contains(&key) => Some(struck),
            key if key == STRIKING_CAR.key => Some(striking),
            _ => None,
        };
        let mut is_removed = false;
        egui::Frame::group(self.ui.style()).show(self.ui, |ui| {
            ui.set_width(width);
            ui.horizontal(|ui| {
                looks::icon_ui(ui, icon(section), ui.visuals().hyperlink_color);
                ui.strong(&title);
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    let hint = format!("Remove: {title}");
                    let button =
                        is_removable.then(|| ui.small_button("Remove").on_hover_text(hint));
                    is_removed = button.is_some_and(|button| button.clicked());
                });
            });
            let grid = |name: &str| Grid::new((name, section.key, idx)).min_col_width(10.0);
            let is_narrow = is_narrow(ui);
            grid("fields").show(ui, |ui| {
                let mut rows = FieldRows::new(ui, *units, (section.key, idx));
                rows.is_narrow = is_narrow;
                rows.adds_to = *adds_to;
                if chosen.is_some() {
                    rows.shown = ShownFields::Measured;
                }
                item.fields(&mut rows);
                *command = rows.command.take().or(command.take());
            });
            if let Some(sheet) = chosen {
                let header = match &*sheet {
                    VehicleChoice::Automatic => "Data sheet, dimensions".to_owned(),
                    chosen => format!("Else as {}", vehicle_label(chosen, "", *units)),
                };
                CollapsingHeader::new(header).id_salt(("dimensions", section.key)).show(ui, |ui| {
                    grid("dimensions").num_columns(2).show(ui, |ui| {
                        evidence_vehicle_ui(ui, &title, sheet, sheets.own, *units);
                        let mut rows = FieldRows::new(ui, *units, (section.key, idx));
                        rows.shown = ShownFields::Plain;
                        item.fields(&mut rows);
                    });
                });
            }
        });
        is_removed
    }
}

impl Items for Cards<'_, '_> {
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item) {
        if section.group == self.group {
            self.card(section, idx, false, item);
        }
    }

    fn optional<T: Item>(&mut self, section: &'static Section, item: &mut Option<T>) {
        if section.group == self.group
            && let Some(found) = item
            && self.card(section, None, true, found)
        {
            *item = None;
        }
    }

    fn many<T: Item>(&mut self, section: &'static Section, items: &mut Vec<T>) {
        if section.group != self.group {
            return;
        }
        let mut removed = None;
        for (idx, item) in items.iter_mut().enumerate() {
            removed = self.card(section, Some(idx), true, item).then_some(idx).or(removed);
        }
        if let Some(idx) = removed {
            items.remove(idx);
            self.command = Some(ReconstructionCommand::AddPoints(None));
        }
    }
}

/// Draws the menu of what can be added.
struct AddMenu<'u> {
    ui: &'u mut Ui,
}

impl AddMenu<'_> {
    fn is_clicked(&mut self, section: &Section) -> bool {
        let button = icon_button(icon(section), sentence_case(section.title));
        self.ui.add(button).clicked()
    }
}

impl Items for AddMenu<'_> {
    fn item(&mut self, _: &'static Section, _: Option<usize>, _: &mut impl Item) {}

    fn optional<T: Item>(&mut self, section: &'static Section, item: &mut Option<T>) {
        if item.is_none() && self.is_clicked(section) {
            *item = Some(T::default());
        }
    }

    fn many<T: Item>(&mut self, section: &'static Section, items: &mut Vec<T>) {
        if self.is_clicked(section) {
            items.push(T::default());
        }
    }
}
