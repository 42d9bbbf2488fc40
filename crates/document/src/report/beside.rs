//! What several variants say, beside each other: each text once with those who say it, tables of the same
//! kind as one table.

use crate::report::numbers::{Wording, fill};
use crate::report::{Block, Column, Table};

/// Variants that stand beside each other in one table.
const MOST_BESIDE: usize = 4;

/// What stands where a variant does not have a row.
const MISSING: &str = "–";

/// Rows of a table with a value each, by their names.
pub(super) type NamedRows = Vec<[String; 2]>;

/// What one variant says.
#[derive(Debug, Clone)]
pub(super) struct Said<'a> {
    /// The variant.
    pub name: &'a str,
    /// What it says.
    pub blocks: Vec<Block>,
}

/// Variants that say the same, and what they say.
struct Speaker {
    names: Vec<String>,
    blocks: Vec<Block>,
}

/// What some of the variants say in one place.
enum Entry<'a> {
    /// The same block, which is no table.
    Text(&'a Block, Vec<usize>),
    /// Tables with one caption and the same columns.
    Tables(Vec<(usize, &'a Table)>),
}

impl<'a> Entry<'a> {
    fn new(who: usize, block: &'a Block) -> Self {
        match block {
            Block::Table(table) => Self::Tables(vec![(who, table)]),
            other => Self::Text(other, vec![who]),
        }
    }

    fn is_warning(&self) -> bool {
        matches!(self, Self::Text(Block::Notice { .. }, _))
    }

    /// Takes a block of one more variant, if it is said in this place.
    fn takes(&mut self, who: usize, block: &'a Block) -> bool {
        match (self, block) {
            (Self::Tables(tables), Block::Table(table)) => {
                let (_, first) = tables[0];
                let is_new = tables.iter().all(|(of, _)| *of != who);
                let is_alike = (&first.caption, &first.columns) == (&table.caption, &table.columns);
                if is_new && is_alike {
                    tables.push((who, table));
                }
                is_new && is_alike
            }
            (Self::Text(text, holders), block) if *text == block && !holders.contains(&who) => {
                holders.push(who);
                true
            }
            _ => false,
        }
    }
}

/// What variants say to one question: each sentence once, with the names of those who say it unless all
/// do; tables of values with a column for each, other tables below each other with the names in a column.
pub(super) fn beside_each_other(said: &[Said<'_>], wording: &Wording) -> Vec<Block> {
    let mut columns: Vec<Speaker> = Vec::new();
    for Said { name, blocks } in said {
        match columns.iter_mut().find(|column| column.blocks == *blocks) {
            Some(same) => same.names.push((*name).to_owned()),
            None => {
                columns.push(Speaker { names: vec![(*name).to_owned()], blocks: blocks.clone() });
            }
        }
    }
    merged(&columns, wording)
}

/// The blocks of all variants as those of one.
fn merged(columns: &[Speaker], wording: &Wording) -> Vec<Block> {
    if let [only] = columns {
        return only.blocks.clone();
    }
    let mut entries: Vec<Entry<'_>> = Vec::new();
    for (who, column) in columns.iter().enumerate() {
        // New blocks stand behind that which they follow in their own variant.
        let mut next = 0;
        for block in &column.blocks {
            let known = entries.iter_mut().enumerate().skip(next);
            let taken = { known }.find_map(|(at, entry)| entry.takes(who, block).then_some(at));
            let at = taken.unwrap_or_else(|| {
                // What a variant says below its warnings divides no warnings of the others.
                let is_warning = |entry: &&Entry<'_>| entry.is_warning();
                let others = match block {
                    Block::Notice { .. } => 0,
                    _ => entries.iter().skip(next).take_while(is_warning).count(),
                };
                entries.insert(next + others, Entry::new(who, block));
                next + others
            });
            next = at + 1;
        }
    }
    let names = |holders: &mut dyn Iterator<Item = usize>| {
        let names = holders.filter_map(|who| columns.get(who)).flat_map(|it| it.names.clone());
        names.collect::<Vec<String>>().join(", ")
    };
    let mut blocks = Vec::new();
    for entry in entries {
        match entry {
            Entry::Text(block, holders) if holders.len() == columns.len() => {
                blocks.push(block.clone());
            }
            Entry::Text(block, holders) => {
                blocks.push(of(&names(&mut holders.into_iter()), block));
            }
            Entry::Tables(tables) => {
                let are_all = tables.len() == columns.len();
                let named: Vec<(String, &Table)> = tables
                    .into_iter()
                    .map(|(who, table)| (names(&mut std::iter::once(who)), table))
                    .collect();
                blocks.extend(one_table(&named, are_all, wording));
            }
        }
    }
    blocks
}

/// A block that only some variants have, with their names.
fn of(names: &str, block: &Block) -> Block {
    let named = |text: &String| format!("{names}: {text}");
    match block {
        Block::Paragraph { text } => Block::paragraph(named(text)),
        Block::Notice { text } => Block::notice(named(text)),
        Block::List { items } => Block::List { items: items.iter().map(named).collect() },
        other => other.clone(),
    }
}

/// Tables with the same caption and columns as one. What all of them say alike stands below it.
fn one_table(tables: &[(String, &Table)], are_all: bool, wording: &Wording) -> Vec<Block> {
    let mut different: Vec<(String, &Table)> = Vec::new();
    for (name, table) in tables {
        match different.iter_mut().find(|(_, known)| known == table) {
            Some((names, _)) => names.push_str(&format!(", {name}")),
            None => different.push((name.clone(), table)),
        }
    }
    let (names, first) = match different.first() {
        Some((names, first)) => (names, *first),
        None => return Vec::new(),
    };
    if different.len() == 1 {
        let caption = match are_all {
            true => first.caption.clone(),
            false => format!("{names}: {}", first.caption),
        };
        return vec![Block::Table(Table { caption, ..first.clone() })];
    }
    let columns: Option<Vec<(String, NamedRows)>> =
        different.iter().map(|(name, table)| Some((name.clone(), named_rows(table)?))).collect();
    let Some(mut columns) = columns else {
        return vec![Block::Table(below_each_other(&different, wording))];
    };
    let alike = match are_all {
        true => taken_rows_alike(&mut columns),
        false => NamedRows::new(),
    };
    let caption = match has_intervals(first) {
        true => fill(wording.words.beside_intervals, &[("caption", &first.caption)]),
        false => first.caption.clone(),
    };
    let rows_title = first.columns.first().map_or("", |column| &column.title);
    let mut blocks = beside(&caption, [rows_title, ""], &columns, MISSING);
    blocks.extend(told_alike(&alike, wording));
    blocks
}

/// What every variant says alike, in a sentence; none where there is nothing.
pub(super) fn told_alike(alike: &[[String; 2]], wording: &Wording) -> Option<Block> {
    let each = alike.iter().map(|[name, value]| format!("{name}: {value}"));
    let each = each.collect::<Vec<_>>().join("; ");
    let told = || Block::paragraph(fill(wording.words.alike, &[("values", &each)]));
    (!alike.is_empty()).then(told)
}

/// Takes the rows out that every column has with the same value.
pub(super) fn taken_rows_alike(columns: &mut [(String, NamedRows)]) -> NamedRows {
    let Some(((_, first), others)) = columns.split_first() else { return NamedRows::new() };
    let is_alike = |row: &&[String; 2]| others.iter().all(|(_, rows)| rows.contains(*row));
    let alike: NamedRows = first.iter().filter(is_alike).cloned().collect();
    for (_, rows) in columns {
        rows.retain(|row| !alike.contains(row));
    }
    alike
}

/// Whether a table has medians with intervals of 50 and 90 %.
fn has_intervals(table: &Table) -> bool {
    let titles: Vec<&str> = table.columns.iter().map(|column| &*column.title).collect();
    matches!(titles[..], [_, _, half, most] if half.starts_with("50") && most.starts_with("90"))
}

/// Names and values of a table that has a value for each name, with its interval of 90 % if it has one;
/// none of other tables.
fn named_rows(table: &Table) -> Option<NamedRows> {
    let has_intervals = has_intervals(table);
    if table.columns.len() != 2 && !has_intervals {
        return None;
    }
    let mut rows: NamedRows = Vec::new();
    for row in &table.rows {
        let (name, value) = match &row[..] {
            [name, value] => (name, value.clone()),
            [name, median, _, most] if most.is_empty() => (name, median.clone()),
            [name, median, _, most] => (name, format!("{median} ({most})")),
            _ => return None,
        };
        if rows.iter().any(|[known, _]| known == name) {
            return None;
        }
        rows.push([name.clone(), value]);
    }
    Some(rows)
}

/// The rows of all tables, those of one name below each other, with the variant behind the name.
fn below_each_other(tables: &[(String, &Table)], wording: &Wording) -> Table {
    let (_, first) = &tables[0];
    let mut names: Vec<&String> = Vec::new();
    for name in tables.iter().flat_map(|(_, table)| &table.rows).filter_map(|row| row.first()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let of_each =
        tables.iter().flat_map(|(variant, table)| table.rows.iter().map(move |row| (variant, row)));
    let mut of_each: Vec<(&String, &Vec<String>)> = of_each.collect();
    // A share at the front is no name: rows of two variants that have the same one say nothing of each other.
    if !names.iter().any(|name| name.ends_with('%')) {
        let place = |row: &Vec<String>| names.iter().position(|name| Some(*name) == row.first());
        of_each.sort_by_key(|(_, row)| place(row));
    }
    let mut rows: Vec<(&Vec<String>, Vec<&str>)> = Vec::new();
    for (variant, row) in of_each {
        let is_of_others = |(known, of): &&mut (&Vec<String>, Vec<&str>)| {
            *known == row && of.iter().all(|name| name != variant)
        };
        match rows.iter_mut().find(is_of_others) {
            Some((_, of)) => of.push(variant),
            None => rows.push((row, vec![variant.as_str()])),
        }
    }
    let with_variants = |(row, of): (&Vec<String>, Vec<&str>)| {
        let mut row = row.clone();
        row.insert(1, of.join(", "));
        row
    };
    let rows = rows.into_iter().map(with_variants).collect();
    let mut columns = first.columns.clone();
    let title = wording.words.variant_column.to_owned();
    columns.insert(1.min(columns.len()), Column { title, is_numeric: false });
    Table { caption: first.caption.clone(), columns, rows }
}

/// Tables of what several variants say, a column for each; none without rows.
///
/// - `titles`: of the rows, and of the column of a single variant;
/// - `missing`: what stands where a variant does not have a row.
pub(super) fn beside(
    caption: &str,
    [rows_title, single]: [&str; 2],
    columns: &[(String, NamedRows)],
    missing: &str,
) -> Vec<Block> {
    let tables = columns.chunks(MOST_BESIDE).filter_map(|chunk| {
        let mut names: Vec<&String> = Vec::new();
        for [name, _] in chunk.iter().flat_map(|(_, rows)| rows) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let cell = |rows: &[[String; 2]], name: &str| {
            let found = rows.iter().find(|[of, _]| of == name);
            found.map_or(missing, |[_, value]| value).to_owned()
        };
        let row = |name: &&String| {
            let cells = chunk.iter().map(|(_, rows)| cell(rows, name));
            std::iter::once((*name).clone()).chain(cells).collect()
        };
        let rows: Vec<Vec<String>> = names.iter().map(row).collect();
        let title = |(name, _): &(String, _)| match columns.len() {
            1 => single.to_owned(),
            _ => name.clone(),
        };
        let titles = std::iter::once(rows_title.to_owned()).chain(chunk.iter().map(title));
        let columns = titles.map(|title| Column { title, is_numeric: false }).collect();
        let table = Table { caption: caption.to_owned(), columns, rows };
        (!names.is_empty()).then_some(Block::Table(table))
    });
    tables.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::UnitSystem;

    fn table(rows: &[[&str; 4]]) -> Block {
        let rows = rows.iter().map(|row| row.map(str::to_owned)).collect();
        Block::Table(Table::new("Motion", ["Quantity", "Median", "50 %", "90 %"], rows))
    }

    fn only_table(blocks: &[Block]) -> &Table {
        let tables: Vec<&Table> = blocks
            .iter()
            .filter_map(|block| match block {
                Block::Table(table) => Some(table),
                _ => None,
            })
            .collect();
        let [one] = tables[..] else { panic!("{tables:?}") };
        one
    }

    #[test]
    fn what_all_say_is_said_once_and_values_stand_beside_each_other() {
        let wording = Wording::english(UnitSystem::Si);
        let question = Block::paragraph("Where does it go?");
        let x = |at, range| table(&[["X", at, "", range], ["vehicle", "a car", "", ""]]);
        let warned = Block::notice("few draws");
        let says = |name, blocks| Said { name, blocks };
        let blocks = beside_each_other(
            &[
                says("coasts", vec![question.clone(), x("4 m", "3 to 5 m")]),
                says("brakes", vec![question.clone(), warned, x("2 m", "1 to 3 m")]),
                says("coasts again", vec![question.clone(), x("4 m", "3 to 5 m")]),
            ],
            &wording,
        );
        assert_eq!(blocks[..2], [question, Block::notice("brakes: few draws")]);
        assert_eq!(
            blocks[3..],
            [Block::paragraph("The same in each of these variants: vehicle: a car.")]
        );
        let table = only_table(&blocks);
        let titles: Vec<&str> = table.columns.iter().map(|column| &*column.title).collect();
        assert_eq!(titles, ["Quantity", "coasts, coasts again", "brakes"]);
        assert_eq!(table.rows, [["X", "4 m (3 to 5 m)", "2 m (1 to 3 m)"]]);
        assert!(table.caption.contains("90 %"), "{}", table.caption);
    }

    /// A table that one variant alone has stood between two warnings of the other one.
    #[test]
    fn warnings_of_all_stand_before_a_table_of_one() {
        let wording = Wording::english(UnitSystem::Si);
        let outside = Block::notice("outside");
        let x = |at| table(&[["X", at, "", "1 to 2 m"]]);
        let force = Block::Table(Table::new("Force", ["Quantity", "Value"], Vec::new()));
        let rests = vec![outside.clone(), Block::notice("few draws"), x("4 m")];
        let coasts = vec![outside.clone(), force, x("2 m")];
        let said = [Said { name: "rests", blocks: rests }, Said { name: "coasts", blocks: coasts }];
        let blocks = beside_each_other(&said, &wording);
        assert_eq!(blocks[..2], [outside, Block::notice("rests: few draws")], "{blocks:?}");
        assert!(matches!(&blocks[2], Block::Table(of) if of.caption == "coasts: Force"));
    }

    /// A table is divided where it has too many columns; no column loses the name of its variant.
    #[test]
    fn of_many_variants_each_has_its_name_and_texts_are_said_once() {
        let wording = Wording::english(UnitSystem::Si);
        let question = Block::paragraph("Where does it go?");
        let names = ["a", "b", "c", "d", "e"];
        let said: Vec<Said<'_>> = names
            .iter()
            .map(|name| {
                let blocks = vec![question.clone(), table(&[["X", name, "", "1 to 2 m"]])];
                Said { name, blocks }
            })
            .collect();
        let blocks = beside_each_other(&said, &wording);
        let [first, Block::Table(four), Block::Table(one)] = &blocks[..] else {
            panic!("{blocks:?}")
        };
        assert_eq!(*first, question);
        assert_eq!((four.columns.len(), one.columns.len()), (5, 2));
        assert_eq!(one.columns[1].title, "e");
        assert_eq!(one.rows, [["X", "e (1 to 2 m)"]]);
    }

    #[test]
    fn rows_without_names_of_their_own_stand_below_each_other_and_none_is_lost() {
        let wording = Wording::english(UnitSystem::Si);
        let marks = |lengths: &[&str]| {
            let row = |length: &&str| ["rear left".to_owned(), (*length).to_owned()];
            let rows = lengths.iter().map(row).collect();
            vec![Block::Table(Table::new("Marks", ["Wheel", "Length"], rows))]
        };
        let blocks = beside_each_other(
            &[
                Said { name: "coasts", blocks: marks(&["3 m", "1 m"]) },
                Said { name: "brakes", blocks: marks(&["7 m"]) },
            ],
            &wording,
        );
        let table = only_table(&blocks);
        assert_eq!(table.columns[1].title, "Variant");
        let rows: Vec<String> = table.rows.iter().map(|row| row.join(" ")).collect();
        assert_eq!(rows, ["rear left coasts 3 m", "rear left coasts 1 m", "rear left brakes 7 m"]);
        // What two of them have alike is one row.
        let said = |name, lengths: &[&str]| Said { name, blocks: marks(lengths) };
        let said = [said("coasts", &["3 m", "1 m"]), said("brakes", &["3 m"])];
        let blocks = beside_each_other(&said, &wording);
        let rows = &only_table(&blocks).rows;
        let rows: Vec<String> = rows.iter().map(|row| row.join(" ")).collect();
        assert_eq!(rows, ["rear left coasts, brakes 3 m", "rear left coasts 1 m"]);
    }

    /// A course of the second variant stood among those of the first, since both had the same probability.
    #[test]
    fn rows_that_begin_with_a_share_stay_with_those_of_their_variant() {
        let wording = Wording::english(UnitSystem::Si);
        let courses = |name, rows: [[&str; 2]; 2]| {
            let rows = rows.map(|row| row.map(str::to_owned)).into();
            let table = Table::new("Courses", ["Probability", "Impulse"], rows);
            Said { name, blocks: vec![Block::Table(table)] }
        };
        let said = [
            courses("coasts", [["4.7 %", "3.9 kN s"], ["4.7 %", "4.0 kN s"]]),
            courses("light", [["19.0 %", "3.0 kN s"], ["4.7 %", "3.6 kN s"]]),
        ];
        let blocks = beside_each_other(&said, &wording);
        let rows = only_table(&blocks).rows.iter().map(|row| row[1].clone());
        assert_eq!(rows.collect::<Vec<_>>(), ["coasts", "coasts", "light", "light"]);
    }
}
