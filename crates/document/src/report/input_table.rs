//! A table of inputs with their sources.

use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use crate::report::{Block, InputClass, Table};

/// Rows with one source from which on it is said once, below the table.
const MANY: usize = 4;

/// Characters of a source that does not fit into one line of its cell.
const LONG: usize = 60;

/// A table of inputs. Where the question says all of them, two stand in a row; a source that many of them
/// have is told once.
pub(super) fn input_table(caption: &str, rows: &[&InputRow], wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let is_asked =
        |row: &&InputRow| row.class == InputClass::Given && row.source == words.source_question;
    if rows.len() >= MANY && rows.iter().all(is_asked) {
        let caption = fill(words.inputs_said, &[("caption", caption)]);
        let [quantity, value] = [words.quantity, words.value];
        let pair = |pair: &[&InputRow]| {
            let cells = |row: &&InputRow| [row.label.clone(), row.value.clone()];
            let [first, second] = [pair.first().map(cells), pair.get(1).map(cells)];
            let [label, value] = first.unwrap_or_default();
            let [other_label, other_value] = second.unwrap_or_default();
            [label, value, other_label, other_value]
        };
        let rows = rows.chunks(2).map(pair).collect();
        return vec![Block::Table(Table::new(caption, [quantity, value, quantity, value], rows))];
    }
    let common = common_source(rows);
    let cells = rows.iter().map(|row| {
        let source = match common {
            Some(common) if common == row.source => "*".to_owned(),
            _ => row.source.clone(),
        };
        [row.label.clone(), row.value.clone(), class_name(row.class, wording), source]
    });
    let columns = [words.quantity, words.value, words.class, words.source];
    let table = Block::Table(Table::new(caption, columns, cells.collect()));
    let below =
        common.map(|source| Block::paragraph(fill(words.common_source, &[("source", source)])));
    std::iter::once(table).chain(below).collect()
}

/// A long source that many rows have.
fn common_source<'a>(rows: &[&'a InputRow]) -> Option<&'a str> {
    let n_of = |source: &str| rows.iter().filter(|row| row.source == source).count();
    let sources = rows.iter().map(|row| row.source.as_str());
    let sources = sources.filter(|source| source.chars().count() > LONG);
    sources.max_by_key(|source| n_of(source)).filter(|source| n_of(source) >= MANY)
}

fn class_name(class: InputClass, wording: &Wording) -> String {
    let words = wording.words;
    let name = match class {
        InputClass::Given => words.class_given,
        InputClass::Measured => words.class_measured,
        InputClass::Estimated => words.class_estimated,
        InputClass::Assumed => words.class_assumed,
    };
    name.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::UnitSystem;

    fn row(label: &str, source: &str) -> InputRow {
        InputRow {
            group: "car".to_owned(),
            label: label.to_owned(),
            value: format!("{label} kg"),
            class: InputClass::Given,
            source: source.to_owned(),
        }
    }

    fn table(blocks: &[Block]) -> &Table {
        let Some(Block::Table(table)) = blocks.first() else { panic!("{blocks:?}") };
        table
    }

    #[test]
    fn a_source_of_many_is_said_once_and_no_row_is_lost() {
        let wording = Wording::english(UnitSystem::Si);
        let sheet = "the data sheet of the maker, edition of 2020, of which tables 3 and 4";
        let mut rows: Vec<InputRow> = ["a", "b", "c", "d"].map(|label| row(label, sheet)).into();
        rows.push(row("e", "weighed on a scale"));
        let blocks = input_table("Car", &rows.iter().collect::<Vec<_>>(), &wording);
        let table = table(&blocks);
        assert_eq!(table.rows.len(), 5);
        assert_eq!(table.rows[0], ["a", "a kg", "given", "*"]);
        assert_eq!(table.rows[4][3], "weighed on a scale");
        assert_eq!(blocks[1], Block::paragraph(format!("* {sheet}")));
    }

    #[test]
    fn what_the_question_says_stands_two_in_a_row() {
        let wording = Wording::english(UnitSystem::Si);
        let asked = wording.words.source_question;
        let rows: Vec<InputRow> = ["a", "b", "c", "d", "e"].map(|label| row(label, asked)).into();
        let blocks = input_table("Car", &rows.iter().collect::<Vec<_>>(), &wording);
        let table = table(&blocks);
        assert_eq!(
            table.rows,
            [["a", "a kg", "b", "b kg"], ["c", "c kg", "d", "d kg"], ["e", "e kg", "", ""]]
        );
        assert!(table.caption.contains("question"), "{}", table.caption);
    }
}
