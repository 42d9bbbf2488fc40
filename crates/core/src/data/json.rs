//! Numbers of results that may be absent because what they measure was not finite, such as the error
//! of a model whose motion diverges. Infinite numbers and NaN are written as `null` here, and
//! `null` is read as NaN.
//!
//! A field without these functions must be finite: the run layer refuses a report in which it is
//! not.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes a number, with `null` for one that is not finite; for use with
/// `#[serde(serialize_with)]`.
///
/// # Errors
/// The error of the format.
pub fn finite_or_null<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    Some(*value).filter(|value| value.is_finite()).serialize(to)
}

/// Writes numbers, with `null` for each that is not finite; for use with
/// `#[serde(serialize_with)]`.
///
/// # Errors
/// The error of the format.
pub fn finite_or_nulls<const N: usize, S: Serializer>(
    values: &[f64; N],
    to: S,
) -> Result<S::Ok, S::Error>
where
    [Option<f64>; N]: Serialize,
{
    values.map(|value| Some(value).filter(|value| value.is_finite())).serialize(to)
}

/// Reads a number, with NaN for `null`; for use with `#[serde(deserialize_with)]`.
///
/// # Errors
/// The error of the format if the value is neither a number nor `null`.
pub fn null_as_nan<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Reads `N` numbers, with NaN for each `null`; for use with `#[serde(deserialize_with)]`.
///
/// # Errors
/// The error of the format if the value is not a list of `N` numbers or `null`.
pub fn nulls_as_nan<'de, const N: usize, D: Deserializer<'de>>(
    from: D,
) -> Result<[f64; N], D::Error>
where
    [Option<f64>; N]: Deserialize<'de>,
{
    let values = <[Option<f64>; N]>::deserialize(from)?;
    Ok(values.map(|value| value.unwrap_or(f64::NAN)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize, Deserialize)]
    struct Numbers {
        #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
        one: f64,
        #[serde(serialize_with = "finite_or_nulls", deserialize_with = "nulls_as_nan")]
        two: [f64; 2],
    }

    #[test]
    fn numbers_that_are_not_finite_are_written_as_null() {
        let numbers = Numbers { one: f64::INFINITY, two: [1.5, f64::NAN] };
        assert_eq!(serde_json::to_string(&numbers).unwrap(), r#"{"one":null,"two":[1.5,null]}"#);
        let numbers = Numbers { one: 0.5, two: [1.5, 2.5] };
        assert_eq!(serde_json::to_string(&numbers).unwrap(), r#"{"one":0.5,"two":[1.5,2.5]}"#);
    }

    #[test]
    fn null_is_no_number_and_nothing_else_is_taken_for_one() {
        let read = serde_json::from_str::<Numbers>;
        let numbers = read(r#"{"one":null,"two":[1.5,null]}"#).unwrap();
        assert!(numbers.one.is_nan() && numbers.two[0] == 1.5 && numbers.two[1].is_nan());
        assert!(read(r#"{"one":"x","two":[1.5,2.0]}"#).is_err());
        assert!(read(r#"{"one":1.0,"two":[1.5]}"#).is_err());
    }
}
