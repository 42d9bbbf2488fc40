//! Which map of an atlas is shown, which is saved.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use impactlab_sweep::atlas::{Atlas, Measure};

/// The axes that a map has where nobody has chosen any.
const USUAL_AXES: [&str; 2] = ["target_speed_m_s", "closing_m_s"];
/// The outcome that a map has at first.
const USUAL_OUTCOME: &str = "turns_90";
/// The axis of which two maps stand side by side.
const BESIDE: &str = "esc";

/// Which map of an atlas is shown. Axes and outcome are kept by their names, so that they are found in
/// another atlas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AtlasView {
    /// The file of the atlas; `None` for the one that comes with the program.
    pub file: Option<PathBuf>,
    /// Names of the horizontal and the vertical axis.
    pub axes: [String; 2],
    /// The bins in which other axes are held, by the names of these. An axis that is missing here is
    /// integrated out.
    pub held: BTreeMap<String, usize>,
    /// Name of the outcome.
    pub outcome: String,
    /// Whether a map without stability control stands beside one with it.
    pub is_beside: bool,
}

impl Default for AtlasView {
    fn default() -> Self {
        Self {
            file: None,
            axes: USUAL_AXES.map(str::to_owned),
            held: BTreeMap::new(),
            outcome: USUAL_OUTCOME.to_owned(),
            is_beside: true,
        }
    }
}

/// A map: two axes of an atlas, where the others stand, and the outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChoice {
    /// The horizontal and the vertical axis, by their numbers.
    pub axes: [usize; 2],
    /// The bin in which each axis is held; `None` where it is shown or integrated out.
    pub held: Vec<Option<usize>>,
    /// What of the outcomes it shows.
    pub measure: Measure,
}

impl AtlasView {
    /// The map of an atlas that is shown. What was chosen and is not in this atlas gives way to what is.
    ///
    /// - returns `None` for an atlas with fewer than two axes.
    pub fn choice(&self, atlas: &Atlas) -> Option<MapChoice> {
        let n = atlas.axes.len();
        let named = |name: &str| atlas.axes.iter().position(|axis| axis.name == name);
        let find = |at: usize, taken: Option<usize>| {
            let wanted = [self.axes[at].as_str(), USUAL_AXES[at]];
            let named = wanted.into_iter().filter_map(named);
            named.chain(0..n).find(|axis| Some(*axis) != taken)
        };
        let x = find(0, None)?;
        let y = find(1, Some(x))?;
        let held = atlas.axes.iter().enumerate().map(|(idx, axis)| {
            let bin = self.held.get(&axis.name).copied().filter(|bin| *bin < axis.n_bins());
            bin.filter(|_| idx != x && idx != y)
        });
        let named = |name: &str| Measure::all().find(|measure| measure.name() == name);
        let measure = named(&self.outcome).or_else(|| named(USUAL_OUTCOME))?;
        Some(MapChoice { axes: [x, y], held: held.collect(), measure })
    }

    /// Holds an axis in a bin; `None` integrates it out.
    pub fn hold(&mut self, axis: &str, bin: Option<usize>) {
        match bin {
            Some(bin) => self.held.insert(axis.to_owned(), bin),
            None => self.held.remove(axis),
        };
    }

    /// The axis of which every bin has a map of its own, side by side.
    pub fn beside(&self, atlas: &Atlas) -> Option<usize> {
        let idx = atlas.axes.iter().position(|axis| axis.name == BESIDE)?;
        let is_shown = self.choice(atlas).is_some_and(|choice| choice.axes.contains(&idx));
        (!is_shown && self.is_beside).then_some(idx)
    }

    /// The maps that stand side by side, from left to right.
    pub fn maps(&self, atlas: &Atlas) -> Vec<MapChoice> {
        let Some(choice) = self.choice(atlas) else { return Vec::new() };
        let Some(beside) = self.beside(atlas) else { return vec![choice] };
        let n = atlas.axes.get(beside).map_or(0, |axis| axis.n_bins());
        let of_bin = |bin: usize| {
            let mut map = choice.clone();
            if let Some(held) = map.held.get_mut(beside) {
                *held = Some(bin);
            }
            map
        };
        (0..n).map(of_bin).collect()
    }
}

/// Whether an axis is the one of which two maps can stand side by side.
pub fn can_be_beside(name: &str) -> bool {
    name == BESIDE
}
