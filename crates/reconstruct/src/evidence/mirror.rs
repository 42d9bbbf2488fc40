//! What a mirror on the X axis shows of the evidence: left and right are swapped.

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PointsMut, Section, Sigma, Word,
};

impl Evidence {
    /// What a mirror on the X axis shows.
    pub fn mirrored(&self) -> Self {
        let mut mirror = self.clone();
        mirror.items(&mut Mirror);
        mirror
    }
}

struct Mirror;

impl Items for Mirror {
    fn item(&mut self, _: &'static Section, _: Option<usize>, item: &mut impl Item) {
        item.fields(self);
    }
}

impl Fields for Mirror {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        if field.is_turned {
            *value = value.map(|value| -value);
        }
    }

    fn points(&mut self, _: &Field, _: &Sigma, points: PointsMut<'_>) {
        points.points_m.iter_mut().for_each(|[_, y_m]| *y_m = -*y_m);
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        if field.is_turned {
            *bounds = bounds.map(|[low, high]| [high.map(|end| -end), low.map(|end| -end)]);
        }
    }

    fn choice<W: Word>(&mut self, _: &Choice, word: &mut W) {
        *word = word.mirrored();
    }

    fn optional_choice<W: Word>(&mut self, _: &Choice, word: &mut Option<W>) {
        *word = word.map(W::mirrored);
    }

    fn choices<W: Word>(&mut self, _: &Choice, words: &mut Option<Vec<W>>) {
        words.iter_mut().flatten().for_each(|word| *word = word.mirrored());
    }
}
