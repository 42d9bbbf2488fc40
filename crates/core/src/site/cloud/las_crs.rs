//! What the coordinate system of a point cloud says of its units: as WKT, or as keys of GeoTIFF. Heights may have
//! another unit than easting and northing.

use las::crs::GeoTiffData;

use crate::site::LengthUnit;

/// Keys of GeoTIFF: the kind of the system, its number, its projection, the unit of its lengths, the number of the
/// system of heights, and their unit.
const MODEL_TYPE: u16 = 1024;
const SYSTEM: u16 = 3072;
const PROJECTION: u16 = 3075;
const LENGTH_UNIT: u16 = 3076;
const HEIGHT_SYSTEM: u16 = 4096;
const HEIGHT_UNIT: u16 = 4099;

/// Model types of coordinates that are none in the plane: longitude and latitude, and geocentric ones.
const OFF_PLANE: std::ops::RangeInclusive<u16> = 2..=3;

/// Numbers of GeoTIFF that stand for nothing, and for what other keys describe.
const UNDEFINED: u16 = 0;
const USER_DEFINED: u16 = 32_767;

/// The projection of Mercator, and EPSG numbers of systems with it: those of web maps, and of the world.
const OF_MERCATOR: u16 = 7;
const MERCATOR_SYSTEMS: [u16; 3] = [3857, 3785, 3395];

/// EPSG numbers of UTM over WGS 84, ETRS89 and NAD 83, which are in metres.
const UTM: [std::ops::RangeInclusive<u16>; 4] =
    [32_601..=32_660, 32_701..=32_760, 25_828..=25_838, 26_901..=26_923];

/// EPSG numbers of the State Plane systems of NAD 83 in feet: those of the United States, and international ones in
/// Michigan, Montana, North Dakota, Oregon, South Carolina and Utah. Later realisations mix with systems in metres.
const IN_FEET: std::ops::RangeInclusive<u16> = 2225..=2289;

/// EPSG numbers that projected systems alone have, of which UTM and the grids of most countries are. Others stand among
/// those of longitude and latitude.
const PROJECTED: [std::ops::RangeInclusive<u16>; 2] = [2000..=3799, 20_000..=32_766];

/// EPSG numbers of systems of heights: NAVD 88 in metres and both feet, and NGVD 29.
const HEIGHT_SYSTEMS: [(u16, LengthUnit); 4] = [
    (5703, LengthUnit::Metre),
    (8228, LengthUnit::Foot),
    (6360, LengthUnit::SurveyFoot),
    (5702, LengthUnit::SurveyFoot),
];

/// Characters of WKT that are examined.
const EXAMINED_BYTES: usize = 64 << 10;

/// Deviation of a factor of WKT from a length of a unit up to which it is that of the unit: the two feet differ by
/// 2e-6.
const FACTOR_REACH: f64 = 1e-7;

/// A unit that a file states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::site) enum StatedUnit {
    /// One of length.
    Length(LengthUnit),
    /// A unit of length that is not known here.
    Other,
    /// None of length: the coordinates are longitude and latitude, or geocentric.
    OffPlane,
    /// One whose length on the ground depends on the latitude: that of a map in the projection of Mercator.
    Mercator,
}

/// What a file states; `None` where it states nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(in crate::site) struct Stated {
    /// Of easting and northing.
    pub plane: Option<StatedUnit>,
    /// Of the heights.
    pub height: Option<StatedUnit>,
    /// The EPSG number of a system whose unit it does not state.
    pub system: Option<u16>,
}

impl Stated {
    /// The number of a system that is known to be in feet, if the unit is not stated.
    pub(in crate::site) fn system_in_feet(&self) -> Option<u16> {
        self.system.filter(is_in_feet)
    }
}

/// Whether a system by its EPSG number is one of those of State Plane in feet.
pub(in crate::site) fn is_in_feet(system: &u16) -> bool {
    IN_FEET.contains(system)
}

/// Whether a system by its EPSG number is certainly one of easting and northing.
pub(in crate::site) fn is_projected(system: &u16) -> bool {
    PROJECTED.iter().any(|numbers| numbers.contains(system))
}

/// What a header states; `None` if it has no coordinate system.
pub(super) fn of_header(header: &las::Header) -> Option<Stated> {
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
    Some(of_keys(value))
}

/// What the keys of a GeoTIFF state.
///
/// - `value`: of a key.
pub(in crate::site) fn of_keys(value: impl Fn(u16) -> Option<u16>) -> Stated {
    let length = |id: u16| {
        Some(match value(id)? {
            9001 => StatedUnit::Length(LengthUnit::Metre),
            9002 => StatedUnit::Length(LengthUnit::Foot),
            9003 => StatedUnit::Length(LengthUnit::SurveyFoot),
            UNDEFINED => return None,
            _ => StatedUnit::Other,
        })
    };
    let system = value(SYSTEM).filter(|system| ![UNDEFINED, USER_DEFINED].contains(system));
    let is_utm = system.is_some_and(|system| UTM.iter().any(|zones| zones.contains(&system)));
    let is_mercator = value(PROJECTION) == Some(OF_MERCATOR)
        || system.is_some_and(|system| MERCATOR_SYSTEMS.contains(&system));
    let plane = match value(MODEL_TYPE) {
        Some(kind) if OFF_PLANE.contains(&kind) => Some(StatedUnit::OffPlane),
        _ if is_mercator => Some(StatedUnit::Mercator),
        _ => {
            length(LENGTH_UNIT).or_else(|| is_utm.then_some(StatedUnit::Length(LengthUnit::Metre)))
        }
    };
    let of_system = |system: u16| {
        let known = HEIGHT_SYSTEMS.iter().find(|(number, _)| *number == system);
        known.map(|(_, unit)| StatedUnit::Length(*unit))
    };
    let height = length(HEIGHT_UNIT).or_else(|| of_system(value(HEIGHT_SYSTEM)?));
    Stated { plane, height, system: system.filter(|_| plane.is_none()) }
}

/// The last unit of the part in the plane, where that of its axes stands behind those of what it is made of, and
/// the last one of the part of the heights.
pub(in crate::site) fn of_wkt(text: &str) -> Stated {
    let lower = text.to_lowercase();
    let has = |text: &str, words: &[&str]| words.iter().any(|word| text.contains(word));
    let words = ["vert_cs", "vertcs", "vertcrs", "verticalcrs"];
    let vertical = words.iter().filter_map(|word| lower.find(word)).min();
    let (plane, vertical) = lower.split_at(vertical.unwrap_or(lower.len()));
    let is_off =
        has(plane, &["geogcs", "geogcrs", "geographiccrs", "geodcrs", "geodeticcrs", "geoccs"])
            && !has(plane, &["projcs", "projcrs", "projectedcrs"]);
    let plane = match () {
        () if is_off => Some(StatedUnit::OffPlane),
        () if is_of_mercator(plane) => Some(StatedUnit::Mercator),
        () => last_unit(plane),
    };
    Stated { plane, height: last_unit(vertical), system: None }
}

/// Whether a text in small letters names the projection of Mercator, and not one along a meridian or at an angle to
/// it, whose lengths are nearly those on the ground. Where it has a projection of its own, names of systems and areas do
/// not count.
fn is_of_mercator(text: &str) -> bool {
    let projection = ["projection[\"", "method[\""].iter().find_map(|word| {
        let (_, rest) = text.split_once(word)?;
        rest.split('"').next()
    });
    let text = projection.unwrap_or(text);
    text.match_indices("mercator").any(|(at, _)| {
        let before = text.get(..at).unwrap_or_default();
        let before = before.trim_end_matches(|c: char| !c.is_alphanumeric());
        !before.ends_with("transverse") && !before.ends_with("oblique")
    })
}

/// The last unit in a part of WKT, by its name, else by the metres that it has. What is called a foot alone may be that
/// of the survey, which its metres say.
fn last_unit(text: &str) -> Option<StatedUnit> {
    let (_, last) = text.rsplit_once("unit[\"")?;
    let (name, rest) = last.split_once('"')?;
    let name: String = name.chars().filter(|c| c.is_alphabetic()).collect();
    let by_name = match name.as_str() {
        "metre" | "meter" | "m" => Some(LengthUnit::Metre),
        "foot" | "internationalfoot" | "ft" | "feet" => Some(LengthUnit::Foot),
        name if name.contains("us") && (name.contains("foot") || name.contains("ft")) => {
            Some(LengthUnit::SurveyFoot)
        }
        _ => None,
    };
    let factor = rest.trim_start_matches([',', ' ']).split([',', ']']).next();
    let factor: Option<f64> = factor.and_then(|factor| factor.trim().parse().ok());
    let (_, all) = LengthUnit::OF_WORLD_FILES;
    let is_of = |unit: &LengthUnit| {
        factor.is_some_and(|factor| (factor / unit.length_m() - 1.0).abs() < FACTOR_REACH)
    };
    let is_survey = by_name == Some(LengthUnit::Foot) && is_of(&LengthUnit::SurveyFoot);
    let by_name = if is_survey { Some(LengthUnit::SurveyFoot) } else { by_name };
    let unit = by_name.or_else(|| all.into_iter().find(is_of));
    Some(unit.map_or(StatedUnit::Other, StatedUnit::Length))
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

    /// - `plane`, `height`: name and metres of a unit.
    fn projected(plane: &str, height: &str) -> String {
        format!(
            "COMPD_CS[\"a\",PROJCS[\"b\",GEOGCS[\"c\",UNIT[\"degree\",0.0174532925199433]],\
             PROJECTION[\"Lambert\"],UNIT[{plane}],AXIS[\"X\",EAST]],\
             VERT_CS[\"d\",UNIT[{height}]]]"
        )
    }

    const IN_METRES: &str = "\"metre\",1";
    const IN_SURVEY_FEET: &str = "\"US survey foot\",0.3048006096012192";

    #[test]
    fn the_units_of_plane_and_heights_are_found() {
        for (name, unit) in [
            (IN_METRES, METRES),
            (IN_SURVEY_FEET, SURVEY_FEET),
            ("\"US survey foot\",1.0", SURVEY_FEET),
            ("\"Foot_US\",0.3048006096012192", SURVEY_FEET),
            ("\"foot\",0.3048", FEET),
            ("\"Foot\",0.304800609601219", SURVEY_FEET),
            // Names that are not known, with metres that are.
            ("\"Foot (International)\",0.3048", FEET),
            ("\"fot\", 0.30480060960121924,AUTHORITY[\"EPSG\",\"9003\"]", SURVEY_FEET),
        ] {
            let stated = of_wkt(&projected(name, IN_METRES));
            assert_eq!(stated, of(length(unit), length(METRES)), "{name}");
            let stated = of_wkt(&projected(IN_METRES, name));
            assert_eq!(stated, of(length(METRES), length(unit)), "{name}");
        }
        let link = "\"link\",0.201168";
        let other = Some(StatedUnit::Other);
        assert_eq!(of_wkt(&projected(link, link)), of(other, other));
        let off_plane = Some(StatedUnit::OffPlane);
        for system in [
            "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174532925199433]]",
            "GEOCCS[\"WGS 84\",UNIT[\"metre\",1]]",
        ] {
            assert_eq!(of_wkt(system), of(off_plane, None), "{system}");
        }
        assert_eq!(of_wkt(""), Stated::default());
        let mercator = Some(StatedUnit::Mercator);
        for system in [
            "PROJCS[\"WGS 84 / Pseudo-Mercator\",GEOGCS[\"c\"],PROJECTION[\"Mercator_1SP\"],UNIT[\"metre\",1]]",
            "PROJCS[\"WGS_1984_Web_Mercator_Auxiliary_Sphere\",UNIT[\"Meter\",1.0]]",
            "PROJCRS[\"a\",CONVERSION[\"b\",METHOD[\"Popular Visualisation Pseudo Mercator\"]],LENGTHUNIT[\"metre\",1]]",
        ] {
            assert_eq!(of_wkt(system), of(mercator, None), "{system}");
        }
        for projection in ["Transverse_Mercator", "Hotine_Oblique_Mercator", "Transverse Mercator"]
        {
            for name in ["b", "Trans Mercator"] {
                let system =
                    format!("PROJCS[\"{name}\",PROJECTION[\"{projection}\"],UNIT[\"metre\",1]]");
                assert_eq!(of_wkt(&system), of(length(METRES), None), "{system}");
            }
        }
        // Heights behind the system in the plane, as ArcGIS writes them, and within it.
        for system in [
            "PROJCS[\"b\",UNIT[\"Meter\",1.0]],VERTCS[\"d\",UNIT[\"Foot_US\",0.3048006096012192]]",
            "PROJCS[\"b\",UNIT[\"Meter\",1.0],VERTCS[\"d\",UNIT[\"US survey foot\",1.0]]]",
        ] {
            assert_eq!(of_wkt(system), of(length(METRES), length(SURVEY_FEET)), "{system}");
        }
    }

    #[test]
    fn keys_of_geotiff_say_units_and_systems() {
        let stated = |keys: &[(u16, u16)]| {
            let keys = keys.to_vec();
            of_keys(move |id| keys.iter().find(|(key, _)| *key == id).map(|(_, value)| *value))
        };
        let feet = stated(&[(MODEL_TYPE, 1), (LENGTH_UNIT, 9003), (HEIGHT_UNIT, 9002)]);
        assert_eq!(feet, of(length(SURVEY_FEET), length(FEET)));
        assert_eq!(stated(&[(MODEL_TYPE, 2)]), of(Some(StatedUnit::OffPlane), None));
        assert_eq!(stated(&[(LENGTH_UNIT, 9005)]), of(Some(StatedUnit::Other), None));
        let utm = stated(&[(SYSTEM, 26_913), (HEIGHT_SYSTEM, 6360)]);
        assert_eq!(utm, of(length(METRES), length(SURVEY_FEET)));
        let by_number = stated(&[(MODEL_TYPE, 1), (SYSTEM, 2225)]);
        assert_eq!(by_number, Stated { plane: None, height: None, system: Some(2225) });
        assert_eq!(stated(&[(SYSTEM, USER_DEFINED)]), Stated::default());
        let mercator = Some(StatedUnit::Mercator);
        for keys in [
            &[(MODEL_TYPE, 1), (SYSTEM, 3857), (LENGTH_UNIT, 9001)][..],
            &[(SYSTEM, USER_DEFINED), (PROJECTION, OF_MERCATOR), (LENGTH_UNIT, 9001)],
        ] {
            assert_eq!(stated(keys), of(mercator, None), "{keys:?}");
        }
    }
}
