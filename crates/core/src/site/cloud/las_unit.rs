//! The unit of the coordinates of LAS, by the coordinate system that a file may state: as WKT, or as keys of
//! GeoTIFF.

use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use las::Reader;
use las::crs::GeoTiffData;

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::site::LengthUnit;
use crate::site::cloud::las_check::CheckedHeader;

/// Keys of GeoTIFF: the kind of the system, 2 for longitude and latitude, and the unit of its lengths.
const MODEL_TYPE: u16 = 1024;
const LENGTH_UNIT: u16 = 3076;

/// Characters of WKT that are examined.
const EXAMINED_BYTES: usize = 64 << 10;

/// A unit of coordinates in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CoordinateUnit {
    Length(LengthUnit),
    Degrees,
}

/// The unit that a file states; `None` if it states none that is known.
pub(super) fn stated_unit(path: &Path) -> Option<CoordinateUnit> {
    // The reader may panic where a file is damaged, which is said when its points are read.
    let read = catch_unwind(AssertUnwindSafe(|| {
        CheckedHeader::read(path).ok()?;
        let (file, _) = open_file(path, MAX_CLOUD_BYTES).ok()?;
        let reader = Reader::new(BufReader::new(file)).ok()?;
        of_header(reader.header())
    }));
    read.ok().flatten()
}

fn of_header(header: &las::Header) -> Option<CoordinateUnit> {
    if let Some(wkt) = header.get_wkt_crs_bytes() {
        return of_wkt(&String::from_utf8_lossy(wkt.get(..EXAMINED_BYTES).unwrap_or(wkt)));
    }
    let keys = header.get_geotiff_crs().ok()??;
    let value = |id: u16| {
        keys.entries.iter().find(|entry| entry.id == id).and_then(|entry| match entry.data {
            GeoTiffData::U16(value) => Some(value),
            _ => None,
        })
    };
    match (value(MODEL_TYPE), value(LENGTH_UNIT)) {
        (Some(2), _) => Some(CoordinateUnit::Degrees),
        (_, Some(9001)) => Some(CoordinateUnit::Length(LengthUnit::Metre)),
        (_, Some(9002)) => Some(CoordinateUnit::Length(LengthUnit::Foot)),
        (_, Some(9003)) => Some(CoordinateUnit::Length(LengthUnit::SurveyFoot)),
        _ => None,
    }
}

/// The last unit of the part in the plane: that of its axes stands behind those of what it is made of.
fn of_wkt(text: &str) -> Option<CoordinateUnit> {
    let lower = text.to_lowercase();
    let plane = ["vert_cs", "vertcrs"].iter().filter_map(|word| lower.find(word)).min();
    let plane = lower.get(..plane.unwrap_or(lower.len()))?;
    let is_projected = ["projcs", "projcrs"].iter().any(|word| plane.contains(word));
    let is_geographic = ["geogcs", "geogcrs", "geodcrs"].iter().any(|word| plane.contains(word));
    if is_geographic && !is_projected {
        return Some(CoordinateUnit::Degrees);
    }
    let (_, last) = plane.rsplit_once("unit[\"")?;
    let name: String = last.split('"').next()?.chars().filter(|c| c.is_alphabetic()).collect();
    let unit = match name.as_str() {
        "metre" | "meter" | "m" => LengthUnit::Metre,
        "foot" | "internationalfoot" | "ft" | "feet" => LengthUnit::Foot,
        name if name.contains("us") && (name.contains("foot") || name.contains("ft")) => {
            LengthUnit::SurveyFoot
        }
        _ => return None,
    };
    Some(CoordinateUnit::Length(unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_the_plane_is_found() {
        let projected = |unit: &str| {
            format!(
                "COMPD_CS[\"a\",PROJCS[\"b\",GEOGCS[\"c\",UNIT[\"degree\",0.0174532925199433]],\
                 PROJECTION[\"Lambert\"],UNIT[\"{unit}\",1],AXIS[\"X\",EAST]],\
                 VERT_CS[\"d\",UNIT[\"metre\",1]]]"
            )
        };
        for (name, unit) in [
            ("metre", LengthUnit::Metre),
            ("US survey foot", LengthUnit::SurveyFoot),
            ("Foot_US", LengthUnit::SurveyFoot),
            ("foot", LengthUnit::Foot),
        ] {
            assert_eq!(of_wkt(&projected(name)), Some(CoordinateUnit::Length(unit)), "{name}");
        }
        assert_eq!(of_wkt(&projected("link")), None);
        let geographic = "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174532925199433]]";
        assert_eq!(of_wkt(geographic), Some(CoordinateUnit::Degrees));
        assert_eq!(of_wkt(""), None);
    }
}
