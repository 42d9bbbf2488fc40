//! `impactlab schema`: what stands in the JSON of questions and of their answers.

use std::io;

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_json, print_table};
use impactlab_study::{JsonKind, json_kinds};

/// Print the JSON Schema of a question or of its answer: every key with its meaning and unit
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct SchemaArgs {
    /// The question, or `case`; without one all are listed
    #[arg(value_name = "QUESTION")]
    question: Option<String>,
    /// The schema of the question, as --print-request writes it (usual)
    #[arg(long, requires = "question", conflicts_with = "answer")]
    request: bool,
    /// The schema of the answer, as --json prints it
    #[arg(long, requires = "question")]
    answer: bool,
}

const EXAMPLES: &str = "\
Examples:
  impactlab schema
  impactlab schema impact
  impactlab schema predict-motion --answer

The request of `case` is a case file, its answer is what case run prints. A command that writes files
says in its help which key it prints beside those of the answer.

JSON of the list: {\"questions\": [{name, meaning}]}; a schema is JSON always";

#[derive(Debug, Serialize)]
struct List<'a> {
    questions: Vec<ListedQuestion<'a>>,
}

#[derive(Debug, Serialize)]
struct ListedQuestion<'a> {
    name: &'a str,
    meaning: &'a str,
}

/// Prints a schema, or which there are.
pub(in crate::cli) fn run(
    args: &SchemaArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let kinds = json_kinds();
    let Some(question) = &args.question else {
        console.print(&List::from_kinds(&kinds), |out| print_list(out, &kinds))?;
        return Ok(Verdict::Clean);
    };
    let name = question.replace('-', "_");
    let kind = kinds.iter().find(|kind| kind.name == name);
    let kind = kind.ok_or_else(|| CliError::NoSchema { name: question.clone() })?;
    let is_answer = args.answer && !args.request;
    print_json(console.out, if is_answer { &kind.answer } else { &kind.request })?;
    Ok(Verdict::Clean)
}

impl<'a> List<'a> {
    fn from_kinds(kinds: &'a [JsonKind]) -> Self {
        let listed =
            |kind: &'a JsonKind| ListedQuestion { name: &kind.name, meaning: kind.meaning };
        Self { questions: kinds.iter().map(listed).collect() }
    }
}

fn print_list(out: &mut dyn io::Write, kinds: &[JsonKind]) -> io::Result<()> {
    let row = |kind: &JsonKind| vec![kind.name.clone(), kind.meaning.to_owned()];
    let rows: Vec<_> = kinds.iter().map(row).collect();
    print_table(out, &["", ""], &rows)
}
