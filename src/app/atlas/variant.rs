//! The case at hand as a point of an atlas, and variants that are made of its cells.

use serde::Deserialize;

use crate::app::atlas::map::CasePoint;
use crate::app::case::VariantCommand;
use crate::app::panes::Pane;
use crate::app::state::{State, Subject};
use impactlab_core::collision::{Role, Scenario};
use impactlab_core::data::Severity;
use impactlab_core::vehicle::VehicleParameters;
use impactlab_study::{
    DEFAULT_STRIKING, DEFAULT_VEHICLE, MotionSource, ScenarioChoice, VehicleChoice,
};
use impactlab_sweep::atlas::{Atlas, Axis, place_of_case, why_no_pit};
use impactlab_sweep::{PitInput, PitQuestion, VehiclePairIds};

/// The plan of the shipped atlas, which says which cars its pairs are.
pub const SHIPPED_PLAN: &str = include_str!("../../../assets/atlas/pit.toml");

/// What a variant of a cell is called.
const VARIANT: &str = "atlas";

/// What is read of the shipped plan.
#[derive(Deserialize)]
struct ShippedPlan {
    pit: ShippedPit,
}

#[derive(Deserialize)]
struct ShippedPit {
    pairs: Vec<VehiclePairIds>,
}

/// A value that a cell says of an input, with its axis and its bin.
struct CellValue<'a> {
    axis: &'a Axis,
    bin: usize,
    input: PitInput,
    value: f64,
}

impl State {
    /// The case at hand in an atlas.
    pub(super) fn case_in(&self, atlas: &Atlas) -> CasePoint {
        let scenario = self.project.scenario();
        let struck = self.vehicle_on_road(Role::Struck);
        let place = scenario.and_then(|scenario| place_of_case(scenario, &struck));
        let bins = place.as_ref().map_or_else(Vec::new, |place| place.bins(atlas));
        let why_none = match scenario {
            Some(scenario) => why_no_pit(scenario).unwrap_or_default(),
            None => "its scenario cannot be read",
        };
        CasePoint { name: self.project.impact.scenario.name(), place, why_none, bins }
    }

    /// A vehicle of the scenario, on its road.
    fn vehicle_on_road(&self, role: Role) -> VehicleParameters {
        let usual = match role {
            Role::Struck => DEFAULT_VEHICLE,
            Role::Striking => DEFAULT_STRIKING,
        };
        let chosen = self.session.chosen_vehicles.get(role).cloned();
        let vehicle = chosen.unwrap_or_else(|| usual.parameters());
        let project = &self.project;
        let friction = match project.simulate.source {
            MotionSource::Scenario { .. } => project.simulate.friction,
            _ => project.beside.road.friction,
        };
        match friction {
            Some(friction) => vehicle.with_friction(friction),
            None => vehicle,
        }
    }

    /// Makes a variant of the case of a cell, and plays it as soon as it is computed. What the cell does not
    /// say stays as it is in the variant that is shown.
    pub(super) fn play_cell(&mut self, bins: &[Option<usize>]) {
        let Some(atlas) = self.session.atlas.atlas().cloned() else { return };
        let values = cell_values(&atlas, bins);
        let pairs = match pairs_of(&values) {
            Ok(pairs) => pairs,
            Err(why) => return self.say(Severity::Warning, why),
        };
        let struck = self.vehicle_on_road(Role::Struck);
        let own = self.project.scenario().filter(|of| place_of_case(of, &struck).is_some());
        let is_own = own.is_some();
        let base = own.cloned().unwrap_or_else(Scenario::example);
        let ending = base.ending.clone();
        let vehicles = Role::ALL.map(|role| self.vehicle_on_road(role));
        let question = PitQuestion { scenario: base, pairs, road_sigma: 0.0, limit_s: 0.0 };
        // In the rows of the atlas the striking car drives about as it points.
        let follows_way = sets_way_alone(&values);
        let number = |input: PitInput| {
            let told = values.iter().find(|of| of.input == input).map(|of| of.value);
            told.or_else(|| (follows_way && input == PitInput::Slip).then_some(0.0))
        };
        let Some(mut scenario) = question.scenario_of(vehicles, number) else {
            let why = "no variant was made: the case at hand gives its contact in another way than by \
                 a side of the struck car";
            return self.say(Severity::Warning, why);
        };
        if [PitInput::Esc, PitInput::Driver].iter().all(|input| number(*input).is_none()) {
            scenario.ending = ending;
        }
        let units = self.view.units;
        let text =
            |of: &CellValue<'_>| format!("{}: {}", of.axis.label, of.axis.bin_text(of.bin, units));
        let way = follows_way.then(|| "the striking car drives as it points".to_owned());
        let told = values.iter().map(text).chain(way).collect::<Vec<_>>().join("; ");
        scenario.notes = format!("The middle of a cell of the atlas. {told}");
        let friction = number(PitInput::Friction);
        let sets_pair = number(PitInput::Pair).is_some();
        self.begin_variant(&told);
        self.take_scenario(scenario, friction, sets_pair);
        let rest = match is_own {
            true => "everything else is as in the variant before",
            false => "everything else is as in the example PIT, as the case before is no PIT",
        };
        let name = self.case.file.shown.clone();
        self.say(Severity::Info, format!("variant {name:?}: {told}; {rest}"));
        self.session.atlas.plays_next = true;
        self.session.playback.is_playing = false;
        self.view.workspaces.show_pane(Pane::Scene);
    }

    /// Copies the variant that is shown, with a name and notes of its own.
    fn begin_variant(&mut self, told: &str) {
        self.change_variant(VariantCommand::Duplicate);
        let name = self.case.file.free_name(VARIANT);
        self.change_variant(VariantCommand::Rename(name.clone()));
        let notes = format!("From the atlas. {told}");
        self.change_variant(VariantCommand::Note { name, notes });
    }

    /// Asks about a scenario from now on.
    fn take_scenario(&mut self, scenario: Scenario, friction: Option<f64>, sets_pair: bool) {
        self.select(Subject::Scenario);
        let project = &mut self.project;
        project.impact.scenario = ScenarioChoice::Inline(Box::new(scenario));
        if let Some(friction) = friction {
            project.simulate.friction = Some(friction);
        }
        if sets_pair {
            // The scenario names them.
            for role in Role::ALL {
                *project.vehicle_mut(role) = VehicleChoice::Automatic;
            }
        }
        project.keep_in_step();
        self.session.fit_plots = true;
    }
}

/// The middle of every bin that a cell says, with the input that it is of.
fn cell_values<'a>(atlas: &'a Atlas, bins: &[Option<usize>]) -> Vec<CellValue<'a>> {
    let of = |(axis, bin): (&'a Axis, &Option<usize>)| {
        let bin = (*bin)?;
        let [low, high] = axis.ends(bin)?;
        let input = PitInput::from_name(&axis.name)?;
        Some(CellValue { axis, bin, input, value: (low + high) / 2.0 })
    };
    atlas.axes.iter().zip(bins).filter_map(of).collect()
}

/// Whether a cell says how the striking car moves, and not how it points.
fn sets_way_alone(values: &[CellValue<'_>]) -> bool {
    let has = |inputs: &[PitInput]| values.iter().any(|of| inputs.contains(&of.input));
    has(&[PitInput::TargetSpeed, PitInput::Closing, PitInput::Faster])
        && !has(&[PitInput::Angle, PitInput::Slip])
}

/// The pairs of vehicles that a cell chooses from; none if it says no pair.
///
/// # Errors
/// A message for the user, if the pairs of the atlas are others than those that the program knows.
fn pairs_of(values: &[CellValue<'_>]) -> Result<Vec<VehiclePairIds>, String> {
    let Some(of_pair) = values.iter().find(|of| of.input == PitInput::Pair) else {
        return Ok(Vec::new());
    };
    let shipped = Axis::pit().unwrap_or_default();
    let is_known = shipped.iter().any(|axis| axis == of_pair.axis);
    let plan = toml::from_str::<ShippedPlan>(SHIPPED_PLAN);
    match plan {
        Ok(plan) if is_known => Ok(plan.pit.pairs),
        _ => Err(
            "no variant was made: the pairs of cars of this atlas are not those of this version; \
             leave them integrated out to use the cars of the case"
                .to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_plan_says_which_cars_the_pairs_are() {
        let axes = Axis::pit().unwrap();
        let pair = axes.iter().find(|axis| axis.name == PitInput::Pair.name()).unwrap();
        let value = CellValue { axis: pair, bin: 1, input: PitInput::Pair, value: 1.0 };
        assert_eq!(pairs_of(&[value]).unwrap().len(), pair.n_bins());
        assert!(pairs_of(&[]).unwrap().is_empty());
        let other = Axis { labels: vec!["van into van".to_owned()], ..pair.clone() };
        let value = CellValue { axis: &other, bin: 0, input: PitInput::Pair, value: 0.0 };
        assert!(pairs_of(&[value]).unwrap_err().contains("pairs of cars"));
    }
}
