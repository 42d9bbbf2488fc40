//! What `impactlab check` prints for a person.

use std::io::{self, Write};

use crate::cli::console::{print_facts, print_table, shown_path};
use impactlab_core::data::Channel;
use impactlab_core::units::{NumberFormat, Quantity};
use impactlab_study::{
    CaseFlag, CheckReport, ColumnReport, DatasetReport, FileReport, PathProblem, ProposedColumn,
    word,
};

/// Prints the report for a person.
pub(in crate::cli) fn print_check(out: &mut dyn Write, report: &CheckReport) -> io::Result<()> {
    for set in &report.datasets {
        print_dataset(out, set)?;
        writeln!(out)?;
    }
    for file in &report.files {
        print_file(out, file)?;
        writeln!(out)?;
    }
    for problem in &report.problems {
        writeln!(out, "problem: {}", problem.message)?;
        print_proposals(out, problem)?;
        writeln!(out)?;
    }
    for model in &report.models {
        writeln!(out, "{}: {}, {:?}", shown_path(&model.path), word(&model.kind), model.name)?;
        for part in &model.contents {
            writeln!(out, "  {part}")?;
        }
        writeln!(out)?;
    }
    let sets = || report.datasets.iter();
    let n_problems = report.problems.len() + sets().map(|set| set.problems.len()).sum::<usize>();
    let n_files = report.files.len() + report.models.len();
    writeln!(
        out,
        "{} with {}, {}; {}",
        counted(report.datasets.len(), "data set"),
        counted(sets().map(|set| set.n_cases).sum(), "case"),
        counted(n_files, "file"),
        counted(n_problems, "problem"),
    )
}

/// `1 case`, `2 cases`.
fn counted(n: usize, what: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {what}{plural}")
}

fn print_dataset(out: &mut dyn Write, set: &DatasetReport) -> io::Result<()> {
    let column = |channel: &Channel| {
        let unit = channel.quantity().si_unit().symbol;
        format!("{} [{unit}]", channel.short_name())
    };
    let columns: Vec<String> = set.columns.iter().map(column).collect();
    let flagged = set.n_cases - set.n_clean;
    let vehicle = set.vehicle_file.as_ref();
    writeln!(out, "{}: {} data set", shown_path(&set.path), set.kind)?;
    let facts = [
        ("  cases", format!("{} ({flagged} with flags)", set.n_cases)),
        ("  vehicle", vehicle.map_or("not given".to_owned(), |path| shown_path(path))),
        ("  columns", columns.join(", ")),
    ];
    print_facts(out, &facts)?;
    print_flags(out, &set.flags, set.clean_cases.as_deref().unwrap_or_default())?;
    for problem in &set.problems {
        writeln!(out, "  problem: {problem}")?;
    }
    Ok(())
}

fn print_file(out: &mut dyn Write, file: &FileReport) -> io::Result<()> {
    writeln!(out, "{}: {} file", shown_path(&file.path), file.kind)?;
    let decimal = if file.decimal_comma { "comma" } else { "point" };
    let mut facts = vec![
        ("  samples", format!("{} from {} s to {} s", file.n_samples, file.start_s, file.end_s)),
        (
            "  format",
            format!("{}, separated by {}, decimal {decimal}", file.encoding, file.separator),
        ),
    ];
    if let Some(sampling) = &file.force_sampling {
        facts.push(("  force is", sampling.replace('_', " ")));
    }
    if let Some(force) = &file.force {
        let format = NumberFormat::default();
        let impulse = format.vector(Quantity::Impulse, force.impulse_n_s, ["x", "y"]);
        let [peak, at] = [(Quantity::Force, force.peak_n), (Quantity::Time, force.peak_time_s)]
            .map(|(quantity, value)| format.value(quantity, value));
        let contact = force.contact_s.map(|[from, to]| format!("{from:.4} s to {to:.4} s"));
        facts.push(("  impulse", format!("{impulse}, {} axes", force.axes)));
        facts.push(("  peak", format!("{peak} at {at}")));
        facts.push(("  contact", contact.unwrap_or_else(|| "none".to_owned())));
    }
    print_facts(out, &facts)?;
    let row = |column: &ColumnReport| {
        let stated = if column.unit_is_stated { "" } else { "assumed" };
        vec![
            String::new(),
            if column.column > 0 { column.column.to_string() } else { String::new() },
            column.name.clone(),
            column.channel.to_owned(),
            column.unit.to_owned(),
            stated.to_owned(),
        ]
    };
    let rows: Vec<_> = file.columns.iter().map(row).collect();
    print_table(out, &["", "column", "name", "channel", "unit", ""], &rows)?;
    for note in &file.notes {
        writeln!(out, "  note: {note}")?;
    }
    print_flags(out, &file.flags, &[])
}

/// Prints flags and the cases without one, the flags first.
fn print_flags(out: &mut dyn Write, flags: &[CaseFlag], clean_cases: &[String]) -> io::Result<()> {
    if flags.is_empty() && clean_cases.is_empty() {
        return Ok(());
    }
    let row = |flag: &CaseFlag| {
        vec![
            String::new(),
            flag.severity.clone(),
            flag.case.clone().unwrap_or_default(),
            flag.kind.replace('_', " "),
            flag.message.clone(),
        ]
    };
    let clean = |case: &String| ["", "clean", case, "", ""].map(str::to_owned).to_vec();
    let flagged = flags.iter().map(row);
    let rows: Vec<_> = flagged.chain(clean_cases.iter().map(clean)).collect();
    print_table(out, &["", "severity", "case", "flag", ""], &rows)
}

fn print_proposals(out: &mut dyn Write, problem: &PathProblem) -> io::Result<()> {
    let Some(columns) = &problem.columns else {
        return Ok(());
    };
    let row = |column: &ProposedColumn| {
        let unit = column.unit.unwrap_or_default();
        vec![
            String::new(),
            column.column.to_string(),
            column.name.clone(),
            column.channel.unwrap_or("?").to_owned(),
            unit.to_owned(),
            column.samples.join(" "),
        ]
    };
    let rows: Vec<_> = columns.iter().map(row).collect();
    print_table(out, &["", "column", "name", "channel", "unit", "first values"], &rows)?;
    let is_known = |channel: &&str| columns.iter().any(|c| c.channel == Some(*channel));
    let missing = ["time", "fx", "fy"]
        .into_iter()
        .filter(|name| !is_known(name))
        .map(|name| format!("{name}=COLUMN:UNIT"));
    let parts: Vec<String> = problem.map.iter().cloned().chain(missing).collect();
    let map = parts.join(",");
    writeln!(out, "  for a force file, complete: --map \"{map}\"")
}
