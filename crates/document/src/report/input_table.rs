//! Tables of inputs with their sources.

use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use crate::report::{Block, InputClass, Table};

/// Rows with one source from which on it is said once, in the caption.
const MANY: usize = 4;

/// Characters of a value that stands beside another one.
const SHORT: usize = 24;

/// Characters of a value of the question that stands beside another one.
const BRIEF: usize = 40;

/// Rows of a group from which on it has a table of its own.
const OWN_TABLE: usize = 4;

/// The inputs of a variant: what question and evidence say, all in one table, then each large group in a
/// table of its own, small groups together, and a sentence of what was left as the program has it.
pub(super) fn input_tables(variant: &str, rows: &[&InputRow], wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let is_left = |row: &&InputRow| row.source == words.source_program;
    let (left, mut rest): (Vec<&InputRow>, Vec<&InputRow>) =
        rows.iter().copied().partition(is_left);
    let mut blocks = Vec::new();
    for (source, class) in [
        (words.source_question, InputClass::Given),
        (words.source_evidence, InputClass::Given),
        (words.source_evidence, InputClass::Measured),
    ] {
        let is_said = |row: &&InputRow| {
            (row.class, &*row.source) == (class, source) && row.value.chars().count() <= BRIEF
        };
        let (said, others): (Vec<&InputRow>, Vec<&InputRow>) = rest.into_iter().partition(is_said);
        rest = others;
        let caption = caption_of(variant, class, source, wording);
        blocks.extend((!said.is_empty()).then(|| said_table(&caption, &said, wording)));
    }
    let rest = merged(&rest, wording);
    let grouped = by_group(rest.iter());
    let (large, small): (Vec<_>, Vec<_>) =
        grouped.into_iter().partition(|(_, rows)| rows.len() >= OWN_TABLE);
    let caption =
        |groups: &str| fill(words.inputs_caption, &[("name", variant), ("group", groups)]);
    for (group, rows) in &large {
        blocks.extend(input_table(&caption(group), rows, wording));
    }
    match &small[..] {
        [] => {}
        [(group, rows)] => blocks.extend(input_table(&caption(group), rows, wording)),
        several => {
            let groups: Vec<&str> = several.iter().map(|(group, _)| *group).collect();
            blocks.push(groups_table(&caption(&groups.join("; ")), several, wording));
        }
    }
    blocks.extend((!left.is_empty()).then(|| left_as_they_are(&left, wording)));
    blocks
}

/// Rows with the group that they belong to.
type Group<'a> = (&'a str, Vec<&'a InputRow>);

/// The groups in the order in which they are first named.
fn by_group<'a>(rows: impl Iterator<Item = &'a InputRow>) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for row in rows {
        match groups.iter_mut().find(|(group, _)| *group == row.group) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((&row.group, vec![row])),
        }
    }
    groups
}

/// Rows in which what was assumed alike, or is not used, for the same reason, stands once with all values.
fn merged(rows: &[&InputRow], wording: &Wording) -> Vec<InputRow> {
    let found_out = [wording.words.inputs_assumed, wording.words.inputs_not_used];
    let mut merged: Vec<InputRow> = Vec::new();
    for row in rows {
        let is_alike = |known: &&mut InputRow| {
            found_out.contains(&known.group.as_str())
                && (&known.group, &known.label, known.class, &known.source)
                    == (&row.group, &row.label, row.class, &row.source)
        };
        match merged.iter_mut().find(is_alike) {
            Some(known) => known.value = format!("{}; {}", known.value, row.value),
            None => merged.push((*row).clone()),
        }
    }
    merged
}

/// What is said without more: names and values, two in a row, behind what they belong to.
fn said_table(caption: &str, rows: &[&InputRow], wording: &Wording) -> Block {
    let words = wording.words;
    let within = format!("{}, ", wording.key("scenario"));
    let mut cells: Vec<[String; 5]> = Vec::new();
    for (group, rows) in by_group(rows.iter().copied()) {
        let of = group.strip_prefix(&*within).unwrap_or(group);
        let pairs = rows.chunks(2).map(pair_cells).enumerate();
        // What the rows belong to stands in the first of them.
        cells.extend(pairs.map(|(idx, [label, value, other, its_value])| {
            let of = if idx == 0 { of } else { "" };
            [of.to_owned(), label, value, other, its_value]
        }));
    }
    let (quantity, value) = (words.quantity, words.value);
    let is_single = |[_, _, _, other, _]: &[String; 5]| other.is_empty();
    if cells.iter().all(is_single) {
        let cells = cells.into_iter().map(|[of, label, value, ..]| [of, label, value]).collect();
        return Block::Table(Table::new(caption, [words.holds_for, quantity, value], cells));
    }
    let columns = [words.holds_for, quantity, value, quantity, value];
    Block::Table(Table::new(caption, columns, cells))
}

/// Several groups in one table.
fn groups_table(caption: &str, groups: &[Group<'_>], wording: &Wording) -> Block {
    let words = wording.words;
    let cells = groups.iter().flat_map(|(group, rows)| {
        rows.iter().map(move |row| {
            let class = class_name(row.class, wording).to_owned();
            let [label, value] = [&row.label, &row.value].map(String::clone);
            [(*group).to_owned(), label, value, class, row.source.clone()]
        })
    });
    let columns = [words.holds_for, words.quantity, words.value, words.class, words.source];
    Block::Table(Table::new(caption, columns, cells.collect()))
}

/// A table of inputs. Short values that many rows have from one source stand two in a row, and the source
/// in the caption.
fn input_table(caption: &str, rows: &[&InputRow], wording: &Wording) -> Vec<Block> {
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
fn left_as_they_are(rows: &[&InputRow], wording: &Wording) -> Block {
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
    let rows = rows.chunks(2).map(pair_cells).collect();
    let [quantity, value] = [wording.words.quantity, wording.words.value];
    Block::Table(Table::new(caption, [quantity, value, quantity, value], rows))
}

/// The cells of one row or of two beside each other.
fn pair_cells(pair: &[&InputRow]) -> [String; 4] {
    let cells = |row: &&InputRow| [row.label.clone(), row.value.clone()];
    let [first, second] = [pair.first().map(cells), pair.get(1).map(cells)];
    let [label, value] = first.unwrap_or_default();
    let [other_label, other_value] = second.unwrap_or_default();
    [label, value, other_label, other_value]
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

    /// Each group had a table of its own, of two rows and a heading.
    #[test]
    fn what_the_question_says_is_one_table_and_small_groups_are_another() {
        let wording = Wording::english(UnitSystem::Si);
        let asked = wording.words.source_question;
        let of = |group: &str, row: InputRow| InputRow { group: group.to_owned(), ..row };
        let mut rows: Vec<InputRow> = ["a", "b", "c"].map(|label| row(label, asked)).into();
        rows.push(of("scenario, road", row("d", asked)));
        rows.push(of("tires", row("e", "a test")));
        rows.push(of("brakes", row("f", "another test")));
        rows.extend(["g", "h", "i", "j"].map(|label| of("sheet", row(label, "a rule"))));
        let blocks = input_tables("coasts", &rows.iter().collect::<Vec<_>>(), &wording);
        let [Block::Table(said), Block::Table(sheet), Block::Table(small)] = &blocks[..] else {
            panic!("{blocks:?}")
        };
        assert!(said.caption.contains("question"), "{}", said.caption);
        assert_eq!(
            said.rows,
            [
                ["car", "a", "a kg", "b", "b kg"],
                ["", "c", "c kg", "", ""],
                ["road", "d", "d kg", "", ""]
            ]
        );
        assert_eq!(sheet.rows, [["g", "g kg", "h", "h kg"], ["i", "i kg", "j", "j kg"]]);
        assert_eq!(small.caption, "coasts: tires; brakes");
        assert_eq!(small.rows[1], ["brakes", "f", "f kg", "given", "another test"]);
    }

    /// Two titles stood above columns in which nothing was.
    #[test]
    fn no_column_is_empty_below_its_title() {
        let wording = Wording::english(UnitSystem::Si);
        let of = |group: &str, label: &str| InputRow {
            group: group.to_owned(),
            ..row(label, wording.words.source_question)
        };
        let rows = [of("car", "a"), of("road", "b")];
        let block = said_table("said", &rows.iter().collect::<Vec<_>>(), &wording);
        let Block::Table(table) = &block else { panic!("{block:?}") };
        assert_eq!(table.columns.len(), 3);
        assert_eq!(table.rows, [["car", "a", "a kg"], ["road", "b", "b kg"]]);
    }

    #[test]
    fn what_is_assumed_for_one_reason_stands_once() {
        let wording = Wording::english(UnitSystem::Si);
        let unused = |value: &str| InputRow {
            group: wording.words.inputs_not_used.to_owned(),
            value: value.to_owned(),
            ..row("not used", "the network knows it")
        };
        let rows = [unused("restitution"), unused("friction limit")];
        let merged = merged(&rows.iter().collect::<Vec<_>>(), &wording);
        assert_eq!(merged, [unused("restitution; friction limit")]);
    }
}
