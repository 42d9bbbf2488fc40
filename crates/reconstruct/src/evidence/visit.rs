//! How the fields of the evidence are shown to what reads, writes, draws and tells them.
//!
//! Each item shows its fields once, in [`Item::fields`], and the evidence shows its items once, in
//! [`Evidence::items`](crate::evidence::Evidence::items). Everything else is a visitor, so that a field that
//! is read from a file is also written, drawn in the window, told in the report and mirrored.

use crate::evidence::{Bounds, Choice, Field, Sigma, Stated, Word};

/// An item of the evidence.
pub trait Item: Clone + Default + PartialEq {
    /// Whether items of this kind count as one where they say the same.
    const COUNTS_ONCE: bool = false;

    /// Shows every field. The item is taken apart without `..`, so that none is left out.
    fn fields(&mut self, visitor: &mut impl Fields);

    /// Whether nothing has been entered that says anything of the collision.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// What the card of an item is put beside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// What was found at the scene, on the struck car and in recorders.
    Scene,
    /// What is known of the cars.
    Cars,
    /// What is taken to be likely beforehand.
    Prior,
}

/// A part of the evidence, which is a table of a file, a card of the window and a group of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Section {
    /// Name of the table.
    pub key: &'static str,
    /// What a person calls it.
    pub title: &'static str,
    /// What its card is put beside.
    pub group: Group,
    /// Whether a file must have it.
    pub is_required: bool,
    /// What to do where it lacks something, after its title; empty for the usual words.
    pub missing: &'static str,
}

/// Coordinates with one standard deviation along each axis.
#[derive(Debug)]
pub struct PlaceMut<'a> {
    /// X, m.
    pub x_m: &'a mut Option<f64>,
    /// Y, m.
    pub y_m: &'a mut Option<f64>,
    /// One standard deviation, m; `None` for that of the program.
    pub sigma_m: &'a mut Option<f64>,
}

/// The points of a line with one standard deviation along each axis.
#[derive(Debug)]
pub struct PointsMut<'a> {
    /// The points, m.
    pub points_m: &'a mut Vec<[f64; 2]>,
    /// One standard deviation, m; `None` for that of the program.
    pub sigma_m: &'a mut Option<f64>,
}

/// Does something with each field of an item.
pub trait Fields {
    /// A number.
    fn number(&mut self, field: &Field, value: &mut Option<f64>);

    /// A number with its standard deviation.
    fn measured(&mut self, field: &Field, sigma: &Sigma, stated: &mut Option<Stated>) {
        let mut parts = stated.unwrap_or_default();
        let is_stated = parts.sigma.is_some();
        self.number(&field.required_if(field.is_required || is_stated), &mut parts.value);
        self.number(&sigma.field, &mut parts.sigma);
        *stated = (parts != Stated::default()).then_some(parts);
    }

    /// A place.
    fn place(&mut self, fields: [&Field; 2], sigma: &Sigma, place: PlaceMut<'_>) {
        let PlaceMut { x_m, y_m, sigma_m } = place;
        self.number(fields[0], x_m);
        self.number(fields[1], y_m);
        self.number(&sigma.field, sigma_m);
    }

    /// Points in the order of time.
    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>);

    /// Lower and upper bound of a record: two keys of a file.
    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>);

    /// A range of which each value is equally likely: one key of a file.
    fn interval(&mut self, field: &Field, interval: &mut Option<Bounds>) {
        self.bounds(field, interval);
    }

    /// One of several words.
    fn choice<W: Word>(&mut self, choice: &Choice, word: &mut W);

    /// One of several words, or none.
    fn optional_choice<W: Word>(&mut self, choice: &Choice, word: &mut Option<W>);

    /// Several words, each once; `None` if nobody looked.
    fn choices<W: Word>(&mut self, choice: &Choice, words: &mut Option<Vec<W>>);
}

/// Does something with each item of the evidence.
pub trait Items {
    /// An item that is there.
    ///
    /// - `idx`: its number among those of its kind, where there may be several.
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item);

    /// An item that may be there.
    fn optional<T: Item>(&mut self, section: &'static Section, item: &mut Option<T>) {
        if let Some(item) = item {
            self.item(section, None, item);
        }
    }

    /// Any number of items.
    fn many<T: Item>(&mut self, section: &'static Section, items: &mut Vec<T>) {
        for (idx, item) in items.iter_mut().enumerate() {
            self.item(section, Some(idx), item);
        }
    }
}
