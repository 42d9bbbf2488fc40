//! Rows of a table from any value that can be told as JSON, so that nothing of it is left out.

use serde_json::Value;

use crate::report::keys::{is_silent, quantity_of_key};
use crate::report::language::{given_name_of, phrase_of};
use crate::report::numbers::Wording;
use crate::report::paths::ShownPaths;
use impactlab_core::units::{significant, trimmed};

/// Numbers of a list that are written; more are counted.
const MAX_LISTED: usize = 12;

/// A value with the names that lead to it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FlatRow {
    /// Names of what it is in, outermost first.
    pub path: Vec<String>,
    /// Its own name.
    pub key: String,
    /// The value as text.
    pub value: String,
}

impl FlatRow {
    /// What it is in, as text.
    pub fn group(&self, wording: &Wording) -> String {
        let names = self.path.iter().filter(|name| !is_silent(name));
        let mut names: Vec<String> = names.map(|name| wording.key(name)).collect();
        // A scenario stands within the choice of a scenario.
        names.dedup();
        names.join(", ")
    }
}

/// Every value in a JSON value that is not null, in its order, with all digits of its numbers.
pub(super) fn flatten(value: &Value, wording: &Wording, paths: &ShownPaths) -> Vec<FlatRow> {
    rows(value, Writing { wording, paths, rounds: false })
}

/// The same of values that were computed: with the digits that are shown of a result.
pub(super) fn flatten_rounded(value: &Value, wording: &Wording) -> Vec<FlatRow> {
    rows(value, Writing { wording, paths: &ShownPaths::default(), rounds: true })
}

fn rows(value: &Value, writing: Writing<'_>) -> Vec<FlatRow> {
    let mut rows = Vec::new();
    walk(value, &mut Vec::new(), "", writing, &mut rows);
    rows
}

/// How values are written.
#[derive(Clone, Copy)]
struct Writing<'a> {
    wording: &'a Wording,
    paths: &'a ShownPaths,
    /// Whether numbers have the digits that are shown of a result.
    rounds: bool,
}

fn walk(
    value: &Value,
    path: &mut Vec<String>,
    key: &str,
    writing: Writing<'_>,
    rows: &mut Vec<FlatRow>,
) {
    let is_plain = |value: &Value| !value.is_object() && !value.is_array();
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            if !key.is_empty() {
                path.push(key.to_owned());
            }
            for (name, field) in fields {
                walk(field, path, name, writing, rows);
            }
            if !key.is_empty() {
                path.pop();
            }
        }
        Value::Array(items) if items.iter().all(is_plain) => {
            let listed = items.iter().take(MAX_LISTED);
            let mut texts: Vec<String> = listed.map(|item| plain(key, item, writing)).collect();
            if items.len() > MAX_LISTED {
                texts.push(format!("… ({} {})", items.len(), writing.wording.words.values));
            }
            if !texts.is_empty() {
                rows.push(FlatRow {
                    path: path.clone(),
                    key: key.to_owned(),
                    value: texts.join("; "),
                });
            }
        }
        Value::Array(items) => {
            for (idx, item) in items.iter().enumerate() {
                walk(item, path, &format!("{key} {}", idx + 1), writing, rows);
            }
        }
        plain_value => {
            let value = plain(key, plain_value, writing);
            rows.push(FlatRow { path: path.clone(), key: key.to_owned(), value });
        }
    }
}

/// A number with the unit that its name says, a word, or a path.
fn plain(key: &str, value: &Value, writing: Writing<'_>) -> String {
    let Writing { wording, paths, rounds } = writing;
    match value {
        Value::Bool(true) => wording.words.yes.to_owned(),
        Value::Bool(false) => wording.words.no.to_owned(),
        Value::String(text) => {
            if let Some(choice) = wording.choice(key, text) {
                return choice;
            }
            let shown = paths.shown(text);
            let given = (key == "name").then(|| given_name_of(wording.language, &shown)).flatten();
            let known = given.or_else(|| phrase_of(wording.language, &shown));
            known.unwrap_or_else(|| match key {
                "notes" => wording.remarks(&shown),
                _ => shown,
            })
        }
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            match quantity_of_key(key) {
                Some(Ok(quantity)) if rounds => wording.rounded(quantity, number),
                Some(Ok(quantity)) => wording.given(quantity, number),
                Some(Err(symbol)) => wording.with_unit(&trimmed(significant(number)), symbol),
                None if rounds => wording.local(&trimmed(significant(number))),
                None => wording.given_number(number),
            }
        }
        Value::Number(number) => number.to_string(),
        _ => String::new(),
    }
}
