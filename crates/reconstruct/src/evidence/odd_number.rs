//! Numbers of the evidence that lie in their range and are hardly meant in their unit, as a place of rest in feet.

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PlaceMut, PointsMut, Section, Sigma,
    Stated, Word,
};
use impactlab_core::units::Phrase;

impl Evidence {
    /// The numbers that are hardly meant in their unit, in words.
    pub fn odd_numbers(&self) -> Vec<Phrase> {
        let mut search = OfItems(Vec::new());
        self.clone().items(&mut search);
        search.0
    }
}

/// What was found in all items.
struct OfItems(Vec<Phrase>);

impl Items for OfItems {
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item) {
        let number = idx.map_or_else(String::new, |idx| format!("[{idx}]"));
        let mut of_item = OfItem { table: format!("{}{number}", section.key), found: &mut self.0 };
        item.fields(&mut of_item);
    }
}

/// What is found in an item.
struct OfItem<'a> {
    /// Its name in a file.
    table: String,
    found: &'a mut Vec<Phrase>,
}

impl OfItem<'_> {
    /// - `value`: SI units.
    fn judge(&mut self, field: &Field, value: f64) {
        let key = format!("{}.{}", self.table, field.si_key());
        self.found.extend(field.range.odd(&key, value));
    }
}

impl Fields for OfItem<'_> {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        if let Some(value) = *value {
            self.judge(field, value);
        }
    }

    /// Standard deviations are judged by what is usual of them.
    fn measured(&mut self, field: &Field, _: &Sigma, stated: &mut Option<Stated>) {
        if let Some(Stated { value: Some(value), .. }) = *stated {
            self.judge(field, value);
        }
    }

    fn place(&mut self, fields: [&Field; 2], _: &Sigma, place: PlaceMut<'_>) {
        self.number(fields[0], place.x_m);
        self.number(fields[1], place.y_m);
    }

    /// The first point that is odd stands for all.
    fn points(&mut self, field: &Field, _: &Sigma, points: PointsMut<'_>) {
        let odd = points.points_m.iter().flatten().find(|at| field.range.odd("", **at).is_some());
        if let Some(&at) = odd {
            self.judge(field, at);
        }
    }

    /// The end that is larger in size; the other one may be next to nothing.
    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        let ends = bounds.iter().flatten().flatten().copied();
        if let Some(end) = ends.max_by(|a: &f64, b: &f64| a.abs().total_cmp(&b.abs())) {
            self.judge(field, end);
        }
    }

    fn choice<W: Word>(&mut self, _: &Choice, _: &mut W) {}

    fn optional_choice<W: Word>(&mut self, _: &Choice, _: &mut Option<W>) {}

    fn choices<W: Word>(&mut self, _: &Choice, _: &mut Option<Vec<W>>) {}
}

#[cfg(test)]
mod tests {
    use crate::evidence::Mark;
    use crate::evidence::examples::{SPIN, read};

    #[test]
    fn numbers_in_another_unit_are_named() {
        let said = |text: &str| -> Vec<String> {
            let evidence = read(text);
            evidence.odd_numbers().iter().map(|of| of.say(&Default::default())).collect()
        };
        assert_eq!(said(SPIN), Vec::<String>::new());
        let prior = format!("{SPIN}[prior]\nbrake_start_s = [0, 350]\n");
        let found = said(&prior);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("prior.brake_start_s is 350 s, and of"), "{found:?}");
        let mut evidence = read(SPIN);
        let points_m = vec![[0.0, 0.0], [900.0, 2.0], [950.0, 2.0]];
        evidence.marks = vec![Mark { points_m, ..Mark::default() }];
        let found = evidence.odd_numbers();
        assert_eq!(found.len(), 1, "{found:?}");
    }
}
