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

/// JSON as files have it that go to others: each string, keys aside, that is an absolute path, or ends in one
/// behind `=`, is said from the working folder or by its last part. All else stays to the last digit.
pub fn json_without_machine(json: &str) -> String {
    let working_folder = std::env::current_dir().ok();
    let (mut told, mut rest) = (String::with_capacity(json.len()), json);
    while let Some((before, from)) = rest.find('"').map(|at| rest.split_at(at)) {
        let (string, after) = from.split_at(string_length(from));
        let text = serde_json::from_str::<String>(string).ok().filter(|_| !after.starts_with(':'));
        let named = text.and_then(|text| without_machine(&text, working_folder.as_deref()));
        told.push_str(before);
        match named {
            Some(named) => told.push_str(&Value::String(named).to_string()),
            None => told.push_str(string),
        }
        rest = after;
    }
    told.push_str(rest);
    told
}

/// Length of the JSON string that a text begins with, with its quotes, bytes.
fn string_length(text: &str) -> usize {
    let mut is_escaped = false;
    let end = text.char_indices().skip(1).find(|&(_, letter)| {
        let is_end = letter == '"' && !is_escaped;
        is_escaped = letter == '\\' && !is_escaped;
        is_end
    });
    end.map_or(text.len(), |(at, _)| at + 1)
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

/// A text with the name of a file in place of its path wherever that begins there: `/s` is no path in `m/s`.
pub fn with_name_for_path(text: &str, path: &str, name: &str) -> String {
    let (mut told, mut end) = (String::with_capacity(text.len()), 0);
    for (at, _) in text.match_indices(path) {
        let (before, _) = text.split_at(at);
        if before.chars().next_back().is_some_and(char::is_alphanumeric) {
            continue;
        }
        told.push_str(&text[end..at]);
        told.push_str(name);
        end = at + path.len();
    }
    told.push_str(&text[end..]);
    told
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

    #[cfg(unix)]
    #[test]
    fn json_keeps_its_order_and_its_numbers() {
        let json = r#"{"z": 0.1000000000000000055, "/a/key": ["/home/ann/a \"b\\.csv", "m/s", 1e-7],
            "a": "x\\", "b": "/home/ann/é.csv"}"#;
        let expected = r#"{"z": 0.1000000000000000055, "/a/key": ["a \"b\\.csv", "m/s", 1e-7],
            "a": "x\\", "b": "é.csv"}"#;
        assert_eq!(json_without_machine(json), expected);
        for broken in ["", "\"", "{\"a\": \"/b", "no strings"] {
            assert_eq!(json_without_machine(broken), broken);
        }
    }

    #[test]
    fn strings_are_replaced_at_any_depth_and_keys_are_not() {
        let mut value = serde_json::json!({"/a": ["/a", {"b": "/a"}, 1, null]});
        replace_strings(&mut value, &|text| (text == "/a").then(|| "./a".to_owned()));
        assert_eq!(value, serde_json::json!({"/a": ["./a", {"b": "./a"}, 1, null]}));
    }
}
