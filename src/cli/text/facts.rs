//! The answer to a question as a person reads it: its facts, and what restricts them.

use std::io::{self, Write};
use std::path::Path;

use crate::cli::console::{print_caveats, print_table, shown_path, within_line};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_study::facts::{FactTable, FactWriter};
use impactlab_study::{
    Answer, CheckReport, CompareReport, EvaluatePairsReport, EvaluateReconstructionReport,
    ForceEvaluation, HandReport, ImpactReport, PredictForceReport, PredictMotionReport,
    ReconstructReport, ReplayReport, ResponseTrainingReport, SimulateDatasetReport, SimulateReport,
    TrainForceReport,
};

/// What is printed of an answer.
pub(in crate::cli) struct PrintedAnswer<'a> {
    name: String,
    tables: Vec<FactTable>,
    caveats: &'a Caveats,
    written: Option<&'a Path>,
}

impl<'a> PrintedAnswer<'a> {
    /// The same with the file or the folder that was written.
    pub(in crate::cli) fn written(self, written: Option<&'a Path>) -> Self {
        Self { written, ..self }
    }
}

macro_rules! answers {
    ($($report:ty: $of:ident => $name:expr;)+) => {
        $(impl<'a> From<&'a Answer<$report>> for PrintedAnswer<'a> {
            fn from($of: &'a Answer<$report>) -> Self {
                Self { name: $name, tables: $of.facts(), caveats: &$of.caveats, written: None }
            }
        })+
    };
}

answers! {
    HandReport: of => of.name.to_owned();
    ImpactReport: of => of.name.clone();
    PredictForceReport: of => of.scenario.clone();
    PredictMotionReport: of => of.scenario.clone();
    ReconstructReport: of => of.case.clone();
    ReplayReport: of => of.name.clone();
    SimulateReport: of => of.name.clone();
    SimulateDatasetReport: of => of.dataset.display().to_string();
    CheckReport: of => String::new();
    TrainForceReport: of => of.data.clone();
    ResponseTrainingReport: of => of.data.clone();
    ForceEvaluation: of => evaluated(of);
    CompareReport: of => of.comparison.data.clone();
    EvaluatePairsReport: of => of.data.display().to_string();
    EvaluateReconstructionReport: of => of.data.display().to_string();
}

/// The network and the data of an evaluation; a cross-validation has networks of its own.
fn evaluated(of: &ForceEvaluation) -> String {
    match of {
        ForceEvaluation::Cases(report) => {
            format!("{} on {}", report.model_file, report.data.display())
        }
        ForceEvaluation::Folds(_) => String::new(),
    }
}

/// Prints the name of an answer, its tables of facts below each other, each with its title, what was
/// written, and what restricts it.
pub(in crate::cli) fn print_answer<'a>(
    out: &mut dyn Write,
    answer: impl Into<PrintedAnswer<'a>>,
    units: UnitSystem,
) -> io::Result<()> {
    let answer: PrintedAnswer<'_> = answer.into();
    let mut before = "";
    if !answer.name.is_empty() {
        writeln!(out, "{}", within_line(&answer.name))?;
        before = "\n";
    }
    for table in &answer.tables {
        let text = table.to_text(&FactWriter::english(units));
        writeln!(out, "{before}{}", within_line(&text.title))?;
        before = "\n";
        let is_list = text.is_list();
        let titles = text.header.iter().map(|title| if is_list { "" } else { title.as_str() });
        let titles: Vec<&str> = titles.collect();
        let rows: Vec<Vec<String>> = text.rows.into_iter().map(|row| row.cells).collect();
        print_table(out, &titles, &rows)?;
    }
    writeln!(out)?;
    print_caveats(out, answer.caveats, units)?;
    answer.written.map_or(Ok(()), |path| writeln!(out, "written: {}", shown_path(path)))
}
