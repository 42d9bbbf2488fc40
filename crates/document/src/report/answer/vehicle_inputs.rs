//! The parameters of a vehicle, as rows of the table of inputs.

use crate::report::InputClass;
use crate::report::flatten::{FlatRow, flatten_rounded};
use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use impactlab_core::units::{Quantity, Unit, UnitSystem};
use impactlab_core::vehicle::VehicleParameters;
use impactlab_core::vehicle::sheet::Estimate;

/// A parameter of a vehicle in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VehicleParameter {
    /// What it is called.
    pub label: String,
    /// Its value with its unit.
    pub value: String,
    /// Whether it is estimated.
    pub is_estimate: bool,
    /// Where it comes from: a source, or a rule.
    pub source: String,
}

/// The parameters of a vehicle with their sources, as the table of inputs of a report has them.
pub fn vehicle_parameters(vehicle: &VehicleParameters, units: UnitSystem) -> Vec<VehicleParameter> {
    let rows = vehicle_rows(vehicle, "", &Wording::english(units)).into_iter();
    let parameter = |row: InputRow| VehicleParameter {
        is_estimate: row.class == InputClass::Estimated,
        label: row.label,
        value: row.value,
        source: row.source,
    };
    rows.map(parameter).collect()
}

/// What a vehicle is called in a question; beside a name that says its mass, that of the collision if it is another.
///
/// - `name`: as the answer has it.
pub(super) fn name_in_question(
    name: &str,
    vehicle: &VehicleParameters,
    wording: &Wording,
) -> String {
    let name = wording.name(name);
    match vehicle.has_mass_of_collision() {
        true => {
            let mass = wording.given(Quantity::Mass, vehicle.mass.mass_kg);
            fill(wording.words.of_other_mass, &[("vehicle", &name), ("mass", &mass)])
        }
        false => name,
    }
}

/// Every parameter with its source. What follows from a data sheet is told by the estimates of that,
/// with their intervals; what a vehicle file estimates, by its rule; what was said elsewhere, by that.
///
/// - `group`: what the vehicle is called in the table.
pub(super) fn vehicle_rows(
    vehicle: &VehicleParameters,
    group: &str,
    wording: &Wording,
) -> Vec<InputRow> {
    let fields = serde_json::to_value(vehicle).unwrap_or_default();
    let rows = flatten_rounded(&fields, wording);
    let is_text = |row: &&FlatRow| {
        row.path.first().is_none_or(|name| name != "estimates" && name != "stated")
            && row.key != "source"
    };
    let mut inputs: Vec<InputRow> = rows
        .iter()
        .filter(is_text)
        .map(|row| {
            let name = format!("{}.{}", row.path.join("."), row.key);
            let value = match (row.path.is_empty(), &*row.key) {
                (true, "name") => wording.name(&vehicle.name),
                _ => row.value.clone(),
            };
            let rule = vehicle.estimates.get(&name);
            let source = rule.or_else(|| vehicle.stated.get(&name)).unwrap_or(&vehicle.source);
            InputRow {
                group: group.to_owned(),
                label: label(row, wording),
                value,
                class: if rule.is_some() { InputClass::Estimated } else { InputClass::Given },
                source: wording.note(source),
            }
        })
        .collect();
    let sheet = vehicle.sheet.as_ref();
    let estimates = sheet.map_or_else(Vec::new, |sheet| sheet.estimates());
    if !estimates.is_empty() {
        let is_stated = |row: &&mut InputRow| {
            !vehicle.stated.values().any(|source| row.source == wording.note(source))
        };
        for row in inputs.iter_mut().filter(is_stated) {
            // Which of the parameters a rule gave is told by the rows of the estimates below.
            row.source = wording.words.follows_from_sheet.to_owned();
        }
    }
    inputs.extend(estimates.iter().map(|estimate| estimate_row(estimate, group, wording)));
    inputs
}

/// What a parameter is called: of those of a part of a table, such as a face, with the part.
fn label(row: &FlatRow, wording: &Wording) -> String {
    let name = wording.key(&row.key);
    match &row.path[..] {
        [_, .., part] => format!("{name}, {}", wording.key(part)),
        _ => name,
    }
}

/// What the rules of a data sheet say of a quantity that it leaves open.
pub(super) fn estimate_row(estimate: &Estimate, group: &str, wording: &Wording) -> InputRow {
    let Estimate { quantity, unit, value, rule, source } = estimate;
    let text = match Quantity::from_si_symbol(unit) {
        Some(quantity) => wording.estimate(quantity, value),
        None => wording
            .estimate_in(Unit { quantity: Quantity::Ratio, symbol: unit, si_per_unit: 1.0 }, value),
    };
    let range = text.at(0.9).map_or_else(String::new, |interval| interval.range.clone());
    InputRow {
        group: group.to_owned(),
        label: wording.term(quantity.label()),
        value: format!("{} (90 %: {range})", text.median),
        class: InputClass::Estimated,
        source: wording.note(&format!("{rule}; {source}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Language, Paper, ReportDate, ReportSettings};
    use impactlab_core::units::UnitSystem;
    use impactlab_core::vehicle::{BuiltInVehicle, CrushStiffness, Preset};

    /// The opinion on a car of 1500 kg spoke of “Reference car (multibody, 2000 kg)” alone.
    #[test]
    fn a_vehicle_of_another_mass_than_its_name_says_has_that_beside_it() {
        let (car, wording) = (Preset::Reference.parameters(), Wording::english(UnitSystem::Si));
        assert_eq!(name_in_question(&car.name, &car, &wording), car.name);
        let lighter = car.clone().with_mass(1500.0, None);
        let expected = format!("{}, here of 1500 kg", car.name);
        assert_eq!(name_in_question(&lighter.name, &lighter, &wording), expected);
    }

    /// The rows of inputs called a car of 4409 lb one of 2000 kg.
    #[test]
    fn the_row_of_the_name_has_its_mass_in_the_units_of_the_report() {
        let car = Preset::Reference.parameters();
        let rows = vehicle_rows(&car, "struck car", &Wording::english(UnitSystem::Us));
        let values: Vec<&str> = rows.iter().map(|row| &*row.value).collect();
        assert!(values.contains(&"Reference car (multibody, 4409 lb)"), "{values:?}");
        assert!(!values.contains(&&*car.name), "{values:?}");
    }

    #[test]
    fn how_stiff_a_face_is_has_its_face_and_its_unit() {
        let date = ReportDate::new(2026, 1, 2).unwrap();
        let (units, paper) = (UnitSystem::Si, Paper::A4);
        let mut vehicle = Preset::Reference.parameters();
        let stiffness = CrushStiffness { onset_n_per_m: 60_400.0, stiffness_n_per_m2: 78e4 };
        vehicle.crush.side = Some(stiffness);
        for (language, expected) in [
            (Language::En, [("onset, side", "60.4 kN/m"), ("stiffness, side", "780 kN/m²")]),
            (
                Language::De,
                [("Einsatzlast A, Seite", "60,4 kN/m"), ("Steifigkeit B, Seite", "780 kN/m²")],
            ),
        ] {
            let wording = Wording::new(&ReportSettings { language, units, paper, date });
            let rows = vehicle_rows(&vehicle, "struck car", &wording);
            for (label, value) in expected {
                let row = rows.iter().find(|row| row.label == label);
                assert_eq!(row.map(|row| &*row.value), Some(value), "{label}");
            }
        }
    }

    #[test]
    fn every_vehicle_of_the_program_is_told_in_german() {
        let date = ReportDate::new(2026, 1, 2).unwrap();
        let (language, units, paper) = (Language::De, UnitSystem::Si, Paper::A4);
        let wording = Wording::new(&ReportSettings { language, units, paper, date });
        let english =
            ["the", "of", "and", "with", "from", "by", "as", "measured", "class", "times"];
        for vehicle in BuiltInVehicle::all() {
            for row in vehicle_rows(&vehicle.parameters, "Fahrzeug", &wording) {
                let text = format!("{}; {}; {}", row.label, row.value, row.source);
                let text = text.replace("„unsprung and links“", "");
                let mut words = text.split(|c: char| !c.is_alphabetic());
                assert!(!words.any(|word| english.contains(&word)), "{}: {text}", vehicle.id);
                assert!(!text.contains('„'), "{}: {text}", vehicle.id);
            }
        }
    }

    #[test]
    fn what_another_mass_has_changed_is_not_said_to_be_of_the_file() {
        let date = ReportDate::new(2026, 1, 2).unwrap();
        let (language, units, paper) = (Language::En, UnitSystem::Si, Paper::A4);
        let wording = Wording::new(&ReportSettings { language, units, paper, date });
        let file = Preset::Reference.parameters();
        let rows = vehicle_rows(&file.clone().with_mass(1500.0, None), "struck car", &wording);
        let by_value = |value: &str| rows.iter().find(|row| row.value.starts_with(value)).unwrap();
        let mass = by_value("1500");
        assert_eq!(mass.class, InputClass::Given);
        assert!(mass.source.contains("instead of 2000 kg"), "{}", mass.source);
        let of_file = rows.iter().filter(|row| row.source.contains(&file.source)).count();
        let untouched = vehicle_rows(&file, "struck car", &wording);
        let before = untouched.iter().filter(|row| row.source.contains(&file.source)).count();
        assert!(of_file + 7 >= before && of_file < before, "{of_file} of {before}");
        let scaled = rows.iter().filter(|row| row.source.contains("from 2000 kg to 1500 kg"));
        assert_eq!(scaled.filter(|row| row.class == InputClass::Estimated).count(), 6);
        assert!(rows.iter().all(|row| !row.value.contains("said with")), "a note is no value");
    }
}
