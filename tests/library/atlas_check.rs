//! How `examples/atlas_check` finds that an atlas agrees with rows that are computed for its cells alone, and
//! that another one does not.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

#[path = "../../examples/atlas_check/cell.rs"]
mod cell;
#[path = "../../examples/atlas_check/compare.rs"]
mod compare;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use cell::{Place, cell_name, confined, direct_rows, drawn_cells, plan_of};
use compare::{Agreement, CellComparison};
use impactlab_core::numerics::random_stream;
use impactlab_study::Library;
use impactlab_sweep::atlas::{Atlas, AtlasBuilder, Axis};
use impactlab_sweep::{Outcome, PitInput, Plan, Row, RowInputs, Rows, chunk_path};
use rand::RngExt;

const PIT: &str = "\
question = \"pit\"
n = 128
chunk = 64
seed = 4

[pit]
scenario = \"pit-right-rear\"
limit_s = 1.5
pairs = [{ struck = \"toyota-camry-2018\", striking = \"ford-explorer-2020\" }]

[vary.target_speed_m_s]
uniform = [15, 25]

[vary.closing_m_s]
uniform = [1, 6]

[vary.overlap_m]
uniform = [-0.6, 0.6]

[vary.esc]
list = [0, 1]
";

const OVERLAP: &str = "\
[[axis]]
name = \"overlap_m\"
word = \"overlap\"
label = \"Contact\"
unit = \"m\"
edges = [-0.6, 0, 0.6]
";

fn shipped_plan() -> PathBuf {
    PathBuf::from("assets/atlas/pit.toml")
}

/// Rows of a plan whose probability of a quarter turn rises with the closing speed; half of these go on to a
/// half turn.
///
/// - `shift`: what the probability is greater by.
fn answered(plan: &Plan, shift: f64) -> Vec<Rows> {
    let closing = plan.vary.iter().position(|vary| vary.name == PitInput::Closing.name()).unwrap();
    let row = |index: u64| {
        let RowInputs { values, seed } = plan.inputs(index);
        let inputs: Vec<f64> = values.iter().map(|value| value.number).collect();
        let mut rng = random_stream(seed, "outcomes of a test", 0);
        let turns = rng.random::<f64>() < 0.1 + 0.1 * inputs[closing] + shift;
        let turns_on = turns && rng.random::<bool>();
        let outcome = |outcome: &Outcome| match outcome {
            Outcome::Turns90 => f64::from(u8::from(turns)),
            Outcome::Turns180 => f64::from(u8::from(turns_on)),
            Outcome::Recovers => f64::from(u8::from(!turns)),
            other if other.is_probability() => 0.0,
            _ => 1.0,
        };
        let outcomes = Ok(Outcome::ALL.iter().map(outcome).collect());
        Row { index, inputs, outcomes, caveats: String::new() }
    };
    let chunk = |chunk: u64| {
        let rows: Vec<Row> = plan.rows_of(chunk).map(row).collect();
        Rows::new(plan, chunk, &rows)
    };
    (0..plan.n_chunks()).map(chunk).collect()
}

fn atlas_of(rows: &[Rows], axes: Vec<Axis>) -> Atlas {
    let mut builder = AtlasBuilder::new(axes).unwrap();
    rows.iter().for_each(|rows| builder.add(rows).unwrap());
    builder.finish().unwrap()
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

#[test]
fn the_shipped_atlas_is_checked_with_its_own_plan_alone() {
    let (atlas, library) = (Atlas::shipped().unwrap(), Library::default());
    let plan = plan_of(atlas, &shipped_plan(), &library).unwrap();
    assert_eq!(plan.n, atlas.n_rows + atlas.n_failed + atlas.n_outside);
    let other = plan_of(atlas, Path::new("assets/atlas/pit-saltelli.toml"), &library);
    assert!(other.unwrap_err().to_string().contains("is not the plan of the atlas"));
    let mut foreign = atlas.clone();
    foreign.networks.clear();
    let refused = plan_of(&foreign, &shipped_plan(), &library).unwrap_err().to_string();
    assert!(refused.contains("other networks"), "{refused}");
}

#[test]
fn cells_are_drawn_by_their_seed_and_their_plans_stay_within_them() {
    let (atlas, library) = (Atlas::shipped().unwrap(), Library::default());
    let plan = plan_of(atlas, &shipped_plan(), &library).unwrap();
    let axes = words(&["speed", "closing", "driver"]);
    let cells = drawn_cells(atlas, &axes, 5, 1).unwrap();
    assert_eq!(cells, drawn_cells(atlas, &axes, 5, 1).unwrap());
    assert_ne!(cells, drawn_cells(atlas, &axes, 5, 2).unwrap());
    for at in &cells {
        let own = confined(&plan, atlas, at, [300, 1]).unwrap();
        assert_eq!((own.n_rows(), own.chunk, &own.name), (300, 300, &cell_name(atlas, at)));
        assert_ne!(own.seed, plan.seed);
        for row in 0..300 {
            let values = own.inputs(row).values;
            let named = own.vary.iter().zip(&values);
            let values: Vec<(&str, f64)> =
                named.map(|(vary, value)| (vary.name.as_str(), value.number)).collect();
            for (held, located) in at.iter().zip(atlas.locate(&values)) {
                assert!(held.is_none() || *held == located, "{at:?} {values:?}");
            }
        }
    }
    assert!(drawn_cells(atlas, &words(&["luck"]), 5, 1).is_err());
    assert!(drawn_cells(atlas, &words(&["speed", "speed"]), 5, 1).is_err());
}

#[test]
fn an_atlas_of_the_same_outcomes_is_confirmed_and_one_of_others_is_not() {
    let library = Library::default();
    let mut plan = Plan::read(&shipped_plan(), &library).unwrap();
    plan.n = 8192;
    let atlas = atlas_of(&answered(&plan, 0.0), Axis::pit().unwrap());
    let cells = drawn_cells(&atlas, &words(&["closing", "esc"]), 12, 3).unwrap();
    assert_eq!(cells.len(), 12);
    let compared = |shift: f64| -> Vec<CellComparison> {
        let cell = |at: &Place| {
            let own = confined(&plan, &atlas, at, [2000, 3]).unwrap();
            CellComparison::new(&atlas, at, &answered(&own, shift)).unwrap()
        };
        cells.iter().map(cell).collect()
    };
    let same = compared(0.0);
    for cell in &same {
        let outcomes: Vec<Outcome> = cell.outcomes.iter().map(|of| of.outcome).collect();
        assert_eq!(outcomes, [Outcome::Turns90, Outcome::Turns180, Outcome::Recovers]);
        assert_eq!((cell.n_same, cell.n_failed), (3, 0));
        assert!((400..1000).contains(&cell.n_atlas_rows), "{}", cell.n_atlas_rows);
        for of in &cell.outcomes {
            assert!(of.atlas.error > 1.3 * of.direct.error, "{of:?}");
        }
    }
    let agreement = Agreement::new(&same).unwrap();
    assert!(agreement.p > 1e-3 && agreement.n == 36 && agreement.n_beyond <= 8, "{agreement:?}");
    // Whoever does not turn recovers, and half turns are among the quarter turns.
    assert!((12.0..24.0).contains(&agreement.freedom), "{agreement:?}");
    let shifted = Agreement::new(&compared(0.08)).unwrap();
    assert!(shifted.p < 1e-6 && shifted.n_beyond > agreement.n_beyond, "{shifted:?}");
    assert!(shifted.chi_square > 2.0 * shifted.freedom, "{shifted:?}");
    assert_eq!(Agreement::new(&[]), None);
}

#[test]
fn rows_of_another_cell_are_refused() {
    let mut plan = Plan::read(&shipped_plan(), &Library::default()).unwrap();
    plan.n = 2048;
    let atlas = atlas_of(&answered(&plan, 0.0), Axis::pit().unwrap());
    let cells = drawn_cells(&atlas, &words(&["closing"]), 2, 1).unwrap();
    let other = confined(&plan, &atlas, &cells[1], [200, 1]).unwrap();
    let refused = CellComparison::new(&atlas, &cells[0], &answered(&other, 0.0));
    assert!(refused.unwrap_err().to_string().contains("outside"));
}

#[test]
fn p_of_independent_cells_is_spread_evenly() {
    let mut plan = Plan::read(&shipped_plan(), &Library::default()).unwrap();
    let axes = words(&["closing"]);
    let p: Vec<f64> = (0..60)
        .map(|seed: u64| {
            (plan.n, plan.seed) = (1024, 1000 + seed);
            let atlas = atlas_of(&answered(&plan, 0.0), Axis::pit().unwrap());
            let cells = drawn_cells(&atlas, &axes, 6, seed).unwrap();
            let compared: Vec<CellComparison> = cells
                .iter()
                .map(|at| {
                    let own = confined(&plan, &atlas, at, [500, seed]).unwrap();
                    CellComparison::new(&atlas, at, &answered(&own, 0.0)).unwrap()
                })
                .collect();
            Agreement::new(&compared).unwrap().p
        })
        .collect();
    let n_below = |limit: f64| p.iter().filter(|p| **p < limit).count();
    // Points of a Sobol sequence scatter less than independent ones: p may be too great, not too small.
    assert!(n_below(0.05) <= 10, "{p:?}");
    assert!(n_below(0.5) >= 10, "{p:?}");
}

/// Rows of the real chain, followed for 1.5 s.
#[test]
fn computed_rows_confirm_their_atlas_and_not_one_that_is_turned_around() {
    let folder = tempfile::tempdir().unwrap();
    let (library, file) = (Library::default(), folder.path().join("plan.toml"));
    std::fs::write(&file, PIT).unwrap();
    let plan = Plan::read(&file, &library).unwrap();
    let axes = Axis::from_toml(OVERLAP, Path::new("axes.toml")).unwrap();
    let computed = |plan: &Plan, name: &str| {
        let folder = folder.path().join(name);
        direct_rows(plan, &folder, &library, &mut |_| ControlFlow::Continue(())).unwrap()
    };
    let (mut rows, n_computed) = computed(&plan, "atlas");
    assert_eq!(n_computed, 128);
    let atlas = atlas_of(&rows, axes.clone());
    assert_eq!(plan_of(&atlas, &file, &library).unwrap(), plan);
    let cells = drawn_cells(&atlas, &words(&["overlap"]), 2, 1).unwrap();
    let own: Vec<Plan> =
        cells.iter().map(|at| confined(&plan, &atlas, at, [64, 1]).unwrap()).collect();
    let direct: Vec<Vec<Rows>> = own.iter().map(|own| computed(own, &own.name).0).collect();
    let agreement = |atlas: &Atlas| {
        let compared = cells.iter().zip(&direct);
        let compared: Vec<CellComparison> =
            compared.map(|(at, rows)| CellComparison::new(atlas, at, rows).unwrap()).collect();
        Agreement::new(&compared).unwrap()
    };
    let found = agreement(&atlas);
    assert!(found.p > 1e-3, "{found:?}");

    // What is there is kept, what is not is computed.
    let first = &own[0];
    let part = chunk_path(&folder.path().join(&first.name), 0);
    let bytes = std::fs::read(&part).unwrap();
    assert_eq!(computed(first, &first.name).1, 0);
    std::fs::remove_file(&part).unwrap();
    assert_eq!(computed(first, &first.name).1, 64);
    assert_eq!(std::fs::read(&part).unwrap(), bytes);

    // A door is hit the more often the further ahead the contact is.
    for rows in &mut rows {
        let overlap = rows.inputs.iter_mut().find(|column| column.name == "overlap_m").unwrap();
        overlap.values.iter_mut().for_each(|value| *value = -*value);
    }
    let turned = agreement(&atlas_of(&rows, axes));
    assert!(turned.p < 1e-6, "{turned:?}");
}
