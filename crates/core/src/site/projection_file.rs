//! The coordinate system of a world file, which programs of surveys and maps write beside the picture: as WKT in
//! `road.prj`, or in `road.png.aux.xml`. The world file itself says neither system nor unit.

use std::path::{Path, PathBuf};

use crate::data::read_bytes;
use crate::site::cloud::{OF_MERCATOR, StatedUnit, of_wkt};
use crate::site::{LengthUnit, SiteError, geo_tiff};

/// Bytes of such a file. A program may write the statistics of a picture beside its coordinate system.
const MAX_BYTES: u64 = 16 << 20;

/// The file beside a picture, or beside its world file, with the coordinate system; `None` if there is none.
pub(super) fn projection_beside(picture: &Path, world_file: &Path) -> Option<PathBuf> {
    let mut described = picture.as_os_str().to_owned();
    described.push(".aux.xml");
    let endings = ["prj", "PRJ"];
    let beside = |file: &Path| endings.map(|ending| file.with_extension(ending));
    let files = [beside(world_file), beside(picture)].concat();
    files.into_iter().chain([PathBuf::from(described)]).find(|file| file.is_file())
}

/// The unit of a world file: the one that is chosen, else that of the system beside it or in the keys of a GeoTIFF, else
/// metres.
///
/// # Errors
/// [`SiteError::Projection`] if the system is none in the plane or that of web maps, or if its unit is not the
/// chosen one; [`SiteError::Data`].
pub(super) fn unit_of_world_file(
    picture: &Path,
    world_file: &Path,
    chosen: Option<LengthUnit>,
) -> Result<LengthUnit, SiteError> {
    let beside = match projection_beside(picture, world_file) {
        Some(path) => {
            let stated = of_wkt(&system_in(&read_bytes(&path, MAX_BYTES)?)).plane;
            stated.map(|stated| (path, Some(stated)))
        }
        None => None,
    };
    // Beside a GeoTIFF programs write the statistics of the picture alone.
    let (path, stated) =
        beside.unwrap_or_else(|| (picture.to_owned(), geo_tiff::stated_in(picture)));
    let wrong = |message: String| Err(SiteError::Projection { path, message });
    match (chosen, stated) {
        (_, Some(StatedUnit::Mercator)) => wrong(OF_MERCATOR.to_owned()),
        (_, Some(StatedUnit::OffPlane)) => wrong(
            "its coordinates are longitude and latitude, or geocentric; bring it into a projected system first"
                .to_owned(),
        ),
        (Some(chosen), Some(StatedUnit::Length(stated))) if chosen != stated => wrong(format!(
            "its coordinates are in {}, and unit in [orthophoto] is {}, expected the same, or no unit there",
            stated.word(),
            chosen.word()
        )),
        (Some(chosen), _) => Ok(chosen),
        (None, Some(StatedUnit::Length(stated))) => Ok(stated),
        (None, Some(StatedUnit::Other)) => wrong(
            "the unit of its coordinates is not known here; say it (unit in [orthophoto] of a site file)"
                .to_owned(),
        ),
        (None, None) => Ok(LengthUnit::Metre),
    }
}

/// The text of a coordinate system. Its words are ASCII in any encoding, and names of places may be in another than
/// UTF-8; a file of XML has its quotation marks in words.
fn system_in(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).replace('\0', "").replace("&quot;", "\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_system_beside_a_picture_says_its_unit_or_why_it_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let (picture, world) = (at("road.png"), at("road.pgw"));
        let unit = |chosen| {
            unit_of_world_file(&picture, &world, chosen).map_err(|error| error.to_string())
        };
        assert_eq!(unit(None), Ok(LengthUnit::Metre));
        assert_eq!(unit(Some(LengthUnit::Foot)), Ok(LengthUnit::Foot));
        assert_eq!(projection_beside(&picture, &world), None);
        let system = |projection: &str, unit: &str| {
            format!(
                "PROJCS[\"a\",GEOGCS[\"b\",UNIT[\"Degree\",0.0174532925199433]],\
                 PROJECTION[\"{projection}\"],PARAMETER[\"c\",0.0],UNIT[{unit}]]"
            )
        };
        let lambert = system("Lambert_Conformal_Conic", "\"Foot_US\",0.3048006096012192");
        std::fs::write(at("road.prj"), &lambert).unwrap();
        assert_eq!(projection_beside(&picture, &world), Some(at("road.prj")));
        for chosen in [None, Some(LengthUnit::SurveyFoot)] {
            assert_eq!(unit(chosen), Ok(LengthUnit::SurveyFoot));
        }
        let error = unit(Some(LengthUnit::Metre)).unwrap_err();
        assert!(error.contains("road.prj: its coordinates are in us_survey_ft"), "{error}");
        for (text, expected) in [
            (system("Mercator_Auxiliary_Sphere", "\"Meter\",1.0"), "web maps (EPSG:3857)"),
            ("GEOGCS[\"b\",UNIT[\"Degree\",0.0174532925199433]]".to_owned(), "longitude"),
            (system("Lambert", "\"Chain\",20.1168"), "is not known here"),
        ] {
            std::fs::write(at("road.prj"), text).unwrap();
            let error = unit(None).unwrap_err();
            assert!(error.contains("road.prj: ") && error.contains(expected), "{error}");
        }
        std::fs::write(at("road.prj"), system("Transverse_Mercator", "\"Meter\",1.0")).unwrap();
        assert_eq!(unit(None), Ok(LengthUnit::Metre));
        // Names in Latin-1, and a file in UTF-16, as shells of Windows write it.
        let latin: Vec<u8> = lambert.replace("\"a\"", "\"Stra#e\"").bytes().collect();
        let latin: Vec<u8> =
            latin.into_iter().map(|of| if of == b'#' { 0xdf } else { of }).collect();
        let wide = lambert.encode_utf16().flat_map(u16::to_le_bytes);
        let wide: Vec<u8> = [0xff, 0xfe].into_iter().chain(wide).collect();
        for bytes in [latin, wide] {
            std::fs::write(at("road.prj"), bytes).unwrap();
            assert_eq!(unit(None), Ok(LengthUnit::SurveyFoot));
        }
        // A file of XML without a system, and with one.
        std::fs::remove_file(at("road.prj")).unwrap();
        let statistics = "<PAMDataset><MDI key=\"STATISTICS_MEAN\">91</MDI></PAMDataset>";
        std::fs::write(at("road.png.aux.xml"), statistics).unwrap();
        assert_eq!(unit(None), Ok(LengthUnit::Metre));
        let xml = lambert.replace('"', "&quot;");
        std::fs::write(
            at("road.png.aux.xml"),
            format!("<PAMDataset><SRS>{xml}</SRS></PAMDataset>"),
        )
        .unwrap();
        assert_eq!(unit(None), Ok(LengthUnit::SurveyFoot));
    }
}
