//! What was found after a collision, as rows of the table of inputs: every field of every item, with who
//! stated it.

use crate::report::InputClass;
use crate::report::answer::evidence::measured;
use crate::report::answer::vehicle_inputs::estimate_row;
use crate::report::answer::zone_inputs::zone_rows;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::sheet::SheetQuantity;
use impactlab_reconstruct::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, Measured, PlaceMut, PointsMut, Section,
    Sigma, Stated, Word, ends,
};
use impactlab_reconstruct::{
    ANTI_LOCK_PROBABILITY, BLOCKED_PROBABILITY, BRAKE_PROBABILITY, Car, Distribution, Latent,
    PriorComponent, PriorSource,
};
use impactlab_study::{ReconstructAnswer, ReconstructRequest};

/// Evidence, estimates of both cars, and the prior.
pub(super) fn evidence_rows(
    request: &ReconstructRequest,
    answer: &ReconstructAnswer,
    wording: &Wording,
) -> Vec<InputRow> {
    let words = wording.words;
    let evidence = answer.target.evidence();
    let mut rows = stated_rows(evidence, wording);
    rows.extend(zone_rows(answer.target.model().zones(), wording));
    let single_car = wording.term("car");
    let struck: &str = if evidence.is_single_car() { &single_car } else { words.struck_vehicle };
    let striking = (&evidence.striking_car, &request.striking, words.striking_vehicle);
    let striking = (!evidence.is_single_car()).then_some(striking);
    let struck = (&evidence.struck_car, &request.vehicle, struck);
    for (found, choice, group) in std::iter::once(struck).chain(striking) {
        // The answer is there, so that the vehicles could be read.
        let chosen = choice.chosen().ok().flatten();
        let estimates = Car::estimates_of(found, chosen.as_ref());
        // The friction of the road is what was measured, or that of the prior.
        let estimates =
            estimates.iter().filter(|estimate| estimate.quantity != SheetQuantity::Friction);
        rows.extend(estimates.map(|estimate| estimate_row(estimate, group, wording)));
    }
    rows.extend(answer.report.priors.iter().map(|prior| prior_row(prior, wording)));
    rows
}

/// What the evidence states, and what the program takes where it states nothing.
pub(in crate::report) fn stated_rows(evidence: &Evidence, wording: &Wording) -> Vec<InputRow> {
    let (group, number) = (String::new(), String::new());
    let mut rows = Rows { wording, group, number, rows: Vec::new() };
    evidence.clone().items(&mut rows);
    rows.rows
}

struct Rows<'a> {
    wording: &'a Wording,
    /// What the item is called.
    group: String,
    /// Its number among those of its kind, as the beginning of a label.
    number: String,
    rows: Vec<InputRow>,
}

impl Rows<'_> {
    fn push(&mut self, label: &str, value: String, class: InputClass, source: &str) {
        let label = format!("{}{}", self.number, self.wording.term(label));
        let (group, source) = (self.group.clone(), source.to_owned());
        self.rows.push(InputRow { group, label, value, class, source });
    }

    fn given(&mut self, label: &str, value: String) {
        self.push(label, value, InputClass::Given, self.wording.words.source_evidence);
    }

    /// - `is_stated`: whether the evidence states the standard deviation.
    fn with_sigma(&mut self, label: &str, value: String, is_stated: bool) {
        let words = self.wording.words;
        let source = match is_stated {
            true => words.source_evidence_sigma,
            false => words.source_default_sigma,
        };
        self.push(label, value, InputClass::Measured, source);
    }

    fn range(&self, field: &Field, ends: [f64; 2]) -> String {
        self.wording.given_range(field.range.quantity, ends)
    }
}

impl Items for Rows<'_> {
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item) {
        self.group = self.wording.term(section.title);
        self.number = idx.map_or(String::new(), |idx| format!("{}: ", idx + 1));
        item.fields(self);
    }
}

impl Fields for Rows<'_> {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        match *value {
            Some(value) => {
                self.given(field.label, self.wording.given(field.range.quantity, value));
            }
            None if field.default.is_empty() => {}
            None => {
                let default = self.wording.term(field.default);
                let source = self.wording.words.source_program;
                self.push(field.label, default, InputClass::Assumed, source);
            }
        }
    }

    fn measured(&mut self, field: &Field, sigma: &Sigma, stated: &mut Option<Stated>) {
        let Some(Measured { value, sigma }) = sigma.resolve(*stated) else { return };
        let text = measured(field.range.quantity, [value, sigma], self.wording);
        self.with_sigma(field.label, text, stated.is_some_and(|stated| stated.sigma.is_some()));
    }

    fn place(&mut self, fields: [&Field; 2], sigma: &Sigma, place: PlaceMut<'_>) {
        let PlaceMut { x_m, y_m, sigma_m } = place;
        for (field, value) in fields.into_iter().zip([*x_m, *y_m]) {
            let stated = Stated { value, sigma: *sigma_m };
            self.measured(field, sigma, &mut Some(stated));
        }
    }

    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        let PointsMut { points_m, sigma_m } = points;
        let ends = [points_m.first(), points_m.last()];
        let [Some(first), Some(last)] = ends else { return };
        let unit = Quantity::Length.display_unit(self.wording.units);
        let point = |at_m: &[f64; 2]| {
            let [x, y] = at_m.map(|si| self.wording.fixed(unit.from_si(si), 2));
            self.wording.with_unit(&format!("({x}; {y})"), unit.symbol)
        };
        let values = [
            ("n", points_m.len().to_string()),
            ("first", point(first)),
            ("last", point(last)),
            (
                "sigma",
                self.wording.sigma(Quantity::Length, sigma_m.unwrap_or(sigma.default_at(0.0))),
            ),
        ];
        let values = values.each_ref().map(|(name, value)| (*name, value.as_str()));
        let text = fill(self.wording.words.mark_value, &values);
        self.with_sigma(field.label, text, sigma_m.is_some());
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        if let Some(ends) = ends(*bounds) {
            let source = self.wording.words.source_evidence;
            self.push(field.label, self.range(field, ends), InputClass::Measured, source);
        }
    }

    fn interval(&mut self, field: &Field, interval: &mut Option<Bounds>) {
        if let Some(ends) = ends(*interval) {
            self.given(field.label, self.range(field, ends));
        }
    }

    fn choice<W: Word>(&mut self, choice: &Choice, word: &mut W) {
        self.given(choice.label, self.wording.term(word.label()));
    }

    fn optional_choice<W: Word>(&mut self, choice: &Choice, word: &mut Option<W>) {
        let label = word.map_or(choice.none, W::label);
        self.given(choice.label, self.wording.term(label));
    }

    fn choices<W: Word>(&mut self, choice: &Choice, words: &mut Option<Vec<W>>) {
        let value = match words.as_deref() {
            None => self.wording.term(choice.none),
            Some([]) => self.wording.words.none.to_owned(),
            Some(words) => {
                let words = words.iter().map(|word| self.wording.term(word.label()));
                words.collect::<Vec<_>>().join(", ")
            }
        };
        self.given(choice.label, value);
    }
}

/// A prior distribution.
fn prior_row(prior: &PriorComponent, wording: &Wording) -> InputRow {
    let words = wording.words;
    let quantity = prior.latent.quantity();
    let value = |si: f64| wording.rounded(quantity, si);
    let decision =
        |template: &str, share: f64| fill(template, &[("share", &wording.percent(share))]);
    let text = match prior.distribution {
        // Uniform draws that are compared with a bound.
        _ if prior.latent == Latent::BrakeDecision => {
            decision(words.decision_prior, BRAKE_PROBABILITY)
        }
        _ if prior.latent == Latent::AntiLockDecision => {
            decision(words.decision_prior, ANTI_LOCK_PROBABILITY)
        }
        _ if prior.latent == Latent::BlockedWheel => {
            decision(words.decision_by_number, BLOCKED_PROBABILITY)
        }
        Distribution::Uniform { low, high } => {
            fill(words.uniform, &[("low", &value(low)), ("high", &value(high))])
        }
        Distribution::Normal { mean, sigma, low, high } => fill(
            words.normal_cut,
            &[
                ("value", &wording.measured(quantity, mean, sigma)),
                ("low", &value(low)),
                ("high", &value(high)),
            ],
        ),
        Distribution::LogNormal { median, sigma, low, high } => fill(
            words.log_normal_cut,
            &[
                ("median", &value(median)),
                ("sigma", &wording.sigma(Quantity::Ratio, sigma)),
                ("low", &value(low)),
                ("high", &value(high)),
            ],
        ),
    };
    let (class, source) = match prior.source {
        PriorSource::Given => (InputClass::Given, words.source_prior_given),
        PriorSource::Measured => (InputClass::Measured, words.source_prior_measured),
        // How well it is known is left to the comparison with the drag itself.
        PriorSource::Estimated if prior.latent == Latent::RoadFriction => {
            (InputClass::Estimated, words.source_prior_drag)
        }
        PriorSource::Estimated => (InputClass::Estimated, words.source_prior_rule),
        PriorSource::Assumed => (InputClass::Assumed, words.source_prior),
    };
    InputRow {
        group: words.prior.to_owned(),
        label: wording.term(prior.latent.label()),
        value: text,
        class,
        source: source.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::report::{Language, Paper, ReportDate, ReportSettings};
    use impactlab_core::data::TomlFile;
    use impactlab_core::units::UnitSystem;

    const EVIDENCE: &str = r#"
        case = "all"
        road = { friction = 0.71, friction_sigma = 0.13 }
        struck_car = { mass_kg = 1500, mass_sigma_kg = 45, track_m = 1.51 }
        striking_car = { mass_kg = 1900 }
        weighing = { shared_scale_sigma = 0.0123 }
        damage = { side = "left", x_m = -1.7, x_sigma_m = 0.1, y_m = 0.91, angle_rad = 0.3 }
        rest = { x_m = 30, y_m = -4, position_sigma_m = 0.15, heading_rad = 1, heading_sigma_rad = 0.035 }
        striking_rest = { x_m = 60, y_m = 2 }
        after = { blocked_wheels = ["RL"] }
        [edr]
        delta_v_x_min_m_s = 1
        delta_v_x_max_m_s = 2
        sensor_x_m = 0.37
        [[mark]]
        wheel = "FL"
        points_m = [[1, 2], [3, 4]]
        sigma_m = 0.1
        [[position]]
        time_s = 1.23
        x_m = 20
        y_m = 0
        [prior]
        restitution = [0.11, 0.29]
        [[striking_mark]]
        wheel = "FL"
        points_m = [[1, 5], [3, 6]]
        [striking_edr]
        speed_before_m_s = 20
    "#;

    fn rows(language: Language) -> Vec<InputRow> {
        rows_in(language, UnitSystem::Si)
    }

    fn rows_in(language: Language, units: UnitSystem) -> Vec<InputRow> {
        let file = TomlFile { path: Path::new("case.toml"), text: EVIDENCE };
        let date = ReportDate::new(2026, 1, 2).unwrap();
        let paper = Paper::A4;
        let wording = Wording::new(&ReportSettings { language, units, paper, date });
        stated_rows(&Evidence::from_toml(file).unwrap(), &wording)
    }

    /// A standard deviation that is stated is said to be stated, also where it is that of the program.
    #[test]
    fn the_source_of_a_standard_deviation_is_who_stated_it() {
        let rows = rows(Language::En);
        let stated = |group: &str, label: &str| {
            let of_label = |row: &&InputRow| row.group == group && row.label == label;
            let row = rows.iter().find(of_label).unwrap_or_else(|| panic!("{group}: {label}"));
            assert_eq!(row.class, InputClass::Measured, "{row:?}");
            row.source == "evidence"
        };
        for (group, label) in [
            ("friction of the road", "peak friction"),
            ("struck car", "mass"),
            ("struck car at rest", "X of the CG"),
            ("struck car at rest", "heading"),
            ("damage of the struck car", "contact ahead of the CG"),
            ("tire mark", "1: points"),
        ] {
            assert!(stated(group, label), "{group}: {label}");
        }
        for (group, label) in [
            ("striking car", "mass"),
            ("striking car at rest", "X of the CG"),
            ("tire mark of the striking car", "1: points"),
            ("event data recorder of the striking car", "speed before the impact"),
            ("damage of the struck car", "angle of the cars"),
            ("position in a video", "1: Y of the CG"),
        ] {
            assert!(!stated(group, label), "{group}: {label}");
        }
    }

    #[test]
    fn every_input_of_the_likelihood_is_listed() {
        let rows = rows(Language::En);
        for (group, label, value) in [
            ("one scale for both cars", "error of the scale, as a share", "0.0123"),
            ("event data recorder", "Δv ahead", "3.6 km/h to 7.2 km/h"),
            ("event data recorder", "sensor ahead of the CG", "0.37 m"),
            ("event data recorder", "sensor to the left of the CG", "at the CG"),
            ("event data recorder", "end of the record", "end of contact"),
            ("struck car", "track width", "1.51 m"),
            ("damage of the struck car", "contact to the left of the CG", "0.91 m"),
            ("position in a video", "1: time", "1.23 s"),
            ("after the impact", "blocked wheels", "rear left"),
            ("after the impact", "driver braked", "not known"),
            ("ranges beforehand", "restitution", "0.11 to 0.29"),
        ] {
            let is_listed =
                |row: &InputRow| row.group == group && row.label == label && row.value == value;
            assert!(rows.iter().any(is_listed), "{group}: {label} = {value} in {rows:#?}");
        }
    }

    /// Of a mark at 512.34 m the place was told to the foot, its error of 0.1 m as 0.3281 ft.
    #[test]
    fn points_of_a_mark_have_two_decimals_and_their_error_two_digits() {
        for (language, units, expected) in [
            (
                Language::En,
                UnitSystem::Si,
                "2 points from (1.00; 2.00) m to (3.00; 4.00) m, each ± 0.1 m",
            ),
            (
                Language::En,
                UnitSystem::Us,
                "2 points from (3.28; 6.56) ft to (9.84; 13.12) ft, each ± 0.33 ft",
            ),
            (
                Language::De,
                UnitSystem::Us,
                "2 Punkte von (3,28; 6,56) ft bis (9,84; 13,12) ft, je ± 0,33 ft",
            ),
        ] {
            let rows = rows_in(language, units);
            assert!(rows.iter().any(|row| row.value == expected), "{expected}: {rows:#?}");
        }
    }

    #[test]
    fn every_row_has_german_words() {
        for row in rows(Language::De) {
            for text in [&row.group, &row.label, &row.value] {
                assert!(!text.contains('„'), "{row:?}");
            }
        }
    }
}
