//! World files: six lines beside a picture that say where its pixels lie.
//!
//! ```text
//! A   easting  from a pixel to the one at its right
//! D   northing from a pixel to the one at its right
//! B   easting  from a pixel to the one below
//! E   northing from a pixel to the one below, usually negative
//! C   easting  of the middle of the left top pixel
//! F   northing of the middle of the left top pixel
//! ```
//!
//! Source: [EsriWorldFiles](crate::bibliography::EsriWorldFiles).

use std::path::{Path, PathBuf};

use crate::data::{MAX_SETTINGS_BYTES, read_utf8, without_byte_order_mark};
use crate::ranges::{PIXEL_SIZE, SURVEY_COORDINATE};
use crate::site::{LengthUnit, PixelMap, SiteError, SiteOrigin};

/// The six numbers of a world file, in metres. The file itself does not say its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldFile {
    /// From a pixel to the one at its right, easting and northing: A and D.
    pub per_column_m: [f64; 2],
    /// From a pixel to the one below, easting and northing: B and E.
    pub per_row_m: [f64; 2],
    /// Middle of the left top pixel, easting and northing: C and F.
    pub first_pixel_m: [f64; 2],
}

impl WorldFile {
    /// Reads a world file.
    ///
    /// - `unit`: of its numbers.
    ///
    /// # Errors
    /// [`SiteError::WorldFile`] with the line, [`SiteError::Data`].
    pub fn load(path: &Path, unit: LengthUnit) -> Result<Self, SiteError> {
        Self::parse(&read_utf8(path, MAX_SETTINGS_BYTES)?, path, unit)
    }

    /// Reads the text of a world file.
    ///
    /// # Errors
    /// [`SiteError::WorldFile`] with the line.
    pub fn parse(text: &str, path: &Path, unit: LengthUnit) -> Result<Self, SiteError> {
        let wrong = |line: usize, text: &str, expected| SiteError::WorldFile {
            path: path.to_owned(),
            line,
            text: text.chars().take(80).collect(),
            expected,
        };
        let lines: Vec<&str> = without_byte_order_mark(text).lines().map(str::trim).collect();
        let at = |idx: usize| lines.get(idx).copied().unwrap_or_default();
        let mut numbers = [0.0; 6];
        for (idx, number) in numbers.iter_mut().enumerate() {
            let found = at(idx).parse().ok().filter(|number: &f64| number.is_finite());
            *number = found.ok_or_else(|| {
                let expected = "a number, the six of a world file";
                match lines.get(idx) {
                    Some(line) => wrong(idx + 1, line, expected),
                    None => wrong(lines.len().max(1), "the end of the file", expected),
                }
            })?;
        }
        if let Some(idx) = (6..lines.len()).find(|idx| !at(*idx).is_empty()) {
            return Err(wrong(idx + 1, at(idx), "no more than the six lines of a world file"));
        }
        let [a, d, b, e, c, f] = numbers.map(|number| number * unit.length_m());
        let world = Self { per_column_m: [a, d], per_row_m: [b, e], first_pixel_m: [c, f] };
        for (idx, [x, y]) in [(usize::from(a == 0.0), [a, d]), (3, [b, e])] {
            if !PIXEL_SIZE.contains(x.hypot(y)) {
                let expected =
                    "a pixel of 0.0005 to 100 m; degrees of latitude and longitude are not read";
                return Err(wrong(idx + 1, at(idx), expected));
            }
        }
        if let Some(expected) = PixelMap::from_world_file(&world, &SiteOrigin::default()).problem()
        {
            return Err(wrong(4, at(3), expected));
        }
        for (idx, value) in [(4, c), (5, f)] {
            if !SURVEY_COORDINATE.contains(value) {
                return Err(wrong(idx + 1, at(idx), "a coordinate of -2e7 to 2e7 m"));
            }
        }
        Ok(world)
    }

    /// The text of the file, in metres.
    pub fn to_text(&self) -> String {
        let ([a, d], [b, e], [c, f]) = (self.per_column_m, self.per_row_m, self.first_pixel_m);
        [a, d, b, e, c, f].map(|number| format!("{number}\n")).concat()
    }
}

/// The world file beside a picture: `road.png` has `road.pgw`, `road.pngw` or `road.wld`, in small or
/// capital letters.
///
/// # Errors
/// [`SiteError::NoPlace`] if there is none.
pub fn world_file_beside(picture: &Path) -> Result<PathBuf, SiteError> {
    let ending = picture.extension().and_then(|end| end.to_str()).unwrap_or_default();
    let letters: Vec<char> = ending.chars().collect();
    let short = match (letters.first(), letters.last()) {
        (Some(first), Some(last)) => format!("{first}{last}w"),
        _ => "wld".to_owned(),
    };
    let endings = [short.clone(), format!("{ending}w"), "wld".to_owned()];
    let both = |end: &String| [end.to_lowercase(), end.to_uppercase()];
    let paths = endings.iter().flat_map(both).map(|end| picture.with_extension(end));
    let found = paths.into_iter().find(|path| path.is_file());
    found.ok_or_else(|| SiteError::NoPlace {
        path: picture.to_owned(),
        name: picture
            .with_extension(short)
            .file_name()
            .map(|name| name.to_string_lossy().into_owned())
            .unwrap_or_default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<WorldFile, String> {
        let path = Path::new("road.pgw");
        WorldFile::parse(text, path, LengthUnit::Metre).map_err(|error| error.to_string())
    }

    #[test]
    fn feet_become_metres_in_all_six_numbers() {
        let text = "0.5\n0\n0\n-0.5\n17000000\n1000000\n";
        let read = |unit| WorldFile::parse(text, Path::new("road.pgw"), unit).unwrap();
        let (foot, survey) = (read(LengthUnit::Foot), read(LengthUnit::SurveyFoot));
        assert_eq!((foot.per_column_m, foot.per_row_m), ([0.1524, 0.0], [0.0, -0.1524]));
        assert!((foot.first_pixel_m[0] - 5_181_600.0).abs() < 1e-6, "{foot:?}");
        let apart_m = survey.first_pixel_m[0] - foot.first_pixel_m[0];
        assert!((apart_m - 10.363).abs() < 1e-2, "the two feet differ by {apart_m} m");
    }

    #[test]
    fn the_numbers_stand_in_the_order_a_d_b_e_c_f() {
        let world = parse("0.1\r\n0.02\r\n0.03\r\n-0.12\r\n500000.5\r\n5400000.25\r\n").unwrap();
        assert_eq!(world.per_column_m, [0.1, 0.02]);
        assert_eq!(world.per_row_m, [0.03, -0.12]);
        assert_eq!(world.first_pixel_m, [500_000.5, 5_400_000.25]);
        assert_eq!(parse(&world.to_text()), Ok(world));
    }

    #[test]
    fn a_wrong_file_is_refused_with_its_line() {
        for (text, expected) in [
            ("0.1\n0\n0\n-0.1\n5\n", "road.pgw:5: is \"the end of the file\", expected a number"),
            ("0.1\n0\nx\n-0.1\n5\n6\n", "road.pgw:3: is \"x\", expected a number"),
            ("0,1\n0\n0\n-0,1\n5\n6\n", "road.pgw:1: is \"0,1\""),
            ("0.1\n0\n0\nnan\n5\n6\n", "road.pgw:4: is \"nan\""),
            ("0.1\n0\n0\n-0.1\n5\n6\n7\n", "road.pgw:7: is \"7\", expected no more"),
            ("0.1\n0\n0\n0.1\n5\n6\n", "road.pgw:4: is \"0.1\", expected rows that lead down"),
            ("1e-6\n0\n0\n-1e-6\n11.5\n48.1\n", "road.pgw:1: is \"1e-6\", expected a pixel of"),
            ("0.1\n0\n0\n-900\n5\n6\n", "road.pgw:4: is \"-900\", expected a pixel of"),
            ("0.1\n0\n0\n-0.5\n5\n6\n", "road.pgw:4: is \"-0.5\", expected pixels that are"),
            ("0.1\n0\n0\n-0.1\n5e9\n6\n", "road.pgw:5: is \"5e9\", expected a coordinate"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.starts_with(expected), "{text:?}: {error}");
        }
    }

    #[test]
    fn it_is_found_beside_the_picture_by_its_usual_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (picture, world) in [
            ("a.png", "a.pgw"),
            ("b.jpg", "b.jgw"),
            ("c.TIF", "c.TFW"),
            ("d.tiff", "d.wld"),
            ("e.jpeg", "e.jpegw"),
        ] {
            let error = world_file_beside(&at(picture)).unwrap_err().to_string();
            assert!(error.contains("has no world file beside it"), "{error}");
            std::fs::write(at(world), "").unwrap();
            assert_eq!(world_file_beside(&at(picture)).unwrap(), at(world), "{picture}");
        }
    }
}
