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
    let of = match cell.n_applies == n_rows {
        true => String::new(),
        false => format!("{} of ", cell.n_applies),
    };
    let inside = format.percent(cell.inside);
    let doubt = match (cell.is_sound(), cell.at_rest < 1.0) {
        (true, _) => String::new(),
        (false, false) => "; not to be relied upon".to_owned(),
        (false, true) => {
            let rest = format.percent(cell.at_rest);
            format!("; not to be relied upon: {rest} come to rest in the time that is computed")
        }
    };
    format!(
        "{label}: {value} in {of}{n_rows} runs{failed}; both networks apply in {inside} of them{doubt}"
    )
}
