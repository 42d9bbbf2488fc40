//! Export of the numbers of a figure as CSV.

use std::io::Write;

use crate::figure::{Axis, Figure, FigureElement, Path};
use impactlab_core::data::RESTRICTIONS_COLUMN;
use impactlab_core::units::{Quantity, Unit, UnitSystem};

/// Writes the numbers of a figure as CSV in drawing order.
///
/// The columns are `series` and the two axes under their own labels and units; each point is a row. A
/// band gives two series, `(low)` and `(high)`; a vertical line gives a row without y; a heat map
/// gives a row for each point whose value is positive, and a map of cells one for the middle of each that
/// has a value, with the value and its unit in the name of the series. Two
/// columns follow in a plan with paths: time and heading of each of their points. What restricts the
/// figure is in the first row of a last column ([`RESTRICTIONS_COLUMN`]), if there is anything to
/// say.
///
/// # Errors
/// [`csv::Error`] if the writer fails.
pub fn write_figure_csv(figure: &Figure, writer: impl Write) -> Result<(), csv::Error> {
    let mut table = FigureTable::new(figure, writer)?;
    for element in &figure.elements {
        match element {
            FigureElement::Path(path) => table.path(path)?,
            FigureElement::Line(series)
            | FigureElement::Points(series)
            | FigureElement::Polygon(series)
            | FigureElement::Arrow(series) => {
                for [x, y] in &series.points {
                    table.row(&series.name, [*x, *y])?;
                }
            }
            FigureElement::HeatMap(map) => {
                for (i, value) in map.values.iter().enumerate().filter(|(_, v)| **v > 0.0) {
                    let [column, row] = [i % map.size[0].max(1), i / map.size[0].max(1)];
                    let at = [
                        map.low[0] + column as f64 * map.step[0],
                        map.low[1] + row as f64 * map.step[1],
                    ];
                    table.row(&format!("{} ({value:.6e} 1/m²)", map.name), at)?;
                }
            }
            FigureElement::CellMap(map) => {
                for ([low, high], value, is_hatched) in map.cells() {
                    let Some(value) = value else { continue };
                    let hatched = if is_hatched { ", hatched" } else { "" };
                    let name = format!("{} ({value} {}{hatched})", map.name, map.unit.symbol);
                    table.row(&name, [0, 1].map(|axis| 0.5 * (low[axis] + high[axis])))?;
                }
            }
            FigureElement::Band(band) => {
                for (edge, values) in [("low", &band.low), ("high", &band.high)] {
                    let name = format!("{} ({edge})", band.name);
                    for (x, y) in band.x.iter().zip(values) {
                        table.row(&name, [*x, *y])?;
                    }
                }
            }
            FigureElement::VerticalLine { name, x, .. } => {
                table.write(name, [x.to_string(), String::new()], [None; 2])?;
            }
        }
    }
    table.csv.flush()?;
    Ok(())
}

/// The table of a figure while it is written.
struct FigureTable<W: Write> {
    csv: csv::Writer<W>,
    /// Units of time and heading, if the table has columns for them.
    path_units: Option<[Unit; 2]>,
    /// Whether the table has a last column for the restrictions.
    is_restricted: bool,
    /// What that column holds in the next row.
    restrictions: String,
}

impl<W: Write> FigureTable<W> {
    /// Writes the header.
    fn new(figure: &Figure, writer: W) -> Result<Self, csv::Error> {
        let mut csv = csv::Writer::from_writer(writer);
        let has_paths =
            figure.elements.iter().any(|element| matches!(element, FigureElement::Path(_)));
        let path_axes = has_paths.then(|| {
            [("Time", Quantity::Time), ("Heading", Quantity::Angle)]
                .map(|(label, quantity)| Axis::shown(label, quantity, UnitSystem::Si))
        });
        let mut header = vec!["series".to_owned(), figure.x.column(), figure.y.column()];
        header.extend(path_axes.iter().flatten().map(Axis::text));
        let text = figure.caveats.text();
        header.extend(text.is_some().then(|| RESTRICTIONS_COLUMN.to_owned()));
        csv.write_record(&header)?;
        Ok(Self {
            csv,
            path_units: path_axes.map(|axes| axes.map(|axis| axis.unit)),
            is_restricted: text.is_some(),
            restrictions: text.unwrap_or_default(),
        })
    }

    fn row(&mut self, name: &str, at: [f64; 2]) -> Result<(), csv::Error> {
        self.write(name, at.map(|value| value.to_string()), [None; 2])
    }

    fn path(&mut self, path: &Path) -> Result<(), csv::Error> {
        for (i, at) in path.series.points.iter().enumerate() {
            let of_path = [&path.time_s, &path.yaw_rad].map(|values| values.get(i).copied());
            self.write(&path.series.name, at.map(|value| value.to_string()), of_path)?;
        }
        Ok(())
    }

    /// Writes a row.
    ///
    /// - `of_path`: time, s, and heading, rad, of the point of a path.
    fn write(
        &mut self,
        name: &str,
        [x, y]: [String; 2],
        of_path: [Option<f64>; 2],
    ) -> Result<(), csv::Error> {
        let mut row = vec![name.to_owned(), x, y];
        for (unit, value) in self.path_units.iter().flatten().zip(of_path) {
            row.push(value.map(|value| unit.from_si(value).to_string()).unwrap_or_default());
        }
        if self.is_restricted {
            row.push(std::mem::take(&mut self.restrictions));
        }
        self.csv.write_record(&row)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::figure::{HeatMap, LineStyle, Role, Series};
    use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};

    fn csv(figure: &Figure) -> String {
        let mut text = Vec::new();
        write_figure_csv(figure, &mut text).unwrap();
        String::from_utf8(text).unwrap()
    }

    fn force() -> Figure {
        let x = Axis::shown("Time", Quantity::Time, UnitSystem::Si);
        let y = Axis::shown("Force", Quantity::Force, UnitSystem::Si);
        let raw = vec![[0.0, 1.5], [0.1, -2.0]];
        let (name, role) = ("start".to_owned(), Role::Muted);
        let elements = vec![
            FigureElement::line("F_x, raw", Role::ComponentX, raw),
            FigureElement::VerticalLine { name, role, x: 0.05 },
        ];
        Figure::new("t", [x, y], elements)
    }

    #[test]
    fn the_file_says_units_and_repeats_the_numbers() {
        let expected =
            "series,Time [s],Force [kN]\n\"F_x, raw\",0,1.5\n\"F_x, raw\",0.1,-2\nstart,0.05,\n";
        assert_eq!(csv(&force()), expected);
    }

    #[test]
    fn what_restricts_a_figure_is_in_the_first_row_of_a_last_column() {
        let caveat = Caveat::new(CaveatKind::OutsideDomain, "mass is 9000, it learned 800 to 3000");
        let text = csv(&force().with_caveats(&Caveats::from(vec![caveat])));
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let expected = ["series", "Time [s]", "Force [kN]", "restrictions"];
        assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), expected);
        let column: Vec<String> =
            reader.records().map(|row| row.unwrap().get(3).unwrap().to_owned()).collect();
        let restriction = "warning: outside the domain: mass is 9000, it learned 800 to 3000";
        assert_eq!(column, [restriction, "", ""]);
    }

    /// A density of 0.25 stood beside places in feet, of which it is none.
    #[test]
    fn a_density_has_its_unit_whatever_the_axes_have() {
        let axis = |label| Axis::shown(label, Quantity::Length, UnitSystem::Us);
        let map = HeatMap {
            name: "density".to_owned(),
            role: Role::Model,
            low: [1.0, 2.0],
            step: [0.5, 0.5],
            size: [2, 1],
            values: Arc::new(vec![0.0, 0.25]),
        };
        let figure = Figure::new("t", [axis("X"), axis("Y")], vec![FigureElement::HeatMap(map)]);
        assert_eq!(csv(&figure), "series,X [ft],Y [ft]\ndensity (2.500000e-1 1/m²),1.5,2\n");
    }

    #[test]
    fn a_path_has_the_time_and_the_heading_of_each_point() {
        let axis = |label| Axis::shown(label, Quantity::Length, UnitSystem::Si);
        let (name, points) = ("recorded".to_owned(), vec![[0.0, 0.0], [1.0, 2.0]]);
        let (role, style) = (Role::Reference, LineStyle::Solid);
        let series = Series { name, role, style, points };
        let (time_s, yaw_rad) = (vec![0.0, 0.5], vec![0.0, std::f64::consts::FRAC_PI_2]);
        let cross = FigureElement::points("CG", Role::Muted, vec![[3.0, 4.0]]);
        let elements = vec![FigureElement::Path(Path { series, time_s, yaw_rad }), cross];
        let figure = Figure::new("t", [axis("X"), axis("Y")], elements).plan();
        let expected = "series,X [m],Y [m],Time [s],Heading [deg]\n\
                        recorded,0,0,0,0\nrecorded,1,2,0.5,90\nCG,3,4,,\n";
        assert_eq!(csv(&figure), expected);
    }
}
