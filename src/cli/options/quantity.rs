//! Numbers with units as arguments: `20`, `72km/h`, `30deg/s`.

use impactlab_core::ranges::{
    CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, FILM_SPEED, INSTANT, OutOfRange, PICTURE_PIXELS,
    PICTURE_SIDE, Range, WINDOW,
};
use impactlab_core::units::{Quantity, TypedError};
use impactlab_core::vehicle::ContactPoint;
use impactlab_document::scene::FilmSection;

/// An argument that is not the number it should be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(in crate::cli) enum QuantityError {
    /// Not a number, or one with a unit of something else.
    #[error(transparent)]
    Typed(#[from] TypedError),
    /// Beyond what makes sense.
    #[error(transparent)]
    Range(#[from] OutOfRange),
    /// Not a whole number.
    #[error("expected a whole number, {expected}")]
    NotWhole { expected: String },
    /// Not three numbers.
    #[error("expected three numbers x,y,z in m, such as -1.5,-0.9,0.5")]
    NoPoint,
    /// Not two moments.
    #[error("expected two moments in s, such as 0,4")]
    NoWindow,
    /// A window that ends before it starts.
    #[error("{from_s} s to {to_s} s ends before it starts; expected the earlier moment first")]
    WindowOrder { from_s: f64, to_s: f64 },
    /// Not a size.
    #[error("expected width x height in pixels, such as 1600x1000")]
    NoSize,
    /// Not a part of a film with its speed.
    #[error("expected two moments in s and a speed, such as 0.2..0.6=0.1")]
    NoSection,
}

/// A parser of a number in a range, in SI units unless the text names another unit.
pub(in crate::cli) fn number(
    range: Range,
) -> impl Fn(&str) -> Result<f64, QuantityError> + Clone + Send + Sync + 'static {
    move |text| Ok(range.check(quantity(text, range.quantity)?)?)
}

/// A parser of a number that counts something.
pub(in crate::cli) fn count<T: TryFrom<u64>>(
    range: Range,
) -> impl Fn(&str) -> Result<T, QuantityError> + Clone + Send + Sync + 'static {
    move |text| {
        let not_whole = || QuantityError::NotWhole { expected: range.explained() };
        let n: u64 = text.trim().parse().or(Err(not_whole()))?;
        range.check_count(n)?;
        T::try_from(n).or(Err(not_whole()))
    }
}

/// A window of time, s unless it says otherwise: `0,2`.
pub(in crate::cli) fn window_s(text: &str) -> Result<[f64; 2], QuantityError> {
    let (from, to) = text.split_once(',').ok_or(QuantityError::NoWindow)?;
    let [from_s, to_s] = [number(WINDOW)(from)?, number(WINDOW)(to)?];
    if from_s > to_s {
        return Err(QuantityError::WindowOrder { from_s, to_s });
    }
    Ok([from_s, to_s])
}

/// Where a force acts: `x,y,z`, m.
pub(in crate::cli) fn contact_point(text: &str) -> Result<ContactPoint, QuantityError> {
    let numbers: Vec<f64> =
        text.split(',').map(|part| quantity(part, Quantity::Length)).collect::<Result<_, _>>()?;
    let [x_body_m, y_body_m, height_m] = numbers[..] else {
        return Err(QuantityError::NoPoint);
    };
    for (value, range) in [(x_body_m, CONTACT_X), (y_body_m, CONTACT_Y), (height_m, CONTACT_HEIGHT)]
    {
        range.check(value)?;
    }
    Ok(ContactPoint { x_body_m, y_body_m, height_m })
}

/// Width and height in pixels: `1600x1000`.
pub(in crate::cli) fn size_px(text: &str) -> Result<[u32; 2], QuantityError> {
    let (width, height) = text.split_once(['x', '×']).ok_or(QuantityError::NoSize)?;
    let side = |text: &str| -> Result<u32, QuantityError> {
        let side = text.trim().parse().or(Err(QuantityError::NoSize))?;
        PICTURE_SIDE.check_count(u64::from(side))?;
        Ok(side)
    };
    let size = [side(width)?, side(height)?];
    PICTURE_PIXELS.check_count(u64::from(size[0]) * u64::from(size[1]))?;
    Ok(size)
}

/// A part of a film at a speed of its own, s unless it says otherwise: `0.2..0.6=0.1`.
pub(in crate::cli) fn film_section(text: &str) -> Result<FilmSection, QuantityError> {
    let (window, speed) = text.split_once('=').ok_or(QuantityError::NoSection)?;
    let (from, to) = window.split_once("..").ok_or(QuantityError::NoSection)?;
    let [from_s, to_s] = [number(INSTANT)(from)?, number(INSTANT)(to)?];
    if from_s >= to_s {
        return Err(QuantityError::WindowOrder { from_s, to_s });
    }
    Ok(FilmSection { from_s, to_s, speed: number(FILM_SPEED)(speed)? })
}

/// A number and, if there is one, its unit; SI without.
fn quantity(text: &str, quantity: Quantity) -> Result<f64, QuantityError> {
    Ok(quantity.parse(text, &quantity.si_unit())?)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use impactlab_core::ranges::{DRAWS, INSTANT, SPEED, YAW_RATE};

    #[test]
    fn units_are_understood_and_si_is_assumed() {
        for (text, expected) in [("20", 20.0), ("72km/h", 20.0), ("-45mph", -45.0 * 0.447_04)] {
            let speed = number(SPEED)(text).unwrap();
            assert!((speed - expected).abs() < 1e-12, "{text}: {speed}");
        }
        let rate = number(YAW_RATE)("30deg/s").unwrap();
        assert!((rate.to_degrees() - 30.0).abs() < 1e-12);
        assert_eq!(number(INSTANT)("250ms"), Ok(0.25));
    }

    #[test]
    fn mistakes_are_named() {
        for (text, part) in [
            ("fast", "expected a number"),
            ("nan", "expected a number"),
            ("inf", "expected a number"),
            ("", "expected a number"),
            ("20 kPa", "\"kPa\" is not one of the units m/s"),
            ("1e9", "speed is 1e9 m/s, expected -150 to 150 m/s"),
            ("1e999", "speed is inf m/s, expected"),
            ("200m/s", "expected -150 to 150 m/s"),
        ] {
            let error = number(SPEED)(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
        assert_eq!(contact_point("1,2"), Err(QuantityError::NoPoint));
        assert!(contact_point("-1.5,-0.9,-1").is_err());
        assert_eq!(contact_point("-1.5, -0.9, 0.5").unwrap().height_m, 0.5);
        assert_eq!(size_px("1600x1000"), Ok([1600, 1000]));
        assert_eq!(size_px("1600"), Err(QuantityError::NoSize));
        assert!(size_px("1600x1").is_err() && size_px("99999x1000").is_err());
    }

    #[test]
    fn a_window_is_two_moments_in_their_order() {
        assert_eq!(window_s("0,2"), Ok([0.0, 2.0]));
        assert_eq!(window_s("500ms, 2"), Ok([0.5, 2.0]));
        let error = window_s("5,2").unwrap_err().to_string();
        assert_eq!(error, "5 s to 2 s ends before it starts; expected the earlier moment first");
        assert!(window_s("-1,2").is_err() && window_s("0,1e999").is_err());
    }

    #[test]
    fn a_part_of_a_film_is_two_moments_and_a_speed() {
        let section = film_section("200ms..0.6=0.1").unwrap();
        assert_eq!((section.from_s, section.to_s, section.speed), (0.2, 0.6, 0.1));
        for (text, part) in [
            ("0.2..0.6", "such as 0.2..0.6=0.1"),
            ("0.2=0.1", "such as 0.2..0.6=0.1"),
            ("0.6..0.2=0.1", "0.6 s to 0.2 s ends before it starts"),
            ("0.2..0.2=0.1", "ends before it starts"),
            ("0.2..0.6=0", "speed of a film is 0, expected"),
            ("0.2..0.6=slow", "expected a number"),
        ] {
            let error = film_section(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn what_counts_is_whole_and_in_its_range() {
        assert_eq!(count::<usize>(DRAWS)("30"), Ok(30));
        for (text, part) in [
            ("0", "draws is 0, expected 1 to 10000"),
            ("2000000000", "draws is 2e9, expected 1 to 10000"),
            ("2.5", "expected a whole number, 1 to 10000"),
            ("-3", "expected a whole number"),
            ("99999999999999999999", "expected a whole number"),
        ] {
            let error = count::<usize>(DRAWS)(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    /// Texts like numbers with units, and any others.
    const TEXT: &str = r"\PC{0,24}|[-+0-9.eE]{0,12} ?(km/h|mph|deg/s|ms|m/s|µs|,)?[-+0-9.eE,x]{0,12}|(nan|inf|1e999)s?";

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// `PROPTEST_CASES` says how many texts are tried.
        #[test]
        fn any_text_is_a_number_in_its_range_or_refused(text in TEXT) {
            for range in [SPEED, WINDOW] {
                if let Ok(value) = number(range)(&text) {
                    prop_assert!(value.is_finite() && range.contains(value), "{text:?}: {value}");
                }
            }
            if let Ok([from_s, to_s]) = window_s(&text) {
                prop_assert!(from_s <= to_s && WINDOW.contains(from_s) && WINDOW.contains(to_s));
            }
            if let Ok(point) = contact_point(&text) {
                let inside = CONTACT_X.contains(point.x_body_m) && CONTACT_HEIGHT.contains(point.height_m);
                prop_assert!(inside, "{text:?}: {point:?}");
            }
            if let Ok(n) = count::<usize>(DRAWS)(&text) {
                prop_assert!(DRAWS.contains(n as f64), "{text:?}: {n}");
            }
            if let Ok(size) = size_px(&text) {
                let inside = size.iter().all(|side| PICTURE_SIDE.contains(f64::from(*side)));
                prop_assert!(inside, "{text:?}: {size:?}");
            }
        }
    }
}
