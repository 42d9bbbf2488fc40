//! Where a PIT lies in the atlas of the manoeuvre: a map with the case in it, and how usual its outcomes
//! are among the computed ones.

use crate::figure::{AtlasFigure, atlas_figure};
use crate::report::answer::Context;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::PartPicture;
use crate::report::provenance::network_name;
use crate::report::{Block, Table};
use impactlab_core::collision::Scenario;
use impactlab_core::data::write::ModelDigest;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::VehicleParameters;
use impactlab_study::{MotionSource, PredictMotionAnswer, PredictMotionRequest};
use impactlab_sweep::atlas::{Atlas, Axis, CasePlace, Cell, Measure, place_of_case};
use impactlab_sweep::{Outcome, PitInput};

/// The axes of the map.
const AXES: [PitInput; 2] = [PitInput::TargetSpeed, PitInput::Closing];

/// What the map shows, and by which the axes that are held are chosen.
const SHOWN: Outcome = Outcome::Turns90;

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
    let digests = &answer.report.provenance.model_digests;
    of_case(atlas, digests, &scenario, &answer.analysis.vehicle, context.wording)
}

/// The networks that answered and are not those of the atlas.
fn other_networks(atlas: &Atlas, answered: &[ModelDigest], wording: &Wording) -> Vec<String> {
    let answered = answered.iter().map(|of| (&*of.network, &*of.sha256));
    atlas.other_networks(answered).into_iter().map(|it| network_name(it, wording)).collect()
}

/// What an atlas says of a scenario.
///
/// - `answered`: the networks that answered.
fn of_case(
    atlas: &Atlas,
    answered: &[ModelDigest],
    scenario: &Scenario,
    struck: &VehicleParameters,
    wording: &Wording,
) -> InAtlas {
    let words = wording.words;
    let Some(place) = place_of_case(scenario, struck) else { return InAtlas::default() };
    let mut blocks = vec![Block::heading(3, words.atlas_heading)];
    let outside = place.outside(atlas, wording.units);
    let others = other_networks(atlas, answered, wording);
    let notice = (!others.is_empty()).then(|| {
        let list = others.join(", ");
        Block::Notice { text: fill(words.atlas_other_networks, &[("list", &list)]) }
    });
    if !outside.is_empty() {
        let list = wording.note(&outside.join("; "));
        blocks.push(Block::paragraph(fill(words.atlas_outside, &[("list", &list)])));
        blocks.extend(notice);
        return InAtlas { blocks, picture: None };
    }
    let held = atlas.held_in_cell(&place.bins(atlas), SHOWN);
    let cell = atlas.cell(&held);
    let (all, rows) = (atlas.n_rows.to_string(), cell.n_rows().to_string());
    let (like, averaged) = (held_list(atlas, &held, wording), averaged(atlas, &held, wording));
    let inside = wording.percent(cell.inside());
    let values = [
        ("all", &*all),
        ("rows", &*rows),
        ("inside", &*inside),
        ("like", &*like),
        ("averaged", &*averaged),
    ];
    blocks.push(Block::paragraph(fill(words.atlas_text, &values)));
    let drivers = place.other_drivers();
    blocks.extend(drivers.iter().map(|text| Block::Notice { text: text.say(wording) }));
    blocks.push(Block::Table(table(&cell, wording)));
    blocks.extend(notice);
    InAtlas { blocks, picture: map(atlas, &others, &place, wording) }
}

/// The map with the case in it; nothing without both axes.
fn map(
    atlas: &Atlas,
    other_networks: &[String],
    place: &CasePlace,
    wording: &Wording,
) -> Option<PartPicture> {
    let [x, y] = AXES.map(|input| atlas.axis(input.name()).zip(place.value(input.name())));
    let ((x, at_x), (y, at_y)) = x.zip(y)?;
    let held = atlas.held_in_map([x, y], &place.bins(atlas), SHOWN);
    let figure = atlas_figure(&AtlasFigure {
        atlas,
        axes: [x, y],
        held: &held,
        measure: SHOWN.into(),
        case: Some([at_x, at_y]),
        units: wording.units,
        other_networks,
    });
    let [x, y] = [x, y].map(|axis| atlas.axes.get(axis).map(|axis| wording.name(&axis.label)));
    let (x, y, held) = (x?, y?, held_list(atlas, &held, wording));
    let values = [("x", &*x), ("y", &*y), ("held", &*held)];
    Some(PartPicture::figure(fill(wording.words.atlas_picture, &values), figure))
}

/// The axes that are held, each with its bin.
fn held_list(atlas: &Atlas, held: &[Option<usize>], wording: &Wording) -> String {
    let bin_text = |axis: &Axis, bin: usize| match (axis.labels.get(bin), axis.ends(bin)) {
        (Some(label), _) => wording.name(label),
        (None, Some(ends)) => wording.given_range(axis.quantity(), ends),
        (None, None) => String::new(),
    };
    let text = |(axis, bin): (&Axis, &Option<usize>)| {
        Some(format!("{} ({})", wording.name(&axis.label), bin_text(axis, (*bin)?)))
    };
    let list: Vec<String> = atlas.axes.iter().zip(held).filter_map(text).collect();
    if list.is_empty() { wording.words.atlas_nothing.to_owned() } else { list.join(", ") }
}

/// What the rows of a cell are averaged over.
fn averaged(atlas: &Atlas, held: &[Option<usize>], wording: &Wording) -> String {
    let axes = atlas.axes.iter().zip(held).filter(|(_, bin)| bin.is_none());
    let labels = axes.map(|(axis, _)| wording.name(&axis.label));
    labels.chain([wording.words.atlas_rest.to_owned()]).collect::<Vec<_>>().join(", ")
}

fn table(cell: &Cell, wording: &Wording) -> Table {
    let words = wording.words;
    let row = |measure: Measure| {
        let told = cell.measure(measure);
        let shown = |value: f64| match Quantity::from_si_symbol(measure.unit()) {
            Some(quantity) => wording.value(quantity, value),
            None => wording.percent(value),
        };
        let (value, error) = match (told.mean, told.more_than) {
            (Some(mean), _) => (shown(mean), shown(told.error)),
            (None, Some(limit)) => (format!("> {}", shown(limit)), String::new()),
            (None, None) => (words.atlas_few.to_owned(), String::new()),
        };
        let value = match told.is_told() && !told.is_sound() {
            true => format!("{value} ({})", words.atlas_doubtful),
            false => value,
        };
        [wording.name(measure.label()), value, error]
    };
    let columns = [words.quantity, words.value, words.atlas_error];
    Table::new(words.atlas_table, columns, TOLD.into_iter().map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::language::phrase_of;
    use crate::report::{Language, Paper, ReportDate, ReportSettings};
    use impactlab_core::units::UnitSystem;
    use impactlab_core::vehicle::Preset;
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
            unit: PitInput::from_name(name).map_or("1", PitInput::unit).to_owned(),
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
            caveats: None,
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
        for axis in Axis::pit().unwrap() {
            assert!(phrase_of(Language::De, &axis.label).is_some(), "{}", axis.label);
            // The pairs are names.
            let labels = axis.labels.iter().filter(|_| axis.name != PitInput::Pair.name());
            for label in labels {
                assert!(phrase_of(Language::De, label).is_some(), "{label}");
            }
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
        let told = format!("{:?}", of_case(&narrow, &[], &scenario, &struck, &wording).blocks);
        let expected =
            "Geschwindigkeit des gestoßenen Fahrzeugs: 54 km/h, der Atlas reicht von 72 km/h";
        assert!(told.contains(expected) && !told.contains("the map"), "{told}");
        let mut slides = scenario;
        slides.striking.heading_rad += 0.3;
        let wide = atlas([10.0, 30.0]);
        let told = format!("{:?}", of_case(&wide, &[], &slides, &struck, &wording).blocks);
        let expected = "zur Längsachse des stoßenden Fahrzeugs: 17,19°, der Atlas reicht von";
        assert!(told.contains(expected), "{told}");
    }

    /// It held every axis, and every row of the table was “too few”.
    #[test]
    fn the_shipped_atlas_says_something_of_a_pit_within_it() {
        let struck = Preset::Reference.parameters();
        let mut scenario = Scenario::example();
        for state in [&mut scenario.struck, &mut scenario.striking] {
            state.vx_world_m_s += 10.0;
        }
        let [vx_m_s, vy_m_s] = [scenario.striking.vx_world_m_s, scenario.striking.vy_world_m_s];
        scenario.striking.heading_rad = vy_m_s.atan2(vx_m_s);
        let wording = Wording::english(UnitSystem::Si);
        let told = of_case(Atlas::shipped().unwrap(), &[], &scenario, &struck, &wording);
        let text = format!("{:?}", told.blocks);
        assert!(!text.contains("outside") && text.contains("another manoeuvre"), "{text}");
        for part in ["(88.51 km/h to 96.57 km/h)", "Striking car and struck car, "] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let table = told.blocks.iter().find_map(|block| match block {
            Block::Table(table) => Some(table),
            _ => None,
        });
        let table = table.unwrap();
        let probabilities: Vec<&str> = table.rows[..6].iter().map(|row| &*row[1]).collect();
        let has_number = |text: &&str| text.contains(" %");
        assert!(probabilities.iter().all(has_number), "{probabilities:?}");
        assert!(told.picture.is_some());
    }

    #[test]
    fn an_atlas_of_other_networks_says_so() {
        let wording = Wording::english(UnitSystem::Si);
        let mut atlas = atlas([10.0, 30.0]);
        atlas.networks.insert("force".to_owned(), "ab".to_owned());
        let digest = |sha256: &str| ModelDigest {
            network: "force".into(),
            name: "shipped".to_owned(),
            sha256: sha256.to_owned(),
        };
        let (scenario, struck) = (Scenario::example(), Preset::Reference.parameters());
        let told = |sha256: &str| {
            let told = of_case(&atlas, &[digest(sha256)], &scenario, &struck, &wording);
            let has_notice = told.blocks.iter().any(
                |block| matches!(block, Block::Notice { text } if text.contains("(force network)")),
            );
            [has_notice, format!("{:?}", told.picture).contains("those in use (")]
        };
        assert_eq!(told("ab"), [false; 2]);
        assert_eq!(told("cd"), [true; 2]);
    }

    #[test]
    fn a_pit_is_placed_in_the_map_and_said_to_be_outside_where_it_is() {
        let (scenario, struck) = (Scenario::example(), Preset::Reference.parameters());
        let wording = Wording::english(UnitSystem::Si);
        let inside = of_case(&atlas([10.0, 30.0]), &[], &scenario, &struck, &wording);
        assert!(inside.picture.is_some());
        let text = format!("{:?}", inside.blocks);
        for part in ["200 of the 200", "model study", "turns in further"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(text.contains("100.0 %"), "{text}");
        let outside = of_case(&atlas([20.0, 30.0]), &[], &scenario, &struck, &wording);
        assert_eq!(outside.picture, None);
        let text = format!("{:?}", outside.blocks);
        assert!(text.contains("outside") && text.contains(": 54 km/h, the map has"), "{text}");
        let mut other = scenario;
        other.striking.vy_world_m_s *= -1.0;
        assert_eq!(
            of_case(&atlas([10.0, 30.0]), &[], &other, &struck, &wording),
            InAtlas::default()
        );
    }
}
