//! Numbers of the evidence that are hardly meant as they stand, although they lie in their ranges.
//!
//! - Values in another unit, as a place of rest in feet.
//! - Stated standard deviations in centimetres where metres are asked for, or as a share where the quantity is. One
//!   that is too small makes an item outweigh all others, one that is too large makes it say nothing, and neither is
//!   seen in the answer.
//! - Bounds of a record that leave no room for its error.
//! - Drag factors that the road does not allow.

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PlaceMut, PointsMut, Section, Sigma,
    Stated, Word, ends,
};
use impactlab_core::units::{Phrase, PhraseValue};

/// Factor by which a stated standard deviation is larger than that of the program: far more than ways of measuring
/// differ, and less than between degrees and radians or metres and centimetres.
const ABOVE: f64 = 30.0;
/// Factor by which it is smaller. A scanner or a scale is up to 60 times as exact as a tape or the mass of a type.
const BELOW: f64 = 100.0;

/// Distance of the bounds of a record over its size below which nobody meant its error: recorders are off by up to a
/// tenth to either side (49 CFR 563.8), and the best of them by a fifth of that.
const NARROWEST: f64 = 0.04;

impl Evidence {
    /// What is hardly meant as it is stated, in words: standard deviations far from what such an item is known to,
    /// drag that the road does not allow, and values in another unit, in this order.
    pub(super) fn odd_values(&self) -> Vec<Phrase> {
        let mut search = OfItems::default();
        self.clone().items(&mut search);
        let OfItems { sigmas, numbers } = search;
        [sigmas, self.odd_drags(), numbers].concat()
    }
}

/// What was found in all items.
#[derive(Default)]
struct OfItems {
    sigmas: Vec<Phrase>,
    numbers: Vec<Phrase>,
}

impl Items for OfItems {
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item) {
        let number = idx.map_or_else(String::new, |idx| format!("[{idx}]"));
        let mut of_item = OfItem { table: format!("{}{number}", section.key), found: self };
        item.fields(&mut of_item);
    }
}

/// What is found in an item.
struct OfItem<'a> {
    /// Its name in a file.
    table: String,
    found: &'a mut OfItems,
}

impl OfItem<'_> {
    /// - `value`: SI units.
    fn judge_number(&mut self, field: &Field, value: f64) {
        let key = format!("{}.{}", self.table, field.si_key());
        self.found.numbers.extend(field.range.odd(&key, value));
    }

    /// - `value`: what the standard deviation is of, SI.
    fn judge_sigma(&mut self, sigma: &Sigma, value: f64, stated: Option<f64>) {
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
        self.found.sigmas.push(text);
    }

    /// The end that is larger in size; the other one may be next to nothing.
    fn judge_ends(&mut self, field: &Field, bounds: Option<Bounds>) {
        let ends = bounds.iter().flatten().flatten().copied();
        if let Some(end) = ends.max_by(|a: &f64, b: &f64| a.abs().total_cmp(&b.abs())) {
            self.judge_number(field, end);
        }
    }

    fn judge_distance(&mut self, field: &Field, bounds: Option<Bounds>) {
        let Some([low, high]) = ends(bounds) else { return };
        if high - low >= NARROWEST * low.abs().max(high.abs()) {
            return;
        }
        let text = Phrase::new(
            "{0}.{1} and {2} lie {3} apart, and recorders are off by up to 10 %: give the bounds between which the \
             change of velocity may lie",
            "{0}.{1} und {2} liegen {3} auseinander, Unfalldatenspeicher weichen aber um bis zu 10 % ab: die Grenzen \
             angeben, zwischen denen die Geschwindigkeitsänderung liegen kann",
        )
        .with(PhraseValue::Name(self.table.clone()))
        .with(PhraseValue::Name(field.si_key_with("_min")))
        .with(PhraseValue::Name(field.si_key_with("_max")))
        .with(PhraseValue::three_digits(field.range.quantity, high - low));
        self.found.sigmas.push(text);
    }
}

impl Fields for OfItem<'_> {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        if let Some(value) = *value {
            self.judge_number(field, value);
        }
    }

    fn measured(&mut self, field: &Field, sigma: &Sigma, stated: &mut Option<Stated>) {
        let Some(Stated { value: Some(value), sigma: of_value }) = *stated else { return };
        self.judge_number(field, value);
        self.judge_sigma(sigma, value, of_value);
    }

    fn place(&mut self, fields: [&Field; 2], sigma: &Sigma, place: PlaceMut<'_>) {
        self.number(fields[0], place.x_m);
        self.number(fields[1], place.y_m);
        self.judge_sigma(sigma, 0.0, *place.sigma_m);
    }

    /// The first point that is odd stands for all.
    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        let odd = points.points_m.iter().flatten().find(|at| field.range.odd("", **at).is_some());
        if let Some(&at) = odd {
            self.judge_number(field, at);
        }
        self.judge_sigma(sigma, 0.0, *points.sigma_m);
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        self.judge_ends(field, *bounds);
        self.judge_distance(field, *bounds);
    }

    /// What somebody takes to be possible may be one value.
    fn interval(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        self.judge_ends(field, *bounds);
    }

    fn choice<W: Word>(&mut self, _: &Choice, _: &mut W) {}

    fn optional_choice<W: Word>(&mut self, _: &Choice, _: &mut Option<W>) {}

    fn choices<W: Word>(&mut self, _: &Choice, _: &mut Option<Vec<W>>) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::examples::{SPIN, read};
    use crate::evidence::{Edr, Mark};

    fn said(evidence: &Evidence) -> Vec<String> {
        evidence.odd_values().iter().map(|phrase| phrase.say(&Default::default())).collect()
    }

    #[test]
    fn standard_deviations_in_another_unit_are_named() {
        let mut evidence = read(SPIN);
        assert_eq!(said(&evidence), Vec::<String>::new());
        let stated = |value, sigma| Some(Stated { value: Some(value), sigma: Some(sigma) });
        // A share of the mass, and centimetres.
        evidence.struck_car.mass_kg = stated(1500.0, 0.03);
        evidence.striking_car.mass_kg = stated(1500.0, 15.0);
        let points_m = vec![[1.0, 0.0], [9.0, 1.0]];
        evidence.marks = vec![Mark { points_m, sigma_m: Some(10.0), ..Mark::default() }];
        let found = said(&evidence);
        assert_eq!(found.len(), 2, "{found:?}");
        let mass = "struck_car.mass_sigma_kg is 0.03 kg, where 45 kg is usual: ";
        assert!(found[0].starts_with(mass), "{found:?}");
        assert!(found[1].starts_with("mark[0].sigma_m is 10 m, where 0.1 m is usual"), "{found:?}");
        // A scale to 1 kg and a scanner to 3 mm.
        evidence.struck_car.mass_kg = stated(1900.0, 1.0);
        evidence.marks[0].sigma_m = Some(0.003);
        assert_eq!(said(&evidence), Vec::<String>::new());
    }

    /// The change of velocity of a recorder with one value for both bounds counted as known within 4 %.
    #[test]
    fn a_record_without_its_error_is_named() {
        let mut evidence = read(SPIN);
        let mut of_record = |low, high| -> Vec<String> {
            let delta_v_x_m_s = Some([Some(low), Some(high)]);
            evidence.edr = Some(Edr { delta_v_x_m_s, ..evidence.recorder() });
            evidence.prior.struck_speed_m_s = Some([Some(0.0), Some(0.0)]);
            said(&evidence)
        };
        let found = of_record(-10.0, -10.0);
        assert_eq!(found.len(), 1, "{found:?}");
        let begin = "edr.delta_v_x_min_m_s and delta_v_x_max_m_s lie ";
        assert!(found[0].starts_with(begin), "{found:?}");
        assert_eq!(of_record(9.9, 10.1).len(), 1);
        assert!(of_record(-11.0, -9.0).is_empty() && of_record(-0.05, 0.05).is_empty());
        assert!(of_record(0.0, 0.0).is_empty(), "no change has no error in per cent");
    }

    #[test]
    fn numbers_in_another_unit_are_named() {
        let found = said(&read(&format!("{SPIN}[prior]\nbrake_start_s = [0, 350]\n")));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("prior.brake_start_s is 350 s, and of"), "{found:?}");
        let mut evidence = read(SPIN);
        let points_m = vec![[0.0, 0.0], [900.0, 2.0], [950.0, 2.0]];
        evidence.marks = vec![Mark { points_m, ..Mark::default() }];
        let found = said(&evidence);
        assert_eq!(found.len(), 1, "{found:?}");
    }

    /// Of one mark both are told, standard deviations first.
    #[test]
    fn a_mark_may_be_odd_in_its_points_and_in_their_errors() {
        let mut evidence = read(SPIN);
        let points_m = vec![[0.0, 0.0], [900.0, 2.0]];
        evidence.marks = vec![Mark { points_m, sigma_m: Some(10.0), ..Mark::default() }];
        let found = said(&evidence);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("mark[0].sigma_m is "), "{found:?}");
        assert!(found[1].starts_with("mark[0].points_m is "), "{found:?}");
    }
}
