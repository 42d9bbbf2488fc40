//! The answer to a question as a person reads it: its facts, and what restricts them.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_table, within_line};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_study::facts::{FactTable, FactWriter};
use impactlab_study::{
    Answer, ImpactReport, PredictForceReport, PredictMotionReport, ReconstructReport,
    SimulateReport,
};

/// What is printed of an answer.
pub(in crate::cli) struct PrintedAnswer<'a> {
    name: &'a str,
    tables: Vec<FactTable>,
    caveats: &'a Caveats,
}

macro_rules! answers {
    ($($report:ty: $name:ident;)+) => {
        $(impl<'a> From<&'a Answer<$report>> for PrintedAnswer<'a> {
            fn from(report: &'a Answer<$report>) -> Self {
                Self {
                    name: &report.$name,
                    tables: report.facts(),
                    caveats: &report.caveats,
                }
            }
        })+
    };
}

answers! {
    ImpactReport: name;
    PredictForceReport: scenario;
    PredictMotionReport: scenario;
    ReconstructReport: case;
    SimulateReport: name;
}

/// Prints the name of an answer, its tables of facts below each other, each with its title, and what
/// restricts it.
pub(in crate::cli) fn print_answer<'a>(
    out: &mut dyn Write,
    answer: impl Into<PrintedAnswer<'a>>,
    units: UnitSystem,
) -> io::Result<()> {
    let answer: PrintedAnswer<'_> = answer.into();
    writeln!(out, "{}", within_line(answer.name))?;
    for table in &answer.tables {
        let text = table.to_text(&FactWriter::english(units));
        writeln!(out, "\n{}", text.title)?;
        let is_list = text.is_list();
        let titles = text.header.iter().map(|title| if is_list { "" } else { title.as_str() });
        let titles: Vec<&str> = titles.collect();
        let rows: Vec<Vec<String>> = text.rows.into_iter().map(|row| row.cells).collect();
        print_table(out, &titles, &rows)?;
    }
    writeln!(out)?;
    for note in answer.caveats.notes() {
        writeln!(out, "note: {}", within_line(note))?;
    }
    print_caveats(out, answer.caveats)
}
