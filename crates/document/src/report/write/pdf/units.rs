//! Units of columns: a unit that all cells of a column have stands once, in its title.

use crate::report::Table;
use crate::report::write::pdf::lines::is_symbol;

/// What stands where a row has no value.
const MISSING: &str = "–";

/// The table with the common unit of a column in its title and no longer in its cells.
pub(super) fn with_units_in_titles(table: &Table) -> Table {
    let mut table = table.clone();
    for (idx, column) in table.columns.iter_mut().enumerate().skip(1) {
        let cells = || table.rows.iter().filter_map(|row| row.get(idx));
        let valued: Vec<&String> =
            cells().filter(|cell| !cell.is_empty() && *cell != MISSING).collect();
        let unit = valued.first().and_then(|cell| Some(value_and_unit(cell)?.1.to_owned()));
        let Some(unit) = unit else { continue };
        let is_of_unit = |cell: &&String| value_and_unit(cell).is_some_and(|(_, it)| it == unit);
        let is_common = valued.len() > 1 && valued.iter().all(is_of_unit);
        // A sign of per cent takes no room, and many titles have one.
        if !is_common || unit == "%" || column.title.contains('[') {
            continue;
        }
        column.title = format!("{} [{unit}]", column.title);
        for cell in table.rows.iter_mut().filter_map(|row| row.get_mut(idx)) {
            if let Some((value, _)) = value_and_unit(cell) {
                *cell = value.to_owned();
            }
        }
    }
    table
}

/// A number or a place, and its unit.
fn value_and_unit(cell: &str) -> Option<(&str, &str)> {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '−');
    let (value, unit) = match cell.starts_with('(') {
        true => {
            let (place, unit) = cell.rsplit_once(") ")?;
            (cell.get(..place.len() + 1)?, unit)
        }
        false => cell.split_once(' ').filter(|(number, _)| number.chars().all(is_of_number))?,
    };
    let is_unit = !unit.is_empty()
        && unit
            .split(' ')
            .all(|part| is_symbol(part) && !part.ends_with([',', '.', ';', ':', ')']));
    is_unit.then_some((value, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_of_all_stands_in_the_title_and_others_stay() {
        let row = |cells: [&str; 4]| cells.map(str::to_owned);
        let rows = vec![
            row(["first", "18.70 km/h", "(5.27; 0.70) m", "1 s"]),
            row(["second", "–", "(25.48; -3.43) m", "1 m"]),
            row(["third", "-1.589 km/h", "(1; 2) m", "80.5 % ± 2.9 %"]),
        ];
        let table = with_units_in_titles(&Table::new("T", ["Phase", "Δv", "From", "Mixed"], rows));
        let titles: Vec<&str> = table.columns.iter().map(|column| &*column.title).collect();
        assert_eq!(titles, ["Phase", "Δv [km/h]", "From [m]", "Mixed"]);
        assert_eq!(table.rows[0], ["first", "18.70", "(5.27; 0.70)", "1 s"]);
        assert_eq!(table.rows[1], ["second", "–", "(25.48; -3.43)", "1 m"]);
        assert_eq!(table.rows[2], ["third", "-1.589", "(1; 2)", "80.5 % ± 2.9 %"]);
    }
}
