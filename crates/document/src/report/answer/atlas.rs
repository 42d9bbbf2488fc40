//! Where a PIT lies in the atlas of the manoeuvre: a map with the case in it, and how usual its outcomes
//! are among the computed ones.

use crate::figure::{AtlasFigure, atlas_figure};
use crate::report::answer::Context;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::PartPicture;
use crate::report::{Block, Table};
use impactlab_core::collision::Scenario;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::VehicleParameters;
use impactlab_study::{MotionSource, PredictMotionAnswer, PredictMotionRequest};
use impactlab_sweep::atlas::{Atlas, Cell, Measure, place_of_case};
use impactlab_sweep::{Outcome, PitInput};

/// The axes of the map.
const AXES: [PitInput; 2] = [PitInput::TargetSpeed, PitInput::Closing];

/// What the map shows.
const SHOWN: Measure = Measure::Mean(Outcome::Turns90);

/// What is told of the cell of the case.
const TOLD: [Measure; 10] = [
    Measure::Mean(Outcome::Turns90),
    Measure::Mean(Outcome::Turns180),
    Measure::Mean(Outcome::Recovers),
    Measure::Mean(Outcome::AcrossLane),
    Measure::Mean(Outcome::DoorContact),
    Measure::Mean(Outcome::WheelLift),
    Measure::CorridorLength,
    Measure::CorridorWidth,
    Measure::Mean(Outcome::RestTimeS),
    Measure::Mean(Outcome::RestDistanceM),
];

/// What the atlas says of a case.
#[derive(Debug, Default, PartialEq)]
pub(super) struct InAtlas {
    /// Text and table.
    pub blocks: Vec<Block>,
    /// The map.
    pub picture: Option<PartPicture>,
}

/// What the shipped atlas says of a predicted motion; nothing where none is shipped, or where it is no
/// PIT.
pub(super) fn in_atlas(
    request: &PredictMotionRequest,
    answer: &PredictMotionAnswer,
    context: Context<'_>,
) -> InAtlas {
    let MotionSource::Scenario { scenario, .. } = &request.motion.source else {
        return InAtlas::default();
    };
    let (Some(atlas), Ok(scenario)) = (Atlas::shipped(), scenario.load()) else {
        return InAtlas::default();
    };
    of_case(atlas, &scenario, &answer.analysis.vehicle, context.wording)
}

/// What an atlas says of a scenario.
fn of_case(
    atlas: &Atlas,
    scenario: &Scenario,
    struck: &VehicleParameters,
    wording: &Wording,
) -> InAtlas {
    let words = wording.words;
    let Some(place) = place_of_case(scenario, struck) else { return InAtlas::default() };
    let mut blocks = vec![Block::heading(3, words.atlas_heading)];
    let outside = place.outside(atlas, wording.units);
    if !outside.is_empty() {
        let list = wording.note(&outside.join("; "));
        blocks.push(Block::paragraph(fill(words.atlas_outside, &[("list", &list)])));
        return InAtlas { blocks, picture: None };
    }
    let held = place.bins(atlas);
    let cell = atlas.cell(&held);
    let (all, rows) = (atlas.n_rows.to_string(), cell.n_rows().to_string());
    let like = atlas.axes.iter().zip(&held).filter(|(_, bin)| bin.is_some());
    let like: Vec<String> = like.map(|(axis, _)| wording.name(&axis.label)).collect();
    let inside = wording.percent(cell.inside());
    let values =
        [("all", &*all), ("rows", &*rows), ("inside", &*inside), ("like", &*like.join(", "))];
    blocks.push(Block::paragraph(fill(words.atlas_text, &values)));
    blocks.push(Block::Table(table(&cell, wording)));
    let [x, y] = AXES.map(|input| atlas.axis(input.name()).zip(place.value(input.name())));
    let picture = x.zip(y).map(|((x, at_x), (y, at_y))| {
        let input = AtlasFigure {
            atlas,
            axes: [x, y],
            held: &held,
            measure: SHOWN,
            case: Some([at_x, at_y]),
            units: wording.units,
        };
        PartPicture::figure(words.atlas_picture.to_owned(), atlas_figure(&input))
    });
    InAtlas { blocks, picture }
}

fn table(cell: &Cell, wording: &Wording) -> Table {
    let words = wording.words;
    let row = |measure: Measure| {
        let told = cell.measure(measure);
        let shown = |value: f64| match Quantity::from_si_symbol(measure.unit()) {
            Some(quantity) => wording.value(quantity, value),
            None => wording.percent(value),
        };
        let (mean, error) = match told.mean {
            Some(mean) if !told.is_sound() => {
                (format!("{} ({})", shown(mean), words.atlas_doubtful), shown(told.error))
            }
            Some(mean) => (shown(mean), shown(told.error)),
            None => (words.atlas_few.to_owned(), String::new()),
        };
        [wording.name(measure.label()), mean, error]
    };
    let columns = [words.quantity, words.value, words.atlas_error];
    Table::new(words.atlas_heading, columns, TOLD.into_iter().map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::language::phrase_of;
    use crate::report::{Language, Paper, ReportDate, ReportSettings};
    use impactlab_core::units::UnitSystem;
    use impactlab_core::vehicle::Preset;
    use impactlab_sweep::atlas::Axis;
    use impactlab_sweep::{Column, Rows, RowsMeta};

    /// An atlas over speed and closing speed of rows that lie evenly between their ends and all turn.
    fn atlas(speeds: [f64; 2]) -> Atlas {
        let axis = |input: PitInput, edges: [f64; 2]| Axis {
            name: input.name().to_owned(),
            word: input.name().to_owned(),
            label: input.name().to_owned(),
            unit: input.unit().to_owned(),
            edges: edges.to_vec(),
            labels: Vec::new(),
        };
        let n = 200_u64;
        let column = |name: &str, at: &dyn Fn(f64) -> f64| Column {
            name: name.to_owned(),
            unit: "1".to_owned(),
            values: (0..n).map(|i| at((i as f64 + 0.5) / n as f64)).collect(),
        };
        let between = |[low, high]: [f64; 2]| move |share: f64| low + share * (high - low);
        let closing = [0.5, 8.0];
        let [speed_name, closing_name] = AXES.map(PitInput::name);
        let rows = Rows {
            inputs: vec![
                column(speed_name, &between(speeds)),
                column(closing_name, &between(closing)),
            ],
            outcomes: Outcome::ALL.iter().map(|of| column(of.name(), &|_| 1.0)).collect(),
            index: (0..n).collect(),
            reasons: vec![String::new(); n as usize],
            meta: RowsMeta::default(),
        };
        Atlas::from_rows(&rows, vec![axis(AXES[0], speeds), axis(AXES[1], closing)]).unwrap()
    }

    #[test]
    fn what_the_atlas_says_is_german_in_a_german_report() {
        for label in TOLD.map(Measure::label) {
            assert!(phrase_of(Language::De, label).is_some(), "{label}");
        }
        let (scenario, struck) = (Scenario::example(), Preset::Reference.parameters());
        let wording = Wording::new(&ReportSettings {
            language: Language::De,
            units: UnitSystem::Si,
            paper: Paper::A4,
            date: ReportDate::new(2026, 1, 2).unwrap(),
        });
        let mut narrow = atlas([20.0, 30.0]);
        narrow.axes[0].label = "Speed of the struck car".to_owned();
        let told = format!("{:?}", of_case(&narrow, &scenario, &struck, &wording).blocks);
        let expected =
            "Geschwindigkeit des gestoßenen Fahrzeugs: 54,00 km/h, der Atlas reicht von 72,00 km/h";
        assert!(told.contains(expected) && !told.contains("the map"), "{told}");
    }

    #[test]
    fn a_pit_is_placed_in_the_map_and_said_to_be_outside_where_it_is() {
        let (scenario, struck) = (Scenario::example(), Preset::Reference.parameters());
        let wording = Wording::english(UnitSystem::Si);
        let inside = of_case(&atlas([10.0, 30.0]), &scenario, &struck, &wording);
        assert!(inside.picture.is_some());
        let text = format!("{:?}", inside.blocks);
        assert!(text.contains("200 of the 200") && text.contains("model study"), "{text}");
        assert!(text.contains("100.0 %"), "{text}");
        let outside = of_case(&atlas([20.0, 30.0]), &scenario, &struck, &wording);
        assert_eq!(outside.picture, None);
        let text = format!("{:?}", outside.blocks);
        assert!(text.contains("outside") && text.contains("54.00 km/h"), "{text}");
        let mut other = scenario;
        other.striking.vy_world_m_s *= -1.0;
        assert_eq!(of_case(&atlas([10.0, 30.0]), &other, &struck, &wording), InAtlas::default());
    }
}
