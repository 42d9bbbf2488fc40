//! Measuring on the ground of a scene: lengths, angles and areas between places that were clicked.

use std::sync::Arc;

use impactlab_core::numerics::{line_length, polygon_area};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_document::scene::{MeasureTextAt, Scene, SceneMeasure};

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// The length of a line with corners.
    Length,
    /// The angle between two lines from one place.
    Angle,
    /// The area within a border.
    Area,
    /// The scale of the orthophoto, by two of its points whose distance is known.
    Scale,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Length, Self::Angle, Self::Area, Self::Scale];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::Length => "Length of a line",
            Self::Angle => "Angle of two lines",
            Self::Area => "Area within a border",
            Self::Scale => "Scale of the orthophoto",
        }
    }

    /// What the user does.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Length => "Click from corner to corner; Esc ends the line, Delete removes it",
            Self::Angle => "Click an end, the vertex and the other end; Delete removes the angle",
            Self::Area => "Click around the border; Esc ends it, Delete removes it",
            Self::Scale => "Click two points of the orthophoto and enter their distance",
        }
    }

    /// Points that are needed, and after which it is complete by itself.
    fn n_points(self) -> (usize, usize) {
        match self {
            Self::Length => (2, usize::MAX),
            Self::Angle => (3, 3),
            Self::Area => (3, usize::MAX),
            Self::Scale => (2, 2),
        }
    }
}

/// Something that was measured, or is being measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// What.
    pub measure: Measure,
    /// The places that were clicked, `[X, Y]`, m.
    pub points_m: Vec<[f64; 2]>,
}

impl Measurement {
    /// Whether it has all the points that it needs.
    pub fn is_complete(&self) -> bool {
        self.points_m.len() >= self.measure.n_points().0
    }

    /// The value, SI units; `None` without the points that it needs.
    ///
    /// Length and scale are the length of the line, the angle is between 0 and π, and the area is that
    /// within the border, also if it crosses itself: the parts that are run around in the other sense
    /// count negative.
    pub fn value(&self) -> Option<f64> {
        if !self.is_complete() {
            return None;
        }
        let points = &self.points_m;
        match self.measure {
            Measure::Length | Measure::Scale => Some(line_length(points)),
            Measure::Angle => angle_rad(points),
            Measure::Area => Some(polygon_area(points)),
        }
    }

    /// How it is shown; `None` without the points that it needs.
    pub fn in_scene(&self, units: UnitSystem) -> Option<SceneMeasure> {
        let text_at = match self.measure {
            Measure::Length | Measure::Scale => MeasureTextAt::End,
            Measure::Angle => MeasureTextAt::Vertex,
            Measure::Area => MeasureTextAt::Middle,
        };
        let is_closed = self.measure == Measure::Area;
        let (points_m, text) = (self.points_m.clone(), self.text(units)?);
        Some(SceneMeasure { points_m, is_closed, text, text_at })
    }

    /// The value in the units that are shown; for a length also that of its last part.
    pub fn text(&self, units: UnitSystem) -> Option<String> {
        let value = self.value()?;
        let length = |value_m: f64| {
            let unit = Quantity::Length.display_unit(units);
            format!("{:.2} {}", unit.from_si(value_m), unit.symbol)
        };
        Some(match self.measure {
            Measure::Length if self.points_m.len() > 2 => {
                let last = self.points_m.len() - 2;
                format!(
                    "{} (last part {})",
                    length(value),
                    length(line_length(&self.points_m[last..]))
                )
            }
            Measure::Length | Measure::Scale => length(value),
            Measure::Angle => {
                let unit = Quantity::Angle.display_unit(units);
                format!("{:.1} {}", unit.from_si(value), unit.symbol)
            }
            Measure::Area => {
                let unit = Quantity::Length.display_unit(units);
                format!("{:.2} {}²", value / unit.to_si(1.0).powi(2), unit.symbol)
            }
        })
    }
}

/// Angle at the second of three points; `None` if it coincides with another.
fn angle_rad(points_m: &[[f64; 2]]) -> Option<f64> {
    let &[a, vertex, b] = points_m else { return None };
    let way = |to: [f64; 2]| [to[0] - vertex[0], to[1] - vertex[1]];
    let ([ax, ay], [bx, by]) = (way(a), way(b));
    let (cross, dot) = (ax * by - ay * bx, ax * bx + ay * by);
    (ax.hypot(ay) > 0.0 && bx.hypot(by) > 0.0).then(|| cross.abs().atan2(dot))
}

/// The measurements of a scene. They stay where they are on the ground while the camera moves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measuring {
    /// What is measured by the next click; nothing if `None`.
    pub measure: Option<Measure>,
    /// What is being measured.
    pub begun: Option<Measurement>,
    /// What was measured.
    pub done: Vec<Measurement>,
    /// The distance that is entered for the scale of the orthophoto, m.
    pub distance_m: Option<f64>,
}

impl Measuring {
    /// A scene with what was measured, for pictures and films of it.
    pub fn added_to(&self, scene: &Arc<Scene>) -> Arc<Scene> {
        let measures = self.done.iter().filter_map(|of| of.in_scene(scene.units));
        let measures: Vec<SceneMeasure> = measures.collect();
        match measures.is_empty() {
            true => Arc::clone(scene),
            false => Arc::new(Scene { measures, ..(**scene).clone() }),
        }
    }

    /// Chooses what is measured next; what was begun is ended.
    pub fn choose(&mut self, measure: Option<Measure>) {
        if self.begun.is_some() {
            self.end();
        }
        self.measure = measure;
    }

    /// A click at a place, m.
    pub fn click(&mut self, at_m: [f64; 2]) {
        let Some(measure) = self.measure else { return };
        let begun = self.begun.take().filter(|of| of.measure == measure);
        let mut begun = begun.unwrap_or(Measurement { measure, points_m: Vec::new() });
        let (_, most) = measure.n_points();
        if begun.points_m.len() >= most {
            begun.points_m.clear();
        }
        if begun.points_m.last() != Some(&at_m) {
            begun.points_m.push(at_m);
        }
        let is_full = begun.points_m.len() >= most;
        match measure {
            // Its distance is entered first.
            Measure::Scale => self.begun = Some(begun),
            _ if is_full => self.done.push(begun),
            _ => self.begun = Some(begun),
        }
    }

    /// Ends what was begun, and keeps it if it is complete; without anything begun, ends measuring.
    pub fn end(&mut self) {
        match self.begun.take() {
            Some(begun) if begun.is_complete() && begun.measure != Measure::Scale => {
                self.done.push(begun);
            }
            Some(_) => {}
            None => self.measure = None,
        }
    }

    /// Removes what was begun, or else what was measured last.
    pub fn delete(&mut self) {
        if self.begun.take().is_none() {
            self.done.pop();
        }
    }

    /// The two points and the distance of the orthophoto that are known now; `None` before.
    pub fn scale_ends_m(&self) -> Option<[[f64; 2]; 2]> {
        let begun = self.begun.as_ref().filter(|of| of.measure == Measure::Scale)?;
        <[[f64; 2]; 2]>::try_from(begun.points_m.as_slice()).ok()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn measurement(measure: Measure, points_m: &[[f64; 2]]) -> Measurement {
        Measurement { measure, points_m: points_m.to_vec() }
    }

    #[test]
    fn lengths_angles_and_areas_have_their_values_also_far_away() {
        for far in [[0.0, 0.0], [3.5e6, 5.4e6]] {
            let at = |x: f64, y: f64| [far[0] + x, far[1] + y];
            let near = |found: Option<f64>, expected: f64| {
                assert!((found.unwrap() - expected).abs() < 1e-6, "{found:?} {expected} {far:?}");
            };
            let corner = [at(3.0, 0.0), at(0.0, 0.0), at(0.0, 4.0)];
            near(measurement(Measure::Length, &corner).value(), 7.0);
            near(measurement(Measure::Angle, &corner).value(), FRAC_PI_2);
            near(measurement(Measure::Area, &corner).value(), 6.0);
        }
        assert_eq!(measurement(Measure::Area, &[[0.0; 2], [1.0, 0.0]]).value(), None);
        assert_eq!(
            measurement(Measure::Angle, &[[1.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).value(),
            None
        );
    }

    #[test]
    fn values_are_shown_in_the_units_of_the_user() {
        let square = [[0.0, 0.0], [3.048, 0.0], [3.048, 3.048], [0.0, 3.048]];
        let text =
            |measure, points: &[[f64; 2]], units| measurement(measure, points).text(units).unwrap();
        assert_eq!(text(Measure::Area, &square, UnitSystem::Si), "9.29 m²");
        assert_eq!(text(Measure::Area, &square, UnitSystem::Us), "100.00 ft²");
        assert_eq!(text(Measure::Length, &square[..2], UnitSystem::Us), "10.00 ft");
        assert_eq!(
            text(Measure::Length, &square[..3], UnitSystem::Si),
            "6.10 m (last part 3.05 m)"
        );
        assert_eq!(text(Measure::Angle, &square[..3], UnitSystem::Us), "90.0 deg");
    }

    #[test]
    fn clicks_escape_and_delete_do_what_the_hints_say() {
        let mut measuring = Measuring::default();
        measuring.click([1.0, 1.0]);
        assert_eq!(measuring, Measuring::default(), "no tool, no measurement");
        measuring.choose(Some(Measure::Angle));
        for at in [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 1.0]] {
            measuring.click(at);
        }
        assert_eq!((measuring.done.len(), measuring.begun.is_none()), (1, true));
        measuring.choose(Some(Measure::Length));
        measuring.click([0.0, 0.0]);
        measuring.end();
        assert_eq!(measuring.done.len(), 1, "a single point is no length");
        measuring.click([0.0, 0.0]);
        measuring.click([5.0, 0.0]);
        measuring.end();
        assert_eq!(measuring.done.len(), 2);
        assert_eq!(measuring.measure, Some(Measure::Length), "the next line");
        measuring.delete();
        assert_eq!(measuring.done.len(), 1);
        measuring.end();
        assert_eq!(measuring.measure, None);
        measuring.choose(Some(Measure::Scale));
        measuring.click([0.0, 0.0]);
        assert_eq!(measuring.scale_ends_m(), None);
        measuring.click([5.0, 0.0]);
        assert_eq!(measuring.scale_ends_m(), Some([[0.0, 0.0], [5.0, 0.0]]));
    }
}
