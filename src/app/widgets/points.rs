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

#[cfg(test)]
mod tests {
    use egui::{Event, Grid, Key, Modifiers};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;
    use impactlab_core::ranges::EVIDENCE_POSITION;

    type Points = Vec<[f64; 2]>;

    fn type_into(harness: &mut Harness<'_, Points>, name: &str, text: &str) {
        harness.get_by_label(name).focus();
        harness.run_steps(2);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.key_press(Key::Delete);
        harness.run_steps(2);
        harness.event(Event::Text(text.to_owned()));
        harness.run_steps(2);
        harness.key_press(Key::Enter);
        harness.run_steps(4);
    }

    /// Points could only be clicked.
    #[test]
    fn points_are_typed_changed_and_removed() {
        let mut harness = Harness::new_ui_state(
            |ui, points_m: &mut Points| {
                let (id, range, units) = (Id::unique("next"), &EVIDENCE_POSITION, UnitSystem::Si);
                let rows = PointRows { id, range, units, is_narrow: false };
                Grid::new("grid").show(ui, |ui| rows.draw(ui, points_m));
            },
            Points::new(),
        );
        harness.run();
        type_into(&mut harness, "x of the next point", "1.5");
        assert!(harness.state().is_empty(), "its y is not known");
        type_into(&mut harness, "y of the next point", "-2");
        assert_eq!(*harness.state(), [[1.5, -2.0]]);
        type_into(&mut harness, "y of the next point", "8");
        type_into(&mut harness, "x of the next point", "3");
        assert_eq!(*harness.state(), [[1.5, -2.0], [3.0, 8.0]]);
        type_into(&mut harness, "y of point 1", "4");
        harness.get_by_label("Remove point 2").click();
        harness.run_steps(4);
        assert_eq!(*harness.state(), [[1.5, 4.0]]);
    }
}
