//! The scene from above: vehicle paths with heading ticks, and vehicle outlines to scale.

use crate::figure::{Axis, Figure, FigureElement, LineStyle, Path, Role, Series};
use impactlab_core::collision::{Footprint, Pose};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::units::{Quantity, Unit, UnitSystem};

/// Time between the heading ticks along a path, s.
const HEADING_TICK_INTERVAL_S: f64 = 0.5;
/// Length of a heading tick ahead of and behind the CG, m.
const HEADING_TICK_LENGTH_M: f64 = 1.0;
/// Length of the chevron at the front, as a share of the vehicle's length.
const CHEVRON_SHARE: f64 = 0.15;

/// Outline of a vehicle from above, with a chevron at the front that shows its heading.
///
/// - `unit`: length unit of both axes.
pub fn vehicle_outline(
    name: &str,
    role: Role,
    style: LineStyle,
    footprint: &Footprint,
    pose: &Pose,
    unit: Unit,
) -> [FigureElement; 2] {
    let (front, half) = (footprint.cg_from_front_m, footprint.width_m / 2.0);
    let shoulder = front - CHEVRON_SHARE * footprint.length_m;
    let chevron = [[shoulder, -half], [front, 0.0], [shoulder, half]];
    let chevron = chevron.map(|point| pose.world_from_body(point)).to_vec();
    let series = |style, points| {
        let points = shown(unit, points);
        Series { name: name.to_owned(), role, style, points }
    };
    [
        FigureElement::Polygon(series(style, footprint.corners_m(pose).to_vec())),
        FigureElement::Line(series(LineStyle::Solid, chevron)),
    ]
}

/// A vehicle in a scene.
#[derive(Debug, Clone, Copy)]
pub struct SceneVehicle<'a> {
    /// Name in the legend.
    pub name: &'a str,
    /// Meaning of the colour.
    pub role: Role,
    /// Style of the path and of the outline.
    pub style: LineStyle,
    /// Motion of the vehicle; X and Y are required, and the heading is zero without yaw.
    pub motion: &'a TimeSeries,
    /// Outer dimensions of the vehicle.
    pub footprint: Footprint,
}

/// Data that the scene shows.
#[derive(Debug, Clone, Copy)]
pub struct SceneFigure<'a> {
    /// Title of the figure.
    pub title: &'a str,
    /// Vehicles, from back to front.
    pub vehicles: &'a [SceneVehicle<'a>],
    /// Time at which the vehicle outlines are drawn, s.
    pub time_s: f64,
    /// System of units of the axes.
    pub units: UnitSystem,
}

/// Paths of the vehicles with a heading tick every half second, and their outlines at one time.
pub fn scene_figure(input: &SceneFigure<'_>) -> Figure {
    let x = Axis::shown("X, along the road", Quantity::Length, input.units);
    let y = Axis::shown("Y, to the left", Quantity::Length, input.units);
    let mut elements = Vec::new();
    for vehicle in input.vehicles {
        elements.extend(vehicle_elements(vehicle, input.time_s, x.unit));
    }
    Figure::new(input.title, [x, y], elements).plan()
}

/// Path, heading ticks and outline of a vehicle; nothing if its motion has no X or Y.
///
/// - `time_s`: time of the outline, s.
/// - `unit`: length unit of both axes.
fn vehicle_elements(vehicle: &SceneVehicle<'_>, time_s: f64, unit: Unit) -> Vec<FigureElement> {
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
    let mut elements = vec![path_of(series(vehicle.style, path), motion)];
    let end = motion.time_s().last().copied().unwrap_or(0.0);
    let start = motion.time_s().first().copied().unwrap_or(0.0);
    let n_ticks = ((end - start) / HEADING_TICK_INTERVAL_S).floor() as usize;
    for tick in 1..=n_ticks {
        let at = start + tick as f64 * HEADING_TICK_INTERVAL_S;
        if let Some(pose) = Pose::from_motion(motion, at) {
            let ends = [-HEADING_TICK_LENGTH_M, HEADING_TICK_LENGTH_M];
            let points = ends.map(|along| pose.world_from_body([along, 0.0])).to_vec();
            elements.push(FigureElement::Line(series(LineStyle::Solid, points)));
        }
    }
    if let Some(pose) = Pose::from_motion(motion, time_s) {
        let SceneVehicle { name, role, style, footprint, .. } = vehicle;
        elements.extend(vehicle_outline(name, *role, *style, footprint, &pose, unit));
    }
    elements
}

/// The path of a motion with its times and headings.
pub(super) fn path_of(series: Series, motion: &TimeSeries) -> FigureElement {
    let yaw_rad = motion.get(Channel::Yaw).map(<[f64]>::to_vec).unwrap_or_default();
    FigureElement::Path(Path { series, time_s: motion.time_s().to_vec(), yaw_rad })
}

/// Points in m converted into a length unit.
pub(super) fn shown(unit: Unit, points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.into_iter().map(|point| point.map(|value| unit.from_si(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAR: Footprint = Footprint { length_m: 4.5, width_m: 1.8, cg_from_front_m: 2.0 };

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
        let pose = Pose { x_m: 15.0, y_m: 0.0, yaw_rad: 0.5 };
        assert_eq!(Pose::from_motion(&motion, 1.5), Some(pose));
        let vehicle = SceneVehicle {
            name: "car",
            role: Role::Target,
            style: LineStyle::Solid,
            motion: &motion,
            footprint: CAR,
        };
        let elements = vehicle_elements(&vehicle, 1.5, Quantity::Length.si_unit());
        assert_eq!(elements.len(), 1 + 4 + 2, "a path, four ticks, an outline with its chevron");
        let FigureElement::Path(path) = &elements[0] else { unreachable!() };
        assert_eq!(path.time_s, [0.0, 1.0, 2.0]);
        assert_eq!(path.yaw_rad, [0.0, 0.0, 1.0]);
    }
}
