//! The units of the coordinates of a cloud. Those of LAS are stated by its coordinate system, if it has one: as
//! WKT, or as keys of GeoTIFF. Heights may have another unit than easting and northing.

use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use las::Reader;
use las::crs::GeoTiffData;

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::site::cloud::las_check::CheckedHeader;
use crate::site::cloud::source::damaged;
use crate::site::{CloudFormat, LengthUnit, SiteError};

/// Keys of GeoTIFF: the kind of the system, 2 for longitude and latitude, the unit of its lengths, and that of
/// its heights.
const MODEL_TYPE: u16 = 1024;
const LENGTH_UNIT: u16 = 3076;
const HEIGHT_UNIT: u16 = 4099;

/// Characters of WKT that are examined.
const EXAMINED_BYTES: usize = 64 << 10;

/// A unit of coordinates in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CoordinateUnit {
    Length(LengthUnit),
    Degrees,
}

/// What a file states; `None` where it states nothing that is known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Stated {
    plane: Option<CoordinateUnit>,
    height: Option<LengthUnit>,
}

/// The units in which the coordinates of a cloud are taken.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CloudUnits {
    plane: LengthUnit,
    height: LengthUnit,
    /// What is said of them, in words.
    pub note: Option<String>,
}

impl CloudUnits {
    /// Those of a file: E57 is in metres, LAS in what is chosen, else in what it states, else in metres.
    ///
    /// # Errors
    /// [`SiteError::Cloud`] for longitudes and latitudes.
    pub fn of(
        path: &Path,
        format: CloudFormat,
        chosen: Option<LengthUnit>,
    ) -> Result<Self, SiteError> {
        match format {
            CloudFormat::E57 => {
                Ok(Self { plane: LengthUnit::Metre, height: LengthUnit::Metre, note: None })
            }
            CloudFormat::Las => {
                Self::chosen(chosen, stated(path)).map_err(|why| damaged(path, &why))
            }
        }
    }

    /// # Errors
    /// Why the coordinates are none in the plane, in words.
    fn chosen(chosen: Option<LengthUnit>, stated: Stated) -> Result<Self, &'static str> {
        let plane = match stated.plane {
            Some(CoordinateUnit::Degrees) => {
                return Err(
                    "its coordinates are longitude and latitude; bring it into a projected system first",
                );
            }
            Some(CoordinateUnit::Length(unit)) => Some(unit),
            None => None,
        };
        let unit = chosen.or(plane).unwrap_or_default();
        let is_as_stated = plane == Some(unit) || (plane.is_none() && chosen.is_none());
        let height = stated.height.filter(|_| is_as_stated).unwrap_or(unit);
        let (taken, of_heights) = (unit.word(), height.word());
        let note = match plane {
            None => {
                format!("it does not say the unit of its coordinates; they were taken as {taken}")
            }
            Some(plane) if plane != unit => format!(
                "its coordinate system is in {}, and its coordinates were taken as {taken}: if that was not on \
                 purpose, all lengths are wrong; say the unit (--unit {})",
                plane.word(),
                plane.word()
            ),
            Some(_) => {
                format!("its coordinates are in {taken}, as its coordinate system says")
            }
        };
        let note = match height == unit {
            true => note,
            false => format!("{note}; its heights are in {of_heights}, as it says"),
        };
        let is_plain = plane == Some(LengthUnit::Metre) && [unit, height] == [LengthUnit::Metre; 2];
        Ok(Self { plane: unit, height, note: (!is_plain).then_some(note) })
    }

    /// Easting, northing and height of a point, m.
    pub fn in_metres(&self, [easting, northing, height]: [f64; 3]) -> [f64; 3] {
        let [plane_m, height_m] = [self.plane, self.height].map(LengthUnit::length_m);
        [easting * plane_m, northing * plane_m, height * height_m]
    }
}

/// The unit of easting and northing that a LAS file states; `None` if it states none that is known.
pub fn stated_cloud_unit(path: &Path) -> Option<LengthUnit> {
    match stated(path).plane? {
        CoordinateUnit::Length(unit) => Some(unit),
        CoordinateUnit::Degrees => None,
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

fn of_header(header: &las::Header) -> Option<Stated> {
    if let Some(wkt) = header.get_wkt_crs_bytes() {
        return Some(of_wkt(&String::from_utf8_lossy(wkt.get(..EXAMINED_BYTES).unwrap_or(wkt))));
    }
    let keys = header.get_geotiff_crs().ok()??;
    let value = |id: u16| {
        keys.entries.iter().find(|entry| entry.id == id).and_then(|entry| match entry.data {
            GeoTiffData::U16(value) => Some(value),
            _ => None,
        })
    };
    let length = |id: u16| match value(id)? {
        9001 => Some(LengthUnit::Metre),
        9002 => Some(LengthUnit::Foot),
        9003 => Some(LengthUnit::SurveyFoot),
        _ => None,
    };
    let plane = match value(MODEL_TYPE) {
        Some(2) => Some(CoordinateUnit::Degrees),
        _ => length(LENGTH_UNIT).map(CoordinateUnit::Length),
    };
    Some(Stated { plane, height: length(HEIGHT_UNIT) })
}

/// The last unit of the part in the plane, where that of its axes stands behind those of what it is made of, and
/// the last one of the part of the heights.
fn of_wkt(text: &str) -> Stated {
    let lower = text.to_lowercase();
    let vertical = ["vert_cs", "vertcrs"].iter().filter_map(|word| lower.find(word)).min();
    let (plane, vertical) = lower.split_at(vertical.unwrap_or(lower.len()));
    let is_projected = ["projcs", "projcrs"].iter().any(|word| plane.contains(word));
    let is_geographic = ["geogcs", "geogcrs", "geodcrs"].iter().any(|word| plane.contains(word));
    let plane = match is_geographic && !is_projected {
        true => Some(CoordinateUnit::Degrees),
        false => last_unit(plane).map(CoordinateUnit::Length),
    };
    Stated { plane, height: last_unit(vertical) }
}

/// The last unit of length in a part of WKT; `None` if it is none that is known.
fn last_unit(text: &str) -> Option<LengthUnit> {
    let (_, last) = text.rsplit_once("unit[\"")?;
    let name: String = last.split('"').next()?.chars().filter(|c| c.is_alphabetic()).collect();
    match name.as_str() {
        "metre" | "meter" | "m" => Some(LengthUnit::Metre),
        "foot" | "internationalfoot" | "ft" | "feet" => Some(LengthUnit::Foot),
        name if name.contains("us") && (name.contains("foot") || name.contains("ft")) => {
            Some(LengthUnit::SurveyFoot)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(unit: LengthUnit) -> Option<CoordinateUnit> {
        Some(CoordinateUnit::Length(unit))
    }

    fn projected(plane: &str, height: &str) -> String {
        format!(
            "COMPD_CS[\"a\",PROJCS[\"b\",GEOGCS[\"c\",UNIT[\"degree\",0.0174532925199433]],\
             PROJECTION[\"Lambert\"],UNIT[\"{plane}\",1],AXIS[\"X\",EAST]],\
             VERT_CS[\"d\",UNIT[\"{height}\",1]]]"
        )
    }

    #[test]
    fn the_units_of_plane_and_heights_are_found() {
        for (name, unit) in [
            ("metre", LengthUnit::Metre),
            ("US survey foot", LengthUnit::SurveyFoot),
            ("Foot_US", LengthUnit::SurveyFoot),
            ("foot", LengthUnit::Foot),
        ] {
            let height = Some(LengthUnit::Metre);
            let stated = of_wkt(&projected(name, "metre"));
            assert_eq!(stated, Stated { plane: length(unit), height }, "{name}");
            let (plane, height) = (length(LengthUnit::Metre), Some(unit));
            let stated = of_wkt(&projected("metre", name));
            assert_eq!(stated, Stated { plane, height }, "{name}");
        }
        assert_eq!(of_wkt(&projected("link", "link")), Stated::default());
        let geographic = "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174532925199433]]";
        let plane = Some(CoordinateUnit::Degrees);
        assert_eq!(of_wkt(geographic), Stated { plane, height: None });
        assert_eq!(of_wkt(""), Stated::default());
    }

    #[test]
    fn what_a_file_states_is_taken_unless_another_unit_is_chosen() {
        let stated = of_wkt(&projected("US survey foot", "metre"));
        let units = CloudUnits::chosen(None, stated).unwrap();
        let foot_m = LengthUnit::SurveyFoot.length_m();
        assert_eq!(units.in_metres([2.0, 4.0, 3.0]), [2.0 * foot_m, 4.0 * foot_m, 3.0]);
        let note = units.note.clone().unwrap();
        assert!(
            note.contains("in us_survey_ft, as") && note.contains("heights are in m"),
            "{note}"
        );
        assert_eq!(CloudUnits::chosen(Some(LengthUnit::SurveyFoot), stated), Ok(units));
        let other = CloudUnits::chosen(Some(LengthUnit::Metre), stated).unwrap();
        assert_eq!(other.in_metres([2.0, 4.0, 3.0]), [2.0, 4.0, 3.0]);
        assert!(other.note.unwrap().contains("--unit us_survey_ft"));
        let metres = CloudUnits::chosen(None, of_wkt(&projected("metre", "metre"))).unwrap();
        assert_eq!(metres.note, None);
        let unknown = CloudUnits::chosen(None, Stated::default()).unwrap();
        assert!(unknown.note.unwrap().contains("does not say the unit"));
        let feet = LengthUnit::Foot;
        let heights = Stated { plane: None, height: Some(feet) };
        let units = CloudUnits::chosen(None, heights).unwrap();
        assert_eq!(units.in_metres([1.0; 3]), [1.0, 1.0, feet.length_m()]);
    }
}
