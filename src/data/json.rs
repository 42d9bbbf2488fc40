//! Reading of numbers that JSON cannot represent. Infinite numbers and NaN are written as `null`,
//! and `null` is read as NaN here.

use serde::{Deserialize, Deserializer};

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

    #[derive(Deserialize)]
    struct Numbers {
        #[serde(deserialize_with = "null_as_nan")]
        one: f64,
        #[serde(deserialize_with = "nulls_as_nan")]
        two: [f64; 2],
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
