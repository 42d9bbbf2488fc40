//! Export of the numbers of a figure as CSV.

use std::io::Write;

use crate::figure::{Figure, FigureElement};

/// Writes the numbers of a figure as CSV in drawing order. The columns are `series` and the two
/// axes under their own labels and units; each point is a row. A band gives two series, `(low)` and
/// `(high)`; a vertical line gives a row without y; a heat map gives a row for each cell whose
/// value is positive, with the value in the name of the series.
///
/// # Errors
/// [`csv::Error`] if the writer fails.
pub fn write_figure_csv(figure: &Figure, writer: impl Write) -> Result<(), csv::Error> {
    let mut csv = csv::Writer::from_writer(writer);
    csv.write_record(["series", &figure.x.text(), &figure.y.text()])?;
    for element in &figure.elements {
        match element {
            FigureElement::Line(series)
            | FigureElement::Points(series)
            | FigureElement::Polygon(series)
            | FigureElement::Arrow(series) => {
                for [x, y] in &series.points {
                    csv.write_record([&series.name, &x.to_string(), &y.to_string()])?;
                }
            }
            FigureElement::HeatMap(map) => {
                for (i, value) in map.values.iter().enumerate().filter(|(_, v)| **v > 0.0) {
                    let [column, row] = [i % map.size[0].max(1), i / map.size[0].max(1)];
                    let [x, y] = [
                        map.low[0] + column as f64 * map.step[0],
                        map.low[1] + row as f64 * map.step[1],
                    ];
                    let name = format!("{} ({value:.6e})", map.name);
                    csv.write_record([&name, &x.to_string(), &y.to_string()])?;
                }
            }
            FigureElement::Band(band) => {
                for (edge, values) in [("low", &band.low), ("high", &band.high)] {
                    let name = format!("{} ({edge})", band.name);
                    for (x, y) in band.x.iter().zip(values) {
                        csv.write_record([&name, &x.to_string(), &y.to_string()])?;
                    }
                }
            }
            FigureElement::VerticalLine { name, x, .. } => {
                csv.write_record([name, &x.to_string(), ""])?;
            }
        }
    }
    csv.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{Axis, Role};
    use crate::units::{Quantity, UnitSystem};

    #[test]
    fn the_file_says_units_and_repeats_the_numbers() {
        let figure = Figure {
            title: "t".to_owned(),
            x: Axis::shown("Time", Quantity::Time, UnitSystem::Si),
            y: Axis::shown("Force", Quantity::Force, UnitSystem::Si),
            equal_aspect: false,
            log_y: false,
            elements: vec![
                FigureElement::line("F_x, raw", Role::ComponentX, vec![[0.0, 1.5], [0.1, -2.0]]),
                FigureElement::VerticalLine {
                    name: "start".to_owned(),
                    role: Role::Muted,
                    x: 0.05,
                },
            ],
        };
        let mut text = Vec::new();
        write_figure_csv(&figure, &mut text).unwrap();
        let expected =
            "series,Time [s],Force [kN]\n\"F_x, raw\",0,1.5\n\"F_x, raw\",0.1,-2\nstart,0.05,\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }
}
