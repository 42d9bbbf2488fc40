//! A list of points, each with its coordinates.

use egui::{Id, Ui};

use crate::app::widgets::{EmptyField, optional_quantity, quantity_value};
use impactlab_core::ranges::Range;
use impactlab_core::units::UnitSystem;

/// What the fields of the next point say while nothing is typed.
const NO_POINT: EmptyField<'static> = EmptyField { text: "none", start_si: 0.0 };

/// The rows of a list of points in a grid of four columns, or of two where there is little room.
pub struct PointRows<'a> {
    /// Tells the list apart from others.
    pub id: Id,
    /// The admissible coordinates.
    pub range: &'a Range,
    /// The units of the coordinates.
    pub units: UnitSystem,
    /// Whether y stands below x.
    pub is_narrow: bool,
}

impl PointRows<'_> {
    /// Draws a row for each point, with its coordinates and a button that removes it, and one for the next
    /// point, which is added at the end as soon as both of its coordinates are known.
    pub fn draw(&self, ui: &mut Ui, points_m: &mut Vec<[f64; 2]>) {
        let mut removed = None;
        for (idx, [x_m, y_m]) in points_m.iter_mut().enumerate() {
            let n = idx + 1;
            ui.label(format!("Point {n}, x"));
            let (field, _) = quantity_value(ui, x_m, self.range, self.units);
            field.accessible_name(format!("x of point {n}"));
            self.begin_y(ui);
            ui.horizontal(|ui| {
                let (field, _) = quantity_value(ui, y_m, self.range, self.units);
                field.accessible_name(format!("y of point {n}"));
                if ui.small_button(format!("Remove point {n}")).clicked() {
                    removed = Some(idx);
                }
            });
            ui.end_row();
        }
        if let Some(idx) = removed {
            points_m.remove(idx);
        }
        points_m.extend(self.next_point(ui));
    }

    /// Draws the row of the next point; returns it when it is known.
    fn next_point(&self, ui: &mut Ui) -> Option<[f64; 2]> {
        let typed = ui.data(|data| data.get_temp::<[Option<f64>; 2]>(self.id));
        let [mut x_m, mut y_m] = typed.unwrap_or_default();
        ui.label("Next point, x");
        optional_quantity(ui, &mut x_m, NO_POINT, self.range, self.units)
            .accessible_name("x of the next point");
        self.begin_y(ui);
        // In a row as those of the points are, so that a drag goes on when this becomes one of them.
        ui.horizontal(|ui| {
            optional_quantity(ui, &mut y_m, NO_POINT, self.range, self.units)
                .accessible_name("y of the next point");
        });
        ui.end_row();
        let next = x_m.zip(y_m).map(<[f64; 2]>::from);
        let left = if next.is_some() { [None; 2] } else { [x_m, y_m] };
        ui.data_mut(|data| data.insert_temp(self.id, left));
        next
    }

    /// Begins the second half of a row.
    fn begin_y(&self, ui: &mut Ui) {
        if self.is_narrow {
            ui.end_row();
        }
        ui.label("y");
    }
}
