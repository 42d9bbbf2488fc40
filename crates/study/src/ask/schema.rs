//! JSON Schemas of questions and answers, made from their types and from the comments of their fields,
//! which say unit and meaning.

use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

use crate::case_file::{CaseFile, CaseReport};
use crate::{Request, word};

/// The key that says which question it is.
const QUESTION: &str = "question";

/// Something that is written and read as JSON: a kind of question, or a case.
#[derive(Debug, Clone, PartialEq)]
pub struct JsonKind {
    /// Name of the question, as `question` says it in JSON; `case` for a case.
    pub name: String,
    /// What is asked, in a sentence.
    pub meaning: &'static str,
    /// Schema of the question, or of the file of a case.
    pub request: Schema,
    /// Schema of its answer.
    pub answer: Schema,
}

/// All kinds of questions in the order in which they are listed, and the case.
pub fn json_kinds() -> Vec<JsonKind> {
    let case = JsonKind {
        name: "case".to_owned(),
        meaning: "What an analyst works on: variants with their questions.",
        request: read::<CaseFile>(),
        answer: written::<CaseReport>(),
    };
    let mut kinds = Request::kinds();
    kinds.push(case);
    kinds
}

impl JsonKind {
    /// A kind of question.
    ///
    /// - `variant`: its name among the requests;
    /// - `meaning`: what is asked.
    pub(crate) fn question<Q: JsonSchema, R: JsonSchema>(
        variant: &str,
        meaning: &'static str,
    ) -> Self {
        let name = word(&format_args!("{variant}"));
        let mut request = read::<Q>();
        let which = json!({ "const": name, "description": "Which question it is." });
        let object = request.ensure_object();
        if let Some(properties) =
            object.entry("properties").or_insert_with(|| json!({})).as_object_mut()
        {
            properties.insert(QUESTION.to_owned(), which);
        }
        if let Some(required) = object.entry("required").or_insert_with(|| json!([])).as_array_mut()
        {
            required.insert(0, QUESTION.into());
        }
        Self { name, meaning: meaning.trim(), request, answer: written::<R>() }
    }
}

/// Schema of what is read.
fn read<T: JsonSchema>() -> Schema {
    root::<T>(SchemaSettings::draft2020_12().for_deserialize())
}

/// Schema of what is written.
fn written<T: JsonSchema>() -> Schema {
    root::<T>(SchemaSettings::draft2020_12().for_serialize())
}

fn root<T: JsonSchema>(settings: SchemaSettings) -> Schema {
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    make_plain(&mut schema);
    schema
}

/// Makes plain text of all descriptions.
fn make_plain(schema: &mut Schema) {
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = plain(text);
    }
    transform_subschemas(&mut make_plain, schema);
}

/// The text of a comment without links, each paragraph and each item of a list in one line.
fn plain(comment: &str) -> String {
    let mut text = String::new();
    for line in without_links(comment).lines() {
        let line = line.trim();
        let starts_anew = line.is_empty() || line.starts_with("- ") || text.ends_with('\n');
        if !text.is_empty() {
            text.push(if starts_anew { '\n' } else { ' ' });
        }
        text.push_str(line);
    }
    text.trim().to_owned()
}

/// The text with the words of links in place of these: ``[`Name`]`` and `[words](target)`. Other
/// brackets, such as those of units, stay.
fn without_links(comment: &str) -> String {
    let (mut text, mut rest) = (String::new(), comment);
    while let Some((before, after)) = rest.split_once('[') {
        text.push_str(before);
        let Some((words, behind)) = after.split_once(']') else {
            text.push('[');
            rest = after;
            continue;
        };
        let target = behind.strip_prefix('(').and_then(|target| target.split_once(')'));
        let is_name = words.starts_with('`') && words.ends_with('`');
        match target {
            Some((_, behind)) => {
                text.push_str(words);
                rest = behind;
            }
            None if is_name => {
                text.push_str(words);
                rest = behind;
            }
            None => {
                text.push('[');
                rest = after;
            }
        }
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_the_names_that_stand_in_json() {
        let all = read::<Request>();
        let variants = all.get("oneOf").and_then(Value::as_array).unwrap();
        let tag = |variant: &Value| variant.pointer("/properties/question/const").cloned();
        let tags: Vec<Value> = variants.iter().map(|variant| tag(variant).unwrap()).collect();
        let names: Vec<Value> = Request::kinds().into_iter().map(|kind| kind.name.into()).collect();
        assert_eq!(names, tags);
    }

    #[test]
    fn every_key_of_a_question_and_of_an_answer_has_its_meaning() {
        for JsonKind { name, request, answer, .. } in json_kinds() {
            for schema in [request, answer] {
                let properties = schema.get("properties").and_then(Value::as_object);
                for (key, property) in properties.into_iter().flatten() {
                    let meaning = property.get("description").and_then(Value::as_str);
                    assert!(meaning.is_some_and(|text| !text.is_empty()), "{name}: {key}");
                }
            }
        }
    }

    #[test]
    fn descriptions_are_plain_text() {
        let comment = "Impulse [x, y] in [`Axes`], N s;\nsee [the source](crate::Source).\n\nNext.";
        let expected = "Impulse [x, y] in `Axes`, N s; see the source.\n\nNext.";
        assert_eq!(plain(comment), expected);
        assert_eq!(plain("One:\n- a\n  b;\n- [m/s"), "One:\n- a b;\n- [m/s");
    }
}
