//! How the columns of a table share its width, on paper and on the screen.

/// Widths of columns that together are the width of the table: what each would like, as far as all of
/// them fit; else what each needs at least, and the rest by how much is wanted.
///
/// - `wanted`: widths at which no text is broken;
/// - `least`: widths of the longest words;
/// - `width`: of the table, in the same unit.
pub fn column_widths(wanted: &[f32], least: &[f32], width: f32) -> Vec<f32> {
    let (all_wanted, all_least): (f32, f32) = (wanted.iter().sum(), least.iter().sum());
    if all_wanted <= width {
        // What is left over is shared alike.
        let more = (width - all_wanted) / wanted.len() as f32;
        return wanted.iter().map(|want| want + more).collect();
    }
    if all_least >= width {
        return least.iter().map(|need| need * width / all_least).collect();
    }
    // The root keeps one very long text from leaving nothing to the others.
    let hunger: Vec<f32> =
        wanted.iter().zip(least).map(|(want, need)| (want - need).max(0.0).sqrt()).collect();
    let all: f32 = hunger.iter().sum::<f32>().max(1e-6);
    let free = width - all_least;
    least.iter().zip(&hunger).map(|(need, hunger)| need + free * hunger / all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_fill_the_table_and_no_more() {
        for (wanted, least) in [
            (vec![50.0, 60.0], vec![20.0, 20.0]),
            (vec![900.0, 60.0, 80.0], vec![60.0, 50.0, 40.0]),
            (vec![900.0, 900.0, 900.0], vec![300.0, 300.0, 300.0]),
        ] {
            let widths = column_widths(&wanted, &least, 480.0);
            let sum: f32 = widths.iter().sum();
            assert!((sum - 480.0).abs() < 0.01, "{widths:?}");
            assert!(widths.iter().all(|width| *width > 20.0), "{widths:?}");
        }
    }
}
