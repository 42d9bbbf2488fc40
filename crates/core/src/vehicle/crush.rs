//! How stiff the faces of a vehicle are, where its file says it.
//!
//! ```toml
//! [crush.front]                    # also side and rear; each may be left out
//! onset_n_per_m = 60400            # A: load at which the face begins to crush
//! stiffness_n_per_m2 = 780000      # B: growth of the load with the depth of the crush
//! ```
//!
//! Both as tests against a flat rigid barrier give them; `impactlab stiffness` computes them from a test.
//! What is left out follows from class and mass by rule.

use serde::{Deserialize, Serialize};

use crate::data::{TomlError, TomlTable};
use crate::ranges::{CRUSH_ONSET, CRUSH_STIFFNESS, Range};

/// A and B of the faces of a vehicle, as far as they are known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrushParameters {
    /// Of the front.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front: Option<CrushStiffness>,
    /// Of the left and of the right side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<CrushStiffness>,
    /// Of the rear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rear: Option<CrushStiffness>,
}

/// A and B of a face.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrushStiffness {
    /// A: load at which the face begins to crush, N/m.
    pub onset_n_per_m: f64,
    /// B: growth of the load with the depth of the crush, N/m².
    pub stiffness_n_per_m2: f64,
}

/// Keys of the numbers of each face, in the order of front, side, rear.
const KEYS: [[&str; 2]; 3] = [
    ["crush.front.onset_n_per_m", "crush.front.stiffness_n_per_m2"],
    ["crush.side.onset_n_per_m", "crush.side.stiffness_n_per_m2"],
    ["crush.rear.onset_n_per_m", "crush.rear.stiffness_n_per_m2"],
];

impl CrushParameters {
    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.faces().iter().all(Option::is_none)
    }

    fn faces(&self) -> [Option<CrushStiffness>; 3] {
        [self.front, self.side, self.rear]
    }

    /// Every number with its key and its range.
    pub(super) fn ranges(&self) -> impl Iterator<Item = (&'static str, f64, Range)> + use<> {
        let numbers = |(face, keys): (Option<CrushStiffness>, [&'static str; 2])| {
            face.map(|face| {
                [
                    (keys[0], face.onset_n_per_m, CRUSH_ONSET),
                    (keys[1], face.stiffness_n_per_m2, CRUSH_STIFFNESS),
                ]
            })
        };
        self.faces().into_iter().zip(KEYS).filter_map(numbers).flatten()
    }

    /// Reads the section of a data sheet.
    pub(super) fn read(table: Option<TomlTable<'_>>) -> Result<Self, TomlError> {
        let Some(mut table) = table else { return Ok(Self::default()) };
        let mut face = |name: &str| -> Result<Option<CrushStiffness>, TomlError> {
            let Some(mut face) = table.optional_table(name)? else { return Ok(None) };
            let onset = face.plain("onset_n_per_m", &CRUSH_ONSET)?;
            let onset_n_per_m = onset.ok_or_else(|| face.missing("onset_n_per_m"))?;
            let stiffness = face.plain("stiffness_n_per_m2", &CRUSH_STIFFNESS)?;
            let stiffness_n_per_m2 = stiffness.ok_or_else(|| face.missing("stiffness_n_per_m2"))?;
            face.finish()?;
            Ok(Some(CrushStiffness { onset_n_per_m, stiffness_n_per_m2 }))
        };
        let found = Self { front: face("front")?, side: face("side")?, rear: face("rear")? };
        table.finish()?;
        Ok(found)
    }

    /// The section of a file.
    pub(super) fn to_table(self) -> toml::Table {
        let faces = ["front", "side", "rear"].into_iter().zip(self.faces());
        let section = |(name, face): (&str, Option<CrushStiffness>)| {
            let face = face?;
            let mut table = toml::Table::new();
            table.insert("onset_n_per_m".to_owned(), face.onset_n_per_m.into());
            table.insert("stiffness_n_per_m2".to_owned(), face.stiffness_n_per_m2.into());
            Some((name.to_owned(), table.into()))
        };
        faces.filter_map(section).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::vehicle::{DataSheet, Preset, VehicleParameters};

    const SECTION: &str = "\n[crush.front]\nonset_n_per_m = 60400\nstiffness_n_per_m2 = 780000.0\n";

    fn parsed(text: &str) -> Result<VehicleParameters, String> {
        VehicleParameters::parse(text, Path::new("car.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn a_file_of_either_kind_says_how_stiff_a_face_is_and_keeps_it() {
        let sheet = format!("[data_sheet]\nclass = \"car\"\n{SECTION}");
        for text in [format!("{}{SECTION}", Preset::Reference.text()), sheet] {
            let vehicle = parsed(&text).unwrap();
            let front = vehicle.crush.front.unwrap();
            assert_eq!([front.onset_n_per_m, front.stiffness_n_per_m2], [60_400.0, 780_000.0]);
            assert!(vehicle.crush.side.is_none() && vehicle.crush.rear.is_none());
            let again = match &vehicle.sheet {
                Some(sheet) => DataSheet::clone(sheet).checked_vehicle().unwrap(),
                None => parsed(&toml::to_string(&vehicle).unwrap()).unwrap(),
            };
            assert_eq!(again.crush, vehicle.crush);
        }
    }

    #[test]
    fn a_number_out_of_range_or_a_key_too_many_or_too_few_is_refused_by_name() {
        let sheet = format!("[data_sheet]\nclass = \"car\"\n{SECTION}");
        let whole = format!("{}{SECTION}", Preset::Reference.text());
        for (old, new, expected) in [
            ("60400", "-1", "onset_n_per_m"),
            ("780000.0", "nan", "stiffness_n_per_m2"),
            ("onset_n_per_m = 60400\n", "", "onset_n_per_m"),
            ("onset_n_per_m", "onset_n", "onset_n"),
            ("crush.front", "crush.nose", "nose"),
        ] {
            for text in [&sheet, &whole] {
                let problem = parsed(&text.replace(old, new)).unwrap_err();
                assert!(problem.contains(expected) && problem.contains("car.toml"), "{problem}");
            }
        }
    }
}
