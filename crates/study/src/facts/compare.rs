//! The facts of a comparison of response models.

use impactlab_networks::response::evaluate::all_tables;

use crate::CompareReport;
use crate::facts::training::left_out;
use crate::facts::{Fact, FactTable, Term, Value};

impl CompareReport {
    /// What the answer says: the models beside each other, and which cases are left out. The words of
    /// its tables are those of its files, which are in English.
    pub fn facts(&self) -> Vec<FactTable> {
        let facts = vec![
            Fact::new(Term::UnseenMotions, Value::Count(self.comparison.test.len())),
            Fact::new(Term::Seed, Value::Text(self.comparison.seed.to_string())),
            Fact::new(Term::Choices, Value::Text(self.comparison.n_choices.to_string())),
        ];
        let tables = all_tables(&self.comparison).into_iter().filter_map(|(title, _, table)| {
            let mut header = table.header.into_iter().map(Value::English);
            let rows = header.next()?;
            let row = |cells: Vec<String>| {
                let mut cells = cells.into_iter().map(Value::Text);
                Some(Fact::row(cells.next()?, cells.collect()))
            };
            FactTable {
                title: Value::English(title.to_owned()),
                rows,
                columns: header.collect(),
                levels: &[],
                facts: table.rows.into_iter().filter_map(row).collect(),
            }
            .unless_empty()
        });
        let first = FactTable::new(Term::ResponseEvaluation, facts);
        std::iter::once(first).chain(tables).chain(left_out(&self.left_out)).collect()
    }
}
