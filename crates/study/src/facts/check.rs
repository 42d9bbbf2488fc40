//! The facts of a check of files and data sets.

use impactlab_core::data::Channel;
use impactlab_core::units::Quantity;

use crate::facts::{Fact, FactTable, Term, Value};
use crate::{
    CaseFlag, CheckReport, ColumnReport, DatasetReport, FileReport, InputFileReport, PathProblem,
    ProposedColumn, RecordedForceReport, word,
};

/// Channels without which a file holds no force.
const FORCE_CHANNELS: [&str; 3] = ["time", "fx", "fy"];

impl CheckReport {
    /// What the answer says: what each path holds, what is suspicious, what cannot be read, and how
    /// many there are of each.
    pub fn facts(&self) -> Vec<FactTable> {
        let sets = self.datasets.iter().flat_map(DatasetReport::facts);
        let files = self.files.iter().flat_map(FileReport::facts);
        let problems = self.problems.iter().flat_map(PathProblem::facts);
        let models = self.models.iter().map(InputFileReport::table);
        sets.chain(files).chain(problems).chain(models).chain([self.count_table()]).collect()
    }

    fn count_table(&self) -> FactTable {
        let sets = || self.datasets.iter();
        let of_sets = sets().map(|set| set.problems.len()).sum::<usize>();
        let counts = [
            (Term::DataSets, self.datasets.len()),
            (Term::Cases, sets().map(|set| set.n_cases).sum()),
            (Term::Files, self.files.len() + self.models.len()),
            (Term::Problems, self.problems.len() + of_sets),
        ];
        let facts = counts.map(|(term, n)| Fact::new(term, Value::Count(n)));
        FactTable::new(Term::Checked, facts.to_vec())
    }
}

impl DatasetReport {
    fn facts(&self) -> Vec<FactTable> {
        let column = |channel: &Channel| {
            let unit = channel.quantity().si_unit().symbol;
            format!("{} [{unit}]", channel.short_name())
        };
        let columns: Vec<String> = self.columns.iter().map(column).collect();
        let vehicle = self.vehicle_file.clone().map_or(Value::Term(Term::NotGiven), Value::File);
        let mut facts = vec![
            Fact::new(Term::Cases, Value::Count(self.n_cases)),
            Fact::new(Term::CasesWithFlags, Value::Count(self.n_cases - self.n_clean)),
            Fact::new(Term::Vehicle, vehicle),
            Fact::new(Term::Columns, Value::Text(columns.join(", "))),
        ];
        facts.extend(self.problems.iter().map(|problem| Fact::text(Term::Problem, problem)));
        let first = FactTable::new(title(&self.path, format!("{} data set", self.kind)), facts);
        let clean_cases = self.clean_cases.as_deref().unwrap_or_default();
        std::iter::once(first).chain(flag_table(&self.flags, clean_cases)).collect()
    }
}

impl FileReport {
    fn facts(&self) -> Vec<FactTable> {
        let span = [self.start_s, self.end_s].map(|s| Value::Given(Quantity::Time, s));
        let decimal = if self.decimal_comma { "comma" } else { "point" };
        let format =
            format!("{}, separated by {}, decimal {decimal}", self.encoding, self.separator);
        let mut facts = vec![
            Fact::new(Term::Samples, Value::Count(self.n_samples)),
            Fact::new(Term::TimeSpan, Value::span(span)),
            Fact::text(Term::Format, format),
        ];
        let sampling = self.force_sampling.as_ref();
        facts.extend(sampling.map(|of| Fact::new(Term::ForceSampling, words(of))));
        facts.extend(self.force.iter().flat_map(RecordedForceReport::facts));
        facts.extend(self.notes.iter().map(|note| Fact::text(Term::Note, note)));
        let first = FactTable::new(title(&self.path, format!("{} file", self.kind)), facts);
        [Some(first), self.column_table(), flag_table(&self.flags, &[])]
            .into_iter()
            .flatten()
            .collect()
    }

    fn column_table(&self) -> Option<FactTable> {
        let row = |column: &ColumnReport| {
            let number = (column.column > 0).then_some(Value::Count(column.column));
            let unit = if column.unit_is_stated { Term::Stated } else { Term::Assumed };
            let texts = [&column.name, column.channel, column.unit];
            let values = texts.map(|text| Value::Text(text.to_owned())).into_iter();
            let values = values.chain([Value::Term(unit)]).collect();
            Fact::row(number.unwrap_or_else(|| Value::Text(String::new())), values)
        };
        let columns = [Term::Name, Term::Channel, Term::Unit, Term::UnitIs];
        let rows = self.columns.iter().map(row).collect();
        let table = FactTable::new(Term::ColumnsRead, rows).with_rows(Term::Column);
        table.with_columns(&columns).unless_empty()
    }
}

impl RecordedForceReport {
    fn facts(&self) -> [Fact; 5] {
        let contact = self
            .contact_s
            .map(|ends| Value::span(ends.map(|s| Value::Decimals(Quantity::Time, s, 4))));
        [
            Fact::new(Term::ForceAxes, words(&self.axes)),
            Fact::vector(Term::Impulse, Quantity::Impulse, self.impulse_n_s),
            Fact::number(Term::PeakForce, Quantity::Force, self.peak_n),
            Fact::number(Term::PeakTime, Quantity::Time, self.peak_time_s),
            Fact::new(Term::Contact, contact.unwrap_or(Value::Term(Term::None))),
        ]
    }
}

impl InputFileReport {
    fn table(&self) -> FactTable {
        let name = Fact::text(Term::Name, &self.name);
        let contents = self.contents.iter().map(|part| Fact::text(Term::Contents, part));
        let unused = self.unused.iter().map(|part| Fact::text(Term::Note, part));
        let command = self.command().map(|command| Fact::text(Term::Command, command));
        let facts = std::iter::once(name).chain(contents).chain(unused).chain(command).collect();
        FactTable::new(title(&self.path, word(&self.kind)), facts)
    }
}

impl PathProblem {
    /// What is wrong, and what its columns may be.
    fn facts(&self) -> Vec<FactTable> {
        let mut facts = vec![Fact::text(Term::Problem, &self.message)];
        let columns = self.columns.as_deref();
        facts.extend(columns.map(|columns| {
            let map = Value::Text(format!("--map \"{}\"", self.proposed_map(columns)));
            Fact::new(Term::ProposedMap, map)
        }));
        let first = FactTable::new(Value::File(self.path.clone()), facts);
        std::iter::once(first).chain(columns.map(proposal_table)).collect()
    }

    /// What is recognised, and beside it what a force file needs.
    fn proposed_map(&self, columns: &[ProposedColumn]) -> String {
        let is_known = |channel: &str| columns.iter().any(|of| of.channel == Some(channel));
        let missing = FORCE_CHANNELS.into_iter().filter(|channel| !is_known(channel));
        let missing = missing.map(|channel| format!("{channel}=COLUMN:UNIT"));
        self.map.iter().cloned().chain(missing).collect::<Vec<String>>().join(",")
    }
}

fn proposal_table(columns: &[ProposedColumn]) -> FactTable {
    let row = |column: &ProposedColumn| {
        let texts = [
            column.name.clone(),
            column.channel.unwrap_or("?").to_owned(),
            column.unit.unwrap_or_default().to_owned(),
            column.samples.join(" "),
        ];
        Fact::row(Value::Count(column.column), texts.map(Value::Text).to_vec())
    };
    let rows = columns.iter().map(row).collect();
    let columns = [Term::Name, Term::Channel, Term::Unit, Term::FirstValues];
    FactTable::new(Term::ColumnsFound, rows).with_rows(Term::Column).with_columns(&columns)
}

/// Flags, and then the cases without one; none without either.
fn flag_table(flags: &[CaseFlag], clean_cases: &[String]) -> Option<FactTable> {
    let flag = |flag: &CaseFlag| {
        let values = vec![
            Value::Phrase(flag.severity.clone()),
            words(&flag.kind),
            Value::English(flag.message.clone()),
        ];
        Fact::row(Value::Text(flag.case.clone().unwrap_or_default()), values)
    };
    let clean = |case: &String| {
        let empty = || Value::Text(String::new());
        Fact::row(Value::Text(case.clone()), vec![Value::Term(Term::Clean), empty(), empty()])
    };
    let rows = flags.iter().map(flag).chain(clean_cases.iter().map(clean)).collect();
    let columns = [Term::Severity, Term::Flag, Term::Meaning];
    FactTable::new(Term::FlagsFound, rows)
        .with_rows(Term::Case)
        .with_columns(&columns)
        .unless_empty()
}

/// A path and what it holds.
fn title(path: &std::path::Path, kind: String) -> Value {
    Value::Joined(vec![Value::File(path.to_owned()), Value::Phrase(kind)], ": ")
}

fn words(text: &str) -> Value {
    Value::Phrase(text.replace('_', " "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InputKind;
    use crate::facts::FactWriter;
    use impactlab_core::data::Severity;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};

    #[test]
    fn columns_that_are_not_understood_are_shown_with_the_map_that_is_missing() {
        let column = |column, channel| ProposedColumn {
            column,
            name: "Kraft".to_owned(),
            samples: vec!["0".to_owned(), "1".to_owned()],
            channel,
            unit: None,
        };
        let problem = PathProblem {
            path: "k.csv".into(),
            kind: InputKind::Series,
            message: "no column".to_owned(),
            columns: Some(vec![column(1, Some("time")), column(2, None)]),
            map: Some("time=1:ms".to_owned()),
        };
        let tables = CheckReport { problems: vec![problem], ..CheckReport::default() }.facts();
        let english = FactWriter::english(UnitSystem::Si);
        let format = NumberFormat { language: Language::De, ..english.format };
        let texts = tables.iter().map(|table| table.to_text(&FactWriter { format, ..english }));
        let texts: Vec<_> = texts.collect();
        let [what, columns, counts] = &texts[..] else { panic!("{texts:?}") };
        let map = "--map \"time=1:ms,fx=COLUMN:UNIT,fy=COLUMN:UNIT\"";
        assert_eq!(what.rows[1].cells[1], map);
        assert_eq!(columns.header, ["Spalte", "Name", "Kanal", "Einheit", "erste Werte"]);
        assert_eq!(columns.rows[1].cells, ["2", "Kraft", "?", "", "0 1"]);
        assert_eq!(counts.rows[3].cells, ["Probleme", "1"]);
    }

    #[test]
    fn flags_come_before_the_cases_without_one() {
        let flag = CaseFlag {
            case: Some("c014".to_owned()),
            kind: "not_separated".to_owned(),
            severity: "warning".to_owned(),
            message: "still in contact".to_owned(),
            value: 0.0,
            limit: 0.0,
            time_s: None,
            severity_rank: Severity::Warning,
        };
        let table = flag_table(&[flag], &["c001".to_owned()]).unwrap();
        let text = table.to_text(&FactWriter::english(UnitSystem::Si));
        assert_eq!(text.rows[0].cells, ["c014", "warning", "not separated", "still in contact"]);
        assert_eq!(text.rows[1].cells, ["c001", "clean", "", ""]);
        assert_eq!(flag_table(&[], &[]), None);
    }
}
