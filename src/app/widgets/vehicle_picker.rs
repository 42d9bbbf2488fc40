//! The list in which a vehicle is chosen: with a search, and the outline of each.

use egui::{
    ComboBox, Grid, Key, PopupCloseBehavior, Rect, Response, ScrollArea, Sense, Stroke, TextEdit,
    Ui, vec2,
};

use crate::app::model::file_name;
use crate::app::widgets::within_view;
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};
use impactlab_core::vehicle::{BuiltInVehicle, GeometryParameters, VehicleClass};
use impactlab_study::VehicleChoice;

/// Largest width of the closed list, points.
const WIDTH: f32 = 240.0;
/// Size of the open list, points.
const OPEN_WIDTH: f32 = 500.0;
const OPEN_HEIGHT: f32 = 420.0;
/// Height of the field for the search in it, points.
const SEARCH_HEIGHT: f32 = 40.0;
/// Size of the picture of an outline, points, and its scale.
const PICTURE: egui::Vec2 = vec2(54.0, 22.0);
const POINTS_PER_METRE: f32 = 8.6;

/// The columns of the list.
const COLUMNS: [&str; 6] = ["", "Vehicle", "Class", "Year", "Mass", "Length"];

/// The choice of a vehicle.
pub struct VehiclePicker<'a> {
    /// What tells it from others in the window.
    pub salt: &'a str,
    /// The label in front of it.
    pub name: &'a Response,
    /// What it is for.
    pub hint: &'a str,
    /// What holds if nothing is chosen.
    pub open: &'a str,
    /// Vehicles of the user that can be chosen, too.
    pub own: &'a [VehicleChoice],
    /// In which units the vehicles are told.
    pub units: UnitSystem,
}

impl VehiclePicker<'_> {
    /// Draws the list.
    ///
    /// - returns whether another vehicle was chosen.
    pub fn show(&self, ui: &mut Ui, choice: &mut VehicleChoice) -> bool {
        let before = choice.clone();
        let list = ComboBox::from_id_salt(self.salt)
            .selected_text(vehicle_label(choice, self.open, self.units))
            .truncate()
            .height(OPEN_HEIGHT)
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        within_view(ui, |ui| {
            list.width(ui.available_width().min(WIDTH))
                .show_ui(ui, |ui| self.options_ui(ui, choice))
        })
        .response
        .labelled_by(self.name.id)
        .on_hover_text(self.hint);
        *choice != before
    }

    fn options_ui(&self, ui: &mut Ui, choice: &mut VehicleChoice) {
        ui.set_min_width(OPEN_WIDTH);
        let id = ui.scope_id().with("search");
        let mut search = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
        let field = TextEdit::singleline(&mut search).hint_text("Search: make, class, year");
        let field = ui.add(field.desired_width(f32::INFINITY));
        // Asked before the field takes the focus back.
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        ui.data_mut(|data| data.insert_temp(id, search.clone()));
        let mut chosen = None;
        ScrollArea::vertical().max_height(OPEN_HEIGHT - SEARCH_HEIGHT).show(ui, |ui| {
            let mut first = None;
            for offered in std::iter::once(&VehicleChoice::Automatic).chain(self.own) {
                let label = vehicle_label(offered, self.open, self.units);
                if matches(&search, &label)
                    && ui.selectable_label(choice == offered, label).clicked()
                {
                    chosen = Some(offered.clone());
                }
            }
            let found = BuiltInVehicle::all().iter().filter(|of| matches(&search, &searched(of)));
            Grid::new("vehicles").num_columns(COLUMNS.len()).show(ui, |ui| {
                for (idx, vehicle) in found.enumerate() {
                    if idx == 0 {
                        for title in COLUMNS {
                            ui.strong(title);
                        }
                        ui.end_row();
                    }
                    first.get_or_insert(vehicle.id);
                    let is_chosen = *choice == VehicleChoice::Preset(vehicle.id.to_owned());
                    if vehicle_row(ui, vehicle, is_chosen, self.units).clicked() {
                        chosen = Some(VehicleChoice::Preset(vehicle.id.to_owned()));
                    }
                }
            });
            match first {
                Some(id) if is_entered && !search.is_empty() => {
                    chosen = Some(VehicleChoice::Preset(id.to_owned()));
                }
                None if !search.is_empty() => {
                    ui.weak("None that comes with the program; open a vehicle file of your own");
                }
                _ => {}
            }
        });
        if let Some(chosen) = chosen {
            *choice = chosen;
            ui.data_mut(|data| data.remove::<String>(id));
            ui.close();
        }
    }
}

/// What a choice is called.
///
/// - `open`: what one is called that is left open.
pub fn vehicle_label(choice: &VehicleChoice, open: &str, units: UnitSystem) -> String {
    match choice {
        VehicleChoice::Automatic => open.to_owned(),
        VehicleChoice::Preset(id) => vehicle_name(id, units),
        VehicleChoice::File(path) => file_name(path),
        VehicleChoice::Sheet(sheet) => format!("{} (edited)", sheet.name),
    }
}

/// The name of a vehicle that comes with the program; its id where there is none.
pub fn vehicle_name(id: &str, units: UnitSystem) -> String {
    let name = |vehicle: &BuiltInVehicle| name_in_units(&vehicle.parameters.name, units);
    BuiltInVehicle::from_id(id).map_or_else(|| id.to_owned(), name)
}

/// The name of a vehicle, in which the mass of one that comes with the program is in the units of the window.
pub fn name_in_units(name: &str, units: UnitSystem) -> String {
    BuiltInVehicle::name_in_units(name, name, &NumberFormat::english(units))
}

/// Draws a vehicle of the list.
fn vehicle_row(
    ui: &mut Ui,
    vehicle: &BuiltInVehicle,
    is_chosen: bool,
    units: UnitSystem,
) -> Response {
    outline_ui(ui, &vehicle.parameters.geometry);
    let name = name_in_units(&vehicle.parameters.name, units);
    let row = ui.selectable_label(is_chosen, name);
    let of = &vehicle.parameters;
    let mass = Quantity::Mass.shown(of.mass.mass_kg, units);
    let length = Quantity::Length.shown(of.geometry.outer_length_m, units);
    for cell in [class(vehicle).to_owned(), year(vehicle), mass, length] {
        ui.weak(cell);
    }
    ui.end_row();
    row.on_hover_text(format!("{}\n{}", vehicle.id, vehicle.parameters.source))
}

fn class(vehicle: &BuiltInVehicle) -> &'static str {
    vehicle.class().map_or("of the data sets", VehicleClass::word)
}

/// The model year; nothing of a vehicle that has none.
fn year(vehicle: &BuiltInVehicle) -> String {
    vehicle.model_year().map(|year| year.to_string()).unwrap_or_default()
}

/// What a search looks at.
fn searched(vehicle: &BuiltInVehicle) -> String {
    let (name, id) = (&vehicle.parameters.name, vehicle.id);
    format!("{name} {id} {} {}", class(vehicle), year(vehicle))
}

/// Whether every word that was searched stands in a text.
fn matches(search: &str, text: &str) -> bool {
    let text = text.to_lowercase();
    search.to_lowercase().split_whitespace().all(|word| text.contains(word))
}

/// Draws an outline to scale, front to the right, with the axles.
fn outline_ui(ui: &mut Ui, geometry: &GeometryParameters) {
    let (rect, _) = ui.allocate_exact_size(PICTURE, Sense::hover());
    let colour = ui.visuals().text_color();
    let [length, width] =
        [geometry.outer_length_m, geometry.outer_width_m].map(|m| m as f32 * POINTS_PER_METRE);
    let size = vec2(length, width).min(rect.size());
    let body = Rect::from_center_size(rect.center(), size);
    let painter = ui.painter();
    painter.rect_stroke(body, 2.0, Stroke::new(1.0, colour), egui::StrokeKind::Inside);
    let scale = size.x / (geometry.outer_length_m as f32);
    let front = geometry.cg_to_front_end_m;
    let axles = [front - geometry.cg_to_front_axle_m, front + geometry.cg_to_rear_axle_m];
    for from_front_m in axles {
        let x = body.right() - from_front_m as f32 * scale;
        painter.vline(
            x,
            body.y_range().shrink(2.0),
            Stroke::new(1.0, ui.visuals().weak_text_color()),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_finds_make_class_and_year() {
        let found = |search: &str| -> Vec<&str> {
            let vehicles = BuiltInVehicle::all().iter();
            vehicles.filter(|of| matches(search, &searched(of))).map(|of| of.id).collect()
        };
        assert_eq!(found("corolla"), ["toyota-corolla-2020"]);
        assert_eq!(found("2020 toyota"), ["toyota-corolla-2020"]);
        assert_eq!(found("car 2020"), ["toyota-corolla-2020"]);
        assert!(found("pickup").contains(&"ford-f-150-2004"), "{:?}", found("pickup"));
        let police = [
            "chevrolet-tahoe-2022",
            "chevrolet-tahoe-4wd-2022",
            "dodge-charger-2022",
            "ford-crown-victoria-2010",
            "ford-explorer-2020",
        ];
        assert_eq!(found("police"), police);
        assert_eq!(found("").len(), BuiltInVehicle::all().len());
        assert_eq!(found("trabant"), [""; 0]);
        assert_eq!(
            vehicle_name("toyota-corolla-2020", UnitSystem::Us),
            BuiltInVehicle::from_id("toyota-corolla-2020").unwrap().parameters.name
        );
        // A car of “2000 kg” stood beside masses in pounds.
        assert_eq!(vehicle_name("target-2000", UnitSystem::Si), "FEA target (2000 kg)");
        assert_eq!(vehicle_name("target-2000", UnitSystem::Us), "FEA target (4409 lb)");
    }
}
