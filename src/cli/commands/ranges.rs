//! `impactlab ranges`: the values that numbers from outside may have.

use std::io;

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_table};
use impactlab_core::ranges::{Range, RangeGroup, TABLE};

/// List the ranges of all numbers in files, settings, options and questions
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct RangesArgs {
    /// Only the groups and ranges whose names contain this word
    #[arg(value_name = "WORD")]
    word: Option<String>,
}

const EXAMPLES: &str = "\
Examples:
  impactlab ranges
  impactlab ranges friction

JSON: {\"ranges\": [{group, name, low, high, unit, is_whole, meaning}]}, SI units";

#[derive(Debug, Serialize)]
struct List {
    ranges: Vec<ListedRange>,
}

#[derive(Debug, Serialize)]
struct ListedRange {
    group: &'static str,
    name: &'static str,
    low: f64,
    high: f64,
    unit: &'static str,
    is_whole: bool,
    meaning: &'static str,
    /// Limits and unit for the text.
    #[serde(skip)]
    limits: String,
}

/// Prints the table of ranges, or a part of it.
pub(in crate::cli) fn run(
    args: &RangesArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let word = args.word.as_deref().unwrap_or_default().to_lowercase();
    let list = List { ranges: TABLE.iter().flat_map(|group| listed(group, &word)).collect() };
    if list.ranges.is_empty() {
        return Err(CliError::NoRange { word });
    }
    console.print(&list, |out| print_list(out, &list.ranges))?;
    Ok(Verdict::Clean)
}

fn listed(group: &RangeGroup, word: &str) -> Vec<ListedRange> {
    let is_whole_group = group.title.to_lowercase().contains(word);
    let wanted = group
        .ranges
        .iter()
        .filter(|range| is_whole_group || range.name.to_lowercase().contains(word));
    let of = |range: &Range| ListedRange {
        group: group.title,
        name: range.name,
        low: range.low,
        high: range.high,
        unit: range.unit(),
        is_whole: range.is_whole,
        meaning: range.meaning,
        limits: range.expected_si(),
    };
    wanted.map(of).collect()
}

fn print_list(out: &mut dyn io::Write, ranges: &[ListedRange]) -> io::Result<()> {
    for (idx, group) in ranges.chunk_by(|a, b| a.group == b.group).enumerate() {
        if idx > 0 {
            writeln!(out)?;
        }
        writeln!(out, "{}", group.first().map_or("", |range| range.group))?;
        let row = |range: &ListedRange| {
            vec![format!("  {}", range.name), range.limits.clone(), range.meaning.to_owned()]
        };
        let rows: Vec<_> = group.iter().map(row).collect();
        print_table(out, &["", "", ""], &rows)?;
    }
    Ok(())
}
