//! What a picture shows, with its values, for those who cannot see it.

use crate::figure::{Figure, FigureElement, Series};
use crate::report::PictureContent;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::PartPicture;
use crate::scene::{SceneCar, SceneStill};
use impactlab_core::units::Quantity;

/// Elements of a picture whose values are told; of more the names alone are.
const MOST_TOLD: usize = 8;

/// The text that stands for a picture.
pub(super) fn alt_text(picture: &PartPicture, wording: &Wording) -> String {
    match &picture.content {
        PictureContent::Scene(still) => scene_text(&picture.caption, still, wording),
        PictureContent::Figure(figure) => figure_text(&picture.caption, figure, wording),
    }
}

fn scene_text(title: &str, still: &SceneStill, wording: &Wording) -> String {
    let words = wording.words;
    let values = [("title", title), ("names", &*listed(still.names()))];
    let mut sentences = vec![fill(words.scene_alt, &values)];
    // To a tenth: as far as a picture can be read.
    let value = |si: f64, quantity: Quantity| {
        let unit = quantity.display_unit(wording.units);
        wording.with_unit(&wording.fixed(unit.from_si(si), 1), unit.symbol)
    };
    // Where one of several cars that belong together is, such as a draw, says nothing of the others.
    let cars = &still.scene.cars;
    let is_alone = |car: &&SceneCar| cars.iter().filter(|of| of.name == car.name).count() == 1;
    for car in cars.iter().filter(is_alone).take(MOST_TOLD) {
        let pose = car.at(still.time_s).pose;
        let values = [
            ("name", &*car.name),
            ("time", &*wording.given(Quantity::Time, still.time_s)),
            ("x", &*value(pose.x_m, Quantity::Length)),
            ("y", &*value(pose.y_m, Quantity::Length)),
            ("heading", &*value(pose.yaw_rad, Quantity::Angle)),
        ];
        sentences.push(fill(words.car_alt, &values));
    }
    sentences.join(" ")
}

fn figure_text(title: &str, figure: &Figure, wording: &Wording) -> String {
    let words = wording.words;
    let names = listed(figure.elements.iter().map(FigureElement::name));
    let [x, y] = [figure.x.text(), figure.y.text()];
    let values = [("title", title), ("x", &*x), ("y", &*y), ("names", &*names)];
    let mut sentences = vec![fill(words.axes_alt, &values)];
    let told = figure.elements.iter().filter_map(|element| element_text(element, figure, wording));
    sentences.extend(told.take(MOST_TOLD));
    sentences.join(" ")
}

/// The values of an element, in the units of the axes; none of what has no few values.
fn element_text(element: &FigureElement, figure: &Figure, wording: &Wording) -> Option<String> {
    let words = wording.words;
    if !(figure.x.names.is_empty() && figure.y.names.is_empty()) {
        return None;
    }
    match element {
        FigureElement::Line(series) | FigureElement::Path(crate::figure::Path { series, .. }) => {
            line_text(series, figure.equal_aspect, wording)
        }
        FigureElement::Arrow(series) => line_text(series, true, wording),
        FigureElement::Band(band) => {
            let (x, low, high) = (band.x.last()?, band.low.last()?, band.high.last()?);
            let of_axis = largest(band.low.iter().chain(&band.high).copied());
            let x = read_off(*x, largest(band.x.iter().copied()), wording);
            let [low, high] = [*low, *high].map(|value| read_off(value, of_axis, wording));
            let values = [("name", &*band.name), ("x", &*x), ("low", &*low), ("high", &*high)];
            Some(fill(words.band_alt, &values))
        }
        FigureElement::VerticalLine { name, x, .. } => {
            Some(fill(words.instant_alt, &[("name", name), ("x", &wording.number(*x))]))
        }
        FigureElement::Points(_)
        | FigureElement::Polygon(_)
        | FigureElement::HeatMap(_)
        | FigureElement::CellMap(_) => None,
    }
}

/// Where a line begins and ends; in a plan the two places, over an axis the least and the greatest value.
fn line_text(series: &Series, is_plan: bool, wording: &Wording) -> Option<String> {
    let is_finite = |point: &&[f64; 2]| point.iter().all(|value| value.is_finite());
    let finite: Vec<[f64; 2]> = series.points.iter().filter(is_finite).copied().collect();
    let (first, last) = (finite.first()?, finite.last()?);
    let least = finite.iter().min_by(|a, b| a[1].total_cmp(&b[1]))?;
    let greatest = finite.iter().max_by(|a, b| a[1].total_cmp(&b[1]))?;
    let largest_x = largest(finite.iter().map(|[x, _]| *x));
    let largest_y = largest(finite.iter().map(|[_, y]| *y));
    let number =
        |[x, y]: [f64; 2]| [read_off(x, largest_x, wording), read_off(y, largest_y, wording)];
    let ([x0, y0], [x1, y1]) = (number(*first), number(*last));
    let ([at_low, low], [at_high, high]) = (number(*least), number(*greatest));
    let template = if is_plan { wording.words.place_alt } else { wording.words.line_alt };
    let values = [
        ("name", &*series.name),
        ("x0", &*x0),
        ("y0", &*y0),
        ("x1", &*x1),
        ("y1", &*y1),
        ("low", &*low),
        ("at_low", &*at_low),
        ("high", &*high),
        ("at_high", &*at_high),
    ];
    (!series.name.is_empty()).then(|| fill(template, &values))
}

/// The largest size of some values.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

/// A value as it can be read off a curve: to about a thousandth of the largest one.
fn read_off(value: f64, largest: f64, wording: &Wording) -> String {
    if largest == 0.0 || !largest.is_finite() {
        return wording.number(value);
    }
    let decimals = (2 - largest.log10().floor() as i32).clamp(0, 6) as usize;
    wording.fixed(value, decimals)
}

/// Names, each once.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut each: Vec<&str> = Vec::new();
    for name in names {
        if !name.is_empty() && !each.contains(&name) {
            each.push(name);
        }
    }
    each.join(", ")
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::figure::{Axis, Role};
    use crate::scene::{CarBody, CarLook, CarMotion, CarShape, Scene, SceneRole, ViewKind};
    use impactlab_core::collision::{Footprint, Pose};
    use impactlab_core::units::UnitSystem;
    use impactlab_core::vehicle::Preset;

    /// The place of the first of thirty draws stood there as that of “draws of the forecast”.
    #[test]
    fn a_place_is_told_of_no_cars_that_share_a_name() {
        let vehicle = Preset::Reference.parameters();
        let body = CarBody::new(&vehicle, &Footprint::from(&vehicle.geometry));
        let car = |name: &str, x_m: f64| {
            let poses = [x_m, x_m + 1.0].map(|x_m| Pose { x_m, y_m: 0.0, yaw_rad: 0.0 });
            SceneCar {
                name: name.to_owned(),
                tag: String::new(),
                role: SceneRole::Forecast,
                look: CarLook::Ghost,
                shape: Arc::new(CarShape::new(body)),
                motion: Arc::new(CarMotion::from_poses(&poses, 1.0, &body).unwrap()),
            }
        };
        let cars = vec![car("draws", 10.0), car("draws", 20.0), car("central path", 30.0)];
        let still = SceneStill {
            scene: Arc::new(Scene { cars, ..Scene::default() }),
            time_s: 1.0,
            view: ViewKind::Above,
            near_m: None,
            is_half_wide: false,
        };
        let text = scene_text("Forecast", &still, &Wording::english(UnitSystem::Si));
        assert!(text.contains("draws") && text.contains("central path: X 31.0 m"), "{text}");
        assert!(!text.contains("draws: X"), "{text}");
    }

    /// A yaw rate ended at “-0.000032 deg/s”, and the names of a curve had no more than that.
    #[test]
    fn a_curve_has_no_digits_that_cannot_be_read_off() {
        let wording = Wording::english(UnitSystem::Si);
        assert_eq!(read_off(-0.000_032, 122.5, &wording), "0");
        assert_eq!(read_off(-122.46, 122.5, &wording), "-122");
        assert_eq!(read_off(1.84, 4.0, &wording), "1.84");
        assert_eq!(read_off(0.25, 0.0, &wording), "0.2500");
    }

    #[test]
    fn a_curve_is_told_by_its_ends_and_its_extremes() {
        let axes = [
            Axis::shown("Time", Quantity::Time, UnitSystem::Si),
            Axis::shown("Force", Quantity::Force, UnitSystem::Si),
        ];
        let curve = vec![[0.0, 1.0], [0.1, 60.5], [0.2, -2.0], [0.3, 4.0]];
        let elements = vec![FigureElement::line("|F|", Role::Resultant, curve)];
        let picture =
            PartPicture::figure("Contact force".to_owned(), Figure::new("force", axes, elements));
        let text = alt_text(&picture, &Wording::english(UnitSystem::Si));
        for value in ["Contact force", "|F|", "60.5", "0.1", "-2", "0.3", "4"] {
            assert!(text.contains(value), "{value:?} is not in {text}");
        }
    }
}
