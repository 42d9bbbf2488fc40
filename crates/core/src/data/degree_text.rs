//! Latitudes and longitudes in degrees, minutes and seconds, such as `52°31.234'N`, `N 52 31 14.0` or `-0:7:39`.

use crate::data::{DataError, Table};

/// Letters of a latitude and of a longitude, the negative one last. The O of other languages is east in one and west in
/// another.
pub(super) const LATITUDE_LETTERS: [char; 2] = ['N', 'S'];
pub(super) const LONGITUDE_LETTERS: [char; 2] = ['E', 'W'];

/// Marks between degrees, minutes and seconds.
const MARKS: &str = "°º'′’\"″”:";

/// Digits of whole degrees at most: `5231.234` has minutes as well, as sentences of receivers write them.
const MOST_DIGITS: usize = 3;

/// The degrees in a cell, as a number or in degrees, minutes and seconds; `None` if it has none.
///
/// - `letters`: to the north or east, and to the south or west.
pub(super) fn place_deg(
    table: &Table,
    row_idx: usize,
    column_idx: usize,
    letters: [char; 2],
) -> Option<f64> {
    let of_text = || {
        let cell = table.cell(row_idx, column_idx);
        degrees_of(&cell, letters, |part| table.dialect().number(part))
    };
    table.number(row_idx, column_idx).or_else(of_text)
}

/// The degrees in all rows of a column.
///
/// # Errors
/// [`DataError::Cell`] at the first cell that holds none.
pub(super) fn places_deg(
    table: &Table,
    column_idx: usize,
    letters: [char; 2],
) -> Result<Vec<f64>, DataError> {
    let expected =
        "degrees, such as 52.5206, or with minutes and seconds, as 52°31.234'N or 52 31 14 N";
    let place = |row_idx| {
        let place = place_deg(table, row_idx, column_idx, letters);
        place.ok_or_else(|| table.cell_error(row_idx, column_idx, expected))
    };
    (0..table.n_rows()).map(place).collect()
}

/// - `number`: the number in a part of the text.
fn degrees_of(text: &str, letters: [char; 2], number: impl Fn(&str) -> Option<f64>) -> Option<f64> {
    let is_letter = |c: char| letters.contains(&c.to_ascii_uppercase());
    let is_around = |c: char| c.is_whitespace() || is_letter(c);
    let mut found = text.chars().filter(|c| is_letter(*c));
    let (letter, other) = (found.next(), found.next());
    let body = text.trim_matches(is_around);
    let (body, is_signed) = match body.strip_prefix(['-', '\u{2212}']) {
        Some(body) => (body, true),
        None => (body, false),
    };
    if other.is_some() || (is_signed && letter.is_some()) {
        return None;
    }
    let is_mark = |c: char| c.is_whitespace() || MARKS.contains(c);
    let parts: Vec<&str> = body.split(is_mark).filter(|part| !part.is_empty()).collect();
    let n_digits = parts.first()?.chars().take_while(char::is_ascii_digit).count();
    if !(1..=MOST_DIGITS).contains(&n_digits) || parts.len() > 3 {
        return None;
    }
    let mut degrees = 0.0;
    for (idx, (part, size)) in parts.iter().zip([1.0, 60.0, 3600.0]).enumerate() {
        let value = number(part).filter(|_| part.starts_with(|c: char| c.is_ascii_digit()))?;
        let is_last = idx + 1 == parts.len();
        if (idx > 0 && value >= 60.0) || (!is_last && value.fract() != 0.0) {
            return None;
        }
        degrees += value / size;
    }
    let is_negative = is_signed || letter.is_some_and(|c| c.to_ascii_uppercase() == letters[1]);
    Some(if is_negative { 0.0 - degrees } else { degrees })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Channel, read_any_series};

    #[test]
    fn degrees_minutes_and_seconds_are_read_and_nothing_else() {
        for (text, letters, expected) in [
            ("52°30.6'N", LATITUDE_LETTERS, Some(52.51)),
            ("S 33 51 36", LATITUDE_LETTERS, Some(-33.86)),
            ("52° 30' 36.0\" N", LATITUDE_LETTERS, Some(52.51)),
            ("52.51N", LATITUDE_LETTERS, Some(52.51)),
            ("0°07'48''w", LONGITUDE_LETTERS, Some(-0.13)),
            ("-0:07:48", LONGITUDE_LETTERS, Some(-0.13)),
            ("13 24.0", LONGITUDE_LETTERS, Some(13.4)),
            // Minutes beyond 60, two signs, another axis, the digits of a receiver, a fraction that is not the last.
            ("52°60.6'N", LATITUDE_LETTERS, None),
            ("-33°51'S", LATITUDE_LETTERS, None),
            ("13°24'O", LONGITUDE_LETTERS, None),
            ("13°24'E", LATITUDE_LETTERS, None),
            ("00007.8W", LONGITUDE_LETTERS, None),
            ("52.5 30 N", LATITUDE_LETTERS, None),
            ("52 30 36 1", LATITUDE_LETTERS, None),
            ("N", LATITUDE_LETTERS, None),
            ("", LATITUDE_LETTERS, None),
            ("52 -30", LATITUDE_LETTERS, None),
        ] {
            let read = degrees_of(text, letters, |part| part.parse().ok());
            let is_same = match (read, expected) {
                (Some(read), Some(expected)) => (read - expected).abs() < 1e-9,
                (read, expected) => read == expected,
            };
            assert!(is_same, "{text}: {read:?}");
        }
    }

    /// A minute of arc at 52.5° is 1854.7 m to the north and 1131.4 m to the west (WGS 84).
    #[test]
    fn a_log_in_degrees_and_minutes_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let head = "time [s],latitude,longitude";
        let read = |rows: &str| {
            std::fs::write(&path, format!("{head}\n{rows}")).unwrap();
            read_any_series(&path, None).map_err(|error| error.to_string())
        };
        let loaded = read("0,52°30.0'N,13°24.0'W\n60,52°31.0'N,13°25.0'W\n").unwrap();
        let [x, y] = [Channel::X, Channel::Y].map(|of| loaded.series.get(of).unwrap()[1]);
        assert!((x + 1131.4).abs() < 0.5 && (y - 1854.7).abs() < 0.5, "{x}, {y}");
        let error = read("0,52°30.0'N,13°24.0'W\n60,52°91.0'N,13°25.0'W\n").unwrap_err();
        assert!(error.contains(":3:2: \"latitude\" is \"52°91.0'N\", expected degrees"), "{error}");
    }
}
