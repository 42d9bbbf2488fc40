//! Where something was found: the points and lines of the evidence, for pictures and for how far a motion
//! has to be followed.

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Group, Item, Items, PlaceMut, PointsMut, Section,
    Sigma, Word, mark, rest,
};

/// A point or a line of the evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundPlace {
    /// What it is, for a legend: the item with what was chosen of it, such as the wheel of a mark.
    pub name: String,
    /// The part of the evidence that it belongs to.
    pub section: &'static Section,
    /// The points, m: one, or those of a line in the order of time.
    pub points_m: Vec<[f64; 2]>,
    /// Whether they are a line.
    pub is_line: bool,
}

impl FoundPlace {
    /// Whether it is the place of a car at rest, which is drawn as a car.
    pub fn is_rest(&self) -> bool {
        [rest::STRUCK.key, rest::STRIKING.key].contains(&self.section.key)
    }

    /// Whether the striking car was there; the struck car otherwise.
    pub fn is_of_striking_car(&self) -> bool {
        [rest::STRIKING.key, mark::STRIKING.key].contains(&self.section.key)
    }
}

impl Evidence {
    /// Every place that has been entered, in the order of the items.
    pub fn places(&self) -> Vec<FoundPlace> {
        let mut collected = Collected { section: None, words: Vec::new(), places: Vec::new() };
        self.clone().items(&mut collected);
        collected.places
    }
}

struct Collected {
    section: Option<&'static Section>,
    words: Vec<&'static str>,
    places: Vec<FoundPlace>,
}

impl Collected {
    fn add(&mut self, points_m: Vec<[f64; 2]>, is_line: bool) {
        let Some(section) = self.section.filter(|section| section.group == Group::Scene) else {
            return;
        };
        let name: Vec<&str> = std::iter::once(section.title).chain(self.words.clone()).collect();
        self.places.push(FoundPlace { name: name.join(", "), section, points_m, is_line });
    }
}

impl Items for Collected {
    fn item(&mut self, section: &'static Section, _: Option<usize>, item: &mut impl Item) {
        (self.section, self.words) = (Some(section), Vec::new());
        item.fields(self);
    }
}

impl Fields for Collected {
    fn number(&mut self, _: &Field, _: &mut Option<f64>) {}

    fn place(&mut self, _: [&Field; 2], _: &Sigma, place: PlaceMut<'_>) {
        if let (Some(x_m), Some(y_m)) = (*place.x_m, *place.y_m) {
            self.add(vec![[x_m, y_m]], false);
        }
    }

    fn points(&mut self, _: &Field, _: &Sigma, points: PointsMut<'_>) {
        self.add(points.points_m.clone(), true);
    }

    fn bounds(&mut self, _: &Field, _: &mut Option<Bounds>) {}

    fn choice<W: Word>(&mut self, _: &Choice, word: &mut W) {
        self.words.push(word.label());
    }

    fn optional_choice<W: Word>(&mut self, _: &Choice, _: &mut Option<W>) {}

    fn choices<W: Word>(&mut self, _: &Choice, _: &mut Option<Vec<W>>) {}
}
