//! Numbers that JSON does not have: infinite ones and NaN are written as `null`.

use serde::{Deserialize, Deserializer};

/// For `#[serde(deserialize_with)]`: a number, NaN for `null`.
///
/// # Errors
/// The format's, for anything else.
pub fn null_as_nan<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// The same for several numbers.
///
/// # Errors
/// The format's, for anything else.
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
