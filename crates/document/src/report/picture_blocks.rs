//! The pictures of a report: each once, those of one kind of all variants beside each other, without the
//! titles that their captions say, and with names in its language.

use crate::report::alt::alt_text;
use crate::report::answer::capitalized;
use crate::report::build::{VariantParts, parts_of};
use crate::report::document::Picture;
use crate::report::numbers::Wording;
use crate::report::parts::{Part, PartPicture};
use crate::report::{Block, Language, PictureContent};
use crate::scene::SceneStill;
use impactlab_core::uncertainty::{Caveat, Caveats};
use impactlab_core::units::{Phrase, PhraseValue};

/// A picture with those that have it.
struct Held<'a> {
    picture: &'a PartPicture,
    /// The collision that it shows.
    collision: &'a str,
    variants: Vec<&'a str>,
}

/// Every picture once, with its number: first those that take the width of a page, and of each kind one
/// variant after the other.
pub(super) fn picture_blocks(variants: &[VariantParts], wording: &Wording) -> Vec<Block> {
    let held = held_pictures(variants);
    let has_forecast = held.iter().any(|held| is_density(held.picture));
    let held: Vec<Held<'_>> =
        held.into_iter().filter(|it| !is_in_forecast(it, variants, wording)).collect();
    let are_several = held.iter().any(|it| held.iter().any(|of| of.collision != it.collision));
    let mut kinds: Vec<&str> = Vec::new();
    for Held { picture, .. } in &held {
        if !kinds.contains(&&*picture.caption) {
            kinds.push(&picture.caption);
        }
    }
    let mut shown: Vec<(&Held<'_>, PartPicture)> = held
        .iter()
        .map(|held| {
            let mut content = shown_content(&held.picture.content, wording);
            if let PictureContent::Scene(still) = &mut content {
                // A motion whose forecast stands there too is seen well enough in half of the width.
                still.is_half_wide |= has_forecast && !is_density(held.picture);
            }
            let caption = match are_several {
                true => format!("{}: {}", held.collision, held.picture.caption),
                false => held.picture.caption.clone(),
            };
            (held, PartPicture { caption: capitalized(&caption), content })
        })
        .collect();
    shown.sort_by_key(|(held, picture)| {
        let kind = kinds.iter().position(|caption| *caption == held.picture.caption);
        (picture.content.is_half_wide(), kind)
    });
    let figure = wording.words.figure;
    let block = |(idx, (held, picture)): (usize, (&Held<'_>, PartPicture))| {
        let (number, alt) = (idx + 1, alt_text(&picture, wording));
        let names = match held.variants.len() {
            _ if variants.len() == 1 => String::new(),
            n if n == variants.len() => format!(" ({})", wording.words.all_variants),
            _ => format!(" ({})", held.variants.join(", ")),
        };
        let caption = format!("{figure} {number}{names}: {}", picture.caption);
        Block::Picture(Box::new(Picture { number, caption, alt, content: picture.content }))
    };
    shown.into_iter().enumerate().map(block).collect()
}

fn held_pictures(variants: &[VariantParts]) -> Vec<Held<'_>> {
    let mut all: Vec<Held<'_>> = Vec::new();
    for variant in variants {
        for part in variant.answers.iter().flatten() {
            for picture in &part.pictures {
                let known = all.iter_mut().find(|held| held.picture.content == picture.content);
                match known {
                    Some(held) if held.variants.contains(&&*variant.name) => {}
                    Some(held) => held.variants.push(&variant.name),
                    None => {
                        let variants = vec![&*variant.name];
                        all.push(Held { picture, collision: collision_of(part), variants });
                    }
                }
            }
        }
    }
    all
}

/// Whether a picture is the end of a motion that the forecast of each of its variants shows too.
fn is_in_forecast(held: &Held<'_>, variants: &[VariantParts], wording: &Wording) -> bool {
    let PictureContent::Scene(end) = &held.picture.content else { return false };
    let shows_it = |picture: &PartPicture| match &picture.content {
        PictureContent::Scene(of) => {
            is_density(picture) && end.scene.cars.iter().all(|car| of.scene.cars.contains(car))
        }
        PictureContent::Figure(_) => false,
    };
    let has_forecast = |name: &&str| {
        let variant = variants.iter().find(|variant| variant.name == **name);
        let mut parts = variant.into_iter().flat_map(parts_of);
        parts.any(|part| part.pictures.iter().any(shows_it))
    };
    // What its ground lacks may stand behind the caption.
    let is_end = held.picture.caption.starts_with(wording.words.scene_picture);
    is_end && held.variants.iter().all(has_forecast)
}

/// Whether a picture shows where a vehicle may come to.
fn is_density(picture: &PartPicture) -> bool {
    matches!(&picture.content, PictureContent::Scene(it) if it.scene.density.is_some())
}

/// What the heading of a part says behind the kind of its question.
fn collision_of(part: &Part) -> &str {
    part.title.strip_prefix(&*part.kind).unwrap_or(&part.title).trim_start_matches(": ")
}

/// What is drawn, as the report shows it.
fn shown_content(content: &PictureContent, wording: &Wording) -> PictureContent {
    let name = |name: &mut String| *name = wording.name(name);
    match content {
        PictureContent::Figure(figure) => {
            let mut figure = figure.clone();
            figure.title.clear();
            figure.language = wording.language;
            figure.caveats = told(&figure.caveats, wording);
            figure.elements.iter_mut().for_each(|element| name(element.name_mut()));
            for axis in [&mut figure.x, &mut figure.y] {
                name(&mut axis.label);
                axis.names.iter_mut().for_each(name);
                axis.unit.symbol = unit_symbol(axis.unit.symbol, wording.language);
            }
            PictureContent::Figure(figure)
        }
        PictureContent::Scene(still) => PictureContent::Scene(shown_still(still, wording)),
    }
}

/// The symbol of a unit in a language.
fn unit_symbol(symbol: &'static str, language: Language) -> &'static str {
    match (language, symbol) {
        (Language::De, "deg") => "°",
        (Language::De, "deg/s") => "°/s",
        _ => symbol,
    }
}

/// A scene as the report shows it.
fn shown_still(still: &SceneStill, wording: &Wording) -> SceneStill {
    let name = |name: &mut String| *name = wording.name(name);
    let mut scene = (*still.scene).clone();
    scene.title.clear();
    scene.language = wording.language;
    scene.caveats = told(&scene.caveats, wording);
    for car in &mut scene.cars {
        name(&mut car.name);
        name(&mut car.tag);
    }
    scene.paths.iter_mut().for_each(|it| name(&mut it.name));
    scene.lines.iter_mut().for_each(|it| name(&mut it.name));
    scene.marks.iter_mut().for_each(|it| name(&mut it.name));
    scene.crushes.iter_mut().for_each(|it| name(&mut it.name));
    scene.points.iter_mut().for_each(|it| name(&mut it.name));
    scene.arrows.iter_mut().for_each(|it| name(&mut it.name));
    scene.forces.iter_mut().for_each(|it| name(&mut it.name));
    scene.crosses.iter_mut().for_each(|it| name(&mut it.name));
    scene.density.iter_mut().for_each(|it| name(&mut it.name));
    SceneStill { scene: scene.into(), ..still.clone() }
}

/// Caveats with their sentences in the language and the units of the report, and without what a picture
/// would make others from.
fn told(caveats: &Caveats, wording: &Wording) -> Caveats {
    let told = |caveat: &Caveat| {
        let text = wording.caveat_text(caveat);
        // It is in the language of the report already: a picture puts it in no quotation marks.
        let text_phrase = Some(Phrase::of(PhraseValue::Name(text.clone())));
        Caveat { text, text_phrase, ..caveat.clone() }
    };
    caveats.iter().map(told).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::figure::{Axis, Figure, FigureElement, Role};
    use crate::report::{Paper, ReportDate, ReportSettings};
    use crate::scene::{
        CarBody, CarLook, CarMotion, CarShape, Scene, SceneCar, SceneDensity, SceneRole, ViewKind,
    };
    use impactlab_core::collision::{Footprint, Pose};
    use impactlab_core::uncertainty::PlanarGrid;
    use impactlab_core::units::{Quantity, UnitSystem};
    use impactlab_core::vehicle::Preset;
    use impactlab_reconstruct::Mode;
    use impactlab_study::ReconstructedPaths;
    use impactlab_study::analysis::DensityMap;

    /// “36.9 %: the struck car turns right by 90° to 270°, the driver does not brake” stood in German legends.
    #[test]
    fn a_course_of_events_has_its_german_name_and_decimal_sign() {
        let date = ReportDate::new(2026, 11, 24).unwrap();
        let (language, units, paper) = (Language::De, UnitSystem::Si, Paper::A4);
        let german = Wording::new(&ReportSettings { language, units, paper, date });
        let course = Mode {
            name: "the struck car turns right by 90° to 270°, the driver does not brake".to_owned(),
            probability: 0.369,
            standard_error: 0.02,
            quantities: Vec::new(),
            members: Vec::new(),
        };
        let told = |wording: &Wording| {
            ReconstructedPaths::course_name(&course, wording, &|label| wording.name(label))
        };
        let expected = "36,9 %: das gestoßene Fahrzeug dreht sich um 90° bis 270° nach rechts, der Fahrer bremst \
                        nicht";
        assert_eq!(told(&german), expected);
        // What a picture has in the language of the report already stays as it is.
        assert_eq!(german.name(expected), expected);
        let english =
            "36.9 %: the struck car turns right by 90° to 270°, the driver does not brake";
        assert_eq!(told(&Wording::english(UnitSystem::Si)), english);
    }

    fn part(heading: f64) -> Part {
        let [x, y] =
            ["Time", "Force"].map(|label| Axis::shown(label, Quantity::Time, UnitSystem::Si));
        let points = vec![[0.0, heading], [1.0, 2.0]];
        let elements = vec![FigureElement::line("striking vehicle", Role::Striking, points)];
        let figure = Figure::new("PIT: force over time", [x, y], elements);
        Part {
            kind: "Motion".to_owned(),
            title: "Motion: PIT".to_owned(),
            pictures: vec![PartPicture::figure("force over time".to_owned(), figure)],
            ..Part::default()
        }
    }

    fn variant(name: &str, part: Part) -> VariantParts {
        VariantParts { name: name.to_owned(), notes: String::new(), answers: vec![Ok(part)] }
    }

    fn pictures(blocks: &[Block]) -> Vec<&Picture> {
        let pictures = blocks.iter().filter_map(|block| match block {
            Block::Picture(picture) => Some(&**picture),
            _ => None,
        });
        pictures.collect()
    }

    #[test]
    fn pictures_of_a_kind_stand_together_and_say_whose_they_are() {
        let mut second = part(3.0);
        second.pictures.insert(
            0,
            PartPicture { caption: "another".to_owned(), ..part(4.0).pictures[0].clone() },
        );
        let variants = [variant("a", part(1.0)), variant("b", second), variant("c", part(1.0))];
        let blocks = picture_blocks(&variants, &Wording::english(UnitSystem::Si));
        let captions: Vec<&str> =
            pictures(&blocks).into_iter().map(|picture| &*picture.caption).collect();
        assert_eq!(
            captions,
            [
                "Figure 1 (a, c): Force over time",
                "Figure 2 (b): Force over time",
                "Figure 3 (b): Another",
            ]
        );
    }

    /// A car along X at a speed, and over it a density, if it is a forecast.
    fn scene(speed_m_s: f64, is_forecast: bool) -> PartPicture {
        let vehicle = Preset::Reference.parameters();
        let body = CarBody::new(&vehicle, &Footprint::from(&vehicle.geometry));
        let poses = [0.0, 1.0].map(|s| Pose { x_m: speed_m_s * s, y_m: 0.0, yaw_rad: 0.0 });
        let motion = CarMotion::from_poses(&poses, 1.0, &body).unwrap();
        let car = SceneCar {
            name: "4DOF simulation".to_owned(),
            tag: "struck".to_owned(),
            role: SceneRole::Simulated,
            look: CarLook::Solid,
            shape: Arc::new(CarShape::new(body)),
            motion: Arc::new(motion),
        };
        let grid = PlanarGrid { low_m: [0.0; 2], step_m: [1.0; 2], size: [1; 2] };
        let map = DensityMap {
            window_s: [1.0; 2],
            grid,
            values: Arc::new(vec![1.0]),
            regions: Vec::new(),
        };
        let density = SceneDensity { name: "density".to_owned(), map: Arc::new(map), peak: 1.0 };
        let scene =
            Scene { cars: vec![car], density: is_forecast.then_some(density), ..Scene::default() };
        let words = Wording::english(UnitSystem::Si).words;
        let caption = if is_forecast { words.forecast_scene_picture } else { words.scene_picture };
        let still = SceneStill {
            scene: Arc::new(scene),
            time_s: 1.0,
            view: ViewKind::Above,
            near_m: None,
            is_half_wide: false,
        };
        PartPicture::still(caption.to_owned(), still)
    }

    /// The end of a motion that another question of the collision has otherwise was left out, too.
    #[test]
    fn only_a_motion_that_a_forecast_shows_has_no_picture_of_its_end() {
        let n_shown = |speed_m_s: f64| {
            let scenes = vec![scene(speed_m_s, false), scene(15.0, true)];
            let part = Part { pictures: scenes, ..part(1.0) };
            let variants = [variant("a", part)];
            pictures(&picture_blocks(&variants, &Wording::english(UnitSystem::Si))).len()
        };
        assert_eq!([15.0, 12.0].map(n_shown), [1, 2]);
    }

    /// Axes and legends of a German report were English, and the title of a picture repeated its caption.
    #[test]
    fn names_in_pictures_are_in_the_language_of_the_report() {
        let settings = ReportSettings {
            language: Language::De,
            units: UnitSystem::Si,
            paper: Paper::A4,
            date: ReportDate::new(2026, 1, 2).unwrap(),
        };
        let blocks = picture_blocks(&[variant("a", part(1.0))], &Wording::new(&settings));
        let [picture] = pictures(&blocks)[..] else { panic!("one picture") };
        let PictureContent::Figure(figure) = &picture.content else { panic!("a plot") };
        assert_eq!(figure.title, "");
        assert_eq!([&*figure.x.label, &*figure.y.label], ["Zeit", "Kraft"]);
        assert_eq!(figure.elements[0].name(), "stoßendes Fahrzeug");
        assert!(picture.alt.contains("stoßendes Fahrzeug"), "{}", picture.alt);
        assert_eq!(unit_symbol("deg/s", Language::De), "°/s");
        assert_eq!(unit_symbol("deg/s", Language::En), "deg/s");
    }
}
