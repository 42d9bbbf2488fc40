//! The units in which the coordinates of a cloud are taken.

use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use e57::{E57Reader, PointCloud};
use las::Reader;

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::site::cloud::las_check::CheckedHeader;
use crate::site::cloud::las_crs::{Stated, StatedUnit, of_header, of_wkt};
use crate::site::cloud::source::damaged;
use crate::site::{CloudFormat, LengthUnit, SiteError};

/// Why coordinates in the projection of Mercator are refused.
pub(in crate::site) const OF_MERCATOR: &str = "its coordinates are those of a map in the projection of Mercator, as of web maps \
    (EPSG:3857), whose metres are shorter than those on the ground by the cosine of the latitude, to two thirds at \
    48 degrees; bring it into a grid of the country or into UTM first";

/// The units in which the coordinates of a cloud are taken.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CloudUnits {
    plane: LengthUnit,
    height: LengthUnit,
    /// What is said of them, and of the places of scans, in words.
    pub note: Option<String>,
}

impl CloudUnits {
    /// Those of a file: E57 is in metres, LAS in what is chosen, else in what it states, else in metres.
    ///
    /// # Errors
    /// [`SiteError::Cloud`] for coordinates that are none in the plane or whose unit differs from place to place, and
    /// if a unit has to be chosen: that of the plane is not known here, or heights alone are said to be in feet.
    pub fn of(
        path: &Path,
        format: CloudFormat,
        chosen: Option<LengthUnit>,
    ) -> Result<Self, SiteError> {
        match format {
            CloudFormat::E57 => match of_e57(path) {
                (stated, _) if stated.plane == Some(StatedUnit::Mercator) => {
                    Err(damaged(path, &OF_MERCATOR))
                }
                (_, note) => Ok(Self { plane: LengthUnit::Metre, height: LengthUnit::Metre, note }),
            },
            CloudFormat::Las => {
                Self::chosen(chosen, stated(path)).map_err(|why| damaged(path, &why))
            }
        }
    }

    /// # Errors
    /// Why the coordinates are none in the plane, or why a unit has to be chosen, in words.
    fn chosen(chosen: Option<LengthUnit>, stated: Stated) -> Result<Self, String> {
        let unit = match (chosen, stated.plane) {
            (_, Some(StatedUnit::OffPlane)) => {
                return Err(
                    "its coordinates are longitude and latitude, or geocentric; bring it into a \
                            projected system first"
                        .to_owned(),
                );
            }
            (_, Some(StatedUnit::Mercator)) => return Err(OF_MERCATOR.to_owned()),
            (Some(chosen), _) => chosen,
            (None, Some(StatedUnit::Length(unit))) => unit,
            (None, Some(StatedUnit::Other)) => {
                return Err(
                    "the unit of its coordinate system is not known here; say in which its \
                            coordinates are (--unit)"
                        .to_owned(),
                );
            }
            (None, None) => stated.unit_without_plane()?,
        };
        let height = match stated.height {
            Some(StatedUnit::Length(height))
                if stated.plane.is_none_or(|of| of == StatedUnit::Length(unit)) =>
            {
                height
            }
            _ => unit,
        };
        let plane_note = stated.plane_note(unit);
        let height_note = match stated.height {
            Some(StatedUnit::Other | StatedUnit::OffPlane | StatedUnit::Mercator) => Some(format!(
                "the unit of its heights is not known here; they were taken as {}",
                height.word()
            )),
            _ => (height != unit)
                .then(|| format!("its heights are in {}, as it says", height.word())),
        };
        let notes: Vec<String> = plane_note.into_iter().chain(height_note).collect();
        let note = (!notes.is_empty()).then(|| notes.join("; "));
        Ok(Self { plane: unit, height, note })
    }

    /// The name of the unit of its heights.
    pub fn height_word(&self) -> &'static str {
        self.height.word()
    }

    /// Easting, northing and height of a point, m.
    pub fn in_metres(&self, [easting, northing, height]: [f64; 3]) -> [f64; 3] {
        let [plane_m, height_m] = [self.plane, self.height].map(LengthUnit::length_m);
        [easting * plane_m, northing * plane_m, height * height_m]
    }
}

impl Stated {
    /// The unit of a file that does not say that of the plane: metres, unless its heights are in another.
    ///
    /// # Errors
    /// Why it has to be chosen, in words.
    fn unit_without_plane(&self) -> Result<LengthUnit, String> {
        if let Some(system) = self.system_in_feet() {
            return Err(format!(
                "its coordinate system EPSG:{system} is one of the State Plane in feet, and it does not say in which; \
                 look the system up, and say the unit of its coordinates (--unit us_survey_ft in most states, or ft)"
            ));
        }
        match self.height {
            None | Some(StatedUnit::Length(LengthUnit::Metre)) => Ok(LengthUnit::Metre),
            Some(StatedUnit::Length(height)) => Err(format!(
                "it says that its heights are in {}, and not in which unit its easting and northing are; say it \
                 (--unit)",
                height.word()
            )),
            Some(StatedUnit::Other | StatedUnit::OffPlane | StatedUnit::Mercator) => {
                Err("the unit of its heights is not known here, and it does not say that of its easting and \
                     northing; say it (--unit)"
                    .to_owned())
            }
        }
    }

    /// What is said of the unit in which easting and northing are taken; `None` for metres beyond doubt.
    fn plane_note(&self, unit: LengthUnit) -> Option<String> {
        let taken = unit.word();
        let on_purpose = "if that was not on purpose, all lengths are wrong";
        Some(match (self.plane, self.system) {
            (Some(StatedUnit::Length(LengthUnit::Metre)), _) if unit == LengthUnit::Metre => {
                return None;
            }
            (Some(StatedUnit::Length(stated)), _) if stated == unit => {
                format!("its coordinates are in {taken}, as its coordinate system says")
            }
            (Some(StatedUnit::Length(stated)), _) => format!(
                "its coordinate system is in {0}, and its coordinates were taken as {taken}: {on_purpose}; \
                 say the unit (--unit {0})",
                stated.word()
            ),
            (Some(StatedUnit::Other | StatedUnit::OffPlane | StatedUnit::Mercator), _) => format!(
                "the unit of its coordinate system is not known here, and its coordinates were taken as \
                 {taken}: {on_purpose}"
            ),
            (None, Some(system))
                if unit == LengthUnit::Metre && self.system_in_feet().is_some() =>
            {
                format!(
                    "its coordinate system EPSG:{system} is in feet, and its coordinates were taken as {taken}: \
                     {on_purpose}; say the unit (--unit us_survey_ft or ft)"
                )
            }
            (None, Some(system)) => format!(
                "its coordinate system is EPSG:{system}, whose unit it does not say; its coordinates were taken \
                 as {taken}: compare that with the system, and say another unit (--unit)"
            ),
            (None, None) => {
                format!("it does not say the unit of its coordinates; they were taken as {taken}")
            }
        })
    }
}

/// The unit of easting and northing that a LAS file states, else the usual one of its system, else that of its heights;
/// `None` if it states none that is known.
pub fn stated_cloud_unit(path: &Path) -> Option<LengthUnit> {
    let stated = stated(path);
    if stated.system_in_feet().is_some() {
        return Some(LengthUnit::SurveyFoot);
    }
    match stated.plane.or(stated.height)? {
        StatedUnit::Length(unit) => Some(unit),
        StatedUnit::Other | StatedUnit::OffPlane | StatedUnit::Mercator => None,
    }
}

fn stated(path: &Path) -> Stated {
    // The reader may panic where a file is damaged, which is said when its points are read.
    let read = catch_unwind(AssertUnwindSafe(|| {
        CheckedHeader::read(path).ok()?;
        let (file, _) = open_file(path, MAX_CLOUD_BYTES).ok()?;
        let reader = Reader::new(BufReader::new(file)).ok()?;
        of_header(reader.header())
    }));
    read.ok().flatten().unwrap_or_default()
}

/// What an E57 file states of its coordinate system, which few do, and what is said of that and of its scans.
fn of_e57(path: &Path) -> (Stated, Option<String>) {
    // As above, of the other reader.
    let read = catch_unwind(AssertUnwindSafe(|| {
        let (file, _) = open_file(path, MAX_CLOUD_BYTES).ok()?;
        let reader = E57Reader::new(BufReader::new(file)).ok()?;
        let stated = reader.coordinate_metadata().map(of_wkt).unwrap_or_default();
        let notes = [other_unit(stated), not_registered(&reader.pointclouds())];
        let notes: Vec<String> = notes.into_iter().flatten().collect();
        Some((stated, (!notes.is_empty()).then(|| notes.join("; "))))
    }));
    read.ok().flatten().unwrap_or_default()
}

/// That the coordinate system of E57, which has metres, is in another unit.
fn other_unit(stated: Stated) -> Option<String> {
    let Some(StatedUnit::Length(unit)) = stated.plane else { return None };
    let word = unit.word();
    (unit != LengthUnit::Metre).then(|| {
        format!(
            "its coordinate system is in {word}, while E57 has metres, as which its coordinates were taken: if it was \
             written in {word}, write it again in metres"
        )
    })
}

/// That several scans stand at the origin, as those of a scanner before they are brought into one system.
fn not_registered(scans: &[PointCloud]) -> Option<String> {
    let scans: Vec<&PointCloud> = scans.iter().filter(|scan| scan.records > 0).collect();
    let is_placed = |scan: &&&PointCloud| {
        let place = scan.transform.as_ref().map(|of| &of.translation);
        place.is_some_and(|of| [of.x, of.y, of.z].iter().any(|value| *value != 0.0))
    };
    let n = scans.len();
    let n_at_origin = n - scans.iter().filter(is_placed).count();
    (n_at_origin > 1).then(|| {
        format!(
            "{n_at_origin} of its {n} scans stand at the origin: unless they were in one system when they were written, \
             they lie on top of each other; register them in the program of the scanner"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEET: LengthUnit = LengthUnit::Foot;
    const SURVEY_FEET: LengthUnit = LengthUnit::SurveyFoot;
    const METRES: LengthUnit = LengthUnit::Metre;

    fn of(plane: Option<StatedUnit>, height: Option<StatedUnit>) -> Stated {
        Stated { plane, height, system: None }
    }

    fn length(unit: LengthUnit) -> Option<StatedUnit> {
        Some(StatedUnit::Length(unit))
    }

    #[test]
    fn what_a_file_states_is_taken_unless_another_unit_is_chosen() {
        let stated = of(length(SURVEY_FEET), length(METRES));
        let units = CloudUnits::chosen(None, stated).unwrap();
        let foot_m = SURVEY_FEET.length_m();
        assert_eq!(units.in_metres([2.0, 4.0, 3.0]), [2.0 * foot_m, 4.0 * foot_m, 3.0]);
        let note = units.note.clone().unwrap();
        assert!(
            note.contains("in us_survey_ft, as") && note.contains("heights are in m"),
            "{note}"
        );
        assert_eq!(CloudUnits::chosen(Some(SURVEY_FEET), stated), Ok(units));
        let other = CloudUnits::chosen(Some(METRES), stated).unwrap();
        assert_eq!(other.in_metres([2.0, 4.0, 3.0]), [2.0, 4.0, 3.0]);
        assert!(other.note.unwrap().contains("--unit us_survey_ft"));
        let metres = CloudUnits::chosen(None, of(length(METRES), length(METRES))).unwrap();
        assert_eq!(metres.note, None);
        let unknown = CloudUnits::chosen(None, Stated::default()).unwrap();
        assert!(unknown.note.unwrap().contains("does not say the unit"));
    }

    /// Feet that are taken as metres make a ground of more than three times its size.
    #[test]
    fn a_system_that_is_known_to_be_in_feet_is_not_taken_as_metres() {
        for system in [2225, 2251, 2289] {
            let by_number = Stated { system: Some(system), ..Stated::default() };
            let error = CloudUnits::chosen(None, by_number).unwrap_err();
            let said = format!("EPSG:{system} is one of the State Plane in feet");
            assert!(error.contains(&said) && error.contains("--unit us_survey_ft"), "{error}");
            let units = CloudUnits::chosen(Some(SURVEY_FEET), by_number).unwrap();
            assert_eq!(units.in_metres([1.0; 3]), [SURVEY_FEET.length_m(); 3]);
            assert!(units.note.unwrap().contains("taken as us_survey_ft: compare"));
            let metres = CloudUnits::chosen(Some(METRES), by_number).unwrap();
            assert!(
                metres.note.unwrap().contains("is in feet, and its coordinates were taken as m:")
            );
        }
    }

    #[test]
    fn a_unit_that_is_open_has_to_be_said() {
        let heights = of(None, length(FEET));
        let error = CloudUnits::chosen(None, heights).unwrap_err();
        assert!(error.contains("heights are in ft") && error.contains("--unit"), "{error}");
        // What is chosen is that of the plane; the heights are what they say.
        let units = CloudUnits::chosen(Some(METRES), heights).unwrap();
        assert_eq!(units.in_metres([1.0; 3]), [1.0, 1.0, FEET.length_m()]);
        let link = of(Some(StatedUnit::Other), None);
        let error = CloudUnits::chosen(None, link).unwrap_err();
        assert!(error.contains("not known here") && error.contains("--unit"), "{error}");
        let taken = CloudUnits::chosen(Some(FEET), link).unwrap();
        assert!(taken.note.unwrap().contains("were taken as ft"));
        let heights = of(length(METRES), Some(StatedUnit::Other));
        let note = CloudUnits::chosen(None, heights).unwrap().note.unwrap();
        assert!(note.contains("unit of its heights is not known"), "{note}");
        let by_number = |system| Stated { system: Some(system), ..Stated::default() };
        let units = CloudUnits::chosen(None, by_number(2056)).unwrap();
        assert!(units.note.unwrap().contains("EPSG:2056, whose unit it does not say"));
        let off_plane = of(Some(StatedUnit::OffPlane), None);
        for chosen in [None, Some(METRES)] {
            let error = CloudUnits::chosen(chosen, off_plane).unwrap_err();
            assert!(error.contains("longitude and latitude"), "{error}");
        }
        let web_map = of(Some(StatedUnit::Mercator), length(METRES));
        for chosen in [None, Some(METRES)] {
            let error = CloudUnits::chosen(chosen, web_map).unwrap_err();
            assert!(error.contains("EPSG:3857") && error.contains("UTM"), "{error}");
        }
    }
}
