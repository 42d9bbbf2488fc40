//! Cells of an atlas in words, in the units of the reader.

use impactlab_core::units::{NumberFormat, Quantity, UnitSystem, significant};
use impactlab_sweep::atlas::{MIN_ROWS, Measure, SliceCell};

/// What a map is, and what it is not: beside every map.
pub const LEGEND: &str = "A model study, not validated by any measured PIT: it shows how often the model computes an outcome. No cell of it is a safe speed.";

/// What a cell says of an outcome, with its Monte Carlo error and the number of its runs.
pub fn cell_text(measure: Measure, cell: &SliceCell, units: UnitSystem) -> String {
    let label = measure.label();
    let n_rows = cell.n_rows;
    let quantity = Quantity::from_si_symbol(measure.unit());
    let format = NumberFormat::english(units);
    if let (None, Some(limit), Some(quantity)) = (cell.mean, cell.more_than, quantity) {
        let limit = format.value(quantity, limit);
        return format!("{label}: more than {limit} in {n_rows} runs{}", doubt(cell, &format));
    }
    let Some(mean) = cell.mean else {
        return format!(
            "{label}: not told, as {} of {n_rows} runs have it, and at least {MIN_ROWS} are needed",
            cell.n_applies
        );
    };
    let value = match quantity {
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
    let doubt = doubt(cell, &format);
    format!(
        "{label}: {value} in {of}{n_rows} runs{failed}; both networks apply in {inside} of them{doubt}"
    )
}

/// Why a number is not to be relied upon; empty if it is.
fn doubt(cell: &SliceCell, format: &NumberFormat) -> String {
    match (cell.is_sound(), cell.at_rest < 1.0) {
        (true, _) => String::new(),
        (false, false) => "; not to be relied upon".to_owned(),
        (false, true) => {
            let rest = format.percent(cell.at_rest);
            format!("; not to be relied upon: {rest} come to rest in the time that is computed")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// “361 of 361 runs have it, and at least 20 are needed” was told of a corridor beyond what is counted.
    #[test]
    fn a_corridor_beyond_what_is_counted_is_more_than_that() {
        let cell = SliceCell {
            n_rows: 361,
            n_failed: 0,
            n_applies: 361,
            mean: None,
            more_than: Some(60.0),
            error: f64::INFINITY,
            inside: 1.0,
            at_rest: 0.5,
        };
        let told = cell_text(Measure::CorridorWidth, &cell, UnitSystem::Si);
        assert!(told.contains("more than 60.00 m in 361 runs; not to be relied upon"), "{told}");
        let few = SliceCell { more_than: None, n_rows: 3, n_applies: 3, ..cell };
        let told = cell_text(Measure::CorridorWidth, &few, UnitSystem::Si);
        assert!(told.contains("at least 20 are needed"), "{told}");
    }
}
