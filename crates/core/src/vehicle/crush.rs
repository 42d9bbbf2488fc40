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

/// A face of a vehicle, as a file names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CrushFace {
    /// The front.
    Front,
    /// The left and the right side.
    Side,
    /// The rear.
    Rear,
}

impl CrushFace {
    /// Every face, from the front to the rear.
    pub const ALL: [Self; 3] = [Self::Front, Self::Side, Self::Rear];

    /// The word of a vehicle file.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Side => "side",
            Self::Rear => "rear",
        }
    }

    /// Keys of A and of B of the face in a vehicle file.
    const fn keys(self) -> [&'static str; 2] {
        match self {
            Self::Front => ["crush.front.onset_n_per_m", "crush.front.stiffness_n_per_m2"],
            Self::Side => ["crush.side.onset_n_per_m", "crush.side.stiffness_n_per_m2"],
            Self::Rear => ["crush.rear.onset_n_per_m", "crush.rear.stiffness_n_per_m2"],
        }
    }
}

impl CrushParameters {
    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.known().next().is_none()
    }

    /// A and B of a face, if they are known.
    pub fn face(&self, face: CrushFace) -> Option<CrushStiffness> {
        match face {
            CrushFace::Front => self.front,
            CrushFace::Side => self.side,
            CrushFace::Rear => self.rear,
        }
    }

    /// A and B of a face, to be changed; `None` leaves them to the rule.
    pub fn face_mut(&mut self, face: CrushFace) -> &mut Option<CrushStiffness> {
        match face {
            CrushFace::Front => &mut self.front,
            CrushFace::Side => &mut self.side,
            CrushFace::Rear => &mut self.rear,
        }
    }

    /// The faces of which A and B are known.
    fn known(&self) -> impl Iterator<Item = (CrushFace, CrushStiffness)> + use<> {
        let parameters = *self;
        CrushFace::ALL.into_iter().filter_map(move |face| Some((face, parameters.face(face)?)))
    }

    /// Every number with its key and its range.
    pub(super) fn ranges(&self) -> impl Iterator<Item = (&'static str, f64, Range)> + use<> {
        self.known().flat_map(|(face, known)| {
            let [onset, stiffness] = face.keys();
            [
                (onset, known.onset_n_per_m, CRUSH_ONSET),
                (stiffness, known.stiffness_n_per_m2, CRUSH_STIFFNESS),
            ]
        })
    }

    /// Reads the section of a data sheet.
    pub(super) fn read(table: Option<TomlTable<'_>>) -> Result<Self, TomlError> {
        let mut found = Self::default();
        let Some(mut table) = table else { return Ok(found) };
        for of in CrushFace::ALL {
            let Some(mut face) = table.optional_table(of.word())? else { continue };
            let onset = face.plain("onset_n_per_m", &CRUSH_ONSET)?;
            let onset_n_per_m = onset.ok_or_else(|| face.missing("onset_n_per_m"))?;
            let stiffness = face.plain("stiffness_n_per_m2", &CRUSH_STIFFNESS)?;
            let stiffness_n_per_m2 = stiffness.ok_or_else(|| face.missing("stiffness_n_per_m2"))?;
            face.finish()?;
            *found.face_mut(of) = Some(CrushStiffness { onset_n_per_m, stiffness_n_per_m2 });
        }
        table.finish()?;
        Ok(found)
    }

    /// The section of a file.
    pub(super) fn to_table(self) -> toml::Table {
        let section = |(face, known): (CrushFace, CrushStiffness)| {
            let mut table = toml::Table::new();
            table.insert("onset_n_per_m".to_owned(), known.onset_n_per_m.into());
            table.insert("stiffness_n_per_m2".to_owned(), known.stiffness_n_per_m2.into());
            (face.word().to_owned(), table.into())
        };
        self.known().map(section).collect()
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
