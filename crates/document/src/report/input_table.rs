//! A table of inputs with their sources.

use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use crate::report::{Block, InputClass, Table};

/// Rows with one source from which on it is said once, in the caption.
const MANY: usize = 4;

/// Characters of a value that stands beside another one.
const SHORT: usize = 24;

/// A table of inputs. Short values that many rows have from one source stand two in a row, and the source
/// in the caption.
pub(super) fn input_table(caption: &str, rows: &[&InputRow], wording: &Wording) -> Vec<Block> {
    let mut rest = rows.to_vec();
    let mut blocks = Vec::new();
    for (class, source) in sources_of_many(rows) {
        let is_of = |row: &&InputRow| (row.class, &*row.source) == (class, source) && is_short(row);
        let (of_source, others): (Vec<&InputRow>, Vec<&InputRow>) =
            rest.into_iter().partition(is_of);
        rest = others;
        blocks.push(pairs(&caption_of(caption, class, source, wording), &of_source, wording));
    }
    if !rest.is_empty() {
        let cells = |row: &&InputRow| {
            let class = class_name(row.class, wording);
            [row.label.clone(), row.value.clone(), class.to_owned(), row.source.clone()]
        };
        let words = wording.words;
        let columns = [words.quantity, words.value, words.class, words.source];
        let cells = rest.iter().map(cells).collect();
        blocks.push(Block::Table(Table::new(caption, columns, cells)));
    }
    blocks
}

/// The values that nobody changed, in a sentence.
pub(super) fn left_as_they_are(rows: &[&InputRow], wording: &Wording) -> Block {
    let mut groups: Vec<(&str, Vec<String>)> = Vec::new();
    for row in rows {
        let text = format!("{} {}", row.label, row.value);
        match groups.iter_mut().find(|(group, _)| *group == row.group) {
            Some((_, texts)) => texts.push(text),
            None => groups.push((&row.group, vec![text])),
        }
    }
    let groups = groups.into_iter().map(|(group, texts)| format!("{group}: {}", texts.join(", ")));
    let values = groups.collect::<Vec<_>>().join("; ");
    Block::paragraph(fill(wording.words.inputs_left, &[("values", &values)]))
}

/// Class and source of many short rows, in the order of the rows.
fn sources_of_many<'a>(rows: &[&'a InputRow]) -> Vec<(InputClass, &'a str)> {
    let mut sources: Vec<(InputClass, &str, usize)> = Vec::new();
    for row in rows.iter().filter(|row| is_short(row)) {
        let is_same =
            |of: &&mut (InputClass, &str, usize)| (of.0, of.1) == (row.class, &*row.source);
        match sources.iter_mut().find(is_same) {
            Some((_, _, n)) => *n += 1,
            None => sources.push((row.class, &row.source, 1)),
        }
    }
    let many = sources.into_iter().filter(|(_, _, n)| *n >= MANY);
    many.map(|(class, source, _)| (class, source)).collect()
}

/// Whether two such rows stand beside each other.
fn is_short(row: &InputRow) -> bool {
    row.value.chars().count() <= SHORT && row.label.chars().count() <= 2 * SHORT
}

fn caption_of(caption: &str, class: InputClass, source: &str, wording: &Wording) -> String {
    match source == wording.words.source_question {
        true => fill(wording.words.inputs_said, &[("caption", caption)]),
        false => format!("{caption}; {}: {source}", class_name(class, wording)),
    }
}

/// Names and values, two in a row.
fn pairs(caption: &str, rows: &[&InputRow], wording: &Wording) -> Block {
    let pair = |pair: &[&InputRow]| {
        let cells = |row: &&InputRow| [row.label.clone(), row.value.clone()];
        let [first, second] = [pair.first().map(cells), pair.get(1).map(cells)];
        let [label, value] = first.unwrap_or_default();
        let [other_label, other_value] = second.unwrap_or_default();
        [label, value, other_label, other_value]
    };
    let rows = rows.chunks(2).map(pair).collect();
    let [quantity, value] = [wording.words.quantity, wording.words.value];
    Block::Table(Table::new(caption, [quantity, value, quantity, value], rows))
}

fn class_name(class: InputClass, wording: &Wording) -> &'static str {
    let words = wording.words;
    match class {
        InputClass::Given => words.class_given,
        InputClass::Measured => words.class_measured,
        InputClass::Estimated => words.class_estimated,
        InputClass::Assumed => words.class_assumed,
    }
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
        let long = "normal, 1500 ± 45 kg, cut off at 1200 and 1800 kg";
        rows.push(InputRow { value: long.to_owned(), ..row("f", sheet) });
        let blocks = input_table("Car", &rows.iter().collect::<Vec<_>>(), &wording);
        let [Block::Table(pairs), Block::Table(rest)] = &blocks[..] else { panic!("{blocks:?}") };
        assert_eq!(pairs.caption, format!("Car; given: {sheet}"));
        assert_eq!(pairs.rows, [["a", "a kg", "b", "b kg"], ["c", "c kg", "d", "d kg"]]);
        assert_eq!(rest.rows[0], ["e", "e kg", "given", "weighed on a scale"]);
        assert_eq!(rest.rows[1], ["f", long, "given", sheet]);
    }

    #[test]
    fn what_nobody_changed_is_one_sentence() {
        let wording = Wording::english(UnitSystem::Si);
        let rows = ["a", "b"].map(|label| row(label, wording.words.source_program));
        let block = left_as_they_are(&rows.iter().collect::<Vec<_>>(), &wording);
        let Block::Paragraph { text } = &block else { panic!("{block:?}") };
        assert!(text.contains("car: a a kg, b b kg"), "{text}");
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
