//! Rows of numbers below a header that are no samples: the numbers of the columns above the first one, and the sums of
//! the columns below the last one, as spreadsheets have them.

use std::collections::BTreeMap;

use crate::data::{Channel, ColumnUse, DataError, Table};

/// Columns from which a row of their numbers is one, and rows from which another one may have their sums.
const LEAST_COLUMNS: usize = 3;
const LEAST_ROWS: usize = 6;
/// How much later than the row before it a row of sums is at least, in steps of the rows above.
const LEAST_STEPS: f64 = 3.0;
/// Rounding of a sum, as a share of the sizes that are added up.
const ROUNDING: f64 = 1e-4;

/// Refuses a table with such a row, which would be read as a sample.
///
/// # Errors
/// [`DataError::Contradiction`] with its line.
pub(super) fn check(
    table: &Table,
    columns: &BTreeMap<Channel, ColumnUse>,
) -> Result<(), DataError> {
    let (line, what) = match (has_column_numbers(table), has_sums(table, columns)) {
        (true, _) => (table.line(0), "the numbers of the columns"),
        (false, true) => (table.line(table.n_rows() - 1), "the sums of the rows above"),
        (false, false) => return Ok(()),
    };
    let what = format!("line {line} has {what} and is no sample: remove it");
    Err(DataError::Contradiction { path: table.path().to_owned(), what })
}

/// Whether the first row has the numbers of the columns, unlike the second in whole numbers.
fn has_column_numbers(table: &Table) -> bool {
    let n_columns = table.header().len();
    let is_number = |idx: usize| table.cell(0, idx) == (idx + 1).to_string();
    let is_whole = |idx: usize| {
        let cell = table.cell(1, idx);
        !cell.is_empty() && cell.bytes().all(|byte| byte.is_ascii_digit())
    };
    table.has_header()
        && n_columns >= LEAST_COLUMNS
        && table.n_rows() > 1
        && (0..n_columns).all(is_number)
        && !(0..n_columns).all(is_whole)
}

/// Whether the last row has the sums of the time and of another column.
fn has_sums(table: &Table, columns: &BTreeMap<Channel, ColumnUse>) -> bool {
    let Some(n_above) = table.n_rows().checked_sub(1).filter(|n| *n >= LEAST_ROWS) else {
        return false;
    };
    let numbers = |column: &ColumnUse| -> Option<Vec<f64>> {
        let idx = column.terms.first()?.number.checked_sub(1)?;
        (0..=n_above).map(|row| table.number(row, idx)).collect()
    };
    let is_sum = |numbers: &[f64]| {
        let above = numbers.iter().take(n_above);
        let size: f64 = above.clone().map(|number| number.abs()).sum();
        let sum: f64 = above.sum();
        size > 0.0 && numbers.last().is_some_and(|last| (last - sum).abs() <= ROUNDING * size)
    };
    let Some(times) = columns.get(&Channel::Time).and_then(numbers) else { return false };
    let [first, before, last] = [times[0], times[n_above - 1], times[n_above]];
    let step = (before - first) / (n_above - 1) as f64;
    let is_late = last - before > LEAST_STEPS * step;
    let others = || columns.values().filter(|column| column.channel != Channel::Time);
    is_late && is_sum(&times) && others().filter_map(numbers).any(|numbers| is_sum(&numbers))
}

#[cfg(test)]
mod tests {
    use crate::data::read_any_series;

    /// What is said of a force over time, in seven rows.
    ///
    /// - `first`, `last`: rows above and below them.
    fn said(first: &str, last: &str) -> Option<String> {
        let row = |i: u32| format!("{},{},{}\n", 0.05 * f64::from(i), 100 * i, 2.5 * f64::from(i));
        let rows: String = (3..10).map(row).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f.csv");
        std::fs::write(&path, format!("time [s],fx [N],fy [N]\n{first}{rows}{last}")).unwrap();
        read_any_series(&path, None).err().map(|error| error.to_string())
    }

    #[test]
    fn a_row_of_column_numbers_and_a_row_of_sums_are_refused() {
        assert_eq!(said("", ""), None);
        assert_eq!(said("0.1,2,3\n", "2.1,700,1\n"), None);
        let numbers = said("1,2,3\n0.1,0,0\n", "").unwrap();
        assert!(numbers.contains("line 2 has the numbers of the columns"), "{numbers}");
        let sums = said("", "2.1,4200,105\n").unwrap();
        assert!(sums.contains("line 9 has the sums of the rows above"), "{sums}");
    }
}
