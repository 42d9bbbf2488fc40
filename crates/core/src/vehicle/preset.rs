//! Vehicles that are part of the program, compiled in from `assets/vehicles/*.toml`.

use std::path::Path;
use std::sync::LazyLock;

use crate::units::{NumberFormat, Phrase, PhraseValue, Quantity, UnitSystem};
use crate::vehicle::{LibraryVehicle, VehicleClass, VehicleParameters};

macro_rules! presets {
    ($($(#[$doc:meta])* $variant:ident: $file:literal;)+) => {
        /// A vehicle whose data come with the program.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Preset {
            $($(#[$doc])* $variant,)+
        }

        impl Preset {
            /// All presets, in the order in which they are listed to the user.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Name of the preset on the command line: its file name without the extension.
            pub fn id(self) -> &'static str {
                match self { $(Self::$variant => $file),+ }
            }

            /// Text of the TOML file of the preset.
            pub fn text(self) -> &'static str {
                match self {
                    $(Self::$variant => {
                        include_str!(concat!("../../../../assets/vehicles/", $file, ".toml"))
                    })+
                }
            }
        }
    };
}

presets! {
    /// The car of the multibody model that simulated the trajectory data sets, 2000 kg.
    Reference: "reference-2000";
    /// The struck vehicle of the finite-element runs, 2000 kg.
    Target: "target-2000";
    /// The lightest striking vehicle of the finite-element runs, 1500 kg.
    Bullet1500: "bullet-1500";
    /// The striking vehicle of medium mass of the finite-element runs, 2000 kg.
    Bullet2000: "bullet-2000";
    /// The heaviest striking vehicle of the finite-element runs, 2500 kg.
    Bullet2500: "bullet-2500";
    /// The striking vehicle of the paper on a scale of 1:4, 290 kg.
    ScaledBullet: "scaled-bullet-290";
    /// The struck vehicle of the paper on a scale of 1:4, 100 kg.
    ScaledStruck: "scaled-target-100";
}

impl Preset {
    /// The preset with a given [`Preset::id`]; `None` if there is none.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|preset| preset.id() == id)
    }

    /// Parameters of the vehicle.
    pub fn parameters(self) -> VehicleParameters {
        shipped_vehicle("assets/vehicles", self.id(), self.text())
    }
}

/// Parameters of a vehicle by its file, which is part of the program.
pub(in crate::vehicle) fn shipped_vehicle(folder: &str, id: &str, text: &str) -> VehicleParameters {
    let path = Path::new(folder).join(id).with_extension("toml");
    match VehicleParameters::parse(text, &path) {
        Ok(parameters) => parameters,
        Err(error) => unreachable!("a shipped vehicle is bad (a test reads them all): {error}"),
    }
}

/// Names of vehicles that come with the program and are no proper names alone, in English and German. `{0}` stands
/// for the mass.
const LABELS: &[(&str, &str)] = &[
    ("Reference car (multibody, {0})", "Referenzfahrzeug (Mehrkörpermodell, {0})"),
    ("FEA bullet ({0})", "stoßendes Fahrzeug der FE-Rechnungen ({0})"),
    ("FEA target ({0})", "gestoßenes Fahrzeug der FE-Rechnungen ({0})"),
    ("Scaled bullet 1:4 ({0})", "stoßendes Modellfahrzeug 1:4 ({0})"),
    ("Scaled target 1:4 ({0})", "gestoßenes Modellfahrzeug 1:4 ({0})"),
    ("Ordinary car, no model known", "gewöhnlicher Pkw, Modell unbekannt"),
    ("Ordinary SUV, no model known", "gewöhnlicher SUV, Modell unbekannt"),
    ("Ordinary minivan, no model known", "gewöhnlicher Van, Modell unbekannt"),
    ("Ordinary pickup, no model known", "gewöhnlicher Pick-up, Modell unbekannt"),
    (
        "Ford Explorer 2020 (base of the Police Interceptor Utility)",
        "Ford Explorer 2020 (Grundlage des Police Interceptor Utility)",
    ),
    (
        "Chevrolet Tahoe 2022, RWD (base of the Police Pursuit Vehicle)",
        "Chevrolet Tahoe 2022, Hinterradantrieb (Grundlage des Police Pursuit Vehicle)",
    ),
    (
        "Chevrolet Tahoe 2022, 4WD (base of the Police Pursuit Vehicle)",
        "Chevrolet Tahoe 2022, Allradantrieb (Grundlage des Police Pursuit Vehicle)",
    ),
    (
        "Dodge Charger 2022, V8, RWD (base of the Charger Pursuit police car)",
        "Dodge Charger 2022, V8, Hinterradantrieb (Grundlage des Polizeifahrzeugs Charger Pursuit)",
    ),
    (
        "Ford Crown Victoria 2010 (base of the Police Interceptor)",
        "Ford Crown Victoria 2010 (Grundlage des Police Interceptor)",
    ),
];

/// A vehicle that comes with the program: a preset, or one of the library.
#[derive(Debug, Clone, PartialEq)]
pub struct BuiltInVehicle {
    /// Its name on the command line.
    pub id: &'static str,
    /// Whether it is an ordinary vehicle of the library; else it is one of the data sets.
    pub is_of_library: bool,
    /// Its parameters.
    pub parameters: VehicleParameters,
}

impl BuiltInVehicle {
    /// Every vehicle, in the order in which they are listed to the user.
    pub fn all() -> &'static [Self] {
        // The files are part of the program; they are read once.
        static ALL: LazyLock<Vec<BuiltInVehicle>> = LazyLock::new(|| {
            let presets = Preset::ALL.iter().map(|of| (of.id(), false, of.parameters()));
            let library = LibraryVehicle::ALL.iter().map(|of| (of.id(), true, of.parameters()));
            let vehicle =
                |(id, is_of_library, parameters)| BuiltInVehicle { id, is_of_library, parameters };
            presets.chain(library).map(vehicle).collect()
        });
        &ALL
    }

    /// Kind of vehicle; `None` for one of the data sets.
    pub fn class(&self) -> Option<VehicleClass> {
        let sheet = self.parameters.sheet.as_ref().filter(|_| self.is_of_library);
        sheet.map(|sheet| sheet.class)
    }

    /// Model year, with which the id of a car of the library ends; `None` for one that stands for its class, and
    /// for one of the data sets.
    pub fn model_year(&self) -> Option<u32> {
        let (_, last) = self.id.rsplit_once('-').filter(|_| self.is_of_library)?;
        last.parse().ok().filter(|_| last.len() == 4)
    }

    /// The vehicle with an id; `None` if there is none.
    pub fn from_id(id: &str) -> Option<&'static Self> {
        Self::all().iter().find(|vehicle| vehicle.id == id)
    }

    /// The name of a vehicle with the mass at its end in the units of the reader, as in `FEA target (2000 kg)`,
    /// where it is one that comes with the program. What somebody calls a car is theirs.
    ///
    /// - `name`: as the file of the vehicle has it;
    /// - `translated`: the same in the language of the reader.
    pub fn name_in_units(name: &str, translated: &str, format: &NumberFormat) -> String {
        match Self::mass_in_name(name, translated) {
            Some((before, mass_kg)) if format.units == UnitSystem::Us => {
                format!("{before}{})", format.value(Quantity::Mass, mass_kg))
            }
            _ => translated.to_owned(),
        }
    }

    /// The same within a phrase.
    pub fn name_in_phrase(name: &str) -> PhraseValue {
        let Some((before, mass_kg)) = Self::mass_in_name(name, name) else {
            return match Self::german_name(name) {
                Some(german) => PhraseValue::phrase(Phrase::new(name, german)),
                None => PhraseValue::Name(name.to_owned()),
            };
        };
        let text = format!("{before}{{0}})");
        let german = Self::german_name(&text).unwrap_or_else(|| text.clone());
        let phrase = Phrase::new(text, german);
        PhraseValue::phrase(phrase.with(PhraseValue::given(Quantity::Mass, mass_kg)))
    }

    /// The German name of a vehicle that comes with the program; `None` of any other one, and of a proper name.
    pub fn german_name(name: &str) -> Option<String> {
        LABELS.iter().find_map(|(english, german)| match english.split_once("{0}") {
            Some((before, behind)) => {
                let mass = name.strip_prefix(before)?.strip_suffix(behind)?;
                Some(german.replace("{0}", mass))
            }
            None => (*english == name).then(|| (*german).to_owned()),
        })
    }

    /// What stands before the mass at the end of the name of a vehicle that comes with the program, and that, kg.
    fn mass_in_name<'a>(name: &str, translated: &'a str) -> Option<(&'a str, f64)> {
        Self::all().iter().find(|of| of.parameters.name == name)?;
        let rest = translated.strip_suffix(" kg)")?;
        let before = rest.trim_end_matches(|c: char| c.is_ascii_digit());
        Some((before, rest.strip_prefix(before)?.parse().ok()?))
    }
}

/// Parameters of a vehicle that comes with the program by its id; `None` if there is none.
pub fn built_in_vehicle(id: &str) -> Option<VehicleParameters> {
    BuiltInVehicle::from_id(id).map(|vehicle| vehicle.parameters.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Language;

    /// The masses at the end of the presets' ids are no years.
    #[test]
    fn cars_of_the_library_have_a_class_and_a_year() {
        let of = |id| {
            let vehicle = BuiltInVehicle::from_id(id).unwrap();
            (vehicle.class(), vehicle.model_year())
        };
        assert_eq!(of("toyota-corolla-2020"), (Some(VehicleClass::Car), Some(2020)));
        assert_eq!(of("generic-car"), (Some(VehicleClass::Car), None));
        assert_eq!(of("reference-2000"), (None, None));
        for vehicle in BuiltInVehicle::all().iter().filter(|of| of.is_of_library) {
            let is_generic = vehicle.id.starts_with("generic");
            assert!(vehicle.class().is_some(), "{}", vehicle.id);
            assert_eq!(vehicle.model_year().is_none(), is_generic, "{}", vehicle.id);
            let year = vehicle.model_year().map(|year| year.to_string()).unwrap_or_default();
            assert!(vehicle.parameters.name.contains(&year), "{}", vehicle.id);
        }
    }

    /// “Reference car (multibody, 2000 kg)” stood among the restrictions of a German report.
    #[test]
    fn names_that_are_labels_are_german_in_phrases_and_proper_names_stay() {
        let said = |language, units, name: &str| {
            let phrase = Phrase::of(BuiltInVehicle::name_in_phrase(name));
            phrase.say(&NumberFormat { units, language })
        };
        for (name, german) in [
            ("Reference car (multibody, 2000 kg)", "Referenzfahrzeug (Mehrkörpermodell, 2000 kg)"),
            ("Scaled bullet 1:4 (290 kg)", "stoßendes Modellfahrzeug 1:4 (290 kg)"),
            ("Ordinary car, no model known", "gewöhnlicher Pkw, Modell unbekannt"),
            ("Toyota Camry 2018", "Toyota Camry 2018"),
            ("our van {0} (2000 kg)", "our van {0} (2000 kg)"),
        ] {
            assert_eq!(said(Language::De, UnitSystem::Si, name), german);
            assert_eq!(said(Language::En, UnitSystem::Si, name), name);
        }
        let us = said(Language::De, UnitSystem::Us, "FEA target (2000 kg)");
        assert_eq!(us, "gestoßenes Fahrzeug der FE-Rechnungen (4409 lb)");
        for preset in Preset::ALL {
            let name = preset.parameters().name;
            assert!(BuiltInVehicle::german_name(&name).is_some(), "{name}");
        }
    }

    #[test]
    fn every_preset_loads_and_every_estimate_names_a_key() {
        for &preset in Preset::ALL {
            let vehicle = preset.parameters();
            assert_eq!(Preset::from_id(preset.id()), Some(preset));
            let values = toml::Table::try_from(&vehicle).unwrap();
            for key in vehicle.estimates.keys() {
                let (table, name) = key.split_once('.').unwrap();
                assert!(values[table].get(name).is_some(), "{}: no {key}", preset.id());
            }
        }
    }
}
