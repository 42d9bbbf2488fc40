//! Numbers that stand for no value, as loggers and other programs write them: nines, and the largest whole numbers that
//! they can store.
//!
//! Such a number is far from those in the rows beside it; one that a curve passes, or at which a sensor is at its limit,
//! is not.

use std::collections::BTreeMap;

use crate::data::error::quoted;
use crate::data::{Channel, ColumnUse, Note, Table, TimeSeries};

/// Sizes of such numbers as they are written: nines, and the largest whole numbers of 16 and 32 bits.
const SIZES: [f64; 8] =
    [9999.0, 99_999.0, 999_999.0, 32_767.0, 32_768.0, 65_535.0, 2_147_483_647.0, 4_294_967_295.0];

/// How far such a number is at least from one beside it, as a share of its size.
const APART: f64 = 0.5;

/// By how much a number may differ from one of them after its conversion, as a share of it.
const ROUNDING: f64 = 1e-9;

/// What is said of columns with such numbers.
pub(super) fn notes(
    table: &Table,
    by_channel: &BTreeMap<Channel, ColumnUse>,
    series: &TimeSeries,
) -> impl Iterator<Item = Note> {
    by_channel.values().filter_map(move |column| note(table, column, series.get(column.channel)?))
}

fn note(table: &Table, column: &ColumnUse, values: &[f64]) -> Option<Note> {
    let [term] = column.terms[..] else { return None };
    let size_of = |value: &f64| {
        let written = value.abs() / term.unit.si_per_unit;
        SIZES.into_iter().find(|size| (written / size - 1.0).abs() < ROUNDING)
    };
    let first = values.iter().position(|value| size_of(value).is_some())?;
    let size = size_of(values.get(first)?)?;
    let is_it = |value: &f64| size_of(value) == Some(size);
    let apart = APART * size * term.unit.si_per_unit;
    let mut steps = values.windows(2).filter(|pair| is_it(&pair[0]) != is_it(&pair[1]));
    steps.all(|pair| (pair[1] - pair[0]).abs() > apart).then(|| Note::Doubt {
        text: format!(
            "column {} {} has {} in {} rows, the first of them line {}, far from the numbers beside: in many files it \
             stands for no value; remove these rows if it does here",
            column.number,
            quoted(&column.name),
            quoted(&table.cell(first, term.number.saturating_sub(1))),
            values.iter().filter(|value| is_it(value)).count(),
            table.line(first)
        ),
    })
}

#[cfg(test)]
mod tests {
    use crate::data::read_any_series;

    /// What is said of a pulse of 100 ms whose force along x is changed.
    fn said(unit: &str, change: impl Fn(usize, f64) -> f64) -> String {
        let row = |i: usize| {
            let force = 150.0 * (std::f64::consts::PI * i as f64 / 100.0).sin();
            format!("{},{:.1},0\n", 0.001 * i as f64, change(i, force))
        };
        let rows: String = (0..=100).map(row).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pulse.csv");
        std::fs::write(&path, format!("time [s],fx [{unit}],fy [{unit}]\n{rows}")).unwrap();
        let notes = read_any_series(&path, None).unwrap().notes;
        notes.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    }

    /// Three such rows in a pulse of 150 kN passed for forces: no check of a single sample sees them.
    #[test]
    fn numbers_that_stand_for_no_value_are_said() {
        assert!(!said("kN", |_, force| force).contains("stands for no value"));
        for none in [-9999.0, 65_535.0, 32_767.0] {
            let text = said("N", |i, force| match (40..43).contains(&i) {
                true => none,
                false => 1000.0 * force,
            });
            let rows = format!("\"{none:.1}\" in 3 rows, the first of them line 42");
            assert!(text.contains(&rows), "{text}");
        }
        // A column that has no other number.
        assert!(said("N", |_, _| 9999.0).contains("in 101 rows"));
    }

    #[test]
    fn a_curve_that_passes_such_a_number_is_none() {
        // The 40th row is 9999 N among rows that rise by some 100 N, and a sensor stays at its limit.
        let passing = said("N", |i, _| 9999.0 + 100.0 * (i as f64 - 40.0));
        assert!(!passing.contains("stands for no value"), "{passing}");
        let limited = said("N", |_, force| (1000.0 * force).min(65_535.0));
        assert!(!limited.contains("stands for no value"), "{limited}");
    }
}
