//! Standard deviations that are stated and hardly meant: in centimetres where metres are asked for, or as a share
//! where the quantity is. One that is too small makes an item outweigh all others, one that is too large makes it
//! say nothing, and neither is seen in the answer.

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PlaceMut, PointsMut, Section, Sigma,
    Stated, Word,
};
use impactlab_core::units::{Phrase, PhraseValue};

/// Factor by which a stated standard deviation is larger than that of the program: far more than ways of measuring
/// differ, and less than between degrees and radians or metres and centimetres.
const ABOVE: f64 = 30.0;
/// Factor by which it is smaller. A scanner or a scale is up to 60 times as exact as a tape or the mass of a type.
const BELOW: f64 = 100.0;

impl Evidence {
    /// The stated standard deviations that are far from what such an item is known to, in words.
    pub fn odd_sigmas(&self) -> Vec<Phrase> {
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
    /// - `value`: what the standard deviation is of, SI.
    fn judge(&mut self, sigma: &Sigma, value: f64, stated: Option<f64>) {
        let Some(stated) = stated else { return };
        let usual = sigma.default_at(value);
        if (usual / BELOW..=usual * ABOVE).contains(&stated) {
            return;
        }
        let quantity = sigma.field.range.quantity;
        let text = Phrase::new(
            "{0}.{1} is {2}, where {3} is usual: it may be in another unit, or a share of the value",
            "{0}.{1} ist {2}, üblich sind {3}: vielleicht eine andere Einheit oder ein Anteil des Werts",
        )
        .with(PhraseValue::Name(self.table.clone()))
        .with(PhraseValue::Name(sigma.field.si_key()))
        .with(PhraseValue::three_digits(quantity, stated))
        .with(PhraseValue::three_digits(quantity, usual));
        self.found.push(text);
    }
}

impl Fields for OfItem<'_> {
    fn number(&mut self, _: &Field, _: &mut Option<f64>) {}

    fn measured(&mut self, _: &Field, sigma: &Sigma, stated: &mut Option<Stated>) {
        let Some(Stated { value: Some(value), sigma: of_value }) = *stated else { return };
        self.judge(sigma, value, of_value);
    }

    fn place(&mut self, _: [&Field; 2], sigma: &Sigma, place: PlaceMut<'_>) {
        self.judge(sigma, 0.0, *place.sigma_m);
    }

    fn points(&mut self, _: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        self.judge(sigma, 0.0, *points.sigma_m);
    }

    fn bounds(&mut self, _: &Field, _: &mut Option<Bounds>) {}

    fn choice<W: Word>(&mut self, _: &Choice, _: &mut W) {}

    fn optional_choice<W: Word>(&mut self, _: &Choice, _: &mut Option<W>) {}

    fn choices<W: Word>(&mut self, _: &Choice, _: &mut Option<Vec<W>>) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::Mark;
    use crate::evidence::examples::{SPIN, read};

    #[test]
    fn standard_deviations_in_another_unit_are_named() {
        let mut evidence = read(SPIN);
        assert!(evidence.odd_sigmas().is_empty(), "{:?}", evidence.odd_sigmas());
        let stated = |value, sigma| Some(Stated { value: Some(value), sigma: Some(sigma) });
        // A share of the mass, and centimetres.
        evidence.struck_car.mass_kg = stated(1500.0, 0.03);
        evidence.striking_car.mass_kg = stated(1500.0, 15.0);
        let points_m = vec![[1.0, 0.0], [9.0, 1.0]];
        evidence.marks = vec![Mark { points_m, sigma_m: Some(10.0), ..Mark::default() }];
        let found: Vec<String> =
            evidence.odd_sigmas().iter().map(|phrase| phrase.say(&Default::default())).collect();
        assert_eq!(found.len(), 2, "{found:?}");
        let mass = "struck_car.mass_sigma_kg is 0.03 kg, where 45 kg is usual: ";
        assert!(found[0].starts_with(mass), "{found:?}");
        assert!(found[1].starts_with("mark[0].sigma_m is 10 m, where 0.1 m is usual"), "{found:?}");
        // A scale to 1 kg and a scanner to 3 mm.
        evidence.struck_car.mass_kg = stated(1900.0, 1.0);
        evidence.marks[0].sigma_m = Some(0.003);
        assert!(evidence.odd_sigmas().is_empty(), "{:?}", evidence.odd_sigmas());
    }
}
