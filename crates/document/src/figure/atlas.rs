//! Figures of the atlas: a map of two of its axes, and which input moves an outcome.

use std::io::Write;

use crate::figure::contours::contours;
use crate::figure::{Axis, CellMap, Figure, FigureElement, LineStyle, Role, Series};
use impactlab_core::data::RESTRICTIONS_COLUMN;
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};
use impactlab_core::units::{
    Phrase, PhraseValue, Quantity, Unit, UnitSystem, significant, trimmed,
};
use impactlab_sweep::atlas::{Atlas, Measure, Sensitivity, Slice, SliceCell};
use impactlab_sweep::{PitInput, UNKNOWNS};

/// Shares of the scale at which there are lines, and their styles.
const LINES: [(f64, LineStyle); 3] =
    [(0.25, LineStyle::Dotted), (0.5, LineStyle::Solid), (0.75, LineStyle::Dashed)];

/// Half the height of a bar of a total index, and of the one of first order in it, as shares of the
/// distance between two.
const HALF_BARS: [f64; 2] = [0.36, 0.18];

/// What a map of the atlas shows.
pub struct AtlasFigure<'a> {
    /// The atlas.
    pub atlas: &'a Atlas,
    /// Two of its axes by their numbers, horizontal and vertical.
    pub axes: [usize; 2],
    /// The bin of every axis that is held.
    pub held: &'a [Option<usize>],
    /// What is shown.
    pub measure: Measure,
    /// The case at hand along both axes, in SI units.
    pub case: Option<[f64; 2]>,
    /// Units of the axes and of the scale.
    pub units: UnitSystem,
    /// Names of the networks in use that are not those that computed the atlas.
    pub other_networks: &'a [String],
}

/// A map of the atlas: a colour for each cell, lines of equal value, and the case at hand. Cells with too
/// few rows, with ones that fail or are cut off before rest, and where the networks do not apply, are hatched.
pub fn atlas_figure(input: &AtlasFigure<'_>) -> Figure {
    let AtlasFigure { atlas, axes: [x, y], held, measure, case, units, other_networks } = *input;
    let slice = atlas.slice(x, y, held, measure);
    let [x_axis, y_axis] = [&slice.x, &slice.y].map(|axis| shown_axis(axis, units));
    let map = cell_map(&slice, measure, [&x_axis, &y_axis], units);
    let mut elements = lines_of(&map);
    if let Some(case) = case {
        let at = [x_axis.unit.from_si(case[0]), y_axis.unit.from_si(case[1])];
        elements.extend(cross(at, &map.edges));
    }
    elements.insert(0, FigureElement::CellMap(map));
    let title = title_of(atlas, [x, y], held, measure, units);
    Figure::new(title, [x_axis, y_axis], elements).with_caveats(&caveats(other_networks))
}

/// What restricts every map, in a line below it. Where that is too long, it is cut from its end, so that other
/// networks stand in its first clause.
fn caveats(other_networks: &[String]) -> Caveats {
    let [en, de] = match other_networks.is_empty() {
        true => [
            "a model study of the PIT, checked against no measured one; no speed in it is a safe speed.",
            "eine Modellstudie zum PIT, an keinem gemessenen geprüft; keine Geschwindigkeit darin ist eine \
             sichere.",
        ],
        false => [
            "a model study with other networks than those in use ({0}); no speed in it is safe. Checked \
             against no measured PIT.",
            "eine Modellstudie mit anderen Netzen als den verwendeten ({0}); keine Geschwindigkeit darin ist \
             eine sichere. An keinem gemessenen PIT geprüft.",
        ],
    };
    let text = Phrase::new(
        format!(
            "{en} Hatched: few rows, or ones that fail or are cut off before rest, or the networks do not \
             apply"
        ),
        format!(
            "{de} Schraffiert: wenige Rechnungen, oder solche, die scheitern oder vor dem Stillstand \
             abgeschnitten sind, oder die Netze gelten nicht"
        ),
    );
    let text = match other_networks.is_empty() {
        true => text,
        false => text.with(PhraseValue::Name(other_networks.join(", "))),
    };
    Caveats::from(vec![Caveat::new(CaveatKind::HardlyValidated, text)])
}

/// What is shown, and what is held.
fn title_of(
    atlas: &Atlas,
    axes: [usize; 2],
    held: &[Option<usize>],
    measure: Measure,
    units: UnitSystem,
) -> String {
    let each = atlas.axes.iter().zip(held).enumerate();
    let held: Vec<String> = each
        .filter(|(idx, _)| !axes.contains(idx))
        .filter_map(|(_, (axis, bin))| {
            let text = axis.bin_text((*bin)?, units);
            Some(if axis.is_choice() { text } else { format!("{} {text}", axis.word) })
        })
        .collect();
    let held = if held.is_empty() { "all rows".to_owned() } else { held.join(", ") };
    let what = if measure.is_probability() { "Probability: " } else { "Mean: " };
    let what = if matches!(measure, Measure::Mean(_)) { what } else { "" };
    format!("{what}{} ({held})", measure.label())
}

/// An axis of the atlas as that of a figure; a choice has its names at 0, 1, 2, ….
fn shown_axis(axis: &impactlab_sweep::atlas::Axis, units: UnitSystem) -> Axis {
    if axis.is_choice() {
        return Axis::named(axis.label.clone(), axis.labels.clone());
    }
    Axis::shown(axis.label.clone(), axis.quantity(), units)
}

/// The unit in which a measure is shown: per cent for a share.
fn unit_of(measure: Measure, units: UnitSystem) -> Unit {
    match Quantity::from_si_symbol(measure.unit()) {
        Some(quantity) => quantity.display_unit(units),
        None => Unit { quantity: Quantity::Ratio, symbol: "%", si_per_unit: 0.01 },
    }
}

fn cell_map(slice: &Slice, measure: Measure, axes: [&Axis; 2], units: UnitSystem) -> CellMap {
    let unit = unit_of(measure, units);
    let edges = |axis: &impactlab_sweep::atlas::Axis, shown: &Axis| -> Vec<f64> {
        let ends = |bin| axis.ends(bin).map(|ends| ends.map(|end| shown.unit.from_si(end)));
        let first = ends(0).map(|[low, _]| low);
        let others = (0..axis.n_bins()).filter_map(ends).map(|[_, high]| high);
        first.into_iter().chain(others).collect()
    };
    let value = |cell: &SliceCell| cell.mean.map(|mean| unit.from_si(mean));
    let values: Vec<Option<f64>> = slice.cells.iter().map(value).collect();
    let is_share = unit.symbol == "%";
    let present = || values.iter().flatten().copied();
    let scale = match is_share {
        true => [0.0, 100.0],
        false => [present().fold(f64::INFINITY, f64::min), present().fold(f64::MIN, f64::max)],
    };
    let scale = if scale[0] <= scale[1] { scale } else { [0.0, 1.0] };
    CellMap {
        name: measure.label().to_owned(),
        edges: [edges(&slice.x, axes[0]), edges(&slice.y, axes[1])],
        values,
        is_hatched: slice.cells.iter().map(is_hatched).collect(),
        scale,
        unit,
    }
}

/// Whether a cell has no colour, or one that is not to be relied upon.
fn is_hatched(cell: &SliceCell) -> bool {
    cell.mean.is_none() || !cell.is_sound()
}

/// Lines of equal value through the middles of the cells, up to the edge of the map.
fn lines_of(map: &CellMap) -> Vec<FigureElement> {
    let [low, high] = map.scale;
    let points = [0, 1].map(|axis: usize| padded_middles(&map.edges[axis]));
    let values = padded(map);
    let mut elements = Vec::new();
    if high <= low {
        return elements;
    }
    for (share, style) in LINES {
        let level = low + share * (high - low);
        let number = trimmed(significant(level));
        let name = format!("{number} {}", map.unit.symbol).trim().to_owned();
        let lines = contours([&points[0], &points[1]], &values, level);
        elements.extend(lines.into_iter().map(|points| {
            FigureElement::Line(Series { name: name.clone(), role: Role::Reference, style, points })
        }));
    }
    elements
}

/// The middles between edges, with the first and the last edge.
fn padded_middles(edges: &[f64]) -> Vec<f64> {
    let middles = edges.windows(2).map(|pair| 0.5 * pair.iter().sum::<f64>());
    let (first, last) = (edges.first().copied(), edges.last().copied());
    first.into_iter().chain(middles).chain(last).collect()
}

/// The values at these points: those of the cells, and at the edges those of the outermost ones.
fn padded(map: &CellMap) -> Vec<Option<f64>> {
    let [width, height] = [0, 1].map(|axis: usize| map.edges[axis].len().saturating_sub(1));
    let inner = |padded: usize, n: usize| padded.saturating_sub(1).min(n.saturating_sub(1));
    let rows = 0..height + 2;
    rows.flat_map(|j| (0..width + 2).map(move |i| (i, j)))
        .map(|(i, j)| {
            let at = inner(j, height) * width + inner(i, width);
            map.values.get(at).copied().flatten()
        })
        .collect()
}

/// A cross of lines through the case, from edge to edge, with a point where they meet.
fn cross(at: [f64; 2], edges: &[Vec<f64>; 2]) -> Vec<FigureElement> {
    let name = "this case";
    let ends = |axis: usize| Some([*edges[axis].first()?, *edges[axis].last()?]);
    let (Some([x0, x1]), Some([y0, y1])) = (ends(0), ends(1)) else { return Vec::new() };
    let line = |points| {
        let (name, style) = (name.to_owned(), LineStyle::Dotted);
        FigureElement::Line(Series { name, role: Role::Striking, style, points })
    };
    vec![
        line(vec![[x0, at[1]], [x1, at[1]]]),
        line(vec![[at[0], y0], [at[0], y1]]),
        FigureElement::points(name, Role::Striking, vec![at]),
    ]
}

/// The Sobol indices of an outcome as bars: the total index, and in it that of first order.
///
/// - `label`: the outcome;
/// - `atlas`: whose axes name the inputs;
/// - `indices`: the greatest first;
/// - `other_networks`: names of the networks in use that are not those that computed the atlas.
pub fn sensitivity_figure(
    label: &str,
    atlas: &Atlas,
    indices: &[Sensitivity],
    other_networks: &[String],
) -> Figure {
    let x = Axis::new("Share of the variance", Quantity::Ratio.si_unit());
    // The first stands at the top.
    let names = indices.iter().rev().map(|index| input_label(atlas, &index.name)).collect();
    let y = Axis::named("", names);
    let mut elements = Vec::new();
    for (row, index) in indices.iter().rev().enumerate() {
        let bars = [
            ("total", Role::Validation, index.total, index.total_error),
            ("alone", Role::Model, index.first, index.first_error),
        ];
        for ((name, role, end, error), half) in bars.into_iter().zip(HALF_BARS) {
            let middle = row as f64;
            let [low, high] = [middle - half, middle + half];
            let corners = vec![[0.0, low], [end, low], [end, high], [0.0, high]];
            elements.push(FigureElement::polygon(name, role, corners));
            let at = if name == "total" { 0.5 * (high + middle + HALF_BARS[1]) } else { middle };
            let whisker = vec![[end - error, at], [end + error, at]];
            elements.push(FigureElement::line("± standard error", Role::Reference, whisker));
        }
    }
    let caveats = caveats(other_networks);
    Figure::new(format!("What moves: {label}"), [x, y], elements).with_caveats(&caveats)
}

/// What an input is called: the label of its axis, where the atlas has one.
fn input_label(atlas: &Atlas, input: &str) -> String {
    let axis = atlas.axes.iter().find(|axis| axis.name == input);
    let label = axis.map(|axis| axis.label.as_str()).or_else(|| match input {
        UNKNOWNS => Some("What a draw leaves open"),
        _ => PitInput::from_name(input).map(PitInput::label),
    });
    label.unwrap_or(input).to_owned()
}

/// Writes the cells of a map as CSV, one row a cell, in SI units; ends, mean and error of a cell are empty
/// where there are none, and what a corridor beyond the histogram is more than has a column of its own.
///
/// - `restrictions`: what the map is and what is held, in the first row of the last column
///   ([`RESTRICTIONS_COLUMN`]).
///
/// # Errors
/// [`csv::Error`] if the writer fails.
pub fn write_slice_csv(
    slice: &Slice,
    measure: Measure,
    restrictions: &str,
    writer: impl Write,
) -> Result<(), csv::Error> {
    let mut csv = csv::Writer::from_writer(writer);
    let [x, y] = [&slice.x.name, &slice.y.name];
    let head = [
        format!("{x}_low"),
        format!("{x}_high"),
        format!("{y}_low"),
        format!("{y}_high"),
        measure.name().to_owned(),
        "standard_error".to_owned(),
        "rows".to_owned(),
        "rows_it_applies_to".to_owned(),
        "rows_failed".to_owned(),
        "share_inside_domain".to_owned(),
        "hatched".to_owned(),
        "more_than".to_owned(),
        RESTRICTIONS_COLUMN.to_owned(),
    ];
    csv.write_record(&head)?;
    let width = slice.x.n_bins().max(1);
    for (idx, cell) in slice.cells.iter().enumerate() {
        let number = |value: Option<f64>| value.map(|it| it.to_string()).unwrap_or_default();
        // A choice has its label at both ends.
        let ends = |axis: &impactlab_sweep::atlas::Axis, bin: usize| match axis.labels.get(bin) {
            Some(label) => [label.clone(), label.clone()],
            None => [0, 1].map(|end: usize| number(axis.ends(bin).map(|ends| ends[end]))),
        };
        let ([x_low, x_high], [y_low, y_high]) =
            (ends(&slice.x, idx % width), ends(&slice.y, idx / width));
        let row = [
            x_low,
            x_high,
            y_low,
            y_high,
            number(cell.mean),
            number(Some(cell.error).filter(|error| error.is_finite())),
            cell.n_rows.to_string(),
            cell.n_applies.to_string(),
            cell.n_failed.to_string(),
            cell.inside.to_string(),
            is_hatched(cell).to_string(),
            number(cell.more_than),
            if idx == 0 { restrictions } else { "" }.to_owned(),
        ];
        csv.write_record(&row)?;
    }
    csv.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Language, NumberFormat};
    use impactlab_sweep::Outcome;

    fn axis(name: &str, edges: &[f64], labels: &[&str]) -> impactlab_sweep::atlas::Axis {
        impactlab_sweep::atlas::Axis {
            name: name.to_owned(),
            word: name.to_owned(),
            label: name.to_owned(),
            unit: if labels.is_empty() { "m/s" } else { "1" }.to_owned(),
            edges: edges.to_vec(),
            labels: labels.iter().map(|&label| label.to_owned()).collect(),
        }
    }

    fn cell(mean: Option<f64>, inside: f64) -> SliceCell {
        let error = if mean.is_some() { 0.01 } else { f64::INFINITY };
        let (n_rows, n_failed, n_applies, at_rest, more_than) = (100, 0, 100, 1.0, None);
        SliceCell { n_rows, n_failed, n_applies, mean, more_than, error, inside, at_rest }
    }

    fn slice() -> Slice {
        let cells = [(Some(0.1), 1.0), (Some(0.9), 1.0), (None, 1.0), (Some(0.6), 0.2)];
        Slice {
            x: axis("speed_m_s", &[10.0, 20.0, 30.0], &[]),
            y: axis("esc", &[], &["without", "with"]),
            cells: cells.into_iter().map(|(mean, inside)| cell(mean, inside)).collect(),
        }
    }

    #[test]
    fn a_map_has_its_edges_in_the_units_of_its_axes_and_hatches_what_is_not_sound() {
        let slice = slice();
        let axes = [&slice.x, &slice.y].map(|axis| shown_axis(axis, UnitSystem::Si));
        let measure = Measure::Mean(Outcome::Turns90);
        let map = cell_map(&slice, measure, [&axes[0], &axes[1]], UnitSystem::Si);
        assert!((map.edges[0][2] - 108.0).abs() < 1e-9, "{:?}", map.edges);
        assert_eq!(map.edges[1], [-0.5, 0.5, 1.5]);
        assert_eq!((map.scale, map.unit.symbol), ([0.0, 100.0], "%"));
        assert_eq!(map.is_hatched, [false, false, true, true]);
        let shares: Vec<f64> = map.values.iter().flatten().map(|it| map.share(*it)).collect();
        for (share, expected) in shares.iter().zip([0.1, 0.9, 0.6]) {
            assert!((share - expected).abs() < 1e-12, "{shares:?}");
        }
        let lines = lines_of(&map);
        let names: Vec<&str> = lines.iter().map(FigureElement::name).collect();
        assert!(names.contains(&"25 %") && names.contains(&"50 %"), "{names:?}");
        let cells: Vec<_> = map.cells().collect();
        assert_eq!(cells.len(), 4);
        assert_eq!(cells[2].0, [[map.edges[0][0], 0.5], [map.edges[0][1], 1.5]]);
    }

    #[test]
    fn the_table_of_a_map_has_a_row_for_each_cell_and_says_what_is_missing() {
        let mut text = Vec::new();
        let mut slice = slice();
        slice.cells[2].more_than = Some(60.0);
        write_slice_csv(&slice, Measure::Mean(Outcome::Turns90), "a study", &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 5, "{text}");
        assert!(lines[0].starts_with("speed_m_s_low,speed_m_s_high,esc_low,esc_high,turns_90,"));
        assert_eq!(lines[1], "10,20,without,without,0.1,0.01,100,100,0,1,false,,a study");
        assert_eq!(lines[3], "10,20,with,with,,,100,100,0,1,true,60,");
    }

    #[test]
    fn a_map_says_that_it_is_a_study_and_no_safe_speed() {
        let caveats = caveats(&[]);
        let text = caveats.text().unwrap();
        assert!(text.contains("a model study") && text.contains("safe speed"), "{text}");
        assert!(!text.contains("other networks"), "{text}");
        assert!(caveats.restrictions()[0].is_warning());
    }

    /// The command and the window said it beside the picture, and the picture that went to others did not.
    #[test]
    fn a_picture_of_an_atlas_of_other_networks_says_so() {
        let atlas = Atlas::shipped().unwrap();
        let other_networks = &["force".to_owned(), "response".to_owned()];
        let map = atlas_figure(&AtlasFigure {
            atlas,
            axes: [0, 1],
            held: &[],
            measure: Measure::Mean(Outcome::Turns90),
            case: None,
            units: UnitSystem::Si,
            other_networks,
        });
        let bars = sensitivity_figure("turns", atlas, &[], other_networks);
        let german = NumberFormat { language: Language::De, ..NumberFormat::default() };
        for figure in [map, bars] {
            let restrictions = figure.caveats.restrictions();
            let line = &restrictions[0];
            // A line that is too long is cut between clauses.
            let first = line.text.split(';').next().unwrap();
            assert!(
                first.ends_with("other networks than those in use (force, response)"),
                "{line}"
            );
            assert!(line.text.contains("is safe. Checked against no measured PIT. Hatched: "));
            let german = line.text_in(&german, &str::to_owned).unwrap();
            assert!(german.contains("als den verwendeten (force, response); keine"), "{german}");
        }
    }
}
