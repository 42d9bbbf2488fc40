//! Values of facts as text.

use std::path::Path;

use impactlab_core::units::{Language, NumberFormat, Quantity, UnitSystem, two_digits};
use impactlab_core::vehicle::BuiltInVehicle;

use crate::facts::{FactTable, Value};

/// How values that are no numbers are written.
#[derive(Clone, Copy)]
pub struct FactWriter<'a> {
    /// Numbers, and the language.
    pub format: NumberFormat,
    /// A label of the program in the language.
    pub phrase: &'a dyn Fn(&str) -> String,
    /// A name in the language; as it is where it is none of the program.
    pub name: &'a dyn Fn(&str) -> String,
    /// A text that the program has in English only, in the language.
    pub english: &'a dyn Fn(&str) -> String,
    /// What a file is called.
    pub file: &'a dyn Fn(&Path) -> String,
}

/// Probability below which a table says only that it is smaller.
const LEAST_PROBABILITY: f64 = 0.001;

/// Probability from which on it would be written as certain, and a table says only that it is larger.
const MOST_PROBABILITY: f64 = 0.9995;

/// Area below which a place does not vary, m²: a square centimetre.
const LEAST_AREA_M2: f64 = 1e-4;

impl FactWriter<'static> {
    /// English, in the units of a system.
    pub fn english(units: UnitSystem) -> Self {
        Self {
            format: NumberFormat::english(units),
            phrase: &<str as ToOwned>::to_owned,
            name: &<str as ToOwned>::to_owned,
            english: &<str as ToOwned>::to_owned,
            file: &|path| path.display().to_string(),
        }
    }
}

impl FactWriter<'_> {
    /// Tables in Markdown.
    pub fn markdown(&self, tables: &[FactTable]) -> String {
        let texts: Vec<String> =
            tables.iter().map(|table| table.to_text(self).to_markdown()).collect();
        texts.join("\n")
    }

    /// A value as text.
    pub(super) fn value(&self, value: &Value) -> String {
        let format = &self.format;
        match value {
            Value::Term(term) => term.label(format.language).to_owned(),
            Value::Phrase(text) => (self.phrase)(text),
            Value::Name(name) => BuiltInVehicle::name_in_units(name, &(self.name)(name), format),
            Value::Text(text) => text.clone(),
            Value::English(text) => (self.english)(text),
            Value::File(path) => (self.file)(path),
            Value::Count(n) => n.to_string(),
            Value::CountOf(n, all) => match format.language {
                Language::En => format!("{n} of {all}"),
                Language::De => format!("{n} von {all}"),
            },
            Value::Share(share) => format.percent(*share),
            Value::Chance(chance, error) => format.chance(*chance, *error),
            Value::ShareOfDraws(share, 1) => match format.language {
                Language::En => format!("{share:.0} of 1 draw"),
                Language::De => format!("{share:.0} von 1 Ziehung"),
            },
            Value::ShareOfDraws(share, n) => match format.language {
                Language::En => format!("{} of {n} draws", format.percent(*share)),
                Language::De => format!("{} von {n} Ziehungen", format.percent(*share)),
            },
            Value::Probability(p) if *p < LEAST_PROBABILITY => {
                format!("< {}", format.fixed(LEAST_PROBABILITY, 3))
            }
            Value::Probability(p) if *p >= MOST_PROBABILITY => {
                format!("> {}", format.fixed(1.0 - LEAST_PROBABILITY, 3))
            }
            Value::Probability(p) => format.fixed(*p, 3),
            Value::ProbabilityBound(p) if *p < LEAST_PROBABILITY => {
                self.value(&Value::Probability(*p))
            }
            Value::ProbabilityBound(p) if *p >= MOST_PROBABILITY => "≤ 1".to_owned(),
            Value::ProbabilityBound(p) => format!("≤ {}", format.fixed(*p, 3)),
            Value::Fixed(number, decimals) => format.fixed(*number, *decimals),
            Value::Number(quantity, si) => format.value(*quantity, *si),
            Value::Decimals(quantity, si, decimals) => {
                let unit = quantity.display_unit(format.units);
                format.with_unit(&format.fixed(unit.from_si(*si), *decimals), unit.symbol)
            }
            Value::Rounded(quantity, si) => format.rounded(*quantity, *si),
            Value::Rough(quantity, si) => format.rough(*quantity, *si),
            Value::Given(quantity, si) => format.given(*quantity, *si),
            Value::Sigma(quantity, si) => format.sigma(*quantity, *si),
            Value::Measured(quantity, si, sigma) => format.measured(*quantity, *si, *sigma),
            Value::Change(quantity, si, sigma) => {
                let sign = if *si > 0.0 { "+" } else { "" };
                format!("{sign}{}", format.measured(*quantity, *si, *sigma))
            }
            Value::Estimate(quantity, estimate) => format.estimate_in_words(*quantity, estimate),
            Value::Vector(quantity, components, names) => {
                let names = names.map(|name| (self.phrase)(name));
                format.vector(*quantity, *components, names.each_ref().map(String::as_str))
            }
            Value::RoughVector(quantity, components, names) => {
                let names = names.map(|name| (self.phrase)(name));
                format.rough_vector(*quantity, *components, names.each_ref().map(String::as_str))
            }
            Value::Place(place_m) => self.place(*place_m),
            Value::RoughPlace(place_m) => format.rough_place(*place_m),
            Value::Area(area_m2) => self.area(*area_m2),
            Value::Clock(hour) => match format.language {
                Language::En => format!("{hour} o’clock"),
                Language::De => format!("{hour} Uhr"),
            },
            Value::Joined(values, between) => {
                let texts: Vec<String> = values.iter().map(|value| self.value(value)).collect();
                texts.join(between)
            }
        }
    }

    fn place(&self, place_m: [f64; 2]) -> String {
        let unit = Quantity::Length.display_unit(self.format.units);
        let [x, y] = place_m.map(|si| self.format.fixed(unit.from_si(si), 1));
        format!("({x}; {y}) {}", unit.symbol)
    }

    /// An area in squares of the unit of lengths.
    fn area(&self, area_m2: f64) -> String {
        let unit = Quantity::Length.display_unit(self.format.units);
        let area_m2 = if area_m2 < LEAST_AREA_M2 { 0.0 } else { area_m2 };
        let area = area_m2 / unit.si_per_unit.powi(2);
        self.format.with_unit(&two_digits(area), &format!("{}²", unit.symbol))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::{Fact, Term};
    use impactlab_core::units::Estimate;

    /// “163.9 m²” had a standard error of 17 m², and a place of a forecast its centimetres.
    #[test]
    fn no_fact_of_a_distribution_has_digits_that_it_does_not_know() {
        let writer = FactWriter::english(UnitSystem::Si);
        let text = |value: Value| writer.value(&value);
        let known = Estimate::new(-193.45, [-195.0, -190.0], [-208.0, -143.0]);
        let unknown = known.without_intervals();
        assert_eq!(text(Value::drawn(Quantity::Length, &known)), "-193 (-208 to -143) m");
        assert_eq!(text(Value::drawn(Quantity::Length, &unknown)), "-193 m");
        assert_eq!(text(Value::Change(Quantity::Length, 1.234, 0.12)), "+1.23 ± 0.12 m");
        assert_eq!(text(Value::Area(163.9)), "160 m²");
        assert_eq!(text(Value::Area(9.9e-6)), "0 m²");
        assert_eq!(text(Value::Place([43.98, -5.944])), "(44.0; -5.9) m");
        // The mean of a forecast of which 90 % lay within 16 m was known to a tenth.
        assert_eq!(text(Value::RoughPlace([43.78, -5.844])), "(44; -5.8) m");
        let us = FactWriter::english(UnitSystem::Us);
        assert_eq!(us.value(&Value::RoughPlace([43.78, -5.844])), "(144; -19) ft");
        assert_eq!(text(Value::Rounded(Quantity::Time, 0.003)), "0.003 s");
        assert_eq!(text(Value::Probability(1.0)), "> 0.999");
        assert_eq!(text(Value::Probability(0.675)), "0.675");
        // A bound that was cut off at 1 was told as “> 0.999”, as if the evidence were certain.
        assert_eq!(text(Value::ProbabilityBound(1.0)), "≤ 1");
        assert_eq!(text(Value::ProbabilityBound(0.704)), "≤ 0.704");
        assert_eq!(text(Value::ProbabilityBound(1e-5)), "< 0.001");
    }

    /// “100.0 % ± 22.0 %” was the probability by one draw, and its place “43.98 (43.98 to 43.98) m”.
    #[test]
    fn a_single_draw_has_neither_an_interval_nor_a_probability() {
        let writer = FactWriter::english(UnitSystem::Si);
        let place = Value::drawn(Quantity::Length, &Estimate::from_draws(vec![43.98]));
        assert_eq!(writer.value(&place), "44 m");
        assert_eq!(writer.value(&Value::chance_of_draws(1.0, 1)), "1 of 1 draw");
        assert_eq!(writer.value(&Value::chance_of_draws(0.0, 1)), "0 of 1 draw");
        assert_eq!(writer.value(&Value::chance_of_draws(1.0, 100)), "100.0 % ± 1.4 %");
    }

    /// The command line and the window told a car of “2000 kg” beside masses in pounds.
    #[test]
    fn the_mass_in_the_name_of_a_shipped_vehicle_is_in_the_units_of_the_reader() {
        let told =
            |units, name: &str| FactWriter::english(units).value(&Value::Name(name.to_owned()));
        let name = "FEA target (2000 kg)";
        assert_eq!(told(UnitSystem::Si, name), name);
        assert_eq!(told(UnitSystem::Us, name), "FEA target (4409 lb)");
        assert_eq!(told(UnitSystem::Us, "our van (2000 kg)"), "our van (2000 kg)");
    }

    #[test]
    fn german_has_its_names_and_feet_are_squared() {
        let facts = vec![
            Fact::new(Term::Region90, Value::Area(0.3048 * 0.3048 * 2.5)),
            Fact::new(Term::ShareAtRest, Value::ShareOfDraws(0.5, 30)),
        ];
        let table = FactTable::new(Term::Forecast, facts);
        let units = FactWriter::english(UnitSystem::Us);
        let format = NumberFormat { language: Language::De, ..units.format };
        let text = table.to_text(&FactWriter { format, ..units });
        assert!(text.is_list());
        assert_eq!(text.title, "Vorhergesagte Bewegung");
        assert_eq!(text.rows[0].cells[1], "2,5 ft²");
        assert_eq!(text.rows[1].cells[1], "50,0 % von 30 Ziehungen");
    }
}
