//! The check that every number of a report is finite.

use ciborium::Value;
use serde::Serialize;

/// A number of a report that is NaN or infinite.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NotFinite {
    /// Where it stands in the report, such as `end.x_m` or `impulse_n_s[1]`.
    pub(crate) field: String,
    /// The number.
    pub(crate) value: f64,
}

/// Finds the first number of a report that is not finite.
///
/// A number that may be absent is an `Option`, or a field that serde writes as `null` on purpose
/// where it is not finite; neither is found here. JSON itself cannot tell these apart from a number
/// that is not finite by mistake, which is why the report is taken apart as CBOR, which can.
pub(crate) fn first_not_finite(report: &impl Serialize) -> Option<NotFinite> {
    // A report that cannot be taken apart cannot be printed either, and fails there.
    find("", &Value::serialized(report).ok()?)
}

fn find(field: &str, value: &Value) -> Option<NotFinite> {
    match value {
        Value::Float(value) if !value.is_finite() => {
            Some(NotFinite { field: field.to_owned(), value: *value })
        }
        Value::Array(values) => values
            .iter()
            .enumerate()
            .find_map(|(idx, value)| find(&format!("{field}[{idx}]"), value)),
        Value::Map(entries) => entries.iter().find_map(|(key, value)| {
            let key = key.as_text().unwrap_or("?");
            let field = if field.is_empty() { key.to_owned() } else { format!("{field}.{key}") };
            find(&field, value)
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[derive(Serialize)]
    struct Outer {
        name: &'static str,
        seed: u64,
        absent: Option<f64>,
        kind: Kind,
        inner: Vec<Inner>,
        by_name: BTreeMap<String, f64>,
    }

    #[derive(Serialize)]
    enum Kind {
        Pair(f64, f64),
    }

    #[derive(Serialize)]
    struct Inner {
        values: [f64; 2],
    }

    fn report() -> Outer {
        Outer {
            name: "report",
            seed: u64::MAX,
            absent: None,
            kind: Kind::Pair(1.0, 2.0),
            inner: vec![Inner { values: [0.0, 1.0] }, Inner { values: [2.0, 3.0] }],
            by_name: BTreeMap::from([("a".to_owned(), 1.0)]),
        }
    }

    #[test]
    fn the_place_of_a_number_that_is_not_finite_is_found() {
        assert_eq!(first_not_finite(&report()), None);
        let mut wrong = report();
        wrong.inner[1].values[0] = f64::INFINITY;
        let found = first_not_finite(&wrong).unwrap();
        assert_eq!((found.field.as_str(), found.value), ("inner[1].values[0]", f64::INFINITY));
        let mut wrong = report();
        wrong.by_name.insert("b".to_owned(), f64::NAN);
        assert_eq!(first_not_finite(&wrong).unwrap().field, "by_name.b");
        let mut wrong = report();
        wrong.absent = Some(f64::NEG_INFINITY);
        assert_eq!(first_not_finite(&wrong).unwrap().field, "absent");
        let mut wrong = report();
        wrong.kind = Kind::Pair(0.0, f64::NAN);
        assert_eq!(first_not_finite(&wrong).unwrap().field, "kind.Pair[1]");
    }
}
