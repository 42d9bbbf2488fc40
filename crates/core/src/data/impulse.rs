//! Columns that hold the impulse of a force up to each instant in place of the force.

use crate::data::columns::{ColumnUse, open_question};
use crate::data::{Channel, ColumnMap, ColumnSource, DataError, Table, TimeSeries};
use crate::units::Quantity;

/// Size at the start of a curve up to which it begins at zero, as a share of the largest.
const BEGINNING: f64 = 0.05;
/// Size at its end from which it has not come back, as a share of the largest.
const END: f64 = 0.9;
/// Share of the rows at the end, over which such a curve hardly changes, and by how much of the largest.
const PLATEAU: f64 = 0.1;
const STEADY: f64 = 0.05;
/// Length of the curve over the distance of its ends up to which it goes one way.
const ONE_WAY: f64 = 1.2;

/// The two components of a force.
const COMPONENTS: [[Channel; 2]; 2] =
    [[Channel::Fx, Channel::Fy], [Channel::FxBody, Channel::FyBody]];

/// The force of which a column holds the impulse, N: the change over two steps.
pub(super) fn rate_n(impulse_n_s: &[f64], time_s: &[f64]) -> Vec<f64> {
    let last = impulse_n_s.len().saturating_sub(1);
    let rate = |i: usize| {
        let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
        match to > from {
            true => (impulse_n_s[to] - impulse_n_s[from]) / (time_s[to] - time_s[from]),
            false => 0.0,
        }
    };
    (0..impulse_n_s.len().min(time_s.len())).map(rate).collect()
}

/// Asks whether a force of unstated unit is an impulse: a curve that rises from zero, never comes back and
/// hardly changes at its end.
///
/// # Errors
/// [`DataError::Open`] with a map that takes it as one.
pub(super) fn check_force(
    table: &Table,
    series: &TimeSeries,
    columns: &[&ColumnUse],
    map: Option<&ColumnMap>,
) -> Result<(), DataError> {
    for [x, y] in COMPONENTS {
        let used: Vec<&&ColumnUse> = columns
            .iter()
            .filter(|column| [x, y].contains(&column.channel) && column.number > 0)
            .collect();
        let (Some(fx), Some(fy)) = (series.get(x), series.get(y)) else { continue };
        if used.iter().any(|column| column.unit_is_stated) || !is_impulse(fx, fy) {
            continue;
        }
        let what = format!(
            "{} and {} rise to a value at which they stay, as an impulse does and no force of a collision; \
             name their unit, N s if they are impulses",
            x.label(),
            y.label()
        );
        let unit = Quantity::Impulse.si_unit();
        let answer = |column: &&&ColumnUse| {
            (column.channel, ColumnSource { unit: Some(unit), ..column.source() })
        };
        return Err(open_question(table, map, what, used.iter().map(answer)));
    }
    Ok(())
}

/// Whether a curve rises from zero, never comes back and hardly changes at its end.
pub(super) fn is_impulse(x: &[f64], y: &[f64]) -> bool {
    let n = x.len().min(y.len());
    let size = |i: usize| x[i].hypot(y[i]);
    let distance = |a: usize, b: usize| (x[b] - x[a]).hypot(y[b] - y[a]);
    let largest = (0..n).map(size).fold(0.0, f64::max);
    let Some(last) = n.checked_sub(1).filter(|_| largest > 0.0) else { return false };
    let late = last - (PLATEAU * last as f64) as usize;
    let length: f64 = (0..last).map(|i| distance(i, i + 1)).sum();
    size(0) < BEGINNING * largest
        && size(last) > END * largest
        && late < last
        && (late..last).all(|i| distance(i, last) < STEADY * largest)
        && length < ONE_WAY * distance(0, last)
}

/// Asks for the columns of a force that is zero throughout while columns without a name hold numbers, as
/// where a header is shifted against its rows.
///
/// # Errors
/// [`DataError::Open`] with the first of these columns.
pub(super) fn check_zero(
    table: &Table,
    series: &TimeSeries,
    columns: &[&ColumnUse],
    map: Option<&ColumnMap>,
) -> Result<(), DataError> {
    let is_zero = |channel| {
        series.get(channel).is_some_and(|values: &[f64]| values.iter().all(|value| *value == 0.0))
    };
    for components in COMPONENTS {
        let is_read =
            |column: &&&ColumnUse| components.contains(&column.channel) && column.terms.len() == 1;
        let used: Vec<&&ColumnUse> = columns.iter().filter(is_read).collect();
        let is_chosen = |channel| map.is_some_and(|map| map.get(channel).is_some());
        if !components.into_iter().all(is_zero) || components.into_iter().any(is_chosen) {
            continue;
        }
        let is_unnamed = |idx: &usize| {
            let name = table.header().get(*idx);
            name.is_some_and(|name| *name == format!("column {}", idx + 1))
                && (0..table.n_rows())
                    .any(|row_idx| table.number(row_idx, *idx).is_some_and(|number| number != 0.0))
        };
        let unnamed: Vec<usize> = (0..table.header().len()).filter(is_unnamed).collect();
        if unnamed.len() < components.len() {
            continue;
        }
        let numbers: Vec<String> = unnamed.iter().map(|idx| (idx + 1).to_string()).collect();
        let what = format!(
            "the columns of {} and {} are zero throughout, and columns {} hold numbers without a name; say \
             which are the force",
            components[0].label(),
            components[1].label(),
            numbers.join(", ")
        );
        let answers = components.iter().zip(&unnamed).map(|(channel, idx)| {
            let unit = used
                .iter()
                .find(|column| column.channel == *channel)
                .and_then(|column| column.source().unit);
            let column = crate::data::ColumnRef::Number(idx + 1);
            (*channel, ColumnSource { column, unit })
        });
        return Err(open_question(table, map, what, answers));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impulse_is_told_from_a_force() {
        let curve = |f: &dyn Fn(f64) -> f64| (0..=100).map(|i| f(f64::from(i) / 100.0)).collect();
        let pulse = |t: f64| (std::f64::consts::PI * (t / 0.7).clamp(0.0, 1.0)).sin();
        let summed =
            |t: f64| (1.0 - (std::f64::consts::PI * (t / 0.7).clamp(0.0, 1.0)).cos()) / 2.0;
        let cases: [(Vec<f64>, bool); 4] = [
            (curve(&summed), true),
            (curve(&pulse), false),
            // A force that is cut while it falls, and one that is constant.
            (curve(&|t| pulse(0.5 * t)), false),
            (curve(&|_| 1.0), false),
        ];
        for (i, (fy, expected)) in cases.into_iter().enumerate() {
            let fx: Vec<f64> = fy.iter().map(|fy| 0.25 * fy).collect();
            assert_eq!(is_impulse(&fx, &fy), expected, "case {i}");
        }
    }

    #[test]
    fn the_force_of_an_impulse_has_this_impulse() {
        let time_s: Vec<f64> = (0..=100).map(|i| f64::from(i) * 1e-3).collect();
        let impulse: Vec<f64> =
            time_s.iter().map(|t| 1000.0 * (t / 0.08).min(1.0).powi(2)).collect();
        let force = rate_n(&impulse, &time_s);
        let sum: f64 = force.windows(2).map(|pair| 5e-4 * (pair[0] + pair[1])).sum();
        assert!((sum - 1000.0).abs() < 1.0, "{sum}");
    }
}
