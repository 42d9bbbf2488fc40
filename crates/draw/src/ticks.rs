//! Positions and labels of the ticks of an axis.

use egui_plot::{GridInput, GridMark};

/// Smallest distance of labelled ticks on the horizontal axis, in multiples of egui_plot's smallest
/// grid spacing (8 points).
pub const X_TICK_CELLS: f64 = 8.0;
/// Smallest distance of labelled ticks on the vertical axis, in the unit of [`X_TICK_CELLS`].
pub const Y_TICK_CELLS: f64 = 4.0;
/// Number of intervals into which grid lines without labels divide the distance between two ticks.
const MINOR_DIVISIONS: i64 = 5;
/// Smallest number of decades that a logarithmic axis must span to have ticks at powers of ten. An
/// axis that spans less has ticks at equal steps of the value.
const MIN_DECADES: f64 = 0.7;
/// Approximate number of ticks of a logarithmic axis that spans less than [`MIN_DECADES`].
const FEW_TICKS: f64 = 5.0;

/// Grid lines of a linear axis: ticks at multiples of 1, 2 or 5 times a power of ten, with fainter
/// lines between them.
///
/// - `tick_cells`: smallest distance of ticks, such as [`X_TICK_CELLS`].
pub fn grid(input: GridInput, tick_cells: f64) -> Vec<GridMark> {
    let tick = nice_step(input.base_step_size * tick_cells);
    let minor = tick / MINOR_DIVISIONS as f64;
    let (low, high) = input.bounds;
    if !(minor > 0.0 && (high - low) / minor < 1e4) {
        return Vec::new();
    }
    let indices = (low / minor).ceil() as i64..=(high / minor).floor() as i64;
    indices
        .map(|index| GridMark {
            value: index as f64 * minor,
            step_size: if index % MINOR_DIVISIONS == 0 { tick } else { minor },
        })
        .collect()
}

/// Grid lines of an axis that shows `log₁₀` of its values: ticks at powers of ten, and at 2 and 5
/// times these where there is room, with fainter lines between them. An axis of less than 0.7
/// decades has ticks at equal steps of the value.
pub fn log_grid(input: GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    if !(low.is_finite() && high.is_finite() && high > low && high - low < 300.0) {
        return Vec::new();
    }
    if high - low < MIN_DECADES {
        let (from, to) = (10.0_f64.powf(low), 10.0_f64.powf(high));
        let step = nice_step((to - from) / FEW_TICKS);
        let indices = (from / step).ceil() as i64..=(to / step).floor() as i64;
        let step_size = (high - low) / FEW_TICKS;
        let mark = |index: i64| GridMark { value: (index as f64 * step).log10(), step_size };
        return indices.filter(|index| *index > 0).map(mark).collect();
    }
    let decades = low.floor() as i32..=high.ceil() as i32;
    let marks = decades.flat_map(|decade| {
        (1..10).map(move |digit| GridMark {
            value: f64::from(decade) + f64::from(digit).log10(),
            step_size: match digit {
                1 => 1.0,
                2 | 5 => 0.3,
                _ => 0.05,
            },
        })
    });
    marks.filter(|mark| (low..=high).contains(&mark.value)).collect()
}

/// Grid lines of an axis of names, at the positions 0, 1, 2, ….
pub fn name_grid(n_names: usize) -> Vec<GridMark> {
    (0..n_names).map(|row| GridMark { value: row as f64, step_size: 1.0 }).collect()
}

/// The name at a tick; empty if there is none.
pub fn name_label(mark: GridMark, names: &[String]) -> String {
    let row = mark.value.round();
    let name = if row < 0.0 { None } else { names.get(row as usize) };
    name.cloned().unwrap_or_default()
}

/// The smallest number that is 1, 2 or 5 times a power of ten and not less than `wanted`.
fn nice_step(wanted: f64) -> f64 {
    let magnitude = 10.0_f64.powf(wanted.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * magnitude);
    steps.into_iter().find(|step| *step >= wanted).unwrap_or(wanted)
}

/// Label of a tick of a linear axis, with as many decimals as the distance of the ticks requires.
pub fn tick_label(mark: GridMark) -> String {
    let decimals = (-mark.step_size.log10().floor()).clamp(0.0, 9.0) as usize;
    let label = format!("{:.decimals$}", mark.value);
    let is_negative_zero = label.starts_with('-') && label.bytes().all(|b| b"-0.".contains(&b));
    if is_negative_zero { label.replace('-', "") } else { label }
}

/// Label of a tick of [`log_grid`]: the value whose logarithm the mark holds, with decimals up to
/// its third significant digit. Values below 1e-3 and from 1e5 upwards are in scientific notation
/// with one digit.
pub fn log_tick_label(mark: GridMark) -> String {
    let value = 10.0_f64.powf(mark.value);
    if !(1e-3..1e5).contains(&value) {
        return format!("{value:.0e}");
    }
    let decimals = (2 - value.log10().floor() as i32).clamp(0, 6) as usize;
    let label = format!("{value:.decimals$}");
    if label.contains('.') {
        label.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        label
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Labels of the ticks of a logarithmic axis whose step size exceeds `least_step`.
    fn labels(low: f64, high: f64, least_step: f64) -> Vec<String> {
        let bounds = (low.log10(), high.log10());
        let marks = log_grid(GridInput { bounds, base_step_size: 0.02 });
        marks.into_iter().filter(|mark| mark.step_size > least_step).map(log_tick_label).collect()
    }

    #[test]
    fn logarithmic_ticks_stand_at_round_values() {
        assert_eq!(
            labels(0.03, 30.0, 0.1),
            ["0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10", "20"]
        );
        assert_eq!(labels(1.05, 1.42, 0.0), ["1.1", "1.2", "1.3", "1.4"]);
        assert_eq!(labels(3e-5, 3e-3, 0.1), ["5e-5", "1e-4", "2e-4", "5e-4", "0.001", "0.002"]);
        assert!(log_grid(GridInput { bounds: (f64::NAN, 1.0), base_step_size: 1.0 }).is_empty());
    }

    #[test]
    fn plain_ticks_need_no_minus_before_zero() {
        assert_eq!(tick_label(GridMark { value: -1e-12, step_size: 0.5 }), "0.0");
        assert_eq!(tick_label(GridMark { value: 1.25, step_size: 0.05 }), "1.25");
    }
}
