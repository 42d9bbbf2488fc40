//! Cells of an atlas in words, in the units of the reader.

use impactlab_core::units::{NumberFormat, Quantity, UnitSystem, significant};
use impactlab_sweep::atlas::{MIN_ROWS, Measure, SliceCell};

/// What a map is, and what it is not: beside every map.
pub const LEGEND: &str = "A model study, not validated by any measured PIT: it shows how often the model computes an outcome. No cell of it is a safe speed.";

/// What a cell says of an outcome, with its Monte Carlo error and the number of its runs.
pub fn cell_text(measure: Measure, cell: &SliceCell, units: UnitSystem) -> String {
    let label = measure.label();
    let n_rows = cell.n_rows;
    let Some(mean) = cell.mean else {
        return format!(
            "{label}: not told, as {} of {n_rows} runs have it, and at least {MIN_ROWS} are needed",
            cell.n_applies
        );
    };
    let format = NumberFormat::english(units);
    let value = match Quantity::from_si_symbol(measure.unit()) {
        _ if measure.is_probability() => format.chance(mean, Some(cell.error)),
        Some(quantity) => format.measured(quantity, mean, cell.error),
        None => format!("{} ± {}", significant(mean), significant(cell.error)),
    };
    let failed = match cell.n_failed {
        0 => String::new(),
        n => format!(", {n} more have no answer"),
    };
    let inside = format.percent(cell.inside);
    format!("{label}: {value} in {n_rows} runs{failed}; both networks apply in {inside} of them")
}
