//! The maps that are shown, and where the case at hand lies in them.

use crate::app::atlas::AtlasSession;
use crate::app::atlas::view::MapChoice;
use crate::app::atlas::words::cell_text;
use impactlab_core::units::{NumberFormat, UnitSystem};
use impactlab_document::figure::{self, AtlasFigure, Figure, FigureElement, atlas_figure};
use impactlab_sweep::atlas::{Atlas, Axis, CasePlace, Slice};

/// What can be done where a case lies outside of an atlas.
pub const OUTSIDE_REMEDY: &str =
    "No cell is like it. Change it in Scenario, or compute an atlas whose plan reaches it (Sweep).";

/// The case at hand as a point of an atlas.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CasePoint {
    /// What it is called.
    pub name: String,
    /// What it says of the inputs of the atlas; `None` if it is no PIT.
    pub place: Option<CasePlace>,
    /// Why it has no place in an atlas; empty if it has one.
    pub why_none: &'static str,
    /// The bin of each axis in which it lies; empty if it is no PIT.
    pub bins: Vec<Option<usize>>,
}

/// What the maps are of.
#[derive(Debug, Clone, PartialEq)]
pub struct MapsOf {
    /// The maps, from left to right.
    pub maps: Vec<MapChoice>,
    /// The axis of which each bin has a map of its own.
    pub beside: Option<usize>,
    /// Units of the figures.
    pub units: UnitSystem,
    /// The case at hand.
    pub case: CasePoint,
    /// The networks of the program that are not those that computed the atlas.
    pub other_networks: Vec<String>,
}

/// An input of the case at hand beside the atlas.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseInput {
    /// What it is.
    pub label: String,
    /// Its value; `None` if the case does not say it.
    pub value: Option<String>,
    /// By how much it is beyond what the atlas has; `None` if it is not.
    pub beyond: Option<String>,
}

/// A map that is shown.
#[derive(Debug, Clone)]
pub struct ShownMap {
    /// Which one it is.
    pub choice: MapChoice,
    /// What tells it from the one beside it; empty for one alone.
    pub name: String,
    /// Its cells.
    pub slice: Slice,
    /// The same as a figure.
    pub figure: Figure,
}

impl CasePoint {
    /// Where it is in a map: its values along both axes, in SI units.
    ///
    /// - returns `None` if it does not say one of them, or belongs into the map beside that one.
    fn in_map(&self, atlas: &Atlas, map: &MapChoice, beside: Option<usize>) -> Option<[f64; 2]> {
        let place = self.place.as_ref()?;
        let value = |axis: usize| place.value(&atlas.axes.get(axis)?.name);
        if let Some(beside) = beside
            && self.bins.get(beside) != map.held.get(beside)
        {
            return None;
        }
        let [x, y] = map.axes;
        Some([value(x)?, value(y)?])
    }
}

impl MapsOf {
    /// Makes the maps. Those side by side have the same scale of colours and the same axes, also where the case
    /// lies outside of one of them.
    pub(super) fn make(&self, atlas: &Atlas) -> Vec<ShownMap> {
        let mut maps: Vec<ShownMap> = self.maps.iter().map(|map| self.one(atlas, map)).collect();
        let scales = maps.iter_mut().flat_map(ShownMap::scales);
        let whole = scales.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], scale| {
            [low.min(scale[0]), high.max(scale[1])]
        });
        maps.iter_mut().flat_map(ShownMap::scales).for_each(|scale| *scale = whole);
        let reach: Vec<[f64; 2]> = maps.iter().flat_map(ShownMap::reach).collect();
        maps.iter_mut().for_each(|map| map.figure.included.clone_from(&reach));
        maps
    }

    fn one(&self, atlas: &Atlas, map: &MapChoice) -> ShownMap {
        let MapChoice { axes: [x, y], held, measure } = map;
        let figure = atlas_figure(&AtlasFigure {
            atlas,
            axes: [*x, *y],
            held,
            measure: *measure,
            case: self.case.in_map(atlas, map, self.beside),
            units: self.units,
            other_networks: &self.other_networks,
        });
        let bin = self.beside.and_then(|axis| held.get(axis).copied().flatten());
        let of_bin = self.beside.and_then(|axis| atlas.axes.get(axis)).zip(bin);
        let name = of_bin.map(|(axis, bin)| axis.bin_text(bin, self.units)).unwrap_or_default();
        let slice = atlas.slice(*x, *y, held, *measure);
        ShownMap { choice: map.clone(), name, slice, figure }
    }
}

impl AtlasSession {
    /// Name of the case at hand, and why it has no place in any map of the atlas, if it has none.
    pub fn case_at_hand(&self) -> Option<(&str, Option<&'static str>)> {
        let case = &self.made_of.as_ref()?.case;
        Some((&case.name, case.place.is_none().then_some(case.why_none)))
    }

    /// What the case at hand says of each axis of the atlas, and what else of it lies outside; nothing if it
    /// has no place in one.
    pub fn case_inputs(&self, atlas: &Atlas, units: UnitSystem) -> Vec<CaseInput> {
        let place = self.made_of.as_ref().and_then(|of| of.case.place.as_ref());
        let Some(place) = place else { return Vec::new() };
        let outside = place.outside_inputs(atlas);
        let of_axis = |axis: &Axis| {
            let value = place.value(&axis.name);
            let shown = |value: f64| match axis.locate(value).filter(|_| axis.is_choice()) {
                Some(bin) => axis.bin_text(bin, units),
                None => axis.quantity().shown(value, units),
            };
            let beyond = outside.iter().find(|input| input.label == axis.label);
            CaseInput {
                label: axis.label.clone(),
                value: value.map(shown),
                beyond: beyond.map(|input| input.beyond(units)),
            }
        };
        let is_of_axis = |label: &str| atlas.axes.iter().any(|axis| axis.label == label);
        let others = outside.iter().filter(|input| !is_of_axis(&input.label));
        let others = others.map(|input| CaseInput {
            label: input.label.clone(),
            value: Some(input.value(units)),
            beyond: Some(input.beyond(units)),
        });
        atlas.axes.iter().map(of_axis).chain(others).collect()
    }

    /// What the map says of the case at hand, a line each.
    pub fn case_lines(&self, atlas: &Atlas, units: UnitSystem) -> Vec<String> {
        let Some(MapsOf { case, beside, .. }) = &self.made_of else { return Vec::new() };
        let Some(place) = &case.place else {
            return vec![format!(
                "The case at hand is no PIT, so it has no place in this map: {}.",
                case.why_none
            )];
        };
        let outside = place.outside_inputs(atlas);
        if !outside.is_empty() {
            let told =
                outside.iter().map(|of| format!("{} ({})", of.text(units), of.beyond(units)));
            return vec![
                format!(
                    "The case at hand is outside of this map: {}.",
                    told.collect::<Vec<_>>().join("; ")
                ),
                OUTSIDE_REMEDY.to_owned(),
            ];
        }
        let found = self.maps.iter().find_map(|map| {
            case.in_map(atlas, &map.choice, *beside)?;
            let bin = |axis: usize| case.bins.get(axis).copied().flatten();
            let [x, y] = map.choice.axes;
            Some((map, [bin(x)?, bin(y)?]))
        });
        let Some((map, cell)) = found else {
            return vec!["The case at hand does not say both axes of this map.".to_owned()];
        };
        let mut lines = vec![format!("The case at hand: {}", map.text(cell, units))];
        let format = NumberFormat::english(units);
        lines.extend(place.other_drivers().iter().map(|text| text.say(&format)));
        let others = map.elsewhere(atlas, &case.bins);
        if !others.is_empty() {
            let others = others.join(", ");
            lines.push(format!("The map holds otherwise than the case: {others}."));
        }
        lines
    }
}

impl ShownMap {
    /// Values at both ends of the scale of colours.
    fn scales(&mut self) -> impl Iterator<Item = &mut [f64; 2]> {
        self.figure.elements.iter_mut().filter_map(|element| match element {
            FigureElement::CellMap(map) => Some(&mut map.scale),
            _ => None,
        })
    }

    /// The places that its axes reach: the corners of the cells, and the case where this map has it.
    fn reach(&self) -> Vec<[f64; 2]> {
        let places = self.figure.elements.iter().flat_map(|element| match element {
            FigureElement::Points(series) => series.points.clone(),
            FigureElement::CellMap(map) => map.cells().flat_map(|(ends, ..)| ends).collect(),
            _ => Vec::new(),
        });
        places.collect()
    }

    /// The inputs that the map holds in another bin than that of a case.
    fn elsewhere(&self, atlas: &Atlas, bins: &[Option<usize>]) -> Vec<String> {
        let each = atlas.axes.iter().zip(&self.choice.held).zip(bins);
        let is_other = |held: &Option<usize>, bin: &Option<usize>| {
            held.is_some() && bin.is_some() && held != bin
        };
        let others = each.filter(|((_, held), bin)| is_other(held, bin));
        others.map(|((axis, _), _)| axis.label.to_lowercase()).collect()
    }

    /// The cell at a point of the figure: its bins along both axes.
    ///
    /// - `at`: in the units of the axes of the figure.
    pub fn bins_at(&self, at: [f64; 2]) -> Option<[usize; 2]> {
        let Self { slice, figure, .. } = self;
        let bin = |axis: &Axis, shown: &figure::Axis, value: f64| match axis.is_choice() {
            true => axis.locate(value.round()),
            false => axis.locate(shown.unit.to_si(value)),
        };
        Some([bin(&slice.x, &figure.x, at[0])?, bin(&slice.y, &figure.y, at[1])?])
    }

    /// The bin of every axis for a cell of this map; `None` for an axis that is integrated out.
    pub fn bins(&self, cell: [usize; 2]) -> Vec<Option<usize>> {
        let mut bins = self.choice.held.clone();
        for (axis, bin) in self.choice.axes.into_iter().zip(cell) {
            if let Some(place) = bins.get_mut(axis) {
                *place = Some(bin);
            }
        }
        bins
    }

    /// Where a cell of this map is.
    pub fn place_text(&self, [x, y]: [usize; 2], units: UnitSystem) -> String {
        let Slice { x: across, y: upwards, .. } = &self.slice;
        let of = |axis: &Axis, bin| format!("{}: {}", axis.label, axis.bin_text(bin, units));
        let mut parts = vec![of(across, x), of(upwards, y)];
        if !self.name.is_empty() {
            parts.push(self.name.clone());
        }
        parts.join("; ")
    }

    /// What a cell of this map says.
    pub fn text(&self, [x, y]: [usize; 2], units: UnitSystem) -> String {
        let cell = self.slice.at(x, y);
        cell.map_or_else(String::new, |cell| cell_text(self.choice.measure, cell, units))
    }
}
