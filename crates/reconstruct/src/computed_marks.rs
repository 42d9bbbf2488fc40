//! The marks that a reconstructed motion leaves, beside those that were found.
//!
//! The fit says how well the whole posterior explains a mark, by the path of its wheel; this compares the
//! mark of one motion with the mark that was found.

use schemars::JsonSchema;
use serde::Serialize;

use crate::evidence::{Evidence, Mark};
use crate::{CollisionMotion, StrikingMotion};
use impactlab_core::numerics::line_length;
use impactlab_core::vehicle::{
    ControlledVehicle, Integrator, Manoeuvre, TireMark, VehicleParameters, Wheel, tire_marks,
};

/// Distance of the places along a found mark that are compared, m.
const STEP_M: f64 = 0.1;

/// A mark that was found, beside the computed one of its wheel that lies nearest.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MarkComparison {
    /// Whether it is a mark of the striking car; of the struck car otherwise.
    pub is_of_striking_car: bool,
    /// The wheel.
    pub wheel: Wheel,
    /// Length of the mark that was found, m.
    pub found_length_m: f64,
    /// Length of the computed mark, m; 0 if the wheel leaves none.
    pub computed_length_m: f64,
    /// Mean over the found mark of the distance to the computed one, m; `None` if there is none.
    pub mean_distance_m: Option<f64>,
    /// Largest distance of a place on the found mark to the computed one, m; `None` if there is none.
    pub largest_distance_m: Option<f64>,
}

impl CollisionMotion {
    /// The marks that the struck car leaves. It is simulated with the loads of its wheels, in steps of
    /// 1 ms; no marks if that is not possible.
    pub fn tire_marks(&self) -> Vec<TireMark> {
        marks_left(&self.vehicle, &self.manoeuvre)
    }
}

impl StrikingMotion {
    /// The marks that the striking car leaves, computed as those of the struck car.
    pub fn tire_marks(&self) -> Vec<TireMark> {
        marks_left(&self.vehicle, &self.manoeuvre)
    }
}

fn marks_left(vehicle: &VehicleParameters, manoeuvre: &Manoeuvre) -> Vec<TireMark> {
    let Ok(motion) = vehicle.simulate(manoeuvre, Integrator::Rk4) else { return Vec::new() };
    let Manoeuvre { controls, friction_zones, .. } = manoeuvre;
    tire_marks(&motion.series, ControlledVehicle { vehicle, controls, friction_zones })
}

impl MarkComparison {
    /// Each mark that was found of the struck car beside the computed ones, in the order of the found
    /// ones, and then those of the striking car.
    pub fn of_both_cars(evidence: &Evidence, motion: &CollisionMotion) -> Vec<Self> {
        let mut all = Self::all(&evidence.marks, &motion.tire_marks());
        if let Some(striking) = &motion.striking {
            let of_striking = Self::all(&evidence.striking_marks, &striking.tire_marks());
            all.extend(of_striking.into_iter().map(|it| Self { is_of_striking_car: true, ..it }));
        }
        all
    }

    /// Each mark that was found of a car beside those that it leaves, in the order of the found ones.
    pub(crate) fn all(found: &[Mark], computed: &[TireMark]) -> Vec<Self> {
        found.iter().map(|mark| Self::new(mark, computed)).collect()
    }

    fn new(found: &Mark, computed: &[TireMark]) -> Self {
        let places = places_along(&found.points_m);
        let of_wheel = computed.iter().filter(|mark| mark.wheel == found.wheel);
        let compared = of_wheel.map(|mark| {
            let line: Vec<[f64; 2]> = mark.points.iter().map(|point| point.place_m).collect();
            let distances: Vec<f64> =
                places.iter().map(|place| distance_m(*place, &line)).collect();
            let mean = distances.iter().sum::<f64>() / distances.len().max(1) as f64;
            (mark.length_m(), mean, distances.into_iter().fold(0.0, f64::max))
        });
        let nearest = compared.min_by(|a, b| a.1.total_cmp(&b.1));
        Self {
            is_of_striking_car: false,
            wheel: found.wheel,
            found_length_m: line_length(&found.points_m),
            computed_length_m: nearest.map_or(0.0, |(length_m, ..)| length_m),
            mean_distance_m: nearest.map(|(_, mean_m, _)| mean_m),
            largest_distance_m: nearest.map(|(.., largest_m)| largest_m),
        }
    }
}

/// Places along a line, close to each other and evenly on each of its pieces.
fn places_along(line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut places: Vec<[f64; 2]> = line.first().copied().into_iter().collect();
    for pair in line.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let n = (line_length(pair) / STEP_M).ceil().clamp(1.0, 1e4) as usize;
        let at = |i: usize| {
            let share = i as f64 / n as f64;
            [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share]
        };
        places.extend((1..=n).map(at));
    }
    places
}

/// Distance of a place to the nearest one on a line, m; infinite without points.
fn distance_m([x, y]: [f64; 2], line: &[[f64; 2]]) -> f64 {
    let to_piece = |pair: &[[f64; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let [dx, dy] = [bx - ax, by - ay];
        let squared = dx * dx + dy * dy;
        let share = match squared > 0.0 {
            true => (((x - ax) * dx + (y - ay) * dy) / squared).clamp(0.0, 1.0),
            false => 0.0,
        };
        (x - ax - share * dx).hypot(y - ay - share * dy)
    };
    line.windows(2).map(to_piece).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::TireMarkPoint;

    fn computed(wheel: Wheel, line: &[[f64; 2]]) -> TireMark {
        let point = |place_m: &[f64; 2]| TireMarkPoint {
            time_s: place_m[0],
            place_m: *place_m,
            width_m: 0.2,
            darkness: 0.5,
            is_locked: true,
        };
        TireMark { wheel, points: line.iter().map(point).collect() }
    }

    #[test]
    fn a_mark_is_compared_with_the_nearest_one_of_its_wheel() {
        let found = Mark {
            wheel: Wheel::RearLeft,
            kind: None,
            points_m: vec![[0.0, 0.0], [4.0, 0.0]],
            sigma_m: None,
        };
        let far = computed(Wheel::RearLeft, &[[0.0, 9.0], [4.0, 9.0]]);
        let near = computed(Wheel::RearLeft, &[[-1.0, 0.0], [4.0, 1.0]]);
        let other = computed(Wheel::RearRight, &[[0.0, 0.0], [4.0, 0.0]]);
        let found = [found];
        let [comparison] = &MarkComparison::all(&found, &[far, near, other.clone()])[..] else {
            panic!("one mark was found");
        };
        let slope = 1.0 / 26.0_f64.sqrt();
        assert_eq!((comparison.wheel, comparison.found_length_m), (Wheel::RearLeft, 4.0));
        assert!((comparison.computed_length_m - 26.0_f64.sqrt()).abs() < 1e-12);
        // From 1 m to 5 m beyond where the computed mark begins; the last place has its foot on it.
        assert!((comparison.mean_distance_m.unwrap() - 3.0 * slope).abs() < 1e-9, "{comparison:?}");
        assert!(
            (comparison.largest_distance_m.unwrap() - 5.0 * slope).abs() < 1e-9,
            "{comparison:?}"
        );
        let none = MarkComparison::all(&found, &[other]);
        assert_eq!((none[0].computed_length_m, none[0].mean_distance_m), (0.0, None));
    }
}
