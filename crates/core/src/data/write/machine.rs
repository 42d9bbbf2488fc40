//! What files that go to others say of the machine that they were made on: nothing.

use std::path::Path;

use serde_json::Value;

/// Replaces strings in a value, at any depth; keys stay.
///
/// - `change`: the new string; `None` keeps the old one.
pub fn replace_strings(value: &mut Value, change: &impl Fn(&str) -> Option<String>) {
    match value {
        Value::String(text) => {
            if let Some(new) = change(text) {
                *text = new;
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| replace_strings(value, change)),
        Value::Object(fields) => {
            fields.values_mut().for_each(|value| replace_strings(value, change));
        }
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

/// A path, or an argument that ends in one behind `=`, as files say it that go to others; `None` for any
/// other text, also for a relative path, which says what its writer chose to say.
///
/// An absolute path below the working folder is said from there, any other by its last part alone. The
/// folders above are those of a person and a machine; what the file held is known by its digest.
///
/// - `working_folder`: absolute; the root of a file system is none.
pub(super) fn without_machine(text: &str, working_folder: Option<&Path>) -> Option<String> {
    let path = Path::new(text);
    if path.is_absolute() {
        let folder = working_folder.filter(|folder| folder.parent().is_some());
        let below = folder.and_then(|folder| path.strip_prefix(folder).ok());
        let below = below.filter(|below| !below.as_os_str().is_empty());
        let named = below.or_else(|| path.file_name().map(Path::new)).unwrap_or(Path::new("."));
        return Some(named.to_string_lossy().into_owned());
    }
    let (key, value) = text.split_once('=')?;
    let value = Some(value).filter(|value| Path::new(value).is_absolute())?;
    Some(format!("{key}={}", without_machine(value, working_folder)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn no_folder_of_a_person_is_said() {
        let said = |text: &str| without_machine(text, Some(Path::new("/home/ann/case")));
        for (text, expected) in [
            ("/home/ann/case/data/force.csv", Some("data/force.csv")),
            ("/home/ann/case", Some("case")),
            ("/home/ann/other/force.csv", Some("force.csv")),
            ("/home/ann", Some("ann")),
            ("/", Some(".")),
            ("--out=/home/ann/case/out", Some("--out=out")),
            ("--site=/home/ann/site.toml", Some("--site=site.toml")),
            ("../other/force.csv", None),
            ("shipped", None),
            ("time=1:ms,fx=Kraft X:kN", None),
            ("", None),
        ] {
            assert_eq!(said(text).as_deref(), expected, "{text:?}");
        }
        // Where the root is the working folder, every path would be said whole.
        let at_root = without_machine("/home/ann/force.csv", Some(Path::new("/")));
        assert_eq!(at_root.as_deref(), Some("force.csv"));
        assert_eq!(without_machine("/home/ann/force.csv", None).as_deref(), Some("force.csv"));
    }

    #[test]
    fn strings_are_replaced_at_any_depth_and_keys_are_not() {
        let mut value = serde_json::json!({"/a": ["/a", {"b": "/a"}, 1, null]});
        replace_strings(&mut value, &|text| (text == "/a").then(|| "./a".to_owned()));
        assert_eq!(value, serde_json::json!({"/a": ["./a", {"b": "./a"}, 1, null]}));
    }
}
