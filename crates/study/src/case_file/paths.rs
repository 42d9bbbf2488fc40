//! Paths in a case: absolute in memory, relative to the case's folder in its file.

use std::collections::HashSet;
use std::path::{Component, Path, PathBuf};

use serde_json::Value;

pub use impactlab_core::data::write::replace_strings;

/// Beginnings of a path that is relative to the folder of the case.
const RELATIVE: [&str; 2] = ["./", "../"];

/// Makes absolute every string of a value that is a path as the file of a case in `folder` says it.
pub fn begin_paths_at(value: &mut Value, folder: &Path) {
    replace_strings(value, &|text| Some(absolute(text, folder)?.to_str()?.to_owned()));
}

/// The opposite of [`begin_paths_at`] for the strings of a value that are one of `paths`; one that would
/// not come back as it is stays.
pub fn end_paths_at(value: &mut Value, paths: &HashSet<&Path>, folder: &Path) {
    replace_strings(value, &|text| {
        let ended = relative(paths.get(Path::new(text))?, folder)?;
        let comes_back = absolute(&ended, folder)?.to_str() == Some(text);
        comes_back.then_some(ended)
    });
}

/// Every string in a value that is an absolute path.
pub(super) fn absolute_paths(value: &Value) -> Vec<PathBuf> {
    match value {
        Value::String(text) if Path::new(text).is_absolute() => vec![PathBuf::from(text)],
        Value::Array(values) => values.iter().flat_map(absolute_paths).collect(),
        Value::Object(fields) => fields.values().flat_map(absolute_paths).collect(),
        _ => Vec::new(),
    }
}

/// A path as the file of a case in `folder` says it, with `/` between its parts; `None` where it is on
/// another drive.
pub(super) fn relative(path: &Path, folder: &Path) -> Option<String> {
    let relative = pathdiff::diff_paths(path, without_dots(folder))?;
    if relative.is_absolute() {
        return None;
    }
    let parts: Vec<String> = relative
        .components()
        .map(|part| part.as_os_str().to_str().map(str::to_owned))
        .collect::<Option<_>>()?;
    let text = parts.join("/");
    let leads_up = relative.components().next() == Some(Component::ParentDir);
    Some(if leads_up { text } else { format!("./{text}") })
}

/// A path that the file of a case in `folder` says; `None` for any other string.
pub(super) fn absolute(text: &str, folder: &Path) -> Option<PathBuf> {
    if !RELATIVE.iter().any(|beginning| text.starts_with(beginning)) {
        return None;
    }
    Some(without_dots(&folder.join(text)))
}

/// An absolute path without `.` and `..`.
fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            Component::Normal(_) | Component::RootDir | Component::Prefix(_) => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_come_back_from_any_folder() {
        let folder = Path::new("/cases/crossing");
        for (path, expected) in [
            ("/cases/crossing/force.csv", "./force.csv"),
            ("/cases/crossing/data/fea", "./data/fea"),
            ("/cases/other/force.csv", "../other/force.csv"),
            ("/data/force.csv", "../../data/force.csv"),
        ] {
            let text = relative(Path::new(path), folder).unwrap();
            assert_eq!(text, expected);
            assert_eq!(absolute(&text, folder), Some(PathBuf::from(path)));
        }
        assert_eq!(absolute("pit-right-rear", folder), None);
        assert_eq!(absolute("", folder), None);
    }

    #[test]
    fn relative_paths_are_no_absolute_ones() {
        let value = serde_json::json!({"/a": ["./a", {"b": "./a"}, 1, null]});
        assert!(absolute_paths(&value).is_empty());
    }

    #[test]
    fn paths_of_a_question_begin_at_the_folder() {
        let mut value = serde_json::json!({"./a": ["./a", "../b", "c", "/d", ""]});
        begin_paths_at(&mut value, Path::new("/cases/here"));
        let expected = ["/cases/here/a", "/cases/b", "c", "/d", ""];
        assert_eq!(value, serde_json::json!({"./a": expected}));
        // Only those that are known as paths, and come back from here as they are.
        let known = ["/cases/here/a", "/cases/b", "/cases/x/../c", "c"];
        let paths = known.map(Path::new).into_iter().collect();
        for folder in ["/cases/here", "/cases/x/y/../../here"].map(Path::new) {
            let mut value =
                serde_json::json!(["/cases/here/a", "/cases/b", "/cases/x/../c", "c", "/d"]);
            end_paths_at(&mut value, &paths, folder);
            assert_eq!(value, serde_json::json!(["./a", "../b", "/cases/x/../c", "c", "/d"]));
            begin_paths_at(&mut value, folder);
            assert_eq!(value[1], "/cases/b");
        }
    }
}
