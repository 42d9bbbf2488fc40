//! The scene from above: paths, vehicles to scale, headings.

use crate::data::{Channel, TimeSeries};
use crate::figure::{Axis, Element, Figure, LineStyle, Role, Series};
use crate::numerics::interpolate;
use crate::units::{Quantity, Unit, UnitSystem};
use crate::vehicle::frames::world_from_body;
use crate::vehicle::GeometryParameters;

/// Interval of the heading ticks along a path, s.
const HEADING_TICK_INTERVAL_S: f64 = 0.5;
/// Length of a heading tick to each side of the path, m.
const HEADING_TICK_LENGTH_M: f64 = 1.0;
/// Share of the length at which the nose of an outline begins to taper.
const NOSE_SHARE: f64 = 0.82;

/// Outer dimensions of a vehicle seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// Outer length, m.
    pub length_m: f64,
    /// Outer width, m.
    pub width_m: f64,
    /// CG to front end, m.
    pub cg_to_front_end_m: f64,
}

impl From<&GeometryParameters> for Footprint {
    fn from(geometry: &GeometryParameters) -> Self {
        Self {
            length_m: geometry.outer_length_m,
            width_m: geometry.outer_width_m,
            cg_to_front_end_m: geometry.cg_to_front_end_m,
        }
    }
}

impl Footprint {
    /// Outline in world axes, m: a rectangle whose front corners are cut, so that one sees which
    /// way it points.
    pub fn outline_m(&self, [x, y, yaw_rad]: [f64; 3]) -> Vec<[f64; 2]> {
        let front = self.cg_to_front_end_m;
        let (rear, half) = (front - self.length_m, self.width_m / 2.0);
        let shoulder = rear + NOSE_SHARE * self.length_m;
        let corners = [
            [rear, -half],
            [shoulder, -half],
            [front, -0.6 * half],
            [front, 0.6 * half],
            [shoulder, half],
            [rear, half],
        ];
        let place = |corner| {
            let [dx, dy] = world_from_body(yaw_rad, corner);
            [x + dx, y + dy]
        };
        corners.map(place).to_vec()
    }
}

/// One vehicle of a scene.
#[derive(Debug, Clone, Copy)]
pub struct SceneVehicle<'a> {
    /// As in the legend.
    pub name: &'a str,
    /// Meaning of the colour.
    pub role: Role,
    /// How its path is drawn.
    pub style: LineStyle,
    /// Its motion; X, Y, yaw are needed.
    pub motion: &'a TimeSeries,
    /// Its outer dimensions.
    pub footprint: Footprint,
}

/// What the scene shows.
#[derive(Debug, Clone, Copy)]
pub struct SceneFigure<'a> {
    /// What it is.
    pub title: &'a str,
    /// The vehicles, from back to front.
    pub vehicles: &'a [SceneVehicle<'a>],
    /// Vehicles that stand for the moment of impact: name, role, outer dimensions and pose (X, Y, ψ).
    pub at_impact: &'a [(&'a str, Role, Footprint, [f64; 3])],
    /// The moment at which the vehicles are drawn, s.
    pub time_s: f64,
    /// Units of the axes.
    pub units: UnitSystem,
}

/// Paths with a heading tick every half second, and the vehicles to scale at a moment.
pub fn scene_figure(input: &SceneFigure<'_>) -> Figure {
    let x = Axis::shown("X, along the road", Quantity::Length, input.units);
    let y = Axis::shown("Y, to the left", Quantity::Length, input.units);
    let mut elements = Vec::new();
    for &(name, role, footprint, pose) in input.at_impact {
        elements.push(Element::polygon(name, role, shown(x.unit, footprint.outline_m(pose))));
    }
    for vehicle in input.vehicles {
        elements.extend(vehicle_elements(vehicle, input.time_s, x.unit));
    }
    Figure { title: input.title.to_owned(), x, y, equal_aspect: true, elements }
}

fn vehicle_elements(vehicle: &SceneVehicle<'_>, time_s: f64, unit: Unit) -> Vec<Element> {
    let motion = vehicle.motion;
    let (Some(x), Some(y)) = (motion.get(Channel::X), motion.get(Channel::Y)) else {
        return Vec::new();
    };
    let series = |style, points| Series {
        name: vehicle.name.to_owned(),
        role: vehicle.role,
        style,
        points: shown(unit, points),
    };
    let path = x.iter().zip(y).map(|(&x, &y)| [x, y]).collect();
    let mut elements = vec![Element::Line(series(vehicle.style, path))];
    let end = motion.time_s().last().copied().unwrap_or(0.0);
    let start = motion.time_s().first().copied().unwrap_or(0.0);
    let n_ticks = ((end - start) / HEADING_TICK_INTERVAL_S).floor() as usize;
    for tick in 1..=n_ticks {
        let at = start + tick as f64 * HEADING_TICK_INTERVAL_S;
        if let Some([x, y, yaw]) = pose_at(motion, at) {
            let [dx, dy] = world_from_body(yaw, [HEADING_TICK_LENGTH_M, 0.0]);
            let points = vec![[x - dx, y - dy], [x + dx, y + dy]];
            elements.push(Element::Line(series(LineStyle::Solid, points)));
        }
    }
    if let Some(pose) = pose_at(motion, time_s) {
        let outline = vehicle.footprint.outline_m(pose);
        elements.push(Element::Polygon(series(vehicle.style, outline)));
    }
    elements
}

/// Pose (X, Y, ψ) at a moment; without a yaw column the heading is 0.
pub(super) fn pose_at(motion: &TimeSeries, time_s: f64) -> Option<[f64; 3]> {
    let at = |channel| interpolate(motion.time_s(), motion.get(channel)?, time_s);
    Some([at(Channel::X)?, at(Channel::Y)?, at(Channel::Yaw).unwrap_or(0.0)])
}

pub(super) fn shown(unit: Unit, points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.into_iter().map(|point| point.map(|value| unit.from_si(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAR: Footprint = Footprint { length_m: 4.5, width_m: 1.8, cg_to_front_end_m: 2.0 };

    #[test]
    fn an_outline_has_the_vehicles_length_along_its_heading() {
        let outline = CAR.outline_m([10.0, 5.0, std::f64::consts::FRAC_PI_2]);
        let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| {
            (low.min(p[1]), high.max(p[1]))
        });
        assert!((high - 7.0).abs() < 1e-12 && (low - 2.5).abs() < 1e-12, "{low} {high}");
    }

    #[test]
    fn the_vehicle_stands_where_it_is_at_the_time() {
        let mut motion = TimeSeries::new(vec![0.0, 1.0, 2.0]).unwrap();
        for (channel, values) in [
            (Channel::X, vec![0.0, 10.0, 20.0]),
            (Channel::Y, vec![0.0; 3]),
            (Channel::Yaw, vec![0.0, 0.0, 1.0]),
        ] {
            motion.insert(channel, values).unwrap();
        }
        assert_eq!(pose_at(&motion, 1.5), Some([15.0, 0.0, 0.5]));
        let vehicle = SceneVehicle {
            name: "car",
            role: Role::Target,
            style: LineStyle::Solid,
            motion: &motion,
            footprint: CAR,
        };
        let elements = vehicle_elements(&vehicle, 1.5, Quantity::Length.si_unit());
        assert_eq!(elements.len(), 1 + 4 + 1, "a path, four ticks, an outline");
    }
}
